// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of trained Gaussians: 3D and 2D Gaussian splatting in the forms that programs write. The format goes by
// content; docs/files.md says what is read of each.
#ifndef EWA_GAUSSIAN_IO_H
#define EWA_GAUSSIAN_IO_H

#include "ewa/base.h"
#include "ewa/gaussian.h"
#include "ewa/options.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ewa_gaussian_format {
    EWA_GAUSSIANS_NONE = 0,   ///< none that is read here
    EWA_GAUSSIANS_PLY,        ///< the columns of 3DGS, 2DGS, Mip-Splatting
    EWA_GAUSSIANS_PACKED_PLY, ///< PlayCanvas's compressed PLY: chunks of 256
    EWA_GAUSSIANS_SPLAT,      ///< records of 32 bytes, without a head
    EWA_GAUSSIANS_SPZ,        ///< versions 1 to 4
    EWA_GAUSSIANS_GLTF,       ///< KHR_gaussian_splatting, .gltf and .glb
    EWA_GAUSSIANS_KSPLAT,     ///< of GaussianSplats3D, versions 0.x, levels 0 to 2
    EWA_GAUSSIANS_SOG,        ///< meta.json with WebP pictures, in a zip or beside it
    EWA_GAUSSIANS_STREAMED_SOG, ///< PlayCanvas's lod-meta.json, which names files of SOG: of each leaf the finest level
} ewa_gaussian_format;

/// Returns "3DGS PLY", "compressed PLY", "splat", "SPZ", "glTF", "ksplat", "SOG", "streamed SOG" or "unknown".
EWA_API const char *ewa_gaussian_format_name(ewa_gaussian_format format);

/// What a file of Gaussians is, beside what the set says.
typedef struct ewa_gaussian_facts {
    ewa_gaussian_format format;
    uint32_t version;    ///< of SPZ, ksplat (its minor number) and SOG; else 0
    bool filtered;       ///< with a 3D filter for each (Mip-Splatting), which is in scales and opacities now
    double up_world[3];  ///< unit, where the file says what is up; else zeros
    uint64_t size_bytes; ///< of the file
} ewa_gaussian_facts;

/// Says whether a regular file, or a folder of SOG, holds Gaussians, and in which form, by its content: EWA_GAUSSIANS_NONE for all
/// else, other folders too. Records without a head (.splat) are told by the suffix and by what the numbers mean. Errors:
/// EWA_ERROR_IO, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_gaussians_probe(ewa_context *context, const char *path, ewa_gaussian_format *format);

/// Reads a file of Gaussians, the format by content; "-" reads standard input. Numbers are what the set says:
/// scales are standard deviations and opacities shares, whatever the file stores. Axes are the file's, but for
/// SPZ, whose right-up-back, or what it names instead, becomes the right-down-front of 3DGS. Centres in doubles get an origin, in
/// floats the origin 0. `facts` may be NULL. The caller frees the set; it is zeroed after a failure.
///
/// Errors, with the Gaussian and the reason: EWA_ERROR_IO, EWA_ERROR_FORMAT (also a quaternion of zeros, a
/// number that is not finite, no Gaussians), EWA_ERROR_UNSUPPORTED (no Gaussians of a known form, versions,
/// extensions), EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED.
EWA_API ewa_status ewa_gaussians_load(ewa_context *context, const char *path, ewa_gaussians *gaussians,
                                      ewa_gaussian_facts *facts);

/// The same from `size_bytes` bytes in memory; `name` stands for the file in messages. Files that they name
/// lie below the folder of `path`; NULL: they are not read.
EWA_API ewa_status ewa_gaussians_load_memory(ewa_context *context, const void *bytes, size_t size_bytes,
                                             const char *name, const char *path, ewa_gaussians *gaussians,
                                             ewa_gaussian_facts *facts);

/// Returns the format that ewa_gaussians_save() writes to a path, by its suffix: .compressed.ply, .ply, .splat, .spz, .glb,
/// .sog, the names meta.json and lod-meta.json, "-": PLY; EWA_GAUSSIANS_NONE: none.
EWA_API ewa_gaussian_format ewa_gaussians_format_of(const char *path);

/// How Gaussians are written. Fill with ewa_gaussians_save_options_init().
typedef struct ewa_gaussians_save_options {
    size_t struct_size;
    uint32_t sh_degree;   ///< highest one of the harmonics that are kept, [0, 4]; default 4; .splat: 0
    uint32_t spz_version; ///< [2, 4]; default 3: quaternions of 32 bits, gzip; 4: zstd
    double up_world[3];   ///< up in the set, in the plane of y and z, any length; zeros: -y, as in 3DGS; default zeros
} ewa_gaussians_save_options;

EWA_API extern const ewa_option_table ewa_gaussians_save_options_table;
EWA_API void ewa_gaussians_save_options_init(ewa_gaussians_save_options *options, size_t struct_size);

/// Writes a set, the format by suffix; docs/files.md says what each keeps. Numbers are turned about x so
/// that `up_world`, which ewa_gaussian_facts has of files that say so, is -y in .ply, .compressed.ply, .splat and SOG, y in .spz and .glb. What a
/// format cannot keep, such as harmonics in .splat, is said in a warning. Beside meta.json its pictures are written, beside lod-meta.json the files
/// of its levels, each of which has a quarter of the one before. The same set gives
/// the same file on every machine, SOG by one version of libwebp. `options` may be NULL. Errors: EWA_ERROR_ARGUMENT (no Gaussians, a number that is none),
/// EWA_ERROR_UNSUPPORTED (suffix; SOG without libwebp; lod-meta.json of 2D Gaussians), EWA_ERROR_LIMIT (coordinates beyond the 24 bits of SPZ; more than 4 GiB of .glb
/// or .sog, pictures of more than 16383 pixels a side), EWA_ERROR_IO, EWA_ERROR_MEMORY.
EWA_API ewa_status ewa_gaussians_save(const ewa_gaussians *gaussians, const char *path,
                                      const ewa_gaussians_save_options *options);

/// Writes what a file holds to another, as ewa_gaussians_load() and ewa_gaussians_save() do one after the other, to the byte; `*count` gets how many
/// Gaussians that are. Of lod-meta.json from a binary PLY whose centres are floats a part is in memory at a time, some 16 MiB of Gaussians and a file of each
/// level, and a temporary file beside it holds them all. What is up is what the file says, whatever `options`, which may be NULL, say. Errors: theirs.
EWA_API ewa_status ewa_gaussians_convert(ewa_context *context, const char *from, const char *to, const ewa_gaussians_save_options *options,
                                         uint64_t *count);

#ifdef __cplusplus
}
#endif
#endif
