// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The formats of point clouds, and what all their readers share.
#include "base/base.h"
#include "base/format.h"
#include "base/options.h"
#include "base/platform.h"
#include "cloud/cloud.h"
#include "io/cloud/format.h"
#include "io/file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/// Those with a magic first, then text.
static const ewa_cloud_format *const formats[] = {&ewa_format_ply, &ewa_format_las, &ewa_format_e57,
                                                  &ewa_format_pcd, &ewa_format_tiff, &ewa_format_grid, &ewa_format_ptx, &ewa_format_text};
enum { MAGIC_COUNT = 6 };

const ewa_cloud_format *ewa_cloud_format_of(const char *name, const uint8_t *bytes, uint64_t size_bytes,
                                            ewa_probe probe, const ewa_cloud_load_options *options) {
    if (options && options->heights && ewa_format_terrain.probe(name, bytes, size_bytes)) return &ewa_format_terrain;
    const size_t count = probe == EWA_PROBE_MAGIC ? MAGIC_COUNT : sizeof formats / sizeof formats[0];
    for (size_t i = 0; i < count; i++)
        if (formats[i]->probe(name, bytes, size_bytes)) return formats[i];
    return NULL;
}

#define LOAD_AT(member) offsetof(ewa_cloud_load_options, member)
#define SAVE_AT(member) offsetof(ewa_cloud_save_options, member)

static const ewa_option load_rows[] = {
    {"keep_going", EWA_OPTION_BOOL, LOAD_AT(keep_going),
     .help = "step over damaged pieces of a file, with a warning, and count the points that are lost"},
    {"heights", EWA_OPTION_CHOICE, LOAD_AT(heights), .words = "none|terrain-rgb|terrarium",
     .help = "PNG and WebP are grids of heights, in colours as Mapbox or as Mapzen has them"},
};

const ewa_option_table ewa_cloud_load_options_table = EWA_OPTION_TABLE(ewa_cloud_load_options, load_rows);

void ewa_cloud_load_options_init(ewa_cloud_load_options *options, size_t struct_size) {
    ewa_options_init(&ewa_cloud_load_options_table, options, struct_size);
}

static const ewa_option save_rows[] = {
    {"ply_encoding", EWA_OPTION_CHOICE, SAVE_AT(ply_encoding), .words = "little-endian|big-endian|ascii",
     .help = "how PLY files hold numbers"},
    {"step_world", EWA_OPTION_F64, SAVE_AT(step_world), 0, INFINITY, .limits = EWA_OPTION_BELOW,
     .help =
         "step of the coordinates of LAS, world units; 0: that of the cloud, else by the size of the box"},
    {"chunk_points", EWA_OPTION_U32, SAVE_AT(chunk_points), 1, 10000000, .initial = 50000,
     .help = "points of one chunk of LAZ"},
};

const ewa_option_table ewa_cloud_save_options_table = EWA_OPTION_TABLE(ewa_cloud_save_options, save_rows);

void ewa_cloud_save_options_init(ewa_cloud_save_options *options, size_t struct_size) {
    ewa_options_init(&ewa_cloud_save_options_table, options, struct_size);
}

ewa_status ewa_cloud_damage(const ewa_cloud_source *source, uint64_t lost_count, const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    ewa_format_list(text, sizeof text, format, arguments);
    va_end(arguments);
    if (!source->options->keep_going)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s (keep_going leaves out what is damaged)", text);
    *source->lost_count += lost_count;
    ewa_report(source->context, EWA_SEVERITY_WARNING, "%s; %llu points lost", text,
               (unsigned long long)lost_count);
    return EWA_OK;
}

void ewa_cloud_passed(const ewa_cloud_source *source, uint64_t at_bytes) {
    if (source->mapped) ewa_file_passed(source->bytes, at_bytes);
}

/// Whether a name is among names that commas separate; "position" always is.
static bool is_wanted(const char *wanted, const char *name) {
    if (!wanted || strcmp(name, EWA_POSITION) == 0) return true;
    const size_t length = strlen(name);
    for (const char *at = wanted; *at;) {
        const size_t word_length = strcspn(at, ",");
        if (word_length == length && memcmp(at, name, length) == 0) return true;
        at += word_length + (at[word_length] == ',');
    }
    return false;
}

static ewa_status check_limits(ewa_context *context, const char *name, const ewa_cloud *prototype,
                               const char *wanted, uint64_t point_count) {
    const ewa_limits *limits = ewa_context_limits(context);
    if (point_count > limits->max_points)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %llu points are over the limit of %llu", name,
                        (unsigned long long)point_count, (unsigned long long)limits->max_points);
    uint64_t point_bytes = 0, total;
    const ewa_attribute *attribute;
    for (uint32_t i = 0; (attribute = ewa_cloud_attribute_at(prototype, i)); i++)
        if (is_wanted(wanted, attribute->name)) point_bytes += attribute->stride_bytes;
    if (__builtin_mul_overflow(point_bytes, point_count, &total)) total = UINT64_MAX;
    return ewa_memory_check(context, total, "%s: %llu points of %llu bytes", name, (unsigned long long)point_count,
                            (unsigned long long)point_bytes);
}

ewa_status ewa_cloud_make_room(const char *name, const ewa_cloud *prototype, const char *wanted,
                               uint64_t point_count, ewa_cloud **cloud, ewa_cloud_sink *sinks) {
    ewa_context *context = ewa_cloud_context(prototype);
    ewa_cloud *made = NULL;
    ewa_status status = check_limits(context, name, prototype, wanted, point_count);
    if (status == EWA_OK) status = ewa_cloud_create(context, point_count, &made);
    const ewa_attribute *attribute;
    for (uint32_t i = 0; status == EWA_OK && (attribute = ewa_cloud_attribute_at(prototype, i)); i++) {
        sinks[i] = (ewa_cloud_sink){.to = NULL};
        if (!is_wanted(wanted, attribute->name)) continue;
        void *data = NULL;
        status = ewa_cloud_add(made, attribute->name, attribute->type, attribute->component_count, &data);
        sinks[i] = (ewa_cloud_sink){data, attribute->stride_bytes};
    }
    if (status == EWA_OK) status = ewa_cloud_follow(made, prototype);
    if (status != EWA_OK) ewa_cloud_destroy(&made);
    *cloud = made;
    return status;
}

const ewa_cloud_write_format *ewa_cloud_write_format_of(const char *path) {
    static const ewa_cloud_write_format *const known[] = {&ewa_write_ply, &ewa_write_las, &ewa_write_pcd,
                                                          &ewa_write_text};
    const char *dot = strrchr(ewa_platform_file_name(path), '.');
    for (size_t i = 0; dot && i < sizeof known / sizeof known[0]; i++)
        for (const char *at = known[i]->suffixes; *at;) {
            const size_t length = strcspn(at, "|");
            if (strlen(dot) == length && strncasecmp(dot, at, length) == 0) return known[i];
            at += length + (at[length] == '|');
        }
    // Streams and devices have no suffix to choose by; files that lie in memory, below /dev/shm, have one.
    const bool stream = strcmp(path, "-") == 0 || strncmp(path, "/dev/", 5) == 0;
    return stream && !dot ? known[0] : NULL;
}
