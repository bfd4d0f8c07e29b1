// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of Gaussians out: the format by suffix, the set checked.
#include "base/options.h"
#include "base/platform.h"
#include "io/gaussian/save.h"

#include <strings.h>

#define AT(member) offsetof(ewa_gaussians_save_options, member)

static const ewa_option option_rows[] = {
    {"sh_degree", EWA_OPTION_U32, AT(sh_degree), 0, EWA_MAX_SH_DEGREE, .initial = EWA_MAX_SH_DEGREE,
     .help = "highest degree of the spherical harmonics that are kept; .splat: 0"},
    {"up_world", EWA_OPTION_F64, AT(up_world), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3,
     .help = "what is up in the set, which is turned to what is up in files; zeros: -y, as in 3DGS"},
    {"spz_version", EWA_OPTION_U32, AT(spz_version), 2, 4, .initial = 3,
     .help = "of .spz: 2 and 3 are gzip, 3 has finer quaternions, 4 is zstd"},
};

const ewa_option_table ewa_gaussians_save_options_table =
    EWA_OPTION_TABLE(ewa_gaussians_save_options, option_rows);

void ewa_gaussians_save_options_init(ewa_gaussians_save_options *options, size_t struct_size) {
    ewa_options_init(&ewa_gaussians_save_options_table, options, struct_size);
}

static const struct {
    const char *suffix;
    ewa_gaussian_format format;
    ewa_gaussian_write *write;
} formats[] = {
    // The first that a name ends in.
    {".compressed.ply", EWA_GAUSSIANS_PACKED_PLY, ewa_gaussians_write_packed_ply},
    {".ply", EWA_GAUSSIANS_PLY, ewa_gaussians_write_ply},
    {".splat", EWA_GAUSSIANS_SPLAT, ewa_gaussians_write_splat},
    {".spz", EWA_GAUSSIANS_SPZ, ewa_gaussians_write_spz},
    {".glb", EWA_GAUSSIANS_GLTF, ewa_gaussians_write_gltf},
    {".sog", EWA_GAUSSIANS_SOG, ewa_gaussians_write_sog},
    {"meta.json", EWA_GAUSSIANS_SOG, ewa_gaussians_write_sog}, // the whole name, as the next
    {"lod-meta.json", EWA_GAUSSIANS_STREAMED_SOG, ewa_gaussians_write_streamed_sog},
};
enum { FORMAT_COUNT = sizeof formats / sizeof formats[0] };

/// The row of `formats` for a path; FORMAT_COUNT: none.
static size_t find_format(const char *path) {
    const char *name = strcmp(path, "-") == 0 ? ".ply" : ewa_platform_file_name(path);
    const size_t length = strlen(name);
    for (size_t i = 0; i < FORMAT_COUNT; i++) {
        const size_t own = strlen(formats[i].suffix);
        if ((*formats[i].suffix == '.' ? length >= own : length == own) && strcasecmp(name + length - own, formats[i].suffix) == 0) return i;
    }
    return FORMAT_COUNT;
}

ewa_gaussian_format ewa_gaussians_format_of(const char *path) {
    const size_t found = path ? find_format(path) : FORMAT_COUNT;
    return found < FORMAT_COUNT ? formats[found].format : EWA_GAUSSIANS_NONE;
}

/// A set that a caller filled may hold anything.
static ewa_status check_set(const ewa_gaussians *set) {
    const uint32_t numbers = 3 * ewa_sh_count(set->sh_degree);
    for (size_t i = 0; i < set->count; i++) {
        double sum = (double)set->opacities[i];
        bool fine = sum >= 0 && sum <= 1;
        for (size_t k = 0; k < 3; k++) {
            sum += 0 * ((double)set->centers[3 * i + k] + (double)set->scales[3 * i + k]);
            fine &= set->scales[3 * i + k] >= 0;
        }
        for (size_t k = 0; k < 4; k++) sum += 0 * (double)set->rotations[4 * i + k];
        for (size_t k = 0; k < numbers; k++) sum += 0 * (double)set->harmonics[i * numbers + k];
        if (!fine || !isfinite(sum))
            return ewa_fail(
                set->context, EWA_ERROR_ARGUMENT,
                "Gaussian %zu of %u has a number that is not finite, a scale below 0 or an opacity "
                "that is not in [0, 1]",
                i, set->count);
    }
    return EWA_OK;
}

/// Whether what is up needs a turn to be -y, as in 3DGS.
static bool is_turned(const double up[3]) { return !(up[1] <= 0 && up[0] == 0 && up[2] == 0); }

ewa_status ewa_gaussians_turn_up(ewa_gaussians *set, const double up_world[3]) {
    const double length = hypot(up_world[1], up_world[2]), y = up_world[1] / length, z = up_world[2] / length;
    if (!is_turned(up_world)) return EWA_OK;
    if (!(length > 0))
        return ewa_fail(set->context, EWA_ERROR_ARGUMENT, "up_world: %g, %g, %g is along x", up_world[0],
                        up_world[1], up_world[2]);
    const double matrix[16] = {1, 0, 0, 0, 0, -y, -z, 0, 0, z, -y, 0, 0, 0, 0, 1};
    return ewa_gaussians_transform(set, matrix);
}

/// Makes a copy of a set that is turned so. Errors: those of ewa_gaussians_turn_up(), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
static ewa_status turn_up(const ewa_gaussians *set, const double up_world[3], ewa_gaussians *turned) {
    *turned = (ewa_gaussians){0};
    EWA_TRY(ewa_gaussians_create(set->context, set->count, set->sh_degree, turned));
    turned->flat = set->flat, turned->antialiased = set->antialiased;
    memcpy(turned->origin, set->origin, sizeof turned->origin);
    memcpy(turned->centers, set->centers, 3 * (size_t)set->count * sizeof(float));
    memcpy(turned->scales, set->scales, 3 * (size_t)set->count * sizeof(float));
    memcpy(turned->rotations, set->rotations, 4 * (size_t)set->count * sizeof(float));
    memcpy(turned->opacities, set->opacities, (size_t)set->count * sizeof(float));
    memcpy(turned->harmonics, set->harmonics,
           3 * (size_t)ewa_sh_count(set->sh_degree) * set->count * sizeof(float));
    ewa_status status = set->classes ? ewa_gaussians_add_classes(turned) : EWA_OK;
    if (status == EWA_OK && set->classes) memcpy(turned->classes, set->classes, set->count * sizeof *set->classes);
    if (status == EWA_OK) status = ewa_gaussians_turn_up(turned, up_world);
    if (status != EWA_OK) ewa_gaussians_free(turned);
    return status;
}

static ewa_status write_set(const ewa_gaussians *set, const char *path, size_t format,
                            const ewa_gaussians_save_options *chosen) {
    ewa_gaussian_target target = {
        .set = set,
        .name = path,
        .sh_degree = chosen->sh_degree < set->sh_degree ? chosen->sh_degree : set->sh_degree,
        .spz_version = chosen->spz_version,
    };
    EWA_TRY(ewa_writer_open(set->context, path, &target.writer));
    ewa_status status = formats[format].write(&target);
    if (status == EWA_OK && set->classes && formats[format].format != EWA_GAUSSIANS_PLY)
        ewa_report(set->context, EWA_SEVERITY_WARNING, "%s: %s has no room for classes, which .ply has", path,
                   ewa_gaussian_format_name(formats[format].format));
    if (status == EWA_OK) return ewa_writer_commit(&target.writer);
    ewa_writer_abort(&target.writer);
    return status;
}

ewa_status ewa_gaussians_save(const ewa_gaussians *gaussians, const char *path,
                              const ewa_gaussians_save_options *options) {
    if (!gaussians || !gaussians->context || !path) return EWA_ERROR_ARGUMENT;
    ewa_context *context = gaussians->context;
    ewa_gaussians_save_options chosen;
    ewa_gaussians_save_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(context, &ewa_gaussians_save_options_table, options, &chosen));
    const size_t format = find_format(path);
    if (format == FORMAT_COUNT)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: Gaussians are written to .ply, .compressed.ply, .splat, .spz, .glb, .sog, meta.json and lod-meta.json",
                        path);
    if (gaussians->count == 0 || gaussians->sh_degree > EWA_MAX_SH_DEGREE)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: there are no Gaussians, or harmonics of degree %u",
                        path, gaussians->sh_degree);
    EWA_TRY(check_set(gaussians));
    const double *up = chosen.up_world;
    if (!is_turned(up)) return write_set(gaussians, path, format, &chosen);
    ewa_gaussians turned;
    ewa_status status = turn_up(gaussians, up, &turned);
    if (status == EWA_OK) status = write_set(&turned, path, format, &chosen);
    ewa_gaussians_free(&turned);
    return status;
}
