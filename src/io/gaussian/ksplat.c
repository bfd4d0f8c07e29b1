// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// .ksplat: sections of records, at level 0 in floats, at levels 1 and 2 with centres as steps from the middles of cubes
// ("buckets") and half floats.
//
// Based on: M. Kellogg, GaussianSplats3D, SplatBuffer.js, version 0.1.
#include "io/gaussian/gaussian.h"

#include <strings.h>

enum {
    HEAD_BYTES = 4096,
    SECTION_BYTES = 1024,
    CENTER_STEPS = 32767, ///< half the steps of a cube where the section does not say
    MAX_DEGREE = 2,       ///< of harmonics: the format has no more
    BUCKET_BYTES = 12,
};

/// The record of a level: where its parts begin.
typedef struct layout {
    uint32_t scale_at, rotation_at, color_at, rest_at, number_bytes, rest_bytes;
} layout;

static const layout layouts[] = {{12, 24, 40, 44, 4, 4}, {6, 12, 20, 24, 2, 2}, {6, 12, 20, 24, 2, 1}};

typedef struct section {
    uint64_t count, room; ///< records that are used, and that there is room for
    uint64_t bucket_size, bucket_count, full_buckets, partial_buckets;
    uint32_t sh_degree;
    uint32_t record_bytes;
    double step_world, middle_step;
    const uint8_t *partial_sizes, *buckets, *records;
} section;

typedef struct ksplat {
    const ewa_gaussian_source *source;
    const layout *layout;
    uint64_t count, section_count;
    uint32_t sh_degree; ///< the highest of the sections
    double low_rest, high_rest;
} ksplat;

static ewa_status fail(const ewa_gaussian_source *source, const char *what) {
    return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: ksplat: %s", source->name, what);
}

/// Reads the head of a section and finds its parts from byte `*at` on, over which it steps.
static ewa_status open_section(const ksplat *file, uint64_t number, uint64_t *at, section *made) {
    const ewa_gaussian_source *source = file->source;
    const uint8_t *head = source->bytes + HEAD_BYTES + number * SECTION_BYTES;
    const uint32_t steps = ewa_bytes_u32(head + 24);
    *made = (section){.count = ewa_bytes_u32(head),
                      .room = ewa_bytes_u32(head + 4),
                      .bucket_size = ewa_bytes_u32(head + 8),
                      .bucket_count = ewa_bytes_u32(head + 12),
                      .full_buckets = ewa_bytes_u32(head + 32),
                      .partial_buckets = ewa_bytes_u32(head + 36),
                      .sh_degree = ewa_file_u16(head + 40),
                      .middle_step = steps ? steps : CENTER_STEPS};
    made->step_world = (double)ewa_file_f32(head + 16) / 2 / made->middle_step;
    const uint64_t bucket_bytes = ewa_file_u16(head + 20);
    if (made->count == 0 && made->room == 0) return EWA_OK;
    if (made->sh_degree > MAX_DEGREE) return fail(source, "a section with harmonics over degree 2");
    if (made->count > made->room) return fail(source, "a section of more records than it has room for");
    made->record_bytes =
        file->layout->rest_at + 3 * (ewa_sh_count(made->sh_degree) - 1) * file->layout->rest_bytes;
    const uint64_t buckets_bytes = bucket_bytes * made->bucket_count,
                   partial_bytes = 4 * made->partial_buckets, records_bytes = made->record_bytes * made->room,
                   left = source->size_bytes - *at;
    // Counts of 32 bits times few bytes: no sum of these overflows.
    if (partial_bytes + buckets_bytes + records_bytes > left)
        return fail(source, "a section ends behind the file");
    if (made->bucket_count && bucket_bytes != BUCKET_BYTES)
        return fail(source, "buckets that are no three floats");
    if (made->full_buckets + made->partial_buckets > made->bucket_count)
        return fail(source, "a section with fewer buckets than it uses");
    made->partial_sizes = source->bytes + *at;
    made->buckets = made->partial_sizes + partial_bytes;
    made->records = made->buckets + buckets_bytes;
    *at += partial_bytes + buckets_bytes + records_bytes;
    return EWA_OK;
}

static float read_number(const layout *form, const uint8_t *bytes, uint32_t index) {
    return form->number_bytes == 4 ? ewa_file_f32(bytes + 4 * index) : ewa_file_f16(bytes + 2 * index);
}

static float read_rest(const ksplat *file, const uint8_t *bytes, uint32_t index) {
    if (file->layout->rest_bytes == 4) return ewa_file_f32(bytes + 4 * index);
    if (file->layout->rest_bytes == 2) return ewa_file_f16(bytes + 2 * index);
    return (float)(file->low_rest + bytes[index] / 255.0 * (file->high_rest - file->low_rest));
}

/// Harmonics lie by degree, then by colour.
static void decode_harmonics(const ksplat *file, uint32_t sh_degree, const uint8_t *record,
                             float *harmonics) {
    uint32_t at = 0;
    for (uint32_t k = 0; k < 3; k++)
        harmonics[k] = ewa_sh_of_color(record[file->layout->color_at + k] / 255.0);
    for (uint32_t degree = 1; degree <= sh_degree; degree++)
        for (uint32_t color = 0; color < 3; color++)
            for (uint32_t n = degree * degree; n < ewa_sh_count(degree); n++)
                harmonics[3 * n + color] = read_rest(file, record + file->layout->rest_at, at++);
}

/// Records that a bucket has: the first buckets are full, of the others the sizes are listed.
static uint64_t bucket_count(const section *from, uint64_t bucket) {
    return bucket < from->full_buckets
               ? from->bucket_size
               : ewa_bytes_u32(from->partial_sizes + 4 * (bucket - from->full_buckets));
}

static void decode_record(const ksplat *file, const section *from, const uint8_t *record, uint64_t bucket,
                          uint32_t i, ewa_gaussians *set) {
    const layout *form = file->layout;
    float *center = set->centers + 3 * (size_t)i;
    for (uint32_t k = 0; k < 3; k++) {
        if (form->number_bytes == 4) {
            center[k] = ewa_file_f32(record + 4 * k);
        } else {
            const double middle = (double)ewa_file_f32(from->buckets + bucket * BUCKET_BYTES + 4 * k);
            center[k] =
                (float)(((double)ewa_file_u16(record + 2 * k) - from->middle_step) * from->step_world +
                        middle);
        }
        set->scales[3 * (size_t)i + k] = read_number(form, record + form->scale_at, k);
    }
    for (uint32_t k = 0; k < 4; k++)
        set->rotations[4 * (size_t)i + k] = read_number(form, record + form->rotation_at, k);
    set->opacities[i] = (float)(record[form->color_at + 3] / 255.0);
    decode_harmonics(file, from->sh_degree, record,
                     set->harmonics + (size_t)i * 3 * ewa_sh_count(set->sh_degree));
}

/// Decodes a section to the Gaussians from `first` on.
static ewa_status decode_section(const ksplat *file, const section *from, uint32_t first,
                                 ewa_gaussians *set) {
    const bool in_buckets = file->layout->number_bytes == 2;
    const uint64_t buckets = from->full_buckets + from->partial_buckets;
    uint64_t bucket = 0, left = in_buckets && buckets ? bucket_count(from, 0) : 0;
    for (uint64_t r = 0; r < from->count; r++) {
        while (in_buckets && left == 0) {
            if (++bucket >= buckets) return fail(file->source, "records that are in none of the buckets");
            left = bucket_count(from, bucket);
        }
        decode_record(file, from, from->records + r * from->record_bytes, bucket, first + (uint32_t)r, set);
        left--;
    }
    return EWA_OK;
}

/// Reads the head and looks through the sections. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED.
static ewa_status open_file(const ewa_gaussian_source *source, ksplat *file) {
    const uint8_t *head = source->bytes;
    if (source->size_bytes < HEAD_BYTES) return fail(source, "the file ends in its header");
    if (head[0] != 0 || head[1] < 1)
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED, "%s: ksplat of version %u.%u; 0.1 is read",
                        source->name, head[0], head[1]);
    const uint32_t level = ewa_file_u16(head + 20);
    if (level >= sizeof layouts / sizeof layouts[0])
        return ewa_fail(source->context, EWA_ERROR_UNSUPPORTED, "%s: ksplat of level %u; 0 to 2 are read",
                        source->name, level);
    const double low = (double)ewa_file_f32(head + 36), high = (double)ewa_file_f32(head + 40);
    *file = (ksplat){.source = source,
                     .layout = &layouts[level],
                     .count = ewa_bytes_u32(head + 16),
                     .section_count = ewa_bytes_u32(head + 4),
                     .low_rest = low != 0 ? low : -1.5,
                     .high_rest = high != 0 ? high : 1.5};
    if (file->section_count > (source->size_bytes - HEAD_BYTES) / SECTION_BYTES)
        return fail(source, "the file ends in the headers of its sections");
    uint64_t at = HEAD_BYTES + file->section_count * SECTION_BYTES, sum = 0;
    for (uint64_t s = 0; s < file->section_count; s++) {
        section found;
        EWA_TRY(open_section(file, s, &at, &found));
        sum += found.count;
        if (found.sh_degree > file->sh_degree) file->sh_degree = found.sh_degree;
    }
    return sum == file->count ? EWA_OK
                              : fail(source, "the sections have not as many records as the header says");
}

static ewa_status read_ksplat(const ewa_gaussian_source *source, ewa_gaussians *set,
                              ewa_gaussian_facts *facts) {
    ksplat file;
    EWA_TRY(open_file(source, &file));
    EWA_TRY(ewa_gaussians_make(source, file.count, file.layout->rest_at, source->size_bytes, file.sh_degree,
                               set));
    uint64_t at = HEAD_BYTES + file.section_count * SECTION_BYTES;
    uint32_t first = 0;
    for (uint64_t s = 0; s < file.section_count; s++) {
        section from;
        EWA_TRY(open_section(&file, s, &at, &from));
        EWA_TRY(decode_section(&file, &from, first, set));
        first += (uint32_t)from.count;
    }
    facts->version = source->bytes[1];
    return ewa_gaussians_settle(source, &(ewa_gaussian_form){.log_scales = false}, set);
}

/// There is no magic: the version, a level, and a first section that can be.
static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    (void)status;
    const size_t length = strlen(source->name);
    if (length > 7 && strcasecmp(source->name + length - 7, ".ksplat") == 0) return true;
    const uint8_t *head = source->bytes;
    if (source->size_bytes < HEAD_BYTES + SECTION_BYTES || head[0] != 0 || head[1] != 1) return false;
    const uint32_t sections = ewa_bytes_u32(head + 4), count = ewa_bytes_u32(head + 16),
                   level = ewa_file_u16(head + 20);
    for (uint32_t k = 64; k < HEAD_BYTES; k++)
        if (head[k]) return false;
    return sections > 0 && sections <= (source->size_bytes - HEAD_BYTES) / SECTION_BYTES && level < 3 &&
           count > 0 && ewa_file_u16(head + HEAD_BYTES + 40) <= MAX_DEGREE;
}

const ewa_gaussian_reader ewa_gaussians_ksplat = {EWA_GAUSSIANS_KSPLAT, probe, read_ksplat};
