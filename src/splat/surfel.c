// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// From streams to surfels: discs of a radius or ellipses of two tangent axes, colours to linear light.
// Based on: M. Zwicker, J. Rasanen, M. Botsch, C. Dachsbacher, M. Pauly, "Perspective Accurate Splatting",
// 2004, section 4.1 (tangent frames); the frame of a normal after T. Duff et al., "Building an Orthonormal
// Basis, Revisited", 2017.
#include "splat/surfel.h"
#include "base/base.h"
#include "splat/semantics.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 64 };

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/// The curve of IEC 61966-2-1 from correctly rounded operations only, so that it is the same on every
/// machine: s^2.4 = (s r)^2 with r the fifth root of s, by Newton from s^(1/8 + 1/16 + 1/128), within 1 % of
/// it here.
static double linear_from_srgb(double value) {
    if (value <= 0.04045) return value / 12.92;
    const double s = (value + 0.055) / 1.055;
    const double eighth = sqrt(sqrt(sqrt(s))), sixteenth = sqrt(eighth);
    double root = eighth * sixteenth * sqrt(sqrt(sqrt(sixteenth)));
    for (int i = 0; i < 4; i++) {
        const double square = root * root;
        root -= 0.2 * (root - s / (square * square));
    }
    const double product = s * root;
    return product * product;
}

/// Full scale of an integer type, 0 for floats.
static double full_scale(ewa_type type) {
    switch (type) {
    case EWA_U8:
        return 255;
    case EWA_I8:
        return 127;
    case EWA_U16:
        return 65535;
    case EWA_I16:
        return 32767;
    case EWA_U32:
        return 4294967295.0;
    case EWA_I32:
        return 2147483647.0;
    default:
        return 0;
    }
}

static double clamp01(double value) { return value < 0 ? 0 : value > 1 ? 1 : value; }

static void read_color(const ewa_surfel_reader *reader, const double *value, ewa_surfel *surfel) {
    const ewa_attribute *color = reader->color;
    const double scale = full_scale(color->type);
    const uint32_t components = color->component_count;
    bool finite = true;
    for (uint32_t c = 0; c < components; c++) finite = finite && isfinite(value[c]);
    for (int c = 0; c < 3; c++) {
        if (!finite)
            surfel->color_linear[c] = EWA_DEFAULT_GREY;
        else if (color->type == EWA_U8)
            surfel->color_linear[c] = reader->linear_from_u8[(int)value[c]];
        else if (scale > 0)
            surfel->color_linear[c] = linear_from_srgb(clamp01(value[c] / scale));
        else
            surfel->color_linear[c] = clamp01(value[c]);
    }
    surfel->alpha = components < 4 || !finite ? 1 : clamp01(scale > 0 ? value[3] / scale : value[3]);
}

static bool within_limit(const double v[3]) {
    // Written so that a NaN is not within.
    return fabs(v[0]) <= EWA_SURFEL_LIMIT && fabs(v[1]) <= EWA_SURFEL_LIMIT && fabs(v[2]) <= EWA_SURFEL_LIMIT;
}

/// Scales `v` to length 1 by way of its largest component, so that tiny and huge vectors keep their
/// direction.
static bool normalize(double v[3]) {
    const double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(largest > 0) || !isfinite(v[0] + v[1] + v[2])) return false;
    for (int c = 0; c < 3; c++) v[c] /= largest;
    const double length = sqrt(dot(v, v));
    for (int c = 0; c < 3; c++) v[c] /= length;
    return true;
}

/// A disc of standard deviation `sigma` around the normal.
static bool make_disc(const double normal[3], double sigma, ewa_surfel *surfel) {
    if (!(sigma >= 1 / EWA_SURFEL_LIMIT && sigma <= EWA_SURFEL_LIMIT)) return false;
    double *n = surfel->normal_world;
    memcpy(n, normal, 3 * sizeof *n);
    if (!normalize(n)) return false;
    const double sign = copysign(1, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    const double u[3] = {1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
    const double v[3] = {b, sign + n[1] * n[1] * a, -n[1]};
    for (int c = 0; c < 3; c++) {
        surfel->axis_u_world[c] = sigma * u[c];
        surfel->axis_v_world[c] = sigma * v[c];
    }
    return true;
}

/// An ellipse of two conjugate axes: turns them into the principal ones of the same covariance. A rotation of
/// the pair by t keeps tu'tu + tv'tv and tu x tv; they become orthogonal for tan 2t = 2 tu.tv / (tu.tu -
/// tv.tv).
static bool make_ellipse(const double tu[3], const double tv[3], double scale, ewa_surfel *surfel) {
    double *u = surfel->axis_u_world, *v = surfel->axis_v_world, *n = surfel->normal_world;
    for (int c = 0; c < 3; c++) {
        u[c] = scale * tu[c];
        v[c] = scale * tv[c];
    }
    if (!within_limit(u) || !within_limit(v)) return false;
    const double difference = dot(u, u) - dot(v, v), mixed = 2 * dot(u, v);
    double cosine = 1, sine = 0;
    if (mixed != 0 || difference < 0) {
        // Half of the angle of (difference, mixed), in [-90, 90] degrees: the longer axis becomes u.
        const double length = sqrt(difference * difference + mixed * mixed);
        const double twice = length > 0 ? difference / length : 1;
        const double larger = sqrt((1 + fabs(twice)) / 2), smaller = fabs(mixed) / length / (2 * larger);
        cosine = twice >= 0 ? larger : smaller;
        sine = copysign(twice >= 0 ? smaller : larger, mixed);
    }
    for (int c = 0; c < 3; c++) {
        const double was = u[c];
        u[c] = cosine * was + sine * v[c];
        v[c] = cosine * v[c] - sine * was;
    }
    const double u_length = sqrt(dot(u, u)), v_length = sqrt(dot(v, v));
    if (!(v_length >= 1 / EWA_SURFEL_LIMIT && v_length >= EWA_SURFEL_MIN_ASPECT * u_length)) return false;
    cross(u, v, n);
    return normalize(n);
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
        .sigma_per_radius = options->radius_scale / options->cutoff,
        .axis_scale = options->radius_scale,
    };
    ewa_status status = check_presence(cloud, reader);
    if (status == EWA_OK) status = check_components(cloud, reader->position, 3, 3);
    if (status == EWA_OK) status = check_components(cloud, reader->normal, 3, 3);
    if (status == EWA_OK) status = check_components(cloud, reader->color, 3, 4);
    if (reader->tangent_u && reader->tangent_v) {
        reader->radius = NULL;
        if (status == EWA_OK) status = check_components(cloud, reader->tangent_u, 3, 3);
        if (status == EWA_OK) status = check_components(cloud, reader->tangent_v, 3, 3);
    } else {
        reader->tangent_u = reader->tangent_v = NULL;
        if (status == EWA_OK) status = check_components(cloud, reader->radius, 1, 1);
    }
    ewa_cloud_origin(cloud, reader->origin_world);
    for (int i = 0; i < 256; i++) reader->linear_from_u8[i] = linear_from_srgb(i / 255.0);
    return status;
}

/// At most BLOCK points.
static uint64_t read_block(const ewa_surfel_reader *reader, uint64_t first, uint64_t count,
                           ewa_surfel *surfels, bool *drawable) {
    double position[3 * BLOCK], normal[3 * BLOCK], first_axis[3 * BLOCK], second_axis[3 * BLOCK],
        color[4 * BLOCK];
    ewa_attribute_read_f64(reader->position, first, count, position);
    if (reader->normal) ewa_attribute_read_f64(reader->normal, first, count, normal);
    if (reader->color) ewa_attribute_read_f64(reader->color, first, count, color);
    ewa_attribute_read_f64(reader->tangent_u ? reader->tangent_u : reader->radius, first, count, first_axis);
    if (reader->tangent_v) ewa_attribute_read_f64(reader->tangent_v, first, count, second_axis);
    uint64_t kept = 0;
    for (uint64_t i = 0; i < count; i++) {
        ewa_surfel *surfel = &surfels[i];
        if (!reader->tangent_u) {
            drawable[i] = make_disc(&normal[3 * i], first_axis[i] * reader->sigma_per_radius, surfel);
        } else {
            drawable[i] = make_ellipse(&first_axis[3 * i], &second_axis[3 * i], reader->axis_scale, surfel);
            if (drawable[i] && reader->normal && dot(surfel->normal_world, &normal[3 * i]) < 0)
                for (int c = 0; c < 3; c++) surfel->normal_world[c] = -surfel->normal_world[c];
        }
        for (int c = 0; c < 3; c++) surfel->center_world[c] = position[3 * i + c] + reader->origin_world[c];
        drawable[i] = drawable[i] && within_limit(surfel->center_world);
        kept += drawable[i];
        surfel->alpha = 1;
        if (reader->color)
            read_color(reader, &color[reader->color->component_count * i], surfel);
        else
            surfel->color_linear[0] = surfel->color_linear[1] = surfel->color_linear[2] = EWA_DEFAULT_GREY;
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
