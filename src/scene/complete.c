// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What surfels need and points lack: normals and radii, estimated for clouds that overlap or touch as if they were one
// file, so that tiles of one survey have no seams and scans of one place no two spacings.
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/scanners.h"
#include "estimate/given.h"
#include "estimate/sharp.h"
#include "estimate/sparse.h"
#include "ewa/framing.h"
#include "ewa/prepare.h"
#include "scene/parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Boxes that are no farther from each other than so many spacings touch.
static const double TOUCH_SPACINGS = 4;

/// Radius of a dot over the scene's size.
static const double DOT_RATIO = 0.004;

enum { NAMES_BYTES = 400, LISTED_NAMES = 4 }; // of a message

void ewa_completed_release(ewa_completed **given) {
    ewa_completed *completed = given ? *given : NULL;
    if (!completed) return;
    *given = NULL;
    if (atomic_fetch_sub(&completed->references, 1) > 1) return;
    ewa_context *context = completed->context;
    for (uint32_t i = 0; i < completed->count; i++) {
        if (completed->clouds) ewa_cloud_destroy(&completed->clouds[i]);
        if (completed->assets) ewa_asset_release(&completed->assets[i]);
    }
    ewa_cloud_destroy(&completed->merged);
    ewa_release(context, completed->clouds, completed->count, sizeof(ewa_cloud *));
    ewa_release(context, completed->assets, completed->count, sizeof(ewa_asset *));
    ewa_release(context, completed, 1, sizeof *completed);
}

/// A distance of the points as on a sheet of the box's size, or on a line.
static double spacing_of(const ewa_bounds *box) {
    double sides[2] = {0}; // the two longest
    for (int c = 0; c < 3; c++) {
        const double extent = box->high_world[c] - box->low_world[c];
        sides[1] = fmax(sides[1], fmin(sides[0], extent));
        sides[0] = fmax(sides[0], extent);
    }
    const double count = (double)box->finite_count;
    return fmax(sqrt(sides[0] * sides[1] / count), sides[0] / count);
}

/// A cloud that lacks something, and has no group yet.
typedef struct lacking {
    const ewa_asset *asset;
    uint32_t item, has; ///< has: bit 0 normals, bit 1 radii
    double reach;       ///< how far what touches it may be
} lacking;

static lacking lacking_of(const ewa_asset *asset, uint32_t item) {
    const uint32_t normals = ewa_cloud_find(asset->cloud, EWA_NORMAL) != NULL, radii = ewa_cloud_find(asset->cloud, EWA_RADIUS) != NULL;
    return (lacking){asset, item, normals | radii << 1, asset->bounds.finite_count ? TOUCH_SPACINGS * spacing_of(&asset->bounds) : -1};
}

/// Whether two clouds that lack the same are to be estimated together.
static bool belong_together(const lacking *a, const lacking *b) {
    if (a->asset == b->asset) return true;
    if (a->has != b->has || a->reach < 0 || b->reach < 0) return false;
    const ewa_bounds *one = &a->asset->bounds, *other = &b->asset->bounds;
    const double reach = fmax(a->reach, b->reach);
    for (int c = 0; c < 3; c++)
        if (one->low_world[c] - reach > other->high_world[c] || other->low_world[c] - reach > one->high_world[c]) return false;
    return true;
}

/// Gives all clouds that belong to the first of those that have no group one, directly or by others; they leave the list.
/// `members` has room for all. Returns how many these are.
static uint32_t mark_group(lacking *list, uint32_t *list_count, uint32_t *group_of, lacking *members) {
    const uint32_t first = list[0].item;
    uint32_t count = 0;
    members[count++] = list[0];
    group_of[first] = first;
    for (uint32_t next = 0; next < count; next++) {
        uint32_t kept = 0;
        for (uint32_t k = 0; k < *list_count; k++) {
            if (list[k].item == first) continue;
            if (belong_together(&members[next], &list[k])) {
                group_of[list[k].item] = first;
                members[count++] = list[k];
            } else {
                list[kept++] = list[k];
            }
        }
        *list_count = kept;
    }
    return count;
}

/// How many scanners a cloud knows the places of; 0: none, or not whose points are whose.
static uint32_t scanner_count(const ewa_cloud *cloud) {
    const size_t count = ewa_cloud_read_scanners(cloud, 0, NULL);
    const ewa_attribute *scan = ewa_cloud_find(cloud, "scan");
    if (count > UINT16_MAX || (scan && scan->component_count != 1)) return 0;
    return count > 1 && !scan ? 0 : (uint32_t)count;
}

/// Tells the merged points whose scanner saw them, if that is known of all.
static ewa_status merge_scanners(const ewa_completed *group) {
    uint32_t total = 0;
    for (uint32_t i = 0; i < group->count; i++) {
        const uint32_t own = scanner_count(group->assets[i]->cloud);
        if (!own) return EWA_OK;
        total += own;
    }
    double(*places)[3] = ewa_allocate(group->context, total, sizeof *places);
    void *data = NULL;
    ewa_status status = places ? ewa_cloud_add(group->merged, "scan", EWA_F64, 1, &data) : EWA_ERROR_MEMORY;
    double *scans = data;
    uint32_t before = 0;
    for (uint32_t i = 0; i < group->count && status == EWA_OK; i++) {
        const ewa_cloud *cloud = group->assets[i]->cloud;
        const ewa_attribute *scan = ewa_cloud_find(cloud, "scan");
        const uint64_t count = ewa_cloud_point_count(cloud);
        const uint32_t own = scanner_count(cloud);
        ewa_cloud_read_scanners(cloud, own, places + before);
        if (scan)
            ewa_attribute_read_f64(scan, 0, count, scans);
        else
            memset(scans, 0, count * sizeof *scans);
        for (uint64_t k = 0; k < count; k++) scans[k] += before;
        scans += count;
        before += own;
    }
    if (status == EWA_OK) status = ewa_cloud_write_scanners(group->merged, total, (const double(*)[3])places);
    ewa_release(group->context, places, total, sizeof *places);
    return status;
}

/// Whether all clouds of a group have an attribute.
static bool all_have(const ewa_completed *group, const char *name) {
    bool all = true;
    for (uint32_t i = 0; i < group->count; i++) all = all && ewa_cloud_find(group->assets[i]->cloud, name);
    return all;
}

/// Makes one cloud of the positions of several, and of what tells the sides of their normals.
static ewa_status merge_positions(ewa_completed *group) {
    static const char *const wanted[] = {EWA_POSITION, EWA_NORMAL, EWA_RADIUS, "return_number"};
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < group->count && status == EWA_OK; i++) {
        const ewa_cloud *from = group->assets[i]->cloud;
        double origin_world[3];
        ewa_cloud_origin(from, origin_world);
        status = ewa_cloud_create(group->context, ewa_cloud_point_count(from), &group->clouds[i]);
        if (status == EWA_OK) ewa_cloud_set_origin(group->clouds[i], origin_world);
        for (size_t w = 0; w < sizeof wanted / sizeof wanted[0] && status == EWA_OK; w++) {
            const ewa_attribute *a = ewa_cloud_find(from, wanted[w]);
            if (a && all_have(group, wanted[w]))
                status = ewa_cloud_borrow(group->clouds[i], a->name, a->type, a->component_count, a->data,
                                          a->stride_bytes);
        }
    }
    if (status == EWA_OK)
        status = ewa_cloud_merge((const ewa_cloud *const *)group->clouds, group->count, &group->merged);
    for (uint32_t i = 0; i < group->count; i++) ewa_cloud_destroy(&group->clouds[i]);
    return status == EWA_OK ? merge_scanners(group) : status;
}

/// Adds what was estimated of all to the view of one.
static ewa_status borrow_estimated(const ewa_completed *group, uint64_t first, ewa_cloud *view) {
    static const char *const estimated[] = {EWA_NORMAL, EWA_RADIUS, EWA_BORDER, EWA_SURFACENESS,
                                            EWA_CURVATURE};
    for (size_t i = 0; i < sizeof estimated / sizeof estimated[0]; i++) {
        const ewa_attribute *a = ewa_cloud_find(group->merged, estimated[i]);
        if (!a || ewa_cloud_find(view, estimated[i])) continue;
        EWA_TRY(ewa_cloud_borrow(view, a->name, a->type, a->component_count,
                                 (const char *)a->data + first * a->stride_bytes, a->stride_bytes));
    }
    return EWA_OK;
}

/// Says what was estimated of which files.
static void report(const ewa_completed *group, bool normals, uint32_t neighbour_count) {
    char names[NAMES_BYTES] = "";
    const uint32_t listed = group->count > LISTED_NAMES ? LISTED_NAMES - 1 : group->count;
    for (uint32_t i = 0; i < listed; i++) {
        const size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, "%s%.90s", i ? ", " : "", group->assets[i]->name);
    }
    const size_t length = strlen(names);
    if (listed < group->count)
        snprintf(names + length, sizeof names - length, " and %u more", group->count - listed);
    ewa_report(group->context, group->count > 1 ? EWA_SEVERITY_NOTE : EWA_SEVERITY_INFO,
               "%s: %sradii estimated%s from %u neighbours in %.3f s", names, normals ? "normals and " : "",
               group->count > 1 ? " together" : "", neighbour_count, group->estimate_s);
    if (!group->sparse && ewa_cloud_note(group->merged ? group->merged : group->clouds[0], EWA_SHARP_NOTE, NULL))
        ewa_report(group->context, EWA_SEVERITY_NOTE,
                   "%s: flat faces that meet in sharp edges; ewa_cloud_detect_features() makes these clean", names);
}

/// Radius of the dots of a scene.
static double dot_radius(const ewa_scene *scene) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, size2 = 0, far = 0;
    for (uint32_t i = 0; i < scene->count; i++)
        for (int c = 0; c < 3; c++) {
            const ewa_bounds *box = &scene->items[i].asset->bounds;
            low[c] = fmin(low[c], box->low_world[c]);
            high[c] = fmax(high[c], box->high_world[c]);
        }
    for (int c = 0; c < 3; c++) {
        if (high[c] > low[c]) size2 += (high[c] - low[c]) * (high[c] - low[c]);
        if (isfinite(high[c])) far = fmax(far, fabs(high[c]));
    }
    const double size = sqrt(size2);
    return DOT_RATIO * (size > 0 ? size : far > 0 ? far : 1);
}

/// Makes dots of the points of a group that is no surface: what was estimated of their distances is of no use.
static ewa_status make_dots(const ewa_scene *scene, ewa_completed *group) {
    const double radius = dot_radius(scene);
    bool sparse = true;
    ewa_status status = EWA_OK;
    for (uint32_t i = 0; i < group->count && sparse && status == EWA_OK; i++) {
        const ewa_cloud *own = group->assets[i]->cloud;
        const bool sized = ewa_cloud_find(own, EWA_RADIUS) || ewa_cloud_find(own, EWA_TANGENT_U);
        status = sized ? EWA_OK : ewa_cloud_is_sparse(group->clouds[i], &sparse);
        sparse = sparse && !sized;
    }
    for (uint32_t i = 0; i < group->count && sparse && status == EWA_OK; i++) {
        void *data = NULL;
        const uint64_t count = ewa_cloud_point_count(group->clouds[i]);
        ewa_cloud_remove(group->clouds[i], EWA_BORDER);
        ewa_cloud_remove(group->clouds[i], EWA_SURFACENESS);
        ewa_cloud_remove(group->clouds[i], EWA_CURVATURE);
        status = ewa_cloud_add(group->clouds[i], EWA_RADIUS, EWA_F32, 1, &data);
        for (uint64_t k = 0; k < count && status == EWA_OK; k++) ((float *)data)[k] = (float)radius;
    }
    group->sparse = sparse;
    return status;
}

/// Finds whether all of a group was photographed by depth cameras: the colours have the light of the place.
static ewa_status find_photographed(ewa_completed *group) {
    bool all = all_have(group, EWA_COLOR);
    for (uint32_t i = 0; i < group->count && all; i++) {
        ewa_framing *framing = NULL;
        EWA_TRY(ewa_framing_create(group->clouds[i], 1, &framing));
        const char *name = group->assets[i]->name;
        ewa_upright upright;
        ewa_framing_choose(framing, ewa_up_convention_of(1, &name), &upright);
        ewa_framing_destroy(&framing);
        all = upright.from_origin;
    }
    group->photographed = all;
    return EWA_OK;
}

/// Estimates one cloud; normals of a file that are not those of its points' surface, whose discs would leave gaps, are measured anew, too.
static ewa_status estimate_cloud(const ewa_scene *scene, ewa_cloud **cloud) {
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    EWA_TRY(ewa_cloud_estimate(cloud, &options));
    const char *percent = ewa_cloud_note(*cloud, EWA_NORMALS_OFF_NOTE, NULL);
    if (!percent) return EWA_OK;
    ewa_report(scene->context, EWA_SEVERITY_NOTE, "normals of %s %% of the points are over 60 degrees off the points' own surface%s", percent,
               scene->options.close_gaps ? ": new ones are used (close_gaps = false keeps the file's)" : ", which leaves gaps");
    if (!scene->options.close_gaps) return EWA_OK;
    options.keep_normals = options.keep_radii = false;
    return ewa_cloud_estimate(cloud, &options);
}

/// Estimates what the clouds of a group lack.
static ewa_status estimate(const ewa_scene *scene, ewa_completed *group) {
    ewa_estimate_options options;
    ewa_estimate_options_init(&options, sizeof options);
    const bool normals = !ewa_cloud_find(group->assets[0]->cloud, EWA_NORMAL);
    const double started_s = ewa_now_s();
    ewa_status status = group->count > 1 ? merge_positions(group) : EWA_OK;
    const char *before = ewa_context_about(group->context, group->count > 1 ? NULL : group->assets[0]->name);
    if (status == EWA_OK && group->count > 1) {
        status = estimate_cloud(scene, &group->merged);
        static const char *const spare[] = {EWA_POSITION, "scan", "return_number"};
        for (size_t i = 0; i < sizeof spare / sizeof spare[0]; i++) ewa_cloud_remove(group->merged, spare[i]);
    }
    uint64_t first = 0;
    for (uint32_t i = 0; i < group->count && status == EWA_OK; i++) {
        const ewa_cloud *from = group->assets[i]->cloud;
        const uint64_t count = ewa_cloud_point_count(from);
        status = ewa_cloud_view(group->context, from, 0, count, &group->clouds[i]);
        if (status == EWA_OK)
            status = group->count > 1 ? borrow_estimated(group, first, group->clouds[i])
                                      : estimate_cloud(scene, &group->clouds[i]);
        first += count;
    }
    if (status == EWA_OK) status = make_dots(scene, group);
    if (status == EWA_OK && normals) status = find_photographed(group);
    ewa_context_about(group->context, before);
    group->estimated_count = first;
    group->estimate_s = ewa_now_s() - started_s;
    if (status == EWA_OK) report(group, normals, options.neighbour_count);
    return status;
}

/// Whether a group that was made before is of these items.
static bool is_of(const ewa_completed *group, const ewa_scene *scene, uint32_t first,
                  const uint32_t *group_of, uint32_t count) {
    if (!group || group->count != count) return false;
    uint32_t member = 0;
    for (uint32_t i = first; i < scene->count; i++)
        if (group_of[i] == first && group->assets[member++] != scene->items[i].asset) return false;
    return true;
}

/// Makes a group of the marked items.
static ewa_status make_group(ewa_scene *scene, uint32_t first, const uint32_t *group_of, uint32_t count,
                             ewa_completed **made) {
    ewa_context *context = scene->context;
    ewa_completed *group = ewa_allocate_zeroed(context, 1, sizeof *group);
    if (!group) return EWA_ERROR_MEMORY;
    group->context = context;
    group->count = count;
    atomic_init(&group->references, 1);
    group->assets = ewa_allocate_zeroed(context, count, sizeof *group->assets);
    group->clouds = ewa_allocate_zeroed(context, count, sizeof *group->clouds);
    ewa_status status = group->assets && group->clouds ? EWA_OK : EWA_ERROR_MEMORY;
    uint32_t member = 0;
    for (uint32_t i = first; i < scene->count && status == EWA_OK; i++)
        if (group_of[i] == first) group->assets[member++] = ewa_asset_retain(scene->items[i].asset);
    if (status == EWA_OK) status = estimate(scene, group);
    *made = group;
    if (status != EWA_OK) ewa_completed_release(made);
    return status;
}

/// Gives each marked item its place in a group.
static void set_group(ewa_scene *scene, uint32_t first, const uint32_t *group_of, ewa_completed *group) {
    uint32_t member = 0;
    for (uint32_t i = first; i < scene->count; i++) {
        if (group_of[i] != first) continue;
        ewa_completed *old = scene->items[i].completed;
        atomic_fetch_add(&group->references, 1);
        scene->items[i].completed = group;
        scene->items[i].member = member++;
        ewa_completed_release(&old);
    }
}

/// Warns of coordinate reference systems that are not that of the first file that has one.
static void check_systems(const ewa_scene *scene) {
    const char *first = NULL, *first_name = NULL;
    for (uint32_t i = 0; i < scene->count; i++) {
        const ewa_asset *asset = scene->items[i].asset;
        const ewa_cloud *cloud = asset->cloud                      ? asset->cloud
                                 : asset->kind == EWA_ASSET_OCTREE ? asset->outline
                                                                   : NULL;
        const char *system = cloud ? ewa_cloud_note(cloud, "crs", NULL) : NULL;
        if (!system) continue;
        if (!first) {
            first = system, first_name = asset->name;
        } else if (strcmp(first, system) != 0) {
            ewa_report(scene->context, EWA_SEVERITY_WARNING,
                       "%s: its coordinate reference system (%.60s) is not that of %s (%.60s): coordinates "
                       "are taken "
                       "as they are",
                       asset->name, system, first_name, first);
        }
    }
}

static double diagonal_of(const ewa_bounds *bounds) {
    double square = 0;
    for (int c = 0; c < 3; c++) square += pow(bounds->high_world[c] - bounds->low_world[c], 2);
    return sqrt(square);
}

static double distance_between(const ewa_bounds *a, const ewa_bounds *b) {
    double square = 0;
    for (int c = 0; c < 3; c++)
        square += pow(fmax(fmax(a->low_world[c] - b->high_world[c], b->low_world[c] - a->high_world[c]), 0), 2);
    return sqrt(square);
}

/// Warns where the largest of several things and the one that is farthest from it are so far apart that hardly any of them is
/// to be seen in a picture of both.
static void check_distances(const ewa_scene *scene) {
    enum { FAR_APART = 1000 }; // times the largest: of a picture of all it takes a pixel or two
    const ewa_asset *largest = NULL, *farthest = NULL;
    double size_world = 0, distance_world = 0;
    for (int find_farthest = 0; find_farthest < 2 && (largest || !find_farthest); find_farthest++)
        for (uint32_t i = 0; i < scene->count; i++) {
            const ewa_asset *asset = scene->items[i].asset;
            if (!scene->items[i].instance.visible || !asset->bounds.finite_count ||
                !(asset->bounds.low_world[0] <= asset->bounds.high_world[0]))
                continue;
            const double number = find_farthest ? distance_between(&asset->bounds, &largest->bounds) : diagonal_of(&asset->bounds);
            double *maximum = find_farthest ? &distance_world : &size_world;
            if (!(number > *maximum)) continue;
            *maximum = number;
            *(find_farthest ? &farthest : &largest) = asset;
        }
    if (size_world > 0 && distance_world > FAR_APART * size_world)
        ewa_report(scene->context, EWA_SEVERITY_WARNING,
                   "%s lies %.3g from %s, which measures %.3g: in one picture hardly any of it is to be seen; are their "
                   "coordinates of one system?",
                   farthest->name, distance_world, largest->name, size_world);
}

ewa_status ewa_scene_complete_items(ewa_scene *scene) {
    uint32_t *group_of = ewa_allocate(scene->context, scene->count, sizeof *group_of), list_count = 0;
    lacking *list = ewa_allocate(scene->context, scene->count, sizeof *list), *members = ewa_allocate(scene->context, scene->count, sizeof *members);
    ewa_status status = group_of && list && members ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK) memset(group_of, 0xff, scene->count * sizeof *group_of);
    for (uint32_t i = 0; i < scene->count && status == EWA_OK; i++) {
        const ewa_asset *asset = scene->items[i].asset;
        if (ewa_asset_is_points(asset) && !asset->drawable && asset->count) list[list_count++] = lacking_of(asset, i);
    }
    while (list_count && status == EWA_OK) {
        const uint32_t first = list[0].item, count = mark_group(list, &list_count, group_of, members);
        ewa_completed *group = scene->items[first].completed;
        if (is_of(group, scene, first, group_of, count)) {
            atomic_fetch_add(&group->references, 1);
        } else {
            group = NULL;
            status = make_group(scene, first, group_of, count, &group);
        }
        if (status == EWA_OK) set_group(scene, first, group_of, group);
        ewa_completed_release(&group);
    }
    ewa_release(scene->context, group_of, scene->count, sizeof *group_of);
    ewa_release(scene->context, list, scene->count, sizeof *list);
    ewa_release(scene->context, members, scene->count, sizeof *members);
    if (status == EWA_OK) check_systems(scene), check_distances(scene);
    return status;
}
