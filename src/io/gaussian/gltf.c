// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// glTF with KHR_gaussian_splatting: primitives of points whose attributes are those of Gaussians, or SPZ in a buffer
// view; nodes put them into place. The tree is walked twice, to count and to fill.
//
// Based on: Khronos, "KHR_gaussian_splatting", release candidate of 2026; drafts of 2024 and 2025 (_ROTATION, _SCALE,
// COLOR_0); "KHR_gaussian_splatting_compression_spz_2".
#include "io/mesh/gltf.h"
#include "io/gaussian/spz.h"

#include <stdio.h>

enum { POINTS = 0, PRIMITIVE_ITEMS = 16 };

static const char extension_name[] = "KHR_gaussian_splatting";
static const char packed_name[] = "KHR_gaussian_splatting_compression_spz_2";

typedef struct filling {
    const ewa_gaussian_source *source;
    uint64_t count; ///< of Gaussians so far
    uint32_t sh_degree;
    bool linear; ///< some colours are linear light
    ewa_gaussians *set;
} filling;

/// The parts of a primitive: the extension, NULL where there is none; the bytes of SPZ in it.
typedef struct splats {
    const cJSON *extension, *attributes;
    const uint8_t *packed;
    uint64_t packed_bytes;
} splats;

/// Finds what a primitive holds. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED.
static ewa_status open_primitive(gltf *g, uint64_t mesh, const cJSON *item, splats *made) {
    *made = (splats){.extension = ewa_gltf_extension(item, extension_name),
                     .attributes = ewa_gltf_member(item, "attributes")};
    if (!made->extension) return EWA_OK;
    EWA_TRY(ewa_gltf_spend(g, PRIMITIVE_ITEMS)); // many nodes may have one mesh
    uint64_t mode, view, stride;
    if (!ewa_gltf_count(item, "mode", 4, &mode) || mode != POINTS)
        return ewa_gltf_fail(g, "meshes", mesh, "a primitive of Gaussians is not of points");
    const cJSON *kernel = ewa_gltf_member(made->extension, "kernel");
    if (cJSON_IsString(kernel) && strcmp(kernel->valuestring, "ellipse") != 0) {
        char quote[EWA_QUOTE_BYTES];
        return ewa_fail(g->build->context, EWA_ERROR_UNSUPPORTED,
                        "%s: Gaussians with the kernel %s; ellipse is read", g->build->source->name,
                        ewa_quote((ewa_text){kernel->valuestring, strlen(kernel->valuestring)}, quote));
    }
    const cJSON *packed = ewa_gltf_extension(made->extension, packed_name);
    if (!packed) return EWA_OK;
    if (!ewa_gltf_count(packed, "bufferView", UINT64_MAX, &view))
        return ewa_gltf_fail(g, "meshes", mesh, "bufferView of a primitive is wrong");
    return ewa_gltf_view(g, view, &made->packed, &made->packed_bytes, &stride);
}

static ewa_status read_packed(const filling *f, const splats *from, ewa_gaussians *set) {
    const ewa_gaussian_source source = {f->source->context, f->source->name, NULL, from->packed,
                                        (size_t)from->packed_bytes};
    ewa_gaussian_facts facts = {0};
    *set = (ewa_gaussians){0};
    EWA_TRY(ewa_gaussians_spz.read(&source, set, &facts));
    ewa_gaussians_turn(set); // y is up in glTF, as in the SPZ that it packs
    return EWA_OK;
}

/// The name of an attribute, in the form of a draft where only that is there.
static const char *name_of(const cJSON *attributes, const char *part, char name[64]) {
    snprintf(name, 64, "%s:%s", extension_name, part);
    if (!ewa_gltf_member(attributes, name)) snprintf(name, 64, "_%s", part);
    return name;
}

static const char *harmonic_name(const cJSON *attributes, uint32_t number, char name[64]) {
    uint32_t degree = 0;
    while (ewa_sh_count(degree) <= number) degree++;
    char part[40];
    snprintf(part, sizeof part, "SH_DEGREE_%u_COEF_%u", degree, number - degree * degree);
    return name_of(attributes, part, name);
}

/// The degree up to which all harmonics are there.
static uint32_t find_degree(const cJSON *attributes) {
    char name[64];
    uint32_t count = 1;
    while (count < ewa_sh_count(EWA_MAX_SH_DEGREE) &&
           ewa_gltf_member(attributes, harmonic_name(attributes, count, name)))
        count++;
    uint32_t degree = EWA_MAX_SH_DEGREE;
    while (ewa_sh_count(degree) > count) degree--;
    return degree;
}

/// Counts the Gaussians of a primitive.
static ewa_status count_primitive(gltf *g, uint64_t mesh, const cJSON *item, const gltf_placement *at) {
    (void)at;
    filling *f = g->user;
    splats from;
    EWA_TRY(open_primitive(g, mesh, item, &from));
    if (!from.extension) return EWA_OK;
    uint64_t count = 0;
    uint32_t degree;
    ewa_status status = EWA_OK;
    if (from.packed) {
        ewa_gaussians set;
        status = read_packed(f, &from, &set);
        count = set.count, degree = set.sh_degree;
        ewa_gaussians_free(&set);
    } else {
        gltf_array array;
        status = ewa_gltf_read_attribute(g, mesh, from.attributes, 0, "POSITION", 3, 3, &array);
        count = array.count, degree = find_degree(from.attributes);
        ewa_gltf_free_array(g, &array);
    }
    f->count += count;
    if (degree > f->sh_degree) f->sh_degree = degree;
    const cJSON *space = ewa_gltf_member(from.extension, "colorSpace");
    f->linear |= cJSON_IsString(space) && strncmp(space->valuestring, "lin_", 4) == 0;
    return status;
}

/// Reads an attribute to numbers `stride` floats apart; `*found`: there is one.
static ewa_status read_to(gltf *g, uint64_t mesh, const splats *from, const char *name, uint32_t components,
                          uint32_t count, float *to, size_t stride, bool *found) {
    gltf_array array;
    const ewa_status status =
        ewa_gltf_read_attribute(g, mesh, from->attributes, count, name, components, components, &array);
    *found = array.numbers != NULL;
    for (uint64_t i = 0; i < array.count; i++)
        for (uint32_t k = 0; k < components; k++)
            to[i * stride + k] = (float)array.numbers[i * components + k];
    ewa_gltf_free_array(g, &array);
    return status;
}

/// Colours and opacities of drafts: display values in COLOR_0.
static ewa_status read_color(gltf *g, uint64_t mesh, const splats *from, ewa_gaussians *part, size_t stride,
                             bool *found) {
    gltf_array array;
    const ewa_status status =
        ewa_gltf_read_attribute(g, mesh, from->attributes, part->count, "COLOR_0", 4, 4, &array);
    *found = array.numbers != NULL;
    for (uint64_t i = 0; i < array.count; i++) {
        for (uint32_t k = 0; k < 3; k++)
            part->harmonics[i * stride + k] = ewa_sh_of_color(array.numbers[4 * i + k]);
        part->opacities[i] = (float)array.numbers[4 * i + 3];
    }
    ewa_gltf_free_array(g, &array);
    return status;
}

/// Reads the attributes to a part of the set.
static ewa_status read_attributes(gltf *g, uint64_t mesh, const splats *from, ewa_gaussians *part) {
    char name[64];
    const cJSON *attributes = from->attributes;
    const size_t stride = 3 * (size_t)ewa_sh_count(part->sh_degree);
    bool found, shown;
    ewa_status status = read_to(g, mesh, from, "POSITION", 3, part->count, part->centers, 3, &found);
    if (status == EWA_OK)
        status = read_to(g, mesh, from, name_of(attributes, "SCALE", name), 3, part->count, part->scales, 3,
                         &found);
    if (status == EWA_OK && !found) return ewa_gltf_fail(g, "meshes", mesh, "Gaussians without SCALE");
    if (status == EWA_OK)
        status = read_to(g, mesh, from, name_of(attributes, "ROTATION", name), 4, part->count,
                         part->rotations, 4, &found);
    if (status == EWA_OK && !found) return ewa_gltf_fail(g, "meshes", mesh, "Gaussians without ROTATION");
    for (size_t i = 0; i < part->count && status == EWA_OK; i++) { // from x y z w
        float *q = part->rotations + 4 * i;
        const float w = q[3];
        q[3] = q[2], q[2] = q[1], q[1] = q[0], q[0] = w;
    }
    const uint32_t coefficients = ewa_sh_count(find_degree(attributes));
    EWA_TRY(status);
    EWA_TRY(read_to(g, mesh, from, name_of(attributes, "OPACITY", name), 1, part->count, part->opacities, 1,
                    &found));
    EWA_TRY(read_to(g, mesh, from, harmonic_name(attributes, 0, name), 3, part->count, part->harmonics,
                    stride, &shown));
    if (!(found && shown)) {
        EWA_TRY(read_color(g, mesh, from, part, stride, &found));
        if (!found)
            return ewa_gltf_fail(g, "meshes", mesh, "Gaussians without OPACITY or SH_DEGREE_0_COEF_0");
    }
    for (uint32_t k = 1; k < coefficients; k++)
        EWA_TRY(read_to(g, mesh, from, harmonic_name(attributes, k, name), 3, part->count,
                        part->harmonics + 3 * k, stride, &found));
    return EWA_OK;
}

/// Copies a set of its own to a part of another, which may have more harmonics.
static void copy_part(const ewa_gaussians *from, ewa_gaussians *part) {
    const size_t count = part->count, numbers = 3 * (size_t)ewa_sh_count(from->sh_degree),
                 stride = 3 * (size_t)ewa_sh_count(part->sh_degree);
    memcpy(part->centers, from->centers, count * 3 * sizeof(float));
    memcpy(part->scales, from->scales, count * 3 * sizeof(float));
    memcpy(part->rotations, from->rotations, count * 4 * sizeof(float));
    memcpy(part->opacities, from->opacities, count * sizeof(float));
    for (size_t i = 0; i < count; i++)
        memcpy(part->harmonics + i * stride, from->harmonics + i * numbers, numbers * sizeof(float));
}

/// Puts Gaussians where their node is. Errors: EWA_ERROR_ARGUMENT, EWA_ERROR_NUMERIC.
static ewa_status place_part(const gltf_placement *at, ewa_gaussians *part) {
    double matrix[16] = {0};
    bool moves = false;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            matrix[4 * r + c] = at->m[r][c];
            moves |= at->m[r][c] != (r == c);
        }
    matrix[15] = 1;
    if (!moves) return EWA_OK;
    EWA_TRY(ewa_gaussians_transform(part, matrix));
    for (size_t i = 0; i < part->count; i++)
        for (size_t k = 0; k < 3; k++)
            part->centers[3 * i + k] = (float)((double)part->centers[3 * i + k] + part->origin[k]);
    return EWA_OK;
}

/// Fills the next part of the set from a primitive.
static ewa_status fill_primitive(gltf *g, uint64_t mesh, const cJSON *item, const gltf_placement *at) {
    filling *f = g->user;
    splats from;
    EWA_TRY(open_primitive(g, mesh, item, &from));
    if (!from.extension) return EWA_OK;
    const size_t first = (size_t)f->count, numbers = 3 * (size_t)ewa_sh_count(f->set->sh_degree);
    ewa_gaussians packed = {0}, part = {.context = f->set->context,
                                        .sh_degree = f->set->sh_degree,
                                        .centers = f->set->centers + 3 * first,
                                        .scales = f->set->scales + 3 * first,
                                        .rotations = f->set->rotations + 4 * first,
                                        .opacities = f->set->opacities + first,
                                        .harmonics = f->set->harmonics + numbers * first};
    ewa_status status = EWA_OK;
    if (from.packed) {
        status = read_packed(f, &from, &packed);
        part.count = packed.count;
        f->set->antialiased |= packed.antialiased;
    } else {
        gltf_array array;
        status = ewa_gltf_read_attribute(g, mesh, from.attributes, 0, "POSITION", 3, 3, &array);
        part.count = (uint32_t)array.count;
        ewa_gltf_free_array(g, &array);
    }
    // Files beside may have changed since they were counted.
    if (status == EWA_OK && part.count > f->set->count - first)
        status = ewa_gltf_fail(g, "meshes", mesh, "it has more Gaussians than when it was read first");
    if (status == EWA_OK && from.packed)
        copy_part(&packed, &part);
    else if (status == EWA_OK && part.count)
        status = read_attributes(g, mesh, &from, &part);
    ewa_gaussians_free(&packed);
    // Turned ones have to be right before they are turned.
    if (status == EWA_OK)
        status = ewa_gaussians_settle(f->source, &(ewa_gaussian_form){.log_scales = false}, &part);
    if (status == EWA_OK) status = place_part(at, &part);
    f->count += part.count;
    return status;
}

static ewa_status walk(const ewa_gaussian_source *source, gltf_take *take, filling *f) {
    const ewa_mesh_source mesh = {source->context, source->name, source->path, source->bytes,
                                  source->size_bytes};
    ewa_mesh_build build;
    ewa_mesh_build_open(&mesh, &build);
    const ewa_status status = ewa_gltf_walk(&build, take, f, packed_name);
    ewa_mesh_build_close(&build);
    return status;
}

static ewa_status read_gltf(const ewa_gaussian_source *source, ewa_gaussians *set,
                            ewa_gaussian_facts *facts) {
    filling f = {.source = source, .set = set};
    EWA_TRY(walk(source, count_primitive, &f));
    EWA_TRY(ewa_gaussians_make(source, f.count, 0, 0, f.sh_degree, set));
    if (f.linear)
        ewa_report(source->context, EWA_SEVERITY_WARNING,
                   "%s: colours of linear light are taken for those of a display", source->name);
    f.count = 0;
    EWA_TRY(walk(source, fill_primitive, &f));
    facts->up_world[1] = 1; // glTF says so
    return ewa_gaussians_settle(source, &(ewa_gaussian_form){.log_scales = false}, set);
}

/// Whether the bytes are glTF that uses the extension: its name stands in the JSON.
static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    (void)status;
    if (ewa_mesh_probe(source->name, source->bytes, source->size_bytes) != EWA_MODEL_GLTF) return false;
    const uint8_t *at = source->bytes, *end = at + source->size_bytes;
    if (source->size_bytes >= 20 && memcmp(at, "glTF", 4) == 0) {
        const uint32_t length = ewa_bytes_u32(at + 12);
        at += 20;
        if (length < (size_t)(end - at)) end = at + length;
    }
    // A text with this name in quotes has little else that it could mean.
    for (; (at = memchr(at, '"', (size_t)(end - at))); at++)
        if ((size_t)(end - at) >= sizeof extension_name + 1 &&
            memcmp(at + 1, extension_name, sizeof extension_name - 1) == 0 &&
            at[sizeof extension_name] == '"')
            return true;
    return false;
}

const ewa_gaussian_reader ewa_gaussians_gltf = {EWA_GAUSSIANS_GLTF, probe, read_gltf};
