// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Opaque surfaces among what lets light through: their planes, and what is seen past their antialiased edges.
#include "within.h"

/// Share of what is behind that must come through to be told apart from rounding.
static const float LEAST_THROUGH = 1e-3f;

// A picture without the surfaces is past = front + (1 - alpha of front) * behind, of which front is what lies
// before the surface.
void within_fill_edges(within_planes *planes, const float background[4]) {
    const size_t pixel_count = (size_t)planes->surface.width_px * planes->surface.height_px;
    for (size_t i = 0; i < pixel_count; i++) {
        float *surface = planes->surface.pixels + 4 * i;
        const float *past = planes->past.pixels + 4 * i, *front = planes->front.pixels + 4 * i;
        const float left = 1 - surface[3], through = 1 - front[3];
        const bool nothing = surface[3] == 0;
        for (int c = 0; c < 4 && left > 0; c++) {
            const float plain = c < 3 ? background[c] * background[3] : background[3];
            const float behind = through > LEAST_THROUGH ? (past[c] - front[c]) / through : 0;
            surface[c] += left * (nothing ? plain : behind > 0 ? behind : 0);
        }
    }
}

void within_free(within_planes *planes) {
    ewa_image *const all[] = {&planes->surface, &planes->surface_depth, &planes->past, &planes->front,
                              &planes->nothing};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) ewa_image_free(all[i]);
}

ewa_status within_make(ewa_context *context, const ewa_camera *camera, within_planes *planes) {
    const uint32_t width = camera->width_px, height = camera->height_px;
    if (planes->surface.width_px == width && planes->surface.height_px == height) return EWA_OK;
    within_free(planes);
    ewa_status status = ewa_image_create(context, width, height, 1, &planes->surface_depth);
    if (status == EWA_OK) status = ewa_image_create(context, width, height, 4, &planes->past);
    if (status == EWA_OK) status = ewa_image_create(context, width, height, 4, &planes->front);
    if (status == EWA_OK) status = ewa_image_create(context, width, height, 4, &planes->nothing);
    if (status == EWA_OK) status = ewa_image_create(context, width, height, 4, &planes->surface);
    return status;
}
