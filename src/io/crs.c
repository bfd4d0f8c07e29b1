// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Units of coordinate reference systems, of well-known text in both versions, of codes that there is a text of, and of names
// that keys of GeoTIFF gave.
#include "io/crs.h"
#include "io/las/las_wkt.h"
#include "io/number.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name;
    uint32_t code; ///< of EPSG
    double length_m;
} lengths[] = {[EWA_CRS_METRES] = {"m", 9001, 1}, [EWA_CRS_FEET] = {"ft", 9002, 0.3048}, [EWA_CRS_US_FEET] = {"US ft", 9003, 1200.0 / 3937}};

enum { LENGTH_COUNT = sizeof lengths / sizeof lengths[0], MAX_DEPTH = 32 };

/// The two kinds of feet differ by 6e-7; texts have at least 12 digits of them.
static const double TOLERANCE = 1e-8;

const char *ewa_crs_unit_name(ewa_crs_unit unit) { return (unsigned)unit < LENGTH_COUNT ? lengths[unit].name : NULL; }

ewa_crs_unit ewa_crs_unit_of_code(uint32_t code) {
    for (int unit = EWA_CRS_METRES; unit < LENGTH_COUNT; unit++)
        if (lengths[unit].code == code) return (ewa_crs_unit)unit;
    return EWA_CRS_UNKNOWN;
}

/// What an element of the text is for its units.
typedef enum element {
    OTHER,
    AXES,       ///< its unit is that of what it stands in
    UNIT,       ///< of lengths, or, in the first version, of angles
    HORIZONTAL, ///< x and y, or all three
    VERTICAL,
    GEOGRAPHIC,
} element;

static element element_of(const char *word, size_t length) {
    static const struct {
        const char *word;
        element is;
    } known[] = {{"AXIS", AXES},           {"UNIT", UNIT},           {"LENGTHUNIT", UNIT},     {"PROJCS", HORIZONTAL},
                 {"PROJCRS", HORIZONTAL},  {"PROJECTEDCRS", HORIZONTAL}, {"LOCAL_CS", HORIZONTAL}, {"ENGCRS", HORIZONTAL},
                 {"GEOCCS", HORIZONTAL},   {"VERT_CS", VERTICAL},    {"VERTCRS", VERTICAL},    {"VERTICALCRS", VERTICAL},
                 {"GEOGCS", GEOGRAPHIC},   {"GEOGCRS", GEOGRAPHIC},  {"GEODCRS", GEOGRAPHIC}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (strlen(known[i].word) == length && strncmp(known[i].word, word, length) == 0) return known[i].is;
    return OTHER;
}

/// The unit whose element's inner text is given: its name, then its length.
static ewa_crs_unit read_unit(const char *text) {
    const char *at = text + strspn(text, " "), *end = *at == '"' ? strchr(at + 1, '"') : NULL;
    if (!end) return EWA_CRS_UNKNOWN;
    at = end + 1 + strspn(end + 1, " ,");
    double length_m;
    if (!ewa_number_read_f64(at, at + strlen(at), &length_m)) return EWA_CRS_UNKNOWN;
    for (int unit = EWA_CRS_METRES; unit < LENGTH_COUNT; unit++)
        if (fabs(length_m - lengths[unit].length_m) < TOLERANCE) return (ewa_crs_unit)unit;
    return EWA_CRS_UNKNOWN;
}

/// What a text says so far.
typedef struct units {
    bool projected, has_horizontal, has_vertical, geographic;
    ewa_crs_unit horizontal, vertical;
} units;

/// Takes a unit whose element stands in those of `depth`, the outermost first.
static void take_unit(const element *around, int depth, const char *text, units *said) {
    while (depth > 0 && around[depth - 1] == AXES) depth--;
    if (depth > 0 && around[depth - 1] == HORIZONTAL) {
        said->has_horizontal = true;
        said->horizontal = read_unit(text);
    } else if (depth > 0 && around[depth - 1] == VERTICAL) {
        said->has_vertical = true;
        said->vertical = read_unit(text);
    }
}

/// Heights in US feet over a plane in feet, as many surveys of the United States have them, are feet: no length that is shown
/// has digits for a difference of 2e-6.
static bool are_alike(ewa_crs_unit a, ewa_crs_unit b) {
    const bool feet_a = a == EWA_CRS_FEET || a == EWA_CRS_US_FEET, feet_b = b == EWA_CRS_FEET || b == EWA_CRS_US_FEET;
    return a == b || (feet_a && feet_b);
}

static ewa_crs_unit unit_of_text(const char *text) {
    element around[MAX_DEPTH];
    units said = {.projected = false};
    int depth = 0;
    const char *word = NULL;
    for (const char *at = text; *at; at++) {
        if (*at == '"') {
            at = strchr(at + 1, '"');
            if (!at) return EWA_CRS_UNKNOWN;
        } else if (*at == '[' || *at == '(') {
            const element is = word ? element_of(word, (size_t)(at - word)) : OTHER;
            if (depth == MAX_DEPTH) return EWA_CRS_UNKNOWN;
            if (is == UNIT) take_unit(around, depth, at + 1, &said);
            said.projected |= is == HORIZONTAL;
            said.geographic |= is == GEOGRAPHIC;
            around[depth++] = is;
        } else if ((*at == ']' || *at == ')') && depth) {
            depth--;
        }
        const bool in_word = (*at >= 'A' && *at <= 'Z') || *at == '_';
        word = !in_word ? NULL : word ? word : at;
    }
    if (said.geographic && !said.projected) return EWA_CRS_DEGREES;
    return said.has_vertical && !are_alike(said.vertical, said.horizontal) ? EWA_CRS_UNKNOWN : said.horizontal;
}

ewa_crs_unit ewa_cloud_crs_unit(const ewa_cloud *cloud) {
    const char *named = cloud ? ewa_cloud_note(cloud, "crs_unit", NULL) : NULL;
    for (int unit = EWA_CRS_METRES; named && unit < LENGTH_COUNT; unit++)
        if (strcmp(named, lengths[unit].name) == 0) return (ewa_crs_unit)unit;
    const char *crs = cloud ? ewa_cloud_note(cloud, "crs", NULL) : NULL;
    if (!crs) return EWA_CRS_UNKNOWN;
    if (strncmp(crs, "EPSG:", 5) != 0) return unit_of_text(crs);
    // Codes of geographic systems with two or three axes lie here, those of projected ones beside.
    if (crs[5] == '4' && strspn(crs + 5, "0123456789") == 4) return EWA_CRS_DEGREES;
    char text[EWA_LAS_WKT_BYTES];
    return ewa_las_wkt_make(crs + 5, text) ? unit_of_text(text) : EWA_CRS_UNKNOWN;
}
