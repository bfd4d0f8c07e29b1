// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Transfer functions from and to JSON. Members are checked by name, so that a misspelt one is not taken for a
// default.
#include "base/base.h"
#include "ewa/image.h"
#include "ewa/io.h"
#include "image/transfer.h"
#include "io/file.h"
#include "io/json_text.h"
#include "io/number.h"
#include "io/volume/transfer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A file that is being read.
typedef struct transfer_text {
    ewa_context *context;
    const char *name;
    bool linear; // the colours
} transfer_text;

static ewa_status fail_member(const transfer_text *file, uint32_t index, const char *member,
                              const char *what) {
    return ewa_fail(file->context, EWA_ERROR_FORMAT, "%s: point %u: '%.40s' %s", file->name, index, member,
                    what);
}

static ewa_status read_color(const transfer_text *file, uint32_t index, const cJSON *item,
                             ewa_transfer_point *point) {
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 3)
        return fail_member(file, index, "color", "is not three numbers");
    int c = 0;
    for (const cJSON *number = item->child; number; number = number->next, c++) {
        if (!cJSON_IsNumber(number) || !(number->valuedouble >= 0) ||
            (!file->linear && number->valuedouble > 1) || !isfinite((float)number->valuedouble))
            return fail_member(file, index, "color",
                               file->linear ? "has a number that is negative or none"
                                            : "has a number outside of [0, 1]");
        const float value = (float)number->valuedouble;
        point->color[c] = file->linear ? value : ewa_linear_from_srgb(value);
    }
    return EWA_OK;
}

static ewa_status read_point(const transfer_text *file, uint32_t index, const cJSON *object,
                             ewa_transfer_point *point) {
    if (!cJSON_IsObject(object))
        return ewa_fail(file->context, EWA_ERROR_FORMAT, "%s: point %u is not an object", file->name, index);
    bool has_value = false, has_color = false, has_density = false;
    const cJSON *item;
    cJSON_ArrayForEach(item, object) {
        const char *member = item->string;
        const double number = cJSON_IsNumber(item) ? item->valuedouble : NAN;
        if (strcmp(member, "color") == 0) {
            EWA_TRY(read_color(file, index, item, point));
            has_color = true;
        } else if (strcmp(member, "value") == 0) {
            if (!isfinite(number)) return fail_member(file, index, member, "is no number");
            point->value = number;
            has_value = true;
        } else if (strcmp(member, "opacity") == 0 || strcmp(member, "extinction") == 0) {
            const bool opacity = member[0] == 'o';
            if (has_density) return fail_member(file, index, member, "beside the other of the two");
            if (!(number >= 0) || !isfinite((float)number) || (opacity && number > 1))
                return fail_member(file, index, member,
                                   opacity ? "is no number in [0, 1]" : "is no number >= 0");
            point->extinction = (float)(opacity ? ewa_extinction_of_opacity(number) : number);
            has_density = true;
        } else {
            return fail_member(file, index, member, "is no known member");
        }
    }
    if (!has_value || !has_color || !has_density)
        return fail_member(file, index, !has_value ? "value" : has_color ? "opacity" : "color", "is missing");
    return EWA_OK;
}

static ewa_status read_gradient(const transfer_text *file, const cJSON *item, ewa_transfer *transfer) {
    const cJSON *low = cJSON_IsArray(item) && cJSON_GetArraySize(item) == 2 ? item->child : NULL;
    if (!cJSON_IsNumber(low) || !cJSON_IsNumber(low->next))
        return ewa_fail(file->context, EWA_ERROR_FORMAT, "%s: 'gradient' is not two numbers", file->name);
    transfer->gradient_low = low->valuedouble;
    transfer->gradient_high = low->next->valuedouble;
    return EWA_OK;
}

/// Reads all members but the points.
static ewa_status read_members(transfer_text *file, const cJSON *root, const cJSON **points,
                               ewa_transfer *transfer) {
    const cJSON *item;
    cJSON_ArrayForEach(item, root) {
        if (strcmp(item->string, "points") == 0) {
            *points = item;
        } else if (strcmp(item->string, "name") == 0) {
            continue;
        } else if (strcmp(item->string, "unit_length") == 0) {
            if (!cJSON_IsNumber(item) || !(item->valuedouble > 0) || !isfinite(item->valuedouble))
                return ewa_fail(file->context, EWA_ERROR_FORMAT, "%s: 'unit_length' is no number > 0",
                                file->name);
            transfer->unit_length_world = item->valuedouble;
        } else if (strcmp(item->string, "color_space") == 0) {
            const char *word = cJSON_IsString(item) ? item->valuestring : "";
            file->linear = strcmp(word, "linear") == 0;
            if (!file->linear && strcmp(word, "srgb") != 0)
                return ewa_fail(file->context, EWA_ERROR_FORMAT,
                                "%s: 'color_space' is neither \"srgb\" nor \"linear\"", file->name);
        } else if (strcmp(item->string, "gradient") == 0) {
            EWA_TRY(read_gradient(file, item, transfer));
        } else {
            return ewa_fail(file->context, EWA_ERROR_FORMAT, "%s: unknown member '%.40s'", file->name,
                            item->string);
        }
    }
    return EWA_OK;
}

static ewa_status read_root(transfer_text *file, const cJSON *root, ewa_transfer *transfer) {
    const cJSON *points = NULL;
    if (!cJSON_IsObject(root))
        return ewa_fail(file->context, EWA_ERROR_FORMAT, "%s: no object with an array 'points'", file->name);
    EWA_TRY(read_members(file, root, &points, transfer));
    if (!cJSON_IsArray(points))
        return ewa_fail(file->context, EWA_ERROR_FORMAT, "%s: no array 'points'", file->name);
    ewa_status status = EWA_OK;
    for (const cJSON *item = points->child; item && status == EWA_OK; item = item->next) {
        const uint32_t index = transfer->point_count;
        if (index == EWA_MAX_TRANSFER_POINTS)
            return ewa_fail(file->context, EWA_ERROR_LIMIT, "%s: more than %d points", file->name,
                            EWA_MAX_TRANSFER_POINTS);
        status = read_point(file, index, item, &transfer->points[index]);
        transfer->point_count++;
    }
    EWA_TRY(status);
    return ewa_transfer_check(file->context, file->name, transfer) == EWA_OK ? EWA_OK : EWA_ERROR_FORMAT;
}

ewa_status ewa_transfer_read(ewa_context *context, const char *name, const uint8_t *bytes, size_t size_bytes,
                             ewa_transfer *transfer) {
    *transfer = (ewa_transfer){0};
    ewa_json json;
    EWA_TRY(ewa_json_parse(context, name, "a transfer function", bytes, size_bytes, &json));
    transfer_text file = {.context = context, .name = name};
    ewa_status status = read_root(&file, json.root, transfer);
    ewa_json_free(context, &json);
    if (status != EWA_OK) *transfer = (ewa_transfer){0};
    return status;
}

ewa_status ewa_transfer_load(ewa_context *context, const char *path, ewa_transfer *transfer) {
    if (!context || !path || !transfer) return EWA_ERROR_ARGUMENT;
    *transfer = (ewa_transfer){0};
    ewa_file file;
    EWA_TRY(ewa_file_map(context, path, &file));
    const char *name = strcmp(path, "-") == 0 ? "standard input" : path;
    ewa_status status = ewa_transfer_read(context, name, file.bytes, file.size_bytes, transfer);
    ewa_file_unmap(context, &file);
    return status;
}

ewa_status ewa_transfer_choose(ewa_context *context, const char *word, const ewa_volume *volume,
                               ewa_transfer *transfer) {
    if (!context || !volume || !transfer) return EWA_ERROR_ARGUMENT;
    ewa_volume_facts facts;
    EWA_TRY(ewa_volume_measure(volume, &facts));
    if (!facts.finite_count) return ewa_fail(context, EWA_ERROR_FORMAT, "no voxel is a finite number");
    if (!word || strcmp(word, "auto") == 0) return ewa_transfer_automatic(volume, &facts, transfer);
    char names[256] = "auto";
    const char *name;
    for (uint32_t i = 0; (name = ewa_transfer_preset_name(i, NULL)); i++) {
        if (strcmp(name, word) == 0) return ewa_transfer_preset(volume, &facts, word, transfer);
        const size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, ", %s", name);
    }
    const char *before = ewa_context_about(context, word);
    const ewa_status status = ewa_transfer_load(context, word, transfer);
    ewa_context_about(context, before);
    if (status == EWA_ERROR_IO)
        ewa_report(context, EWA_SEVERITY_NOTE, "the presets of transfer functions are %s", names);
    return status;
}

static void put_text(ewa_writer *writer, const char *text) { ewa_writer_put(writer, text, strlen(text)); }

static void put_f64(ewa_writer *writer, double value) {
    char text[EWA_NUMBER_BYTES];
    ewa_writer_put(writer, text, ewa_number_write_f64(value, text));
}

static void put_f32(ewa_writer *writer, float value) {
    char text[EWA_NUMBER_BYTES];
    ewa_writer_put(writer, text, ewa_number_write_f32(value, text));
}

static void put_point(ewa_writer *writer, const ewa_transfer_point *point) {
    put_text(writer, "  {\"value\": ");
    put_f64(writer, point->value);
    for (int c = 0; c < 3; c++) {
        put_text(writer, c ? ", " : ", \"color\": [");
        put_f32(writer, point->color[c]);
    }
    put_text(writer, "], \"extinction\": ");
    put_f32(writer, point->extinction);
    put_text(writer, "}");
}

ewa_status ewa_transfer_save(ewa_context *context, const ewa_transfer *transfer, const char *path) {
    if (!context || !transfer || !path) return EWA_ERROR_ARGUMENT;
    ewa_writer *writer;
    EWA_TRY(ewa_transfer_check(context, path, transfer));
    EWA_TRY(ewa_writer_open(context, path, &writer));
    put_text(writer, "{\n \"color_space\": \"linear\",\n");
    if (transfer->unit_length_world > 0) {
        put_text(writer, " \"unit_length\": ");
        put_f64(writer, transfer->unit_length_world);
        put_text(writer, ",\n");
    }
    if (transfer->gradient_high > 0) {
        put_text(writer, " \"gradient\": [");
        put_f64(writer, transfer->gradient_low);
        put_text(writer, ", ");
        put_f64(writer, transfer->gradient_high);
        put_text(writer, "],\n");
    }
    put_text(writer, " \"points\": [\n");
    for (uint32_t i = 0; i < transfer->point_count; i++) {
        put_point(writer, &transfer->points[i]);
        put_text(writer, i + 1 < transfer->point_count ? ",\n" : "\n");
    }
    put_text(writer, " ]\n}\n");
    return ewa_writer_commit(&writer);
}
