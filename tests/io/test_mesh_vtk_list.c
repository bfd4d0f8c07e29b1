// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Lists of VTK's XML files: what they name is one mesh, lists within lists, times; what is not there, leads elsewhere or in a
// circle is refused. Lines, which are drawn where there are no faces.
#include "io/mesh_fixture.h"

static void write_text(const char *name, const char *text) {
    char path[512];
    scratch_write(scratch_path(name, path), text, strlen(text));
}

/// Writes a piece, a triangle of area 1/2 at a height.
static void write_piece(const char *name, double height) {
    char text[1024];
    snprintf(text, sizeof text,
             "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points>"
             "<DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 %g 1 0 %g 0 1 %g</DataArray></Points><Cells>"
             "<DataArray type=\"Int32\" Name=\"connectivity\">0 1 2</DataArray><DataArray type=\"Int32\" Name=\"offsets\">3</DataArray>"
             "<DataArray type=\"UInt8\" Name=\"types\">5</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>",
             height, height, height);
    write_text(name, text);
}

static ewa_status load(const char *name, ewa_model *model) {
    char path[512];
    messages = (mesh_messages){.errors = 0};
    return ewa_model_load(context, scratch_path(name, path), EWA_MODEL_MESH | EWA_MODEL_POINTS, NULL, model);
}

static void refuse(const char *name, const char *said, ewa_status status) {
    ewa_model model;
    assert_int_equal(load(name, &model), status);
    mesh_says(&messages, said);
    assert_int_equal(messages.errors, 1);
}

#define PIECES(names) "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">" names "</PUnstructuredGrid></VTKFile>"
#define PIECE(name)   "<Piece Source=\"" name "\"/>"
#define BLOCKS(names) "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><Block index=\"0\">" names "</Block></vtkMultiBlockDataSet></VTKFile>"
#define SET(name)     "<DataSet index=\"0\" file=\"" name "\"/>"

CASE(test_lists) {
    write_piece("list_0.vtu", 0);
    write_piece("list_1.vtu", 1);
    write_text("list.pvtu", PIECES(PIECE("list_0.vtu") PIECE("list_1.vtu")));
    write_text("list.vtm", BLOCKS(SET("list.pvtu") SET("list_1.vtu")));
    write_text("list.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"list.vtm\"/>"
                           "<DataSet timestep=\"0\" part=\"1\" file=\"list_0.vtu\"/><DataSet timestep=\"0.5\" file=\"gone.vtu\"/>"
                           "</Collection></VTKFile>");
    static const struct {
        const char *name;
        uint32_t triangles;
    } lists[] = {{"list.pvtu", 2}, {"list.vtm", 3}, {"list.pvd", 4}};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        OWNED(ewa_model_free) ewa_model model;
        if (load(lists[i].name, &model) != EWA_OK) fail_msg("%s: %s", lists[i].name, messages.text);
        assert_int_equal(model.format, EWA_MODEL_VTK);
        assert_int_equal(model.mesh.triangle_count, lists[i].triangles);
        assert_float_equal(mesh_area(&model.mesh, NULL), 0.5 * lists[i].triangles, 1e-12);
        assert_int_equal(messages.warnings, i == 2);
    }
    mesh_says(&messages, "of several times the first is read: 0");
}

CASE(test_refused) {
    write_piece("list_0.vtu", 0);
    write_text("gone.pvtu", PIECES(PIECE("list_0.vtu") PIECE("not_there.vtu")));
    refuse("gone.pvtu", "'not_there.vtu', which it names: it is not there", EWA_ERROR_IO);
    write_text("away.pvtu", PIECES(PIECE("../../../../../../../../etc/passwd")));
    refuse("away.pvtu", "it is not below the folder", EWA_ERROR_IO);
    write_text("none.pvtu", PIECES(""));
    refuse("none.pvtu", "the list names no files", EWA_ERROR_FORMAT);
    write_text("self.vtm", BLOCKS(SET("self.vtm")));
    refuse("self.vtm", "lists name each other 4 deep", EWA_ERROR_FORMAT);
    write_text("text.obj", "v 0 0 0\n");
    write_text("other.vtm", BLOCKS(SET("text.obj")));
    refuse("other.vtm", "text.obj: no mesh in VTK's XML", EWA_ERROR_UNSUPPORTED);
    ewa_model model;
    messages = (mesh_messages){.errors = 0};
    const char *text = PIECES(PIECE("list_0.vtu"));
    assert_int_equal(ewa_model_load_memory(context, text, strlen(text), "a", NULL, EWA_MODEL_MESH, NULL, &model),
                     EWA_ERROR_UNSUPPORTED);
    mesh_says(&messages, "not read without its folder");
}

/// A line of three points, an edge and places beyond the file's: points along them, in the colours between.
CASE(test_lines) {
    write_text("lines.vtp",
               "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"4\" NumberOfLines=\"3\"><PointData>"
               "<DataArray type=\"UInt8\" NumberOfComponents=\"3\">255 255 255 0 0 0 255 255 255 255 255 255</DataArray></PointData><Points>"
               "<DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 3 0 0 3 4 0 0 4 0</DataArray></Points><Lines>"
               "<DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 2 3 3 9</DataArray>"
               "<DataArray type=\"Int32\" Name=\"offsets\">3 5 7</DataArray></Lines></Piece></PolyData></VTKFile>");
    OWNED(ewa_model_free) ewa_model model;
    assert_int_equal(load("lines.vtp", &model), EWA_OK);
    assert_string_equal(messages.text, "");
    // The diagonal is 5, the step 0.005: 600, 800 and 600 parts.
    const uint64_t count = ewa_cloud_point_count(model.points);
    assert_int_equal(count, 4 + 599 + 799 + 599);
    const double *places = ewa_cloud_find(model.points, EWA_POSITION)->data;
    const float *colors = ewa_cloud_find(model.points, EWA_COLOR)->data;
    for (uint64_t i = 4; i < count; i++) {
        const double *p = places + 3 * i;
        assert_true(p[1] == 0 || p[0] == 3 || p[1] == 4);
        if (p[1] == 0) assert_float_equal(colors[4 * i], 1 - p[0] / 3, 1e-6);
    }
    assert_float_equal(places[3 * 4], 0.005, 1e-12);
}

static ewa_status load_failing(ewa_context *failing, void *user) {
    char path[512];
    OWNED(ewa_model_free) ewa_model model;
    const ewa_status status = ewa_model_load(failing, scratch_path(user, path), EWA_MODEL_MESH | EWA_MODEL_POINTS, NULL, &model);
    return status;
}

CASE(test_failing_allocations) {
    scratch_fail_each(load_failing, (char[]){"list.vtm"});
}

int main(void) { return RUN_TESTS(NULL, NULL); }
