// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A depth camera that measures by disparity has noise and steps of one size in inverse depth, 1 / z. In the picture plane
// (a, b) = (x / z, y / z) of its eye a plane n.p = d has 1 / z = (n / d).(a, b, 1): it is linear there. So planes are
// fitted to inverse depths in windows of the picture, by sums over rectangles. The largest window counts whose residual is
// noise; at edges those beside the place do (M. Kuwahara et al., 1976), so that edges stay sharp
// (docs/math.md section 5; docs/quality.md says what it gives).
//
// F. Holzer, R. Rusu, M. Dixon, S. Gedikli, N. Navab, "Adaptive neighborhood selection for real-time surface normal
// estimation from organized point cloud data using integral images", 2012, choose windows by depth; here the residual does.
#include "estimate/noise.h"
#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    TASK_PLACES = 1 << 14,
    BATCH = 256,
    MAX_CELLS = 1 << 20,
    PROBES = 4096,  // windows by which the noise is found
    MIN_PROBES = 64,
    RUNS = 128, RUN_PLACES = 169, // a window of half side LARGE
    MIN_PLACES = 4096,
    SMALL = 3, LARGE = 6, // half sides of those, in cells
    RADIUS_COUNT = 4,
    MIN_POINTS = 12, // of a window
    GROUPS = 4,      // of depths: not every camera's noise is the same for all
};

static const int32_t RADIUS[RADIUS_COUNT] = {12, 8, 5, 3};
static const double WIDEST_COSINE = 0.4;       // of directions from their mean, of one picture
static const double NARROWEST_COSINE = 0.985;  // of the widest ones, of a camera that nobody told of
static const double LOW_SHARE = 0.25;          // of windows, the flattest ones, tells the noise
static const double MAX_GROWTH = 2.0;          // of the residual with the window's size: what grows more is a shape
static const double LEAST_NOISE = 0.2;         // standard deviation along the view, in samples' distances
static const double MOST_NOISE = 0.02;         // the same, as a share of the depth
static const double MOST_OF_GROUP = 4;         // noise of a group over that of all
static const double ACCEPTED = 1.25, OWN = 3;   // residuals, of the window and of the place itself, in standard deviations
static const double JITTER = 0.7;              // of samples sideways, in their distances, standard deviation
static const double LEAST_SHARE = 0.3;         // of a window's cells that have points
static const double MOST_STRETCH = 4;          // of samples on what is seen at a grazing angle

/// Sums over the points of a rectangle of the picture.
typedef struct sums {
    double n, a, b, w, aa, ab, bb, aw, bw, ww;
} sums;

enum { SUM_COUNT = sizeof(sums) / sizeof(double) };

/// A picture of inverse depths, as a table of sums over all that is left of and above each corner.
typedef struct picture {
    double eye[3], axis[3][3]; ///< columns, rows, view
    double low[2], cell;
    int32_t width, height;
    sums *corner; ///< [(height + 1) * (width + 1)]
    double sigma[GROUPS], until[GROUPS]; ///< noise of inverse depths, by groups of these, ascending
    double pitch;                        ///< distance of samples at depth 1
} picture;

typedef struct noise_job {
    const noise_input *input;
    const noise_output *output;
    picture picture;
    uint64_t *turned; // per task
} noise_job;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Where a place is in the picture; false behind or far beside the eye.
static bool project(const picture *p, const double position[3], double at[3]) {
    double d[3];
    for (int c = 0; c < 3; c++) d[c] = position[c] - p->eye[c];
    const double z = dot(d, p->axis[2]);
    if (!(z * z > WIDEST_COSINE * WIDEST_COSINE * dot(d, d) && z > 0)) return false;
    at[0] = dot(d, p->axis[0]) / z, at[1] = dot(d, p->axis[1]) / z, at[2] = 1 / z;
    return isfinite(at[2]);
}

/// Lets the picture look along the mean direction of the places. False where these are all around, or, for an eye that
/// nobody told of, in a narrow beam: from afar any thing is.
static bool aim(const noise_input *input, picture *p) {
    enum { SAMPLES = 1024 };
    double sum[3] = {0}, narrowest = 1;
    const uint32_t step = input->place_count / SAMPLES;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < SAMPLES; i++) {
            double place[1][3], d[3];
            ewa_neighbours_positions(input->neighbours, i * step, 1, place);
            for (int c = 0; c < 3; c++) d[c] = place[0][c] - p->eye[c];
            const double length = sqrt(dot(d, d));
            if (!(length > 0)) return false;
            narrowest = pass ? fmin(narrowest, dot(d, p->axis[2]) / length) : 1;
            for (int c = 0; c < 3 && !pass; c++) sum[c] += d[c] / length;
        }
        const double length = sqrt(dot(sum, sum));
        if (!(length > WIDEST_COSINE * SAMPLES)) return false;
        for (int c = 0; c < 3; c++) p->axis[2][c] = sum[c] / length;
    }
    const double *view = p->axis[2];
    const int least = fabs(view[0]) < 0.6 ? 0 : 1;
    const double across = sqrt(1 - view[least] * view[least]);
    for (int c = 0; c < 3; c++) p->axis[0][c] = ((c == least) - view[least] * view[c]) / across;
    for (int c = 0; c < 3; c++) {
        const int one = (c + 1) % 3, two = (c + 2) % 3;
        p->axis[1][c] = view[one] * p->axis[0][two] - view[two] * p->axis[0][one];
    }
    return narrowest > WIDEST_COSINE && (input->grid->given || narrowest < NARROWEST_COSINE);
}

/// Finds the box of all places in the picture plane, and cells of about one place each. False where one is beside it.
static bool frame(const noise_input *input, picture *p) {
    double high[2] = {-INFINITY, -INFINITY}, place[BATCH][3];
    p->low[0] = p->low[1] = INFINITY;
    for (uint32_t first = 0; first < input->place_count; first += BATCH) {
        const uint32_t left = input->place_count - first, count = left < BATCH ? left : BATCH;
        ewa_neighbours_positions(input->neighbours, first, count, place);
        for (uint32_t i = 0; i < count; i++) {
            double at[3];
            if (!project(p, place[i], at)) return false;
            for (int c = 0; c < 2; c++) p->low[c] = fmin(p->low[c], at[c]), high[c] = fmax(high[c], at[c]);
        }
    }
    const double wide = high[0] - p->low[0], tall = high[1] - p->low[1];
    const double cells = fmin(input->place_count, MAX_CELLS);
    p->cell = sqrt(wide * tall / cells);
    if (!(p->cell > 0) || wide > MAX_CELLS / 8 * p->cell || tall > MAX_CELLS / 8 * p->cell) return false;
    p->width = (int32_t)(wide / p->cell) + 1, p->height = (int32_t)(tall / p->cell) + 1;
    return true;
}

/// Numbers from the middle of the picture, so that sums of squares keep their digits.
static void center(const picture *p, double at[3]) {
    at[0] -= p->low[0] + 0.5 * p->width * p->cell;
    at[1] -= p->low[1] + 0.5 * p->height * p->cell;
}

static void cell_of(const picture *p, const double at[3], int32_t cell[2]) {
    for (int c = 0; c < 2; c++) {
        const int32_t last = (c ? p->height : p->width) - 1;
        const int32_t found = (int32_t)((at[c] - p->low[c]) / p->cell);
        cell[c] = found < last ? found : last;
    }
}

static void add(double *to, const double *from, double sign) {
    for (int k = 0; k < SUM_COUNT; k++) to[k] += sign * from[k];
}

/// Fills the table.
static ewa_status fill(ewa_context *context, const noise_input *input, picture *p) {
    const size_t row = (size_t)p->width + 1, rows = (size_t)p->height + 1;
    p->corner = ewa_allocate_zeroed(context, row * rows, sizeof *p->corner);
    if (!p->corner) return EWA_ERROR_MEMORY;
    double place[BATCH][3];
    for (uint32_t first = 0; first < input->place_count; first += BATCH) {
        const uint32_t left = input->place_count - first, count = left < BATCH ? left : BATCH;
        ewa_neighbours_positions(input->neighbours, first, count, place);
        for (uint32_t i = 0; i < count; i++) {
            double at[3];
            int32_t cell[2];
            project(p, place[i], at);
            cell_of(p, at, cell);
            center(p, at);
            const double a = at[0], b = at[1], w = at[2];
            const sums own = {1, a, b, w, a * a, a * b, b * b, a * w, b * w, w * w};
            add(&p->corner[((size_t)cell[1] + 1) * row + (size_t)cell[0] + 1].n, &own.n, 1);
        }
    }
    for (size_t y = 1; y < rows; y++) {
        sums line = {0};
        for (size_t x = 1; x < row; x++) {
            sums *corner = &p->corner[y * row + x];
            add(&line.n, &corner->n, 1);
            *corner = line;
            add(&corner->n, &p->corner[(y - 1) * row + x].n, 1);
        }
    }
    return EWA_OK;
}

/// A plane in a window: w = alpha a + beta b + gamma.
typedef struct fit {
    double count, alpha, beta, gamma, variance; ///< count 0: too few points
    double pitch; ///< distance of samples at depth 1
} fit;

static fit fit_sums(sums s) {
    fit made = {.count = 0};
    const double a = s.a / s.n, b = s.b / s.n, w = s.w / s.n;
    const double aa = s.aa - s.n * a * a, ab = s.ab - s.n * a * b, bb = s.bb - s.n * b * b;
    const double aw = s.aw - s.n * a * w, bw = s.bw - s.n * b * w, ww = s.ww - s.n * w * w;
    const double determinant = aa * bb - ab * ab;
    // Samples along a line carry no plane.
    if (!(determinant > 0.05 * aa * bb)) return made;
    made.alpha = (aw * bb - bw * ab) / determinant;
    made.beta = (bw * aa - aw * ab) / determinant;
    made.gamma = w - made.alpha * a - made.beta * b;
    made.variance = fmax(ww - made.alpha * aw - made.beta * bw, 0) / (s.n - 3);
    made.count = s.n;
    // The area of a rectangle that is evenly filled follows from its variances.
    made.pitch = sqrt(sqrt(12 * 12 * determinant) / s.n / s.n);
    return made;
}

/// Fits a plane to the cells up to `radius` from one in each direction.
static fit fit_window(const picture *p, int32_t x, int32_t y, int32_t radius) {
    const size_t row = (size_t)p->width + 1;
    const int32_t left = x < radius ? 0 : x - radius, up = y < radius ? 0 : y - radius;
    const int32_t right = x + radius + 1 < p->width ? x + radius + 1 : p->width;
    const int32_t down = y + radius + 1 < p->height ? y + radius + 1 : p->height;
    fit made = {.count = 0};
    if (right <= left || down <= up) return made;
    sums s = p->corner[(size_t)down * row + (size_t)right];
    add(&s.n, &p->corner[(size_t)up * row + (size_t)right].n, -1);
    add(&s.n, &p->corner[(size_t)down * row + (size_t)left].n, -1);
    add(&s.n, &p->corner[(size_t)up * row + (size_t)left].n, 1);
    const double side = 2 * radius + 1;
    return s.n < MIN_POINTS || s.n < LEAST_SHARE * side * side ? made : fit_sums(s);
}

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double low_share_of(double *numbers, uint32_t count) {
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    return numbers[(uint32_t)(LOW_SHARE * count)];
}

/// What one probe found.
typedef struct probe {
    double w, small, large, pitch; ///< residuals are standard deviations
} probe;

typedef struct probe_list {
    probe probes[PROBES];
    double numbers[PROBES]; ///< of them, to be sorted
} probe_list;

static int compare_probes(const void *a, const void *b) { return compare_numbers(&((const probe *)a)->w, &((const probe *)b)->w); }

/// Takes windows all over the picture; returns how many, by inverse depth.
static uint32_t take_probes(const noise_input *input, const picture *p, probe probes[PROBES]) {
    uint32_t count = 0;
    const uint32_t step = input->place_count / PROBES;
    for (uint32_t i = 0; i < PROBES; i++) {
        double place[1][3], at[3];
        int32_t cell[2];
        ewa_neighbours_positions(input->neighbours, i * step, 1, place);
        project(p, place[0], at);
        cell_of(p, at, cell);
        const fit few = fit_window(p, cell[0], cell[1], SMALL), many = fit_window(p, cell[0], cell[1], LARGE);
        if (few.count == 0 || many.count == 0) continue;
        probes[count++] = (probe){at[2], sqrt(few.variance), sqrt(many.variance), few.pitch};
    }
    qsort(probes, count, sizeof *probes, compare_probes);
    return count;
}

/// Whether there may be noise, by runs of places, which lie beside each other mostly: spares whoever has none the tables.
static bool may_have_noise(const noise_input *input, const picture *p) {
    double along[RUNS], place[RUN_PLACES][3];
    uint32_t count = 0;
    for (uint32_t i = 0; i < RUNS; i++) {
        const uint32_t first = (uint32_t)((uint64_t)(input->place_count - RUN_PLACES) * i / (RUNS - 1));
        ewa_neighbours_positions(input->neighbours, first, RUN_PLACES, place);
        double middle[3], at[3];
        bool inside = project(p, place[RUN_PLACES / 2], middle);
        sums s = {0};
        for (uint32_t k = 0; k < RUN_PLACES && inside; k++) {
            inside = project(p, place[k], at);
            const double a = at[0] - middle[0], b = at[1] - middle[1], w = at[2];
            const sums own = {1, a, b, w, a * a, a * b, b * b, a * w, b * w, w * w};
            add(&s.n, &own.n, 1);
        }
        const fit found = inside ? fit_sums(s) : (fit){.count = 0};
        if (found.count > 0) along[count++] = sqrt(found.variance) / middle[2] / found.pitch;
    }
    return count >= MIN_PROBES && low_share_of(along, count) > 0.5 * LEAST_NOISE;
}

/// Finds the noise; false where there is none to speak of.
static bool find_noise(const noise_input *input, probe_list *list, picture *p) {
    probe *probes = list->probes;
    double *numbers = list->numbers;
    const uint32_t count = take_probes(input, p, probes);
    if (count < MIN_PROBES) return false;
    for (uint32_t i = 0; i < count; i++) numbers[i] = probes[i].small;
    const double fine = low_share_of(numbers, count);
    for (uint32_t i = 0; i < count; i++) numbers[i] = probes[i].pitch;
    p->pitch = low_share_of(numbers, count);
    for (uint32_t i = 0; i < count; i++) numbers[i] = probes[i].large;
    const double sigma = low_share_of(numbers, count);
    for (uint32_t g = 0; g < GROUPS; g++) {
        const uint32_t first = count * g / GROUPS, end = count * (g + 1) / GROUPS;
        for (uint32_t i = first; i < end; i++) numbers[i] = probes[i].large;
        p->sigma[g] = fmin(low_share_of(numbers + first, end - first), MOST_OF_GROUP * sigma);
        p->until[g] = end < count ? probes[end].w : INFINITY;
    }
    const double along = sigma / probes[count / 2].w; // as a share of the depth
    return sigma < MAX_GROWTH * fine && along > LEAST_NOISE * p->pitch && along < MOST_NOISE;
}

static double sigma_of(const picture *p, double w) {
    uint32_t g = 0;
    while (g + 1 < GROUPS && w >= p->until[g]) g++;
    return p->sigma[g];
}

/// The plane of the largest window around or beside a place whose residual is noise; count 0: none is.
static fit find_plane(const picture *p, const double at[3]) {
    int32_t cell[2];
    double own[3] = {at[0], at[1], at[2]};
    cell_of(p, at, cell);
    center(p, own);
    const double sigma = sigma_of(p, at[2]), jitter = JITTER * p->pitch;
    for (int k = 0; k < RADIUS_COUNT; k++) {
        fit best = {.count = 0};
        const int windows = k == 0 ? 1 : 9; // the largest ones are too dear to be tried all around
        for (int window = 0; window < windows; window++) {
            // The one around the place first: if it will do, no other is looked at.
            const int dx = (window + 4) % 9 % 3 - 1, dy = (window + 4) % 9 / 3 - 1;
            const fit found = fit_window(p, cell[0] + dx * RADIUS[k], cell[1] + dy * RADIUS[k], RADIUS[k]);
            const double slope2 = found.alpha * found.alpha + found.beta * found.beta;
            const double noise2 = sigma * sigma + jitter * jitter * slope2;
            if (found.count == 0 || !(found.variance <= ACCEPTED * ACCEPTED * noise2)) continue;
            const double off = found.alpha * own[0] + found.beta * own[1] + found.gamma - own[2];
            if (off * off > OWN * OWN * noise2) continue;
            if (best.count == 0 || found.variance < best.variance) best = found;
            if (window == 0) break;
        }
        if (best.count > 0) return best;
    }
    return (fit){.count = 0};
}

/// Gives a place the normal of a plane, and its points discs that close the samples there.
static void turn(const noise_job *job, uint32_t place, const double position[3], const fit *plane) {
    const picture *p = &job->picture;
    // In the picture's axes; gamma counts from its middle.
    const double middle[2] = {p->low[0] + 0.5 * p->width * p->cell, p->low[1] + 0.5 * p->height * p->cell};
    const double n[3] = {plane->alpha, plane->beta, plane->gamma - plane->alpha * middle[0] - plane->beta * middle[1]};
    const double length = sqrt(dot(n, n));
    float *normal = &job->output->normals[3 * (size_t)place];
    double turned[3] = {0}, side = 0;
    if (!(length > 0)) return;
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 3; k++) turned[c] += n[k] / length * p->axis[k][c];
        side += turned[c] * (double)normal[c];
    }
    for (int c = 0; c < 3; c++) normal[c] = (float)(side < 0 ? -turned[c] : turned[c]);
    if (job->output->strewn) job->output->strewn[place] = 0;
    if (!job->output->radii) return;
    double d[3];
    for (int c = 0; c < 3; c++) d[c] = position[c] - p->eye[c];
    const double z = dot(d, p->axis[2]), facing = fabs(dot(turned, d)) / z;
    const double stretch = fmin(1 / fmax(facing, 1e-9), MOST_STRETCH);
    const float least = (float)(job->input->radius_scale * z * p->pitch * sqrt(0.5 * (1 + stretch * stretch)));
    uint32_t count;
    const uint32_t *points = ewa_neighbours_points(job->input->neighbours, place, &count);
    for (uint32_t i = 0; i < count; i++)
        if (job->output->radii[points[i]] < least) job->output->radii[points[i]] = least;
}

static void smooth_task(void *data, uint32_t task, uint32_t worker) {
    (void)worker;
    const noise_job *job = data;
    const uint32_t begin = task * TASK_PLACES, left = job->input->place_count - begin;
    const uint32_t end = begin + (left < TASK_PLACES ? left : TASK_PLACES);
    double place[BATCH][3];
    for (uint32_t first = begin; first < end; first += BATCH) {
        const uint32_t count = end - first < BATCH ? end - first : BATCH;
        ewa_neighbours_positions(job->input->neighbours, first, count, place);
        for (uint32_t i = 0; i < count; i++) {
            double at[3];
            project(&job->picture, place[i], at);
            const fit plane = find_plane(&job->picture, at);
            if (plane.count == 0) continue;
            turn(job, first + i, place[i], &plane);
            job->turned[task]++;
        }
    }
}

ewa_status ewa_noise_smooth(ewa_context *context, const noise_input *input, const noise_output *output, uint64_t *turned) {
    *turned = 0;
    if (input->place_count < MIN_PLACES) return EWA_OK;
    const uint32_t tasks = (input->place_count + TASK_PLACES - 1) / TASK_PLACES;
    noise_job job = {.input = input, .output = output};
    picture *p = &job.picture;
    memcpy(p->eye, input->grid->given ? input->grid->eye : input->world_origin, sizeof p->eye);
    if (!aim(input, p) || !may_have_noise(input, p) || !frame(input, p)) return EWA_OK;
    ewa_status status = fill(context, input, p);
    probe_list *list = ewa_allocate(context, 1, sizeof *list);
    if (!list) status = EWA_ERROR_MEMORY;
    if (status == EWA_OK && find_noise(input, list, p)) {
        job.turned = ewa_allocate_zeroed(context, tasks, sizeof *job.turned);
        status = job.turned ? ewa_parallel_stoppable(context, "estimate", smooth_task, &job, tasks) : EWA_ERROR_MEMORY;
        for (uint32_t i = 0; i < tasks && job.turned; i++) *turned += job.turned[i];
        ewa_release(context, job.turned, tasks, sizeof *job.turned);
    }
    ewa_release(context, list, 1, sizeof *list);
    ewa_release(context, p->corner, ((size_t)p->width + 1) * ((size_t)p->height + 1), sizeof *p->corner);
    return status;
}
