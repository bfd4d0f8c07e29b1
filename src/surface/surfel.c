// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From streams to surfels: discs of a radius or ellipses of two tangent axes, colours to linear light.
// Based on: M. Zwicker, J. Rasanen, M. Botsch, C. Dachsbacher, M. Pauly, "Perspective Accurate Splatting",
// 2004, section 4.1 (tangent frames); the frame of a normal after T. Duff et al., "Building an Orthonormal
// Basis, Revisited", 2017.
#include "surface/surfel.h"
#include "base/base.h"
#include "cloud/border.h"
#include "cloud/cloud.h"
#include "cloud/color.h"
#include "homogeneous/frame.h"
#include "surface/packets.h"
#include "surface/semantics.h"

#include <string.h>

enum { BLOCK = 64 };

static bool all_finite(const double *value, uint32_t count) {
    bool finite = true;
    for (uint32_t c = 0; c < count; c++) finite = finite && isfinite(value[c]);
    return finite;
}

/// False for NaN too.
static bool within_limit(ewa_vec3 v) {
    return fabs(v.x) <= EWA_SURFEL_LIMIT && fabs(v.y) <= EWA_SURFEL_LIMIT && fabs(v.z) <= EWA_SURFEL_LIMIT;
}

/// A disc of standard deviation `sigma` around the normal `n`.
static bool make_disc(ewa_vec3 n, double sigma, ewa_surfel *surfel) {
    if (!(sigma >= 1 / EWA_SURFEL_LIMIT && sigma <= EWA_SURFEL_LIMIT) || !vec3_normalize(&n)) return false;
    ewa_vec3 axis[2];
    ewa_frame_of(n, axis);
    vec3_store(vec3_scale(axis[0], sigma), surfel->axis_u_world);
    vec3_store(vec3_scale(axis[1], sigma), surfel->axis_v_world);
    vec3_store(n, surfel->normal_world);
    return true;
}

/// An ellipse of two conjugate axes: turns them into the principal ones of the same covariance. A rotation of
/// the pair by t keeps tu'tu + tv'tv and tu x tv; they become orthogonal for tan 2t = 2 tu.tv / (tu.tu -
/// tv.tv). The normal is on the side of `given`, if that has one. `turn` is set to the cosine and sine of t.
static bool make_ellipse(ewa_vec3 tu, ewa_vec3 tv, ewa_vec3 given, ewa_surfel *surfel, double turn[2]) {
    if (!within_limit(tu) || !within_limit(tv)) return false;
    const double difference = vec3_dot(tu, tu) - vec3_dot(tv, tv), mixed = 2 * vec3_dot(tu, tv);
    double cosine = 1, sine = 0;
    if (mixed != 0 || difference < 0) {
        // Half of the angle of (difference, mixed), in [-90, 90] degrees: the longer axis becomes u.
        const double largest = fmax(fabs(difference), fabs(mixed)); // whose square may be beyond doubles
        const double x = difference / largest, y = mixed / largest, length = largest * sqrt(x * x + y * y);
        const double larger = sqrt((1 + fabs(difference) / length) / 2);
        const double smaller = fabs(mixed) / length / (2 * larger);
        cosine = difference >= 0 ? larger : smaller;
        sine = copysign(difference >= 0 ? smaller : larger, mixed);
    }
    const ewa_vec3 u = vec3_add(vec3_scale(tu, cosine), vec3_scale(tv, sine));
    const ewa_vec3 v = vec3_sub(vec3_scale(tv, cosine), vec3_scale(tu, sine));
    // A length of 0 above has made NaN of both.
    if (!(vec3_length(v) >= 1 / EWA_SURFEL_LIMIT && vec3_length(v) >= EWA_SURFEL_MIN_ASPECT * vec3_length(u)))
        return false;
    ewa_vec3 n = vec3_cross(u, v);
    if (!vec3_normalize(&n)) return false;
    vec3_store(u, surfel->axis_u_world);
    vec3_store(v, surfel->axis_v_world);
    turn[0] = cosine, turn[1] = sine;
    vec3_store(vec3_scale(n, vec3_dot(n, given) < 0 ? -1 : 1), surfel->normal_world);
    return true;
}

/// Sets a clip line from the file's, which is for the axes before they were scaled and turned.
static void set_clip(const double line[3], double axis_scale, const double turn[2], double clip[3]) {
    clip[0] = clip[1] = clip[2] = 0;
    if (!all_finite(line, 3)) return;
    clip[0] = axis_scale * (line[0] * turn[0] + line[1] * turn[1]);
    clip[1] = axis_scale * (line[1] * turn[0] - line[0] * turn[1]);
    clip[2] = line[2];
}

/// The line in which the plane at a border cuts a disc.
static void set_border(const double border[3], ewa_surfel *surfel) {
    static const double none[3] = {0};
    ewa_border_line(all_finite(border, 3) ? border : none, surfel->axis_u_world, surfel->axis_v_world, surfel->clip[0]);
}

static uint8_t material_of(double value) {
    return value >= 0 && value <= UINT8_MAX && value == floor(value) ? (uint8_t)value : 0;
}

uint8_t ewa_surfel_material(const ewa_surfel_reader *reader, uint64_t point) {
    double value = 0;
    if (reader->material) ewa_attribute_read_f64(reader->material, point, 1, &value);
    return material_of(value);
}

/// As packets keep it.
static double curvature_of(double curvature) {
    return fabs(curvature) <= EWA_SURFEL_LIMIT ? ewa_packet_decode_curvature(ewa_packet_code_curvature(curvature)) : 0;
}

static ewa_status check_components(const ewa_cloud *cloud, const ewa_attribute *attribute, uint32_t low,
                                   uint32_t high) {
    if (!attribute || (attribute->component_count >= low && attribute->component_count <= high))
        return EWA_OK;
    return ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT,
                    "cloud: '%s' has %u components instead of %u", attribute->name,
                    attribute->component_count, low);
}

/// Names the first attribute that is missing.
static ewa_status check_presence(const ewa_cloud *cloud, const ewa_surfel_reader *reader) {
    const char *missing = NULL;
    if (!reader->position)
        missing = EWA_POSITION;
    else if (reader->tangent_u && reader->tangent_v)
        return EWA_OK;
    else if (reader->normal && reader->radius)
        return EWA_OK;
    else if (reader->tangent_u)
        missing = EWA_TANGENT_V;
    else if (reader->tangent_v)
        missing = EWA_TANGENT_U;
    else
        missing = reader->normal ? EWA_RADIUS : EWA_NORMAL;
    return ewa_fail(
        ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT,
        "cloud: '%s' is missing (surfels need 'position' with 'normal' and 'radius', or with 'tangent_u' "
        "and 'tangent_v')",
        missing);
}

ewa_status ewa_surfel_reader_open(const ewa_cloud *cloud, const ewa_surfels_options *options,
                                  ewa_surfel_reader *reader) {
    *reader = (ewa_surfel_reader){
        .position = ewa_cloud_find(cloud, EWA_POSITION),
        .normal = ewa_cloud_find(cloud, EWA_NORMAL),
        .radius = ewa_cloud_find(cloud, EWA_RADIUS),
        .tangent_u = ewa_cloud_find(cloud, EWA_TANGENT_U),
        .tangent_v = ewa_cloud_find(cloud, EWA_TANGENT_V),
        .color = ewa_cloud_find(cloud, EWA_COLOR),
        .material = ewa_cloud_find(cloud, EWA_MATERIAL),
        .surfaceness = ewa_cloud_find(cloud, EWA_SURFACENESS),
        .curvature = ewa_cloud_find(cloud, EWA_CURVATURE),
        .sigma_per_radius = options->radius_scale / options->cutoff,
        .axis_scale = options->radius_scale,
    };
    if (reader->tangent_u && reader->tangent_v) {
        reader->clip[0] = ewa_cloud_find(cloud, EWA_CLIP0);
        reader->clip[1] = ewa_cloud_find(cloud, EWA_CLIP1);
        reader->clip_mode = ewa_cloud_find(cloud, EWA_CLIP_MODE);
    }
    EWA_TRY(check_presence(cloud, reader));
    for (int i = 0; i < 2; i++) EWA_TRY(check_components(cloud, reader->clip[i], 3, 3));
    EWA_TRY(check_components(cloud, reader->clip_mode, 1, 1));
    EWA_TRY(check_components(cloud, reader->position, 3, 3));
    EWA_TRY(check_components(cloud, reader->normal, 3, 3));
    EWA_TRY(check_components(cloud, reader->color, 3, 4));
    EWA_TRY(check_components(cloud, reader->material, 1, 1));
    EWA_TRY(check_components(cloud, reader->surfaceness, 1, 1));
    EWA_TRY(check_components(cloud, reader->curvature, 1, 1));
    if (reader->tangent_u && reader->tangent_v) {
        reader->radius = NULL;
        EWA_TRY(check_components(cloud, reader->tangent_u, 3, 3));
        EWA_TRY(check_components(cloud, reader->tangent_v, 3, 3));
    } else {
        reader->border = ewa_cloud_find(cloud, EWA_BORDER);
        EWA_TRY(check_components(cloud, reader->border, 3, 3));
        reader->tangent_u = reader->tangent_v = NULL;
        EWA_TRY(check_components(cloud, reader->radius, 1, 1));
    }
    ewa_cloud_origin(cloud, reader->origin_world);
    ewa_color_table_make(&reader->colors);
    return EWA_OK;
}

/// Makes an ellipse the circle of a billboard.
static void make_circle(ewa_surfel *surfel) {
    const ewa_vec3 u = vec3_load(surfel->axis_u_world), v = vec3_load(surfel->axis_v_world);
    const double shorter = sqrt(vec3_length(v) / vec3_length(u));
    vec3_store(vec3_scale(u, EWA_BILLBOARD_SCALE * shorter), surfel->axis_u_world);
    vec3_store(vec3_scale(v, EWA_BILLBOARD_SCALE / shorter), surfel->axis_v_world);
}

/// At most BLOCK points.
static uint64_t read_block(const ewa_surfel_reader *reader, uint64_t first, uint64_t count,
                           ewa_surfel *surfels, bool *drawable) {
    double position[3 * BLOCK], normal[3 * BLOCK], first_axis[3 * BLOCK], second_axis[3 * BLOCK],
        color[4 * BLOCK], clip[2][3 * BLOCK], mode[BLOCK], border[3 * BLOCK], material[BLOCK], curvature[BLOCK];
    ewa_attribute_read_f64(reader->position, first, count, position);
    if (reader->normal) ewa_attribute_read_f64(reader->normal, first, count, normal);
    if (reader->color) ewa_attribute_read_f64(reader->color, first, count, color);
    ewa_attribute_read_f64(reader->tangent_u ? reader->tangent_u : reader->radius, first, count, first_axis);
    if (reader->tangent_v) ewa_attribute_read_f64(reader->tangent_v, first, count, second_axis);
    for (int k = 0; k < 2; k++)
        if (reader->clip[k])
            ewa_attribute_read_f64(reader->clip[k], first, count, clip[k]);
        else
            memset(clip[k], 0, 3 * count * sizeof *clip[k]);
    if (reader->clip_mode)
        ewa_attribute_read_f64(reader->clip_mode, first, count, mode);
    else
        memset(mode, 0, count * sizeof *mode);
    if (reader->border) ewa_attribute_read_f64(reader->border, first, count, border);
    if (reader->material) ewa_attribute_read_f64(reader->material, first, count, material);
    if (reader->curvature) ewa_attribute_read_f64(reader->curvature, first, count, curvature);
    uint64_t kept = 0;
    for (uint64_t i = 0; i < count; i++) {
        ewa_surfel *surfel = &surfels[i];
        double turn[2] = {1, 0};
        const ewa_vec3 center = vec3_load(&position[3 * i]);
        vec3_store(center, surfel->center);
        const ewa_vec3 given = reader->normal ? vec3_load(&normal[3 * i]) : vec3_make(0, 0, 0);
        if (reader->tangent_u)
            drawable[i] = make_ellipse(vec3_scale(vec3_load(&first_axis[3 * i]), reader->axis_scale),
                                       vec3_scale(vec3_load(&second_axis[3 * i]), reader->axis_scale), given,
                                       surfel, turn);
        else
            drawable[i] = make_disc(given, first_axis[i] * reader->sigma_per_radius, surfel);
        drawable[i] = drawable[i] && within_limit(center);
        kept += drawable[i];
        for (int k = 0; k < 2; k++) set_clip(&clip[k][3 * i], reader->axis_scale, turn, surfel->clip[k]);
        surfel->billboard = ewa_surfel_is_billboard(reader, first + i);
        if (reader->border && !surfel->billboard) set_border(&border[3 * i], surfel);
        surfel->clip_either = mode[i] == 1;
        if (surfel->billboard && drawable[i]) make_circle(surfel);
        surfel->alpha = 1;
        surfel->material = reader->material ? material_of(material[i]) : 0;
        surfel->curvature_world = reader->curvature && !surfel->billboard ? curvature_of(curvature[i]) : 0;
        if (reader->color) {
            const double *value = &color[reader->color->component_count * i];
            ewa_color_decode(&reader->colors, reader->color, value, surfel->color_linear);
            surfel->alpha = ewa_color_alpha(reader->color, value);
        } else {
            surfel->color_linear[0] = surfel->color_linear[1] = surfel->color_linear[2] = EWA_DEFAULT_GREY;
        }
    }
    return kept;
}

uint64_t ewa_surfel_read(const ewa_surfel_reader *reader, uint64_t first, uint64_t count, ewa_surfel *surfels,
                         bool *drawable) {
    uint64_t kept = 0;
    for (uint64_t done = 0; done < count; done += BLOCK) {
        const uint64_t part = count - done < BLOCK ? count - done : BLOCK;
        kept += read_block(reader, first + done, part, surfels + done, drawable + done);
    }
    return kept;
}

double ewa_surfel_curvature(const ewa_surfel_reader *reader, uint64_t point) {
    double curvature = 0;
    if (reader->curvature && !ewa_surfel_is_billboard(reader, point))
        ewa_attribute_read_f64(reader->curvature, point, 1, &curvature);
    return curvature_of(curvature);
}

double ewa_surfel_alpha(const ewa_surfel_reader *reader, uint64_t point) {
    double color[4] = {0};
    if (!reader->color || reader->color->component_count != 4) return 1;
    ewa_attribute_read_f64(reader->color, point, 1, color);
    return ewa_color_alpha(reader->color, color);
}

/// Whether the numbers of a clip line, or three of a border, are one.
static bool is_line(const double v[3], int numbers) {
    return (v[0] != 0 || v[1] != 0 || (numbers == 3 && v[2] != 0)) && all_finite(v, 3);
}

bool ewa_surfel_is_billboard(const ewa_surfel_reader *reader, uint64_t point) {
    double surfaceness = 1;
    if (reader->surfaceness) ewa_attribute_read_f64(reader->surfaceness, point, 1, &surfaceness);
    if (!(surfaceness < EWA_SURFACE_LIMIT)) return false;
    for (int k = 0; k < 2; k++) {
        double line[3] = {0};
        if (reader->clip[k]) ewa_attribute_read_f64(reader->clip[k], point, 1, line);
        if (is_line(line, 2)) return false;
    }
    return true;
}

static void mark_lines(const ewa_attribute *attribute, uint64_t first, uint64_t count, int numbers, uint8_t *clipped) {
    double values[3 * BLOCK];
    if (!attribute) return;
    ewa_attribute_read_f64(attribute, first, count, values);
    for (uint64_t i = 0; i < count; i++) clipped[i] |= is_line(&values[3 * i], numbers);
}

void ewa_surfel_mark_clipped(const ewa_surfel_reader *reader, uint64_t first, uint64_t count, uint8_t *clipped) {
    memset(clipped, 0, count);
    for (uint64_t done = 0; done < count; done += BLOCK) {
        const uint64_t part = count - done < BLOCK ? count - done : BLOCK;
        for (int k = 0; k < 2; k++) mark_lines(reader->clip[k], first + done, part, 2, clipped + done);
        mark_lines(reader->border, first + done, part, 3, clipped + done);
    }
    for (uint64_t i = 0; i < count && reader->surfaceness; i++)
        if (clipped[i] && ewa_surfel_is_billboard(reader, first + i)) clipped[i] = 0;
}
