// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians with levels of detail as streamed SOG: lod-meta.json, which sog_streamed.c describes, and archives of SOG beside it. A leaf
// is a run along the Morton curve; of each level the leaves lie one behind the other, so that a leaf is a range of one file.
//
// Beside the set there is one file's worth of Gaussians in memory at a time, and four bytes for each Gaussian.
#include "base/platform.h"
#include "cloud/gaussian_merge.h"
#include "cloud/morton.h"
#include "io/gaussian/save.h"
#include "io/number.h"

#include <stdio.h>

/// Leaves are small enough that each can have its own level, and files small enough that what is not seen need not be fetched.
enum { LEAF_GAUSSIANS = 8192, LEVELS = 5, FILE_GAUSSIANS = 1 << 18, PATH_BYTES = 4096, NAME_BYTES = 32 };

/// Where Gaussians of one level of a leaf are.
typedef struct level_range {
    uint32_t file, offset, count;
} level_range;

typedef struct leaf {
    uint32_t first, count; ///< of `order`
    double low[3], high[3]; ///< world units, of all within three standard deviations
    level_range levels[LEVELS];
} leaf;

typedef struct level_file {
    char name[NAME_BYTES];
    ewa_writer *writer;
} level_file;

typedef struct streaming {
    const ewa_gaussian_target *target;
    const ewa_gaussians *set;
    ewa_context *context;
    uint32_t *order; ///< Gaussians by leaf, within it by groups
    leaf *leaves;
    uint32_t leaf_count, workers;
    ewa_gaussian_mass *masses; ///< [workers][LEAF_GAUSSIANS]
    ewa_buffer files;          ///< of level_file
    uint32_t file_count;
    ewa_buffer text; ///< of lod-meta.json
    size_t text_bytes;
    ewa_gaussians part; ///< what is being written,
    uint32_t level, first_leaf; ///< of this level, from this leaf on
} streaming;

static void order_leaf(void *data, uint32_t index, uint32_t worker) {
    const streaming *s = data;
    const ewa_gaussians *set = s->set;
    leaf *own = &s->leaves[index];
    (void)worker;
    ewa_gaussians_group(set, s->order + own->first, own->count);
    for (uint32_t i = 0; i < own->count; i++) {
        const size_t from = s->order[own->first + i];
        const float *scales = set->scales + 3 * from;
        const double reach = 3 * (double)fmaxf(fmaxf(scales[0], scales[1]), scales[2]);
        for (size_t k = 0; k < 3; k++) {
            const double at = set->origin[k] + (double)set->centers[3 * from + k];
            own->low[k] = i ? fmin(own->low[k], at - reach) : at - reach;
            own->high[k] = i ? fmax(own->high[k], at + reach) : at + reach;
        }
    }
}

static ewa_status make_leaves(streaming *s) {
    const ewa_gaussians *set = s->set;
    const ewa_attribute position = {.data = set->centers, .type = EWA_F32, .component_count = 3, .stride_bytes = 3 * sizeof(float)};
    s->leaf_count = (set->count - 1) / LEAF_GAUSSIANS + 1;
    s->workers = ewa_context_worker_count(s->context);
    s->order = ewa_allocate(s->context, set->count, sizeof *s->order);
    s->leaves = ewa_allocate_zeroed(s->context, s->leaf_count, sizeof *s->leaves);
    s->masses = ewa_allocate(s->context, (size_t)s->workers * LEAF_GAUSSIANS, sizeof *s->masses);
    if (!s->order || !s->leaves || !s->masses) return EWA_ERROR_MEMORY;
    EWA_TRY(ewa_morton_order(s->context, &position, set->count, s->order, NULL, NULL));
    for (uint32_t i = 0; i < s->leaf_count; i++) {
        leaf *own = &s->leaves[i];
        own->first = (uint32_t)ewa_split(set->count, s->leaf_count, i);
        own->count = (uint32_t)ewa_split(set->count, s->leaf_count, i + 1) - own->first;
        for (uint32_t level = 0; level < LEVELS; level++) own->levels[level].count = ((own->count - 1) >> 2 * level) + 1;
    }
    return ewa_parallel_stoppable(s->context, "levels", order_leaf, s, s->leaf_count);
}

static void copy(const ewa_gaussians *set, size_t from, ewa_gaussians *part, size_t to) {
    const size_t numbers = 3 * (size_t)ewa_sh_count(set->sh_degree);
    memcpy(part->centers + 3 * to, set->centers + 3 * from, 3 * sizeof(float));
    memcpy(part->scales + 3 * to, set->scales + 3 * from, 3 * sizeof(float));
    memcpy(part->rotations + 4 * to, set->rotations + 4 * from, 4 * sizeof(float));
    memcpy(part->harmonics + numbers * to, set->harmonics + numbers * from, numbers * sizeof(float));
    part->opacities[to] = set->opacities[from];
}

/// Fills a leaf's range of the part.
static void fill_leaf(void *data, uint32_t index, uint32_t worker) {
    streaming *s = data;
    const leaf *own = &s->leaves[s->first_leaf + index];
    const level_range *range = &own->levels[s->level];
    const uint32_t *members = s->order + own->first, size = 1u << 2 * s->level;
    ewa_gaussian_mass *masses = s->masses + (size_t)worker * LEAF_GAUSSIANS;
    if (s->level == 0) {
        for (uint32_t i = 0; i < own->count; i++) copy(s->set, members[i], &s->part, range->offset + (size_t)i);
        return;
    }
    for (uint32_t i = 0; i < own->count; i++) ewa_gaussian_weigh(s->set, members[i], &masses[i]);
    for (uint32_t m = 0; m < range->count; m++) {
        const uint32_t first = m * size, count = own->count - first < size ? own->count - first : size;
        ewa_gaussians_merge(s->set, members + first, masses + first, count, &s->part, range->offset + (size_t)m);
    }
}

/// Writes the part to a file beside lod-meta.json, which gets its name when all are there.
static ewa_status write_part(streaming *s, level_file *file) {
    char path[PATH_BYTES];
    const char *name = s->target->name;
    const int folder_bytes = (int)(ewa_platform_file_name(name) - name);
    if (snprintf(path, sizeof path, "%.*s%s", folder_bytes, name, file->name) >= (int)sizeof path)
        return ewa_fail(s->context, EWA_ERROR_LIMIT, "%s: the path is longer than %d bytes", name, PATH_BYTES);
    EWA_TRY(ewa_writer_open(s->context, path, &file->writer));
    return ewa_gaussians_write_sog(&(ewa_gaussian_target){
        .set = &s->part, .name = path, .writer = file->writer, .sh_degree = s->target->sh_degree, .keep_order = true});
}

/// Makes and writes the next file: of a level the leaves from `first` on that have room in it. Returns the leaf behind it in `*end`.
static ewa_status write_file(streaming *s, uint32_t level, uint32_t number, uint32_t first, uint32_t *end) {
    uint32_t total = 0, last = first;
    for (; last < s->leaf_count && (last == first || total + s->leaves[last].levels[level].count <= FILE_GAUSSIANS); last++) {
        level_range *range = &s->leaves[last].levels[level];
        range->file = s->file_count, range->offset = total;
        total += range->count;
    }
    *end = last;
    EWA_TRY(ewa_buffer_grow(s->context, &s->files, s->file_count, s->file_count + (size_t)1, sizeof(level_file)));
    level_file *file = (level_file *)s->files.data + s->file_count++;
    *file = (level_file){.writer = NULL};
    snprintf(file->name, sizeof file->name, "%u_%u.sog", level, number);
    EWA_TRY(ewa_gaussians_create(s->context, total, s->set->sh_degree, &s->part));
    s->level = level, s->first_leaf = first;
    memcpy(s->part.origin, s->set->origin, sizeof s->part.origin);
    s->part.antialiased = s->set->antialiased;
    ewa_status status = ewa_parallel_stoppable(s->context, "levels", fill_leaf, s, last - first);
    if (status == EWA_OK) status = write_part(s, file);
    ewa_gaussians_free(&s->part);
    return status;
}

static ewa_status write_levels(streaming *s) {
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t first = 0, end, number = 0; first < s->leaf_count; first = end, number++) {
            const bool told = s->file_count > 0; // what one file has no room for, none has
            if (told) ewa_reports_hush(s->context, true);
            const ewa_status status = write_file(s, level, number, first, &end);
            if (told) ewa_reports_hush(s->context, false);
            EWA_TRY(status);
        }
    return EWA_OK;
}

/// Appends to lod-meta.json.
static ewa_status say(streaming *s, const char *text) {
    const size_t length = strlen(text);
    EWA_TRY(ewa_buffer_grow(s->context, &s->text, s->text_bytes, s->text_bytes + length, 1));
    memcpy((char *)s->text.data + s->text_bytes, text, length);
    s->text_bytes += length;
    return EWA_OK;
}

static ewa_status say_place(streaming *s, const char *name, const double place[3]) {
    EWA_TRY(say(s, name));
    for (int k = 0; k < 3; k++) {
        char number[EWA_NUMBER_BYTES + 1];
        number[ewa_number_write_f64(place[k], number)] = 0;
        EWA_TRY(say(s, number));
        EWA_TRY(say(s, k < 2 ? "," : "]"));
    }
    return EWA_OK;
}

/// Appends the node of leaves [first, end), halved until one is left.
static ewa_status say_node(streaming *s, uint32_t first, uint32_t end) {
    const leaf *own = &s->leaves[first];
    double low[3], high[3];
    memcpy(low, own->low, sizeof low);
    memcpy(high, own->high, sizeof high);
    for (uint32_t i = first + 1; i < end; i++)
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], s->leaves[i].low[k]), high[k] = fmax(high[k], s->leaves[i].high[k]);
    EWA_TRY(say_place(s, "{\"bound\":{\"min\":[", low));
    EWA_TRY(say_place(s, ",\"max\":[", high));
    if (end - first > 1) {
        EWA_TRY(say(s, "},\"children\":["));
        EWA_TRY(say_node(s, first, first + (end - first) / 2));
        EWA_TRY(say(s, ","));
        EWA_TRY(say_node(s, first + (end - first) / 2, end));
        return say(s, "]}");
    }
    for (uint32_t level = 0; level < LEVELS; level++) {
        const level_range *range = &own->levels[level];
        char text[128];
        snprintf(text, sizeof text, "%s\"%u\":{\"file\":%u,\"offset\":%u,\"count\":%u}", level ? "," : "},\"lods\":{", level, range->file,
                 range->offset, range->count);
        EWA_TRY(say(s, text));
    }
    return say(s, "}}");
}

static ewa_status put_meta(streaming *s) {
    const level_file *files = s->files.data;
    uint64_t counts[LEVELS] = {0}, total = 0;
    char text[128];
    for (uint32_t i = 0; i < s->leaf_count; i++)
        for (uint32_t level = 0; level < LEVELS; level++) counts[level] += s->leaves[i].levels[level].count, total += s->leaves[i].levels[level].count;
    snprintf(text, sizeof text, "{\"version\":1,\"asset\":{\"generator\":\"ewa %s\"},\"count\":%llu,\"counts\":[", ewa_version(),
             (unsigned long long)total);
    EWA_TRY(say(s, text));
    for (uint32_t level = 0; level < LEVELS; level++) {
        snprintf(text, sizeof text, "%s%llu", level ? "," : "", (unsigned long long)counts[level]);
        EWA_TRY(say(s, text));
    }
    snprintf(text, sizeof text, "],\"lodLevels\":%d,\"filenames\":[", (int)LEVELS);
    EWA_TRY(say(s, text));
    for (uint32_t i = 0; i < s->file_count; i++) {
        EWA_TRY(say(s, i ? ",\"" : "\""));
        EWA_TRY(say(s, files[i].name));
        EWA_TRY(say(s, "\""));
    }
    EWA_TRY(say(s, "],\"tree\":"));
    EWA_TRY(say_node(s, 0, s->leaf_count));
    EWA_TRY(say(s, "}"));
    return ewa_writer_put(s->target->writer, s->text.data, s->text_bytes);
}

ewa_status ewa_gaussians_write_streamed_sog(const ewa_gaussian_target *target) {
    const ewa_gaussians *set = target->set;
    ewa_context *context = set->context;
    streaming s = {.target = target, .set = set, .context = context};
    if (set->flat) return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: 2D Gaussians have no levels", target->name);
    ewa_status status = make_leaves(&s);
    if (status == EWA_OK) status = write_levels(&s);
    if (status == EWA_OK) status = put_meta(&s);
    level_file *files = s.files.data;
    for (uint32_t i = 0; i < s.file_count && status == EWA_OK; i++) status = ewa_writer_commit(&files[i].writer);
    for (uint32_t i = 0; i < s.file_count; i++) ewa_writer_abort(&files[i].writer);
    ewa_buffer_free(context, &s.text);
    ewa_buffer_free(context, &s.files);
    ewa_release(context, s.masses, (size_t)s.workers * LEAF_GAUSSIANS, sizeof *s.masses);
    ewa_release(context, s.leaves, s.leaf_count, sizeof *s.leaves);
    ewa_release(context, s.order, set->count, sizeof *s.order);
    return status;
}
