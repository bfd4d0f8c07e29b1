// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels as vertices, which stay on the device from frame to frame; clip lines as a picture.
#include "gl/raster_surfels.h"

#include <assert.h>

enum { LANES = EWA_PACKET_LANES, MAX_PAGE_PACKETS = 1 << 16, LINE_TEXELS = 3, LINE_PICTURE_PX = 1536 };

static_assert(sizeof(ewa_raster_surfel) == 36, "as the attributes of vertices have it");

/// Copies that the last frame did not use are kept up to so many bytes.
static const uint64_t KEPT_BYTES = 512ull << 20;

static void free_resident(ewa_gl *device, ewa_raster_residents *residents, ewa_raster_resident *old) {
    for (uint32_t i = 0; i < old->page_count; i++) {
        ewa_gl_buffer_free(&old->pages[i].surfels);
        ewa_gl_buffer_free(&old->pages[i].materials);
    }
    if (old->lines) glDeleteTextures(1, &old->lines);
    ewa_release(device->context, old->pages, old->page_count, sizeof *old->pages);
    residents->size_bytes -= old->size_bytes;
}

/// Drops what has not been used since.
static void drop_unused(ewa_gl *device, ewa_raster_residents *residents, uint64_t used_min) {
    ewa_raster_resident *items = residents->items.data;
    for (uint32_t i = residents->count; i-- > 0;) {
        if (items[i].used >= used_min) continue;
        free_resident(device, residents, &items[i]);
        items[i] = items[--residents->count];
    }
}

void ewa_raster_residents_start(ewa_gl *device, ewa_raster_residents *residents) {
    if (residents->size_bytes > KEPT_BYTES) drop_unused(device, residents, residents->frame);
    residents->frame++;
}

/// What the task that unfolds packets reads.
typedef struct unfold_job {
    const ewa_surfels *surfels;
    uint32_t first;
    ewa_raster_surfel *to;
    uint32_t count; ///< of packets
} unfold_job;

enum { UNFOLD_PACKETS = 1024 };

static void unfold(void *data, uint32_t index, uint32_t worker) {
    const unfold_job *job = data;
    (void)worker;
    const uint32_t end =
        job->count - index * UNFOLD_PACKETS < UNFOLD_PACKETS ? job->count : (index + 1) * UNFOLD_PACKETS;
    for (uint32_t p = index * UNFOLD_PACKETS; p < end; p++) {
        const ewa_packet *packet = &job->surfels->packets[job->first + p];
        const uint16_t *opacities = job->surfels->opacities, *curvatures = job->surfels->curvatures;
        const size_t first = (size_t)(job->first + p) * LANES;
        for (uint32_t i = 0; i < LANES; i++)
            job->to[(size_t)p * LANES + i] = (ewa_raster_surfel){
                .x = packet->x[i],
                .y = packet->y[i],
                .z = packet->z[i],
                .sigma = packet->sigma[i],
                .oct_x = packet->oct_x[i],
                .oct_y = packet->oct_y[i],
                .angle = packet->angle[i],
                .ratio = packet->ratio[i],
                .red = packet->red[i],
                .green = packet->green[i],
                .blue = packet->blue[i],
                .opacity = opacities ? opacities[first + i] : UINT16_MAX,
                .curvature = curvatures ? (float)ewa_packet_decode_curvature(curvatures[first + i]) : 0};
    }
}

static ewa_status put_page(ewa_gl *device, const ewa_surfels *surfels, ewa_raster_page *page) {
    const size_t count = (size_t)page->count * LANES;
    ewa_raster_surfel *made = ewa_allocate(device->context, count, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    unfold_job job = {surfels, page->first, made, page->count};
    ewa_parallel(device->context, unfold, &job, (page->count + UNFOLD_PACKETS - 1) / UNFOLD_PACKETS);
    ewa_status status = ewa_gl_buffer_put(device, &page->surfels, "surfels", made, count * sizeof *made);
    if (status == EWA_OK && surfels->materials)
        status = ewa_gl_buffer_put(device, &page->materials, "materials",
                                   surfels->materials + (size_t)page->first * LANES, count);
    ewa_release(device->context, made, count, sizeof *made);
    return status == EWA_OK ? ewa_gl_check(device, "surfels") : status;
}

/// Clip lines, in rows of LINE_PICTURE_PX texels.
static ewa_status put_lines(ewa_gl *device, const ewa_surfels *surfels, ewa_raster_resident *made) {
    enum { PER_ROW = LINE_PICTURE_PX / LINE_TEXELS };
    const uint64_t rows = (surfels->clip_count + PER_ROW - 1) / PER_ROW;
    if (!rows) return EWA_OK;
    if (rows > device->facts.texture_px)
        return ewa_fail(
            device->context, EWA_ERROR_LIMIT,
            "OpenGL: %llu surfels with clip lines are more than the %llu that a picture of %s holds",
            (unsigned long long)surfels->clip_count, (unsigned long long)device->facts.texture_px * PER_ROW,
            device->facts.renderer);
    const size_t count = (size_t)rows * LINE_PICTURE_PX * 4;
    float *texels = ewa_allocate_zeroed(device->context, count, sizeof *texels);
    if (!texels) return EWA_ERROR_MEMORY;
    for (uint64_t i = 0; i < surfels->clip_count; i++) {
        const ewa_surfel_clip *clip = &surfels->clips[i];
        float *to = texels + i * LINE_TEXELS * 4;
        for (int k = 0; k < 2; k++, to += 4) {
            for (int c = 0; c < 3; c++) to[c] = clip->toward[k][c];
            to[3] = clip->offset[k];
        }
        to[0] = clip->either ? 1 : 0;
    }
    glGenTextures(1, &made->lines);
    glBindTexture(GL_TEXTURE_2D, made->lines);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, LINE_PICTURE_PX, (GLsizei)rows, 0, GL_RGBA, GL_FLOAT, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    ewa_release(device->context, texels, count, sizeof *texels);
    made->size_bytes += count * sizeof *texels;
    return ewa_gl_check(device, "clip lines");
}

static ewa_status put_surfels(ewa_gl *device, ewa_raster_residents *residents, const ewa_surfels *surfels) {
    const uint32_t page_count = (surfels->packet_count + MAX_PAGE_PACKETS - 1) / MAX_PAGE_PACKETS;
    ewa_raster_resident made = {
        .serial = surfels->serial, .page_count = page_count, .used = residents->frame};
    EWA_TRY(ewa_buffer_grow(device->context, &residents->items, residents->count,
                            (size_t)residents->count + 1, sizeof made));
    made.pages = ewa_allocate_zeroed(device->context, page_count, sizeof *made.pages);
    if (!made.pages) return EWA_ERROR_MEMORY;
    ewa_status status = put_lines(device, surfels, &made);
    for (uint32_t i = 0; i < page_count && status == EWA_OK; i++) {
        ewa_raster_page *page = &made.pages[i];
        const uint32_t left = surfels->packet_count - i * MAX_PAGE_PACKETS;
        page->first = i * MAX_PAGE_PACKETS;
        page->count = left < MAX_PAGE_PACKETS ? left : MAX_PAGE_PACKETS;
        status = put_page(device, surfels, page);
        made.size_bytes += page->surfels.size_bytes + page->materials.size_bytes;
    }
    residents->size_bytes += made.size_bytes;
    if (status != EWA_OK) {
        free_resident(device, residents, &made);
        return status;
    }
    ((ewa_raster_resident *)residents->items.data)[residents->count++] = made;
    return EWA_OK;
}

ewa_status ewa_raster_residents_get(ewa_gl *device, ewa_raster_residents *residents,
                                    const ewa_surfels *surfels, uint32_t *index) {
    ewa_raster_resident *items = residents->items.data;
    for (uint32_t i = 0; i < residents->count; i++)
        if (items[i].serial == surfels->serial) {
            items[i].used = residents->frame;
            *index = i;
            return EWA_OK;
        }
    *index = residents->count;
    return put_surfels(device, residents, surfels);
}

void ewa_raster_residents_free(ewa_gl *device, ewa_raster_residents *residents) {
    drop_unused(device, residents, UINT64_MAX);
    ewa_buffer_free(device->context, &residents->items);
}

void ewa_raster_residents_forget(ewa_context *context, ewa_raster_residents *residents) {
    ewa_raster_resident *items = residents->items.data;
    for (uint32_t i = 0; i < residents->count; i++)
        ewa_release(context, items[i].pages, items[i].page_count, sizeof *items[i].pages);
    residents->count = 0;
    ewa_buffer_free(context, &residents->items);
}
