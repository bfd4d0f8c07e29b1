// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// ewa photos: colours of points from photographs.
#include "cli/base/commands.h"
#include "cli/base/json.h"
#include "cli/convert/cloud_output.h"
#include "cli/input/inputs.h"
#include "cli/input/photo_input.h"
#include "cli/input/scene_input.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct photos_arguments {
    output_arguments output; // first
    photo_arguments photos;
    const char *report_path;
    ewa_photos_options options;
} photos_arguments;

#define AT(member)     offsetof(photos_arguments, member)
#define PHOTOS(member) OPTION_OF(ewa_photos_options, AT(options), member)

static const cli_option photos_table[] = {
    PHOTO_OPTIONS(AT(photos)),
    {"report", OPTION_OUTPUT, AT(report_path), "FILE.json",
     .help = "write exposure, error and what else was found for each photograph"},
    {"method", PHOTOS(method)},
    {"exposure", PHOTOS(exposure)},
    {"hold-out", PHOTOS(hold_out)},
    {"rounds", PHOTOS(rounds)},
    {"pose-steps", PHOTOS(pose_steps)},
    {"vignetting", PHOTOS(vignetting)},
    {"robust", PHOTOS(robust)},
    {"ridge", PHOTOS(ridge)},
    {"spacing", PHOTOS(spacing_px)},
    {"cutoff", PHOTOS(cutoff)},
};

static void set_defaults(void *data) {
    photos_arguments *arguments = data;
    ewa_photos_options_init(&arguments->options, sizeof arguments->options);
}

static bool check(const void *data, char message[OPTION_ERROR_BYTES]) {
    const photos_arguments *arguments = data;
    return cloud_output_check(&arguments->output, message) &&
           photo_input_check(&arguments->photos, "photos", message);
}

static void write_photo(json_writer *json, const ewa_photo *photo, const ewa_photo_report *report) {
    json_object(json, NULL);
    json_text(json, "path", photo->path);
    json_flag(json, "held_out", report->held_out);
    json_count(json, "width_px", report->width_px);
    json_count(json, "height_px", report->height_px);
    json_count(json, "pixel_count", report->pixel_count);
    json_count(json, "point_count", report->point_count);
    json_vector(json, "gain", 3, report->gain);
    json_vector(json, "offset", 3, report->offset);
    json_number(json, "rms", report->rms);
    json_number(json, "psnr_db", report->psnr_db);
    json_number(json, "rejected", report->rejected);
    json_number(json, "shift_px", report->shift_px);
    json_vector(json, "world_to_camera", 16, report->world_to_camera);
    json_close(json, '}');
}

/// Writes the report; false after reporting.
static bool write_report(cli_session *session, const char *path, const ewa_photo *photos, uint32_t count,
                         const ewa_photos_report *report, const ewa_photo_report *per_photo) {
    text_file text;
    if (!text_file_open(session, &text, path)) return false;
    json_writer json;
    json_start(&json, text.file);
    json_count(&json, "used_count", report->used_count);
    json_count(&json, "held_out_count", report->held_out_count);
    json_count(&json, "seen_count", report->seen_count);
    json_number(&json, "rms", report->rms);
    json_number(&json, "psnr_db", report->psnr_db);
    json_number(&json, "held_out_rms", report->held_out_rms);
    json_number(&json, "held_out_psnr_db", report->held_out_psnr_db);
    json_vector(&json, "vignetting", 2, report->vignetting);
    json_number(&json, "low", (double)report->low);
    json_number(&json, "high", (double)report->high);
    json_array(&json, "photographs");
    for (uint32_t i = 0; i < count; i++) write_photo(&json, &photos[i], &per_photo[i]);
    json_close(&json, ']');
    json_end(&json);
    return text_file_close(session, &text);
}

static void say(cli_session *session, const ewa_photo *photos, uint32_t count, const ewa_photos_report *report,
                const ewa_photo_report *per_photo, uint64_t point_count) {
    for (uint32_t i = 0; i < count; i++) {
        const ewa_photo_report *at = &per_photo[i];
        session_say(session,
                    "%s: %u x %u, %llu points, gain %.4f %.4f %.4f, offset %.4f %.4f %.4f, moved by %.2f px, %.2f dB, "
                    "%.1f %% rejected%s",
                    photos[i].path, at->width_px, at->height_px, (unsigned long long)at->point_count, at->gain[0],
                    at->gain[1], at->gain[2], at->offset[0], at->offset[1], at->offset[2], at->shift_px, at->psnr_db,
                    100 * at->rejected, at->held_out ? ", held out" : "");
    }
    session_note(session, "%u photographs see %llu of %llu points, %.2f dB", report->used_count,
                 (unsigned long long)report->seen_count, (unsigned long long)point_count, report->psnr_db);
    if (report->held_out_count)
        session_note(session, "%u photographs that were not used: %.2f dB", report->held_out_count,
                     report->held_out_psnr_db);
}

/// Colours a cloud; false after reporting.
static bool color(cli_session *session, const photos_arguments *arguments, const ewa_photo_list *list, ewa_cloud *cloud) {
    uint32_t count;
    const ewa_photo *photos = ewa_photo_list_photos(list, &count);
    ewa_photo_report *per_photo = calloc(count, sizeof *per_photo);
    ewa_photos_report report;
    if (!per_photo) {
        session_fail(session, "out of memory for %u photographs", count);
        return false;
    }
    session->subject = arguments->photos.cameras_path;
    bool done = session_passed(
        session, ewa_cloud_color_from_photos(cloud, photos, count, &arguments->options, &report, per_photo));
    if (done) {
        say(session, photos, count, &report, per_photo, ewa_cloud_point_count(cloud));
        done = !arguments->report_path ||
               write_report(session, arguments->report_path, photos, count, &report, per_photo);
    }
    free(per_photo);
    return done;
}

static ewa_cloud *make(cli_session *session, const void *data) {
    const photos_arguments *arguments = data;
    const common_arguments *common = &arguments->output.common;
    ewa_photo_list *list = photo_input_load(session, &arguments->photos);
    if (!list) return NULL;
    session->subject = common->operands[0];
    ewa_cloud *cloud = scene_input_cloud(session, common->operand_count, common->operands, arguments->options.cutoff);
    if (cloud && !color(session, arguments, list, cloud)) ewa_cloud_destroy(&cloud);
    ewa_photo_list_destroy(&list);
    return cloud;
}

static int run(const void *data) { return cloud_output_run(data, make); }

static const option_group photos_options = OPTION_GROUP("Photographs", photos_table);
const cli_command photos_command = {
    .name = "photos",
    .operands = "IN... --cameras PATH -o OUT",
    .summary = "give points the colours that photographs show, whose cameras are known",
    .details =
        "Points that lack normals and radii get them as in 'ewa render'; of meshes points on the faces are taken. "
        "Points that no photograph sees keep their colours; photo_count and photo_residual say how many see each, and "
        "how well they agree.\n"
        "\n"
        "docs/photos.md says how it is done and how good it is.",
    .examples = "ewa photos scan.ply --cameras colmap/sparse/0 -o coloured.ply\n"
                "ewa photos scan.ply --cameras transforms.json -o coloured.ply --hold-out 8 --report report.json\n"
                "ewa photos scan.ply --cameras colmap/sparse/0 --images small -o mean.ply --method mean\n",
    .low_operands = 1,
    .high_operands = 64,
    .groups =
        (const option_group *const[]){&cloud_output_options, &cloud_input_options, &photos_options, NULL},
    .arguments_bytes = sizeof(photos_arguments),
    .set_defaults = set_defaults,
    .check = check,
    .run = run,
};
