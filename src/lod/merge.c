// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One surfel for all that lie in a cell, sheet by sheet.
#include "lod/representative.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    PARTS = 64,
    MAX_SHEETS = 6, // of a cell
    SAMPLE = 64,    // radii that a median is taken of
    MIN_MEDIAN = 5, // surfels that have one
};

/// Cosine between the normals of one sheet.
static const float SAME_SHEET = 0.5f;

/// Largest radius that counts, over the median.
static const float MAX_RADIUS = 3;

typedef struct sheet {
    double weight, at[3], normal[3], color[3], alpha, curvature;
    double first[3], offset[3], moment, square; ///< w p, w n.p and w |p|^2, p from the first member, n its normal
    float first_normal[3];
    double code; ///< of its members, where codes are not mixed
} sheet;

/// A number of a surfel, and its area.
typedef struct weighed {
    double number, weight;
} weighed;

typedef struct merge_job {
    const ewa_representatives *all;
    const ewa_representative *fine;
    uint32_t count, cell_level, means, code_index;
    ewa_representatives made; // those of each part where its fine ones begin
    uint8_t *sheet_of;        // [fine], where there are numbers
    weighed *weighed;         // [fine], likewise
    uint32_t made_counts[PARTS];
} merge_job;

static int compare_numbers(const void *a, const void *b) {
    const double p = ((const weighed *)a)->number, q = ((const weighed *)b)->number;
    return p < q ? -1 : p > q;
}

/// The mean of the finite ones by area; NaN where there is none.
static double weighted_mean(const weighed *of, uint32_t count) {
    double sum = 0, weights = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!isfinite(of[i].number)) continue;
        sum += of[i].weight * of[i].number;
        weights += of[i].weight;
    }
    return weights > 0 ? sum / weights : (double)NAN;
}

/// The number of the largest area, of several the smallest.
static double weighted_mode(weighed *of, uint32_t count) {
    double mode = of[0].number, maximum = -1;
    qsort(of, count, sizeof *of, compare_numbers);
    for (uint32_t first = 0, next; first < count; first = next) {
        double weight = of[first].weight;
        for (next = first + 1; next < count && of[next].number == of[first].number; next++) weight += of[next].weight;
        if (weight > maximum) maximum = weight, mode = of[first].number;
    }
    return mode;
}

static int compare_floats(const void *a, const void *b) {
    const float p = *(const float *)a, q = *(const float *)b;
    return p < q ? -1 : p > q;
}

/// The largest radius that counts in a cell.
static float radius_limit(const ewa_representative *cell, uint32_t count) {
    if (count < MIN_MEDIAN) return INFINITY;
    float radii[SAMPLE];
    const uint32_t sample = count < SAMPLE ? count : SAMPLE;
    for (uint32_t i = 0; i < sample; i++) radii[i] = cell[(uint64_t)i * count / sample].radius_world;
    qsort(radii, sample, sizeof *radii, compare_floats);
    return MAX_RADIUS * radii[sample / 2];
}

static float dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The area by which a surfel counts.
static double weight_of(const ewa_representative *s, float limit) {
    const double radius = (double)(s->radius_world < limit ? s->radius_world : limit);
    return radius * radius;
}

static void add(sheet *to, const ewa_representative *s, float limit) {
    const double weight = weight_of(s, limit);
    to->weight += weight;
    to->alpha += weight * (double)s->alpha;
    to->curvature += weight * (double)s->curvature;
    for (int c = 0; c < 3; c++) {
        const double offset = s->at_world[c] - to->first[c];
        to->offset[c] += weight * offset;
        to->moment += weight * (double)s->normal[c] * offset;
        to->square += weight * offset * offset;
        to->at[c] += weight * s->at_world[c];
        to->normal[c] += weight * (double)s->normal[c];
        to->color[c] += weight * (double)s->color[c];
    }
}

/// How far the surface lies above the middle of its members, towards their normals: half of what the planes of these are
/// above it, which is exact where it bends evenly. Where nothing is known to bend, normals are noise: 0.
static double height_of(const sheet *from) {
    if (from->curvature == 0) return 0;
    double moment = from->moment, square = from->square;
    for (int c = 0; c < 3; c++) {
        const double middle = from->offset[c] / from->weight;
        moment -= middle * from->normal[c];
        square -= middle * from->offset[c];
    }
    const double height = moment / (2 * from->weight), limit = square > 0 ? sqrt(square / from->weight) / 2 : 0;
    return height < -limit ? -limit : height > limit ? limit : height;
}

static ewa_representative finish(const sheet *from, uint64_t code) {
    ewa_representative made = {.code = code,
                               .radius_world = (float)sqrt(from->weight),
                               .alpha = (float)(from->alpha / from->weight),
                               .curvature = (float)(from->curvature / from->weight)};
    const double height = height_of(from);
    const double length = sqrt(from->normal[0] * from->normal[0] + from->normal[1] * from->normal[1] +
                               from->normal[2] * from->normal[2]);
    for (int c = 0; c < 3; c++) {
        made.normal[c] = length > 0 ? (float)(from->normal[c] / length) : from->first_normal[c];
        made.at_world[c] = from->at[c] / from->weight + height * (double)made.normal[c];
        made.color[c] = made.shown[c] = (float)(from->color[c] / from->weight);
    }
    return made;
}

/// Makes the numbers of a cell's sheets.
static void merge_numbers(const merge_job *job, uint32_t first, uint32_t count, float limit, uint32_t sheet_count,
                          double *made) {
    const uint32_t number_count = job->all->number_count;
    weighed *of = job->weighed + first;
    for (uint32_t k = 0; k < sheet_count; k++)
        for (uint32_t a = 0; a < number_count; a++) {
            uint32_t members = 0;
            bool same = true;
            for (uint32_t i = first; i < first + count; i++) {
                if (job->sheet_of[i] != k) continue;
                of[members] = (weighed){job->all->numbers[(size_t)i * number_count + a], weight_of(&job->fine[i], limit)};
                same = same && of[members].number == of[0].number;
                members++;
            }
            made[(size_t)k * number_count + a] = same                  ? of[0].number
                                                 : job->means >> a & 1 ? weighted_mean(of, members)
                                                                       : weighted_mode(of, members);
        }
}

/// The sheet of a cell that a surfel belongs to: the nearest one by its normal, of those of its code where there is one and codes are not mixed;
/// `*same`: no other one is wanted.
static uint32_t find_sheet(const sheet *sheets, uint32_t count, const ewa_representative *s, double code, bool *same) {
    uint32_t best = 0;
    float maximum = -2;
    bool best_of_code = false;
    for (uint32_t k = 0; k < count; k++) {
        const float cosine = dot(sheets[k].first_normal, s->normal);
        const bool of_code = sheets[k].code == code;
        if (of_code < best_of_code || (of_code == best_of_code && cosine <= maximum)) continue;
        maximum = cosine, best = k, best_of_code = of_code;
    }
    *same = best_of_code && maximum >= SAME_SHEET;
    return best;
}

/// Merges the surfels of a cell from `first` on; returns how many they become.
static uint32_t merge_cell(const merge_job *job, uint32_t first, uint32_t count, uint32_t made_at) {
    const ewa_representative *cell = job->fine + first;
    const size_t number_count = job->all->number_count;
    ewa_representative *made = job->made.items + made_at;
    double *numbers = number_count ? job->made.numbers + made_at * number_count : NULL;
    if (count == 1) {
        *made = *cell;
        memcpy(made->shown, made->color, sizeof made->shown);
        if (number_count) memcpy(numbers, job->all->numbers + first * number_count, number_count * sizeof *numbers);
        return 1;
    }
    sheet sheets[MAX_SHEETS];
    uint32_t sheet_count = 0;
    const float limit = radius_limit(cell, count);
    for (uint32_t i = 0; i < count; i++) {
        const double code = job->code_index < number_count ? job->all->numbers[(first + i) * number_count + job->code_index] : 0;
        bool same;
        uint32_t best = find_sheet(sheets, sheet_count, &cell[i], code, &same);
        if (!same && sheet_count < MAX_SHEETS) {
            best = sheet_count++;
            sheets[best] = (sheet){.code = code};
            memcpy(sheets[best].first, cell[i].at_world, sizeof sheets[best].first);
            memcpy(sheets[best].first_normal, cell[i].normal, sizeof sheets[best].first_normal);
        }
        add(&sheets[best], &cell[i], limit);
        if (number_count) job->sheet_of[first + i] = (uint8_t)best;
    }
    if (number_count) merge_numbers(job, first, count, limit, sheet_count, numbers);
    for (uint32_t k = 0; k < sheet_count; k++) made[k] = finish(&sheets[k], cell->code);
    return sheet_count;
}

/// The first surfel from `at` on that begins a cell.
static uint32_t cell_start(const merge_job *job, uint32_t at) {
    while (at > 0 && at < job->count &&
           ewa_code_prefix(job->fine[at].code, job->cell_level) ==
               ewa_code_prefix(job->fine[at - 1].code, job->cell_level))
        at++;
    return at;
}

static void merge_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    merge_job *job = data;
    const uint32_t begin = cell_start(job, (uint32_t)ewa_split(job->count, PARTS, part)),
                   end = cell_start(job, (uint32_t)ewa_split(job->count, PARTS, part + 1));
    uint32_t made_count = 0;
    for (uint32_t first = begin, next; first < end; first = next) {
        const uint64_t prefix = ewa_code_prefix(job->fine[first].code, job->cell_level);
        next = first + 1;
        while (next < end && ewa_code_prefix(job->fine[next].code, job->cell_level) == prefix) next++;
        made_count += merge_cell(job, first, next - first, begin + made_count);
    }
    job->made_counts[part] = made_count;
}

ewa_status ewa_representatives_reserve(ewa_context *context, ewa_representatives *representatives, uint32_t count,
                                       uint32_t number_count) {
    ewa_buffer items = {representatives->items, representatives->capacity_bytes},
               numbers = {representatives->numbers, representatives->numbers_capacity_bytes};
    ewa_status status = ewa_buffer_reserve(context, &items, count, sizeof *representatives->items);
    if (status == EWA_OK && number_count)
        status = ewa_buffer_reserve(context, &numbers, (size_t)count * number_count, sizeof *representatives->numbers);
    representatives->items = items.data, representatives->capacity_bytes = items.capacity_bytes;
    representatives->numbers = numbers.data, representatives->numbers_capacity_bytes = numbers.capacity_bytes;
    representatives->number_count = number_count;
    return status;
}

/// Puts the surfels of all parts behind each other.
static void gather_parts(const merge_job *job, ewa_representatives *merged) {
    const size_t number_count = merged->number_count;
    size_t kept = 0;
    for (uint32_t part = 0; part < PARTS; part++) {
        const size_t begin = cell_start(job, (uint32_t)ewa_split(job->count, PARTS, part)), count = job->made_counts[part];
        if (!count) continue;
        memcpy(merged->items + kept, job->made.items + begin, count * sizeof *merged->items);
        if (number_count)
            memcpy(merged->numbers + kept * number_count, job->made.numbers + begin * number_count,
                   count * number_count * sizeof *merged->numbers);
        kept += count;
    }
}

ewa_status ewa_representatives_merge(ewa_context *context, const ewa_representatives *fine, uint32_t cell_level,
                                     uint32_t means, uint32_t code_index, ewa_representatives *merged) {
    merge_job job = {.all = fine, .fine = fine->items, .count = fine->count, .cell_level = cell_level, .means = means, .code_index = code_index};
    const uint32_t weighed_count = fine->number_count ? fine->count : 0;
    ewa_status status = ewa_representatives_reserve(context, &job.made, fine->count, fine->number_count);
    if (weighed_count) {
        job.sheet_of = ewa_allocate(context, weighed_count, 1);
        job.weighed = ewa_allocate(context, weighed_count, sizeof *job.weighed);
        if (!job.sheet_of || !job.weighed) status = EWA_ERROR_MEMORY;
    }
    if (status == EWA_OK) {
        ewa_parallel(context, merge_part, &job, PARTS);
        merged->count = 0;
        for (uint32_t part = 0; part < PARTS; part++) merged->count += job.made_counts[part];
        status = ewa_representatives_reserve(context, merged, merged->count, fine->number_count);
    }
    if (status == EWA_OK) gather_parts(&job, merged);
    ewa_release(context, job.sheet_of, weighed_count, 1);
    ewa_release(context, job.weighed, weighed_count, sizeof *job.weighed);
    ewa_representatives_free(context, &job.made);
    return status;
}

void ewa_representatives_free(ewa_context *context, ewa_representatives *representatives) {
    ewa_buffer items = {representatives->items, representatives->capacity_bytes},
               numbers = {representatives->numbers, representatives->numbers_capacity_bytes};
    ewa_buffer_free(context, &items);
    ewa_buffer_free(context, &numbers);
    *representatives = (ewa_representatives){0};
}
