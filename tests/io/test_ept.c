// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// EPT folders that the test makes, in all three encodings: points and facts; what is missing, miscounted or broken.
#include "io/copc_sample.h"
#include "io/las_sample.h"
#include "io/scratch.h"

#include <zstd.h>

enum { LASZIP, BINARY, ZSTANDARD, ENCODING_COUNT, POINTS = 700, LEVELS = 3 };
static const char *const encodings[] = {"laszip", "binary", "zstandard"};
static const char *const suffixes[] = {"laz", "bin", "zst"};

static check_log messages;
static ewa_context *context;
static char folder[512];
static ewa_cloud *cloud;
static copc_nodes nodes;

/// One dimension of the binary records.
static const struct {
    const char *name, *type, *more;
    int size_bytes;
} dimensions[] = {
    {"X", "signed", ",\"scale\":0.001,\"offset\":500000", 4},
    {"Intensity", "unsigned", "", 2},
    {"Y", "signed", ",\"scale\":0.001,\"offset\":4200000", 4},
    {"Z", "signed", ",\"scale\":0.01,\"offset\":0", 4},
    {"ReturnNumber", "unsigned", ",\"minimum\":1", 1},
    {"Classification", "unsigned", "", 1},
    {"GpsTime", "float", "", 8},
    {"ScanAngleRank", "signed", "", 1},
    {"Red", "unsigned", "", 2},
    {"Green", "unsigned", "", 2},
    {"Blue", "unsigned", "", 2},
    {"NormalX", "float", "", 4},
    {"NormalY", "float", "", 4},
    {"NormalZ", "float", "", 4},
    {"Radius", "unsigned", ",\"scale\":0.0005,\"offset\":0", 2},
    {"OriginId", "unsigned", "", 4},
    {"Echoes", "unsigned", "", 8},
};
enum { DIMENSION_COUNT = sizeof dimensions / sizeof dimensions[0], RECORD_BYTES = 57 };

/// Path of a file of the folder.
static const char *within(const char *name, char path[600]) {
    snprintf(path, 600, "%s/%s", folder, name);
    return path;
}

static void write_text(const char *name, const char *text) {
    char path[600];
    scratch_write(within(name, path), text, strlen(text));
}

static void put_f32(uint8_t *to, double value) {
    const float narrow = (float)value;
    memcpy(to, &narrow, sizeof narrow);
}

/// The records of a piece, by the dimensions; the caller frees.
static uint8_t *make_records(const ewa_cloud *piece) {
    const uint64_t count = ewa_cloud_point_count(piece);
    uint8_t *records = calloc(count + 1, RECORD_BYTES), *r = records;
    assert_non_null(records);
    static const double scale[3] = {0.001, 0.001, 0.01}, offset[3] = {500000, 4200000, 0};
    for (uint64_t i = 0; i < count; i++, r += RECORD_BYTES) {
        static const int at[3] = {0, 6, 10};
        for (int c = 0; c < 3; c++) {
            const double world = las_world(piece, i, (uint32_t)c);
            las_put(r + at[c], (uint64_t)(int64_t)nearbyint((world - offset[c]) / scale[c]), 4);
            las_put(r + 25 + 2 * c, (uint64_t)las_value(piece, EWA_COLOR, i, (uint32_t)c), 2);
            put_f32(r + 31 + 4 * c, las_value(piece, EWA_NORMAL, i, (uint32_t)c));
        }
        las_put(r + 4, (uint64_t)las_value(piece, "intensity", i, 0), 2);
        r[14] = (uint8_t)las_value(piece, "return_number", i, 0);
        r[15] = (uint8_t)las_value(piece, "classification", i, 0);
        las_put_f64(r + 16, las_value(piece, "gps_time", i, 0));
        r[24] = (uint8_t)(int8_t)(i % 50 - 25);
        las_put(r + 43, (uint64_t)las_value(piece, EWA_RADIUS, i, 0), 2);
        las_put(r + 45, i, 4);
        las_put(r + 49, 1000 * i, 8);
    }
    return records;
}

static void key_path(const char *what, const ewa_octree_key *k, const char *suffix, char path[600]) {
    snprintf(path, 600, "%s/%s/%d-%d-%d-%d.%s", folder, what, k->level, k->cell[0], k->cell[1], k->cell[2],
             suffix);
}

static void write_node(int encoding, uint32_t index) {
    char path[600];
    const ewa_cloud *piece = nodes.pieces[index];
    key_path("ept-data", &nodes.keys[index], suffixes[encoding], path);
    if (encoding == LASZIP) {
        WITH_DEFAULTS(ewa_cloud_save_options, options);
        options.chunk_points = 37;
        assert_int_equal(ewa_cloud_save(piece, path, &options), EWA_OK);
        return;
    }
    OWNED(check_free) uint8_t *records = make_records(piece);
    size_t size_bytes = ewa_cloud_point_count(piece) * RECORD_BYTES;
    if (encoding == ZSTANDARD) {
        const size_t bound = ZSTD_compressBound(size_bytes);
        uint8_t *packed = malloc(bound);
        size_bytes = ZSTD_compress(packed, bound, records, size_bytes, 3);
        free(records);
        records = packed;
    }
    scratch_write(path, records, size_bytes);
}

/// The description; `schema` NULL: that of the dimensions.
static void write_description(const char *type, const char *schema) {
    char text[4096];
    int length = snprintf(
        text, sizeof text,
        "{\"bounds\":[500000,4200000,90,500064,4200064,154],\"boundsConforming\":[500000,4200000,90,"
        "500064,4200064,154],\"dataType\":\"%s\",\"hierarchyType\":\"json\",\"points\":%d,\"span\":128,"
        "\"version\":\"1.1.0\",\"srs\":{\"authority\":\"EPSG\",\"horizontal\":\"32632\"},\"schema\":[%s",
        type, POINTS, schema ? schema : "");
    for (int i = 0; i < DIMENSION_COUNT && !schema; i++)
        length +=
            snprintf(text + length, sizeof text - (size_t)length,
                     "%s{\"name\":\"%s\",\"type\":\"%s\",\"size\":%d%s}", i ? "," : "", dimensions[i].name,
                     dimensions[i].type, dimensions[i].size_bytes, dimensions[i].more);
    snprintf(text + length, sizeof text - (size_t)length, "]}");
    write_text("ept.json", text);
}

/// The hierarchy: the root's file, and one for all below each cube of level 1.
static void write_hierarchy(void) {
    char path[600];
    FILE *root = fopen(within("ept-hierarchy/0-0-0-0.json", path), "wb");
    fprintf(root, "{");
    for (int32_t at = 0; at < 8; at++) {
        const ewa_octree_key k = {1, {at & 1, at >> 1 & 1, at >> 2}};
        key_path("ept-hierarchy", &k, "json", path);
        FILE *file = fopen(path, "wb");
        fprintf(file, "{");
        int count = 0;
        for (uint32_t i = 0; i < nodes.count; i++) {
            const ewa_octree_key *n = &nodes.keys[i];
            const int32_t steps = n->level - 1;
            if (steps < 0 || n->cell[0] >> steps != k.cell[0] || n->cell[1] >> steps != k.cell[1] ||
                n->cell[2] >> steps != k.cell[2])
                continue;
            fprintf(file, "%s\"%d-%d-%d-%d\":%d", count++ ? "," : "", n->level, n->cell[0], n->cell[1],
                    n->cell[2], (int)ewa_cloud_point_count(nodes.pieces[i]));
        }
        fprintf(file, "}");
        fclose(file);
        if (count) fprintf(root, "\"%d-%d-%d-%d\":-1,", 1, k.cell[0], k.cell[1], k.cell[2]);
    }
    for (uint32_t i = 0; i < nodes.count; i++)
        if (nodes.keys[i].level == 0)
            fprintf(root, "\"0-0-0-0\":%d}", (int)ewa_cloud_point_count(nodes.pieces[i]));
    fclose(root);
}

static void empty_folder(void) {
    static const char *const parts[] = {"ept-data", "ept-hierarchy", "."};
    for (int i = 0; i < 3; i++) {
        char path[600], file[1200];
        DIR *listing = opendir(within(parts[i], path));
        for (struct dirent *entry; listing && (entry = readdir(listing));) {
            snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
            unlink(file);
        }
        if (listing) closedir(listing);
        rmdir(path);
    }
    rmdir(folder);
}

static void write_folder(int encoding) {
    char path[600];
    mkdir(folder, 0777);
    mkdir(within("ept-data", path), 0777);
    mkdir(within("ept-hierarchy", path), 0777);
    write_description(encodings[encoding], NULL);
    write_hierarchy();
    for (uint32_t i = 0; i < nodes.count; i++) write_node(encoding, i);
}

static int begin(void **state) {
    messages = (check_log){0};
    context = check_context(2, &messages);
    scratch_path("tiles", folder);
    empty_folder();
    cloud = copc_cloud(context, POINTS, true);
    void *overlap;
    // So that every piece is written in the newer point formats.
    assert_int_equal(ewa_cloud_add(cloud, "overlap", EWA_U8, 1, &overlap), EWA_OK);
    memset(overlap, 0, POINTS);
    nodes = copc_share(cloud, LEVELS);
    return 0;
}

static int end(void **state) {
    empty_folder();
    copc_nodes_free(&nodes);
    ewa_cloud_destroy(&cloud);
    ewa_context_destroy(&context);
    return 0;
}

static ewa_octree *open_folder(const char *path) {
    ewa_octree *octree = NULL;
    assert_true(ewa_octree_is(context, path));
    if (ewa_octree_open(context, path, &octree) != EWA_OK) fail_msg("%s", messages.text);
    return octree;
}

/// Opens the folder and reads all of it; the first failure.
static ewa_status try_folder(void) {
    messages = (check_log){0};
    const ewa_status status = copc_open_and_read(context, folder);
    assert_true(status == EWA_OK || strncmp(messages.text, folder, strlen(folder)) == 0);
    return status;
}

TEST_WITHIN(reads_all_encodings, begin, end) {
    for (int encoding = 0; encoding < ENCODING_COUNT; encoding++) {
        write_folder(encoding);
        char description[600];
        ewa_octree *octree = open_folder(encoding == 1 ? within("ept.json", description) : folder);
        const ewa_octree_facts *facts = ewa_octree_describe(octree);
        assert_string_equal(facts->kind, "EPT 1.1.0");
        assert_int_equal(facts->node_count, nodes.count);
        assert_int_equal(facts->point_count, POINTS);
        assert_true(facts->side_world == 64 && facts->spacing_world == 0.5 && facts->low_world[2] == 90);
        assert_true(facts->bounds.high_world[1] == 4200064 && facts->bounds.finite_count == POINTS);
        assert_string_equal(ewa_cloud_note(facts->prototype, "crs", NULL), "EPSG:32632");
        for (uint32_t i = 0; i < nodes.count; i++) {
            const uint32_t index = ewa_octree_find(octree, &nodes.keys[i]);
            ewa_cloud *read = NULL, *piece = NULL;
            char path[600];
            assert_true(index != UINT32_MAX);
            assert_int_equal(ewa_octree_read(octree, &index, 1, NULL, &read), EWA_OK);
            if (encoding == LASZIP) {
                key_path("ept-data", &nodes.keys[i], "laz", path);
                assert_int_equal(ewa_cloud_load(context, path, &piece), EWA_OK);
                las_compare(piece, read);
                ewa_cloud_destroy(&piece);
            }
            assert_int_equal(ewa_cloud_point_count(read), ewa_cloud_point_count(nodes.pieces[i]));
            assert_int_equal(ewa_cloud_find(read, EWA_COLOR)->type, EWA_U16);
            for (uint64_t p = 0; p < ewa_cloud_point_count(read); p++) {
                static const char *const same[] = {"intensity", "return_number", "classification",
                                                   "gps_time"};
                for (int k = 0; k < 4; k++)
                    assert_true(las_value(read, same[k], p, 0) == las_value(nodes.pieces[i], same[k], p, 0));
                assert_true(las_value(read, EWA_RADIUS, p, 0) ==
                            0.0005 * las_value(nodes.pieces[i], EWA_RADIUS, p, 0));
                for (uint32_t c = 0; c < 3; c++) {
                    assert_true(las_value(read, EWA_COLOR, p, c) ==
                                las_value(nodes.pieces[i], EWA_COLOR, p, c));
                    assert_true(las_world(read, p, c) == las_world(nodes.pieces[i], p, c));
                    if (encoding != LASZIP)
                        assert_true(las_value(read, EWA_NORMAL, p, c) ==
                                    las_value(nodes.pieces[i], EWA_NORMAL, p, c));
                }
                if (encoding == LASZIP) continue;
                assert_true(las_value(read, "scan_angle", p, 0) == (double)(p % 50) - 25);
                assert_true(las_value(read, "OriginId", p, 0) == (double)p);
                assert_true(las_value(read, "Echoes", p, 0) == 1000.0 * (double)p);
            }
            assert_int_equal(ewa_cloud_find(read, EWA_NORMAL)->type, EWA_F32);
            ewa_cloud_destroy(&read);
        }
        // All at once, in another order, the same.
        ewa_status status;
        ewa_cloud **clouds = copc_read_all(octree, &status);
        assert_int_equal(status, EWA_OK);
        copc_free_all(clouds, facts->node_count);
        ewa_octree_close(&octree);
        empty_folder();
    }
    assert_int_equal(messages.count, 0);
}

TEST_WITHIN(reads_positions_of_any_type, begin, end) {
    static const struct {
        const char *type;
        int size_bytes;
        double world;
    } types[] = {{"float", 8, 500000.25}, {"float", 4, 500000.25}, {"signed", 8, -7}, {"unsigned", 2, 65000}};
    write_folder(BINARY);
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        char schema[512], path[600];
        uint8_t record[24];
        int length = 0;
        for (int c = 0; c < 3; c++) {
            uint8_t *to = record + c * types[i].size_bytes;
            const float narrow = (float)types[i].world;
            length += snprintf(schema + length, sizeof schema - (size_t)length,
                               "%s{\"name\":\"%c\",\"type\":\"%s\",\"size\":%d}", c ? "," : "", "XYZ"[c],
                               types[i].type, types[i].size_bytes);
            if (types[i].type[0] != 'f')
                las_put(to, (uint64_t)(int64_t)types[i].world, types[i].size_bytes);
            else if (types[i].size_bytes == 8)
                las_put_f64(to, types[i].world);
            else
                memcpy(to, &narrow, 4);
        }
        write_description("binary", schema);
        write_text("ept-hierarchy/0-0-0-0.json", "{\"0-0-0-0\": 1}");
        scratch_write(within("ept-data/0-0-0-0.bin", path), record, 3 * (size_t)types[i].size_bytes);
        OWNED(ewa_octree_close) ewa_octree *octree = open_folder(folder);
        OWNED(ewa_cloud_destroy) ewa_cloud *read = NULL;
        const uint32_t index = 0;
        assert_int_equal(ewa_octree_read(octree, &index, 1, NULL, &read), EWA_OK);
        for (uint32_t c = 0; c < 3; c++) assert_true(las_world(read, 0, c) == types[i].world);
    }
}

/// A number with scale and offset that is no place.
TEST_WITHIN(reads_scaled_numbers, begin, end) {
    char path[600];
    uint8_t record[14] = {0};
    write_folder(BINARY);
    for (int c = 0; c < 3; c++) las_put(record + 4 * c, 5, 4);
    las_put(record + 12, (uint64_t)(int64_t)-7, 2);
    write_description("binary", "{\"name\":\"X\",\"type\":\"signed\",\"size\":4},{\"name\":\"Y\",\"type\":\"signed\",\"size\":4},"
                                "{\"name\":\"Z\",\"type\":\"signed\",\"size\":4},"
                                "{\"name\":\"Heat\",\"type\":\"signed\",\"size\":2,\"scale\":0.5,\"offset\":20}");
    write_text("ept-hierarchy/0-0-0-0.json", "{\"0-0-0-0\": 1}");
    scratch_write(within("ept-data/0-0-0-0.bin", path), record, sizeof record);
    OWNED(ewa_octree_close) ewa_octree *octree = open_folder(folder);
    OWNED(ewa_cloud_destroy) ewa_cloud *read = NULL;
    const uint32_t index = 0;
    assert_int_equal(ewa_octree_read(octree, &index, 1, NULL, &read), EWA_OK);
    assert_true(las_value(read, "Heat", 0, 0) == 16.5);
    for (uint32_t c = 0; c < 3; c++) assert_true(las_world(read, 0, c) == 5);
}

TEST_WITHIN(takes_narrow_colors_for_all, begin, end) {
    write_folder(BINARY);
    // One byte twice in all nodes, of which each would be looked at alone.
    for (uint32_t i = 0; i < nodes.count; i++) {
        char path[600];
        OWNED(check_free) uint8_t *records = make_records(nodes.pieces[i]);
        for (uint64_t p = 0; p < ewa_cloud_point_count(nodes.pieces[i]); p++)
            for (int c = 0; c < 3; c++)
                records[p * RECORD_BYTES + 25 + 2 * c] = records[p * RECORD_BYTES + 26 + 2 * c];
        key_path("ept-data", &nodes.keys[i], "bin", path);
        scratch_write(path, records, ewa_cloud_point_count(nodes.pieces[i]) * RECORD_BYTES);
    }
    OWNED(ewa_octree_close) ewa_octree *octree = open_folder(folder);
    const uint32_t index = ewa_octree_find(octree, &nodes.keys[0]);
    OWNED(ewa_cloud_destroy) ewa_cloud *read = NULL;
    assert_int_equal(ewa_octree_read(octree, &index, 1, "color", &read), EWA_OK);
    assert_int_equal(ewa_cloud_attribute_count(read), 2);
    assert_int_equal(ewa_cloud_find(read, EWA_COLOR)->type, EWA_U8);
    assert_true(las_value(read, EWA_COLOR, 0, 1) == floor(las_value(nodes.pieces[0], EWA_COLOR, 0, 1) / 256));
}

TEST_WITHIN(says_which_node_is_missing_or_miscounted, begin, end) {
    for (int encoding = 0; encoding < ENCODING_COUNT; encoding++) {
        // The last node: at every level the first is the tree's pattern.
        const ewa_octree_key *k = &nodes.keys[nodes.count - 1];
        char path[600], key[64];
        size_t size_bytes;
        snprintf(key, sizeof key, "%d-%d-%d-%d", k->level, k->cell[0], k->cell[1], k->cell[2]);
        write_folder(encoding);
        key_path("ept-data", k, suffixes[encoding], path);
        uint8_t *bytes = scratch_read(path, &size_bytes);
        for (size_t size = 0; size < size_bytes; size += 1 + size_bytes / 50) {
            scratch_write(path, bytes, size);
            assert_int_equal(try_folder(), EWA_ERROR_FORMAT);
            assert_non_null(strstr(messages.text, key));
        }
        free(bytes);
        unlink(path);
        assert_int_equal(try_folder(), EWA_ERROR_IO);
        assert_non_null(strstr(messages.text, key));
        for (uint32_t i = 0; i + 1 < nodes.count; i++) {
            if (nodes.keys[i].level == 0 || ewa_cloud_point_count(nodes.pieces[i]) ==
                                                ewa_cloud_point_count(nodes.pieces[nodes.count - 1]))
                continue;
            char other[600];
            key_path("ept-data", &nodes.keys[i], suffixes[encoding], other);
            bytes = scratch_read(other, &size_bytes);
            scratch_write(path, bytes, size_bytes);
            free(bytes);
            assert_int_equal(try_folder(), EWA_ERROR_FORMAT);
            assert_non_null(strstr(messages.text, key));
            break;
        }
        empty_folder();
    }
}

TEST_WITHIN(refuses_files_that_are_not_alike, begin, end) {
    char path[600];
    ewa_cloud *piece = nodes.pieces[nodes.count - 1];
    ewa_coordinate_grid grid;
    write_folder(LASZIP);
    key_path("ept-data", &nodes.keys[nodes.count - 1], "laz", path);
    ewa_cloud_grid(piece, &grid);
    grid.step_world[1] = 0.002;
    ewa_cloud_set_grid(piece, &grid);
    assert_int_equal(ewa_cloud_save(piece, path, NULL), EWA_OK);
    assert_int_equal(try_folder(), EWA_ERROR_FORMAT);
    assert_non_null(strstr(messages.text, "another grid"));
    scratch_write(path, "LASF", 4);
    assert_int_equal(try_folder(), EWA_ERROR_FORMAT);
    scratch_write(path, "", 0);
    assert_int_equal(try_folder(), EWA_ERROR_FORMAT);
}

TEST_WITHIN(refuses_hierarchies_that_lead_nowhere, begin, end) {
    write_folder(BINARY);
    static const char *const bad[] = {
        "",
        "{",
        "[]",
        "{\"0-0-0-0\": \"1\"}",
        "{\"0-0-0-0\": -2}",
        "{\"0-0-0-0\": 1.5}",
        "{\"0-0-0-0\": 1e300}",
        "{\"0-0-0-0\": -1}",
        "{\"0-0-0-0\": 1, \"0-0-0-0\": 1}",
        "{\"../../0-0-0-0\": 1}",
        "{\"1-0-0-0/../../../x\": -1}",
        "{\"/etc/passwd\": -1}",
        "{\"1-0-0\": 1}",
        "{\"1-0-0-0-0\": 1}",
        "{\"1-0-0-2\": 1}",
        "{\"31-0-0-0\": 1}",
        "{\"-1-0-0-0\": 1}",
        "{\"+1-0-0-0\": 1}",
        "{\" 1-0-0-0\": 1}",
        "{\"1-0-0-0x\": 1}",
        "{\"99999999999999999999-0-0-0\": 1}",
        "{\"1-0-0-0\": -1, \"1-0-0-0\": -1}",
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        write_text("ept-hierarchy/0-0-0-0.json", bad[i]);
        if (try_folder() != EWA_ERROR_FORMAT) fail_msg("%s: %s", bad[i], messages.text);
    }
    // A part that leads to itself, back up, and out of its cube.
    static const char *const parts[] = {"{\"1-0-0-0\": -1}", "{\"0-0-0-0\": 5}", "{\"1-1-0-0\": 5}",
                                        "{\"2-2-0-0\": -1}"};
    write_text("ept-hierarchy/0-0-0-0.json", "{\"1-0-0-0\": -1}");
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        write_text("ept-hierarchy/1-0-0-0.json", parts[i]);
        assert_int_equal(try_folder(), EWA_ERROR_FORMAT);
    }
    write_text("ept-hierarchy/1-0-0-0.json", "{\"3-0-0-0\": -1}");
    assert_int_equal(try_folder(), EWA_ERROR_IO);
    assert_non_null(strstr(messages.text, "3-0-0-0.json"));
}

TEST_WITHIN(refuses_descriptions_that_are_none, begin, end) {
#define HEAD                                                                                                 \
    "{\"version\":\"1.1.0\",\"dataType\":\"binary\",\"hierarchyType\":\"json\",\"points\":1,\"span\":128,"
#define BOUNDS "\"bounds\":[0,0,0,1,1,1],"
#define XY     "{\"name\":\"X\",\"type\":\"signed\",\"size\":4},{\"name\":\"Y\",\"type\":\"signed\",\"size\":4}"
    static const struct {
        const char *text;
        ewa_status status;
    } bad[] = {
        {"", EWA_ERROR_FORMAT},
        {"{", EWA_ERROR_FORMAT},
        {"[1]", EWA_ERROR_UNSUPPORTED},
        {"{\"version\":\"2.0.0\"}", EWA_ERROR_UNSUPPORTED},
        {"{\"version\":\"1.0.0\",\"dataType\":\"parquet\"}", EWA_ERROR_UNSUPPORTED},
        {"{\"version\":\"1.0.0\",\"dataType\":\"../binary\"}", EWA_ERROR_UNSUPPORTED},
        {"{\"version\":\"1.0.0\",\"dataType\":\"binary\",\"hierarchyType\":\"gzip\"}", EWA_ERROR_UNSUPPORTED},
        {HEAD "\"schema\":[]}", EWA_ERROR_FORMAT},
        {HEAD "\"bounds\":[0,0,0,1,1,2]}", EWA_ERROR_FORMAT},
        {HEAD "\"bounds\":[1,1,1,0,0,0]}", EWA_ERROR_FORMAT},
        {HEAD BOUNDS "\"schema\":[]}", EWA_ERROR_FORMAT},
        {HEAD BOUNDS "\"schema\":[" XY "]}", EWA_ERROR_FORMAT},
        {HEAD BOUNDS "\"schema\":[" XY ",{\"name\":\"Z\",\"type\":\"signed\",\"size\":3}]}",
         EWA_ERROR_FORMAT},
        {HEAD BOUNDS "\"schema\":[" XY ",{\"name\":\"Z\",\"type\":\"word\",\"size\":4}]}", EWA_ERROR_FORMAT},
        {HEAD BOUNDS "\"schema\":[" XY ",{\"name\":\"Z\",\"type\":\"signed\",\"size\":4,\"scale\":0}]}",
         EWA_ERROR_FORMAT},
        {HEAD BOUNDS "\"schema\":[" XY ",{\"name\":\"Z\",\"type\":\"float\",\"size\":4}]}",
         EWA_ERROR_UNSUPPORTED},
        {HEAD BOUNDS "\"schema\":[" XY ",{\"name\":\"Z\",\"type\":\"signed\",\"size\":4},{\"name\":\"Q\","
                     "\"type\":\"signed\",\"size\":4},{\"name\":\"Q\",\"type\":\"signed\",\"size\":4}]}",
         EWA_ERROR_FORMAT},
    };
    write_folder(BINARY);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        write_text("ept.json", bad[i].text);
        if (try_folder() != bad[i].status) fail_msg("%s: %s", bad[i].text, messages.text);
    }
    char path[600];
    unlink(within("ept.json", path));
    assert_false(ewa_octree_is(context, folder));
    assert_int_equal(try_folder(), EWA_ERROR_UNSUPPORTED);
}

TEST_WITHIN(survives_changed_bytes, begin, end) {
    char path[600];
    check_random random = {3};
    write_folder(ZSTANDARD);
    for (int i = 0; i < 300; i++) {
        static const char *const names[] = {"ept.json", "ept-hierarchy/0-0-0-0.json", "ept-data/0-0-0-0.zst"};
        size_t size_bytes;
        within(names[i % 3], path);
        OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
        const size_t at = check_random_u64(&random) % size_bytes;
        const uint8_t was = bytes[at];
        bytes[at] = (uint8_t)check_random_u64(&random);
        scratch_write(path, bytes, size_bytes);
        const ewa_status status = try_folder();
        assert_true(status == EWA_OK || messages.count > 0);
        bytes[at] = was;
        scratch_write(path, bytes, size_bytes);
    }
}

static ewa_status open_and_read(ewa_context *failing, void *user) {
    (void)user;
    return copc_open_and_read(failing, folder);
}

TEST_WITHIN(survives_memory_that_fails, begin, end) {
    for (int encoding = 0; encoding < ENCODING_COUNT; encoding++) {
        char entries[128];
        uint32_t root = 0, below = 0;
        write_folder(encoding);
        for (uint32_t i = 0; i < nodes.count; i++) *(nodes.keys[i].level ? &below : &root) = i;
        // Two nodes, in a file each.
        const ewa_octree_key *k = &nodes.keys[below];
        snprintf(entries, sizeof entries, "{\"0-0-0-0\":%d,\"%d-%d-%d-%d\":-1}",
                 (int)ewa_cloud_point_count(nodes.pieces[root]), k->level, k->cell[0], k->cell[1],
                 k->cell[2]);
        write_text("ept-hierarchy/0-0-0-0.json", entries);
        char path[600];
        key_path("ept-hierarchy", k, "json", path);
        const int length = snprintf(entries, sizeof entries, "{\"%d-%d-%d-%d\":%d}", k->level, k->cell[0],
                                    k->cell[1], k->cell[2], (int)ewa_cloud_point_count(nodes.pieces[below]));
        scratch_write(path, entries, (size_t)length);
        scratch_fail_each(open_and_read, NULL);
        empty_folder();
    }
}

int main(void) { return RUN_TESTS(NULL, NULL); }
