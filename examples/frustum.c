// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Draws what a camera sees: a torus in wireframe, bright where the frustum of a second camera holds it, on a
// ground of infinite lines that run to their vanishing points. Usage: frustum OUT.png
#include "ewa/ewa.h"

#include <math.h>
#include <stdio.h>

static const float ORANGE[3] = {1, 0.34f, 0.05f}, TEAL[3] = {0.03f, 0.6f, 0.5f};
static const float WHITE[3] = {0.9f, 0.9f, 0.85f}, DIM[3] = {0.06f, 0.09f, 0.16f};
typedef struct scene {
    ewa_image image;
    ewa_mat4 clip[2], world[2]; // of the camera that draws and the one that is drawn: to clip space and back
} scene;

/// Draws a line between two visible points of clip space: coverage by distance, fainter with depth.
static void stroke(ewa_image *image, const ewa_vec4 end[2], const float color[3], double width_px) {
    double at[2][3], size[2] = {image->width_px, image->height_px}, p[2], d[2], low[2], high[2];
    if (ewa_point3_divide(end[0], at[0]) || ewa_point3_divide(end[1], at[1])) return;
    for (int i = 0; i < 2; i++) {
        p[i] = (at[0][i] + 1) / 2 * size[i];
        d[i] = (at[1][i] + 1) / 2 * size[i] - p[i];
        low[i] = floor(fmax(0, fmin(p[i], p[i] + d[i]) - width_px));
        high[i] = fmin(size[i], fmax(p[i], p[i] + d[i]) + width_px);
    }
    for (double y = low[1]; y < high[1]; y++)
        for (double x = low[0]; x < high[0]; x++) {
            double qx = x + 0.5 - p[0], qy = y + 0.5 - p[1], square = d[0] * d[0] + d[1] * d[1];
            double t = square > 0 ? fmin(1, fmax(0, (qx * d[0] + qy * d[1]) / square)) : 0;
            double cover = fmax(0, fmin(1, width_px / 2 + 0.5 - hypot(qx - t * d[0], qy - t * d[1])));
            double z = fmin(1 - 1e-9, at[0][2] + t * (at[1][2] - at[0][2])); // 1 - near / depth: linear
            double clear = exp(-1 / (400 * (1 - z) * (1 - z)));
            float *pixel = image->pixels + 3 * ((size_t)y * image->width_px + (size_t)x);
            for (int c = 0; c < 3; c++) pixel[c] += (float)(cover * clear) * (color[c] - pixel[c]);
        }
}

/// Draws a line of the world, for camera 1 only the part that it sees; its ends may be directions.
static void line(scene *s, int camera, ewa_vec4 a, ewa_vec4 b, const float color[3]) {
    const ewa_mat4 *clip = &s->clip[camera], *w = &s->world[camera];
    ewa_segment_part parts[2];
    uint32_t visible = 0;
    ewa_clip_segment(ewa_point3_transform(a, clip), ewa_point3_transform(b, clip), parts, &visible);
    for (int k = 0; k < 2; k++) {
        const ewa_vec4 *end = parts[k].end;
        if (!(visible & 1u << k)) continue;
        if (camera == 0) stroke(&s->image, end, color, color == DIM ? 1 : 1.7);
        if (camera == 1) line(s, 0, ewa_point3_transform(end[0], w), ewa_point3_transform(end[1], w), color);
    }
}

static ewa_vec4 on_torus(int i, int k) {
    double step = acos(-1) / 24, r = 1.5 + 0.55 * cos(k * step);
    return (ewa_vec4){r * cos(i * step), r * sin(i * step), 0.9 + 0.55 * sin(k * step), 1};
}

static void draw(scene *s) {
    for (int camera = 0; camera < 2; camera++) { // everything dimly, then what camera 1 sees of it in colour
        for (int i = 0; i < 1000; i++) { // the ground: from a point of each line to infinity on both sides
            double place = (i / 4 - 125) / 2.0, side = i & 1 ? 1 : -1;
            ewa_vec4 end[4] = {{0, place, 0, 1}, {side, 0, 0, 0}, {place, 0, 0, 1}, {0, side, 0, 0}};
            line(s, camera, end[i & 2], end[(i & 2) + 1], camera ? TEAL : DIM);
        }
        for (int u = 0; u < 48; u++)
            for (int v = 0; v < 48; v++) {
                if (u % 2 == 0) line(s, camera, on_torus(u, v), on_torus(u, v + 1), camera ? ORANGE : DIM);
                if (v % 4 == 0) line(s, camera, on_torus(u, v), on_torus(u + 1, v), camera ? ORANGE : DIM);
            }
    }
    ewa_vec4 corner[8], eye = ewa_point3_transform((ewa_vec4){0, 0, -1, 0}, &s->world[1]);
    for (int i = 0; i < 8; i++) // clip space's box mapped back
        corner[i] = ewa_point3_transform((ewa_vec4){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i >> 2, 1}, &s->world[1]);
    for (int i = 0; i < 24; i++) line(s, 0, corner[i / 3 & ~(1 << i % 3)], corner[i / 3 | 1 << i % 3], WHITE);
    for (int i = 0; i < 4; i++) line(s, 0, eye, corner[i], WHITE);
}

int main(int count, char **arguments) {
    const double view[2][2][3] = {{{6.2, -8.2, 3.9}, {-0.7, -0.7, 0.9}}, {{-4, -3.2, 2.4}, {0, 0.3, 0.8}}};
    const double up[3] = {0, 0, 1}, fov_deg[2] = {36, 30}, near_z[2] = {1, 1.6}, far_z[2] = {INFINITY, 6.2};
    ewa_context *context = NULL;
    scene s = {0};
    ewa_camera camera;
    if (count != 2) return fprintf(stderr, "usage: frustum OUT.png\n"), 2;
    ewa_status status = ewa_context_create(NULL, &context);
    ewa_camera_init(&camera);
    for (int i = 0; i < 2 && !status; i++) {
        status = ewa_camera_set_fov(&camera, fov_deg[i]);
        if (!status) status = ewa_camera_look_at(&camera, view[i][0], view[i][1], up);
        if (!status) status = ewa_camera_clip_map(&camera, near_z[i], far_z[i], &s.clip[i]);
        if (!status) status = ewa_mat4_invert(&s.clip[i], &s.world[i]);
    }
    if (!status) status = ewa_image_create(context, camera.width_px, camera.height_px, 3, &s.image);
    if (!status) draw(&s), status = ewa_image_save(&s.image, arguments[1], NULL);
    if (status) fprintf(stderr, "frustum: %s: %s\n", arguments[1], ewa_status_name(status));
    ewa_image_free(&s.image);
    ewa_context_destroy(&context);
    return status ? 1 : 0;
}
