// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// "ept.json": the root's cube, how points are held, the coordinate reference system.
#include "base/base.h"
#include "io/ept/ept.h"
#include "io/referenced_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// The description and where messages about it go.
typedef struct description {
    ewa_octree *octree;
    ewa_ept *ept;
    const char *path;
    const cJSON *root;
} description;

ewa_status ewa_ept_open(const ewa_ept *ept, const char *what, const ewa_octree_key *key, const char *suffix,
                        char path[EWA_EPT_PATH_BYTES], ewa_file *file) {
    char name[EWA_EPT_NAME_BYTES];
    snprintf(name, sizeof name, "%s%d-%d-%d-%d.%s", what, key->level, key->cell[0], key->cell[1], key->cell[2], suffix);
    snprintf(path, EWA_EPT_PATH_BYTES, "%s/%s", ept->folder, name);
    return ewa_referenced_file_part(ept->context, ept->folder, name, file);
}

static const cJSON *item(const description *d, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(d->root, name);
}

/// Reads a box of six numbers; false when it is none.
static bool read_box(const cJSON *box, double low[3], double high[3]) {
    if (!cJSON_IsArray(box) || cJSON_GetArraySize(box) != 6) return false;
    const cJSON *number;
    int i = 0;
    cJSON_ArrayForEach(number, box) {
        if (!cJSON_IsNumber(number) || !isfinite(number->valuedouble)) return false;
        (i < 3 ? low : high)[i % 3] = number->valuedouble;
        i++;
    }
    return low[0] <= high[0] && low[1] <= high[1] && low[2] <= high[2];
}

/// Takes the root's cube, the box of the points and the distance of the root's points.
static ewa_status take_box(const description *d) {
    ewa_octree_facts *facts = &d->octree->facts;
    ewa_bounds *bounds = &facts->bounds;
    double high_world[3];
    const cJSON *span = item(d, "span");
    const bool is_box = read_box(item(d, "bounds"), facts->low_world, high_world);
    const double side = is_box ? high_world[0] - facts->low_world[0] : 0;
    bool is_cube = side > 0 && isfinite(side);
    for (int c = 1; c < 3 && is_cube; c++)
        is_cube = fabs(high_world[c] - facts->low_world[c] - side) <= 1e-6 * side;
    if (!is_cube)
        return ewa_fail(d->ept->context, EWA_ERROR_FORMAT, "%s: \"bounds\" are not the six numbers of a cube",
                        d->path);
    if (!cJSON_IsNumber(span) || !(span->valuedouble >= 1) || !isfinite(span->valuedouble))
        return ewa_fail(d->ept->context, EWA_ERROR_FORMAT, "%s: \"span\" is no number of voxels", d->path);
    facts->side_world = side;
    facts->spacing_world = side / span->valuedouble;
    if (!read_box(item(d, "boundsConforming"), bounds->low_world, bounds->high_world))
        for (int c = 0; c < 3; c++) {
            bounds->low_world[c] = facts->low_world[c];
            bounds->high_world[c] = high_world[c];
        }
    return EWA_OK;
}

/// Takes the version, and how points and hierarchy are held.
static ewa_status take_encoding(const description *d) {
    static const char *const words[] = {"laszip", "binary", "zstandard"};
    ewa_ept *ept = d->ept;
    const char *version = cJSON_GetStringValue(item(d, "version"));
    const char *data = cJSON_GetStringValue(item(d, "dataType"));
    const char *hierarchy = cJSON_GetStringValue(item(d, "hierarchyType"));
    char shown[EWA_EPT_SHOWN_BYTES];
    if (!version || strncmp(version, "1.", 2) != 0 || strlen(version) > 8 ||
        strspn(version, "0123456789.") != strlen(version))
        return ewa_fail(ept->context, EWA_ERROR_UNSUPPORTED, "%s: EPT of version %s; 1.0 and 1.1 are read",
                        d->path, ewa_ept_show(version, shown));
    if (hierarchy && strcmp(hierarchy, "json") != 0)
        return ewa_fail(ept->context, EWA_ERROR_UNSUPPORTED,
                        "%s: a hierarchy of type \"%s\"; \"json\" is read", d->path,
                        ewa_ept_show(hierarchy, shown));
    snprintf(ept->kind, sizeof ept->kind, "EPT %s", version);
    d->octree->facts.kind = ept->kind;
    for (int i = 0; i < 3 && data; i++) {
        if (strcmp(data, words[i]) != 0) continue;
        ept->encoding = (ewa_ept_encoding)i;
        return EWA_OK;
    }
    return ewa_fail(ept->context, EWA_ERROR_UNSUPPORTED,
                    "%s: points of type \"%s\"; \"laszip\", \"binary\" and \"zstandard\" are read", d->path,
                    ewa_ept_show(data, shown));
}

static ewa_status note(const description *d, const char *name, const char *text) {
    return ewa_cloud_set_note(d->octree->prototype, name, text, strlen(text));
}

/// Notes the coordinate reference system: well-known text, else codes of EPSG.
static ewa_status note_system(const description *d) {
    const cJSON *system = item(d, "srs");
    const char *wkt = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(system, "wkt"));
    const char *authority = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(system, "authority"));
    const char *codes[2] = {cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(system, "horizontal")),
                            cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(system, "vertical"))};
    if (wkt && wkt[0]) {
        const ewa_las_crs crs = {.wkt = (const uint8_t *)wkt, .wkt_bytes = strlen(wkt)};
        return ewa_las_crs_note(d->ept->context, &crs, true, d->octree->prototype);
    }
    if (!authority || strcmp(authority, "EPSG") != 0 || !codes[0]) return EWA_OK;
    for (int i = 0; i < 2 && codes[i]; i++)
        if (!codes[i][0] || strlen(codes[i]) > 6 || strspn(codes[i], "0123456789") != strlen(codes[i]))
            return EWA_OK;
    char text[32];
    snprintf(text, sizeof text, codes[1] ? "EPSG:%s+%s" : "EPSG:%s", codes[0], codes[1] ? codes[1] : "");
    return note(d, "crs", text);
}

/// Takes what the description says, but for the points.
static ewa_status take(const description *d, uint64_t *point_count) {
    const cJSON *points = item(d, "points");
    EWA_TRY(take_encoding(d));
    EWA_TRY(take_box(d));
    if (!cJSON_IsNumber(points) || !(points->valuedouble >= 0) || points->valuedouble >= 0x1p53)
        return ewa_fail(d->ept->context, EWA_ERROR_FORMAT, "%s: \"points\" is no number of points", d->path);
    *point_count = (uint64_t)points->valuedouble;
    d->octree->facts.bounds.finite_count = *point_count;
    if (d->ept->encoding != EWA_EPT_LASZIP)
        EWA_TRY(ewa_ept_schema(d->path, item(d, "schema"), d->octree->facts.bounds.low_world, d->ept));
    EWA_TRY(note_system(d));
    return note(d, "file.format", d->ept->kind);
}

ewa_status ewa_ept_describe(ewa_octree *octree, ewa_ept *ept, uint64_t *point_count) {
    ewa_context *context = octree->context;
    char path[EWA_EPT_PATH_BYTES];
    snprintf(path, sizeof path, "%s/ept.json", ept->folder);
    ewa_file file;
    EWA_TRY(ewa_referenced_file_part(context, ept->folder, "ept.json", &file));
    ewa_json json;
    ewa_status status = ewa_json_parse(context, path, "a description of EPT", file.bytes, file.size_bytes, &json);
    const description d = {octree, ept, path, json.root};
    if (status == EWA_OK) status = take(&d, point_count);
    ewa_json_free(context, &json);
    ewa_file_unmap(context, &file);
    return status;
}
