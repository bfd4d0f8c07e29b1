// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up in a cloud, and from where it is looked at when nobody says: docs/framing.md.
// Based on: H. Fu, D. Cohen-Or, G. Dror, A. Sheffer, "Upright Orientation of Man-Made Objects", 2008 (what
// stands has a base that its weight is over).
#include "framing/upright.h"
#include "base/base.h"
#include "framing/conventions.h"
#include "framing/upright_measure.h"

#include <math.h>
#include <stdio.h>

/// Thickness over size under which points are a drawing in a plane.
static const double PLANE_RATIO = 1e-4;

/// Height over width under which a sheet is ground, and a box lies.
static const double FLAT_RATIO = 0.4;

/// Height over width under which a sheet is ground though its kind of file has another axis up.
static const double RELIEF_RATIO = 0.2;

/// Distance from the origin over size from which coordinates are those of a map.
static const double MAP_RATIO = 100;

/// Share of the places that have something behind or below, under which a surface is one sheet: bodies have
/// 0.4 and more, those that are open below too. Ground has trees and houses, a range image of a room many
/// edges.
static const double SHEET_SHARE = 0.15, BROKEN_SHARE = 0.3;

/// A range image lies within 45 degrees of the axis.
static const double CONE_SLOPE = 1;

/// Share of the numbers of columns or rows in those of the points, under which they are a camera's pixels.
static const double PIXEL_SHARE = 0.1;

/// Height over width, or the other way, under which a picture is a strip.
static const double NARROW_RATIO = 0.05;

/// A base is so much of the footprint at least, and so many times what is lowest along the other axis.
static const double BASE_SHARE = 0.2, BASE_RATIO = 2;

/// What a base has to be to overrule the kind of a file.
static const double UNUSUAL_SHARE = 0.3, SURVEYED_SHARE = 0.5, SURVEYED_RATIO = 10;

/// Feet: so much of a base tells that something stands, and that its flat back is none.
static const double FEET_SHARE = 0.1;

/// So much of a body has its mirror image across an axis along which it is level, and so many times as much across the
/// one that is up.
static const double MIRRORED_SHARE = 0.85, UNMIRRORED_RATIO = 0.85;

/// What has so much of a base along y and along z is a box.
static const double BOX_SHARE = 0.6;

/// So much of what the front shows are insides of surfaces, and of what the back does at most, where the back is the outside.
static const double INSIDE_SHARE = 0.3, OUTSIDE_SHARE = 0.1;

/// So much of a body's front in one plane shows nothing of its form.
static const double FACE_SHARE = 0.6;

/// A survey whose whole front is a plane, and that is at least so deep, in widths, is a box or a room.
static const double SURVEYED_FACE_SHARE = 0.75, ROOM_RATIO = 0.5;

/// What is so many times higher than wide, without a base, lies on its side.
static const double TALL_RATIO = 2;

/// What is so many times deeper than wide, and deepest, is seen at an angle; so much higher than wide is a
/// tower.
static const double DEEP_RATIO = 1.5;

/// Whether the axis of a camera at the origin passes well within the points.
static bool is_aimed_at(const point_cloud_sample *points) {
    bool aimed = true;
    for (int c = 0; c < 2; c++) {
        const double room = 0.1 * points->extent[c], middle = points->middle_world[c];
        aimed = aimed && middle + points->low[c] < -room && middle + points->high[c] > room;
    }
    return aimed;
}

/// A camera's view, if the points are what one at the origin saw along z or -z: all lie before it, and none
/// behind another. Cameras that look along +z have y down. With `pixels_wanted`, told by columns and rows.
static bool choose_camera(const point_cloud_sample *points, bool pixels_wanted, ewa_upright *chosen) {
    for (int sign = 1; sign >= -1; sign -= 2) {
        range_facts facts;
        if (!ewa_measure_range(points, sign, CONE_SLOPE, &facts)) continue;
        const size_t fewest = facts.column_count < facts.row_count ? facts.column_count : facts.row_count;
        const bool pixels = (double)fewest < PIXEL_SHARE * (double)points->count;
        if (pixels_wanted ? !pixels : !is_aimed_at(points)) continue;
        if (facts.layered_share >= (pixels ? BROKEN_SHARE : SHEET_SHARE)) continue;
        // A few rows of a picture show nothing to the eye that took them.
        const bool narrow = facts.narrowness < NARROW_RATIO;
        *chosen = (ewa_upright){.axis = 1,
                                .reversed = sign > 0,
                                .from_origin = !narrow,
                                .view = narrow ? EWA_VIEW_ISO : EWA_VIEW_FRONT,
                                .why = pixels_wanted ? "a range image, by its pixels"
                                                     : "nothing hides behind another from the origin"};
        return true;
    }
    return false;
}

/// Whether a sheet lies flat across an axis that may be up. Across another axis than the usual one of its kind, a sheet is
/// a wall or a relief that stands: only that of an OBJ, which many programs write with z up, may be ground, where it
/// is flatter than reliefs are.
static bool is_ground(const point_cloud_sample *points, int axis, ewa_up_convention convention) {
    const int usual = ewa_up_axis_of(convention);
    if (usual && axis != usual && convention != EWA_UP_Y_USUAL) return false;
    const double ratio = usual && axis != usual ? RELIEF_RATIO : FLAT_RATIO, *e = points->extent;
    return e[axis] < ratio * fmin(e[0], e[3 - axis]) && ewa_measure_layers(points, axis) < BROKEN_SHARE;
}

/// Whether points lie all around the origin, where the instrument stood that took them.
static bool surrounds_origin(const point_cloud_sample *points) {
    bool inside = true;
    for (int c = 0; c < 3; c++) {
        const double room = 0.02 * points->extent[c], middle = points->middle_world[c];
        inside = inside && middle + points->low[c] < -room && middle + points->high[c] > room;
    }
    return inside;
}

/// Share of the footprint that is the base; 0 where the weight is not over it, and for open sheets, which end
/// in a rim. `*lowest`: the share of what is lowest, whatever it is.
static double base_share(const point_cloud_sample *points, int axis, double *lowest) {
    base_facts facts;
    ewa_measure_base(points, axis, &facts);
    *lowest = facts.share;
    return facts.stable && ewa_measure_layers(points, axis) >= SHEET_SHARE ? facts.share : 0;
}

/// Whether a body is its mirror image across the first axis, and not across the second: what stands is so across what is
/// level.
static bool is_mirrored(const point_cloud_sample *points, int across, int not_across) {
    const double mirrored = ewa_measure_mirror(points, across);
    return mirrored >= MIRRORED_SHARE && ewa_measure_mirror(points, not_across) < UNMIRRORED_RATIO * mirrored;
}

/// Which axis is up in a body.
static ewa_upright choose_body(const point_cloud_sample *points, ewa_up_convention convention) {
    const bool any = !ewa_up_axis_of(convention), surveyed = convention == EWA_UP_Z_SURVEYED;
    const int usual = any ? 1 : ewa_up_axis_of(convention), other = 3 - usual;
    double lowest, its_lowest;
    const double own = base_share(points, usual, &lowest), its = base_share(points, other, &its_lowest);
    const double *e = points->extent;
    if (own >= fmax(BASE_SHARE, BASE_RATIO * its))
        return (ewa_upright){.axis = usual, .why = "it stands on a base"};
    // A flank that something flat could lie on is no base where it has feet, or its kind an axis. Plates and rings lie.
    const bool feet = own >= FEET_SHARE && its < BOX_SHARE;
    const bool flank = e[other] < FLAT_RATIO * e[usual] && (!any || feet);
    const double minimum = any ? BASE_SHARE : surveyed ? SURVEYED_SHARE : UNUSUAL_SHARE;
    const double ratio = surveyed ? SURVEYED_RATIO : BASE_RATIO;
    if (its >= fmax(minimum, ratio * lowest) && !flank && !(surveyed && surrounds_origin(points)) &&
        !is_mirrored(points, other, usual))
        return (ewa_upright){.axis = other, .why = "it stands on a base"};
    const bool box = fmin(own, its) >= BOX_SHARE;
    if (box && (any || convention == EWA_UP_Z_USUAL) &&
        fmin(e[1], e[2]) < FLAT_RATIO * fmin(e[0], fmax(e[1], e[2])))
        return (ewa_upright){.axis = e[1] < e[2] ? 1 : 2, .why = "what is flat lies"};
    if (any && e[usual] > TALL_RATIO * fmax(e[0], e[other]) && own < FEET_SHARE)
        return (ewa_upright){.axis = other, .why = "what is long and has no base lies"};
    if (any && is_mirrored(points, usual, other))
        return (ewa_upright){.axis = other, .why = "its halves are alike across y"};
    return (ewa_upright){
        .axis = usual,
        .why = any ? "nothing speaks for another axis" : "files of this kind mostly have it so"};
}

/// From where a body is seen: at an angle, too, if a plane is most of what its front shows, which is of one shade. Walls
/// that were surveyed, but for boxes and rooms, and open sheets are seen face on.
static ewa_named_view body_view(const point_cloud_sample *points, int axis, ewa_up_convention convention) {
    const int depth = 3 - axis; // the front is +z with y up, -y with z up
    const bool surveyed = convention == EWA_UP_Z_SURVEYED;
    const double share = surveyed ? SURVEYED_FACE_SHARE : FACE_SHARE;
    const bool plane = !(surveyed && points->extent[depth] < ROOM_RATIO * points->extent[0]) &&
                       ewa_measure_face(points, depth, axis == 1) >= share && ewa_measure_layers(points, depth) >= SHEET_SHARE;
    return plane ? EWA_VIEW_ISO : ewa_upright_view(points->extent, axis);
}

static ewa_upright choose_axis(const point_cloud_sample *points, ewa_up_convention convention) {
    const double *e = points->extent, *middle = points->middle_world;
    const double size = fmax(e[0], fmax(e[1], e[2]));
    static const ewa_named_view face_on[] = {EWA_VIEW_RIGHT, EWA_VIEW_FRONT, EWA_VIEW_TOP}; // across x, y, z
    ewa_upright chosen = {.axis = ewa_up_axis_of(convention) == 2 ? 2 : 1, .why = "there is one place only"};
    if (!(size > 0)) return chosen;
    if (convention == EWA_UP_Y_REQUIRED)
        return (ewa_upright){.axis = 1, .view = body_view(points, 1, convention), .why = "glTF has y up"};
    const bool map = fmax(fabs(middle[0]), fabs(middle[1])) > MAP_RATIO * size;
    for (int axis = 0; axis < 3; axis++)
        if (e[axis] < PLANE_RATIO * size && fmin(e[(axis + 1) % 3], e[(axis + 2) % 3]) > PLANE_RATIO * size)
            // What a camera draws has y down, and is seen along z.
            return axis == 2 && convention == EWA_UP_CAMERA_USUAL && !map
                       ? (ewa_upright){.axis = 1, .reversed = true, .view = EWA_VIEW_FRONT, .why = "a plane across a camera's axis"}
                       : (ewa_upright){.axis = axis > 0 || ewa_up_axis_of(convention) == 2 ? 2 : 1,
                                       .view = face_on[axis],
                                       .why = "all lies in a plane, which is seen face on"};
    if (choose_camera(points, true, &chosen)) return chosen;
    if (map)
        return (ewa_upright){.axis = 2,
                             .view = e[2] > DEEP_RATIO * fmax(e[0], e[1]) ? EWA_VIEW_FRONT : EWA_VIEW_ISO,
                             .why = "map coordinates"};
    for (int axis = 2; axis >= 1; axis--)
        if (is_ground(points, axis, convention))
            return (ewa_upright){.axis = axis, .view = EWA_VIEW_ISO, .why = "a sheet that lies flat: ground"};
    if (convention != EWA_UP_Z_SURVEYED && choose_camera(points, false, &chosen)) return chosen;
    chosen = choose_body(points, convention);
    chosen.view = body_view(points, chosen.axis, convention);
    return chosen;
}

const char *ewa_upright_place(const ewa_upright *chosen) {
    static const char *const names[] = {"front", "back", "left", "right", "top", "bottom", "iso"};
    return chosen->from_origin ? "the origin" : names[chosen->view];
}

void ewa_upright_describe(const ewa_upright *chosen, char text[EWA_UPRIGHT_TEXT_BYTES]) {
    snprintf(text, EWA_UPRIGHT_TEXT_BYTES, "%s%c (%s), seen from %s", chosen->reversed ? "-" : "",
             "xyz"[chosen->axis], chosen -> why, ewa_upright_place(chosen));
}

ewa_named_view ewa_upright_view(const double extent[3], int axis) {
    const double width = extent[0], depth = extent[3 - axis], height = extent[axis];
    const bool wide = height < FLAT_RATIO * fmin(width, depth);
    const bool deep = depth > DEEP_RATIO * width && depth >= height;
    return wide || deep ? EWA_VIEW_ISO : EWA_VIEW_FRONT;
}

/// Direction from the eye to the middle for a named view with y (1) or z (2) up; `reversed`: with that axis
/// down, turned about x.
static void view_direction(ewa_named_view view, const ewa_upright *upright, double direction[3]) {
    // Written for z up, from the front at -y; y up is the same turned about x. The last is isometric.
    static const double directions[][3] = {{0, 1, 0},  {0, -1, 0}, {1, 0, 0},  {-1, 0, 0},
                                           {0, 0, -1}, {0, 0, 1},  {-1, 1, -1}};
    const double *d = directions[view];
    direction[0] = d[0];
    direction[1] = upright->axis == 2 ? d[1] : d[2];
    direction[2] = upright->axis == 2 ? d[2] : -d[1];
    for (int c = 1; c < 3 && upright->reversed; c++) direction[c] = -direction[c];
}

void ewa_upright_look(const ewa_upright *upright, double direction_world[3], double up_world[3]) {
    view_direction(upright->view, upright, direction_world);
    for (int c = 0; c < 3; c++) up_world[c] = c != upright->axis ? 0 : upright->reversed ? -1 : 1;
    // Seen from above, the back is up in the picture; from below, the front.
    if (upright->view == EWA_VIEW_TOP) view_direction(EWA_VIEW_FRONT, upright, up_world);
    if (upright->view == EWA_VIEW_BOTTOM) view_direction(EWA_VIEW_BACK, upright, up_world);
}

// The direction is seen as that of a camera that looks at the origin.
ewa_status ewa_upright_turn(const double axis_world[3], double azimuth_deg, double elevation_deg,
                            double direction_world[3], double up_world[3]) {
    if (!axis_world || !direction_world || !up_world) return EWA_ERROR_ARGUMENT;
    static const double origin[3] = {0, 0, 0};
    ewa_camera camera;
    ewa_camera_init(&camera);
    EWA_TRY(ewa_camera_look_at(&camera, origin, direction_world, up_world));
    EWA_TRY(ewa_camera_orbit(&camera, origin, axis_world, azimuth_deg));
    const double *m = camera.world_to_camera, right[3] = {m[0], m[1], m[2]};
    EWA_TRY(ewa_camera_orbit(&camera, origin, right, -elevation_deg));
    for (int c = 0; c < 3; c++) {
        up_world[c] = -m[4 + c];
        direction_world[c] = m[8 + c];
    }
    return EWA_OK;
}

void ewa_upright_turn_to_outside(size_t count, const double (*offsets)[3], const float (*normals)[3],
                                 ewa_upright *chosen) {
    if (chosen->view != EWA_VIEW_FRONT || chosen->from_origin || chosen->reversed) return;
    point_cloud_sample points = {.count = count, .offsets = offsets};
    ewa_measure_extent(&points);
    const int depth = 3 - chosen->axis;
    const bool high = chosen->axis == 1; // the front is +z with y up, -y with z up
    // Of a sheet nothing tells whether it is seen from behind or has its normals inside out.
    if (ewa_measure_layers(&points, depth) >= SHEET_SHARE &&
        ewa_measure_inside(&points, normals, depth, high) >= INSIDE_SHARE &&
        ewa_measure_inside(&points, normals, depth, !high) <= OUTSIDE_SHARE)
        chosen->view = EWA_VIEW_BACK;
}

ewa_upright ewa_upright_choose(size_t count, const double (*offsets)[3], const double middle_world[3],
                               ewa_up_convention convention) {
    point_cloud_sample points = {.count = count, .offsets = offsets, .middle_world = middle_world};
    ewa_measure_extent(&points);
    return choose_axis(&points, convention);
}
