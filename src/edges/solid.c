// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A closed surface of surfels as a solid.
//
// The surface near a place is what its nearest surfels say. They are parted by their normals: those that
// agree with the nearest one make a plane, those that agree with the nearest of the rest a second one, so
// that edges stay sharp. A plane's distance is the weighted mean of the distances from the surfels along the
// mean of their own normal and the plane's, which is exact on spheres as it is on planes.
//
// Based on B. Adams, P. Dutre, "Interactive boolean operations on surfel-bounded solids", 2003, section 4
// (inside and outside by the nearest surfels), and M. Pauly, R. Keiser, L. Kobbelt, M. Gross, "Shape modeling
// with point-sampled geometry", 2003, section 4.
#include "edges/solid.h"
#include "base/base.h"
#include "cloud/cloud.h"
#include "cloud/morton.h"

#include <math.h>
#include <string.h>

enum { NEAREST = 16, TASK_SURFELS = 4096, RUN_SURFELS = 512, FEWEST_OF_PLANE = 2 };

/// Cosine of the largest angle between the normals of one plane: 37 degrees.
#define SAME_PLANE 0.8

/// Surfels with larger coordinates or reaches are none: squares of their distances could overflow.
#define LARGEST 1e100

/// A place with its point, for sorting.
typedef struct place_key {
    double at[3];
    uint32_t point;
} place_key;

typedef struct read_job {
    const ewa_attribute *position, *normal, *radius, *tangent[2];
    ewa_vec3 shift;
    double cutoff;
    uint32_t *order;
    uint32_t count;
    ewa_solid_surfel *surfels;
} read_job;

static ewa_vec3 read_vec3(const ewa_attribute *attribute, uint32_t point) {
    double v[3];
    ewa_attribute_read_f64(attribute, point, 1, v);
    return vec3_load(v);
}

/// Two axes along a plane, orthogonal, `length` long.
static void span_plane(ewa_vec3 normal, double length, ewa_vec3 axis[2]) {
    const ewa_vec3 helper = fabs(normal.x) < 0.6 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
    axis[0] = vec3_cross(helper, normal);
    vec3_normalize(&axis[0]);
    axis[1] = vec3_scale(vec3_cross(normal, axis[0]), length);
    axis[0] = vec3_scale(axis[0], length);
}

/// False for NaN too.
static bool within(double value) { return fabs(value) <= LARGEST; }

/// False when the point is no surfel.
static bool read_surfel(const read_job *job, uint32_t point, ewa_solid_surfel *surfel) {
    surfel->point = point;
    surfel->center = vec3_add(read_vec3(job->position, point), job->shift);
    const ewa_vec3 given = job->normal ? read_vec3(job->normal, point) : vec3_make(0, 0, 0);
    surfel->normal = given;
    if (job->tangent[0]) {
        for (int k = 0; k < 2; k++) surfel->axis[k] = read_vec3(job->tangent[k], point);
        surfel->normal = vec3_cross(surfel->axis[0], surfel->axis[1]);
        if (!vec3_normalize(&surfel->normal)) return false;
        if (vec3_dot(surfel->normal, given) < 0) surfel->normal = vec3_scale(surfel->normal, -1);
    } else {
        double radius;
        ewa_attribute_read_f64(job->radius, point, 1, &radius);
        if (!(radius > 0) || !vec3_normalize(&surfel->normal)) return false;
        span_plane(surfel->normal, radius / job->cutoff, surfel->axis);
    }
    surfel->reach = job->cutoff * fmax(vec3_length(surfel->axis[0]), vec3_length(surfel->axis[1]));
    return within(surfel->center.x) && within(surfel->center.y) && within(surfel->center.z) &&
           within(surfel->reach) && surfel->reach > 0;
}

/// Without branches, so that loops over it become vectors.
static double larger(double a, double b) { return a > b ? a : b; }

static bool comes_before(const place_key *a, const place_key *b, int axis) {
    return a->at[axis] < b->at[axis] || (a->at[axis] == b->at[axis] && a->point < b->point);
}

/// Moves the `rank` first keys along an axis to the front (Hoare's selection).
static void select_first(place_key *keys, uint32_t count, uint32_t rank, int axis) {
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const place_key pivot = keys[low + (high - low) / 2];
        uint32_t i = low, k = high;
        for (;;) {
            while (comes_before(&keys[i], &pivot, axis)) i++;
            while (comes_before(&pivot, &keys[k], axis)) k--;
            if (i >= k) break;
            const place_key swapped = keys[i];
            keys[i] = keys[k];
            keys[k] = swapped;
        }
        // keys[k] is the pivot.
        if (k == rank) return;
        if (k < rank)
            low = k + 1;
        else
            high = k - 1;
    }
}

/// Orders keys so that nodes are compact boxes: halves along the longest side, again and again. Runs of the
/// Z-order curve jump, and their boxes overlap.
static void halve(place_key *keys, uint32_t count) {
    if (count <= EWA_SOLID_ARITY) return;
    double low[3], high[3];
    for (int c = 0; c < 3; c++) low[c] = high[c] = keys[0].at[c];
    for (uint32_t i = 1; i < count; i++)
        for (int c = 0; c < 3; c++) {
            low[c] = -larger(-low[c], -keys[i].at[c]);
            high[c] = larger(high[c], keys[i].at[c]);
        }
    int axis = 0;
    for (int c = 1; c < 3; c++)
        if (high[c] - low[c] > high[axis] - low[axis]) axis = c;
    uint32_t first = EWA_SOLID_ARITY;
    while (2 * first < count) first *= 2;
    select_first(keys, count, first, axis);
    halve(keys, first);
    halve(keys + first, count - first);
}

static void order_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const read_job *job = data;
    place_key keys[RUN_SURFELS];
    const uint32_t first = part * RUN_SURFELS;
    const uint32_t count = job->count - first < RUN_SURFELS ? job->count - first : RUN_SURFELS;
    for (uint32_t i = 0; i < count; i++) {
        keys[i].point = job->order[first + i];
        ewa_attribute_read_f64(job->position, keys[i].point, 1, keys[i].at);
    }
    halve(keys, count);
    for (uint32_t i = 0; i < count; i++) job->order[first + i] = keys[i].point;
}

static void read_part(void *data, uint32_t part, uint32_t worker) {
    (void)worker;
    const read_job *job = data;
    const uint32_t first = part * TASK_SURFELS;
    const uint32_t end = job->count - first < TASK_SURFELS ? job->count : first + TASK_SURFELS;
    for (uint32_t i = first; i < end; i++)
        if (!read_surfel(job, job->order[i], &job->surfels[i])) job->surfels[i].reach = 0;
}

static ewa_status find_streams(const ewa_cloud *cloud, const char *name, read_job *job) {
    const struct {
        const char *name;
        uint32_t component_count;
        const ewa_attribute **found;
    } streams[] = {
        {EWA_POSITION, 3, &job->position},    {EWA_NORMAL, 3, &job->normal},
        {EWA_RADIUS, 1, &job->radius},        {EWA_TANGENT_U, 3, &job->tangent[0]},
        {EWA_TANGENT_V, 3, &job->tangent[1]},
    };
    for (size_t i = 0; i < sizeof streams / sizeof streams[0]; i++) {
        *streams[i].found = ewa_cloud_find(cloud, streams[i].name);
        if (*streams[i].found && (*streams[i].found)->component_count != streams[i].component_count)
            return ewa_fail(ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT,
                            "%s: '%s' has %u components instead of %u", name, streams[i].name,
                            (*streams[i].found)->component_count, streams[i].component_count);
    }
    if (!job->tangent[1]) job->tangent[0] = NULL;
    if (!job->position || (!job->tangent[0] && !(job->normal && job->radius)))
        return ewa_fail(
            ewa_cloud_context(cloud), EWA_ERROR_ARGUMENT,
            "%s: 'position' is needed with 'normal' and 'radius', or with 'tangent_u' and 'tangent_v'", name);
    return EWA_OK;
}

/// Moves the surfels to the front.
static void compact(ewa_solid *solid, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        if (solid->surfels[i].reach > 0) solid->surfels[solid->count++] = solid->surfels[i];
}

static void grow(ewa_solid_node *node, const ewa_solid_node *by) {
    node->low =
        vec3_make(fmin(node->low.x, by->low.x), fmin(node->low.y, by->low.y), fmin(node->low.z, by->low.z));
    node->high = vec3_make(fmax(node->high.x, by->high.x), fmax(node->high.y, by->high.y),
                           fmax(node->high.z, by->high.z));
    node->reach = fmax(node->reach, by->reach);
}

static ewa_status build_nodes(ewa_solid *solid) {
    uint32_t below = solid->count;
    do {
        below = (below + EWA_SOLID_ARITY - 1) / EWA_SOLID_ARITY;
        solid->level_first[solid->level_count] = (uint32_t)solid->node_count;
        solid->level_nodes[solid->level_count++] = below;
        solid->node_count += below;
    } while (below > 1);
    solid->nodes = ewa_allocate(solid->context, solid->node_count, sizeof *solid->nodes);
    if (!solid->nodes) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < solid->count; i++) {
        const ewa_solid_surfel *surfel = &solid->surfels[i];
        const ewa_solid_node lone = {surfel->center, surfel->center, surfel->reach};
        ewa_solid_node *leaf = &solid->nodes[i / EWA_SOLID_ARITY];
        if (i % EWA_SOLID_ARITY == 0)
            *leaf = lone;
        else
            grow(leaf, &lone);
    }
    for (uint32_t level = 1; level < solid->level_count; level++)
        for (uint32_t i = 0; i < solid->level_nodes[level - 1]; i++) {
            const ewa_solid_node *child = &solid->nodes[solid->level_first[level - 1] + i];
            ewa_solid_node *node = &solid->nodes[solid->level_first[level] + i / EWA_SOLID_ARITY];
            if (i % EWA_SOLID_ARITY == 0)
                *node = *child;
            else
                grow(node, child);
        }
    return EWA_OK;
}

ewa_status ewa_solid_open(const ewa_cloud *cloud, const char *name, const double origin_world[3],
                          double cutoff, ewa_solid *solid) {
    ewa_context *context = ewa_cloud_context(cloud);
    *solid = (ewa_solid){.context = context, .cloud = cloud};
    read_job job = {.cutoff = cutoff};
    EWA_TRY(find_streams(cloud, name, &job));
    const uint64_t point_count = ewa_cloud_point_count(cloud);
    if (point_count >= UINT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: %llu points are over the limit of 2^32 - 2", name,
                        (unsigned long long)point_count);
    double own_world[3];
    ewa_cloud_origin(cloud, own_world);
    job.shift = vec3_sub(vec3_load(own_world), vec3_load(origin_world));
    solid->capacity = (uint32_t)point_count;
    solid->surfels = ewa_allocate(context, point_count, sizeof *solid->surfels);
    uint32_t *order = ewa_allocate(context, point_count, sizeof *order);
    ewa_status status = EWA_ERROR_MEMORY;
    if (solid->surfels && order)
        status = ewa_morton_order(context, job.position, (uint32_t)point_count, order, NULL, &job.count);
    if (status == EWA_OK) {
        job.order = order;
        job.surfels = solid->surfels;
        ewa_parallel(context, order_part, &job, (job.count + RUN_SURFELS - 1) / RUN_SURFELS);
        ewa_parallel(context, read_part, &job, (job.count + TASK_SURFELS - 1) / TASK_SURFELS);
        compact(solid, job.count);
        if (solid->count == 0)
            status = ewa_fail(context, EWA_ERROR_ARGUMENT, "%s: none of the %llu points is a surfel", name,
                              (unsigned long long)point_count);
    }
    ewa_release(context, order, point_count, sizeof *order);
    return status == EWA_OK ? build_nodes(solid) : status;
}

void ewa_solid_close(ewa_solid *solid) {
    ewa_release(solid->context, solid->nodes, solid->node_count, sizeof *solid->nodes);
    ewa_release(solid->context, solid->surfels, solid->capacity, sizeof *solid->surfels);
    *solid = (ewa_solid){0};
}

uint32_t ewa_solid_lines(const ewa_solid *solid, uint32_t surfel, ewa_vec3 lines[2], bool *either) {
    static const char *const names[] = {EWA_CLIP0, EWA_CLIP1};
    const uint32_t point = solid->surfels[surfel].point;
    uint32_t count = 0;
    *either = false;
    if (!ewa_cloud_find(solid->cloud, EWA_TANGENT_U)) return 0;
    for (int k = 0; k < 2; k++) {
        const ewa_attribute *attribute = ewa_cloud_find(solid->cloud, names[k]);
        if (!attribute || attribute->component_count != 3) continue;
        const ewa_vec3 line = read_vec3(attribute, point);
        if (vec3_is_finite(line) && (line.x != 0 || line.y != 0)) lines[count++] = line;
    }
    const ewa_attribute *mode = ewa_cloud_find(solid->cloud, EWA_CLIP_MODE);
    double value = 0;
    if (mode && mode->component_count == 1) ewa_attribute_read_f64(mode, point, 1, &value);
    *either = count == 2 && value == 1;
    return count;
}

double ewa_solid_openness(const ewa_solid *solid) {
    ewa_vec3 sum = vec3_make(0, 0, 0);
    double total = 0;
    for (uint32_t i = 0; i < solid->count; i++) {
        const ewa_solid_surfel *surfel = &solid->surfels[i];
        double area = vec3_length(vec3_cross(surfel->axis[0], surfel->axis[1]));
        ewa_vec3 lines[2];
        bool either;
        // A line through the centre leaves half of the kernel.
        const uint32_t count = ewa_solid_lines(solid, i, lines, &either);
        for (uint32_t k = 0; k < count && !either; k++) {
            const double slope = sqrt(lines[k].x * lines[k].x + lines[k].y * lines[k].y);
            area *= fmin(fmax(0.5 + 0.4 * lines[k].z / slope, 0), 1);
        }
        sum = vec3_add(sum, vec3_scale(surfel->normal, area));
        total += area;
    }
    return vec3_length(sum) / total;
}

/// The nearest surfels so far, nearest first.
typedef struct nearest_list {
    ewa_vec3 place;
    uint32_t wanted, count;
    uint32_t surfel[NEAREST];
    double distance2[NEAREST];
} nearest_list;

static double limit2_of(const nearest_list *list) {
    return list->count < list->wanted ? INFINITY : list->distance2[list->wanted - 1];
}

static void offer(nearest_list *list, uint32_t surfel, double distance2) {
    if (!(distance2 < limit2_of(list))) return;
    uint32_t at = list->count < list->wanted ? list->count++ : list->wanted - 1;
    for (; at > 0 && list->distance2[at - 1] > distance2; at--) {
        list->distance2[at] = list->distance2[at - 1];
        list->surfel[at] = list->surfel[at - 1];
    }
    list->distance2[at] = distance2;
    list->surfel[at] = surfel;
}

static double box_distance2(const ewa_solid_node *node, ewa_vec3 p) {
    const ewa_vec3 d = vec3_make(larger(larger(node->low.x - p.x, p.x - node->high.x), 0),
                                 larger(larger(node->low.y - p.y, p.y - node->high.y), 0),
                                 larger(larger(node->low.z - p.z, p.z - node->high.z), 0));
    return vec3_dot(d, d);
}

static void search(const ewa_solid *solid, uint32_t level, uint32_t node, nearest_list *list) {
    const uint32_t first = node * EWA_SOLID_ARITY;
    if (level == 0) {
        for (uint32_t i = first; i < first + EWA_SOLID_ARITY && i < solid->count; i++) {
            const ewa_vec3 d = vec3_sub(solid->surfels[i].center, list->place);
            offer(list, i, vec3_dot(d, d));
        }
        return;
    }
    double distance2[EWA_SOLID_ARITY];
    uint32_t order[EWA_SOLID_ARITY], count = 0;
    for (uint32_t i = first; i < first + EWA_SOLID_ARITY && i < solid->level_nodes[level - 1]; i++) {
        const double d2 = box_distance2(&solid->nodes[solid->level_first[level - 1] + i], list->place);
        if (!(d2 < limit2_of(list))) continue;
        uint32_t at = count++;
        for (; at > 0 && distance2[at - 1] > d2; at--)
            distance2[at] = distance2[at - 1], order[at] = order[at - 1];
        distance2[at] = d2;
        order[at] = i;
    }
    for (uint32_t i = 0; i < count && distance2[i] < limit2_of(list); i++)
        search(solid, level - 1, order[i], list);
}

/// One plane of the surface: the surfels of the list with set `members` bits.
typedef struct plane_fit {
    uint32_t members, member_count;
    ewa_vec3 normal, centroid;
    double distance;
} plane_fit;

/// Takes from the `free` ones the nearest and those whose normals agree with it.
static plane_fit fit_plane(const ewa_solid *solid, const nearest_list *list, const double *weight,
                           uint32_t free) {
    plane_fit plane = {.normal = {0, 0, 0}};
    const ewa_vec3 seed = solid->surfels[list->surfel[__builtin_ctz(free)]].normal;
    double total = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const ewa_solid_surfel *surfel = &solid->surfels[list->surfel[i]];
        if (!(free >> i & 1) || vec3_dot(surfel->normal, seed) < SAME_PLANE) continue;
        plane.members |= 1u << i;
        plane.member_count++;
        plane.normal = vec3_add(plane.normal, vec3_scale(surfel->normal, weight[i]));
        plane.centroid = vec3_add(plane.centroid, vec3_scale(surfel->center, weight[i]));
        total += weight[i];
    }
    vec3_normalize(&plane.normal);
    plane.centroid = vec3_scale(plane.centroid, 1 / total);
    for (uint32_t i = 0; i < list->count; i++) {
        if (!(plane.members >> i & 1)) continue;
        const ewa_solid_surfel *surfel = &solid->surfels[list->surfel[i]];
        const ewa_vec3 mean = vec3_scale(vec3_add(surfel->normal, plane.normal), 0.5);
        plane.distance += weight[i] / total * vec3_dot(vec3_sub(list->place, surfel->center), mean);
    }
    return plane;
}

double ewa_solid_nearest(const ewa_solid *solid, ewa_vec3 place, double *reach) {
    nearest_list list = {.place = place, .wanted = 1};
    search(solid, solid->level_count - 1, 0, &list);
    *reach = solid->surfels[list.surfel[0]].reach;
    return sqrt(list.distance2[0]);
}

void ewa_solid_look(const ewa_solid *solid, ewa_vec3 place, ewa_local_surface *surface) {
    nearest_list list = {.place = place, .wanted = NEAREST};
    search(solid, solid->level_count - 1, 0, &list);
    // Weights fall to nearly nothing at the last of them, so that the surface has no steps.
    double weight[NEAREST] = {0};
    const double range2 = 1.05 * list.distance2[list.count - 1];
    for (uint32_t i = 0; i < list.count; i++) {
        const double w = range2 > 0 ? 1 - list.distance2[i] / range2 : 1;
        weight[i] = w * w;
    }
    uint32_t free = (1u << list.count) - 1;
    const plane_fit first = fit_plane(solid, &list, weight, free);
    *surface = (ewa_local_surface){.plane_count = 1};
    surface->nearest = sqrt(list.distance2[0]);
    surface->reach = solid->surfels[list.surfel[0]].reach;
    double total = 0;
    for (uint32_t i = 0; i < list.count; i++) {
        const ewa_solid_surfel *surfel = &solid->surfels[list.surfel[i]];
        total += weight[i];
        surface->mean_distance += weight[i] * vec3_dot(vec3_sub(place, surfel->center), surfel->normal);
    }
    surface->mean_distance /= total;
    surface->normal[0] = first.normal;
    surface->distance[0] = first.distance;
    free &= ~first.members;
    if (!free) return;
    const plane_fit second = fit_plane(solid, &list, weight, free);
    if (second.member_count < FEWEST_OF_PLANE) return;
    const ewa_vec3 across = vec3_sub(second.centroid, first.centroid);
    surface->plane_count = 2;
    surface->normal[1] = second.normal;
    surface->distance[1] = second.distance;
    surface->convex = vec3_dot(across, first.normal) - vec3_dot(across, second.normal) < 0;
}
