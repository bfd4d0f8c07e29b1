// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What files say of their coordinates: reference systems, units of lengths, which way is up.
#include "check_scene.h"

#define FOOT "UNIT[\"foot\",0.3048]"
#define US_FOOT "UNIT[\"US survey foot\",0.304800609601219,AUTHORITY[\"EPSG\",\"9003\"]]"
#define METRE "UNIT[\"metre\",1]"
#define GEOGRAPHIC "GEOGCS[\"G [UNIT\",DATUM[\"D\",SPHEROID[\"S\",6378137,298.25]],UNIT[\"degree\",0.0174532925199433]]"
#define PROJECTED(unit) "PROJCS[\"P\"," GEOGRAPHIC ",PROJECTION[\"M\"]," unit "]"
#define COMPOUND(horizontal, vertical) "COMPD_CS[\"C\"," PROJECTED(horizontal) ",VERT_CS[\"V\",VERT_DATUM[\"D\",2005]," vertical "]]"

/// What is said of lengths by a scene of a bare cloud, moved by a map, with a reference system.
static const char *unit_of(ewa_context *context, const char *crs, const char *note, double scale) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = make_object(context, EWA_OBJECT_SPHERE, 0);
    if (crs) assert_int_equal(ewa_cloud_set_note(cloud, "crs", crs, strlen(crs)), EWA_OK);
    if (note) assert_int_equal(ewa_cloud_set_note(cloud, "crs_unit", note, strlen(note)), EWA_OK);
    WITH_DEFAULTS(ewa_asset_options, options);
    // Turned by a quarter, and as large as the scale says.
    const double to_world[16] = {0, -scale, 0, 500, scale, 0, 0, 0, 0, 0, scale, 0, 0, 0, 0, 1};
    memcpy(options.to_world, to_world, sizeof to_world);
    OWNED(ewa_asset_release) ewa_asset *asset = NULL;
    OWNED(ewa_scene_destroy) ewa_scene *scene = NULL;
    ewa_scene_info info;
    assert_int_equal(ewa_asset_create(context, &(ewa_asset_source){.cloud = cloud}, &options, &asset), EWA_OK);
    assert_int_equal(ewa_scene_create(context, NULL, &scene), EWA_OK);
    assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
    ewa_scene_describe(scene, &info);
    return info.unit ? info.unit : "none";
}

/// Two systems of coordinates in one scene are told with both names, and drawn as they are.
TEST_LOGGED(test_two_systems, 1) {
    ewa_scene *scene = make_scene(context);
    static const char *const systems[] = {NULL, PROJECTED(METRE), PROJECTED(METRE), PROJECTED(FOOT)};
    ewa_cloud *clouds[4];
    for (int i = 0; i < 4; i++) {
        clouds[i] = make_object(context, EWA_OBJECT_SPHERE, 0);
        if (systems[i]) assert_int_equal(ewa_cloud_set_note(clouds[i], "crs", systems[i], strlen(systems[i])), EWA_OK);
        ewa_asset *asset = NULL;
        const ewa_asset_source source = {.cloud = clouds[i], .name = (const char *[]){"none", "one", "same", "other"}[i]};
        assert_int_equal(ewa_asset_create(context, &source, NULL, &asset), EWA_OK);
        assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
        ewa_asset_release(&asset);
        assert_int_equal(ewa_scene_complete(scene), EWA_OK);
        assert_int_equal(log->count, i == 3);
    }
    assert_ptr_equal(strstr(log->text, "other: its coordinate reference system (PROJCS"), log->text);
    assert_non_null(strstr(log->text, "is not that of one (PROJCS"));
    ewa_scene_destroy(&scene);
    for (int i = 0; i < 4; i++) ewa_cloud_destroy(&clouds[i]);
}

/// A sphere on a foot along an axis, 1 y, 2 z, with normals.
static ewa_cloud *make_stand(ewa_context *context, int up) {
    ewa_cloud *cloud = make_object(context, EWA_OBJECT_CUBE, 0);
    double to_world[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    to_world[5 * up] = 4;
    assert_int_equal(ewa_cloud_transform(cloud, to_world), EWA_OK);
    return cloud;
}

/// Files that have not the same up are told of, once; what a map moves lies as somebody wants it.
TEST(test_two_ups) {
    static const struct {
        const char *names[2];
        int up[2];
        bool moved;
        const char *said;
    } rows[] = {
        {{"mug.glb", "scan.las"}, {1, 2}, false, "mug.glb has y up, scan.las z"},
        {{"mug.glb", "scan.las"}, {1, 2}, true, NULL},
        {{"mug.glb", "part.obj"}, {1, 1}, false, NULL},
        {{"tower.las", "part.laz"}, {2, 2}, false, NULL},
        {{"one.ply", "two.ply"}, {1, 2}, false, NULL},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        check_log log = {.count = 0};
        OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
        ewa_scene *scene = make_scene(context);
        ewa_cloud *clouds[2];
        for (int k = 0; k < 2; k++) {
            clouds[k] = make_stand(context, rows[i].up[k]);
            WITH_DEFAULTS(ewa_asset_options, options);
            if (k && rows[i].moved) options.to_world[3] = 1;
            OWNED(ewa_asset_release) ewa_asset *asset = NULL;
            const ewa_asset_source source = {.cloud = clouds[k], .name = rows[i].names[k]};
            assert_int_equal(ewa_asset_create(context, &source, &options, &asset), EWA_OK);
            assert_int_equal(ewa_scene_add(scene, asset, NULL), EWA_OK);
        }
        ewa_camera camera;
        for (int again = 0; again < 2; again++) {
            assert_int_equal(ewa_scene_place_camera(scene, NULL, &camera, NULL), EWA_OK);
            const bool told = strstr(log.text, " up, ") != NULL;
            if (told != (rows[i].said && !again)) fail_msg("row %zu: '%s'", i, log.text);
            if (told) assert_non_null(strstr(log.text, rows[i].said));
            log = (check_log){.count = 0};
        }
        ewa_scene_destroy(&scene);
        for (int k = 0; k < 2; k++) ewa_cloud_destroy(&clouds[k]);
    }
}

/// Lengths have the unit that reference systems say, unless it is none, several, or changed by a map.
TEST(test_units) {
    static const struct {
        const char *crs, *unit;
    } systems[] = {
        {NULL, "none"},
        {PROJECTED(METRE), "m"},
        {PROJECTED(FOOT), "ft"},
        {PROJECTED("UNIT[\"Foot_US\",0.3048006096012192]"), "US ft"},
        {PROJECTED("UNIT[\"link\",0.201168]"), "none"},
        {"PROJCS[\"P\"," GEOGRAPHIC "]", "none"},
        {COMPOUND(METRE, METRE), "m"},
        {COMPOUND(US_FOOT, US_FOOT), "US ft"},
        {COMPOUND(METRE, FOOT), "none"},
        {COMPOUND(FOOT, US_FOOT), "ft"},
        {COMPOUND(US_FOOT, FOOT), "US ft"},
        {GEOGRAPHIC, "none"},
        {"PROJCRS[\"P\",BASEGEOGCRS[\"B\",DATUM[\"D\",ELLIPSOID[\"E\",6378137,298.25,LENGTHUNIT[\"metre\",1]]]],CS[Cartesian,2],"
         "AXIS[\"(E)\",east,ORDER[1],LENGTHUNIT[\"foot\", 0.3048]],AXIS[\"(N)\",north,LENGTHUNIT[\"foot\",0.3048]]]",
         "ft"},
        {"PROJCRS[\"P\",CS[Cartesian,2],AXIS[\"e\",east],AXIS[\"n\",north],LENGTHUNIT[\"metre\",1]]", "m"},
        {"EPSG:32633", "m"},
        {"EPSG:25832+7837", "m"},
        {"EPSG:26910+6360", "none"}, // heights in feet
        {"EPSG:4326", "none"},
        {"EPSG:1", "none"},
        {"user-defined: PROJCS[", "none"},
    };
    OWNED(ewa_context_destroy) ewa_context *context = NULL;
    assert_int_equal(ewa_context_create(NULL, &context), EWA_OK);
    for (size_t i = 0; i < sizeof systems / sizeof systems[0]; i++)
        assert_string_equal(unit_of(context, systems[i].crs, NULL, 1), systems[i].unit);
    assert_string_equal(unit_of(context, PROJECTED(METRE), NULL, 0.5), "none");
    assert_string_equal(unit_of(context, "user-defined", "US ft", 1), "US ft");
    assert_string_equal(unit_of(context, "user-defined", "rods", 1), "none");
    // Texts that end anywhere say nothing wrong.
    const char *whole = COMPOUND(FOOT, FOOT);
    char begun[512];
    for (size_t length = 0; length < strlen(whole); length++) {
        snprintf(begun, sizeof begun, "%.*s", (int)length, whole);
        const char *unit = unit_of(context, length ? begun : NULL, NULL, 1);
        assert_true(strcmp(unit, "none") == 0 || strcmp(unit, "ft") == 0);
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
