// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Pages and nodes in the form of the file, and the plan that all regions are made by.
#include "cloud/cloud.h"
#include "estimate/curvature.h"
#include "ewa/select.h"
#include "image/srgb.h"
#include "lod/records.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 16, MEASURED_LEAVES = 8 };

/// Whether attributes make surfels.
static bool has(const ewa_cloud *cloud, const char *name, uint32_t component_count) {
    const ewa_attribute *attribute = ewa_cloud_find(cloud, name);
    return attribute && attribute->component_count == component_count;
}

static ewa_status make_output(ewa_region_plan *plan) {
    const ewa_lattice *lattice = &plan->statistics->lattice;
    ewa_status status = ewa_cloud_create(plan->context, 0, &plan->output);
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(plan->inputs) && status == EWA_OK; a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(plan->inputs, a);
        const bool is_place = strcmp(attribute->name, EWA_POSITION) == 0;
        if (plan->makes_normals && strcmp(attribute->name, EWA_NORMAL) == 0) continue;
        if (plan->makes_radii && strcmp(attribute->name, EWA_RADIUS) == 0) continue;
        if (plan->makes_curvatures && strcmp(attribute->name, EWA_CURVATURE) == 0) continue;
        if (plan->makes_radii && strcmp(attribute->name, EWA_BORDER) == 0) continue;
        status = ewa_cloud_add(plan->output, attribute->name, is_place ? EWA_F64 : attribute->type,
                               attribute->component_count, NULL);
    }
    if (status == EWA_OK && plan->makes_normals)
        status = ewa_cloud_add(plan->output, EWA_NORMAL, EWA_I16, 3, NULL);
    if (status == EWA_OK && plan->makes_radii)
        status = ewa_cloud_add(plan->output, EWA_RADIUS, EWA_F32, 1, NULL);
    if (status == EWA_OK && plan->makes_curvatures)
        status = ewa_cloud_add(plan->output, EWA_CURVATURE, EWA_F32, 1, NULL);
    if (status == EWA_OK && plan->makes_radii)
        status = ewa_cloud_add(plan->output, EWA_BORDER, EWA_F32, 3, NULL);
    if (status == EWA_OK) status = ewa_cloud_follow(plan->output, plan->inputs);
    ewa_coordinate_grid grid;
    for (int c = 0; c < 3; c++) {
        grid.step_world[c] = lattice->step_world;
        grid.offset_world[c] = lattice->offset_world[c];
    }
    ewa_cloud_set_origin(plan->output, lattice->offset_world);
    ewa_cloud_set_grid(plan->output, &grid);
    return status;
}

/// Adds an attribute to those that representatives have; `chosen`: somebody named it.
static ewa_status add_attribute(ewa_region_plan *plan, const char *name, bool chosen) {
    ewa_scalar scalar;
    if (!chosen && !ewa_cloud_has_scalar(plan->inputs, name)) return EWA_OK;
    EWA_TRY(ewa_cloud_find_scalar(plan->inputs, name, &scalar));
    const ewa_attribute *found = &scalar.attribute;
    if (found->component_count != 1 || !ewa_level_attribute_is_free(found->name))
        return ewa_fail(plan->context, EWA_ERROR_ARGUMENT,
                        "attributes: %s is no number of its own: what represents points has it anyhow, or cannot have it", name);
    for (uint32_t a = 0; a < plan->attribute_count; a++)
        if (strcmp(plan->attributes[a].name, found->name) == 0) return EWA_OK;
    if (plan->attribute_count == EWA_LEVELS_MAX_ATTRIBUTES)
        return ewa_fail(plan->context, EWA_ERROR_ARGUMENT, "attributes: there may be %d", EWA_LEVELS_MAX_ATTRIBUTES);
    ewa_level_attribute *added = &plan->attributes[plan->attribute_count];
    snprintf(added->name, sizeof added->name, "%s", found->name);
    added->type = found->type;
    // Other whole numbers are codes, of which there is no mean.
    if (found->type == EWA_F32 || found->type == EWA_F64 || ewa_attribute_is_signal(found->name))
        plan->attribute_means |= 1u << plan->attribute_count;
    // What is filtered by its class is there at all levels.
    if (strcmp(found->name, "classification") == 0) plan->attribute_code = plan->attribute_count;
    plan->attribute_count++;
    return EWA_OK;
}

/// Chooses the attributes that representatives have: those of a list, or the usual ones.
static ewa_status choose_attributes(ewa_region_plan *plan, const char *list) {
    const char *name = list ? list : "classification,intensity";
    while (*name) {
        const size_t length = strcspn(name, ",");
        char word[EWA_NAME_BYTES];
        if (length == 0 || length >= sizeof word)
            return ewa_fail(plan->context, EWA_ERROR_ARGUMENT, "attributes: \"%s\" is no list of names", list);
        memcpy(word, name, length);
        word[length] = 0;
        EWA_TRY(add_attribute(plan, word, list != NULL));
        name += length + (name[length] == ',');
    }
    return EWA_OK;
}

ewa_status ewa_region_plan_make(ewa_context *context, const ewa_statistics *statistics,
                                const ewa_cloud *inputs, const char *attributes, ewa_region_plan *plan) {
    *plan = (ewa_region_plan){.context = context, .statistics = statistics, .inputs = inputs, .attribute_code = UINT32_MAX};
    const bool has_axes = has(inputs, EWA_TANGENT_U, 3) && has(inputs, EWA_TANGENT_V, 3);
    plan->makes_normals = !has_axes && !has(inputs, EWA_NORMAL, 3);
    plan->makes_radii = !has_axes && !has(inputs, EWA_RADIUS, 1);
    // Radii that points come with may not reach as far as what moves at contours needs, by curvatures of estimated normals.
    plan->makes_curvatures = (plan->makes_normals || plan->makes_radii) && ewa_curvature_is_lacking(inputs);
    plan->normal_at_bytes = statistics->record_bytes;
    plan->radius_at_bytes = plan->normal_at_bytes + (plan->makes_normals ? 6 : 0);
    plan->curvature_at_bytes = plan->radius_at_bytes + (plan->makes_radii ? 4 : 0);
    plan->border_at_bytes = plan->curvature_at_bytes + (plan->makes_curvatures ? 4 : 0);
    plan->record_bytes = plan->border_at_bytes + (plan->makes_radii ? 12 : 0);
    EWA_TRY(choose_attributes(plan, attributes));
    return make_output(plan);
}

void ewa_region_plan_free(ewa_region_plan *plan) { ewa_cloud_destroy(&plan->output); }

void ewa_region_result_free(ewa_context *context, ewa_region_result *result) {
    ewa_octree_chunk *chunks = result->chunks.data;
    for (uint32_t i = 0; i < result->chunk_count; i++) ewa_octree_chunk_free(context, &chunks[i]);
    ewa_buffer_free(context, &result->chunks);
    ewa_buffer_free(context, &result->pages);
    ewa_buffer_free(context, &result->blocks);
    for (uint32_t level = 0; level < EWA_CODE_LEVELS; level++)
        ewa_buffer_free(context, &result->above[level]);
    ewa_representatives_free(context, &result->representatives);
    *result = (ewa_region_result){.chunk_count = 0};
}

/// Encodes some nodes at once.
static ewa_status encode_batch(ewa_region_plan *plan, const ewa_octree_key *keys, ewa_cloud **pieces,
                               uint32_t count, ewa_region_result *result) {
    ewa_status status = ewa_buffer_grow(plan->context, &result->chunks, result->chunk_count,
                                        (size_t)result->chunk_count + count, sizeof(ewa_octree_chunk));
    if (status == EWA_OK) {
        ewa_octree_chunk *chunks = (ewa_octree_chunk *)result->chunks.data + result->chunk_count;
        memset(chunks, 0, count * sizeof *chunks);
        result->chunk_count += count;
        status = ewa_octree_encode(plan->writer, keys, (const ewa_cloud *const *)pieces, count, chunks);
    }
    for (uint32_t i = 0; i < count; i++) ewa_cloud_destroy(&pieces[i]);
    return status;
}

ewa_status ewa_region_encode(ewa_region_plan *plan, const uint8_t *records, uint32_t count, uint32_t level,
                             ewa_region_result *result) {
    const ewa_lattice *lattice = &plan->statistics->lattice;
    ewa_octree_key keys[BATCH];
    ewa_cloud *pieces[BATCH] = {NULL};
    uint32_t piece_count = 0;
    ewa_status status = EWA_OK;
    for (uint32_t first = 0, next; first < count && status == EWA_OK; first = next) {
        const uint64_t code = ewa_record_code(lattice, records + (size_t)first * plan->record_bytes);
        const uint64_t prefix = ewa_code_prefix(code, level);
        next = first + 1;
        while (next < count &&
               ewa_code_prefix(ewa_record_code(lattice, records + (size_t)next * plan->record_bytes),
                               level) == prefix)
            next++;
        keys[piece_count] = ewa_code_key(code, level);
        status = ewa_records_to_cloud(plan, records + (size_t)first * plan->record_bytes, next - first,
                                      &pieces[piece_count]);
        if (status == EWA_OK && ++piece_count == BATCH) {
            status = encode_batch(plan, keys, pieces, piece_count, result);
            piece_count = 0;
        }
    }
    if (status == EWA_OK && piece_count) status = encode_batch(plan, keys, pieces, piece_count, result);
    for (uint32_t i = 0; i < BATCH; i++) ewa_cloud_destroy(&pieces[i]);
    return status;
}

/// Packs what represents a node's points.
static ewa_status encode_page(ewa_region_plan *plan, const ewa_octree_key *key,
                              const ewa_representatives *representatives, ewa_region_result *result,
                              ewa_levels_page *page) {
    const uint32_t count = representatives->count;
    enum { FLOATS = 8 };
    float *floats = ewa_allocate(plan->context, (size_t)count * FLOATS, sizeof *floats);
    uint8_t *rgba = ewa_allocate(plan->context, count, 4);
    ewa_status status = floats && rgba ? EWA_OK : EWA_ERROR_MEMORY;
    const double side = ewa_lattice_side_world(&plan->statistics->lattice, (uint32_t)key->level);
    const ewa_level_surfels surfels = {floats, floats + 3 * (size_t)count, floats + 6 * (size_t)count,
                                       floats + 7 * (size_t)count, rgba};
    for (uint32_t i = 0; i < count && status == EWA_OK; i++) {
        const ewa_representative *s = &representatives->items[i];
        for (int c = 0; c < 3; c++) {
            surfels.at[3 * (size_t)i + (size_t)c] = (float)(s->at_world[c] / side - key->cell[c]);
            surfels.normal[3 * (size_t)i + (size_t)c] = s->normal[c];
            rgba[4 * (size_t)i + (size_t)c] = ewa_srgb8_from_linear(s->shown[c]);
        }
        surfels.radius_world[i] = s->radius_world;
        surfels.curvature[i] = s->curvature;
        rgba[4 * (size_t)i + 3] = (uint8_t)lrintf(255 * s->alpha);
        if (s->radius_world > page->largest_radius_world) page->largest_radius_world = s->radius_world;
    }
    page->at_bytes = result->blocks_bytes;
    if (status == EWA_OK)
        status = ewa_level_encode(plan->context, &surfels, count, &result->blocks, &result->blocks_bytes);
    page->size_bytes = (uint32_t)(result->blocks_bytes - page->at_bytes);
    if (status == EWA_OK)
        status = ewa_level_encode_attributes(plan->context, plan->attributes, plan->attribute_count, representatives->numbers,
                                             count, &result->blocks, &result->blocks_bytes);
    page->attributes_bytes = (uint32_t)(result->blocks_bytes - page->at_bytes) - page->size_bytes;
    ewa_release(plan->context, floats, (size_t)count * FLOATS, sizeof *floats);
    ewa_release(plan->context, rgba, count, 4);
    return status;
}

/// Puts the surfels of a node's children behind each other. Free `all`, also after a failure.
static ewa_status join(const ewa_region_plan *plan, const ewa_representatives *children, uint32_t child_count,
                       ewa_representatives *all) {
    uint32_t count = 0;
    const size_t number_count = plan->attribute_count;
    for (uint32_t i = 0; i < child_count; i++) count += children[i].count;
    EWA_TRY(ewa_representatives_reserve(plan->context, all, count, plan->attribute_count));
    for (uint32_t i = 0; i < child_count; i++) {
        if (!children[i].count) continue;
        memcpy(all->items + all->count, children[i].items, children[i].count * sizeof *all->items);
        if (number_count)
            memcpy(all->numbers + all->count * number_count, children[i].numbers,
                   children[i].count * number_count * sizeof *all->numbers);
        all->count += children[i].count;
    }
    return EWA_OK;
}

/// Whether the unit coverage of a page of points is measured: of the first of a region, then of one in so many.
static bool is_measured(uint32_t leaf) { return leaf < MEASURED_LEAVES || leaf % MEASURED_LEAVES == 0; }

ewa_status ewa_region_page(ewa_region_plan *plan, const ewa_octree_key *key, uint64_t point_count,
                           const ewa_representatives *children, uint32_t child_count,
                           ewa_region_result *result, ewa_representatives *representatives) {
    ewa_levels_page page = {.key = *key, .point_count = point_count, .radius_scale = 1};
    for (uint32_t i = 0; i < representatives->count && !child_count; i++)
        page.largest_radius_world = fmaxf(page.largest_radius_world, representatives->items[i].radius_world);
    ewa_status status = EWA_OK;
    if (!child_count && representatives->count && is_measured(plan->leaf_count++))
        status = ewa_representatives_cover(plan->evaluator, representatives, &page.unit_coverage);
    if (child_count) {
        ewa_representatives all = {.count = 0};
        status = join(plan, children, child_count, &all);
        if (status == EWA_OK)
            status = ewa_representatives_merge(plan->context, &all, (uint32_t)key->level + EWA_PAGE_BITS,
                                               plan->attribute_means, plan->attribute_code, representatives);
        ewa_representatives_free(plan->context, &all);
        const double side = ewa_lattice_side_world(&plan->statistics->lattice, (uint32_t)key->level);
        if (status == EWA_OK)
            status = ewa_representatives_evaluate(plan->evaluator, children, child_count, key, side,
                                                  representatives, &page.error);
        if (status == EWA_OK) status = encode_page(plan, key, representatives, result, &page);
        page.surfel_count = representatives->count;
        page.radius_scale = representatives->radius_scale;
    }
    EWA_TRY(status);
    EWA_TRY(ewa_buffer_grow(plan->context, &result->pages, result->page_count, (size_t)result->page_count + 1,
                            sizeof page));
    ((ewa_levels_page *)result->pages.data)[result->page_count++] = page;
    return EWA_OK;
}
