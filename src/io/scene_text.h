// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Scene files, the outer side: JSON text to members with their places. What a member means, and which values it may
// have, the room of scenes says by its tables of options. docs/scene.md has the format.
#ifndef EWA_SRC_SCENE_TEXT_H
#define EWA_SRC_SCENE_TEXT_H

#include "io/camera/file.h"

/// Where in the file a member stands.
typedef enum ewa_scene_section {
    EWA_SCENE_OPTIONS = 0, ///< "options", the members that are no object
    EWA_SCENE_SURFELS = 1, ///< "options"."surfels" and so on
    EWA_SCENE_LOD = 2,
    EWA_SCENE_RENDER = 3,
    EWA_SCENE_GAUSSIANS = 4,
    EWA_SCENE_VOLUMES = 5,
    EWA_SCENE_LIGHT = 6,         ///< "options"."lights"[index]
    EWA_SCENE_SECTION_PLANE = 7, ///< "options"."section_planes"[index], a member without a name
    EWA_SCENE_ITEM = 8,          ///< "items"[index]
    EWA_SCENE_REGION = 9,        ///< "options"."regions"[index]
    EWA_SCENE_MEASURE = 10,      ///< "measures"[index]
} ewa_scene_section;

enum {
    EWA_SCENE_FILE_BYTES = 1 << 24, ///< a scene file may have
    EWA_SCENE_FILE_ITEMS = 1 << 16,
    EWA_SCENE_PLACE_BYTES = 96,
};

/// A member: "items[3].opacity" of value 0.5.
typedef struct ewa_scene_member {
    ewa_scene_section section;
    uint32_t index;   ///< of lights, section planes, regions, measures and items
    const char *name; ///< the text's own
    size_t value_at;  ///< where its value begins among `values`
} ewa_scene_member;

/// What a scene file says. Zero-initialise; free with ewa_scene_text_free().
typedef struct ewa_scene_text {
    ewa_context *context;
    const char *name; ///< of the file, for messages; borrowed
    ewa_json tree;    ///< what names point into
    ewa_scene_member *members;
    size_t member_count, members_bytes;
    char *
        values; ///< strings as they are; numbers so that they read as the same ones; switches "on" and "off"; arrays
                ///< separated by commas; each ended by a zero
    size_t values_size, values_bytes;
    uint32_t item_count, light_count, section_count, region_count, measure_count;
    bool has_camera;
    ewa_camera camera;
    ewa_camera_list keyframes;
} ewa_scene_text;

/// Whether bytes begin as a scene file does: an object whose first member is "ewa_scene", perhaps behind a byte order mark.
bool ewa_scene_text_probe(const uint8_t *bytes, size_t size_bytes);

/// Reads a scene file. Frees what it has read after a failure. Errors, with the place: EWA_ERROR_FORMAT (no JSON, a
/// member that no scene has or of another kind, twice the same, a camera that is none), EWA_ERROR_UNSUPPORTED (a
/// version), EWA_ERROR_LIMIT (longer than EWA_SCENE_FILE_BYTES, more items than EWA_SCENE_FILE_ITEMS),
/// EWA_ERROR_MEMORY.
ewa_status ewa_scene_text_read(ewa_context *context, const char *name, const uint8_t *bytes,
                               size_t size_bytes, ewa_scene_text *text);
void ewa_scene_text_free(ewa_scene_text *text);

static inline const char *ewa_scene_text_value(const ewa_scene_text *text, const ewa_scene_member *member) {
    return text->values + member->value_at;
}

/// Writes a member's place, such as "items[3].opacity".
void ewa_scene_text_place(const ewa_scene_member *member, char place[EWA_SCENE_PLACE_BYTES]);

#endif
