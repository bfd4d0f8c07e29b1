// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Point clouds: named streams, conversion on reading, bounds.
#include "ewa/cloud.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/notes.h"

#include <math.h>
#include <string.h>

struct ewa_cloud {
    ewa_context *context;
    uint64_t point_count, point_capacity; // the streams that are owned have room for so many
    double origin_world[3];
    ewa_coordinate_grid grid;
    ewa_notes notes;
    ewa_attribute *attributes;
    uint32_t attribute_count, attribute_capacity;
};

enum { BLOCK_POINTS = 1 << 14 };

ewa_status ewa_cloud_create(ewa_context *context, uint64_t point_count, ewa_cloud **cloud) {
    if (!context || !cloud) return EWA_ERROR_ARGUMENT;
    *cloud = NULL;
    const uint64_t limit = ewa_context_limits(context)->max_points;
    if (point_count > limit)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%llu points are over the limit of %llu",
                        (unsigned long long)point_count, (unsigned long long)limit);
    ewa_cloud *made = ewa_allocate(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    *made = (ewa_cloud){.context = context, .point_count = point_count, .point_capacity = point_count};
    *cloud = made;
    return EWA_OK;
}

static void release_attribute(ewa_cloud *cloud, ewa_attribute *attribute) {
    if (!attribute->borrowed)
        ewa_release(cloud->context, attribute->data, cloud->point_capacity, attribute->stride_bytes);
}

void ewa_cloud_destroy(ewa_cloud **cloud) {
    if (!cloud || !*cloud) return;
    ewa_cloud *old = *cloud;
    for (uint32_t i = 0; i < old->attribute_count; i++) release_attribute(old, &old->attributes[i]);
    ewa_release(old->context, old->attributes, old->attribute_capacity, sizeof *old->attributes);
    ewa_notes_free(old->context, &old->notes);
    ewa_release(old->context, old, 1, sizeof *old);
    *cloud = NULL;
}

ewa_context *ewa_cloud_context(const ewa_cloud *cloud) { return cloud->context; }
uint64_t ewa_cloud_point_count(const ewa_cloud *cloud) { return cloud->point_count; }
uint32_t ewa_cloud_attribute_count(const ewa_cloud *cloud) { return cloud->attribute_count; }

const ewa_attribute *ewa_cloud_attribute_at(const ewa_cloud *cloud, uint32_t index) {
    return index < cloud->attribute_count ? &cloud->attributes[index] : NULL;
}

const ewa_attribute *ewa_cloud_find(const ewa_cloud *cloud, const char *name) {
    for (uint32_t i = 0; i < cloud->attribute_count; i++)
        if (strcmp(cloud->attributes[i].name, name) == 0) return &cloud->attributes[i];
    return NULL;
}

bool ewa_cloud_is_drawable(const ewa_cloud *cloud) {
    if (!cloud) return false;
    return (ewa_cloud_find(cloud, EWA_TANGENT_U) && ewa_cloud_find(cloud, EWA_TANGENT_V)) ||
           (ewa_cloud_find(cloud, EWA_NORMAL) && ewa_cloud_find(cloud, EWA_RADIUS));
}

static ewa_status check_shape(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t component_count) {
    const size_t length = name ? strlen(name) : 0;
    if (length == 0 || length >= EWA_NAME_BYTES)
        return ewa_fail(cloud->context, EWA_ERROR_ARGUMENT, "attribute name of %zu bytes (1 to %d allowed)",
                        length, EWA_NAME_BYTES - 1);
    if (ewa_type_bytes(type) == 0 || component_count < 1 || component_count > 4)
        return ewa_fail(cloud->context, EWA_ERROR_ARGUMENT, "attribute '%s': type %d with %u components",
                        name, (int)type, component_count);
    return EWA_OK;
}

/// Puts the attribute in place of one of the same name, or at the end.
static ewa_status put(ewa_cloud *cloud, const ewa_attribute *attribute) {
    for (uint32_t i = 0; i < cloud->attribute_count; i++) {
        if (strcmp(cloud->attributes[i].name, attribute->name) != 0) continue;
        release_attribute(cloud, &cloud->attributes[i]);
        cloud->attributes[i] = *attribute;
        return EWA_OK;
    }
    if (cloud->attribute_count == cloud->attribute_capacity) {
        const uint32_t capacity = cloud->attribute_capacity ? 2 * cloud->attribute_capacity : 8;
        ewa_attribute *larger = ewa_allocate(cloud->context, capacity, sizeof *larger);
        if (!larger) return EWA_ERROR_MEMORY;
        if (cloud->attribute_count)
            memcpy(larger, cloud->attributes, cloud->attribute_count * sizeof *larger);
        ewa_release(cloud->context, cloud->attributes, cloud->attribute_capacity, sizeof *larger);
        cloud->attributes = larger;
        cloud->attribute_capacity = capacity;
    }
    cloud->attributes[cloud->attribute_count++] = *attribute;
    return EWA_OK;
}

ewa_status ewa_cloud_add(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t component_count,
                         void **data) {
    if (!cloud) return EWA_ERROR_ARGUMENT;
    EWA_TRY(check_shape(cloud, name, type, component_count));
    ewa_attribute attribute = {.type = type,
                               .component_count = component_count,
                               .stride_bytes = component_count * ewa_type_bytes(type)};
    memcpy(attribute.name, name, strlen(name) + 1);
    attribute.data = ewa_allocate(cloud->context, cloud->point_capacity, attribute.stride_bytes);
    if (!attribute.data) return EWA_ERROR_MEMORY;
    ewa_status status = put(cloud, &attribute);
    if (status != EWA_OK)
        release_attribute(cloud, &attribute);
    else if (data)
        *data = attribute.data;
    return status;
}

ewa_status ewa_cloud_borrow(ewa_cloud *cloud, const char *name, ewa_type type, uint32_t component_count,
                            const void *data, size_t stride_bytes) {
    if (!cloud) return EWA_ERROR_ARGUMENT;
    EWA_TRY(check_shape(cloud, name, type, component_count));
    const size_t packed_bytes = component_count * ewa_type_bytes(type);
    if (stride_bytes == 0) stride_bytes = packed_bytes;
    if ((!data && cloud->point_count) || stride_bytes < packed_bytes || stride_bytes % ewa_type_bytes(type) ||
        (uintptr_t)data % ewa_type_bytes(type))
        return ewa_fail(cloud->context, EWA_ERROR_ARGUMENT,
                        "attribute '%s': stride of %zu bytes for %zu, or misaligned", name, stride_bytes,
                        packed_bytes);
    ewa_attribute attribute = {.type = type,
                               .component_count = component_count,
                               .stride_bytes = stride_bytes,
                               .data = (void *)(uintptr_t)data,
                               .borrowed = true};
    memcpy(attribute.name, name, strlen(name) + 1);
    return put(cloud, &attribute);
}

void ewa_cloud_remove(ewa_cloud *cloud, const char *name) {
    for (uint32_t i = 0; i < cloud->attribute_count; i++) {
        if (strcmp(cloud->attributes[i].name, name) != 0) continue;
        release_attribute(cloud, &cloud->attributes[i]);
        memmove(&cloud->attributes[i], &cloud->attributes[i + 1],
                (cloud->attribute_count - i - 1) * sizeof *cloud->attributes);
        cloud->attribute_count--;
        return;
    }
}

void ewa_cloud_set_origin(ewa_cloud *cloud, const double origin_world[3]) {
    memcpy(cloud->origin_world, origin_world, sizeof cloud->origin_world);
}

void ewa_cloud_origin(const ewa_cloud *cloud, double origin_world[3]) {
    memcpy(origin_world, cloud->origin_world, sizeof cloud->origin_world);
}

void ewa_cloud_set_grid(ewa_cloud *cloud, const ewa_coordinate_grid *grid) { cloud->grid = *grid; }
void ewa_cloud_grid(const ewa_cloud *cloud, ewa_coordinate_grid *grid) { *grid = cloud->grid; }

ewa_status ewa_cloud_set_note(ewa_cloud *cloud, const char *name, const void *bytes, size_t size_bytes) {
    if (!cloud || (size_bytes && !bytes)) return EWA_ERROR_ARGUMENT;
    return ewa_notes_set(cloud->context, &cloud->notes, name, bytes, size_bytes);
}

const char *ewa_cloud_note(const ewa_cloud *cloud, const char *name, size_t *size_bytes) {
    const ewa_note *note = ewa_notes_find(&cloud->notes, name);
    if (size_bytes) *size_bytes = note ? note->size_bytes : 0;
    return note ? note->bytes : NULL;
}

const char *ewa_cloud_note_name(const ewa_cloud *cloud, uint32_t index) {
    return index < cloud->notes.count ? cloud->notes.notes[index].name : NULL;
}

ewa_status ewa_cloud_follow(ewa_cloud *cloud, const ewa_cloud *source) {
    memcpy(cloud->origin_world, source->origin_world, sizeof cloud->origin_world);
    cloud->grid = source->grid;
    for (uint32_t i = 0; i < source->notes.count; i++) {
        const ewa_note *note = &source->notes.notes[i];
        EWA_TRY(ewa_notes_set(cloud->context, &cloud->notes, note->name, note->bytes, note->size_bytes));
    }
    return EWA_OK;
}

ewa_status ewa_cloud_like(const ewa_cloud *cloud, ewa_cloud **like) {
    ewa_cloud *made = NULL;
    ewa_status status = ewa_cloud_create(cloud->context, 0, &made);
    for (uint32_t i = 0; i < cloud->attribute_count && status == EWA_OK; i++) {
        const ewa_attribute *attribute = &cloud->attributes[i];
        status = ewa_cloud_add(made, attribute->name, attribute->type, attribute->component_count, NULL);
    }
    if (status == EWA_OK) status = ewa_cloud_follow(made, cloud);
    if (status != EWA_OK) ewa_cloud_destroy(&made);
    *like = made;
    return status;
}

bool ewa_cloud_is_alike(const ewa_cloud *a, const ewa_cloud *b) {
    bool alike = a->attribute_count == b->attribute_count;
    for (uint32_t i = 0; i < b->attribute_count && alike; i++) {
        const ewa_attribute *p = &a->attributes[i], *q = &b->attributes[i];
        alike =
            strcmp(p->name, q->name) == 0 && p->type == q->type && p->component_count == q->component_count;
    }
    return alike;
}

void ewa_cloud_truncate(ewa_cloud *cloud, uint64_t point_count) {
    if (point_count < cloud->point_count) cloud->point_count = point_count;
}

/// Packed numbers are one run, of which the compiler makes vectors.
#define READ_AS(source_type, target)                                                                         \
    if (stride == components * sizeof(source_type)) {                                                        \
        const source_type *from = (const source_type *)(const void *)bytes;                                  \
        for (uint64_t i = 0; i < count * components; i++) values[i] = (target)from[i];                       \
        break;                                                                                               \
    }                                                                                                        \
    for (uint64_t i = 0; i < count; i++, bytes += stride) {                                                  \
        const source_type *from = (const source_type *)(const void *)bytes;                                  \
        for (uint32_t c = 0; c < components; c++) *values++ = (target)from[c];                               \
    }                                                                                                        \
    break

#define READ_ALL(target)                                                                                     \
    const size_t stride = attribute->stride_bytes;                                                           \
    const uint32_t components = attribute->component_count;                                                  \
    const char *bytes = (const char *)attribute->data + first * stride;                                      \
    switch (attribute->type) {                                                                               \
    case EWA_F32:                                                                                            \
        READ_AS(float, target);                                                                              \
    case EWA_F64:                                                                                            \
        READ_AS(double, target);                                                                             \
    case EWA_I8:                                                                                             \
        READ_AS(int8_t, target);                                                                             \
    case EWA_U8:                                                                                             \
        READ_AS(uint8_t, target);                                                                            \
    case EWA_I16:                                                                                            \
        READ_AS(int16_t, target);                                                                            \
    case EWA_U16:                                                                                            \
        READ_AS(uint16_t, target);                                                                           \
    case EWA_I32:                                                                                            \
        READ_AS(int32_t, target);                                                                            \
    case EWA_U32:                                                                                            \
        READ_AS(uint32_t, target);                                                                           \
    }

void ewa_attribute_read_f32(const ewa_attribute *attribute, uint64_t first, uint64_t count, float *values) {
    READ_ALL(float)
}

void ewa_attribute_read_f64(const ewa_attribute *attribute, uint64_t first, uint64_t count, double *values) {
    READ_ALL(double)
}

typedef struct measure_job {
    const ewa_attribute *position;
    uint64_t point_count;
    uint32_t parts;
    ewa_bounds *partial; // one per part
} measure_job;

enum { MEASURE_POINTS = 256, PATTERN = 12 }; // a pattern is a whole number of points and of vectors

/// Grows a box by points that are all finite, in loops that make full vectors. Returns false, the box
/// unchanged, when some are not.
static bool measure_finite(const double *points, uint64_t count, ewa_bounds *box) {
    double low[PATTERN], high[PATTERN], unbounded[PATTERN] = {0};
    for (int k = 0; k < PATTERN; k++) low[k] = INFINITY, high[k] = -INFINITY;
    uint64_t at = 0;
    for (; at + PATTERN <= 3 * count; at += PATTERN)
        for (int k = 0; k < PATTERN; k++) {
            const double value = points[at + k];
            low[k] = value < low[k] ? value : low[k];
            high[k] = value > high[k] ? value : high[k];
            unbounded[k] += value - value; // becomes NaN
        }
    for (int k = 0; at < 3 * count; at++, k++) {
        low[k] = points[at] < low[k] ? points[at] : low[k];
        high[k] = points[at] > high[k] ? points[at] : high[k];
        unbounded[k] += points[at] - points[at];
    }
    for (int k = 0; k < PATTERN; k++)
        if (unbounded[k] != 0) return false;
    for (int k = 0; k < PATTERN; k++) {
        box->low_world[k % 3] = low[k] < box->low_world[k % 3] ? low[k] : box->low_world[k % 3];
        box->high_world[k % 3] = high[k] > box->high_world[k % 3] ? high[k] : box->high_world[k % 3];
    }
    box->finite_count += count;
    return true;
}

static void measure_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const measure_job *job = data;
    ewa_bounds box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
    const uint64_t end = ewa_split(job->point_count, job->parts, part + 1);
    double block[3 * MEASURE_POINTS];
    for (uint64_t first = ewa_split(job->point_count, job->parts, part), count; first < end; first += count) {
        count = end - first < MEASURE_POINTS ? end - first : MEASURE_POINTS;
        ewa_attribute_read_f64(job->position, first, count, block);
        if (measure_finite(block, count, &box)) continue;
        for (uint64_t i = 0; i < count; i++) {
            const double *p = &block[3 * i];
            if (isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2])) measure_finite(p, 1, &box);
        }
    }
    job->partial[part] = box;
}

void ewa_position_measure(ewa_context *context, const ewa_attribute *position, uint64_t count,
                          ewa_bounds *bounds) {
    enum { MAX_PARTS = 64 };
    ewa_bounds partial[MAX_PARTS];
    const uint64_t blocks = count / BLOCK_POINTS + 1;
    measure_job job = {position, count, blocks < MAX_PARTS ? (uint32_t)blocks : MAX_PARTS, partial};
    ewa_parallel(context, measure_part, &job, job.parts);
    *bounds = partial[0];
    for (uint32_t part = 1; part < job.parts; part++) {
        bounds->finite_count += partial[part].finite_count;
        for (int c = 0; c < 3; c++) {
            bounds->low_world[c] = fmin(bounds->low_world[c], partial[part].low_world[c]);
            bounds->high_world[c] = fmax(bounds->high_world[c], partial[part].high_world[c]);
        }
    }
}

ewa_status ewa_cloud_measure(const ewa_cloud *cloud, ewa_bounds *bounds) {
    if (!cloud || !bounds) return EWA_ERROR_ARGUMENT;
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    if (!position || position->component_count != 3)
        return ewa_fail(cloud->context, EWA_ERROR_ARGUMENT, "the cloud has no positions of three components");
    ewa_position_measure(cloud->context, position, cloud->point_count, bounds);
    for (int c = 0; c < 3 && bounds->finite_count; c++) {
        bounds->low_world[c] += cloud->origin_world[c];
        bounds->high_world[c] += cloud->origin_world[c];
    }
    return EWA_OK;
}
