// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as SPZ: see spz.c for its numbers. They are turned to right, up, back: what all versions mean when they
// name no axes, and all that many readers know.
#include "io/gaussian/save.h"
#include "io/deflate.h"
#include "io/gaussian/spz.h"
#include "io/zstandard.h"


enum {
    GZIP_LEVEL = 6,
    ZSTD_LEVEL = 12,
    FIXED_HALF = 1 << 23, ///< fixed-point numbers are below this
    FRACTION_BITS = 12,   ///< at least, where coordinates allow it
    MAX_FRACTION_BITS = 22,
    BOX_STEPS = 1 << 18, ///< of the longest side of the box, where coordinates allow it
    TABLE_ENTRY_BYTES = 16,
};

/// Finds how many bits of fraction coordinates get. Errors: EWA_ERROR_LIMIT.
static ewa_status choose_fraction(const ewa_gaussian_target *target, uint32_t *bits) {
    const ewa_gaussians *set = target->set;
    ewa_bounds box;
    double largest = 0, side = 0;
    EWA_TRY(ewa_gaussians_measure(set, &box));
    for (int k = 0; k < 3; k++) {
        largest = fmax(largest, fmax(fabs(box.low_world[k]), fabs(box.high_world[k])));
        side = fmax(side, box.high_world[k] - box.low_world[k]);
    }
    if (!(largest < FIXED_HALF - 1))
        return ewa_fail(
            set->context, EWA_ERROR_LIMIT,
            "%s: coordinates up to %.9g do not fit the 24 bits of SPZ; moved nearer to the origin they "
            "do",
            target->name, largest);
    *bits = FRACTION_BITS;
    while (*bits < MAX_FRACTION_BITS && ldexp(side, (int)*bits) < BOX_STEPS) ++*bits;
    while (*bits > 0 && !(ldexp(largest, (int)*bits) < FIXED_HALF - 1)) --*bits;
    if (*bits < FRACTION_BITS)
        ewa_report(set->context, EWA_SEVERITY_WARNING,
                   "%s: coordinates up to %.9g leave SPZ steps of %.3g between places", target->name, largest,
                   ldexp(1, -(int)*bits));
    return EWA_OK;
}

/// Where the streams are being filled.
typedef struct packing {
    const ewa_gaussians *set;
    ewa_spz_header header;
    uint8_t *streams[EWA_SPZ_STREAMS];
    ewa_gaussian_signs signs;
} packing;

static void pack_center(const packing *p, size_t i) {
    uint8_t *to = p->streams[EWA_SPZ_CENTERS] + 9 * i;
    for (size_t k = 0; k < 3; k++) {
        const double world =
            (double)p->signs.center[k] * (p->set->origin[k] + (double)p->set->centers[3 * i + k]);
        const int32_t fixed = (int32_t)floor(ldexp(world, (int)p->header.fraction_bits) + 0.5);
        for (int b = 0; b < 3; b++) *to++ = (uint8_t)((uint32_t)fixed >> 8 * b);
    }
}

static void pack_rotation(const packing *p, size_t i) {
    const float *rotation = p->set->rotations + 4 * i;
    double q[4]; // x y z w
    uint32_t largest = 3;
    for (uint32_t k = 0; k < 3; k++) q[k] = (double)(p->signs.rotation[k] * rotation[k + 1]);
    q[3] = (double)rotation[0];
    if (p->header.version == 2) {
        uint8_t *to = p->streams[EWA_SPZ_ROTATIONS] + 3 * i;
        for (uint32_t k = 0; k < 3; k++) to[k] = ewa_byte_of(127.5 + (q[3] < 0 ? -127.5 : 127.5) * q[k]);
        return;
    }
    for (uint32_t k = 0; k < 4; k++)
        if (fabs(q[k]) > fabs(q[largest])) largest = k;
    uint32_t word = largest;
    for (uint32_t k = 0; k < 4; k++) {
        if (k == largest) continue;
        const uint32_t size = (uint32_t)fmin(511 * fabs(q[k]) * sqrt(2) + 0.5, 511);
        word = word << 10 | ((q[k] < 0) != (q[largest] < 0) ? 512u : 0u) | size;
    }
    ewa_put_u32(p->streams[EWA_SPZ_ROTATIONS] + 4 * i, word);
}

static void pack(void *data, uint32_t first, uint32_t end) {
    const packing *p = data;
    const ewa_gaussians *set = p->set;
    const size_t rest = ewa_spz_stream_bytes(&p->header, EWA_SPZ_HARMONICS);
    for (size_t i = first; i < end; i++) {
        const float *harmonics = set->harmonics + i * 3 * ewa_sh_count(set->sh_degree);
        pack_center(p, i);
        pack_rotation(p, i);
        for (size_t k = 0; k < 3; k++) {
            p->streams[EWA_SPZ_SCALES][3 * i + k] =
                ewa_byte_of(16 * (ewa_log_scale(set->scales[3 * i + k]) + 10));
            p->streams[EWA_SPZ_COLORS][3 * i + k] =
                ewa_byte_of(255 * (0.5 + EWA_SPZ_COLOR * (double)harmonics[k]));
        }
        p->streams[EWA_SPZ_OPACITIES][i] = ewa_byte_of(255 * (double)set->opacities[i]);
        for (size_t k = 0; k < rest; k++)
            p->streams[EWA_SPZ_HARMONICS][i * rest + k] =
                ewa_byte_of(128 + 128 * (double)(p->signs.harmonics[1 + k / 3] * harmonics[3 + k]));
    }
}

static void put_head(const ewa_spz_header *header, uint8_t *to) {
    to = ewa_put_u32(to, EWA_SPZ_MAGIC);
    to = ewa_put_u32(to, header->version);
    to = ewa_put_u32(to, header->count);
    *to++ = (uint8_t)header->sh_degree;
    *to++ = (uint8_t)header->fraction_bits;
    *to++ = (uint8_t)header->flags;
    *to++ = (uint8_t)header->stream_count;
}

/// Packs head and streams, which follow each other, as one gzip stream.
static ewa_status put_gzip(const ewa_gaussian_target *target, const uint8_t *bytes, size_t size_bytes) {
    ewa_context *context = target->set->context;
    ewa_deflated packed;
    EWA_TRY(ewa_deflate(context, EWA_DEFLATE_GZIP, GZIP_LEVEL, bytes, size_bytes, &packed));
    const ewa_status status = ewa_writer_put(target->writer, packed.bytes, packed.size_bytes);
    ewa_deflated_free(context, &packed);
    return status;
}

/// Packs every stream on its own behind a head that says how long each became.
static ewa_status put_zstd(const ewa_gaussian_target *target, packing *p) {
    ewa_context *context = target->set->context;
    const uint32_t streams = p->header.sh_degree ? EWA_SPZ_STREAMS : EWA_SPZ_STREAMS - 1;
    uint8_t head[EWA_SPZ_OPEN_BYTES + EWA_SPZ_STREAMS * TABLE_ENTRY_BYTES] = {0};
    p->header.stream_count = streams;
    put_head(&p->header, head);
    ewa_put_u32(head + EWA_SPZ_HEAD_BYTES, EWA_SPZ_OPEN_BYTES);
    uint8_t *to = head + EWA_SPZ_OPEN_BYTES;
    size_t room = 0, used = 0;
    for (uint32_t k = 0; k < streams; k++)
        room += ewa_zstandard_bound((size_t)ewa_spz_stream_bytes(&p->header, k) * p->header.count);
    uint8_t *packed = ewa_allocate(context, room, 1);
    ewa_status status = packed ? EWA_OK : EWA_ERROR_MEMORY;
    for (uint32_t k = 0; k < streams && status == EWA_OK; k++) {
        const size_t whole = (size_t)ewa_spz_stream_bytes(&p->header, k) * p->header.count;
        size_t got = 0;
        const char *wrong = ewa_zstandard_pack(p->streams[k], whole, ZSTD_LEVEL, packed + used, room - used, &got);
        if (wrong) {
            status = ewa_fail(context, EWA_ERROR_MEMORY, "%s: %s", target->name, wrong);
            break;
        }
        to = ewa_put_u64(ewa_put_u64(to, got), whole);
        used += got;
    }
    if (status == EWA_OK) status = ewa_writer_put(target->writer, head, (size_t)(to - head));
    if (status == EWA_OK) status = ewa_writer_put(target->writer, packed, used);
    ewa_release(context, packed, room, 1);
    return status;
}

ewa_status ewa_gaussians_write_spz(const ewa_gaussian_target *target) {
    const ewa_gaussians *set = target->set;
    packing p = {.set = set,
                 .header = {.version = target->spz_version,
                            .count = set->count,
                            .sh_degree = target->sh_degree,
                            .flags = set->antialiased ? EWA_SPZ_ANTIALIASED : 0}};
    ewa_gaussian_signs_turn(&p.signs);
    EWA_TRY(choose_fraction(target, &p.header.fraction_bits));
    size_t size_bytes = EWA_SPZ_HEAD_BYTES;
    for (uint32_t k = 0; k < EWA_SPZ_STREAMS; k++)
        size_bytes += (size_t)ewa_spz_stream_bytes(&p.header, k) * set->count;
    uint8_t *bytes = ewa_allocate(set->context, size_bytes, 1);
    if (!bytes) return EWA_ERROR_MEMORY;
    put_head(&p.header, bytes);
    uint8_t *to = bytes + EWA_SPZ_HEAD_BYTES;
    for (uint32_t k = 0; k < EWA_SPZ_STREAMS; k++) {
        p.streams[k] = to;
        to += (size_t)ewa_spz_stream_bytes(&p.header, k) * set->count;
    }
    ewa_gaussians_decode(set->context, set->count, pack, &p);
    ewa_status status = target->spz_version < 4 ? put_gzip(target, bytes, size_bytes) : put_zstd(target, &p);
    ewa_release(set->context, bytes, size_bytes, 1);
    if (status == EWA_OK && set->flat)
        ewa_report(set->context, EWA_SEVERITY_WARNING,
                   "%s: SPZ does not say that Gaussians are flat: their third scale is e^-10", target->name);
    return status;
}
