// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Clouds that become one: views of their streams, some of their points, and the same kinds of streams in all of them.
#include "base/base.h"
#include "cloud/border.h"
#include "cloud/cloud.h"
#include "scene/parts.h"

#include <math.h>
#include <string.h>

/// sRGB of points without colours beside coloured ones: as bright as the renderer's grey, linear 0.6.
static const uint8_t GREY_SRGB = 203;

static bool has_axes(const ewa_cloud *cloud) {
    return ewa_cloud_find(cloud, EWA_TANGENT_U) && ewa_cloud_find(cloud, EWA_TANGENT_V);
}

ewa_status ewa_cloud_filter(ewa_context *context, const ewa_filter *filter, ewa_cloud **cloud) {
    const uint64_t count = ewa_cloud_point_count(*cloud);
    if (!filter->term_count) return EWA_OK;
    uint8_t *marks = ewa_allocate(context, count, 1);
    if (!marks) return EWA_ERROR_MEMORY;
    memset(marks, 1, count);
    ewa_cloud *chosen = NULL;
    ewa_status status = ewa_filter_mark(filter, *cloud, marks);
    if (status == EWA_OK && memchr(marks, 0, count)) status = ewa_cloud_keep(*cloud, marks, &chosen);
    ewa_release(context, marks, count, 1);
    if (!chosen) return status;
    ewa_cloud_destroy(cloud);
    *cloud = chosen;
    return EWA_OK;
}

ewa_status ewa_cloud_view(ewa_context *context, const ewa_cloud *cloud, uint64_t first, uint64_t count,
                          ewa_cloud **view) {
    ewa_status status = ewa_cloud_create(context, count, view);
    const ewa_attribute *a;
    for (uint32_t k = 0; status == EWA_OK && (a = ewa_cloud_attribute_at(cloud, k)); k++)
        status = ewa_cloud_borrow(*view, a->name, a->type, a->component_count,
                                  (const char *)a->data + first * a->stride_bytes, a->stride_bytes);
    if (status == EWA_OK) status = ewa_cloud_follow(*view, cloud);
    if (status != EWA_OK) ewa_cloud_destroy(view);
    return status;
}

/// Whether two clouds store a stream in different ways, or only one has it.
static bool streams_differ(const ewa_cloud *a, const ewa_cloud *b, const char *name) {
    const ewa_attribute *first = ewa_cloud_find(a, name), *second = ewa_cloud_find(b, name);
    if (!first || !second) return first != second;
    return first->type != second->type || first->component_count != second->component_count;
}

/// Gives discs two equal axes, so that they can be merged with ellipses, and clip lines at their borders.
static ewa_status discs_to_axes(ewa_cloud *cloud, double cutoff) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    void *u_data = NULL, *v_data = NULL, *clip_data = NULL;
    EWA_TRY(ewa_cloud_add(cloud, EWA_TANGENT_U, EWA_F32, 3, &u_data));
    EWA_TRY(ewa_cloud_add(cloud, EWA_TANGENT_V, EWA_F32, 3, &v_data));
    const bool ends = ewa_cloud_find(cloud, EWA_BORDER) != NULL;
    if (ends) EWA_TRY(ewa_cloud_add(cloud, EWA_CLIP0, EWA_F32, 3, &clip_data));
    const ewa_attribute *normal = ewa_cloud_find(cloud, EWA_NORMAL),
                        *radius = ewa_cloud_find(cloud, EWA_RADIUS), *border = ewa_cloud_find(cloud, EWA_BORDER);
    float *u = u_data, *v = v_data, *clip = clip_data;
    for (uint64_t i = 0; i < count; i++, u += 3, v += 3) {
        double n[3], r;
        ewa_attribute_read_f64(normal, i, 1, n);
        ewa_attribute_read_f64(radius, i, 1, &r);
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        const double scale = length > 0 ? 1 / length : 0, sigma_world = r / cutoff;
        for (int c = 0; c < 3; c++) n[c] *= scale;
        // Any direction across the normal: the axis in which the normal is shortest leads to a safe one.
        const int shortest =
            fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2) : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
        const int next = (shortest + 1) % 3, last = (shortest + 2) % 3;
        double a[3] = {0};
        a[next] = -n[last];
        a[last] = n[next];
        const double a_length = sqrt(a[next] * a[next] + a[last] * a[last]);
        const double a_scale = a_length > 0 ? sigma_world / a_length : 0;
        for (int c = 0; c < 3; c++) a[c] *= a_scale;
        for (int c = 0; c < 3; c++) {
            u[c] = (float)a[c];
            v[c] = (float)(n[(c + 1) % 3] * a[(c + 2) % 3] - n[(c + 2) % 3] * a[(c + 1) % 3]);
        }
        if (!ends) continue;
        double to[3], line[3];
        const double axis_u[3] = {(double)u[0], (double)u[1], (double)u[2]},
                     axis_v[3] = {(double)v[0], (double)v[1], (double)v[2]};
        ewa_attribute_read_f64(border, i, 1, to);
        ewa_border_line(to, axis_u, axis_v, line);
        for (int c = 0; c < 3; c++) clip[3 * i + (uint64_t)c] = (float)line[c];
    }
    return EWA_OK;
}

ewa_status ewa_cloud_colors_to_linear(ewa_cloud *cloud) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute *found = ewa_cloud_find(cloud, EWA_COLOR);
    const ewa_attribute color = found ? *found : (ewa_attribute){.component_count = 0};
    static const double scales[] = {1, 1, 127, 255, 32767, 65535, 2147483647.0, 4294967295.0}; // by ewa_type
    ewa_context *context = ewa_cloud_context(cloud);
    float *linear = ewa_allocate(context, count, 4 * sizeof *linear);
    if (!linear) return EWA_ERROR_MEMORY;
    const bool is_float = color.type == EWA_F32 || color.type == EWA_F64;
    for (uint64_t i = 0; i < count; i++) {
        double rgba[4] = {GREY_SRGB / 255.0, GREY_SRGB / 255.0, GREY_SRGB / 255.0, 1};
        if (found) ewa_attribute_read_f64(&color, i, 1, rgba);
        const double scale = found ? scales[color.type] : 1;
        for (uint32_t c = 0; c < 4; c++) {
            const bool coded = c < 3 && !(found && is_float);
            const float value = (float)(c < color.component_count ? rgba[c] / scale : rgba[c]);
            linear[4 * i + c] = coded ? ewa_linear_from_srgb(value) : value;
        }
    }
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, EWA_COLOR, EWA_F32, 4, &data);
    if (status == EWA_OK) memcpy(data, linear, count * 4 * sizeof *linear);
    ewa_release(context, linear, count, 4 * sizeof *linear);
    return status;
}

/// Replaces a number of each point, or its absence, by doubles, which all can become.
static ewa_status numbers_to_doubles(ewa_cloud *cloud, const char *name) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    ewa_context *context = ewa_cloud_context(cloud);
    double *numbers = ewa_allocate(context, count, sizeof *numbers);
    if (!numbers) return EWA_ERROR_MEMORY;
    double absent;
    ewa_cloud_absent_number(name, &absent);
    for (uint64_t i = 0; i < count; i++) numbers[i] = absent;
    const ewa_attribute *found = ewa_cloud_find(cloud, name);
    if (found && found->component_count == 1) ewa_attribute_read_f64(found, 0, count, numbers);
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, name, EWA_F64, 1, &data);
    if (status == EWA_OK) memcpy(data, numbers, count * sizeof *numbers);
    ewa_release(context, numbers, count, sizeof *numbers);
    return status;
}

/// Removes what is not drawn, so that merging need not speak about it.
static void drop_undrawn(ewa_cloud *cloud) {
    static const char *const drawn[] = {EWA_POSITION,  EWA_NORMAL,   EWA_COLOR, EWA_RADIUS, EWA_TANGENT_U,
                                        EWA_TANGENT_V, EWA_MATERIAL, EWA_CLIP0, EWA_CLIP1,  EWA_CLIP_MODE,
                                        EWA_BORDER,    EWA_SURFACENESS, EWA_CURVATURE};
    for (uint32_t k = ewa_cloud_attribute_count(cloud); k-- > 0;) {
        bool kept = false;
        char name[EWA_NAME_BYTES];
        memcpy(name, ewa_cloud_attribute_at(cloud, k)->name, sizeof name);
        for (size_t i = 0; i < sizeof drawn / sizeof drawn[0]; i++) kept |= strcmp(name, drawn[i]) == 0;
        if (!kept) ewa_cloud_remove(cloud, name);
    }
}

enum { CLIP_STREAMS = 4 };
static const char *const clip_streams[CLIP_STREAMS] = {EWA_CLIP0, EWA_CLIP1, EWA_CLIP_MODE, EWA_BORDER};

/// Adds the clip lines and borders that another cloud has: zeros, which cut nothing.
static ewa_status add_clip_lines(ewa_cloud *cloud, const bool wanted[CLIP_STREAMS]) {
    for (int k = 0; k < CLIP_STREAMS; k++) {
        if (!wanted[k] || ewa_cloud_find(cloud, clip_streams[k])) continue;
        const uint32_t components = strcmp(clip_streams[k], EWA_CLIP_MODE) == 0 ? 1 : 3;
        void *data = NULL;
        EWA_TRY(ewa_cloud_add(cloud, clip_streams[k], EWA_F32, components, &data));
        memset(data, 0, ewa_cloud_point_count(cloud) * components * sizeof(float));
    }
    return EWA_OK;
}

ewa_status ewa_clouds_make_alike(ewa_cloud *const *clouds, uint32_t count, double cutoff) {
    bool any_axes = false, colors_differ = false, normals_differ = false, materials_differ = false,
         surfaceness_differs = false, curvatures_differ = false;
    bool clip[CLIP_STREAMS] = {false};
    for (uint32_t i = 0; i < count; i++) {
        any_axes |= has_axes(clouds[i]);
        colors_differ |= streams_differ(clouds[0], clouds[i], EWA_COLOR);
        normals_differ |= !ewa_cloud_find(clouds[i], EWA_NORMAL);
        materials_differ |= streams_differ(clouds[0], clouds[i], EWA_MATERIAL);
        surfaceness_differs |= streams_differ(clouds[0], clouds[i], EWA_SURFACENESS);
        curvatures_differ |= streams_differ(clouds[0], clouds[i], EWA_CURVATURE);
        for (int k = 0; k < CLIP_STREAMS; k++) clip[k] |= ewa_cloud_find(clouds[i], clip_streams[k]) != NULL;
    }
    if (any_axes) clip[0] |= clip[3], clip[3] = false;
    for (uint32_t i = 0; i < count; i++) {
        if (any_axes && !has_axes(clouds[i])) EWA_TRY(discs_to_axes(clouds[i], cutoff));
        if (colors_differ) EWA_TRY(ewa_cloud_colors_to_linear(clouds[i]));
        if (materials_differ) EWA_TRY(numbers_to_doubles(clouds[i], EWA_MATERIAL));
        if (surfaceness_differs) EWA_TRY(numbers_to_doubles(clouds[i], EWA_SURFACENESS));
        if (curvatures_differ) EWA_TRY(numbers_to_doubles(clouds[i], EWA_CURVATURE));
        EWA_TRY(add_clip_lines(clouds[i], clip));
        if (any_axes) ewa_cloud_remove(clouds[i], EWA_RADIUS), ewa_cloud_remove(clouds[i], EWA_BORDER);
        if (normals_differ) ewa_cloud_remove(clouds[i], EWA_NORMAL);
        drop_undrawn(clouds[i]);
    }
    return EWA_OK;
}
