// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which surfels a pixel shows, surface behind surface, and what the pixel becomes. Each pixel has a list of
// all that counts at it, of which surfaces are taken off one after another.
#include "tests/independent/independent.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// The numbers of semantics.h, written down again.
static const real SHADED_NORMAL = 0.95L;
static const real FRONT = 0.05L, CUT = 0.05L, EDGES_AGREE = 0.95L, EDGES_OPPOSE = 0.8L;
enum { MERGED_SURFACES = 64 };

static void *memory(size_t count, size_t bytes) {
    void *made = calloc(count ? count : 1, bytes);
    if (!made) {
        fprintf(stderr, "independent: no memory for %zu of %zu bytes\n", count, bytes);
        exit(1);
    }
    return made;
}

/// Weighted sums over the splats of a surface.
typedef struct sums {
    real weight, opacity, z;
    real3 color, normal;
    real material[5];
} sums;

/// What clip lines have cut off from a surface, and what that makes of it.
typedef struct cut {
    real kept, whole, toward[2]; ///< k, w and D of semantics.h
    real alpha, plain;           ///< share of the pixel that the surface covers; the same without lines
    real mean[2];                ///< d of semantics.h
} cut;

/// The fragments of a pixel and what the surfaces that were taken off have become.
typedef struct pixel {
    independent_fragment *fragments;
    uint32_t count;
    bool open, doubtful;
    real passed;   ///< B of the surface before
    sums sides[2]; ///< of the splats that face the viewer, of those that do not
    sums sum;      ///< what they come to
    cut cut, first_cut;
    real3 front;
    real through;
    independent_surface surface;
} pixel;

typedef struct drawing {
    const independent_scene *scene;
    independent_splat *splats;
    pixel *pixels;
    int64_t width, height;
    bool transparent, one_pass;
    uint32_t surfaces; ///< at most
    bool merge_last;
} drawing;

/// Which surfaces are composited: the rules of ewa_render_options.layers and edge_layers.
static void choose_layers(drawing *d) {
    const ewa_render_options *options = &d->scene->options;
    d->one_pass = options->passes == 1;
    bool some = options->opacity < 1;
    for (uint64_t i = 0; i < d->scene->surfel_count; i++) some = some || d->scene->surfels[i].alpha < 1;
    d->transparent = some && options->layers != 1 && !d->one_pass;
    d->surfaces = d->transparent ? options->layers : options->edge_layers;
    if (d->transparent && options->layers == 0) d->surfaces = EWA_LAYERS_EXACT;
    d->merge_last = d->transparent ? d->surfaces != EWA_LAYERS_EXACT : d->surfaces > 1;
}

/// Of the splats that may count in a row of pixels, `candidates`, those that count at one of them.
static void list_fragments(const drawing *d, const uint32_t *candidates, uint32_t count, int64_t x,
                           int64_t y) {
    pixel *at = &d->pixels[y * d->width + x];
    uint32_t room = 0;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t i = candidates[k];
        independent_fragment fragment;
        if ((real)x + 0.5L < d->splats[i].box[0] || (real)x + 0.5L > d->splats[i].box[1]) continue;
        independent_evaluate(&d->splats[i], (real)x + 0.5L, (real)y + 0.5L, &fragment);
        at->doubtful = at->doubtful || fragment.doubtful;
        if (!fragment.counts) continue;
        if (at->count == room) {
            room = room ? 2 * room : 16;
            at->fragments = realloc(at->fragments, room * sizeof *at->fragments);
            if (!at->fragments) exit(1);
        }
        fragment.splat = i;
        at->fragments[at->count++] = fragment;
    }
}

static void add(const drawing *d, pixel *at, const independent_fragment *fragment) {
    const independent_surfel *surfel = &d->scene->surfels[fragment->splat];
    const ewa_render_options *options = &d->scene->options;
    const real w = d->one_pass ? 1 : fragment->weight, o = d->transparent ? (real)surfel->alpha : 1;
    sums *to = &at->sides[d->splats[fragment->splat].back_facing];
    to->weight += w, to->opacity += w * o, to->z += w * fragment->z;
    to->color = real3_add(to->color, real3_times(real3_of(surfel->color), w * o));
    to->normal = real3_add(to->normal, real3_times(d->splats[fragment->splat].normal_world, w));
    ewa_material material = {(float)options->ambient, 1 - (float)options->ambient, 0.3f, 32, 0.25f};
    if (options->shading == EWA_SHADING_PHONG && options->materials)
        material = options->materials[surfel->material];
    const real numbers[5] = {(real)material.ambient, (real)material.diffuse, (real)material.specular,
                             (real)material.shininess, (real)material.reflection};
    for (int i = 0; i < 5; i++) to->material[i] += w * numbers[i];
    const real off = (1 - fragment->share) / CUT, c = off > 1 ? 1 : off, rho = w / fragment->share;
    at->cut.kept += c * w, at->cut.whole += c * rho;
    for (int i = 0; i < 2; i++) at->cut.toward[i] += c * rho * fragment->inward[i];
}

/// Adds `share` of one to another.
static void mix(sums *to, const sums *from, real share) {
    to->weight += share * from->weight, to->opacity += share * from->opacity, to->z += share * from->z;
    to->color = real3_add(to->color, real3_times(from->color, share));
    to->normal = real3_add(to->normal, real3_times(from->normal, share));
    for (int i = 0; i < 5; i++) to->material[i] += share * from->material[i];
}

static real within(real value, real low, real high) {
    return value < low ? low : value > high ? high : value;
}

/// What of a surface is seen, and how much of the pixel it covers; `all` stands for several.
static void settle(const drawing *d, pixel *at, bool all) {
    const sums *faces = &at->sides[0], *backs = &at->sides[1];
    const real q0 = (real)d->scene->unit_coverage, minimum = (real)d->scene->options.edge_threshold * q0;
    const real hidden = within(faces->weight / (FRONT * q0), 0, 1), q = faces->weight + backs->weight;
    at->sum = (sums){0};
    if (!(q > 0)) return;
    const bool one_side = all || !(faces->weight > 0) || !(backs->weight > 0);
    mix(&at->sum, faces, one_side ? 1 : hidden * q / faces->weight);
    mix(&at->sum, backs, one_side ? 1 : (1 - hidden) * q / backs->weight);
    cut *c = &at->cut;
    c->alpha = c->plain = within(q / minimum, 0, 1);
    c->mean[0] = c->mean[1] = 0;
    if (all || !(c->whole > 0)) return;
    const real rest = q - c->kept > 0 ? q - c->kept : 0;
    const real along = hypotl(c->toward[0], c->toward[1]) / c->whole;
    const real alone = within((along - EDGES_OPPOSE) / (EDGES_AGREE - EDGES_OPPOSE), 0, 1);
    const real maximum = rest + alone * c->whole > minimum ? rest + alone * c->whole : minimum;
    c->alpha = within(rest / minimum > q / maximum ? rest / minimum : q / maximum, 0, 1);
    for (int i = 0; i < 2; i++) c->mean[i] = c->toward[i] / (rest + c->whole);
}

/// Share of what the first surface leaves open that a surface behind it covers.
static real cover_behind(const cut *first, const cut *behind) {
    const real along = first->mean[0] * behind->mean[0] + first->mean[1] * behind->mean[1];
    if (!(first->alpha < 1)) return behind->alpha;
    const real past = within((behind->alpha - first->alpha) / (1 - first->alpha), 0, 1);
    return behind->alpha +
           within(2 * fabsl(along), 0, 1) * ((along > 0 ? past : behind->plain) - behind->alpha);
}

/// Gathers the nearest surface beyond at->passed; with `all`, everything that is left.
static void gather(const drawing *d, pixel *at, bool all) {
    at->sides[0] = at->sides[1] = (sums){0};
    at->cut = (cut){0};
    real bound = INFINITY, band = 0;
    const independent_fragment *nearest = NULL;
    for (uint32_t i = 0; i < at->count; i++) {
        const independent_fragment *fragment = &at->fragments[i];
        if (fragment->z <= at->passed) continue;
        if (!nearest || fragment->z < nearest->z) nearest = fragment;
        if (fragment->z + fragment->epsilon < bound) {
            bound = fragment->z + fragment->epsilon;
            band = fragment->depth_band;
        }
    }
    if (all) bound = INFINITY;
    if (d->one_pass && nearest) {
        bound = nearest->z;
        band = nearest->depth_band;
        add(d, at, nearest);
    }
    for (uint32_t i = 0; i < at->count; i++) {
        const independent_fragment *fragment = &at->fragments[i];
        if (fragment->z <= at->passed) continue;
        const bool itself = d->one_pass && fragment == nearest;
        if (!itself && fabsl(fragment->z - bound) < band + fragment->depth_band) at->doubtful = true;
        if (!d->one_pass && fragment->z <= bound) add(d, at, fragment);
    }
    at->passed = bound;
    settle(d, at, all);
}

/// What the sums make of a surface.
static void make_surface(const drawing *d, pixel *at, int64_t x, int64_t y) {
    const ewa_camera *camera = &d->scene->camera;
    at->surface = (independent_surface){.there = at->open && at->sum.weight > 0};
    if (!at->surface.there) return;
    real3 ray = {0, 0, 1};
    if (camera->projection == EWA_PERSPECTIVE) {
        ray.x = ((real)x + 0.5L - (real)camera->cx_px) / (real)camera->fx_px;
        ray.y = ((real)y + 0.5L - (real)camera->cy_px) / (real)camera->fy_px;
    }
    // Back to the world by the transpose, A being a rotation but for its scale.
    const double *m = camera->world_to_camera;
    const real3 columns[3] = {{(real)m[0], (real)m[4], (real)m[8]},
                              {(real)m[1], (real)m[5], (real)m[9]},
                              {(real)m[2], (real)m[6], (real)m[10]}};
    const real3 away = {real3_dot(columns[0], ray), real3_dot(columns[1], ray), real3_dot(columns[2], ray)};
    at->surface.eye = real3_times(real3_unit(away), -1);
    if (at->sum.opacity > 0) at->surface.color = real3_times(at->sum.color, 1 / at->sum.opacity);
    const real length = real3_length(at->sum.normal), minimum = SHADED_NORMAL * at->sum.weight;
    at->surface.normal = real3_times(at->sum.normal, 1 / (length > minimum ? length : minimum));
    for (int i = 0; i < 5; i++) at->surface.material[i] = at->sum.material[i] / at->sum.weight;
}

/// alpha of a layer that stands for all that is left.
static real merged(real alpha, real coverage) {
    real through = 1 - alpha;
    for (int i = 1; i < MERGED_SURFACES; i++) {
        const real more = 4 * (coverage - i) - 2, share = more < 0 ? 0 : more > 1 ? 1 : more;
        through *= 1 - alpha * share;
    }
    return 1 - through;
}

static independent_surface surface_at(const drawing *d, int64_t x, int64_t y) {
    return x < d->width && y < d->height ? d->pixels[y * d->width + x].surface : (independent_surface){0};
}

static void write_first(const drawing *d, const independent_picture *picture, size_t i) {
    const pixel *at = &d->pixels[i];
    const bool there = at->sum.weight > 0;
    const real3 normal = real3_unit(at->sum.normal);
    picture->depth[i] = there ? (double)(at->sum.z / at->sum.weight) : (double)INFINITY;
    picture->normal[3 * i] = (double)normal.x;
    picture->normal[3 * i + 1] = (double)normal.y;
    picture->normal[3 * i + 2] = (double)normal.z;
    picture->coverage[i] = !there        ? 0
                           : d->one_pass ? 1
                                         : (double)(at->sum.weight / (real)d->scene->unit_coverage);
}

/// Shades the surface, puts it behind those before, and closes the pixel where nothing more can show.
static void compose(const drawing *d, uint32_t layer, int64_t x, int64_t y) {
    const ewa_render_options *options = &d->scene->options;
    pixel *at = &d->pixels[y * d->width + x];
    if (!at->open) return;
    if (!at->surface.there) {
        at->open = false;
        return;
    }
    const independent_surface beside = surface_at(d, x ^ 1, y), below = surface_at(d, x, y ^ 1);
    const real3 color = independent_shade(d->scene, &at->surface, &beside, &below);
    const real coverage = at->sum.weight / (real)d->scene->unit_coverage;
    real alpha = 1;
    if (!d->one_pass && options->edge_antialiasing) {
        const bool related = layer > 0 && !d->transparent;
        alpha = related ? cover_behind(&at->first_cut, &at->cut) : at->cut.alpha;
        if (layer == 0) at->first_cut = at->cut;
    }
    if (d->transparent) alpha *= (real)options->opacity * at->sum.opacity / at->sum.weight;
    if (d->merge_last && layer + 1 == d->surfaces) alpha = merged(alpha, coverage);
    at->front = real3_add(at->front, real3_times(color, alpha * at->through));
    at->through *= 1 - alpha;
    at->open = at->through > 0;
}

static double srgb_code(real linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    return (double)(255 *
                    (linear <= 0.0031308L ? 12.92L * linear : 1.055L * powl(linear, 1 / 2.4L) - 0.055L));
}

static void finish(const drawing *d, const independent_picture *picture, int64_t x, int64_t y) {
    const ewa_render_options *options = &d->scene->options;
    const size_t i = (size_t)(y * d->width + x);
    const pixel *at = &d->pixels[i];
    real3 front = at->front;
    if (options->eye_dome > 0)
        front = real3_times(front, independent_eye_dome(d->scene, picture->depth, x, y));
    const real behind = (real)options->background[3] * at->through, a = 1 - at->through + behind;
    const real rgb[3] = {front.x + (real)options->background[0] * behind,
                         front.y + (real)options->background[1] * behind,
                         front.z + (real)options->background[2] * behind};
    for (size_t c = 0; c < 3; c++) {
        picture->rgba[4 * i + c] = (double)rgb[c];
        picture->srgb[4 * i + c] = a > 0 ? srgb_code(rgb[c] / a) : 0;
    }
    picture->rgba[4 * i + 3] = (double)a;
    picture->srgb[4 * i + 3] = (double)(255 * a);
    // Eye-dome lighting looks at pixels around.
    const int64_t reach = options->eye_dome > 0 ? 4 : 0;
    for (int64_t row = y - reach; row <= y + reach; row++)
        for (int64_t column = x - reach; column <= x + reach; column++)
            if (row >= 0 && column >= 0 && row < d->height && column < d->width &&
                d->pixels[row * d->width + column].doubtful)
                picture->doubtful[i] = true;
}

static void draw(drawing *d, const independent_picture *picture) {
    uint32_t *candidates = memory(d->scene->surfel_count, sizeof *candidates);
    for (int64_t y = 0; y < d->height; y++) {
        uint32_t found = 0;
        for (uint32_t i = 0; i < d->scene->surfel_count; i++)
            if (!d->splats[i].dropped && (real)y + 0.5L >= d->splats[i].box[2] &&
                (real)y + 0.5L <= d->splats[i].box[3])
                candidates[found++] = i;
        for (int64_t x = 0; x < d->width; x++) {
            list_fragments(d, candidates, found, x, y);
            d->pixels[y * d->width + x].open = true;
            d->pixels[y * d->width + x].through = 1;
            d->pixels[y * d->width + x].passed = -INFINITY;
        }
    }
    free(candidates);
    const size_t count = (size_t)(d->width * d->height);
    bool open = true;
    for (uint32_t layer = 0; layer < d->surfaces && open; layer++) {
        for (int64_t y = 0; y < d->height; y++)
            for (int64_t x = 0; x < d->width; x++) {
                pixel *at = &d->pixels[y * d->width + x];
                if (at->open) gather(d, at, d->merge_last && layer + 1 == d->surfaces);
                make_surface(d, at, x, y);
            }
        for (size_t i = 0; i < count && layer == 0; i++) write_first(d, picture, i);
        open = false;
        for (int64_t y = 0; y < d->height; y++)
            for (int64_t x = 0; x < d->width; x++) {
                compose(d, layer, x, y);
                open = open || d->pixels[y * d->width + x].open;
            }
    }
    for (int64_t y = 0; y < d->height; y++)
        for (int64_t x = 0; x < d->width; x++) finish(d, picture, x, y);
}

independent_picture independent_render(const independent_scene *scene) {
    drawing d = {.scene = scene, .width = scene->camera.width_px, .height = scene->camera.height_px};
    const size_t count = (size_t)(d.width * d.height);
    independent_picture picture = {.width_px = scene->camera.width_px,
                                   .height_px = scene->camera.height_px,
                                   .rgba = memory(4 * count, sizeof(double)),
                                   .srgb = memory(4 * count, sizeof(double)),
                                   .depth = memory(count, sizeof(double)),
                                   .normal = memory(3 * count, sizeof(double)),
                                   .coverage = memory(count, sizeof(double)),
                                   .doubtful = memory(count, sizeof(bool))};
    d.splats = memory(scene->surfel_count, sizeof *d.splats);
    d.pixels = memory(count, sizeof *d.pixels);
    for (uint64_t i = 0; i < scene->surfel_count; i++)
        independent_project(scene, &scene->surfels[i], &d.splats[i]);
    choose_layers(&d);
    draw(&d, &picture);
    for (size_t i = 0; i < count; i++) free(d.pixels[i].fragments);
    free(d.pixels);
    free(d.splats);
    return picture;
}

void independent_free(independent_picture *picture) {
    free(picture->rgba);
    free(picture->srgb);
    free(picture->depth);
    free(picture->normal);
    free(picture->coverage);
    free(picture->doubtful);
    *picture = (independent_picture){0};
}
