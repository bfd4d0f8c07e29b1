// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The share of a bell that lies below t standard deviations, Phi(t): share_below() of src/volume/kernels_over.h.

float share_below(float t) {
    float x = wf_mul(wf_abs(t), 0.707106781), bell = wf_exp2(wf_mul(-0.721347520, wf_mul(t, t)));
    float u = wf_div(1.0, wf_fma(x, 0.3275911, 1.0));
    float series = wf_fma(u, 1.061405429, -1.453152027);
    series = wf_fma(u, series, 1.421413741);
    series = wf_fma(u, series, -0.284496736);
    series = wf_fma(u, series, 0.254829592);
    float beyond = wf_mul(0.5, wf_mul(wf_mul(u, series), bell));
    return t < 0.0 ? wf_keep(-6.0 < t, beyond) : wf_sub(1.0, beyond);
}
