// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How far the levels of surfels are off is measured before they are made, on patches of the surfels: what levels make of these
// is drawn, from above at an angle, beside what all surfels make, where the level's surfels are a pixel apart and less. A patch ends
// where the surface goes on. So what is inside of patches counts by the share of the frame that the surfels cover, and what is at their
// ends by the length of the outlines there: elsewhere nothing differs.
//
// A level's surfels are larger, so that pixels would have fewer parts, or one, and outlines are seen that all surfels do not have. Drawn in
// as many parts as these it is nearer to them, and takes longer where pixels count. So it is measured in both, and each frame has
// what is the cheapest of what is near enough.
#include "scene/detail.h"
#include "homogeneous/vec.h"
#include "image/srgb.h"
#include "surface/levels.h"
#include "surface/parts.h"
#include "surface/render.h"
#include "surface/semantics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    MIN_SURFELS = 1 << 18, // fewer are drawn as fast as one can look
    PATCHES = 4,
    PATCH_PACKETS = 1024, // neighbours along the curve: a patch of some 128 by 128
    LEVELS = 2,           // of a patch, of which the last has 1,024
    SCALES = LEVELS + 1,  // 2^scale surfels are a pixel wide; at the coarsest a patch is sixteen
    MAX_PX = 256,         // of a frame that a patch is drawn in
    INSIDE_PX = 2,        // as far outlines reach
    CELLS = 64,           // along the longer side of what is seen
    SAMPLES = 1 << 14,    // packets that are looked for in them
};

/// Directions and colours in sums of squares: from the normal by so much, over a middle grey.
static const double TILT = 0.7;
static const float GREY = 0.2f;

/// What is off by more where it covers looks blurred, however little of the frame that is; 1/255.
static const double MAX_RMS = 12;

/// What cameras see beyond what patches show: of slopes inside, and of outlines.
static const double INSIDE_FACTOR = 1.6, OUTLINE_FACTOR = 1.2;

/// What a pixel's part that is covered costs beside a surfel.
static const double PART_COST = 2;

/// Pixels of levels: divided as their own surfels say, and as all surfels say.
typedef enum division_by { BY_LEVEL, BY_ALL, DIVISIONS } division_by;

/// What errors grow by from level to level where surfels are as large as pixels; beyond those that are measured.
static const double GROWTH = 2;

/// Mean squares of what a level is off by, (1/255)^2.
typedef struct detail_error {
    double inside, outline; ///< of pixels that are covered with all around; of the others, for each that lies on the outline
} detail_error;

typedef struct detail {
    uint64_t serial, last_frame; ///< of the surfels; that had them
    double spacing_world;        ///< of all surfels, about
    double octaves;              ///< as ewa_parts_for() has them, where that is a pixel
    /// Of what levels are off by: where their surfels are a pixel apart, and half a pixel.
    detail_error errors[DIVISIONS][LEVELS + 1][2];
    ewa_surfels head; ///< surfels without levels, borrowed, before those that the detail makes of them
    bool made;        ///< its levels, where there are any
} detail;

static void free_detail(detail *of) { ewa_surfels_destroy(&of->head.coarser); }

void ewa_details_free(ewa_context *context, ewa_details *details) {
    detail *items = details->items.data;
    for (uint32_t i = 0; i < details->count; i++) free_detail(&items[i]);
    details->count = 0;
    ewa_buffer_free(context, &details->items);
    ewa_buffer_free(context, &details->finest);
}

/// Some packets of surfels in a row, which stay where they are. Those before and behind are a multiple of vectors.
static ewa_surfels take_patch(const ewa_surfels *surfels, uint32_t first) {
    const size_t lane = (size_t)first * EWA_PACKET_LANES;
    ewa_surfels patch = *surfels;
    patch.coarser = NULL;
    patch.packets += first;
    patch.packet_count = PATCH_PACKETS;
    patch.count = PATCH_PACKETS * EWA_PACKET_LANES;
    if (patch.points) patch.points += lane;
    if (patch.materials) patch.materials += lane;
    if (patch.opacities) patch.opacities += lane;
    if (patch.curvatures) patch.curvatures += lane;
    if (patch.clip_masks) patch.clip_masks += first, patch.clip_first += first;
    patch.bounds.center_x += first, patch.bounds.center_y += first, patch.bounds.center_z += first;
    patch.bounds.radius += first, patch.bounds.colors += first, patch.bounds.cone += first;
    return patch;
}

/// A patch from above at an angle, and where the camera has it.
typedef struct patch_view {
    double middle_world[3], direction[3], half_world, sigma2_world; ///< mean square of the sigmas
} patch_view;

static patch_view look_at_patch(const ewa_surfels *patch) {
    ewa_vec3 normal = vec3_make(0, 0, 0);
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, sum = 0;
    uint64_t count = 0;
    for (uint32_t p = 0; p < patch->packet_count; p++) {
        double center[3];
        vec3_store(ewa_packet_center(patch, p), center);
        for (int c = 0; c < 3; c++) low[c] = fmin(low[c], center[c]), high[c] = fmax(high[c], center[c]);
        ewa_packet_surfel one;
        ewa_packet_decode(patch, p, 0, &one);
        if (!one.billboard) normal = vec3_add(normal, one.normal);
        for (uint32_t i = 0; i < EWA_PACKET_LANES; i++) {
            const double sigma = (double)patch->packets[p].sigma[i];
            sum += sigma * sigma, count += sigma > 0;
        }
    }
    const double length = vec3_length(normal);
    const ewa_vec3 up = length > 0 ? vec3_scale(normal, 1 / length) : vec3_make(0, 0, 1);
    // Beside the coordinate axis that is farthest from it.
    const double x = fabs(up.x), y = fabs(up.y), z = fabs(up.z);
    const ewa_vec3 side = x <= y && x <= z ? vec3_make(1, 0, 0) : y <= z ? vec3_make(0, 1, 0) : vec3_make(0, 0, 1);
    patch_view view = {.half_world = 0};
    const ewa_vec3 from = vec3_add(up, vec3_scale(side, TILT));
    vec3_store(vec3_scale(from, -1 / vec3_length(from)), view.direction);
    for (int c = 0; c < 3; c++) {
        view.middle_world[c] = patch->origin_world[c] + patch->unit * (low[c] + high[c]) / 2;
        view.half_world += patch->unit * patch->unit * (high[c] - low[c]) * (high[c] - low[c]) / 4;
    }
    view.half_world = sqrt(view.half_world);
    view.sigma2_world = count ? patch->unit * patch->unit * sum / (double)count : 0;
    return view;
}

/// The frames that levels of a patch are compared by.
typedef struct patch_frames {
    ewa_renderer *renderer;
    uint8_t *all, *level; ///< MAX_PX squared
} patch_frames;

/// Draws surfels; `all`: those that say into how many parts pixels are divided.
static ewa_status draw_patch(const patch_frames *frames, const patch_view *view, const ewa_surfels *surfels, const ewa_surfels *all,
                             double pixel_world, uint8_t *rgba8, uint32_t *side_px) {
    ewa_camera camera;
    ewa_render_options options;
    ewa_camera_init(&camera);
    ewa_render_options_init(&options, sizeof options);
    const double side = ceil(2 * view->half_world / pixel_world) + 2;
    *side_px = side < MAX_PX ? (uint32_t)side : MAX_PX;
    camera.width_px = camera.height_px = *side_px;
    EWA_TRY(ewa_camera_set_ortho(&camera, *side_px * pixel_world));
    double eye[3];
    for (int c = 0; c < 3; c++) eye[c] = view->middle_world[c] - 4 * view->half_world * view->direction[c];
    EWA_TRY(ewa_camera_look_at(&camera, eye, view->middle_world, (const double[3]){0, 0, 1}));
    memset(options.background, 0, sizeof options.background);
    const ewa_frame frame = {.rgba8 = rgba8};
    ewa_renderer_set_parts_of(frames->renderer, &all, 1);
    return ewa_render(frames->renderer, surfels, &camera, &options, &frame, NULL);
}

/// A pixel's channel over grey, on a screen.
static double over_grey(const uint8_t *rgba, int channel, double grey) {
    return grey + (rgba[channel] - grey) * rgba[3] / 255;
}

/// Whether a patch covers a pixel and all within INSIDE_PX of it.
static bool is_inside(const uint8_t *rgba8, int64_t side_px, int64_t x, int64_t y) {
    for (int64_t j = y - INSIDE_PX; j <= y + INSIDE_PX; j++)
        for (int64_t i = x - INSIDE_PX; i <= x + INSIDE_PX; i++)
            if (i < 0 || j < 0 || i >= side_px || j >= side_px || rgba8[4 * (j * side_px + i) + 3] < 255) return false;
    return true;
}

/// Whether a patch ends at a pixel, which is covered by a half.
static bool is_outline(const uint8_t *rgba8, int64_t side_px, int64_t x, int64_t y) {
    const uint8_t *here = rgba8 + 4 * (y * side_px + x) + 3;
    return *here >= 128 && (x == 0 || here[-4] < 128 || x + 1 == side_px || here[4] < 128 || y == 0 || here[-4 * side_px] < 128 ||
                            y + 1 == side_px || here[4 * side_px] < 128);
}

/// Adds what two pictures of a patch differ by.
static void add_error(const uint8_t *all, const uint8_t *level, int64_t side_px, detail_error *error) {
    const double grey = ewa_srgb8_from_linear(GREY);
    double inside = 0, outline = 0;
    uint64_t inside_count = 0, outline_count = 0;
    for (int64_t y = 0; y < side_px; y++)
        for (int64_t x = 0; x < side_px; x++) {
            const uint8_t *a = all + 4 * (y * side_px + x), *b = level + 4 * (y * side_px + x);
            double square = 0;
            for (int c = 0; c < 3; c++) {
                const double off = over_grey(a, c, grey) - over_grey(b, c, grey);
                square += off * off / 3;
            }
            const bool within = is_inside(all, side_px, x, y);
            if (within)
                inside += square, inside_count++;
            else
                outline += square;
            outline_count += is_outline(all, side_px, x, y);
        }
    if (inside_count) error->inside += inside / (double)inside_count / PATCHES;
    if (outline_count) error->outline += outline / (double)outline_count / PATCHES;
}

/// Adds the share that a patch has in the levels' errors.
static ewa_status measure_patch(const patch_frames *frames, ewa_surfels *patch, detail *of) {
    const patch_view view = look_at_patch(patch);
    if (!(view.half_world > 0)) return EWA_OK;
    EWA_TRY(ewa_levels_make(patch, LEVELS + 1));
    for (uint32_t scale = 1; scale <= SCALES; scale++) {
        const double pixel_world = ldexp(of->spacing_world, (int)scale);
        uint32_t side_px;
        EWA_TRY(draw_patch(frames, &view, patch, patch, pixel_world, frames->all, &side_px));
        const ewa_surfels *level = patch->coarser;
        for (uint32_t l = 1; l <= scale && level; l++, level = level->coarser)
            for (int by = 0; l + 1 >= scale && by < DIVISIONS; by++) {
                EWA_TRY(draw_patch(frames, &view, level, by == BY_ALL ? patch : level, pixel_world, frames->level, &side_px));
                add_error(frames->all, frames->level, side_px, &of->errors[by][l][scale - l]);
            }
    }
    return EWA_OK;
}

static ewa_status measure(ewa_context *context, const ewa_surfels *surfels, detail *of) {
    const double kernel = 1 - exp(-surfels->cutoff * surfels->cutoff / 2);
    const uint32_t step = (surfels->packet_count - PATCH_PACKETS) / (PATCHES - 1) / EWA_PACKET_LANES * EWA_PACKET_LANES;
    double sigma2 = 0;
    for (uint32_t i = 0; i < PATCHES; i++) {
        const ewa_surfels patch = take_patch(surfels, i * step);
        sigma2 += look_at_patch(&patch).sigma2_world / PATCHES;
    }
    // The density follows from the unit coverage, sigma^2 d (1 - exp(-F^2 / 2)).
    of->spacing_world = sqrt(sigma2 * kernel / surfels->unit_coverage);
    of->octaves = log2(EWA_PART_RADIUS_PX * of->spacing_world / (surfels->cutoff * sqrt(sigma2)));
    const size_t bytes = 4 * (size_t)MAX_PX * MAX_PX;
    patch_frames frames = {.all = ewa_allocate(context, bytes, 1), .level = ewa_allocate(context, bytes, 1)};
    ewa_status status = frames.all && frames.level ? ewa_renderer_create(context, &frames.renderer) : EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < PATCHES && status == EWA_OK && of->spacing_world > 0; i++) {
        ewa_surfels patch = take_patch(surfels, i * step);
        status = measure_patch(&frames, &patch, of);
        ewa_surfels_destroy(&patch.coarser);
    }
    ewa_renderer_destroy(&frames.renderer);
    ewa_release(context, frames.all, bytes, 1);
    ewa_release(context, frames.level, bytes, 1);
    return status;
}

/// What a level is off by, 2^scale surfels being a pixel wide where they are nearest, and 2^middle in the middle of them. Infinite: its
/// own are more than a pixel apart. Between the two scales that are measured it goes up evenly. Inside it is the mean of both from the
/// finer one on: on patches errors go on falling, on whole scenes, of which more and more lies upon each other in a pixel, they do
/// not.
static detail_error error_of(const detail *of, division_by by, uint32_t level, double scale, double middle) {
    if (!(scale >= level)) return (detail_error){INFINITY, INFINITY};
    const uint32_t measured = level < LEVELS ? level : LEVELS;
    const detail_error *errors = of->errors[by][measured];
    const double finer[2] = {fmin(scale - level, 1), fmin(fmax(middle - level, 0), 1)}, growth = pow(GROWTH * GROWTH, level - measured);
    return (detail_error){growth * (errors[0].inside + finer[0] * (errors[1].inside - errors[0].inside) / 2),
                          growth * (errors[0].outline + finer[1] * (errors[1].outline - errors[0].outline))};
}

/// Returns what is known of surfels; NULL: nothing is.
static detail *find(const ewa_details *details, const ewa_surfels *surfels) {
    detail *items = details->items.data;
    for (uint32_t i = 0; i < details->count; i++)
        if (items[i].serial == surfels->serial) return &items[i];
    return NULL;
}

/// Measures surfels of which nothing is known.
static ewa_status add(ewa_context *context, ewa_details *details, const ewa_surfels *surfels, detail **added) {
    EWA_TRY(ewa_buffer_grow(context, &details->items, details->count, (size_t)details->count + 1, sizeof **added));
    detail made = {.serial = surfels->serial};
    EWA_TRY(measure(context, surfels, &made));
    *added = (detail *)details->items.data + details->count++;
    **added = made;
    return EWA_OK;
}

/// Largest number of pixels of a world unit, where the surfels are nearest; infinite: the camera is among them.
static double find_scale(const ewa_surfels *surfels, const ewa_camera *camera) {
    const double *z = &camera->world_to_camera[8];
    double near_z = z[3];
    for (int c = 0; c < 3; c++)
        near_z += z[c] * surfels->origin_world[c] +
                  fmin(z[c] * (surfels->extent.low_world[c] - surfels->reach_world),
                       z[c] * (surfels->extent.high_world[c] + surfels->reach_world));
    const bool perspective = camera->projection == EWA_PERSPECTIVE;
    if (perspective && !(near_z > 0)) return INFINITY;
    return fmax(camera->fx_px, camera->fy_px) * vec3_length(vec3_load(z)) / (perspective ? near_z : 1);
}

/// Puts the middle of a packet into a frame; false: it is not there.
static bool find_pixel(const ewa_surfels *surfels, const ewa_camera *camera, uint32_t packet, double px[2]) {
    const double *m = camera->world_to_camera;
    double world[3], at[3];
    vec3_store(ewa_packet_center(surfels, packet), world);
    for (int c = 0; c < 3; c++) world[c] = surfels->origin_world[c] + surfels->unit * world[c];
    for (int r = 0; r < 3; r++)
        at[r] = m[4 * r] * world[0] + m[4 * r + 1] * world[1] + m[4 * r + 2] * world[2] + m[4 * r + 3];
    const double slope = camera->projection == EWA_PERSPECTIVE ? 1 / at[2] : 1;
    px[0] = camera->fx_px * at[0] * slope + camera->cx_px;
    px[1] = camera->fy_px * at[1] * slope + camera->cy_px;
    return px[0] >= 0 && px[0] < camera->width_px && px[1] >= 0 && px[1] < camera->height_px;
}

/// What of a frame surfels cover, as shares of its pixels.
typedef struct detail_shares {
    double covered, outline;
} detail_shares;

/// Estimates it by the cells of the box around what is seen of them: those with packets in them, and the sides of these to others.
static detail_shares find_shares(const ewa_surfels *surfels, const ewa_camera *camera) {
    const uint32_t step = surfels->packet_count / SAMPLES + 1;
    double low_px[2] = {INFINITY, INFINITY}, high_px[2] = {-INFINITY, -INFINITY}, px[2];
    for (uint32_t p = 0; p < surfels->packet_count; p += step)
        for (int k = 0; find_pixel(surfels, camera, p, px) && k < 2; k++)
            low_px[k] = fmin(low_px[k], px[k]), high_px[k] = fmax(high_px[k], px[k]);
    // A pixel at least, with which outlines are filtered.
    const double side_px = fmax(high_px[0] - low_px[0], high_px[1] - low_px[1]), cell_px = fmax(side_px / (CELLS - 1), 1);
    uint8_t taken[CELLS + 2][CELLS + 2] = {{0}};
    uint32_t count = 0, sides = 0;
    for (uint32_t p = 0; p < surfels->packet_count; p += step) {
        if (!find_pixel(surfels, camera, p, px)) continue;
        uint8_t *cell = &taken[1 + (uint32_t)((px[1] - low_px[1]) / cell_px)][1 + (uint32_t)((px[0] - low_px[0]) / cell_px)];
        count += !*cell;
        *cell = 1;
    }
    for (int y = 1; y <= CELLS; y++)
        for (int x = 1; x <= CELLS; x++)
            if (taken[y][x]) sides += 4u - taken[y][x - 1] - taken[y][x + 1] - taken[y - 1][x] - taken[y + 1][x];
    const double pixels = (double)camera->width_px * camera->height_px;
    return (detail_shares){fmin(count * cell_px * cell_px / pixels, 1), fmin(sides * cell_px / pixels, 1)};
}

/// A frame that levels are chosen for.
typedef struct detail_frame {
    const ewa_camera *camera;
    double max_rms;
    uint32_t count; ///< of surfels
    double octaves; ///< how far all of them are below the size at which pixels are divided (ewa_parts_for())
    int divisions;  ///< that there are to choose from
} detail_frame;

/// The coarsest level that is near enough.
static uint32_t find_level(const detail *of, division_by by, const detail_frame *frame, double px_per_world, const detail_shares *shares) {
    const double scale = -log2(of->spacing_world * px_per_world), middle = fmax(scale, frame->octaves - of->octaves);
    uint32_t level = 0;
    while (level + 1 < EWA_MAX_LEVELS) {
        const detail_error error = error_of(of, by, level + 1, scale, middle);
        const double inside = INSIDE_FACTOR * INSIDE_FACTOR * error.inside * shares->covered;
        const double outline = OUTLINE_FACTOR * OUTLINE_FACTOR * error.outline * shares->outline;
        if (error.inside > MAX_RMS * MAX_RMS || (inside + outline) * frame->count > frame->max_rms * frame->max_rms) break;
        level++;
    }
    return level;
}

/// What a frame of a level costs whose pixels are divided by surfels so many octaves below their size, in surfels.
static double cost_of(const ewa_surfels *finest, uint32_t level, double octaves, const ewa_camera *camera, double share) {
    const ewa_division parts = ewa_parts_for(octaves, camera);
    const double surfels = ldexp(finest->count, -2 * (int)level), covered_px = share * camera->width_px * camera->height_px;
    const double square = (double)parts.count * parts.count;
    const double coarse = surfels + PART_COST * covered_px * square;
    return parts.finer_share > 0 ? coarse + surfels + 4 * PART_COST * covered_px * square : coarse;
}

/// Chooses a level of one of a frame's surfels, and who says into how many parts its pixels are divided.
static ewa_status choose(ewa_context *context, ewa_details *details, const detail_frame *frame, const ewa_surfels **surfels,
                         const ewa_surfels **parts_of, uint32_t *level) {
    *level = 0;
    if ((*surfels)->count < MIN_SURFELS) return EWA_OK;
    // What is known stays while the camera is among the surfels, where no level is enough.
    detail *of = find(details, *surfels);
    if (of) of->last_frame = details->frame;
    const double px_per_world = find_scale(*surfels, frame->camera);
    if (!(px_per_world < INFINITY)) return EWA_OK;
    if (!of) EWA_TRY(add(context, details, *surfels, &of));
    of->last_frame = details->frame;
    if (!(of->spacing_world > 0)) return EWA_OK; // discs without size, of which nothing was measured
    const detail_shares shares = find_shares(*surfels, frame->camera);
    uint32_t levels[DIVISIONS];
    double costs[DIVISIONS];
    for (int by = 0; by < frame->divisions; by++) {
        levels[by] = find_level(of, (division_by)by, frame, px_per_world, &shares);
        costs[by] = cost_of(*surfels, levels[by], frame->octaves - (by == BY_LEVEL ? levels[by] : 0), frame->camera, shares.covered);
    }
    const division_by by = frame->divisions > BY_ALL && costs[BY_ALL] < costs[BY_LEVEL] ? BY_ALL : BY_LEVEL;
    *level = levels[by];
    if (!*level) return EWA_OK;
    const ewa_surfels *finest = *surfels;
    if (!finest->coarser && !of->made) {
        of->head = *finest;
        const ewa_status status = ewa_levels_make(&of->head, EWA_MAX_LEVELS);
        if (status != EWA_OK) free_detail(of);
        EWA_TRY(status);
        of->made = true;
    }
    *surfels = ewa_levels_find(finest->coarser ? finest : &of->head, level);
    // All surfels are those that are given: the head is a copy of what says where they are.
    if (!*level) *surfels = finest;
    if (by == BY_LEVEL) *parts_of = *surfels;
    return EWA_OK;
}

/// How far the surfels of a frame are below the size at which pixels are divided.
static double octaves_of(const ewa_camera *camera, const ewa_surfels *const *surfels, uint32_t count) {
    uint64_t packet_count = 0;
    for (uint32_t i = 0; i < count; i++) packet_count += surfels[i]->packet_count;
    ewa_part_areas areas = {.at = {0}};
    for (uint32_t i = 0; i < count; i++) ewa_part_areas_add_surfels(&areas, camera, surfels[i], ewa_part_areas_step(packet_count));
    return ewa_part_areas_octaves(&areas);
}

ewa_status ewa_details_choose(ewa_context *context, ewa_details *details, const ewa_camera *camera,
                              const ewa_render_options *options, double max_rms, bool alone, const ewa_surfels **surfels,
                              uint32_t count, uint32_t *level) {
    *level = 0;
    details->parts_of = NULL;
    // Whoever says how fine surfels are drawn has the say.
    if (options->level || options->budget_s > 0 || options->supersampling > 0 || options->point_size_px > 0) return EWA_OK;
    details->frame++;
    EWA_TRY(ewa_buffer_reserve(context, &details->finest, count + (size_t)1, sizeof *surfels));
    const ewa_surfels **parts_of = details->finest.data;
    if (count) memcpy(parts_of, surfels, count * sizeof *surfels);
    const bool divided = alone && !(options->eye_dome > 0);
    const detail_frame frame = {camera, max_rms, count, octaves_of(camera, surfels, count), divided ? DIVISIONS : BY_LEVEL + 1};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t own;
        EWA_TRY(choose(context, details, &frame, &surfels[i], &parts_of[i], &own));
        if (own > *level) *level = own;
    }
    if (*level) details->parts_of = parts_of;
    detail *items = details->items.data;
    for (uint32_t i = details->count; i-- > 0;)
        if (items[i].last_frame < details->frame) {
            free_detail(&items[i]);
            items[i] = items[--details->count];
        }
    return EWA_OK;
}
