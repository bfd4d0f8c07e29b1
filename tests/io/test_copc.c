// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// COPC by nodes: what is written is read back, by nodes as by all points; files that are cut, changed or lie.
#include "io/copc_sample.h"
#include "io/las_sample.h"
#include "io/scratch.h"

static check_log messages;
static ewa_context *context;
static char path[512];

static int begin(void **state) {
    messages = (check_log){0};
    context = check_context(2, &messages);
    scratch_path("made.copc.laz", path);
    return 0;
}

static int end(void **state) {
    unlink(path);
    ewa_context_destroy(&context);
    return 0;
}

static ewa_octree *open_made(void) {
    ewa_octree *octree = NULL;
    assert_true(ewa_octree_is(context, path));
    if (ewa_octree_open(context, path, &octree) != EWA_OK) fail_msg("%s", messages.text);
    return octree;
}

/// Writes `count` points as a tree of that many levels.
static void write_made(uint64_t count, int32_t level_count, bool wide_colors, uint64_t levels_bytes) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = copc_cloud(context, count, wide_colors);
    OWNED(copc_nodes_free) copc_nodes nodes = copc_share(cloud, level_count);
    const ewa_octree_plan plan = copc_plan(cloud);
    if (copc_write(context, path, &plan, &nodes, levels_bytes) != EWA_OK) fail_msg("%s", messages.text);
}

/// Numbers that come back: places as decimals, normals and radii times their scales, all else as it was.
static void expect_point(const ewa_cloud *before, const ewa_cloud *after) {
    for (uint32_t a = 0; a < ewa_cloud_attribute_count(before); a++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(before, a);
        const char *name = attribute->name;
        double scale = strcmp(name, EWA_RADIUS) == 0 ? 0.0005 : 1;
        for (uint64_t i = 0; i < ewa_cloud_point_count(before); i++)
            for (uint32_t c = 0; c < attribute->component_count; c++) {
                double left = las_value(before, name, i, c), right = las_value(after, name, i, c);
                if (strcmp(name, EWA_NORMAL) == 0) {
                    assert_int_equal(ewa_cloud_find(after, name)->type, EWA_F32);
                    left = (float)(left * (1.0 / 32767));
                }
                if (strcmp(name, EWA_POSITION) == 0) {
                    left = las_world(before, i, c);
                    right = las_world(after, i, c);
                }
                if (left * scale != right) fail_msg("%s: %.17g, %.17g", name, left * scale, right);
            }
    }
}

TEST_WITHIN(gives_back_what_was_written, begin, end) {
    for (int wide = 0; wide < 2; wide++) {
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = copc_cloud(context, 5000, wide);
        OWNED(copc_nodes_free) copc_nodes nodes = copc_share(cloud, 4);
        const ewa_octree_plan plan = copc_plan(cloud);
        assert_int_equal(copc_write(context, path, &plan, &nodes, 0), EWA_OK);
        ewa_octree *octree = open_made();
        const ewa_octree_facts *facts = ewa_octree_describe(octree);
        assert_string_equal(facts->kind, "COPC 1.0");
        assert_int_equal(facts->node_count, nodes.count);
        assert_int_equal(facts->point_count, 5000);
        assert_true(facts->side_world == copc_side_world && facts->spacing_world == 0.5);
        assert_memory_equal(facts->low_world, copc_low_world, sizeof copc_low_world);
        assert_null(facts->levels);
        ewa_bounds bounds;
        ewa_cloud_measure(cloud, &bounds);
        for (int c = 0; c < 3; c++) {
            assert_true(fabs(bounds.low_world[c] - facts->bounds.low_world[c]) < 1e-6);
            assert_true(fabs(bounds.high_world[c] - facts->bounds.high_world[c]) < 1e-6);
        }
        for (uint32_t i = 1; i < facts->node_count; i++)
            assert_true(ewa_octree_key_compare(&facts->nodes[i - 1].key, &facts->nodes[i].key) < 0);
        for (uint32_t i = 0; i < nodes.count; i++) {
            const uint32_t index = ewa_octree_find(octree, &nodes.keys[i]);
            OWNED(ewa_cloud_destroy) ewa_cloud *read = NULL;
            assert_true(index != UINT32_MAX);
            assert_int_equal(ewa_octree_read(octree, &index, 1, NULL, &read), EWA_OK);
            assert_int_equal(ewa_cloud_point_count(read), ewa_cloud_point_count(nodes.pieces[i]));
            assert_int_equal(ewa_cloud_find(read, EWA_COLOR)->type, wide ? EWA_U16 : EWA_U8);
            expect_point(nodes.pieces[i], read);
        }
        assert_int_equal(ewa_octree_find(octree, &(ewa_octree_key){9, {1, 2, 3}}), UINT32_MAX);
        ewa_octree_close(&octree);
        assert_null(octree);
    }
    assert_int_equal(messages.count, 0);
}

TEST_WITHIN(has_the_points_of_the_whole_file, begin, end) {
    for (int wide = 0; wide < 2; wide++) {
        write_made(20000, 5, wide, 77);
        OWNED(ewa_cloud_destroy) ewa_cloud *whole = NULL;
        assert_int_equal(ewa_cloud_load(context, path, &whole), EWA_OK);
        OWNED(ewa_octree_close) ewa_octree *octree = open_made();
        copc_expect(octree, whole);
    }
    assert_int_equal(messages.count, 0);
}

/// Chunks that count for themselves are read though the header counts nothing.
TEST_WITHIN(reads_what_no_header_counts, begin, end) {
    write_made(20000, 5, false, 0);
    FILE *file = fopen(path, "r+b");
    const uint8_t none[8] = {0};
    assert_non_null(file);
    assert_true(fseek(file, 247, SEEK_SET) == 0 && fwrite(none, sizeof none, 1, file) == 1);
    // A hierarchy would count them: no longer a COPC.
    assert_true(fseek(file, 377, SEEK_SET) == 0 && fwrite("none", 4, 1, file) == 1 && fclose(file) == 0);
    ewa_cloud *whole = NULL;
    assert_int_equal(ewa_cloud_load(context, path, &whole), EWA_OK);
    assert_int_equal(ewa_cloud_point_count(whole), 20000);
    if (!strstr(messages.text, "the header counts no points, the chunks hold 20000")) fail_msg("%s", messages.text);
    ewa_cloud_destroy(&whole);
    messages = (check_log){0};
}

TEST_WITHIN(counts_colors_that_others_do_not_lead_to_expect, begin, end) {
    enum { NODES = 40, ODD = 7 }; // not among the eight chunks that are looked at
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = copc_cloud(context, 2 * NODES, true);
    OWNED(copc_nodes_free)
    copc_nodes nodes = {calloc(NODES, sizeof *nodes.keys), calloc(NODES, sizeof(ewa_cloud *)), NODES};
    for (uint32_t i = 0; i < NODES; i++) {
        const uint64_t indices[2] = {2 * i, 2 * i + 1};
        nodes.keys[i] = (ewa_octree_key){6, {(int32_t)i, 3, 4}};
        assert_int_equal(ewa_cloud_select(cloud, indices, 2, &nodes.pieces[i]), EWA_OK);
        uint16_t *color = ewa_cloud_find(nodes.pieces[i], EWA_COLOR)->data;
        for (int c = 0; c < 6; c++) color[c] = i == ODD && c > 3 ? 300 : (uint16_t)(i + 1);
    }
    const ewa_octree_plan plan = copc_plan(cloud);
    assert_int_equal(copc_write(context, path, &plan, &nodes, 0), EWA_OK);
    OWNED(ewa_cloud_destroy) ewa_cloud *whole = NULL;
    assert_int_equal(ewa_cloud_load(context, path, &whole), EWA_OK);
    assert_int_equal(ewa_cloud_find(whole, EWA_COLOR)->type, EWA_U8);
    messages = (check_log){0};
    ewa_octree *octree = open_made();
    copc_expect(octree, whole);
    assert_int_equal(messages.count, 0);
    ewa_octree_close(&octree);
    assert_non_null(strstr(messages.text, ": 2 numbers of colours are above 255"));
}

TEST_WITHIN(notes_the_times_of_the_points, begin, end) {
    size_t size_bytes;
    write_made(101, 2, false, 0);
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    assert_true(las_get_f64(bytes + 375 + 54 + 56) == 1000 && las_get_f64(bytes + 375 + 54 + 64) == 1025);
}

TEST_WITHIN(reads_files_of_others, begin, end) {
    static const char *const files[] = {"simple.copc.laz", "simple_with_page.copc.laz",
                                        "lion_takanawa.copc.laz"};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char relative[128], real[512];
        snprintf(relative, sizeof relative, "clouds/laz/%s", files[i]);
        if (!check_data(relative, real, sizeof real)) continue;
        OWNED(ewa_cloud_destroy) ewa_cloud *whole = NULL;
        OWNED(ewa_octree_close) ewa_octree *octree = NULL;
        assert_true(ewa_octree_is(context, real));
        assert_int_equal(ewa_cloud_load(context, real, &whole), EWA_OK);
        assert_int_equal(ewa_octree_open(context, real, &octree), EWA_OK);
        copc_expect(octree, whole);
    }
    assert_int_equal(messages.count, 0);
}

TEST_WITHIN(reads_the_attributes_that_are_wanted, begin, end) {
    write_made(100, 1, false, 0);
    OWNED(ewa_octree_close) ewa_octree *octree = open_made();
    const uint32_t index = 0;
    ewa_cloud *read = NULL;
    assert_int_equal(ewa_octree_read(octree, &index, 1, "normal,gps_time,none", &read), EWA_OK);
    assert_int_equal(ewa_cloud_attribute_count(read), 3);
    assert_non_null(ewa_cloud_find(read, EWA_NORMAL));
    assert_int_equal(ewa_octree_read(octree, &index, 0, NULL, NULL), EWA_OK);
    ewa_cloud_destroy(&read);
    const uint32_t beyond = 1;
    assert_int_equal(ewa_octree_read(octree, &beyond, 1, NULL, &read), EWA_ERROR_ARGUMENT);
    assert_null(read);
}

TEST_WITHIN(is_the_same_for_any_number_of_threads, begin, end) {
    size_t size_bytes = 0, other_bytes;
    OWNED(check_free) uint8_t *bytes = NULL;
    ewa_context *kept = context;
    for (uint32_t threads = 1; threads <= 3; threads++) {
        context = check_context(threads, &messages);
        write_made(3000, 4, true, 1001);
        uint8_t *other = scratch_read(path, &other_bytes);
        if (bytes) {
            assert_int_equal(other_bytes, size_bytes);
            assert_memory_equal(bytes, other, size_bytes);
            free(other);
        } else {
            bytes = other;
            size_bytes = other_bytes;
        }
        ewa_context_destroy(&context);
    }
    context = kept;
}

TEST_WITHIN(keeps_levels_of_any_size, begin, end) {
    for (uint64_t size = 1; size < 70000; size = size * 5 + 2) {
        write_made(50, 2, false, size);
        OWNED(ewa_octree_close) ewa_octree *octree = open_made();
        const ewa_octree_facts *facts = ewa_octree_describe(octree);
        assert_int_equal(facts->levels_bytes, size);
        for (uint64_t i = 0; i < size; i++) assert_int_equal(facts->levels[i], (uint8_t)(i * 31));
        // What is made from the cloud has no part in the levels.
        assert_null(ewa_cloud_note(facts->prototype, "las.vlrs", NULL));
    }
}

/// A tree of one point in each of many nodes.
static copc_nodes make_many(const ewa_cloud *cloud, uint32_t count) {
    copc_nodes nodes = {calloc(count, sizeof *nodes.keys), calloc(count, sizeof(ewa_cloud *)), count};
    assert_true(nodes.keys && nodes.pieces);
    const uint64_t first = 0;
    for (uint32_t i = 0; i < count; i++) {
        // A surface: four of eight children. Level 2 has none, so that readers need entries without points.
        int32_t level = 0;
        uint32_t before = 0;
        while (i - before >= 1u << (2 * level)) before += 1u << (2 * level++);
        const uint32_t at = i - before;
        if (level >= 2) level++;
        nodes.keys[i] =
            (ewa_octree_key){level, {(int32_t)(at & ((1u << level) - 1)), 0, (int32_t)(at >> level)}};
        assert_int_equal(ewa_cloud_select(cloud, &first, 1, &nodes.pieces[i]), EWA_OK);
    }
    return nodes;
}

TEST_WITHIN(writes_many_nodes_in_pages, begin, end) {
    enum { COUNT = 5461, PAGE_ENTRIES = 1000, ENTRY_BYTES = 32 };
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = copc_cloud(context, 1, false);
    OWNED(copc_nodes_free) copc_nodes nodes = make_many(cloud, COUNT);
    const ewa_octree_plan plan = copc_plan(cloud);
    assert_int_equal(copc_write(context, path, &plan, &nodes, 3), EWA_OK);
    OWNED(ewa_octree_close) ewa_octree *octree = open_made();
    const ewa_octree_facts *facts = ewa_octree_describe(octree);
    assert_int_equal(facts->node_count, COUNT);
    for (uint32_t i = 0; i < COUNT; i++) assert_true(ewa_octree_find(octree, &nodes.keys[i]) != UINT32_MAX);
    ewa_status status;
    ewa_cloud **clouds = copc_read_all(octree, &status);
    assert_int_equal(status, EWA_OK);
    copc_free_all(clouds, COUNT);
    // From page to page as readers go that look for one cube: every entry's parent is in its page, but the root's.
    size_t size_bytes;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    size_t page_at[COUNT], page_bytes[COUNT], pages = 1, entries = 0, empty = 0;
    page_at[0] = las_get(bytes + 375 + 54 + 40, 8);
    page_bytes[0] = las_get(bytes + 375 + 54 + 48, 8);
    for (size_t p = 0; p < pages; p++) {
        const uint8_t *page = bytes + page_at[p];
        const size_t count = page_bytes[p] / ENTRY_BYTES;
        assert_true(count <= PAGE_ENTRIES && page_at[p] + page_bytes[p] <= size_bytes);
        for (size_t i = 0; i < count; i++) {
            const uint8_t *entry = page + i * ENTRY_BYTES;
            bool found = i == 0;
            for (size_t k = 0; k < i && !found; k++) {
                found = las_get(page + k * ENTRY_BYTES, 4) + 1 == las_get(entry, 4);
                for (int c = 1; c <= 3; c++)
                    found =
                        found && las_get(page + k * ENTRY_BYTES + 4 * c, 4) == las_get(entry + 4 * c, 4) / 2;
            }
            assert_true(found);
            const int32_t point_count = (int32_t)las_get(entry + 28, 4);
            entries += point_count >= 0;
            empty += point_count == 0;
            if (point_count >= 0) continue;
            page_at[pages] = las_get(entry + 16, 8);
            page_bytes[pages++] = las_get(entry + 24, 4);
        }
    }
    assert_true(pages > 3);
    assert_true(empty > 0);
    assert_int_equal(entries, COUNT + empty);
}

TEST_WITHIN(writes_trees_without_nodes, begin, end) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = copc_cloud(context, 0, false);
    const ewa_octree_plan plan = copc_plan(cloud);
    const ewa_octree_key key = {0, {0, 0, 0}};
    ewa_cloud *const pieces[1] = {cloud};
    const copc_nodes nodes[2] = {{0}, {(ewa_octree_key *)&key, (ewa_cloud **)pieces, 1}};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(copc_write(context, path, &plan, &nodes[i], 0), EWA_OK);
        OWNED(ewa_octree_close) ewa_octree *octree = open_made();
        assert_int_equal(ewa_octree_describe(octree)->node_count, 0);
        assert_int_equal(ewa_octree_describe(octree)->point_count, 0);
    }
}

/// Writes a tree of a cloud with that note about its system, and holds header and records to what LAS 1.4 says of point
/// format 6 to 8 and COPC of its first record: the bit of well-known text, that text or NULL, and GeoTIFF keys.
static void expect_system(const char *crs, const char *wkt_begin, const char *wkt_end, bool has_keys) {
    ewa_cloud *cloud = copc_cloud(context, 200, false);
    if (crs) ewa_cloud_set_note(cloud, "crs", crs, strlen(crs));
    copc_nodes nodes = copc_share(cloud, 2);
    const ewa_octree_plan plan = copc_plan(cloud);
    if (copc_write(context, path, &plan, &nodes, 0) != EWA_OK) fail_msg("%s", messages.text);
    copc_nodes_free(&nodes);
    ewa_cloud_destroy(&cloud);
    size_t size;
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size);
    assert_true(bytes[24] == 1 && bytes[25] == 4);
    assert_int_equal(las_get(bytes + 94, 2), 375);
    assert_true(las_get(bytes + 6, 2) & 16);
    assert_true((bytes[104] & 0x3f) >= 6 && (bytes[104] & 0x3f) <= 8);
    // Counts of 32 bits must be 0 in these point formats.
    for (int i = 107; i < 131; i++) assert_int_equal(bytes[i], 0);
    const char *wkt = NULL;
    size_t wkt_bytes = 0, at = 375;
    bool keys = false;
    for (uint64_t i = 0; i < las_get(bytes + 100, 4); i++) {
        const uint8_t *head = bytes + at;
        const uint64_t id = las_get(head + 18, 2), record_bytes = las_get(head + 20, 2);
        if (i == 0) assert_true(memcmp(head + 2, "copc\0", 5) == 0 && id == 1 && record_bytes == 160);
        if (memcmp(head + 2, "LASF_Projection", 16) == 0 && id == 2112) wkt = (const char *)head + 54, wkt_bytes = record_bytes;
        if (memcmp(head + 2, "LASF_Projection", 16) == 0 && id == 34735) keys = true;
        at += 54 + record_bytes;
    }
    assert_int_equal(at, las_get(bytes + 96, 4));
    assert_int_equal(keys, has_keys);
    assert_int_equal(wkt != NULL, wkt_begin != NULL);
    if (wkt_begin) {
        const size_t end_bytes = strlen(wkt_end);
        assert_memory_equal(wkt, wkt_begin, strlen(wkt_begin));
        assert_true(wkt_bytes > end_bytes && wkt[wkt_bytes - 1] == 0);
        assert_string_equal(wkt + wkt_bytes - 1 - end_bytes, wkt_end);
    }
}

TEST_WITHIN(has_its_system_as_text, begin, end) {
    expect_system(NULL, NULL, NULL, false);
    expect_system("EPSG:25832+7837", "COMPD_CS[\"ETRS89 / UTM zone 32N + DHHN2016 height\",PROJCS[\"ETRS89 / UTM zone 32N\",",
                  "AXIS[\"Gravity-related height\",UP],AUTHORITY[\"EPSG\",\"7837\"]]]", false);
    expect_system("EPSG:32723", "PROJCS[\"WGS 84 / UTM zone 23S\",GEOGCS[\"WGS 84\",", "AUTHORITY[\"EPSG\",\"32723\"]]", false);
    expect_system("EPSG:2154", "PROJCS[\"RGF93 v1 / Lambert-93\",", "AUTHORITY[\"EPSG\",\"2154\"]]", false);
    expect_system("EPSG:4326", "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",", "AUTHORITY[\"EPSG\",\"4326\"]]", false);
    expect_system("LOCAL_CS[\"ours\"]", "LOCAL_CS[\"ours\"]", "LOCAL_CS[\"ours\"]", false);
    assert_string_equal(messages.text, "");
    expect_system("EPSG:2285", NULL, NULL, true);
    assert_non_null(strstr(messages.text, "EPSG:2285 is written as GeoTIFF keys"));
    messages.text[0] = 0;
    // A known system with heights of an unknown one would be another system.
    expect_system("EPSG:25832+8228", NULL, NULL, true);
    assert_non_null(strstr(messages.text, "EPSG:25832+8228 is written as GeoTIFF keys"));
}

/// The keys of a file in an older point format become text, and are gone.
TEST_WITHIN(makes_text_of_keys, begin, end) {
    const uint8_t keys[] = {1, 0, 1, 0, 0, 0, 2, 0, 0, 4, 0, 0, 1, 0, 1, 0, 0, 12, 0, 0, 1, 0, 0x17, 0x69};
    uint8_t vlr[200];
    const size_t vlr_bytes = las_vlr(vlr, "LASF_Projection", 34735, keys, sizeof keys);
    las_sample sample = las_make(0, 2, 0, 50, vlr, vlr_bytes, 1);
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = las_load(context, &sample), *back = NULL;
    assert_string_equal(ewa_cloud_note(cloud, "crs", NULL), "EPSG:26903");
    const ewa_octree_plan plan = {cloud, .bounds = {{0, 0, 0}, {1, 1, 1}}, {0, 0, 0}, 1, 1};
    const copc_nodes none = {0};
    assert_int_equal(copc_write(context, path, &plan, &none, 0), EWA_OK);
    assert_int_equal(ewa_cloud_load(context, path, &back), EWA_OK);
    assert_string_equal(ewa_cloud_note(back, "crs_name", NULL), "NAD83 / UTM zone 3N");
    assert_memory_equal(ewa_cloud_note(back, "crs", NULL), "PROJCS[", 7);
    free(sample.bytes);
}

TEST_WITHIN(refuses_what_it_cannot_write, begin, end) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = copc_cloud(context, 10, false), *other = copc_cloud(context, 10, true);
    ewa_octree_plan plan = copc_plan(cloud);
    ewa_octree_key keys[2] = {{1, {0, 1, 0}}, {1, {0, 1, 0}}};
    ewa_cloud *pieces[2] = {cloud, cloud};
    copc_nodes nodes = {keys, pieces, 2};
    assert_int_equal(ewa_cloud_save(cloud, path, NULL), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(messages.text, "made.copc.laz: a file of that name is an octree (COPC), which ewa_lod_build() makes"));
    assert_int_equal(copc_write(context, path, &plan, &nodes, 0), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.text, "1-0-1-0 comes twice"));
    assert_int_not_equal(access(path, F_OK), 0);
    keys[1].cell[1] = 2;
    assert_int_equal(copc_write(context, path, &plan, &nodes, 0), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.text, "no node 1-0-2-0"));
    keys[1].cell[1] = 0;
    pieces[1] = other;
    assert_int_equal(copc_write(context, path, &plan, &nodes, 0), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.text, "other attributes"));
    nodes.count = 1;
    plan.side_world = 0;
    assert_int_equal(copc_write(context, path, &plan, &nodes, 0), EWA_ERROR_ARGUMENT);
    plan.side_world = 64;
    plan.bounds.high_world[0] += 1e12;
    assert_int_equal(copc_write(context, path, &plan, &nodes, 0), EWA_ERROR_LIMIT);
    plan = copc_plan(cloud);
    assert_int_equal(copc_write(context, "/dev/null", &plan, &nodes, 0), EWA_ERROR_UNSUPPORTED);
    ewa_octree_writer *writer = NULL;
    assert_int_equal(ewa_octree_writer_open(context, path, &plan, &writer), EWA_OK);
    assert_int_equal(ewa_octree_levels_begin(writer, 3), EWA_OK);
    assert_int_equal(ewa_octree_levels_begin(writer, 3), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_octree_levels_put(writer, "1234", 4), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_octree_levels_put(writer, "12", 2), EWA_OK);
    const ewa_octree_chunk late = {.point_count = 1};
    assert_int_equal(ewa_octree_append(writer, &late), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_octree_writer_commit(&writer), EWA_ERROR_ARGUMENT);
    assert_null(writer);
    assert_int_not_equal(access(path, F_OK), 0);
}

/// Opens the bytes as a file and reads all nodes; the first failure.
static ewa_status try_bytes(const uint8_t *bytes, size_t size_bytes) {
    messages = (check_log){0};
    scratch_write(path, bytes, size_bytes);
    const ewa_status status = copc_open_and_read(context, path);
    if (status != EWA_OK) assert_true(strncmp(messages.text, path, strlen(path)) == 0);
    return status;
}

TEST_WITHIN(refuses_every_beginning, begin, end) {
    size_t size_bytes;
    write_made(12, 2, false, 0);
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    for (size_t size = 0; size < size_bytes; size++)
        if (try_bytes(bytes, size) == EWA_OK) fail_msg("%zu bytes of %zu are taken", size, size_bytes);
    assert_int_equal(try_bytes(bytes, size_bytes), EWA_OK);
    check_random random = {5};
    for (int i = 0; i < 600; i++) {
        OWNED(check_free) uint8_t *changed = malloc(size_bytes);
        memcpy(changed, bytes, size_bytes);
        for (int k = 0; k < 2; k++)
            changed[check_random_u64(&random) % size_bytes] = (uint8_t)check_random_u64(&random);
        const ewa_status status = try_bytes(changed, size_bytes);
        assert_true(status == EWA_OK || messages.count > 0);
    }
}

TEST_WITHIN(refuses_hierarchies_that_lie, begin, end) {
    enum { ENTRY_BYTES = 32 };
    size_t size_bytes;
    write_made(400, 2, false, 0);
    OWNED(check_free) uint8_t *bytes = scratch_read(path, &size_bytes);
    const size_t root_at = las_get(bytes + 375 + 54 + 40, 8);
    const struct {
        const char *what;
        size_t at;
        uint64_t value;
        int count;
        const char *said;
    } lies[] = {
        {"a point more", root_at + 28, las_get(bytes + root_at + 28, 4) + 1, 4, "node 0-0-0-0"},
        {"a point less", root_at + 28, las_get(bytes + root_at + 28, 4) - 1, 4, "node 0-0-0-0"},
        {"too many points", root_at + 28, 0x7fffffff, 4, "0-0-0-0"},
        {"points below none", root_at + 28, (uint64_t)-2, 4, "0-0-0-0"},
        {"a chunk beyond the file", root_at + 16, size_bytes, 8, "0-0-0-0"},
        {"a chunk far beyond", root_at + 16, UINT64_MAX, 8, "0-0-0-0"},
        {"a chunk too long", root_at + 24, size_bytes, 4, "0-0-0-0"},
        {"a chunk elsewhere", root_at + 16, 400, 8, "0-0-0-0"},
        {"a cell beside the cube", root_at + ENTRY_BYTES + 4, 2, 4, "1-2-"},
        {"a level too deep", root_at + ENTRY_BYTES, 31, 4, "31-"},
        {"the root twice", root_at + ENTRY_BYTES, 0, 4, "0-0-0-0 comes twice"},
        {"a page in itself", root_at + 28, (uint64_t)-1, 4, "page"},
        {"no root page", 375 + 54 + 48, 0, 8, "page"},
        {"a page beyond the file", 375 + 54 + 40, size_bytes - 8, 8, "page"},
        {"no side", 375 + 54 + 24, 0, 8, "half a side of 0"},
    };
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        OWNED(check_free) uint8_t *changed = malloc(size_bytes);
        memcpy(changed, bytes, size_bytes);
        las_put(changed + lies[i].at, lies[i].value, lies[i].count);
        if (strcmp(lies[i].what, "a page in itself") == 0) {
            las_put(changed + root_at + 16, root_at, 8);
            las_put(changed + root_at + 24, las_get(bytes + 375 + 54 + 48, 8), 4);
        }
        if (try_bytes(changed, size_bytes) != EWA_ERROR_FORMAT || !strstr(messages.text, lies[i].said))
            fail_msg("%s: '%s'", lies[i].what, messages.text);
    }
}

TEST_WITHIN(is_no_other_file, begin, end) {
    ewa_octree *octree = NULL;
    assert_false(ewa_octree_is(context, "/nowhere/at/all"));
    assert_false(ewa_octree_is(context, "/tmp"));
    assert_false(ewa_octree_is(context, "/dev/null"));
    assert_int_equal(messages.count, 0);
    assert_int_equal(ewa_octree_open(context, "/nowhere/at/all", &octree), EWA_ERROR_UNSUPPORTED);
    las_sample plain = las_make(7, 4, 0, 10, NULL, 0, 0);
    assert_int_equal(try_bytes(plain.bytes, plain.size_bytes), EWA_ERROR_UNSUPPORTED);
    assert_false(ewa_octree_is(context, path));
    free(plain.bytes);
}

static ewa_status write_and_read(ewa_context *failing, void *user) {
    const copc_nodes *nodes = user;
    const ewa_octree_plan plan = copc_plan(nodes->pieces[0]);
    EWA_TRY(copc_write(failing, path, &plan, nodes, 5));
    return copc_open_and_read(failing, path);
}

TEST_WITHIN(survives_memory_that_fails, begin, end) {
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = copc_cloud(context, 40, false);
    OWNED(copc_nodes_free) copc_nodes nodes = copc_share(cloud, 2);
    scratch_fail_each(write_and_read, &nodes);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
