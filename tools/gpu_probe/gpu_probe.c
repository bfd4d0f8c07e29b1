// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// gpu_probe [--json]: what a graphics processor is, how it calculates, and the rates that decide how to draw with it; a section
// for docs/gpu.md, or JSON.
#include "gl/compute.h"
#include "rates.h"

#include <stdio.h>
#include <string.h>

typedef struct probe {
    ewa_gl_facts facts;
    ewa_gl_verdict verdict;
    bool usable;
    GLint shared_bytes, timer_bits;
    bool subgroups, long_atomics, ballots;
    probe_rates rates;
} probe;

static void on_message(void *user, ewa_severity severity, const char *text) {
    (void)user, (void)severity;
    fprintf(stderr, "gpu_probe: %s\n", text);
}

static const char *class_of(const probe *found) {
    return !found->usable ? "unusable" : found->verdict.exact ? "exact" : "close";
}

static const char *said(bool yes) { return yes ? "yes" : "no"; }

static void print_markdown(const probe *found) {
    const ewa_gl_facts *facts = &found->facts;
    const ewa_gl_arithmetic *own = &found->verdict.own;
    const probe_rates *rates = &found->rates;
    printf("### %s\n\n| | |\n|---|---|\n", facts->renderer);
    printf("| vendor, version | %s, %s%s |\n", facts->vendor, facts->version,
           facts->software ? ", software" : "");
    printf("| class | %s%s%s |\n", class_of(found), found->verdict.differs ? ": " : "",
           found->verdict.differs ? found->verdict.differs : "");
    printf("| fma fused; quotient, root correctly rounded | %s; %s, %s |\n", said(own->fused),
           said(own->divides), said(own->roots));
    printf("| storage buffers | %u of %.0f MiB |\n", facts->storage_count,
           (double)facts->storage_bytes / (1 << 20));
    printf("| groups | %u threads, %d KiB shared |\n", facts->group_threads, found->shared_bytes >> 10);
    printf("| subgroups, ballots, 64-bit atomics | %s, %s, %s |\n", said(found->subgroups),
           said(found->ballots), said(found->long_atomics));
    printf("| times by | %s |\n", facts->software ? "the wall" : "GL_TIME_ELAPSED");
    printf("| fma, of doubles | %.3g, %.3g TFLOP/s |\n", rates->fma_tflops, rates->double_tflops);
    printf("| %.2f M splats of 25 px, 7 sums: gather | %.3g ms |\n", 1e-6 * rates->splat_count,
           rates->way_ms[PROBE_GATHER]);
    printf("| the same by shared atomics | %.3g ms |\n", rates->way_ms[PROBE_SHARED_ATOMICS]);
    printf("| the same by global atomics | %.3g ms%s |\n", rates->way_ms[PROBE_GLOBAL_ATOMICS],
           rates->ways_agree ? "" : " (other sums)");
    printf("| blending of RGBA32F, RGBA16F | %.3g, %.3g Gpx/s |\n", rates->blend32_gpx_s,
           rates->blend16_gpx_s);
    printf("| readback of %.1f MB | %.3g ms |\n", rates->readback_mb, rates->readback_ms);
    printf("| wait for a dispatch; a dispatch | %.3g; %.3g ms |\n", rates->wait_ms, rates->dispatch_ms);
    printf("| upload, clear of %.1f MB | %.3g, %.3g ms |\n", rates->readback_mb, rates->upload_ms, rates->clear_ms);
    printf("| compiling the set-up program | %.3g ms |\n", rates->compile_ms);
    if (!found->usable) return;
    printf("| passes of a frame: a torus of %u surfels, %ux%u | ms |\n", rates->pass_splat_count, rates->pass_width_px,
           rates->pass_height_px);
    for (int pass = 0; pass < EWA_GL_PASSES; pass++)
        printf("| %s%s | %.3g |\n", ewa_gl_pass_name((ewa_gl_pass)pass), pass == EWA_GL_AVERAGES ? " of 2x2 parts" : "",
               rates->pass_ms[pass]);
}

static void print_json(const probe *found) {
    const ewa_gl_facts *facts = &found->facts;
    const ewa_gl_arithmetic *own = &found->verdict.own;
    const probe_rates *rates = &found->rates;
    static const char *const words[] = {"false", "true"};
    printf("{\n  \"renderer\": \"%s\",\n  \"vendor\": \"%s\",\n  \"version\": \"%s\",\n", facts->renderer,
           facts->vendor, facts->version);
    printf("  \"software\": %s,\n  \"class\": \"%s\",\n", words[facts->software], class_of(found));
    printf("  \"fma_is_fused\": %s,\n  \"quotient_is_rounded\": %s,\n  \"root_is_rounded\": %s,\n",
           words[own->fused], words[own->divides], words[own->roots]);
    printf("  \"storage_buffers\": %u,\n  \"storage_bytes\": %llu,\n  \"group_threads\": %u,\n",
           facts->storage_count, (unsigned long long)facts->storage_bytes, facts->group_threads);
    printf("  \"shared_bytes\": %d,\n  \"timer_bits\": %d,\n", found->shared_bytes, found->timer_bits);
    printf("  \"subgroups\": %s,\n  \"ballots\": %s,\n  \"atomics_of_64_bits\": %s,\n",
           words[found->subgroups], words[found->ballots], words[found->long_atomics]);
    printf("  \"fma_tflops\": %.4g,\n  \"splats\": %u,\n  \"gather_ms\": %.4g,\n", rates->fma_tflops,
           rates->splat_count, rates->way_ms[PROBE_GATHER]);
    printf("  \"shared_atomics_ms\": %.4g,\n  \"global_atomics_ms\": %.4g,\n  \"ways_agree\": %s,\n",
           rates->way_ms[PROBE_SHARED_ATOMICS], rates->way_ms[PROBE_GLOBAL_ATOMICS],
           words[rates->ways_agree]);
    printf("  \"blend_rgba32f_gpx_s\": %.4g,\n  \"blend_rgba16f_gpx_s\": %.4g,\n", rates->blend32_gpx_s,
           rates->blend16_gpx_s);
    printf("  \"double_tflops\": %.4g,\n  \"wait_ms\": %.4g,\n  \"dispatch_ms\": %.4g,\n", rates->double_tflops,
           rates->wait_ms, rates->dispatch_ms);
    printf("  \"upload_ms\": %.4g,\n  \"clear_ms\": %.4g,\n  \"compile_ms\": %.4g,\n", rates->upload_ms,
           rates->clear_ms, rates->compile_ms);
    printf("  \"readback_mb\": %.4g,\n  \"readback_ms\": %.4g,\n", rates->readback_mb, rates->readback_ms);
    printf("  \"pass_splats\": %u,\n  \"pass_size_px\": [%u, %u],\n  \"pass_ms\": {", rates->pass_splat_count,
           rates->pass_width_px, rates->pass_height_px);
    for (int pass = 0; pass < EWA_GL_PASSES && found->usable; pass++)
        printf("%s\"%s\": %.4g", pass ? ", " : "", ewa_gl_pass_name((ewa_gl_pass)pass), rates->pass_ms[pass]);
    printf("}\n}\n");
}

static ewa_status look(ewa_gl *device, probe *found) {
    found->facts = device->facts;
    ewa_failures_soften(device->context, true);
    found->usable = ewa_gl_try(device, &found->verdict) == EWA_OK;
    ewa_failures_soften(device->context, false);
    ewa_status status = ewa_gl_enter(device);
    if (status != EWA_OK) return status;
    found->subgroups = epoxy_has_gl_extension("GL_KHR_shader_subgroup");
    found->ballots = epoxy_has_gl_extension("GL_ARB_shader_ballot");
    found->long_atomics = epoxy_has_gl_extension("GL_NV_shader_atomic_int64");
    glGetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &found->timer_bits);
    if (found->facts.compute) {
        glGetIntegerv(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, &found->shared_bytes);
        status = probe_measure(device, &found->rates);
    }
    ewa_gl_leave(device);
    return status;
}

int main(int count, char **words) {
    const bool json = count == 2 && strcmp(words[1], "--json") == 0;
    if (count > 1 && !json) {
        fprintf(stderr, "usage: gpu_probe [--json]\nEWA_GL_DEVICE=N takes the N-th device.\n");
        return 2;
    }
    ewa_context_options options;
    ewa_context_options_init(&options, sizeof options);
    options.message = on_message;
    ewa_context *context;
    if (ewa_context_create(&options, &context) != EWA_OK) return 1;
    enum { NO_DEVICE = 77 };
    ewa_gl *device;
    if (ewa_gl_open(context, &device) != EWA_OK) {
        ewa_context_destroy(&context);
        return NO_DEVICE;
    }
    probe found = {.usable = false};
    ewa_status status = look(device, &found);
    ewa_gl_close(&device);
    if (status == EWA_OK && found.usable) status = probe_passes(context, found.facts.software, &found.rates);
    if (status == EWA_OK) (json ? print_json : print_markdown)(&found);
    ewa_context_destroy(&context);
    return status == EWA_OK ? 0 : 1;
}
