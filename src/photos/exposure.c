// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Exposures of photographs: gains and offsets by weighted least squares, which robust weights make anew in each step, and what
// their lens darkens towards the corners.
//
// Based on: S. Geman, D. McClure, "Statistical Methods for Tomographic Image Reconstruction", 1987 (weights).
#include "photos/parts.h"

#include <math.h>

/// What pulls offsets to 0 where all colours are alike, in squares of colours.
static const double OFFSET_PULL = 1e-5;
/// Gains of a photograph that shows next to nothing stay within.
static const double MIN_GAIN = 1e-3, MAX_GAIN = 1e3;
/// Of both numbers of a vignette, relative to what pixels say of it: what they say nothing of stays small.
static const double VIGNETTING_DAMPING = 1e-4;
/// Lenses leave so much: on the way to what they leave where photographs show points, numbers may say less elsewhere.
static const double MIN_LIGHT = 0.05;

double ewa_robust_weight(const double shown[EWA_PHOTO_CHANNELS], const double wanted[EWA_PHOTO_CHANNELS], double scale) {
    if (scale <= 0) return 1;
    double square = 0;
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
        const double difference = sqrt(fmax(shown[c], 0)) - sqrt(fmax(wanted[c], 0));
        square += difference * difference / EWA_PHOTO_CHANNELS;
    }
    const double root = 1 / (1 + square / (scale * scale));
    return root * root;
}

void ewa_exposure_step(const ewa_exposure_pairs *pairs, ewa_photos_exposure kind, double scale,
                       double gain[EWA_PHOTO_CHANNELS], double offset[EWA_PHOTO_CHANNELS]) {
    double sums[EWA_PHOTO_CHANNELS][5] = {{0}}; // w, wc, wcc, wf, wcf
    if (kind == EWA_EXPOSURE_OFF) return;
    for (uint32_t i = 0; i < pairs->count; i += pairs->step) {
        double shown[EWA_PHOTO_CHANNELS], color[EWA_PHOTO_CHANNELS], wanted[EWA_PHOTO_CHANNELS], weight = 0;
        pairs->get(pairs->user, i, shown, color, &weight);
        if (weight == 0) continue;
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) wanted[c] = gain[c] * color[c] + offset[c];
        weight *= ewa_robust_weight(shown, wanted, scale);
        for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
            const double w = weight / (fmax(color[c], 0) + EWA_PHOTO_MIN_COLOR), x = color[c], f = shown[c];
            const double terms[5] = {w, w * x, w * x * x, w * f, w * x * f};
            for (int k = 0; k < 5; k++) sums[c][k] += terms[k];
        }
    }
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
        const double *s = sums[c];
        if (!(s[2] > 0)) continue;
        double g = s[4] / s[2], o = 0;
        if (kind == EWA_EXPOSURE_GAIN_OFFSET) {
            const double w = s[0] + OFFSET_PULL * s[0] * s[0] / s[2];
            const double determinant = s[2] * w - s[1] * s[1];
            if (determinant > 1e-9 * s[2] * w) {
                g = (s[4] * w - s[1] * s[3]) / determinant;
                o = (s[2] * s[3] - s[1] * s[4]) / determinant;
            }
        }
        gain[c] = fmin(fmax(g, MIN_GAIN), MAX_GAIN), offset[c] = o;
    }
}

double ewa_photo_radius2(const ewa_camera *camera, double x_px, double y_px) {
    const double x = x_px - 0.5 * camera->width_px, y = y_px - 0.5 * camera->height_px;
    return 4 * (x * x + y * y) / ((double)camera->width_px * camera->width_px + (double)camera->height_px * camera->height_px);
}

double ewa_photo_vignette(const double vignetting[2], double radius2) {
    return fmax(1 + radius2 * (vignetting[0] + radius2 * vignetting[1]), MIN_LIGHT);
}

void ewa_vignetting_add(const double shown[EWA_PHOTO_CHANNELS], const double wanted[EWA_PHOTO_CHANNELS], double radius2,
                        double weight, double sums[EWA_VIGNETTING_SUMS]) {
    for (int c = 0; c < EWA_PHOTO_CHANNELS; c++) {
        const double w = weight / (fmax(wanted[c], 0) + EWA_PHOTO_MIN_COLOR), x = wanted[c] * radius2, y = x * radius2,
                     f = shown[c] - wanted[c];
        const double terms[EWA_VIGNETTING_SUMS] = {w * x * x, w * x * y, w * y * y, w * x * f, w * y * f};
        for (int k = 0; k < EWA_VIGNETTING_SUMS; k++) sums[k] += terms[k];
    }
}

void ewa_vignetting_solve(const double sums[EWA_VIGNETTING_SUMS], double vignetting[2]) {
    const double xx = sums[0] * (1 + VIGNETTING_DAMPING), xy = sums[1], yy = sums[2] * (1 + VIGNETTING_DAMPING);
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0)) return;
    vignetting[0] = (sums[3] * yy - sums[4] * xy) / determinant;
    vignetting[1] = (sums[4] * xx - sums[3] * xy) / determinant;
}

void ewa_exposures_centre(ewa_photos_job *job, double *const *colors, uint32_t array_count) {
    for (int c = 0; c < EWA_PHOTO_CHANNELS && job->options.exposure != EWA_EXPOSURE_OFF; c++) {
        double logs = 0, gains = 0, offsets = 0;
        uint32_t count = 0;
        for (uint32_t i = 0; i < job->photo_count; i++) {
            const ewa_photo_state *photo = &job->photos[i];
            if (!ewa_photo_is_exposed(photo)) continue;
            logs += log(photo->gain[c]), gains += photo->gain[c], offsets += photo->offset[c];
            count++;
        }
        if (count == 0) return;
        // A colour x becomes scale x + shift, and all photographs show the same of it.
        const double scale = exp(logs / count), shift = offsets / (gains / scale);
        for (uint32_t i = 0; i < job->photo_count; i++) {
            ewa_photo_state *photo = &job->photos[i];
            photo->gain[c] /= scale;
            photo->offset[c] -= shift * photo->gain[c];
        }
        for (uint32_t k = 0; k < array_count; k++)
            for (uint32_t i = 0; i < job->point_count; i++) {
                double *at = &colors[k][(size_t)i * EWA_PHOTO_CHANNELS + (size_t)c];
                if (job->counts[i]) *at = scale * *at + shift;
            }
    }
}
