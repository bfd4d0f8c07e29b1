// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Assets: what can be drawn, from files of any kind and from objects in memory. The one place where it is decided what
// a file is.
#include "scene/asset.h"
#include "base/base.h"
#include "base/context.h"
#include "base/options.h"
#include "base/platform.h"
#include "cloud/cloud.h"
#include "ewa/diagnosis.h"
#include "ewa/gaussian_io.h"
#include "io/file.h"
#include "scene/streamed.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double IDENTITY[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

#define AT(member) offsetof(ewa_asset_options, member)

static const ewa_option option_rows[] = {
    {"to_world", EWA_OPTION_F64, AT(to_world), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 16,
     .initials = IDENTITY, .help = "where coordinates lie in the scene: a matrix, row by row"},
    {"gaussians_as_surfels", EWA_OPTION_BOOL, AT(gaussians_as_surfels),
     .help = "draw trained Gaussians as opaque surfels, in their constant colours"},
    {"gaussian_levels", EWA_OPTION_BOOL, AT(gaussian_levels),
     .help = "make levels of large sets of Gaussians, among which merge_px chooses"},
    {"levels", EWA_OPTION_CHOICE, AT(levels), .words = "auto|always|never",
     .help = "draw octrees (COPC, EPT) from their levels; auto: those of more than 4000000 points"},
    {"own_context", EWA_OPTION_BOOL, AT(own_context), .help = "octrees get a context of their own"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which kernels of a mesh's points end"},
    {"voxel_level_count", EWA_OPTION_U32, AT(voxel_level_count), 1, EWA_MAX_VOLUME_LEVELS, .initial = 1,
     .help = "levels of detail of volumes"},
    {"voxel_level_minimum", EWA_OPTION_U32, AT(voxel_level_minimum), 1, EWA_MAX_VOLUME_LEVELS, .initial = 1,
     .help = "levels of detail of volumes at least, for pictures while something moves"},
    {"reach_steps", EWA_OPTION_F64, AT(reach_steps), 0, 64, .initial = 0.6 * 3,
     .help = "how far a voxel's footprint counts in the picture's frame, steps of the grid"},
};

const ewa_option_table ewa_asset_options_table = EWA_OPTION_TABLE(ewa_asset_options, option_rows);

void ewa_asset_options_init(ewa_asset_options *options, size_t struct_size) {
    ewa_options_init(&ewa_asset_options_table, options, struct_size);
}

/// Copies a text; NULL stays NULL.
static ewa_status copy_text(ewa_context *context, const char *text, char **copy, size_t *bytes) {
    *copy = NULL;
    if (!text) return EWA_OK;
    *bytes = strlen(text) + 1;
    *copy = ewa_allocate(context, *bytes, 1);
    if (!*copy) return EWA_ERROR_MEMORY;
    memcpy(*copy, text, *bytes);
    return EWA_OK;
}

/// Makes an asset of nothing yet.
static ewa_status make(ewa_context *context, const char *name, const ewa_asset_options *options,
                       ewa_asset **made) {
    ewa_asset *asset = ewa_allocate_zeroed(context, 1, sizeof *asset);
    if (!asset) return EWA_ERROR_MEMORY;
    asset->context = context;
    atomic_init(&asset->references, 1);
    asset->serial = ewa_serial_next(context);
    asset->view = -1;
    asset->levels = options->levels;
    asset->gaussians_as_surfels = options->gaussians_as_surfels;
    asset->cutoff = options->cutoff;
    asset->voxel_level_count = options->voxel_level_count;
    asset->reach_steps = options->reach_steps;
    asset->of_columns = options->load && (options->load->columns || options->load->attributes || options->load->heights);
    memcpy(asset->to_world, options->to_world, sizeof asset->to_world);
    ewa_status status = copy_text(context, name, &asset->name, &asset->name_bytes);
    if (status == EWA_OK)
        status = copy_text(context, options->transfer, &asset->transfer, &asset->transfer_bytes);
    if (options->filter) asset->filter = *options->filter;
    *made = asset;
    if (status != EWA_OK) ewa_asset_release(made);
    return status;
}

const char *ewa_asset_kind_name(ewa_asset_kind kind) {
    static const char *const names[] = {"points", "mesh", "surfels", "octree", "gaussians", "volume"};
    return (unsigned)kind < sizeof names / sizeof names[0] ? names[kind] : "unknown";
}

ewa_asset *ewa_asset_retain(ewa_asset *asset) {
    atomic_fetch_add(&asset->references, 1);
    return asset;
}

void ewa_asset_release(ewa_asset **given) {
    ewa_asset *asset = given ? *given : NULL;
    if (!asset) return;
    *given = NULL;
    if (atomic_fetch_sub(&asset->references, 1) > 1) return;
    ewa_cloud_destroy(&asset->cloud);
    ewa_cloud_destroy(&asset->outline);
    if (asset->owns_parts) {
        ewa_lod_close(&asset->lod);
        ewa_splats_destroy(&asset->splats);
        ewa_asset_stream_free(&asset->stream);
        ewa_voxels_destroy(&asset->voxels);
    }
    ewa_context_destroy(&asset->lod_context); // its clouds are gone by now
    if (asset->source.release) asset->source.release(asset->source.user);
    ewa_release(asset->context, asset->name, asset->name_bytes, 1);
    ewa_release(asset->context, asset->transfer, asset->transfer_bytes, 1);
    ewa_release(asset->context, asset, 1, sizeof *asset);
}

void ewa_asset_describe(const ewa_asset *asset, ewa_asset_info *info) {
    *info = (ewa_asset_info){.kind = asset->kind,
                             .name = asset->name,
                             .count = asset->count,
                             .bounds = asset->bounds,
                             .cloud = asset->cloud,
                             .lod = asset->lod,
                             .surfels = asset->surfels,
                             .splats = asset->splats,
                             .voxels = asset->voxels,
                             .load_s = asset->load_s,
                             .drawable = asset->drawable,
                             .changeable = ewa_asset_is_changeable(asset),
                             .colorable = ewa_asset_is_colorable(asset)};
    memcpy(info->up_world, asset->up_world, sizeof info->up_world);
}

/// Whether what represents the points of an octree can be filtered as they are.
static bool levels_have(const ewa_lod_info *info, const ewa_filter *filter) {
    bool have = info->represented || !filter->term_count;
    for (uint32_t t = 0; t < filter->term_count && have; t++)
        have = ewa_cloud_has_scalar(info->represented, filter->terms[t].name);
    return have;
}

/// Opens an octree that is drawn from its levels; `*lod` is NULL where the file is none of these.
static ewa_status open_octree(const ewa_asset_job *job, const char *path, ewa_lod **lod) {
    const ewa_asset_options *options = job->options;
    ewa_context *context = job->asset->context;
    *lod = NULL;
    if (options->levels == EWA_OCTREE_NEVER || strcmp(path, "-") == 0 || !ewa_lod_probe(context, path))
        return EWA_OK;
    const bool columns = job->asset->of_columns, keep_going = options->load && options->load->keep_going;
    if (options->levels == EWA_OCTREE_AUTO && (columns || keep_going)) return EWA_OK;
    if (columns)
        return ewa_fail(
            context, EWA_ERROR_ARGUMENT,
            "a choice of columns needs all points of the octree, its levels do without; leave one of both "
            "out, or write what is wanted to a file of its own");
    if (options->own_context) EWA_TRY(ewa_context_create(&context->options, &job->asset->lod_context));
    EWA_TRY(ewa_lod_open(options->own_context ? job->asset->lod_context : context, path, lod));
    ewa_lod_info info;
    ewa_lod_describe(*lod, &info);
    const bool whole = info.point_count <= EWA_OCTREE_WHOLE_POINTS || !levels_have(&info, &job->asset->filter);
    if (options->levels == EWA_OCTREE_AUTO && whole) ewa_lod_close(lod);
    return EWA_OK;
}

static ewa_status load_gaussians(const ewa_asset_job *job, const char *path) {
    ewa_asset *asset = job->asset;
    ewa_gaussians set;
    ewa_gaussian_facts facts;
    const double started_s = ewa_now_s();
    bool streamed = false;
    if (!job->options->gaussians_as_surfels) EWA_TRY(ewa_asset_stream_gaussians(job, path, &streamed));
    if (streamed) return EWA_OK;
    EWA_TRY(ewa_gaussians_load(asset->context, path, &set, &facts));
    ewa_report(asset->context, EWA_SEVERITY_INFO, "%u Gaussians read in %.3f s (%s)", set.count,
               ewa_now_s() - started_s, ewa_gaussian_format_name(facts.format));
    ewa_status status = ewa_asset_take_gaussians(job, &set, facts.up_world);
    ewa_gaussians_free(&set);
    return status;
}

static ewa_status load_volume(const ewa_asset_job *job, const char *path) {
    ewa_volume volume = {.context = NULL};
    ewa_volume_load_options options;
    ewa_volume_load_options_init(&options, sizeof options);
    ewa_status status = ewa_volume_load(job->asset->context, path, &options, &volume);
    if (status == EWA_OK) status = ewa_asset_take_volume(job, NULL, &volume);
    ewa_volume_free(&volume);
    return status;
}

/// Loads points or triangles, by the caller's reader where it takes the file.
static ewa_status load_model(const ewa_asset_job *job, const char *path) {
    const ewa_asset_options *options = job->options;
    ewa_context *context = job->asset->context;
    ewa_model model = {.points = NULL};
    ewa_status status = EWA_OK;
    const double started_s = ewa_now_s();
    bool taken = false;
    if (options->reader) status = options->reader(options->reader_user, context, path, &model, &taken);
    if (status == EWA_OK && !taken) {
        if (ewa_lod_is_folder(context, path)) {
            static const double low_world[3] = {-INFINITY, -INFINITY, -INFINITY},
                                high_world[3] = {INFINITY, INFINITY, INFINITY};
            ewa_lod *lod = NULL;
            status = ewa_lod_open(context, path, &lod);
            if (status == EWA_OK) status = ewa_lod_read(lod, low_world, high_world, 0, &model.points);
            ewa_lod_close(&lod);
        } else {
            status = ewa_model_load(context, path, EWA_MODEL_MESH, options->load, &model);
        }
    }
    if (status == EWA_OK && model.lost_count)
        ewa_report(context, EWA_SEVERITY_NOTE, "%llu points are lost", (unsigned long long)model.lost_count);
    if (status == EWA_OK)
        ewa_report(
            context, EWA_SEVERITY_INFO, "%llu %s read in %.3f s",
            (unsigned long long)(model.face_count ? model.face_count : ewa_cloud_point_count(model.points)),
            model.face_count ? "faces" : "points", ewa_now_s() - started_s);
    if (status == EWA_OK) status = ewa_asset_take_model(job, &model);
    ewa_model_free(&model);
    return status;
}

/// Whether a file, or a folder, holds Gaussians.
static bool holds_gaussians(ewa_context *context, const char *path) {
    ewa_gaussian_format format = EWA_GAUSSIANS_NONE;
    // What is missing or cannot be opened is said by who reads it.
    ewa_failures_hush(context, true);
    const ewa_status status = ewa_gaussians_probe(context, path, &format);
    ewa_failures_hush(context, false);
    return status == EWA_OK && format != EWA_GAUSSIANS_NONE;
}

/// Finds what a file becomes; of an octree that is drawn from its levels, `*lod` is the caller's, else NULL.
static ewa_status find_kind(const ewa_asset_job *job, const char *path, ewa_asset_kind *kind, ewa_lod **lod) {
    ewa_context *context = job->asset->context;
    *lod = NULL;
    ewa_platform_facts facts;
    if (ewa_platform_stat(path, &facts) && facts.folder && !ewa_lod_probe(context, path)) {
        *kind = EWA_ASSET_GAUSSIANS;
        if (holds_gaussians(context, path)) return EWA_OK;
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: a folder, and neither an octree (EPT) nor Gaussians (SOG): name the files in it (%s/*)", path, path);
    }
    *kind = EWA_ASSET_VOLUME;
    if (ewa_volume_is_file(context, path)) return EWA_OK;
    // Octrees first: of them, not all is read to see what they are.
    EWA_TRY(open_octree(job, path, lod));
    *kind = *lod ? EWA_ASSET_OCTREE : EWA_ASSET_POINTS;
    if (!*lod && ewa_file_may_read(context, path) && holds_gaussians(context, path)) *kind = EWA_ASSET_GAUSSIANS;
    return EWA_OK;
}

static ewa_status load(const ewa_asset_job *job, const char *path) {
    ewa_asset_kind kind;
    ewa_lod *lod;
    EWA_TRY(find_kind(job, path, &kind, &lod));
    return kind == EWA_ASSET_VOLUME      ? load_volume(job, path)
           : kind == EWA_ASSET_GAUSSIANS ? load_gaussians(job, path)
           : kind == EWA_ASSET_OCTREE    ? ewa_asset_take_octree(job, lod)
                                         : load_model(job, path);
}

bool ewa_asset_map_is_valid(const double m[16]) {
    if (!m) return false;
    const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                               m[2] * (m[4] * m[9] - m[5] * m[8]);
    for (int i = 0; i < 12; i++)
        if (!isfinite(m[i])) return false;
    return m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1 && isfinite(determinant) && determinant != 0;
}

ewa_status ewa_asset_take_options(ewa_context *context, const ewa_asset_options *given,
                                  ewa_asset_options *options) {
    ewa_asset_options_init(options, sizeof *options);
    EWA_TRY(ewa_options_take(context, &ewa_asset_options_table, given, options));
    if (!ewa_asset_map_is_valid(options->to_world))
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "to_world: is no map that can be turned back: its last row must be 0 0 0 1, and its "
                        "determinant neither zero nor infinite");
    return EWA_OK;
}

ewa_status ewa_asset_load(ewa_context *context, const char *path, const ewa_asset_options *given,
                          ewa_asset **made) {
    if (!context || !path || !made) return EWA_ERROR_ARGUMENT;
    *made = NULL;
    ewa_asset_options options;
    const char *before = ewa_context_about(context, path);
    ewa_status status = ewa_asset_take_options(context, given, &options);
    ewa_asset *asset = NULL;
    if (status == EWA_OK) status = make(context, path, &options, &asset);
    const double started_s = ewa_now_s();
    if (status == EWA_OK) {
        asset->of_file = true;
        asset->of_octree = ewa_lod_is_folder(context, path);
        asset->owns_parts = true;
        ewa_kept_file kept;
        ewa_file_keep_begin(context, &kept, path);
        status = load(&(ewa_asset_job){asset, &options}, path);
        ewa_file_keep_end(context, &kept);
        asset->load_s = ewa_now_s() - started_s;
    }
    ewa_context_about(context, before);
    if (status != EWA_OK) ewa_asset_release(&asset);
    *made = asset;
    return status;
}

ewa_status ewa_asset_probe(ewa_context *context, const char *path, const ewa_asset_options *given,
                           ewa_asset_kind *kind) {
    if (!context || !path || !kind) return EWA_ERROR_ARGUMENT;
    ewa_asset_options options;
    const char *before = ewa_context_about(context, path);
    ewa_asset *asset = NULL;
    ewa_lod *lod = NULL;
    ewa_status status = ewa_asset_take_options(context, given, &options);
    options.own_context = false;
    if (status == EWA_OK) status = make(context, path, &options, &asset);
    if (status == EWA_OK) status = find_kind(&(ewa_asset_job){asset, &options}, path, kind, &lod);
    ewa_lod_close(&lod);
    ewa_asset_release(&asset);
    ewa_context_about(context, before);
    return status;
}

/// Borrows a cloud's streams.
static ewa_status borrow_cloud(const ewa_asset_job *job, const ewa_cloud *cloud) {
    ewa_cloud *view = NULL;
    char text[EWA_DIAGNOSIS_TEXT_BYTES];
    // A map changes the streams, as metres do.
    EWA_TRY(ewa_asset_is_moved(job->asset) || ewa_cloud_find_degrees(cloud, text)
                ? ewa_cloud_merge(&cloud, 1, &view)
                : ewa_cloud_view(job->asset->context, cloud, 0, ewa_cloud_point_count(cloud), &view));
    return ewa_asset_take_cloud(job, view);
}

/// Splats, voxels and surfels are where they are.
static ewa_status refuse_map(const ewa_asset_job *job) {
    if (!ewa_asset_is_moved(job->asset)) return EWA_OK;
    return ewa_fail(job->asset->context, EWA_ERROR_UNSUPPORTED, "to_world: what is resident cannot be moved");
}

static ewa_status take_source(const ewa_asset_job *job, const ewa_asset_source *source) {
    ewa_asset *asset = job->asset;
    ewa_context *context = asset->context;
    memcpy(asset->up_world, source->up_world, sizeof asset->up_world);
    if (source->cloud) return borrow_cloud(job, source->cloud);
    if (source->mesh) return ewa_asset_sample_mesh(job, source->mesh);
    if (source->gaussians) {
        ewa_gaussians set = *source->gaussians;
        return ewa_asset_take_gaussians(job, &set, source->up_world);
    }
    if (source->volume && !source->voxels) {
        ewa_volume volume = *source->volume;
        return ewa_asset_take_volume(job, source->transfer, &volume);
    }
    if (source->lod) return ewa_asset_take_octree(job, source->lod);
    EWA_TRY(refuse_map(job));
    if (source->surfels) {
        ewa_surfels_info info;
        ewa_surfels_describe(source->surfels, &info);
        asset->kind = EWA_ASSET_SURFELS;
        asset->surfels = source->surfels;
        asset->count = info.point_count;
        asset->bounds = info.bounds;
        return ewa_asset_outline_surfels(context, source->surfels, &asset->outline);
    }
    if (!source->outline)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: splats and voxels come with an outline",
                        asset->name);
    if (source->splats) {
        ewa_splats_info info;
        ewa_splats_describe(source->splats, &info);
        asset->kind = EWA_ASSET_GAUSSIANS;
        asset->splats = (ewa_splats *)source->splats; // never changed, and not its own
        asset->count = info.splat_count;
        asset->bounds = info.core;
        asset->near_world = info.near_world;
    } else {
        ewa_voxels_info info;
        ewa_voxels_describe(source->voxels, &info);
        asset->kind = EWA_ASSET_VOLUME;
        asset->voxels = (ewa_voxels *)source->voxels; // likewise
        asset->count = info.voxel_count;
        asset->bounds = info.bounds;
        asset->flat = source->flat;
        if (source->volume) asset->view = ewa_asset_view_of_volume(source->volume);
    }
    return ewa_cloud_view(context, source->outline, 0, ewa_cloud_point_count(source->outline),
                          &asset->outline);
}

ewa_status ewa_asset_create(ewa_context *context, const ewa_asset_source *source,
                            const ewa_asset_options *given, ewa_asset **made) {
    if (!context || !source || !made) return EWA_ERROR_ARGUMENT;
    *made = NULL;
    const void *const objects[] = {source->cloud,  source->surfels, source->lod,       source->splats,
                                   source->voxels, source->mesh,    source->gaussians, source->voxels ? NULL : source->volume};
    static const char *const names[] = {"points", "surfels", "octree",    "Gaussians",
                                        "volume", "mesh",    "Gaussians", "volume"};
    size_t count = 0, last = 0;
    for (size_t i = 0; i < sizeof objects / sizeof objects[0]; i++)
        if (objects[i]) count++, last = i;
    ewa_asset_options options;
    ewa_status status = ewa_asset_take_options(context, given, &options);
    if (status == EWA_OK && count != 1)
        status = ewa_fail(context, EWA_ERROR_ARGUMENT, "an asset is of one object, not of %zu", count);
    ewa_asset *asset = NULL;
    if (status == EWA_OK) status = make(context, source->name ? source->name : names[last], &options, &asset);
    if (status != EWA_OK) {
        if (source->release) source->release(source->user);
        return status;
    }
    asset->source = *source;
    // What is converted becomes the asset's own.
    asset->owns_parts = source->gaussians || (source->volume && !source->voxels);
    const char *before = ewa_context_about(context, source->name);
    const double started_s = ewa_now_s();
    status = take_source(&(ewa_asset_job){asset, &options}, source);
    asset->load_s = ewa_now_s() - started_s;
    ewa_context_about(context, before);
    if (status != EWA_OK) ewa_asset_release(&asset);
    *made = asset;
    return status;
}
