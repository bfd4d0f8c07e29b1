// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the parts of the glTF reader share: the JSON tree, its arrays as tables, buffers, accessors, looks.
//
// Based on: The Khronos 3D Formats Working Group, "glTF 2.0 Specification", version 2.0.1, 2021.
#ifndef EWA_SRC_MESH_GLTF_H
#define EWA_SRC_MESH_GLTF_H

#include "io/file.h"
#include "io/json_text.h"
#include "io/mesh/formats.h"

/// An array of the tree, so that item n need not be looked for.
typedef struct gltf_table {
    const cJSON **items;
    uint32_t count;
} gltf_table;

typedef struct gltf_buffer {
    bool opened;
    const uint8_t *bytes;
    size_t size_bytes;
    ewa_file file;    ///< of a file of its own
    uint8_t *decoded; ///< of base64
    size_t decoded_room;
} gltf_buffer;

/// Numbers of an accessor.
typedef struct gltf_array {
    double *numbers; ///< count * components
    uint64_t count;
    uint32_t components;
} gltf_array;

typedef struct gltf gltf;
typedef struct gltf_packed gltf_packed; ///< a primitive that Draco has packed

/// Where a node puts its mesh: three rows of an affine map on column vectors.
typedef struct gltf_placement {
    double m[3][4];
} gltf_placement;

/// Takes a primitive, item `item` of mesh `mesh`, of a node.
typedef ewa_status gltf_take(gltf *g, uint64_t mesh, const cJSON *item, const gltf_placement *at);

struct gltf {
    ewa_mesh_build *build;
    gltf_take *take;
    void *user;            ///< of `take`
    const char *extension; ///< one more that may be required; or NULL
    const cJSON *root;
    gltf_table nodes, meshes, accessors, views, buffers, materials, textures, images;
    gltf_buffer *opened;   ///< by buffer
    gltf_buffer *unpacked; ///< by view; NULL while none was
    uint32_t *looks;       ///< by material, none while it was not used
    const uint8_t *chunk;  ///< binary chunk of a .glb
    size_t chunk_bytes;
    bool *visited; ///< by node
    bool has_triangles;
    uint64_t items_granted; ///< vertices and corners that may be made of the file and its buffers
    uint64_t items_left;    ///< of these, by now
};

/// Reads a file and has every primitive of its scene taken, which may require one more extension. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED,
/// EWA_ERROR_LIMIT, EWA_ERROR_MEMORY, EWA_CANCELLED, and what `take` returns.
ewa_status ewa_gltf_walk(ewa_mesh_build *build, gltf_take *take, void *user, const char *extension);

/// Reads an attribute of `wanted_count` items (0: as many as there are); `array` is empty when it is not there.
ewa_status ewa_gltf_read_attribute(gltf *g, uint64_t mesh, const cJSON *attributes, uint64_t wanted_count,
                                   const char *name, uint32_t low, uint32_t high, gltf_array *array);

/// Reports EWA_ERROR_FORMAT for item `index` of an array of the tree.
ewa_status ewa_gltf_fail(const gltf *g, const char *array, uint64_t index, const char *what);

/// A member that is a natural number: `*value` gets it, or `otherwise` when it is not there. False when it is
/// something else.
bool ewa_gltf_count(const cJSON *object, const char *name, uint64_t otherwise, uint64_t *value);

/// Grants vertices and corners for so many bytes that the file or a buffer beside it has.
void ewa_gltf_grant(gltf *g, uint64_t size_bytes);

/// Takes from what was granted. Errors: EWA_ERROR_LIMIT.
ewa_status ewa_gltf_spend(gltf *g, uint64_t item_count);

/// The member of an object, of an extension of the object, or NULL. Only the first 128 members are looked at:
/// no object of glTF has as many, and one that is used often must not cost its length each time.
const cJSON *ewa_gltf_member(const cJSON *object, const char *name);
const cJSON *ewa_gltf_extension(const cJSON *object, const char *extension);

/// Numbers of an array member; false when it is there but not of `count` numbers. Absent: values stay.
bool ewa_gltf_numbers(const cJSON *object, const char *name, uint32_t count, double *values);

/// The bytes of a buffer view.
ewa_status ewa_gltf_view(gltf *g, uint64_t index, const uint8_t **bytes, uint64_t *size_bytes,
                         uint64_t *stride);
void ewa_gltf_close_buffers(gltf *g);

/// Unpacks a view whose extension EXT_meshopt_compression or KHR_meshopt_compression is `packed`, from the bytes and the
/// stride that it names. Errors: EWA_ERROR_FORMAT, EWA_ERROR_UNSUPPORTED, EWA_ERROR_LIMIT, EWA_ERROR_MEMORY.
ewa_status ewa_gltf_unpack_view(gltf *g, uint64_t index, const cJSON *packed, const uint8_t *bytes,
                                uint64_t size_bytes, uint64_t stride, gltf_buffer *unpacked);

/// Opens what Draco has packed of a primitive with these accessors, or sets NULL where it has not. Close it.
ewa_status ewa_gltf_open_packed(gltf *g, uint64_t mesh, const cJSON *item, uint64_t positions,
                                uint64_t indices, gltf_packed **packed);
void ewa_gltf_close_packed(const gltf *g, gltf_packed **packed);

/// Whether the numbers of an attribute are in it (not of NULL), and these, as ewa_gltf_read_accessor() gives them;
/// the triangles' corners.
bool ewa_gltf_packed_has(const gltf_packed *packed, const char *name);
ewa_status ewa_gltf_packed_attribute(gltf *g, uint64_t mesh, const gltf_packed *packed, const char *name,
                                     uint64_t accessor, uint32_t low, uint32_t high, gltf_array *array);
ewa_status ewa_gltf_packed_indices(gltf *g, const gltf_packed *packed, gltf_array *array);

/// Decodes the bytes of a data: URI; `*decoded` has `*room` bytes for ewa_release(). Errors: EWA_ERROR_FORMAT
/// (a message names `array` and `index`), EWA_ERROR_MEMORY.
ewa_status ewa_gltf_decode_uri(const gltf *g, const char *array, uint64_t index, const char *uri,
                               uint8_t **decoded, size_t *room, size_t *size_bytes);

/// Copies a URI that is a path with %XX decoded; false when it is too long.
bool ewa_gltf_path_of(const char *uri, char *path, size_t room);

/// Reads all numbers of an accessor with `low` to `high` components. Normalised integers are shares. Free
/// with ewa_gltf_free_array(); after a failure `*array` is zeroed.
ewa_status ewa_gltf_read_accessor(gltf *g, uint64_t index, uint32_t low, uint32_t high, gltf_array *array);
void ewa_gltf_free_array(const gltf *g, gltf_array *array);

/// What the integers of an accessor stand for: themselves times `share`, at least `lowest`.
typedef struct gltf_numbers {
    double share, lowest;
} gltf_numbers;

/// Fills components and count of `array`, without numbers, and what they stand for.
ewa_status ewa_gltf_describe(const gltf *g, uint64_t index, uint32_t low, uint32_t high, gltf_array *array,
                             gltf_numbers *form);

/// What alpha means in a material that is there.
ewa_mesh_alpha ewa_gltf_alpha(const gltf *g, uint64_t material);

/// The look of a material, made when it is used first; which set of texture coordinates its picture wants.
ewa_status ewa_gltf_look(gltf *g, uint64_t material, uint32_t *look, uint64_t *texcoord_set);

#endif
