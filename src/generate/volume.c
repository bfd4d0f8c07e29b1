// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Test volumes. Plain IEEE arithmetic throughout, so that the bytes are the same on every machine.
#include "base/base.h"
#include "base/options.h"
#include "ewa/prepare.h"
#include "math/generate_number.h"

#include <math.h>
#include <string.h>

enum {
    TREE_LEVELS = 9, // 511 tubes
    TREE_TUBES = (1 << TREE_LEVELS) - 1,
    DIM_CHECK = 96,
    BRIGHT_CHECK = 255,
};

/// Half the edge of the checker box, the blob's standard deviation and the ball's radius, in units of the
/// size.
static const double BOX_HALF = 0.375, BLOB_DEVIATION = 0.1, BALL_RADIUS = 0.4;

/// The tree: radius and length of the trunk in units of the size, and what becomes of them at each fork.
static const double TRUNK_RADIUS = 1.0 / 40, TRUNK_LENGTH = 0.26, RADIUS_RATIO = 0.795, LENGTH_RATIO = 0.8;

/// Radius in voxels below which a tube is drawn this wide, and fainter instead, so that it has no gaps.
static const double MIN_RADIUS = 0.9;

/// A tube between two places, thinner towards its end; lengths in units of the size.
typedef struct tube {
    double from[3], along[3], length; // along: unit
    double across[3];                 // unit: the plane in which it forks
    double radius;
} tube;

/// All that slices work on.
typedef struct generator {
    const ewa_volume_generate_options *options;
    const ewa_volume *volume;
    double step;     // between voxels, in units of the size
    double first[3]; // the first voxel
    tube tubes[TREE_TUBES];
} generator;

/// exp(-x) for x >= 0, to the last digits: 2^-k by ldexp, and the Taylor series of the rest.
static double exp_minus(double x) {
    if (x > 700) return 0;
    const double ln2 = 0.6931471805599453;
    const int k = (int)(x / ln2 + 0.5);
    const double r = -(x - k * ln2);
    double sum = 1;
    for (int i = 16; i >= 1; i--) sum = 1 + sum * r / i;
    return ldexp(sum, -k);
}

static double checkerbox_at(const ewa_volume_generate_options *options, const double p[3]) {
    int parity = 0;
    for (int k = 0; k < 3; k++) {
        if (!(fabs(p[k]) <= BOX_HALF)) return 0;
        parity += (int)((p[k] + BOX_HALF) / (2 * BOX_HALF) * options->checks);
    }
    return parity & 1 ? DIM_CHECK : BRIGHT_CHECK;
}

static double field_at(const ewa_volume_generate_options *options, const double p[3]) {
    const double rr = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    if (options->object == EWA_VOLUME_CHECKERBOX) return checkerbox_at(options, p);
    if (options->object == EWA_VOLUME_BLOB) return exp_minus(0.5 * rr / (BLOB_DEVIATION * BLOB_DEVIATION));
    const double inside = 1 - rr / (BALL_RADIUS * BALL_RADIUS);
    return inside > 0 ? inside * inside : 0;
}

static void fill_slice(void *data, uint32_t index, uint32_t worker) {
    (void)worker;
    const generator *job = data;
    const ewa_volume *volume = job->volume;
    size_t at = (size_t)index * volume->dims[0] * volume->dims[1];
    double p[3] = {0, 0, job->first[2] + index * job->step};
    for (uint32_t j = 0; j < volume->dims[1]; j++) {
        p[1] = job->first[1] + j * job->step;
        for (uint32_t i = 0; i < volume->dims[0]; i++, at++) {
            p[0] = job->first[0] + i * job->step;
            const double value = field_at(job->options, p);
            if (volume->type == EWA_F32)
                ((float *)volume->voxels)[at] = (float)value;
            else
                ((uint8_t *)volume->voxels)[at] = (uint8_t)value;
        }
    }
}

/// A number in [0, 1).
static double random_share(uint64_t seed, uint64_t counter) {
    return (double)(ewa_generate_random(seed, counter) >> 11) * 0x1p-53;
}

/// Turns the unit vector `a` towards `b`, which is across it, by so many full turns.
static void turn(const double a[3], const double b[3], double turns, double turned[3]) {
    double sine, cosine;
    ewa_generate_sincos(turns, &sine, &cosine);
    for (int k = 0; k < 3; k++) turned[k] = cosine * a[k] + sine * b[k];
}

/// Makes tube `index` of the tree, whose forks are those of a binary heap: the children of i are 2 i + 1 and
/// 2 i + 2. The first grows along z.
static void grow(uint64_t seed, tube *tubes, uint32_t index) {
    tube *grown = &tubes[index];
    if (index == 0) {
        *grown = (tube){.from = {0, 0, -0.45},
                        .along = {0, 0, 1},
                        .across = {1, 0, 0},
                        .length = TRUNK_LENGTH,
                        .radius = TRUNK_RADIUS};
        return;
    }
    const tube *parent = &tubes[(index - 1) / 2];
    const double *a = parent->along, *b = parent->across;
    const double side[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double away = (index & 1 ? -1 : 1) * (0.06 + 0.06 * random_share(seed, 2 * (uint64_t)index));
    double sideways[3];
    turn(parent->across, side, 0.15 + 0.2 * random_share(seed, 2 * (uint64_t)index + 1), sideways);
    *grown = (tube){.length = parent->length * LENGTH_RATIO, .radius = parent->radius * RADIUS_RATIO};
    for (int k = 0; k < 3; k++) grown->from[k] = parent->from[k] + parent->length * parent->along[k];
    turn(parent->along, sideways, away, grown->along);
    // Across the new direction, in the plane of the fork.
    turn(sideways, parent->along, -away, grown->across);
}

/// First and last voxel of an axis within `reach` of [a, b]; false when there is none.
static bool find_voxels(const generator *job, int axis, double a, double b, double reach, uint32_t range[2]) {
    const double low = ((a < b ? a : b) - reach - job->first[axis]) / job->step;
    const double high = ((a < b ? b : a) + reach - job->first[axis]) / job->step;
    const double last = job->volume->dims[axis] - 1.0;
    if (high < 0 || low > last) return false;
    range[0] = low > 0 ? (uint32_t)ceil(low) : 0;
    range[1] = high < last ? (uint32_t)high : (uint32_t)last;
    return true;
}

/// Raises a voxel to what a tube has there: 255 in its middle, falling as a parabola. `min_radius`: see
/// MIN_RADIUS.
static void raise_voxel(const tube *t, double min_radius, const double p[3], uint8_t *voxel) {
    double from[3], along = 0, distance2 = 0;
    for (int k = 0; k < 3; k++) {
        from[k] = p[k] - t->from[k];
        along += from[k] * t->along[k];
    }
    along = along < 0 ? 0 : along > t->length ? t->length : along;
    const double true_radius = t->radius * (1 + (RADIUS_RATIO - 1) * along / t->length);
    const double radius = true_radius > min_radius ? true_radius : min_radius;
    const double share = true_radius / radius;
    for (int k = 0; k < 3; k++) {
        const double off = from[k] - along * t->along[k];
        distance2 += off * off;
    }
    const double value = 255 * share * share * (1 - distance2 / (radius * radius)) + 0.5;
    if (value > *voxel) *voxel = (uint8_t)value;
}

static void draw_tube(const generator *job, const tube *t) {
    uint32_t x[2], y[2], z[2];
    const double min_radius = MIN_RADIUS * job->step;
    const double reach = t->radius > min_radius ? t->radius : min_radius;
    double end[3], p[3];
    for (int k = 0; k < 3; k++) end[k] = t->from[k] + t->length * t->along[k];
    if (!find_voxels(job, 0, t->from[0], end[0], reach, x) ||
        !find_voxels(job, 1, t->from[1], end[1], reach, y) ||
        !find_voxels(job, 2, t->from[2], end[2], reach, z))
        return;
    const uint32_t *dims = job->volume->dims;
    uint8_t *voxels = job->volume->voxels;
    for (uint32_t k = z[0]; k <= z[1]; k++)
        for (uint32_t j = y[0]; j <= y[1]; j++)
            for (uint32_t i = x[0]; i <= x[1]; i++) {
                p[0] = job->first[0] + i * job->step;
                p[1] = job->first[1] + j * job->step;
                p[2] = job->first[2] + k * job->step;
                raise_voxel(t, min_radius, p, voxels + ((size_t)k * dims[1] + j) * dims[0] + i);
            }
}

static ewa_status draw_tree(ewa_context *context, generator *job) {
    for (uint32_t i = 0; i < TREE_TUBES; i++) {
        grow(job->options->seed, job->tubes, i);
        draw_tube(job, &job->tubes[i]);
        if (i % 64 == 0) EWA_TRY(ewa_progress(context, "generate", (double)i / TREE_TUBES));
    }
    return EWA_OK;
}

#define AT(member) offsetof(ewa_volume_generate_options, member)

static const ewa_option option_rows[] = {
    {"object", EWA_OPTION_CHOICE, AT(object), .words = "checkerbox|blob|ball|vessels",
     .help = "which volume is made"},
    {"dims", EWA_OPTION_U32, AT(dims), 2, UINT32_MAX, .count = 3, .initial = 128,
     .help = "voxels along each axis"},
    {"size_world", EWA_OPTION_F64, AT(size_world), 0, INFINITY, EWA_OPTION_ABOVE | EWA_OPTION_BELOW,
     .initial = 1, .help = "distance of the outermost voxels along the longest axis, in world units"},
    {"checks", EWA_OPTION_F64, AT(checks), 0, 1e6, EWA_OPTION_ABOVE, .initial = 8,
     .help = "cubes along an edge of checkerbox"},
    {"seed", EWA_OPTION_U64, AT(seed), 0, INFINITY, EWA_OPTION_BELOW,
     .help = "of the vessels: same seed, same bytes, on every machine"},
};

const ewa_option_table ewa_volume_generate_options_table =
    EWA_OPTION_TABLE(ewa_volume_generate_options, option_rows);

void ewa_volume_generate_options_init(ewa_volume_generate_options *options, size_t struct_size) {
    ewa_options_init(&ewa_volume_generate_options_table, options, struct_size);
}

ewa_status ewa_volume_generate(ewa_context *context, const ewa_volume_generate_options *given,
                               ewa_volume *volume) {
    if (!context || !given || !volume) return EWA_ERROR_ARGUMENT;
    *volume = (ewa_volume){0};
    ewa_volume_generate_options chosen, *options = &chosen;
    ewa_volume_generate_options_init(options, sizeof *options);
    EWA_TRY(ewa_options_take(context, &ewa_volume_generate_options_table, given, options));
    const bool floats = options->object == EWA_VOLUME_BLOB || options->object == EWA_VOLUME_BALL;
    ewa_status status = ewa_volume_create(context, options->dims, floats ? EWA_F32 : EWA_U8, volume);
    generator *job = status == EWA_OK ? ewa_allocate(context, 1, sizeof *job) : NULL;
    if (!job) {
        ewa_volume_free(volume);
        return status == EWA_OK ? EWA_ERROR_MEMORY : status;
    }
    uint32_t longest = 2;
    for (int axis = 0; axis < 3; axis++)
        if (options->dims[axis] > longest) longest = options->dims[axis];
    job->options = options;
    job->volume = volume;
    job->step = 1.0 / (longest - 1.0);
    for (int axis = 0; axis < 3; axis++) {
        job->first[axis] = -0.5 * job->step * (options->dims[axis] - 1.0);
        volume->index_to_world[5 * axis] = options->size_world * job->step;
        volume->index_to_world[4 * axis + 3] = options->size_world * job->first[axis];
    }
    if (options->object == EWA_VOLUME_VESSELS)
        status = draw_tree(context, job);
    else
        ewa_parallel(context, fill_slice, job, options->dims[2]);
    ewa_release(context, job, 1, sizeof *job);
    if (status != EWA_OK) ewa_volume_free(volume);
    return status;
}
