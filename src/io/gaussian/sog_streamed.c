// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Streamed SOG as one set: of each leaf one level, of which a file of SOG beside lod-meta.json has a range, and the environment, where
// there is one.
#include "io/gaussian/streamed.h"
#include "io/referenced_file.h"

#include <stdio.h>

typedef struct joining {
    ewa_context *context;
    const ewa_streamed *streamed;
    bool coarsest;
    uint64_t total;
    uint32_t *file_first; ///< [file_count + 1] of `order`
    uint32_t *order;      ///< [leaf_count] leaves by file
    ewa_gaussians *sets;  ///< [file_count] what is read of each
} joining;

static const ewa_streamed_range *chosen(const joining *j, uint32_t leaf) {
    const ewa_streamed_leaf *own = (const ewa_streamed_leaf *)j->streamed->leaves.data + leaf;
    return (const ewa_streamed_range *)j->streamed->ranges.data + own->first + (j->coarsest ? own->count - 1 : 0);
}

/// Lists the ranges of each file.
static ewa_status list_files(joining *j) {
    const uint32_t files = j->streamed->file_count, leaves = j->streamed->leaf_count;
    j->file_first = ewa_allocate_zeroed(j->context, files + (size_t)1, sizeof *j->file_first);
    j->order = ewa_allocate_zeroed(j->context, leaves, sizeof *j->order);
    j->sets = ewa_allocate_zeroed(j->context, files, sizeof *j->sets);
    if (!j->file_first || !j->order || !j->sets) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < leaves; i++) j->file_first[chosen(j, i)->file + 1]++, j->total += chosen(j, i)->count;
    for (uint32_t i = 0; i < files; i++) j->file_first[i + 1] += j->file_first[i];
    for (uint32_t i = 0; i < leaves; i++) j->order[j->file_first[chosen(j, i)->file]++] = i;
    memmove(j->file_first + 1, j->file_first, files * sizeof *j->file_first);
    j->file_first[0] = 0;
    return EWA_OK;
}

ewa_status ewa_streamed_read_file(ewa_context *context, const ewa_streamed *streamed, uint32_t index, ewa_gaussians *set) {
    const char *name = ewa_streamed_file(streamed, index);
    char shown[512], path[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    ewa_file file;
    *set = (ewa_gaussians){.context = NULL};
    snprintf(shown, sizeof shown, "%s: %s", streamed->name, name);
    if (!streamed->path) return ewa_fail(context, EWA_ERROR_IO, "%s: there is no folder that it could be in", shown);
    if (!ewa_referenced_file_find(context, streamed->path, name, false, path, reason) ||
        !ewa_referenced_file_map(context, streamed->path, (ewa_text){name, strlen(name)}, &file, reason))
        return ewa_fail(context, EWA_ERROR_IO, "%s: %s", shown, reason);
    const ewa_gaussian_source source = {context, shown, path, file.bytes, file.size_bytes};
    ewa_gaussian_facts facts = {0};
    ewa_status status = EWA_OK;
    const bool sog = source.size_bytes && ewa_gaussians_sog.probe(&source, &status);
    if (status == EWA_OK && !sog) status = ewa_fail(context, EWA_ERROR_FORMAT, "%s: is no SOG", shown);
    if (status == EWA_OK) status = ewa_gaussians_sog.read(&source, set, &facts);
    ewa_file_unmap(context, &file);
    if (status != EWA_OK) ewa_gaussians_free(set);
    return status;
}

ewa_status ewa_streamed_check(ewa_context *context, const ewa_streamed *streamed, const ewa_streamed_range *range, uint32_t count) {
    if ((uint64_t)range->offset + range->count <= count) return EWA_OK;
    return ewa_fail(context, EWA_ERROR_FORMAT, "%s: streamed SOG: leaves take %u Gaussians from number %u on of %s, which has %u", streamed->name,
                    range->count, range->offset, ewa_streamed_file(streamed, range->file), count);
}

/// Whether the leaves ask no more of a file than it has, so that none is there twice.
static ewa_status check_ranges(const joining *j, uint32_t file) {
    const uint32_t count = j->sets[file].count;
    uint64_t taken = 0;
    for (uint32_t k = j->file_first[file]; k < j->file_first[file + 1]; k++) {
        const ewa_streamed_range *range = chosen(j, j->order[k]);
        taken += range->count;
        EWA_TRY(ewa_streamed_check(j->context, j->streamed, range, count));
        if (taken > count)
            return ewa_fail(j->context, EWA_ERROR_FORMAT, "%s: streamed SOG: leaves take %llu Gaussians of %s, which has %u",
                            j->streamed->name, (unsigned long long)taken, ewa_streamed_file(j->streamed, file), count);
    }
    return EWA_OK;
}

void ewa_streamed_copy(const ewa_gaussians *from, size_t first, size_t count, ewa_gaussians *to, size_t *at) {
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
static ewa_status put_together(joining *j, ewa_gaussians *set) {
    const ewa_streamed *streamed = j->streamed;
    const ewa_gaussians *environment = streamed->environment ? &j->sets[streamed->file_count - 1] : NULL;
    uint32_t degree = 0;
    bool flat = true, antialiased = false;
    for (uint32_t i = 0; i < streamed->file_count; i++) {
        if (!j->sets[i].count) continue;
        degree = j->sets[i].sh_degree > degree ? j->sets[i].sh_degree : degree;
        flat = flat && j->sets[i].flat, antialiased = antialiased || j->sets[i].antialiased;
    }
    const ewa_gaussian_source source = {.context = j->context, .name = streamed->name};
    EWA_TRY(ewa_gaussians_make(&source, j->total + (environment ? environment->count : 0), 0, 0, degree, set));
    set->flat = flat, set->antialiased = antialiased;
    size_t at = 0;
    for (uint32_t i = 0; i < streamed->leaf_count; i++)
        ewa_streamed_copy(&j->sets[chosen(j, i)->file], chosen(j, i)->offset, chosen(j, i)->count, set, &at);
    if (environment) ewa_streamed_copy(environment, 0, environment->count, set, &at);
    return EWA_OK;
}

ewa_status ewa_streamed_join(ewa_context *context, const ewa_streamed *streamed, bool coarsest, ewa_gaussians *set) {
    joining j = {.context = context, .streamed = streamed, .coarsest = coarsest};
    *set = (ewa_gaussians){.context = NULL};
    ewa_status status = list_files(&j);
    for (uint32_t i = 0; i < streamed->file_count && status == EWA_OK; i++) {
        const bool environment = streamed->environment && i + 1 == streamed->file_count;
        if (!environment && j.file_first[i] == j.file_first[i + 1]) continue;
        status = ewa_streamed_read_file(context, streamed, i, &j.sets[i]);
        if (status == EWA_OK) status = check_ranges(&j, i);
    }
    if (status == EWA_OK) status = put_together(&j, set);
    for (uint32_t i = 0; j.sets && i < streamed->file_count; i++) ewa_gaussians_free(&j.sets[i]);
    ewa_release(context, j.sets, streamed->file_count, sizeof *j.sets);
    ewa_release(context, j.order, streamed->leaf_count, sizeof *j.order);
    ewa_release(context, j.file_first, streamed->file_count + (size_t)1, sizeof *j.file_first);
    if (status != EWA_OK) ewa_gaussians_free(set);
    return status;
}

static ewa_status read_streamed(const ewa_gaussian_source *source, ewa_gaussians *set, ewa_gaussian_facts *facts) {
    ewa_streamed streamed;
    EWA_TRY(ewa_streamed_open(source, &streamed));
    const ewa_status status = ewa_streamed_join(source->context, &streamed, false, set);
    facts->version = streamed.version;
    ewa_streamed_free(&streamed);
    return status;
}

static bool probe(const ewa_gaussian_source *source, ewa_status *status) {
    (void)status;
    return ewa_gaussian_text_has(source, (const char *const[]){"filenames", "lodLevels", "tree"}, 3);
}

const ewa_gaussian_reader ewa_gaussians_sog_streamed = {EWA_GAUSSIANS_STREAMED_SOG, probe, read_streamed};
