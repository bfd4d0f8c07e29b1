// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras where no file says: what is up in a scene, from where it is seen, all of it in the picture.
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "framing/conventions.h"
#include "furniture/layout.h"
#include "homogeneous/camera.h"
#include "scene/parts.h"

#include <math.h>
#include <string.h>

#define AT(member) offsetof(ewa_view_options, member)

static const ewa_option view_rows[] = {
    {"width_px", EWA_OPTION_U32, AT(width_px), 1, 65536, EWA_OPTION_OR_ZERO, .unit = "px",
     .help = "of the picture; 0: of the scene's camera, else 1280"},
    {"height_px", EWA_OPTION_U32, AT(height_px), 1, 65536, EWA_OPTION_OR_ZERO, .unit = "px",
     .help = "of the picture; 0: of the scene's camera, else 720"},
    {"fov_deg", EWA_OPTION_F64, AT(fov_deg), 0, 180, EWA_OPTION_BELOW, .unit = "deg",
     .help = "vertical field of view; 0: 30, but for what a camera at the origin took"},
    {"ortho_height_world", EWA_OPTION_F64, AT(ortho_height_world), 0, INFINITY, EWA_OPTION_BELOW,
     .unit = "world", .help = "an orthographic camera that shows so much; 0: perspective"},
    {"up_world", EWA_OPTION_F64, AT(up_world), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3,
     .help = "up in the picture; zeros: the scene's"},
    {"has_eye", EWA_OPTION_BOOL, AT(has_eye), .help = "the eye is given"},
    {"has_target", EWA_OPTION_BOOL, AT(has_target), .help = "the target is given"},
    {"eye_world", EWA_OPTION_F64, AT(eye_world), -INFINITY, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3,
     .help = "where the camera is"},
    {"target_world", EWA_OPTION_F64, AT(target_world), -INFINITY, INFINITY,
     EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3, .help = "what it looks at"},
    {"azimuth_deg", EWA_OPTION_F64, AT(azimuth_deg), -360, 360, .unit = "deg",
     .help = "carries the camera about the up axis"},
    {"elevation_deg", EWA_OPTION_F64, AT(elevation_deg), -180, 180, .unit = "deg", .help = "then raises it"},
    {"turntable", EWA_OPTION_BOOL, AT(turntable),
     .help = "all is in the picture in every turn about the axis"},
    {"direction_world", EWA_OPTION_F64, AT(direction_world), -INFINITY, INFINITY,
     EWA_OPTION_ABOVE | EWA_OPTION_BELOW, 3, .help = "in which it looks; zeros: as the view says"},
    {"color_bar", EWA_OPTION_BOOL, AT(color_bar), .help = "room is left for a colour bar where all is put into the picture"},
};

const ewa_option_table ewa_view_options_table = EWA_OPTION_TABLE(ewa_view_options, view_rows);

void ewa_view_options_init(ewa_view_options *options, size_t struct_size) {
    ewa_options_init(&ewa_view_options_table, options, struct_size);
    if (options && struct_size >= sizeof *options) options->view = -1;
}

/// A camera that is being placed.
typedef struct placement {
    ewa_context *context;
    const ewa_view_options *options;
    const ewa_framing *framing;
    int up_axis;   ///< 1 y, 2 z, negative: down; 0: nothing says so
    bool up_asked; ///< somebody, and no file, says so
    const char *up_why; ///< of a file; NULL: its kind has it
    ewa_up_convention convention;
    int suited_view; ///< -1: none
    ewa_framing_info of;
    ewa_upright upright;
    double direction_world[3], up_world[3], axis_world[3];
} placement;

static int axis_of(ewa_scene_up up) {
    static const int axes[] = {0, 1, 2, -1, -2};
    return axes[up];
}

/// The axis, y or z, that a direction is nearest to: 1 y, 2 z, negative: down. What has y or z down hangs: its sides are those of what
/// cameras see.
static int axis_near(const double up[3]) {
    const int axis = fabs(up[2]) > fabs(up[1]) ? 2 : 1;
    return up[axis] < 0 ? -axis : axis;
}

/// What is up as an asset says, as above; 0: it does not.
static int up_axis_of_asset(const ewa_asset *asset) {
    const double *up = asset->up_world;
    return up[0] == 0 && up[1] == 0 && up[2] == 0 ? 0 : axis_near(up);
}

/// By the end of which name an asset's convention goes: octrees are surveyed, whatever they are called.
static const char *file_of(const ewa_asset *asset) {
    return asset->of_octree || asset->lod ? "ept.json" : asset->name;
}

/// What is up by the first visible file that says so, and why.
static int up_axis_of(const ewa_scene *scene, const char **why) {
    // Volumes come last: what else there is was put to them.
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < scene->count; i++) {
            const ewa_asset *asset = scene->items[i].asset;
            const int axis = up_axis_of_asset(asset);
            if (!scene->items[i].instance.visible || !axis || (pass == 0) != (asset->kind != EWA_ASSET_VOLUME)) continue;
            *why = asset->up_why;
            return axis;
        }
    return 0;
}

/// The convention that all visible files share.
static ewa_status find_convention(const ewa_scene *scene, ewa_up_convention *convention) {
    const char **names = ewa_allocate(scene->context, scene->count, sizeof *names);
    size_t count = 0;
    if (!names) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < scene->count; i++)
        if (scene->items[i].instance.visible)
            names[count++] = file_of(scene->items[i].asset);
    *convention = ewa_up_convention_of(count, names);
    ewa_release(scene->context, names, scene->count, sizeof *names);
    return EWA_OK;
}

ewa_status ewa_scene_find_up(ewa_scene *scene, double up_world[3]) {
    int axis = axis_of(scene->options.up);
    ewa_up_convention convention;
    EWA_TRY(find_convention(scene, &convention));
    const char *why;
    if (!axis) axis = up_axis_of(scene, &why);
    // Heights of surveys are along z, whatever their points look like.
    if (!axis && convention == EWA_UP_Z_SURVEYED) axis = 2;
    if (axis) {
        for (int c = 0; c < 3; c++) up_world[c] = c == axis ? 1 : c == -axis ? -1 : 0;
        return EWA_OK;
    }
    ewa_view_info info;
    EWA_TRY(ewa_scene_place_camera(scene, NULL, NULL, &info));
    memcpy(up_world, info.up_world, sizeof info.up_world);
    return EWA_OK;
}

/// The view that suits the only visible asset, if that is a volume; -1: none does.
static int view_of_volume(const ewa_scene *scene) {
    const ewa_asset *only = NULL;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->count; i++)
        if (scene->items[i].instance.visible) only = scene->items[i].asset, count++;
    return count == 1 ? only->view : -1;
}

/// What is up and how it is looked at.
static void choose_upright(placement *p) {
    const double *up = p->options->up_world;
    const bool given = up[0] != 0 || up[1] != 0 || up[2] != 0;
    const int said = given ? axis_near(up) : p->up_axis;
    if (!said) {
        ewa_framing_choose(p->framing, p->convention, &p->upright);
        return;
    }
    const double *low = p->of.box.low_world, *high = p->of.box.high_world;
    const double extent[3] = {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    const int axis = said < 0 ? -said : said;
    p->upright =
        (ewa_upright){.axis = axis,
                      .reversed = said < 0,
                      .view = ewa_upright_view(extent, axis),
                      .why = given || p->up_asked ? "as it was asked for" : p->up_why ? p->up_why : "as files of this kind have it"};
}

/// The up vector of the picture, the axis of a turntable and the direction in which a camera without an eye looks.
static ewa_status choose_direction(placement *p) {
    const ewa_view_options *options = p->options;
    choose_upright(p);
    ewa_upright *chosen = &p->upright;
    const double *up = options->up_world;
    const double *direction = options->direction_world;
    const bool given = up[0] != 0 || up[1] != 0 || up[2] != 0,
               directed = direction[0] != 0 || direction[1] != 0 || direction[2] != 0,
               carried = options->azimuth_deg != 0 || options->elevation_deg != 0;
    chosen->from_origin = chosen->from_origin && options->view < 0 && !carried && !directed;
    if (options->view >= 0)
        chosen->view = (ewa_named_view)options->view;
    else if (p->suited_view >= 0)
        chosen->view = carried || given ? EWA_VIEW_FRONT : (ewa_named_view)p->suited_view;
    ewa_upright_look(chosen, p->direction_world, p->up_world);
    for (int c = 0; c < 3; c++)
        p->axis_world[c] = given ? up[c] : c == chosen->axis ? (chosen->reversed ? -1 : 1) : 0;
    if (given || directed) memcpy(p->up_world, p->axis_world, sizeof p->up_world);
    if (directed) memcpy(p->direction_world, direction, sizeof p->direction_world);
    return !carried ? EWA_OK
                    : ewa_upright_turn(p->axis_world, options->azimuth_deg, options->elevation_deg,
                                       p->direction_world, p->up_world);
}

/// Moves the camera sideways so that it looks at the target from the same distance.
static ewa_status aim(const placement *p, ewa_camera *camera) {
    const double *direction = p->direction_world, *target_world = p->options->target_world;
    double eye_world[3], aimed_world[3], distance = 0, length = 0;
    ewa_camera_eye(camera, eye_world);
    for (int c = 0; c < 3; c++) {
        const double away = p->of.middle_world[c] - eye_world[c];
        distance += away * away;
        length += direction[c] * direction[c];
    }
    for (int c = 0; c < 3; c++) aimed_world[c] = target_world[c] - direction[c] * sqrt(distance / length);
    return ewa_camera_look_at(camera, aimed_world, target_world, p->up_world);
}

/// Takes room off a picture's right and bottom, and the principal point into the middle of what is left; or adds it again.
static void add_room(const uint32_t room_px[2], bool added, ewa_camera *camera) {
    camera->width_px = added ? camera->width_px + room_px[0] : camera->width_px - room_px[0];
    camera->height_px = added ? camera->height_px + room_px[1] : camera->height_px - room_px[1];
    if (added) return;
    camera->cx_px -= 0.5 * room_px[0];
    camera->cy_px -= 0.5 * room_px[1];
}

/// Places a camera whose picture and projection are set.
static ewa_status place(const placement *p, const double pivot_world[3], ewa_camera *camera) {
    const ewa_view_options *options = p->options;
    ewa_context *context = p->context;
    if (options->has_eye) {
        const double *eye = options->eye_world,
                     *target = options->has_target ? options->target_world : p->of.middle_world;
        const ewa_status status = ewa_camera_look_at(camera, eye, target, p->up_world);
        return status == EWA_OK ? EWA_OK
                                : ewa_fail(context, status, "the eye %g,%g,%g is also where the camera looks",
                                           eye[0], eye[1], eye[2]);
    }
    if (p->of.trimmed)
        ewa_report(context, EWA_SEVERITY_NOTE,
                   "a few points lie far off and are left outside the picture; eye_world decides otherwise");
    uint32_t room_px[2] = {0, 0};
    if (options->color_bar && !options->has_target && !(options->ortho_height_world > 0))
        ewa_color_bar_room(camera->width_px, camera->height_px, room_px);
    add_room(room_px, false, camera);
    ewa_status status = EWA_OK;
    if (options->turntable) {
        ewa_framing *solid = NULL;
        status = ewa_framing_revolve(p->framing, pivot_world, p->axis_world, p->direction_world, &solid);
        if (status == EWA_OK) status = ewa_framing_fit(solid, p->direction_world, p->up_world, camera);
        ewa_framing_destroy(&solid);
    } else if (p->upright.from_origin && !options->has_target && !(options->fov_deg > 0) &&
               !(options->ortho_height_world > 0)) {
        static const double origin[3] = {0, 0, 0};
        status = ewa_framing_zoom(p->framing, origin, p->up_world, camera);
    } else {
        status = ewa_framing_fit(p->framing, p->direction_world, p->up_world, camera);
        if (status == EWA_OK && options->has_target) status = aim(p, camera);
    }
    add_room(room_px, true, camera);
    if (status == EWA_OK && options->ortho_height_world > 0)
        status = ewa_camera_set_ortho(camera, options->ortho_height_world);
    return status;
}

static ewa_status place_by_framing(placement *p, ewa_camera *camera, ewa_view_info *info) {
    const ewa_view_options *options = p->options;
    ewa_framing_describe(p->framing, &p->of);
    EWA_TRY(choose_direction(p));
    const double *axis = p->axis_world,
                 length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    *info = (ewa_view_info){.upright = p->upright, .trimmed = p->of.trimmed};
    memcpy(info->pivot_world, options->has_target ? options->target_world : p->of.middle_world,
           sizeof info->pivot_world);
    for (int c = 0; c < 3; c++) info->up_world[c] = axis[c] / length;
    if (!camera) return EWA_OK;
    char text[EWA_UPRIGHT_TEXT_BYTES];
    ewa_upright_describe(&p->upright, text);
    ewa_report(p->context, EWA_SEVERITY_INFO, "up: %s", text);
    ewa_camera_init(camera);
    if (options->width_px) camera->width_px = options->width_px;
    if (options->height_px) camera->height_px = options->height_px;
    EWA_TRY(options->ortho_height_world > 0
                ? ewa_camera_set_ortho(camera, options->ortho_height_world)
                : ewa_camera_set_fov(camera, options->fov_deg > 0 ? options->fov_deg : EWA_VIEW_FOV_DEG));
    return place(p, info->pivot_world, camera);
}

/// Measures an outline and places a camera at it.
static ewa_status place_at(placement *p, const ewa_cloud *outline, double radius_scale,
                           const ewa_view_options *given, ewa_camera *camera, ewa_view_info *info) {
    ewa_view_options options;
    ewa_view_options_init(&options, sizeof options);
    EWA_TRY(ewa_options_take(p->context, &ewa_view_options_table, given, &options));
    if (options.view > EWA_VIEW_ISO)
        return ewa_fail(p->context, EWA_ERROR_ARGUMENT, "view: %d is none of the named ones", options.view);
    ewa_framing *framing = NULL;
    ewa_view_info own;
    ewa_status status = ewa_framing_create(outline, radius_scale, &framing);
    p->options = &options;
    p->framing = framing;
    if (status == EWA_OK) status = place_by_framing(p, camera, info ? info : &own);
    if (status == EWA_ERROR_NUMERIC && framing && !options.has_eye)
        ewa_fail(p->context, status, "no camera can be placed: the numbers of its options are too large");
    ewa_framing_destroy(&framing);
    return status;
}

ewa_status ewa_cloud_place_camera(const ewa_cloud *cloud, double radius_scale, ewa_up_convention convention,
                                  ewa_scene_up up, const ewa_view_options *options, ewa_camera *camera,
                                  ewa_view_info *info) {
    if (!cloud || (unsigned)up > EWA_UP_MINUS_Z) return EWA_ERROR_ARGUMENT;
    placement p = {.context = ewa_cloud_context(cloud),
                   .up_axis = axis_of(up),
                   .convention = convention,
                   .suited_view = -1};
    return place_at(&p, cloud, radius_scale, options, camera, info);
}

/// What an asset is measured by; NULL: its points are gone.
static const ewa_cloud *places_of(const ewa_asset *asset) { return ewa_asset_is_points(asset) ? asset->cloud : asset->outline; }

/// Measures how an asset stands, as files of a convention do, by a context of the calling thread.
static ewa_status measure_upright(ewa_context *context, const ewa_asset *asset, ewa_up_convention convention, ewa_upright *upright) {
    const ewa_cloud *places = places_of(asset);
    if (!places) return ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: its points are gone", asset->name);
    ewa_cloud *own = NULL; // the asset's context may be loading another file
    EWA_TRY(ewa_cloud_view(context, places, 0, ewa_cloud_point_count(places), &own));
    placement p = {.context = context,
                   .up_axis = up_axis_of_asset(asset),
                   .up_why = asset->up_why,
                   .convention = convention,
                   .suited_view = asset->view};
    ewa_view_info info;
    const ewa_status status = place_at(&p, own, 1, NULL, NULL, &info);
    ewa_cloud_destroy(&own);
    if (status == EWA_OK) *upright = info.upright;
    return status;
}

ewa_status ewa_asset_find_upright(const ewa_asset *asset, ewa_upright *upright) {
    if (!asset || !upright) return EWA_ERROR_ARGUMENT;
    const char *name = file_of(asset);
    return measure_upright(asset->context, asset, ewa_up_convention_of(1, &name), upright);
}

/// What is up in a file for sure: 1 y, 2 z, negative: down; 0: it has to be measured. What a map moves lies as somebody wants it,
/// volumes are what all else was put to.
static int sure_axis_of(const ewa_asset *asset) {
    const char *name = file_of(asset);
    const ewa_up_convention convention = ewa_up_convention_of(1, &name);
    const bool sure = convention == EWA_UP_Y_REQUIRED || convention == EWA_UP_Z_SURVEYED;
    const int said = up_axis_of_asset(asset);
    return said ? said : sure ? ewa_up_axis_of(convention) : 0;
}

/// Whether an asset lies by the numbers of its file, which another program may have meant otherwise.
static bool lies_as_filed(const ewa_scene_item *item) {
    return item->instance.visible && !ewa_asset_is_moved(item->asset) && item->asset->kind != EWA_ASSET_VOLUME && item->asset->count;
}

/// Says of two files which have not the same up that they are joined by their numbers: turning one would part what was made to
/// fit. The first one is sure of it; others are as sure, or stand otherwise even measured by the convention of the first.
static ewa_status tell_ups(ewa_scene *scene) {
    enum { MAX_MEASURED = 8 };
    static const char *const axes[] = {"-z", "-y", "", "y", "z"};
    const ewa_asset *first = NULL;
    for (uint32_t i = 0; i < scene->count && !first; i++)
        if (lies_as_filed(&scene->items[i]) && sure_axis_of(scene->items[i].asset)) first = scene->items[i].asset;
    const bool told = scene->ups_told == scene->count;
    scene->ups_told = scene->count;
    if (!first || told) return EWA_OK;
    const int axis = sure_axis_of(first);
    uint32_t measured = 0;
    for (uint32_t i = 0; i < scene->count && measured < MAX_MEASURED; i++) {
        const ewa_asset *other = scene->items[i].asset;
        if (other == first || !lies_as_filed(&scene->items[i])) continue;
        int its = sure_axis_of(other);
        // The table has no convention of what is measured against cameras.
        if (!its && (axis < 0 || !places_of(other))) continue;
        if (!its) {
            ewa_upright upright;
            measured++;
            EWA_TRY(measure_upright(scene->context, other, axis == 1 ? EWA_UP_Y_USUAL : EWA_UP_Z_SURVEYED, &upright));
            its = upright.reversed ? -upright.axis : upright.axis;
        }
        if (its == axis) continue;
        ewa_report(scene->context, EWA_SEVERITY_WARNING,
                   "%s has %s up, %s %s: they are joined by their numbers as they are; to_world of one in a scene file turns it",
                   first->name, axes[axis + 2], other->name, axes[its + 2]);
        return EWA_OK;
    }
    return EWA_OK;
}

ewa_status ewa_scene_set_camera(ewa_scene *scene, const ewa_camera *camera) {
    if (!scene) return EWA_ERROR_ARGUMENT;
    if (camera) EWA_TRY(ewa_camera_check(scene->context, camera));
    scene->has_camera = camera != NULL;
    if (camera) scene->camera = *camera;
    return EWA_OK;
}

bool ewa_scene_get_camera(const ewa_scene *scene, ewa_camera *camera) {
    if (!scene || !scene->has_camera) return false;
    *camera = scene->camera;
    return true;
}

/// Whether options say anything of a camera but its size.
static bool says_where(const ewa_view_options *options) {
    const double *up = options->up_world, *direction = options->direction_world;
    return direction[0] != 0 || direction[1] != 0 || direction[2] != 0 || options->fov_deg > 0 ||
           options->ortho_height_world > 0 || options->view >= 0 || up[0] != 0 || up[1] != 0 || up[2] != 0 ||
           options->has_eye || options->has_target || options->azimuth_deg != 0 || options->elevation_deg != 0;
}

/// Takes the scene's camera at another size: what is seen from the upper edge to the lower one stays.
static void take_own(const ewa_scene *scene, const ewa_view_options *options, ewa_camera *camera) {
    *camera = scene->camera;
    if (!options || !options->width_px || !options->height_px) return;
    ewa_camera_resize(camera, EWA_RESIZE_HEIGHT, options->width_px, options->height_px);
}

ewa_status ewa_scene_place_camera(ewa_scene *scene, const ewa_view_options *options, ewa_camera *camera,
                                  ewa_view_info *info) {
    if (!scene) return EWA_ERROR_ARGUMENT;
    const int asked = axis_of(scene->options.up);
    placement p = {.context = scene->context, .up_axis = asked, .up_asked = asked != 0, .suited_view = view_of_volume(scene)};
    if (!asked) p.up_axis = up_axis_of(scene, &p.up_why);
    ewa_cloud *outline = NULL;
    bool made = false;
    ewa_status status = ewa_scene_complete(scene);
    if (status == EWA_OK && camera && scene->count > 1) status = tell_ups(scene);
    if (status == EWA_OK) status = find_convention(scene, &p.convention);
    if (status == EWA_OK) status = ewa_scene_outline(scene, &outline, &made);
    const bool own = scene->has_camera && !(options && says_where(options));
    if (status == EWA_OK) status = place_at(&p, outline, 1, options, own ? NULL : camera, info);
    if (status == EWA_OK && own && camera) take_own(scene, options, camera);
    if (made) ewa_cloud_destroy(&outline);
    return status;
}
