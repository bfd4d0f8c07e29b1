// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Runs of a tile's packets: set up, sorted by class, drawn for the first pass, and kept for the second.
#include "surface/tile_runs.h"

#include <math.h>

enum { NEAR_CHUNK = 64 };

/// Orders a run's splats by class, stably: in parts, which count beside each other, since counting up a number
/// again and again waits each time.
static void sort_run(const ewa_run *run, uint16_t *order, ewa_sorted_run *sorted) {
    enum { PARTS = 4 };
    uint16_t next[EWA_CLASS_COUNT][PARTS] = {{0}};
    const uint32_t part = run->count / PARTS, rest = PARTS * part;
    const uint8_t *classes = run->classes;
    for (uint32_t i = 0; i < part; i++)
        for (uint32_t k = 0; k < PARTS; k++) next[classes[k * part + i]][k]++;
    for (uint32_t i = rest; i < run->count; i++) next[classes[i]][PARTS - 1]++;
    uint16_t sum = 0;
    for (int c = 0; c < EWA_CLASS_COUNT; c++) {
        sorted->class_first[c] = sum;
        for (uint32_t k = 0; k < PARTS; k++) {
            const uint16_t here = next[c][k];
            next[c][k] = sum;
            sum = (uint16_t)(sum + here);
        }
    }
    sorted->class_first[EWA_CLASS_COUNT] = sum;
    for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++) order[sum + i] = 0; // small splats are read by sixteens
    for (uint32_t i = 0; i < part; i++)
        for (uint32_t k = 0; k < PARTS; k++)
            order[next[classes[k * part + i]][k]++] = (uint16_t)(k * part + i);
    for (uint32_t i = rest; i < run->count; i++) order[next[classes[i]][PARTS - 1]++] = (uint16_t)i;
    sorted->records = run->records;
    sorted->loads = run->loads;
    sorted->opacities = run->opacities;
    sorted->materials = run->materials;
    sorted->surfels = run->surfels;
    sorted->order = order;
}

void ewa_tile_draw_near(const ewa_tile_job *job, const ewa_tile_source *source, const ewa_tile *tile,
                        const ewa_edges *edges, const uint32_t *surfels, uint32_t count, ewa_tile_pass what) {
    if (!ewa_takes_part(source, what)) return;
    const ewa_pipeline_kernels *kernels = job->kernels;
    const ewa_view *view = &source->view;
    ewa_near_record records[NEAR_CHUNK];
    for (uint32_t done = 0; done < count;) {
        uint32_t filled = 0;
        for (; done < count && filled < NEAR_CHUNK; done++)
            filled += ewa_near_record_set(&records[filled], source->surfels, surfels[done], view, tile);
        if (what == EWA_PASS_VISIBILITY)
            kernels->near_visibility(view, tile, records, filled);
        else if (what == EWA_PASS_ACCUMULATE)
            kernels->near_accumulate(view, tile, records, filled);
        else if (what == EWA_PASS_SPREAD)
            kernels->near_spread(view, tile, records, filled);
        else if (what == EWA_PASS_GATHER)
            kernels->near_gather(view, tile, records, filled);
        else
            kernels->edge_near_pass(view, tile, edges, records, filled, what == EWA_PASS_EDGE_ACCUMULATE);
    }
}

static void count_splats(const ewa_tile_job *job, ewa_tile_scratch *s, const ewa_sorted_run *run) {
    s->drawn_count += s->run.count + s->run.near_count;
    if (!job->count_fragments) return;
    uint32_t blocks = 0;
    for (uint32_t c = 0; c < EWA_CLASS_COUNT; c++) {
        const uint32_t columns = c % EWA_STEEP_CLASS / EWA_ROW_CLASSES + 1, rows = c % EWA_ROW_CLASSES + 1;
        if (c < EWA_WIDE_CLASS && rows < EWA_ROW_CLASSES) {
            blocks += columns * rows * (uint32_t)(run->class_first[c + 1] - run->class_first[c]);
            continue;
        }
        for (uint32_t i = run->class_first[c]; i < run->class_first[c + 1]; i++) {
            const uint32_t box = (uint32_t)s->run.boxes[run->order[i]];
            blocks += ewa_box_columns(box) * ewa_box_rows(box);
        }
    }
    s->fragment_count += blocks;
}

/// Makes splats that hide nothing: the key of z + eps is below all. For the passes behind edges, where lists mix
/// the splats of several sources.
static void unbind(ewa_record *records, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        ewa_record *r = &records[i];
        if (r->box & EWA_STEEP_BIT)
            r->bound_scale = 1, r->bound_offset = -INFINITY;
        else
            r->bound = -INFINITY, r->bound_x = r->bound_y = 0;
    }
}

/// Sets up and sorts run `index`; its splats go to place `at` of the scratch.
static void prepare_run(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                        const ewa_tile_packets *packets, uint64_t index, uint32_t at,
                        ewa_sorted_run *sorted) {
    const uint64_t first = index * EWA_RUN_PACKETS, left = packets->count - first;
    s->run.records = s->records + at;
    s->run.loads = s->loads + at;
    s->run.boxes = s->boxes[0].first + at;
    s->run.key_lows = s->boxes[0].key_low + at;
    s->run.opacities = s->opacities ? s->opacities + at : NULL;
    s->run.materials = s->materials ? s->materials + at : NULL;
    s->run.surfels = s->surfels ? s->surfels + at : NULL;
    const uint32_t announced = left < 2 * EWA_RUN_PACKETS ? (uint32_t)left : 2 * EWA_RUN_PACKETS;
    const ewa_tile_source *source = packets->source;
    job->kernels->setup(&source->view, &source->packets, packets->ids + first,
                        announced < EWA_RUN_PACKETS ? announced : EWA_RUN_PACKETS, announced, tile, &s->run);
    if (!source->hides) unbind(s->run.records, s->run.count);
    s->min_key = fminf(s->min_key, s->run.min_key);
    s->has_near |= s->run.near_count > 0;
    s->record_count += s->run.count, s->small_count += s->run.small_count;
    sort_run(&s->run, s->order + at, sorted);
    sorted->clips = s->clips ? s->clips + at : NULL;
    for (uint32_t i = 0; i < s->run.clipped_count; i++)
        ewa_clip_set(&s->clips[at + s->run.clipped[i].record], source->surfels, s->run.clipped[i].surfel,
                     &source->view, tile);
}

static void visit_run(const ewa_tile_job *job, const ewa_tile_source *source, const ewa_tile *tile,
                      const ewa_sorted_run *run, ewa_tile_pass what) {
    if (!ewa_takes_part(source, what)) return;
    if (what == EWA_PASS_VISIBILITY)
        job->kernels->visibility(&source->view, tile, run);
    else if (what == EWA_PASS_SPREAD)
        job->kernels->spread(&source->view, tile, run);
    else if (what == EWA_PASS_GATHER)
        job->kernels->gather(&source->view, tile, run);
    else
        job->kernels->accumulate(&source->view, tile, run);
}

void ewa_tile_walk_kept(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s, ewa_tile_pass what) {
    for (uint32_t i = 0; i < s->kept_count && ewa_tile_goes_on(job, s); i++) {
        const ewa_kept_run *kept = &s->kept[i];
        visit_run(job, kept->source, tile, &kept->sorted, what);
        ewa_tile_draw_near(job, kept->source, tile, NULL, s->near_surfels + kept->near_first,
                           kept->near_count, what);
    }
}

void ewa_tile_walk_again(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                         const ewa_tile_packets *packets, uint64_t first, uint64_t end, ewa_tile_pass what) {
    for (uint64_t i = first; i < end && ewa_tile_goes_on(job, s); i++) {
        ewa_sorted_run sorted;
        const double before = ewa_now_s();
        prepare_run(job, tile, s, packets, i, 0, &sorted);
        const double middle = ewa_now_s();
        s->setup_s += middle - before;
        visit_run(job, packets->source, tile, &sorted, what);
        ewa_tile_draw_near(job, packets->source, tile, NULL, s->run.near_surfels, s->run.near_count, what);
        if (what == EWA_PASS_VISIBILITY) count_splats(job, s, &sorted);
        *(what == EWA_PASS_VISIBILITY ? &s->visibility_s : &s->accumulate_s) += ewa_now_s() - middle;
    }
}

void ewa_tile_walk_shown(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s, bool kept,
                         ewa_tile_pass what) {
    if (kept) ewa_tile_walk_kept(job, tile, s, what);
    for (uint32_t i = 0; i < job->source_count && !kept; i++) {
        const ewa_tile_packets shown = {&job->sources[i], s->split[i].shown, s->split[i].shown_count};
        ewa_tile_walk_again(job, tile, s, &shown, 0, ewa_run_count(&shown), what);
    }
}

void ewa_tile_close_pixels(float *nearest, uint32_t block_count, float from, float to) {
    for (size_t i = 0; i < (size_t)block_count * EWA_BLOCK_LANES; i++)
        if (nearest[i] == from) nearest[i] = to;
}

void ewa_tile_drop_runs(ewa_tile_scratch *s) { s->kept_count = s->near_count = s->boxes[0].count = 0; }

uint64_t ewa_tile_keep_runs(const ewa_tile_job *job, const ewa_tile *tile, ewa_tile_scratch *s,
                            const ewa_tile_packets *packets, uint64_t first, uint64_t end, bool draw) {
    double before = ewa_now_s();
    uint64_t i = first;
    for (; i < end; i++) {
        const uint64_t packets_left = packets->count - i * EWA_RUN_PACKETS;
        const uint64_t lanes =
            EWA_PACKET_LANES * (packets_left < EWA_RUN_PACKETS ? packets_left : EWA_RUN_PACKETS);
        if (s->boxes[0].count + s->near_count + lanes > s->record_capacity) break;
        if (s->kept_count >= s->kept_capacity) break;
        ewa_kept_run *kept = &s->kept[s->kept_count++];
        prepare_run(job, tile, s, packets, i, s->boxes[0].count, &kept->sorted);
        kept->source = packets->source;
        kept->near_first = s->near_count;
        kept->near_count = s->run.near_count;
        for (uint32_t k = 0; k < kept->near_count; k++)
            s->near_surfels[s->near_count + k] = s->run.near_surfels[k];
        s->boxes[0].count += s->run.count;
        s->near_count += kept->near_count;
        const double middle = ewa_now_s();
        s->setup_s += middle - before;
        before = middle;
        if (!draw) continue;
        visit_run(job, kept->source, tile, &kept->sorted, EWA_PASS_VISIBILITY);
        ewa_tile_draw_near(job, kept->source, tile, NULL, s->run.near_surfels, kept->near_count,
                           EWA_PASS_VISIBILITY);
        count_splats(job, s, &kept->sorted);
        before = ewa_now_s();
        s->visibility_s += before - middle;
    }
    return i;
}
