// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Groups of neighbouring surfels, by a tree of planes, and what stands for them: a surfel of docs/math.md section 2 that keeps the
// sum of kernels of section 7.
//
// Four surfels in a row along the Morton curve would do on a grid, but the curve jumps: what stands for surfels
// on both sides of a jump lies between them, and leaves holes where they were. Of 64 in a row, few are near a
// jump.
//
// All nodes of one depth of the tree are sorted at once, by counting, for each surfel, how many are below it: no comparison
// decides what is done next, which would be guessed wrong every other time.
#include "surface/groups.h"
#include "surface/semantics.h"
#include "wide/wide_octahedral.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum {
    LANES = EWA_PACKET_LANES,
    WINDOW = EWA_WINDOW_LANES,
    BLOCKS = EWA_WINDOW_PACKETS,
    ROW = 4, ///< numbers of a surfel's row: three axes, and none
    LANE_BITS = 6, STEP_BITS = 17, ///< of a sort key, from its end; the node is before them
    SMALLEST = 0x00800000, ///< added to sort keys, which are compared as floats, for these to be normal
};

_Static_assert(WINDOW <= 1 << LANE_BITS, "a window's lanes have so many bits");

/// Neighbours are closer than that, in support radii: the default radius is 1.14 spacings.
static const float GAP = 2.25f;

/// Support radii per unit of a normal: where faces meet at right angles and more, that is a gap.
static const float NORMAL_RADII = 2.3f;

/// Of a key: beyond, all places are alike.
static const float FARTHEST = 1e9f;

/// Mean normals shorter than that say nothing.
static const float SOUND_NORMAL = 0.5f;

/// Steps of a sort key along an axis.
static const float STEPS = (1 << STEP_BITS) - 1;

typedef struct divider {
    float places[ROW * WINDOW + LANES], normals[ROW * WINDOW + LANES]; ///< in support radii, in their order; filled behind
    bool with_normals;                                 ///< they differ
    uint8_t *order;
    uint16_t *starts;
    uint32_t group_count;
} divider;

/// Surfels of the order that are to be divided.
typedef struct node {
    uint8_t first, end;
    uint8_t sorted; ///< where they begin among all that are sorted
    bool by_normal;
    uint8_t axis;
    float low, extent; ///< along the axis
} node;

static void read_window(const ewa_packet *packets, const ewa_packet_bounds *bounds, uint32_t first,
                        uint32_t packet_count, ewa_window *window) {
    window->first = first, window->packet_count = packet_count;
    const double *const centers[3] = {bounds->center_x, bounds->center_y, bounds->center_z};
    for (uint32_t k = 0; k < packet_count; k++) {
        const ewa_packet *packet = &packets[first + k];
        const float *const places[3] = {packet->x, packet->y, packet->z};
        wf normal[3];
        decode_normals(packet->oct_x, packet->oct_y, normal);
        for (int c = 0; c < 3; c++) {
            const wf from = wf_set((float)(centers[c][first + k] - centers[c][first]));
            wf_store(window->place[c] + k * LANES, wf_add(wf_load(places[c]), from));
            wf_store(window->normal[c] + k * LANES, normal[c]);
        }
        wf_store(window->sigma + k * LANES, wf_load(packet->sigma));
    }
}

/// Widens a node to the axis of these rows along which it reaches farthest.
static inline void find_widest(const float *rows, bool by_normal, node *of) {
    enum { ROWS = LANES / ROW };
    const uint32_t count = (uint32_t)(of->end - of->first);
    const float *from = rows + ROW * (size_t)of->first;
    wf lows = wf_set(INFINITY), highs = wf_set(-INFINITY);
    for (uint32_t i = 0; i < count; i += ROWS) {
        const uint32_t left = count - i < ROWS ? count - i : ROWS;
        const wf four = wf_load(from + ROW * (size_t)i);
        const wm there = wm_of_bits((1u << ROW * left) - 1);
        lows = wf_min(wf_select(there, four, lows), lows), highs = wf_max(wf_select(there, four, highs), highs);
    }
    float low[LANES], high[LANES], minimum[3];
    wf_store(low, lows), wf_store(high, highs);
    uint32_t widest = 0; // its upper bits and the axis, which needs no guesses
    for (uint32_t c = 0; c < 3; c++) {
        float l = low[c], h = high[c];
        for (uint32_t i = c + ROW; i < LANES; i += ROW) {
            l = low[i] < l ? low[i] : l;
            h = high[i] > h ? high[i] : h;
        }
        const float extent = h - l;
        uint32_t bits;
        memcpy(&bits, &extent, sizeof bits);
        bits = (bits & ~UINT32_C(3)) | c;
        minimum[c] = l;
        widest = bits > widest ? bits : widest;
    }
    const uint32_t axis = widest & 3, bits = widest & ~UINT32_C(3);
    float extent;
    memcpy(&extent, &bits, sizeof extent);
    if (!(extent > of->extent)) return;
    of->by_normal = by_normal, of->axis = (uint8_t)axis, of->low = minimum[axis], of->extent = extent;
}

/// The sort keys of nodes: their number, the place along their axis, the lane. Returns how many there are.
static uint32_t make_keys(const divider *d, node *nodes, uint32_t node_count, float keys[WINDOW]) {
    float places[WINDOW], lows[WINDOW], scales[WINDOW];
    int32_t bases[WINDOW], bits[WINDOW];
    uint32_t count = 0;
    for (uint32_t n = 0; n < node_count; n++) {
        node *of = &nodes[n];
        const float *rows = (of->by_normal ? d->normals : d->places) + of->axis;
        const float scale = STEPS / (of->extent > 1e-30f ? of->extent : 1e-30f);
        of->sorted = (uint8_t)count;
        for (uint32_t i = of->first; i < of->end; i++, count++) {
            places[count] = rows[ROW * (size_t)i];
            lows[count] = of->low, scales[count] = scale;
            bases[count] = (int32_t)(SMALLEST + (n << (LANE_BITS + STEP_BITS)) + d->order[i]);
        }
    }
    for (uint32_t i = count; i % LANES; i++) places[i] = lows[i] = scales[i] = 0, bases[i] = SMALLEST;
    for (uint32_t i = 0; i < count; i += LANES) {
        const wi steps = wi_from_f(wf_mul(wf_sub(wf_load(places + i), wf_load(lows + i)), wf_load(scales + i)));
        wi_store(bits + i, wi_add(wi_shl(steps, LANE_BITS), wi_load(bases + i)));
        wf_store(keys + i, wf_of_bits(wi_load(bits + i)));
    }
    return count;
}

/// Puts keys into ascending order. No two are alike, and those of a node lie side by side, before those of the next one.
static void sort_keys(const node *nodes, uint32_t node_count, const float keys[WINDOW], uint32_t count, float sorted[WINDOW]) {
    uint32_t first[BLOCKS] = {0}, end[BLOCKS] = {0}; // of the nodes that reach into a block
    for (uint32_t n = node_count; n-- > 0;) {
        const uint32_t from = nodes[n].sorted, to = from + nodes[n].end - nodes[n].first;
        for (uint32_t b = from / LANES; b <= (to - 1) / LANES; b++) first[b] = from, end[b] = end[b] ? end[b] : to;
    }
    int32_t ranks[WINDOW];
    const wf one = wf_of_bits(wi_set(1));
    for (uint32_t b = 0; b * LANES < count; b++) {
        const wf block = wf_load(keys + b * LANES);
        wi rank = wi_set((int32_t)first[b]);
        for (uint32_t i = first[b]; i < end[b]; i++)
            rank = wi_add(rank, wi_of_bits(wf_keep(wf_lt(wf_set(keys[i]), block), one)));
        wi_store(ranks + b * LANES, rank);
    }
    for (uint32_t i = 0; i < count; i++) sorted[ranks[i]] = keys[i];
}

/// How far sorted keys are from those before them, and which they are below that.
static void find_steps(const float sorted[WINDOW], uint32_t count, int32_t steps[WINDOW], uint8_t lanes[WINDOW]) {
    int32_t bits[WINDOW + 1];
    wi at = wi_load((const int32_t[LANES]){0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
    bits[0] = 0;
    for (uint32_t i = 0; i < count; i += LANES) wi_store(bits + 1 + i, wi_of_bits(wf_load(sorted + i)));
    for (uint32_t i = 0; i < count; i += LANES) {
        const wi here = wi_load(bits + 1 + i), before = wi_load(bits + i);
        const wi step = wi_sub(wi_sar(here, LANE_BITS), wi_sar(before, LANE_BITS));
        wi_store(steps + i, wi_or(wi_shl(step, LANE_BITS), at));
        wi_store_u8(lanes + i, wi_and(here, wi_set(WINDOW - 1)));
        at = wi_add(at, wi_set(LANES));
    }
}

/// Where a node is to be divided, whose surfels are sorted; its end: nowhere.
static uint32_t find_middle(const node *of, const int32_t steps[WINDOW]) {
    const uint32_t count = (uint32_t)(of->end - of->first), groups = (count + EWA_GROUP_SURFELS - 1) / EWA_GROUP_SURFELS;
    int32_t widest = 0;
    for (uint32_t i = 1; i < count; i++) widest = steps[of->sorted + i] > widest ? steps[of->sorted + i] : widest;
    if ((float)(widest >> LANE_BITS) * of->extent > GAP * STEPS)
        return (uint32_t)of->first + (uint32_t)(widest % WINDOW) - of->sorted;
    return groups == 1 ? of->end : of->first + count * (groups / 2) / groups;
}

/// Puts rows of lanes into the order.
static void order_rows(const divider *d, const float *lanes, uint32_t count, float *rows) {
    for (uint32_t i = 0; i < count; i++)
        memcpy(rows + ROW * (size_t)i, lanes + ROW * (size_t)d->order[i], ROW * sizeof *rows);
}

/// Keeps of a list of nodes those that have to be looked at closer; the others are groups.
static uint32_t close_groups(divider *d, node *nodes, uint32_t node_count) {
    uint32_t kept = 0;
    for (uint32_t n = 0; n < node_count; n++) {
        node of = nodes[n];
        of.extent = -1;
        find_widest(d->places, false, &of);
        if (d->with_normals) find_widest(d->normals, true, &of);
        if (of.end - of.first > EWA_GROUP_SURFELS || of.extent > GAP) {
            nodes[kept++] = of;
        } else {
            d->starts[of.first / LANES] |= (uint16_t)(1u << of.first % LANES);
            d->group_count++;
        }
    }
    return kept;
}

/// Divides `count` surfels, whose rows are those of lanes.
static void divide(divider *d, const float *places, const float *normals, uint32_t count) {
    node lists[2][WINDOW];
    lists[0][0] = (node){.end = (uint8_t)count};
    uint32_t node_count = 1;
    for (int list = 0; node_count; list = !list) {
        node *nodes = lists[list], *next = lists[!list];
        order_rows(d, places, count, d->places);
        if (d->with_normals) order_rows(d, normals, count, d->normals);
        const uint32_t kept = close_groups(d, nodes, node_count);
        float keys[WINDOW], sorted[WINDOW] = {0};
        int32_t steps[WINDOW];
        uint8_t lanes[WINDOW];
        const uint32_t keyed = make_keys(d, nodes, kept, keys);
        sort_keys(nodes, kept, keys, keyed, sorted);
        find_steps(sorted, keyed, steps, lanes);
        node_count = 0;
        for (uint32_t n = 0; n < kept; n++) {
            const node *of = &nodes[n];
            for (uint32_t i = of->first; i < of->end; i++) d->order[i] = lanes[of->sorted + i - of->first];
            const uint32_t middle = find_middle(of, steps);
            if (middle < of->end) {
                next[node_count++] = (node){.first = of->first, .end = (uint8_t)middle};
                next[node_count++] = (node){.first = (uint8_t)middle, .end = of->end};
            } else {
                d->starts[of->first / LANES] |= (uint16_t)(1u << of->first % LANES);
                d->group_count++;
            }
        }
    }
}

static uint32_t divide_window(const ewa_window *window, float cutoff, uint8_t order[EWA_WINDOW_LANES],
                              uint16_t starts[EWA_WINDOW_PACKETS]) {
    divider d;
    d.order = order, d.starts = starts, d.group_count = 0;
    uint32_t count = 0;
    float sigmas[LANES], sum = 0;
    wf all = wf_set(0);
    for (uint32_t k = 0; k < window->packet_count; k++) {
        const wf sigma = wf_load(window->sigma + k * LANES);
        all = wf_add(all, wf_max(sigma, wf_set(0)));
        starts[k] = 0;
        for (uint32_t i = k * LANES; i < (k + 1) * LANES; i++) order[count] = (uint8_t)i, count += window->sigma[i] > 0; // count <= i
    }
    if (!count) return 0;
    wf_store(sigmas, all);
    for (int i = 0; i < LANES; i++) sum += sigmas[i];
    const wf per_radius = wf_set((float)count / (cutoff * sum)), zero = wf_set(0), normal_radii = wf_set(NORMAL_RADII);
    float places[ROW * WINDOW], normals[ROW * WINDOW];
    wf low[3], high[3];
    float minimum[LANES], maximum[LANES], extent = 0;
    for (int c = 0; c < 3; c++) low[c] = wf_set(NORMAL_RADII), high[c] = wf_set(-NORMAL_RADII);
    for (uint32_t i = 0; i < window->packet_count * LANES; i += LANES) {
        wf place[3], normal[3];
        for (int c = 0; c < 3; c++) {
            const wf key = wf_mul(wf_load(window->place[c] + i), per_radius);
            place[c] = wf_min(wf_max(key, wf_set(-FARTHEST)), wf_set(FARTHEST)); // NaN too
            normal[c] = wf_mul(wf_load(window->normal[c] + i), normal_radii);
            low[c] = wf_min(low[c], normal[c]), high[c] = wf_max(high[c], normal[c]);
        }
        w_store4(places + ROW * (size_t)i, place[0], place[1], place[2], zero);
        w_store4(normals + ROW * (size_t)i, normal[0], normal[1], normal[2], zero);
    }
    for (int c = 0; c < 3; c++) {
        wf_store(minimum, low[c]), wf_store(maximum, high[c]);
        for (int i = 1; i < LANES; i++) {
            minimum[0] = minimum[i] < minimum[0] ? minimum[i] : minimum[0];
            maximum[0] = maximum[i] > maximum[0] ? maximum[i] : maximum[0];
        }
        extent = maximum[0] - minimum[0] > extent ? maximum[0] - minimum[0] : extent;
    }
    d.with_normals = extent > GAP;
    divide(&d, places, normals, count);
    return d.group_count;
}

static inline wf dot(const wf a[3], const wf b[3]) {
    return wf_fma(a[0], b[0], wf_fma(a[1], b[1], wf_mul(a[2], b[2])));
}

/// Ways in support radii are cut there: their squares are numbers.
static inline wf bounded(wf way) { return wf_min(wf_max(way, wf_set(-FARTHEST)), wf_set(FARTHEST)); }

/// Members of groups, by the order of these.
typedef struct group_members {
    wf place[EWA_GROUP_SURFELS][3], normal[EWA_GROUP_SURFELS][3]; ///< places in mean radii of the window
    wf sigma[EWA_GROUP_SURFELS];
    wf share[EWA_GROUP_SURFELS];    ///< of the sum of areas
    wm clipped[EWA_GROUP_SURFELS], any_clipped;
} group_members;

static inline void gather_members(const ewa_window *window, const ewa_window_means *means, const ewa_groups *groups,
                                  wf per_sigma, group_members *of) {
    const wf zero = wf_set(0), size = wf_load(groups->sizes);
    wf sum = zero;
    wm missing = wm_of_bits(0);
    of->any_clipped = missing;
    for (int m = 0; m < EWA_GROUP_SURFELS; m++) {
        const wi lane = wi_load(groups->lanes[m]);
        missing = wf_le(size, wf_set((float)m));
        for (int c = 0; c < 3; c++) {
            of->place[m][c] = bounded(wf_mul(wf_gather(window->place[c], lane), per_sigma));
            of->normal[m][c] = wf_gather(window->normal[c], lane);
        }
        of->sigma[m] = wf_mul(wf_gather(window->sigma, lane), per_sigma);
        const wf area = wf_mul(wf_mul(of->sigma[m], of->sigma[m]), wf_gather(means->aspect, lane));
        of->share[m] = wf_keep(wm_not(missing), area);
        of->clipped[m] = wf_lt(zero, wf_gather(means->clipped, lane));
        of->any_clipped = wm_or(of->any_clipped, of->clipped[m]);
        sum = wf_add(sum, of->share[m]);
    }
    // Areas may vanish where sigmas do not.
    const wm sound = wf_lt(wf_set(0x1p-120f), sum);
    for (int m = 0; m < EWA_GROUP_SURFELS; m++) {
        const wf even = wf_keep(wf_lt(wf_set((float)m), size), wf_div(wf_set(1), size));
        of->share[m] = wf_select(sound, wf_div(of->share[m], wf_select(sound, sum, wf_set(1))), even);
    }
}

/// Colour and opacity: what a pixel that all members fill alike sees.
static inline void mix_colors(const ewa_window_means *means, const ewa_groups *groups, const group_members *of,
                              ewa_representatives *made) {
    const wf zero = wf_set(0), one = wf_set(1);
    wf opaque[EWA_GROUP_SURFELS], sum = zero, color[3] = {zero, zero, zero}, curvature = zero;
    for (int m = 0; m < EWA_GROUP_SURFELS; m++) {
        opaque[m] = wf_mul(of->share[m], wf_gather(means->opacity, wi_load(groups->lanes[m])));
        sum = wf_add(sum, opaque[m]);
    }
    const wm seen = wf_lt(wf_set(0x1p-120f), sum);
    const wf safe = wf_select(seen, sum, one);
    for (int m = 0; m < EWA_GROUP_SURFELS; m++) {
        const wi lane = wi_load(groups->lanes[m]);
        const wf part = wf_select(seen, wf_div(opaque[m], safe), of->share[m]);
        for (int c = 0; c < 3; c++) color[c] = wf_fma(part, wf_gather(means->color[c], lane), color[c]);
        curvature = wf_fma(of->share[m], wf_gather(means->curvature, lane), curvature);
    }
    for (int c = 0; c < 3; c++) wf_store(made->color[c], color[c]);
    wf_store(made->opacity, wf_min(sum, one));
    wf_store(made->curvature, curvature);
}

/// The mean of the members' normals, or `own` where that says nothing or the surface is cut, whose line is in the plane of its own.
static inline void mean_normal(const group_members *of, const wf own[3], wf normal[3]) {
    const wf zero = wf_set(0);
    wf sum[3] = {zero, zero, zero};
    for (int m = 0; m < EWA_GROUP_SURFELS; m++)
        for (int c = 0; c < 3; c++) sum[c] = wf_fma(of->share[m], of->normal[m][c], sum[c]);
    const wf square = dot(sum, sum);
    wm sound = wm_and(wf_lt(wf_set(SOUND_NORMAL * SOUND_NORMAL), square), wm_not(of->any_clipped));
    for (int m = 0; m < EWA_GROUP_SURFELS; m++) sound = wm_and(sound, wf_lt(zero, dot(sum, of->normal[m])));
    const wf inverse = wf_inverse_root(wf_select(sound, square, wf_set(1)));
    for (int c = 0; c < 3; c++) normal[c] = wf_select(sound, wf_mul(sum[c], inverse), own[c]);
}

/// The member of a group that is nearest to its middle, of those with clip lines if there are any.
typedef struct nearest_member {
    wf place[3], normal[3], sigma, share, picked;
    wf distance[EWA_GROUP_SURFELS]; ///< of all, from the middle
} nearest_member;

static void find_nearest(const ewa_groups *groups, const group_members *of, const wf middle[3], nearest_member *found) {
    const wf zero = wf_set(0);
    wf nearest = wf_set(INFINITY);
    found->sigma = found->share = found->picked = zero;
    for (int c = 0; c < 3; c++) found->place[c] = found->normal[c] = zero;
    for (int m = 0; m < EWA_GROUP_SURFELS; m++) {
        wf way[3];
        for (int c = 0; c < 3; c++) way[c] = wf_sub(of->place[m][c], middle[c]);
        const wf square = dot(way, way);
        found->distance[m] = wf_sqrt(square);
        const wm nearer = wm_and(wf_lt(square, nearest), wm_or(of->clipped[m], wm_not(of->any_clipped)));
        nearest = wf_select(nearer, square, nearest);
        for (int c = 0; c < 3; c++) {
            found->place[c] = wf_select(nearer, of->place[m][c], found->place[c]);
            found->normal[c] = wf_select(nearer, of->normal[m][c], found->normal[c]);
        }
        found->sigma = wf_select(nearer, of->sigma[m], found->sigma);
        found->share = wf_select(nearer, of->share[m], found->share);
        found->picked = wf_select(nearer, wf_of_bits(wi_load(groups->lanes[m])), found->picked);
    }
}

static void represent(const ewa_window *window, const ewa_window_means *means, const ewa_groups *groups, float cutoff,
                      float growth, ewa_representatives *made) {
    const wf zero = wf_set(0);
    // By the mean sigma, whose square is a number.
    wf all = zero;
    float sigmas[LANES], sigma_sum = 0, count = 0;
    for (uint32_t i = 0; i < window->packet_count * LANES; i += LANES) {
        const wf sigma = wf_load(window->sigma + i);
        all = wf_add(all, wf_max(sigma, zero));
        count += (float)__builtin_popcount(wm_bits(wf_lt(zero, sigma)));
    }
    wf_store(sigmas, all);
    for (int i = 0; i < LANES; i++) sigma_sum += sigmas[i];
    const wf unit = wf_set(sigma_sum / count), per_sigma = wf_set(count / sigma_sum);
    group_members of;
    gather_members(window, means, groups, per_sigma, &of);
    mix_colors(means, groups, &of, made);
    wf middle[3] = {zero, zero, zero};
    for (int m = 0; m < EWA_GROUP_SURFELS; m++)
        for (int c = 0; c < 3; c++) middle[c] = wf_fma(of.share[m], of.place[m][c], middle[c]);
    nearest_member own;
    find_nearest(groups, &of, middle, &own);
    wf normal[3];
    mean_normal(&of, own.normal, normal);
    wf reach = zero, height = zero, spread = zero, raised = zero, square = zero;
    for (int m = 0; m < EWA_GROUP_SURFELS; m++) {
        wf way[3];
        for (int c = 0; c < 3; c++) way[c] = wf_sub(of.place[m][c], middle[c]);
        height = wf_max(height, wf_abs(dot(way, normal)));
        spread = wf_max(spread, own.distance[m]);
        // Where surfels lie upon each other the area is not that of what they cover.
        reach = wf_max(reach, wf_fma(wf_set(4 / cutoff), own.distance[m], of.sigma[m]));
        // How far the surface lies above the middle: half of what the members' planes are above it, which is exact where it
        // bends evenly.
        raised = wf_fma(wf_mul(of.share[m], wf_set(0.5f)), dot(of.normal[m], way), raised);
        square = wf_fma(of.share[m], wf_mul(own.distance[m], own.distance[m]), square);
    }
    const wf limit = wf_mul(wf_sqrt(square), wf_set(0.5f)), curvature = wf_load(made->curvature);
    const wm bent = wm_or(wf_lt(curvature, zero), wf_lt(zero, curvature));
    raised = wf_keep(bent, wf_min(wf_max(raised, wf_sub(zero, limit)), limit));
    const wf kept = wf_div(own.sigma, wf_sqrt(wf_max(own.share, wf_set(0x1p-100f))));
    const wf grown = wf_mul(wf_max(kept, wf_mul(spread, wf_set((float)(1 / EWA_LEVEL_SPREAD)))), wf_set(growth));
    const wf made_sigma = wf_max(own.sigma, wf_min(grown, reach));
    const wm on_surface = wf_le(height, made_sigma);
    wf moved[3];
    for (int c = 0; c < 3; c++) moved[c] = wf_fma(normal[c], raised, wf_sub(middle[c], own.place[c]));
    const wf above = wf_keep(of.any_clipped, dot(moved, own.normal));
    wi_store(made->pick, wi_of_bits(own.picked));
    // What did not grow keeps its sigma to the last bit.
    wf_store(made->sigma, wf_mul(wf_gather(window->sigma, wi_of_bits(own.picked)), wf_div(made_sigma, own.sigma)));
    for (int c = 0; c < 3; c++) {
        const wf way = wf_mul(wf_keep(on_surface, wf_fnma(own.normal[c], above, moved[c])), unit);
        wf_store(made->moved[c], way);
        wf_store(made->place[c], wf_add(wf_gather(window->place[c], wi_of_bits(own.picked)), way));
        wf_store(made->normal[c], normal[c]);
    }
}

const ewa_group_kernels EWA_VERSION(ewa_group_kernels) = {read_window, divide_window, represent};
