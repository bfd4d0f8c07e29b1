// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A level of detail from the one before: what stands for each group of surfels, packed as they are.
//
// Packets are looked at twice: to divide them into groups and count these, then to make what stands for them.
// Parts have a fixed number of packets, so that the result does not depend on the number of workers.
#include "surface/levels.h"
#include "base/base.h"
#include "surface/color_form.h"
#include "surface/groups.h"
#include "surface/pack.h"
#include "surface/packet_order.h"
#include "surface/semantics.h"

#include <math.h>
#include <string.h>

enum {
    LANES = EWA_PACKET_LANES,
    PART_PACKETS = 1024,
    WINDOW_SEPARATE = 128, // too far from what lies before for one packet with it
};

/// A surfel in the making that stands for a group.
typedef struct representative {
    ewa_vec3 center; ///< from the origin, in the surfels' unit
    ewa_vec3 normal, axis_u;
    double sigma, color[3], opacity, curvature;
    uint16_t ratio;
    uint8_t material;
    bool clipped, billboard;
    ewa_surfel_clip clip;
} representative;

/// What a part of the finer level gives.
typedef struct part_count {
    uint32_t surfels, packets, clips; ///< of all that it gives
    uint32_t first_packet;            ///< of the coarser level
    uint64_t first_clip;
} part_count;

typedef struct level_job {
    const ewa_surfels *fine;
    ewa_surfels *coarse;
    const ewa_pack_kernels *kernels;
    const ewa_group_kernels *grouping;
    double growth;    ///< of sigmas, beside what keeps the area
    uint8_t *order;   ///< [packet of the finer level][16]: lanes of each window, as groups are
    uint16_t *starts; ///< [packet of the finer level]: of groups
    uint8_t
        *windows; ///< [packet of the finer level]: packets of the window that begins there; WINDOW_SEPARATE
    part_count *parts;
    uint32_t part_count;
    uint8_t *lane_counts; ///< [packet of the coarser level]
} level_job;

/// As fmin() and fmax() of numbers, without the calls.
static inline double minimum(double a, double b) { return a < b ? a : b; }
static inline double maximum(double a, double b) { return a > b ? a : b; }

/// Boxes around packets that may become one.
typedef struct open_box {
    double low[3], high[3], min_sigma;
} open_box;

static uint64_t part_end(const level_job *job, uint32_t part) {
    const uint64_t end = ((uint64_t)part + 1) * PART_PACKETS;
    return end < job->fine->packet_count ? end : job->fine->packet_count;
}

/// Puts a packet into the box; false where that becomes too wide for single precision.
static bool open_with(open_box *box, const ewa_surfels *fine, uint32_t index) {
    const ewa_packet *packet = &fine->packets[index];
    const uint32_t bits = (uint32_t)fine->bounds.radius[index] << EWA_RADIUS_SHIFT;
    float radius, sigma = INFINITY;
    memcpy(&radius, &bits, sizeof radius);
    for (int lane = 0; lane < LANES; lane++) {
        const float here = packet->sigma[lane];
        sigma = here > 0 && here < sigma ? here : sigma;
    }
    box->min_sigma = minimum(box->min_sigma, (double)sigma);
    double center[3];
    vec3_store(ewa_packet_center(fine, index), center);
    bool fits = true;
    for (int c = 0; c < 3; c++) {
        box->low[c] = minimum(box->low[c], center[c] - (double)radius);
        box->high[c] = maximum(box->high[c], center[c] + (double)radius);
        fits &= box->high[c] - box->low[c] <= EWA_PACKET_REACH * box->min_sigma;
    }
    return fits;
}

// Curvature times standard deviation of what stands for several, at most: coarse surfels that moved farther at contours would leave gaps.
static const double MAX_BEND = 0.07;

static const open_box EMPTY = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, INFINITY};

/// Takes packets into a window, up to one that would make the open packet too wide; returns the window, with
/// WINDOW_SEPARATE if that is so for the first one.
static uint8_t take_window(const ewa_surfels *fine, open_box *box, bool open, uint32_t first, uint32_t end) {
    uint32_t count = 0, separate = 0;
    for (; count < EWA_WINDOW_PACKETS && first + count < end; count++) {
        if (open_with(box, fine, first + count) || (count == 0 && !open)) continue;
        if (count > 0) break; // the box keeps it: the next window is apart
        separate = WINDOW_SEPARATE;
        *box = EMPTY;
        open_with(box, fine, first);
    }
    return (uint8_t)(count | separate);
}

/// Whether a group has a member with clip lines.
static uint32_t clipped_count(const ewa_surfels *fine, const uint8_t *order, uint32_t first_packet,
                              uint32_t first, uint32_t end) {
    uint32_t count = 0;
    for (uint32_t i = first; i < end; i++)
        count += fine->clip_masks[first_packet + order[i] / LANES] >> order[i] % LANES & 1;
    return count;
}

/// The end of the group that begins at `first` of a window's order.
static uint32_t group_end(const uint16_t *starts, uint32_t first, uint32_t surfel_count) {
    uint32_t end = first + 1;
    while (end < surfel_count && !(starts[end / LANES] >> end % LANES & 1)) end++;
    return end;
}

static uint32_t surfels_of(const ewa_window *window) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < window->packet_count * LANES; i++) count += window->sigma[i] > 0;
    return count;
}

/// Divides the packets of a part into groups and counts what these give.
static void count_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const level_job *job = data;
    const ewa_surfels *fine = job->fine;
    part_count made = {0};
    open_box box = EMPTY;
    uint32_t open = 0; // surfels of a packet that is not full
    const uint32_t end = (uint32_t)part_end(job, part);
    for (uint32_t p = part * PART_PACKETS, count; p < end; p += count) {
        ewa_window window;
        job->windows[p] = take_window(fine, &box, open > 0, p, end);
        count = job->windows[p] % WINDOW_SEPARATE;
        job->grouping->read(fine->packets, &fine->bounds, p, count, &window);
        uint8_t *order = job->order + (size_t)p * LANES;
        const uint32_t groups = job->grouping->divide(&window, (float)fine->cutoff, order, job->starts + p);
        if (job->windows[p] & WINDOW_SEPARATE) made.packets++, open = 0;
        open += groups;
        made.surfels += groups;
        made.packets += open / LANES;
        if (open >= LANES) {
            box = EMPTY;
            for (uint32_t k = 0; k < count && open % LANES; k++) open_with(&box, fine, p + k);
        }
        open %= LANES;
        const uint32_t surfels = fine->clip_masks ? surfels_of(&window) : 0;
        for (uint32_t first = 0, next; first < surfels; first = next) {
            next = group_end(job->starts + p, first, surfels);
            made.clips += clipped_count(fine, order, p, first, next) > 0;
        }
    }
    made.packets += open > 0;
    job->parts[part] = made;
}

/// Where each part's packets and clip lines begin. Without packets kept apart, if these would be too many.
static void place_parts(level_job *job) {
    enum { ALWAYS = 64 }; // more packets that any level may have
    uint64_t packets = 0, full = 0, clips = 0, surfels = 0;
    for (uint32_t part = 0; part < job->part_count; part++) {
        packets += job->parts[part].packets;
        full += ((uint64_t)job->parts[part].surfels + LANES - 1) / LANES;
    }
    const bool spread = packets > full + full / 4 + ALWAYS;
    for (uint32_t p = 0; spread && p < job->fine->packet_count; p++) job->windows[p] &= WINDOW_SEPARATE - 1;
    packets = 0;
    for (uint32_t part = 0; part < job->part_count; part++) {
        part_count *made = &job->parts[part];
        if (spread) made->packets = (made->surfels + LANES - 1) / LANES;
        made->first_packet = (uint32_t)packets, made->first_clip = clips;
        packets += made->packets, clips += made->clips, surfels += made->surfels;
    }
    job->coarse->packet_count = (uint32_t)packets;
    job->coarse->count = (uint32_t)surfels;
    job->coarse->clip_count = clips;
}

/// What becomes a mean of the surfels of a window; returns whether all colours have the plain form.
static bool read_means(const ewa_surfels *fine, const ewa_window *window, ewa_window_means *means) {
    bool plain = true;
    for (uint32_t k = 0; k < window->packet_count; k++) {
        const ewa_packet *packet = &fine->packets[window->first + k];
        const size_t lane = (size_t)(window->first + k) * LANES, to = (size_t)k * LANES;
        const uint16_t form = fine->bounds.colors[window->first + k];
        const uint16_t *const codes[3] = {packet->red, packet->green, packet->blue};
        plain &= form == EWA_COLOR_FORM_UNIT;
        for (int c = 0; c < 3; c++) {
            float *color = means->color[c] + to;
            for (uint32_t i = 0; i < LANES && form == EWA_COLOR_FORM_UNIT; i++) color[i] = (float)codes[c][i] * (1.0f / 65535);
            for (uint32_t i = 0; i < LANES && form != EWA_COLOR_FORM_UNIT; i++)
                color[i] = (float)ewa_color_decode_code(form, codes[c][i]);
        }
        const uint32_t clipped = fine->clip_masks ? fine->clip_masks[window->first + k] : 0;
        for (uint32_t i = 0; i < LANES; i++) means->clipped[to + i] = (float)(clipped >> i & 1);
        for (uint32_t i = 0; i < LANES; i++) means->opacity[to + i] = fine->opacities ? (float)fine->opacities[lane + i] / 65535 : 1;
        for (uint32_t i = 0; i < LANES; i++) {
            const float root = fine->ellipses ? (float)packet->ratio[i] / 65535 : 1;
            means->aspect[to + i] = root * root * (root * root);
        }
        for (uint32_t i = 0; i < LANES; i++)
            means->curvature[to + i] = fine->curvatures ? (float)ewa_packet_decode_curvature(fine->curvatures[lane + i]) : 0;
    }
    return plain;
}

/// The clip lines of a member, at the same places in the world seen from another centre in its plane.
static void move_clip(const ewa_surfels *fine, uint32_t index, uint32_t lane, ewa_vec3 moved,
                      ewa_surfel_clip *clip) {
    const uint32_t before = fine->clip_masks[index] & ((1u << lane) - 1);
    *clip = fine->clips[fine->clip_first[index] + (uint32_t)__builtin_popcount(before)];
    for (int k = 0; k < 2; k++) {
        const float *t = clip->toward[k];
        const ewa_vec3 toward = vec3_make((double)t[0], (double)t[1], (double)t[2]);
        clip->offset[k] = (float)((double)clip->offset[k] + vec3_dot(toward, moved));
    }
}

/// Some groups of a window, up to sixteen from surfel `*first` of its order on, of which it has `surfels`; moves `*first` on.
static void take_groups(const level_job *job, const ewa_window *window, uint32_t *first, uint32_t surfels, ewa_groups *groups) {
    const uint8_t *order = job->order + (size_t)window->first * LANES;
    for (groups->count = 0; groups->count < LANES && *first < surfels; groups->count++) {
        const uint32_t next = group_end(job->starts + window->first, *first, surfels), size = next - *first;
        for (uint32_t m = 0; m < EWA_GROUP_SURFELS; m++)
            groups->lanes[m][groups->count] = order[*first + (m < size ? m : 0)];
        groups->sizes[groups->count] = (float)size;
        *first = next;
    }
    for (uint32_t i = groups->count; i < LANES; i++) {
        for (uint32_t m = 0; m < EWA_GROUP_SURFELS; m++) groups->lanes[m][i] = groups->lanes[m][0];
        groups->sizes[i] = groups->sizes[0];
    }
}

/// A curvature by which splats at contours do not leave those beside them, however large they are.
static double limited_bend(double curvature, double sigma) {
    const double largest = sigma > 0 ? MAX_BEND / sigma : 0;
    return fabs(curvature) > largest ? copysign(largest, curvature) : curvature;
}

/// Makes surfels of what kernels say of groups.
static void take_representatives(const level_job *job, const ewa_window *window, const ewa_groups *groups,
                                 const ewa_representatives *from, representative *made) {
    const ewa_surfels *fine = job->fine;
    const ewa_vec3 base = ewa_packet_center(fine, window->first);
    for (uint32_t i = 0; i < groups->count; i++, made++) {
        const uint32_t pick = (uint32_t)from->pick[i], index = window->first + pick / LANES, lane = pick % LANES;
        const ewa_packet *packet = &fine->packets[index];
        made->center = vec3_add(base, vec3_make((double)from->place[0][i], (double)from->place[1][i], (double)from->place[2][i]));
        made->normal = vec3_make((double)from->normal[0][i], (double)from->normal[1][i], (double)from->normal[2][i]);
        made->sigma = (double)from->sigma[i];
        for (int c = 0; c < 3; c++) made->color[c] = (double)from->color[c][i];
        made->opacity = (double)from->opacity[i];
        made->curvature = limited_bend((double)from->curvature[i], made->sigma);
        made->ratio = packet->ratio[lane];
        made->billboard = fine->billboards;
        for (uint32_t m = 0; m < EWA_GROUP_SURFELS && made->billboard; m++) {
            const uint32_t member = (uint32_t)groups->lanes[m][i];
            made->billboard = fine->packets[window->first + member / LANES].oct_x[member % LANES] == EWA_BILLBOARD;
        }
        made->clipped = fine->clip_masks && fine->clip_masks[index] >> lane & 1;
        if (made->clipped) {
            const ewa_vec3 moved =
                vec3_make((double)from->moved[0][i], (double)from->moved[1][i], (double)from->moved[2][i]);
            move_clip(fine, index, lane, moved, &made->clip);
        }
        made->material = fine->materials ? fine->materials[(size_t)index * LANES + lane] : fine->material;
        if (made->ratio != UINT16_MAX) {
            ewa_packet_surfel decoded;
            ewa_packet_decode(fine, index, lane, &decoded);
            made->axis_u = decoded.axis_u;
        }
    }
}

/// Packs 1 to 16 surfels as packet `index`; all lanes behind them are like the first. Its centre becomes the
/// place that its surfels are relative to.
static void encode_packet(const level_job *job, uint32_t index, const representative *made, uint32_t count,
                          bool even, ewa_surfel_clip **clips) {
    ewa_surfels *coarse = job->coarse;
    ewa_packet *packet = &coarse->packets[index];
    float normal[3][LANES];
    double colors[LANES][3];
    uint32_t clip_mask = 0;
    for (uint32_t i = 0; i < LANES; i++) {
        const representative *s = &made[i < count ? i : 0];
        const ewa_vec3 way = vec3_sub(s->center, made[0].center);
        packet->x[i] = (float)way.x, packet->y[i] = (float)way.y, packet->z[i] = (float)way.z;
        packet->sigma[i] = ewa_packed_sigma(s->sigma);
        packet->ratio[i] = s->ratio;
        normal[0][i] = (float)s->normal.x, normal[1][i] = (float)s->normal.y;
        normal[2][i] = (float)s->normal.z;
        memcpy(colors[i], s->color, sizeof colors[i]);
        const size_t at = (size_t)index * LANES + i;
        if (coarse->opacities)
            coarse->opacities[at] = i < count ? (uint16_t)(s->opacity * 65535 + 0.5) : UINT16_MAX;
        if (coarse->materials) coarse->materials[at] = s->material;
        if (coarse->curvatures) coarse->curvatures[at] = ewa_packet_code_curvature(i < count ? s->curvature : 0);
        if (i < count && s->clipped) clip_mask |= 1u << i, *(*clips)++ = s->clip;
    }
    if (coarse->clip_masks) coarse->clip_masks[index] = (uint16_t)clip_mask;
    job->kernels->code_normals((const float(*)[LANES])normal, packet);
    for (uint32_t i = 0; i < LANES; i++) {
        const bool circle = packet->ratio[i] == UINT16_MAX;
        packet->angle[i] = circle ? 0 : ewa_packet_code_angle(packet, i, made[i < count ? i : 0].axis_u);
        if (made[i < count ? i : 0].billboard) packet->oct_x[i] = EWA_BILLBOARD;
    }
    const uint16_t form =
        even ? EWA_COLOR_FORM_UNIT : ewa_color_form_choose((const double(*)[3])colors, LANES);
    uint16_t *const channels[3] = {packet->red, packet->green, packet->blue};
    ewa_color_encode(form, (const double(*)[3])colors, LANES, channels);
    coarse->bounds.colors[index] = form;
    coarse->bounds.center_x[index] = made[0].center.x, coarse->bounds.center_y[index] = made[0].center.y;
    coarse->bounds.center_z[index] = made[0].center.z;
    job->lane_counts[index] = (uint8_t)count;
}

static void encode_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const level_job *job = data;
    const ewa_surfels *fine = job->fine;
    uint32_t index = job->parts[part].first_packet, pending = 0;
    ewa_surfel_clip *clips = fine->clip_masks ? job->coarse->clips + job->parts[part].first_clip : NULL;
    bool even = true; // all colours that are pending are of the plain form
    representative made[2 * LANES];
    const uint32_t end = (uint32_t)part_end(job, part);
    for (uint32_t p = part * PART_PACKETS, count; p < end; p += count) {
        ewa_window window;
        ewa_window_means means;
        count = job->windows[p] % WINDOW_SEPARATE;
        job->grouping->read(fine->packets, &fine->bounds, p, count, &window);
        if (job->windows[p] & WINDOW_SEPARATE && pending) {
            encode_packet(job, index++, made, pending, even, &clips);
            pending = 0;
        }
        const bool plain = read_means(fine, &window, &means);
        even = (even || pending == 0) && plain;
        const uint32_t surfels = surfels_of(&window);
        for (uint32_t first = 0; first < surfels;) {
            ewa_groups groups;
            ewa_representatives from;
            take_groups(job, &window, &first, surfels, &groups);
            job->grouping->represent(&window, &means, &groups, (float)fine->cutoff, (float)job->growth, &from);
            take_representatives(job, &window, &groups, &from, made + pending);
            pending += groups.count;
            if (pending < LANES) continue;
            encode_packet(job, index++, made, LANES, even, &clips);
            pending -= LANES;
            memmove(made, made + LANES, pending * sizeof *made);
            even = plain;
        }
    }
    if (pending) encode_packet(job, index, made, pending, even, &clips);
}

/// Bounds sixteen packets, fewer at the end.
static void bound_group(void *data, uint32_t group, uint32_t worker) {
    (void)worker;
    const level_job *job = data;
    const ewa_surfels *coarse = job->coarse;
    const uint64_t first = (uint64_t)group * LANES, left = coarse->packet_count - first;
    const uint32_t count = left < LANES ? (uint32_t)left : LANES;
    double starts[LANES][3];
    for (uint32_t k = 0; k < count; k++) {
        const ewa_vec3 start = ewa_packet_center(coarse, (uint32_t)first + k);
        vec3_store(start, starts[k]);
    }
    job->kernels->bound_packets(&coarse->packets[first], count, (const double(*)[3])starts,
                                (float)coarse->cutoff, (float)EWA_PACKET_REACH, &coarse->bounds, first);
    for (uint32_t k = 0; k < count; k++) {
        if (coarse->billboards)
            ewa_packet_free_billboards(&coarse->packets[first + k], &coarse->bounds.cone[first + k]);
        if (job->lane_counts[first + k] < LANES)
            ewa_packet_empty_lanes(&coarse->packets[first + k], job->lane_counts[first + k]);
    }
}

/// Makes room for what the packets were counted to take.
static ewa_status allocate_level(level_job *job) {
    const ewa_surfels *fine = job->fine;
    ewa_surfels *coarse = job->coarse;
    ewa_context *context = coarse->context;
    const size_t packets = coarse->packet_count, lanes = packets * LANES;
    EWA_TRY(ewa_packets_allocate(coarse, coarse->packet_count));
    job->lane_counts = ewa_allocate(context, packets, sizeof *job->lane_counts);
    if (fine->opacities) coarse->opacities = ewa_allocate(context, lanes, sizeof *coarse->opacities);
    if (fine->materials) coarse->materials = ewa_allocate(context, lanes, sizeof *coarse->materials);
    if (fine->curvatures) coarse->curvatures = ewa_allocate(context, lanes, sizeof *coarse->curvatures);
    if (fine->clip_masks) {
        coarse->clip_masks = ewa_allocate(context, packets, sizeof *coarse->clip_masks);
        coarse->clip_first = ewa_allocate(context, packets, sizeof *coarse->clip_first);
        coarse->clips = ewa_allocate(context, coarse->clip_count, sizeof *coarse->clips);
    }
    const bool made = job->lane_counts && (!fine->opacities || coarse->opacities) &&
                      (!fine->materials || coarse->materials) && (!fine->curvatures || coarse->curvatures) &&
                      (!fine->clip_masks || (coarse->clip_masks && coarse->clip_first && coarse->clips));
    return made ? EWA_OK : EWA_ERROR_MEMORY;
}

static ewa_status encode_level(level_job *job) {
    ewa_surfels *coarse = job->coarse;
    ewa_context *context = coarse->context;
    ewa_status status = allocate_level(job);
    if (status == EWA_OK) {
        ewa_parallel(context, encode_part, job, job->part_count);
        ewa_parallel(context, bound_group, job, (coarse->packet_count + LANES - 1) / LANES);
        uint32_t clips = 0;
        for (uint32_t p = 0; coarse->clip_masks && p < coarse->packet_count; p++) {
            coarse->clip_first[p] = clips;
            clips += (uint32_t)__builtin_popcount(coarse->clip_masks[p]);
        }
        coarse->unit_coverage = ewa_packets_unit_coverage(coarse);
        ewa_packets_sum_up(coarse);
    }
    ewa_release(context, job->lane_counts, coarse->packet_count, sizeof *job->lane_counts);
    return status;
}

/// Makes the level behind `fine`, if that is worth it.
static ewa_status make_level(ewa_surfels *fine, double growth) {
    ewa_context *context = fine->context;
    const uint32_t parts = (fine->packet_count + PART_PACKETS - 1) / PART_PACKETS;
    level_job job = {.fine = fine,
                     .kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pack_kernels),
                     .grouping = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_group_kernels),
                     .growth = growth,
                     .part_count = parts};
    job.order = ewa_allocate(context, (size_t)fine->packet_count * LANES, sizeof *job.order);
    job.starts = ewa_allocate(context, fine->packet_count, sizeof *job.starts);
    job.windows = ewa_allocate(context, fine->packet_count, sizeof *job.windows);
    job.parts = ewa_allocate(context, parts, sizeof *job.parts);
    job.coarse = ewa_allocate_zeroed(context, 1, sizeof *job.coarse);
    if (job.coarse) job.coarse->context = context;
    const bool room = job.order && job.starts && job.windows && job.parts && job.coarse;
    ewa_status status = room ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) {
        ewa_surfels *coarse = job.coarse;
        coarse->material = fine->material, coarse->max_material = fine->max_material;
        coarse->unit = fine->unit, coarse->cutoff = fine->cutoff, coarse->ellipses = fine->ellipses;
        coarse->billboards = fine->billboards;
        coarse->extent = fine->extent;
        memcpy(coarse->origin_world, fine->origin_world, sizeof coarse->origin_world);
        ewa_parallel(context, count_part, &job, parts);
        place_parts(&job);
        const bool worth = coarse->count >= EWA_LEVEL_MIN_SURFELS && coarse->count <= fine->count / 2;
        if (worth) status = encode_level(&job);
        if (worth && status == EWA_OK) fine->coarser = coarse;
    }
    ewa_release(context, job.order, (size_t)fine->packet_count * LANES, sizeof *job.order);
    ewa_release(context, job.starts, fine->packet_count, sizeof *job.starts);
    ewa_release(context, job.windows, fine->packet_count, sizeof *job.windows);
    ewa_release(context, job.parts, parts, sizeof *job.parts);
    if (!fine->coarser) ewa_surfels_destroy(&job.coarse);
    return status;
}

ewa_status ewa_levels_make(ewa_surfels *surfels, uint32_t level_count) {
    for (uint32_t level = 1; level < level_count; level++) {
        // What grew once stays grown: areas add up.
        EWA_TRY(make_level(surfels, level == 1 ? EWA_LEVEL_GROWTH : 1));
        if (!surfels->coarser) return EWA_OK;
        surfels = surfels->coarser;
    }
    return EWA_OK;
}

const ewa_surfels *ewa_levels_find(const ewa_surfels *surfels, uint32_t *level) {
    const uint32_t wanted = *level;
    for (*level = 0; *level < wanted && surfels->coarser; ++*level) surfels = surfels->coarser;
    return surfels;
}
