// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes in VTK's XML files: polygonal data (.vtp), the surface of unstructured grids (.vtu), the sides of structured and
// rectilinear ones (.vts, .vtr); any number of pieces. Of the data of points, normals, colours of bytes and numbers by name
// are taken, of those of cells colours and numbers.
//
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 12 to 17.
#include "base/base.h"
#include "io/mesh/formats.h"
#include "io/mesh/vtk_cells.h"
#include "io/mesh/vtk_number.h"
#include "io/volume/text.h"
#include "io/vtk_xml.h"

enum { BLOCK_BYTES = 4096, POLYHEDRON = 42, MAX_NAMED = 256 };

/// Arrays of a piece that are read.
typedef enum role {
    POINTS,
    COORDINATES, ///< along x; y and z are the next two
    NORMALS = COORDINATES + 3,
    COLORS,
    CELL_COLORS,
    TYPES,
    FACES,
    FACE_OFFSETS,
    CONNECTIVITY,
    OFFSETS = CONNECTIVITY + 4, ///< of cells, lines, strips and polygons, as CONNECTIVITY
    ROLE_COUNT = OFFSETS + 4,
} role;

/// Groups of cells, in the order of CONNECTIVITY and OFFSETS, and the kind of cells that they hold; 0: TYPES says.
static const struct cell_group {
    const char *section, *count;
    uint32_t kind;
} cell_groups[] = {{"Cells", "NumberOfCells", 0},
                   {"Lines", "NumberOfLines", EWA_VTK_LINES},
                   {"Strips", "NumberOfStrips", EWA_VTK_STRIP},
                   {"Polys", "NumberOfPolys", EWA_VTK_POLYGON}};
enum { CELL_GROUPS = sizeof cell_groups / sizeof cell_groups[0] };

typedef struct xml_mesh {
    ewa_mesh_build *build;
    ewa_vtk_xml xml;
    bool structured, rectilinear;
    ewa_xml_tag piece, arrays[ROLE_COUNT];
    bool has[ROLE_COUNT];
    ewa_xml_tag named[MAX_NAMED]; ///< arrays that are numbers,
    bool of_cells[MAX_NAMED];     ///< of points or of cells
    uint32_t named_count;
    uint64_t first; ///< place of the piece's first point
    bool has_normals;
    ewa_mesh_list cells, kinds, offsets, faces, face_offsets; ///< 32-bit numbers of a piece
} xml_mesh;

static const ewa_vtk_type types[] = {
    {"Int8", 1, 'i'},   {"UInt8", 1, 'u'}, {"Int16", 2, 'i'},  {"UInt16", 2, 'u'},  {"Int32", 4, 'i'},
    {"UInt32", 4, 'u'}, {"Int64", 8, 'i'}, {"UInt64", 8, 'u'}, {"Float32", 4, 'f'}, {"Float64", 8, 'f'},
};

/// The numbers of an array, one after the other.
typedef struct numbers {
    const ewa_vtk_xml *xml;
    ewa_vtk_type type;
    ewa_vtk_stored stored;
    ewa_source *source; ///< NULL: text
    ewa_cursor text;
    uint8_t block[BLOCK_BYTES];
    size_t at, filled;
} numbers;

static ewa_status fail(const xml_mesh *m, const char *what) {
    return ewa_fail(m->build->context, EWA_ERROR_FORMAT, "%s: VTK: %s", m->xml.name, what);
}

static void close_numbers(numbers *n) {
    ewa_source_close(&n->source);
    ewa_release(n->xml->context, n->stored.owned, n->stored.owned_bytes, 1);
    n->stored = (ewa_vtk_stored){0};
}

static ewa_status open_array(const xml_mesh *m, const ewa_xml_tag *array, numbers *n) {
    char value[EWA_VTK_ATTRIBUTE_BYTES] = "";
    *n = (numbers){.xml = &m->xml};
    if (!ewa_vtk_attribute(array, "type", value)) value[0] = 0;
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (strcmp(value, types[i].name) == 0) n->type = types[i];
    if (!n->type.name)
        return ewa_fail(m->build->context, EWA_ERROR_UNSUPPORTED, "%s: VTK: type '%.80s'", m->xml.name, value);
    EWA_TRY(ewa_vtk_xml_find(&m->xml, array, &n->stored));
    const char *text = (const char *)n->stored.bytes;
    n->text = (ewa_cursor){text, text + n->stored.size_bytes, 1};
    if (n->stored.packing == EWA_PACKING_TEXT) return EWA_OK;
    const ewa_status status = ewa_source_open(m->build->context, m->xml.name, n->stored.packing, n->stored.bytes,
                                              n->stored.size_bytes, &n->source);
    if (status != EWA_OK) close_numbers(n);
    return status;
}

static ewa_status open_numbers(const xml_mesh *m, role which, numbers *n) {
    *n = (numbers){.xml = &m->xml}; // closed even where it could not be opened
    return m->has[which] ? open_array(m, &m->arrays[which], n) : fail(m, "an array of a piece is not there");
}

static ewa_status ends_early(const numbers *n) {
    return ewa_fail(n->xml->context, EWA_ERROR_FORMAT, "%s: VTK: the data of the array end early", n->xml->name);
}

static ewa_status take_number(numbers *n, double *value) {
    if (!n->source) {
        const ewa_text word = ewa_cursor_any_word(&n->text);
        char quote[EWA_QUOTE_BYTES];
        if (ewa_text_number(word, value)) return EWA_OK;
        return word.length ? ewa_vtk_broken(n->xml, "a number,", ewa_quote(word, quote)) : ends_early(n);
    }
    if (n->at == n->filled) {
        EWA_TRY(ewa_source_read(n->source, n->block, BLOCK_BYTES, &n->filled));
        n->at = 0;
    }
    if (n->filled - n->at < n->type.bytes) return ends_early(n);
    *value = ewa_vtk_number(&n->type, n->block + n->at, n->xml->big_endian);
    n->at += n->type.bytes;
    return EWA_OK;
}

/// Reads `count` numbers of an array into a list; none that a place could have become EWA_MESH_NONE.
static ewa_status read_list(xml_mesh *m, role which, uint64_t count, ewa_mesh_list *list) {
    numbers n;
    list->count = 0;
    if (count == 0) return EWA_OK;
    EWA_TRY(open_numbers(m, which, &n));
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        double value = 0;
        status = take_number(&n, &value);
        uint32_t *to = status == EWA_OK ? ewa_mesh_list_add(m->build, list, &status) : NULL;
        if (to) *to = value >= 0 && value < (double)EWA_MESH_NONE ? (uint32_t)value : EWA_MESH_NONE;
    }
    close_numbers(&n);
    return status;
}

static ewa_status read_points(xml_mesh *m, uint64_t count) {
    numbers n;
    EWA_TRY(open_numbers(m, POINTS, &n));
    m->build->float_positions = n.type.kind == 'f' && n.type.bytes == 4 && n.source;
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        double place[3] = {0};
        for (int c = 0; c < 3 && status == EWA_OK; c++) status = take_number(&n, &place[c]);
        if (status == EWA_OK) status = ewa_mesh_add_position(m->build, place);
    }
    close_numbers(&n);
    return status;
}

static ewa_status read_normals(xml_mesh *m, uint64_t count) {
    numbers n;
    EWA_TRY(open_numbers(m, NORMALS, &n));
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        double normal[3] = {0};
        for (int c = 0; c < 3 && status == EWA_OK; c++) status = take_number(&n, &normal[c]);
        if (status == EWA_OK) status = ewa_mesh_add_normal(m->build, normal);
    }
    close_numbers(&n);
    return status;
}

/// Reads colours of points, codes of bytes.
static ewa_status read_colors(xml_mesh *m, uint64_t count) {
    static const float white[4] = {1, 1, 1, 1};
    ewa_mesh_build *build = m->build;
    char value[EWA_VTK_ATTRIBUTE_BYTES];
    const int components =
        ewa_vtk_attribute(&m->arrays[COLORS], "NumberOfComponents", value) && strcmp(value, "4") == 0 ? 4 : 3;
    numbers n;
    EWA_TRY(open_numbers(m, COLORS, &n));
    ewa_status status = EWA_OK;
    // Colours go by place, the last one's.
    build->positions.count = m->first;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        double codes[4] = {0, 0, 0, 255};
        float color[4];
        build->positions.count++;
        for (int c = 0; c < components && status == EWA_OK; c++) status = take_number(&n, &codes[c]);
        ewa_vtk_color(codes, 1.0 / 255, color);
        if (status == EWA_OK) status = ewa_mesh_add_color(build, white, color);
    }
    build->positions.count = m->first + count;
    close_numbers(&n);
    return status;
}

/// Reads colours of cells, codes of bytes.
static ewa_status read_cell_colors(xml_mesh *m, uint64_t count) {
    char value[EWA_VTK_ATTRIBUTE_BYTES];
    const int components = ewa_vtk_attribute(&m->arrays[CELL_COLORS], "NumberOfComponents", value) && strcmp(value, "4") == 0 ? 4 : 3;
    numbers n;
    EWA_TRY(open_numbers(m, CELL_COLORS, &n));
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        double codes[4] = {0, 0, 0, 255};
        float color[4];
        for (int c = 0; c < components && status == EWA_OK; c++) status = take_number(&n, &codes[c]);
        ewa_vtk_color(codes, 1.0 / 255, color);
        if (status == EWA_OK) status = ewa_mesh_add_cell_color(m->build, color);
    }
    close_numbers(&n);
    return status;
}

/// Reads an array of `count` points or cells that has a name; `first`: those of pieces before.
static ewa_status read_named(xml_mesh *m, const ewa_xml_tag *tag, bool of_cells, uint64_t first, uint64_t count) {
    char name[EWA_VTK_ATTRIBUTE_BYTES], value[EWA_VTK_ATTRIBUTE_BYTES];
    uint64_t components = 1;
    numbers n;
    if (!ewa_vtk_attribute(tag, "Name", name)) return EWA_OK;
    if (ewa_vtk_attribute(tag, "NumberOfComponents", value) && ewa_text_counts(value, 1, &components) != 1) return EWA_OK;
    EWA_TRY(open_array(m, tag, &n));
    ewa_mesh_array *array;
    ewa_status status = ewa_mesh_find_array(m->build, of_cells, (ewa_text){name, strlen(name)}, ewa_vtk_kept_type(&n.type),
                                            components, first, &array);
    if (array) array->wide |= n.type.bytes == 8 && n.type.kind != 'f';
    for (uint64_t i = 0; i < count && array && status == EWA_OK; i++) {
        double values[4];
        for (uint64_t c = 0; c < components && status == EWA_OK; c++) status = take_number(&n, &values[c]);
        if (status == EWA_OK) status = ewa_mesh_add_numbers(m->build, array, values);
    }
    close_numbers(&n);
    return status;
}

static ewa_status append(xml_mesh *m, uint64_t number) {
    ewa_status status = EWA_OK;
    uint32_t *to = ewa_mesh_list_add(m->build, &m->cells, &status);
    if (to) *to = number < EWA_MESH_NONE ? (uint32_t)number : EWA_MESH_NONE;
    return status;
}

/// Appends the faces of a polyhedron: how many, then of each how many corners and which.
static ewa_status append_polyhedron(xml_mesh *m, uint64_t from, uint64_t to) {
    const uint32_t *stream = m->faces.items;
    uint64_t corners_left = 0;
    EWA_TRY(append(m, to - from));
    for (uint64_t i = from; i < to; i++) {
        const bool corner = corners_left > 0;
        EWA_TRY(append(m, stream[i] + (corner ? m->first : 0)));
        if (corner)
            corners_left--;
        else if (i > from)
            corners_left = stream[i];
    }
    return EWA_OK;
}

/// Reads the cells of a group into the list of the piece's cells. TYPES, FACES and FACE_OFFSETS have been read.
static ewa_status read_cells(xml_mesh *m, size_t group, uint64_t count) {
    numbers n;
    const uint32_t kind = cell_groups[group].kind;
    EWA_TRY(read_list(m, (role)(OFFSETS + group), count, &m->offsets));
    EWA_TRY(open_numbers(m, (role)(CONNECTIVITY + group), &n));
    const uint32_t *offsets = m->offsets.items, *face_ends = m->face_offsets.items;
    uint64_t taken = 0, faces_taken = 0;
    ewa_status status = EWA_OK;
    for (uint64_t i = 0; i < count && status == EWA_OK; i++) {
        const bool polyhedron = !kind && ((const uint32_t *)m->kinds.items)[i] == POLYHEDRON;
        if (offsets[i] < taken) status = fail(m, "offsets do not ascend");
        if (status == EWA_OK && polyhedron) {
            const uint64_t end = i < m->face_offsets.count ? face_ends[i] : 0;
            if (end > m->faces.count || end < faces_taken) status = fail(m, "offsets of faces do not ascend, or lead beyond them");
            if (status == EWA_OK) status = append_polyhedron(m, faces_taken, end);
            faces_taken = end;
        } else if (status == EWA_OK) {
            status = append(m, offsets[i] - taken);
        }
        if (status == EWA_OK && kind) {
            uint32_t *to = ewa_mesh_list_add(m->build, &m->kinds, &status);
            if (to) *to = kind;
        }
        for (; status == EWA_OK && taken < offsets[i]; taken++) {
            double place = 0;
            status = take_number(&n, &place);
            const bool known = place >= 0 && place < (double)EWA_MESH_NONE;
            if (status == EWA_OK && !polyhedron) status = append(m, known ? (uint64_t)place + m->first : EWA_MESH_NONE);
        }
    }
    close_numbers(&n);
    return status;
}

/// Takes a count from the piece's tag; 0 when it has none.
static uint64_t count_of(const xml_mesh *m, const char *name) {
    char value[EWA_VTK_ATTRIBUTE_BYTES];
    uint64_t count = 0;
    if (!ewa_vtk_attribute(&m->piece, name, value) || ewa_text_counts(value, 1, &count) != 1) return 0;
    return count;
}

/// How many numbers an array has, by its offsets' last; EWA_MESH_NONE stands for none.
static uint64_t last_of(const ewa_mesh_list *list) {
    const uint32_t *items = list->items;
    for (uint64_t i = list->count; i > 0; i--)
        if (items[i - 1] != EWA_MESH_NONE) return items[i - 1];
    return 0;
}

/// How many cells of polygonal data there are, by group.
static void count_groups(const xml_mesh *m, uint64_t counts[4]) {
    static const char *const names[] = {"NumberOfVerts", "NumberOfLines", "NumberOfPolys", "NumberOfStrips"};
    for (int group = 0; group < 4; group++) counts[group] = count_of(m, names[group]);
}

/// How many cells a piece has; a grid's are those between its `counts` places.
static uint64_t count_cells(const xml_mesh *m, const uint64_t counts[3]) {
    uint64_t groups[4], all = count_of(m, "NumberOfCells");
    count_groups(m, groups);
    for (int group = 0; group < 4; group++) all += groups[group];
    if (!m->structured && !m->rectilinear) return all;
    all = 1;
    for (int c = 0; c < 3; c++) all *= counts[c] > 1 ? counts[c] - 1 : 1;
    return all;
}

/// Reads the numbers and colours of a piece's points and cells.
static ewa_status read_data(xml_mesh *m, uint64_t point_count, uint64_t cell_count) {
    ewa_mesh_build *build = m->build;
    if (m->has[COLORS]) EWA_TRY(read_colors(m, point_count));
    // Colours of cells go by cell, and are for files whose points have none.
    if (m->has[CELL_COLORS] && !build->colors.count && build->cell_colors.count == build->cell_count)
        EWA_TRY(read_cell_colors(m, cell_count));
    for (uint32_t i = 0; i < m->named_count; i++) {
        const bool of_cells = m->of_cells[i];
        EWA_TRY(read_named(m, &m->named[i], of_cells, of_cells ? build->cell_count : m->first, of_cells ? cell_count : point_count));
    }
    return EWA_OK;
}

static ewa_status add_cells(xml_mesh *m) {
    m->cells.count = m->kinds.count = m->faces.count = m->face_offsets.count = 0;
    const uint64_t count = count_of(m, "NumberOfCells");
    if (count && m->has[CONNECTIVITY]) {
        EWA_TRY(read_list(m, TYPES, count, &m->kinds));
        if (m->has[FACES] && m->has[FACE_OFFSETS]) EWA_TRY(read_list(m, FACE_OFFSETS, count, &m->face_offsets));
        if (m->face_offsets.count) EWA_TRY(read_list(m, FACES, last_of(&m->face_offsets), &m->faces));
    }
    for (size_t group = 0; group < CELL_GROUPS; group++) {
        const uint64_t its = count_of(m, cell_groups[group].count);
        if (its && m->has[CONNECTIVITY + group]) EWA_TRY(read_cells(m, group, its));
    }
    uint64_t group_counts[4];
    count_groups(m, group_counts);
    const ewa_vtk_cells cells = {m->cells.items, m->cells.count, m->kinds.items,
                                 m->kinds.count, m->has_normals, count ? NULL : group_counts};
    return ewa_vtk_add_cells(m->build, &cells);
}

/// Reads the counts of a grid's piece along its axes.
static ewa_status read_counts(const xml_mesh *m, uint64_t counts[3]) {
    char value[EWA_VTK_ATTRIBUTE_BYTES] = "";
    double extent[6];
    if (!ewa_vtk_attribute(&m->piece, "Extent", value)) value[0] = 0;
    if (ewa_text_numbers(value, 6, extent) != 6) return ewa_vtk_broken(&m->xml, "the extent", value);
    for (int c = 0; c < 3; c++) {
        const double count = extent[2 * c + 1] - extent[2 * c] + 1;
        if (!(count >= 1 && count < 65536 * 65536.0)) return ewa_vtk_broken(&m->xml, "the extent", value);
        counts[c] = (uint64_t)count;
    }
    return EWA_OK;
}

/// Makes the places of a rectilinear grid, x fastest.
static ewa_status make_places(xml_mesh *m, const uint64_t counts[3]) {
    numbers n;
    ewa_mesh_list along[3] = {{.item_bytes = sizeof(double)}, {.item_bytes = sizeof(double)}, {.item_bytes = sizeof(double)}};
    ewa_status status = EWA_OK;
    for (int c = 0; c < 3 && status == EWA_OK; c++) {
        status = open_numbers(m, (role)(COORDINATES + c), &n);
        for (uint64_t i = 0; i < counts[c] && status == EWA_OK; i++) {
            double value = 0;
            status = take_number(&n, &value);
            double *to = status == EWA_OK ? ewa_mesh_list_add(m->build, &along[c], &status) : NULL;
            if (to) *to = value;
        }
        close_numbers(&n);
    }
    const double *at[3] = {along[0].items, along[1].items, along[2].items};
    for (uint64_t z = 0; z < counts[2] && status == EWA_OK; z++)
        for (uint64_t y = 0; y < counts[1] && status == EWA_OK; y++)
            for (uint64_t x = 0; x < counts[0] && status == EWA_OK; x++)
                status = ewa_mesh_add_position(m->build, (const double[3]){at[0][x], at[1][y], at[2][z]});
    for (int c = 0; c < 3; c++)
        ewa_release(m->build->context, along[c].items, along[c].capacity, along[c].item_bytes);
    return status;
}

/// Adds what a piece holds, once its tags have been seen.
static ewa_status add_piece(xml_mesh *m) {
    ewa_mesh_build *build = m->build;
    uint64_t counts[3] = {0}, count = count_of(m, "NumberOfPoints");
    m->first = build->positions.count;
    if (m->structured || m->rectilinear) {
        uint64_t layer;
        EWA_TRY(read_counts(m, counts));
        if (__builtin_mul_overflow(counts[0], counts[1], &layer) || __builtin_mul_overflow(layer, counts[2], &count))
            return fail(m, "a grid is too large");
    }
    if (count == 0) return EWA_OK;
    EWA_TRY(m->rectilinear ? make_places(m, counts) : read_points(m, count));
    // Normals have the numbers of places: of pieces behind one without them none are taken.
    m->has_normals = m->has[NORMALS] && build->normals.count == m->first;
    if (m->has_normals) EWA_TRY(read_normals(m, count));
    const uint64_t cell_count = count_cells(m, counts);
    EWA_TRY(read_data(m, count, cell_count));
    EWA_TRY(m->structured || m->rectilinear ? ewa_vtk_add_sides(build, m->first, counts, m->has_normals) : add_cells(m));
    build->cell_count += cell_count;
    return EWA_OK;
}

/// Keeps an array of a section, if it is one that is read.
static void offer_array(xml_mesh *m, const ewa_xml_tag *tag, const char *section, int *coordinates) {
    char name[EWA_VTK_ATTRIBUTE_BYTES] = "", components[EWA_VTK_ATTRIBUTE_BYTES] = "", type[EWA_VTK_ATTRIBUTE_BYTES] = "";
    if (!ewa_vtk_attribute(tag, "Name", name)) name[0] = 0;
    if (!ewa_vtk_attribute(tag, "NumberOfComponents", components)) components[0] = 0;
    if (!ewa_vtk_attribute(tag, "type", type)) type[0] = 0;
    int which = -1;
    const bool three = strcmp(components, "3") == 0;
    if (strcmp(section, "Points") == 0) which = POINTS;
    if (strcmp(section, "Coordinates") == 0 && *coordinates < 3) which = COORDINATES + (*coordinates)++;
    const bool of_cells = strcmp(section, "CellData") == 0, of_points = strcmp(section, "PointData") == 0;
    const bool color = strcmp(type, "UInt8") == 0 && (three || strcmp(components, "4") == 0);
    if (of_cells && color) which = CELL_COLORS;
    if (of_points) {
        if (three && strcasecmp(name, "Normals") == 0) which = NORMALS;
        if (color) which = COLORS;
    }
    for (int group = 0; group < CELL_GROUPS; group++) {
        if (strcmp(section, cell_groups[group].section) != 0) continue;
        if (strcmp(name, "connectivity") == 0) which = CONNECTIVITY + group;
        if (strcmp(name, "offsets") == 0) which = OFFSETS + group;
        if (group > 0) continue;
        if (strcmp(name, "types") == 0) which = TYPES;
        if (strcmp(name, "faces") == 0) which = FACES;
        if (strcmp(name, "faceoffsets") == 0) which = FACE_OFFSETS;
    }
    const bool named = (of_points || of_cells) && (which < 0 || m->has[which]) && strcmp(type, "String") != 0;
    if (named && m->named_count < MAX_NAMED) m->of_cells[m->named_count] = of_cells, m->named[m->named_count++] = *tag;
    if (which < 0 || m->has[which]) return;
    m->arrays[which] = *tag;
    m->has[which] = true;
}

static ewa_status read_body(xml_mesh *m) {
    static const char *const sections[] = {"Points", "Coordinates", "PointData", "CellData", "Cells", "Lines", "Strips", "Polys"};
    const char *at = m->xml.text, *end = m->xml.has_appended ? m->xml.appended.open : m->xml.end, *section = "";
    bool in_piece = false;
    int coordinates = 0;
    ewa_xml_tag tag;
    while (ewa_xml_next(&at, end, &tag)) {
        if (ewa_xml_is(&tag, "Piece")) {
            if (in_piece) EWA_TRY(add_piece(m));
            in_piece = !tag.closing;
            m->piece = tag;
            memset(m->has, 0, sizeof m->has);
            coordinates = 0;
            m->named_count = 0;
            section = "";
        } else if (in_piece && ewa_xml_is(&tag, "DataArray")) {
            if (!tag.closing) offer_array(m, &tag, section, &coordinates);
        } else if (!ewa_xml_is(&tag, "InformationKey") && !ewa_xml_is(&tag, "Value")) { // which stand in arrays
            section = "";
            for (size_t i = 0; i < sizeof sections / sizeof sections[0]; i++)
                if (!tag.closing && ewa_xml_is(&tag, sections[i])) section = sections[i];
        }
    }
    return in_piece ? add_piece(m) : EWA_OK;
}

static bool is_kind(const ewa_xml_tag *root, const char *kind) {
    char value[EWA_VTK_ATTRIBUTE_BYTES];
    return ewa_vtk_attribute(root, "type", value) && strcmp(value, kind) == 0;
}

bool ewa_mesh_is_vtk_xml(const uint8_t *bytes, size_t size_bytes) {
    static const char *const kinds[] = {"PolyData", "UnstructuredGrid", "StructuredGrid", "RectilinearGrid"};
    const char *at = (const char *)bytes;
    ewa_xml_tag tag;
    if (size_bytes < sizeof "<VTKFile" || *at != '<') return false;
    if (!ewa_xml_next(&at, at + size_bytes, &tag) || !ewa_xml_is(&tag, "VTKFile")) return false;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        if (is_kind(&tag, kinds[i])) return true;
    return false;
}

ewa_status ewa_mesh_read_vtk_pieces(ewa_mesh_build *build, const char *name, const uint8_t *bytes, size_t size_bytes) {
    xml_mesh m = {.build = build, .xml = {.context = build->context, .name = name, .kind = "VTK"}};
    ewa_vtk_xml_open(&m.xml, bytes, size_bytes);
    m.structured = m.xml.has_root && is_kind(&m.xml.root, "StructuredGrid");
    m.rectilinear = m.xml.has_root && is_kind(&m.xml.root, "RectilinearGrid");
    ewa_mesh_list *const lists[] = {&m.cells, &m.kinds, &m.offsets, &m.faces, &m.face_offsets};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) lists[i]->item_bytes = sizeof(uint32_t);
    const ewa_status status = read_body(&m);
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
        ewa_release(build->context, lists[i]->items, lists[i]->capacity, lists[i]->item_bytes);
    return status;
}

ewa_status ewa_mesh_read_vtk_xml(ewa_mesh_build *build) {
    return ewa_mesh_read_vtk_pieces(build, build->source->name, build->source->bytes, build->source->size_bytes);
}
