// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes in VTK's legacy files: polygonal data, the surface of unstructured grids, the sides of structured and rectilinear
// ones, in text or in binary. Of the data of points normals, colours of bytes and numbers by name are taken, of those of cells
// colours and numbers.
//
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 3 to 17; VTK's reader of legacy files
// (cells of version 5).
#include "base/base.h"
#include "io/mesh/formats.h"
#include "io/mesh/vtk_cells.h"
#include "io/mesh/vtk_number.h"

#include <math.h>

enum { MAX_FIELDS = 1000, MAX_COMPONENTS = 1000, HEAD_BYTES = 1024 };

typedef struct vtk_reader {
    ewa_mesh_build *build;
    ewa_cursor cursor;
    bool text, of_points, of_cells; ///< the data that come are those of points, of cells
    uint64_t data_count;
    ewa_mesh_list cells;   ///< numbers: how many corners, which
    ewa_mesh_list kinds;   ///< of VTK's numbers, by cell
    ewa_mesh_list offsets; ///< of OFFSETS
    bool has_colors, has_normals;
    uint64_t group_counts[4]; ///< of polygonal data, as ewa_vtk_cells has them
    bool grouped;
    bool has_counts;
    uint64_t counts[3];           ///< of a grid's places along its axes
    ewa_mesh_list coordinates[3]; ///< of a rectilinear grid
} vtk_reader;

static const ewa_vtk_type types[] = {
    {"float", 4, 'f'},         {"double", 8, 'f'},         {"int", 4, 'i'},          {"unsigned_int", 4, 'u'},
    {"long", 8, 'i'},          {"unsigned_long", 8, 'u'},  {"short", 2, 'i'},        {"unsigned_short", 2, 'u'},
    {"char", 1, 'i'},          {"signed_char", 1, 'i'},    {"unsigned_char", 1, 'u'}, {"vtkIdType", 4, 'i'},
    {"vtktypeint64", 8, 'i'},  {"vtktypeint32", 4, 'i'},   {"vtktypeuint8", 1, 'u'}, {"vtktypeint8", 1, 'i'},
    {"vtktypeint16", 2, 'i'},  {"vtktypeuint16", 2, 'u'},  {"vtktypeuint32", 4, 'u'}, {"vtktypeuint64", 8, 'u'},
};
static const ewa_vtk_type BYTES = {"unsigned_char", 1, 'u'}, INTS = {"int", 4, 'i'}, FLOATS = {"float", 4, 'f'};

static ewa_status fail(const vtk_reader *r, const char *what) {
    return ewa_fail(r->build->context, EWA_ERROR_FORMAT, "%s: line %llu: VTK: %s", r->build->source->name,
                    (unsigned long long)r->cursor.line, what);
}

/// Steps behind this line.
static void end_line(ewa_cursor *cursor) {
    while (cursor->at < cursor->end && !ewa_is_line_end(*cursor->at)) cursor->at++;
    ewa_cursor_step_line(cursor);
}

static bool take_count(vtk_reader *r, uint64_t *count) {
    int64_t value;
    if (!ewa_text_integer(ewa_cursor_any_word(&r->cursor), &value) || value < 0) return false;
    *count = (uint64_t)value;
    return true;
}

static bool take_type(vtk_reader *r, ewa_vtk_type *type) {
    const ewa_text word = ewa_cursor_any_word(&r->cursor);
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (ewa_text_is_any_case(word, types[i].name)) {
            *type = types[i];
            return true;
        }
    return false;
}

/// Begins the numbers behind a line; in binary they have to be there, so that no room is made for what is not.
static ewa_status begin_numbers(vtk_reader *r, const ewa_vtk_type *type, uint64_t count) {
    if (r->text) return EWA_OK;
    end_line(&r->cursor);
    return count > (uint64_t)(r->cursor.end - r->cursor.at) / type->bytes ? fail(r, "the file ends early") : EWA_OK;
}

/// Takes the next number; begin_numbers() has seen that it is there.
static ewa_status take_number(vtk_reader *r, const ewa_vtk_type *type, double *value) {
    if (r->text) {
        const ewa_text word = ewa_cursor_any_word(&r->cursor);
        if (ewa_text_number(word, value)) return EWA_OK;
        return fail(r, word.length ? "a number is wanted" : "the file ends early");
    }
    *value = ewa_vtk_number(type, (const uint8_t *)r->cursor.at, true);
    r->cursor.at += type->bytes;
    return EWA_OK;
}

static ewa_status skip_numbers(vtk_reader *r, const ewa_vtk_type *type, uint64_t count) {
    EWA_TRY(begin_numbers(r, type, count));
    if (!r->text) {
        r->cursor.at += count * type->bytes;
        return EWA_OK;
    }
    double value;
    for (uint64_t i = 0; i < count; i++) EWA_TRY(take_number(r, type, &value));
    return EWA_OK;
}

static ewa_status read_points(vtk_reader *r) {
    uint64_t count, all;
    ewa_vtk_type type;
    if (!take_count(r, &count) || !take_type(r, &type) || __builtin_mul_overflow(count, 3, &all))
        return fail(r, "POINTS has no number and type");
    r->build->float_positions = type.kind == 'f' && type.bytes == 4 && !r->text;
    EWA_TRY(begin_numbers(r, &type, all));
    for (uint64_t i = 0; i < count; i++) {
        double place[3];
        for (int c = 0; c < 3; c++) EWA_TRY(take_number(r, &type, &place[c]));
        EWA_TRY(ewa_mesh_add_position(r->build, place));
    }
    return EWA_OK;
}

static ewa_status read_counts(vtk_reader *r) {
    for (int c = 0; c < 3; c++)
        if (!take_count(r, &r->counts[c]) || r->counts[c] == 0) return fail(r, "DIMENSIONS are no three numbers from 1 on");
    r->has_counts = true;
    return EWA_OK;
}

/// Reads the places of a rectilinear grid along an axis.
static ewa_status read_coordinates(vtk_reader *r, ewa_mesh_list *list) {
    uint64_t count;
    ewa_vtk_type type;
    ewa_status status = EWA_OK;
    if (!take_count(r, &count) || !take_type(r, &type)) return fail(r, "coordinates have no number and type");
    EWA_TRY(begin_numbers(r, &type, count));
    for (list->count = 0; list->count < count;) {
        double value;
        EWA_TRY(take_number(r, &type, &value));
        double *to = ewa_mesh_list_add(r->build, list, &status);
        if (!to) return status;
        *to = value;
    }
    return EWA_OK;
}

/// Reads the last axis of a rectilinear grid, and makes its places, x fastest.
static ewa_status make_places(vtk_reader *r) {
    EWA_TRY(read_coordinates(r, &r->coordinates[2]));
    const double *at[3];
    for (int c = 0; c < 3; c++) {
        if (r->coordinates[c].count != r->counts[c]) return fail(r, "there are not as many coordinates as DIMENSIONS say");
        at[c] = r->coordinates[c].items;
    }
    for (uint64_t z = 0; z < r->counts[2]; z++)
        for (uint64_t y = 0; y < r->counts[1]; y++)
            for (uint64_t x = 0; x < r->counts[0]; x++)
                EWA_TRY(ewa_mesh_add_position(r->build, (const double[3]){at[0][x], at[1][y], at[2][z]}));
    return EWA_OK;
}

static ewa_status append(vtk_reader *r, ewa_mesh_list *list, double value) {
    ewa_status status = EWA_OK;
    uint32_t *number = ewa_mesh_list_add(r->build, list, &status);
    if (number) *number = value >= 0 && value < (double)EWA_MESH_NONE ? (uint32_t)value : EWA_MESH_NONE;
    return status;
}

/// Reads numbers of corners and which, of cells of one kind; `kind` is that of VTK's cells, 0 where their types follow.
static ewa_status read_cells(vtk_reader *r, uint32_t kind) {
    uint64_t count, all, taken = 0;
    if (!take_count(r, &count) || !take_count(r, &all)) return fail(r, "cells have no numbers");
    const ewa_cursor before = r->cursor;
    double value = 0;
    const bool by_offsets = ewa_text_is_any_case(ewa_cursor_any_word(&r->cursor), "OFFSETS");
    r->grouped |= kind != 0;
    if (kind) r->group_counts[ewa_vtk_group(kind)] += by_offsets && count ? count - 1 : count;
    if (by_offsets) {
        ewa_vtk_type type;
        r->offsets.count = 0;
        if (!take_type(r, &type)) return fail(r, "OFFSETS has no type");
        EWA_TRY(begin_numbers(r, &type, count));
        for (uint64_t i = 0; i < count; i++) {
            EWA_TRY(take_number(r, &type, &value));
            EWA_TRY(append(r, &r->offsets, value));
        }
        if (!ewa_text_is_any_case(ewa_cursor_any_word(&r->cursor), "CONNECTIVITY") || !take_type(r, &type))
            return fail(r, "CONNECTIVITY and its type are wanted");
        EWA_TRY(begin_numbers(r, &type, all));
        const uint32_t *offsets = r->offsets.items;
        for (uint64_t i = 0; i + 1 < count; i++) {
            if (offsets[i] != taken || offsets[i + 1] < taken || offsets[i + 1] > all)
                return fail(r, "OFFSETS do not ascend, or lead beyond CONNECTIVITY");
            EWA_TRY(append(r, &r->cells, offsets[i + 1] - offsets[i]));
            EWA_TRY(kind ? append(r, &r->kinds, kind) : EWA_OK);
            for (; taken < offsets[i + 1]; taken++) {
                EWA_TRY(take_number(r, &type, &value));
                EWA_TRY(append(r, &r->cells, value));
            }
        }
        return taken == all ? EWA_OK : fail(r, "CONNECTIVITY has more than OFFSETS say");
    }
    r->cursor = before;
    EWA_TRY(begin_numbers(r, &INTS, all));
    for (uint64_t i = 0; i < count; i++) {
        double corners;
        if (taken == all) return fail(r, "there are fewer cells than their number");
        EWA_TRY(take_number(r, &INTS, &corners));
        taken++;
        if (!(corners >= 0 && corners <= (double)(all - taken))) return fail(r, "a cell is larger than all of them");
        if (corners != floor(corners)) return fail(r, "a number of corners is not whole");
        EWA_TRY(append(r, &r->cells, corners));
        EWA_TRY(kind ? append(r, &r->kinds, kind) : EWA_OK);
        for (double k = 0; k < corners; k++, taken++) {
            EWA_TRY(take_number(r, &INTS, &value));
            EWA_TRY(append(r, &r->cells, value));
        }
    }
    return taken == all ? EWA_OK : fail(r, "there are more cells than their number");
}

static ewa_status read_cell_types(vtk_reader *r) {
    uint64_t count;
    double value;
    if (!take_count(r, &count)) return fail(r, "CELL_TYPES has no number");
    EWA_TRY(begin_numbers(r, &INTS, count));
    for (uint64_t i = 0; i < count; i++) {
        EWA_TRY(take_number(r, &INTS, &value));
        EWA_TRY(append(r, &r->kinds, value));
    }
    return EWA_OK;
}

/// Reads a colour, codes of bytes or, in text of COLOR_SCALARS, shares.
static ewa_status read_color(vtk_reader *r, const ewa_vtk_type *type, uint32_t components, float color[4]) {
    const double scale = type->kind == 'f' ? 1 : 1.0 / 255;
    double value[4] = {1, 1, 1, 1 / scale};
    for (uint32_t c = 0; c < components; c++) EWA_TRY(take_number(r, type, &value[c]));
    ewa_vtk_color(value, scale, color);
    return EWA_OK;
}

static ewa_status read_cell_colors(vtk_reader *r, const ewa_vtk_type *type, uint32_t components) {
    if (r->data_count > UINT64_MAX / components) return fail(r, "an array is too large");
    EWA_TRY(begin_numbers(r, type, r->data_count * components));
    for (uint64_t i = 0; i < r->data_count; i++) {
        float color[4];
        EWA_TRY(read_color(r, type, components, color));
        EWA_TRY(ewa_mesh_add_cell_color(r->build, color));
    }
    return EWA_OK;
}

static ewa_status read_colors(vtk_reader *r, const ewa_vtk_type *type, uint32_t components) {
    static const float white[4] = {1, 1, 1, 1};
    ewa_mesh_build *build = r->build;
    const uint64_t end = build->positions.count;
    if (r->data_count != end) return fail(r, "there are not as many colours as points");
    EWA_TRY(begin_numbers(r, type, r->data_count * components));
    ewa_status status = EWA_OK;
    r->has_colors = true;
    // Colours go by place, the last one's.
    for (build->positions.count = 0; build->positions.count < end && status == EWA_OK;) {
        float color[4];
        build->positions.count++;
        status = read_color(r, type, components, color);
        if (status == EWA_OK) status = ewa_mesh_add_color(build, white, color);
    }
    build->positions.count = end;
    return status;
}

/// Whether colours of so many numbers of these data are still wanted.
static bool wants_colors(const vtk_reader *r, uint64_t components) {
    return (components == 3 || components == 4) && ((r->of_points && !r->has_colors) || (r->of_cells && !r->build->cell_colors.count));
}

static ewa_status read_normals(vtk_reader *r, const ewa_vtk_type *type) {
    if (r->data_count != r->build->positions.count) return fail(r, "there are not as many normals as points");
    EWA_TRY(begin_numbers(r, type, 3 * r->data_count));
    r->has_normals = true;
    for (uint64_t i = 0; i < r->data_count; i++) {
        double normal[3];
        for (int c = 0; c < 3; c++) EWA_TRY(take_number(r, type, &normal[c]));
        EWA_TRY(ewa_mesh_add_normal(r->build, normal));
    }
    return EWA_OK;
}

/// Takes an array of the data of points or cells, as colours where it is such.
static ewa_status take_data(vtk_reader *r, ewa_text name, const ewa_vtk_type *type, uint64_t components, uint64_t count) {
    const bool bytes = type->bytes == 1 && type->kind == 'u', of_data = count == r->data_count;
    uint64_t all;
    if (bytes && of_data && wants_colors(r, components))
        return r->of_cells ? read_cell_colors(r, type, (uint32_t)components) : read_colors(r, type, (uint32_t)components);
    if (components > MAX_COMPONENTS || __builtin_mul_overflow(count, components, &all))
        return fail(r, "an array is too large");
    ewa_mesh_array *array = NULL;
    if (of_data && (r->of_cells || (r->of_points && count == r->build->positions.count)))
        EWA_TRY(ewa_mesh_find_array(r->build, r->of_cells, name, ewa_vtk_kept_type(type), components, 0, &array));
    if (!array) return skip_numbers(r, type, all);
    array->wide |= type->bytes == 8 && type->kind != 'f';
    EWA_TRY(begin_numbers(r, type, all));
    for (uint64_t i = 0; i < count; i++) {
        double numbers[4];
        for (uint64_t c = 0; c < components; c++) EWA_TRY(take_number(r, type, &numbers[c]));
        EWA_TRY(ewa_mesh_add_numbers(r->build, array, numbers));
    }
    return EWA_OK;
}

/// Steps over what says how arrays are to be understood, up to an empty line.
static void skip_metadata(vtk_reader *r) {
    end_line(&r->cursor);
    while (r->cursor.at < r->cursor.end && !ewa_is_line_end(*r->cursor.at)) end_line(&r->cursor);
}

/// Reads arrays; `*known` becomes false at one of no numbers.
static ewa_status read_fields(vtk_reader *r, bool *known) {
    uint64_t fields, components, count;
    ewa_vtk_type type;
    ewa_cursor_any_word(&r->cursor);
    if (!take_count(r, &fields) || fields > MAX_FIELDS) return fail(r, "FIELD has no number of arrays");
    for (uint64_t i = 0; i < fields; i++) {
        ewa_text name = ewa_cursor_any_word(&r->cursor);
        while (ewa_text_is_any_case(name, "METADATA")) {
            skip_metadata(r);
            name = ewa_cursor_any_word(&r->cursor);
        }
        if (!take_count(r, &components) || !take_count(r, &count)) return fail(r, "an array of FIELD has no sizes");
        *known = take_type(r, &type);
        if (!*known) return EWA_OK;
        EWA_TRY(take_data(r, name, &type, components, count));
    }
    return EWA_OK;
}

/// Reads an array; `*known` becomes false when it is one of bits.
static ewa_status read_scalars(vtk_reader *r, bool *known) {
    ewa_vtk_type type;
    uint64_t components = 1;
    const ewa_text name = ewa_cursor_any_word(&r->cursor);
    *known = take_type(r, &type);
    if (!*known) return EWA_OK;
    ewa_cursor_skip_blanks(&r->cursor);
    if (r->cursor.at < r->cursor.end && !ewa_is_line_end(*r->cursor.at) && !take_count(r, &components))
        return fail(r, "SCALARS has no number of components");
    const ewa_cursor before = r->cursor;
    if (ewa_text_is_any_case(ewa_cursor_any_word(&r->cursor), "LOOKUP_TABLE"))
        ewa_cursor_any_word(&r->cursor);
    else
        r->cursor = before;
    return take_data(r, name, &type, components, r->data_count);
}

/// Numbers of each vector or matrix that stands behind a word, its name and its type; 0: none is.
static uint32_t numbers_of(ewa_text word) {
    static const struct {
        const char *name;
        uint32_t count;
    } kinds[] = {{"VECTORS", 3},  {"NORMALS", 3},    {"TENSORS", 9},
                 {"TENSORS6", 6}, {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (ewa_text_is_any_case(word, kinds[i].name)) return kinds[i].count;
    return 0;
}

/// Reads what a word begins; `*known` is whether it is known.
static ewa_status read_section(vtk_reader *r, ewa_text word, bool *known) {
    ewa_vtk_type type;
    uint64_t count;
    *known = true;
    if (ewa_text_is_any_case(word, "POINTS")) return read_points(r);
    if (ewa_text_is_any_case(word, "DIMENSIONS")) return read_counts(r);
    if (ewa_text_is_any_case(word, "X_COORDINATES")) return read_coordinates(r, &r->coordinates[0]);
    if (ewa_text_is_any_case(word, "Y_COORDINATES")) return read_coordinates(r, &r->coordinates[1]);
    if (ewa_text_is_any_case(word, "Z_COORDINATES")) return make_places(r);
    if (ewa_text_is_any_case(word, "POLYGONS")) return read_cells(r, EWA_VTK_POLYGON);
    if (ewa_text_is_any_case(word, "TRIANGLE_STRIPS")) return read_cells(r, EWA_VTK_STRIP);
    if (ewa_text_is_any_case(word, "VERTICES")) return read_cells(r, EWA_VTK_VERTEX);
    if (ewa_text_is_any_case(word, "LINES")) return read_cells(r, EWA_VTK_LINES);
    if (ewa_text_is_any_case(word, "CELLS")) return read_cells(r, 0);
    if (ewa_text_is_any_case(word, "CELL_TYPES")) return read_cell_types(r);
    if (ewa_text_is_any_case(word, "FIELD")) return read_fields(r, known);
    if (ewa_text_is_any_case(word, "SCALARS")) return read_scalars(r, known);
    if (ewa_text_is_any_case(word, "METADATA")) {
        skip_metadata(r);
        return EWA_OK;
    }
    const bool of_points = ewa_text_is_any_case(word, "POINT_DATA");
    if (of_points || ewa_text_is_any_case(word, "CELL_DATA")) {
        r->of_points = of_points;
        r->of_cells = !of_points;
        return take_count(r, &r->data_count) ? EWA_OK : fail(r, "data have no number");
    }
    if (ewa_text_is_any_case(word, "COLOR_SCALARS") || ewa_text_is_any_case(word, "TEXTURE_COORDINATES")) {
        const bool colors = ewa_text_is_any_case(word, "COLOR_SCALARS");
        ewa_cursor_any_word(&r->cursor);
        if (!take_count(r, &count)) return fail(r, "data have no number of components");
        type = r->text ? FLOATS : BYTES;
        if (!colors && !take_type(r, &type)) return fail(r, "TEXTURE_COORDINATES has no type");
        if (colors && wants_colors(r, count))
            return r->of_cells ? read_cell_colors(r, &type, (uint32_t)count) : read_colors(r, &type, (uint32_t)count);
        if (count > MAX_COMPONENTS || r->data_count > UINT64_MAX / MAX_COMPONENTS)
            return fail(r, "an array is too large");
        return skip_numbers(r, &type, count * r->data_count);
    }
    if (ewa_text_is_any_case(word, "LOOKUP_TABLE")) {
        ewa_cursor_any_word(&r->cursor);
        type = r->text ? FLOATS : BYTES;
        return take_count(r, &count) && count < UINT64_MAX / 4 ? skip_numbers(r, &type, 4 * count)
                                                               : fail(r, "LOOKUP_TABLE has no size");
    }
    const uint32_t numbers = numbers_of(word);
    *known = numbers > 0;
    if (!*known) return EWA_OK;
    const ewa_text name = ewa_cursor_any_word(&r->cursor);
    if (!take_type(r, &type)) return fail(r, "vectors have no type");
    if (ewa_text_is_any_case(word, "NORMALS") && r->of_points && !r->has_normals) return read_normals(r, &type);
    return take_data(r, name, &type, numbers, r->data_count);
}

/// Adds the sides of a grid, if its places are those that its sizes say.
static ewa_status add_grid(vtk_reader *r) {
    uint64_t layer, all;
    if (__builtin_mul_overflow(r->counts[0], r->counts[1], &layer) || __builtin_mul_overflow(layer, r->counts[2], &all) ||
        all != r->build->positions.count)
        return fail(r, "there are not as many POINTS as DIMENSIONS say");
    return ewa_vtk_add_sides(r->build, 0, r->counts, r->has_normals);
}

static ewa_status read_body(vtk_reader *r) {
    const char *name = r->build->source->name;
    for (int line = 0; line < 2; line++) end_line(&r->cursor); // magic and title
    const ewa_text encoding = ewa_cursor_any_word(&r->cursor);
    r->text = ewa_text_is_any_case(encoding, "ASCII");
    if (!r->text && !ewa_text_is_any_case(encoding, "BINARY")) return fail(r, "ASCII or BINARY is wanted");
    ewa_cursor_any_word(&r->cursor); // DATASET
    ewa_cursor_any_word(&r->cursor);
    for (;;) {
        const ewa_text word = ewa_cursor_any_word(&r->cursor);
        bool known;
        char quote[EWA_QUOTE_BYTES];
        if (!word.length) break;
        EWA_TRY(read_section(r, word, &known));
        if (known) continue;
        if (!r->build->positions.count) return fail(r, "there are no POINTS");
        ewa_report(r->build->context, EWA_SEVERITY_WARNING,
                   "%s: line %llu: VTK: what %s begins is left out, and all behind it", name,
                   (unsigned long long)r->cursor.line, ewa_quote(word, quote));
        break;
    }
    if (r->has_colors) r->build->cell_colors.count = 0; // points' own
    if (r->has_counts) return add_grid(r);
    const ewa_vtk_cells cells = {r->cells.items, r->cells.count,  r->kinds.items,
                                 r->kinds.count, r->has_normals, r->grouped ? r->group_counts : NULL};
    return ewa_vtk_add_cells(r->build, &cells);
}

bool ewa_mesh_is_vtk(const uint8_t *bytes, size_t size_bytes) {
    static const char magic[] = "# vtk DataFile Version";
    if (size_bytes < sizeof magic || memcmp(bytes, magic, sizeof magic - 1) != 0) return false;
    const char *start = (const char *)bytes;
    ewa_cursor cursor = {start, start + (size_bytes < HEAD_BYTES ? size_bytes : HEAD_BYTES), 1};
    for (int line = 0; line < 2; line++) end_line(&cursor);
    ewa_cursor_any_word(&cursor); // encoding
    if (!ewa_text_is_any_case(ewa_cursor_any_word(&cursor), "DATASET")) return false;
    const ewa_text kind = ewa_cursor_any_word(&cursor);
    static const char *const kinds[] = {"POLYDATA", "UNSTRUCTURED_GRID", "STRUCTURED_GRID", "RECTILINEAR_GRID"};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (ewa_text_is_any_case(kind, kinds[i])) return true;
    return false;
}

ewa_status ewa_mesh_read_vtk(ewa_mesh_build *build) {
    const ewa_mesh_source *source = build->source;
    const char *bytes = (const char *)source->bytes;
    vtk_reader r = {.build = build,
                    .cursor = {bytes, bytes + source->size_bytes, 1},
                    .cells = {.item_bytes = sizeof(uint32_t)},
                    .kinds = {.item_bytes = sizeof(uint32_t)},
                    .offsets = {.item_bytes = sizeof(uint32_t)}};
    for (int c = 0; c < 3; c++) r.coordinates[c].item_bytes = sizeof(double);
    const ewa_status status = read_body(&r);
    ewa_mesh_list *const lists[] = {&r.cells,          &r.kinds,          &r.offsets,
                                    &r.coordinates[0], &r.coordinates[1], &r.coordinates[2]};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
        ewa_release(build->context, lists[i]->items, lists[i]->capacity, lists[i]->item_bytes);
    return status;
}
