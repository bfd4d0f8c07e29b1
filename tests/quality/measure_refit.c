// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Prints the table of docs/colors.md on refitted colours.
#include "quality/refit_scene.h"

#include <stdio.h>

int main(void) {
    static const char *const names[] = {"checker", "marble", "wood", "noise"};
    static const refit_setting settings[] = {
        {EWA_PROCEDURE_CHECKER, 10, 10000, 0.5, 1.14, 0}, {EWA_PROCEDURE_CHECKER, 10, 10000, 0.5, 1.6, 0},
        {EWA_PROCEDURE_CHECKER, 10, 10000, 0.5, 2, 0},    {EWA_PROCEDURE_MARBLE, 4, 10000, 0.5, 1.6, 0},
        {EWA_PROCEDURE_NOISE, 4, 10000, 0.5, 1.14, 0},    {EWA_PROCEDURE_NOISE, 4, 10000, 0.5, 1.6, 0},
        {EWA_PROCEDURE_NOISE, 1.5, 10000, 0.5, 1.6, 0},   {EWA_PROCEDURE_NOISE, 1.5, 10000, 1, 1.6, 0},
        {EWA_PROCEDURE_NOISE, 4, 10000, 1, 1.6, 0},       {EWA_PROCEDURE_NOISE, 4, 10000, 0.5, 1.6, 0.02},
        {EWA_PROCEDURE_NOISE, 4, 10000, 1, 1.6, 0.02},    {EWA_PROCEDURE_NOISE, 4, 10000, 1, 1.6, 0.05},
    };
    ewa_context *context = NULL;
    if (ewa_context_create(NULL, &context) != EWA_OK) return 1;
    printf("| texture | features per spacing | jitter | radius | noise | plain | interpolate | fit | error "
           "at the "
           "points, plain | interpolate | fit | steps | coefficients |\n"
           "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        const refit_setting *s = &settings[i];
        ewa_refit_report interpolated = {0}, fitted = {0};
        const double plain_db = refit_scene_psnr(context, s, REFIT_PLAIN, NULL),
                     interpolate_db = refit_scene_psnr(context, s, EWA_REFIT_INTERPOLATE, &interpolated),
                     fit_db = refit_scene_psnr(context, s, EWA_REFIT_FIT, &fitted);
        printf("| %s | %.2g | %g | %g | %g | %.2f dB | %.2f dB | %.2f dB | %.4f | %.4f | %.4f | %u, %u | "
               "%.2g to "
               "%.2g, %.2g to %.2g |\n",
               names[s->texture], s->frequency * 2 / 100, s->jitter, s->radius_scale, s->noise, plain_db,
               interpolate_db, fit_db, interpolated.before_rms, interpolated.after_rms, fitted.after_rms,
               interpolated.iteration_count, fitted.iteration_count, (double)interpolated.low,
               (double)interpolated.high, (double)fitted.low, (double)fitted.high);
    }
    ewa_context_destroy(&context);
    return 0;
}
