// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pages of E57 files and their checksums.
//
// CRC-32C by: RFC 3720, section 12.1; eight bytes at a time by eight tables.
#include "io/e57/e57.h"

#include <string.h>
#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

enum { TABLES = 8, TASK_PAGES = 1024 };

typedef struct checksum_tables {
    uint32_t of[TABLES][256];
} checksum_tables;

static void make_tables(checksum_tables *tables) {
    for (uint32_t i = 0; i < 256; i++) {
        uint32_t rest = i;
        for (int bit = 0; bit < 8; bit++) rest = rest >> 1 ^ (rest & 1 ? 0x82f63b78u : 0);
        tables->of[0][i] = rest;
    }
    for (int t = 1; t < TABLES; t++)
        for (uint32_t i = 0; i < 256; i++) {
            const uint32_t before = tables->of[t - 1][i];
            tables->of[t][i] = before >> 8 ^ tables->of[0][before & 255];
        }
}

static uint32_t by_tables(const checksum_tables *t, const uint8_t *bytes, size_t size) {
    uint32_t rest = UINT32_MAX;
    for (; size >= TABLES; size -= TABLES, bytes += TABLES) {
        const uint32_t low =
            rest ^ (bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24);
        rest = t->of[7][low & 255] ^ t->of[6][low >> 8 & 255] ^ t->of[5][low >> 16 & 255] ^
               t->of[4][low >> 24] ^ t->of[3][bytes[4]] ^ t->of[2][bytes[5]] ^ t->of[1][bytes[6]] ^
               t->of[0][bytes[7]];
    }
    for (; size; size--) rest = rest >> 8 ^ t->of[0][(rest ^ *bytes++) & 255];
    return ~rest;
}

#if defined(__x86_64__)
__attribute__((target("sse4.2,crc32"))) static uint32_t by_instruction(const uint8_t *bytes, size_t size) {
    uint64_t rest = UINT32_MAX;
    for (; size >= sizeof rest; size -= sizeof rest, bytes += sizeof rest) {
        uint64_t word;
        memcpy(&word, bytes, sizeof word);
        rest = _mm_crc32_u64(rest, word);
    }
    for (; size; size--) rest = _mm_crc32_u8((uint32_t)rest, *bytes++);
    return ~(uint32_t)rest;
}
#endif

uint32_t ewa_e57_checksum(const uint8_t *bytes, size_t size_bytes, bool hardware) {
#if defined(__x86_64__)
    if (hardware) return by_instruction(bytes, size_bytes);
#endif
    (void)hardware;
    checksum_tables tables;
    make_tables(&tables);
    return by_tables(&tables, bytes, size_bytes);
}

typedef struct check_job {
    const ewa_e57_pages *pages;
    bool hardware;
    checksum_tables tables;
} check_job;

static void check_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const check_job *job = data;
    const ewa_e57_pages *pages = job->pages;
    const uint64_t first = (uint64_t)task * TASK_PAGES, left = pages->page_count - first;
    const uint64_t end = first + (left < TASK_PAGES ? left : TASK_PAGES);
    for (uint64_t page = first; page < end; page++) {
        const uint8_t *bytes = pages->bytes + page * pages->page_bytes, *said = bytes + pages->payload_bytes;
        const uint32_t checksum = job->hardware ? ewa_e57_checksum(bytes, pages->payload_bytes, true)
                                                : by_tables(&job->tables, bytes, pages->payload_bytes);
        pages->damaged[page] = checksum != ((uint32_t)said[0] << 24 | (uint32_t)said[1] << 16 |
                                            (uint32_t)said[2] << 8 | said[3]);
    }
}

ewa_status ewa_e57_pages_open(const ewa_cloud_source *source, uint64_t page_bytes, uint64_t size_bytes,
                              ewa_e57_pages *pages) {
    *pages = (ewa_e57_pages){.source = source,
                             .bytes = source->bytes,
                             .page_bytes = page_bytes,
                             .payload_bytes = page_bytes - EWA_E57_CHECKSUM_BYTES,
                             .page_count = size_bytes / page_bytes};
    pages->damaged = ewa_allocate_zeroed(source->context, pages->page_count, 1);
    if (!pages->damaged) return EWA_ERROR_MEMORY;
    check_job job = {.pages = pages, .hardware = false};
#if defined(__x86_64__)
    // CPUs with AVX2 have the instruction.
    job.hardware = ewa_context_cpu_features(source->context) & EWA_CPU_AVX2;
#endif
    if (!job.hardware) make_tables(&job.tables);
    const uint32_t tasks = (uint32_t)((pages->page_count + TASK_PAGES - 1) / TASK_PAGES);
    EWA_TRY(ewa_parallel_stoppable(source->context, "check", check_task, &job, tasks));
    uint64_t first = pages->page_count;
    for (uint64_t i = pages->page_count; i-- > 0;)
        if (pages->damaged[i]) {
            pages->damaged_count++;
            first = i;
        }
    if (!pages->damaged_count) return EWA_OK;
    return ewa_cloud_damage(source, 0,
                            "%s: page %llu at byte %llu is damaged: its checksum does not fit (%llu of %llu "
                            "pages are)",
                            source->name, (unsigned long long)first, (unsigned long long)(first * page_bytes),
                            (unsigned long long)pages->damaged_count, (unsigned long long)pages->page_count);
}

void ewa_e57_pages_close(ewa_e57_pages *pages) {
    if (pages->source) ewa_release(pages->source->context, pages->damaged, pages->page_count, 1);
    pages->damaged = NULL;
}

bool ewa_e57_logical(const ewa_e57_pages *pages, uint64_t physical, uint64_t *logical) {
    const uint64_t page = physical / pages->page_bytes, offset = physical % pages->page_bytes;
    *logical = page * pages->payload_bytes + offset;
    return page < pages->page_count && offset < pages->payload_bytes;
}

const uint8_t *ewa_e57_piece(const ewa_e57_pages *pages, uint64_t logical, uint64_t size_bytes,
                             uint64_t *piece_bytes) {
    const uint64_t page = logical / pages->payload_bytes, offset = logical % pages->payload_bytes;
    const uint64_t left = pages->payload_bytes - offset;
    *piece_bytes = size_bytes < left ? size_bytes : left;
    return pages->bytes + page * pages->page_bytes + offset;
}

bool ewa_e57_copy(const ewa_e57_pages *pages, uint64_t logical, uint64_t size_bytes, uint8_t *to,
                  bool *damaged) {
    const uint64_t there = pages->page_count * pages->payload_bytes;
    if (logical > there || size_bytes > there - logical) return false;
    while (size_bytes) {
        uint64_t piece_bytes;
        const uint8_t *piece = ewa_e57_piece(pages, logical, size_bytes, &piece_bytes);
        if (pages->damaged[logical / pages->payload_bytes]) *damaged = true;
        memcpy(to, piece, piece_bytes);
        to += piece_bytes;
        logical += piece_bytes;
        size_bytes -= piece_bytes;
    }
    return true;
}
