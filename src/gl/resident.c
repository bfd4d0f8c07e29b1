// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Copies of surfels on the device.
#include "gl/resident.h"

#include <string.h>

enum { LANES = EWA_PACKET_LANES, MAX_PAGE_PACKETS = 1 << 18 };

/// Copies that the last frame did not use are kept up to so many bytes.
static const uint64_t KEPT_BYTES = 512ull << 20;

static void free_resident(ewa_gl *device, ewa_gl_residents *residents, ewa_gl_resident *old) {
    for (uint32_t i = 0; i < old->page_count && !device->lost; i++) {
        ewa_gl_buffer_free(&old->pages[i].packets);
        ewa_gl_buffer_free(&old->pages[i].attributes);
        ewa_gl_buffer_free(&old->pages[i].bounds);
    }
    ewa_release(device->context, old->pages, old->page_count, sizeof *old->pages);
    residents->size_bytes -= old->size_bytes;
}

/// Drops what this frame has not used.
static void drop_unused(ewa_gl *device, ewa_gl_residents *residents, uint64_t used_min) {
    ewa_gl_resident *items = residents->items.data;
    for (uint32_t i = residents->count; i-- > 0;) {
        if (items[i].used >= used_min) continue;
        free_resident(device, residents, &items[i]);
        items[i] = items[--residents->count];
    }
}

void ewa_gl_residents_start(ewa_gl *device, ewa_gl_residents *residents) {
    if (residents->size_bytes > KEPT_BYTES) drop_unused(device, residents, residents->frame);
    residents->frame++;
}

/// What culling reads of the packets, one array behind the other, each from a whole word on.
static ewa_status put_bounds(ewa_gl *device, const ewa_surfels *surfels, ewa_gl_page *page) {
    const ewa_packet_bounds *bounds = &surfels->bounds;
    const uint64_t n = page->count, word = sizeof(uint32_t), halves = (n + 1) / 2;
    enum { CENTERS = 6, WORDS = 7, HALVES = 3 };
    page->clips_at = surfels->clip_masks ? (int32_t)(WORDS * n + 2 * halves) : -1;
    const struct {
        const void *from;
        uint64_t at, size_bytes;
    } parts[] = {{bounds->center_x + page->first, 0, n * sizeof(double)},
                 {bounds->center_y + page->first, 2 * n, n * sizeof(double)},
                 {bounds->center_z + page->first, 4 * n, n * sizeof(double)},
                 {bounds->cone + page->first, CENTERS * n, n * word},
                 {bounds->radius + page->first, WORDS * n, n * word / 2},
                 {bounds->colors + page->first, WORDS * n + halves, n * word / 2},
                 {surfels->clip_masks ? surfels->clip_masks + page->first : NULL, WORDS * n + 2 * halves,
                  surfels->clip_masks ? n * word / 2 : 0}};
    EWA_TRY(ewa_gl_buffer_reserve(device, &page->bounds, "surfels", (WORDS * n + HALVES * halves) * word));
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        ewa_gl_buffer_write(device, &page->bounds, parts[i].at * word, parts[i].from, parts[i].size_bytes);
    return EWA_OK;
}

static ewa_status put_page(ewa_gl *device, const ewa_surfels *surfels, ewa_gl_page *page) {
    const size_t lanes = (size_t)page->count * LANES, first = (size_t)page->first * LANES;
    ewa_status status = ewa_gl_buffer_put(device, &page->packets, "surfels", surfels->packets + page->first,
                                          page->count * sizeof *surfels->packets);
    const size_t opacity_bytes = surfels->opacities ? lanes * sizeof *surfels->opacities : 0,
                 curvature_bytes = surfels->curvatures ? lanes * sizeof *surfels->curvatures : 0,
                 material_bytes = surfels->materials ? lanes : 0, halves_bytes = opacity_bytes + curvature_bytes;
    page->opacities_at = opacity_bytes ? 0 : -1;
    page->curvatures_at = curvature_bytes ? (int32_t)(opacity_bytes / 4) : -1;
    page->materials_at = material_bytes ? (int32_t)(halves_bytes / 4) : -1;
    if (status == EWA_OK)
        status = ewa_gl_buffer_reserve(device, &page->attributes, "surfels", halves_bytes + material_bytes);
    EWA_TRY(status);
    EWA_TRY(put_bounds(device, surfels, page));
    if (opacity_bytes)
        ewa_gl_buffer_write(device, &page->attributes, 0, surfels->opacities + first, opacity_bytes);
    if (curvature_bytes)
        ewa_gl_buffer_write(device, &page->attributes, opacity_bytes, surfels->curvatures + first, curvature_bytes);
    if (material_bytes)
        ewa_gl_buffer_write(device, &page->attributes, halves_bytes, surfels->materials + first, material_bytes);
    return ewa_gl_check(device, "surfels");
}

static ewa_status put_surfels(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels) {
    uint32_t maximum = residents->page_packets ? residents->page_packets : MAX_PAGE_PACKETS;
    const uint64_t fit = device->facts.storage_bytes / sizeof(ewa_packet);
    if (maximum > fit) maximum = fit ? (uint32_t)fit : 1;
    const uint32_t page_count = (surfels->packet_count + maximum - 1) / maximum;
    ewa_gl_resident made = {.serial = surfels->serial, .page_count = page_count, .used = residents->frame};
    made.pages = ewa_allocate_zeroed(device->context, page_count, sizeof *made.pages);
    if (!made.pages) return EWA_ERROR_MEMORY;
    ewa_status status = ewa_buffer_grow(device->context, &residents->items, residents->count,
                                        (size_t)residents->count + 1, sizeof made);
    for (uint32_t i = 0; i < page_count && status == EWA_OK; i++) {
        ewa_gl_page *page = &made.pages[i];
        page->first = i * maximum;
        page->count =
            surfels->packet_count - page->first < maximum ? surfels->packet_count - page->first : maximum;
        status = put_page(device, surfels, page);
        made.size_bytes += page->packets.size_bytes + page->attributes.size_bytes + page->bounds.size_bytes;
    }
    residents->size_bytes += made.size_bytes;
    if (status != EWA_OK) {
        free_resident(device, residents, &made);
        return status;
    }
    ((ewa_gl_resident *)residents->items.data)[residents->count++] = made;
    return EWA_OK;
}

ewa_status ewa_gl_residents_get(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels,
                                uint32_t *index) {
    ewa_gl_resident *items = residents->items.data;
    for (uint32_t i = 0; i < residents->count; i++)
        if (items[i].serial == surfels->serial) {
            items[i].used = residents->frame;
            *index = i;
            return EWA_OK;
        }
    *index = residents->count;
    return put_surfels(device, residents, surfels);
}

void ewa_gl_residents_free(ewa_gl *device, ewa_gl_residents *residents) {
    drop_unused(device, residents, UINT64_MAX);
    ewa_buffer_free(device->context, &residents->items);
}
