// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the columns of a text are: by the names that programs give them, or, where nobody names them, by their
// numbers and the orders that are usual.
#include "io/cloud/text_table.h"

#include <math.h>
#include <stdio.h>

enum { KEY_BYTES = 32 };

/// A name as its letters and digits in small letters, and the component that it stands for.
typedef struct alias {
    const char *key, *attribute;
    uint32_t component;
} alias;

static const alias aliases[] = {
    {"x", EWA_POSITION, 0},
    {"coordx", EWA_POSITION, 0},
    {"xcoord", EWA_POSITION, 0},
    {"xcoordinate", EWA_POSITION, 0},
    {"easting", EWA_POSITION, 0},
    {"east", EWA_POSITION, 0},
    {"lon", EWA_POSITION, 0},
    {"longitude", EWA_POSITION, 0},
    {"y", EWA_POSITION, 1},
    {"coordy", EWA_POSITION, 1},
    {"ycoord", EWA_POSITION, 1},
    {"ycoordinate", EWA_POSITION, 1},
    {"northing", EWA_POSITION, 1},
    {"north", EWA_POSITION, 1},
    {"lat", EWA_POSITION, 1},
    {"latitude", EWA_POSITION, 1},
    {"cartesianx", EWA_POSITION, 0},
    {"cartesiany", EWA_POSITION, 1},
    {"cartesianz", EWA_POSITION, 2},
    {"z", EWA_POSITION, 2},
    {"coordz", EWA_POSITION, 2},
    {"zcoord", EWA_POSITION, 2},
    {"zcoordinate", EWA_POSITION, 2},
    {"elevation", EWA_POSITION, 2},
    {"height", EWA_POSITION, 2},
    {"altitude", EWA_POSITION, 2},
    {"nx", EWA_NORMAL, 0},
    {"normalx", EWA_NORMAL, 0},
    {"normx", EWA_NORMAL, 0},
    {"ny", EWA_NORMAL, 1},
    {"normaly", EWA_NORMAL, 1},
    {"normy", EWA_NORMAL, 1},
    {"nz", EWA_NORMAL, 2},
    {"normalz", EWA_NORMAL, 2},
    {"normz", EWA_NORMAL, 2},
    {"r", EWA_COLOR, 0},
    {"red", EWA_COLOR, 0},
    {"rf", EWA_COLOR, 0},
    {"diffusered", EWA_COLOR, 0},
    {"colorred", EWA_COLOR, 0},
    {"g", EWA_COLOR, 1},
    {"green", EWA_COLOR, 1},
    {"gf", EWA_COLOR, 1},
    {"diffusegreen", EWA_COLOR, 1},
    {"colorgreen", EWA_COLOR, 1},
    {"b", EWA_COLOR, 2},
    {"blue", EWA_COLOR, 2},
    {"bf", EWA_COLOR, 2},
    {"diffuseblue", EWA_COLOR, 2},
    {"colorblue", EWA_COLOR, 2},
    {"a", EWA_COLOR, 3},
    {"alpha", EWA_COLOR, 3},
    {"af", EWA_COLOR, 3},
    {"diffusealpha", EWA_COLOR, 3},
    {"tux", EWA_TANGENT_U, 0},
    {"tuy", EWA_TANGENT_U, 1},
    {"tuz", EWA_TANGENT_U, 2},
    {"tvx", EWA_TANGENT_V, 0},
    {"tvy", EWA_TANGENT_V, 1},
    {"tvz", EWA_TANGENT_V, 2},
    {"clip0a", EWA_CLIP0, 0},
    {"clip0b", EWA_CLIP0, 1},
    {"clip0c", EWA_CLIP0, 2},
    {"clip1a", EWA_CLIP1, 0},
    {"clip1b", EWA_CLIP1, 1},
    {"clip1c", EWA_CLIP1, 2},
    {"borderx", EWA_BORDER, 0},
    {"bordery", EWA_BORDER, 1},
    {"borderz", EWA_BORDER, 2},
    {"radius", EWA_RADIUS, 0},
    {"intensity", "intensity", 0},
    {"i", "intensity", 0},
    {"reflectance", "intensity", 0},
    {"scalarfieldintensity", "intensity", 0},
    {"returnnumber", "return_number", 0},
    {"returnno", "return_number", 0},
    {"return", "return_number", 0},
    {"numberofreturns", "number_of_returns", 0},
    {"numreturns", "number_of_returns", 0},
    {"scandirectionflag", "scan_direction_flag", 0},
    {"scandirection", "scan_direction_flag", 0},
    {"edgeofflightline", "edge_of_flight_line", 0},
    {"edgeofflight", "edge_of_flight_line", 0},
    {"classification", "classification", 0},
    {"class", "classification", 0},
    {"scalarfieldclassification", "classification", 0},
    {"synthetic", "synthetic", 0},
    {"keypoint", "key_point", 0},
    {"withheld", "withheld", 0},
    {"overlap", "overlap", 0},
    {"scannerchannel", "scanner_channel", 0},
    {"scanchannel", "scanner_channel", 0},
    {"userdata", "user_data", 0},
    {"scanangle", "scan_angle", 0},
    {"scananglerank", "scan_angle", 0},
    {"pointsourceid", "point_source_id", 0},
    {"pointsource", "point_source_id", 0},
    {"gpstime", "gps_time", 0},
    {"nir", "nir", 0},
    {"infrared", "nir", 0},
    {"nearinfrared", "nir", 0},
};

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); }

/// Makes the key of a name: its letters and digits in small letters, without a unit in brackets behind it.
/// Empty when it is more than words with blanks, '_', '-' or '.' between them.
static void make_key(ewa_text name, char key[KEY_BYTES]) {
    size_t length = 0;
    bool open = true; // no letter stands before
    for (size_t i = 0; i < name.length; i++) {
        char c = name.chars[i];
        if (!open &&
            (c == '(' || c == '[' ||
             (c == ' ' && i + 1 < name.length && (name.chars[i + 1] == '(' || name.chars[i + 1] == '['))))
            break;
        if (c >= 'A' && c <= 'Z') c = (char)(c - 'A' + 'a');
        const bool between = length > 0 && (c == ' ' || c == '_' || c == '-' || c == '.');
        if ((!is_letter(c) && !between) || length + 1 == KEY_BYTES) {
            key[0] = 0;
            return;
        }
        open = !is_letter(c);
        if (!open) key[length++] = c;
    }
    key[open ? 0 : length] = 0;
}

/// Gives a column the name of a scalar: the word as it is, printable.
static void set_scalar(ewa_text_column *column, ewa_text word) {
    size_t length = 0;
    for (size_t i = 0; i < word.length && length + 1 < EWA_NAME_BYTES; i++) {
        const unsigned char c = (unsigned char)word.chars[i];
        column->name[length++] = (char)(c <= ' ' || c == ',' || c == ';' || c == '"' || c == 0x7f ? '_' : c);
    }
    column->name[length] = 0;
    column->component = 0;
}

static void set_column(ewa_text_column *column, const char *attribute, uint32_t component) {
    snprintf(column->name, sizeof column->name, "%s", attribute);
    column->component = component;
}

static ewa_text without_quotes(ewa_text word) {
    while (word.length && (*word.chars == '"' || *word.chars == '\'')) word.chars++, word.length--;
    while (word.length && (word.chars[word.length - 1] == '"' || word.chars[word.length - 1] == '\''))
        word.length--;
    return word;
}

static void name_column(ewa_text_column *column, ewa_text word) {
    word = without_quotes(word);
    column->word = word;
    if (word.length == 0 || ewa_text_is(word, "-")) {
        column->name[0] = 0;
        return;
    }
    char key[KEY_BYTES];
    make_key(word, key);
    for (size_t i = 0; i < sizeof aliases / sizeof aliases[0]; i++)
        if (strcmp(aliases[i].key, key) == 0) {
            set_column(column, aliases[i].attribute, aliases[i].component);
            return;
        }
    set_scalar(column, word);
}

// ---- names in the file -----------------------------------------------------------------------------------

static bool has_place(const ewa_text_column *columns, uint32_t count) {
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(columns[i].name, EWA_POSITION) == 0) found |= 1u << columns[i].component;
    return found == 7;
}

/// Splits a head into names, by the separator that it has itself; returns how many.
static uint32_t split_head(ewa_text head, ewa_text *words) {
    while (head.length && strchr("#/%! \t", *head.chars)) head.chars++, head.length--;
    ewa_text_layout layout = {.words = true};
    const char *const separators = ";,\t";
    for (const char *c = separators; *c && !layout.separator; c++)
        if (memchr(head.chars, *c, head.length)) layout.separator = *c;
    return ewa_text_split(&layout, head, words, EWA_ROWS_MAX_COLUMNS);
}

bool ewa_text_head_has_place(ewa_text head) {
    ewa_text words[EWA_ROWS_MAX_COLUMNS];
    const uint32_t count = split_head(head, words);
    uint32_t found = 0;
    for (uint32_t i = 0; i < count && i < EWA_ROWS_MAX_COLUMNS; i++) {
        ewa_text_column column = {.name = ""};
        name_column(&column, words[i]);
        if (strcmp(column.name, EWA_POSITION) == 0) found |= 1u << column.component;
    }
    return found == 7;
}

bool ewa_text_columns_from_head(const ewa_text_begin *begin, ewa_text_column *columns) {
    ewa_text words[EWA_ROWS_MAX_COLUMNS];
    const uint32_t count = split_head(begin->head, words), column_count = begin->layout.column_count;
    if (count > column_count || count < 3) return false;
    for (uint32_t i = 0; i < column_count; i++) {
        char text[24];
        const int length = snprintf(text, sizeof text, "c%u", i + 1);
        columns[i] = (ewa_text_column){.name = ""};
        if (i < count)
            name_column(&columns[i], words[i]);
        else
            set_scalar(&columns[i], (ewa_text){text, (size_t)length});
    }
    // A remark that happens to have as many words says nothing; a head of its own does.
    return !begin->head_is_comment || has_place(columns, column_count);
}

ewa_status ewa_text_columns_from_options(const ewa_cloud_source *source, uint32_t column_count,
                                         ewa_text_column *columns) {
    const char *list = source->options->columns;
    const ewa_text_layout layout = {.separator = ',', .words = true};
    ewa_text words[EWA_ROWS_MAX_COLUMNS];
    const uint32_t count =
        ewa_text_split(&layout, (ewa_text){list, strlen(list)}, words, EWA_ROWS_MAX_COLUMNS);
    if (count > column_count)
        return ewa_fail(source->context, EWA_ERROR_ARGUMENT, "%s: columns '%s' are %u, but lines have %u",
                        source->name, list, count, column_count);
    for (uint32_t i = 0; i < column_count; i++) {
        columns[i] = (ewa_text_column){.name = ""};
        if (i < count) name_column(&columns[i], words[i]);
    }
    return EWA_OK;
}

// ---- names by numbers ------------------------------------------------------------------------------------

/// A sample of rows.
typedef struct table {
    const double *numbers;
    uint32_t row_count, column_count;
} table;

static double cell(const table *t, uint32_t row, uint32_t column) {
    return t->numbers[(size_t)row * t->column_count + column];
}

/// Whether three columns are unit vectors, or nothing at all, in nearly every row.
static bool is_normal(const table *t, uint32_t first) {
    if (first + 3 > t->column_count) return false;
    uint32_t unit = 0, zero = 0;
    for (uint32_t row = 0; row < t->row_count; row++) {
        double squares = 0;
        for (uint32_t c = 0; c < 3; c++) squares += cell(t, row, first + c) * cell(t, row, first + c);
        unit += fabs(sqrt(squares) - 1) < 0.02;
        zero += !(squares > 0);
    }
    return unit > 0 && 20 * (uint64_t)(unit + zero) >= 19 * (uint64_t)t->row_count;
}

/// Whether three columns are colours: whole numbers from 0 to `maximum`, or numbers from 0 to 1.
static bool is_color(const table *t, uint32_t first, double maximum) {
    if (first + 3 > t->column_count) return false;
    bool whole = true, share = true;
    for (uint32_t row = 0; row < t->row_count; row++)
        for (uint32_t c = 0; c < 3; c++) {
            const double value = cell(t, row, first + c);
            whole = whole && value >= 0 && value <= maximum && value == floor(value);
            share = share && value >= 0 && value <= 1;
        }
    return whole || share;
}

/// Whether seven columns are x y z r g b a: colours and an alpha that is full in every row, as CloudCompare writes them. Green or red have to
/// differ somewhere: what is white all over has an intensity.
static bool has_alpha(const table *t) {
    enum { RED = 3, GREEN = 4, ALPHA = 6, LEAST_ROWS = 3 };
    if (t->column_count != 7 || t->row_count < LEAST_ROWS || !is_color(t, RED, UINT8_MAX)) return false;
    const double full = cell(t, 0, ALPHA);
    bool differ = false;
    for (uint32_t row = 0; row < t->row_count; row++) {
        if (cell(t, row, ALPHA) != full) return false;
        differ = differ || cell(t, row, RED) != cell(t, 0, RED) || cell(t, row, GREEN) != cell(t, 0, GREEN);
    }
    return differ && (full == UINT8_MAX || full == 1);
}

/// Whether the fourth column is an intensity: alone, or before normals or colours. Seven columns that could be
/// both are x y z i r g b, the order of PTS; more are x y z r g b and others.
static bool has_intensity(const table *t) {
    if (t->column_count == 4) return true;
    if (has_alpha(t)) return false;
    if (t->column_count == 7) return is_normal(t, 4) || is_color(t, 4, UINT16_MAX);
    return t->column_count > 7 && is_color(t, 4, UINT16_MAX) && !is_color(t, 3, UINT8_MAX);
}

void ewa_text_columns_from_numbers(const double *sample, uint32_t row_count, uint32_t column_count,
                                   ewa_text_column *columns) {
    const table t = {sample, row_count, column_count};
    bool normal = false, color = false;
    for (uint32_t i = 0; i < column_count; i++) columns[i] = (ewa_text_column){.name = ""};
    for (uint32_t i = 0; i < column_count;) {
        const char *attribute = NULL;
        const bool intensity = i == 3 && has_intensity(&t);
        if (i == 0) {
            attribute = EWA_POSITION;
        } else if (!normal && column_count >= 6 && is_normal(&t, i)) {
            attribute = EWA_NORMAL;
            normal = true;
        } else if (!color && !intensity && column_count >= 6 && is_color(&t, i, UINT16_MAX)) {
            attribute = EWA_COLOR;
            color = true;
        }
        if (attribute) {
            for (uint32_t c = 0; c < 3; c++) set_column(&columns[i + c], attribute, c);
            i += 3;
            continue;
        }
        if (i == 6 && has_alpha(&t))
            set_column(&columns[i], EWA_COLOR, 3);
        else if (intensity)
            set_column(&columns[i], "intensity", 0);
        else
            snprintf(columns[i].name, sizeof columns[i].name, "c%u", i + 1);
        i++;
    }
}

// ---- whatever they were named by -------------------------------------------------------------------------

/// What an attribute has to have: so many of its components.
static const struct {
    const char *name;
    uint32_t minimum, maximum;
} groups[] = {{EWA_POSITION, 3, 3},  {EWA_NORMAL, 3, 3}, {EWA_COLOR, 3, 4}, {EWA_TANGENT_U, 3, 3},
              {EWA_TANGENT_V, 3, 3}, {EWA_CLIP0, 3, 3},  {EWA_CLIP1, 3, 3}, {EWA_BORDER, 3, 3}};

/// Makes a scalar of a column, called what the head calls it.
static void demote(ewa_text_column *column, uint32_t index) {
    char text[24];
    const int length = snprintf(text, sizeof text, "c%u", index + 1);
    set_scalar(column, column->word.length ? column->word : (ewa_text){text, (size_t)length});
}

static bool is_group(const char *name) {
    for (size_t g = 0; g < sizeof groups / sizeof groups[0]; g++)
        if (strcmp(groups[g].name, name) == 0) return true;
    return false;
}

/// Whether an earlier column has this name and component.
static bool is_taken(const ewa_text_column *columns, uint32_t index) {
    for (uint32_t k = 0; k < index; k++)
        if (strcmp(columns[k].name, columns[index].name) == 0 &&
            columns[k].component == columns[index].component)
            return true;
    return false;
}

/// Gives a column another name if an earlier one has its name, or if the name is that of an attribute of
/// several components.
static void make_distinct(ewa_text_column *columns, uint32_t index) {
    ewa_text_column *column = &columns[index];
    if (!column->name[0]) return;
    char plain[EWA_NAME_BYTES - 12];
    snprintf(plain, sizeof plain, "%.*s", (int)sizeof plain - 1, column->name);
    for (uint32_t n = 2; is_taken(columns, index) || is_group(column->name); n++)
        snprintf(column->name, sizeof column->name, "%s_%u", plain, n);
}

ewa_status ewa_text_columns_finish(const ewa_cloud_source *source, uint32_t column_count,
                                   ewa_text_column *columns) {
    bool grouped[EWA_ROWS_MAX_COLUMNS] = {false};
    for (size_t g = 0; g < sizeof groups / sizeof groups[0]; g++) {
        uint32_t found = 0;
        for (uint32_t i = 0; i < column_count; i++) {
            if (strcmp(columns[i].name, groups[g].name) != 0) continue;
            const bool named = columns[i].word.length == 0 || !ewa_text_is(columns[i].word, groups[g].name);
            if (!named) continue; // a scalar that happens to have that name
            char quote[EWA_QUOTE_BYTES];
            if (found & 1u << columns[i].component)
                return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: two columns are %s (%c of %s)",
                                source->name, ewa_quote(columns[i].word, quote), "xyzw"[columns[i].component],
                                groups[g].name);
            found |= 1u << columns[i].component;
            grouped[i] = true;
        }
        const uint32_t minimum = (1u << groups[g].minimum) - 1;
        if ((found & minimum) == minimum) continue;
        if (g == 0)
            return ewa_fail(source->context, EWA_ERROR_FORMAT,
                            "%s: none of the %u columns is called %s; columns=x,y,z,... tells which are what",
                            source->name, column_count, found & 1 ? found & 2 ? "z" : "y" : "x");
        for (uint32_t i = 0; i < column_count; i++)
            if (grouped[i] && strcmp(columns[i].name, groups[g].name) == 0) {
                grouped[i] = false;
                demote(&columns[i], i);
            }
    }
    for (uint32_t i = 0; i < column_count; i++)
        if (!grouped[i]) make_distinct(columns, i);
    return EWA_OK;
}
