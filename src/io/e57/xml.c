// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The XML part of E57 files: which scans there are, what their points consist of, where they stand. It is
// walked once, and only what is wanted of it is kept.
#include "io/e57/e57.h"
#include "io/number.h"
#include "io/text.h"

#include <expat.h>
#include <math.h>

enum {
    MAX_DEPTH = 32,
    MAX_TEXT_BYTES = 1 << 20,
};

/// Where in the tree an element is.
typedef enum node {
    NODE_TOP,
    NODE_ROOT,
    NODE_SCANS,
    NODE_SCAN,
    NODE_POSE,
    NODE_ROTATION,
    NODE_TRANSLATION,
    NODE_COLOR_LIMITS,
    NODE_INTENSITY_LIMITS,
    NODE_POINTS,
    NODE_PROTOTYPE,
    NODE_FIELD,
    NODE_IMAGES,
    NODE_NUMBER, ///< its text goes to `number`
    NODE_TEXT,   ///< its text goes to `kept`
    NODE_OTHER,
} node;

typedef struct walk {
    const ewa_e57_pages *pages;
    ewa_e57_contents *contents;
    XML_Parser parser;
    node path[MAX_DEPTH];
    uint32_t depth;
    ewa_status status;
    double *number;       ///< of the number being read
    double scale, offset; ///< of it
    ewa_buffer *kept;     ///< text being read
    size_t *kept_bytes;
    char digits[64]; ///< text of a number
    size_t digit_count;
} walk;

static void fail(walk *w, ewa_status status, const char *what, const char *name) {
    if (w->status != EWA_OK) return;
    char quote[EWA_QUOTE_BYTES];
    const ewa_cloud_source *source = w->pages->source;
    w->status = ewa_fail(source->context, status, "%s: XML, line %llu: %s %s", source->name,
                         (unsigned long long)XML_GetCurrentLineNumber(w->parser),
                         ewa_quote((ewa_text){name, strlen(name)}, quote), what);
    XML_StopParser(w->parser, XML_FALSE);
}

static const char *attribute(const char **attributes, const char *name) {
    for (; *attributes; attributes += 2)
        if (strcmp(attributes[0], name) == 0) return attributes[1];
    return NULL;
}

static double read_f64(const char *text, double otherwise) {
    double value;
    return text && ewa_number_read_f64(text, text + strlen(text), &value) ? value : otherwise;
}

/// Reads a whole number of 64 bits; false when it is none.
static bool read_i64(const char *text, int64_t *value) {
    const bool negative = *text == '-';
    uint64_t size = 0;
    text += negative || *text == '+';
    if (!*text) return false;
    for (; *text; text++)
        if (*text < '0' || *text > '9' || __builtin_mul_overflow(size, 10, &size) ||
            __builtin_add_overflow(size, (uint64_t)(*text - '0'), &size))
            return false;
    if (size > (uint64_t)INT64_MAX + negative) return false;
    *value = negative ? (int64_t)(0 - size) : (int64_t)size;
    return true;
}

static const struct {
    const char *name;
    ewa_e57_role role;
} roles[] = {
    {"cartesianX", EWA_E57_X},
    {"cartesianY", EWA_E57_Y},
    {"cartesianZ", EWA_E57_Z},
    {"sphericalRange", EWA_E57_RANGE},
    {"sphericalAzimuth", EWA_E57_AZIMUTH},
    {"sphericalElevation", EWA_E57_ELEVATION},
    {"cartesianInvalidState", EWA_E57_CARTESIAN_INVALID},
    {"sphericalInvalidState", EWA_E57_SPHERICAL_INVALID},
    {"colorRed", EWA_E57_RED},
    {"colorGreen", EWA_E57_GREEN},
    {"colorBlue", EWA_E57_BLUE},
    {"isColorInvalid", EWA_E57_COLOR_INVALID},
    {"intensity", EWA_E57_INTENSITY},
    {"isIntensityInvalid", EWA_E57_INTENSITY_INVALID},
    {"timeStamp", EWA_E57_TIME},
    {"isTimeStampInvalid", EWA_E57_TIME_INVALID},
    {"returnIndex", EWA_E57_RETURN_INDEX},
    {"returnCount", EWA_E57_RETURN_COUNT},
    {"rowIndex", EWA_E57_ROW},
    {"columnIndex", EWA_E57_COLUMN},
};

/// Fields of the extension for normals have any prefix.
static ewa_e57_role role_of(const char *name) {
    for (size_t i = 0; i < sizeof roles / sizeof roles[0]; i++)
        if (strcmp(name, roles[i].name) == 0) return roles[i].role;
    const char *colon = strchr(name, ':');
    if (colon && strncmp(colon + 1, "normal", 6) == 0 && colon[7] >= 'X' && colon[7] <= 'Z' && !colon[8])
        return (ewa_e57_role)(EWA_E57_NORMAL_X + (colon[7] - 'X'));
    return EWA_E57_OTHER;
}

/// Appends a field to the last scan.
static void add_field(walk *w, const char *name, const char **attributes) {
    ewa_e57_contents *c = w->contents;
    ewa_e57_scan *scan = ewa_e57_scan_at(c, c->scan_count - 1);
    const char *type = attribute(attributes, "type"), *precision = attribute(attributes, "precision");
    const char *minimum = attribute(attributes, "minimum"), *maximum = attribute(attributes, "maximum");
    ewa_e57_field field = {.role = role_of(name),
                           .minimum = INT64_MIN,
                           .maximum = INT64_MAX,
                           .scale = read_f64(attribute(attributes, "scale"), 1),
                           .offset = read_f64(attribute(attributes, "offset"), 0),
                           .low = -INFINITY,
                           .high = INFINITY};
    if (strlen(name) >= sizeof field.name || !ewa_text_is_name((ewa_text){name, strlen(name)})) {
        fail(w, EWA_ERROR_FORMAT, "is no name of a field", name);
        return;
    }
    memcpy(field.name, name, strlen(name) + 1);
    if (type && strcmp(type, "Float") == 0) {
        field.kind = EWA_E57_FLOAT;
        field.single = precision && strcmp(precision, "single") == 0;
        field.bits = field.single ? 32 : 64;
        field.low = read_f64(minimum, -INFINITY);
        field.high = read_f64(maximum, INFINITY);
    } else if (type && (strcmp(type, "Integer") == 0 || strcmp(type, "ScaledInteger") == 0)) {
        field.kind = *type == 'I' ? EWA_E57_INTEGER : EWA_E57_SCALED;
        if ((minimum && !read_i64(minimum, &field.minimum)) ||
            (maximum && !read_i64(maximum, &field.maximum)) || field.minimum > field.maximum) {
            fail(w, EWA_ERROR_FORMAT, "has a minimum and a maximum that are no range of whole numbers", name);
            return;
        }
        const uint64_t span = (uint64_t)field.maximum - (uint64_t)field.minimum;
        field.bits = span ? 64 - (uint32_t)__builtin_clzll(span) : 0;
        field.low = (double)field.minimum;
        field.high = (double)field.maximum;
        if (!isfinite(field.scale) || !isfinite(field.offset)) {
            fail(w, EWA_ERROR_FORMAT, "has a scale or an offset that is not finite", name);
            return;
        }
    } else {
        fail(w, EWA_ERROR_UNSUPPORTED, "is a field of a type that is not read", name);
        return;
    }
    if (scan->field_count == EWA_E57_MAX_FIELDS) {
        fail(w, EWA_ERROR_LIMIT, "is one field more than are read", name);
        return;
    }
    const ewa_status status = ewa_buffer_grow(w->pages->source->context, &c->fields, c->field_count,
                                              c->field_count + 1, sizeof field);
    if (status != EWA_OK) {
        w->status = status;
        XML_StopParser(w->parser, XML_FALSE);
        return;
    }
    ((ewa_e57_field *)c->fields.data)[c->field_count++] = field;
    scan->field_count++;
}

static void add_scan(walk *w) {
    ewa_e57_contents *c = w->contents;
    if (c->scan_count == EWA_E57_MAX_SCANS) {
        fail(w, EWA_ERROR_LIMIT, "is one scan more than are read", "vectorChild");
        return;
    }
    const ewa_status status = ewa_buffer_grow(w->pages->source->context, &c->scans, c->scan_count,
                                              c->scan_count + 1, sizeof(ewa_e57_scan));
    if (status != EWA_OK) {
        w->status = status;
        XML_StopParser(w->parser, XML_FALSE);
        return;
    }
    ewa_e57_scan scan = {.rotation = {1, 0, 0, 0}, .intensity = {NAN, NAN}};
    for (int i = 0; i < 3; i++) scan.color[i] = (ewa_e57_limits){NAN, NAN};
    *ewa_e57_scan_at(c, c->scan_count++) = scan;
}

static void begin_points(walk *w, const char **attributes) {
    ewa_e57_scan *scan = ewa_e57_scan_at(w->contents, w->contents->scan_count - 1);
    const char *offset = attribute(attributes, "fileOffset"), *count = attribute(attributes, "recordCount");
    int64_t file_offset = 0, record_count = 0;
    if (scan->has_points || !offset || !read_i64(offset, &file_offset) || file_offset < 0 ||
        (count && (!read_i64(count, &record_count) || record_count < 0))) {
        fail(w, EWA_ERROR_FORMAT, "has no place or no number of points, or comes twice", "points");
        return;
    }
    scan->has_points = true;
    scan->file_offset = (uint64_t)file_offset;
    scan->record_count = (uint64_t)record_count;
    scan->first_field = w->contents->field_count;
}

static node begin_number(walk *w, double *number, const char **attributes) {
    if (!number) return NODE_OTHER;
    w->number = number;
    w->scale = read_f64(attribute(attributes, "scale"), 1);
    w->offset = read_f64(attribute(attributes, "offset"), 0);
    w->digit_count = 0;
    return NODE_NUMBER;
}

static node begin_text(walk *w, ewa_buffer *kept, size_t *kept_bytes) {
    w->kept = kept;
    w->kept_bytes = kept_bytes;
    *kept_bytes = 0;
    return NODE_TEXT;
}

static double *limit_of(ewa_e57_scan *scan, const char *name) {
    static const char *const names[] = {"colorRed", "colorGreen", "colorBlue"};
    for (int i = 0; i < 4; i++) {
        const char *begin = i < 3 ? names[i] : "intensity";
        ewa_e57_limits *limits = i < 3 ? &scan->color[i] : &scan->intensity;
        const size_t length = strlen(begin);
        if (strncmp(name, begin, length) != 0) continue;
        if (strcmp(name + length, "Minimum") == 0) return &limits->low;
        if (strcmp(name + length, "Maximum") == 0) return &limits->high;
    }
    return NULL;
}

static node begin_in_scan(walk *w, const char *name, const char **attributes) {
    ewa_e57_scan *scan = ewa_e57_scan_at(w->contents, w->contents->scan_count - 1);
    if (strcmp(name, "colorLimits") == 0) return NODE_COLOR_LIMITS;
    if (strcmp(name, "intensityLimits") == 0) return NODE_INTENSITY_LIMITS;
    if (strcmp(name, "pose") == 0) {
        scan->has_pose = true;
        return NODE_POSE;
    }
    if (strcmp(name, "points") != 0) return NODE_OTHER;
    begin_points(w, attributes);
    return NODE_POINTS;
}

static node begin_in_root(walk *w, const char *name) {
    ewa_e57_contents *c = w->contents;
    if (strcmp(name, "data3D") == 0) return NODE_SCANS;
    if (strcmp(name, "images2D") == 0) return NODE_IMAGES;
    if (strcmp(name, "guid") == 0) return begin_text(w, &c->guid, &c->guid_bytes);
    if (strcmp(name, "e57LibraryVersion") == 0) return begin_text(w, &c->library, &c->library_bytes);
    if (strcmp(name, "coordinateMetadata") == 0) return begin_text(w, &c->crs, &c->crs_bytes);
    return NODE_OTHER;
}

static node begin_in(walk *w, node parent, const char *name, const char **attributes) {
    ewa_e57_contents *c = w->contents;
    ewa_e57_scan *scan = c->scan_count ? ewa_e57_scan_at(c, c->scan_count - 1) : NULL;
    switch (parent) {
    case NODE_TOP:
        if (strcmp(name, "e57Root") != 0) fail(w, EWA_ERROR_FORMAT, "is not the root of an E57 file", name);
        return NODE_ROOT;
    case NODE_ROOT:
        return begin_in_root(w, name);
    case NODE_SCANS:
        add_scan(w);
        return NODE_SCAN;
    case NODE_IMAGES:
        c->image_count++;
        return NODE_OTHER;
    case NODE_SCAN:
        return begin_in_scan(w, name, attributes);
    case NODE_POSE:
        return strcmp(name, "rotation") == 0      ? NODE_ROTATION
               : strcmp(name, "translation") == 0 ? NODE_TRANSLATION
                                                  : NODE_OTHER;
    case NODE_ROTATION:
        return !name[0] || name[1] || *name < 'w' || *name > 'z'
                   ? NODE_OTHER
                   : begin_number(w, &scan->rotation[*name - 'w'], attributes);
    case NODE_TRANSLATION:
        return !name[0] || name[1] || *name < 'x' || *name > 'z'
                   ? NODE_OTHER
                   : begin_number(w, &scan->translation_world[*name - 'x'], attributes);
    case NODE_COLOR_LIMITS:
    case NODE_INTENSITY_LIMITS:
        return begin_number(w, limit_of(scan, name), attributes);
    case NODE_POINTS:
        return strcmp(name, "prototype") == 0 ? NODE_PROTOTYPE : NODE_OTHER;
    case NODE_PROTOTYPE:
        add_field(w, name, attributes);
        return NODE_FIELD;
    default:
        return NODE_OTHER;
    }
}

static void begin_element(void *user, const char *name, const char **attributes) {
    walk *w = user;
    if (w->status != EWA_OK) return;
    if (w->depth == MAX_DEPTH) {
        fail(w, EWA_ERROR_LIMIT, "lies too deep", name);
        return;
    }
    const node made = begin_in(w, w->depth ? w->path[w->depth - 1] : NODE_TOP, name, attributes);
    w->path[w->depth++] = made;
}

static void end_element(void *user, const char *name) {
    walk *w = user;
    if (w->status != EWA_OK) return;
    const node ended = w->path[--w->depth];
    if (ended != NODE_NUMBER) return;
    ewa_cursor cursor = {w->digits, w->digits + w->digit_count, 1};
    while (cursor.at < cursor.end && (ewa_is_blank(*cursor.at) || ewa_is_line_end(*cursor.at))) cursor.at++;
    double value = 0; // an element without text is 0
    if (cursor.at < cursor.end && !ewa_number_read_f64(cursor.at, cursor.end, &value))
        fail(w, EWA_ERROR_FORMAT, "is no number", name);
    *w->number = value * w->scale + w->offset;
}

static void read_text(void *user, const char *text, int length) {
    walk *w = user;
    if (w->status != EWA_OK || !w->depth) return;
    const node at = w->path[w->depth - 1];
    const size_t size = (size_t)length;
    if (at == NODE_NUMBER) {
        const size_t room = sizeof w->digits - w->digit_count, taken = size < room ? size : room;
        memcpy(w->digits + w->digit_count, text, taken);
        w->digit_count += taken;
    } else if (at == NODE_TEXT) {
        if (*w->kept_bytes + size > MAX_TEXT_BYTES) {
            fail(w, EWA_ERROR_LIMIT, "begins a text that is too long", "");
            return;
        }
        w->status =
            ewa_buffer_grow(w->pages->source->context, w->kept, *w->kept_bytes, *w->kept_bytes + size, 1);
        if (w->status != EWA_OK) {
            XML_StopParser(w->parser, XML_FALSE);
            return;
        }
        memcpy((char *)w->kept->data + *w->kept_bytes, text, size);
        *w->kept_bytes += size;
    }
}

/// E57 has no document types, and with them no entities that grow.
static void refuse_document_type(void *user, const char *name, const char *system, const char *public_id,
                                 int has_subset) {
    (void)system;
    (void)public_id;
    (void)has_subset;
    fail(user, EWA_ERROR_FORMAT, "is a document type, which E57 does not have", name);
}

static ewa_status parse(walk *w, uint64_t logical, uint64_t size_bytes) {
    const ewa_cloud_source *source = w->pages->source;
    while (w->status == EWA_OK) {
        uint64_t piece_bytes = 0;
        const uint8_t *piece = size_bytes ? ewa_e57_piece(w->pages, logical, size_bytes, &piece_bytes) : NULL;
        const bool last = piece_bytes == size_bytes;
        if (XML_Parse(w->parser, (const char *)piece, (int)piece_bytes, last) != XML_STATUS_OK &&
            w->status == EWA_OK)
            w->status = ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: XML, line %llu: %s", source->name,
                                 (unsigned long long)XML_GetCurrentLineNumber(w->parser),
                                 XML_ErrorString(XML_GetErrorCode(w->parser)));
        if (last) break;
        logical += piece_bytes;
        size_bytes -= piece_bytes;
    }
    return w->status;
}

ewa_status ewa_e57_xml_read(const ewa_e57_pages *pages, uint64_t logical, uint64_t size_bytes,
                            ewa_e57_contents *contents) {
    const ewa_cloud_source *source = pages->source;
    const uint64_t there = pages->page_count * pages->payload_bytes;
    *contents = (ewa_e57_contents){.scan_count = 0};
    if (logical > there || size_bytes > there - logical)
        return ewa_fail(source->context, EWA_ERROR_FORMAT, "%s: the XML of %llu bytes is not all there",
                        source->name, (unsigned long long)size_bytes);
    walk *w = ewa_allocate_zeroed(source->context, 1, sizeof *w);
    if (!w) return EWA_ERROR_MEMORY;
    w->pages = pages;
    w->contents = contents;
    w->parser = XML_ParserCreate(NULL);
    if (!w->parser) {
        ewa_release(source->context, w, 1, sizeof *w);
        return ewa_fail(source->context, EWA_ERROR_MEMORY, "%s: no memory for the XML", source->name);
    }
    XML_SetUserData(w->parser, w);
    XML_SetElementHandler(w->parser, begin_element, end_element);
    XML_SetCharacterDataHandler(w->parser, read_text);
    XML_SetStartDoctypeDeclHandler(w->parser, refuse_document_type);
    const ewa_status status = parse(w, logical, size_bytes);
    XML_ParserFree(w->parser);
    ewa_release(source->context, w, 1, sizeof *w);
    return status;
}

void ewa_e57_contents_free(ewa_context *context, ewa_e57_contents *contents) {
    ewa_buffer_free(context, &contents->scans);
    ewa_buffer_free(context, &contents->fields);
    ewa_buffer_free(context, &contents->guid);
    ewa_buffer_free(context, &contents->library);
    ewa_buffer_free(context, &contents->crs);
}
