// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// PlayCanvas's compressed PLY: Gaussians in chunks of 256, their numbers as shares of the chunk's bounds, packed
// into four integers of 32 bits; harmonics beyond the first in an element of bytes.
//
// Based on: PlayCanvas, "Compressed PLY", as SuperSplat and splat-transform write it.
#include "io/gaussian/ply.h"

#include <stdio.h>

enum { CHUNK = 256, MAX_REST = 3 * ((EWA_MAX_SH_DEGREE + 1) * (EWA_MAX_SH_DEGREE + 1) - 1) };

/// Bounds of a chunk; those of colours are [0, 1] where the file has none.
enum {
    LOW_CENTER = 0,
    HIGH_CENTER = 3,
    LOW_SCALE = 6,
    HIGH_SCALE = 9,
    LOW_COLOR = 12,
    HIGH_COLOR = 15,
    BOUNDS = 18
};

/// What the vertices are packed to.
enum { POSITION, ROTATION, SCALE, COLOR, WORDS };

static const char *const word_names[WORDS] = {"packed_position", "packed_rotation", "packed_scale",
                                              "packed_color"};

typedef struct packed {
    const ewa_gaussian_source *source;
    ewa_ply_source ply;
    ewa_ply_header *header;
    const ewa_ply_element *chunks, *vertices, *harmonics; ///< harmonics: NULL: none
    uint32_t rest_count;
    float *bounds;   ///< BOUNDS per chunk
    uint32_t *words; ///< WORDS per Gaussian
    uint8_t *rest;   ///< rest_count per Gaussian
    ewa_gaussians *set;
} packed;

static const ewa_ply_element *find_element(const ewa_ply_header *header, const char *name) {
    for (uint32_t i = 0; i < header->element_count; i++)
        if (ewa_text_is(header->elements[i].name, name)) return &header->elements[i];
    return NULL;
}

static bool is_packed(const ewa_ply_header *header) {
    const ewa_ply_element *vertices = ewa_ply_vertices(header);
    uint32_t property;
    for (int w = 0; w < WORDS; w++)
        if (!vertices || !ewa_ply_find_property(header, vertices, word_names[w], &property) ||
            header->properties[property].is_list)
            return false;
    return true;
}

/// Leads a property to a stream; false when the element has none of that name.
static bool add_stream(const packed *p, const ewa_ply_element *element, const char *name, ewa_type type,
                       void *to, size_t stride_bytes, ewa_ply_sink *sink) {
    uint32_t property;
    if (!ewa_ply_find_property(p->header, element, name, &property) ||
        p->header->properties[property].is_list)
        return false;
    const ewa_ply_property *from = &p->header->properties[property];
    if (type != EWA_F32 && from->type != type) return false;
    sink->streams[sink->stream_count++] = (ewa_ply_stream){.move = {.from_type = from->type,
                                                                    .to_type = type,
                                                                    .component_count = 1,
                                                                    .swap = ewa_ply_is_swapped(p->header)},
                                                           .from_offset_bytes = from->offset_bytes,
                                                           .to = to,
                                                           .to_stride_bytes = stride_bytes};
    return true;
}

static ewa_status fail_property(const packed *p, const char *name, const char *type) {
    return ewa_fail(p->source->context, EWA_ERROR_FORMAT,
                    "%s: packed Gaussians without a property %s of type %s", p->source->name, name, type);
}

/// Reads an element through a sink.
static ewa_status read_element(const packed *p, const ewa_ply_element *element, const ewa_ply_sink *sink) {
    uint64_t at = p->header->body_at;
    EWA_TRY(ewa_gaussians_ply_skip_to(&p->ply, p->header, element, &at));
    return ewa_gaussians_ply_read_element(&p->ply, p->header, element, sink, &at);
}

static ewa_status read_chunks(const packed *p) {
    static const char *const names[BOUNDS] = {
        "min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
        "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
        "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};
    ewa_ply_stream streams[BOUNDS];
    ewa_ply_sink sink = {.streams = streams, .stream_capacity = BOUNDS};
    uint32_t property;
    const bool has_colors = ewa_ply_find_property(p->header, p->chunks, names[LOW_COLOR], &property);
    for (int k = 0; k < BOUNDS && (k < LOW_COLOR || has_colors); k++)
        if (!add_stream(p, p->chunks, names[k], EWA_F32, p->bounds + k, BOUNDS * sizeof *p->bounds, &sink))
            return fail_property(p, names[k], "float");
    for (uint64_t c = 0; c < p->chunks->count && !has_colors; c++)
        for (int k = LOW_COLOR; k < BOUNDS; k++) p->bounds[c * BOUNDS + (uint64_t)k] = k >= HIGH_COLOR;
    return read_element(p, p->chunks, &sink);
}

static ewa_status read_vertices(const packed *p) {
    ewa_ply_stream streams[WORDS];
    ewa_ply_sink sink = {.streams = streams, .stream_capacity = WORDS};
    for (int w = 0; w < WORDS; w++)
        if (!add_stream(p, p->vertices, word_names[w], EWA_U32, p->words + w, WORDS * sizeof *p->words,
                        &sink))
            return fail_property(p, word_names[w], "uint");
    return read_element(p, p->vertices, &sink);
}

static ewa_status read_harmonics(const packed *p) {
    ewa_ply_stream streams[MAX_REST];
    ewa_ply_sink sink = {.streams = streams, .stream_capacity = MAX_REST};
    for (uint32_t k = 0; k < p->rest_count; k++) {
        char name[24];
        snprintf(name, sizeof name, "f_rest_%u", k);
        if (!add_stream(p, p->harmonics, name, EWA_U8, p->rest + k, p->rest_count, &sink))
            return fail_property(p, name, "uchar");
    }
    return read_element(p, p->harmonics, &sink);
}

/// `bits` bits of a word from bit `at` on, as a share.
static double share(uint32_t word, uint32_t at, uint32_t bits) {
    const uint32_t maximum = (1u << bits) - 1;
    return (double)(word >> at & maximum) / maximum;
}

static double between(float low, float high, double share_of) {
    return (double)low * (1 - share_of) + (double)high * share_of;
}

static void decode(void *data, uint32_t first, uint32_t end) {
    static const uint32_t at[3] = {21, 11, 0}, bits[3] = {11, 10, 11};
    const packed *p = data;
    ewa_gaussians *set = p->set;
    const uint32_t coefficients = ewa_sh_count(set->sh_degree);
    for (uint32_t i = first; i < end; i++) {
        const float *bounds = p->bounds + (size_t)(i / CHUNK) * BOUNDS;
        const uint32_t *words = p->words + (size_t)i * WORDS;
        float *harmonics = set->harmonics + (size_t)i * 3 * coefficients;
        double others[3];
        for (uint32_t k = 0; k < 3; k++) {
            const double center = share(words[POSITION], at[k], bits[k]),
                         scale = share(words[SCALE], at[k], bits[k]),
                         color = share(words[COLOR], 24 - 8 * k, 8);
            set->centers[3 * (size_t)i + k] =
                (float)between(bounds[LOW_CENTER + k], bounds[HIGH_CENTER + k], center);
            set->scales[3 * (size_t)i + k] =
                (float)between(bounds[LOW_SCALE + k], bounds[HIGH_SCALE + k], scale);
            harmonics[k] = ewa_sh_of_color(between(bounds[LOW_COLOR + k], bounds[HIGH_COLOR + k], color));
            others[k] = (share(words[ROTATION], 20 - 10 * k, 10) - 0.5) * sqrt(2);
        }
        ewa_quaternion_complete(others, words[ROTATION] >> 30, set->rotations + 4 * (size_t)i);
        set->opacities[i] = (float)share(words[COLOR], 0, 8);
        for (uint32_t k = 0; k < p->rest_count; k++) {
            const uint8_t byte = p->rest[(size_t)i * p->rest_count + k];
            // The middle of each step, but the ends for its ends.
            const double step = byte == 0 ? 0 : byte == 255 ? 1 : (byte + 0.5) / 256;
            harmonics[3 * (1 + k % (coefficients - 1)) + k / (coefficients - 1)] = (float)((step - 0.5) * 8);
        }
    }
}

/// Reads with the elements known and memory for them made.
static ewa_status read_into(packed *p) {
    EWA_TRY(read_chunks(p));
    EWA_TRY(read_vertices(p));
    if (p->harmonics) EWA_TRY(read_harmonics(p));
    ewa_gaussians_decode(p->source->context, p->set->count, decode, p);
    return ewa_gaussians_settle(p->source, &(ewa_gaussian_form){.log_scales = true}, p->set);
}

/// Finds the elements and checks that they fit together and into the file. Errors: EWA_ERROR_FORMAT.
static ewa_status find_elements(packed *p, uint32_t *sh_degree) {
    ewa_context *context = p->source->context;
    p->chunks = find_element(p->header, "chunk");
    p->vertices = ewa_ply_vertices(p->header);
    p->harmonics = find_element(p->header, "sh");
    if (!p->chunks)
        return ewa_fail(context, EWA_ERROR_FORMAT, "%s: packed Gaussians without an element 'chunk'",
                        p->source->name);
    const uint64_t count = p->vertices->count, wanted = count / CHUNK + (count % CHUNK != 0);
    if (p->chunks->count < wanted)
        return ewa_fail(context, EWA_ERROR_FORMAT,
                        "%s: %llu chunks of 256 for %llu Gaussians, which need %llu", p->source->name,
                        (unsigned long long)p->chunks->count, (unsigned long long)count,
                        (unsigned long long)wanted);
    *sh_degree = 0;
    if (p->harmonics) {
        p->rest_count = p->harmonics->property_count;
        while (3 * (ewa_sh_count(*sh_degree) - 1) < p->rest_count && *sh_degree < EWA_MAX_SH_DEGREE)
            ++*sh_degree;
        if (3 * (ewa_sh_count(*sh_degree) - 1) != p->rest_count || p->harmonics->count != count)
            return ewa_fail(
                context, EWA_ERROR_FORMAT,
                "%s: %llu records of %u coefficients in the element 'sh' for %llu Gaussians; 9, 24, 45 "
                "or 72 make whole degrees",
                p->source->name, (unsigned long long)p->harmonics->count, p->rest_count,
                (unsigned long long)count);
        if (!p->rest_count) p->harmonics = NULL;
    }
    // All elements are there before anything is made for them.
    uint64_t at = p->header->body_at;
    EWA_TRY(ewa_gaussians_ply_skip_to(&p->ply, p->header, p->chunks, &at));
    at = p->header->body_at;
    EWA_TRY(ewa_gaussians_ply_skip_to(&p->ply, p->header, p->vertices, &at));
    at = p->header->body_at;
    if (p->harmonics) EWA_TRY(ewa_gaussians_ply_skip_to(&p->ply, p->header, p->harmonics, &at));
    return EWA_OK;
}

static ewa_status read_with(const ewa_gaussian_source *source, ewa_ply_header *header, ewa_gaussians *set) {
    ewa_context *context = source->context;
    packed p = {.source = source,
                .ply = {context, source->name, source->bytes, source->size_bytes},
                .header = header,
                .set = set};
    uint32_t sh_degree = 0;
    EWA_TRY(ewa_ply_header_read(&p.ply, header));
    EWA_TRY(find_elements(&p, &sh_degree));
    EWA_TRY(ewa_gaussians_make(source, p.vertices->count, 0, 0, sh_degree, set));
    const size_t chunk_count = (size_t)p.chunks->count, count = set->count;
    p.bounds = ewa_allocate(context, chunk_count, BOUNDS * sizeof *p.bounds);
    p.words = ewa_allocate(context, count, WORDS * sizeof *p.words);
    p.rest = ewa_allocate(context, count, p.rest_count);
    ewa_status status = p.bounds && p.words && p.rest ? read_into(&p) : EWA_ERROR_MEMORY;
    ewa_release(context, p.bounds, chunk_count, BOUNDS * sizeof *p.bounds);
    ewa_release(context, p.words, count, WORDS * sizeof *p.words);
    ewa_release(context, p.rest, count, p.rest_count);
    return status;
}

static ewa_status read_packed(const ewa_gaussian_source *source, ewa_gaussians *set,
                              ewa_gaussian_facts *facts) {
    (void)facts;
    ewa_ply_header *header = ewa_allocate(source->context, 1, sizeof *header);
    const ewa_status status = header ? read_with(source, header, set) : EWA_ERROR_MEMORY;
    ewa_release(source->context, header, 1, sizeof *header);
    return status;
}

static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    return ewa_gaussians_ply_probe(source, is_packed, status);
}

const ewa_gaussian_reader ewa_gaussians_packed_ply = {EWA_GAUSSIANS_PACKED_PLY, probe, read_packed};
