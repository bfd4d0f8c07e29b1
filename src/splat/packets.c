// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a cloud to packets: Morton order, sixteen surfels at a time, encoded as src/kernels/packet.h says.
//
// Octahedral normals: Meyer et al., "On Floating-Point Normal Vectors", 2010. Tangent frame: Duff et al.,
// "Building an Orthonormal Basis, Revisited", 2017.
#include "splat/packets.h"
#include "base/base.h"
#include "cloud/morton.h"
#include "kernels/semantics.h"
#include "splat/discs.h"
#include "splat/extras.h"
#include "splat/options.h"
#include "splat/pack.h"
#include "splat/surfel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LANES = EWA_PACKET_LANES,
    READ_BLOCK = 256,
    MAX_PARTS = 64,
    PREFETCH_POINTS = 64, // between asking for a point's numbers and reading them: four packets
    TIE_BLOCK = 64,       // points that are looked at together for ties, which are rare
};

/// What one part of the cloud contributes to the facts about the whole.
typedef struct part_facts {
    uint64_t drawable_count;
    double low[3], high[3];
    double color_low[3], color_high[3];
    bool ellipses;
} part_facts;

typedef struct build {
    ewa_surfel_reader reader;
    ewa_discs discs;
    bool are_discs; // `discs` can be used
    const ewa_pack_kernels *kernels;
    uint16_t color_codes[3][256], grey_codes[3]; // of discs
    uint64_t point_count;
    uint32_t parts;
    uint8_t *drawable; // per point
    part_facts facts[MAX_PARTS];
    uint32_t *order; // drawable points in packet order
    ewa_surfels *surfels;
} build;

/// As fmin() and fmax() of numbers, without the calls.
static inline double least(double a, double b) { return a < b ? a : b; }
static inline double most(double a, double b) { return a > b ? a : b; }

/// Surveys discs, whose colours are within [0, 1].
static void survey_discs(build *b, uint32_t part) {
    const uint64_t first = ewa_split(b->point_count, b->parts, part),
                   end = ewa_split(b->point_count, b->parts, part + 1);
    ewa_disc_facts discs;
    ewa_discs_survey(&b->discs, first, end - first, b->drawable + first, &discs);
    part_facts *facts = &b->facts[part];
    *facts = (part_facts){.drawable_count = discs.drawable_count};
    for (int c = 0; c < 3; c++) {
        facts->low[c] = discs.low_world[c], facts->high[c] = discs.high_world[c];
        facts->color_low[c] = 0, facts->color_high[c] = 1;
    }
}

static void survey_surfels(build *b, uint32_t part) {
    part_facts facts = {.low = {INFINITY, INFINITY, INFINITY},
                        .high = {-INFINITY, -INFINITY, -INFINITY},
                        .color_low = {INFINITY, INFINITY, INFINITY},
                        .color_high = {-INFINITY, -INFINITY, -INFINITY}};
    ewa_surfel surfels[READ_BLOCK];
    bool drawable[READ_BLOCK];
    const uint64_t end = ewa_split(b->point_count, b->parts, part + 1);
    for (uint64_t first = ewa_split(b->point_count, b->parts, part); first < end; first += READ_BLOCK) {
        const uint64_t count = end - first < READ_BLOCK ? end - first : READ_BLOCK;
        facts.drawable_count += ewa_surfel_read(&b->reader, first, count, surfels, drawable);
        for (uint64_t i = 0; i < count; i++) {
            b->drawable[first + i] = drawable[i];
            if (!drawable[i]) continue;
            const ewa_surfel *s = &surfels[i];
            double u2 = 0, v2 = 0;
            for (int c = 0; c < 3; c++) {
                facts.low[c] = least(facts.low[c], s->center_world[c]);
                facts.high[c] = most(facts.high[c], s->center_world[c]);
                facts.color_low[c] = least(facts.color_low[c], s->color_linear[c]);
                facts.color_high[c] = most(facts.color_high[c], s->color_linear[c]);
                u2 += s->axis_u_world[c] * s->axis_u_world[c];
                v2 += s->axis_v_world[c] * s->axis_v_world[c];
            }
            facts.ellipses |= v2 < u2 * (1 - 1e-5);
        }
    }
    b->facts[part] = facts;
}

static void survey_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    build *b = data;
    if (b->are_discs)
        survey_discs(b, part);
    else
        survey_surfels(b, part);
}

/// Joins the parts' facts and fixes local origin and colour range.
static void settle(build *b) {
    ewa_surfels *s = b->surfels;
    part_facts all = b->facts[0];
    for (uint32_t part = 1; part < b->parts; part++) {
        const part_facts *f = &b->facts[part];
        all.drawable_count += f->drawable_count;
        all.ellipses |= f->ellipses;
        for (int c = 0; c < 3; c++) {
            all.low[c] = least(all.low[c], f->low[c]);
            all.high[c] = most(all.high[c], f->high[c]);
            all.color_low[c] = least(all.color_low[c], f->color_low[c]);
            all.color_high[c] = most(all.color_high[c], f->color_high[c]);
        }
    }
    s->count = (uint32_t)all.drawable_count;
    s->left_out_count = b->point_count - all.drawable_count;
    s->ellipses = all.ellipses;
    s->extent.finite_count = all.drawable_count;
    for (int c = 0; c < 3; c++) {
        s->extent.low_world[c] = all.low[c];
        s->extent.high_world[c] = all.high[c];
        s->origin_world[c] = s->count ? 0.5 * all.low[c] + 0.5 * all.high[c] : 0;
        // Colours of [0, 1] share one code, so that equal colours of two clouds stay equal.
        const double low = s->count ? least(all.color_low[c], 0) : 0,
                     high = s->count ? most(all.color_high[c], 1) : 1;
        s->color_offset[c] = (float)low;
        s->color_scale[c] = (float)((high - low) / 65535);
    }
}

static ewa_vec3 oct_decode(int16_t code_x, int16_t code_y) {
    const double u = code_x / 32767.0, v = code_y / 32767.0, z = 1 - fabs(u) - fabs(v), fold = fmax(-z, 0);
    const ewa_vec3 n = vec3_make(u - (u < 0 ? -fold : fold), v - (v < 0 ? -fold : fold), z);
    return vec3_scale(n, 1 / vec3_length(n));
}

/// Two unit vectors that complete n to a right-handed frame.
static void packet_frame(ewa_vec3 n, ewa_vec3 *first, ewa_vec3 *second) {
    const double sign = n.z < 0 ? -1 : 1, a = -1 / (sign + n.z), b = n.x * n.y * a;
    *first = vec3_make(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *second = vec3_make(b, sign + n.y * n.y * a, -n.y);
}

/// The diamond angle in [0, 2) of an axis in the frame of the lane's normal: 1 - c / (|c| + t).
static uint16_t encode_angle(const ewa_packet *packet, uint32_t lane, ewa_vec3 axis) {
    ewa_vec3 first, second;
    packet_frame(oct_decode(packet->oct_x[lane], packet->oct_y[lane]), &first, &second);
    double c = vec3_dot(axis, first), t = vec3_dot(axis, second);
    if (t < 0) c = -c, t = -t; // the axis has no sign
    const double sum = fabs(c) + t;
    return (uint16_t)((uint32_t)((sum > 0 ? 1 - c / sum : 0) * 32768 + 0.5) & 0xffff);
}

void ewa_packets_encode_color(const ewa_surfels *surfels, const double color_linear[3], uint16_t codes[3]) {
    for (int k = 0; k < 3; k++) {
        const double value =
            (color_linear[k] - (double)surfels->color_offset[k]) / (double)surfels->color_scale[k];
        codes[k] = (uint16_t)(least(most(value, 0), 65535) + 0.5);
    }
}

void ewa_packet_decode(const ewa_surfels *surfels, uint32_t index, uint32_t lane, ewa_packet_surfel *surfel) {
    const ewa_packet *packet = &surfels->packets[index];
    surfel->center = vec3_make((double)packet->x[lane], (double)packet->y[lane], (double)packet->z[lane]);
    surfel->normal = oct_decode(packet->oct_x[lane], packet->oct_y[lane]);
    ewa_vec3 first, second;
    packet_frame(surfel->normal, &first, &second);
    const double c = 1 - packet->angle[lane] / 32768.0, t = 1 - fabs(c);
    const double major = (double)packet->sigma[lane], ratio = packet->ratio[lane] / 65535.0;
    const ewa_vec3 axis = vec3_add(vec3_scale(first, c), vec3_scale(second, t));
    surfel->axis_u = vec3_scale(axis, major / sqrt(c * c + t * t));
    surfel->axis_v = vec3_scale(vec3_cross(surfel->normal, surfel->axis_u), ratio);
    const uint16_t codes[3] = {packet->red[lane], packet->green[lane], packet->blue[lane]};
    for (int k = 0; k < 3; k++)
        surfel->color[k] = codes[k] * (double)surfels->color_scale[k] + (double)surfels->color_offset[k];
    surfel->opacity = surfels->opacities ? surfels->opacities[(size_t)index * LANES + lane] / 65535.0 : 1;
}

static void put_color(ewa_packet *packet, uint32_t lane, const uint16_t codes[3]) {
    packet->red[lane] = codes[0], packet->green[lane] = codes[1], packet->blue[lane] = codes[2];
}

/// Packs discs of a cloud whose streams need no general reading.
static void encode_discs(const build *b, const uint32_t *points, uint32_t count, ewa_packet *packet) {
    float normal[3][LANES];
    ewa_discs_load(&b->discs, b->surfels->origin_world, points, count, packet, normal);
    b->kernels->code_normals(normal, packet);
    const ewa_attribute *color = b->reader.color;
    for (uint32_t lane = 0; lane < LANES; lane++) {
        if (!color) {
            put_color(packet, lane, b->grey_codes);
            continue;
        }
        const uint32_t point = points[lane < count ? lane : 0];
        const uint8_t *c = (const uint8_t *)color->data + point * color->stride_bytes;
        packet->red[lane] = b->color_codes[0][c[0]];
        packet->green[lane] = b->color_codes[1][c[1]];
        packet->blue[lane] = b->color_codes[2][c[2]];
    }
}

/// Packs any surfels.
static void encode_surfels(const build *b, const uint32_t *points, uint32_t count, ewa_packet *packet) {
    const double *origin = b->surfels->origin_world;
    ewa_surfel surfels[LANES];
    float normal[3][LANES];
    for (uint32_t i = 0; i < LANES; i++) {
        bool drawable;
        if (i < count)
            ewa_surfel_read(&b->reader, points[i], 1, &surfels[i], &drawable);
        else
            surfels[i] = surfels[0];
        const ewa_surfel *s = &surfels[i];
        const double major = vec3_length(vec3_load(s->axis_u_world)),
                     minor = vec3_length(vec3_load(s->axis_v_world));
        packet->x[i] = (float)(s->center_world[0] - origin[0]);
        packet->y[i] = (float)(s->center_world[1] - origin[1]);
        packet->z[i] = (float)(s->center_world[2] - origin[2]);
        packet->sigma[i] = (float)major;
        packet->ratio[i] = (uint16_t)(least(minor / major, 1) * 65535 + 0.5);
        for (int c = 0; c < 3; c++) normal[c][i] = (float)s->normal_world[c];
        uint16_t codes[3];
        ewa_packets_encode_color(b->surfels, s->color_linear, codes);
        put_color(packet, i, codes);
    }
    b->kernels->code_normals(normal, packet);
    for (uint32_t i = 0; i < LANES; i++) {
        const bool circle = packet->ratio[i] == 65535;
        packet->angle[i] = circle ? 0 : encode_angle(packet, i, vec3_load(surfels[i].axis_u_world));
    }
}

/// Clears the lanes from `count` on.
static void empty_lanes(ewa_packet *packet, uint32_t count) {
    for (uint32_t i = count; i < LANES; i++) {
        packet->x[i] = packet->y[i] = packet->z[i] = packet->sigma[i] = 0;
        packet->oct_x[i] = packet->oct_y[i] = 0;
        packet->angle[i] = packet->ratio[i] = packet->red[i] = packet->green[i] = packet->blue[i] = 0;
    }
}

/// Packs and bounds the sixteen packets of a group, fewer in the last one.
static void encode_group(const build *b, uint64_t group) {
    const ewa_surfels *surfels = b->surfels;
    const uint64_t first = group * LANES, packets_left = surfels->packet_count - first;
    const uint32_t packet_count = packets_left < LANES ? (uint32_t)packets_left : LANES;
    uint32_t count = LANES;
    for (uint32_t k = 0; k < packet_count; k++) {
        const uint64_t at = (first + k) * LANES, left = surfels->count - at;
        ewa_packet *packet = &surfels->packets[first + k];
        count = left < LANES ? (uint32_t)left : LANES;
        if (!b->are_discs) {
            encode_surfels(b, &b->order[at], count, packet);
            continue;
        }
        if (left >= PREFETCH_POINTS + LANES)
            for (uint32_t i = 0; i < LANES; i++)
                ewa_discs_prefetch(&b->discs, b->order[at + PREFETCH_POINTS + i]);
        encode_discs(b, &b->order[at], count, packet);
    }
    b->kernels->bound_packets(&surfels->packets[first], packet_count, (float)surfels->cutoff,
                              &surfels->bounds, first);
    empty_lanes(&surfels->packets[first + packet_count - 1], count);
}

static void encode_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const build *b = data;
    const uint64_t groups = ((uint64_t)b->surfels->packet_count + LANES - 1) / LANES;
    const uint64_t end = ewa_split(groups, b->parts, part + 1);
    for (uint64_t g = ewa_split(groups, b->parts, part); g < end; g++) encode_group(b, g);
}

/// A surfel with its point, for ordering what the Morton curve leaves in the order of the input.
typedef struct tied_surfel {
    ewa_surfel surfel;
    uint32_t point;
} tied_surfel;

static int compare_tied(const void *a, const void *b) {
    const tied_surfel *s = a, *t = b;
    const double *x = &s->surfel.center_world[0], *y = &t->surfel.center_world[0];
    for (size_t i = 0; i < sizeof(ewa_surfel) / sizeof(double); i++)
        if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
    return s->point < t->point ? -1 : s->point > t->point;
}

/// Whether some of the next TIE_BLOCK points is not told apart from the one before it.
static bool any_same(const uint16_t split_level[TIE_BLOCK]) {
    uint16_t any = 0;
    for (int i = 0; i < TIE_BLOCK; i++) any |= split_level[i] == EWA_MORTON_SAME;
    return any;
}

/// Orders runs of points that the curve does not tell apart by everything that is drawn of them.
static ewa_status order_ties(build *b, ewa_context *context, const uint16_t *split_level, uint32_t count) {
    for (uint32_t first = 0, end; first < count; first = end) {
        if (count - first > TIE_BLOCK && !any_same(&split_level[first + 1])) {
            end = first + TIE_BLOCK;
            continue;
        }
        end = first + 1;
        while (end < count && split_level[end] == EWA_MORTON_SAME) end++;
        if (end - first < 2) continue;
        tied_surfel *tied = ewa_allocate_zeroed(context, end - first, sizeof *tied);
        if (!tied) return EWA_ERROR_MEMORY;
        for (uint32_t i = first; i < end; i++) {
            tied_surfel *t = &tied[i - first];
            bool drawable;
            ewa_surfel_read(&b->reader, b->order[i], 1, &t->surfel, &drawable);
            if (!drawable) memset(&t->surfel, 0, sizeof t->surfel);
            t->point = b->order[i];
        }
        qsort(tied, end - first, sizeof *tied, compare_tied);
        for (uint32_t i = first; i < end; i++) b->order[i] = tied[i - first].point;
        ewa_release(context, tied, end - first, sizeof *tied);
    }
    return EWA_OK;
}

/// Fills b->order with the drawable points in packet order.
static ewa_status order_points(build *b, ewa_context *context) {
    const uint32_t count = (uint32_t)b->point_count;
    uint16_t *split_level = ewa_allocate(context, count, sizeof *split_level);
    if (!split_level) return EWA_ERROR_MEMORY;
    // The sort may use the packets' memory before there are packets.
    ewa_surfels *surfels = b->surfels;
    const bool fits = surfels->packet_count * sizeof *surfels->packets >= ewa_morton_room_bytes(count);
    ewa_bounds box = surfels->extent;
    for (int c = 0; c < 3; c++) {
        box.low_world[c] -= b->reader.origin_world[c];
        box.high_world[c] -= b->reader.origin_world[c];
    }
    ewa_status status = ewa_morton_order_in(context, b->reader.position, count, &box,
                                            fits ? surfels->packets : NULL, b->order, split_level);
    if (status == EWA_OK) status = order_ties(b, context, split_level, count);
    if (status == EWA_OK && b->surfels->left_out_count) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < count; i++)
            if (b->drawable[b->order[i]]) b->order[kept++] = b->order[i];
    }
    ewa_release(context, split_level, count, sizeof *split_level);
    return status;
}

const ewa_pack_kernels *ewa_pack_kernels_choose(uint32_t features) {
    const ewa_pack_kernels *kernels = &ewa_pack_kernels_portable;
#if defined(__x86_64__)
    if (features & EWA_CPU_AVX2) kernels = &ewa_pack_kernels_avx2;
    if (features & EWA_CPU_AVX512) kernels = &ewa_pack_kernels_avx512;
#else
    (void)features;
#endif
    return kernels;
}

/// Makes tables from the colours that discs can have to their codes.
static void set_color_codes(build *b) {
    const double grey[3] = {EWA_DEFAULT_GREY, EWA_DEFAULT_GREY, EWA_DEFAULT_GREY};
    ewa_packets_encode_color(b->surfels, grey, b->grey_codes);
    for (int value = 0; value < 256; value++) {
        const double linear = b->reader.colors.linear_from_u8[value], color[3] = {linear, linear, linear};
        uint16_t codes[3];
        ewa_packets_encode_color(b->surfels, color, codes);
        for (int k = 0; k < 3; k++) b->color_codes[k][value] = codes[k];
    }
}

void ewa_packets_view_bounds(ewa_surfels *surfels) {
    float **const streams[EWA_BOUNDS_STREAMS] = {&surfels->bounds.center_x, &surfels->bounds.center_y,
                                                 &surfels->bounds.center_z, &surfels->bounds.radius,
                                                 &surfels->bounds.axis_x,   &surfels->bounds.axis_y,
                                                 &surfels->bounds.axis_z,   &surfels->bounds.cone_sine};
    for (int i = 0; i < EWA_BOUNDS_STREAMS; i++)
        *streams[i] = surfels->bounds_floats + i * surfels->bounds_stride;
}

static ewa_status allocate_packets(ewa_surfels *surfels) {
    ewa_context *context = surfels->context;
    surfels->packet_count = (uint32_t)(((uint64_t)surfels->count + LANES - 1) / LANES);
    surfels->bounds_stride = ((size_t)surfels->packet_count + LANES - 1) / LANES * LANES;
    surfels->packets = ewa_allocate(context, surfels->packet_count, sizeof *surfels->packets);
    surfels->bounds_floats = ewa_allocate_zeroed(context, EWA_BOUNDS_STREAMS * surfels->bounds_stride,
                                                 sizeof *surfels->bounds_floats);
    if (!surfels->packets || !surfels->bounds_floats) return EWA_ERROR_MEMORY;
    ewa_packets_view_bounds(surfels);
    return EWA_OK;
}

static ewa_status build_surfels(build *b, ewa_context *context) {
    b->drawable = ewa_allocate(context, b->point_count, sizeof *b->drawable);
    b->order = ewa_allocate(context, b->point_count, sizeof *b->order);
    if (!b->drawable || !b->order) return EWA_ERROR_MEMORY;
    b->kernels = ewa_pack_kernels_choose(ewa_context_cpu_features(context));
    b->are_discs = ewa_discs_open(&b->reader, b->kernels, &b->discs);
    ewa_parallel(context, survey_part, b, b->parts);
    settle(b);
    if (b->are_discs) set_color_codes(b);
    ewa_status status = allocate_packets(b->surfels);
    if (status == EWA_OK) status = order_points(b, context);
    if (status != EWA_OK) return status;
    ewa_parallel(context, encode_part, b, b->parts);
    b->surfels->unit_coverage = ewa_packets_unit_coverage(b->surfels);
    return ewa_extras_make(context, b->surfels, &b->reader, b->order);
}

ewa_status ewa_surfels_create(const ewa_cloud *cloud, const ewa_surfels_options *options,
                              ewa_surfels **surfels) {
    if (!surfels) return EWA_ERROR_ARGUMENT;
    *surfels = NULL;
    if (!cloud) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_surfels_options chosen;
    ewa_status status = ewa_surfels_options_choose(context, options, &chosen);
    if (status != EWA_OK) return status;
    build *b = ewa_allocate_zeroed(context, 1, sizeof *b);
    ewa_surfels *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!b || !made) {
        ewa_release(context, b, 1, sizeof *b);
        ewa_release(context, made, 1, sizeof *made);
        return EWA_ERROR_MEMORY;
    }
    made->context = context;
    made->cutoff = chosen.cutoff;
    b->surfels = made;
    b->point_count = ewa_cloud_point_count(cloud);
    b->parts =
        b->point_count / READ_BLOCK + 1 < MAX_PARTS ? (uint32_t)(b->point_count / READ_BLOCK + 1) : MAX_PARTS;
    status = ewa_surfel_reader_open(cloud, &chosen, &b->reader);
    if (status == EWA_OK && b->point_count > UINT32_MAX - LANES)
        status = ewa_fail(context, EWA_ERROR_LIMIT, "%llu points are more than a renderer holds",
                          (unsigned long long)b->point_count);
    if (status == EWA_OK) status = build_surfels(b, context);
    ewa_release(context, b->drawable, b->point_count, sizeof *b->drawable);
    ewa_release(context, b->order, b->point_count, sizeof *b->order);
    ewa_release(context, b, 1, sizeof *b);
    if (status == EWA_OK)
        *surfels = made;
    else
        ewa_surfels_destroy(&made);
    return status;
}

void ewa_surfels_destroy(ewa_surfels **surfels) {
    if (!surfels || !*surfels) return;
    ewa_surfels *old = *surfels;
    ewa_context *context = old->context;
    ewa_release(context, old->packets, old->packet_count, sizeof *old->packets);
    ewa_extras_free(context, old);
    ewa_release(context, old->bounds_floats, EWA_BOUNDS_STREAMS * old->bounds_stride,
                sizeof *old->bounds_floats);
    ewa_release(context, old, 1, sizeof *old);
    *surfels = NULL;
}

void ewa_surfels_describe(const ewa_surfels *surfels, ewa_surfels_info *info) {
    *info = (ewa_surfels_info){
        .point_count = surfels->count,
        .left_out_count = surfels->left_out_count,
        .resident_bytes = sizeof *surfels + surfels->packet_count * sizeof *surfels->packets +
                          EWA_BOUNDS_STREAMS * surfels->bounds_stride * sizeof *surfels->bounds_floats +
                          ewa_extras_bytes(surfels),
        .unit_coverage = surfels->unit_coverage,
        .transparent = surfels->opacities != NULL,
        .bounds = surfels->extent,
        .material_count = (uint32_t)surfels->most_material + 1,
    };
}
