// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// lod-meta.json of streamed SOG: a tree of boxes whose leaves say, for each of some levels of detail, where in which file of SOG their
// Gaussians are.
//
// Based on: PlayCanvas, "Streamed SOG"; splat-transform's reader of version 1.
#include "io/gaussian/streamed.h"
#include "io/json_text.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct parsing {
    const ewa_gaussian_source *source;
    ewa_streamed *made;
} parsing;

static ewa_status fail(const parsing *p, const char *what) {
    return ewa_fail(p->source->context, EWA_ERROR_FORMAT, "%s: streamed SOG: %s", p->source->name, what);
}

static bool read_whole(const cJSON *object, const char *name, uint32_t *number) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble < 0x1p32)) return false;
    *number = (uint32_t)item->valuedouble;
    return (double)*number == item->valuedouble;
}

static int compare_levels(const void *a, const void *b) {
    const uint32_t x = ((const ewa_streamed_range *)a)->level, y = ((const ewa_streamed_range *)b)->level;
    return x < y ? -1 : x > y;
}

/// Takes a place of a box, three numbers; false: it is none.
static bool read_place(const cJSON *box, const char *name, double place[3]) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(box, name);
    bool fine = cJSON_GetArraySize(list) == 3;
    for (int k = 0; k < 3 && fine; k++) {
        const cJSON *item = cJSON_GetArrayItem(list, k);
        fine = cJSON_IsNumber(item) && isfinite(item->valuedouble);
        if (fine) place[k] = item->valuedouble;
    }
    return fine;
}

/// Takes the levels of a leaf that have Gaussians.
static ewa_status take_leaf(parsing *p, const cJSON *levels, const cJSON *box) {
    ewa_streamed *made = p->made;
    ewa_context *context = p->source->context;
    ewa_streamed_leaf leaf = {.first = made->range_count};
    const cJSON *level;
    cJSON_ArrayForEach(level, levels) {
        ewa_streamed_range range;
        unsigned number;
        char more;
        if (!level->string || sscanf(level->string, "%9u%c", &number, &more) != 1) return fail(p, "a level of a leaf is no number");
        range.level = number;
        if (!read_whole(level, "file", &range.file) || !read_whole(level, "offset", &range.offset) ||
            !read_whole(level, "count", &range.count) || range.file >= made->file_count)
            return fail(p, "a level of a leaf has no file, offset or count, or a file that is not named");
        if (!range.count) continue;
        EWA_TRY(ewa_buffer_grow(context, &made->ranges, made->range_count, made->range_count + (size_t)1, sizeof range));
        ((ewa_streamed_range *)made->ranges.data)[made->range_count++] = range;
        leaf.count++;
    }
    if (!leaf.count) return EWA_OK;
    qsort((ewa_streamed_range *)made->ranges.data + leaf.first, leaf.count, sizeof(ewa_streamed_range), compare_levels);
    if (!read_place(box, "min", leaf.low_world) || !read_place(box, "max", leaf.high_world))
        for (int k = 0; k < 3; k++) leaf.low_world[k] = -INFINITY, leaf.high_world[k] = INFINITY;
    EWA_TRY(ewa_buffer_grow(context, &made->leaves, made->leaf_count, made->leaf_count + (size_t)1, sizeof leaf));
    ((ewa_streamed_leaf *)made->leaves.data)[made->leaf_count++] = leaf;
    return EWA_OK;
}

/// Goes through the tree below a node; the parser bounds its depth.
static ewa_status take_tree(parsing *p, const cJSON *node) {
    const cJSON *children = cJSON_GetObjectItemCaseSensitive(node, "children"),
                *levels = cJSON_GetObjectItemCaseSensitive(node, "lods"), *child;
    if (!cJSON_IsObject(node) || (children && !cJSON_IsArray(children)) || (levels && !cJSON_IsObject(levels)))
        return fail(p, "the tree has a node that is none");
    if (levels) EWA_TRY(take_leaf(p, levels, cJSON_GetObjectItemCaseSensitive(node, "bound")));
    cJSON_ArrayForEach(child, children) EWA_TRY(take_tree(p, child));
    return EWA_OK;
}

static ewa_status take_name(parsing *p, const char *name) {
    ewa_streamed *made = p->made;
    ewa_context *context = p->source->context;
    const size_t bytes = strlen(name) + 1;
    EWA_TRY(ewa_buffer_grow(context, &made->name_first, made->file_count, made->file_count + (size_t)1, sizeof(size_t)));
    EWA_TRY(ewa_buffer_grow(context, &made->names, made->names_bytes, made->names_bytes + bytes, 1));
    memcpy((char *)made->names.data + made->names_bytes, name, bytes);
    ((size_t *)made->name_first.data)[made->file_count++] = made->names_bytes;
    made->names_bytes += bytes;
    return EWA_OK;
}

static ewa_status take_text(ewa_context *context, const char *text, char **copy) {
    if (!text) return EWA_OK;
    *copy = ewa_allocate(context, strlen(text) + 1, 1);
    if (!*copy) return EWA_ERROR_MEMORY;
    memcpy(*copy, text, strlen(text) + 1);
    return EWA_OK;
}

static ewa_status take_root(parsing *p, const cJSON *root) {
    ewa_streamed *made = p->made;
    const cJSON *environment = cJSON_GetObjectItemCaseSensitive(root, "environment"),
                *names = cJSON_GetObjectItemCaseSensitive(root, "filenames"), *name;
    made->version = 1;
    if (cJSON_GetObjectItemCaseSensitive(root, "version") && !read_whole(root, "version", &made->version)) return fail(p, "version is no number");
    if (made->version != 1)
        return ewa_fail(p->source->context, EWA_ERROR_UNSUPPORTED, "%s: streamed SOG of version %u; 1 is read", p->source->name,
                        made->version);
    if (!cJSON_IsArray(names)) return fail(p, "filenames is no list");
    if (environment && !cJSON_IsString(environment)) return fail(p, "environment is no name");
    cJSON_ArrayForEach(name, names) {
        if (!cJSON_IsString(name)) return fail(p, "filenames has something that is no name");
        EWA_TRY(take_name(p, name->valuestring));
    }
    EWA_TRY(take_tree(p, cJSON_GetObjectItemCaseSensitive(root, "tree")));
    made->environment = environment;
    EWA_TRY(environment ? take_name(p, environment->valuestring) : EWA_OK);
    EWA_TRY(take_text(p->source->context, p->source->name, &made->name));
    return take_text(p->source->context, p->source->path, &made->path);
}

ewa_status ewa_streamed_open(const ewa_gaussian_source *source, ewa_streamed *streamed) {
    ewa_json json = {0};
    *streamed = (ewa_streamed){.context = source->context};
    EWA_TRY(ewa_json_parse(source->context, source->name, "lod-meta.json of SOG", source->bytes, source->size_bytes, &json));
    const ewa_status status = take_root(&(parsing){source, streamed}, json.root);
    ewa_json_free(source->context, &json);
    if (status != EWA_OK) ewa_streamed_free(streamed);
    return status;
}

void ewa_streamed_free(ewa_streamed *streamed) {
    ewa_context *context = streamed->context;
    if (!context) return;
    if (streamed->path) ewa_release(context, streamed->path, strlen(streamed->path) + 1, 1);
    if (streamed->name) ewa_release(context, streamed->name, strlen(streamed->name) + 1, 1);
    ewa_buffer *const buffers[] = {&streamed->ranges, &streamed->leaves, &streamed->names, &streamed->name_first};
    for (size_t b = 0; b < sizeof buffers / sizeof *buffers; b++) ewa_buffer_free(context, buffers[b]);
    *streamed = (ewa_streamed){.context = NULL};
}

const char *ewa_streamed_file(const ewa_streamed *streamed, uint32_t file) {
    return (const char *)streamed->names.data + ((const size_t *)streamed->name_first.data)[file];
}
