// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The projection of one surfel, written to be read beside docs/math.md.
// Based on: M. Zwicker, J. Rasanen, M. Botsch, C. Dachsbacher, M. Pauly, "Perspective Accurate Splatting",
// 2004, section 4, by way of the dual conic (docs/math.md section 3); M. Zwicker, H. Pfister, J. van Baar, M.
// Gross, "Surface Splatting", 2001, sections 3 and 4 (affine kernel, visibility).
#include "reference/splat.h"
#include "math/ellipse.h"
#include "math/gaussian.h"
#include "reference/contour.h"
#include "surface/points.h"
#include "surface/semantics.h"

#include <string.h>

static const double TWO_PI = 6.283185307179586;

/// v A': a direction from world to camera space.
static ewa_vec3 to_camera(const ewa_reference_view *view, ewa_vec3 v) {
    return mat3_mul_vec3(&view->placement.linear, v);
}

/// Takes the section planes to where points are measured from.
static void place_sections(const double origin_world[3], ewa_reference_view *view) {
    for (uint32_t k = 0; k < view->section_count; k++)
        ewa_placement_plane(view->sections_world[k], origin_world, view->sections[k]);
}

void ewa_reference_view_make(const ewa_camera *camera, double cutoff, const ewa_render_options *options,
                             ewa_reference_view *view) {
    *view = (ewa_reference_view){
        .orthographic = camera->projection == EWA_ORTHOGRAPHIC,
        .width_px = (int32_t)camera->width_px,
        .height_px = (int32_t)camera->height_px,
        .fx_px = camera->fx_px,
        .fy_px = camera->fy_px,
        .cx_px = camera->cx_px,
        .cy_px = camera->cy_px,
        .kernel = options->kernel,
        .cull = options->cull,
        .cutoff = cutoff,
        .prefilter_px = options->prefilter_px,
        .tolerance = options->tolerance,
        .section_count = options->section_count,
    };
    memcpy(view->sections_world, options->section_planes, sizeof view->sections_world);
    if (options->point_size_px > 0) {
        const ewa_point_profile profile = ewa_point_profile_make(options);
        view->cutoff = profile.cutoff;
        view->point_sigma_px = profile.sigma_px;
    }
    for (int corner = 0; corner < 4; corner++) {
        const ewa_vec3 ray =
            ewa_reference_ray(view, corner & 1 ? view->width_px : 0, corner & 2 ? view->height_px : 0);
        view->farthest_slope = fmax(view->farthest_slope, vec3_length(ray));
    }
    const double origin_world[3] = {0, 0, 0};
    view->placement = ewa_placement_make(camera, origin_world, NULL, 0);
    place_sections(origin_world, view);
}

void ewa_reference_view_place(const ewa_camera *camera, const double origin_world[3], const ewa_bounds *box,
                              ewa_reference_view *view) {
    view->placement = ewa_placement_make(camera, origin_world, box, 0);
    place_sections(origin_world, view);
    if (!view->orthographic) return;
    view->fx_px = camera->fx_px * view->placement.unit;
    view->fy_px = camera->fy_px * view->placement.unit;
}

ewa_vec3 ewa_reference_ray(const ewa_reference_view *view, double x_px, double y_px) {
    if (view->orthographic) return vec3_make(0, 0, 1);
    return vec3_make((x_px - view->cx_px) / view->fx_px, (y_px - view->cy_px) / view->fy_px, 1);
}

/// Pixels whose centres lie in [low, high], within [0, size).
static void pixel_range(double low, double high, int32_t size, int32_t *begin, int32_t *end) {
    // The centre of pixel i is i + 1/2.
    const double first = ceil(low - 0.5), last = floor(high - 0.5);
    *begin = first > 0 ? (first < size ? (int32_t)first : size) : 0;
    *end = last < size - 1 ? (last < 0 ? 0 : (int32_t)last + 1) : size;
}

static void set_box(const ewa_reference_view *view, double x_low, double x_high, double y_low, double y_high,
                    ewa_reference_splat *splat) {
    pixel_range(x_low, x_high, view->width_px, &splat->x_begin, &splat->x_end);
    pixel_range(y_low, y_high, view->height_px, &splat->y_begin, &splat->y_end);
}

/// Whether the kernel is evaluated in the surfel's plane.
static bool by_backward_mapping(const ewa_reference_view *view) {
    return view->kernel == EWA_KERNEL_SOURCE || (view->kernel == EWA_KERNEL_RAYCAST && !view->orthographic);
}

/// The map from the picture back to the surfel's plane. Source: the inverse of (u, v) J, from the
/// centre. Raycast: of x M ~ the ray, with M = [tu; tv; p] (PAS equation 4), scaled so that w =
/// pz / z. Returns false where it has none to speak of. `root` is sqrt|V|.
static bool make_backward_map(const ewa_reference_view *view, double jacobian[2][2], double root,
                              ewa_reference_splat *splat) {
    const ewa_vec3 p = splat->center;
    if (view->kernel == EWA_KERNEL_RAYCAST) {
        if (fabs(vec3_dot(splat->normal, p)) < EWA_EDGE_ON * vec3_length(p)) return false;
        const ewa_mat3 map = mat3_from_rows(splat->axis_u, splat->axis_v, p), adjugate = mat3_adjugate(&map);
        splat->plane_from_ray =
            mat3_scale(&adjugate, p.z / vec3_dot(vec3_cross(splat->axis_u, splat->axis_v), p));
        return true;
    }
    const double minimum = EWA_SINGULAR * splat->variance_px2[0] * splat->variance_px2[2];
    if (!(root >= EWA_MIN_AREA && root * root >= minimum)) return false;
    const ewa_mat3 forward = {
        {{jacobian[0][0], jacobian[0][1], 0}, {jacobian[1][0], jacobian[1][1], 0}, {0, 0, 1}}};
    const ewa_mat3 adjugate = mat3_adjugate(&forward);
    splat->plane_from_ray = mat3_scale(&adjugate, 1 / adjugate.m[2][2]); // the cofactor of the 1 is |J|
    return true;
}

/// The resampling kernel (docs/math.md sections 4 and 9) of a splat with its centre and V set, and its box.
/// `root` is sqrt|V|. Returns whether there is one.
static bool filter_ellipse(const ewa_reference_view *view, double jacobian[2][2], double root,
                           ewa_reference_splat *splat) {
    const double F = view->cutoff, h2 = view->prefilter_px * view->prefilter_px, z = splat->center.z;
    const double *variance = splat->variance_px2, *center = splat->center_px;
    // V' = V + h^2 I (docs/math.md section 4); its determinant by a sum of positive terms.
    double determinant = root * root + h2 * (variance[0] + variance[2]) + h2 * h2;
    // Without a prefilter a splat from the edge is a line of no area.
    if (!(determinant > EWA_FLAT * (variance[0] + h2) * (variance[2] + h2))) return false;
    if (!(root >= EWA_MIN_SPLAT)) return false;
    double filtered[3] = {variance[0] + h2, variance[1], variance[2] + h2}; // V'
    if (view->kernel == EWA_KERNEL_CIRCULAR) {
        const double mean = (filtered[0] + filtered[2]) / 2, difference = (filtered[0] - filtered[2]) / 2;
        filtered[0] = filtered[2] = mean + hypot(difference, filtered[1]); // the larger eigenvalue
        filtered[1] = 0;
        determinant = filtered[0] * filtered[0];
        const double radius = F * fmax(vec3_length(splat->axis_u), vec3_length(splat->axis_v));
        const double reach = fmin(F * sqrt(filtered[0]) * hypot(splat->plane[0], splat->plane[1]),
                                  EWA_GRAZING_TOLERANCE * radius / (view->orthographic ? 1 : z * z));
        splat->key_low -= reach;
        splat->key_high += reach;
        if (!view->orthographic) splat->key_low = fmax(splat->key_low, EWA_MIN_KEY / z);
    }
    splat->inverse[0] = filtered[2] / determinant;
    splat->inverse[1] = -filtered[1] / determinant;
    splat->inverse[2] = filtered[0] / determinant;
    splat->peak = root / sqrt(determinant) / TWO_PI;
    double half_width = F * sqrt(filtered[0]), half_height = F * sqrt(filtered[2]);
    if (by_backward_mapping(view)) {
        if (!make_backward_map(view, jacobian, root, splat)) return false;
        if (view->kernel == EWA_KERNEL_RAYCAST) {
            const double larger = z / (z - splat->half_range); // w where the disc is nearest
            half_width = F * sqrt(larger * larger * variance[0] + h2);
            half_height = F * sqrt(larger * larger * variance[2] + h2);
        }
    }
    set_box(view, center[0] - half_width, center[0] + half_width, center[1] - half_height,
            center[1] + half_height, splat);
    return true;
}

/// The ellipse of a surfel at a distance (docs/math.md section 3).
///
/// The dual conic of the support's rim is D = F^2 Sigma - p'p. A shear G of the rays, x -= (px/pz) z, y -=
/// (py/pz) z, lays p onto the z axis and moves the picture's origin to the projected centre x0; with it
///     G D G' = F^2 Sigma' - pz^2 e3'e3,    Sigma' = sum of t't over the sheared axes t,
/// whose entries other than D33 do not contain p and so do not cancel. Relative to x0, in pixels,
///     c = F^2 (Sigma'13, Sigma'23) / D33,  S = c'c - F^2 Sigma'[1:2, 1:2] / D33,  V = S / F^2,
/// and, because det D = -F^4 det(M)^2 for M = [tu; tv; p] (PAS eq. 4),
///     |V| = det(M)^2 / |D33|^3,
/// exact even where the splat is a line. The Jacobian at the centre (affine kernel) has the rows t_xy / pz:
/// the same with D33 = -pz^2, c = 0, what is left for F -> 0. Orthographic cameras project t by dropping z.
static bool make_ellipse(const ewa_reference_view *view, ewa_reference_splat *splat) {
    const ewa_vec3 p = splat->center;
    const double x0 = view->orthographic ? 0 : p.x / p.z, y0 = view->orthographic ? 0 : p.y / p.z;
    const ewa_vec3 axes[2] = {splat->axis_u, splat->axis_v};
    double s11 = 0, s12 = 0, s22 = 0, s13 = 0, s23 = 0, s33 = 0; // Sigma', x and y in pixels
    double jacobian[2][2];
    for (int i = 0; i < 2; i++) {
        const double x = view->fx_px * (axes[i].x - x0 * axes[i].z),
                     y = view->fy_px * (axes[i].y - y0 * axes[i].z);
        const double z = axes[i].z;
        jacobian[i][0] = view->orthographic ? x : x / p.z, jacobian[i][1] = view->orthographic ? y : y / p.z;
        s11 += x * x, s12 += x * y, s22 += y * y;
        s13 += x * z, s23 += y * z, s33 += z * z;
    }
    const ewa_vec3 across = vec3_cross(splat->axis_u, splat->axis_v);
    double root, *variance = splat->variance_px2, *center = splat->center_px; // root = sqrt(|V|)
    if (view->orthographic) {
        center[0] = view->fx_px * p.x + view->cx_px;
        center[1] = view->fy_px * p.y + view->cy_px;
        variance[0] = s11, variance[1] = s12, variance[2] = s22;
        root = view->fx_px * view->fy_px * fabs(across.z);
    } else {
        const bool affine = view->kernel != EWA_KERNEL_PERSPECTIVE;
        const double cutoff2 = affine ? 0 : view->cutoff * view->cutoff;
        const double k = 1 / (p.z * p.z - cutoff2 * s33);
        double shift[2];
        ewa_ellipse_project((const double[5]){s11, s12, s22, s13, s23}, k, cutoff2, variance, shift);
        center[0] = view->fx_px * x0 + view->cx_px + shift[0];
        center[1] = view->fy_px * y0 + view->cy_px + shift[1];
        root = view->fx_px * view->fy_px * fabs(vec3_dot(across, p)) * k * sqrt(k);
    }
    return filter_ellipse(view, jacobian, root, splat);
}

/// A box around the pixels whose rays may meet a near surfel within 2 F standard deviations: the corners of
/// the circumscribed rectangle, clipped to the depths at which rays of the picture meet the plane at all.
static void bound_near(const ewa_reference_view *view, ewa_reference_splat *splat) {
    const double reach = 2 * view->cutoff;
    if (view->orthographic) {
        const ewa_vec3 p = splat->center, u = splat->axis_u, v = splat->axis_v;
        const double x = view->fx_px * p.x + view->cx_px, y = view->fy_px * p.y + view->cy_px;
        const double half_x = view->fx_px * reach * hypot(u.x, v.x),
                     half_y = view->fy_px * reach * hypot(u.y, v.y);
        set_box(view, x - half_x, x + half_x, y - half_y, y + half_y, splat);
        return;
    }
    // A ray d meets the plane at z = n.p / n.d, and |n.d| <= |d|.
    const double z_min = 0.999 * fabs(vec3_dot(splat->normal, splat->center)) / view->farthest_slope;
    ewa_vec3 corners[4];
    for (int i = 0; i < 4; i++) {
        const ewa_vec3 along = vec3_scale(splat->axis_u, i == 1 || i == 2 ? reach : -reach);
        const ewa_vec3 across = vec3_scale(splat->axis_v, i >= 2 ? reach : -reach);
        corners[i] = vec3_add(splat->center, vec3_add(along, across));
    }
    double x_low = INFINITY, x_high = -INFINITY, y_low = INFINITY, y_high = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const ewa_vec3 a = corners[i], b = corners[(i + 1) % 4];
        ewa_vec3 seen[2];
        int count = 0;
        if (a.z >= z_min) seen[count++] = a;
        if ((a.z >= z_min) != (b.z >= z_min))
            seen[count++] = vec3_add(a, vec3_scale(vec3_sub(b, a), (z_min - a.z) / (b.z - a.z)));
        for (int k = 0; k < count; k++) {
            const double x = view->fx_px * seen[k].x / seen[k].z + view->cx_px;
            const double y = view->fy_px * seen[k].y / seen[k].z + view->cy_px;
            x_low = fmin(x_low, x), x_high = fmax(x_high, x);
            y_low = fmin(y_low, y), y_high = fmax(y_high, y);
        }
    }
    set_box(view, x_low - 1e-3, x_high + 1e-3, y_low - 1e-3, y_high + 1e-3, splat);
}

/// The tangent plane on the screen and the tolerance of the visibility test (docs/math.md sections 5 and 6).
///     1/z(x) = n.d(x) / n.p = 1/pz + n.(d(x) - p/pz) / n.p
/// Orthographic: z(x) = pz - ((X - px) nx + (Y - py) ny) / nz at X = (x - cx) / fx, Y = (y - cy) / fy.
static void make_depth(const ewa_reference_view *view, double half_range, ewa_reference_splat *splat) {
    const ewa_vec3 p = splat->center, n = splat->normal;
    const bool flat = view->orthographic;
    const double facing = flat ? n.z : vec3_dot(n, p), minimum = EWA_EDGE_ON * (flat ? 1 : vec3_length(p));
    const double raised = (facing < 0 ? -1 : 1) * fmax(fabs(facing), minimum) * (flat ? -1 : 1);
    splat->plane[0] = n.x / (raised * view->fx_px);
    splat->plane[1] = n.y / (raised * view->fy_px);
    const double s = flat ? 1 : 1 / p.z;
    splat->plane[2] = (flat ? p.z : s) - splat->plane[0] * (view->fx_px * p.x * s + view->cx_px) -
                      splat->plane[1] * (view->fy_px * p.y * s + view->cy_px);
    // what z changes per pixel at the centre
    const double *plane = splat->plane;
    const double slope = sqrt(plane[0] * plane[0] + plane[1] * plane[1]) * (flat ? 1 : p.z * p.z);
    const double radius = view->cutoff * fmax(vec3_length(splat->axis_u), vec3_length(splat->axis_v));
    const double reach = view->cutoff * view->prefilter_px * slope;
    splat->epsilon = view->tolerance * radius + fmin(reach, EWA_GRAZING_TOLERANCE * radius);
    const double margin = fmax(fmin(EWA_FREE_RADII * radius, EWA_FREE_DEPTH * p.z) - reach, 0);
    if (flat) {
        splat->key_low = -(p.z + half_range) - margin;
        splat->key_high = -(p.z - half_range) + margin;
    } else {
        splat->key_low = 1 / (p.z + half_range) - margin * s * s;
        splat->key_high = 1 / (p.z - half_range) + margin * s * s;
    }
}

/// Clip lines on the screen (docs/math.md section 5, PAS 4.4): l' = M^-1 l by the adjugate of M with the rows
/// tu, tv, p, with the sign that makes (x, y, 1).l' positive inside for z > 0. Orthographic: (x, y) - p is
/// the picture of u tu + v tv, so (u, v) is its product with the inverse of the axes' first two components.
static void add_line(const ewa_reference_view *view, const double l[3], ewa_reference_splat *splat) {
    const ewa_vec3 u = splat->axis_u, v = splat->axis_v, p = splat->center;
    double *line = splat->clip[splat->clip_count++];
    ewa_vec3 seen;
    if (view->orthographic) {
        const double determinant = u.x * v.y - u.y * v.x;
        const double a = (l[0] * v.y - l[1] * u.y) / determinant, b = (l[1] * u.x - l[0] * v.x) / determinant;
        seen = vec3_make(a, b, l[2] - a * p.x - b * p.y);
    } else {
        const ewa_mat3 m = mat3_from_rows(u, v, p), adjugate = mat3_adjugate(&m);
        seen = vec3_scale(mat3_mul_vec3(&adjugate, vec3_make(l[0], l[1], l[2])),
                          mat3_determinant(&m) < 0 ? -1 : 1);
    }
    // From (x, y) at z = 1 to pixels, and to pixels from the line.
    const double a = seen.x / view->fx_px, b = seen.y / view->fy_px;
    const double c = seen.z - a * view->cx_px - b * view->cy_px, length = hypot(a, b);
    line[0] = length > 0 ? a / length : 0;
    line[1] = length > 0 ? b / length : 0;
    line[2] = length > 0 ? c / length : copysign(1, c);
}

/// How a section plane and a surfel meet.
typedef struct section_hit {
    double line[3];  ///< keep a u + b v + c >= 0 of its plane; c: how far the centre lies inside
    double distance; ///< c
    double reach;    ///< of the support along the plane's normal, at most
} section_hit;

static section_hit hit_section(const ewa_reference_view *view, uint32_t plane, const ewa_surfel *surfel) {
    const ewa_vec3 n = vec3_load(view->sections[plane]), u = vec3_load(surfel->axis_u_world);
    const double along = vec3_dot(n, vec3_load(surfel->normal_world));
    const double distance = vec3_dot(n, vec3_load(surfel->center)) + view->sections[plane][3];
    const double support = view->point_sigma_px > 0 ? 0 : view->cutoff * vec3_length(u);
    return (section_hit){{vec3_dot(n, u), vec3_dot(n, vec3_load(surfel->axis_v_world)), distance},
                         distance,
                         support * sqrt(fmax(1 - along * along, 0))};
}

/// Whether a surfel lies outside of some section plane.
static bool is_cut_off(const ewa_reference_view *view, const ewa_surfel *surfel) {
    for (uint32_t k = 0; k < view->section_count; k++) {
        const section_hit hit = hit_section(view, k, surfel);
        if (hit.distance < 0 && hit.distance <= -hit.reach) return true;
    }
    return false;
}

static void make_clip(const ewa_reference_view *view, const ewa_surfel *surfel, ewa_reference_splat *splat) {
    splat->clip_count = 0;
    if (view->point_sigma_px > 0) return;
    for (int k = 0; k < 2; k++)
        if (surfel->clip[k][0] != 0 || surfel->clip[k][1] != 0) add_line(view, surfel->clip[k], splat);
    splat->clip_either = surfel->clip_either == 1 && splat->clip_count == 2;
    // The planes that cut it, from the smallest distance on.
    uint32_t done = 0;
    while (splat->clip_count < EWA_CLIP_LINES) {
        section_hit next = {.distance = INFINITY};
        uint32_t plane = 0;
        for (uint32_t k = 0; k < view->section_count; k++) {
            const section_hit hit = hit_section(view, k, surfel);
            if (done >> k & 1 || !(hit.distance < hit.reach) || hit.distance >= next.distance) continue;
            next = hit, plane = k;
        }
        if (!(next.distance < INFINITY)) return;
        add_line(view, next.line, splat);
        done |= 1u << plane;
    }
}

/// The area of a pixel's square on the inner side of a line, of which its centre is `inside` pixels inside.
/// Away from the middle the line meets two sides of the square that touch, then it cuts off a triangle.
static double half_plane_share(const double line[3], double inside) {
    const double wide = fmax(fabs(line[0]), fabs(line[1])), narrow = fmin(fabs(line[0]), fabs(line[1]));
    if (wide == 0) return inside > 0 ? 1 : 0;
    const double left = (wide + narrow) / 2 - fabs(inside); // from the line to the square's farthest corner
    const double corner = fmin(fmax(left, 0), narrow);
    const double triangle = narrow > 0 ? corner * corner / narrow : 0;
    const double smaller = (triangle + 2 * fmax(left - narrow, 0)) / (2 * wide);
    return inside > 0 ? 1 - smaller : smaller;
}

/// Sets the share of a pixel that clip lines leave, and where it lies.
static void clip_sample(const ewa_reference_splat *splat, double x_px, double y_px,
                        ewa_reference_sample *sample) {
    double share[EWA_CLIP_LINES], sum = 0;
    ewa_vec3 inward = {0, 0, 0};
    for (uint32_t k = 0; k < splat->clip_count; k++) {
        const double *line = splat->clip[k];
        share[k] = half_plane_share(line, line[0] * x_px + line[1] * y_px + line[2]);
        const double decides = splat->clip_either && k < 2 ? share[k] : 1 - share[k];
        inward = vec3_add(inward, vec3_scale(vec3_make(line[0], line[1], 0), decides));
        sum += decides;
        sample->share = fmin(sample->share, share[k]);
        if (!splat->clip_either || k != 1) continue;
        // Two lines of which one suffices are one line beside the others.
        sample->share = fmax(share[0], share[1]);
        inward = vec3_scale(inward, sum > 0 ? (1 - sample->share) / sum : 0);
        sum = 1 - sample->share;
    }
    sample->inward[0] = sum > 0 ? inward.x / sum : 0;
    sample->inward[1] = sum > 0 ? inward.y / sum : 0;
}

/// A surfel of no surface, parallel to the picture.
static ewa_surfel face_picture(const ewa_reference_view *view, const ewa_surfel *surfel) {
    ewa_surfel facing = *surfel;
    const double sigma = vec3_length(vec3_load(surfel->axis_u_world));
    double *const axes[3] = {facing.axis_u_world, facing.axis_v_world, facing.normal_world};
    const double lengths[3] = {sigma, sigma, -1};
    for (int i = 0; i < 3; i++) {
        const ewa_vec3 row = mat3_row(&view->placement.linear, i);
        vec3_store(vec3_scale(row, lengths[i] / vec3_length(row)), axes[i]);
    }
    return facing;
}

void ewa_reference_project(const ewa_reference_view *view, const ewa_surfel *given, ewa_reference_splat *splat) {
    const ewa_surfel facing_picture = given->billboard ? face_picture(view, given) : *given;
    const ewa_surfel *surfel = &facing_picture;
    splat->drawn = false;
    if (is_cut_off(view, surfel)) return;
    const ewa_vec3 p = ewa_placement_apply(&view->placement, vec3_load(surfel->center));
    ewa_vec3 u = to_camera(view, vec3_load(surfel->axis_u_world));
    ewa_vec3 v = to_camera(view, vec3_load(surfel->axis_v_world));
    ewa_vec3 normal_world = vec3_load(surfel->normal_world);
    const bool is_point = view->point_sigma_px > 0;
    if (is_point) {
        const double size = view->point_sigma_px * (view->orthographic ? 1 : p.z);
        u = vec3_make(size / view->fx_px, 0, 0);
        v = vec3_make(0, size / view->fy_px, 0);
        const ewa_vec3 ahead = mat3_row(&view->placement.linear, 2);
        normal_world = vec3_scale(ahead, -1 / vec3_length(ahead));
    }
    ewa_vec3 n = to_camera(view, normal_world);
    n = vec3_scale(n, 1 / vec3_length(n));
    // R = F sqrt(Sigma33), the depth half range of the disc
    const double half_range = view->cutoff * sqrt(u.z * u.z + v.z * v.z);
    const double facing = view->orthographic ? n.z : vec3_dot(n, p);
    if (view->orthographic || is_point ? p.z <= 0 : p.z + half_range <= 0) return;
    if (view->cull == EWA_CULL_BACK && facing >= 0) return;
    const double broad = fmax(vec3_length(u), vec3_length(v)) * fmax(view->fx_px, view->fy_px) / EWA_BROAD_PX;
    const bool by_rays = view->orthographic ? broad > 1 : p.z <= fmax(EWA_NEAR_RATIO * half_range, broad);
    if (by_rays && fabs(facing) < EWA_EDGE_ON * (view->orthographic ? 1 : vec3_length(p))) return;
    splat->is_back = facing > 0;
    const double sign = splat->is_back ? -1 : 1;
    splat->center = p;
    splat->axis_u = u;
    splat->axis_v = v;
    splat->normal = vec3_scale(n, sign);
    splat->normal_world = vec3_scale(normal_world, sign);
    splat->color = vec3_load(surfel->color_linear);
    splat->opacity = surfel->alpha;
    splat->by_rays = by_rays;
    splat->half_range = half_range;
    make_clip(view, surfel, splat);
    make_depth(view, half_range, splat);
    if (splat->by_rays)
        bound_near(view, splat);
    else if (!make_ellipse(view, splat))
        return;
    ewa_reference_move(view, surfel, splat);
    splat->drawn = true;
}

/// The kernel at (u, v) in the surfel's plane, in standard deviations, convolved with the prefilter that the
/// derivatives of (u, v) per pixel carry over: variance I + h^2 (by_x'by_x + by_y'by_y).
static void sample_plane(const ewa_reference_view *view, const double at[2], const double by_x[2],
                         const double by_y[2], ewa_reference_sample *sample) {
    const double u = at[0], v = at[1], h2 = view->prefilter_px * view->prefilter_px;
    const double w11 = 1 + h2 * (by_x[0] * by_x[0] + by_y[0] * by_y[0]);
    const double w22 = 1 + h2 * (by_x[1] * by_x[1] + by_y[1] * by_y[1]);
    const double cross = by_x[0] * by_y[1] - by_x[1] * by_y[0];
    const double determinant = w11 + w22 - 1 + h2 * h2 * cross * cross; // |W|, without cancellation
    // u adj(W) u', a sum of squares: where the surfel is seen from its edge its terms are huge.
    const double across_x = u * by_x[1] - v * by_x[0], across_y = u * by_y[1] - v * by_y[0];
    sample->distance2 = (u * u + v * v + h2 * (across_x * across_x + across_y * across_y)) / determinant;
    sample->weight = ewa_exp(-0.5 * sample->distance2) / sqrt(determinant) / TWO_PI;
}

/// A surfel along a ray: q = z d - p in the tangent frame, u = (q.tu / tu.tu, q.tv / tv.tv), with the
/// derivatives of u at this very pixel. Orthographic: the ray goes through (x, y, 0) along d = (0, 0, 1).
static bool sample_ray(const ewa_reference_view *view, const ewa_reference_splat *splat, double x_px,
                       double y_px, ewa_reference_sample *sample) {
    const ewa_vec3 d = ewa_reference_ray(view, x_px, y_px), p = splat->center, n = splat->normal;
    const bool flat = view->orthographic;
    ewa_vec3 way = vec3_scale(p, -1); // from the centre to where the ray starts
    if (flat) {
        way.x += (x_px - view->cx_px) / view->fx_px;
        way.y += (y_px - view->cy_px) / view->fy_px;
    }
    const double nd = vec3_dot(n, d), z = -vec3_dot(n, way) / nd, stretch = flat ? 1 : z;
    if (!(flat || z > 0) || !isfinite(z)) return false;
    const ewa_vec3 tangents[2] = {splat->axis_u, splat->axis_v};
    double u[2], by_x[2], by_y[2];
    for (int i = 0; i < 2; i++) {
        const ewa_vec3 t = vec3_scale(tangents[i], 1 / vec3_dot(tangents[i], tangents[i]));
        u[i] = vec3_dot(vec3_add(vec3_scale(d, z), way), t);
        // d(z d)/dx = dz/dx d + z (1/fx, 0, 0), dz/dx = -z nx / (fx n.d); likewise y; orthographic: without z
        by_x[i] = stretch / view->fx_px * (t.x - n.x / nd * vec3_dot(d, t));
        by_y[i] = stretch / view->fy_px * (t.y - n.y / nd * vec3_dot(d, t));
    }
    if (!(u[0] * u[0] + u[1] * u[1] < 4 * view->cutoff * view->cutoff)) return false;
    sample_plane(view, u, by_x, by_y, sample);
    sample->z = fmin(fmax(z, p.z - splat->half_range), p.z + splat->half_range);
    return true;
}

/// The source kernel (SS equation 8) and the raycast one: the pixel goes back to the surfel's plane and the
/// kernel is evaluated there. Both maps are affine but for the division by w.
static void sample_backward(const ewa_reference_view *view, const ewa_reference_splat *splat, double x_px,
                            double y_px, ewa_reference_sample *sample) {
    const bool raycast = view->kernel == EWA_KERNEL_RAYCAST;
    const ewa_vec3 from = raycast ? ewa_reference_ray(view, x_px, y_px)
                                  : vec3_make(x_px - splat->center_px[0], y_px - splat->center_px[1], 1);
    const double x_unit = raycast ? view->fx_px : 1, y_unit = raycast ? view->fy_px : 1;
    const double z = splat->center.z, range = splat->half_range;
    double w = 1, u[2], by_x[2], by_y[2];
    if (raycast)
        w = fmin(fmax(vec3_dot(from, mat3_column(&splat->plane_from_ray, 2)), z / (z + range)),
                 z / (z - range));
    for (int i = 0; i < 2; i++) {
        const ewa_vec3 column = mat3_column(&splat->plane_from_ray, i);
        u[i] = vec3_dot(from, column) / w;
        by_x[i] = column.x / x_unit / w;
        by_y[i] = column.y / y_unit / w;
    }
    sample_plane(view, u, by_x, by_y, sample);
}

/// Without the clip lines.
static bool sample_unclipped(const ewa_reference_view *view, const ewa_reference_splat *splat, double x_px,
                             double y_px, ewa_reference_sample *sample) {
    if (splat->by_rays) return sample_ray(view, splat, x_px, y_px, sample);
    const double x_moved_px = x_px - splat->moved_px[0], y_moved_px = y_px - splat->moved_px[1];
    if (by_backward_mapping(view)) {
        sample_backward(view, splat, x_moved_px, y_moved_px, sample);
    } else {
        const double dx = x_moved_px - splat->center_px[0], dy = y_moved_px - splat->center_px[1];
        const double *q = splat->inverse;
        sample->distance2 = q[0] * dx * dx + 2 * q[1] * dx * dy + q[2] * dy * dy;
        sample->weight = splat->peak * ewa_exp(-0.5 * sample->distance2);
    }
    const double plane = splat->plane[0] * x_px + splat->plane[1] * y_px + splat->plane[2];
    // Clamped before the division: a ray that misses the plane gets the far end of the disc.
    const double key = fmin(fmax(view->orthographic ? -plane : plane, splat->key_low), splat->key_high);
    sample->z = view->orthographic ? -key : 1 / key;
    return true;
}

bool ewa_reference_sample_at(const ewa_reference_view *view, const ewa_reference_splat *splat, double x_px,
                             double y_px, ewa_reference_sample *sample) {
    sample->share = 1;
    if (splat->clip_count) clip_sample(splat, x_px, y_px, sample);
    if (!(sample->share > 0) || !sample_unclipped(view, splat, x_px, y_px, sample)) return false;
    sample->weight *= sample->share;
    return true;
}
