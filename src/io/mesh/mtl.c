// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Material libraries of OBJ files: diffuse colour, opacity and picture of each material, with the picture's
// scale and offset. Pictures are read when a face uses their material.
//
// Based on: D. Ramey, L. Rose, L. Tyerman, "MTL material format (Lightwave, OBJ)", 1995.
#include "base/base.h"
#include "base/platform.h"
#include "image/srgb.h"
#include "io/mesh/formats.h"
#include "io/referenced_file.h"

#include <math.h>
#include <stdio.h>

enum { FIRST_SLOTS = 64, MAX_LIBRARIES = 256 };

typedef struct mtl_material {
    ewa_text name, picture; ///< in the library's text
    double color[3];
    bool has_color;
    double opacity;
    double scale[2], offset[2]; ///< of texture coordinates
    uint32_t look;              ///< or none yet
} mtl_material;

/// A library's text, which names of materials are in; no bytes when it could not be had.
typedef struct mtl_library {
    ewa_text name;
    ewa_file file;
    char *owned;
    size_t owned_bytes;
} mtl_library;

struct ewa_mtl {
    ewa_mesh_list libraries, materials;
    uint32_t *table; ///< hash table of materials by name
    size_t slots;
    char own_name[EWA_FILE_NAME_BYTES]; ///< of the library that is called like the mesh
};

static size_t slot_of(const ewa_mtl *mtl, ewa_text name) {
    uint64_t hash = 0xcbf29ce484222325u; // FNV-1a
    for (size_t i = 0; i < name.length; i++) hash = (hash ^ (uint8_t)name.chars[i]) * 0x100000001b3u;
    const mtl_material *materials = mtl->materials.items;
    size_t slot = (hash ^ hash >> 32) & (mtl->slots - 1);
    for (; mtl->table[slot] != EWA_MESH_NONE; slot = (slot + 1) & (mtl->slots - 1)) {
        const ewa_text other = materials[mtl->table[slot]].name;
        if (other.length == name.length && memcmp(other.chars, name.chars, name.length) == 0) break;
    }
    return slot;
}

/// Doubles the table while it is more than half full.
static ewa_status grow_table(ewa_mesh_build *build, ewa_mtl *mtl) {
    if (2 * (mtl->materials.count + 1) <= mtl->slots) return EWA_OK;
    const size_t slots = mtl->slots ? 2 * mtl->slots : FIRST_SLOTS;
    uint32_t *table = ewa_allocate(build->context, slots, sizeof *table);
    if (!table) return EWA_ERROR_MEMORY;
    ewa_release(build->context, mtl->table, mtl->slots, sizeof *mtl->table);
    mtl->table = table;
    mtl->slots = slots;
    memset(table, 0xff, slots * sizeof *table);
    const mtl_material *materials = mtl->materials.items;
    for (uint64_t i = 0; i < mtl->materials.count; i++) table[slot_of(mtl, materials[i].name)] = (uint32_t)i;
    return EWA_OK;
}

/// Begins a material; one of a name that is there already takes its place.
static ewa_status begin_material(ewa_mesh_build *build, ewa_mtl *mtl, ewa_text name,
                                 mtl_material **material) {
    ewa_status status = grow_table(build, mtl);
    EWA_TRY(status);
    const size_t slot = slot_of(mtl, name);
    if (mtl->table[slot] == EWA_MESH_NONE) {
        if (!ewa_mesh_list_add(build, &mtl->materials, &status)) return status;
        mtl->table[slot] = (uint32_t)(mtl->materials.count - 1);
    }
    *material = (mtl_material *)mtl->materials.items + mtl->table[slot];
    **material = (mtl_material){.name = name, .opacity = 1, .scale = {1, 1}, .look = EWA_MESH_NONE};
    return EWA_OK;
}

/// How many words follow an option of a picture; -1: it is no option. Those of -s, -o and -t are one to three
/// numbers.
static int option_words(ewa_text option) {
    static const struct {
        const char *name;
        int words;
    } options[] = {{"-blendu", 1}, {"-blendv", 1}, {"-boost", 1},   {"-mm", 2}, {"-texres", 1},
                   {"-clamp", 1},  {"-bm", 1},     {"-imfchan", 1}, {"-cc", 1}, {"-type", 1},
                   {"-s", 0},      {"-o", 0},      {"-t", 0}};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++)
        if (ewa_text_is(option, options[i].name)) return options[i].words;
    return -1;
}

/// Reads what stands behind map_Kd: options, then a name that may have blanks in it.
static void read_picture(ewa_cursor *cursor, mtl_material *material) {
    for (int k = 0; k < 2; k++) material->scale[k] = 1, material->offset[k] = 0;
    for (;;) {
        const ewa_cursor before = *cursor;
        const ewa_text option = ewa_cursor_word(cursor);
        const int words = option_words(option);
        if (words < 0) {
            *cursor = before;
            break;
        }
        double values[3] = {0, 0, 0};
        const uint32_t count = words ? 0 : ewa_cursor_numbers(cursor, 3, values);
        for (int k = 0; k < words; k++) ewa_cursor_word(cursor);
        const bool scales = ewa_text_is(option, "-s");
        if (!scales && !ewa_text_is(option, "-o")) continue;
        for (uint32_t k = 0; k < 2 && k < count; k++)
            (scales ? material->scale : material->offset)[k] = values[k];
    }
    material->picture = ewa_cursor_rest(cursor);
}

static void read_color(ewa_cursor *cursor, mtl_material *material) {
    double values[3];
    const uint32_t count = ewa_cursor_numbers(cursor, 3, values);
    if (!count) return; // a spectral curve
    for (uint32_t c = 0; c < 3; c++) material->color[c] = values[count == 3 ? c : 0];
    material->has_color = true;
}

static ewa_status read_library(ewa_mesh_build *build, ewa_mtl *mtl, ewa_cursor cursor) {
    mtl_material *material = NULL;
    ewa_status status = EWA_OK;
    for (; cursor.at < cursor.end && status == EWA_OK; ewa_cursor_next_line(&cursor)) {
        const ewa_text word = ewa_cursor_word(&cursor);
        double value;
        if (ewa_text_is(word, "newmtl"))
            status = begin_material(build, mtl, ewa_cursor_rest(&cursor), &material);
        else if (!material)
            continue;
        else if (ewa_text_is(word, "Kd"))
            read_color(&cursor, material);
        else if (ewa_text_is(word, "map_Kd"))
            read_picture(&cursor, material);
        else if (ewa_text_is(word, "d") && ewa_cursor_numbers(&cursor, 1, &value) == 1)
            material->opacity = value;
    }
    return status;
}

static bool is_known(const ewa_mtl *mtl, ewa_text name) {
    const mtl_library *known = mtl->libraries.items;
    for (uint64_t i = 0; i < mtl->libraries.count; i++)
        if (known[i].name.length == name.length && memcmp(known[i].name.chars, name.chars, name.length) == 0)
            return true;
    return false;
}

/// Reads a library, unless that has been tried; `*found` is false, and nothing is reported, when there is no
/// such file.
static ewa_status open_library(ewa_mesh_build *build, ewa_mtl *mtl, ewa_text name, bool *found,
                               char reason[EWA_REASON_BYTES]) {
    if (is_known(mtl, name)) {
        *found = true; // or said
        return EWA_OK;
    }
    if (mtl->libraries.count == MAX_LIBRARIES)
        return ewa_fail(build->context, EWA_ERROR_LIMIT, "%s: more than %d material libraries",
                        build->source->name, MAX_LIBRARIES);
    ewa_status status = EWA_OK;
    mtl_library *kept = ewa_mesh_list_add(build, &mtl->libraries, &status);
    if (!kept) return status;
    *kept = (mtl_library){.name = name};
    *found = build->source->path && ewa_referenced_file_map(build->context, build->source->path, name, &kept->file, reason);
    if (!build->source->path)
        snprintf(reason, EWA_REASON_BYTES, "the mesh is no file that it could lie beside");
    if (!*found) return EWA_OK;
    ewa_cursor cursor;
    char quote[EWA_QUOTE_BYTES];
    EWA_TRY(ewa_text_open(build->context, ewa_quote(name, quote), kept->file.bytes, kept->file.size_bytes,
                          &cursor, &kept->owned, &kept->owned_bytes));
    return read_library(build, mtl, cursor);
}

static ewa_status make_mtl(ewa_mesh_build *build, ewa_mtl **materials) {
    if (*materials) return EWA_OK;
    *materials = ewa_allocate_zeroed(build->context, 1, sizeof **materials);
    if (!*materials) return EWA_ERROR_MEMORY;
    (*materials)->libraries.item_bytes = sizeof(mtl_library);
    (*materials)->materials.item_bytes = sizeof(mtl_material);
    return grow_table(build, *materials);
}

/// Opens the library that is called like the mesh, for meshes that were renamed together with theirs.
static ewa_status open_own(ewa_mesh_build *build, ewa_mtl *mtl, bool *found) {
    const char *path = build->source->path, *file = path ? ewa_platform_file_name(path) : NULL;
    const char *dot = file ? strrchr(file, '.') : NULL;
    char reason[EWA_REASON_BYTES];
    *found = false;
    if (!dot || dot == file) return EWA_OK;
    const int length = snprintf(mtl->own_name, sizeof mtl->own_name, "%.*s.mtl", (int)(dot - file), file);
    if (length < 0 || (size_t)length >= sizeof mtl->own_name) return EWA_OK;
    const ewa_text name = {mtl->own_name, (size_t)length};
    return is_known(mtl, name) ? EWA_OK : open_library(build, mtl, name, found, reason);
}

ewa_status ewa_mtl_read(ewa_mesh_build *build, ewa_text names, ewa_mtl **materials) {
    if (!names.length) return EWA_OK;
    EWA_TRY(make_mtl(build, materials));
    char reason[EWA_REASON_BYTES] = "", quote[EWA_QUOTE_BYTES];
    bool found, missing = false, own = false;
    // One name with blanks, or several names.
    EWA_TRY(open_library(build, *materials, names, &found, reason));
    if (found) return EWA_OK;
    ewa_cursor cursor = {names.chars, names.chars + names.length, 1};
    ewa_text name = ewa_cursor_word(&cursor);
    const bool single = name.length == names.length;
    ewa_status status = EWA_OK;
    for (; !single && name.length && status == EWA_OK; name = ewa_cursor_word(&cursor)) {
        status = open_library(build, *materials, name, &found, reason);
        missing = missing || !found;
    }
    if (status != EWA_OK || !(single || missing)) return status;
    EWA_TRY(open_own(build, *materials, &own));
    const ewa_text own_name = {(*materials)->own_name, strlen((*materials)->own_name)};
    char own_quote[EWA_QUOTE_BYTES];
    ewa_report(build->context, EWA_SEVERITY_WARNING, "%s: the material library %s is left out: %s%s%s",
               build->source->name, ewa_quote(names, quote), reason, own ? "; instead of it: " : "",
               own ? ewa_quote(own_name, own_quote) : "");
    return EWA_OK;
}

/// Makes a material's look. The picture stands for the colour, as programs write grey beside it.
static ewa_status make_look(ewa_mesh_build *build, mtl_material *material) {
    uint32_t picture = EWA_MESH_NONE;
    EWA_TRY(ewa_mesh_add_look(build, &material->look));
    if (material->picture.length)
        EWA_TRY(ewa_mesh_find_picture(build, material->picture, EWA_MESH_ALPHA_KEEP, 0, &picture));
    ewa_mesh_look *look = ewa_mesh_look_at(build, material->look);
    look->picture = picture;
    for (int c = 0; c < 3 && material->has_color && picture == EWA_MESH_NONE; c++)
        if (material->color[c] >= 0)
            look->base_color[c] = (float)ewa_srgb_decode(fmin(material->color[c], 1));
    // A material that nothing is seen of is a mistake of its writer.
    if (material->opacity > 0 && material->opacity < 1) look->base_color[3] = (float)material->opacity;
    for (int k = 0; k < 2; k++) {
        look->map[k][k] = material->scale[k];
        look->map[k][2] = material->offset[k];
        look->mapped = look->mapped || material->scale[k] != 1 || material->offset[k] != 0;
    }
    return EWA_OK;
}

ewa_status ewa_mtl_look(ewa_mesh_build *build, ewa_mtl *materials, ewa_text name, uint32_t *look) {
    *look = EWA_MESH_NONE;
    if (!materials) return EWA_OK;
    const uint32_t index = materials->table[slot_of(materials, name)];
    if (index == EWA_MESH_NONE) return EWA_OK;
    mtl_material *material = (mtl_material *)materials->materials.items + index;
    const ewa_status status = material->look == EWA_MESH_NONE ? make_look(build, material) : EWA_OK;
    *look = material->look;
    return status;
}

ewa_status ewa_mtl_look_of_own(ewa_mesh_build *build, ewa_mtl **materials, uint32_t *look) {
    bool found;
    *look = EWA_MESH_NONE;
    EWA_TRY(make_mtl(build, materials));
    EWA_TRY(open_own(build, *materials, &found));
    if ((*materials)->materials.count != 1) return EWA_OK;
    ewa_report(build->context, EWA_SEVERITY_INFO, "%s: no material library is named; the one beside it is taken: %s",
               build->source->name, (*materials)->own_name);
    mtl_material *material = (*materials)->materials.items;
    const ewa_status status = make_look(build, material);
    *look = material->look;
    return status;
}

void ewa_mtl_free(ewa_mesh_build *build, ewa_mtl **materials) {
    ewa_mtl *old = *materials;
    if (!old) return;
    ewa_context *context = build->context;
    mtl_library *libraries = old->libraries.items;
    for (uint64_t i = 0; i < old->libraries.count; i++) {
        ewa_file_unmap(context, &libraries[i].file);
        ewa_release(context, libraries[i].owned, libraries[i].owned_bytes, 1);
    }
    ewa_mesh_list *const lists[] = {&old->libraries, &old->materials};
    for (int i = 0; i < 2; i++)
        ewa_release(context, lists[i]->items, lists[i]->capacity, lists[i]->item_bytes);
    ewa_release(context, old->table, old->slots, sizeof *old->table);
    ewa_release(context, old, 1, sizeof *old);
    *materials = NULL;
}
