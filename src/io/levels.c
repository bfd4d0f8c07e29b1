// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Table and blocks of the surfels that represent nodes' points.
#include "io/levels.h"
#include "io/deflate.h"
#include "io/las/las.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    PLANES = 16, CURVED_PLANES = 18, // bytes of a surfel, one plane each, without and with its curvature
    COMPRESSION = 4,
    AT_STEPS = 65536,
    NORMAL_STEPS =
        2047, // octahedral coordinates are whole numbers of 12 bits, shifted to the upper ones of 16
    NORMAL_SHIFT = 4,
};

static float read_f32(const uint8_t *bytes) {
    const uint32_t bits = ewa_bytes_u32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void write_f32(uint8_t *bytes, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    ewa_las_put_u32(bytes, bits);
}

static int compare_pages(const void *a, const void *b) {
    return ewa_octree_key_compare(&((const ewa_levels_page *)a)->key, &((const ewa_levels_page *)b)->key);
}

/// What is wrong with a page; NULL: nothing.
static const char *check_page(const ewa_levels_page *page, uint64_t size_bytes) {
    const ewa_octree_key *key = &page->key;
    if (key->level < 0 || key->level >= EWA_OCTREE_LEVELS) return "a level is out of range";
    for (int c = 0; c < 3; c++)
        if (key->cell[c] < 0 || key->cell[c] >= (int64_t)1 << key->level) return "a key is no node";
    if (page->surfel_count > EWA_LEVELS_MAX_SURFELS) return "a node has too many surfels";
    if (page->at_bytes > size_bytes || page->size_bytes > size_bytes - page->at_bytes ||
        page->attributes_bytes > size_bytes - page->at_bytes - page->size_bytes)
        return "a block lies beyond the record";
    if (!(page->radius_scale > 0 && page->radius_scale <= 16) || !(page->error >= 0 && page->error <= 255) ||
        !(page->largest_radius_world >= 0 && isfinite(page->largest_radius_world)) ||
        !(page->unit_coverage >= 0 && page->unit_coverage < 1e6f))
        return "a node's numbers are out of range";
    return NULL;
}

/// Whether every page but the root follows its parent.
static const char *check_tree(const ewa_levels *levels) {
    for (uint32_t i = 0; i < levels->page_count; i++) {
        const ewa_levels_page *page = &levels->pages[i];
        if (i > 0 && compare_pages(&levels->pages[i - 1], page) == 0) return "a node comes twice";
        if (page->key.level == 0) continue;
        ewa_levels_page parent = {.key = {.level = page->key.level - 1}};
        for (int c = 0; c < 3; c++) parent.key.cell[c] = page->key.cell[c] >> 1;
        const ewa_levels_page *found =
            bsearch(&parent, levels->pages, levels->page_count, sizeof parent, compare_pages);
        if (!found || !found->size_bytes) return "a node is no part of one that is divided";
    }
    return NULL;
}

/// Attributes that a head says, which versions before the third have none of.
static uint32_t read_attribute_count(const uint8_t *head) { return ewa_bytes_u32(head + 4) > 2 ? ewa_bytes_u32(head + 12) : 0; }

/// Byte of the table of pages.
static uint64_t pages_at(uint32_t attribute_count) {
    return EWA_LEVELS_HEAD_BYTES + (uint64_t)attribute_count * EWA_LEVELS_ATTRIBUTE_BYTES;
}

uint64_t ewa_levels_table_bytes(const uint8_t *head, uint64_t size_bytes) {
    if (size_bytes < EWA_LEVELS_HEAD_BYTES) return size_bytes;
    const uint64_t table_bytes = pages_at(read_attribute_count(head)) + (uint64_t)ewa_bytes_u32(head + 8) * EWA_LEVELS_PAGE_BYTES;
    return table_bytes < size_bytes ? table_bytes : size_bytes;
}

bool ewa_level_attribute_is_free(const char *name) {
    static const char *const taken[] = {EWA_POSITION, EWA_NORMAL, EWA_RADIUS, EWA_COLOR, EWA_CURVATURE};
    for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++)
        if (strcmp(name, taken[i]) == 0) return false;
    return name[0] != 0;
}

/// Reads the attributes; what is wrong with them, NULL: nothing.
static const char *read_attributes(const uint8_t *bytes, uint32_t count, ewa_levels *levels) {
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t *entry = bytes + EWA_LEVELS_HEAD_BYTES + (size_t)i * EWA_LEVELS_ATTRIBUTE_BYTES;
        ewa_level_attribute *attribute = &levels->attributes[i];
        memcpy(attribute->name, entry, EWA_NAME_BYTES);
        const uint32_t type = ewa_bytes_u32(entry + EWA_NAME_BYTES);
        if (!memchr(attribute->name, 0, EWA_NAME_BYTES) || type > EWA_U32) return "an attribute";
        attribute->type = (ewa_type)type;
        bool is_free = ewa_level_attribute_is_free(attribute->name);
        for (uint32_t k = 0; k < i; k++) is_free = is_free && strcmp(levels->attributes[k].name, attribute->name) != 0;
        if (!is_free) return "an attribute comes twice";
    }
    levels->attribute_count = count;
    return NULL;
}

ewa_status ewa_levels_read(ewa_context *context, const char *name, const uint8_t *bytes, uint64_t size_bytes,
                           ewa_levels *levels) {
    *levels = (ewa_levels){0};
    if (size_bytes < EWA_LEVELS_HEAD_BYTES || memcmp(bytes, "EWAL", 4) != 0)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the record of surfels has no head", name);
    const uint32_t version = ewa_bytes_u32(bytes + 4);
    if (version < 1 || version > EWA_LEVELS_VERSION)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: the record of surfels is of version %u, not 1 to %d", name,
                        version, EWA_LEVELS_VERSION);
    levels->has_curvatures = version > 1;
    const uint32_t count = ewa_bytes_u32(bytes + 8), attributes = read_attribute_count(bytes);
    levels->unit_coverage = ewa_las_f64(bytes + 16);
    if (attributes > EWA_LEVELS_MAX_ATTRIBUTES || pages_at(attributes) > size_bytes ||
        count > (size_bytes - pages_at(attributes)) / EWA_LEVELS_PAGE_BYTES ||
        !(levels->unit_coverage >= 0 && levels->unit_coverage < 1e6))
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: the record of surfels is damaged: its head", name);
    levels->pages = ewa_allocate(context, count, sizeof *levels->pages);
    if (!levels->pages) return EWA_ERROR_MEMORY;
    levels->page_count = count;
    const char *fault = read_attributes(bytes, attributes, levels);
    for (uint32_t i = 0; i < count && !fault; i++) {
        const uint8_t *entry = bytes + pages_at(attributes) + (size_t)i * EWA_LEVELS_PAGE_BYTES;
        ewa_levels_page *page = &levels->pages[i];
        *page = (ewa_levels_page){.key = {.level = (int32_t)ewa_bytes_u32(entry)},
                                  .point_count = ewa_las_u64(entry + 16),
                                  .surfel_count = ewa_bytes_u32(entry + 24),
                                  .radius_scale = read_f32(entry + 28),
                                  .error = read_f32(entry + 32),
                                  .largest_radius_world = read_f32(entry + 36),
                                  .unit_coverage = read_f32(entry + 52),
                                  .at_bytes = ewa_las_u64(entry + 40),
                                  .size_bytes = ewa_bytes_u32(entry + 48),
                                  .attributes_bytes = attributes ? ewa_bytes_u32(entry + 56) : 0};
        for (int c = 0; c < 3; c++) page->key.cell[c] = (int32_t)ewa_bytes_u32(entry + 4 + 4 * c);
        fault = check_page(page, size_bytes);
        levels->surfel_count += page->surfel_count;
    }
    if (!fault) {
        qsort(levels->pages, count, sizeof *levels->pages, compare_pages);
        fault = check_tree(levels);
    }
    return fault
               ? ewa_fail(context, EWA_ERROR_FORMAT, "%s: the record of surfels is damaged: %s", name, fault)
               : EWA_OK;
}

void ewa_levels_free(ewa_context *context, ewa_levels *levels) {
    ewa_release(context, levels->pages, levels->page_count, sizeof *levels->pages);
    *levels = (ewa_levels){0};
}

void ewa_levels_write(const ewa_levels *levels, uint8_t *bytes) {
    const uint64_t table_at = pages_at(levels->attribute_count);
    const uint64_t blocks_at = table_at + (uint64_t)levels->page_count * EWA_LEVELS_PAGE_BYTES;
    memset(bytes, 0, (size_t)blocks_at);
    memcpy(bytes, "EWAL", 4);
    ewa_las_put_u32(bytes + 4, levels->attribute_count ? EWA_LEVELS_VERSION : levels->has_curvatures ? 2 : 1);
    ewa_las_put_u32(bytes + 8, levels->page_count);
    ewa_las_put_u32(bytes + 12, levels->attribute_count);
    ewa_las_put_f64(bytes + 16, levels->unit_coverage);
    ewa_las_put_u64(bytes + 24, levels->surfel_count);
    for (uint32_t i = 0; i < levels->attribute_count; i++) {
        uint8_t *entry = bytes + EWA_LEVELS_HEAD_BYTES + (size_t)i * EWA_LEVELS_ATTRIBUTE_BYTES;
        memcpy(entry, levels->attributes[i].name, EWA_NAME_BYTES);
        ewa_las_put_u32(entry + EWA_NAME_BYTES, (uint32_t)levels->attributes[i].type);
    }
    for (uint32_t i = 0; i < levels->page_count; i++) {
        const ewa_levels_page *page = &levels->pages[i];
        uint8_t *entry = bytes + table_at + (size_t)i * EWA_LEVELS_PAGE_BYTES;
        ewa_las_put_u32(entry, (uint32_t)page->key.level);
        for (int c = 0; c < 3; c++) ewa_las_put_u32(entry + 4 + 4 * c, (uint32_t)page->key.cell[c]);
        ewa_las_put_u64(entry + 16, page->point_count);
        ewa_las_put_u32(entry + 24, page->surfel_count);
        write_f32(entry + 28, page->radius_scale);
        write_f32(entry + 32, page->error);
        write_f32(entry + 36, page->largest_radius_world);
        ewa_las_put_u64(entry + 40, page->size_bytes ? blocks_at + page->at_bytes : 0);
        ewa_las_put_u32(entry + 48, page->size_bytes);
        write_f32(entry + 52, page->unit_coverage);
        ewa_las_put_u32(entry + 56, page->attributes_bytes);
    }
}

size_t ewa_level_raw_bytes(uint32_t count, bool has_curvatures) {
    return (size_t)count * (has_curvatures ? CURVED_PLANES : PLANES);
}

/// The upper half of a float, rounded.
static uint32_t code_half(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (bits + 0x8000u) >> 16;
}

static float decode_half(uint32_t code) {
    const uint32_t bits = code << 16;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t code_at(float at) {
    const float steps = floorf(at * AT_STEPS);
    return steps < 0 ? 0 : steps > AT_STEPS - 1 ? AT_STEPS - 1 : (uint32_t)steps;
}

/// The octahedral codes of a unit vector, with NORMAL_STEPS added.
static void code_normal(const float n[3], uint32_t code[2]) {
    const float sum = fabsf(n[0]) + fabsf(n[1]) + fabsf(n[2]);
    float u = sum > 0 ? n[0] / sum : 0, v = sum > 0 ? n[1] / sum : 0;
    if (n[2] < 0) {
        const float folded = copysignf(1 - fabsf(v), u);
        v = copysignf(1 - fabsf(u), v);
        u = folded;
    }
    code[0] = (uint32_t)(lrintf(u * NORMAL_STEPS) + NORMAL_STEPS) << NORMAL_SHIFT;
    code[1] = (uint32_t)(lrintf(v * NORMAL_STEPS) + NORMAL_STEPS) << NORMAL_SHIFT;
}

static void decode_normal(uint32_t code_u, uint32_t code_v, float n[3]) {
    const float u = ((float)(code_u >> NORMAL_SHIFT) - NORMAL_STEPS) / NORMAL_STEPS,
                v = ((float)(code_v >> NORMAL_SHIFT) - NORMAL_STEPS) / NORMAL_STEPS;
    n[2] = 1 - fabsf(u) - fabsf(v);
    const float fold = n[2] < 0 ? -n[2] : 0;
    n[0] = u - copysignf(fold, u);
    n[1] = v - copysignf(fold, v);
    const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int c = 0; c < 3; c++) n[c] /= length;
}

/// Packs planes of bytes.
static ewa_status append_packed(ewa_context *context, const uint8_t *raw, size_t raw_bytes, ewa_buffer *to, size_t *at_bytes) {
    ewa_deflated packed = {0};
    ewa_status status = ewa_deflate(context, EWA_DEFLATE_BARE, COMPRESSION, raw, raw_bytes, &packed);
    if (status == EWA_OK) status = ewa_buffer_grow(context, to, *at_bytes, *at_bytes + packed.size_bytes, 1);
    if (status == EWA_OK) {
        memcpy((uint8_t *)to->data + *at_bytes, packed.bytes, packed.size_bytes);
        *at_bytes += packed.size_bytes;
    }
    ewa_deflated_free(context, &packed);
    return status;
}

/// Unpacks planes of bytes; NULL, or what is wrong.
static const char *unpack(const uint8_t *bytes, size_t size_bytes, uint8_t *raw, size_t raw_bytes) {
    const ewa_status status = ewa_inflate(bytes, size_bytes, raw, raw_bytes);
    return status == EWA_OK                  ? NULL
           : status == EWA_ERROR_MEMORY      ? "there is no memory"
           : status == EWA_ERROR_UNSUPPORTED ? "its surfels are packed as this build cannot unpack (EWA_WITH_DEFLATE)"
                                             : "its surfels cannot be unpacked";
}

ewa_status ewa_level_encode(ewa_context *context, const ewa_level_surfels *surfels, uint32_t count,
                            ewa_buffer *to, size_t *at_bytes) {
    const size_t raw_bytes = ewa_level_raw_bytes(count, surfels->curvature);
    uint8_t *raw = ewa_allocate(context, raw_bytes, 1);
    ewa_status status = raw ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        uint32_t codes[6];
        for (int c = 0; c < 3; c++) codes[c] = code_at(surfels->at[3 * (size_t)i + (size_t)c]);
        code_normal(surfels->normal + 3 * (size_t)i, codes + 3);
        codes[5] = code_half(surfels->radius_world[i]);
        for (size_t k = 0; k < 6; k++) {
            raw[2 * k * count + i] = (uint8_t)(codes[k] >> 8);
            raw[(2 * k + 1) * count + i] = (uint8_t)codes[k];
        }
        for (size_t c = 0; c < 4; c++) raw[(12 + c) * count + i] = surfels->rgba[4 * (size_t)i + c];
        if (!surfels->curvature) continue;
        const uint32_t bend = code_half(surfels->curvature[i]);
        raw[(size_t)PLANES * count + i] = (uint8_t)(bend >> 8);
        raw[((size_t)PLANES + 1) * count + i] = (uint8_t)bend;
    }
    if (status == EWA_OK) status = append_packed(context, raw, raw_bytes, to, at_bytes);
    ewa_release(context, raw, raw_bytes, 1);
    return status;
}

const char *ewa_level_decode(const ewa_levels_page *page, const uint8_t *bytes, uint8_t *scratch,
                             const ewa_level_surfels *surfels) {
    const uint32_t count = page->surfel_count;
    const char *fault = unpack(bytes, page->size_bytes, scratch, ewa_level_raw_bytes(count, surfels->curvature));
    if (fault) return fault;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t codes[6];
        for (size_t k = 0; k < 6; k++)
            codes[k] = (uint32_t)scratch[2 * k * count + i] << 8 | scratch[(2 * k + 1) * count + i];
        for (size_t c = 0; c < 3; c++) surfels->at[3 * (size_t)i + c] = ((float)codes[c] + 0.5f) / AT_STEPS;
        decode_normal(codes[3], codes[4], surfels->normal + 3 * (size_t)i);
        surfels->radius_world[i] = decode_half(codes[5]);
        for (size_t c = 0; c < 4; c++) surfels->rgba[4 * (size_t)i + c] = scratch[(12 + c) * count + i];
        if (!surfels->curvature) continue;
        const float bend = decode_half((uint32_t)scratch[(size_t)PLANES * count + i] << 8 |
                                       scratch[((size_t)PLANES + 1) * count + i]);
        surfels->curvature[i] = isfinite(bend) ? bend : 0;
    }
    return NULL;
}

/// The bits of a number as a type has it, of whole numbers the nearest.
static uint64_t code_number(ewa_type type, double number) {
    if (type == EWA_F64) {
        uint64_t bits;
        memcpy(&bits, &number, sizeof bits);
        return bits;
    }
    if (type == EWA_F32) {
        const float value = (float)number;
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        return bits;
    }
    return (uint64_t)llrint(number);
}

/// Stores the lower bytes of a code in the order of this machine.
static void put_bits(uint8_t *to, size_t size_bytes, uint64_t code) {
    const uint16_t half = (uint16_t)code;
    const uint32_t word = (uint32_t)code;
    if (size_bytes == 1)
        *to = (uint8_t)code;
    else if (size_bytes == 2)
        memcpy(to, &half, sizeof half);
    else if (size_bytes == 4)
        memcpy(to, &word, sizeof word);
    else
        memcpy(to, &code, sizeof code);
}

size_t ewa_level_attribute_bytes(const ewa_levels *levels, uint32_t count) {
    size_t bytes = 0;
    for (uint32_t a = 0; a < levels->attribute_count; a++) bytes += count * ewa_type_bytes(levels->attributes[a].type);
    return bytes;
}

ewa_status ewa_level_encode_attributes(ewa_context *context, const ewa_level_attribute *attributes, uint32_t attribute_count,
                                       const double *numbers, uint32_t count, ewa_buffer *to, size_t *at_bytes) {
    size_t raw_bytes = 0, plane = 0;
    for (uint32_t a = 0; a < attribute_count; a++) raw_bytes += count * ewa_type_bytes(attributes[a].type);
    if (!raw_bytes) return EWA_OK;
    uint8_t *raw = ewa_allocate(context, raw_bytes, 1);
    if (!raw) return EWA_ERROR_MEMORY;
    for (uint32_t a = 0; a < attribute_count; a++) {
        const size_t bytes = ewa_type_bytes(attributes[a].type);
        for (uint32_t i = 0; i < count; i++) {
            const uint64_t code = code_number(attributes[a].type, numbers[(size_t)i * attribute_count + a]);
            for (size_t k = 0; k < bytes; k++) raw[(plane + k) * count + i] = (uint8_t)(code >> 8 * (bytes - 1 - k));
        }
        plane += bytes;
    }
    const ewa_status status = append_packed(context, raw, raw_bytes, to, at_bytes);
    ewa_release(context, raw, raw_bytes, 1);
    return status;
}

const char *ewa_level_decode_attributes(const ewa_levels *levels, const ewa_levels_page *page, const uint8_t *bytes,
                                        uint8_t *scratch, void *const *streams) {
    const uint32_t count = page->surfel_count;
    const char *fault = unpack(bytes, page->attributes_bytes, scratch, ewa_level_attribute_bytes(levels, count));
    const uint8_t *plane = scratch;
    for (uint32_t a = 0; a < levels->attribute_count && !fault; a++) {
        const size_t size_bytes = ewa_type_bytes(levels->attributes[a].type);
        for (uint32_t i = 0; i < count && streams[a]; i++) {
            uint64_t code = 0;
            for (size_t k = 0; k < size_bytes; k++) code = code << 8 | plane[k * count + i];
            put_bits((uint8_t *)streams[a] + i * size_bytes, size_bytes, code);
        }
        plane += size_bytes * count;
    }
    return fault;
}
