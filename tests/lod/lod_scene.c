// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A hilly ground whose coordinates are exact in every format, and points as sorted bytes.
#include "lod/lod_scene.h"

#include <math.h>

static const double STEP = 0x1p-20;

ewa_cloud *lod_ground(ewa_context *context, uint64_t first, uint64_t count, lod_look look) {
    void *at = NULL, *color = NULL, *normal = NULL, *radius = NULL;
    ewa_cloud *cloud = check_cloud_of(context, count);
    assert_int_equal(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, &at), EWA_OK);
    if (look.colors) assert_int_equal(ewa_cloud_add(cloud, EWA_COLOR, EWA_U8, 3, &color), EWA_OK);
    if (look.surfels) {
        assert_int_equal(ewa_cloud_add(cloud, EWA_NORMAL, EWA_F32, 3, &normal), EWA_OK);
        assert_int_equal(ewa_cloud_add(cloud, EWA_RADIUS, EWA_F32, 1, &radius), EWA_OK);
    }
    for (uint64_t i = 0; i < count; i++) {
        // Evenly spread, whatever part of the sequence it is (R2 of Roberts).
        const double u = 2 * fmod(0.5 + 0.7548776662466927 * (double)(first + i), 1) - 1;
        const double v = 2 * fmod(0.5 + 0.5698402909980532 * (double)(first + i), 1) - 1;
        const double z = 0.1 * sin(4 * u) * cos(3 * v);
        const double slope[2] = {0.4 * cos(4 * u) * cos(3 * v), -0.3 * sin(4 * u) * sin(3 * v)};
        const double world[3] = {u, v, z};
        for (uint64_t c = 0; c < 3; c++) ((double *)at)[3 * i + c] = rint(world[c] / STEP) * STEP;
        if (color) {
            ((uint8_t *)color)[3 * i] = (uint8_t)(128 + 100 * sin(7 * u));
            ((uint8_t *)color)[3 * i + 1] = (uint8_t)(128 + 100 * sin(5 * v));
            ((uint8_t *)color)[3 * i + 2] = (uint8_t)(128 + 100 * sin(9 * (u + v)));
        }
        if (!normal) continue;
        const double length = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
        const double unit[3] = {-slope[0] / length, -slope[1] / length, 1 / length};
        for (uint64_t c = 0; c < 3; c++) ((float *)normal)[3 * i + c] = (float)unit[c];
        ((float *)radius)[i] = 0.004f;
    }
    return cloud;
}

void lod_save(ewa_cloud *cloud, const char *name) {
    char path[512];
    WITH_DEFAULTS(ewa_cloud_save_options, options);
    options.step_world = STEP;
    assert_int_equal(ewa_cloud_save(cloud, scratch_path(name, path), &options), EWA_OK);
    ewa_cloud_destroy(&cloud);
}

ewa_cloud *lod_load(ewa_context *context, const char *name) {
    char path[512];
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_load(context, scratch_path(name, path), &cloud), EWA_OK);
    return cloud;
}

ewa_status lod_build(ewa_context *context, const char *const *names, uint32_t count, const char *out,
                     const ewa_lod_build_options *options, ewa_lod_build_stats *stats) {
    enum { MAXIMUM = 8 };
    char paths[MAXIMUM][512], out_path[512];
    const char *given[MAXIMUM];
    assert_true(count <= MAXIMUM);
    for (uint32_t i = 0; i < count; i++) given[i] = scratch_path(names[i], paths[i]);
    WITH_DEFAULTS(ewa_lod_build_options, plain);
    plain.memory_bytes = LOD_MEMORY_BYTES;
    return ewa_lod_build(context, given, count, scratch_path(out, out_path), options ? options : &plain,
                         stats);
}

void lod_build_ground(uint64_t count, const char *out) {
    static const char *const names[] = {"ground.ply"};
    lod_clear();
    OWNED(ewa_context_destroy) ewa_context *context = check_context(2, NULL);
    lod_save(lod_ground(context, 0, count, (lod_look){true, true}), names[0]);
    assert_int_equal(lod_build(context, names, 1, out, NULL, NULL), EWA_OK);
}

static int compare_points(const void *a, const void *b) { return memcmp(a, b, sizeof(lod_point)); }

lod_point *lod_points(ewa_cloud *const *clouds, uint32_t cloud_count, bool surfels, uint64_t *count) {
    *count = 0;
    for (uint32_t k = 0; k < cloud_count; k++) *count += ewa_cloud_point_count(clouds[k]);
    lod_point *points = calloc(*count + 1, sizeof *points), *to = points;
    assert_non_null(points);
    for (uint32_t k = 0; k < cloud_count; k++) {
        const ewa_attribute *position = ewa_cloud_find(clouds[k], EWA_POSITION),
                            *color = ewa_cloud_find(clouds[k], EWA_COLOR),
                            *normal = ewa_cloud_find(clouds[k], EWA_NORMAL),
                            *radius = ewa_cloud_find(clouds[k], EWA_RADIUS);
        double origin[3];
        ewa_cloud_origin(clouds[k], origin);
        const uint64_t point_count = ewa_cloud_point_count(clouds[k]);
        for (uint64_t i = 0; i < point_count; i++, to++) {
            double numbers[4];
            ewa_attribute_read_f64(position, i, 1, numbers);
            for (int c = 0; c < 3; c++) to->at[c] = llrint((numbers[c] + origin[c]) / STEP);
            // Half a byte of the 16 bits of LAS is none of the 8 of PLY.
            const double scale = color && color->type == EWA_U16 ? 1 / 257.0 : 1;
            if (color) ewa_attribute_read_f64(color, i, 1, numbers);
            for (int c = 0; c < 3 && color; c++) to->color[c] = (int32_t)lrint(numbers[c] * scale);
            if (!surfels) continue;
            ewa_attribute_read_f64(normal, i, 1, numbers);
            for (int c = 0; c < 3; c++) to->normal[c] = (int32_t)lrint(numbers[c] * 1e6);
            ewa_attribute_read_f64(radius, i, 1, numbers);
            to->radius = (int32_t)lrint(numbers[0] * 1e6);
        }
    }
    qsort(points, *count, sizeof *points, compare_points);
    return points;
}

void lod_hold_same(ewa_cloud *const *inputs, uint32_t input_count, ewa_cloud *output, bool surfels) {
    uint64_t count, output_count;
    OWNED(check_free) lod_point *expected = lod_points(inputs, input_count, surfels, &count);
    OWNED(check_free) lod_point *got = lod_points(&output, 1, surfels, &output_count);
    assert_int_equal(count, output_count);
    assert_memory_equal(expected, got, count * sizeof *got);
}

void lod_hold_same_files(const char *a, const char *b) {
    char path[512];
    size_t a_bytes, b_bytes;
    OWNED(check_free)
    uint8_t *of_a = scratch_read(scratch_path(a, path), &a_bytes),
            *of_b = scratch_read(scratch_path(b, path), &b_bytes);
    assert_int_equal(a_bytes, b_bytes);
    if (memcmp(of_a, of_b, a_bytes) != 0) fail_msg("%s and %s are different", a, b);
}

bool lod_is_there(const char *name) {
    char path[512];
    return access(scratch_path(name, path), F_OK) == 0;
}

int lod_clear(void) {
    char folder[512], path[1024];
    DIR *listing = opendir(scratch_path("", folder));
    assert_non_null(listing);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(listing));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        snprintf(path, sizeof path, "%s%s", folder, entry->d_name);
        assert_int_equal(unlink(path), 0);
        count++;
    }
    closedir(listing);
    return count;
}
