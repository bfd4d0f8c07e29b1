// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The part of local_body.h that adds up kernels where discs cover a cell least (docs/math.md section 7).

// A disc grows by no more than this, and by what its kernel's exponent at the corner asks for, taken to be at least this.
static const float MAX_GROWTH = 1.5f, MIN_EXPONENT = 0.5f;

/// (1 - x / 16)^16 up to there, a tenth below exp(-x) at 2.
static inline wf bell(wf x) {
    const wf base = wf_max(wf_sub(wf_set(1), wf_mul(x, wf_set(1.0f / 16))), wf_set(0));
    const wf square = wf_mul(base, base), fourth = wf_mul(square, square), eighth = wf_mul(fourth, fourth);
    return wf_mul(eighth, eighth);
}

/// From radii to kernels.
static void set_kernels(local_gaps *gaps, wf per_radius2) {
    for (uint32_t i = 0; i < gaps->count; i += EWA_BLOCK_LANES) {
        const wf radius = wf_max(wf_load(&gaps->kernel[i]), wf_set(1e-15f));
        wf_store(&gaps->kernel[i], wf_div(per_radius2, wf_mul(radius, radius)));
    }
}

static void grow(local_gaps *gaps, float needed, float cutoff, float grown[EWA_BLOCK_LANES]) {
    const vec corner = {wf_load(gaps->corner[0]), wf_load(gaps->corner[1]), wf_load(gaps->corner[2])};
    const wf one = wf_set(1), half = wf_set(0.5f), least = wf_set(needed), per_radius2 = wf_set(0.5f * cutoff * cutoff);
    wf sum = wf_set(0);
    set_kernels(gaps, per_radius2);
    for (uint32_t i = 0; i < gaps->count; i++) {
        const vec way = v_sub((vec){wf_set(gaps->x[i]), wf_set(gaps->y[i]), wf_set(gaps->z[i])}, corner);
        sum = wf_add(sum, bell(wf_mul(v_dot(way, way), wf_set(gaps->kernel[i]))));
    }
    // A step of Newton's iteration in logarithms, all discs around the corner growing alike: (needed / sum)^(1 / (2 exponent)).
    const wf radius = wf_load(gaps->radius), reach2 = wf_load(gaps->reach2);
    const wf exponent = wf_div(wf_mul(per_radius2, reach2), wf_max(wf_mul(radius, radius), wf_set(1e-30f)));
    const wf ratio = wf_div(least, wf_max(sum, wf_set(1e-6f)));
    const wf t = wf_div(wf_sub(ratio, one), wf_mul(wf_add(ratio, one), wf_max(exponent, wf_set(MIN_EXPONENT))));
    const wf by = wf_min(wf_add(one, wf_mul(t, wf_add(one, wf_mul(half, t)))), wf_set(MAX_GROWTH));
    const wf closed = wf_max(radius, wf_min(wf_mul(radius, by), wf_load(gaps->limit)));
    wf_store(grown, wf_select(wm_and(wf_lt(wf_set(0), reach2), wf_lt(sum, least)), closed, radius));
}
