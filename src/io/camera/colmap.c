// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Cameras of a COLMAP model, text and binary: lenses in one file, poses that refer to them in another.
// Based on: J. L. Schoenberger, COLMAP documentation, "Output Format" (cameras, images).
#include "base/base.h"
#include "base/platform.h"
#include "io/camera/file.h"
#include "io/number.h"
#include "io/reader.h"
#include "io/referenced_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAX_PARAMETERS = 12,
    LENS_MIN_BYTES = 24,  // id, model, width, height
    IMAGE_MIN_BYTES = 73, // id, pose, lens, empty name, no points
    POINT_BYTES = 24,     // x, y, id
    WHERE_BYTES = 64,
};

/// A camera model: how many parameters, how many focal lengths lead them (the principal point follows, then the
/// distortion, whose numbers go to `places` of k1 to k6, p1, p2), and what they mean. Fisheyes are no pinholes when the
/// distortion is left out.
typedef struct model {
    const char *name;
    uint8_t parameter_count, focal_count;
    ewa_lens_model lens;
    bool unknown; ///< not undistorted
    uint8_t places[8];
} model;

enum { P1 = 6, P2 = 7 };

static const model MODELS[] = {
    {"SIMPLE_PINHOLE", 3, 1, EWA_LENS_PINHOLE, false, {0}},
    {"PINHOLE", 4, 2, EWA_LENS_PINHOLE, false, {0}},
    {"SIMPLE_RADIAL", 4, 1, EWA_LENS_BROWN, false, {0}},
    {"RADIAL", 5, 1, EWA_LENS_BROWN, false, {0, 1}},
    {"OPENCV", 8, 2, EWA_LENS_BROWN, false, {0, 1, P1, P2}},
    {"OPENCV_FISHEYE", 8, 2, EWA_LENS_FISHEYE, false, {0, 1, 2, 3}},
    {"FULL_OPENCV", 12, 2, EWA_LENS_BROWN, false, {0, 1, P1, P2, 2, 3, 4, 5}},
    {"FOV", 5, 2, EWA_LENS_FISHEYE, true, {0}},
    {"SIMPLE_RADIAL_FISHEYE", 4, 1, EWA_LENS_FISHEYE, false, {0}},
    {"RADIAL_FISHEYE", 5, 1, EWA_LENS_FISHEYE, false, {0, 1}},
    {"THIN_PRISM_FISHEYE", 12, 2, EWA_LENS_FISHEYE, true, {0}},
};

enum { MODEL_COUNT = sizeof MODELS / sizeof MODELS[0] };

typedef struct lens {
    uint32_t id;
    uint32_t width_px, height_px;
    double fx_px, fy_px, cx_px, cy_px;
    ewa_lens distortion;
} lens;

typedef struct loader {
    ewa_camera_list *list;
    lens *lenses; // sorted by id once all are read
    size_t lens_count, lens_capacity;
    bool warned; // of distortion
} loader;

static ewa_status fail_at(const loader *in, const char *file, const char *unit, uint64_t place,
                          const char *what) {
    return ewa_fail(in->list->context, EWA_ERROR_FORMAT, "%s/%s: %s %llu: %s", in->list->name, file, unit,
                    (unsigned long long)place, what);
}

static ewa_status reserve_lenses(loader *in, size_t capacity) {
    lens *larger = ewa_allocate(in->list->context, capacity, sizeof *larger);
    if (!larger) return EWA_ERROR_MEMORY;
    if (in->lens_count) memcpy(larger, in->lenses, in->lens_count * sizeof *larger);
    ewa_release(in->list->context, in->lenses, in->lens_capacity, sizeof *larger);
    in->lenses = larger;
    in->lens_capacity = capacity;
    return EWA_OK;
}

static ewa_status add_lens(loader *in, uint32_t id, const model *kind, uint64_t width, uint64_t height,
                           const double *parameters) {
    const bool takes = in->list->takes_lenses;
    if (takes ? kind->unknown : kind->lens == EWA_LENS_FISHEYE)
        return ewa_fail(in->list->context, EWA_ERROR_UNSUPPORTED, "%s: camera %u is of the model %s, %s", in->list->name, id,
                        kind->name, takes ? "which is not undistorted here" : "not a pinhole");
    const int first = kind->focal_count + 2;
    ewa_lens distortion = {.model = kind->lens};
    for (int i = first; i < kind->parameter_count; i++) {
        const uint8_t place = kind->places[i - first];
        *(place < P1 ? &distortion.radial[place] : &distortion.tangential[place - P1]) = parameters[i];
        if (takes && !isfinite(parameters[i]))
            return ewa_fail(in->list->context, EWA_ERROR_FORMAT, "%s: camera %u: parameter %d is %g", in->list->name, id, i,
                            parameters[i]);
        if (takes || in->warned || parameters[i] == 0) continue;
        ewa_report(in->list->context, EWA_SEVERITY_WARNING, "%s: lens distortion of camera %u (%s) is left out",
                   in->list->name, id, kind->name);
        in->warned = true;
    }
    if (in->lens_count == in->lens_capacity) {
        EWA_TRY(reserve_lenses(in, in->lens_capacity ? 2 * in->lens_capacity : 8));
    }
    // What does not fit stays out of range, for the check of the whole camera to name.
    in->lenses[in->lens_count++] = (lens){
        .id = id,
        .width_px = width > UINT32_MAX ? UINT32_MAX : (uint32_t)width,
        .height_px = height > UINT32_MAX ? UINT32_MAX : (uint32_t)height,
        .fx_px = parameters[0],
        .fy_px = parameters[kind->focal_count - 1],
        .cx_px = parameters[kind->focal_count],
        .cy_px = parameters[kind->focal_count + 1],
        .distortion = distortion,
    };
    return EWA_OK;
}

static int compare_lenses(const void *a, const void *b) {
    const uint32_t left = ((const lens *)a)->id, right = ((const lens *)b)->id;
    return left < right ? -1 : left > right;
}

/// `pose` is the quaternion w x y z of world to camera, then its translation.
static ewa_status add_image(loader *in, uint32_t image_id, const double pose[7], uint32_t lens_id, ewa_text picture) {
    char where[WHERE_BYTES];
    snprintf(where, sizeof where, "image %u", image_id);
    const lens key = {.id = lens_id};
    const lens *found =
        in->lens_count ? bsearch(&key, in->lenses, in->lens_count, sizeof key, compare_lenses) : NULL;
    if (!found)
        return ewa_fail(in->list->context, EWA_ERROR_FORMAT, "%s: %s refers to camera %u, which is missing",
                        in->list->name, where, lens_id);
    const double length = sqrt(pose[0] * pose[0] + pose[1] * pose[1] + pose[2] * pose[2] + pose[3] * pose[3]);
    const double w = pose[0] / length, x = pose[1] / length, y = pose[2] / length, z = pose[3] / length;
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = found->width_px;
    camera.height_px = found->height_px;
    camera.fx_px = found->fx_px;
    camera.fy_px = found->fy_px;
    camera.cx_px = found->cx_px;
    camera.cy_px = found->cy_px;
    const double rows[12] = {
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     pose[4],
        2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     pose[5],
        2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), pose[6],
    };
    memcpy(camera.world_to_camera, rows, sizeof rows);
    EWA_TRY(ewa_camera_list_add(in->list, where, &camera));
    ewa_camera_list_set_lens(in->list, &found->distortion);
    return picture.length ? ewa_camera_list_name(in->list, picture) : EWA_OK;
}

/// The words of one line.
typedef struct line {
    const char *next, *end;
    uint64_t number; // from 1
} line;

/// Takes the next line of a text; false at the end.
static bool next_line(ewa_reader *text, line *taken) {
    const uint64_t left = ewa_reader_left(text);
    if (left == 0) return false;
    const uint8_t *first = text->bytes + text->at_bytes, *feed = memchr(first, '\n', (size_t)left);
    const uint64_t length = feed ? (uint64_t)(feed - first) : left;
    text->at_bytes += length + (feed != NULL);
    *taken = (line){(const char *)first, (const char *)first + length, taken->number + 1};
    return true;
}

static void skip_blank(line *at) {
    while (at->next < at->end && (*at->next == ' ' || *at->next == '\t' || *at->next == '\r')) at->next++;
}

static bool is_comment(line at) {
    skip_blank(&at);
    return at.next == at.end || *at.next == '#';
}

static bool take_word(line *at, const char **word, size_t *length) {
    skip_blank(at);
    *word = at->next;
    while (at->next < at->end && *at->next != ' ' && *at->next != '\t' && *at->next != '\r') at->next++;
    *length = (size_t)(at->next - *word);
    return *length > 0;
}

/// Takes a number that fills its word.
static bool take_f64(line *at, double *value) {
    const char *word;
    size_t length;
    return take_word(at, &word, &length) && ewa_number_read_f64(word, word + length, value) == word + length;
}

static bool take_u32(line *at, uint32_t *value) {
    const char *word;
    size_t length;
    int64_t wide = 0;
    if (!take_word(at, &word, &length) || ewa_number_read_i64(word, word + length, &wide) != word + length ||
        wide < 0 || wide > UINT32_MAX)
        return false;
    *value = (uint32_t)wide;
    return true;
}

static const model *take_model(line *at) {
    const char *word;
    size_t length;
    if (!take_word(at, &word, &length)) return NULL;
    for (int i = 0; i < MODEL_COUNT; i++)
        if (strlen(MODELS[i].name) == length && memcmp(MODELS[i].name, word, length) == 0) return &MODELS[i];
    return NULL;
}

static ewa_status read_text_lenses(loader *in, ewa_reader text) {
    line at = {.number = 0};
    while (next_line(&text, &at)) {
        if (is_comment(at)) continue;
        uint32_t id, width, height;
        double parameters[MAX_PARAMETERS];
        if (!take_u32(&at, &id)) return fail_at(in, "cameras.txt", "line", at.number, "camera id wanted");
        const model *kind = take_model(&at);
        if (!kind) return fail_at(in, "cameras.txt", "line", at.number, "camera model wanted");
        if (!take_u32(&at, &width) || !take_u32(&at, &height))
            return fail_at(in, "cameras.txt", "line", at.number, "width and height wanted");
        for (int i = 0; i < kind->parameter_count; i++)
            if (!take_f64(&at, &parameters[i]))
                return fail_at(in, "cameras.txt", "line", at.number, "parameter of the camera model wanted");
        EWA_TRY(add_lens(in, id, kind, width, height, parameters));
    }
    return EWA_OK;
}

/// What is left of a line, which a name with blanks may be.
static ewa_text rest_of(line *at) {
    skip_blank(at);
    const char *end = at->end;
    while (end > at->next && (end[-1] == ' ' || end[-1] == '\t' || end[-1] == '\r')) end--;
    return (ewa_text){at->next, (size_t)(end - at->next)};
}

static ewa_status read_text_images(loader *in, ewa_reader text) {
    line at = {.number = 0};
    while (next_line(&text, &at)) {
        if (is_comment(at)) continue;
        uint32_t id, lens_id;
        double pose[7];
        bool good = take_u32(&at, &id);
        for (int i = 0; i < 7; i++) good = good && take_f64(&at, &pose[i]);
        if (!good || !take_u32(&at, &lens_id))
            return fail_at(in, "images.txt", "line", at.number,
                           "image id, quaternion, translation and camera id wanted");
        EWA_TRY(add_image(in, id, pose, lens_id, rest_of(&at)));
        next_line(&text, &at); // the image's points, possibly none: never looked at
    }
    return EWA_OK;
}

/// Binary models are little-endian.
static uint64_t take_unsigned(ewa_reader *bytes, uint32_t size_bytes) {
    const uint8_t *at = ewa_reader_take(bytes, size_bytes);
    uint64_t value = 0;
    for (uint32_t i = 0; at && i < size_bytes; i++) value |= (uint64_t)at[i] << 8 * i;
    return value;
}

static double take_double(ewa_reader *bytes) {
    const uint64_t bits = take_unsigned(bytes, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/// Reads the count of records that leads a file and checks it against the bytes that follow.
static ewa_status take_count(const loader *in, const char *file, ewa_reader *bytes, uint64_t record_bytes,
                             uint64_t *count) {
    *count = take_unsigned(bytes, 8);
    if (bytes->failed || *count > ewa_reader_left(bytes) / record_bytes)
        return fail_at(in, file, "byte", 0, "more records promised than the file holds");
    return EWA_OK;
}

static ewa_status read_binary_lenses(loader *in, ewa_reader bytes) {
    uint64_t count;
    EWA_TRY(take_count(in, "cameras.bin", &bytes, LENS_MIN_BYTES, &count));
    for (uint64_t i = 0; i < count; i++) {
        const uint64_t start = bytes.at_bytes;
        const uint32_t id = (uint32_t)take_unsigned(&bytes, 4);
        const uint64_t kind = take_unsigned(&bytes, 4), width = take_unsigned(&bytes, 8);
        const uint64_t height = take_unsigned(&bytes, 8);
        double parameters[MAX_PARAMETERS];
        if (!bytes.failed && kind >= MODEL_COUNT)
            return fail_at(in, "cameras.bin", "byte", start, "unknown camera model");
        for (int p = 0; !bytes.failed && p < MODELS[kind].parameter_count; p++)
            parameters[p] = take_double(&bytes);
        if (bytes.failed) return fail_at(in, "cameras.bin", "byte", start, "the file ends within a camera");
        EWA_TRY(add_lens(in, id, &MODELS[kind], width, height, parameters));
    }
    return EWA_OK;
}

static ewa_status read_binary_images(loader *in, ewa_reader bytes) {
    uint64_t count;
    EWA_TRY(take_count(in, "images.bin", &bytes, IMAGE_MIN_BYTES, &count));
    for (uint64_t i = 0; i < count; i++) {
        const uint64_t start = bytes.at_bytes;
        const uint32_t id = (uint32_t)take_unsigned(&bytes, 4);
        double pose[7];
        for (int p = 0; p < 7; p++) pose[p] = take_double(&bytes);
        const uint32_t lens_id = (uint32_t)take_unsigned(&bytes, 4);
        uint64_t name_bytes = 0;
        const uint8_t *name = ewa_reader_take_line(&bytes, '\0', &name_bytes);
        const uint64_t point_count = take_unsigned(&bytes, 8);
        if (!bytes.failed && point_count > ewa_reader_left(&bytes) / POINT_BYTES) bytes.failed = true;
        if (!bytes.failed) ewa_reader_take(&bytes, point_count * POINT_BYTES);
        if (bytes.failed) return fail_at(in, "images.bin", "byte", start, "the file ends within an image");
        EWA_TRY(add_image(in, id, pose, lens_id, (ewa_text){(const char *)name, (size_t)name_bytes}));
    }
    return EWA_OK;
}

ewa_status ewa_camera_list_read_colmap_memory(ewa_camera_list *list, bool is_text, const uint8_t *cameras,
                                              size_t cameras_bytes, const uint8_t *images,
                                              size_t images_bytes) {
    loader in = {.list = list};
    const ewa_reader first = {.bytes = cameras, .size_bytes = cameras_bytes};
    const ewa_reader second = {.bytes = images, .size_bytes = images_bytes};
    ewa_status status = is_text ? read_text_lenses(&in, first) : read_binary_lenses(&in, first);
    if (status == EWA_OK && in.lens_count) qsort(in.lenses, in.lens_count, sizeof *in.lenses, compare_lenses);
    if (status == EWA_OK) status = is_text ? read_text_images(&in, second) : read_binary_images(&in, second);
    ewa_release(list->context, in.lenses, in.lens_capacity, sizeof *in.lenses);
    if (status == EWA_OK && list->count == 0)
        status = ewa_fail(list->context, EWA_ERROR_FORMAT, "%s: the COLMAP model has no images", list->name);
    return status;
}

/// Whether a folder has a file; what kind of file it is shows when it is opened.
static bool has_part(const char *folder, const char *name) {
    char path[EWA_PATH_BYTES];
    ewa_platform_facts facts;
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    return length > 0 && length < (int)sizeof path && ewa_platform_stat(path, &facts);
}

ewa_status ewa_camera_list_read_colmap(ewa_camera_list *list, const char *folder) {
    static const char *const names[2][2] = {{"cameras.bin", "images.bin"}, {"cameras.txt", "images.txt"}};
    int kind = 0;
    while (kind < 2 && !(has_part(folder, names[kind][0]) && has_part(folder, names[kind][1]))) kind++;
    if (kind == 2)
        return ewa_fail(list->context, EWA_ERROR_FORMAT,
                        "%s: a folder without a COLMAP model (cameras and images, .bin or .txt)", folder);
    ewa_file cameras, images = {0};
    ewa_status status = ewa_referenced_file_part(list->context, folder, names[kind][0], &cameras);
    if (status == EWA_OK) status = ewa_referenced_file_part(list->context, folder, names[kind][1], &images);
    if (status == EWA_OK)
        status = ewa_camera_list_read_colmap_memory(list, kind == 1, cameras.bytes, cameras.size_bytes,
                                                    images.bytes, images.size_bytes);
    ewa_file_unmap(list->context, &images);
    ewa_file_unmap(list->context, &cameras);
    return status;
}
