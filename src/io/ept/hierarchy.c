// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The hierarchy of EPT: files of JSON, each a part of the tree below a node, that lead from one to the next.
#include "base/base.h"
#include "io/ept/ept.h"
#include "io/number.h"

#include <stdlib.h>
#include <string.h>

/// Nodes whose own file is still to be read.
typedef struct key_list {
    ewa_buffer buffer;
    size_t count;
} key_list;

static int compare_keys(const void *a, const void *b) { return ewa_octree_key_compare(a, b); }

/// Reads "level-x-y-z" that is the whole text; false when it is no node.
static bool read_key(const char *text, ewa_octree_key *key) {
    int64_t numbers[4];
    const char *end = text + strlen(text);
    for (int i = 0; i < 4; i++) {
        if (*text < '0' || *text > '9') return false;
        text = ewa_number_read_i64(text, end, &numbers[i]);
        if (!text || *text != (i < 3 ? '-' : 0)) return false;
        text++;
    }
    if (numbers[0] >= EWA_OCTREE_LEVELS) return false;
    key->level = (int32_t)numbers[0];
    for (int c = 0; c < 3; c++) {
        if (numbers[c + 1] >= (int64_t)1 << key->level) return false;
        key->cell[c] = (int32_t)numbers[c + 1];
    }
    return true;
}

/// Whether a node lies within another, or is it.
static bool is_within(const ewa_octree_key *key, const ewa_octree_key *root) {
    const int32_t steps = key->level - root->level;
    if (steps < 0) return false;
    for (int c = 0; c < 3; c++)
        if (key->cell[c] >> steps != root->cell[c]) return false;
    return true;
}

/// Takes the entries of the file at `root`; nodes with files of their own join the list.
static ewa_status take_entries(ewa_octree *octree, const char *path, const cJSON *entries,
                               const ewa_octree_key *root, key_list *list) {
    ewa_context *context = octree->context;
    const cJSON *entry;
    char shown[EWA_EPT_SHOWN_BYTES];
    cJSON_ArrayForEach(entry, entries) {
        ewa_octree_node node = {0};
        const double count = cJSON_IsNumber(entry) ? entry->valuedouble : -2;
        // Files lead downwards only, so that they end.
        const bool is_good = read_key(entry->string, &node.key) && is_within(&node.key, root) &&
                             count >= -1 && count < 0x1p53 && count == (double)(int64_t)count &&
                             !(count < 0 && node.key.level == root->level);
        if (!is_good)
            return ewa_fail(
                context, EWA_ERROR_FORMAT,
                "%s: \"%s\" is no node \"level-x-y-z\" within %d-%d-%d-%d with a number of points, or "
                "-1 for a file below this one",
                path, ewa_ept_show(entry->string, shown), root->level, root->cell[0], root->cell[1],
                root->cell[2]);
        if (count < 0) {
            EWA_TRY(ewa_buffer_grow(context, &list->buffer, list->count, list->count + 1, sizeof node.key));
            ((ewa_octree_key *)list->buffer.data)[list->count++] = node.key;
        } else if (count > 0) {
            node.point_count = (uint64_t)count;
            EWA_TRY(ewa_octree_add(octree, &node));
        }
    }
    return EWA_OK;
}

static ewa_status read_file(ewa_octree *octree, const ewa_ept *ept, const ewa_octree_key *root,
                            key_list *list) {
    ewa_context *context = octree->context;
    char path[EWA_EPT_PATH_BYTES];
    ewa_file file;
    EWA_TRY(ewa_ept_open(ept, "ept-hierarchy/", root, "json", path, &file));
    ewa_json json;
    ewa_status status = ewa_json_parse(context, path, "a hierarchy of EPT", file.bytes, file.size_bytes, &json);
    if (status == EWA_OK && !cJSON_IsObject(json.root))
        status =
            ewa_fail(context, EWA_ERROR_FORMAT, "%s: no object of nodes and their numbers of points", path);
    if (status == EWA_OK) status = take_entries(octree, path, json.root, root, list);
    ewa_json_free(context, &json);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_ept_hierarchy(ewa_octree *octree, const ewa_ept *ept) {
    ewa_context *context = octree->context;
    key_list lists[2] = {{{0}, 0}, {{0}, 0}};
    const ewa_octree_key root = {0};
    ewa_status status = read_file(octree, ept, &root, &lists[0]);
    // One generation of files after the other, of which each has the next.
    for (int now = 0; lists[now].count && status == EWA_OK; now = !now) {
        const ewa_octree_key *keys = lists[now].buffer.data;
        qsort(lists[now].buffer.data, lists[now].count, sizeof *keys, compare_keys);
        lists[!now].count = 0;
        for (size_t i = 0; i < lists[now].count && status == EWA_OK; i++) {
            const ewa_octree_key *k = &keys[i];
            if (i && ewa_octree_key_compare(k, k - 1) == 0)
                status = ewa_fail(context, EWA_ERROR_FORMAT,
                                  "%s: the file of %d-%d-%d-%d is named twice in the hierarchy", octree->path,
                                  k->level, k->cell[0], k->cell[1], k->cell[2]);
            else
                status = read_file(octree, ept, k, &lists[!now]);
        }
    }
    ewa_buffer_free(context, &lists[0].buffer);
    ewa_buffer_free(context, &lists[1].buffer);
    return status;
}
