// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Fuzz target: any bytes as the record of surfels that stand for cubes' points. What is read is a tree whose blocks lie in
// the record and can be tried.
#include "fuzz_cloud.h"
#include "io/levels.h"

/// Decodes a page into memory that ends with its surfels.
static void try_page(const ewa_levels_page *page, const uint8_t *bytes, bool has_curvatures) {
    enum { MAX_SURFELS = 1 << 14 };
    if (!page->size_bytes || page->surfel_count > MAX_SURFELS) return;
    const size_t count = page->surfel_count;
    float *at = malloc(3 * count * sizeof *at + 1), *normal = malloc(3 * count * sizeof *normal + 1),
          *radius = malloc(count * sizeof *radius + 1), *curvature = malloc(count * sizeof *curvature + 1);
    uint8_t *rgba = malloc(4 * count + 1), *scratch = malloc(ewa_level_raw_bytes(page->surfel_count, has_curvatures) + 1);
    fuzz_require(at && normal && radius && curvature && rgba && scratch, "memory");
    const ewa_level_surfels surfels = {at, normal, radius, has_curvatures ? curvature : NULL, rgba};
    if (!ewa_level_decode(page, bytes, scratch, &surfels))
        for (size_t i = 0; i < 3 * count; i++) {
            fuzz_require(at[i] >= 0 && at[i] <= 1, "places in the cube");
            fuzz_require(normal[i] >= -1.001f && normal[i] <= 1.001f, "normals of length 1");
        }
    free(at), free(normal), free(radius), free(curvature), free(rgba), free(scratch);
}

/// Decodes a page's attributes likewise.
static void try_attributes(const ewa_levels *levels, const ewa_levels_page *page, const uint8_t *bytes) {
    enum { MAX_SURFELS = 1 << 14 };
    if (!page->attributes_bytes || page->surfel_count > MAX_SURFELS) return;
    uint8_t *scratch = malloc(ewa_level_attribute_bytes(levels, page->surfel_count) + 1);
    void *streams[EWA_LEVELS_MAX_ATTRIBUTES] = {NULL};
    for (uint32_t a = 0; a < levels->attribute_count; a++)
        streams[a] = malloc(page->surfel_count * ewa_type_bytes(levels->attributes[a].type) + 1);
    fuzz_require(scratch != NULL, "memory");
    (void)ewa_level_decode_attributes(levels, page, bytes, scratch, streams);
    for (uint32_t a = 0; a < levels->attribute_count; a++) free(streams[a]);
    free(scratch);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size_bytes) {
    int errors = 0;
    ewa_context *context = fuzz_context(1, 0, &errors);
    ewa_levels levels;
    const ewa_status status = ewa_levels_read(context, "fuzz", bytes, size_bytes, &levels);
    fuzz_require((status == EWA_OK) == (errors == 0), "a message on failure only");
    for (uint32_t i = 0; status == EWA_OK && i < levels.page_count; i++) {
        const ewa_levels_page *page = &levels.pages[i];
        fuzz_require(i == 0 || ewa_octree_key_compare(&page[-1].key, &page->key) < 0, "pages in order");
        fuzz_require(page->at_bytes <= size_bytes && page->size_bytes <= size_bytes - page->at_bytes,
                     "blocks in the record");
        fuzz_require(page->attributes_bytes <= size_bytes - page->at_bytes - page->size_bytes, "attributes in the record");
        if (i < 64) try_page(page, bytes + page->at_bytes, levels.has_curvatures);
        if (i < 64) try_attributes(&levels, page, bytes + page->at_bytes + page->size_bytes);
    }
    ewa_levels_free(context, &levels);
    ewa_context_destroy(&context);
    return 0;
}
