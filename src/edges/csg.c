// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Constructive solid geometry of two closed surfel solids.
//
// Surfels far from the other surface are kept or left out node by node. Those that its planes may cut become
// four smaller ones, again until they are as fine as the other's and no more than two lines meet in one of
// them; each piece is kept, left out, or kept with the lines in which the other's planes meet its own.
//
// Based on B. Adams, P. Dutre, "Interactive boolean operations on surfel-bounded solids", 2003 (sections 4
// and 5: classification, resampling near the intersection), with the clip lines of M. Zwicker et al.,
// "Perspective Accurate Splatting", 2004, section 5, in place of its many small surfels.
#include "base/base.h"
#include "base/options.h"
#include "cloud/cloud.h"
#include "edges/csg_lines.h"
#include "edges/solid.h"

#include <math.h>
#include <string.h>

enum { TASK_SURFELS = 512, SPLIT_LEVELS = 4, PIECES = 4 };

/// A piece's axes, and how far it is from the middle of its parent along each axis, in units of the parent's.
#define PIECE_SIZE  0.55
#define PIECE_SHIFT 0.66

/// Surfaces are the same where the sine of their angle and the distance in units of the reach are below.
#define SAME_SINE     0.1
#define SAME_DISTANCE 0.1

/// Share of the area that the normals of a closed surface may sum up to.
#define MAX_OPENNESS 0.1

typedef enum fate { FATE_DROP = 0, FATE_KEEP = 1, FATE_NEAR = 2 } fate;

/// What one operand keeps of itself.
typedef struct keep_rule {
    double side;                  ///< 1: what is outside of the other, -1: inside
    bool flip;                    ///< normals are turned
    bool same_keeps, other_keeps; ///< where surfaces coincide, with normals along or against each other
} keep_rule;

typedef struct csg_job {
    const ewa_solid *solid, *other;
    keep_rule rule;
    bool second; ///< of the two operands
    double cutoff;
    uint8_t *fate;    // [solid->count]
    uint32_t *doubts; // [parts] places whose side contradicts that of a place that no surface parts from them
    uint32_t *near;   // surfels with FATE_NEAR, ascending
    uint32_t near_count;
    uint32_t *piece_first; // [near_count + 1]
    struct csg_piece *pieces;
} csg_job;

/// What is left of a surfel that the other surface cuts.
typedef struct csg_piece {
    ewa_vec3 center, axis[2];
    uint32_t surfel;
    ewa_line_set lines;
} csg_piece;

/// The line in which a plane of the other surface, seen from `at` = (u, v) of the disc, meets the disc's
/// plane.
static ewa_vec3 meet(const csg_job *job, const csg_piece *piece, ewa_vec3 own_normal, ewa_vec3 normal,
                     double distance, const double at[2]) {
    const double along = vec3_dot(normal, own_normal), side = job->rule.side;
    const double reach = job->cutoff * fmax(vec3_length(piece->axis[0]), vec3_length(piece->axis[1]));
    if (1 - along * along < SAME_SINE * SAME_SINE && fabs(distance) < SAME_DISTANCE * reach) {
        const bool keeps = along > 0 ? job->rule.same_keeps : job->rule.other_keeps;
        return vec3_make(0, 0, keeps ? 1 : -1);
    }
    const double a = vec3_dot(normal, piece->axis[0]), b = vec3_dot(normal, piece->axis[1]);
    return vec3_scale(vec3_make(a, b, distance - a * at[0] - b * at[1]), side);
}

/// The lines that the other surface asks for, after `looks` looks: the second is at the place where the first
/// saw it meet the disc, and so on.
static ewa_line_set lines_of(const csg_job *job, const csg_piece *piece, int looks,
                             ewa_local_surface *surface) {
    const ewa_vec3 own_normal = job->solid->surfels[piece->surfel].normal;
    const double reach = job->cutoff * fmax(vec3_length(piece->axis[0]), vec3_length(piece->axis[1]));
    double at[2] = {0, 0};
    ewa_line_set lines = {.count = 0};
    for (int look = 0; look < looks; look++) {
        const ewa_vec3 place = vec3_add(
            piece->center, vec3_add(vec3_scale(piece->axis[0], at[0]), vec3_scale(piece->axis[1], at[1])));
        ewa_local_surface seen;
        ewa_solid_look(job->other, place, &seen);
        *surface = seen;
        if (look == 0 && seen.nearest > reach + seen.reach) {
            // No surface here: planes that go on beyond their ends say nothing.
            const bool keeps = (seen.mean_distance > 0) == (job->rule.side > 0);
            return (ewa_line_set){.line = {vec3_make(0, 0, keeps ? 1 : -1)}, .count = 1};
        }
        lines.count = seen.plane_count;
        for (uint32_t k = 0; k < seen.plane_count; k++)
            lines.line[k] = meet(job, piece, own_normal, seen.normal[k], seen.distance[k], at);
        // Outside of a convex edge is in front of either plane; inside is behind both.
        lines.either = seen.plane_count == 2 && seen.convex == (job->rule.side > 0);
        uint32_t nearest = 0;
        if (lines.count == 2 && fabs(ewa_line_depth(lines.line[1])) < fabs(ewa_line_depth(lines.line[0])))
            nearest = 1;
        if (ewa_line_share(lines.line[nearest], job->cutoff) != EWA_DISC_PART) break;
        const ewa_vec3 l = lines.line[nearest];
        const double scale = -l.z / (l.x * l.x + l.y * l.y);
        at[0] = scale * l.x;
        at[1] = scale * l.y;
    }
    return lines;
}

/// The quarter of a piece at a sign along each axis, its own lines with it.
static csg_piece quarter(const csg_piece *piece, double su, double sv) {
    const double u = su * PIECE_SHIFT, v = sv * PIECE_SHIFT;
    csg_piece part = *piece;
    part.center =
        vec3_add(piece->center, vec3_add(vec3_scale(piece->axis[0], u), vec3_scale(piece->axis[1], v)));
    for (int k = 0; k < 2; k++) part.axis[k] = vec3_scale(piece->axis[k], PIECE_SIZE);
    for (uint32_t k = 0; k < piece->lines.count; k++) {
        const ewa_vec3 l = piece->lines.line[k];
        part.lines.line[k] = vec3_make(PIECE_SIZE * l.x, PIECE_SIZE * l.y, l.z + l.x * u + l.y * v);
    }
    return part;
}

/// Cuts a piece by the other surface; writes what is left at `out` unless that is NULL, returns its count.
static uint32_t cut(const csg_job *job, const csg_piece *piece, uint32_t level, csg_piece *out) {
    csg_piece left = *piece;
    if (ewa_lines_prune(&left.lines, job->cutoff) == EWA_DISC_NONE) return 0;
    ewa_local_surface surface;
    // What is going to be split is looked at again in parts.
    ewa_line_set asked = lines_of(job, piece, level == 0 ? 1 : 2, &surface);
    const ewa_disc_share share = ewa_lines_prune(&asked, job->cutoff);
    if (share == EWA_DISC_NONE) return 0;
    if (share == EWA_DISC_PART) {
        const ewa_line_set own = left.lines;
        if (ewa_lines_exclude(&own, &asked, job->cutoff)) return 0;
        const bool complete = ewa_lines_join(&own, &asked, &left.lines);
        const double reach = job->cutoff * fmax(vec3_length(piece->axis[0]), vec3_length(piece->axis[1]));
        const bool coarse = level == 0 || reach > 1.2 * surface.reach;
        if (level < SPLIT_LEVELS && (coarse || !complete)) {
            uint32_t count = 0;
            for (int i = 0; i < PIECES; i++) {
                const csg_piece part = quarter(piece, i & 1 ? 1 : -1, i & 2 ? 1 : -1);
                count += cut(job, &part, level + 1, out ? out + count : NULL);
            }
            return count;
        }
        if (ewa_lines_beyond(&asked)) return 0;
    }
    if (out) *out = left;
    return 1;
}

static csg_piece whole_surfel(const csg_job *job, uint32_t index) {
    const ewa_solid_surfel *surfel = &job->solid->surfels[index];
    csg_piece piece = {.center = surfel->center, .axis = {surfel->axis[0], surfel->axis[1]}, .surfel = index};
    piece.lines.count = ewa_solid_lines(job->solid, index, piece.lines.line, &piece.lines.either);
    return piece;
}

static void count_near(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const csg_job *job = data;
    for (uint32_t i = part * TASK_SURFELS; i < (part + 1) * TASK_SURFELS && i < job->near_count; i++) {
        const csg_piece piece = whole_surfel(job, job->near[i]);
        job->piece_first[i] = cut(job, &piece, 0, NULL);
    }
}

static void cut_near(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const csg_job *job = data;
    for (uint32_t i = part * TASK_SURFELS; i < (part + 1) * TASK_SURFELS && i < job->near_count; i++) {
        if (job->piece_first[i] == job->piece_first[i + 1]) continue;
        const csg_piece piece = whole_surfel(job, job->near[i]);
        cut(job, &piece, 0, job->pieces + job->piece_first[i]);
    }
}

/// The last place whose side was certain: no surface is within `distance` of it, so that a place whose own
/// such ball meets this one is on the same side.
typedef struct certain_place {
    ewa_vec3 place;
    double distance;
    bool outside, known;
} certain_place;

/// Decides a node, or the surfels under it where the other surface is near.
static uint32_t classify(const csg_job *job, uint32_t level, uint32_t index, certain_place *last) {
    const ewa_solid *solid = job->solid;
    const ewa_solid_node *node = &solid->nodes[solid->level_first[level] + index];
    uint64_t first = index, end = (uint64_t)index + 1;
    for (uint32_t k = 0; k <= level; k++) first *= EWA_SOLID_ARITY, end *= EWA_SOLID_ARITY;
    if (end > solid->count) end = solid->count;
    const ewa_vec3 middle = vec3_scale(vec3_add(node->low, node->high), 0.5);
    const double radius = vec3_length(vec3_sub(node->high, middle)) + node->reach;
    double reach;
    const double nearest = ewa_solid_nearest(job->other, middle, &reach);
    // Between samples the surface is nearer than they are, by less than their reach.
    if (nearest > radius + 2 * reach) {
        ewa_local_surface surface;
        ewa_solid_look(job->other, middle, &surface);
        const bool outside = surface.mean_distance > 0;
        const ewa_vec3 step = vec3_sub(middle, last->place);
        const double clear = nearest - reach;
        const bool doubt =
            last->known && last->outside != outside && vec3_length(step) < clear + last->distance;
        *last = (certain_place){middle, clear, outside, true};
        memset(job->fate + first, outside == (job->rule.side > 0) ? FATE_KEEP : FATE_DROP, end - first);
        return doubt;
    }
    if (level == 0) {
        memset(job->fate + first, FATE_NEAR, end - first);
        return 0;
    }
    uint32_t doubts = 0;
    for (uint32_t i = index * EWA_SOLID_ARITY;
         i < (index + 1) * EWA_SOLID_ARITY && i < solid->level_nodes[level - 1]; i++)
        doubts += classify(job, level - 1, i, last);
    return doubts;
}

/// Nodes of one task: those of the third level, or the topmost.
static uint32_t task_level(const ewa_solid *solid) {
    return solid->level_count > 3 ? 3 : solid->level_count - 1;
}

static void classify_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const csg_job *job = data;
    certain_place last = {.known = false};
    job->doubts[part] = classify(job, task_level(job->solid), part, &last);
}

static void list_near(csg_job *job) {
    for (uint32_t i = 0; i < job->solid->count; i++)
        if (job->fate[i] == FATE_NEAR) job->near[job->near_count++] = i;
}

/// Turns counts into first indices; false when there are too many pieces.
static bool add_up(csg_job *job) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < job->near_count; i++) {
        const uint32_t count = job->piece_first[i];
        job->piece_first[i] = (uint32_t)sum;
        sum += count;
        if (sum >= UINT32_MAX) return false;
    }
    job->piece_first[job->near_count] = (uint32_t)sum;
    return true;
}

/// The progress of operand k goes from 0.4 k to 0.4 (k + 1).
static double progress_of(const csg_job *job, double share) { return 0.4 * ((job->second ? 1 : 0) + share); }

static ewa_status classify_all(csg_job *job, uint32_t *doubts) {
    ewa_context *context = job->solid->context;
    const uint32_t parts = job->solid->level_nodes[task_level(job->solid)];
    job->doubts = ewa_allocate(context, parts, sizeof *job->doubts);
    job->fate = ewa_allocate(context, job->solid->count, sizeof *job->fate);
    job->near = ewa_allocate(context, job->solid->count, sizeof *job->near);
    ewa_status status = job->doubts && job->fate && job->near ? EWA_OK : EWA_ERROR_MEMORY;
    if (status == EWA_OK)
        status = ewa_parallel_within(context, "csg", progress_of(job, 0), progress_of(job, 0.5), classify_part, job, parts);
    if (status == EWA_OK) {
        for (uint32_t i = 0; i < parts; i++) *doubts += job->doubts[i];
        list_near(job);
    }
    ewa_release(context, job->doubts, parts, sizeof *job->doubts);
    job->doubts = NULL;
    return status;
}

static ewa_status cut_all(csg_job *job) {
    ewa_context *context = job->solid->context;
    const uint32_t parts = (job->near_count + TASK_SURFELS - 1) / TASK_SURFELS;
    job->piece_first = ewa_allocate(context, (size_t)job->near_count + 1, sizeof *job->piece_first);
    if (!job->piece_first) return EWA_ERROR_MEMORY;
    job->piece_first[job->near_count] = 0;
    EWA_TRY(ewa_parallel_within(context, "csg", progress_of(job, 0.5), progress_of(job, 0.75), count_near, job, parts));
    if (!add_up(job)) return ewa_fail(context, EWA_ERROR_LIMIT, "csg: over 2^32 pieces");
    job->pieces = ewa_allocate(context, job->piece_first[job->near_count], sizeof *job->pieces);
    if (!job->pieces) return EWA_ERROR_MEMORY;
    return ewa_parallel_within(context, "csg", progress_of(job, 0.75), progress_of(job, 1), cut_near, job, parts);
}

static void free_job(csg_job *job) {
    ewa_context *context = job->solid->context;
    if (job->piece_first)
        ewa_release(context, job->pieces, job->piece_first[job->near_count], sizeof *job->pieces);
    ewa_release(context, job->piece_first, (size_t)job->near_count + 1, sizeof *job->piece_first);
    ewa_release(context, job->near, job->solid->count, sizeof *job->near);
    ewa_release(context, job->fate, job->solid->count, sizeof *job->fate);
}

/// The streams that a result gets anew.
typedef struct csg_streams {
    ewa_attribute position;
    float *normal, *tangent[2], *clip[2];
    uint8_t *mode;
} csg_streams;

static void store_vec3(float *stream, uint64_t i, ewa_vec3 v) {
    stream[3 * i] = (float)v.x, stream[3 * i + 1] = (float)v.y, stream[3 * i + 2] = (float)v.z;
}

static void store_piece(const csg_job *job, const csg_piece *piece, uint64_t i, const csg_streams *streams) {
    const double turn = job->rule.flip ? -1 : 1;
    store_vec3(streams->normal, i, vec3_scale(job->solid->surfels[piece->surfel].normal, turn));
    for (uint32_t k = 0; k < 2; k++) {
        store_vec3(streams->tangent[k], i, piece->axis[k]);
        store_vec3(streams->clip[k], i, k < piece->lines.count ? piece->lines.line[k] : vec3_make(0, 0, 0));
    }
    streams->mode[i] = piece->lines.either;
    double center[3];
    vec3_store(piece->center, center);
    for (uint64_t c = 0; c < 3; c++) {
        if (streams->position.type == EWA_F64)
            ((double *)streams->position.data)[3 * i + c] = center[c];
        else
            ((float *)streams->position.data)[3 * i + c] = (float)center[c];
    }
}

/// Calls for what is left, in order: with `streams` it is stored, with `indices` its source is. Returns how
/// many there are from `first` on.
static uint64_t gather(const csg_job *job, uint64_t first, uint32_t point_shift, uint64_t *indices,
                       const csg_streams *streams) {
    uint64_t to = first;
    for (uint32_t i = 0, near = 0; i < job->solid->count; i++) {
        const uint64_t source = (uint64_t)point_shift + job->solid->surfels[i].point;
        if (job->fate[i] == FATE_KEEP) {
            if (indices) indices[to] = source;
            if (streams) {
                const csg_piece piece = whole_surfel(job, i);
                store_piece(job, &piece, to, streams);
            }
            to++;
        } else if (job->fate[i] == FATE_NEAR) {
            for (uint32_t k = job->piece_first[near]; k < job->piece_first[near + 1]; k++, to++) {
                if (indices) indices[to] = source;
                if (streams) store_piece(job, &job->pieces[k], to, streams);
            }
            near++;
        }
    }
    return to;
}

/// Both operands without what the result gets anew, one after the other.
static ewa_status merge_rest(const ewa_cloud *const operands[2], ewa_cloud **merged) {
    static const char *const anew[] = {EWA_NORMAL, EWA_RADIUS, EWA_TANGENT_U, EWA_TANGENT_V,
                                       EWA_CLIP0,  EWA_CLIP1,  EWA_CLIP_MODE, EWA_BORDER,
                                       EWA_CURVATURE};
    ewa_cloud *rest[2] = {NULL, NULL};
    ewa_status status = EWA_OK;
    for (int k = 0; k < 2 && status == EWA_OK; k++) {
        double origin_world[3];
        ewa_cloud_origin(operands[k], origin_world);
        status =
            ewa_cloud_create(ewa_cloud_context(operands[0]), ewa_cloud_point_count(operands[k]), &rest[k]);
        if (status == EWA_OK) ewa_cloud_set_origin(rest[k], origin_world);
        const ewa_attribute *from;
        for (uint32_t a = 0; status == EWA_OK && (from = ewa_cloud_attribute_at(operands[k], a)); a++) {
            bool made_anew = false;
            for (size_t n = 0; n < sizeof anew / sizeof anew[0]; n++)
                made_anew |= strcmp(from->name, anew[n]) == 0;
            if (!made_anew)
                status = ewa_cloud_borrow(rest[k], from->name, from->type, from->component_count, from->data,
                                          from->stride_bytes);
        }
    }
    if (status == EWA_OK) status = ewa_cloud_merge((const ewa_cloud *const *)rest, 2, merged);
    for (int k = 0; k < 2; k++) ewa_cloud_destroy(&rest[k]);
    return status;
}

static ewa_status add_streams(ewa_cloud *cloud, csg_streams *streams) {
    void *data[6] = {NULL};
    static const char *const names[] = {EWA_NORMAL, EWA_TANGENT_U, EWA_TANGENT_V, EWA_CLIP0, EWA_CLIP1};
    for (int i = 0; i < 5; i++) EWA_TRY(ewa_cloud_add(cloud, names[i], EWA_F32, 3, &data[i]));
    EWA_TRY(ewa_cloud_add(cloud, EWA_CLIP_MODE, EWA_U8, 1, &data[5]));
    const ewa_attribute *position = ewa_cloud_find(cloud, EWA_POSITION);
    if (position->type != EWA_F32 && position->type != EWA_F64) {
        EWA_TRY(ewa_cloud_add(cloud, EWA_POSITION, EWA_F64, 3, NULL));
        position = ewa_cloud_find(cloud, EWA_POSITION);
    }
    streams->position = *position;
    streams->normal = data[0];
    for (int k = 0; k < 2; k++) streams->tangent[k] = data[1 + k], streams->clip[k] = data[3 + k];
    streams->mode = data[5];
    return EWA_OK;
}

static ewa_status assemble(const ewa_cloud *const operands[2], const csg_job jobs[2], ewa_cloud **result) {
    ewa_context *context = ewa_cloud_context(operands[0]);
    const uint32_t shift = (uint32_t)ewa_cloud_point_count(operands[0]);
    const uint64_t of_first = gather(&jobs[0], 0, 0, NULL, NULL);
    const uint64_t count = gather(&jobs[1], of_first, shift, NULL, NULL);
    if (count == 0) ewa_report(context, EWA_SEVERITY_WARNING, "csg: nothing is left");
    uint64_t *indices = ewa_allocate(context, count, sizeof *indices);
    if (!indices) return EWA_ERROR_MEMORY;
    gather(&jobs[0], 0, 0, indices, NULL);
    gather(&jobs[1], of_first, shift, indices, NULL);
    ewa_cloud *merged = NULL;
    ewa_status status = merge_rest(operands, &merged);
    if (status == EWA_OK) status = ewa_cloud_select(merged, indices, count, result);
    ewa_cloud_destroy(&merged);
    ewa_release(context, indices, count, sizeof *indices);
    csg_streams streams;
    if (status == EWA_OK) status = add_streams(*result, &streams);
    EWA_TRY(status);
    gather(&jobs[0], 0, 0, NULL, &streams);
    gather(&jobs[1], of_first, shift, NULL, &streams);
    return EWA_OK;
}

/// What messages call operand `k`.
static const char *operand_name(const ewa_csg_options *options, int k) {
    return options->names[k] ? options->names[k] : k ? "csg: operand B" : "csg: operand A";
}

static ewa_status check_closed(const ewa_solid *solid, const char *name) {
    const double openness = ewa_solid_openness(solid);
    if (openness <= MAX_OPENNESS) return EWA_OK;
    return ewa_fail(
        solid->context, EWA_ERROR_ARGUMENT,
        "%s is not closed: its normals, weighted by area, sum up to %.0f %% of the area (closed: 0); are "
        "normals turned outward and no side missing?",
        name, 100 * openness);
}

static ewa_status combine(const ewa_cloud *const operands[2], const ewa_solid solids[2],
                          const ewa_csg_options *options, ewa_cloud **result) {
    static const keep_rule rules[3][2] = {
        [EWA_CSG_UNION] = {{1, false, true, false}, {1, false, false, false}},
        [EWA_CSG_INTERSECTION] = {{-1, false, true, false}, {-1, false, false, false}},
        [EWA_CSG_DIFFERENCE] = {{1, false, false, true}, {-1, true, false, false}},
    };
    ewa_context *context = ewa_cloud_context(operands[0]);
    csg_job jobs[2];
    ewa_status status = EWA_OK;
    for (int k = 0; k < 2; k++) {
        jobs[k] = (csg_job){.solid = &solids[k],
                            .other = &solids[1 - k],
                            .rule = rules[options->operation][k],
                            .second = k == 1,
                            .cutoff = options->cutoff};
        uint32_t doubts = 0;
        if (status == EWA_OK) status = classify_all(&jobs[k], &doubts);
        if (status == EWA_OK) status = cut_all(&jobs[k]);
        if (status == EWA_OK && doubts)
            status =
                ewa_fail(context, EWA_ERROR_ARGUMENT,
                         "%s is not closed: at %u places, what is inside and what is outside of it meet with "
                         "none of its surfels between",
                         operand_name(options, 1 - k), doubts);
    }
    if (status == EWA_OK) status = assemble(operands, jobs, result);
    for (int k = 0; k < 2; k++) free_job(&jobs[k]);
    return status == EWA_OK ? ewa_progress(context, "csg", 1) : status;
}

#define AT(member) offsetof(ewa_csg_options, member)

static const ewa_option option_rows[] = {
    {"operation", EWA_OPTION_CHOICE, AT(operation), .words = "union|intersection|difference",
     .help = "what to keep; difference: A without B"},
    {"cutoff", EWA_OPTION_F64, AT(cutoff), 0, 4, EWA_OPTION_ABOVE, .initial = 3,
     .help = "standard deviations at which kernels end"},
};

const ewa_option_table ewa_csg_options_table = EWA_OPTION_TABLE(ewa_csg_options, option_rows);

void ewa_csg_options_init(ewa_csg_options *options, size_t struct_size) {
    ewa_options_init(&ewa_csg_options_table, options, struct_size);
}

ewa_status ewa_cloud_csg(const ewa_cloud *a, const ewa_cloud *b, const ewa_csg_options *given,
                         ewa_cloud **result) {
    if (!a || !b || !result) return EWA_ERROR_ARGUMENT;
    *result = NULL;
    ewa_context *context = ewa_cloud_context(a);
    ewa_csg_options chosen, *options = &chosen;
    ewa_csg_options_init(options, sizeof *options);
    EWA_TRY(ewa_options_take(context, &ewa_csg_options_table, given, options));
    const ewa_cloud *const operands[2] = {a, b};
    double origin_world[3];
    ewa_cloud_origin(a, origin_world);
    ewa_solid solids[2] = {{.context = context}, {.context = context}};
    ewa_status status = ewa_progress(context, "csg", 0);
    for (int k = 0; k < 2 && status == EWA_OK; k++) {
        status =
            ewa_solid_open(operands[k], operand_name(options, k), origin_world, options->cutoff, &solids[k]);
        if (status == EWA_OK) status = check_closed(&solids[k], operand_name(options, k));
    }
    ewa_cloud *made = NULL;
    if (status == EWA_OK) status = combine(operands, solids, options, &made);
    for (int k = 0; k < 2; k++) ewa_solid_close(&solids[k]);
    if (status != EWA_OK) ewa_cloud_destroy(&made);
    *result = made;
    return status;
}
