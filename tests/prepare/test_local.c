// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Every entry of the tables of src/estimate/local_body.h against its definition in double precision, written
// here a second time: the estimators' constants are held by this test alone.
#include "base/base.h"
#include "estimate/local.h"
#include "prepare/check_prepare.h"

#define PI 3.141592653589793

enum { PLACES = 220, WAYS = 16, BLOCKS = 60 };

typedef struct plain {
    int count; ///< of neighbours, the place itself included
    double normal[3], value[3], spacing, line_spacing, variation;
    bool thin, degenerate, doubtful;
    double reach, ellipse_reach, aspect, major[3];
    bool close_call; ///< some decision hangs on the last digits
} plain;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int c = 0; c < 3; c++) out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

static void scale_to_unit(double v[3]) {
    const double length = sqrt(dot(v, v));
    for (int c = 0; c < 3; c++) v[c] /= length;
}

static bool is_inside(const ewa_block *block, uint32_t i, uint32_t lane) {
    return block->distance2[i][lane] <= block->radius2[lane];
}

static void offset_of(const ewa_block *block, uint32_t i, uint32_t lane, double d[3]) {
    d[0] = (double)block->x[i] - (double)block->lane_x[lane];
    d[1] = (double)block->y[i] - (double)block->lane_y[lane];
    d[2] = (double)block->z[i] - (double)block->lane_z[lane];
}

/// Eigenvalues descending and their vectors as rows, by Jacobi's rotations.
static void decompose(double a[3][3], double value[3], double vector[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) vector[i][j] = i == j;
    for (int turn = 0; turn < 60; turn++) {
        const int p = turn % 3 == 2, q = turn % 3 == 0 ? 1 : 2;
        if (a[p][q] == 0) continue;
        const double angle = 0.5 * atan2(2 * a[p][q], a[p][p] - a[q][q]), c = cos(angle), s = sin(angle);
        for (int k = 0; k < 3; k++) {
            const double x = a[p][k], y = a[q][k];
            a[p][k] = c * x + s * y, a[q][k] = c * y - s * x;
        }
        for (int k = 0; k < 3; k++) {
            const double x = a[k][p], y = a[k][q];
            a[k][p] = c * x + s * y, a[k][q] = c * y - s * x;
            const double v = vector[p][k], w = vector[q][k];
            vector[p][k] = c * v + s * w, vector[q][k] = c * w - s * v;
        }
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 3; j++)
            if (a[order[j]][order[j]] > a[order[i]][order[i]]) {
                const int swapped = order[i];
                order[i] = order[j], order[j] = swapped;
            }
    double sorted[3][3];
    for (int i = 0; i < 3; i++) {
        value[i] = a[order[i]][order[i]];
        memcpy(sorted[i], vector[order[i]], sizeof sorted[i]);
    }
    memcpy(vector, sorted, sizeof sorted);
}

static bool near_value(double a, double b) { return fabs(a - b) < 2e-3 * fabs(b); }

/// Spacing (Poisson, with the border's correction), flags and frame. `given`: NULL, or the normal to take.
static void measure_plane(const ewa_block *block, uint32_t lane, const double *given, plain *s,
                          double frame[2][3]) {
    double first[3] = {0}, second[3][3] = {{0}}, covariance[3][3], vector[3][3];
    s->count = 0;
    for (uint32_t i = 0; i < block->candidate_count; i++) {
        if (!is_inside(block, i, lane)) continue;
        double d[3];
        offset_of(block, i, lane, d);
        s->count++;
        for (int a = 0; a < 3; a++) {
            first[a] += d[a];
            for (int b = 0; b < 3; b++) second[a][b] += d[a] * d[b];
        }
    }
    const double n = s->count, others = n - 1;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) covariance[a][b] = second[a][b] / n - first[a] * first[b] / (n * n);
    decompose(covariance, s->value, vector);
    const double all = s->value[0] + s->value[1] + s->value[2];
    s->variation = s->value[2] / all;
    s->thin = n < 3 || s->value[1] <= 0.05 * s->value[0];
    s->degenerate = n < 3 || s->value[1] <= 1e-3 * s->value[0];
    s->close_call |=
        near_value(s->value[1], 0.05 * s->value[0]) || near_value(s->value[1], 1e-3 * s->value[0]);
    memcpy(s->normal, given ? given : vector[2], sizeof s->normal);
    memcpy(frame[0], vector[0], sizeof frame[0]);
    if (given) {
        const double helper[3] = {fabs(given[2]) > 0.9, 0, !(fabs(given[2]) > 0.9)};
        cross(given, helper, frame[1]);
        scale_to_unit(frame[1]);
        cross(frame[1], given, frame[0]);
    } else {
        int largest = 0;
        for (int c = 1; c < 3; c++)
            if (fabs(s->normal[c]) > fabs(s->normal[largest])) largest = c;
        const double sign = s->normal[largest] < 0 ? -1 : 1;
        for (int c = 0; c < 3; c++) s->normal[c] *= sign;
        cross(s->normal, frame[0], frame[1]);
    }
    double squares = 0, across = 0, along[3];
    for (int a = 0; a < 3; a++) {
        squares += second[a][a];
        for (int b = 0; b < 3; b++) across += s->normal[a] * second[a][b] * s->normal[b];
    }
    const double tangential = squares - across, lean = dot(first, s->normal);
    for (int c = 0; c < 3; c++) along[c] = first[c] - lean * s->normal[c];
    const double offset = dot(along, along) / (others * tangential), noise = 2 / others;
    double area = 2 * PI * tangential / (others * (others + 1.3));
    if (noise < 0.36) area *= fmax(0.25, 1 / (1 + fmax(0, offset - noise) / fmax(0.36 - noise, 0.05)));
    s->spacing = sqrt(area);
    s->line_spacing = sqrt(12 * (squares - dot(first, first) / others) / pow(others, 3));
}

/// Extents of the cell in 16 directions, which of them are open and which bounded by a neighbour within 30
/// degrees.
static void measure_cell(const ewa_block *block, uint32_t lane, double frame[2][3], double limit,
                         bool enclosed, bool shape, plain *s) {
    double extent[WAYS], uu = 0, uv = 0, vv = 0;
    bool open[WAYS], shut[WAYS];
    for (uint32_t i = 0; i < block->candidate_count && shape; i++) {
        double d[3];
        offset_of(block, i, lane, d);
        const double d2 = dot(d, d);
        if (!is_inside(block, i, lane) || d2 == 0) continue;
        const double u = dot(d, frame[0]) / d2, v = dot(d, frame[1]) / d2;
        uu += u * u, uv += u * v, vv += v * v;
    }
    const double turn = shape ? 0.5 * atan2(2 * uv, uu - vv) : 0;
    double axis[2][3];
    for (int c = 0; c < 3; c++) {
        axis[0][c] = cos(turn) * frame[0][c] + sin(turn) * frame[1][c];
        axis[1][c] = cos(turn) * frame[1][c] - sin(turn) * frame[0][c];
    }
    for (int w = 0; w < WAYS; w++) {
        const double x = cos(w * PI / 8), y = sin(w * PI / 8);
        double maximum = 1e-30, cosine = 0;
        for (uint32_t i = 0; i < block->candidate_count; i++) {
            double d[3];
            offset_of(block, i, lane, d);
            const double d2 = dot(d, d), t = x * dot(d, axis[0]) + y * dot(d, axis[1]);
            if (!is_inside(block, i, lane) || d2 == 0) continue;
            maximum = fmax(maximum, t / d2);
            cosine = fmax(cosine, t / sqrt(d2));
        }
        extent[w] = 0.5 / maximum;
        open[w] = extent[w] > limit;
        shut[w] = !open[w] && (!enclosed || cosine >= sqrt(0.75));
        s->close_call |= near_value(extent[w], limit) || (enclosed && near_value(cosine, sqrt(0.75)));
        s->doubtful |= open[w];
    }
    double xx = 0, xy = 0, yy = 0;
    for (int w = 0; w < WAYS; w++) {
        const int opposite = (w + WAYS / 2) % WAYS;
        const double t = shut[w] ? extent[w] : shut[opposite] ? extent[opposite] : s->spacing;
        const double x = cos(w * PI / 8), y = sin(w * PI / 8), weight = pow(t / s->spacing, 4);
        xx += weight * x * x, xy += weight * x * y, yy += weight * y * y;
    }
    const double angle = 0.5 * atan2(2 * xy, xx - yy), spread = hypot((xx - yy) / 2, xy);
    s->aspect = fmin(4, sqrt(((xx + yy) / 2 + spread) / ((xx + yy) / 2 - spread)));
    for (int c = 0; c < 3; c++) s->major[c] = cos(angle) * axis[0][c] + sin(angle) * axis[1][c];
    for (int w = 0; w < WAYS; w++) {
        if (!shut[w] || open[(w + 1) % WAYS] || open[(w + WAYS - 1) % WAYS]) continue;
        const double between = w * PI / 8 - angle;
        const double stretch = pow(cos(between), 2) / s->aspect + pow(sin(between), 2) * s->aspect;
        s->reach = fmax(s->reach, 1.08 * extent[w]);
        s->ellipse_reach = fmax(s->ellipse_reach, 1.08 * extent[w] * sqrt(stretch));
    }
}

/// A place among others that are, by turns, on a plane, beside its border, on lines, on a bent surface,
/// anywhere, far apart one way and on a strip, whose parts are by some as thin as lines.
static void make_place(int kind, int i, check_random *random, double p[3]) {
    const double x = check_uniform(random, -1, 1), y = check_uniform(random, -1, 1);
    p[0] = x, p[1] = y, p[2] = 0.02 * x;
    if (kind == 1) p[0] = fabs(x) * 1.3;
    if (kind == 2) p[1] = (i % 5 - 2) * 0.25 + 0.01 * y;
    if (kind == 3) p[2] = 0.4 * x * y + 0.03 * check_uniform(random, -1, 1);
    if (kind == 4) p[2] = check_uniform(random, -1, 1);
    if (kind == 5) p[0] = 4 * x, p[2] += 0.5 * y;
    if (kind == 6) p[1] = 0.065 * y;
}

static void make_block(int number, ewa_block *block) {
    check_random random = {(uint64_t)number + 1};
    double place[PLACES][3];
    for (int i = 0; i < PLACES; i++) make_place(number % 7, i, &random, place[i]);
    // The lanes are the places nearest to one of them.
    const uint32_t neighbours = number / 7 % 3 == 0 ? 8 : number / 7 % 3 == 1 ? 16 : 64;
    memset(block, 0, sizeof *block);
    block->candidate_count = PLACES;
    block->lane_count = number % 4 ? 16 : 11;
    block->first_place = 0;
    block->unit_world = 1;
    for (int i = 0; i < PLACES; i++) {
        block->x[i] = (float)place[i][0], block->y[i] = (float)place[i][1], block->z[i] = (float)place[i][2];
        block->place[i] = (uint32_t)i;
    }
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) {
        const uint32_t from = lane < block->lane_count ? lane : 0;
        block->lane_x[lane] = block->x[from], block->lane_y[lane] = block->y[from];
        block->lane_z[lane] = block->z[from];
        float sorted[PLACES];
        for (uint32_t i = 0; i < PLACES; i++) {
            double d[3];
            offset_of(block, i, lane, d);
            const float distance2 = (float)dot(d, d);
            block->distance2[i][lane] = distance2;
            uint32_t to = i;
            for (; to > 0 && sorted[to - 1] > distance2; to--) sorted[to] = sorted[to - 1];
            sorted[to] = distance2;
        }
        block->radius2[lane] = sorted[neighbours];
    }
}

/// How many lanes were held to the definition, over all blocks.
typedef struct tally {
    int plane, thin, reach, shape, enclosed, doubtful, certain;
} tally;

static void assert_close_at(double got, double wanted, double tolerance, int line) {
    if (fabs(got - wanted) <= tolerance * fabs(wanted) + 1e-6) return;
    print_message("line %d: %.7g is not %.7g\n", line, got, wanted);
    fail();
}

#define assert_close(got, wanted, tolerance) assert_close_at(got, wanted, tolerance, __LINE__)

static void hold_plane(const local_surface *got, const plain *s, uint32_t lane, tally *t) {
    if (s->close_call) return;
    assert_int_equal(got->thin >> lane & 1, s->thin);
    assert_int_equal(got->degenerate >> lane & 1, s->degenerate);
    if (s->thin) assert_close((double)got->line_spacing[lane], s->line_spacing, 1e-3);
    t->thin += s->thin;
    if (s->degenerate) return;
    assert_close((double)got->spacing[lane], s->spacing, 1e-3);
    assert_close((double)got->variation[lane], s->variation, 1e-2);
    double cosine = 0;
    for (int c = 0; c < 3; c++) cosine += (double)got->normal[c][lane] * s->normal[c];
    assert_true(fabs(cosine) > 1 - 1e-4);
    t->plane++;
}

static void hold_shape(const local_surface *got, const plain *s, uint32_t lane) {
    assert_close((double)got->aspect[lane], s->aspect, 5e-3);
    assert_close((double)got->ellipse_reach[lane], s->ellipse_reach, 5e-3);
    double cosine = 0;
    for (int c = 0; c < 3; c++) cosine += (double)got->major[c][lane] * s->major[c];
    if (s->aspect > 1.1) assert_true(fabs(cosine) > 0.999);
}

static void hold_measure(const local_kernels *kernels, const ewa_block *block, tally *t) {
    static local_batch batch;
    local_surface round, oval;
    memset(&batch, 0x7f, sizeof batch);
    kernels->measure(block, LOCAL_REACH, &batch, &round);
    kernels->measure(block, LOCAL_SHAPE, &batch, &oval);
    double spacings[EWA_BLOCK_LANES];
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        double frame[2][3];
        plain disc = {.count = 0};
        measure_plane(block, lane, NULL, &disc, frame);
        hold_plane(&round, &disc, lane, t);
        uint32_t to = lane;
        for (; to > 0 && spacings[to - 1] > (double)round.spacing[lane]; to--)
            spacings[to] = spacings[to - 1];
        spacings[to] = (double)round.spacing[lane];
        // Where two directions are as good the frame is anyone's.
        if (disc.degenerate || disc.value[1] > 0.95 * disc.value[0] || disc.value[2] > 0.9 * disc.value[1])
            continue;
        plain ellipse = disc;
        measure_cell(block, lane, frame, 2 * disc.spacing, false, false, &disc);
        measure_cell(block, lane, frame, 2 * disc.spacing, false, true, &ellipse);
        if (!disc.close_call) {
            assert_close((double)round.reach[lane], disc.reach, 3e-3);
            disc.doubtful |= disc.variation > 0.11;
            if (!near_value(disc.variation, 0.11))
                assert_int_equal(round.doubtful >> lane & 1, disc.doubtful);
            t->reach++, t->doubtful += disc.doubtful, t->certain += !disc.doubtful;
        }
        if (!ellipse.close_call) hold_shape(&oval, &ellipse, lane), t->shape++;
    }
    assert_true((double)round.median_spacing == spacings[(block->lane_count - 1) / 2]);
}

/// The block's places in a batch, the last one first.
static local_batch *collect(const local_kernels *kernels, const ewa_block *block, const float *values) {
    static local_batch batch;
    memset(&batch, 0x7f, sizeof batch);
    batch.lane_count = 0;
    for (uint32_t lane = block->lane_count; lane-- > 0;) {
        assert_int_equal(kernels->collect(block, 1u << lane, values, &batch), 0);
        assert_int_equal(batch.place[batch.lane_count - 1], lane);
    }
    assert_int_equal(batch.lane_count, block->lane_count);
    return &batch;
}

/// A batch takes what it has room for.
static void hold_batch(const local_kernels *kernels, const ewa_block *block, const float *values) {
    static local_batch batch;
    batch.lane_count = 6;
    assert_int_equal(kernels->collect(block, 0x7ff, values, &batch), 0x400);
    assert_int_equal(batch.lane_count, EWA_BLOCK_LANES);
    for (uint32_t lane = 6; lane < EWA_BLOCK_LANES; lane++) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < PLACES; i++) {
            if (!is_inside(block, i, lane - 6)) continue;
            const local_row *row = &batch.row[count++];
            assert_true(row->value[lane] == values[i] &&
                        row->distance2[lane] == block->distance2[i][lane - 6] &&
                        row->x[lane] == block->x[i] - block->lane_x[lane - 6]);
        }
        assert_int_equal(batch.count[lane], count);
        assert_int_equal(batch.place[lane], lane - 6);
    }
}

static void hold_enclose(const local_kernels *kernels, const ewa_block *block, tally *t) {
    float normal[3][EWA_BLOCK_LANES], limit[EWA_BLOCK_LANES];
    double given[EWA_BLOCK_LANES][3];
    for (uint32_t lane = 0; lane < EWA_BLOCK_LANES; lane++) {
        given[lane][0] = 0.1 * lane - 0.7, given[lane][1] = 0.2, given[lane][2] = 1 - 0.05 * lane;
        scale_to_unit(given[lane]);
        for (int c = 0; c < 3; c++) {
            normal[c][lane] = (float)given[lane][c];
            given[lane][c] = (double)normal[c][lane];
        }
        limit[lane] = 0.05f + 0.03f * (float)lane;
    }
    local_surface got, oval;
    local_batch *batch = collect(kernels, block, (const float[PLACES]){0});
    kernels->enclose(batch, LOCAL_REACH, (const float(*)[EWA_BLOCK_LANES])normal, limit, &got);
    kernels->enclose(batch, LOCAL_SHAPE, (const float(*)[EWA_BLOCK_LANES])normal, limit, &oval);
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        const uint32_t from = block->lane_count - 1 - lane;
        double frame[2][3];
        plain s = {.count = 0};
        measure_plane(block, from, given[lane], &s, frame);
        assert_close((double)got.spacing[lane], s.spacing, 1e-3);
        plain ellipse = s;
        measure_cell(block, from, frame, (double)limit[lane], true, false, &s);
        measure_cell(block, from, frame, (double)limit[lane], true, true, &ellipse);
        if (!s.close_call) assert_close((double)got.reach[lane], s.reach, 3e-3), t->enclosed += s.reach > 0;
        if (!ellipse.close_call) hold_shape(&oval, &ellipse, lane);
    }
    assert_int_equal(got.doubtful, 0);
}

static void hold_size(const local_kernels *kernels, bool gaps_later, check_random *random) {
    local_surface s = {.median_spacing = 0.7f};
    const local_sizing sizing = {.scale = 1.2f, .cover = 1.5f, .gaps_later = gaps_later, .thin_cover = 1.4f,
                                 .limit = 2.4f, .ratio_steps = 16, .max_steps = 63};
    for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++) {
        s.spacing[i] = (float)check_uniform(random, 0.1, 2);
        s.reach[i] = s.spacing[i] * (float)check_uniform(random, 0, 2);
        s.ellipse_reach[i] = s.spacing[i] * (float)check_uniform(random, 0, 2);
        s.variation[i] = (float)check_uniform(random, 0, i % 2 ? 0.15 : 0.02);
    }
    for (uint32_t wanted = LOCAL_REACH; wanted <= LOCAL_SHAPE; wanted++) {
        s.doubtful = 0x7fff;
        kernels->size(wanted, &sizing, &s);
        for (uint32_t i = 0; i < EWA_BLOCK_LANES; i++) {
            const double spacing = (double)s.spacing[i];
            const double reach = (double)(wanted == LOCAL_SHAPE ? s.ellipse_reach[i] : s.reach[i]);
            const double thick = gaps_later ? fmax(0, fmin(1, (double)s.variation[i] / 0.007 - 1)) : 1;
            const double wide = (1.4 + 0.1 * thick) * (reach + thick * fmax(0, reach - spacing));
            const double closed = fmin(wide, 2.4 * fmin(spacing, 0.7));
            const double radius = fmax(1.2 * spacing, closed), steps = fmin(63, radius / spacing * 16 + 1);
            assert_close((double)s.radius[i], radius, 1e-5);
            const bool at_limit = closed >= 2.4 * fmin(spacing, 0.7) * (1 - 1e-6);
            assert_int_equal(s.doubtful >> i & 1, i < 15 && ((double)s.variation[i] > 0.11 || !at_limit));
            assert_true(fabs((double)s.ratio[i] + 0.5 - steps) < 0.501);
        }
    }
}

/// Discs grow where kernels are too few at the farthest corner, by what closes it if all grow alike, up to a limit.
static void hold_growth(const local_kernels *kernels, check_random *random) {
    local_gaps gaps = {.count = 40};
    float radius[40], grown[EWA_BLOCK_LANES];
    for (uint32_t i = 0; i < gaps.count; i++) {
        gaps.x[i] = (float)check_uniform(random, -3, 3), gaps.y[i] = (float)check_uniform(random, -3, 3);
        gaps.z[i] = (float)check_uniform(random, -0.1, 0.1);
        gaps.kernel[i] = radius[i] = (float)check_uniform(random, 0.8, 2);
    }
    for (int i = 0; i < EWA_BLOCK_LANES; i++) {
        for (int c = 0; c < 3; c++) gaps.corner[c][i] = (float)check_uniform(random, -2, 2);
        gaps.radius[i] = (float)check_uniform(random, 0.8, 2), gaps.limit[i] = i == 3 ? 0.5f : 2.2f;
        gaps.reach2[i] = i == 5 ? 0 : (float)check_uniform(random, 0.1, 4);
    }
    kernels->grow(&gaps, 0.6f, 3, grown);
    for (int i = 0; i < EWA_BLOCK_LANES; i++) {
        double sum = 0;
        for (uint32_t k = 0; k < gaps.count; k++) {
            const double x = (double)(gaps.x[k] - gaps.corner[0][i]), y = (double)(gaps.y[k] - gaps.corner[1][i]);
            const double z = (double)(gaps.z[k] - gaps.corner[2][i]), sigmas = 3 / (double)radius[k];
            sum += pow(fmax(0, 1 - sigmas * sigmas * (x * x + y * y + z * z) / 32), 16);
        }
        const double own = (double)gaps.radius[i], exponent = fmax(0.5, 4.5 * (double)gaps.reach2[i] / (own * own));
        const double ratio = 0.6 / fmax(sum, 1e-6), step = (ratio - 1) / ((ratio + 1) * exponent);
        const double by = fmin(1.5, 1 + step + step * step / 2);
        const bool grows = sum < 0.6 && gaps.reach2[i] > 0;
        assert_close((double)grown[i], grows ? fmax(own, fmin(own * by, (double)gaps.limit[i])) : own, 1e-4);
    }
}

static void hold_median(const local_kernels *kernels, const ewa_block *block, check_random *random) {
    float values[PLACES], around[EWA_BLOCK_LANES], farthest2[EWA_BLOCK_LANES];
    for (int i = 0; i < PLACES; i++) values[i] = (float)exp(check_uniform(random, -3, 3));
    hold_batch(kernels, block, values);
    kernels->median(collect(kernels, block, values), around, farthest2);
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        float sorted[PLACES], farthest = 0;
        uint32_t count = 0;
        for (uint32_t i = 0; i < PLACES; i++) {
            if (!is_inside(block, i, block->lane_count - 1 - lane)) continue;
            farthest = fmaxf(farthest, block->distance2[i][block->lane_count - 1 - lane]);
            uint32_t to = count++;
            for (; to > 0 && sorted[to - 1] > values[i]; to--) sorted[to] = sorted[to - 1];
            sorted[to] = values[i];
        }
        assert_true(fabs(log((double)(around[lane] / sorted[(count - 1) / 2]))) < 6.0 / 256 + 1e-5);
        assert_true(farthest2[lane] == farthest);
    }
}

static void hold_distances(const local_kernels *kernels, const ewa_block *block) {
    static local_batch batch;
    local_surface s;
    local_graph graph;
    kernels->measure(block, 0, &batch, &s);
    kernels->link(block, &batch, graph);
    kernels->measure_distance(block, &s);
    for (uint32_t lane = 0; lane < block->lane_count; lane++) {
        double sum = 0, sorted[PLACES];
        uint32_t count = 0;
        for (uint32_t i = 0; i < PLACES; i++) {
            if (i == lane || !is_inside(block, i, lane)) continue;
            const double distance = sqrt((double)block->distance2[i][lane]);
            sum += distance;
            uint32_t to = count++;
            for (; to > 0 && sorted[to - 1] > distance; to--) sorted[to] = sorted[to - 1];
            sorted[to] = distance;
        }
        assert_close((double)s.mean_distance[lane], sum / count, 1e-5);
        for (uint32_t i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
            assert_true(graph[lane][i] < PLACES && graph[lane][i] != lane);
            assert_close(sqrt((double)block->distance2[graph[lane][i]][lane]), sorted[i], 2e-4);
            for (uint32_t k = 0; k < i; k++) assert_true(graph[lane][i] != graph[lane][k]);
        }
    }
}

TEST(test_tables) {
    static const uint32_t masks[] = {0, EWA_CPU_AVX2, EWA_CPU_ALL};
    static ewa_block block;
    for (int k = 0; k < 3; k++) {
        const local_kernels *kernels = EWA_CHOOSE(masks[k] & ewa_cpu_detect(), ewa_local_kernels);
        tally t = {0};
        check_random random = {77};
        for (int i = 0; i < BLOCKS; i++) {
            make_block(i, &block);
            hold_measure(kernels, &block, &t);
            hold_enclose(kernels, &block, &t);
            hold_median(kernels, &block, &random);
            hold_distances(kernels, &block);
            hold_size(kernels, false, &random), hold_size(kernels, true, &random);
        hold_growth(kernels, &random);
        }
        print_message("%d planes, %d thin, %d reaches, %d doubtful, %d certain, %d shapes, %d enclosed\n",
                      t.plane, t.thin, t.reach, t.doubtful, t.certain, t.shape, t.enclosed);
        assert_true(t.plane > 500 && t.thin > 20 && t.reach > 200 && t.shape > 150 && t.enclosed > 150 &&
                    t.doubtful > 100 && t.certain > 30);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
