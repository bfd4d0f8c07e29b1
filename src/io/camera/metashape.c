// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras as Metashape exports them, cameras.xml: sensors with their lenses, cameras that refer to them, and the map of their
// space to the world.
// By: Agisoft Metashape User Manual, Professional Edition, 2.1, appendix D (camera models).
#include "base/base.h"
#include "io/camera/file.h"
#include "io/number.h"
#include "io/volume/xml_tags.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WORD_BYTES = 256,
    MAX_SENSORS = 4096,
    SENSOR_STEP = 8, ///< of memory
    MATRIX = 16,
};

/// Numbers of a calibration.
enum { F, CX, CY, B1, B2, K1, K2, K3, K4, P1, P2, P3, P4, NUMBERS };

static const char *const names[NUMBERS] = {"f", "cx", "cy", "b1", "b2", "k1", "k2", "k3", "k4", "p1", "p2", "p3", "p4"};

typedef struct sensor {
    char id[WORD_BYTES], kind[WORD_BYTES];
    double width_px, height_px;
    double numbers[NUMBERS];
} sensor;

/// Where a map to the world stands.
typedef struct map {
    double rotation[9], translation[3], scale;
    bool found;
} map;

typedef struct camera {
    char sensor_id[WORD_BYTES], label[WORD_BYTES];
    bool enabled;
    double matrix[MATRIX]; ///< of its space to the chunk's
    bool placed;
} camera;

typedef struct loader {
    ewa_camera_list *list;
    const char *at, *end;
    sensor *sensors;
    size_t sensor_count;
    map to_world;
    char component_id[WORD_BYTES]; ///< of the cameras that the map is of; empty: all
    uint32_t unplaced_count;
    bool warned; ///< of distortion
} loader;

static ewa_status fail(const loader *in, ewa_status status, const char *what, const char *word) {
    char quote[EWA_QUOTE_BYTES];
    return ewa_fail(in->list->context, status, "%s: %s %s", in->list->name, what,
                    ewa_quote((ewa_text){word, strlen(word)}, quote));
}

/// Reads numbers of the text that follows a tag; false unless there are just so many, all finite.
static bool read_numbers(const loader *in, const ewa_xml_tag *tag, int count, double *numbers) {
    const char *at = tag->end + 1;
    for (int i = 0; i <= count; i++) {
        while (at < in->end && strchr(" \t\r\n", *at)) at++;
        if (i == count) break;
        at = ewa_number_read_f64(at, in->end, &numbers[i]);
        if (!at || !isfinite(numbers[i])) return false;
    }
    return at < in->end && *at == '<';
}

/// Steps to the next tag within an element; false behind its end, or that of the file.
static bool next_within(loader *in, const char *element, ewa_xml_tag *tag) {
    return ewa_xml_next(&in->at, in->end, tag) && !(tag->closing && ewa_xml_is(tag, element));
}

/// Whether a tag is all of its element: <resolution width="1" height="1"/>.
static bool is_alone(const ewa_xml_tag *tag) { return tag->end[-1] == '/'; }

static double read_attribute(const ewa_xml_tag *tag, const char *name) {
    char text[WORD_BYTES];
    double value = NAN;
    if (ewa_xml_attribute(tag, name, text, sizeof text)) ewa_number_read_f64(text, text + strlen(text), &value);
    return value;
}

/// Reads one calibration; that which was adjusted comes after the one that was given, and counts.
static ewa_status read_calibration(loader *in, const ewa_xml_tag *open, sensor *to) {
    ewa_xml_tag tag;
    memset(to->numbers, 0, sizeof to->numbers);
    ewa_xml_attribute(open, "type", to->kind, sizeof to->kind);
    while (next_within(in, "calibration", &tag)) {
        if (tag.closing) continue;
        if (ewa_xml_is(&tag, "fx"))
            return fail(in, EWA_ERROR_UNSUPPORTED, "calibrations of PhotoScan before 1.3 are not read: element", "fx");
        for (int i = 0; i < NUMBERS; i++)
            if (ewa_xml_is(&tag, names[i]) && !read_numbers(in, &tag, 1, &to->numbers[i]))
                return fail(in, EWA_ERROR_FORMAT, "a number wanted in the element", names[i]);
    }
    return EWA_OK;
}

static ewa_status read_sensor(loader *in, const ewa_xml_tag *open) {
    if (in->sensor_count == MAX_SENSORS)
        return ewa_fail(in->list->context, EWA_ERROR_LIMIT, "%s: more than %d sensors", in->list->name, MAX_SENSORS);
    if (in->sensor_count % SENSOR_STEP == 0) {
        sensor *larger = ewa_allocate(in->list->context, in->sensor_count + SENSOR_STEP, sizeof *larger);
        if (!larger) return EWA_ERROR_MEMORY;
        if (in->sensor_count) memcpy(larger, in->sensors, in->sensor_count * sizeof *larger);
        ewa_release(in->list->context, in->sensors, in->sensor_count, sizeof *larger);
        in->sensors = larger;
    }
    sensor *to = &in->sensors[in->sensor_count++];
    ewa_xml_tag tag;
    memset(to, 0, sizeof *to);
    ewa_xml_attribute(open, "id", to->id, sizeof to->id);
    ewa_xml_attribute(open, "type", to->kind, sizeof to->kind);
    while (!is_alone(open) && next_within(in, "sensor", &tag)) {
        if (tag.closing) continue;
        if (ewa_xml_is(&tag, "resolution"))
            to->width_px = read_attribute(&tag, "width"), to->height_px = read_attribute(&tag, "height");
        if (ewa_xml_is(&tag, "calibration") && !is_alone(&tag)) EWA_TRY(read_calibration(in, &tag, to));
    }
    return EWA_OK;
}

/// Reads a map to the world: of a component, or of a chunk in files that know none.
static ewa_status read_map(loader *in) {
    map *to = &in->to_world;
    ewa_xml_tag tag;
    to->scale = 1;
    for (int i = 0; i < 9; i++) to->rotation[i] = i % 4 == 0;
    memset(to->translation, 0, sizeof to->translation);
    while (next_within(in, "transform", &tag)) {
        if (tag.closing) continue;
        if (ewa_xml_is(&tag, "rotation") && !read_numbers(in, &tag, 9, to->rotation))
            return fail(in, EWA_ERROR_FORMAT, "nine numbers wanted in the element", "rotation");
        if (ewa_xml_is(&tag, "translation") && !read_numbers(in, &tag, 3, to->translation))
            return fail(in, EWA_ERROR_FORMAT, "three numbers wanted in the element", "translation");
        if (ewa_xml_is(&tag, "scale") && !(read_numbers(in, &tag, 1, &to->scale) && to->scale > 0))
            return fail(in, EWA_ERROR_FORMAT, "a number above 0 wanted in the element", "scale");
    }
    to->found = true;
    return EWA_OK;
}

/// The lens of a sensor. Errors: EWA_ERROR_UNSUPPORTED.
static ewa_status find_lens(loader *in, const sensor *from, ewa_lens *lens) {
    const bool takes = in->list->takes_lenses, fisheye = strcmp(from->kind, "fisheye") == 0;
    const double *n = from->numbers;
    *lens = (ewa_lens){.model = fisheye ? EWA_LENS_FISHEYE : EWA_LENS_PINHOLE};
    if (!(fisheye && takes) && strcmp(from->kind, "frame") != 0)
        return fail(in, EWA_ERROR_UNSUPPORTED,
                    takes ? "a lens that is not undistorted here, of the type" : "a lens that is no pinhole, of the type",
                    from->kind);
    for (int i = B2; i < NUMBERS; i++) {
        const bool unknown = i == B2 || i >= P3 || (fisheye ? i == P1 || i == P2 : i == K4);
        if (n[i] == 0) continue;
        if (!fisheye) lens->model = EWA_LENS_BROWN;
        if (takes && unknown)
            return ewa_fail(in->list->context, EWA_ERROR_UNSUPPORTED, "%s: %s = %g of a lens of the type %s is not undistorted here",
                            in->list->name, names[i], n[i], from->kind);
        if (takes || in->warned) continue;
        ewa_report(in->list->context, EWA_SEVERITY_WARNING, "%s: lens distortion (%s = %g) is left out", in->list->name,
                   names[i], n[i]);
        in->warned = true;
    }
    memcpy(lens->radial, n + K1, (fisheye ? 4 : 3) * sizeof *n);
    lens->tangential[0] = n[P2], lens->tangential[1] = n[P1]; // OpenCV has them the other way round
    return EWA_OK;
}

static ewa_status add_camera(loader *in, const camera *from) {
    if (!from->enabled) return EWA_OK;
    if (!from->placed) {
        in->unplaced_count++;
        return EWA_OK;
    }
    const sensor *of = in->sensors, *const end = in->sensor_count ? in->sensors + in->sensor_count : of;
    while (of < end && strcmp(of->id, from->sensor_id) != 0) of++;
    if (of == end) return fail(in, EWA_ERROR_FORMAT, "a camera refers to a sensor that is missing:", from->sensor_id);
    ewa_lens lens;
    EWA_TRY(find_lens(in, of, &lens));
    const map *to = &in->to_world;
    ewa_camera made;
    double rotation[9] = {0}, centre[3];
    for (int r = 0; r < 3; r++) {
        centre[r] = to->translation[r];
        for (int c = 0; c < 4; c++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) sum += to->scale * to->rotation[3 * r + k] * from->matrix[4 * k + c];
            *(c < 3 ? &rotation[3 * r + c] : &centre[r]) += sum;
        }
    }
    ewa_camera_init(&made);
    made.width_px = of->width_px > 0 && of->width_px < UINT32_MAX ? (uint32_t)of->width_px : 0;
    made.height_px = of->height_px > 0 && of->height_px < UINT32_MAX ? (uint32_t)of->height_px : 0;
    made.fx_px = of->numbers[F] + of->numbers[B1], made.fy_px = of->numbers[F];
    made.cx_px = 0.5 * of->width_px + of->numbers[CX], made.cy_px = 0.5 * of->height_px + of->numbers[CY];
    ewa_camera_set_inverse(&made, rotation, centre);
    EWA_TRY(ewa_camera_list_add(in->list, from->label, &made));
    ewa_camera_list_set_lens(in->list, &lens);
    return from->label[0] ? ewa_camera_list_name(in->list, (ewa_text){from->label, strlen(from->label)}) : EWA_OK;
}

static ewa_status read_camera(loader *in, const ewa_xml_tag *open) {
    camera read = {.enabled = true};
    ewa_xml_tag tag;
    char enabled[WORD_BYTES] = "true", component[WORD_BYTES] = "";
    if (!ewa_xml_attribute(open, "sensor_id", read.sensor_id, sizeof read.sensor_id)) return EWA_OK; // of another list
    ewa_xml_attribute(open, "label", read.label, sizeof read.label);
    ewa_xml_attribute(open, "enabled", enabled, sizeof enabled);
    ewa_xml_attribute(open, "component_id", component, sizeof component);
    read.enabled = strcmp(enabled, "false") != 0 && strcmp(enabled, "0") != 0;
    while (!is_alone(open) && next_within(in, "camera", &tag)) {
        if (tag.closing || !ewa_xml_is(&tag, "transform")) continue;
        if (!read_numbers(in, &tag, MATRIX, read.matrix))
            return fail(in, EWA_ERROR_FORMAT, "sixteen numbers wanted in the transform of", read.label);
        read.placed = !component[0] || !in->component_id[0] || strcmp(component, in->component_id) == 0;
    }
    return add_camera(in, &read);
}

/// Passes over a camera.
static void skip_camera(loader *in, const ewa_xml_tag *open) {
    ewa_xml_tag tag;
    while (!is_alone(open) && next_within(in, "camera", &tag)) {}
}

/// Reads sensors and the map of the first chunk, which ends the file from then on. `*whole`: the document ends.
static ewa_status read_sensors(loader *in, bool *whole) {
    const char *chunk_end = NULL, *from = in->at;
    ewa_xml_tag tag;
    *whole = false;
    while (!*whole && ewa_xml_next(&in->at, in->end, &tag)) {
        if (tag.closing) {
            if (ewa_xml_is(&tag, "chunk") && !chunk_end) chunk_end = in->at;
            *whole = ewa_xml_is(&tag, "document");
        } else if (chunk_end) {
            continue;
        } else if (ewa_xml_is(&tag, "camera")) {
            skip_camera(in, &tag);
        } else if (ewa_xml_is(&tag, "sensor")) {
            EWA_TRY(read_sensor(in, &tag));
        } else if (ewa_xml_is(&tag, "component") && !in->to_world.found) {
            in->component_id[0] = 0;
            ewa_xml_attribute(&tag, "id", in->component_id, sizeof in->component_id);
        } else if (ewa_xml_is(&tag, "transform") && !in->to_world.found && !is_alone(&tag)) {
            EWA_TRY(read_map(in));
        }
    }
    *whole = *whole && chunk_end;
    if (*whole) in->end = chunk_end;
    in->at = from;
    return EWA_OK;
}

static ewa_status read_cameras(loader *in) {
    ewa_xml_tag tag;
    while (ewa_xml_next(&in->at, in->end, &tag))
        if (!tag.closing && ewa_xml_is(&tag, "camera")) EWA_TRY(read_camera(in, &tag));
    if (in->list->count == 0) return ewa_fail(in->list->context, EWA_ERROR_FORMAT, "%s: no camera of it is aligned", in->list->name);
    if (in->unplaced_count)
        ewa_report(in->list->context, EWA_SEVERITY_WARNING, "%s: %u cameras are left out, which are not aligned with the others",
                   in->list->name, in->unplaced_count);
    return EWA_OK;
}

ewa_status ewa_camera_list_read_metashape(ewa_camera_list *list, const uint8_t *bytes, size_t size_bytes) {
    loader in = {.list = list, .at = (const char *)bytes, .end = (const char *)bytes + size_bytes,
                 .to_world = {.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .scale = 1}};
    bool whole;
    ewa_status status = read_sensors(&in, &whole);
    if (status == EWA_OK && !whole)
        status = ewa_fail(list->context, EWA_ERROR_FORMAT, "%s: is XML, but no whole file of Metashape's cameras, <document> with a <chunk>", list->name);
    if (status == EWA_OK) status = read_cameras(&in);
    ewa_release(list->context, in.sensors, (in.sensor_count + SENSOR_STEP - 1) / SENSOR_STEP * SENSOR_STEP, sizeof *in.sensors);
    return status;
}
