// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Copies of surfels on the device.
#include "gl/resident.h"

#include <string.h>

enum { LANES = EWA_PACKET_LANES, MAX_PAGE_PACKETS = 1 << 22, BOUND_WORDS = 8 };

static const uint64_t KEPT_BYTES = 512ull << 20;

/// Words of a packet.
static const uint32_t stream_words[EWA_GL_STREAMS] = {[EWA_GL_PACKETS] = sizeof(ewa_packet) / 4,
                                                      [EWA_GL_BOUNDS] = BOUND_WORDS,
                                                      [EWA_GL_OPACITIES] = LANES / 2,
                                                      [EWA_GL_CURVATURES] = LANES / 2,
                                                      [EWA_GL_MATERIALS] = LANES / 4,
                                                      [EWA_GL_CLIP_MASKS] = 1};

static uint64_t stream_bytes(int stream, uint32_t packets) { return (uint64_t)packets * stream_words[stream] * sizeof(uint32_t); }

static uint32_t smaller(uint64_t a, uint32_t b) { return a < b ? (uint32_t)a : b; }

static ewa_gl_page *page_at(ewa_gl_residents *residents, uint32_t index) {
    return (ewa_gl_page *)residents->pages.data + index;
}

static void free_page(ewa_gl *device, ewa_gl_residents *residents, ewa_gl_page *page) {
    for (int stream = 0; stream < EWA_GL_STREAMS; stream++) {
        if (device->lost) page->streams[stream].name = 0;
        ewa_gl_buffer_free(&page->streams[stream]);
    }
    residents->capacity -= page->capacity;
    page->capacity = page->hole_count = 0;
}

/// Gives packets of a page back; its list of holes has room for that (take()).
static void add_hole(ewa_gl_page *page, ewa_gl_range free) {
    ewa_gl_range *holes = page->holes.data;
    uint32_t at = 0;
    while (at < page->hole_count && holes[at].first < free.first) at++;
    const bool joins_before = at > 0 && holes[at - 1].first + holes[at - 1].count == free.first;
    const bool joins_after = at < page->hole_count && free.first + free.count == holes[at].first;
    if (joins_before && joins_after) {
        holes[at - 1].count += free.count + holes[at].count;
        memmove(holes + at, holes + at + 1, (--page->hole_count - at) * sizeof *holes);
    } else if (joins_before) {
        holes[at - 1].count += free.count;
    } else if (joins_after) {
        holes[at].first = free.first, holes[at].count += free.count;
    } else {
        memmove(holes + at + 1, holes + at, (page->hole_count++ - at) * sizeof *holes);
        holes[at] = free;
    }
}

/// Takes packets from the start of a hole. A page never has more holes than pieces and one.
static ewa_status take(ewa_gl *device, ewa_gl_page *page, uint32_t hole, uint32_t count) {
    EWA_TRY(ewa_buffer_grow(device->context, &page->holes, page->hole_count, (size_t)page->piece_count + 2,
                            sizeof(ewa_gl_range)));
    ewa_gl_range *holes = page->holes.data;
    holes[hole].first += count, holes[hole].count -= count;
    if (!holes[hole].count) memmove(holes + hole, holes + hole + 1, (--page->hole_count - hole) * sizeof *holes);
    page->piece_count++;
    return EWA_OK;
}

static void free_resident(ewa_gl *device, ewa_gl_residents *residents, ewa_gl_resident *old) {
    const ewa_gl_piece *pieces = old->pieces.data;
    for (uint32_t i = 0; i < old->piece_count; i++) {
        ewa_gl_page *page = page_at(residents, pieces[i].page);
        add_hole(page, (ewa_gl_range){pieces[i].at, pieces[i].count});
        page->piece_count--;
        residents->packet_count -= pieces[i].count;
    }
    ewa_buffer_free(device->context, &old->pieces);
}

/// Drops what was last used before that frame.
static void drop_unused(ewa_gl *device, ewa_gl_residents *residents, uint64_t used_min) {
    ewa_gl_resident *items = residents->items.data;
    for (uint32_t i = residents->count; i-- > 0;) {
        if (items[i].used >= used_min) continue;
        free_resident(device, residents, &items[i]);
        items[i] = items[--residents->count];
    }
    for (uint32_t i = 0; i < residents->page_count; i++) {
        ewa_gl_page *page = page_at(residents, i);
        if (!page->piece_count) free_page(device, residents, page);
    }
}

/// Packets that were last used in that frame or later, but not in the last one.
static uint64_t count_unused(const ewa_gl_residents *residents, uint64_t used_min) {
    const ewa_gl_resident *items = residents->items.data;
    uint64_t count = 0;
    for (uint32_t i = 0; i < residents->count; i++) {
        const ewa_gl_piece *pieces = items[i].pieces.data;
        for (uint32_t k = 0; k < items[i].piece_count && items[i].used >= used_min && items[i].used < residents->frame; k++)
            count += pieces[k].count;
    }
    return count;
}

/// Drops what was not used for longest, until as many packets are left beside those of the last frame.
static void drop_oldest(ewa_gl *device, ewa_gl_residents *residents, uint64_t kept) {
    if (residents->packet_count <= kept || count_unused(residents, 0) <= kept) return;
    uint64_t low = 0, high = residents->frame; // too many since `low`, not since `high`
    while (high - low > 1) {
        const uint64_t middle = low + (high - low) / 2;
        *(count_unused(residents, middle) > kept ? &low : &high) = middle;
    }
    drop_unused(device, residents, high);
}

void ewa_gl_residents_start(ewa_gl *device, ewa_gl_residents *residents) {
    enum { MUCH = 4 };
    const uint64_t kept_bytes = residents->kept_bytes ? residents->kept_bytes : KEPT_BYTES;
    const uint64_t kept = kept_bytes / sizeof(ewa_packet);
    drop_oldest(device, residents, kept);
    // Few packets that hold much memory are copied anew.
    if (residents->capacity > kept && MUCH * residents->packet_count < residents->capacity)
        drop_unused(device, residents, UINT64_MAX);
    residents->frame++;
}

/// Makes room for more packets in a page; what is there stays.
static ewa_status grow_page(ewa_gl *device, ewa_gl_residents *residents, ewa_gl_page *page, uint32_t capacity) {
    const bool first = page->capacity == 0;
    for (int stream = 0; stream < EWA_GL_STREAMS; stream++)
        if (page->streams[stream].name || (first && stream <= EWA_GL_BOUNDS))
            EWA_TRY(ewa_gl_buffer_grow(device, &page->streams[stream], "surfels", stream_bytes(stream, capacity)));
    EWA_TRY(ewa_buffer_grow(device->context, &page->holes, page->hole_count, (size_t)page->piece_count + 2,
                            sizeof(ewa_gl_range)));
    const uint32_t more = capacity - page->capacity;
    add_hole(page, (ewa_gl_range){page->capacity, more});
    page->capacity = capacity, residents->capacity += more;
    return EWA_OK;
}

/// Finds room for so many packets: a page that has it, else one that may grow, else a new one.
static ewa_status make_room(ewa_gl *device, ewa_gl_residents *residents, uint32_t count) {
    if (residents->capacity - residents->packet_count >= count) return EWA_OK;
    const uint64_t fit = device->facts.storage_bytes / sizeof(ewa_packet);
    uint32_t most = residents->page_packets ? residents->page_packets : MAX_PAGE_PACKETS;
    if (most > fit) most = fit ? (uint32_t)fit : 1;
    const uint32_t missing = count - (uint32_t)(residents->capacity - residents->packet_count);
    for (uint32_t i = 0; i < residents->page_count; i++) {
        ewa_gl_page *page = page_at(residents, i);
        if (page->capacity >= most) continue;
        const uint64_t wanted = (uint64_t)page->capacity + page->capacity / 2, needed = (uint64_t)page->capacity + missing;
        const uint32_t capacity = smaller(wanted > needed ? wanted : needed, most);
        // Both copies have to fit while it grows; a page more needs only its own.
        ewa_failures_soften(device->context, true);
        const ewa_status status = grow_page(device, residents, page, capacity);
        ewa_failures_soften(device->context, false);
        if (status == EWA_OK) return EWA_OK;
        if (status != EWA_ERROR_MEMORY) return status;
    }
    EWA_TRY(ewa_buffer_grow(device->context, &residents->pages, residents->page_count, (size_t)residents->page_count + 1,
                            sizeof(ewa_gl_page)));
    ewa_gl_page *page = page_at(residents, residents->page_count);
    memset(page, 0, sizeof *page);
    residents->page_count++;
    const ewa_status status = grow_page(device, residents, page, smaller(missing, most));
    if (status != EWA_OK) free_page(device, residents, page);
    return status;
}

/// Writes a stream of packets from `first` on into a page from `at` on; it becomes a buffer where it was none.
static ewa_status write_stream(ewa_gl *device, ewa_gl_page *page, const ewa_gl_piece *piece, ewa_gl_stream stream,
                             const void *from) {
    ewa_gl_buffer *buffer = &page->streams[stream];
    EWA_TRY(ewa_gl_buffer_reserve(device, buffer, "surfels", stream_bytes(stream, page->capacity)));
    ewa_gl_buffer_write(device, buffer, stream_bytes(stream, piece->at), from, stream_bytes(stream, piece->count));
    return EWA_OK;
}

/// What culling reads of a packet side by side: x, y, z of its centre, two words each, its cone, then its radius and the form
/// of its colours.
static ewa_status write_bounds(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels, ewa_gl_page *page,
                               const ewa_gl_piece *piece) {
    EWA_TRY(ewa_buffer_reserve(device->context, &residents->staging, piece->count, BOUND_WORDS * sizeof(uint32_t)));
    const ewa_packet_bounds *bounds = &surfels->bounds;
    uint32_t *words = residents->staging.data;
    for (uint32_t i = piece->first; i < piece->first + piece->count; i++, words += BOUND_WORDS) {
        const double center[3] = {bounds->center_x[i], bounds->center_y[i], bounds->center_z[i]};
        memcpy(words, center, sizeof center);
        words[6] = bounds->cone[i];
        words[7] = bounds->radius[i] | (uint32_t)bounds->colors[i] << 16;
    }
    return write_stream(device, page, piece, EWA_GL_BOUNDS, residents->staging.data);
}

static ewa_status write_clip_masks(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels,
                                   ewa_gl_page *page, const ewa_gl_piece *piece) {
    EWA_TRY(ewa_buffer_reserve(device->context, &residents->staging, piece->count, sizeof(uint32_t)));
    uint32_t *words = residents->staging.data;
    for (uint32_t i = 0; i < piece->count; i++) words[i] = surfels->clip_masks[piece->first + i];
    return write_stream(device, page, piece, EWA_GL_CLIP_MASKS, words);
}

static ewa_status write_piece(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels,
                              const ewa_gl_piece *piece) {
    ewa_gl_page *page = page_at(residents, piece->page);
    const size_t lane = (size_t)piece->first * LANES;
    EWA_TRY(write_stream(device, page, piece, EWA_GL_PACKETS, surfels->packets + piece->first));
    EWA_TRY(write_bounds(device, residents, surfels, page, piece));
    if (surfels->opacities) EWA_TRY(write_stream(device, page, piece, EWA_GL_OPACITIES, surfels->opacities + lane));
    if (surfels->curvatures) EWA_TRY(write_stream(device, page, piece, EWA_GL_CURVATURES, surfels->curvatures + lane));
    if (surfels->materials) EWA_TRY(write_stream(device, page, piece, EWA_GL_MATERIALS, surfels->materials + lane));
    if (surfels->clip_masks) EWA_TRY(write_clip_masks(device, residents, surfels, page, piece));
    return ewa_gl_check(device, "surfels");
}

/// Takes room for packets: where all of them fit, else the first that there is.
static ewa_status take_piece(ewa_gl *device, ewa_gl_residents *residents, uint32_t left, ewa_gl_piece *piece) {
    ewa_gl_page *in = NULL;
    uint32_t hole = 0;
    for (uint32_t i = 0; i < residents->page_count; i++) {
        ewa_gl_page *page = page_at(residents, i);
        const ewa_gl_range *holes = page->holes.data;
        for (uint32_t k = 0; k < page->hole_count; k++) {
            if (in && holes[k].count < left) continue;
            in = page, hole = k, piece->page = i;
            if (holes[k].count >= left) i = residents->page_count, k = page->hole_count;
        }
    }
    const ewa_gl_range *holes = in->holes.data;
    piece->at = holes[hole].first, piece->count = smaller(holes[hole].count, left);
    EWA_TRY(take(device, in, hole, piece->count));
    residents->packet_count += piece->count;
    return EWA_OK;
}

static ewa_status put_pieces(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels,
                             ewa_gl_resident *made) {
    for (uint32_t first = 0; first < surfels->packet_count;) {
        EWA_TRY(ewa_buffer_grow(device->context, &made->pieces, made->piece_count, (size_t)made->piece_count + 1,
                                sizeof(ewa_gl_piece)));
        ewa_gl_piece *piece = (ewa_gl_piece *)made->pieces.data + made->piece_count;
        piece->first = first;
        EWA_TRY(make_room(device, residents, surfels->packet_count - first));
        EWA_TRY(take_piece(device, residents, surfels->packet_count - first, piece));
        made->piece_count++;
        EWA_TRY(write_piece(device, residents, surfels, piece));
        first += piece->count;
    }
    return EWA_OK;
}

static ewa_status put_surfels(ewa_gl *device, ewa_gl_residents *residents, const ewa_surfels *surfels) {
    ewa_gl_resident made = {.serial = surfels->serial, .used = residents->frame};
    const bool has[EWA_GL_STREAMS] = {[EWA_GL_OPACITIES] = surfels->opacities, [EWA_GL_CURVATURES] = surfels->curvatures,
                                      [EWA_GL_MATERIALS] = surfels->materials, [EWA_GL_CLIP_MASKS] = surfels->clip_masks};
    for (int stream = 0; stream < EWA_GL_STREAMS; stream++) made.streams |= has[stream] ? 1u << stream : 0;
    EWA_TRY(ewa_buffer_grow(device->context, &residents->items, residents->count, (size_t)residents->count + 1,
                            sizeof made));
    const ewa_status status = put_pieces(device, residents, surfels, &made);
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
    // Frames ask in the same order, so that each is found behind the one before.
    for (uint32_t i = 0; i < residents->count; i++) {
        if (residents->next >= residents->count) residents->next = 0;
        const uint32_t at = residents->next++;
        if (items[at].serial != surfels->serial) continue;
        items[at].used = residents->frame;
        *index = at;
        return EWA_OK;
    }
    *index = residents->count;
    return put_surfels(device, residents, surfels);
}

void ewa_gl_residents_free(ewa_gl *device, ewa_gl_residents *residents) {
    drop_unused(device, residents, UINT64_MAX);
    for (uint32_t i = 0; i < residents->page_count; i++)
        ewa_buffer_free(device->context, &page_at(residents, i)->holes);
    residents->page_count = 0;
    ewa_buffer_free(device->context, &residents->staging);
    ewa_buffer_free(device->context, &residents->pages);
    ewa_buffer_free(device->context, &residents->items);
}
