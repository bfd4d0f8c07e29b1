// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Gaussians with levels of detail as streamed SOG: lod-meta.json, which sog_streamed.c describes, and archives of SOG beside it. A leaf
// is a run along the Morton curve; of each level the leaves lie one behind the other, so that a leaf is a range of one file. How many Gaussians
// there are says how many every leaf and file has: leaves are taken one after the other, and a file is written when its last one is there.
//
// Beside what the leaves are made of there is one file's worth of Gaussians of each level in memory.
#include "base/platform.h"
#include "cloud/gaussian_tree.h"
#include "cloud/morton.h"
#include "io/gaussian/levels_write.h"
#include "io/number.h"

#include <stdio.h>

/// Leaves are small enough that each can have its own level, and files small enough that what is not seen need not be fetched.
enum { LEAF_GAUSSIANS = EWA_TREE_GAUSSIANS, LEVELS = 5, FILE_GAUSSIANS = 1 << 18, PATH_BYTES = 4096, NAME_BYTES = 32 };

/// Where Gaussians of one level of a leaf are.
typedef struct level_range {
    uint32_t file, offset, count;
} level_range;

typedef struct leaf {
    uint64_t first; ///< of all Gaussians
    uint32_t count;
    double low[3], high[3]; ///< world units, of all within three standard deviations
    level_range levels[LEVELS];
} leaf;

typedef struct level_file {
    char name[NAME_BYTES];
    uint32_t count, end_leaf; ///< Gaussians, and the leaf behind its last
    ewa_writer *writer;
} level_file;

struct ewa_levels_writer {
    const ewa_gaussian_target *target;
    ewa_context *context;
    leaf *leaves;
    uint32_t leaf_count, next_leaf, workers;
    ewa_gaussian_tree *trees; ///< one per worker
    ewa_buffer files;         ///< of level_file, the finest level's first
    uint32_t file_count;
    bool told; ///< what one file has no room for, none has
    ewa_gaussians parts[LEVELS]; ///< what the file that is being filled has of each level
    ewa_buffer text; ///< of lod-meta.json
    size_t text_bytes;
    // one parallel step over leaves:
    const ewa_gaussians *set;
    const uint32_t *order;
    uint64_t order_first; ///< of all Gaussians: the first of `order`
};

/// Lays out which file has what.
static ewa_status lay_out(ewa_levels_writer *s, uint32_t level) {
    uint32_t number = 0;
    for (uint32_t i = 0; i < s->leaf_count; number++) {
        EWA_TRY(ewa_buffer_grow(s->context, &s->files, s->file_count, s->file_count + (size_t)1, sizeof(level_file)));
        level_file *file = (level_file *)s->files.data + s->file_count;
        *file = (level_file){.count = 0};
        snprintf(file->name, sizeof file->name, "%u_%u.sog", level, number);
        for (; i < s->leaf_count && (!file->count || file->count + s->leaves[i].levels[level].count <= FILE_GAUSSIANS); i++) {
            level_range *range = &s->leaves[i].levels[level];
            range->file = s->file_count, range->offset = file->count;
            file->count += range->count;
        }
        file->end_leaf = i;
        s->file_count++;
    }
    return EWA_OK;
}

ewa_status ewa_levels_writer_open(const ewa_gaussian_target *target, ewa_levels_writer **writer) {
    const ewa_gaussians *like = target->set;
    ewa_context *context = like->context;
    *writer = NULL;
    if (like->flat) return ewa_fail(context, EWA_ERROR_UNSUPPORTED, "%s: 2D Gaussians have no levels", target->name);
    ewa_levels_writer *s = ewa_allocate_zeroed(context, 1, sizeof *s);
    if (!s) return EWA_ERROR_MEMORY;
    *writer = s;
    s->target = target, s->context = context;
    s->leaf_count = (like->count - 1) / LEAF_GAUSSIANS + 1;
    s->workers = ewa_context_worker_count(context);
    s->leaves = ewa_allocate_zeroed(context, s->leaf_count, sizeof *s->leaves);
    s->trees = ewa_allocate(context, s->workers, sizeof *s->trees);
    if (!s->leaves || !s->trees) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < s->leaf_count; i++) {
        leaf *own = &s->leaves[i];
        own->first = ewa_split(like->count, s->leaf_count, i);
        own->count = (uint32_t)(ewa_split(like->count, s->leaf_count, i + 1) - own->first);
        for (uint32_t level = 0; level < LEVELS; level++) own->levels[level].count = ((own->count - 1) >> 2 * level) + 1;
    }
    for (uint32_t level = 0; level < LEVELS; level++) EWA_TRY(lay_out(s, level));
    return EWA_OK;
}

static void copy(const ewa_gaussians *set, size_t from, ewa_gaussians *part, size_t to) {
    const size_t numbers = 3 * (size_t)ewa_sh_count(set->sh_degree);
    memcpy(part->centers + 3 * to, set->centers + 3 * from, 3 * sizeof(float));
    memcpy(part->scales + 3 * to, set->scales + 3 * from, 3 * sizeof(float));
    memcpy(part->rotations + 4 * to, set->rotations + 4 * from, 4 * sizeof(float));
    memcpy(part->harmonics + numbers * to, set->harmonics + numbers * from, numbers * sizeof(float));
    part->opacities[to] = set->opacities[from];
}

static void measure(const ewa_gaussians *set, const uint32_t *members, leaf *own) {
    for (uint32_t i = 0; i < own->count; i++) {
        const float *scales = set->scales + 3 * (size_t)members[i];
        const double reach = 3 * (double)fmaxf(fmaxf(scales[0], scales[1]), scales[2]);
        for (size_t k = 0; k < 3; k++) {
            const double at = set->origin[k] + (double)set->centers[3 * (size_t)members[i] + k];
            own->low[k] = i ? fmin(own->low[k], at - reach) : at - reach;
            own->high[k] = i ? fmax(own->high[k], at + reach) : at + reach;
        }
    }
}

/// Fills a leaf's ranges of all levels.
static void fill_leaf(void *data, uint32_t index, uint32_t worker) {
    ewa_levels_writer *s = data;
    leaf *own = &s->leaves[s->next_leaf + index];
    ewa_gaussian_tree *tree = &s->trees[worker];
    const uint32_t *members = s->order + (own->first - s->order_first);
    measure(s->set, members, own);
    ewa_gaussian_tree_make(tree, s->set, members, own->count);
    for (uint32_t i = 0; i < own->count; i++) copy(s->set, tree->members[i], &s->parts[0], own->levels[0].offset + (size_t)i);
    for (uint32_t level = 1; level < LEVELS; level++) {
        const level_range *range = &own->levels[level];
        ewa_gaussian_tree_cut(tree, range->count);
        for (uint32_t g = 0; g < range->count; g++) ewa_gaussian_tree_merge(tree, s->set, g, &s->parts[level], range->offset + (size_t)g);
    }
}

/// Writes a part to a file beside lod-meta.json, which gets its name when all are there.
static ewa_status write_part(ewa_levels_writer *s, const ewa_gaussians *part, level_file *file) {
    char path[PATH_BYTES];
    const char *name = s->target->name;
    const int folder_bytes = (int)(ewa_platform_file_name(name) - name);
    if (snprintf(path, sizeof path, "%.*s%s", folder_bytes, name, file->name) >= (int)sizeof path)
        return ewa_fail(s->context, EWA_ERROR_LIMIT, "%s: the path is longer than %d bytes", name, PATH_BYTES);
    EWA_TRY(ewa_writer_open(s->context, path, &file->writer));
    if (s->told) ewa_reports_hush(s->context, true);
    const ewa_status status = ewa_gaussians_write_sog(&(ewa_gaussian_target){
        .set = part, .name = path, .writer = file->writer, .sh_degree = s->target->sh_degree, .keep_order = true});
    if (s->told) ewa_reports_hush(s->context, false);
    s->told = true;
    return status;
}

/// Takes leaves up to `end`, behind which no file of any level goes on that is not there to be filled.
static ewa_status take_leaves(ewa_levels_writer *s, uint32_t end) {
    const ewa_gaussians *like = s->target->set;
    level_file *files = s->files.data;
    for (uint32_t level = 0; level < LEVELS; level++) {
        ewa_gaussians *part = &s->parts[level];
        if (part->context) continue;
        EWA_TRY(ewa_gaussians_create(s->context, files[s->leaves[s->next_leaf].levels[level].file].count, like->sh_degree, part));
        memcpy(part->origin, like->origin, sizeof part->origin);
        part->antialiased = like->antialiased;
    }
    EWA_TRY(ewa_parallel_stoppable(s->context, "levels", fill_leaf, s, end - s->next_leaf));
    s->next_leaf = end;
    for (uint32_t level = 0; level < LEVELS; level++) {
        level_file *file = &files[s->leaves[end - 1].levels[level].file];
        if (file->end_leaf != end) continue;
        EWA_TRY(write_part(s, &s->parts[level], file));
        ewa_gaussians_free(&s->parts[level]);
    }
    return EWA_OK;
}

ewa_status ewa_levels_writer_add(ewa_levels_writer *s, const ewa_gaussians *set, const uint32_t *order, uint32_t count, uint32_t *taken) {
    const level_file *files = s->files.data;
    s->set = set, s->order = order;
    s->order_first = s->next_leaf < s->leaf_count ? s->leaves[s->next_leaf].first : 0;
    const uint64_t order_end = s->order_first + count;
    for (*taken = 0; s->next_leaf < s->leaf_count;) {
        uint32_t end = s->next_leaf, last = s->leaf_count;
        for (uint32_t level = 0; level < LEVELS; level++) {
            const uint32_t end_leaf = files[s->leaves[end].levels[level].file].end_leaf;
            last = end_leaf < last ? end_leaf : last;
        }
        while (end < last && s->leaves[end].first + s->leaves[end].count <= order_end) end++;
        if (end == s->next_leaf) break;
        EWA_TRY(take_leaves(s, end));
        *taken = (uint32_t)(s->leaves[end - 1].first + s->leaves[end - 1].count - s->order_first);
    }
    return EWA_OK;
}

/// Appends to lod-meta.json.
static ewa_status say(ewa_levels_writer *s, const char *text) {
    const size_t length = strlen(text);
    EWA_TRY(ewa_buffer_grow(s->context, &s->text, s->text_bytes, s->text_bytes + length, 1));
    memcpy((char *)s->text.data + s->text_bytes, text, length);
    s->text_bytes += length;
    return EWA_OK;
}

static ewa_status say_place(ewa_levels_writer *s, const char *name, const double place[3]) {
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
static ewa_status say_node(ewa_levels_writer *s, uint32_t first, uint32_t end) {
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

static ewa_status put_meta(ewa_levels_writer *s) {
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

ewa_status ewa_levels_writer_finish(ewa_levels_writer *s) {
    level_file *files = s->files.data;
    EWA_TRY(put_meta(s));
    for (uint32_t i = 0; i < s->file_count; i++) EWA_TRY(ewa_writer_commit(&files[i].writer));
    return EWA_OK;
}

void ewa_levels_writer_close(ewa_levels_writer **writer) {
    ewa_levels_writer *s = *writer;
    if (!s) return;
    *writer = NULL;
    ewa_context *context = s->context;
    level_file *files = s->files.data;
    for (uint32_t i = 0; i < s->file_count; i++) ewa_writer_abort(&files[i].writer);
    for (uint32_t level = 0; level < LEVELS; level++) ewa_gaussians_free(&s->parts[level]);
    ewa_buffer_free(context, &s->text);
    ewa_buffer_free(context, &s->files);
    ewa_release(context, s->trees, s->workers, sizeof *s->trees);
    ewa_release(context, s->leaves, s->leaf_count, sizeof *s->leaves);
    ewa_release(context, s, 1, sizeof *s);
}

ewa_status ewa_gaussians_write_streamed_sog(const ewa_gaussian_target *target) {
    const ewa_gaussians *set = target->set;
    ewa_context *context = set->context;
    const ewa_attribute position = {.data = set->centers, .type = EWA_F32, .component_count = 3, .stride_bytes = 3 * sizeof(float)};
    ewa_levels_writer *writer = NULL;
    uint32_t *order = NULL, taken;
    ewa_status status = ewa_levels_writer_open(target, &writer);
    if (status == EWA_OK) order = ewa_allocate(context, set->count, sizeof *order);
    if (status == EWA_OK) status = order ? ewa_morton_order(context, &position, set->count, order, NULL, NULL) : EWA_ERROR_MEMORY;
    if (status == EWA_OK) status = ewa_levels_writer_add(writer, set, order, set->count, &taken);
    if (status == EWA_OK) status = ewa_levels_writer_finish(writer);
    ewa_release(context, order, set->count, sizeof *order);
    ewa_levels_writer_close(&writer);
    return status;
}
