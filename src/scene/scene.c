// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scenes: instances, options, and when what is made of them has to be made anew.
#include "base/base.h"
#include "base/options.h"
#include "homogeneous/camera.h"
#include "scene/octree.h"

#include <math.h>
#include <string.h>

#define AT(member) offsetof(ewa_scene_options, member)

static const ewa_option scene_rows[] = {
    {"up", EWA_OPTION_CHOICE, AT(up), .words = "auto|y|z|-y|-z",
     .help = "what is up; auto: as files and points say"},
    {"close_gaps", EWA_OPTION_BOOL, AT(close_gaps), .initial = true,
     .help = "measure anew the radii of a file that leave gaps between the discs, and its normals where many are far off the points' own surface"},
    {"keep_points", EWA_OPTION_BOOL, AT(keep_points), .initial = true,
     .help = "clouds stay in memory beside their surfels, for picks and changes"},
    {"shade_volumes", EWA_OPTION_BOOL, AT(shade_volumes), .initial = true,
     .help = "volumes get the light that suits their transfer function"},
    {"many_frames", EWA_OPTION_BOOL, AT(many_frames),
     .help = "many frames of the scene follow: surfels in memory are drawn by levels of detail where the picture is off by next to nothing"},
    {"region_count", EWA_OPTION_U32, AT(region_count), 0, EWA_MAX_REGIONS, .help = "of the regions that hide points"},
};

const ewa_option_table ewa_scene_options_table = EWA_OPTION_TABLE(ewa_scene_options, scene_rows);

void ewa_scene_options_init(ewa_scene_options *options, size_t struct_size) {
    ewa_options_init(&ewa_scene_options_table, options, struct_size);
    if (!options || struct_size < sizeof *options) return;
    ewa_surfels_options_init(&options->surfels, sizeof options->surfels);
    ewa_lod_options_init(&options->lod, sizeof options->lod);
    ewa_render_options_init(&options->render, sizeof options->render);
    ewa_gaussian_options_init(&options->gaussians, sizeof options->gaussians);
    ewa_volume_options_init(&options->volumes, sizeof options->volumes);
    for (int c = 0; c < 4; c++) options->render.background[c] = 1;
    options->gaussians.near_world = 0;
}

#undef AT
#define AT(member) offsetof(ewa_instance, member)

static const ewa_option instance_rows[] = {
    {"visible", EWA_OPTION_BOOL, AT(visible), .initial = true, .help = "whether it is drawn"},
    {"opacity", EWA_OPTION_F64, AT(opacity), 0, 1, .initial = 1, .help = "of its points, times their own"},
    {"radius_scale", EWA_OPTION_F64, AT(radius_scale), 0, 100, EWA_OPTION_ABOVE, .initial = 1,
     .help = "of its points' radii"},
    {"material", EWA_OPTION_U32, AT(material), 0, UINT32_MAX, .initial = UINT32_MAX,
     .help = "of all its points; 4294967295: as each says"},
};

const ewa_option_table ewa_instance_table = EWA_OPTION_TABLE(ewa_instance, instance_rows);

void ewa_instance_init(ewa_instance *instance, size_t struct_size) {
    ewa_options_init(&ewa_instance_table, instance, struct_size);
    if (instance && struct_size >= sizeof *instance)
        ewa_coloring_init(&instance->coloring, sizeof instance->coloring);
}

/// Takes options with all structs within.
static ewa_status take_options(ewa_context *context, const ewa_scene_options *given,
                               ewa_scene_options *options) {
    ewa_scene_options_init(options, sizeof *options);
    if (!given) return EWA_OK;
    EWA_TRY(ewa_options_take(context, &ewa_scene_options_table, given, options));
    const struct {
        const ewa_option_table *table;
        const void *given;
        void *taken;
    } parts[] = {{&ewa_surfels_options_table, &given->surfels, &options->surfels},
                 {&ewa_lod_options_table, &given->lod, &options->lod},
                 {&ewa_render_options_table, &given->render, &options->render},
                 {&ewa_gaussian_options_table, &given->gaussians, &options->gaussians},
                 {&ewa_volume_options_table, &given->volumes, &options->volumes}};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        EWA_TRY(ewa_options_take(context, parts[i].table, parts[i].given, parts[i].taken));
    // What is compared later has no bytes that are left to chance.
    memset(&options->regions[options->region_count], 0,
           (EWA_MAX_REGIONS - options->region_count) * sizeof options->regions[0]);
    return ewa_regions_check(context, options->regions, options->region_count);
}

ewa_status ewa_scene_create(ewa_context *context, const ewa_scene_options *options, ewa_scene **made) {
    if (!context || !made) return EWA_ERROR_ARGUMENT;
    *made = NULL;
    ewa_scene *scene = ewa_allocate_zeroed(context, 1, sizeof *scene);
    if (!scene) return EWA_ERROR_MEMORY;
    scene->context = context;
    const ewa_status status = take_options(context, options, &scene->options);
    *made = scene;
    if (status != EWA_OK) ewa_scene_destroy(made);
    return status;
}

static void release_item(ewa_scene_item *item) {
    ewa_completed_release(&item->completed);
    ewa_left_part_release(&item->left);
    ewa_asset_release(&item->asset);
}

void ewa_scene_destroy(ewa_scene **given) {
    ewa_scene *scene = given ? *given : NULL;
    if (!scene) return;
    *given = NULL;
    for (uint32_t i = 0; i < scene->count; i++) release_item(&scene->items[i]);
    ewa_surface_release(&scene->surface);
    ewa_release(scene->context, scene->measures, scene->measure_count, sizeof *scene->measures);
    ewa_release(scene->context, scene->keyframes, scene->keyframe_count, sizeof *scene->keyframes);
    ewa_release(scene->context, scene->items, scene->capacity, sizeof *scene->items);
    ewa_release(scene->context, scene, 1, sizeof *scene);
}

/// Makes room for one more item.
static ewa_status grow(ewa_scene *scene) {
    if (scene->count < scene->capacity) return EWA_OK;
    const uint32_t capacity = scene->capacity ? 2 * scene->capacity : 8;
    ewa_scene_item *items = ewa_allocate_zeroed(scene->context, capacity, sizeof *items);
    if (!items) return EWA_ERROR_MEMORY;
    if (scene->count) memcpy(items, scene->items, scene->count * sizeof *items);
    ewa_release(scene->context, scene->items, scene->capacity, sizeof *items);
    scene->items = items;
    scene->capacity = capacity;
    return EWA_OK;
}

ewa_status ewa_scene_copy(const ewa_scene *scene, ewa_context *context, ewa_scene **copy) {
    if (!scene || !context || !copy) return EWA_ERROR_ARGUMENT;
    ewa_status status = ewa_scene_create(context, &scene->options, copy);
    for (uint32_t i = 0; i < scene->count && status == EWA_OK; i++) {
        status = grow(*copy);
        if (status != EWA_OK) break;
        ewa_scene_item *item = &(*copy)->items[(*copy)->count++];
        *item = scene->items[i];
        ewa_asset_retain(item->asset);
        if (item->completed) atomic_fetch_add(&item->completed->references, 1);
        if (item->left) atomic_fetch_add(&item->left->references, 1);
    }
    if (status == EWA_OK) status = ewa_scene_set_measures(*copy, scene->measures, scene->measure_count);
    if (status == EWA_OK) status = ewa_scene_set_keyframes(*copy, scene->keyframes, scene->keyframe_count);
    if (status != EWA_OK) {
        ewa_scene_destroy(copy);
        return status;
    }
    (*copy)->complete = scene->complete;
    (*copy)->committed = scene->committed;
    (*copy)->points_gone = scene->points_gone;
    (*copy)->surface = scene->surface;
    (*copy)->has_camera = scene->has_camera;
    (*copy)->camera = scene->camera;
    if (scene->surface) atomic_fetch_add(&scene->surface->references, 1);
    return EWA_OK;
}

void ewa_scene_reuse(ewa_scene *scene, const ewa_scene *other) {
    for (uint32_t i = 0; i < scene->count; i++) {
        ewa_scene_item *item = &scene->items[i];
        for (uint32_t k = 0; k < other->count && !item->completed; k++) {
            const ewa_scene_item *from = &other->items[k];
            if (from->asset != item->asset || !from->completed) continue;
            atomic_fetch_add(&from->completed->references, 1);
            item->completed = from->completed;
            item->member = from->member;
        }
        for (uint32_t k = 0; k < other->count && !item->left; k++) {
            const ewa_scene_item *from = &other->items[k];
            if (from->asset != item->asset || !from->left) continue;
            atomic_fetch_add(&from->left->references, 1);
            item->left = from->left;
        }
    }
    if (scene->surface || !other->surface) return;
    atomic_fetch_add(&other->surface->references, 1);
    scene->surface = other->surface;
}

/// Checks how an instance of an asset is to be shown.
static ewa_status take_instance(const ewa_scene *scene, const ewa_asset *asset, const ewa_instance *given,
                                ewa_instance *taken) {
    ewa_context *context = scene->context;
    ewa_instance_init(taken, sizeof *taken);
    if (!given) return EWA_OK;
    EWA_TRY(ewa_options_take(context, &ewa_instance_table, given, taken));
    EWA_TRY(ewa_coloring_take(context, &given->coloring, &taken->coloring));
    if (ewa_coloring_is_auto(taken->coloring.attribute)) taken->coloring.attribute[0] = 0;
    if (taken->material != EWA_MATERIAL_OWN && taken->material >= EWA_MAX_MATERIALS)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: material %u is beyond %d", asset->name,
                        taken->material, EWA_MAX_MATERIALS - 1);
    const bool own = ewa_coloring_is_own(taken->coloring.attribute) && !taken->coloring.tinted;
    const bool plain = taken->opacity == 1 && taken->radius_scale == 1 && taken->material == EWA_MATERIAL_OWN;
    if ((plain || ewa_asset_is_changeable(asset)) && (own || ewa_asset_is_colorable(asset))) return EWA_OK;
    if (asset->kind == EWA_ASSET_GAUSSIANS)
        return ewa_fail(context, EWA_ERROR_UNSUPPORTED,
                        "%s: opacity, radius scale and material are of points; of trained Gaussians the colouring can change",
                        asset->name);
    const char *kind = asset->kind == EWA_ASSET_SURFELS ? "resident surfels" : "a volume";
    return ewa_fail(
        context, EWA_ERROR_UNSUPPORTED,
        "%s: opacity, radius scale, material and colouring are of points; this is %s, with colours of "
        "its own",
        asset->name, kind);
}

ewa_status ewa_scene_add(ewa_scene *scene, ewa_asset *asset, const ewa_instance *instance) {
    if (!scene || !asset) return EWA_ERROR_ARGUMENT;
    ewa_instance taken;
    EWA_TRY(take_instance(scene, asset, instance, &taken));
    if (scene->points_gone && ewa_asset_is_points(asset))
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT,
                        "%s: the points of this scene are gone (keep_points), none can be added",
                        asset->name);
    if (scene->count == EWA_SCENE_MAX_INSTANCES)
        return ewa_fail(scene->context, EWA_ERROR_LIMIT,
                        "%s: the scene has %u instances already, its maximum", asset->name, scene->count);
    EWA_TRY(grow(scene));
    scene->items[scene->count++] = (ewa_scene_item){.asset = ewa_asset_retain(asset), .instance = taken};
    scene->complete = false; // what lacks nothing may still be of another system of coordinates, or far away
    scene->committed = false;
    return EWA_OK;
}

ewa_status ewa_scene_remove(ewa_scene *scene, uint32_t index) {
    if (!scene || index >= scene->count) return EWA_ERROR_ARGUMENT;
    const bool points = ewa_asset_is_points(scene->items[index].asset);
    if (points && scene->points_gone)
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT,
                        "%s: the points of this scene are gone (keep_points), none can be taken out",
                        scene->items[index].asset->name);
    release_item(&scene->items[index]);
    scene->count--;
    memmove(&scene->items[index], &scene->items[index + 1], (scene->count - index) * sizeof *scene->items);
    scene->complete = scene->complete && !points;
    scene->committed = false;
    return EWA_OK;
}

uint32_t ewa_scene_count(const ewa_scene *scene) { return scene->count; }

ewa_asset *ewa_scene_asset(const ewa_scene *scene, uint32_t index) {
    return index < scene->count ? scene->items[index].asset : NULL;
}

ewa_status ewa_scene_get(const ewa_scene *scene, uint32_t index, ewa_instance *instance) {
    if (!scene || index >= scene->count || !instance) return EWA_ERROR_ARGUMENT;
    *instance = scene->items[index].instance;
    return EWA_OK;
}

ewa_status ewa_scene_set(ewa_scene *scene, uint32_t index, const ewa_instance *instance) {
    if (!scene || index >= scene->count || !instance) return EWA_ERROR_ARGUMENT;
    ewa_scene_item *item = &scene->items[index];
    ewa_instance taken;
    EWA_TRY(take_instance(scene, item->asset, instance, &taken));
    if (scene->points_gone && ewa_asset_is_points(item->asset))
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT,
                        "%s: the points of this scene are gone (keep_points), they stay as they are",
                        item->asset->name);
    item->instance = taken;
    scene->committed = false;
    return EWA_OK;
}

void ewa_scene_get_options(const ewa_scene *scene, ewa_scene_options *options) { *options = scene->options; }

/// Whether what is left of Gaussians and volumes is what the regions leave.
static bool parts_agree(const ewa_scene *scene) {
    bool agree = true;
    for (uint32_t i = 0; i < scene->count && agree; i++)
        agree = (!scene->items[i].asset->splats && !scene->items[i].asset->voxels) ||
                ewa_left_part_is_of(scene->items[i].left, &scene->options);
    return agree;
}

ewa_status ewa_scene_set_options(ewa_scene *scene, const ewa_scene_options *given) {
    if (!scene || !given) return EWA_ERROR_ARGUMENT;
    ewa_scene_options options;
    EWA_TRY(take_options(scene->context, given, &options));
    scene->options = options;
    scene->committed = scene->committed && (scene->points_gone || ewa_surface_is_of(scene->surface, scene)) && parts_agree(scene);
    return EWA_OK;
}

ewa_status ewa_scene_complete(ewa_scene *scene) {
    if (!scene) return EWA_ERROR_ARGUMENT;
    if (scene->complete || scene->points_gone) return EWA_OK;
    const ewa_status status = ewa_scene_complete_items(scene);
    scene->complete = status == EWA_OK;
    return status;
}

/// Gives back the clouds, which nothing needs any more.
static void drop_points(ewa_scene *scene) {
    for (uint32_t i = 0; i < scene->count; i++) {
        ewa_scene_item *item = &scene->items[i];
        if (!ewa_asset_is_points(item->asset)) continue;
        ewa_completed_release(&item->completed);
    }
    for (uint32_t i = 0; i < scene->count; i++) {
        ewa_asset *asset = scene->items[i].asset;
        if (ewa_asset_is_points(asset) && atomic_load(&asset->references) == 1)
            ewa_cloud_destroy(&asset->cloud);
    }
    scene->points_gone = true;
}

ewa_status ewa_scene_make_resident(ewa_scene *scene) {
    if (scene->committed) return EWA_OK;
    EWA_TRY(ewa_scene_complete(scene));
    if (!scene->points_gone && !ewa_surface_is_of(scene->surface, scene)) {
        ewa_surface *surface = NULL;
        EWA_TRY(ewa_surface_make(scene, &surface));
        ewa_surface_release(&scene->surface);
        scene->surface = surface;
    }
    EWA_TRY(ewa_scene_hide_parts(scene));
    if (!scene->options.keep_points && !scene->points_gone) drop_points(scene);
    scene->committed = true;
    return EWA_OK;
}

ewa_status ewa_scene_commit(ewa_scene *scene) {
    if (!scene) return EWA_ERROR_ARGUMENT;
    EWA_TRY(ewa_scene_make_resident(scene));
    for (uint32_t i = 0; i < scene->count; i++) {
        ewa_octree_appearance appearance;
        if (scene->items[i].instance.visible && scene->items[i].asset->lod)
            EWA_TRY(ewa_scene_octree_appearance(scene, i, &scene->options.lod, &appearance));
    }
    return EWA_OK;
}

ewa_status ewa_scene_gather(ewa_scene *scene, bool closed, ewa_cloud **cloud) {
    *cloud = NULL;
    EWA_TRY(ewa_scene_complete(scene));
    if (scene->points_gone)
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT, "the points of this scene are gone (keep_points)");
    return ewa_surface_gather(scene, closed, cloud);
}

ewa_status ewa_scene_cloud(ewa_scene *scene, ewa_cloud **cloud) {
    if (!scene || !cloud) return EWA_ERROR_ARGUMENT;
    EWA_TRY(ewa_scene_gather(scene, false, cloud));
    return *cloud ? EWA_OK : ewa_fail(scene->context, EWA_ERROR_ARGUMENT, "the scene shows no points");
}

void ewa_scene_describe(const ewa_scene *scene, ewa_scene_info *info) {
    *info = (ewa_scene_info){.instance_count = scene->count};
    bool one_unit = true;
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_scene_item *item = &scene->items[i];
        const ewa_asset *asset = item->asset;
        info->load_s += asset->load_s;
        // Of those that were completed together, the first tells.
        if (item->completed && item->member == 0) {
            info->estimate_s += item->completed->estimate_s;
            info->estimated_count += item->completed->estimated_count;
        }
        if (!item->instance.visible) continue;
        info->visible_count++;
        one_unit = one_unit && !(asset->unit && info->unit && strcmp(asset->unit, info->unit) != 0);
        if (asset->unit) info->unit = asset->unit;
        info->point_count += asset->kind == EWA_ASSET_VOLUME ? 0 : asset->count;
        info->octrees |= asset->kind == EWA_ASSET_OCTREE;
        info->gaussians |= asset->kind == EWA_ASSET_GAUSSIANS;
        ewa_splats_info splats = {.has_levels = false};
        ewa_splats_describe(asset->splats, &splats);
        info->gaussian_levels |= splats.has_levels || asset->stream;
        info->volumes |= asset->kind == EWA_ASSET_VOLUME;
        info->surfaces |= ewa_asset_is_points(asset) || asset->kind == EWA_ASSET_SURFELS || info->octrees;
    }
    if (!one_unit) info->unit = NULL;
    if (!scene->surface) return;
    info->surfels = scene->surface->info;
    info->resident = scene->surface->surfels;
    info->surfels_s = scene->surface->surfels_s;
    info->estimate_s += scene->surface->estimate_s;
}

ewa_status ewa_scene_set_measures(ewa_scene *scene, const ewa_measure *measures, uint32_t count) {
    static const double up_world[3] = {0, 0, 1};
    if (!scene || (!measures && count)) return EWA_ERROR_ARGUMENT;
    if (count > EWA_MAX_MEASURES)
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT, "%u measurements; a scene has %d at most", count, EWA_MAX_MEASURES);
    for (uint32_t i = 0; i < count; i++) {
        ewa_measurement measured;
        const ewa_measure *m = &measures[i];
        if (m->count > EWA_MEASURE_PLACES || !memchr(m->name, 0, sizeof m->name) ||
            ewa_places_measure(m->kind, m->places_world, m->count, up_world, &measured) != EWA_OK)
            return ewa_fail(scene->context, EWA_ERROR_ARGUMENT, "measurement %u has no name, or not the places of its kind", i);
    }
    ewa_measure *made = count ? ewa_allocate(scene->context, count, sizeof *made) : NULL;
    if (count && !made) return EWA_ERROR_MEMORY;
    if (count) memcpy(made, measures, count * sizeof *made);
    ewa_release(scene->context, scene->measures, scene->measure_count, sizeof *made);
    scene->measures = made;
    scene->measure_count = count;
    return EWA_OK;
}

const ewa_measure *ewa_scene_measure(const ewa_scene *scene, uint32_t index) {
    return scene && index < scene->measure_count ? &scene->measures[index] : NULL;
}

ewa_status ewa_scene_set_keyframes(ewa_scene *scene, const ewa_camera *keyframes, uint32_t count) {
    if (!scene || (!keyframes && count)) return EWA_ERROR_ARGUMENT;
    if (count > EWA_MAX_KEYFRAMES)
        return ewa_fail(scene->context, EWA_ERROR_ARGUMENT, "%u keyframes; a scene has %d at most", count, EWA_MAX_KEYFRAMES);
    for (uint32_t i = 0; i < count; i++) EWA_TRY(ewa_camera_check(scene->context, &keyframes[i]));
    ewa_camera *made = count ? ewa_allocate(scene->context, count, sizeof *made) : NULL;
    if (count && !made) return EWA_ERROR_MEMORY;
    if (count) memcpy(made, keyframes, count * sizeof *made);
    ewa_release(scene->context, scene->keyframes, scene->keyframe_count, sizeof *made);
    scene->keyframes = made;
    scene->keyframe_count = count;
    return EWA_OK;
}

const ewa_camera *ewa_scene_keyframe(const ewa_scene *scene, uint32_t index) {
    return scene && index < scene->keyframe_count ? &scene->keyframes[index] : NULL;
}

void ewa_scene_bounds(const ewa_scene *scene, ewa_bounds *bounds) {
    *bounds = (ewa_bounds){.finite_count = 0};
    for (int c = 0; c < 3; c++) bounds->low_world[c] = INFINITY, bounds->high_world[c] = -INFINITY;
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_bounds *own = &scene->items[i].asset->bounds;
        if (!scene->items[i].instance.visible || !own->finite_count ||
            !(own->low_world[0] <= own->high_world[0]))
            continue;
        bounds->finite_count += own->finite_count;
        for (int c = 0; c < 3; c++) {
            bounds->low_world[c] = fmin(bounds->low_world[c], own->low_world[c]);
            bounds->high_world[c] = fmax(bounds->high_world[c], own->high_world[c]);
        }
    }
}
