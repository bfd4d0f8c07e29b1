// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Faces of other formats as elements of PLY, so that they can be written: triangles, texture coordinates by
// corner, numbers and names of pictures, colours.
#include "base/base.h"
#include "image/srgb.h"
#include "io/cloud/ply.h"
#include "io/mesh/formats.h"

#include <stdio.h>

/// The words of the header that is made, one behind the other.
static const char words[] = "vertexfacevertex_indicestexcoordtexnumberredgreenbluealpha";

enum { COLOR_NUMBERS = 4, LOOK_NUMBER_BYTES = 4 };

typedef struct face_writer {
    const ewa_mesh_build *build;
    ewa_elements *made;
    bool texcoords, looks, colors;
    uint32_t *picture; ///< number of the picture by look, or none
} face_writer;

static ewa_text word_at(const ewa_elements *elements, const char *word) {
    const char *at = strstr(words, word);
    return (ewa_text){elements->text + elements->text_bytes - (sizeof words - 1) + (at - words),
                      strlen(word)};
}

static void add_property(ewa_elements *elements, const char *name, ewa_type type, bool is_list) {
    ewa_ply_header *header = elements->header;
    ewa_ply_element *face = &header->elements[1];
    header->properties[header->property_count++] =
        (ewa_ply_property){.name = word_at(elements, name),
                           .type = type,
                           .count_type = EWA_U8,
                           .is_list = is_list,
                           .offset_bytes = is_list ? 0 : face->record_bytes};
    face->property_count++;
    face->list_count += is_list;
    if (!is_list) face->record_bytes += (uint32_t)ewa_type_bytes(type);
}

static const ewa_mesh_look *look_at(const ewa_mesh_build *build, uint32_t look) {
    return (const ewa_mesh_look *)build->looks.items + look;
}

static uint32_t look_of(const ewa_mesh_build *build, uint64_t triangle) {
    return triangle < build->face_looks.count ? ((const uint32_t *)build->face_looks.items)[triangle]
                                              : EWA_MESH_NONE;
}

/// Names the pictures that lie in files as comments, in the order of looks, and makes room for the words.
static ewa_status make_text(face_writer *w) {
    const ewa_mesh_build *build = w->build;
    const ewa_mesh_picture *pictures = build->pictures.items;
    static const char lead[] = "comment TextureFile ";
    size_t bytes = 1 + sizeof words - 1;
    uint32_t count = 0;
    for (uint64_t i = 0; i < build->looks.count; i++) {
        const uint32_t picture = look_at(build, (uint32_t)i)->picture;
        w->picture[i] = EWA_MESH_NONE;
        if (picture == EWA_MESH_NONE || !pictures[picture].beside) continue;
        w->picture[i] = count++;
        bytes += sizeof lead - 1 + pictures[picture].name_bytes + 1;
    }
    w->looks = count > 0;
    w->made->text = ewa_allocate(build->context, bytes, 1);
    w->made->text_bytes = bytes;
    if (!w->made->text) return EWA_ERROR_MEMORY;
    char *to = w->made->text;
    for (uint64_t i = 0; i < build->looks.count; i++) {
        if (w->picture[i] == EWA_MESH_NONE) continue;
        const ewa_mesh_picture *picture = &pictures[look_at(build, (uint32_t)i)->picture];
        memcpy(to, lead, sizeof lead - 1);
        to += sizeof lead - 1;
        for (size_t k = 0; k < picture->name_bytes; k++)
            *to++ = (char)((unsigned char)picture->name[k] < ' ' ? '?' : picture->name[k]);
        *to++ = '\n';
    }
    *to++ = '\n'; // the words are no comment
    memcpy(to, words, sizeof words - 1);
    return EWA_OK;
}

static ewa_status make_header(face_writer *w) {
    const ewa_mesh_build *build = w->build;
    ewa_elements *made = w->made;
    made->header = ewa_allocate_zeroed(build->context, 1, sizeof *made->header);
    if (!made->header) return EWA_ERROR_MEMORY;
    made->header->element_count = 2;
    made->header->elements[0] =
        (ewa_ply_element){.name = word_at(made, "vertex"), .count = build->positions.count};
    made->header->elements[1] =
        (ewa_ply_element){.name = word_at(made, "face"), .count = build->corners.count};
    add_property(made, "vertex_indices", EWA_I32, true);
    if (w->texcoords) add_property(made, "texcoord", EWA_F32, true);
    if (w->looks) add_property(made, "texnumber", EWA_I32, false);
    static const char *const names[COLOR_NUMBERS] = {"red", "green", "blue", "alpha"};
    for (int c = 0; c < COLOR_NUMBERS && w->colors; c++) add_property(made, names[c], EWA_U8, false);
    made->tables = ewa_allocate_zeroed(build->context, 2, sizeof *made->tables);
    if (!made->tables) return EWA_ERROR_MEMORY;
    made->table_count = 2;
    for (uint32_t i = 0; i < 2; i++) made->tables[i].element = &made->header->elements[i];
    return EWA_OK;
}

/// Allocates lists of three corners and of six texture coordinates for every face, and the records.
static ewa_status make_table(face_writer *w) {
    ewa_context *context = w->build->context;
    ewa_ply_table *table = &w->made->tables[1];
    const uint64_t count = table->element->count;
    table->records = ewa_allocate(context, count, table->element->record_bytes);
    table->lists = ewa_allocate_zeroed(context, table->element->list_count, sizeof *table->lists);
    if (!table->records || !table->lists) return EWA_ERROR_MEMORY;
    for (uint32_t i = 0; i < table->element->list_count; i++) {
        ewa_ply_list *list = &table->lists[i];
        const uint64_t each = i ? 6 : 3;
        list->first = ewa_allocate(context, count + 1, sizeof *list->first);
        list->numbers = ewa_allocate(context, each * count, sizeof(uint32_t));
        list->count = list->capacity = each * count;
        if (!list->first || !list->numbers) return EWA_ERROR_MEMORY;
        for (uint64_t f = 0; f <= count; f++) list->first[f] = each * f;
    }
    return EWA_OK;
}

/// Texture coordinates of a corner as its look maps them.
static void texcoord_of(const face_writer *w, uint64_t triangle, uint32_t corner, float uv[2]) {
    const ewa_mesh_build *build = w->build;
    const uint32_t *numbers = (const uint32_t *)build->texcoord_corners.items + 3 * triangle;
    uv[0] = uv[1] = 0;
    if (triangle >= build->texcoord_corners.count || numbers[corner] >= build->texcoords.count) return;
    memcpy(uv, (const float *)build->texcoords.items + 2 * (size_t)numbers[corner], 2 * sizeof *uv);
    const uint32_t look = look_of(build, triangle);
    if (look != EWA_MESH_NONE) ewa_mesh_map_texcoord(look_at(build, look), uv);
}

static void fill_table(const face_writer *w) {
    const ewa_mesh_build *build = w->build;
    const ewa_ply_table *table = &w->made->tables[1];
    memcpy(table->lists[0].numbers, build->corners.items, build->corners.count * 3 * sizeof(uint32_t));
    for (uint64_t t = 0; t < build->corners.count; t++) {
        uint8_t *record = table->records + t * table->element->record_bytes;
        const uint32_t look = look_of(build, t);
        for (uint32_t c = 0; c < 3 && w->texcoords; c++)
            texcoord_of(w, t, c, (float *)table->lists[1].numbers + 6 * t + 2 * (size_t)c);
        if (w->looks) {
            const int32_t number = look == EWA_MESH_NONE ? -1 : (int32_t)w->picture[look];
            memcpy(record, &number, sizeof number);
            record += LOOK_NUMBER_BYTES;
        }
        for (int c = 0; c < COLOR_NUMBERS && w->colors; c++) {
            float value = look == EWA_MESH_NONE ? 1 : look_at(build, look)->base_color[c];
            if (t < build->face_colors.count)
                value *= ((const float *)build->face_colors.items)[4 * t + (uint64_t)c];
            record[c] = c < 3 ? ewa_srgb8_from_linear(value) : (uint8_t)(255 * value + 0.5f);
        }
    }
}

ewa_status ewa_mesh_build_elements(ewa_mesh_build *build, ewa_elements **elements) {
    ewa_context *context = build->context;
    *elements = NULL;
    if (!build->corners.count) return EWA_OK; // none of the faces can be used, which the points say
    const uint64_t bytes = build->corners.count * (11 * sizeof(uint32_t) + 2 * sizeof(uint64_t));
    if (build->positions.count > INT32_MAX)
        return ewa_fail(context, EWA_ERROR_LIMIT, "%s: faces of %llu places, PLY has numbers up to %d",
                        build->source->name, (unsigned long long)build->positions.count, INT32_MAX);
    EWA_TRY(ewa_memory_check(context, bytes, "%s: %llu faces", build->source->name, (unsigned long long)build->corners.count));
    face_writer w = {.build = build,
                     .texcoords = build->texcoord_corners.count && build->texcoords.count,
                     .colors = build->face_colors.count > 0};
    for (uint64_t i = 0; i < build->looks.count; i++)
        for (int c = 0; c < COLOR_NUMBERS; c++)
            w.colors = w.colors || look_at(build, (uint32_t)i)->base_color[c] < 1;
    w.picture = ewa_allocate(context, build->looks.count, sizeof *w.picture);
    w.made = w.picture ? ewa_allocate_zeroed(context, 1, sizeof *w.made) : NULL;
    ewa_status status = w.made ? EWA_OK : EWA_ERROR_MEMORY;
    if (w.made) w.made->context = context;
    if (status == EWA_OK) status = make_text(&w);
    if (status == EWA_OK) status = make_header(&w);
    if (status == EWA_OK) status = make_table(&w);
    if (status == EWA_OK)
        fill_table(&w);
    else
        ewa_elements_free(&w.made);
    ewa_release(context, w.picture, build->looks.count, sizeof *w.picture);
    *elements = w.made;
    return status;
}
