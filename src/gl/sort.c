// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A stable radix sort on the device. Based on: D. Merrill, A. Grimshaw, "High Performance and Scalable Radix Sorting", 2011 (counts,
// their sums, places).
#include "gl/sort.h"
#include "gl/shaders.h"

#include <stdio.h>

enum { DIGITS = 1 << EWA_GL_SORT_BITS };

void ewa_gl_sort_write(uint32_t stage, ewa_gl_source *source) {
    snprintf(source->head, sizeof source->head, "#version 430 core\n#define STAGE %u\n", stage);
    source->pieces[0] = ewa_shader_scan, source->pieces[1] = ewa_shader_sort;
    source->piece_count = 2;
}

static ewa_status make_programs(ewa_gl *device, ewa_gl_sorter *sorter) {
    for (uint32_t i = 0; i < EWA_GL_SORT_STAGES; i++) {
        if (sorter->programs[i]) continue;
        ewa_gl_source source;
        ewa_gl_sort_write(i, &source);
        const ewa_gl_stage stage = {GL_COMPUTE_SHADER, source.head, source.pieces, source.piece_count};
        EWA_TRY(ewa_gl_program_make(device, "sort", &stage, 1, &sorter->programs[i]));
    }
    return EWA_OK;
}

ewa_status ewa_gl_sort_pass(ewa_gl *device, ewa_gl_sorter *sorter, const ewa_gl_items *from, const ewa_gl_items *to,
                            const ewa_gl_buffer *counts, uint32_t count_at, uint32_t shift) {
    enum { SHIFT, COUNT_AT, CAPACITY, BLOCK_COUNT, ROOM };
    const uint32_t blocks = (uint32_t)(((uint64_t)from->capacity + EWA_GL_SORT_BLOCK - 1) / EWA_GL_SORT_BLOCK);
    EWA_TRY(make_programs(device, sorter));
    EWA_TRY(ewa_gl_buffer_reserve(device, &sorter->table, "sorting", DIGITS * (blocks + (uint64_t)1) * sizeof(uint32_t)));
    const ewa_gl_buffer *const buffers[] = {from->keys, from->values, to->keys, to->values, &sorter->table, counts};
    for (GLuint i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]->name);
    for (uint32_t i = 0; i < EWA_GL_SORT_STAGES; i++) {
        glUseProgram(sorter->programs[i]);
        glUniform1ui(SHIFT, shift);
        glUniform1ui(COUNT_AT, count_at);
        glUniform1ui(CAPACITY, from->capacity);
        glUniform1ui(BLOCK_COUNT, blocks);
        glUniform1ui(ROOM, to->capacity);
        ewa_gl_program_run(device, i == 1 ? DIGITS : blocks);
    }
    return ewa_gl_check(device, "sorting");
}

void ewa_gl_sorter_free(ewa_gl_sorter *sorter) {
    for (uint32_t i = 0; i < EWA_GL_SORT_STAGES; i++)
        if (sorter->programs[i]) glDeleteProgram(sorter->programs[i]);
    ewa_gl_buffer_free(&sorter->table);
    *sorter = (ewa_gl_sorter){.table.size_bytes = 0};
}
