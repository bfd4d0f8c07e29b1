// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of E57: what is read of scans of every kind, what is refused, what is stepped over. The files are made
// here, by a writer of packets, pages and checksums of its own.
#include "io/cloud_check.h"

#include "io/e57/e57.h"
#include "io/scratch.h"

#include <math.h>

#include "io/fixture.h"

// ---- a writer --------------------------------------------------------------------------------------------

enum { PAGE = 1024, PAYLOAD = PAGE - 4, MAX_FIELDS = 12, PACKET_RECORDS = 500 };

/// Bits as they follow each other, the lowest first.
typedef struct bits {
    cloud_bytes bytes;
    uint32_t used; ///< of the last byte
} bits;

static void put_bits(bits *to, uint64_t value, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        if (to->used == 0) cloud_put(&to->bytes, "", 1);
        to->bytes.bytes[to->bytes.size - 1] |= (uint8_t)((value >> i & 1) << to->used);
        to->used = (to->used + 1) % 8;
    }
}

/// One field: its XML, its bits, and its numbers, by record.
typedef struct made_field {
    const char *xml;
    uint32_t bit_count;
    uint64_t (*raw)(uint32_t record);
} made_field;

typedef struct made_scan {
    const made_field *fields;
    uint32_t field_count, record_count;
    const char *more; ///< XML beside the points
} made_scan;

static uint64_t physical(uint64_t logical) { return logical / PAYLOAD * PAGE + logical % PAYLOAD; }

static void put_le(cloud_bytes *to, uint64_t value, int size) {
    for (int i = 0; i < size; i++) {
        const uint8_t byte = (uint8_t)(i < 8 ? value >> 8 * i : 0);
        cloud_put(to, &byte, 1);
    }
}

/// Bits are not cut where records end: packets hold whole bytes of every field.
static void put_packets(cloud_bytes *to, const made_scan *scan) {
    bits streams[MAX_FIELDS] = {{{0}, 0}};
    size_t taken[MAX_FIELDS] = {0};
    for (uint32_t first = 0; first < scan->record_count; first += PACKET_RECORDS) {
        const uint32_t last =
            first + PACKET_RECORDS < scan->record_count ? first + PACKET_RECORDS : scan->record_count;
        size_t sizes[MAX_FIELDS], size = 6 + 2 * scan->field_count;
        for (uint32_t f = 0; f < scan->field_count; f++) {
            for (uint32_t r = first; r < last; r++)
                put_bits(&streams[f], scan->fields[f].raw(r), scan->fields[f].bit_count);
            const bool whole = last == scan->record_count || streams[f].used == 0;
            sizes[f] = streams[f].bytes.size - taken[f] - !whole;
            size += sizes[f];
        }
        const size_t padding = (4 - size % 4) % 4;
        put_le(to, 1, 2);
        put_le(to, size + padding - 1, 2);
        put_le(to, scan->field_count, 2);
        for (uint32_t f = 0; f < scan->field_count; f++) put_le(to, sizes[f], 2);
        for (uint32_t f = 0; f < scan->field_count; f++) {
            cloud_put(to, streams[f].bytes.bytes + taken[f], sizes[f]);
            taken[f] += sizes[f];
        }
        cloud_put(to, "\0\0\0", padding);
        // What a reader has to step over: an empty packet and an index.
        put_le(to, 2 | 7u << 16, 8);
        put_le(to, 15u << 16, 16);
    }
    for (uint32_t f = 0; f < scan->field_count; f++) free(streams[f].bytes.bytes);
}

static uint32_t slow_checksum(const uint8_t *bytes, size_t size) {
    uint32_t rest = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        rest ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) rest = rest >> 1 ^ (rest & 1 ? 0x82f63b78u : 0);
    }
    return ~rest;
}

static void fit_checksum(uint8_t *page) {
    const uint32_t checksum = slow_checksum(page, PAYLOAD);
    for (int i = 0; i < 4; i++) page[PAYLOAD + i] = (uint8_t)(checksum >> (24 - 8 * i));
}

static void put_text(cloud_bytes *to, const char *text) { cloud_put(to, text, strlen(text)); }

static cloud_bytes make(const made_scan *scans, uint32_t scan_count, const char *more) {
    cloud_bytes logical = {0}, xml = {0}, file = {0};
    char text[512];
    put_le(&logical, 0, 48);
    put_text(&xml, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\">\n"
                   "<guid type=\"String\"><![CDATA[{1-2}]]></guid>");
    put_text(&xml, more);
    put_text(&xml, "<data3D type=\"Vector\">");
    for (uint32_t s = 0; s < scan_count; s++) {
        const size_t at = logical.size;
        cloud_bytes packets = {0};
        put_packets(&packets, &scans[s]);
        put_le(&logical, 1, 8);
        put_le(&logical, 32 + packets.size, 8);
        put_le(&logical, physical(at + 32), 8);
        put_le(&logical, 0, 8);
        cloud_put(&logical, packets.bytes, packets.size);
        free(packets.bytes);
        put_text(&xml, "<vectorChild type=\"Structure\">");
        put_text(&xml, scans[s].more);
        snprintf(text, sizeof text,
                 "<points type=\"CompressedVector\" fileOffset=\"%llu\" recordCount=\"%u\"><prototype>\n",
                 (unsigned long long)physical(at), scans[s].record_count);
        put_text(&xml, text);
        for (uint32_t f = 0; f < scans[s].field_count; f++) put_text(&xml, scans[s].fields[f].xml);
        put_text(&xml, "</prototype></points></vectorChild>");
    }
    put_text(&xml, "</data3D><images2D type=\"Vector\"><vectorChild/><vectorChild/></images2D></e57Root>");
    const size_t xml_at = logical.size;
    cloud_put(&logical, xml.bytes, xml.size);
    const size_t pages = (logical.size + PAYLOAD - 1) / PAYLOAD;
    cloud_bytes header = {0};
    put_text(&header, "ASTM-E57");
    put_le(&header, 1, 4);
    put_le(&header, 0, 4);
    put_le(&header, pages * PAGE, 8);
    put_le(&header, physical(xml_at), 8);
    put_le(&header, xml.size, 8);
    put_le(&header, PAGE, 8);
    memcpy(logical.bytes, header.bytes, 48);
    for (size_t page = 0; page < pages; page++) {
        uint8_t bytes[PAGE] = {0};
        const size_t left = logical.size - page * PAYLOAD;
        memcpy(bytes, logical.bytes + page * PAYLOAD, left < PAYLOAD ? left : PAYLOAD);
        fit_checksum(bytes);
        cloud_put(&file, bytes, PAGE);
    }
    free(logical.bytes);
    free(xml.bytes);
    free(header.bytes);
    return file;
}

static ewa_cloud *load(const cloud_bytes *file) {
    ewa_cloud *cloud = NULL;
    if (ewa_cloud_load_memory(context, file->bytes, file->size, "sample.e57", &cloud) != EWA_OK)
        fail_msg("%s", messages.text);
    return cloud;
}

// ---- fields ----------------------------------------------------------------------------------------------

static uint64_t bits_of_float(float value) {
    uint32_t raw;
    memcpy(&raw, &value, sizeof raw);
    return raw;
}

static uint64_t bits_of_double(double value) {
    uint64_t raw;
    memcpy(&raw, &value, sizeof raw);
    return raw;
}

static uint64_t float_x(uint32_t r) { return bits_of_float((float)r + 0.25f); }
static uint64_t float_y(uint32_t r) { return bits_of_float(-(float)r); }
static uint64_t float_z(uint32_t r) { return bits_of_float(r % 7 == 6 ? NAN : 1); }
static uint64_t byte_of(uint32_t r) { return r % 256; }
static uint64_t state_of(uint32_t r) { return r % 5 == 4 ? 1 + r % 2 : 0; }
static uint64_t nothing(uint32_t r) { return r * 0; }
static uint64_t double_r(uint32_t r) { return bits_of_double(1 + r); }
static uint64_t double_a(uint32_t r) { return bits_of_double(0.1 * r); }
static uint64_t double_e(uint32_t r) { return bits_of_double(-0.01 * r); }
static uint64_t ten_bits(uint32_t r) { return r * 37 % 1024; }
static uint64_t scaled_x(uint32_t r) { return r * 1000003 % (1u << 21); }
static uint64_t scaled_y(uint32_t r) { return r * UINT64_C(100000000003) % (UINT64_C(1) << 41); }
static uint64_t all_bits(uint32_t r) { return (UINT64_C(1) << 63) + r; }
static uint64_t two_bits(uint32_t r) { return r % 4; }
static uint64_t many_bits(uint32_t r) { return (r * UINT64_C(0x9e3779b97f4a7c15)) >> 3; }
static uint64_t one_bit(uint32_t r) { return r % 2; }
static uint64_t normal_x(uint32_t r) { return bits_of_float(r % 2 ? 1 : 0); }
static uint64_t normal_y(uint32_t r) { return bits_of_float(r % 2 ? 0 : 1); }
static uint64_t zero_float(uint32_t r) { return bits_of_float((float)r * 0); }

#define SINGLE(name)             "<" name " type=\"Float\" precision=\"single\"/>\n"
#define DOUBLE(name)             "<" name " type=\"Float\"/>\n"
#define INTEGER(name, low, high) "<" name " type=\"Integer\" minimum=\"" low "\" maximum=\"" high "\"/>\n"

static const made_field float_fields[] = {
    {SINGLE("cartesianX"), 32, float_x},
    {SINGLE("cartesianY"), 32, float_y},
    {SINGLE("cartesianZ"), 32, float_z},
    {INTEGER("colorRed", "0", "255"), 8, byte_of},
    {INTEGER("colorGreen", "0", "255"), 8, byte_of},
    {INTEGER("colorBlue", "0", "255"), 8, byte_of},
    {INTEGER("intensity", "-7", "-7"), 0, nothing},
    {INTEGER("cartesianInvalidState", "0", "2"), 2, state_of},
};
static const made_field spherical_fields[] = {
    {DOUBLE("sphericalRange"), 64, double_r},
    {DOUBLE("sphericalAzimuth"), 64, double_a},
    {DOUBLE("sphericalElevation"), 64, double_e},
    {DOUBLE("timeStamp"), 64, double_r},
    {INTEGER("isTimeStampInvalid", "0", "1"), 1, one_bit},
    {INTEGER("returnIndex", "0", "3"), 2, two_bits},
    {INTEGER("returnCount", "0", "3"), 2, two_bits},
    {INTEGER("rowIndex", "0", "1023"), 10, ten_bits},
};
static const made_field scaled_fields[] = {
    {"<cartesianX type=\"ScaledInteger\" minimum=\"-1048576\" maximum=\"1048575\" scale=\"1e-3\" "
     "offset=\"500000\"/>",
     21, scaled_x},
    {"<cartesianY type=\"ScaledInteger\" minimum=\"0\" maximum=\"2199023255551\" scale=\"1e-6\" "
     "offset=\"5400000\"/>",
     41, scaled_y},
    {"<cartesianZ type=\"Integer\"/>", 64, all_bits},
    {INTEGER("colorRed", "0", "1023"), 10, ten_bits},
    {INTEGER("colorGreen", "0", "1023"), 10, ten_bits},
    {INTEGER("colorBlue", "0", "1023"), 10, ten_bits},
    {INTEGER("isColorInvalid", "0", "1"), 1, one_bit},
    {"<intensity type=\"ScaledInteger\" minimum=\"0\" maximum=\"1023\" scale=\"0.5\"/>", 10, ten_bits},
    {SINGLE("nor:normalX"), 32, normal_x},
    {SINGLE("nor:normalY"), 32, normal_y},
    {SINGLE("nor:normalZ"), 32, zero_float},
    {INTEGER("ext:x", "-3", "2305843009213693948"), 61, many_bits},
};

/// A quarter of a turn about z.
#define POSE                                                                                                 \
    "<pose><rotation><w type=\"Float\">2</w><z type=\"Float\">2</z></rotation>"                              \
    "<translation><x type=\"Float\">500000.5</x><y type=\"Float\">4e6</y></translation></pose>"

static const made_scan float_scan = {float_fields, 8, 3000, ""};
static const made_scan posed_scan = {float_fields, 8, 1200, POSE};
static const made_scan spherical_scan = {spherical_fields, 8, 700, ""};
static const made_scan scaled_scan = {
    scaled_fields, 12, 2000,
    "<intensityLimits><intensityMinimum type=\"Integer\"/><intensityMaximum "
    "type=\"Float\">511.5</intensityMaximum></intensityLimits>"};

static bool is_point(uint32_t r) { return r % 5 != 4 && r % 7 != 6; }

static uint32_t count_points(uint32_t record_count) {
    uint32_t count = 0;
    for (uint32_t r = 0; r < record_count; r++) count += is_point(r);
    return count;
}

CASE(test_floats_colors_and_states) {
    cloud_bytes file = make(&float_scan, 1, "<coordinateMetadata>EPSG:32632</coordinateMetadata>");
    ewa_cloud *cloud = load(&file);
    assert_int_equal(ewa_cloud_point_count(cloud), count_points(3000));
    uint64_t point = 0;
    for (uint32_t r = 0; r < 3000; r++) {
        if (!is_point(r)) continue;
        const double color = r % 256;
        cloud_expect(cloud, "position", EWA_F32, 3, point, (const double[]){r + 0.25, -(double)r, 1});
        cloud_expect(cloud, "color", EWA_U8, 3, point, (const double[]){color, color, color});
        cloud_expect(cloud, "intensity", EWA_I8, 1, point++, (const double[]){-7});
    }
    assert_int_equal(ewa_cloud_attribute_count(cloud), 3);
    assert_string_equal(ewa_cloud_note(cloud, "crs", NULL), "EPSG:32632");
    assert_string_equal(ewa_cloud_note(cloud, "file.format", NULL), "E57 1.0");
    assert_string_equal(ewa_cloud_note(cloud, "file.guid", NULL), "{1-2}");
    assert_string_equal(ewa_cloud_note(cloud, "file.images", NULL), "2");
    assert_null(ewa_cloud_note(cloud, "scanners", NULL));
    cloud_check_pieces(&file, "floats.e57", cloud);
    ewa_cloud_destroy(&cloud);
    free(file.bytes);
    assert_string_equal(messages.text, "");
}

/// Half a turn about each axis alone, and a shift along each, are poses.
CASE(test_poses_of_one_axis) {
    enum { POINTS = 6 };
    made_scan scan = {float_fields, 3, POINTS, ""};
    double places[POINTS][3], origin[3];
    for (int pose = -1; pose < 6; pose++) {
        char text[160] = "";
        const char axis = (char)("xyz"[pose < 0 ? 0 : pose % 3]);
        if (pose >= 0 && pose < 3)
            snprintf(text, sizeof text,
                     "<pose><rotation><w type=\"Float\">0</w><%c type=\"Float\">1</%c></rotation></pose>", axis, axis);
        else if (pose >= 3)
            snprintf(text, sizeof text, "<pose><translation><%c type=\"Float\">2</%c></translation></pose>", axis, axis);
        scan.more = text;
        cloud_bytes file = make(&scan, 1, "");
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file);
        assert_int_equal(ewa_cloud_point_count(cloud), POINTS);
        ewa_cloud_origin(cloud, origin);
        for (uint32_t r = 0; r < POINTS; r++) {
            double at[3];
            ewa_attribute_read_f64(ewa_cloud_find(cloud, "position"), r, 1, at);
            for (int c = 0; c < 3; c++) {
                if (pose < 0) places[r][c] = at[c] + origin[c];
                const double moved = pose >= 3   ? places[r][c] + (c == pose - 3 ? 2 : 0)
                                     : pose >= 0 ? places[r][c] * (c == pose ? 1 : -1)
                                                 : places[r][c];
                assert_true(fabs(at[c] + origin[c] - moved) < 1e-9);
            }
        }
        free(file.bytes);
    }
}

CASE(test_spherical) {
    cloud_bytes file = make(&spherical_scan, 1, "");
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file);
    assert_int_equal(ewa_cloud_point_count(cloud), 700);
    for (uint32_t r = 0; r < 700; r++) {
        const double range = 1 + r, azimuth = 0.1 * r, elevation = -0.01 * r;
        double place[3];
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "position"), r, 1, place);
        assert_true(fabs(place[0] - range * cos(elevation) * cos(azimuth)) < 1e-9);
        assert_true(fabs(place[1] - range * cos(elevation) * sin(azimuth)) < 1e-9);
        assert_true(fabs(place[2] - range * sin(elevation)) < 1e-9);
        cloud_expect(cloud, "gps_time", EWA_F64, 1, r, (const double[]){r % 2 ? NAN : range});
        cloud_expect(cloud, "return_number", EWA_U8, 1, r, (const double[]){r % 4 + 1});
        cloud_expect(cloud, "number_of_returns", EWA_U8, 1, r, (const double[]){r % 4});
        cloud_expect(cloud, "row_index", EWA_U16, 1, r, (const double[]){r * 37 % 1024});
    }
    assert_string_equal(ewa_cloud_note(cloud, "scanners", NULL), "0 0 0");
    free(file.bytes);
}

CASE(test_scaled_integers_of_any_width) {
    cloud_bytes file = make(&scaled_scan, 1, "");
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file);
    double origin[3];
    ewa_coordinate_grid grid;
    ewa_cloud_origin(cloud, origin);
    ewa_cloud_grid(cloud, &grid);
    assert_true(origin[0] == 500000 && origin[1] == 5400000 && origin[2] == 0);
    assert_true(grid.step_world[0] == 1e-3 && grid.step_world[1] == 1e-6 && grid.step_world[2] == 0);
    assert_true(grid.offset_world[0] == 500000 && grid.offset_world[1] == 5400000);
    for (uint32_t r = 0; r < 2000; r++) {
        const double raw_x = (double)scaled_x(r) - 1048576, raw_y = (double)scaled_y(r),
                     ten = (double)ten_bits(r);
        const double color = r % 2 ? 0 : floor(ten * (65535.0 / 1023) + 0.5);
        cloud_expect(cloud, "position", EWA_F64, 3, r, (const double[]){raw_x * 1e-3, raw_y * 1e-6, r});
        cloud_expect(cloud, "color", EWA_U16, 3, r, (const double[]){color, color, color});
        cloud_expect(cloud, "intensity", EWA_F64, 1, r, (const double[]){ten * 0.5});
        cloud_expect(cloud, "normal", EWA_F32, 3, r, (const double[]){r % 2, 1 - r % 2, 0});
        cloud_expect(cloud, "ext:x", EWA_F64, 1, r, (const double[]){(double)((int64_t)many_bits(r) - 3)});
    }
    assert_string_equal(ewa_cloud_note(cloud, "file.intensity", NULL), "0 to 511.5");
    cloud_check_pieces(&file, "scaled.e57", cloud);
    free(file.bytes);
}

CASE(test_several_scans_are_one_cloud) {
    const made_scan scans[3] = {posed_scan, spherical_scan, {float_fields, 3, 0, POSE}};
    cloud_bytes file = make(scans, 3, "");
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = load(&file);
    const uint32_t first_count = count_points(1200);
    double origin[3];
    ewa_cloud_origin(cloud, origin);
    assert_true(origin[0] == 500000 && origin[1] == 4000000 && origin[2] == 0);
    assert_int_equal(ewa_cloud_point_count(cloud), first_count + 700);
    uint64_t point = 0;
    for (uint32_t r = 0; r < 1200; r++) {
        if (!is_point(r)) continue;
        double place[3];
        ewa_attribute_read_f64(ewa_cloud_find(cloud, "position"), point, 1, place);
        assert_true(fabs(place[0] - (r + 0.5)) < 1e-9 && fabs(place[1] - (r + 0.25)) < 1e-9 && place[2] == 1);
        cloud_expect(cloud, "scan", EWA_U16, 1, point, (const double[]){0});
        cloud_expect(cloud, "gps_time", EWA_F64, 1, point, (const double[]){NAN});
        cloud_expect(cloud, "row_index", EWA_U16, 1, point++, (const double[]){0});
    }
    cloud_expect(cloud, "scan", EWA_U16, 1, point, (const double[]){1});
    cloud_expect(cloud, "position", EWA_F64, 3, point, (const double[]){1 - 500000.0, -4000000, 0});
    cloud_expect(cloud, "color", EWA_U8, 3, point, (const double[]){0, 0, 0});
    assert_string_equal(ewa_cloud_note(cloud, "scanners", NULL),
                        "500000.5 4000000 0\n0 0 0\n500000.5 4000000 0");
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.text, "some scans lack"));
    assert_non_null(strstr(messages.text, "gps_time (nan)"));
    assert_non_null(strstr(messages.text, "row_index (0)"));
    cloud_check_pieces(&file, "scans.e57", cloud);
    free(file.bytes);
}

// ---- what is wrong ---------------------------------------------------------------------------------------

CASE(test_checksums) {
    uint8_t bytes[2048];
    check_random random = {4};
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = (uint8_t)check_random_u64(&random);
    assert_int_equal(ewa_e57_checksum((const uint8_t *)"123456789", 9, false), 0xe3069283);
    for (size_t size = 0; size < sizeof bytes; size += 1 + size / 9) {
        assert_int_equal(ewa_e57_checksum(bytes, size, false), slow_checksum(bytes, size));
        if (ewa_context_cpu_features(context) & EWA_CPU_AVX2)
            assert_int_equal(ewa_e57_checksum(bytes, size, true), slow_checksum(bytes, size));
    }
}

/// Every page counts, whatever its bytes are for, with the instruction and without.
CASE(test_every_page_is_checked) {
    static const uint32_t masks[2] = {EWA_CPU_ALL, 0};
    const made_scan scan = {float_fields, 8, 300, ""};
    cloud_bytes file = make(&scan, 1, "");
    for (int mask = 0; mask < 2; mask++) {
        OWNED(ewa_context_destroy) ewa_context *masked = check_context_of(1, masks[mask]);
        for (size_t at = 3; at < file.size; at += 97) {
            ewa_cloud *cloud = NULL;
            file.bytes[at] ^= 0x10;
            assert_true(ewa_cloud_load_memory(masked, file.bytes, file.size, "sample.e57", &cloud) < 0);
            file.bytes[at] ^= 0x10;
        }
    }
    file.bytes[PAGE + 5] ^= 1;
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_load_memory(context, file.bytes, file.size, "sample.e57", &cloud),
                     EWA_ERROR_FORMAT);
    assert_string_equal(
        messages.text,
        "sample.e57: page 1 at byte 1024 is damaged: its checksum does not fit (1 of 6 pages are) "
        "(keep_going leaves out what is damaged)");
    free(file.bytes);
}

CASE(test_damaged_pages_are_stepped_over) {
    cloud_bytes file = make(&scaled_scan, 1, "");
    // Within the first packet: 500 records are lost, the others are what they were.
    file.bytes[5 * PAGE + 100] ^= 1;
    uint64_t lost_count;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = cloud_keep_going(context, &file, "keep.e57", &lost_count);
    assert_non_null(cloud);
    assert_in_range(lost_count, 490, 520);
    assert_int_equal(ewa_cloud_point_count(cloud) + lost_count, 2000);
    const uint64_t count = ewa_cloud_point_count(cloud);
    cloud_expect(
        cloud, "position", EWA_F64, 3, count - 1,
        (const double[]){((double)scaled_x(1999) - 1048576) * 1e-3, (double)scaled_y(1999) * 1e-6, 1999});
    ewa_cloud_destroy(&cloud);
    free(file.bytes);
    // Far behind what is held at once.
    const made_scan many = {float_fields, 3, 70000, ""};
    file = make(&many, 1, "");
    uint64_t min_count = UINT64_MAX;
    for (size_t page = 18; page < 25; page++) { // one of them has the head of no packet
        file.bytes[file.size - page * PAGE] ^= 1;
        cloud = cloud_keep_going(context, &file, "keep.e57", &lost_count);
        file.bytes[file.size - page * PAGE] ^= 1;
        assert_non_null(cloud);
        assert_in_range(lost_count, 490, 4000);
        assert_true(ewa_cloud_point_count(cloud) > 70000 / 7 * 6 - lost_count);
        min_count = lost_count < min_count ? lost_count : min_count;
        ewa_cloud_destroy(&cloud);
    }
    assert_in_range(min_count, 490, 510);
    free(file.bytes);
    // Where the points begin: the scan is lost, the next one is read.
    const made_scan scans[2] = {float_scan, spherical_scan};
    file = make(scans, 2, "");
    file.bytes[80] ^= 1;
    cloud = cloud_keep_going(context, &file, "keep.e57", &lost_count);
    assert_non_null(cloud);
    assert_int_equal(lost_count, 3000);
    assert_int_equal(ewa_cloud_point_count(cloud), 700);
    cloud_expect(cloud, "scan", EWA_U16, 1, 0, (const double[]){1});
    free(file.bytes);
}

static void change(cloud_bytes *file, const char *from, const char *to) {
    for (size_t at = 0; at + strlen(from) <= file->size; at++)
        if (memcmp(file->bytes + at, from, strlen(from)) == 0) {
            memcpy(file->bytes + at, to, strlen(to));
            for (size_t page = 0; page + PAGE <= file->size; page += PAGE) fit_checksum(file->bytes + page);
            return;
        }
    fail_msg("no %s", from);
}

CASE(test_files_that_are_wrong) {
    static const struct {
        const char *from, *to, *message;
    } cases[] = {
        {"ASTM-E57\1", "ASTM-E57\2", "E57 of version 2; 1 is read"},
        {"</data3D>", "</data4D>", "XML, line "},
        {"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", "<!DOCTYPE a [<!ENTITY b 'c'>]>         ",
         "is a document type"},
        {"<e57Root", "<f57Root", "XML, line 2: 'f57Root' is not the root"},
        {"recordCount=\"300\"", "recordCount=\"999\"", "does not come: the points end before it"},
        {"recordCount=\"300\"", "recordCount=\"-99\"", "'points' has no place or no number"},
        {"fileOffset=\"48\"", "fileOffset=\"60\"", "scan 1: there are no points at byte 60"},
        {"maximum=\"255\"", "maximum=\"-55\"", "'colorRed' has a minimum and a maximum"},
        {"maximum=\"255\"", "maximum=\"500\"", "scan 1: the packet at byte "},
        {"type=\"Float\" precision=\"single\"", "type=\"Strin\" precision=\"single\"",
         "'cartesianX' is a field of a type that is not read"},
        {"<cartesianX", "<cartesianW", "no scan has coordinates"},
        {"data3D type=\"Vector\">", "data3D type=\"Vecto\" >", ""},
        {"vectorChild type=\"Structure\"", "vectorChild type=\"Structurf\"", ""},
    };
    const made_scan scan = {float_fields, 8, 300, ""};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        cloud_bytes file = make(&scan, 1, "");
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        messages = (check_log){0};
        change(&file, cases[i].from, cases[i].to);
        const ewa_status status = ewa_cloud_load_memory(context, file.bytes, file.size, "sample.e57", &cloud);
        if ((status == EWA_OK) != !cases[i].message[0] || !strstr(messages.text, cases[i].message))
            fail_msg("case %zu: '%s' instead of '%s'", i, messages.text, cases[i].message);
        free(file.bytes);
    }
    const made_scan none = {float_fields, 8, 0, ""};
    cloud_bytes file = make(&none, 0, "");
    ewa_cloud *cloud = NULL;
    assert_int_equal(ewa_cloud_load_memory(context, file.bytes, file.size, "sample.e57", &cloud),
                     EWA_ERROR_FORMAT);
    assert_non_null(strstr(messages.text, "there are no scans in it"));
    free(file.bytes);
}

CASE(test_truncated) {
    const made_scan scans[2] = {{float_fields, 8, 20, ""}, {spherical_fields, 8, 9, ""}};
    cloud_bytes file = make(scans, 2, "");
    cloud_check_truncations(&file, "cut.e57", 0);
    free(file.bytes);
}

/// Changed bytes behind checksums that fit.
CASE(test_damaged_bytes_are_survived) {
    const made_scan scans[2] = {{scaled_fields, 12, 30, POSE}, {spherical_fields, 8, 9, ""}};
    cloud_bytes file = make(scans, 2, "");
    check_random random = {8};
    for (int i = 0; i < 1500; i++) {
        cloud_bytes changed = {0};
        cloud_put(&changed, file.bytes, file.size);
        for (int k = 0; k < 3; k++)
            changed.bytes[check_random_u64(&random) % file.size] = (uint8_t)check_random_u64(&random);
        for (size_t page = 0; page + PAGE <= file.size; page += PAGE) fit_checksum(changed.bytes + page);
        OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
        messages = (check_log){0};
        const ewa_status status =
            ewa_cloud_load_memory(context, changed.bytes, changed.size, "sample.e57", &cloud);
        assert_true(status == EWA_OK || messages.count > 0);
        free(changed.bytes);
    }
    free(file.bytes);
}

static ewa_status load_each(ewa_context *failing, void *user) {
    const cloud_bytes *file = user;
    OWNED(ewa_cloud_destroy) ewa_cloud *cloud = NULL;
    const ewa_status status = ewa_cloud_load_memory(failing, file->bytes, file->size, "sample.e57", &cloud);
    return status;
}

CASE(test_memory_that_fails) {
    const made_scan scans[2] = {{scaled_fields, 12, 30, POSE}, {spherical_fields, 8, 9, ""}};
    cloud_bytes file = make(scans, 2, "<coordinateMetadata>EPSG:32632</coordinateMetadata>");
    scratch_fail_each(load_each, &file);
    free(file.bytes);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
