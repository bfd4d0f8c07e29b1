// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Consistent orientation of normals.
//
// The signs are propagated along a minimum spanning tree of the neighbour graph whose edges cost 1 - |n.n'|:
// between almost parallel normals first, around sharp bends last. Based on H. Hoppe, T. DeRose, T. Duchamp,
// J. McDonald, W. Stuetzle, "Surface reconstruction from unorganized points", 1992, section 3.3. The tree is
// grown by Kruskal's method with costs rounded up to a few classes; a place keeps the sign that it has
// relative to its set instead of being visited from a root. (R. E. Tarjan, "Efficiency of a good but not
// linear set union algorithm", 1975.)
//
// Sections of consecutive places grow their own forests in parallel, one class after the other. Sets that
// reach beyond their section are linked: a section may add its own sets to a linked one, which no other
// section can see, but two linked ones may already be one elsewhere. Those and the links between sections
// wait for a serial step at the end of the class, so that the whole is Kruskal's method with one fixed order
// of the links in a class, whatever the number of threads.
#include "estimate/orient.h"
#include "base/base.h"

#include <math.h>
#include <string.h>

enum {
    SECTION_BITS = 14,
    SECTION_PLACES = 1 << SECTION_BITS,
    // An entry of `local`: the parent's place within the section, whether the place is flipped relative to it
    // (a linked root: relative to its parent in `linked`), and whether it is a linked root.
    PARENT = SECTION_PLACES - 1,
    FLIPPED = 1 << SECTION_BITS,
    LINKED = 2 << SECTION_BITS,
    // Costs 1 - |n.n'| up to 2^-7, 2^-5, 2^-3, 2^-1, 2: 7, 14, 29, 60 degrees, anything. Finer ones make no
    // difference to the signs, which go wrong around sharp bends only.
    COST_CLASSES = 5,
    LOWEST_COST_EXPONENT = -7,
    // An entry of `classes`: one octal digit per link, its class or DECIDED.
    CLASS_BITS = 3,
    DECIDED = 7,
    EVERY_LINK = 011111111,
    BLOCK_POSITIONS = 256, // positions read at once
};

// A part counts as closed when its normals, weighted by area, cancel to this share.
static const double CLOSED_MEAN_NORMAL = 0.1;
// An open part still has an inside when on the whole its normals point away from its centre by this share.
static const double OPEN_OUTWARDNESS = 0.15;

/// Sums over a set of places, positions relative to the first place of the cloud.
typedef struct part {
    double area, moment[3], moment2[3]; // of position and of its square, by axis
    double normal[3];                   // oriented and weighted by area
    double flux[3];                     // of position through the surface, by axis
    uint32_t root;
    bool flipped; // its places' normals relative to what they should be
} part;

typedef struct orient_job {
    const orient_input *input;
    float *normals;
    uint32_t place_count;
    uint32_t class;
    // by place
    uint16_t *local;   // whole sections
    uint32_t *linked;  // of linked roots only: the parent, itself a linked root
    uint32_t *classes; // of its links
    uint16_t
        *waiting; // each section's list of places with links for the serial step, then the ranks of roots
    // by section
    uint32_t *waiting_count;
    uint8_t *classes_left; // bits of the classes of links that were not decided with the lowest
    uint32_t *first_part;  // [section_count + 1]
    part *parts;           // of each root of a section, then of the root of the whole
} orient_job;

static uint32_t section_end(const orient_job *job, uint32_t section) {
    const uint32_t begin = section << SECTION_BITS;
    return job->place_count - begin < SECTION_PLACES ? job->place_count : begin + SECTION_PLACES;
}

static uint32_t section_count_of(const orient_job *job) {
    return (uint32_t)(((uint64_t)job->place_count + SECTION_PLACES - 1) >> SECTION_BITS);
}

/// Returns the root in its section of a place's set; toggles `*flipped` if the place is flipped relative to
/// it. Halves the path.
static uint32_t find_local(uint16_t *local, uint32_t place, uint32_t *flipped) {
    for (;;) {
        const uint32_t parent = local[place] & PARENT;
        if (parent == place) return place;
        const uint32_t above = local[parent];
        if ((above & PARENT) != parent)
            local[place] = (uint16_t)((above & PARENT) | ((local[place] ^ above) & FLIPPED));
        *flipped ^= local[place] & FLIPPED;
        place = local[place] & PARENT;
    }
}

/// Returns the root of the whole set; toggles `*flipped` if the place is flipped relative to it.
static uint32_t find_root(const orient_job *job, uint32_t place, uint32_t *flipped) {
    const uint32_t begin = place & ~(uint32_t)PARENT;
    uint32_t root = begin + find_local(&job->local[begin], place & PARENT, flipped);
    if (!(job->local[root] & LINKED)) return root;
    while (job->linked[root] != root) {
        const uint32_t parent = job->linked[root], above = job->linked[parent];
        if (above != parent) {
            job->linked[root] = above;
            job->local[root] ^= job->local[parent] & FLIPPED;
        }
        *flipped ^= job->local[root] & FLIPPED;
        root = job->linked[root];
    }
    return root;
}

static float cosine_between(const orient_job *job, uint32_t place, uint32_t other) {
    const float *a = &job->normals[3 * (size_t)place], *b = &job->normals[3 * (size_t)other];
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The class of 1 - |cosine|, from its exponent: a class spans two powers of two.
static uint32_t class_of(float cosine) {
    enum { MANTISSA_BITS = 23, EXPONENT_BIAS = 127 };
    const float cost = 1 - fabsf(cosine);
    int32_t bits;
    memcpy(&bits, &cost, sizeof bits);
    // The last number below a power of two and the power itself share a class: (low, high].
    const int32_t above = ((bits - 1) >> MANTISSA_BITS) - EXPONENT_BIAS - (LOWEST_COST_EXPONENT - 2);
    return above < 2 ? 0 : (uint32_t)above / 2;
}

static uint32_t link_class(uint32_t classes, int link) { return classes >> CLASS_BITS * link & DECIDED; }

/// Whether any link has this class: a digit of the difference is zero.
static bool has_class(uint32_t classes, uint32_t class) {
    const uint32_t difference = classes ^ class * EVERY_LINK;
    return ((difference - EVERY_LINK) & ~difference & 4 * EVERY_LINK) != 0;
}

/// Joins two roots of a section, of which one at most is linked; `flipped`: relative to each other.
static void join_local(uint16_t *local, uint32_t a, uint32_t b, uint32_t flipped) {
    const bool a_stays = local[b] & LINKED ? false : local[a] & LINKED ? true : a < b;
    const uint32_t stays = a_stays ? a : b, goes = a_stays ? b : a;
    local[goes] = (uint16_t)(stays | flipped);
}

/// Joins the sets along the links of the class at hand of one place, as far as its section may. Returns
/// whether links wait for the serial step.
static bool join_place(const orient_job *job, uint32_t place) {
    const uint32_t begin = place & ~(uint32_t)PARENT, own = place & PARENT;
    uint16_t *local = &job->local[begin];
    const uint32_t *links = job->input->links[place];
    uint32_t classes = job->classes[place];
    bool waits = false;
    for (int i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
        if (link_class(classes, i) != job->class) continue;
        const uint32_t other = links[i];
        if ((other & ~(uint32_t)PARENT) != begin) {
            waits = true;
            continue;
        }
        uint32_t flipped = 0;
        const uint32_t a = find_local(local, own, &flipped), b = find_local(local, other & PARENT, &flipped);
        if (a != b && local[a] & local[b] & LINKED) {
            waits = true;
            continue;
        }
        if (a != b) join_local(local, a, b, flipped ^ (cosine_between(job, place, other) < 0 ? FLIPPED : 0));
        classes |= (uint32_t)DECIDED << CLASS_BITS * i;
    }
    job->classes[place] = classes;
    return waits;
}

/// Returns the bits of the links of a place that may join something: in its section, those whose set is not
/// obviously the same; without branches, for almost all of them are the same.
static uint32_t open_links(const uint16_t *local, const uint32_t *links, uint32_t begin, uint32_t root) {
    uint32_t open = 0;
    for (int i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
        const uint32_t other = links[i], parent = local[other & PARENT] & PARENT;
        const uint32_t differs = ((other & ~(uint32_t)PARENT) ^ begin) | (parent ^ root);
        open |= (uint32_t)((differs != 0) & (other != UINT32_MAX)) << i;
    }
    return open;
}

static bool has_link(const uint32_t *links, uint32_t place) {
    uint32_t found = 0;
    for (int i = 0; i < LOCAL_GRAPH_DEGREE; i++) found |= links[i] == place;
    return found;
}

/// Finds the classes of a place's links, and joins along those of the lowest class. `*left` gets the bits of
/// the others.
static bool begin_place(const orient_job *job, uint32_t place, uint8_t *left) {
    const uint32_t begin = place & ~(uint32_t)PARENT, own = place & PARENT;
    uint16_t *local = &job->local[begin];
    const uint32_t *links = job->input->links[place];
    uint32_t own_flipped = 0, root = find_local(local, own, &own_flipped);
    uint32_t rest = open_links(local, links, begin, root), joined = 0, negative = 0;
    uint32_t class_of_link[LOCAL_GRAPH_DEGREE];
    for (uint32_t open = rest; open; open &= open - 1) {
        const int i = __builtin_ctz(open);
        const float cosine = cosine_between(job, place, links[i]);
        const uint32_t class = class_of(cosine);
        class_of_link[i] = class;
        joined |= (uint32_t)(class == 0 && (links[i] & ~(uint32_t)PARENT) == begin) << i;
        negative |= (uint32_t)(cosine < 0) << i;
    }
    rest ^= joined;
    for (; joined; joined &= joined - 1) {
        const int i = __builtin_ctz(joined);
        uint32_t flipped = own_flipped ^ (negative >> i & 1) * FLIPPED;
        const uint32_t other_root = find_local(local, links[i] & PARENT, &flipped);
        if (other_root == root) continue;
        join_local(local, root, other_root, flipped);
        if (root < other_root) continue;
        own_flipped = 0;
        root = find_local(local, own, &own_flipped);
    }
    uint32_t classes = DECIDED * (uint32_t)EVERY_LINK, seen = 0;
    for (; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        // A link in both directions is the earlier place's. Without branches, for it is anybody's guess.
        const uint32_t ours = !((links[i] < place) & has_link(job->input->links[links[i]], place));
        const uint32_t class = class_of_link[i];
        seen |= ours << class;
        classes ^= ours * (DECIDED ^ class) << CLASS_BITS * i;
    }
    *left |= (uint8_t)seen;
    job->classes[place] = classes;
    return seen & 1;
}

static void join_section(void *data, uint32_t section, uint32_t worker) {
    (void)worker;
    const orient_job *job = data;
    const uint32_t begin = section << SECTION_BITS, end = section_end(job, section);
    uint32_t waiting = 0;
    job->waiting_count[section] = 0;
    if (job->class > 0 && !(job->classes_left[section] >> job->class & 1)) return;
    if (job->class == 0)
        for (uint32_t i = 0; i < end - begin; i++) job->local[begin + i] = (uint16_t)i;
    uint8_t left = 0;
    for (uint32_t place = begin; place < end; place++) {
        bool waits;
        if (job->class == 0)
            waits = begin_place(job, place, &left);
        else
            waits = has_class(job->classes[place], job->class) && join_place(job, place);
        if (waits) job->waiting[begin + waiting++] = (uint16_t)(place - begin);
    }
    if (job->class == 0) job->classes_left[section] = left;
    job->waiting_count[section] = waiting;
}

static void link_root(const orient_job *job, uint32_t root) {
    if (job->local[root] & LINKED) return;
    job->local[root] |= LINKED;
    job->linked[root] = root;
}

/// Joins along the links of the class at hand that wait.
static void join_waiting(const orient_job *job, uint32_t place) {
    const uint32_t classes = job->classes[place];
    uint32_t own_flipped = 0, root = find_root(job, place, &own_flipped);
    for (int i = 0; i < LOCAL_GRAPH_DEGREE; i++) {
        if (link_class(classes, i) != job->class) continue;
        const uint32_t other = job->input->links[place][i];
        uint32_t flipped = own_flipped;
        const uint32_t other_root = find_root(job, other, &flipped);
        if (root == other_root) continue;
        if (cosine_between(job, place, other) < 0) flipped ^= FLIPPED;
        link_root(job, root);
        link_root(job, other_root);
        const uint32_t low = root < other_root ? root : other_root,
                       high = root < other_root ? other_root : root;
        job->linked[high] = low;
        job->local[high] ^= flipped; // a root's was not set
        own_flipped = 0;
        root = find_root(job, place, &own_flipped);
    }
}

static ewa_status grow_forest(ewa_context *context, orient_job *job) {
    const uint32_t section_count = section_count_of(job);
    for (job->class = 0; job->class < COST_CLASSES; job->class ++) {
        EWA_TRY(ewa_parallel_stoppable(context, "orient", join_section, job, section_count));
        for (uint32_t section = 0; section < section_count; section++)
            for (uint32_t i = 0; i < job->waiting_count[section]; i++)
                join_waiting(job, (section << SECTION_BITS) + job->waiting[(section << SECTION_BITS) + i]);
        EWA_TRY(ewa_progress(context, "orient", (job->class + 1.0) / COST_CLASSES));
    }
    return EWA_OK;
}

static void rank_roots(void *data, uint32_t section, uint32_t worker) {
    (void)worker;
    const orient_job *job = data;
    const uint32_t begin = section << SECTION_BITS, end = section_end(job, section);
    uint32_t count = 0;
    for (uint32_t place = begin; place < end; place++)
        if ((job->local[place] & PARENT) == place - begin) job->waiting[place] = (uint16_t)count++;
    job->first_part[section] = count;
}

/// The sums of the set of a root of a section.
static part *part_of(const orient_job *job, uint32_t root) {
    return &job->parts[job->first_part[root >> SECTION_BITS] + job->waiting[root]];
}

static void add_part(part *to, const part *from, double sign) {
    to->area += from->area;
    for (int c = 0; c < 3; c++) {
        to->moment[c] += from->moment[c];
        to->moment2[c] += from->moment2[c];
        to->normal[c] += sign * from->normal[c];
        to->flux[c] += sign * from->flux[c];
    }
}

static void add_place(part *p, const double position[3], const float *normal, double sign, double area) {
    p->area += area;
    for (int c = 0; c < 3; c++) {
        const double moment = area * position[c], oriented = sign * (double)normal[c];
        p->moment[c] += moment;
        p->moment2[c] += moment * position[c];
        p->normal[c] += area * oriented;
        p->flux[c] += moment * oriented;
    }
}

static void sum_section(void *data, uint32_t section, uint32_t worker) {
    (void)worker;
    const orient_job *job = data;
    const ewa_neighbours *neighbours = job->input->neighbours;
    const uint32_t begin = section << SECTION_BITS, end = section_end(job, section);
    double origin[1][3], position[BLOCK_POSITIONS][3];
    part sum = {.root = UINT32_MAX}; // of the places in a row that have the same root
    ewa_neighbours_positions(neighbours, 0, 1, origin);
    for (uint32_t place = begin; place < end; place++) {
        const uint32_t i = (place - begin) % BLOCK_POSITIONS, left = end - place;
        if (i == 0)
            ewa_neighbours_positions(neighbours, place, left < BLOCK_POSITIONS ? left : BLOCK_POSITIONS,
                                     position);
        for (int c = 0; c < 3; c++) position[i][c] -= origin[0][c];
        uint32_t flipped = 0;
        const uint32_t root = begin + find_local(&job->local[begin], place - begin, &flipped);
        if (root != sum.root) {
            if (sum.root != UINT32_MAX) add_part(part_of(job, sum.root), &sum, 1);
            sum = (part){.root = root};
            part_of(job, root)->root = root;
        }
        const double spacing = (double)job->input->spacing[place];
        add_place(&sum, position[i], &job->normals[3 * (size_t)place], flipped ? -1 : 1, spacing * spacing);
    }
    add_part(part_of(job, sum.root), &sum, 1);
}

/// Decides whether the part's normals as they are point outward: by the volume that they enclose (the flux of
/// the position through a closed surface is three times its volume), or along the axis that most of them
/// follow.
static bool points_outward(const part *p) {
    double mean2 = 0, flux = 0, moment2 = 0, largest = 0;
    for (int c = 0; c < 3; c++) {
        const double center = p->moment[c] / p->area; // flux and moment are wanted relative to it
        mean2 += p->normal[c] * p->normal[c];
        flux += p->flux[c] - center * p->normal[c];
        moment2 += p->moment2[c] - center * p->moment[c];
        if (fabs(p->normal[c]) > fabs(largest)) largest = p->normal[c];
    }
    const bool closed = mean2 < CLOSED_MEAN_NORMAL * CLOSED_MEAN_NORMAL * p->area * p->area;
    if (closed || fabs(flux) > OPEN_OUTWARDNESS * sqrt(p->area * fmax(moment2, 0))) return flux >= 0;
    return largest >= 0;
}

static void flip_section(void *data, uint32_t section, uint32_t worker) {
    (void)worker;
    const orient_job *job = data;
    const uint32_t begin = section << SECTION_BITS, end = section_end(job, section);
    for (uint32_t place = begin; place < end; place++) {
        uint32_t flipped = 0;
        const uint32_t root = begin + find_local(&job->local[begin], place - begin, &flipped);
        if ((flipped != 0) != part_of(job, root)->flipped)
            for (int c = 0; c < 3; c++) job->normals[3 * (size_t)place + (size_t)c] *= -1;
    }
}

/// Flips the normals by their place's sign and their part's.
static ewa_status flip_parts(ewa_context *context, orient_job *job) {
    const uint32_t section_count = section_count_of(job);
    ewa_parallel(context, rank_roots, job, section_count);
    uint32_t part_count = 0;
    for (uint32_t section = 0; section < section_count; section++) {
        const uint32_t count = job->first_part[section];
        job->first_part[section] = part_count;
        part_count += count;
    }
    job->parts = ewa_allocate_zeroed(context, part_count, sizeof *job->parts);
    if (!job->parts) return EWA_ERROR_MEMORY;
    ewa_parallel(context, sum_section, job, section_count);
    for (part *p = job->parts; p < job->parts + part_count; p++) {
        uint32_t flipped = 0;
        part *whole = part_of(job, find_root(job, p->root, &flipped));
        if (whole != p) add_part(whole, p, flipped ? -1 : 1);
    }
    for (part *p = job->parts; p < job->parts + part_count; p++) {
        uint32_t flipped = 0;
        if (find_root(job, p->root, &flipped) == p->root) p->flipped = !points_outward(p);
    }
    for (part *p = job->parts; p < job->parts + part_count; p++) {
        uint32_t flipped = 0;
        const part *whole = part_of(job, find_root(job, p->root, &flipped));
        if (whole != p) p->flipped = whole->flipped != (flipped != 0);
    }
    ewa_parallel(context, flip_section, job, section_count);
    ewa_release(context, job->parts, part_count, sizeof *job->parts);
    return EWA_OK;
}

ewa_status ewa_orient_propagate(ewa_context *context, const orient_input *input, float *normals) {
    orient_job job = {
        .input = input, .normals = normals, .place_count = ewa_neighbours_place_count(input->neighbours)};
    const size_t places = job.place_count, sections = section_count_of(&job);
    job.local = ewa_allocate(context, sections << SECTION_BITS, sizeof *job.local);
    job.linked = ewa_allocate(context, places, sizeof *job.linked);
    job.classes = ewa_allocate(context, places, sizeof *job.classes);
    job.waiting = ewa_allocate(context, places, sizeof *job.waiting);
    job.waiting_count = ewa_allocate(context, sections, sizeof *job.waiting_count);
    job.classes_left = ewa_allocate(context, sections, sizeof *job.classes_left);
    job.first_part = ewa_allocate(context, sections, sizeof *job.first_part);
    ewa_status status = EWA_ERROR_MEMORY;
    if (job.local && job.linked && job.classes && job.waiting && job.waiting_count && job.classes_left &&
        job.first_part) {
        status = grow_forest(context, &job);
        if (status == EWA_OK) status = flip_parts(context, &job);
    }
    ewa_release(context, job.first_part, sections, sizeof *job.first_part);
    ewa_release(context, job.classes_left, sections, sizeof *job.classes_left);
    ewa_release(context, job.waiting_count, sections, sizeof *job.waiting_count);
    ewa_release(context, job.waiting, places, sizeof *job.waiting);
    ewa_release(context, job.classes, places, sizeof *job.classes);
    ewa_release(context, job.linked, places, sizeof *job.linked);
    ewa_release(context, job.local, sections << SECTION_BITS, sizeof *job.local);
    return status;
}
