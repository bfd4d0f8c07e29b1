// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Meshes in VTK's XML files: every way of storing numbers gives the same mesh, pieces are counted on, grids, cells and
// polyhedra; what is refused, every truncation.
#include "io/mesh_fixture.h"

#include "io/deflate.h"

enum { MAX_BYTES = 1 << 14, STORAGES = 6 };

/// A file that is written, and the data behind it.
typedef struct writer {
    char bytes[MAX_BYTES], appended[MAX_BYTES];
    size_t size, appended_size;
    int storage; ///< 0: text; 1: base64; 2, 3: appended, raw or base64; 4, 5: the same packed; odd ones have sizes of 64 bits
    bool big_endian;
} writer;

static void put(writer *w, const char *text) {
    assert_true(w->size + strlen(text) < MAX_BYTES);
    memcpy(w->bytes + w->size, text, strlen(text) + 1);
    w->size += strlen(text);
}

static size_t put_number(const writer *w, uint8_t *to, uint32_t bytes, uint64_t bits) {
    for (uint32_t i = 0; i < bytes; i++) to[i] = (uint8_t)(bits >> 8 * (w->big_endian ? bytes - 1 - i : i));
    return bytes;
}

static size_t base64(const uint8_t *bytes, size_t count, char *text) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t size = 0;
    for (size_t i = 0; i < count; i += 3) {
        const uint32_t three = (uint32_t)bytes[i] << 16 | (uint32_t)(i + 1 < count ? bytes[i + 1] : 0) << 8 |
                               (i + 2 < count ? bytes[i + 2] : 0);
        for (int k = 0; k < 4; k++) text[size++] = i + (size_t)k > count ? '=' : letters[three >> (18 - 6 * k) & 63];
    }
    text[size] = 0;
    return size;
}

static void begin_file(writer *w, const char *type, int storage, bool big_endian) {
    char head[512];
    *w = (writer){.storage = storage, .big_endian = big_endian};
    snprintf(head, sizeof head,
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" byte_order=\"%s\"%s%s>\n<%s>\n", type,
             big_endian ? "BigEndian" : "LittleEndian", storage % 2 ? " header_type=\"UInt64\"" : "",
             storage >= 4 ? " compressor=\"vtkZLibDataCompressor\"" : "", type);
    put(w, head);
}

/// What VTK writes into an array of vectors whose longest it has looked for.
static const char KEY[] = "<InformationKey name=\"L2_NORM_RANGE\" location=\"vtkDataArray\" length=\"2\">\n<Value index=\"0\">\n0\n"
                          "</Value>\n<Value index=\"1\">\n1\n</Value>\n</InformationKey>\n";

/// Writes an array of "Float32", "Float64", "Int32", "Int64" or "UInt8".
static void put_array(writer *w, const char *type, const char *attributes, int count, const double *numbers) {
    uint8_t bytes[MAX_BYTES / 8], *all = bytes + 32;
    char text[MAX_BYTES / 4];
    size_t size = 0;
    const char *key = strstr(attributes, "rgb") ? KEY : "";
    snprintf(text, sizeof text, "<DataArray type=\"%s\" %s ", type, attributes);
    put(w, text);
    if (w->storage == 0) {
        put(w, "format=\"ascii\">\n");
        for (int i = 0; i < count; i++) {
            snprintf(text, sizeof text, "%.9g ", numbers[i]);
            put(w, text);
        }
        put(w, "\n");
        put(w, key);
        put(w, "</DataArray>\n");
        return;
    }
    const uint32_t word = w->storage % 2 ? 8 : 4;
    for (int i = 0; i < count; i++) {
        const uint32_t width = type[0] == 'U' ? 1 : strchr(type, '6') ? 8 : 4;
        uint64_t bits = (uint64_t)(int64_t)numbers[i];
        const float half = (float)numbers[i];
        uint32_t half_bits;
        memcpy(&half_bits, &half, 4);
        if (type[0] == 'F') memcpy(&bits, &numbers[i], 8);
        if (type[0] == 'F' && width == 4) bits = half_bits;
        size += put_number(w, all + size, width, bits);
    }
    uint8_t out[MAX_BYTES / 8];
    size_t head = 0, out_size = 0;
    if (w->storage >= 4) { // one block
        ewa_deflated packed;
        assert_int_equal(ewa_deflate(context, EWA_DEFLATE_ZLIB, 6, all, size, &packed), EWA_OK);
        const uint64_t sizes[4] = {1, size, 0, packed.size_bytes};
        for (int i = 0; i < 4; i++) head += put_number(w, out + head, word, sizes[i]);
        memcpy(out + head, packed.bytes, packed.size_bytes);
        out_size = head + packed.size_bytes;
        ewa_deflated_free(context, &packed);
    } else {
        head = put_number(w, out, word, size);
        memcpy(out + head, all, size);
        out_size = head + size;
    }
    // Sizes and packed data are two texts of base64.
    size_t text_size = 0;
    if (w->storage >= 4) {
        text_size = base64(out, head, text);
        text_size += base64(out + head, out_size - head, text + text_size);
    } else {
        text_size = base64(out, out_size, text);
    }
    if (w->storage == 1) {
        put(w, "format=\"binary\">\n");
        put(w, text);
        put(w, "\n");
        put(w, key);
        put(w, "</DataArray>\n");
        return;
    }
    char offset[512];
    snprintf(offset, sizeof offset, *key ? "format=\"appended\" offset=\"%zu\">\n%s</DataArray>\n" : "format=\"appended\" offset=\"%zu\"/>\n%s",
             w->appended_size, key);
    put(w, offset);
    const bool raw = w->storage % 2 == 0;
    memcpy(w->appended + w->appended_size, raw ? (const char *)out : text, raw ? out_size : text_size);
    w->appended_size += raw ? out_size : text_size;
}

static void end_file(writer *w, const char *type) {
    char tail[128];
    snprintf(tail, sizeof tail, "</%s>\n", type);
    put(w, tail);
    if (w->storage >= 2) {
        put(w, w->storage % 2 ? "<AppendedData encoding=\"base64\">\n_" : "<AppendedData encoding=\"raw\">\n_");
        memcpy(w->bytes + w->size, w->appended, w->appended_size);
        w->size += w->appended_size;
        put(w, "\n</AppendedData>\n");
    }
    put(w, "</VTKFile>\n");
}

static const double CUBE[27] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 0.5, 0.5, 1.5};

/// A cube with a pyramid on it, colours and normals; with as many bytes of places before it in a piece of its own.
static void make_grid(writer *w, int storage, bool big_endian, bool two_pieces) {
    static const double cells[13] = {0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8}, offsets[2] = {8, 13}, types[2] = {12, 14};
    double colors[27], normals[27];
    for (int i = 0; i < 27; i++) colors[i] = i % 3 == 1 ? 255 : 0, normals[i] = i % 3 == 2;
    begin_file(w, "UnstructuredGrid", storage, big_endian);
    for (int piece = 0; piece <= two_pieces; piece++) {
        double places[27];
        for (int i = 0; i < 27; i++) places[i] = CUBE[i] + (i % 3 == 0 ? 5 * piece : 0);
        put(w, "<Piece NumberOfPoints=\"9\" NumberOfCells=\"2\">\n<PointData Scalars=\"t\">\n");
        put_array(w, "Float64", "Name=\"t\"", 9, CUBE);
        put_array(w, "UInt8", "Name=\"rgb\" NumberOfComponents=\"3\"", 27, colors);
        put_array(w, "UInt8", "Name=\"second\" NumberOfComponents=\"3\"", 27, CUBE);
        put_array(w, "Float32", "Name=\"Normals\" NumberOfComponents=\"3\"", 27, normals);
        const double far[9] = {5e9}, part[9] = {0, 0, 0, 0, 7 + piece};
        put_array(w, "Int64", "Name=\"part\"", 9, part);
        put_array(w, "Int64", "Name=\"far\"", 9, far);
        put(w, "</PointData>\n<CellData>\n");
        const double id[2] = {10 * piece + 1, 10 * piece + 2};
        put_array(w, "UInt8", "Name=\"no color\" NumberOfComponents=\"3\"", 6, CUBE);
        put_array(w, "Int32", "Name=\"id\"", 2, id);
        put(w, "</CellData>\n<Points>\n");
        put_array(w, piece ? "Float64" : "Float32", "Name=\"Points\" NumberOfComponents=\"3\"", 27, places);
        put(w, "</Points>\n<Cells>\n");
        put_array(w, "Int64", "Name=\"connectivity\"", 13, cells);
        put_array(w, "Int32", "Name=\"offsets\"", 2, offsets);
        put_array(w, "UInt8", "Name=\"types\"", 2, types);
        put(w, "</Cells>\n</Piece>\n");
    }
    end_file(w, "UnstructuredGrid");
}

/// Every way of storing numbers, from lowest to highest byte and the other way, one piece and two.
CASE(test_storages) {
    static writer w;
    for (int storage = 0; storage < STORAGES; storage++) {
        for (int way = 0; way < 4; way++) {
            OWNED(ewa_mesh_free) ewa_mesh mesh;
            make_grid(&w, storage, way & 1, way & 2);
            mesh_load_bytes(context, &messages, "a.vtu", w.bytes, w.size, false, &mesh);
            const double expected = (way & 2 ? 2 : 1) * (5 + sqrt(2));
            if (fabs(mesh_area(&mesh, NULL) - expected) > 1e-12)
                fail_msg("storage %d, way %d: area %.12g", storage, way, mesh_area(&mesh, NULL));
            assert_non_null(mesh.colors);
            assert_non_null(mesh.normals);
            double end = 0;
            unsigned seen = 0;
            for (uint32_t i = 0; i < 3 * mesh.triangle_count; i++) end = fmax(end, mesh.positions[3 * (size_t)mesh.triangles[i]]);
            assert_float_equal(end, (way & 2) ? 6 : 1, 0);
            const ewa_attribute *numbers = ewa_cloud_find(mesh.attributes, "t"), *second = ewa_cloud_find(mesh.attributes, "second");
            assert_true(numbers->type == EWA_F64 && second->type == EWA_U8 && second->component_count == 3);
            const ewa_attribute *part = ewa_cloud_find(mesh.attributes, "part"); // of eight bytes, which fit into four
            assert_true(part->type == EWA_I32 && ewa_cloud_find(mesh.attributes, "far")->type == EWA_F64);
            double highest = 0;
            for (uint32_t i = 0; i < mesh.vertex_count; i++) {
                double number;
                ewa_attribute_read_f64(part, i, 1, &number);
                highest = fmax(highest, number);
            }
            assert_float_equal(highest, (way & 2) ? 8 : 7, 0);
            assert_null(ewa_cloud_find(mesh.attributes, "no_color")); // of cells whose points have colours
            const ewa_attribute *ids = ewa_cloud_find(mesh.attributes, "id");
            for (uint32_t i = 0; i < 3 * mesh.triangle_count; i++) {
                const uint32_t first = mesh.triangles[i - i % 3], vertex = mesh.triangles[i];
                double own, its, x = mesh.positions[3 * (size_t)vertex];
                ewa_attribute_read_f64(ids, first, 1, &own);
                ewa_attribute_read_f64(ids, vertex, 1, &its);
                assert_true(own == its && floor(its / 10) == (x >= 5) && fmod(its, 10) >= 1 && fmod(its, 10) <= 2);
                seen |= 1u << (int)its;
            }
            assert_int_equal(seen, way & 2 ? 6 | 6 << 10 : 6);
            for (uint32_t i = 0; i < mesh.vertex_count; i++) {
                const double *place = mesh.positions + 3 * (size_t)i;
                double t, three[3];
                ewa_attribute_read_f64(numbers, i, 1, &t);
                ewa_attribute_read_f64(second, i, 1, three);
                if (place[1] == 1 && place[2] == 0) assert_true(t == 1 - (fmod(place[0], 5) == 1) * (1 - CUBE[2]));
                assert_true(three[1] == floor(place[1]) && three[2] == floor(place[2]));
            }
            for (uint32_t i = 0; i < mesh.vertex_count; i++)
                assert_true(mesh.colors[4 * i] == 0 && mesh.colors[4 * i + 1] == 1 && mesh.colors[4 * i + 3] == 1);
        }
    }
}

CASE(test_polygons) {
    static writer w;
    static const double lines[2] = {0, 8}, line_ends[1] = {2}, strip[4] = {0, 1, 3, 2}, strip_ends[1] = {4},
                        polygons[7] = {4, 5, 6, 4, 6, 7, 8}, polygon_ends[2] = {3, 7},
                        ids[4] = {1, 20, 30, 40}; // strips come before polygons, and their data behind
    for (int storage = 0; storage < STORAGES; storage++) {
        OWNED(ewa_mesh_free) ewa_mesh mesh;
        begin_file(&w, "PolyData", storage, false);
        put(&w, "<Piece NumberOfPoints=\"9\" NumberOfVerts=\"0\" NumberOfLines=\"1\" NumberOfStrips=\"1\" NumberOfPolys=\"2\">\n<CellData>\n");
        put_array(&w, "Int32", "Name=\"id\"", 4, ids);
        put(&w, "</CellData>\n<Points>\n");
        put_array(&w, "Float64", "NumberOfComponents=\"3\"", 27, CUBE);
        put(&w, "</Points>\n<Verts>\n");
        put_array(&w, "Int32", "Name=\"connectivity\"", 0, lines);
        put_array(&w, "Int32", "Name=\"offsets\"", 0, lines);
        put(&w, "</Verts>\n<Lines>\n");
        put_array(&w, "Int32", "Name=\"connectivity\"", 2, lines);
        put_array(&w, "Int32", "Name=\"offsets\"", 1, line_ends);
        put(&w, "</Lines>\n<Strips>\n");
        put_array(&w, "Int64", "Name=\"connectivity\"", 4, strip);
        put_array(&w, "Int64", "Name=\"offsets\"", 1, strip_ends);
        put(&w, "</Strips>\n<Polys>\n");
        put_array(&w, "Int64", "Name=\"connectivity\"", 7, polygons);
        put_array(&w, "Int64", "Name=\"offsets\"", 2, polygon_ends);
        put(&w, "</Polys>\n</Piece>\n");
        end_file(&w, "PolyData");
        mesh_load_bytes(context, &messages, "a.vtp", w.bytes, w.size, true, &mesh);
        mesh_says(&messages, "1 lines beside the faces are left out");
        // The strip is a square, the first polygon half of one; the second is not flat.
        assert_int_equal(mesh.triangle_count, 5);
        const ewa_attribute *numbers = ewa_cloud_find(mesh.attributes, "id");
        for (uint32_t t = 0; t < 5; t++) {
            double id, z = mesh.positions[3 * (size_t)mesh.triangles[3 * t] + 2];
            ewa_attribute_read_f64(numbers, mesh.triangles[3 * t], 1, &id);
            assert_float_equal(id, z == 0 ? 40 : t == 2 ? 20 : 30, 0);
        }
    }
}

#define ROOT(type) "<VTKFile type=\"" type "\" version=\"0.1\">\n<" type ">\n"
#define ARRAY(name, numbers) "<DataArray type=\"Float32\" Name=\"" name "\" NumberOfComponents=\"3\">" numbers "</DataArray>\n"
#define COUNT(name, numbers) "<DataArray type=\"Int64\" Name=\"" name "\" format=\"ascii\">" numbers "</DataArray>\n"
#define PLACES               "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1"

/// Kinds of cells begin anew with a piece; normals are those of all pieces or, behind one without, of none.
CASE(test_pieces) {
    ewa_mesh mesh;
    static const char pieces[] =
        ROOT("PolyData") "<Piece NumberOfPoints=\"8\" NumberOfPolys=\"1\"><Points>" ARRAY("p", PLACES)
        "</Points><Polys>" COUNT("connectivity", "0 1 2 3") COUNT("offsets", "4") "</Polys></Piece>\n"
        "<Piece NumberOfPoints=\"8\" NumberOfLines=\"1\" NumberOfPolys=\"1\"><PointData>" ARRAY("Normals", PLACES)
        "</PointData><Points>" ARRAY("p", PLACES) "</Points><Lines>" COUNT("connectivity", "0 6") COUNT("offsets", "2")
        "</Lines><Polys>" COUNT("connectivity", "4 5 6 7") COUNT("offsets", "4") "</Polys></Piece></PolyData></VTKFile>\n";
    mesh_load_bytes(context, &messages, "a.vtp", pieces, sizeof pieces - 1, true, &mesh);
    assert_float_equal(mesh_area(&mesh, NULL), 2, 1e-12);
    assert_null(mesh.normals);
    ewa_mesh_free(&mesh);
    // More cells than an array of bytes has.
    static writer w;
    for (int storage = 1; storage < STORAGES; storage++) {
        make_grid(&w, storage, false, false);
        char *count = strstr(w.bytes, "NumberOfCells=\"2\"");
        assert_non_null(count);
        count[strlen("NumberOfCells=\"")] = '9';
        mesh_refuse(context, &messages, "a.vtu", w.bytes, w.size, EWA_ERROR_FORMAT, "end early");
    }
}

CASE(test_grids) {
    OWNED(ewa_mesh_free) ewa_mesh mesh;
    double sum[3];
    // Two pieces of a structured sheet that meet, behind remarks and what is not read.
    mesh_load_text(context, &messages, "a.vts",
                   "<?xml version='1.0'?>\n<!-- a > b -->\n" ROOT("StructuredGrid")
                       "<FieldData>" ARRAY("t", "1 2 3") "</FieldData>\n"
                       "<Piece Extent=\"0 1 0 1 0 0\"><Points>" ARRAY("p", "0 0 0 1 0 0 0 1 0 1 1 0") "</Points></Piece>\n"
                       "<Piece Extent=\"1 2 0 1 0 0\"><Points>" ARRAY("p", "1 0 0 3 0 0 1 1 0 3 1 0") "</Points></Piece>\n"
                       "</StructuredGrid>\n</VTKFile>\n",
                   &mesh);
    assert_float_equal(mesh_area(&mesh, sum), 3, 0);
    assert_float_equal(sum[2], 3, 0);
    ewa_mesh_free(&mesh);
    mesh_load_text(context, &messages, "a.vtr",
                   ROOT("RectilinearGrid") "<Piece Extent=\"3 5 -1 0 7 8\"><Coordinates>" COUNT("x", "0 1 5") COUNT(
                       "y", "0 2") COUNT("z", "0 3") "</Coordinates></Piece>\n</RectilinearGrid>\n</VTKFile>\n",
                   &mesh);
    assert_float_equal(mesh_area(&mesh, sum), 2 * (5 * 2 + 5 * 3 + 2 * 3), 0);
    assert_float_equal(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2], 0, 0);
}

/// Two polyhedra that share a face, in the second piece, where their corners are counted on.
CASE(test_polyhedra) {
#define FIRST "<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"><Points>" ARRAY("p", "9 9 9") "</Points></Piece>\n"
#define GRID  ROOT("UnstructuredGrid") FIRST "<Piece NumberOfPoints=\"8\" NumberOfCells=\"2\"><Points>" ARRAY("p", PLACES) "</Points><Cells>"
#define WEDGES COUNT("connectivity", "0 1 2 4 5 6 0 2 3 4 6 7") COUNT("offsets", "6 12 12") COUNT("types", "42 42 42")
#define TAIL  "</Cells></Piece></UnstructuredGrid></VTKFile>\n"
    static const char faces[] = "5 3 0 2 1 3 4 5 6 4 0 1 5 4 4 1 2 6 5 4 2 0 4 6 "
                                "5 3 0 3 2 3 4 6 7 4 2 3 7 6 4 3 0 4 7 4 0 2 6 4";
    char text[4096];
    ewa_mesh mesh;
    snprintf(text, sizeof text, GRID WEDGES COUNT("faces", "%s") COUNT("faceoffsets", "24 48") TAIL, faces);
    mesh_load_text(context, &messages, "a.vtu", text, &mesh);
    assert_float_equal(mesh_area(&mesh, NULL), 6, 1e-12);
    assert_int_equal(mesh.triangle_count, 12);
    ewa_mesh_free(&mesh);
    // The same behind a byte order mark.
    snprintf(text, sizeof text, "\xef\xbb\xbf" GRID WEDGES COUNT("faces", "%s") COUNT("faceoffsets", "24 48") TAIL, faces);
    mesh_load_text(context, &messages, "a.vtu", text, &mesh);
    assert_int_equal(mesh.triangle_count, 12);
    ewa_mesh_free(&mesh);
    // Without their faces they are unknown.
    ewa_model model;
    assert_int_equal(ewa_model_load_memory(context, GRID WEDGES TAIL, strlen(GRID WEDGES TAIL), "a.vtu", NULL, EWA_MODEL_MESH,
                                           NULL, &model),
                     EWA_OK);
    mesh_says(&messages, "2 cells of a kind that is not known are left out");
    assert_int_equal(ewa_cloud_point_count(model.points), 9);
    ewa_model_free(&model);
    static const char *const ends[] = {"24 20 48", "48 20 24"};
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text, GRID WEDGES COUNT("faces", "%s") COUNT("faceoffsets", "%s") TAIL, faces, ends[i]);
        char *wedges = strstr(text, "NumberOfCells=\"2\"");
        assert_non_null(wedges);
        wedges[strlen("NumberOfCells=\"")] = '3';
        mesh_refuse(context, &messages, "a.vtu", text, strlen(text), EWA_ERROR_FORMAT, "offsets of faces do not ascend");
    }
}

CASE(test_refused) {
#define PIECE ROOT("UnstructuredGrid") "<Piece NumberOfPoints=\"8\" NumberOfCells=\"1\"><Points>"
    static const struct {
        const char *text, *said;
        ewa_status status;
    } broken[] = {
        {ROOT("UnstructuredGrid") TAIL, "neither faces nor points", EWA_ERROR_FORMAT},
        {PIECE "</Points>" TAIL, "an array of a piece is not there", EWA_ERROR_FORMAT},
        {PIECE ARRAY("p", "0 0 0") "</Points>" TAIL, "the data of the array end early", EWA_ERROR_FORMAT},
        {PIECE ARRAY("p", "0 0 0x") "</Points>" TAIL, "cannot be read", EWA_ERROR_FORMAT},
        {PIECE "<DataArray type=\"String\">" PLACES "</DataArray>" TAIL, "type 'String'", EWA_ERROR_UNSUPPORTED},
        {PIECE ARRAY("p", PLACES) "</Points><Cells>" COUNT("connectivity", "0 1 2") COUNT("offsets", "4") COUNT("types", "7") TAIL,
         "the data of the array end early", EWA_ERROR_FORMAT},
        {PIECE ARRAY("p", PLACES) "</Points><Cells>" COUNT("connectivity", "0 1 2") COUNT("offsets", "3") TAIL,
         "an array of a piece is not there", EWA_ERROR_FORMAT},
        {ROOT("PolyData") "<Piece NumberOfPoints=\"8\" NumberOfPolys=\"2\"><Points>" ARRAY("p", PLACES) "</Points><Polys>" COUNT(
             "connectivity", "0 1 2") COUNT("offsets", "3 2") TAIL,
         "offsets do not ascend", EWA_ERROR_FORMAT},
        {ROOT("PolyData") "<Piece NumberOfPoints=\"8\" NumberOfPolys=\"1\"><Points>" ARRAY("p", PLACES) "</Points><Polys>" COUNT(
             "connectivity", "0 1 8") COUNT("offsets", "3") TAIL,
         "none of the faces can be used", EWA_ERROR_FORMAT},
        {ROOT("StructuredGrid") "<Piece Extent=\"0 1 0 1\">" TAIL, "the extent", EWA_ERROR_FORMAT},
        {ROOT("StructuredGrid") "<Piece Extent=\"0 1 0 -1 0 1\">" TAIL, "the extent", EWA_ERROR_FORMAT},
        {ROOT("StructuredGrid") "<Piece Extent=\"0 4e9 0 4e9 0 4e9\">" TAIL, "a grid is too large", EWA_ERROR_FORMAT},
        {PIECE ARRAY("p", PLACES), "the file ends early", EWA_ERROR_FORMAT},
        {"<VTKFile type=\"PolyData\" compressor=\"vtkSnappyCompressor\"><PolyData><Piece NumberOfPoints=\"8\"><Points>" ARRAY(
             "p", PLACES) TAIL,
         "compressor 'vtkSnappyCompressor'", EWA_ERROR_UNSUPPORTED},
    };
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++)
        mesh_refuse(context, &messages, "a.vtu", broken[i].text, strlen(broken[i].text), broken[i].status, broken[i].said);
}

/// Cut anywhere: refused, or as much as there is, and never a byte behind the end.
CASE(test_cut) {
    static writer w;
    for (int storage = 1; storage <= 4; storage += 3) {
        make_grid(&w, storage, false, false);
        for (size_t cut = 0; cut < w.size; cut++) {
            OWNED(check_free) uint8_t *part = malloc(cut + 1);
            assert_non_null(part);
            memcpy(part, w.bytes, cut);
            OWNED(ewa_model_free) ewa_model model;
            const ewa_status status =
                ewa_model_load_memory(context, part, cut, "a.vtu", NULL, EWA_MODEL_MESH, NULL, &model);
            if (status == EWA_OK && model.mesh.triangle_count)
                assert_float_equal(mesh_area(&model.mesh, NULL), 5 + sqrt(2), 1e-12);
        }
    }
}

static writer for_failing;

static ewa_status load_failing(ewa_context *failing, void *user) {
    OWNED(ewa_model_free) ewa_model model;
    const ewa_status status = ewa_model_load_memory(failing, for_failing.bytes, for_failing.size, "a.vtu", NULL,
                                                    EWA_MODEL_MESH, NULL, &model);
    return status;
}

CASE(test_failing_allocations) {
    make_grid(&for_failing, 5, false, false);
    scratch_fail_each(load_failing, NULL);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
