// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Nearest pixels: every sample is written to the pixel that it falls into, in an order in which what is
// nearer comes later, so that nothing is compared.
//
// Based on: McMillan, "An Image-Based Approach to Three-Dimensional Computer Graphics", 1997, chapter 4. Two
// samples that fall on one ray of the new camera lie on one line of the old picture through the epipole, the
// new eye's place in it. Where the new eye is before the old one the nearer sample is nearer to the epipole,
// where it is behind, farther. Rows and columns are therefore walked towards the epipole or away from it, in
// up to four sheets that it separates.
#include "homogeneous/placement.h"
#include "image/srgb.h"
#include "surface/color_form.h"
#include "warp/warp_place.h"

#include <math.h>
#include <string.h>

enum { LANES = EWA_PACKET_LANES, ROWS_PER_TASK = 16 };

/// Marks a sample that falls into no pixel.
static const uint32_t NOWHERE = UINT32_MAX;

/// What the tasks share. A winner is 1 + packet * 16 + lane; 0: none.
typedef struct drawing {
    const ewa_warp *warp;
    const ewa_warp_source *source;
    const ewa_camera *target;
    const ewa_render_options *options;
    const ewa_frame *frame;
    uint8_t *holes;
    ewa_placement place;   // of the target before the surfels
    uint32_t *pixels;      // of the source's samples, row by row
    uint32_t *winners;     // of the target's pixels
    const uint32_t *layer; // likewise, of one more source
} drawing;

static ewa_vec3 sample_in_camera(const drawing *d, uint32_t packet, uint32_t lane) {
    const ewa_surfels *surfels = &d->warp->grid.surfels;
    const ewa_packet *of = &surfels->packets[packet];
    const ewa_vec3 offset = vec3_make((double)of->x[lane], (double)of->y[lane], (double)of->z[lane]);
    // The way from the anchor first: it is short where the centre is near.
    const ewa_vec3 way = vec3_add(vec3_sub(ewa_packet_center(surfels, packet), d->place.anchor), offset);
    return vec3_add(mat3_mul_vec3(&d->place.linear, way), d->place.offset);
}

static bool faces_away(const drawing *d, uint32_t packet, uint32_t lane, ewa_vec3 p) {
    ewa_packet_surfel surfel;
    ewa_packet_decode(&d->warp->grid.surfels, packet, lane, &surfel);
    const ewa_vec3 n = mat3_mul_vec3(&d->place.linear, surfel.normal);
    return d->target->projection == EWA_ORTHOGRAPHIC ? n.z >= 0 : vec3_dot(n, p) >= 0;
}

/// The pixel that one sample falls into.
static uint32_t pixel_of(const drawing *d, uint64_t packet_index, uint32_t lane) {
    const ewa_packet *packet = &d->warp->grid.surfels.packets[packet_index];
    if (!(packet->sigma[lane] > 0)) return NOWHERE;
    const ewa_camera *target = d->target;
    const ewa_vec3 p = sample_in_camera(d, (uint32_t)packet_index, lane);
    if (!(p.z > 0)) return NOWHERE;
    const double over = target->projection == EWA_ORTHOGRAPHIC ? 1 : 1 / p.z;
    const double x = floor(target->fx_px * p.x * over + target->cx_px),
                 y = floor(target->fy_px * p.y * over + target->cy_px);
    if (!(x >= 0 && x < target->width_px && y >= 0 && y < target->height_px)) return NOWHERE;
    if (d->options->cull == EWA_CULL_BACK && faces_away(d, (uint32_t)packet_index, lane, p)) return NOWHERE;
    return (uint32_t)y * target->width_px + (uint32_t)x;
}

static void project_strip(void *data, uint32_t strip, uint32_t worker) {
    (void)worker;
    const drawing *d = data;
    const ewa_camera *camera = &d->source->image.camera;
    const uint32_t first = strip * EWA_WARP_STRIP_PX, width = camera->width_px;
    for (uint32_t y = first; y < first + EWA_WARP_STRIP_PX && y < camera->height_px; y++)
        for (uint32_t x = 0; x < width; x++)
            d->pixels[(size_t)y * width + x] =
                pixel_of(d, ewa_warp_packet(d->source, x, y), ewa_warp_lane(x, y));
}

/// How one side of a picture is walked: [0, split) and [split, count), each towards the split or from it.
typedef struct walk {
    uint32_t split, count;
    bool toward;
} walk;

/// `epipole` times `depth` is the new eye in the old camera, along one side, in pixels.
static walk walk_side(double eye_px, double depth, uint32_t count) {
    walk w = {.split = 0, .count = count, .toward = depth >= 0};
    if (depth == 0) { // the epipole is infinitely far: up the numbers, or down
        w.split = eye_px > 0 ? count : 0;
        return w;
    }
    const double split = floor(eye_px / depth + 0.5); // the first whose centre is not before the epipole
    w.split = split <= 0 ? 0 : split >= count ? count : (uint32_t)split;
    return w;
}

/// Part 0 is before the split, part 1 behind; step i of it.
static uint32_t walk_at(const walk *w, int part, uint32_t i) {
    if (part == 0) return w->toward ? i : w->split - 1 - i;
    return w->toward ? w->count - 1 - i : w->split + i;
}

static uint32_t walk_count(const walk *w, int part) { return part == 0 ? w->split : w->count - w->split; }

/// Writes the samples of the source in McMillan's order.
static void write_in_order(const drawing *d, uint32_t *winners) {
    const ewa_camera *camera = &d->source->image.camera;
    double eye_world[3], eye[3];
    const double *m = camera->world_to_camera;
    if (d->target->projection == EWA_ORTHOGRAPHIC) { // an eye infinitely far back
        for (int r = 0; r < 3; r++) eye[r] = -vec3_dot(vec3_load(&m[4 * r]), mat3_row(&d->place.linear, 2));
    } else {
        ewa_camera_eye(d->target, eye_world);
        for (int r = 0; r < 3; r++)
            eye[r] = m[4 * r] * eye_world[0] + m[4 * r + 1] * eye_world[1] + m[4 * r + 2] * eye_world[2] +
                     m[4 * r + 3];
    }
    const walk across = walk_side(camera->fx_px * eye[0] + camera->cx_px * eye[2], eye[2], camera->width_px);
    const walk down = walk_side(camera->fy_px * eye[1] + camera->cy_px * eye[2], eye[2], camera->height_px);
    for (int sheet = 0; sheet < 4; sheet++) {
        const int below = sheet >> 1, right = sheet & 1;
        for (uint32_t j = 0; j < walk_count(&down, below); j++) {
            const uint32_t y = walk_at(&down, below, j);
            const uint32_t *pixels = d->pixels + (size_t)y * camera->width_px;
            for (uint32_t i = 0; i < walk_count(&across, right); i++) {
                const uint32_t x = walk_at(&across, right, i);
                if (pixels[x] == NOWHERE) continue;
                winners[pixels[x]] =
                    1 + (uint32_t)ewa_warp_packet(d->source, x, y) * LANES + ewa_warp_lane(x, y);
            }
        }
    }
}

static double depth_of(const drawing *d, uint32_t winner) {
    return sample_in_camera(d, (winner - 1) / LANES, (winner - 1) % LANES).z;
}

/// Keeps the nearer of two sources' samples; of equally near ones the first source's.
static void merge_rows(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const drawing *d = data;
    const size_t width = d->target->width_px, first = (size_t)task * ROWS_PER_TASK;
    const size_t end =
        first + ROWS_PER_TASK < d->target->height_px ? first + ROWS_PER_TASK : d->target->height_px;
    for (size_t i = first * width; i < end * width; i++)
        if (d->layer[i] && (!d->winners[i] || depth_of(d, d->layer[i]) < depth_of(d, d->winners[i])))
            d->winners[i] = d->layer[i];
}

static void set_normal(const drawing *d, uint32_t winner, float normal[3]) {
    ewa_packet_surfel surfel;
    const uint32_t packet = (winner - 1) / LANES, lane = (winner - 1) % LANES;
    ewa_packet_decode(&d->warp->grid.surfels, packet, lane, &surfel);
    const double sign = faces_away(d, packet, lane, sample_in_camera(d, packet, lane)) ? -1 : 1;
    normal[0] = (float)(sign * surfel.normal.x), normal[1] = (float)(sign * surfel.normal.y);
    normal[2] = (float)(sign * surfel.normal.z);
}

static void put_color(const drawing *d, size_t pixel, uint32_t winner) {
    const ewa_surfels *surfels = &d->warp->grid.surfels;
    const float *background = d->options->background;
    float light[3], alpha = 1;
    if (winner) {
        const uint32_t index = (winner - 1) / LANES, lane = (winner - 1) % LANES;
        const ewa_packet *packet = &surfels->packets[index];
        const uint16_t codes[3] = {packet->red[lane], packet->green[lane], packet->blue[lane]};
        for (int c = 0; c < 3; c++)
            light[c] = (float)ewa_color_decode_code(surfels->bounds.colors[index], codes[c]);
    } else {
        memcpy(light, background, sizeof light);
        alpha = background[3];
    }
    if (d->frame->rgba) {
        for (int c = 0; c < 3; c++) d->frame->rgba[4 * pixel + c] = light[c] * alpha;
        d->frame->rgba[4 * pixel + 3] = alpha;
    }
    if (d->frame->rgba8) {
        for (int c = 0; c < 3; c++)
            d->frame->rgba8[4 * pixel + c] = alpha > 0 ? ewa_srgb8_from_linear(light[c]) : 0;
        d->frame->rgba8[4 * pixel + 3] = (uint8_t)(255 * alpha + 0.5f);
    }
}

static void resolve_rows(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const drawing *d = data;
    const ewa_frame *frame = d->frame;
    const size_t width = d->target->width_px, first = (size_t)task * ROWS_PER_TASK;
    const size_t end =
        first + ROWS_PER_TASK < d->target->height_px ? first + ROWS_PER_TASK : d->target->height_px;
    for (size_t i = first * width; i < end * width; i++) {
        const uint32_t winner = d->winners[i];
        put_color(d, i, winner);
        if (frame->depth) frame->depth[i] = winner ? (float)depth_of(d, winner) : INFINITY;
        if (frame->coverage) frame->coverage[i] = winner ? 1 : 0;
        if (d->holes) d->holes[i] = winner ? 0 : 255;
        if (!frame->normal) continue;
        memset(frame->normal + 3 * i, 0, 3 * sizeof(float));
        if (winner) set_normal(d, winner, frame->normal + 3 * i);
    }
}

ewa_status ewa_warp_draw_nearest(ewa_warp *warp, const ewa_camera *target, const ewa_render_options *options,
                                 const ewa_frame *frame, uint8_t *holes) {
    ewa_context *context = warp->context;
    ewa_warp_nearest *n = &warp->nearest;
    const size_t pixel_count = (size_t)target->width_px * target->height_px;
    size_t maximum = 0;
    for (uint32_t i = 0; i < warp->source_count; i++) {
        const ewa_camera *camera = &warp->sources[i].image.camera;
        const size_t count = (size_t)camera->width_px * camera->height_px;
        maximum = count > maximum ? count : maximum;
    }
    EWA_TRY(ewa_buffer_reserve(context, &n->pixel_buffer, maximum, sizeof(uint32_t)));
    EWA_TRY(ewa_buffer_reserve(context, &n->winner_buffer, pixel_count, sizeof(uint32_t)));
    if (warp->source_count > 1)
        EWA_TRY(ewa_buffer_reserve(context, &n->layer_buffer, pixel_count, sizeof(uint32_t)));
    drawing d = {.warp = warp,
                 .target = target,
                 .options = options,
                 .frame = frame,
                 .holes = holes,
                 .pixels = n->pixel_buffer.data,
                 .winners = n->winner_buffer.data,
                 .layer = n->layer_buffer.data,
                 .place = ewa_placement_make(target, warp->grid.surfels.origin_world, NULL, 0)};
    const uint32_t tasks = (target->height_px + ROWS_PER_TASK - 1) / ROWS_PER_TASK;
    for (uint32_t i = 0; i < warp->source_count; i++) {
        d.source = &warp->sources[i];
        EWA_TRY(ewa_parallel_stoppable(context, "warp", project_strip, &d, d.source->strip_count));
        uint32_t *winners = i == 0 ? d.winners : n->layer_buffer.data;
        memset(winners, 0, pixel_count * sizeof *winners);
        write_in_order(&d, winners);
        if (i > 0) EWA_TRY(ewa_parallel_stoppable(context, "warp", merge_rows, &d, tasks));
    }
    return ewa_parallel_stoppable(context, "warp", resolve_rows, &d, tasks);
}

void ewa_warp_nearest_free(ewa_context *context, ewa_warp_nearest *nearest) {
    ewa_buffer *const buffers[] = {&nearest->pixel_buffer, &nearest->winner_buffer, &nearest->layer_buffer};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++) ewa_buffer_free(context, buffers[i]);
}
