// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Streamed SOG: lod-meta.json has a tree of boxes whose leaves say, for each of some levels of detail, where in which file of SOG their
// Gaussians are. Of each leaf the finest level is read, and the environment, where there is one.
//
// Based on: PlayCanvas, "Streamed SOG"; splat-transform's reader of version 1.
#include "io/gaussian/gaussian.h"
#include "io/json_text.h"
#include "io/referenced_file.h"

#include <stdio.h>

/// Gaussians of one leaf.
typedef struct leaf_range {
    uint64_t file, offset, count;
} leaf_range;

typedef struct streamed {
    const ewa_gaussian_source *source;
    const cJSON *names;
    uint64_t name_count;
    ewa_buffer ranges;
    uint64_t range_count, total;
    const cJSON **files;  ///< [file_count] the names, then that of the environment
    uint64_t *range_first; ///< [file_count + 1] of `order`
    uint64_t file_count;
    uint64_t *order;      ///< [range_count] ranges by file
    ewa_gaussians *sets;  ///< [file_count] what is read of each
} streamed;

static ewa_status fail(const streamed *s, const char *what) {
    return ewa_fail(s->source->context, EWA_ERROR_FORMAT, "%s: streamed SOG: %s", s->source->name, what);
}

static bool read_whole(const cJSON *object, const char *name, uint64_t *number) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble < 0x1p32)) return false;
    *number = (uint64_t)item->valuedouble;
    return (double)*number == item->valuedouble;
}

static ewa_status add_range(streamed *s, leaf_range range) {
    EWA_TRY(ewa_buffer_grow(s->source->context, &s->ranges, s->range_count, s->range_count + 1, sizeof range));
    ((leaf_range *)s->ranges.data)[s->range_count++] = range;
    s->total += range.count; // less than 2^32 each, and no more than bytes of the text
    return EWA_OK;
}

/// Takes the finest level of a leaf.
static ewa_status take_leaf(streamed *s, const cJSON *levels) {
    const cJSON *level, *finest = NULL;
    unsigned long best = 0;
    cJSON_ArrayForEach(level, levels) {
        unsigned number;
        char more;
        if (!level->string || sscanf(level->string, "%9u%c", &number, &more) != 1) return fail(s, "a level of a leaf is no number");
        if (!finest || number < best) finest = level, best = number;
    }
    leaf_range range;
    if (!finest) return EWA_OK;
    if (!read_whole(finest, "file", &range.file) || !read_whole(finest, "offset", &range.offset) ||
        !read_whole(finest, "count", &range.count) || range.file >= s->name_count)
        return fail(s, "a level of a leaf has no file, offset or count, or a file that is not named");
    return range.count ? add_range(s, range) : EWA_OK;
}

/// Goes through the tree below a node; the parser bounds its depth.
static ewa_status take_tree(streamed *s, const cJSON *node) {
    const cJSON *children = cJSON_GetObjectItemCaseSensitive(node, "children"),
                *levels = cJSON_GetObjectItemCaseSensitive(node, "lods"), *child;
    if (!cJSON_IsObject(node) || (children && !cJSON_IsArray(children)) || (levels && !cJSON_IsObject(levels)))
        return fail(s, "the tree has a node that is none");
    if (levels) EWA_TRY(take_leaf(s, levels));
    cJSON_ArrayForEach(child, children) EWA_TRY(take_tree(s, child));
    return EWA_OK;
}

/// Lists the files, and the ranges of each.
static ewa_status list_files(streamed *s, const cJSON *environment) {
    ewa_context *context = s->source->context;
    s->file_count = s->name_count + 1;
    s->files = ewa_allocate_zeroed(context, s->file_count, sizeof *s->files);
    s->range_first = ewa_allocate_zeroed(context, s->file_count + 1, sizeof *s->range_first);
    s->order = ewa_allocate_zeroed(context, s->range_count + 1, sizeof *s->order);
    s->sets = ewa_allocate_zeroed(context, s->file_count, sizeof *s->sets);
    if (!s->files || !s->range_first || !s->order || !s->sets) return EWA_ERROR_MEMORY;
    const leaf_range *ranges = s->ranges.data;
    const cJSON *name;
    uint64_t n = 0;
    cJSON_ArrayForEach(name, s->names) s->files[n++] = name;
    s->files[n] = environment;
    for (uint64_t i = 0; i < s->range_count; i++) s->range_first[ranges[i].file + 1]++;
    for (uint64_t i = 0; i < s->file_count; i++) s->range_first[i + 1] += s->range_first[i];
    for (uint64_t i = 0; i < s->range_count; i++) s->order[s->range_first[ranges[i].file]++] = i;
    memmove(s->range_first + 1, s->range_first, s->file_count * sizeof *s->range_first);
    s->range_first[0] = 0;
    return EWA_OK;
}

/// Reads a file of SOG beside lod-meta.json.
static ewa_status read_file(streamed *s, uint64_t index) {
    ewa_context *context = s->source->context;
    const char *name = s->files[index]->valuestring;
    char shown[512], path[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    ewa_file file;
    snprintf(shown, sizeof shown, "%s: %s", s->source->name, name);
    if (!s->source->path) return ewa_fail(context, EWA_ERROR_IO, "%s: there is no folder that it could be in", shown);
    if (!ewa_referenced_file_find(context, s->source->path, name, false, path, reason) ||
        !ewa_referenced_file_map(context, s->source->path, (ewa_text){name, strlen(name)}, &file, reason))
        return ewa_fail(context, EWA_ERROR_IO, "%s: %s", shown, reason);
    const ewa_gaussian_source source = {context, shown, path, file.bytes, file.size_bytes};
    ewa_gaussian_facts facts = {0};
    ewa_status status = EWA_OK;
    const bool sog = source.size_bytes && ewa_gaussians_sog.probe(&source, &status);
    if (status == EWA_OK && !sog) status = ewa_fail(context, EWA_ERROR_FORMAT, "%s: is no SOG", shown);
    if (status == EWA_OK) status = ewa_gaussians_sog.read(&source, &s->sets[index], &facts);
    ewa_file_unmap(context, &file);
    return status;
}

/// Whether the leaves ask no more of a file than it has, so that none is there twice.
static ewa_status check_ranges(const streamed *s, uint64_t index) {
    const leaf_range *ranges = s->ranges.data;
    uint64_t taken = 0;
    for (uint64_t k = s->range_first[index]; k < s->range_first[index + 1]; k++) {
        const leaf_range *range = &ranges[s->order[k]];
        taken += range->count;
        if (range->offset + range->count > s->sets[index].count || taken > s->sets[index].count)
            return ewa_fail(s->source->context, EWA_ERROR_FORMAT,
                            "%s: streamed SOG: leaves take %llu Gaussians from number %llu on of %s, which has %u", s->source->name,
                            (unsigned long long)range->count, (unsigned long long)range->offset, s->files[index]->valuestring,
                            s->sets[index].count);
    }
    return EWA_OK;
}

/// Copies a range of a set, of at most its degree, behind what is there.
static void append(const ewa_gaussians *from, size_t first, size_t count, ewa_gaussians *to, size_t *at) {
    if (!count) return;
    const size_t own = 3 * (size_t)ewa_sh_count(from->sh_degree), all = 3 * (size_t)ewa_sh_count(to->sh_degree);
    memcpy(to->centers + 3 * *at, from->centers + 3 * first, 3 * count * sizeof(float));
    memcpy(to->scales + 3 * *at, from->scales + 3 * first, 3 * count * sizeof(float));
    memcpy(to->rotations + 4 * *at, from->rotations + 4 * first, 4 * count * sizeof(float));
    memcpy(to->opacities + *at, from->opacities + first, count * sizeof(float));
    for (size_t i = 0; i < count; i++) // more harmonics are 0
        memcpy(to->harmonics + all * (*at + i), from->harmonics + own * (first + i), own * sizeof(float));
    *at += count;
}

/// Puts together what the leaves have, in their order, and the environment.
static ewa_status join(streamed *s, ewa_gaussians *set) {
    const leaf_range *ranges = s->ranges.data;
    const ewa_gaussians *environment = &s->sets[s->name_count];
    uint32_t degree = 0;
    bool flat = true, antialiased = false;
    for (uint64_t i = 0; i < s->file_count; i++) {
        if (!s->sets[i].count) continue;
        degree = s->sets[i].sh_degree > degree ? s->sets[i].sh_degree : degree;
        flat = flat && s->sets[i].flat, antialiased = antialiased || s->sets[i].antialiased;
    }
    EWA_TRY(ewa_gaussians_make(s->source, s->total + environment->count, 0, 0, degree, set));
    set->flat = flat, set->antialiased = antialiased;
    size_t at = 0;
    for (uint64_t i = 0; i < s->range_count; i++)
        append(&s->sets[ranges[i].file], (size_t)ranges[i].offset, (size_t)ranges[i].count, set, &at);
    append(environment, 0, environment->count, set, &at);
    return EWA_OK;
}

static ewa_status read_with(streamed *s, const cJSON *root, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    const cJSON *environment = cJSON_GetObjectItemCaseSensitive(root, "environment"), *name;
    uint64_t version = 1;
    if (cJSON_GetObjectItemCaseSensitive(root, "version") && !read_whole(root, "version", &version)) return fail(s, "version is no number");
    if (version != 1)
        return ewa_fail(s->source->context, EWA_ERROR_UNSUPPORTED, "%s: streamed SOG of version %llu; 1 is read", s->source->name,
                        (unsigned long long)version);
    s->names = cJSON_GetObjectItemCaseSensitive(root, "filenames");
    if (!cJSON_IsArray(s->names)) return fail(s, "filenames is no list");
    cJSON_ArrayForEach(name, s->names) {
        if (!cJSON_IsString(name)) return fail(s, "filenames has something that is no name");
        s->name_count++;
    }
    if (environment && !cJSON_IsString(environment)) return fail(s, "environment is no name");
    EWA_TRY(take_tree(s, cJSON_GetObjectItemCaseSensitive(root, "tree")));
    EWA_TRY(list_files(s, environment));
    for (uint64_t i = 0; i < s->file_count; i++) {
        const bool wanted = i < s->name_count ? s->range_first[i] < s->range_first[i + 1] : environment != NULL;
        if (!wanted) continue;
        EWA_TRY(read_file(s, i));
        EWA_TRY(check_ranges(s, i));
    }
    facts->version = (uint32_t)version;
    return join(s, set);
}

static ewa_status read_streamed(const ewa_gaussian_source *source, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    streamed s = {.source = source};
    ewa_json json = {0};
    ewa_context *context = source->context;
    ewa_status status = ewa_json_parse(context, source->name, "lod-meta.json of SOG", source->bytes, source->size_bytes, &json);
    if (status == EWA_OK) status = read_with(&s, json.root, set, facts);
    for (uint64_t i = 0; s.sets && i < s.file_count; i++) ewa_gaussians_free(&s.sets[i]);
    ewa_release(context, s.sets, s.file_count, sizeof *s.sets);
    ewa_release(context, s.order, s.range_count + 1, sizeof *s.order);
    ewa_release(context, s.range_first, s.file_count + 1, sizeof *s.range_first);
    ewa_release(context, s.files, s.file_count, sizeof *s.files);
    ewa_buffer_free(context, &s.ranges);
    ewa_json_free(context, &json);
    return status;
}

static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    (void)status;
    return ewa_gaussian_text_has(source, (const char *const[]){"filenames", "lodLevels", "tree"}, 3);
}

const ewa_gaussian_reader ewa_gaussians_sog_streamed = {EWA_GAUSSIANS_STREAMED_SOG, probe, read_streamed};
