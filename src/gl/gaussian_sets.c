// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Copies of sets of Gaussians on the device.
#include "gl/gaussian_sets.h"

#include <string.h>

static const uint64_t KEPT_BYTES = 512ull << 20;

static void free_set(ewa_context *context, ewa_gl_splat_sets *sets, ewa_gl_splat_set *old, bool there) {
    ewa_gl_splat_page *pages = old->pages.data;
    for (uint32_t i = 0; i < old->page_count && there; i++) {
        ewa_gl_buffer_free(&pages[i].packets);
        ewa_gl_buffer_free(&pages[i].harmonics);
        ewa_gl_buffer_free(&pages[i].colors);
        ewa_gl_buffer_free(&pages[i].lanes);
    }
    sets->size_bytes -= old->size_bytes;
    ewa_buffer_free(context, &old->pages);
}

void ewa_gl_splat_sets_start(ewa_gl *device, ewa_gl_splat_sets *sets) {
    ewa_gl_splat_set *items = sets->items.data;
    const uint64_t kept_bytes = sets->kept_bytes ? sets->kept_bytes : KEPT_BYTES;
    for (uint32_t i = sets->count; i-- > 0 && sets->size_bytes > kept_bytes;) {
        if (items[i].used >= sets->frame) continue;
        free_set(device->context, sets, &items[i], true);
        items[i] = items[--sets->count];
    }
    sets->frame++;
}

static ewa_status put_page(ewa_gl *device, const ewa_splats *splats, size_t first, size_t count, ewa_gl_splat_page *page) {
    const size_t harmonic_bytes = splats->harmonic_count * sizeof *splats->harmonics;
    EWA_TRY(ewa_gl_buffer_put(device, &page->packets, "Gaussians", splats->packets + first, count * sizeof *splats->packets));
    if (!harmonic_bytes) return EWA_OK;
    return ewa_gl_buffer_put(device, &page->harmonics, "Gaussians", splats->harmonics + first * splats->harmonic_count,
                             count * harmonic_bytes);
}

static ewa_status put_set(ewa_gl *device, ewa_gl_splat_sets *sets, const ewa_splats *splats) {
    enum { MAX_PAGE_PACKETS = 1 << 22 };
    const uint64_t packet_bytes = sizeof *splats->packets, harmonic_bytes = splats->harmonic_count * sizeof *splats->harmonics;
    const uint64_t fit = device->facts.storage_bytes / (packet_bytes > harmonic_bytes ? packet_bytes : harmonic_bytes);
    uint64_t most = sets->page_packets ? sets->page_packets : MAX_PAGE_PACKETS;
    if (most > fit) most = fit ? fit : 1;
    const size_t all = ewa_splats_all_packets(splats);
    ewa_gl_splat_set made = {.packets = splats->packets, .serial = splats->serial, .used = sets->frame, .page_packets = (uint32_t)most};
    const uint32_t page_count = (uint32_t)((all + most - 1) / most);
    EWA_TRY(ewa_buffer_grow(device->context, &sets->items, sets->count, (size_t)sets->count + 1, sizeof made));
    ewa_status status = ewa_buffer_reserve(device->context, &made.pages, page_count, sizeof(ewa_gl_splat_page));
    for (uint32_t i = 0; i < page_count && status == EWA_OK; i++) {
        ewa_gl_splat_page *page = (ewa_gl_splat_page *)made.pages.data + i;
        const size_t first = i * (size_t)most, left = all - first;
        memset(page, 0, sizeof *page);
        made.page_count++;
        status = put_page(device, splats, first, left < most ? left : (size_t)most, page);
        made.size_bytes += page->packets.size_bytes + page->harmonics.size_bytes;
    }
    sets->size_bytes += made.size_bytes;
    if (status != EWA_OK) {
        free_set(device->context, sets, &made, true);
        return status;
    }
    ((ewa_gl_splat_set *)sets->items.data)[sets->count++] = made;
    return ewa_gl_check(device, "Gaussians");
}

ewa_status ewa_gl_splat_sets_get(ewa_gl *device, ewa_gl_splat_sets *sets, const ewa_splats *splats, uint32_t *index) {
    ewa_gl_splat_set *items = sets->items.data;
    // Frames ask in the same order, so that each is found behind the one before.
    for (uint32_t i = 0; i < sets->count; i++) {
        if (sets->next >= sets->count) sets->next = 0;
        const uint32_t at = sets->next++;
        if (items[at].serial != splats->serial || items[at].packets != (const ewa_splat_packet *)splats->packets) continue;
        items[at].used = sets->frame;
        *index = at;
        return EWA_OK;
    }
    *index = sets->count;
    return put_set(device, sets, splats);
}

void ewa_gl_splat_sets_free(ewa_context *context, ewa_gl_splat_sets *sets, bool there) {
    ewa_gl_splat_set *items = sets->items.data;
    for (uint32_t i = 0; i < sets->count; i++) free_set(context, sets, &items[i], there);
    sets->count = sets->next = 0;
    ewa_buffer_free(context, &sets->items);
    ewa_buffer_free(context, &sets->staging);
}

/// Colours in place of those of packets from `first` on.
static ewa_status put_colors(ewa_gl *device, ewa_gl_splat_sets *sets, const ewa_gl_splat_look *look, size_t first, size_t count,
                             ewa_gl_splat_page *page) {
    enum { ROWS = 3 };
    EWA_TRY(ewa_buffer_reserve(device->context, &sets->staging, count, ROWS * EWA_SPLAT_LANES * sizeof(float)));
    float(*to)[EWA_SPLAT_LANES] = sets->staging.data;
    for (size_t i = 0; i < count; i++, to += ROWS) {
        ewa_splat_packet painted;
        ewa_splat_colors_apply(look->colors, (const ewa_splat_packet *)look->splats->packets, first + i, &painted);
        memcpy(to, painted[EWA_SPLAT_COLOR], ROWS * sizeof *to);
    }
    EWA_TRY(ewa_gl_buffer_put(device, &page->colors, "colours", sets->staging.data, count * ROWS * sizeof *to));
    page->colors_serial = look->colors->serial;
    return EWA_OK;
}

ewa_status ewa_gl_splat_sets_look(ewa_gl *device, ewa_gl_splat_sets *sets, uint32_t set, uint32_t page_number,
                                  const ewa_gl_splat_look *look, const ewa_gl_splat_page **page) {
    const ewa_gl_splat_set *of = ewa_gl_splat_sets_at(sets, set);
    ewa_gl_splat_page *found = (ewa_gl_splat_page *)of->pages.data + page_number;
    const ewa_splats *splats = look->splats;
    const size_t first = page_number * (size_t)of->page_packets, left = ewa_splats_all_packets(splats) - first;
    const size_t count = left < of->page_packets ? left : of->page_packets;
    *page = found;
    if (look->colors && look->colors->serial != found->colors_serial)
        EWA_TRY(put_colors(device, sets, look, first, count, found));
    if (!splats->shown_lanes || splats->lanes_serial == found->lanes_serial) return EWA_OK;
    // Two packets share a word.
    EWA_TRY(ewa_gl_buffer_reserve(device, &found->lanes, "Gaussians", (count + 1) / 2 * sizeof(uint32_t)));
    ewa_gl_buffer_write(device, &found->lanes, 0, splats->shown_lanes + first, count * sizeof *splats->shown_lanes);
    found->lanes_serial = splats->lanes_serial;
    return EWA_OK;
}
