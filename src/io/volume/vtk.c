// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// VTK's legacy structured points: scalars of the points, else one array of them, else such of the cells between them.
// Based on: Kitware, "VTK File Formats", The VTK User's Guide, 2010, pages 3 to 17.
#include "base/base.h"
#include "io/mesh/formats.h"
#include "io/volume/file.h"
#include "io/volume/text.h"

enum { WORDS = 4, WORD_BYTES = 256, MAX_LINES = 4096, MAX_FIELDS = 1000, MAX_COMPONENTS = 1000 };

/// How well an array suits: of the cells between the points less than of these, of a field less than scalars.
enum { OF_FIELD = 1, OF_SCALARS = 2, OF_POINTS = 2 };

static ewa_status broken(const ewa_volume_input *in, const char *what, const char *text) {
    return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: %s '%.80s' cannot be read", what, text);
}

static const ewa_text_word legacy_types[] = {
    {"char", EWA_I8},       {"unsigned_char", EWA_U8},       {"short", EWA_I16}, {"unsigned_short", EWA_U16},
    {"int", EWA_I32},       {"unsigned_int", EWA_U32},       {"float", EWA_F32}, {"double", EWA_F64},
    {"long", EWA_FILE_I64}, {"unsigned_long", EWA_FILE_U64},
};

/// Splits a line at its blanks into at most WORDS words; returns how many.
static int split(const char *line, char words[WORDS][WORD_BYTES]) {
    int count = 0;
    while (count < WORDS) {
        line = ewa_text_skip_blanks(line);
        const size_t length = strcspn(line, " \t");
        if (!length || length >= WORD_BYTES) return count;
        memcpy(words[count], line, length);
        words[count++][length] = 0;
        line += length;
    }
    return count;
}

static ewa_status take_spacings(const ewa_volume_input *in, const double spacings[3],
                                ewa_volume_header *header) {
    for (int axis = 0; axis < 3; axis++) {
        if (spacings[axis] == 0) return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: a spacing of zero");
        header->directions[axis][axis] = spacings[axis];
    }
    return EWA_OK;
}

/// What has been read of a file.
typedef struct vtk_grid {
    const ewa_volume_input *in;
    ewa_volume_header *header;
    ewa_reader reader;
    bool text, has_dims, of_cells;
    uint64_t data_count; ///< of points or cells
    int rank;            ///< of the array that is taken; 0: none
    bool taken_of_cells;
    uint64_t taken_at_bytes, taken_count;
} vtk_grid;

static int type_of(const char *word) {
    return ewa_text_find(legacy_types, sizeof legacy_types / sizeof legacy_types[0], word);
}

/// Steps over numbers.
static ewa_status skip_numbers(vtk_grid *grid, uint64_t count, size_t number_bytes) {
    ewa_reader *reader = &grid->reader;
    const uint8_t *bytes = reader->bytes;
    if (grid->text) {
        for (uint64_t i = 0; i < count && reader->at_bytes < reader->size_bytes; i++) {
            while (reader->at_bytes < reader->size_bytes && bytes[reader->at_bytes] <= ' ') reader->at_bytes++;
            while (reader->at_bytes < reader->size_bytes && bytes[reader->at_bytes] > ' ') reader->at_bytes++;
        }
        return EWA_OK;
    }
    if (count > ewa_reader_left(reader) / number_bytes)
        return ewa_volume_fail(grid->in, EWA_ERROR_FORMAT, "VTK: the data of an array end early");
    reader->at_bytes += count * number_bytes;
    return EWA_OK;
}

/// Takes an array whose numbers follow, if it suits better than what there is, and steps over it.
static ewa_status take_array(vtk_grid *grid, int number, uint64_t components, uint64_t count, int rank) {
    const bool drawable = components == 1 || components == 3 || components == 4;
    rank += grid->of_cells ? 0 : OF_POINTS;
    if (rank > grid->rank && drawable && count == grid->data_count) {
        grid->rank = rank;
        grid->taken_of_cells = grid->of_cells;
        grid->taken_at_bytes = grid->reader.at_bytes;
        grid->taken_count = count;
        grid->header->number = number;
        grid->header->component_count = (uint32_t)components;
    }
    if (components > MAX_COMPONENTS || count > UINT64_MAX / MAX_COMPONENTS)
        return ewa_volume_fail(grid->in, EWA_ERROR_FORMAT, "VTK: an array is too large");
    return skip_numbers(grid, components * count, ewa_file_number_bytes(number));
}

/// Takes the next line that is not empty; false at the end.
static bool next_line(vtk_grid *grid, char line[EWA_LINE_BYTES]) {
    line[0] = 0;
    while (!line[0])
        if (!ewa_text_line(&grid->reader, line)) return false;
    return true;
}

/// Steps over what says how an array is to be understood, up to an empty line.
static void skip_metadata(vtk_grid *grid) {
    char line[EWA_LINE_BYTES];
    while (ewa_text_line(&grid->reader, line) && line[0]) continue;
}

static ewa_status take_fields(vtk_grid *grid, uint64_t field_count) {
    char line[EWA_LINE_BYTES], words[WORDS][WORD_BYTES];
    for (uint64_t i = 0; i < field_count; i++) {
        uint64_t components, count;
        bool more = next_line(grid, line);
        while (more && strncasecmp(line, "METADATA", 8) == 0) {
            skip_metadata(grid);
            more = next_line(grid, line);
        }
        if (!more || split(line, words) != 4 || ewa_text_counts(words[1], 1, &components) != 1 ||
            ewa_text_counts(words[2], 1, &count) != 1 || type_of(words[3]) < 0)
            return grid->rank ? EWA_OK : broken(grid->in, "an array of FIELD,", line);
        EWA_TRY(take_array(grid, type_of(words[3]), components, count, OF_FIELD));
    }
    return EWA_OK;
}

/// Takes the numbers behind a line of SCALARS and the name of their table.
static ewa_status take_scalars(vtk_grid *grid, const char *line, int count, char words[WORDS][WORD_BYTES]) {
    const int number = count > 2 ? type_of(words[2]) : -1;
    uint64_t components = 1;
    if (number < 0) return ewa_volume_fail(grid->in, EWA_ERROR_UNSUPPORTED, "VTK: '%.80s'", line);
    const bool drawable = count < 4 || strcmp(words[3], "1") == 0 || strcmp(words[3], "3") == 0 || strcmp(words[3], "4") == 0;
    if (!drawable || (count > 3 && ewa_text_counts(words[3], 1, &components) != 1))
        return ewa_volume_fail(grid->in, EWA_ERROR_UNSUPPORTED, "VTK: '%.80s' numbers per voxel", words[3]);
    const uint64_t before = grid->reader.at_bytes;
    char next[EWA_LINE_BYTES];
    if (!next_line(grid, next) || strncasecmp(ewa_text_skip_blanks(next), "LOOKUP_TABLE", 12) != 0) grid->reader.at_bytes = before;
    return take_array(grid, number, components, grid->data_count, OF_SCALARS);
}

static ewa_status take_dataset(const vtk_grid *grid, const char *kind) {
    if (ewa_mesh_is_vtk(grid->in->bytes, grid->in->size_bytes))
        return ewa_volume_fail(grid->in, EWA_ERROR_UNSUPPORTED, "VTK: a mesh (%.40s), no grid of voxels", kind);
    if (strcasecmp(kind, "STRUCTURED_POINTS") == 0) return EWA_OK;
    return ewa_volume_fail(grid->in, EWA_ERROR_UNSUPPORTED,
                           "VTK: dataset '%.40s' is no STRUCTURED_POINTS; resampled to them it is read", kind);
}

/// Takes one line and what belongs to it; `*known` becomes false at what cannot be stepped over.
static ewa_status take_line(vtk_grid *grid, const char *line, bool *known) {
    const ewa_volume_input *in = grid->in;
    ewa_volume_header *header = grid->header;
    char words[WORDS][WORD_BYTES];
    const int count = split(line, words);
    if (!count) return EWA_OK;
    const char *rest = ewa_text_skip_blanks(line) + strlen(words[0]);
    uint64_t size = 0;
    const bool sized = count > 2 && ewa_text_counts(words[2], 1, &size) == 1 && size <= MAX_COMPONENTS;
    if (strcasecmp(words[0], "DATASET") == 0) return take_dataset(grid, count > 1 ? words[1] : "");
    if (strcasecmp(words[0], "DIMENSIONS") == 0) {
        grid->has_dims = ewa_text_counts(rest, 3, header->dims) == 3;
        return grid->has_dims ? EWA_OK : broken(in, "the line", line);
    }
    if (strcasecmp(words[0], "SPACING") == 0 || strcasecmp(words[0], "ASPECT_RATIO") == 0) {
        double spacings[3];
        return ewa_text_numbers(rest, 3, spacings) == 3 ? take_spacings(in, spacings, header) : broken(in, "the line", line);
    }
    if (strcasecmp(words[0], "ORIGIN") == 0) {
        header->placed = true;
        return ewa_text_numbers(rest, 3, header->first_world) == 3 ? EWA_OK : broken(in, "the line", line);
    }
    grid->of_cells = strcasecmp(words[0], "CELL_DATA") == 0 || (grid->of_cells && strcasecmp(words[0], "POINT_DATA") != 0);
    if (strcasecmp(words[0], "CELL_DATA") == 0 || strcasecmp(words[0], "POINT_DATA") == 0)
        return ewa_text_counts(rest, 1, &grid->data_count) == 1 ? EWA_OK : broken(in, "the line", line);
    if (strcasecmp(words[0], "SCALARS") == 0) return take_scalars(grid, line, count, words);
    if (strcasecmp(words[0], "FIELD") == 0 && sized) return take_fields(grid, size);
    if (strcasecmp(words[0], "COLOR_SCALARS") == 0 && sized)
        return grid->text ? skip_numbers(grid, size * grid->data_count, 1)
                          : take_array(grid, EWA_U8, size, grid->data_count, OF_FIELD);
    if (strcasecmp(words[0], "METADATA") == 0) {
        skip_metadata(grid);
        return EWA_OK;
    }
    const bool vectors = strcasecmp(words[0], "VECTORS") == 0 || strcasecmp(words[0], "NORMALS") == 0;
    *known = (vectors || strcasecmp(words[0], "TENSORS") == 0) && count > 2 && type_of(words[2]) >= 0 &&
             grid->data_count <= UINT64_MAX / 9;
    return *known ? skip_numbers(grid, (vectors ? 3 : 9) * grid->data_count, ewa_file_number_bytes(type_of(words[2]))) : EWA_OK;
}

/// Makes the grid that of the cells between the points; a slice has one layer of them.
static void go_to_cells(ewa_volume_header *header) {
    for (int axis = 0; axis < 3; axis++) {
        if (header->dims[axis] < 2) continue;
        header->dims[axis]--;
        header->first_world[axis] += 0.5 * header->directions[axis][axis];
    }
}

bool ewa_vtk_recognise(const uint8_t *bytes, size_t size_bytes) {
    static const char magic[] = "# vtk DataFile Version";
    return size_bytes >= sizeof magic - 1 && memcmp(bytes, magic, sizeof magic - 1) == 0;
}

ewa_status ewa_vtk_parse(const ewa_volume_input *in, ewa_volume_header *header) {
    vtk_grid grid = {.in = in, .header = header, .reader = {.bytes = in->bytes, .size_bytes = in->size_bytes}};
    char line[EWA_LINE_BYTES] = "";
    ewa_text_line(&grid.reader, line); // magic
    ewa_text_line(&grid.reader, line); // title
    next_line(&grid, line);
    grid.text = strcasecmp(line, "ASCII") == 0;
    if (!grid.text && strcasecmp(line, "BINARY") != 0) return broken(in, "the encoding", line);
    header->packing = grid.text ? EWA_PACKING_TEXT : EWA_PACKING_NONE;
    header->big_endian = true;
    bool known = true;
    // Scalars of points are as good as it gets.
    for (int count = 0; known && grid.rank < OF_POINTS + OF_SCALARS && count < MAX_LINES && next_line(&grid, line); count++)
        EWA_TRY(take_line(&grid, line, &known));
    if (!known && !grid.rank) return ewa_volume_fail(in, EWA_ERROR_UNSUPPORTED, "VTK: '%.80s'", line);
    if (!grid.has_dims || !grid.rank)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: no %s", grid.has_dims ? "SCALARS, nor an array like them" : "DIMENSIONS");
    if (grid.taken_of_cells) go_to_cells(header);
    const double voxels = (double)header->dims[0] * (double)header->dims[1] * (double)header->dims[2];
    // Files without POINT_DATA do not say how many there are.
    if (grid.taken_count && (double)grid.taken_count != voxels)
        return ewa_volume_fail(in, EWA_ERROR_FORMAT, "VTK: data of %llu places, which DIMENSIONS say are %g",
                               (unsigned long long)grid.taken_count, voxels);
    return ewa_volume_add_bytes(in, in->bytes + grid.taken_at_bytes, in->size_bytes - grid.taken_at_bytes, &header->pieces);
}
