// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera and options in the single-precision form that the kernels read.
#include "surface/view.h"
#include "base/base.h"
#include "homogeneous/perspective.h"
#include "surface/contour.h"
#include "surface/points.h"
#include "surface/semantics.h"

#include <math.h>
#include <string.h>

/// Splits the upper left 3x3 of world_to_camera into a rotation, whose rows are the camera's axes, and its
/// scale.
static double split_scale(const ewa_camera *camera, ewa_mat3 *rotation) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const ewa_vec3 row = vec3_load(&camera->world_to_camera[4 * i]);
        sum += vec3_dot(row, row);
        memcpy(rotation->m[i], &camera->world_to_camera[4 * i], sizeof rotation->m[i]);
    }
    const double scale = sqrt(sum / 3);
    *rotation = mat3_scale(rotation, 1 / scale);
    return scale;
}

/// The sides of the view volume in camera space, `margin_px` outside of the picture's edges.
static ewa_status set_sides(ewa_context *context, ewa_view *view, const ewa_camera *camera,
                            double margin_px) {
    const uint32_t margin = (uint32_t)ceil(margin_px);
    ewa_camera wide = *camera;
    wide.width_px += 2 * margin, wide.height_px += 2 * margin;
    wide.cx_px += margin, wide.cy_px += margin;
    for (int i = 0; i < 16; i++) wide.world_to_camera[i] = i % 5 == 0;
    ewa_mat4 map;
    ewa_vec4 planes[6];
    ewa_status status = ewa_camera_clip_map(&wide, 1, 2, &map); // the depths do not matter for the sides
    if (status == EWA_OK) status = ewa_frustum_planes(&map, planes);
    if (status != EWA_OK) return ewa_fail(context, status, "render: the camera has no view volume");
    for (int i = 0; i < 4; i++) {
        view->side_planes[i][0] = (float)planes[i].x;
        view->side_planes[i][1] = (float)planes[i].y;
        view->side_planes[i][2] = (float)planes[i].z;
    }
    return EWA_OK;
}

/// Where the packets are in camera space.
static void set_places(ewa_view *view, const ewa_surfels *surfels, const ewa_camera *camera,
                       const ewa_placement *placement) {
    ewa_mat3 rotation;
    const double scale = split_scale(camera, &rotation);
    view->scale = (float)(scale * surfels->unit / placement->unit);
    for (int i = 0; i < 9; i++) {
        view->rotation[i] = (float)rotation.m[i / 3][i % 3];
        view->linear[i] = placement->linear.m[i / 3][i % 3] * surfels->unit;
    }
    vec3_store(vec3_scale(placement->anchor, 1 / surfels->unit), view->anchor);
    vec3_store(placement->offset, view->offset);
}

/// The power of two that is no less than `size`.
static double power_above(double size) {
    int exponent = 0;
    const double part = frexp(size, &exponent);
    return ldexp(1, part == 0.5 ? exponent - 1 : exponent);
}

/// The largest depth of a source's surfels, in camera space.
static double largest_depth(const ewa_surfels *surfels, const ewa_placement *placement) {
    const ewa_vec3 low = vec3_load(surfels->extent.low_world), high = vec3_load(surfels->extent.high_world);
    const ewa_vec3 middle = vec3_scale(vec3_add(low, high), 0.5);
    const double reach_world = vec3_length(vec3_sub(high, middle)) + surfels->reach_world;
    return fabs(ewa_placement_apply(placement, middle).z) +
           vec3_length(mat3_row(&placement->linear, 2)) * reach_world;
}

/// The largest sigmas of a surfel on the screen, for those that are far from the eye; else infinite.
static double largest_sigma_px(const ewa_surfels *surfels, const ewa_camera *camera,
                               const ewa_placement *placement, double sigma_world) {
    enum { FAR_REACHES = 4 };
    const double scale = vec3_length(mat3_row(&placement->linear, 2)); // camera units per world unit
    const double focal_px = fmax(camera->fx_px, camera->fy_px);
    if (camera->projection == EWA_ORTHOGRAPHIC) return focal_px * placement->unit * scale * sigma_world;
    const ewa_vec3 low = vec3_load(surfels->extent.low_world), high = vec3_load(surfels->extent.high_world);
    const ewa_vec3 middle = vec3_scale(vec3_add(low, high), 0.5), to = ewa_placement_apply(placement, middle);
    const double around = scale * (vec3_length(vec3_sub(high, middle)) + surfels->reach_world);
    const double nearest_z = to.z - around, reach = scale * surfels->reach_world;
    if (!(nearest_z > FAR_REACHES * reach)) return INFINITY;
    // What is seen off the axis is larger on the screen.
    const double slope = (fabs(to.x) + fabs(to.y) + 2 * around) / nearest_z;
    return 2 * (1 + slope * slope) * focal_px * scale * sigma_world / nearest_z;
}

/// How many weights of 1 sums have room for: those of a few surfaces like that of q0.
static double room_for(double unit_coverage) {
    enum { SURFACES = 3 };
    return power_above(fmin(fmax(SURFACES * unit_coverage, 1), EWA_MAX_ROOM));
}

/// Units of sums per weight, a power of two: there is room for room_for(). More where splats are
/// so small that very many make a surface: their terms would be next to nothing, and sums are gathered with
/// care anyway.
static double sum_scale(const ewa_surfels *surfels, const ewa_camera *camera, const ewa_placement *placement,
                        const ewa_render_options *options, double unit_coverage) {
    enum { PLAIN_STEPS = 10, MAX_STEPS = 32 };
    const double room = 1 / room_for(unit_coverage);
    if (options->point_size_px > 0 || !(options->prefilter_px > 0) || !surfels->extent.finite_count)
        return EWA_SUM_UNITS * room;
    // sqrt(|V| / |V'|) is at most the product of both axes over what the prefilter makes of them.
    double share = 1;
    for (int i = 0; i < 2; i++) {
        const double sigma_px =
            largest_sigma_px(surfels, camera, placement, surfels->largest_sigmas_world[i]);
        share *= fmin(1, sigma_px / options->prefilter_px);
    }
    int exponent = 0;
    frexp(share, &exponent); // share < 2^exponent
    const int steps = -exponent - PLAIN_STEPS;
    return ldexp(EWA_SUM_UNITS * room, steps < 0 ? 0 : steps > MAX_STEPS ? MAX_STEPS : steps);
}

/// q0 of the splats that are drawn.
static double unit_coverage_of(const ewa_surfels *surfels, const ewa_render_options *options) {
    return options->point_size_px > 0 ? ewa_point_profile_make(options).unit_coverage
                                      : surfels->unit_coverage;
}

/// Where the camera is before a source, in camera space of its own unit.
static ewa_placement place(const ewa_surfels *surfels, const ewa_camera *camera) {
    return ewa_placement_make(camera, surfels->origin_world, &surfels->extent, surfels->unit);
}

/// The same in a unit, a power of two, that is no smaller.
static ewa_placement place_in(const ewa_surfels *surfels, const ewa_camera *camera, double unit) {
    ewa_placement placement = place(surfels, camera);
    const double part = placement.unit / unit;
    placement.linear = mat3_scale(&placement.linear, part);
    placement.offset = vec3_scale(placement.offset, part);
    placement.unit = unit;
    return placement;
}

ewa_scales ewa_scales_make(const ewa_frame_source *sources, uint32_t source_count, const ewa_camera *camera,
                           const ewa_render_options *options) {
    ewa_scales made = {.cutoff = 1, .unit = 1, .unit_coverage = 1, .sum = 1, .depth = 1, .largest_color = 1};
    if (!source_count) return made;
    const ewa_surfels *const first = sources[0].surfels;
    made.cutoff = first->cutoff;
    made.unit = made.largest_color = 0;
    made.unit_coverage = made.sum = INFINITY;
    bool alike = true;
    for (uint32_t i = 0; i < source_count; i++) {
        const ewa_surfels *const surfels = sources[i].surfels;
        made.unit = fmax(made.unit, place(surfels, camera).unit);
        made.unit_coverage = fmin(made.unit_coverage, unit_coverage_of(surfels, options));
        made.largest_color = fmax(made.largest_color, surfels->largest_color);
        alike &= surfels->largest_color == first->largest_color;
        made.fine_colors |= surfels->fine_colors;
        made.opacities |= surfels->opacities || surfels->with_opacities;
    }
    made.transparent = (options->opacity < 1 || made.opacities) && options->layers != 1 && options->passes == 3;
    made.fine_colors |= !alike && made.largest_color > EWA_PLAIN_COLORS;
    double largest = 0;
    for (uint32_t i = 0; i < source_count; i++) {
        const ewa_surfels *const surfels = sources[i].surfels;
        const ewa_placement placement = place_in(surfels, camera, made.unit);
        made.sum = fmin(made.sum, sum_scale(surfels, camera, &placement, options, made.unit_coverage));
        if (surfels->extent.finite_count) largest = fmax(largest, largest_depth(surfels, &placement));
    }
    if (largest > 0) made.depth = power_above(largest);
    made.terms_per_carry = EWA_TERMS_PER_CARRY * (uint32_t)room_for(made.unit_coverage);
    return made;
}

double ewa_scales_nearest(const ewa_scales *scales, const ewa_surfels *surfels, const ewa_camera *camera) {
    const ewa_placement placement = place_in(surfels, camera, scales->unit);
    const ewa_vec3 low = vec3_load(surfels->extent.low_world), high = vec3_load(surfels->extent.high_world);
    const ewa_vec3 middle = vec3_scale(vec3_add(low, high), 0.5);
    const double around = vec3_length(mat3_row(&placement.linear, 2)) * vec3_length(vec3_sub(high, middle));
    return ewa_placement_apply(&placement, middle).z - around;
}

/// The section planes as the packets' centres see them.
static void set_sections(ewa_view *view, const ewa_surfels *surfels, const ewa_render_options *options) {
    view->section_count = options->section_count;
    view->section_reach = options->section_count && options->point_size_px == 0 ? (float)surfels->cutoff : 0;
    for (uint32_t k = 0; k < options->section_count; k++) {
        ewa_placement_plane(options->section_planes[k], surfels->origin_world, view->sections[k]);
        view->sections[k][3] /= surfels->unit;
    }
}

/// What is a source's own.
static void set_source(ewa_view *view, const ewa_frame_source *source, const ewa_camera *camera,
                       const ewa_render_options *options, const ewa_scales *scales) {
    const ewa_surfels *const surfels = source->surfels;
    const ewa_placement placement = place_in(surfels, camera, scales->unit);
    set_places(view, surfels, camera, &placement);
    set_sections(view, surfels, options);
    view->ellipses = surfels->ellipses && options->point_size_px == 0;
    const double part = source->weight * (scales->unit_coverage / unit_coverage_of(surfels, options));
    view->sum_scale = (float)(scales->sum * part);
    view->color_scale = (float)(scales->sum * part / scales->largest_color);
}

ewa_status ewa_view_set(ewa_context *context, ewa_view *view, const ewa_frame_source *source,
                        const ewa_camera *camera, const ewa_render_options *options, const ewa_scales *scales,
                        uint32_t tile_px) {
    memset(view, 0, sizeof *view);
    view->orthographic = camera->projection == EWA_ORTHOGRAPHIC;
    if (source) set_source(view, source, camera, options, scales);
    const double per_unit = view->orthographic ? scales->unit : 1; // of orthographic focal lengths
    view->focal_px[0] = camera->fx_px * per_unit, view->focal_px[1] = camera->fy_px * per_unit;
    view->principal_px[0] = camera->cx_px, view->principal_px[1] = camera->cy_px;
    view->fx_px = (float)view->focal_px[0], view->fy_px = (float)view->focal_px[1];
    view->cx_px = (float)camera->cx_px, view->cy_px = (float)camera->cy_px;
    double cutoff = scales->cutoff, reach_px = cutoff * options->prefilter_px;
    if (options->point_size_px > 0) {
        const ewa_point_profile profile = ewa_point_profile_make(options);
        cutoff = profile.cutoff;
        reach_px = cutoff * profile.sigma_px;
        view->point_sigma_px = (float)profile.sigma_px;
    }
    const double larger_px = fmax(view->focal_px[0], view->focal_px[1]);
    const double zoom = ldexp(1, ilogb(larger_px));
    view->zoom = (float)zoom;
    view->fx_zoomed = (float)(view->focal_px[0] / zoom), view->fy_zoomed = (float)(view->focal_px[1] / zoom);
    view->broad = (float)(view->orthographic ? EWA_BROAD_PX / larger_px : larger_px / EWA_BROAD_PX);
    view->cutoff = (float)cutoff, view->cutoff2 = (float)(cutoff * cutoff);
    view->prefilter2_px2 = (float)(options->prefilter_px * options->prefilter_px);
    view->reach_px = (float)reach_px;
    // With one pass the nearest splat wins: no tolerance.
    view->tolerance = options->passes == 1 ? 0 : (float)(options->tolerance * cutoff);
    view->grazing = options->passes == 1 ? 0 : 1;
    // Halve r^2 / 2 until F^2 / 2 is in the range of the exponential's polynomial.
    view->doublings = 2;
    double exponent_scale = 0.125;
    while (exponent_scale * cutoff * cutoff > EWA_EXPONENT_END) exponent_scale *= 0.5, view->doublings++;
    view->exponent_scale = (float)exponent_scale;
    view->exponent_end = (float)(exponent_scale * cutoff * cutoff);
    view->width_px = camera->width_px, view->height_px = camera->height_px;
    view->tile_px = tile_px;
    view->affine = options->kernel != EWA_KERNEL_PERSPECTIVE;
    view->source = options->kernel == EWA_KERNEL_SOURCE;
    view->circular = options->kernel == EWA_KERNEL_CIRCULAR;
    view->raycast = options->kernel == EWA_KERNEL_RAYCAST && !view->orthographic;
    view->cull_back = options->cull == EWA_CULL_BACK;
    view->depth_scale = (float)(1 / scales->depth);
    const double shift = ewa_contour_shift(options, view->orthographic);
    view->contour_shift = source && source->surfels->curvatures ? (float)shift : 0;
    view->transparent = scales->transparent;
    view->contour_sine2 = (float)ewa_contour_sine2(cutoff, shift);
    view->margin_px = (float)(reach_px + (double)view->contour_shift * options->prefilter_px + 1);
    view->curvature_scale =
        view->scale > 0 ? (float)fmin(2 / ((double)view->fx_px * (double)view->scale), 1e30) : 0;
    return view->orthographic ? EWA_OK : set_sides(context, view, camera, (double)view->margin_px);
}

void ewa_material_numbers(const ewa_material *material, float numbers[EWA_MATERIAL_CHANNELS]) {
    numbers[0] = material->ambient, numbers[1] = material->diffuse, numbers[2] = material->specular;
    numbers[3] = material->shininess, numbers[4] = material->reflection;
}

static void store_matrix(const ewa_mat3 *from, float to[9]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) to[3 * i + j] = (float)from->m[i][j];
}

/// Lights, the one material and the environment; `rotation` is camera from world.
static void set_shading(ewa_resolve *resolve, uint8_t material, const ewa_render_options *options,
                        const ewa_shading_setup *shading, const ewa_mat3 *rotation) {
    bool plain = shading->light_count == 1;
    resolve->light_count = shading->light_count;
    for (uint32_t i = 0; i < shading->light_count; i++) {
        const ewa_shading_light *from = &shading->lights[i];
        ewa_kernel_light *to = &resolve->lights[i];
        to->headlight = from->headlight;
        const ewa_vec3 toward = from->headlight
                                    ? vec3_make(0, 0, -1) // against the orthographic view direction
                                    : mat3_mul_vec3(rotation, from->toward_world);
        to->toward[0] = (float)toward.x, to->toward[1] = (float)toward.y, to->toward[2] = (float)toward.z;
        for (int c = 0; c < 3; c++) {
            to->color[c] = (float)from->color[c];
            plain &= from->color[c] == 1;
        }
    }
    ewa_material_numbers(&shading->materials[shading->has_table ? material : 0], resolve->material);
    resolve->shading = !shading->lit         ? EWA_PIPELINE_UNSHADED
                       : shading->highlights ? EWA_PIPELINE_PHONG
                       : plain               ? EWA_PIPELINE_LAMBERT
                                             : EWA_PIPELINE_LIGHTS;
    resolve->environment = options->environment;
    const ewa_mat3 world = mat3_transpose(rotation);
    const ewa_mat3 turn = mat3_multiply(&shading->environment_from_world, &world);
    store_matrix(&turn, resolve->environment_from_camera);
    store_matrix(&world, resolve->to_world);
}

void ewa_resolve_set(ewa_resolve *resolve, uint8_t material, const ewa_camera *camera,
                     const ewa_render_options *options, const ewa_scales *scales,
                     const ewa_shading_setup *shading, const ewa_frame *frame) {
    ewa_mat3 rotation;
    memset(resolve, 0, sizeof *resolve);
    split_scale(camera, &rotation);
    const double unit_coverage = scales->unit_coverage * scales->sum; // in units of sums
    resolve->unit_coverage_inverse = (float)(1 / unit_coverage);
    resolve->alpha_scale = (float)(1 / (options->edge_threshold * unit_coverage));
    resolve->covering = (float)(options->edge_threshold * unit_coverage);
    resolve->front_scale = (float)(1 / (EWA_FRONT * unit_coverage));
    resolve->color_unit = (float)scales->largest_color;
    resolve->opacity = (float)options->opacity;
    resolve->one_pass = options->passes == 1;
    resolve->edge_antialiasing = options->edge_antialiasing && !resolve->one_pass;
    resolve->orthographic = camera->projection == EWA_ORTHOGRAPHIC;
    set_shading(resolve, material, options, shading, &rotation);
    for (int i = 0; i < 3; i++) resolve->background[i] = options->background[i] * options->background[3];
    resolve->background[3] = options->background[3];
    resolve->ray_x[0] = (float)(1 / camera->fx_px),
    resolve->ray_x[1] = (float)(-camera->cx_px / camera->fx_px);
    resolve->ray_y[0] = (float)(1 / camera->fy_px),
    resolve->ray_y[1] = (float)(-camera->cy_px / camera->fy_px);
    resolve->width_px = camera->width_px;
    resolve->depth_unit = (float)scales->unit;
    resolve->rgba8 = frame->rgba8;
    resolve->rgba = frame->rgba;
    resolve->depth = frame->depth;
    resolve->normal = frame->normal;
    resolve->coverage = frame->coverage;
}

/// Camera-space direction of a local vector, times `scale`.
static ewa_vec3 turn(const ewa_view *view, ewa_vec3 v, double scale) {
    double out[3];
    for (int i = 0; i < 3; i++) {
        const float *row = &view->rotation[3 * i];
        out[i] = scale * ((double)row[0] * v.x + (double)row[1] * v.y + (double)row[2] * v.z);
    }
    return vec3_load(out);
}

/// Sets `terms` to the linear function of pixels of the field that a vector's product with pixel rays (x, y,
/// 1) is.
static void set_linear(float terms[3], ewa_vec3 n, const ewa_view *view, const ewa_tile *tile) {
    const double fx = view->focal_px[0], fy = view->focal_px[1];
    const double left_px = tile->x_px - (double)tile->field_x_px,
                 top_px = tile->y_px - (double)tile->field_y_px;
    const double x = (left_px - view->principal_px[0]) / fx, y = (top_px - view->principal_px[1]) / fy;
    terms[0] = (float)(n.x * x + n.y * y + n.z);
    terms[1] = (float)(n.x / fx);
    terms[2] = (float)(n.y / fy);
}

/// The clip lines of a surfel that has some.
static const ewa_surfel_clip *find_clip(const ewa_surfels *surfels, uint32_t surfel) {
    const uint32_t packet = surfel / EWA_PACKET_LANES, lane = surfel % EWA_PACKET_LANES;
    const uint32_t before = surfels->clip_masks[packet] & ((1u << lane) - 1);
    return &surfels->clips[surfels->clip_first[packet] + (uint32_t)__builtin_popcount(before)];
}

/// A line of the surfel's plane, keep g.(q - p) + d >= 0, on the screen. With q = z x on the ray x and z =
/// n.p / n.x this is, divided by z > 0, x.(g - (g.p - d) / n.p n): docs/math.md section 5, M^-1 l without the
/// frame. Orthographic: z = pz - ((x - px) nx + (y - py) ny) / nz is linear itself.
static void set_clip_line(ewa_clip_line *line, ewa_vec3 g, double d, ewa_vec3 n, ewa_vec3 p,
                          const ewa_view *view, const ewa_tile *tile) {
    float terms[3];
    if (view->orthographic) {
        const double nz = copysign(fmax(fabs(n.z), EWA_EDGE_ON), n.z);
        const double a = g.x - g.z * n.x / nz, b = g.y - g.z * n.y / nz;
        set_linear(terms, vec3_make(a, b, d - a * p.x - b * p.y), view, tile);
    } else {
        const double np = vec3_dot(n, p), minimum = EWA_EDGE_ON * vec3_length(p);
        const double share = (vec3_dot(g, p) - d) / copysign(fmax(fabs(np), minimum), np);
        set_linear(terms, vec3_sub(g, vec3_scale(n, share)), view, tile);
    }
    // In pixels from the line; a line at infinity has only sides.
    const float length = sqrtf(terms[1] * terms[1] + terms[2] * terms[2]);
    if (!(length > 0 && isfinite(1 / length))) {
        *line = (ewa_clip_line){.offset = terms[0] < 0 ? -1 : 1};
        return;
    }
    const float x = terms[1] / length, y = terms[2] / length;
    const float wide = fmaxf(fabsf(x), fabsf(y)), narrow = fminf(fabsf(x), fabsf(y));
    *line = (ewa_clip_line){.x_inward = x,
                            .y_inward = y,
                            .offset = terms[0] / length,
                            .reach = (wide + narrow) / 2,
                            .narrow = narrow,
                            .per_narrow = narrow > 0 ? 1 / narrow : 0,
                            .per_widths = 1 / (2 * wide)};
}

/// A surfel in camera space.
typedef struct placed_surfel {
    ewa_packet_surfel coded;
    ewa_vec3 p, u, v, n;
} placed_surfel;

/// Lays a circle parallel to the picture.
static void face_picture(placed_surfel *placed, const ewa_view *view) {
    const double sigma = vec3_length(placed->u);
    placed->u = vec3_make(sigma, 0, 0), placed->v = vec3_make(0, sigma, 0), placed->n = vec3_make(0, 0, -1);
    const float *row = &view->rotation[6];
    placed->coded.normal = vec3_make(-(double)row[0], -(double)row[1], -(double)row[2]);
}

static placed_surfel place_surfel(const ewa_surfels *surfels, uint32_t surfel, const ewa_view *view) {
    const uint32_t packet = surfel / EWA_PACKET_LANES;
    const double scale = (double)view->scale;
    placed_surfel placed;
    ewa_packet_decode(surfels, packet, surfel % EWA_PACKET_LANES, &placed.coded);
    const ewa_vec3 way = vec3_sub(ewa_packet_center(surfels, packet), vec3_load(view->anchor));
    double center[3];
    for (int i = 0; i < 3; i++) center[i] = vec3_dot(vec3_load(&view->linear[3 * i]), way) + view->offset[i];
    placed.p = vec3_add(vec3_load(center), turn(view, placed.coded.offset, scale));
    placed.u = turn(view, placed.coded.axis_u, scale);
    placed.v = turn(view, placed.coded.axis_v, scale);
    placed.n = turn(view, placed.coded.normal, 1);
    if (placed.coded.billboard) face_picture(&placed, view);
    return placed;
}

/// A clip line that a section plane makes: keep toward.(q - center) + distance >= 0.
typedef struct section_line {
    ewa_vec3 toward;
    double distance;
} section_line;

/// Lists the lines of the section planes that cut a surfel, the smallest distance first; returns how many.
static uint32_t find_section_lines(const ewa_surfels *surfels, uint32_t surfel, const placed_surfel *placed,
                                   const ewa_view *view, section_line lines[EWA_MAX_SECTION_PLANES]) {
    const ewa_packet_surfel *s = &placed->coded;
    const ewa_vec3 packet = ewa_packet_center(surfels, surfel / EWA_PACKET_LANES);
    const double support = (double)view->section_reach * vec3_length(s->axis_u);
    uint32_t count = 0;
    for (uint32_t k = 0; k < view->section_count; k++) {
        const ewa_vec3 n = vec3_load(view->sections[k]);
        const double distance = vec3_dot(n, packet) + view->sections[k][3] + vec3_dot(n, s->offset);
        const double along = vec3_dot(n, s->normal);
        if (!(distance < support * sqrt(fmax(1 - along * along, 0)))) continue;
        uint32_t at = count++;
        for (; at > 0 && lines[at - 1].distance > distance; at--) lines[at] = lines[at - 1];
        lines[at] = (section_line){n, distance};
    }
    return count;
}

/// Sets the lines that the surfel has of its own.
static void set_own_lines(ewa_clip *clip, const ewa_surfels *surfels, uint32_t surfel,
                          const placed_surfel *placed, const ewa_view *view, const ewa_tile *tile) {
    const ewa_surfel_clip *from = find_clip(surfels, surfel);
    clip->either = from->either;
    for (int k = 0; k < 2; k++) {
        const float *g = from->toward[k];
        if (g[0] == 0 && g[1] == 0 && g[2] == 0) continue;
        const ewa_vec3 toward = vec3_make((double)g[0], (double)g[1], (double)g[2]);
        set_clip_line(&clip->line[clip->count++], turn(view, toward, 1),
                      (double)view->scale * (double)from->offset[k], placed->n, placed->p, view, tile);
    }
}

/// Sets the clip lines of a surfel; returns whether it has some.
static bool set_clip(ewa_clip *clip, const ewa_surfels *surfels, uint32_t surfel, const placed_surfel *placed,
                     const ewa_view *view, const ewa_tile *tile) {
    const uint32_t packet = surfel / EWA_PACKET_LANES, lane = surfel % EWA_PACKET_LANES;
    clip->count = 0;
    clip->either = false;
    if (surfels->clip_masks && surfels->clip_masks[packet] >> lane & 1)
        set_own_lines(clip, surfels, surfel, placed, view, tile);
    section_line lines[EWA_MAX_SECTION_PLANES];
    const uint32_t line_count = find_section_lines(surfels, surfel, placed, view, lines);
    for (uint32_t k = 0; k < line_count && clip->count < EWA_CLIP_LINES; k++)
        set_clip_line(&clip->line[clip->count++], turn(view, lines[k].toward, 1),
                      (double)view->scale * lines[k].distance, placed->n, placed->p, view, tile);
    const bool some = clip->count > 0;
    while (clip->count < 2) clip->line[clip->count++] = (ewa_clip_line){.offset = 1};
    return some;
}

void ewa_clip_set(ewa_clip *clip, const ewa_surfels *surfels, uint32_t surfel, const ewa_view *view,
                  const ewa_tile *tile) {
    const placed_surfel placed = place_surfel(surfels, surfel, view);
    set_clip(clip, surfels, surfel, &placed, view, tile);
}

/// U, V, W and Z of a surfel (ewa_near_record); returns what z changes per pixel at the centre.
static double set_rays(ewa_near_record *record, const placed_surfel *s, const ewa_view *view,
                       const ewa_tile *tile) {
    const ewa_vec3 u = s->u, v = s->v, n = s->n, p = s->p;
    const double fx = view->focal_px[0], fy = view->focal_px[1];
    if (view->orthographic) {
        // With (x, y) on the plane, z = pz - ((x - px) nx + (y - py) ny) / nz and u = (q - p).tu / tu.tu.
        const double a = -n.x / n.z, b = -n.y / n.z;
        const ewa_vec3 axes[2] = {vec3_scale(u, 1 / vec3_dot(u, u)), vec3_scale(v, 1 / vec3_dot(v, v))};
        float *const terms[2] = {record->u, record->v};
        for (int i = 0; i < 2; i++) {
            const double x = axes[i].x + axes[i].z * a, y = axes[i].y + axes[i].z * b;
            set_linear(terms[i], vec3_make(x, y, -x * p.x - y * p.y), view, tile);
        }
        set_linear(record->w, vec3_make(0, 0, 1), view, tile);
        set_linear(record->z, vec3_make(a, b, p.z - a * p.x - b * p.y), view, tile);
        return hypot(a / fx, b / fy);
    }
    // (u, v, 1) M = z x with the rows tu, tv, p of M (PAS equation 4), so (u, v, 1) ~ x adj(M) and z = |M| /
    // W.
    // Divided by |tu x tv|, W is n itself and |M| is n.p, whatever the unit of length.
    const ewa_mat3 m = mat3_from_rows(u, v, p), adjugate = mat3_adjugate(&m);
    const ewa_mat3 inverse = mat3_scale(&adjugate, 1 / vec3_length(vec3_cross(u, v)));
    set_linear(record->u, mat3_column(&inverse, 0), view, tile);
    set_linear(record->v, mat3_column(&inverse, 1), view, tile);
    set_linear(record->w, mat3_column(&inverse, 2), view, tile);
    record->z[0] = (float)vec3_dot(mat3_column(&inverse, 2), p);
    record->z[1] = record->z[2] = 0;
    const double plane = vec3_dot(n, p), slope_x = n.x / plane / fx, slope_y = n.y / plane / fy;
    return sqrt(slope_x * slope_x + slope_y * slope_y) * p.z * p.z;
}

bool ewa_near_record_set(ewa_near_record *record, const ewa_surfels *surfels, uint32_t surfel,
                         const ewa_view *view, const ewa_tile *tile) {
    const placed_surfel s = place_surfel(surfels, surfel, view);
    const double facing = view->orthographic ? s.n.z : vec3_dot(s.n, s.p);
    if (fabs(facing) < EWA_EDGE_ON * (view->orthographic ? 1 : vec3_length(s.p))) return false;
    if (view->cull_back && facing >= 0) return false;
    const double per_px = set_rays(record, &s, view, tile);
    const double range = surfels->cutoff * sqrt(s.u.z * s.u.z + s.v.z * s.v.z);
    record->depth_low = (float)(s.p.z - range);
    record->depth_high = (float)(s.p.z + range);
    const double sigma = vec3_length(s.u);
    const double grazing =
        fmin((double)view->reach_px * per_px, EWA_GRAZING_TOLERANCE * surfels->cutoff * sigma);
    record->tolerance = (float)((double)view->tolerance * sigma + (double)view->grazing * grazing);
    const ewa_vec3 toward = vec3_scale(s.n, facing > 0 ? -1 : 1); // normals face the viewer
    const double normal[3] = {toward.x, toward.y, toward.z},
                 opacity = tile->with_opacity ? s.coded.opacity : 1;
    for (int i = 0; i < 3; i++) {
        record->color[i] =
            (float)(s.coded.color[i] * opacity * (double)view->color_scale / (double)view->sum_scale);
        record->normal[i] = (float)normal[i];
    }
    record->opacity = (float)opacity;
    record->is_back = facing > 0;
    if (tile->with_materials)
        memcpy(record->material,
               view->materials[surfels->materials ? surfels->materials[surfel] : surfels->material],
               sizeof record->material);
    else
        memset(record->material, 0, sizeof record->material);
    record->surfel = surfel;
    record->clipped = set_clip(&record->clip, surfels, surfel, &s, view, tile);
    return true;
}
