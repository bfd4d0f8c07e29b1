// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The outlines of some surfels over a picture: the rims of their discs as the camera sees them, point by point, so that
// they hold for every kernel that is exact on the rim (docs/math.md section 3).
//
// Based on: M. Zwicker, J. Räsänen, M. Botsch, C. Dachsbacher, M. Pauly, "Perspective Accurate Splatting", 2004, figure 1.
#include "base/base.h"
#include "cloud/cloud.h"
#include "ewa/furniture.h"
#include "scene/parts.h"
#include "surface/surfel.h"

#include <math.h>

enum { BLOCK = 256, SEGMENTS = 64 };

static const double PI = 3.14159265358979323846, LINE_PX = 1.2;
static const uint8_t INK[4] = {0, 0, 0, 255};

/// A cloud's surfels before a camera.
typedef struct footprints {
    ewa_surfel_reader reader;
    const ewa_camera *camera;
    const float *depth; ///< of what is seen, +infinity: nothing
    double cutoff;
} footprints;

/// Projects a point that is `from_origin` from the reader's origin; false: behind the eye. `z` is its depth in camera
/// space.
static bool project(const footprints *of, const double from_origin[3], double pixel[2], double *z) {
    const ewa_camera *camera = of->camera;
    double seen[3];
    for (int row = 0; row < 3; row++) {
        const double *m = camera->world_to_camera + 4 * row;
        seen[row] = m[3];
        for (int c = 0; c < 3; c++) seen[row] += m[c] * (of->reader.origin_world[c] + from_origin[c]);
    }
    *z = seen[2];
    const double scale = camera->projection == EWA_PERSPECTIVE ? 1 / seen[2] : 1;
    pixel[0] = camera->fx_px * seen[0] * scale + camera->cx_px;
    pixel[1] = camera->fy_px * seen[1] * scale + camera->cy_px;
    return camera->projection != EWA_PERSPECTIVE || seen[2] > 0;
}

/// Whether the middle of a surfel is in the picture, and no farther than its radius behind what is seen there.
static bool is_seen(const footprints *of, const ewa_surfel *surfel) {
    const ewa_camera *camera = of->camera;
    double pixel[2], z;
    if (!project(of, surfel->center, pixel, &z)) return false;
    if (!(pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] < camera->width_px && pixel[1] < camera->height_px)) return false;
    const double *m = camera->world_to_camera + 8, *u = surfel->axis_u_world;
    const double scale = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    const double reach = of->cutoff * scale * sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    return z <= (double)of->depth[(size_t)pixel[1] * camera->width_px + (size_t)pixel[0]] + reach;
}

/// Whether the clip lines leave a place of the disc, in standard deviations.
static bool is_left(const ewa_surfel *surfel, double u, double v) {
    int lines = 0, kept = 0;
    for (int i = 0; i < 2; i++) {
        const double *line = surfel->clip[i];
        if (line[0] == 0 && line[1] == 0) continue;
        lines++;
        kept += line[0] * u + line[1] * v + line[2] >= 0;
    }
    return surfel->clip_either > 0 ? kept > 0 || lines == 0 : kept == lines;
}

static void draw_outline(const footprints *of, const ewa_surfel *surfel, const ewa_canvas *canvas) {
    double before[2], pixel[2], z;
    bool joined = false;
    for (int i = 0; i <= SEGMENTS; i++) {
        const double turn = 2 * PI * i / SEGMENTS, u = of->cutoff * cos(turn), v = of->cutoff * sin(turn);
        double place[3];
        for (int c = 0; c < 3; c++)
            place[c] = surfel->center[c] + u * surfel->axis_u_world[c] + v * surfel->axis_v_world[c];
        const bool shown = project(of, place, pixel, &z) && is_left(surfel, u, v);
        if (shown && joined) ewa_draw_line(canvas, before[0], before[1], pixel[0], pixel[1], LINE_PX, INK);
        joined = shown;
        before[0] = pixel[0], before[1] = pixel[1];
    }
}

/// Goes over all surfels that are seen; draws those whose turn it is, `count` of `seen_count` (0: none). Returns how many
/// are seen.
static uint64_t go_over(const footprints *of, uint64_t point_count, uint64_t seen_count, uint32_t count,
                        const ewa_canvas *canvas) {
    ewa_surfel surfels[BLOCK];
    bool drawable[BLOCK];
    uint64_t seen = 0, drawn = 0;
    for (uint64_t first = 0; first < point_count; first += BLOCK) {
        const uint64_t in_block = point_count - first < BLOCK ? point_count - first : BLOCK;
        ewa_surfel_read(&of->reader, first, in_block, surfels, drawable);
        for (uint64_t i = 0; i < in_block; i++) {
            if (!drawable[i] || !is_seen(of, &surfels[i])) continue;
            // The middle one of each run of equal length.
            const double turn = ((double)drawn + 0.5) * (double)seen_count / count;
            if (seen_count && drawn < count && (double)seen >= floor(turn)) {
                draw_outline(of, &surfels[i], canvas);
                drawn++;
            }
            seen++;
        }
    }
    return seen;
}

ewa_status ewa_scene_draw_outlines(ewa_scene *scene, ewa_scene_renderer *renderer, const ewa_camera *camera,
                                   const ewa_scene_options *options, uint32_t count, const ewa_canvas *canvas) {
    if (!scene || !renderer || !camera || !canvas || !canvas->rgba8) return EWA_ERROR_ARGUMENT;
    if (canvas->width_px != camera->width_px || canvas->height_px != camera->height_px)
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT,
                        "outlines: a picture of %u x %u pixels for a camera of %u x %u", canvas->width_px,
                        canvas->height_px, camera->width_px, camera->height_px);
    if (count == 0) return EWA_OK;
    ewa_cloud *cloud = NULL;
    // Of a scene that is committed, the messages have been told.
    const bool told = scene->committed;
    if (told) ewa_reports_hush(scene->context, true);
    ewa_status status = ewa_scene_gather(scene, true, &cloud);
    if (told) ewa_reports_hush(scene->context, false);
    EWA_TRY(status);
    if (!cloud)
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT,
                        "outlines are of the surfels of clouds and meshes, of which the scene shows none");
    footprints of = {.camera = camera, .cutoff = scene->options.surfels.cutoff};
    const size_t pixel_count = (size_t)camera->width_px * camera->height_px;
    float *depth = ewa_allocate(scene->context, pixel_count, sizeof *depth);
    status = depth ? ewa_surfel_reader_open(cloud, &scene->options.surfels, &of.reader) : EWA_ERROR_MEMORY;
    if (status == EWA_OK)
        status = ewa_scene_draw(scene, renderer, camera, options, &(ewa_frame){.depth = depth}, NULL);
    if (status == EWA_OK) {
        of.depth = depth;
        const uint64_t points = ewa_cloud_point_count(cloud), seen = go_over(&of, points, 0, count, canvas);
        go_over(&of, points, seen, count, canvas);
    }
    ewa_release(scene->context, depth, pixel_count, sizeof *depth);
    ewa_cloud_destroy(&cloud);
    return status;
}
