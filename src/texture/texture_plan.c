// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Forward texture mapping: arguments, and the maps that corners and cameras give.
#include "base/options.h"
#include "texture/texture.h"

#include <math.h>
#include <string.h>

/// Distance in pixels from the vanishing line at which a repeated texture ends.
static const double HORIZON_PX = 0.125;

/// A map that is singular to within this, of unit squares, cannot be drawn.
static const double SINGULAR = 1e-13;

#define AT(member) offsetof(ewa_texture_options, member)

static const ewa_option option_rows[] = {
    {"method", EWA_OPTION_CHOICE, AT(method), .words = "hybrid|splat|point|bilinear",
     .help = "hybrid: texels are points where they are minified along both axes, and splats elsewhere; all "
             "splats; all points, with holes where magnified; backward, by bilinear interpolation, which "
             "aliases"},
    {"prefilter_px", EWA_OPTION_F64, AT(prefilter_px), 0.1, 4, .initial = 0.3, .unit = "px",
     .help = "standard deviation of the pixel filter in pixels"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 1, 4, .initial = 3.3,
     .help = "standard deviations at which kernels end"},
    {"sigma_texels", EWA_OPTION_F64, AT(sigma_texels), 0.3, 2, .initial = 0.4,
     .help = "standard deviation of a texel's disc, in texels: larger is softer where magnified"},
    {"point_spacing_px", EWA_OPTION_F64, AT(point_spacing_px), 0.05, 1, .initial = 0.5, .unit = "px",
     .help = "hybrid: texels that are not farther apart than this, in pixels, are points"},
    {"repeat", EWA_OPTION_BOOL, AT(repeat),
     .help = "fill the whole plane with copies of the image, up to the horizon"},
    {"background", EWA_OPTION_F32, AT(background), 0, 1e6, .count = 4,
     .help = "linear light, straight alpha, which is at most 1"},
};

const ewa_option_table ewa_texture_options_table = EWA_OPTION_TABLE(ewa_texture_options, option_rows);

void ewa_texture_options_init(ewa_texture_options *options, size_t struct_size) {
    ewa_options_init(&ewa_texture_options_table, options, struct_size);
}

/// Checks what sources and targets have in common.
static ewa_status check_raster(ewa_context *context, const char *what, const ewa_texture_target *raster) {
    const uint32_t channels = raster->channel_count, limit = ewa_context_limits(context)->max_image_side;
    if (!raster->pixels || raster->width_px == 0 || raster->height_px == 0)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: the %s is empty", what);
    if (raster->width_px > limit || raster->height_px > limit)
        return ewa_fail(context, EWA_ERROR_LIMIT, "texture: the %s has %u x %u pixels, over the limit of %u",
                        what, raster->width_px, raster->height_px, limit);
    if (raster->format != EWA_PIXEL_SRGB8 && raster->format != EWA_PIXEL_LINEAR)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: the %s has the unknown format %d", what,
                        (int)raster->format);
    if (channels != 1 && channels != 3 && channels != 4)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: the %s has %u channels, not 1, 3 or 4", what,
                        channels);
    const size_t number_bytes = raster->format == EWA_PIXEL_LINEAR ? sizeof(float) : 1;
    if (raster->stride_bytes / number_bytes / channels < raster->width_px ||
        raster->stride_bytes % number_bytes || (uintptr_t)raster->pixels % number_bytes)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "texture: rows of the %s are %zu bytes apart, which is %s", what,
                        raster->stride_bytes, "too few for its pixels or not aligned");
    return EWA_OK;
}

static ewa_status check_rasters(ewa_context *context, const ewa_texture_source *source,
                                const ewa_texture_target *target) {
    // Only looked at: the source stays constant.
    const ewa_texture_target looked_at = {(void *)(uintptr_t)source->pixels,
                                          source->format,
                                          source->channel_count,
                                          source->width_px,
                                          source->height_px,
                                          source->stride_bytes};
    EWA_TRY(check_raster(context, "source", &looked_at));
    EWA_TRY(check_raster(context, "target", target));
    if (target->channel_count == 1 && source->channel_count != 1)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: a grey target needs a grey source");
    return EWA_OK;
}

/// Whether some texel of a source with alpha is not opaque.
static bool has_holes(const ewa_texture_source *source) {
    for (uint32_t y = 0; y < source->height_px; y++) {
        const char *row = (const char *)source->pixels + (size_t)y * source->stride_bytes;
        bool opaque = true;
        if (source->format == EWA_PIXEL_SRGB8) {
            uint32_t all = UINT32_MAX;
            for (uint32_t x = 0; x < source->width_px; x++) {
                uint32_t pixel;
                memcpy(&pixel, row + 4 * (size_t)x, sizeof pixel);
                all &= pixel;
            }
            uint8_t channels[4];
            memcpy(channels, &all, sizeof channels);
            opaque = channels[3] == 255;
        } else {
            const float *numbers = (const float *)(const void *)row;
            for (uint32_t x = 0; x < source->width_px; x++) opaque &= numbers[4 * (size_t)x + 3] == 1;
        }
        if (!opaque) return true;
    }
    return false;
}

/// Gives the adjugate and returns the determinant; `magnitude` is the sum of the magnitudes of its products.
static double invert(double m[3][3], double adjugate[3][3], double *magnitude) {
    double determinant = 0;
    *magnitude = 0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            const double plus = m[a][c] * m[b][d], minus = m[a][d] * m[b][c];
            adjugate[i][j] = plus - minus;
            if (j > 0) continue;
            determinant += m[0][i] * adjugate[i][0];
            *magnitude += fabs(m[0][i]) * (fabs(plus) + fabs(minus));
        }
    }
    return determinant;
}

/// Sets the map, scaled to |w| <= 1 over the texture, and its inverse.
static ewa_status set_map(ewa_texture_plan *plan, const ewa_mat3 *map) {
    ewa_context *context = plan->context;
    const double texture[3] = {plan->source.width_px, plan->source.height_px, 1};
    const double picture[3] = {plan->target.width_px, plan->target.height_px, 1};
    double unit[3][3], w = 0, largest = 0;
    for (int i = 0; i < 3; i++) w += fabs(map->m[i][2]) * texture[i];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            if (!isfinite(map->m[i][j]))
                return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: number %d of the map is not finite",
                                3 * i + j + 1);
            plan->map[i][j] = map->m[i][j] / w;
            unit[i][j] = plan->map[i][j] * texture[i] / picture[j];
            largest = fmax(largest, fabs(unit[i][j]));
        }
    }
    if (!(w > 0) || !(largest < 1e100))
        return ewa_fail(context, EWA_ERROR_NUMERIC, "texture: the map is singular: it sends all to infinity");
    // Of unit squares, so that sizes do not count; the magnitude tells what rounding leaves of the
    // determinant.
    double magnitude, adjugate[3][3];
    const double of_units = invert(unit, adjugate, &magnitude);
    if (!(fabs(of_units) > SINGULAR * magnitude))
        return ewa_fail(context, EWA_ERROR_NUMERIC,
                        "texture: the map is singular: it sends all to a line or a point");
    const double determinant = invert(plan->map, plan->inverse, &magnitude);
    plan->determinant = fabs(determinant);
    bool finite = plan->determinant > 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            plan->inverse[i][j] /= determinant;
            finite = finite && isfinite(plan->inverse[i][j]);
        }
    if (!finite)
        return ewa_fail(context, EWA_ERROR_NUMERIC, "texture: the map is singular: areas vanish or overflow");
    return EWA_OK;
}

/// Lines of the picture between what the texture covers and what it does not, in pixels of distance.
static void set_edges(ewa_texture_plan *plan) {
    const double(*inverse)[3] = (const double(*)[3])plan->inverse;
    const double size[2] = {plan->source.width_px, plan->source.height_px};
    ewa_texture_line *edge = plan->edges;
    if (plan->options.repeat) {
        *edge++ = (ewa_texture_line){inverse[0][2], inverse[1][2], inverse[2][2]};
    } else {
        for (int i = 0; i < 2; i++) {
            *edge++ = (ewa_texture_line){inverse[0][i], inverse[1][i], inverse[2][i]};
            *edge++ = (ewa_texture_line){size[i] * inverse[0][2] - inverse[0][i],
                                         size[i] * inverse[1][2] - inverse[1][i],
                                         size[i] * inverse[2][2] - inverse[2][i]};
        }
    }
    plan->edge_count = (uint32_t)(edge - plan->edges);
    for (uint32_t i = 0; i < plan->edge_count; i++) {
        const double length = hypot(plan->edges[i].a, plan->edges[i].b);
        if (!(length > 0)) continue;
        plan->edges[i].a /= length;
        plan->edges[i].b /= length;
        plan->edges[i].c /= length;
    }
    // 1/w is linear in the picture and 0 on the vanishing line.
    const double slope = hypot(inverse[0][2], inverse[1][2]);
    plan->far_w = plan->options.repeat && slope > 0 ? 1 / (slope * HORIZON_PX) : INFINITY;
}

ewa_status ewa_texture_plan_make(ewa_context *context, const ewa_texture_source *source, const ewa_mat3 *map,
                                 const ewa_texture_options *options, const ewa_texture_target *target,
                                 ewa_texture_plan *plan) {
    if (!context) return EWA_ERROR_ARGUMENT;
    if (!source || !map || !target)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: an argument is NULL");
    ewa_texture_options chosen;
    ewa_texture_options_init(&chosen, sizeof chosen);
    EWA_TRY(ewa_options_take(context, &ewa_texture_options_table, options, &chosen));
    if (chosen.repeat && chosen.method == EWA_TEXTURE_SPLAT)
        return ewa_fail(context, EWA_ERROR_ARGUMENT,
                        "texture: splats alone cannot repeat a texture without end; hybrid can");
    if (chosen.background[3] > 1)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: background[3] is %g, allowed is [0, 1]",
                        (double)chosen.background[3]);
    EWA_TRY(check_rasters(context, source, target));
    memset(plan, 0, sizeof *plan);
    plan->context = context;
    plan->source = *source;
    plan->target = *target;
    plan->options = chosen;
    plan->with_alpha = source->channel_count == 4 && has_holes(source);
    EWA_TRY(set_map(plan, map));
    plan->tangent_w = chosen.sigma_texels * hypot(plan->map[0][2], plan->map[1][2]);
    set_edges(plan);
    ewa_texture_levels_describe(plan);
    return EWA_OK;
}

ewa_status ewa_texture_map_from_corners(ewa_context *context, uint32_t width_px, uint32_t height_px,
                                        const double corners_px[4][2], ewa_mat3 *map) {
    if (!context) return EWA_ERROR_ARGUMENT;
    if (!corners_px || !map || width_px == 0 || height_px == 0)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: no corners or an empty texture");
    // Convex: every three successive corners turn the same way.
    double turns[4], p[4][2];
    for (int i = 0; i < 4; i++) {
        const double *a = corners_px[i], *b = corners_px[(i + 1) % 4], *c = corners_px[(i + 2) % 4];
        turns[i] = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
        if (!(turns[i] * turns[0] > 0) || !isfinite(turns[i]))
            return ewa_fail(
                context, EWA_ERROR_NUMERIC,
                "texture: corners %d, %d, %d turn no corner, or the other way than the first three", i + 1,
                (i + 1) % 4 + 1, (i + 2) % 4 + 1);
        p[i][0] = a[0];
        p[i][1] = a[1];
    }
    // The unit square to four points: Heckbert, "Fundamentals of Texture Mapping and Image Warping",
    // 1989, 2.2.3.
    double unit[3][3], d1[2], d2[2], sum[2];
    for (int c = 0; c < 2; c++) {
        d1[c] = p[1][c] - p[2][c];
        d2[c] = p[3][c] - p[2][c];
        sum[c] = p[0][c] - p[1][c] + p[2][c] - p[3][c];
    }
    const double area = d1[0] * d2[1] - d2[0] * d1[1];
    const double g = (sum[0] * d2[1] - d2[0] * sum[1]) / area, h = (d1[0] * sum[1] - sum[0] * d1[1]) / area;
    for (int c = 0; c < 2; c++) {
        unit[0][c] = p[1][c] - p[0][c] + g * p[1][c];
        unit[1][c] = p[3][c] - p[0][c] + h * p[3][c];
        unit[2][c] = p[0][c];
    }
    unit[0][2] = g;
    unit[1][2] = h;
    unit[2][2] = 1;
    for (int c = 0; c < 3; c++) {
        map->m[0][c] = unit[0][c] / width_px;
        map->m[1][c] = unit[1][c] / height_px;
        map->m[2][c] = unit[2][c];
    }
    return EWA_OK;
}

ewa_status ewa_texture_map_from_camera(ewa_context *context, uint32_t width_px, uint32_t height_px,
                                       const ewa_camera *camera, const double origin_world[3],
                                       const double across_world[3], const double down_world[3],
                                       ewa_mat3 *map) {
    if (!context) return EWA_ERROR_ARGUMENT;
    if (!camera || !origin_world || !across_world || !down_world || !map || width_px == 0 || height_px == 0)
        return ewa_fail(context, EWA_ERROR_ARGUMENT, "texture: no camera, no plane or an empty texture");
    EWA_TRY(ewa_camera_check(context, camera));
    const double *vectors[3] = {across_world, down_world, origin_world};
    const double size[3] = {width_px, height_px, 1};
    ewa_mat3 seen;
    bool finite = true;
    for (int i = 0; i < 3; i++) {
        double p[3];
        for (int row = 0; row < 3; row++) {
            const double *m = &camera->world_to_camera[4 * row];
            p[row] = m[0] * vectors[i][0] + m[1] * vectors[i][1] + m[2] * vectors[i][2] + (i == 2 ? m[3] : 0);
            finite = finite && isfinite(p[row]);
        }
        const double w = camera->projection == EWA_PERSPECTIVE ? p[2] : (i == 2 ? 1 : 0);
        seen.m[i][0] = (camera->fx_px * p[0] + camera->cx_px * w) / size[i];
        seen.m[i][1] = (camera->fy_px * p[1] + camera->cy_px * w) / size[i];
        seen.m[i][2] = w / size[i];
    }
    ewa_mat3 inverse;
    if (!finite || ewa_mat3_invert(&seen, &inverse) != EWA_OK)
        return ewa_fail(context, EWA_ERROR_NUMERIC,
                        "texture: the plane is seen from its edge, its axes are parallel or not finite");
    *map = seen;
    return EWA_OK;
}
