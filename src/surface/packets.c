// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From a cloud to packets: Morton order, sixteen surfels at a time, encoded as src/surface/packet.h says.
//
// Octahedral normals: Meyer et al., "On Floating-Point Normal Vectors", 2010. Tangent frame: Duff et al.,
// "Building an Orthonormal Basis, Revisited", 2017.
#include "surface/packets.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/morton.h"
#include "surface/color_form.h"
#include "surface/discs.h"
#include "surface/extras.h"
#include "surface/levels.h"
#include "surface/options.h"
#include "surface/pack.h"
#include "surface/packet_order.h"
#include "surface/semantics.h"

#include <math.h>
#include <string.h>

enum {
    LANES = EWA_PACKET_LANES,
    READ_BLOCK = 256,
    MAX_PARTS = 64,
    PREFETCH_POINTS = 64, // between asking for a point's numbers and reading them: four packets
};

/// What one part of the cloud contributes to the facts about the whole.
typedef struct part_facts {
    uint64_t drawable_count;
    double low[3], high[3];
    bool ellipses;
} part_facts;

typedef struct build {
    ewa_surfel_reader reader;
    ewa_discs discs;
    bool are_discs; // `discs` can be used
    bool keep_points;
    const ewa_pack_kernels *kernels;
    uint16_t color_codes[256], grey_code; // of discs
    uint64_t point_count;
    uint32_t parts;
    uint8_t *drawable; // per point
    part_facts facts[MAX_PARTS];
    ewa_packet_order order;
    uint8_t *wide; // [packet]: whether it reaches too far
    ewa_surfels *surfels;
} build;

/// As fmin() and fmax() of numbers, without the calls.
static inline double minimum(double a, double b) { return a < b ? a : b; }
static inline double maximum(double a, double b) { return a > b ? a : b; }

static void measure_discs(build *b, uint32_t part) {
    const uint64_t first = ewa_split(b->point_count, b->parts, part),
                   end = ewa_split(b->point_count, b->parts, part + 1);
    ewa_disc_facts discs;
    ewa_discs_measure(&b->discs, first, end - first, b->drawable + first, &discs);
    part_facts *facts = &b->facts[part];
    *facts = (part_facts){.drawable_count = discs.drawable_count};
    for (int c = 0; c < 3; c++) facts->low[c] = discs.low[c], facts->high[c] = discs.high[c];
}

static void measure_surfels(build *b, uint32_t part) {
    part_facts facts = {.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
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
                facts.low[c] = minimum(facts.low[c], s->center[c]);
                facts.high[c] = maximum(facts.high[c], s->center[c]);
                u2 += s->axis_u_world[c] * s->axis_u_world[c];
                v2 += s->axis_v_world[c] * s->axis_v_world[c];
            }
            facts.ellipses |= v2 < u2 * (1 - 1e-5);
        }
    }
    b->facts[part] = facts;
}

static void measure_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    build *b = data;
    if (b->are_discs)
        measure_discs(b, part);
    else
        measure_surfels(b, part);
}

/// Joins the parts' facts and fixes the origin.
static void join_facts(build *b) {
    ewa_surfels *s = b->surfels;
    part_facts all = b->facts[0];
    for (uint32_t part = 1; part < b->parts; part++) {
        const part_facts *f = &b->facts[part];
        all.drawable_count += f->drawable_count;
        all.ellipses |= f->ellipses;
        for (int c = 0; c < 3; c++) {
            all.low[c] = minimum(all.low[c], f->low[c]);
            all.high[c] = maximum(all.high[c], f->high[c]);
        }
    }
    s->count = (uint32_t)all.drawable_count;
    s->left_out_count = b->point_count - all.drawable_count;
    s->ellipses = all.ellipses;
    s->billboards = b->reader.surfaceness;
    s->colored = b->reader.color;
    s->extent.finite_count = all.drawable_count;
    memcpy(s->extent.low_world, all.low, sizeof all.low);
    memcpy(s->extent.high_world, all.high, sizeof all.high);
    memcpy(s->origin_world, b->reader.origin_world, sizeof s->origin_world);
}

/// Marks the lanes of points that are no part of a surface; `scale` is of sigmas.
static void mark_billboards(const build *b, const uint32_t *points, uint32_t count, double scale, ewa_packet *packet) {
    for (uint32_t i = 0; b->reader.surfaceness && i < LANES; i++) {
        if (!ewa_surfel_is_billboard(&b->reader, points[i < count ? i : 0])) continue;
        packet->oct_x[i] = EWA_BILLBOARD;
        packet->sigma[i] = (float)(scale * (double)packet->sigma[i]);
    }
}

/// Packs discs of a cloud whose streams need no general reading.
static void encode_discs(const build *b, const uint32_t *points, uint32_t count, double start[3],
                         ewa_packet *packet) {
    float normal[3][LANES];
    ewa_discs_load(&b->discs, b->surfels->unit, points, count, start, packet, normal);
    b->kernels->code_normals(normal, packet);
    mark_billboards(b, points, count, EWA_BILLBOARD_SCALE, packet);
    const ewa_attribute *color = b->reader.color;
    for (uint32_t lane = 0; lane < LANES; lane++) {
        if (!color) {
            packet->red[lane] = packet->green[lane] = packet->blue[lane] = b->grey_code;
            continue;
        }
        const uint32_t point = points[lane < count ? lane : 0];
        const uint8_t *c = (const uint8_t *)color->data + point * color->stride_bytes;
        packet->red[lane] = b->color_codes[c[0]];
        packet->green[lane] = b->color_codes[c[1]];
        packet->blue[lane] = b->color_codes[c[2]];
    }
}

/// Packs any surfels; returns the form of their colours.
static uint16_t encode_surfels(const build *b, const uint32_t *points, uint32_t count, double start[3],
                               ewa_packet *packet) {
    const double per_unit = 1 / b->surfels->unit;
    ewa_surfel surfels[LANES];
    double colors[LANES][3];
    float normal[3][LANES];
    for (uint32_t i = 0; i < LANES; i++) {
        bool drawable;
        if (i < count)
            ewa_surfel_read(&b->reader, points[i], 1, &surfels[i], &drawable);
        else
            surfels[i] = surfels[0];
        const ewa_surfel *s = &surfels[i];
        const double *from = surfels[0].center;
        const double major = vec3_length(vec3_load(s->axis_u_world)),
                     minor = vec3_length(vec3_load(s->axis_v_world));
        packet->x[i] = (float)((s->center[0] - from[0]) * per_unit);
        packet->y[i] = (float)((s->center[1] - from[1]) * per_unit);
        packet->z[i] = (float)((s->center[2] - from[2]) * per_unit);
        packet->sigma[i] = ewa_packed_sigma(major * per_unit);
        packet->ratio[i] = (uint16_t)(sqrt(sqrt(minimum(minor / major, 1))) * 65535 + 0.5);
        for (int c = 0; c < 3; c++) normal[c][i] = (float)s->normal_world[c];
        memcpy(colors[i], s->color_linear, sizeof colors[i]);
    }
    for (int c = 0; c < 3; c++) start[c] = surfels[0].center[c] * per_unit;
    b->kernels->code_normals(normal, packet);
    const ewa_attribute *color = b->reader.color;
    const bool even = !color || color->type == EWA_U8; // as packets of discs have
    const uint16_t form =
        even ? EWA_COLOR_FORM_UNIT : ewa_color_form_choose((const double(*)[3])colors, LANES);
    for (uint32_t i = 0; i < LANES; i++) {
        const bool circle = packet->ratio[i] == 65535;
        packet->angle[i] = circle ? 0 : ewa_packet_code_angle(packet, i, vec3_load(surfels[i].axis_u_world));
    }
    mark_billboards(b, points, count, 1, packet); // whose axes are scaled
    uint16_t *const channels[3] = {packet->red, packet->green, packet->blue};
    ewa_color_encode(form, (const double(*)[3])colors, LANES, channels);
    return form;
}

static uint32_t count_points(const uint32_t points[LANES]) {
    uint32_t count = LANES;
    while (points[count - 1] == EWA_NO_POINT) count--;
    return count;
}

/// Packs and bounds the sixteen packets of a group, fewer in the last one.
static void encode_group(const build *b, uint64_t group) {
    const ewa_surfels *surfels = b->surfels;
    const uint64_t first = group * LANES, packets_left = surfels->packet_count - first;
    const uint32_t packet_count = packets_left < LANES ? (uint32_t)packets_left : LANES;
    const uint32_t *points = b->order.points + first * LANES;
    uint32_t counts[LANES];
    double starts[LANES][3];
    for (uint32_t k = 0; k < packet_count; k++, points += LANES) {
        ewa_packet *packet = &surfels->packets[first + k];
        counts[k] = count_points(points);
        if (!b->are_discs) {
            surfels->bounds.colors[first + k] = encode_surfels(b, points, counts[k], starts[k], packet);
            continue;
        }
        if ((surfels->packet_count - first - k) * LANES >= PREFETCH_POINTS + LANES)
            for (uint32_t i = 0; i < LANES; i++)
                if (points[PREFETCH_POINTS + i] != EWA_NO_POINT)
                    ewa_discs_prefetch(&b->discs, points[PREFETCH_POINTS + i]);
        encode_discs(b, points, counts[k], starts[k], packet);
        surfels->bounds.colors[first + k] = EWA_COLOR_FORM_UNIT;
    }
    const uint32_t wide =
        b->kernels->bound_packets(&surfels->packets[first], packet_count, (const double(*)[3])starts,
                                  (float)surfels->cutoff, (float)EWA_PACKET_REACH, &surfels->bounds, first);
    for (uint32_t k = 0; k < packet_count; k++) {
        b->wide[first + k] = wide >> k & 1;
        if (surfels->billboards)
            ewa_packet_free_billboards(&surfels->packets[first + k], &surfels->bounds.cone[first + k]);
        if (counts[k] < LANES) ewa_packet_empty_lanes(&surfels->packets[first + k], counts[k]);
    }
}

static void encode_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const build *b = data;
    const uint64_t groups = ((uint64_t)b->surfels->packet_count + LANES - 1) / LANES;
    const uint64_t end = ewa_split(groups, b->parts, part + 1);
    for (uint64_t g = ewa_split(groups, b->parts, part); g < end; g++) encode_group(b, g);
}

/// Makes codes of the numbers that colours of discs can have.
static void set_color_codes(build *b) {
    b->grey_code = ewa_color_unit_code(EWA_DEFAULT_GREY);
    for (int value = 0; value < 256; value++)
        b->color_codes[value] = ewa_color_unit_code(b->reader.colors.linear_from_u8[value]);
}

/// The unit of lengths in packets: a power of two near the sigma of a surfel amid the others, so that sets
/// may be as small or large as doubles.
static double choose_unit(const build *b) {
    ewa_surfel surfel;
    bool drawable;
    if (b->surfels->count == 0) return 1;
    const size_t middle = (size_t)(b->order.packet_count / 2) * LANES;
    ewa_surfel_read(&b->reader, b->order.points[middle], 1, &surfel, &drawable);
    return ldexp(1, ilogb(vec3_length(vec3_load(surfel.axis_u_world))));
}

/// Packs all surfels as they are ordered.
static ewa_status encode(build *b, ewa_context *context) {
    const size_t packet_count = b->surfels->packet_count;
    b->wide = ewa_allocate(context, packet_count, sizeof *b->wide);
    if (!b->wide) return EWA_ERROR_MEMORY;
    ewa_parallel(context, encode_part, b, b->parts);
    bool any = false;
    for (size_t p = 0; p < packet_count; p++) any |= b->wide[p];
    ewa_status status = EWA_OK;
    if (any) status = ewa_packet_order_split(context, &b->reader, b->wide, &b->order);
    if (status == EWA_OK && b->order.packet_count != packet_count && any) {
        status = ewa_packets_allocate(b->surfels, b->order.packet_count);
        ewa_release(context, b->wide, packet_count, sizeof *b->wide);
        b->wide = status == EWA_OK ? ewa_allocate(context, b->order.packet_count, sizeof *b->wide) : NULL;
        if (!b->wide) return EWA_ERROR_MEMORY;
        ewa_parallel(context, encode_part, b, b->parts);
    }
    ewa_release(context, b->wide, b->surfels->packet_count, sizeof *b->wide);
    return status;
}

static ewa_status build_surfels(build *b, ewa_context *context) {
    b->drawable = ewa_allocate(context, b->point_count, sizeof *b->drawable);
    if (!b->drawable) return EWA_ERROR_MEMORY;
    b->kernels = EWA_CHOOSE(ewa_context_cpu_features(context), ewa_pack_kernels);
    b->are_discs = ewa_discs_open(&b->reader, b->kernels, &b->discs);
    ewa_parallel(context, measure_part, b, b->parts);
    join_facts(b);
    if (b->are_discs) set_color_codes(b);
    ewa_surfels *s = b->surfels;
    const uint32_t count = (uint32_t)b->point_count;
    EWA_TRY(ewa_packets_allocate(s, (uint32_t)(((uint64_t)s->count + LANES - 1) / LANES)));
    // The sort may use the packets' memory before there are packets.
    const bool fits = s->packet_count * sizeof *s->packets >= ewa_morton_room_bytes(count);
    EWA_TRY(ewa_packet_order_make(context, &b->reader, count, b->drawable, s->count, &s->extent,
                                  fits ? s->packets : NULL, &b->order));
    s->unit = choose_unit(b);
    EWA_TRY(encode(b, context));
    if (!(s->unit_coverage > 0) || !isfinite(s->unit_coverage)) s->unit_coverage = ewa_packets_unit_coverage(s);
    ewa_packets_sum_up(s);
    if (b->keep_points) {
        const size_t lanes = (size_t)s->packet_count * LANES;
        s->points = ewa_allocate(context, lanes, sizeof *s->points);
        if (!s->points) return EWA_ERROR_MEMORY;
        memcpy(s->points, b->order.points, lanes * sizeof *s->points);
    }
    return ewa_extras_make(context, s, &b->reader, b->point_count, b->order.points);
}

static ewa_status create(const ewa_cloud *cloud, const ewa_surfels_options *options, bool keep_points, double unit_coverage,
                         ewa_surfels **surfels) {
    if (!surfels) return EWA_ERROR_ARGUMENT;
    *surfels = NULL;
    if (!cloud) return EWA_ERROR_ARGUMENT;
    ewa_context *context = ewa_cloud_context(cloud);
    ewa_surfels_options chosen;
    EWA_TRY(ewa_surfels_options_choose(context, options, &chosen));
    build *b = ewa_allocate_zeroed(context, 1, sizeof *b);
    ewa_surfels *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!b || !made) {
        ewa_release(context, b, 1, sizeof *b);
        ewa_release(context, made, 1, sizeof *made);
        return EWA_ERROR_MEMORY;
    }
    made->context = context;
    made->cutoff = chosen.cutoff;
    made->unit_coverage = unit_coverage;
    b->keep_points = keep_points;
    b->surfels = made;
    b->point_count = ewa_cloud_point_count(cloud);
    b->parts =
        b->point_count / READ_BLOCK + 1 < MAX_PARTS ? (uint32_t)(b->point_count / READ_BLOCK + 1) : MAX_PARTS;
    ewa_status status = ewa_surfel_reader_open(cloud, &chosen, &b->reader);
    if (status == EWA_OK && b->point_count > UINT32_MAX - LANES)
        status = ewa_fail(context, EWA_ERROR_LIMIT, "%llu points are more than a renderer holds",
                          (unsigned long long)b->point_count);
    if (status == EWA_OK) status = build_surfels(b, context);
    ewa_release(context, b->drawable, b->point_count, sizeof *b->drawable);
    ewa_packet_order_free(context, &b->order);
    ewa_release(context, b, 1, sizeof *b);
    if (status == EWA_OK) status = ewa_levels_make(made, chosen.level_count);
    if (status == EWA_OK)
        *surfels = made;
    else
        ewa_surfels_destroy(&made);
    return status;
}

ewa_status ewa_surfels_create(const ewa_cloud *cloud, const ewa_surfels_options *options, ewa_surfels **surfels) {
    return create(cloud, options, false, 0, surfels);
}

ewa_status ewa_surfels_create_covering(const ewa_cloud *cloud, const ewa_surfels_options *options, double unit_coverage, ewa_surfels **surfels) {
    return create(cloud, options, false, unit_coverage, surfels);
}

ewa_status ewa_surfels_create_kept(const ewa_cloud *cloud, const ewa_surfels_options *options, ewa_surfels **surfels) {
    return create(cloud, options, true, 0, surfels);
}
