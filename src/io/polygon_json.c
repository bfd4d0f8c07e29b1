// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Outlines from GeoJSON.
// Based on: H. Butler et al., "The GeoJSON Format", RFC 7946, 2016.
#include "io/json_text.h"
#include "io/polygon.h"

static ewa_status fail_shape(const ewa_rings *rings, const char *what) {
    return ewa_fail(rings->context, EWA_ERROR_FORMAT, "%s: GeoJSON: %s", rings->name, what);
}

/// Adds a ring: an array of positions.
static ewa_status add_ring(ewa_rings *rings, const cJSON *ring) {
    if (!cJSON_IsArray(ring)) return fail_shape(rings, "a ring is no array");
    const cJSON *position;
    cJSON_ArrayForEach(position, ring) {
        const cJSON *x = cJSON_IsArray(position) ? position->child : NULL, *y = x ? x->next : NULL;
        if (!cJSON_IsNumber(x) || !cJSON_IsNumber(y))
            return fail_shape(rings, "a position is no array of two numbers");
        EWA_TRY(ewa_rings_add(rings, x->valuedouble, y->valuedouble));
    }
    return ewa_rings_close(rings);
}

/// Adds the rings of a polygon, or of the polygons of an array.
static ewa_status add_polygons(ewa_rings *rings, const cJSON *coordinates, bool several) {
    if (!cJSON_IsArray(coordinates)) return fail_shape(rings, "\"coordinates\" is no array");
    const cJSON *part;
    ewa_status status = EWA_OK;
    cJSON_ArrayForEach(part, coordinates) {
        status = several ? add_polygons(rings, part, false) : add_ring(rings, part);
        if (status != EWA_OK) break;
    }
    return status;
}

/// Adds what an object holds, and what the objects in it do; cJSON limits how deep they are.
static ewa_status add_object(ewa_rings *rings, const cJSON *object) {
    if (!cJSON_IsObject(object)) return EWA_OK; // null is a feature's missing geometry
    const cJSON *type = cJSON_GetObjectItemCaseSensitive(object, "type");
    const ewa_text word = {cJSON_IsString(type) ? type->valuestring : "",
                           cJSON_IsString(type) ? strlen(type->valuestring) : 0};
    const cJSON *coordinates = cJSON_GetObjectItemCaseSensitive(object, "coordinates");
    if (ewa_text_is(word, "Polygon")) return add_polygons(rings, coordinates, false);
    if (ewa_text_is(word, "MultiPolygon")) return add_polygons(rings, coordinates, true);
    if (ewa_text_is(word, "Feature"))
        return add_object(rings, cJSON_GetObjectItemCaseSensitive(object, "geometry"));
    const bool features = ewa_text_is(word, "FeatureCollection");
    if (!features && !ewa_text_is(word, "GeometryCollection"))
        return EWA_OK; // points and lines have no inside
    const cJSON *member;
    ewa_status status = EWA_OK;
    cJSON_ArrayForEach(member,
                       cJSON_GetObjectItemCaseSensitive(object, features ? "features" : "geometries")) {
        status = add_object(rings, member);
        if (status != EWA_OK) break;
    }
    return status;
}

ewa_status ewa_rings_read_json(ewa_rings *rings, ewa_text text) {
    ewa_json json;
    ewa_status status = ewa_json_parse(rings->context, rings->name, "an outline", (const uint8_t *)text.chars,
                                       text.length, &json);
    if (status == EWA_OK) status = add_object(rings, json.root);
    ewa_json_free(rings->context, &json);
    return status;
}
