// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The one surface of a scene: the surfels of all visible clouds and meshes, made of them as if they were one file, so
// that what is added and what was merged before are the same bytes. Octrees that are coloured by numbers take part in
// the scale of these colours, by the points that stand for them; they are drawn from their nodes (octree.c).
#include "base/base.h"
#include "cloud/border.h"
#include "cloud/cloud.h"
#include "ewa/diagnosis.h"
#include "ewa/prepare.h"
#include "scene/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GAP_POINTS = 1000 };

/// Support radius in units of the spacing under which irregular points leave gaps.
static const double GAP_RADIUS = 1;

void ewa_surface_release(ewa_surface **given) {
    ewa_surface *surface = given ? *given : NULL;
    if (!surface) return;
    *given = NULL;
    if (atomic_fetch_sub(&surface->references, 1) > 1) return;
    ewa_context *context = surface->context;
    ewa_surfels_destroy(&surface->surfels);
    for (uint32_t i = 0; surface->legends && i < surface->legend_count; i++)
        ewa_legend_free(&surface->legends[i]);
    for (uint32_t i = 0; surface->splat_colors && i < surface->count; i++)
        ewa_splat_colors_destroy(&surface->splat_colors[i]);
    ewa_release(context, surface->splat_colors, surface->count, sizeof *surface->splat_colors);
    ewa_release(context, surface->legends, surface->count, sizeof *surface->legends);
    ewa_release(context, surface->legend_of, surface->count, sizeof *surface->legend_of);
    ewa_release(context, surface->keys, surface->count, sizeof *surface->keys);
    ewa_release(context, surface, 1, sizeof *surface);
}

/// Whether an item's points are part of the surface, or of its colours.
static bool is_shown(const ewa_scene_item *item) {
    const ewa_asset *asset = item->asset;
    const ewa_coloring *coloring = &item->instance.coloring;
    if (!item->instance.visible || !asset->count) return false;
    if (asset->kind == EWA_ASSET_GAUSSIANS) return coloring->tinted || !ewa_coloring_is_own(coloring->attribute);
    if (asset->kind != EWA_ASSET_OCTREE) return ewa_asset_is_points(asset);
    // An octree without colours may show a number that nobody asked for.
    return ewa_coloring_is_auto(coloring->attribute) ? !coloring->tinted && !ewa_asset_has_colors(asset)
                                                     : !ewa_coloring_is_own(coloring->attribute);
}

/// An order of the clouds that does not depend on that of the instances: by their places, octrees and Gaussians last.
static int compare_keys(const void *a, const void *b) {
    const ewa_surface_key *p = a, *q = b;
    const bool whole[] = {ewa_asset_is_points(p->asset), ewa_asset_is_points(q->asset)};
    if (whole[0] != whole[1]) return whole[0] ? -1 : 1;
    const ewa_bounds *m = &p->asset->bounds, *n = &q->asset->bounds;
    for (int c = 0; c < 3; c++) {
        if (m->low_world[c] != n->low_world[c]) return m->low_world[c] < n->low_world[c] ? -1 : 1;
        if (m->high_world[c] != n->high_world[c]) return m->high_world[c] < n->high_world[c] ? -1 : 1;
    }
    if (p->asset->count != q->asset->count) return p->asset->count < q->asset->count ? -1 : 1;
    return strcmp(p->asset->name, q->asset->name);
}

static ewa_surface_key key_of(const ewa_scene_item *item) {
    return (ewa_surface_key){item->asset, item->asset->serial, item->asset->drawable ? NULL : item->completed,
                             item->instance, item->member};
}

/// Whether two keys give the same surfels.
static bool keys_agree(const ewa_surface_key *a, const ewa_surface_key *b) {
    const ewa_instance *m = &a->instance, *n = &b->instance;
    const bool alike =
        m->opacity == n->opacity && m->radius_scale == n->radius_scale && m->material == n->material;
    return a->asset == b->asset && a->serial == b->serial && a->completed == b->completed &&
           (alike || !ewa_asset_is_points(a->asset)) && ewa_colorings_agree(&m->coloring, &n->coloring);
}

/// Lists what is shown, in the order in which it is merged; `*count` keys of `scene->count` that there is room for.
static ewa_status list_keys(const ewa_scene *scene, ewa_surface_key **keys, uint32_t *count) {
    *count = 0;
    for (uint32_t i = 0; i < scene->count; i++) *count += is_shown(&scene->items[i]);
    *keys = ewa_allocate_zeroed(scene->context, *count, sizeof **keys);
    if (!*keys) return EWA_ERROR_MEMORY;
    uint32_t at = 0;
    for (uint32_t i = 0; i < scene->count; i++)
        if (is_shown(&scene->items[i])) (*keys)[at++] = key_of(&scene->items[i]);
    qsort(*keys, *count, sizeof **keys, compare_keys);
    return EWA_OK;
}

bool ewa_surface_is_of(const ewa_surface *surface, const ewa_scene *scene) {
    const ewa_scene_options *options = &scene->options;
    const ewa_surfels_options *a = &options->surfels;
    const ewa_surfels_options *b = surface ? &surface->options : NULL;
    if (!surface || surface->close_gaps != options->close_gaps ||
        surface->as_points != (options->render.point_size_px > 0) || a->cutoff != b->cutoff ||
        a->radius_scale != b->radius_scale || a->level_count != b->level_count ||
        surface->region_count != options->region_count ||
        memcmp(surface->regions, options->regions, options->region_count * sizeof options->regions[0]) != 0)
        return false;
    ewa_surface_key *keys = NULL;
    uint32_t count;
    bool agree = list_keys(scene, &keys, &count) == EWA_OK && count == surface->count;
    for (uint32_t i = 0; agree && i < count; i++) agree = keys_agree(&keys[i], &surface->keys[i]);
    ewa_release(scene->context, keys, count, sizeof *keys);
    return agree;
}

/// The clouds that a surface is made of, changed as their instances say.
typedef struct shown_clouds {
    ewa_cloud **clouds;  ///< [surface->count]
    ewa_cloud **colored; ///< likewise: those of one colouring
    ewa_coloring *colorings; ///< of each, with what automatic ones choose
    ewa_coloring **chosen;   ///< of those in `colored`
} shown_clouds;

/// Multiplies numbers of some components by a factor.
static ewa_status scale_stream(ewa_cloud *cloud, const char *name, uint32_t components, double factor) {
    const ewa_attribute *found = ewa_cloud_find(cloud, name);
    if (!found || found->component_count != components) return EWA_OK;
    const uint64_t count = ewa_cloud_point_count(cloud);
    const ewa_attribute from = *found;
    ewa_context *context = ewa_cloud_context(cloud);
    float *scaled = ewa_allocate(context, count, components * sizeof *scaled);
    if (!scaled) return EWA_ERROR_MEMORY;
    ewa_attribute_read_f32(&from, 0, count, scaled);
    for (uint64_t i = 0; i < count * components; i++) scaled[i] = (float)((double)scaled[i] * factor);
    void *data = NULL;
    const ewa_status status = ewa_cloud_add(cloud, name, EWA_F32, components, &data);
    if (status == EWA_OK) memcpy(data, scaled, count * components * sizeof *scaled);
    ewa_release(context, scaled, count, components * sizeof *scaled);
    return status;
}

ewa_status ewa_cloud_set_appearance(ewa_cloud *cloud, double opacity, uint32_t material) {
    const uint64_t count = ewa_cloud_point_count(cloud);
    ewa_status status = EWA_OK;
    if (opacity < 1) {
        status = ewa_cloud_colors_to_linear(cloud);
        float *colors = status == EWA_OK ? ewa_cloud_find(cloud, EWA_COLOR)->data : NULL;
        for (uint64_t i = 0; colors && i < count; i++) colors[4 * i + 3] *= (float)opacity;
    }
    if (status == EWA_OK && material != EWA_MATERIAL_OWN) {
        void *data = NULL;
        status = ewa_cloud_add(cloud, EWA_MATERIAL, EWA_U8, 1, &data);
        if (status == EWA_OK) memset(data, (int)material, count);
    }
    return status;
}

/// Changes radii, alpha and material as an instance says.
static ewa_status apply_instance(const ewa_instance *instance, ewa_cloud *cloud) {
    if (instance->radius_scale != 1) {
        EWA_TRY(scale_stream(cloud, EWA_RADIUS, 1, instance->radius_scale));
        EWA_TRY(scale_stream(cloud, EWA_TANGENT_U, 3, instance->radius_scale));
        EWA_TRY(scale_stream(cloud, EWA_TANGENT_V, 3, instance->radius_scale));
    }
    return ewa_cloud_set_appearance(cloud, instance->opacity, instance->material);
}

/// Decides by what the points are coloured.
static ewa_status choose_colorings(const ewa_surface *surface, const shown_clouds *shown) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < surface->count; i++) {
        ewa_coloring *coloring = &shown->colorings[i];
        *coloring = surface->keys[i].instance.coloring;
        // Numbers of a mesh's vertices say less of it than its shape does.
        if (coloring->tinted || !ewa_coloring_is_auto(coloring->attribute) || surface->keys[i].asset->kind == EWA_ASSET_MESH)
            continue;
        if (surface->keys[i].asset->lod) {
            ewa_lod_info info;
            ewa_lod_describe(surface->keys[i].asset->lod, &info);
            // What represents points need not have every strength of light.
            if (info.represented) ewa_cloud_drop_signals(shown->clouds[i], info.represented);
        }
        shown->colored[count] = shown->clouds[i];
        shown->chosen[count++] = coloring;
    }
    return ewa_colorings_choose(shown->colored, count, shown->chosen);
}

/// Colours the clouds, those of one colouring on one scale.
static ewa_status apply_colorings(ewa_surface *surface, const shown_clouds *shown) {
    EWA_TRY(choose_colorings(surface, shown));
    for (uint32_t i = 0; i < surface->count; i++) surface->legend_of[i] = UINT32_MAX;
    for (uint32_t i = 0; i < surface->count; i++) {
        const ewa_coloring *coloring = &shown->colorings[i];
        if (surface->legend_of[i] != UINT32_MAX) continue;
        uint32_t count = 0;
        const char *lacking = NULL; // what has not got the attribute
        for (uint32_t k = i; k < surface->count; k++) {
            if (!ewa_colorings_agree(coloring, &shown->colorings[k])) continue;
            if (!lacking && !ewa_coloring_is_own(coloring->attribute) && !ewa_cloud_has_scalar(shown->clouds[k], coloring->attribute))
                lacking = surface->keys[k].asset->name;
            shown->colored[count++] = shown->clouds[k];
            surface->legend_of[k] = surface->legend_count;
        }
        const char *before = lacking ? ewa_context_about(surface->context, lacking) : NULL;
        const ewa_status status =
            ewa_clouds_color(shown->colored, count, coloring, &surface->legends[surface->legend_count++]);
        if (lacking) ewa_context_about(surface->context, before);
        EWA_TRY(status);
    }
    return EWA_OK;
}

/// The discs' median support radius in units of the spacing 1 / sqrt(d) (d: density): from the unit coverage
/// q = s^2 d (1 - exp(-F^2 / 2)) with s = radius / F. Before a radius scale that shrinks discs: whoever asks for it
/// wants gaps.
static double radius_in_spacings(const ewa_surface *surface) {
    const double f = surface->options.cutoff, kernel = 1 - exp(-0.5 * f * f);
    return f * sqrt(surface->info.unit_coverage / kernel) / fmin(surface->options.radius_scale, 1);
}

static ewa_status make_surfels(ewa_surface *surface, const ewa_cloud *cloud) {
    const double started_s = ewa_now_s();
    const ewa_status status = ewa_surfels_create(cloud, &surface->options, &surface->surfels);
    surface->surfels_s += ewa_now_s() - started_s;
    if (status == EWA_OK) ewa_surfels_describe(surface->surfels, &surface->info);
    return status;
}

/// Whether no point is part of a surface, as of lines: there is nothing that could have gaps.
static bool is_no_surface(const ewa_cloud *cloud) {
    const ewa_attribute *surfaceness = ewa_cloud_find(cloud, EWA_SURFACENESS);
    bool none = surfaceness;
    for (uint64_t i = 0; none && i < ewa_cloud_point_count(cloud); i++) {
        double value = 0;
        ewa_attribute_read_f64(surfaceness, i, 1, &value);
        none = value < EWA_SURFACE_LIMIT;
    }
    return none;
}

/// Measures the radii anew where those of files are so small that there are gaps between the discs; says so.
static ewa_status close_gaps(ewa_surface *surface, ewa_cloud **cloud) {
    const double radius = radius_in_spacings(surface);
    const bool gaps = surface->info.point_count >= GAP_POINTS && radius < GAP_RADIUS;
    if (surface->as_points || !gaps || !ewa_cloud_find(*cloud, EWA_RADIUS) ||
        ewa_cloud_find(*cloud, EWA_TANGENT_U) || is_no_surface(*cloud))
        return EWA_OK;
    if (!surface->close_gaps) {
        ewa_report(surface->context, EWA_SEVERITY_NOTE,
                   "the radii are %.2f of the points' spacing, which leaves gaps", radius);
        return EWA_OK;
    }
    ewa_report(surface->context, EWA_SEVERITY_NOTE,
               "the radii are %.2f of the points' spacing, which leaves gaps: larger ones are used "
               "(close_gaps = false keeps the file's)",
               radius);
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    options.cutoff = surface->options.cutoff;
    options.keep_radii = false;
    const double started_s = ewa_now_s();
    ewa_surfels_destroy(&surface->surfels);
    const ewa_status status = ewa_cloud_estimate(cloud, &options);
    surface->estimate_s += ewa_now_s() - started_s;
    return status == EWA_OK ? make_surfels(surface, *cloud) : status;
}

/// Makes surfels of the one cloud that the shown ones become.
static ewa_status make_resident(ewa_surface *surface, ewa_cloud **cloud) {
    EWA_TRY(make_surfels(surface, *cloud));
    EWA_TRY(close_gaps(surface, cloud));
    return ewa_cloud_report_invalid_points(*cloud, &surface->info);
}

/// Takes the colours of Gaussians from the clouds that they were for that, and gives their levels those of their own numbers.
static ewa_status take_splat_colors(ewa_surface *surface, const shown_clouds *shown) {
    for (uint32_t i = surface->cloud_count; i < surface->count; i++) {
        const ewa_splats *splats = surface->keys[i].asset->splats;
        const ewa_coloring *coloring = &shown->colorings[i];
        ewa_splats_info info;
        ewa_cloud *levels = NULL;
        if (!splats) continue;
        ewa_splats_describe(splats, &info);
        ewa_status status = info.has_levels ? ewa_splats_to_cloud(splats, true, &levels) : EWA_OK;
        const ewa_legend *legend = &surface->legends[surface->legend_of[i]];
        if (status == EWA_OK && levels && legend->context) {
            const ewa_color_scale scale = ewa_color_scale_of(legend);
            ewa_scalar scalar;
            uint64_t grey_count = 0; // room without a Gaussian, too
            status = ewa_cloud_find_scalar(levels, coloring->attribute, &scalar);
            if (status == EWA_OK) status = ewa_cloud_color_by(levels, &scalar, &scale, &grey_count);
        } else if (status == EWA_OK && levels) {
            status = ewa_cloud_tint(levels, coloring->tint);
        }
        if (status == EWA_OK) status = ewa_splat_colors_create(splats, shown->clouds[i], levels, &surface->splat_colors[i]);
        ewa_cloud_destroy(&levels);
        EWA_TRY(status);
    }
    return EWA_OK;
}

/// Makes views of all that is shown, in the colours of their instances.
static ewa_status color(ewa_surface *surface, const shown_clouds *shown) {
    for (uint32_t i = 0; i < surface->count; i++) {
        const ewa_surface_key *key = &surface->keys[i];
        if (key->asset->splats) {
            EWA_TRY(ewa_splats_to_cloud(key->asset->splats, false, &shown->clouds[i]));
            continue;
        }
        const ewa_cloud *cloud = key->completed                    ? key->completed->clouds[key->member]
                                 : ewa_asset_is_points(key->asset) ? key->asset->cloud
                                                                   : key->asset->outline;
        EWA_TRY(ewa_cloud_view(surface->context, cloud, 0, ewa_cloud_point_count(cloud), &shown->clouds[i]));
    }
    EWA_TRY(apply_colorings(surface, shown));
    return take_splat_colors(surface, shown);
}

/// Leaves out the points that regions hide; `count` clouds, the first, have some left.
static ewa_status hide(const ewa_surface *surface, const shown_clouds *shown, uint32_t *count) {
    *count = 0;
    for (uint32_t i = 0; i < surface->cloud_count; i++) {
        ewa_cloud *cloud = shown->clouds[i];
        shown->clouds[i] = NULL;
        const ewa_status status = ewa_cloud_hide(surface->context, surface->regions, surface->region_count, &cloud);
        if (status == EWA_OK && (ewa_cloud_point_count(cloud) || !surface->region_count))
            shown->clouds[(*count)++] = cloud;
        else
            ewa_cloud_destroy(&cloud);
        EWA_TRY(status);
    }
    return EWA_OK;
}

/// Makes one cloud of all that is shown, coloured and measured as the instances say; NULL: there is none. One that is
/// alone is shown's, and borrows its streams.
static ewa_status gather(ewa_scene *scene, ewa_surface *surface, const shown_clouds *shown, ewa_cloud **whole) {
    ewa_context *context = surface->context;
    *whole = NULL;
    EWA_TRY(color(surface, shown));
    surface->photographed = true;
    for (uint32_t i = 0; i < surface->cloud_count; i++) {
        const ewa_surface_key *key = &surface->keys[i];
        const bool own = !shown->colorings[i].tinted && ewa_coloring_is_own(shown->colorings[i].attribute);
        const bool colored = ewa_cloud_find(shown->clouds[i], EWA_COLOR) && !(own && key->asset->plain);
        surface->colored = surface->colored || colored;
        surface->photographed = surface->photographed && colored && own && key->completed && key->completed->photographed;
    }
    for (uint32_t i = 0; i < surface->cloud_count; i++)
        EWA_TRY(apply_instance(&surface->keys[i].instance, shown->clouds[i]));
    uint32_t count;
    EWA_TRY(hide(surface, shown, &count));
    if (count == 1) {
        *whole = shown->clouds[0];
        shown->clouds[0] = NULL;
    }
    if (count < 2) return EWA_OK;
    EWA_TRY(ewa_clouds_make_alike(shown->clouds, count, scene->options.surfels.cutoff));
    // Systems of coordinates that differ have been told with the names of the files (complete.c).
    ewa_reports_hush(context, true);
    const ewa_status status = ewa_cloud_merge((const ewa_cloud *const *)shown->clouds, count, whole);
    ewa_reports_hush(context, false);
    return status;
}

/// What of a surface is wanted: its colours' meaning alone, its cloud as it is, or surfels, whose gaps are closed.
typedef enum surface_extent { ONLY_LEGENDS, ONLY_CLOUD, WITH_SURFELS } surface_extent;

/// Makes what is wanted of all that is shown; with `cloud`, that surfels are made of.
static ewa_status fill(ewa_scene *scene, ewa_surface *surface, const shown_clouds *shown, surface_extent extent,
                       ewa_cloud **cloud) {
    if (extent == ONLY_LEGENDS) return color(surface, shown);
    ewa_cloud *whole;
    ewa_status status = gather(scene, surface, shown, &whole);
    const char *before =
        ewa_context_about(surface->context, surface->cloud_count == 1 ? surface->keys[0].asset->name : NULL);
    if (status == EWA_OK && whole && extent == WITH_SURFELS) status = make_resident(surface, &whole);
    // The streams of one cloud are not the caller's.
    if (status == EWA_OK && whole && cloud)
        status = ewa_cloud_merge((const ewa_cloud *const *)&whole, 1, cloud);
    ewa_context_about(surface->context, before);
    ewa_cloud_destroy(&whole);
    return status;
}

/// Makes the surface of a scene, as fill() does.
static ewa_status make(ewa_scene *scene, ewa_surface **made, surface_extent extent, ewa_cloud **cloud) {
    ewa_context *context = scene->context;
    *made = NULL;
    ewa_surface *surface = ewa_allocate_zeroed(context, 1, sizeof *surface);
    if (!surface) return EWA_ERROR_MEMORY;
    surface->context = context;
    atomic_init(&surface->references, 1);
    surface->options = scene->options.surfels;
    surface->close_gaps = scene->options.close_gaps;
    surface->region_count = scene->options.region_count;
    memcpy(surface->regions, scene->options.regions, surface->region_count * sizeof surface->regions[0]);
    surface->as_points = scene->options.render.point_size_px > 0;
    ewa_status status = list_keys(scene, &surface->keys, &surface->count);
    const uint32_t count = surface->count;
    shown_clouds shown = {.clouds = NULL};
    for (uint32_t i = 0; i < count && status == EWA_OK; i++)
        surface->cloud_count += ewa_asset_is_points(surface->keys[i].asset);
    surface->sparse = surface->cloud_count > 0 && surface->options.radius_scale == 1;
    for (uint32_t i = 0; i < surface->cloud_count; i++) {
        const ewa_completed *completed = surface->keys[i].completed;
        surface->sparse = surface->sparse && completed && completed->sparse && surface->keys[i].instance.radius_scale == 1;
    }
    if (status == EWA_OK && count) {
        surface->legends = ewa_allocate_zeroed(context, count, sizeof *surface->legends);
        surface->legend_of = ewa_allocate_zeroed(context, count, sizeof *surface->legend_of);
        surface->splat_colors = ewa_allocate_zeroed(context, count, sizeof *surface->splat_colors);
        shown.clouds = ewa_allocate_zeroed(context, count, sizeof *shown.clouds);
        shown.colored = ewa_allocate_zeroed(context, count, sizeof *shown.colored);
        shown.colorings = ewa_allocate_zeroed(context, count, sizeof *shown.colorings);
        shown.chosen = ewa_allocate_zeroed(context, count, sizeof *shown.chosen);
        const bool room = surface->legends && surface->legend_of && surface->splat_colors && shown.clouds && shown.colored &&
                          shown.colorings && shown.chosen;
        status = room ? fill(scene, surface, &shown, extent, cloud) : EWA_ERROR_MEMORY;
    }
    for (uint32_t i = 0; shown.clouds && i < count; i++) ewa_cloud_destroy(&shown.clouds[i]);
    ewa_release(context, shown.clouds, count, sizeof *shown.clouds);
    ewa_release(context, shown.colored, count, sizeof *shown.colored);
    ewa_release(context, shown.colorings, count, sizeof *shown.colorings);
    ewa_release(context, shown.chosen, count, sizeof *shown.chosen);
    if (status == EWA_OK && surface->sparse && !surface->as_points && !cloud && extent == WITH_SURFELS)
        ewa_report(context, EWA_SEVERITY_NOTE, "%llu point%s: drawn as dots of %d pixels, point_size_px decides otherwise",
                   (unsigned long long)surface->info.point_count,
                   surface->info.point_count == 1 ? "" : "s on no surface", EWA_DOT_PX);
    if (status == EWA_OK)
        *made = surface;
    else
        ewa_surface_release(&surface);
    return status;
}

ewa_status ewa_surface_make(ewa_scene *scene, ewa_surface **surface) {
    return make(scene, surface, WITH_SURFELS, NULL);
}

ewa_status ewa_surface_make_legends(ewa_scene *scene, ewa_surface **surface) {
    return make(scene, surface, ONLY_LEGENDS, NULL);
}

ewa_status ewa_surface_gather(ewa_scene *scene, bool closed, ewa_cloud **cloud) {
    ewa_surface *surface;
    *cloud = NULL;
    const ewa_status status = make(scene, &surface, closed ? WITH_SURFELS : ONLY_CLOUD, cloud);
    ewa_surface_release(&surface);
    return status;
}

const ewa_legend *ewa_surface_legend(const ewa_surface *surface, const ewa_asset *asset) {
    for (uint32_t i = 0; i < surface->count; i++) {
        if (surface->keys[i].asset != asset || surface->legend_of[i] == UINT32_MAX) continue;
        const ewa_legend *legend = &surface->legends[surface->legend_of[i]];
        return legend->context ? legend : NULL;
    }
    return NULL;
}

const ewa_splat_colors *ewa_surface_splat_colors(const ewa_surface *surface, const ewa_asset *asset) {
    for (uint32_t i = 0; surface && i < surface->count; i++)
        if (surface->keys[i].asset == asset && surface->splat_colors[i]) return surface->splat_colors[i];
    return NULL;
}

const ewa_legend *ewa_scene_legend(const ewa_scene *scene, uint32_t index) {
    if (index >= scene->count || !scene->committed || !scene->surface) return NULL;
    return ewa_surface_legend(scene->surface, scene->items[index].asset);
}
