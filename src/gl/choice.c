// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which of processor and device draws the frames of a scene.
#include "gl/choice.h"
#include "base/format.h"
#include "gl/tuning.h"

bool ewa_gl_choice_takes_gl(const ewa_gl_choice *choice) {
    return choice->step == EWA_GL_WARM_UP || choice->step == EWA_GL_MEASURE || choice->by_gl;
}

void ewa_gl_choice_learn(ewa_gl_choice *choice, bool by_gl, double took_s, char *remark, size_t remark_bytes) {
    if (choice->step == EWA_GL_DECIDED) return;
    *(by_gl ? &choice->gl_s : &choice->cpu_s) = took_s;
    if (++choice->step != EWA_GL_DECIDED) return;
    choice->by_gl = choice->gl_s < choice->cpu_s || ewa_gl_tuning_is("auto", "gl");
    ewa_format(remark, remark_bytes, "frames took %.3g ms by the CPU, %.3g ms by the device", 1e3 * choice->cpu_s,
               1e3 * choice->gl_s);
}

void ewa_gl_choice_leave(ewa_gl_choice *choice) { choice->step = EWA_GL_DECIDED, choice->by_gl = false; }

bool ewa_gl_far_apart(uint64_t a, uint64_t b) { return a / 2 > b || b / 2 > a; }
