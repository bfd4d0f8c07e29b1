// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// How surfels that represent others are drawn best. Means blur twice, when they are taken and when they are
// drawn: narrower kernels and sharpened colours make up for it on clean data and worsen noise, so both are
// tried. A picture is linear in its colours; how much sharpening is best follows from two pictures by least
// squares.
#include "image/srgb.h"
#include "lod/representative.h"
#include "surface/packets.h"

#include <math.h>
#include <string.h>

enum {
    WINDOW_LEVELS = 2, // of the node of which pictures are taken, below the one that is evaluated
    WINDOW_PX = 1 << (EWA_PAGE_BITS - WINDOW_LEVELS - 1), // surfels are half a pixel apart
    MARGIN_PX = 1,
    SIDE_PX = WINDOW_PX + 2 * MARGIN_PX,
    PIXELS = SIDE_PX * SIDE_PX,
    CHANNELS = 4,
    GRID_SIDE = 1 << EWA_PAGE_BITS,
    NO_SURFEL = -1,
    MIN_SURFELS = 16, // surfels in a window that tell something
};

/// Radii that are tried, over those that keep areas.
static const float RADIUS_SCALES[] = {1.0f, 0.7f};

/// Standard deviation of the neighbourhood that colours are sharpened against, in cells, and most sharpening.
static const float BLUR_CELLS = 0.6f, MAX_SHARPENING = 1.5f;

ewa_status ewa_evaluator_make(ewa_context *context, bool lit, ewa_evaluator *evaluator) {
    *evaluator = (ewa_evaluator){.context = context, .lit = lit};
    return ewa_renderer_create(context, &evaluator->renderer);
}

void ewa_evaluator_free(ewa_evaluator *evaluator) {
    if (!evaluator->context) return;
    ewa_renderer_destroy(&evaluator->renderer);
    ewa_buffer_free(evaluator->context, &evaluator->grid);
    ewa_buffer_free(evaluator->context, &evaluator->blurred);
    ewa_buffer_free(evaluator->context, &evaluator->chosen);
    ewa_buffer_free(evaluator->context, &evaluator->pictures);
}

/// The neighbourhoods of some surfels of a node.
typedef struct blur_job {
    const ewa_representatives *merged;
    uint32_t first_surfel, end;
    uint32_t level;
    double cell_world;
    int32_t *first; ///< [cell]: first surfel in it
    float (*blurred)[3];
} blur_job;

/// Cell of a surfel in its node, 3 times EWA_PAGE_BITS bits.
static void cell_of(uint64_t code, uint32_t cell_level, int32_t cell[3]) {
    const ewa_octree_key key = ewa_code_key(code, cell_level);
    for (int c = 0; c < 3; c++) cell[c] = key.cell[c] & (GRID_SIDE - 1);
}

static size_t cell_index(const int32_t cell[3]) {
    return ((size_t)cell[2] * GRID_SIDE + (size_t)cell[1]) * GRID_SIDE + (size_t)cell[0];
}

enum { BLUR_TASKS = 64, NEAR_SURFELS = 64 };

/// Surfels around one, so many that several can be weighed at a time; they are added in their order.
typedef struct near_surfels {
    float distance2[NEAR_SURFELS], facing[NEAR_SURFELS], radius2[NEAR_SURFELS];
    const float *colors[NEAR_SURFELS];
    uint32_t count;
    float sum[3], weights;
} near_surfels;

/// Adds those that face the same way, and begins again with none.
static void add_near(near_surfels *near, float exponent) {
    float weights[NEAR_SURFELS];
    for (uint32_t i = 0; i < near->count; i++) {
        // Rational, so that every machine has the same bits; close to the Gaussian out to two deviations.
        const float x = near->distance2[i] * -exponent, falling = 1 / (1 + x * (1 + x * (0.5f + x / 6)));
        weights[i] = near->radius2[i] * falling;
    }
    for (uint32_t i = 0; i < near->count; i++) {
        if (near->facing[i] <= 0) continue;
        near->weights += weights[i];
        for (int c = 0; c < 3; c++) near->sum[c] += weights[i] * near->colors[i][c];
    }
    near->count = 0;
}

/// Takes the surfels of one cell, from its first on, as neighbours of `s`.
static void take_cell(const blur_job *job, const ewa_representative *s, uint32_t first, uint32_t cell_level, float exponent,
                      near_surfels *near) {
    const ewa_representatives *merged = job->merged;
    const uint64_t prefix = ewa_code_prefix(merged->items[first].code, cell_level);
    for (uint32_t k = first; k < merged->count && ewa_code_prefix(merged->items[k].code, cell_level) == prefix; k++) {
        const ewa_representative *o = &merged->items[k];
        float distance2 = 0, facing = 0;
        for (int c = 0; c < 3; c++) {
            const float d = (float)(o->at_world[c] - s->at_world[c]);
            distance2 += d * d;
            facing += o->normal[c] * s->normal[c];
        }
        near->distance2[near->count] = distance2, near->facing[near->count] = facing;
        near->radius2[near->count] = o->radius_world * o->radius_world;
        near->colors[near->count++] = o->color;
        if (near->count == NEAR_SURFELS) add_near(near, exponent);
    }
}

static void blur_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const blur_job *job = data;
    const uint32_t cell_level = job->level + EWA_PAGE_BITS;
    const float exponent =
        (float)(-0.5 / ((double)BLUR_CELLS * (double)BLUR_CELLS * job->cell_world * job->cell_world));
    const uint32_t count = job->end - job->first_surfel;
    const uint32_t end = job->first_surfel + (uint32_t)ewa_split(count, BLUR_TASKS, part + 1);
    for (uint32_t i = job->first_surfel + (uint32_t)ewa_split(count, BLUR_TASKS, part); i < end; i++) {
        const ewa_representative *s = &job->merged->items[i];
        int32_t cell[3], low[3], high[3];
        cell_of(s->code, cell_level, cell);
        for (int c = 0; c < 3; c++) {
            low[c] = cell[c] > 0 ? cell[c] - 1 : 0;
            high[c] = cell[c] < GRID_SIDE - 1 ? cell[c] + 1 : GRID_SIDE - 1;
        }
        near_surfels near;
        near.count = 0, near.weights = near.sum[0] = near.sum[1] = near.sum[2] = 0;
        for (int32_t z = low[2]; z <= high[2]; z++)
            for (int32_t y = low[1]; y <= high[1]; y++) {
                const int32_t *row = &job->first[cell_index((const int32_t[3]){0, y, z})];
                for (int32_t x = low[0]; x <= high[0]; x++)
                    if (row[x] != NO_SURFEL) take_cell(job, s, (uint32_t)row[x], cell_level, exponent, &near);
            }
        add_near(&near, exponent);
        for (int c = 0; c < 3; c++) job->blurred[i][c] = near.weights > 0 ? near.sum[c] / near.weights : s->color[c];
    }
}

/// Finds what blurring needs, for no surfels so far.
static ewa_status prepare_blur(ewa_evaluator *evaluator, const ewa_representatives *merged, uint32_t level,
                               double cell_world, blur_job *job) {
    const size_t cells = (size_t)GRID_SIDE * GRID_SIDE * GRID_SIDE;
    EWA_TRY(ewa_buffer_reserve(evaluator->context, &evaluator->grid, cells, sizeof(int32_t)));
    EWA_TRY(ewa_buffer_reserve(evaluator->context, &evaluator->blurred, merged->count, 3 * sizeof(float)));
    *job = (blur_job){merged, 0, 0, level, cell_world, evaluator->grid.data, evaluator->blurred.data};
    memset(job->first, 0xff, cells * sizeof *job->first);
    for (uint32_t i = merged->count; i-- > 0;) {
        int32_t cell[3];
        cell_of(merged->items[i].code, level + EWA_PAGE_BITS, cell);
        job->first[cell_index(cell)] = (int32_t)i;
    }
    return EWA_OK;
}

/// Blurs the surfels [first, end).
static void blur(ewa_evaluator *evaluator, blur_job *job, uint32_t first, uint32_t end) {
    job->first_surfel = first, job->end = end;
    ewa_parallel(evaluator->context, blur_part, job, BLUR_TASKS);
}

/// The node in the evaluated one that has most surfels.
static uint64_t choose_window(const ewa_representatives *merged, uint32_t window_level) {
    uint64_t best = 0;
    uint32_t maximum = 0;
    for (uint32_t first = 0, next; first < merged->count; first = next) {
        const uint64_t prefix = ewa_code_prefix(merged->items[first].code, window_level);
        next = first + 1;
        while (next < merged->count && ewa_code_prefix(merged->items[next].code, window_level) == prefix)
            next++;
        if (next - first > maximum) maximum = next - first, best = prefix;
    }
    return best;
}

/// Range of the surfels of a list that lie in a node.
static void find_range(const ewa_representatives *list, uint64_t prefix, uint32_t level, uint32_t *first,
                       uint32_t *end) {
    uint32_t bounds[2];
    for (uint32_t side = 0; side < 2; side++) {
        uint32_t low = 0, high = list->count;
        while (low < high) {
            const uint32_t middle = low + (high - low) / 2;
            if (ewa_code_prefix(list->items[middle].code, level) < prefix + side)
                low = middle + 1;
            else
                high = middle;
        }
        bounds[side] = low;
    }
    *first = bounds[0], *end = bounds[1];
}

/// A camera that looks at a node along the axis that most of its surfels face, from the side that most do.
static void aim(const ewa_representatives *merged, uint32_t first, uint32_t end, const double low[3],
                double side_world, ewa_camera *camera) {
    double along[3] = {0}, facing[3] = {0};
    for (uint32_t i = first; i < end; i++)
        for (int c = 0; c < 3; c++) {
            const double weight =
                (double)merged->items[i].radius_world * (double)merged->items[i].radius_world;
            along[c] += weight * fabs((double)merged->items[i].normal[c]);
            facing[c] += weight * (double)merged->items[i].normal[c];
        }
    int axis = 0;
    for (int c = 1; c < 3; c++)
        if (along[c] > along[axis]) axis = c;
    const double sign = facing[axis] < 0 ? -1 : 1;
    ewa_camera_init(camera);
    camera->projection = EWA_ORTHOGRAPHIC;
    camera->width_px = camera->height_px = SIDE_PX;
    camera->fx_px = camera->fy_px = WINDOW_PX / side_world;
    camera->cx_px = camera->cy_px = SIDE_PX / 2.0;
    double *m = camera->world_to_camera;
    memset(m, 0, 16 * sizeof *m);
    m[15] = 1;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3; // a right-handed frame that looks against the axis
    m[0 + u] = 1, m[4 + v] = -sign, m[8 + axis] = -sign;
    for (int r = 0; r < 3; r++) {
        double middle = 0;
        for (int c = 0; c < 3; c++) middle += m[4 * r + c] * (low[c] + side_world / 2);
        m[4 * r + 3] = -middle;
    }
    m[11] += 4 * side_world;
}

/// Makes surfels of a range of a list, with shown colours, or with colours moved against their neighbourhood; `unit_coverage` 0:
/// measured.
static ewa_status pack(ewa_evaluator *evaluator, const ewa_representatives *list, uint32_t first,
                       uint32_t end, float radius_scale, const float (*blurred)[3], float unit_coverage, ewa_surfels **surfels) {
    enum { FLOATS = 3 + 3 + 1 + 4 };
    const uint32_t count = end - first;
    EWA_TRY(ewa_buffer_reserve(evaluator->context, &evaluator->chosen, count, FLOATS * sizeof(float)));
    float *stream = evaluator->chosen.data;
    for (uint32_t i = 0; i < count; i++) {
        const ewa_representative *s = &list->items[first + i];
        float *to = stream + (size_t)i * FLOATS;
        for (int c = 0; c < 3; c++) {
            to[c] = (float)(s->at_world[c] - list->items[first].at_world[c]);
            to[3 + c] = s->normal[c];
            to[7 + c] = blurred ? 2 * s->color[c] - blurred[first + i][c] : s->shown[c];
        }
        to[6] = s->radius_world;
        to[10] = 1;
    }
    ewa_cloud *cloud = NULL;
    const size_t stride = FLOATS * sizeof(float);
    ewa_surfels_options options;
    ewa_surfels_options_init(&options, sizeof options);
    options.radius_scale = (double)radius_scale;
    ewa_status status = ewa_cloud_create(evaluator->context, count, &cloud);
    if (status == EWA_OK) ewa_cloud_set_origin(cloud, list->items[first].at_world);
    if (status == EWA_OK) status = ewa_cloud_borrow(cloud, EWA_POSITION, EWA_F32, 3, stream, stride);
    if (status == EWA_OK) status = ewa_cloud_borrow(cloud, EWA_NORMAL, EWA_F32, 3, stream + 3, stride);
    if (status == EWA_OK) status = ewa_cloud_borrow(cloud, EWA_RADIUS, EWA_F32, 1, stream + 6, stride);
    if (status == EWA_OK) status = ewa_cloud_borrow(cloud, EWA_COLOR, EWA_F32, 3, stream + 7, stride);
    if (status == EWA_OK) status = ewa_surfels_create_covering(cloud, &options, (double)unit_coverage, surfels);
    ewa_cloud_destroy(&cloud);
    return status;
}

ewa_status ewa_representatives_cover(ewa_evaluator *evaluator, const ewa_representatives *representatives,
                                     float *unit_coverage) {
    ewa_surfels *surfels = NULL;
    const ewa_status status = pack(evaluator, representatives, 0, representatives->count, 1, NULL, 0, &surfels);
    *unit_coverage = status == EWA_OK ? (float)surfels->unit_coverage : 0;
    ewa_surfels_destroy(&surfels);
    return status;
}

/// Draws ranges of lists as one picture, linear and premultiplied.
static ewa_status draw(ewa_evaluator *evaluator, const ewa_camera *camera, ewa_surfels **surfels,
                       uint32_t count, float *picture) {
    ewa_render_options options;
    ewa_render_options_init(&options, sizeof options);
    options.shading = evaluator->lit ? EWA_SHADING_LAMBERT : EWA_SHADING_NONE;
    options.supersampling = 1; // nodes are as fine as what they are drawn by
    const ewa_frame frame = {.rgba = picture};
    EWA_TRY(ewa_render_begin(evaluator->renderer, camera, &options, &frame));
    for (uint32_t i = 0; i < count; i++) {
        if (surfels[i]) EWA_TRY(ewa_render_add(evaluator->renderer, surfels[i]));
    }
    return ewa_render_finish(evaluator->renderer, NULL);
}

static float encode(float linear) {
    return (float)ewa_srgb_encode(linear < 0 ? 0 : linear > 1 ? 1 : (double)linear);
}

/// Mean square of the differences between a picture, moved by `share` of the way to another, and the true one, where either
/// shows something; negative where nothing does.
static double difference(const float *reference, const float *picture, const float *sharp, float share) {
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const float *t = reference + CHANNELS * i, *p = picture + CHANNELS * i, *q = sharp + CHANNELS * i;
        if (t[3] == 0 && p[3] == 0) continue;
        count++;
        for (int c = 0; c < 3; c++) {
            const float d = encode(p[c] + share * (q[c] - p[c])) - encode(t[c]);
            sum += (double)d * (double)d / 3;
        }
    }
    return count ? sum / count : -1;
}

/// The share of the way from one picture to another that is nearest to the true one.
static float best_share(const float *reference, const float *picture, const float *sharp) {
    double along = 0, square = 0;
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t c = 0; c < 3; c++) {
            const uint32_t at = CHANNELS * i + c;
            const double way = (double)sharp[at] - (double)picture[at];
            along += way * ((double)reference[at] - (double)picture[at]);
            square += way * way;
        }
    const double share = square > 0 ? along / square : 0;
    return share < 0 ? 0 : share > (double)MAX_SHARPENING ? MAX_SHARPENING : (float)share;
}

/// A way to draw, and what it is worth.
typedef struct verdict {
    float radius_scale, share;
    double error2;
} verdict;

static ewa_status try_scales(ewa_evaluator *evaluator, const ewa_camera *camera,
                             const ewa_representatives *merged, uint32_t first, uint32_t end,
                             float unit_coverage, const float *reference, verdict *best) {
    float *pictures[2] = {(float *)evaluator->pictures.data + PIXELS * CHANNELS,
                          (float *)evaluator->pictures.data + (size_t)2 * PIXELS * CHANNELS};
    ewa_status status = EWA_OK;
    for (size_t k = 0; k < sizeof RADIUS_SCALES / sizeof *RADIUS_SCALES && status == EWA_OK; k++) {
        for (int sharp = 0; sharp < 2 && status == EWA_OK; sharp++) {
            ewa_surfels *surfels = NULL;
            EWA_TRY(pack(evaluator, merged, first, end, RADIUS_SCALES[k],
                         sharp ? (const float(*)[3])evaluator->blurred.data : NULL,
                         unit_coverage * RADIUS_SCALES[k] * RADIUS_SCALES[k], &surfels));
            status = draw(evaluator, camera, &surfels, 1, pictures[sharp]);
            ewa_surfels_destroy(&surfels);
        }
        if (status != EWA_OK) break;
        const float share = best_share(reference, pictures[0], pictures[1]);
        const double error2 = difference(reference, pictures[0], pictures[1], share);
        if (k == 0 || error2 < best->error2) *best = (verdict){RADIUS_SCALES[k], share, error2};
    }
    return status;
}

enum { MAX_PARTS = 8 };

ewa_status ewa_representatives_evaluate(ewa_evaluator *evaluator, const ewa_representatives *children,
                                        uint32_t child_count, const ewa_octree_key *key, double side_world,
                                        ewa_representatives *merged, float *error) {
    const uint32_t level = (uint32_t)key->level, window_level = level + WINDOW_LEVELS;
    const double window_world = side_world / (1 << WINDOW_LEVELS);
    *error = 0;
    merged->radius_scale = 1;
    merged->unit_coverage = 0;
    ewa_status status =
        ewa_buffer_reserve(evaluator->context, &evaluator->pictures, 3 * PIXELS * CHANNELS, sizeof(float));
    const uint64_t prefix = choose_window(merged, window_level);
    ewa_surfels *surfels[MAX_PARTS] = {NULL};
    uint32_t first, end;
    double coverage = 0;
    for (uint32_t i = 0; i < child_count && status == EWA_OK; i++) {
        find_range(&children[i], prefix, window_level, &first, &end);
        if (end == first) continue;
        const float known = children[i].unit_coverage * children[i].radius_scale * children[i].radius_scale;
        status = pack(evaluator, &children[i], first, end, children[i].radius_scale, NULL, known, &surfels[i]);
        if (status != EWA_OK) break;
        coverage =
            surfels[i]->unit_coverage / ((double)children[i].radius_scale * (double)children[i].radius_scale);
    }
    merged->unit_coverage = (float)coverage;
    find_range(merged, prefix, window_level, &first, &end);
    if (status == EWA_OK && end - first >= MIN_SURFELS) {
        const ewa_octree_key window =
            ewa_code_key(prefix << 3 * (EWA_CODE_LEVELS - window_level), window_level);
        const double low[3] = {window.cell[0] * window_world, window.cell[1] * window_world,
                               window.cell[2] * window_world};
        ewa_camera camera;
        aim(merged, first, end, low, window_world, &camera);
        verdict best = {1, 0, 0};
        blur_job job;
        status = prepare_blur(evaluator, merged, level, side_world / GRID_SIDE, &job);
        if (status == EWA_OK) blur(evaluator, &job, first, end);
        if (status == EWA_OK) status = draw(evaluator, &camera, surfels, child_count, evaluator->pictures.data);
        if (status == EWA_OK)
            status = try_scales(evaluator, &camera, merged, first, end, merged->unit_coverage,
                                evaluator->pictures.data, &best);
        merged->radius_scale = best.radius_scale;
        *error = best.error2 > 0 ? (float)(255 * sqrt(best.error2)) : 0;
        // What is not in the picture is blurred only where that made it better.
        const bool sharpened = status == EWA_OK && best.share > 0;
        if (sharpened) blur(evaluator, &job, 0, first), blur(evaluator, &job, end, merged->count);
        const float(*blurred)[3] = evaluator->blurred.data;
        for (uint32_t i = 0; i < merged->count; i++)
            for (int c = 0; c < 3; c++) {
                const float color = merged->items[i].color[c];
                const float shown = sharpened ? color + best.share * (color - blurred[i][c]) : color;
                merged->items[i].shown[c] = shown > 0 ? shown : 0;
            }
    }
    for (uint32_t i = 0; i < child_count && i < MAX_PARTS; i++) ewa_surfels_destroy(&surfels[i]);
    return status;
}
