// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The extended record of COPC files that holds, for the nodes of the octree, surfels that represent all
// points in them (docs/scale.md says what its bytes are).
#ifndef EWA_SRC_LEVELS_H
#define EWA_SRC_LEVELS_H

#include "io/octree.h"

enum {
    EWA_LEVELS_VERSION = 3, ///< 1: without curvatures; 1 and 2: without attributes
    EWA_LEVELS_HEAD_BYTES = 64,
    EWA_LEVELS_ATTRIBUTE_BYTES = 72,
    EWA_LEVELS_PAGE_BYTES = 64,
    EWA_LEVELS_MAX_ATTRIBUTES = 16,
    EWA_LEVELS_MAX_SURFELS = 1 << 24, ///< of a page
};

/// A node: what represents its points.
typedef struct ewa_levels_page {
    ewa_octree_key key;
    uint64_t point_count;  ///< in the node, whatever node they are in
    uint32_t surfel_count; ///< that stand for them
    float radius_scale;    ///< of radii when they are drawn
    float error;           ///< rms, 1/255 of sRGB's range, where they are half a pixel apart
    float largest_radius_world;
    float unit_coverage; ///< of the points' kernels, where it was measured; 0: it was not
    uint64_t at_bytes;   ///< of their block in the record
    uint32_t size_bytes; ///< 0: the node is not divided and has none
    uint32_t attributes_bytes; ///< of the block of their attributes, which follows
} ewa_levels_page;

/// An attribute of one number that surfels of all pages have beside what they are drawn by.
typedef struct ewa_level_attribute {
    char name[EWA_NAME_BYTES];
    ewa_type type;
} ewa_level_attribute;

/// The pages of a file.
typedef struct ewa_levels {
    double unit_coverage;   ///< of the points' kernels all over; 0: not known
    ewa_levels_page *pages; ///< in the order of ewa_octree_key_compare()
    uint32_t page_count;
    uint64_t surfel_count;
    bool has_curvatures; ///< in all blocks
    uint32_t attribute_count;
    ewa_level_attribute attributes[EWA_LEVELS_MAX_ATTRIBUTES];
} ewa_levels;

/// Whether a name may be that of an attribute: surfels have no number of that name anyhow.
bool ewa_level_attribute_is_free(const char *name);

/// Returns how many of the `size_bytes` bytes of a record are its head and table, the head being there.
uint64_t ewa_levels_table_bytes(const uint8_t *head, uint64_t size_bytes);

/// Reads the table of pages, of which as many bytes are there as ewa_levels_table_bytes() says. Every number is checked: keys are nodes, each comes once, every page but the
/// root has its parent, blocks lie in the record. `name` stands for the file in messages. Free with
/// ewa_levels_free(), also after a failure. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED (another
/// version), EWA_ERROR_MEMORY.
ewa_status ewa_levels_read(ewa_context *context, const char *name, const uint8_t *bytes, uint64_t size_bytes,
                           ewa_levels *levels);
void ewa_levels_free(ewa_context *context, ewa_levels *levels);

/// Writes head and table of `levels`, whose blocks begin at 0 in what follows, into `bytes`: EWA_LEVELS_HEAD_BYTES +
/// attribute_count * EWA_LEVELS_ATTRIBUTE_BYTES + page_count * EWA_LEVELS_PAGE_BYTES.
void ewa_levels_write(const ewa_levels *levels, uint8_t *bytes);

/// Surfels of a page, as arrays.
typedef struct ewa_level_surfels {
    float *at;           ///< [count][3], from the node's low corner, in its sides
    float *normal;       ///< [count][3]
    float *radius_world; ///< [count]
    float *curvature;    ///< [count], signed, 1 / world unit; NULL: in a block without
    uint8_t *rgba;       ///< [count][4], sRGB, straight alpha
} ewa_level_surfels;

/// Appends the block of `count` surfels to `to` from byte `*at_bytes` on, which steps behind it. Errors:
/// EWA_ERROR_MEMORY.
ewa_status ewa_level_encode(ewa_context *context, const ewa_level_surfels *surfels, uint32_t count,
                            ewa_buffer *to, size_t *at_bytes);

/// Decodes the block of a page, which is all of `bytes`, into arrays with room for its surfels. Any thread, with memory of its own; NULL, or what
/// is wrong. `scratch` has room for ewa_level_raw_bytes(); `surfels` has curvatures where the block does.
const char *ewa_level_decode(const ewa_levels_page *page, const uint8_t *bytes, uint8_t *scratch,
                             const ewa_level_surfels *surfels);
size_t ewa_level_raw_bytes(uint32_t count, bool has_curvatures);

/// Appends a block of attributes, `numbers` [count][attribute_count], to `to` from byte `*at_bytes` on, which steps behind it: rounded
/// where the type is whole. Errors: EWA_ERROR_MEMORY.
ewa_status ewa_level_encode_attributes(ewa_context *context, const ewa_level_attribute *attributes, uint32_t attribute_count,
                                       const double *numbers, uint32_t count, ewa_buffer *to, size_t *at_bytes);

/// Decodes the block of a page's attributes, which is all of `bytes`, into `streams` [attribute_count], which have room for
/// `count` numbers of the attributes' types each; NULL: not that one. As ewa_level_decode(), `scratch` has room for
/// ewa_level_attribute_bytes().
const char *ewa_level_decode_attributes(const ewa_levels *levels, const ewa_levels_page *page, const uint8_t *bytes,
                                        uint8_t *scratch, void *const *streams);
size_t ewa_level_attribute_bytes(const ewa_levels *levels, uint32_t count);

#endif
