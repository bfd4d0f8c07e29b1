// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians as .glb: a primitive of points with the attributes of KHR_gaussian_splatting, one array of floats after the other. They
// are turned to right, up, back, for y is up in glTF.
//
// Based on: Khronos, "KHR_gaussian_splatting", release candidate of 2026; "glTF 2.0", section 4.4 (GLB).
#include "io/gaussian/save.h"
#include "io/number.h"

#include <stdio.h>

enum { MAX_DEGREE = 3, ARRAYS = 4 + (MAX_DEGREE + 1) * (MAX_DEGREE + 1), TEXT_BYTES = 1 << 14, HEAD_BYTES = 20, PIECE = 1024 };

/// Which numbers an array holds; harmonic k is array HARMONICS + k.
enum { POSITION, ROTATION, SCALE, OPACITY, HARMONICS };

typedef struct writing {
    const ewa_gaussian_target *target;
    const ewa_gaussians *set;
    ewa_gaussian_signs signs;
    uint32_t arrays;
    uint64_t body_bytes;
    char text[TEXT_BYTES];
    size_t text_bytes;
} writing;

static uint32_t components_of(uint32_t array) { return array == ROTATION ? 4 : array == OPACITY ? 1 : 3; }

/// Number `k` of a Gaussian in an array.
static float number_of(const writing *w, uint32_t array, size_t i, size_t k) {
    const ewa_gaussians *set = w->set;
    switch (array) {
    case POSITION:
        return w->signs.center[k] * (float)(set->origin[k] + (double)set->centers[3 * i + k]);
    case ROTATION: // x y z w
        return k < 3 ? w->signs.rotation[k] * set->rotations[4 * i + 1 + k] : set->rotations[4 * i];
    case SCALE:
        return set->scales[3 * i + k];
    case OPACITY:
        return set->opacities[i];
    default: {
        const size_t harmonic = array - HARMONICS;
        return w->signs.harmonics[harmonic] * set->harmonics[3 * (i * ewa_sh_count(set->sh_degree) + harmonic) + k];
    }
    }
}

static void say(writing *w, const char *text) {
    const size_t length = strlen(text);
    memcpy(w->text + w->text_bytes, text, length);
    w->text_bytes += length;
}

static void name_array(uint32_t array, char name[64]) {
    static const char *const first[HARMONICS] = {"POSITION", "KHR_gaussian_splatting:ROTATION", "KHR_gaussian_splatting:SCALE",
                                                 "KHR_gaussian_splatting:OPACITY"};
    uint32_t degree = 0;
    while (array >= HARMONICS && ewa_sh_count(degree) <= array - HARMONICS) degree++;
    if (array < HARMONICS)
        snprintf(name, 64, "%s", first[array]);
    else
        snprintf(name, 64, "KHR_gaussian_splatting:SH_DEGREE_%u_COEF_%u", degree, array - HARMONICS - degree * degree);
}

/// The smallest and the largest coordinates, which glTF wants of positions.
static void say_bounds(writing *w) {
    for (int side = 0; side < 2; side++) {
        say(w, side ? "],\"max\":[" : ",\"min\":[");
        for (size_t k = 0; k < 3; k++) {
            float bound = number_of(w, POSITION, 0, k);
            for (size_t i = 1; i < w->set->count; i++)
                bound = side ? fmaxf(bound, number_of(w, POSITION, i, k)) : fminf(bound, number_of(w, POSITION, i, k));
            if (k) say(w, ",");
            w->text_bytes += ewa_number_write_f32(bound, w->text + w->text_bytes);
        }
    }
    say(w, "]");
}

static void make_text(writing *w) {
    char name[64], line[256];
    say(w, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"ewa\"},\"extensionsUsed\":[\"KHR_gaussian_splatting\"],\"scene\":0,"
           "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"mode\":0,\"attributes\":{");
    for (uint32_t a = 0; a < w->arrays; a++) {
        name_array(a, name);
        snprintf(line, sizeof line, "%s\"%s\":%u", a ? "," : "", name, a);
        say(w, line);
    }
    say(w, "},\"extensions\":{\"KHR_gaussian_splatting\":{\"kernel\":\"ellipse\",\"colorSpace\":\"srgb_rec709_display\","
           "\"projection\":\"perspective\",\"sortingMethod\":\"cameraDistance\"}}}]}],\"accessors\":[");
    for (uint32_t a = 0; a < w->arrays; a++) {
        static const char *const types[5] = {"", "SCALAR", "", "VEC3", "VEC4"};
        snprintf(line, sizeof line, "%s{\"bufferView\":%u,\"componentType\":5126,\"count\":%u,\"type\":\"%s\"", a ? "," : "", a,
                 w->set->count, types[components_of(a)]);
        say(w, line);
        if (a == POSITION) say_bounds(w);
        say(w, "}");
    }
    say(w, "],\"bufferViews\":[");
    for (uint32_t a = 0; a < w->arrays; a++) {
        const uint64_t bytes = (uint64_t)w->set->count * components_of(a) * sizeof(float);
        snprintf(line, sizeof line, "%s{\"buffer\":0,\"byteOffset\":%llu,\"byteLength\":%llu}", a ? "," : "",
                 (unsigned long long)w->body_bytes, (unsigned long long)bytes);
        say(w, line);
        w->body_bytes += bytes;
    }
    snprintf(line, sizeof line, "],\"buffers\":[{\"byteLength\":%llu}]}", (unsigned long long)w->body_bytes);
    say(w, line);
    while (w->text_bytes % 4) say(w, " ");
}

static ewa_status put_array(const writing *w, uint32_t array) {
    const uint32_t components = components_of(array);
    uint8_t piece[PIECE * 4 * sizeof(float)];
    for (size_t first = 0; first < w->set->count; first += PIECE) {
        uint8_t *to = piece;
        for (size_t i = first; i < first + PIECE && i < w->set->count; i++)
            for (size_t k = 0; k < components; k++) to = ewa_put_f32(to, number_of(w, array, i, k));
        EWA_TRY(ewa_writer_put(w->target->writer, piece, (size_t)(to - piece)));
    }
    return EWA_OK;
}

static ewa_status write_file(writing *w) {
    make_text(w);
    const uint64_t all_bytes = HEAD_BYTES + w->text_bytes + 8 + w->body_bytes;
    if (all_bytes > UINT32_MAX)
        return ewa_fail(w->set->context, EWA_ERROR_LIMIT, "%s: %llu bytes do not fit the 32 bits of .glb", w->target->name,
                        (unsigned long long)all_bytes);
    uint8_t head[HEAD_BYTES] = {'g', 'l', 'T', 'F'}, middle[8];
    uint8_t *to = ewa_put_u32(ewa_put_u32(head + 4, 2), (uint32_t)all_bytes);
    memcpy(ewa_put_u32(to, (uint32_t)w->text_bytes), "JSON", 4);
    memcpy(ewa_put_u32(middle, (uint32_t)w->body_bytes), "BIN", 4);
    EWA_TRY(ewa_writer_put(w->target->writer, head, sizeof head));
    EWA_TRY(ewa_writer_put(w->target->writer, w->text, w->text_bytes));
    EWA_TRY(ewa_writer_put(w->target->writer, middle, sizeof middle));
    for (uint32_t a = 0; a < w->arrays; a++) EWA_TRY(put_array(w, a));
    return EWA_OK;
}

ewa_status ewa_gaussians_write_gltf(const ewa_gaussian_target *target) {
    const ewa_gaussians *set = target->set;
    writing *w = ewa_allocate_zeroed(set->context, 1, sizeof *w);
    if (!w) return EWA_ERROR_MEMORY;
    w->target = target, w->set = set;
    w->arrays = HARMONICS + ewa_sh_count(target->sh_degree < MAX_DEGREE ? target->sh_degree : MAX_DEGREE);
    ewa_gaussian_signs_turn(&w->signs);
    const ewa_status status = write_file(w);
    ewa_release(set->context, w, 1, sizeof *w);
    if (status == EWA_OK && target->sh_degree > MAX_DEGREE)
        ewa_report(set->context, EWA_SEVERITY_WARNING, "%s: glTF has no harmonics of degree 4", target->name);
    if (status == EWA_OK && (set->flat || set->antialiased))
        ewa_report(set->context, EWA_SEVERITY_WARNING, "%s: glTF does not say that Gaussians are %s", target->name,
                   set->flat ? "flat: their third scale is 0" : "trained with a filter that keeps what they add");
    return status;
}
