// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of src/io/camera/*.c: the same camera through every format, exact round trips, messages for broken
// files.
#include "io/camera/file.h"
#include "scratch.h"

#include <math.h>

/// The camera of most tests: from (10, 0, 2) towards -x, +z up, so camera axes x = +y, y = -z, z = -x.
static const double EXPECTED[16] = {0, 1, 0, 0, 0, 0, -1, 2, -1, 0, 0, 10, 0, 0, 0, 1};

static void count_camera(void *user, uint32_t index, const ewa_camera *camera) {
    (void)camera;
    *(uint32_t *)user = index + 1;
}

static uint32_t count_cameras(ewa_context *context, const char *path) {
    uint32_t count = 0;
    assert_int_equal(ewa_camera_load_each(context, path, count_camera, &count), EWA_OK);
    return count;
}

static void assert_expected(const ewa_camera *camera, double cx, double cy) {
    assert_int_equal(camera->projection, EWA_PERSPECTIVE);
    assert_int_equal(camera->width_px, 640);
    assert_int_equal(camera->height_px, 480);
    assert_true(camera->fx_px == 500 && camera->fy_px == 510 && camera->cx_px == cx && camera->cy_px == cy);
    for (int i = 0; i < 16; i++) assert_true(camera->world_to_camera[i] == EXPECTED[i]);
}

static const char NATIVE[] = "{\"width\":640,\"height\":480,\"fx\":500,\"fy\":510,\"cx\":320.125,\"cy\":-7.5,"
                             "\"world_to_camera\":[0,1,0,0, 0,0,-1,2, -1,0,0,10, 0,0,0,1]}";
static const char OPEN3D[] =
    "{\"class_name\":\"PinholeCameraParameters\",\"version_major\":1,\"version_minor\":0,"
    "\"extrinsic\":[0,0,-1,0, 1,0,0,0, 0,-1,0,0, 0,2,10,1],"
    "\"intrinsic\":{\"width\":640,\"height\":480,\"intrinsic_matrix\":[500,0,0, 0,510,0, 319.625,-8,1]}}";
static const char TRANSFORMS[] =
    "{\"w\":640,\"h\":480,\"fl_x\":500,\"fl_y\":510,\"cx\":320.125,\"cy\":-7.5,\"k1\":0,\"camera_model\":"
    "\"OPENCV\","
    "\"frames\":[{\"file_path\":\"a.png\",\"transform_matrix\":[[0,0,1,10],[1,0,0,0],[0,1,0,2],[0,0,0,1]]}]}";
static const char INRIA[] =
    "[{\"id\":0,\"img_name\":\"a\",\"width\":640,\"height\":480,\"position\":[10,0,2],"
    "\"rotation\":[[0,0,-1],[1,0,0],[0,-1,0]],\"fx\":500,\"fy\":510}]";
static const char STACKS[] =
    "{\"width\":640,\"height\":480,\"viewmats\":[[[0,1,0,0],[0,0,-1,2],[-1,0,0,10],[0,0,0,1]]],"
    "\"Ks\":[[[500,0,320.125],[0,510,-7.5],[0,0,1]]]}";

static const char CAMERA_PATH[] =
    "{\"camera_type\":\"perspective\",\"render_width\":640,\"render_height\":480,\"fps\":24,\"seconds\":1,"
    "\"keyframes\":[],\"camera_path\":[{\"camera_to_world\":[0,0,1,10,1,0,0,0,0,1,0,2,0,0,0,1],\"fov\":90,\"aspect\":1.333}]}";

static ewa_status load_text(ewa_context *context, const char *text, uint32_t index, ewa_camera *camera) {
    char path[512];
    scratch_write(scratch_path("camera.json", path), text, strlen(text));
    ewa_camera_init(camera);
    return ewa_camera_load(context, path, index, camera);
}

TEST_ON(test_every_format_gives_the_same_camera, 1) {
    ewa_camera camera;
    const char *const texts[] = {NATIVE, OPEN3D, TRANSFORMS, STACKS};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_int_equal(load_text(context, texts[i], 0, &camera), EWA_OK);
        assert_expected(&camera, 320.125, -7.5);
    }
    assert_int_equal(load_text(context, INRIA, 0, &camera), EWA_OK); // knows no principal point
    assert_expected(&camera, 320, 240);
    assert_int_equal(load_text(context, CAMERA_PATH, 0, &camera), EWA_OK); // knows an angle
    assert_true(fabs(camera.fx_px - 240) < 1e-12 && camera.fy_px == camera.fx_px);
    camera.fx_px = 500, camera.fy_px = 510;
    assert_expected(&camera, 320, 240);
}

/// Open3D has pixel centres at whole numbers: what it calls the middle of its pictures is the middle of ours.
TEST_ON(test_open3d_middle, 1) {
    ewa_camera camera;
    char text[600];
    snprintf(text, sizeof text,
             "{\"extrinsic\":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],\"intrinsic\":{\"width\":%d,\"height\":%d,"
             "\"intrinsic_matrix\":[525,0,0, 0,525,0, %g,%g,1]}}",
             641, 480, 641 / 2.0 - 0.5, 480 / 2.0 - 0.5);
    assert_int_equal(load_text(context, text, 0, &camera), EWA_OK);
    assert_true(camera.cx_px == 320.5 && camera.cy_px == 240);
}

/// A lens comes from every format, without the pose, and from Open3D's file of a lens alone.
TEST_LOGGED(test_lens, 1) {
    static const char alone[] =
        "{\"width\":640,\"height\":480,\"intrinsic_matrix\":[500,0,0, 0,510,0, 319.625,-8,1]}";
    const char *const texts[] = {NATIVE, OPEN3D, TRANSFORMS, STACKS, alone};
    char path[512];
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        ewa_camera lens, at_origin;
        ewa_camera_init(&lens);
        ewa_camera_init(&at_origin);
        scratch_write(scratch_path("lens.json", path), texts[i], strlen(texts[i]));
        assert_int_equal(ewa_camera_load_lens(context, path, &lens), EWA_OK);
        assert_true(lens.width_px == 640 && lens.height_px == 480 && lens.fx_px == 500 && lens.fy_px == 510);
        assert_true(lens.cx_px == 320.125 && lens.cy_px == -7.5);
        assert_memory_equal(lens.world_to_camera, at_origin.world_to_camera, sizeof lens.world_to_camera);
    }
    assert_int_equal(log->count, 0);
    // What cannot be read leaves the lens as it is, with a message.
    static const char *const broken[] = {
        "{\"width\":640,\"intrinsic_matrix\":[1,0,0,0,1,0,0,0,1]}",
        "{\"width\":6,\"height\":4,\"intrinsic_matrix\":[1,0,0,0,1,0,0,0]}",
        "{\"width\":6,\"height\":4,\"intrinsic_matrix\":[0,0,0,0,1,0,0,0,1]}",
        "{\"width\":6,\"height\":4,\"intrinsic_matrix\":[1,0,0,9,1,0,0,0,1]}"};
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        ewa_camera lens, before;
        ewa_camera_init(&lens);
        ewa_camera_init(&before);
        scratch_write(scratch_path("lens.json", path), broken[i], strlen(broken[i]));
        assert_int_equal(ewa_camera_load_lens(context, path, &lens), EWA_ERROR_FORMAT);
        assert_int_equal(log->count, i + 1);
        assert_memory_equal(&lens, &before, sizeof lens);
    }
}

TEST_LOGGED(test_many_cameras, 1) {
    char path[512], text[2000];
    ewa_camera camera;
    snprintf(text, sizeof text, "[%s,\n%s]\n", NATIVE, NATIVE);
    text[10] = '7'; // the first one is 740 wide
    assert_int_equal(load_text(context, text, 1, &camera), EWA_OK);
    assert_expected(&camera, 320.125, -7.5);
    assert_int_equal(load_text(context, text, 0, &camera), EWA_OK);
    assert_int_equal(camera.width_px, 740);
    assert_int_equal(load_text(context, text, 2, &camera), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "camera 2 wanted, 2 there"));
    assert_int_equal(count_cameras(context, scratch_path("camera.json", path)), 2);
    snprintf(text, sizeof text, "{\"class_name\":\"PinholeCameraTrajectory\",\"parameters\":[%s,%s]}", OPEN3D,
             OPEN3D);
    assert_int_equal(load_text(context, text, 1, &camera), EWA_OK);
    assert_expected(&camera, 320.125, -7.5);
}

TEST_ON(test_round_trip_is_exact, 1) {
    char path[512];
    scratch_path("saved.json", path);
    check_random random = {5};
    for (int round = 0; round < 200; round++) {
        ewa_camera camera, back;
        ewa_camera_init(&camera);
        double eye[3], target[3], up[3];
        for (int i = 0; i < 3; i++) {
            eye[i] = 5e6 + check_uniform(&random, -1e3, 1e3);
            target[i] = 5e6 + check_uniform(&random, -1e3, 1e3);
            up[i] = check_uniform(&random, -1, 1);
        }
        if (round % 3 == 0) ewa_camera_set_ortho(&camera, check_uniform(&random, 1e-3, 1e3));
        assert_int_equal(ewa_camera_look_at(&camera, eye, target, up), EWA_OK);
        camera.cx_px = check_uniform(&random, -1e4, 1e4);
        camera.fy_px *= 1.01;
        assert_int_equal(ewa_camera_save(context, &camera, path), EWA_OK);
        ewa_camera_init(&back);
        assert_int_equal(ewa_camera_load(context, path, 0, &back), EWA_OK);
        assert_memory_equal(&camera, &back, sizeof camera);
    }
}

TEST_LOGGED(test_transforms_lens, 1) {
    ewa_camera camera;
    // The lens by angles; members of a frame win.
    assert_int_equal(load_text(context,
                               "{\"camera_angle_x\":1.5707963267948966,\"w\":640,\"h\":480,\"frames\":["
                               "{\"transform_matrix\":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]},"
                               "{\"transform_matrix\":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]],"
                               "\"w\":100,\"h\":50,\"fl_x\":70,\"cx\":12.5}]}",
                               0, &camera),
                     EWA_OK);
    assert_true(fabs(camera.fx_px - 320) < 1e-12 && camera.fy_px == camera.fx_px);
    assert_true(camera.cx_px == 320 && camera.cy_px == 240);
    const double opengl[12] = {1, 0, 0, -1, 0, -1, 0, 2, 0, 0, -1, 3};
    for (int i = 0; i < 12; i++) assert_true(camera.world_to_camera[i] == opengl[i]);
    char path[512];
    assert_int_equal(ewa_camera_load(context, scratch_path("camera.json", path), 1, &camera), EWA_OK);
    assert_true(camera.width_px == 100 && camera.fx_px == 70 && camera.fy_px == 70);
    assert_true(camera.cx_px == 12.5 && camera.cy_px == 25);
    assert_int_equal(log->count, 0);
    // Poses of the synthetic NeRF scenes without their pictures.
    assert_int_equal(load_text(context,
                               "{\"camera_angle_x\":1.5707963267948966,\"frames\":[{\"file_path\":\"./train/r_0\",\"transform_matrix\":"
                               "[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]}",
                               0, &camera),
                     EWA_OK);
    assert_true(camera.width_px == 800 && camera.height_px == 800 && fabs(camera.fx_px - 400) < 1e-12);
    assert_non_null(strstr(log->text, "frames[0]: says no size"));
    assert_int_equal(log->count, 1);
    // Distortion is left out with a warning, a fisheye refused.
    assert_int_equal(load_text(context,
                               "{\"fl_x\":7,\"w\":640,\"h\":480,\"k1\":0.1,\"frames\":["
                               "{\"transform_matrix\":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]}",
                               0, &camera),
                     EWA_OK);
    assert_non_null(strstr(log->text, "k1 = 0.1"));
    assert_int_equal(
        load_text(context,
                  "{\"fl_x\":7,\"w\":640,\"h\":480,\"camera_model\":\"OPENCV_FISHEYE\",\"frames\":["
                  "{\"transform_matrix\":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]}",
                  0, &camera),
        EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log->text, "camera_model"));
    assert_int_equal(load_text(context, "{\"camera_type\":\"equirectangular\",\"camera_path\":[{}]}", 0, &camera), EWA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(log->text, "'camera_type' is equirectangular, not perspective"));
}

TEST(test_messages_name_the_member) {
    static const struct {
        const char *text, *said;
    } cases[] = {
        {"", "camera.json:1:1"},
        {"{\n  \"width\": }", "camera.json:2:12"},
        {"{} x", "camera.json:1:4"},
        {"5", "is no JSON; cameras are the folder of a COLMAP model"},
        {"# Bundle file v0.3\n2 5\n", "is Bundler's bundle.out; cameras are"},
        {"NVM_V3\n", "is a model of VisualSFM; cameras are"},
        {"\xef\xbb\xbf<?xml version=\"1.0\"?>", "is XML, but no whole file of Metashape's cameras"},
        {"# Camera list with one line of data per camera:\n", "of which the folder is wanted"},
        {"ply\nformat ascii 1.0\n", "is points (PLY); cameras are"},
        {"\xff\xd8\xff\xe0", "is a picture; cameras are"},
        {"{}", "'width' is missing"},
        {"{\"ewa_scene\":1,\"items\":[]}", "'keyframes' is missing, and so is 'camera'"},
        {"[]", "'cameras' is not an array of cameras"},
        {"[{}]", "cameras[0]: member 'width' is missing"},
        {"{\"width\":640}", "'height' is missing"},
        {"{\"width\":640.5}", "'width' is not a positive whole number"},
        {"{\"width\":-1}", "'width' is not a positive whole number"},
        {"{\"width\":\"640\"}", "'width' is not a number"},
        {"{\"width\":640,\"height\":480,\"fx\":1,\"fy\":1,\"cx\":1}", "'cy' is missing"},
        {"{\"width\":640,\"height\":480,\"fx\":1,\"fy\":1,\"cx\":1,\"cy\":1}",
         "'world_to_camera' is missing"},
        {"{\"width\":640,\"height\":480,\"fx\":1,\"fy\":1,\"cx\":1,\"cy\":1,\"world_to_camera\":[1,2]}",
         "'world_to_camera' is not an array of 16 numbers"},
        {"{\"width\":640,\"height\":480,\"fx\":1,\"fy\":1,\"cx\":1,\"cy\":1,"
         "\"world_to_camera\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1,5]}",
         "'world_to_camera' is not an array of 16 numbers"},
        {"{\"width\":640,\"height\":480,\"fx\":1,\"fy\":1,\"cx\":1,\"cy\":1,"
         "\"world_to_camera\":[1,0,0,0,0,1,0,0,0,0,2,0,0,0,0,1]}",
         "world_to_camera's upper left 3x3 is not a rotation"},
        {"{\"width\":640,\"height\":480,\"fx\":0,\"fy\":1,\"cx\":1,\"cy\":1,"
         "\"world_to_camera\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}",
         "fx_px, fy_px is 0, 1"},
        {"{\"width\":70000,\"height\":480,\"fx\":1,\"fy\":1,\"cx\":1e999,\"cy\":1,"
         "\"world_to_camera\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}",
         "70000 x 480"},
        {"{\"projection\":\"fisheye\"}", "'projection' is neither"},
        {"{\"intrinsic_matrix\":[1,0,0,0,1,0,0,0,1]}", "'extrinsic' is missing"},
        {"{\"extrinsic\":[]}", "'intrinsic' is missing"},
        {"{\"intrinsic\":{\"width\":1,\"height\":1,\"intrinsic_matrix\":[1,0,0,0,1,0,0,0,1]}}",
         "'extrinsic' is missing"},
        {"{\"extrinsic\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"
         "\"intrinsic\":{\"width\":1,\"height\":1,\"intrinsic_matrix\":[1,0,0,9,1,0,0,0,1]}}",
         "'intrinsic_matrix' is skewed"},
        {"{\"parameters\":[]}", "'parameters' is not an array"},
        {"{\"frames\":[]}", "'frames' is not an array of frames"},
        {"{\"frames\":[{}]}", "frames[0]: member 'transform_matrix' is missing"},
        {"{\"frames\":[{\"transform_matrix\":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]}",
         "frames[0]: member 'w' is missing"},
        {"{\"w\":3,\"h\":3,\"frames\":[{\"transform_matrix\":[[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]}]}",
         "frames[0]: member 'fl_x or camera_angle_x' is missing"},
        {"{\"camera_path\":[]}", "'camera_path' is not an array of cameras"},
        {"{\"render_width\":3,\"render_height\":0,\"camera_path\":[{}]}", "'render_height' is not a positive whole number"},
        {"{\"render_width\":3,\"render_height\":3,\"camera_path\":[{}]}", "camera_path[0]: member 'camera_to_world' is missing"},
        {"{\"render_width\":3,\"render_height\":3,\"camera_path\":[{\"camera_to_world\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}",
         "camera_path[0]: member 'fov' is missing"},
        {"{\"render_width\":3,\"render_height\":3,\"camera_path\":[{\"fov\":180,\"camera_to_world\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}",
         "camera_path[0]: member 'fov' is not between 0 and 180 degrees"},
        {"{\"width\":1,\"height\":1,\"viewmats\":[[1]]}", "'Ks' is missing"},
        {"{\"width\":1,\"height\":1,\"viewmats\":[[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]],\"Ks\":[]}",
         "camera 0: member 'Ks' is missing"},
        {"[{\"position\":[1,2,3],\"width\":1,\"height\":1,\"fx\":1,\"fy\":1}]", "'rotation' is missing"},
        {"[{\"position\":[1,2],\"rotation\":[1,0,0,0,1,0,0,0,1],\"width\":1,\"height\":1,\"fx\":1,\"fy\":1}]",
         "cameras[0]: member 'position' is not an array of 3 numbers"},
        {"[{\"position\":[1,2,3],\"rotation\":[0,0,0,0,0,0,0,0,0],\"width\":1,\"height\":1,\"fx\":1,\"fy\":1}"
         "]",
         "cameras[0]: world_to_camera[0] is"},
    };
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ewa_camera camera, before;
        ewa_camera_init(&before);
        log = (check_log){0};
        assert_int_equal(load_text(context, cases[i].text, 0, &camera), EWA_ERROR_FORMAT);
        if (!strstr(log.text, cases[i].said))
            fail_msg("%s: said '%s', not '%s'", cases[i].text, log.text, cases[i].said);
        assert_non_null(strstr(log.text, "camera.json:"));
        assert_int_equal(log.count, 1);
        assert_memory_equal(&camera, &before, sizeof camera);
    }
    ewa_camera camera;
    ewa_camera_init(&camera);
    assert_int_equal(ewa_camera_load(context, "/nowhere/camera.json", 0, &camera), EWA_ERROR_IO);
}

TEST_LOGGED(test_every_truncation_is_refused, 1) {
    const char *const texts[] = {NATIVE, OPEN3D, TRANSFORMS, INRIA, STACKS, CAMERA_PATH};
    for (size_t t = 0; t < sizeof texts / sizeof texts[0]; t++) {
        const size_t size_bytes = strlen(texts[t]);
        for (size_t length = 0; length <= size_bytes; length++) {
            OWNED(check_free) uint8_t *exact = malloc(length ? length : 1);
            memcpy(exact, texts[t], length);
            OWNED(ewa_camera_list_free) ewa_camera_list list = {.context = context, .name = "cut.json"};
            const ewa_status status = ewa_camera_list_read_json(&list, NULL, exact, length);
            assert_int_equal(status, length == size_bytes ? EWA_OK : EWA_ERROR_FORMAT);
        }
    }
}

/// The cameras that ewa_camera_load_each() hands over.
typedef struct received {
    ewa_camera cameras[4];
    uint32_t count;
} received;

static void receive(void *user, uint32_t index, const ewa_camera *camera) {
    received *all = user;
    assert_int_equal(index, all->count);
    assert_true(index < 4);
    all->cameras[all->count++] = *camera;
}

/// A list that was written comes back bit by bit, in order; a broken file hands over nothing.
TEST_ON(test_list, 1) {
    char path[512];
    scratch_path("list.json", path);
    ewa_camera cameras[3];
    for (int i = 0; i < 3; i++) {
        const double eye[3] = {i + 0.1, 2, 3}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
        ewa_camera_init(&cameras[i]);
        assert_int_equal(ewa_camera_look_at(&cameras[i], eye, target, up), EWA_OK);
    }
    cameras[1].projection = EWA_ORTHOGRAPHIC;
    received all = {.count = 0};
    assert_int_equal(ewa_camera_save_list(context, cameras, 3, path), EWA_OK);
    assert_int_equal(ewa_camera_load_each(context, path, receive, &all), EWA_OK);
    assert_int_equal(all.count, 3);
    assert_memory_equal(all.cameras, cameras, sizeof cameras);
    cameras[2].fx_px = -1;
    assert_int_equal(ewa_camera_save_list(context, cameras, 3, path), EWA_ERROR_ARGUMENT);
    assert_int_equal(ewa_camera_save_list(context, cameras, 0, path), EWA_ERROR_ARGUMENT);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("[{\"width\": 2}]", file);
    fclose(file);
    all.count = 0;
    assert_int_equal(ewa_camera_load_each(context, path, receive, &all), EWA_ERROR_FORMAT);
    assert_int_equal(all.count, 0);
}

TEST_LOGGED(test_refuses_to_write_nonsense, 1) {
    char path[512];
    remove(scratch_path("never.json", path));
    ewa_camera camera;
    ewa_camera_init(&camera);
    assert_int_equal(ewa_camera_save(context, &camera, "/nowhere/camera.json"), EWA_ERROR_IO);
    camera.cx_px = NAN;
    assert_int_equal(ewa_camera_save(context, &camera, path), EWA_ERROR_ARGUMENT);
    assert_non_null(strstr(log->text, "cx_px"));
    assert_int_equal(access(path, F_OK), -1);
}

static const char LENSES_TEXT[] = "# Camera list\n\n7 PINHOLE 640 480 500 510 320.125 -7.5\n"
                                  "2 SIMPLE_RADIAL 64 48 50 32 24 0.25\n";
// The quaternion of EXPECTED is (1, 1, 1, -1) / 2; the first image has no points, so an empty
// line.
static const char IMAGES_TEXT[] = "# Image list\n1 0.5 0.5 0.5 -0.5 0 2 10 7 a name.png\n\n"
                                  "5 1 0 0 0 1 2 3 2 b.png\n1.5 2.5 -1 3 4 7\n";

typedef struct packer {
    uint8_t bytes[1024];
    size_t size_bytes;
} packer;

static void pack(packer *to, uint64_t value, int size_bytes) {
    for (int i = 0; i < size_bytes; i++) to->bytes[to->size_bytes++] = (uint8_t)(value >> 8 * i);
}

static void pack_f64(packer *to, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    pack(to, bits, 8);
}

/// The same model as LENSES_TEXT and IMAGES_TEXT.
static void make_binary(packer *lenses, packer *images) {
    *lenses = *images = (packer){.size_bytes = 0};
    const double pinhole[] = {500, 510, 320.125, -7.5}, radial[] = {50, 32, 24, 0.25};
    pack(lenses, 2, 8);
    pack(lenses, 7, 4), pack(lenses, 1, 4), pack(lenses, 640, 8), pack(lenses, 480, 8);
    for (int i = 0; i < 4; i++) pack_f64(lenses, pinhole[i]);
    pack(lenses, 2, 4), pack(lenses, 2, 4), pack(lenses, 64, 8), pack(lenses, 48, 8);
    for (int i = 0; i < 4; i++) pack_f64(lenses, radial[i]);
    const double poses[2][7] = {{0.5, 0.5, 0.5, -0.5, 0, 2, 10}, {1, 0, 0, 0, 1, 2, 3}};
    pack(images, 2, 8);
    for (int image = 0; image < 2; image++) {
        pack(images, image ? 5 : 1, 4);
        for (int i = 0; i < 7; i++) pack_f64(images, poses[image][i]);
        pack(images, image ? 2 : 7, 4);
        for (const char *name = image ? "b.png" : "a name.png"; *name; name++)
            pack(images, (uint64_t)*name, 1);
        pack(images, 0, 1);
        pack(images, image ? 1 : 0, 8);
        if (image) pack_f64(images, 1.5), pack_f64(images, 2.5), pack(images, UINT64_MAX, 8);
    }
}

static void check_colmap(ewa_context *context, check_log *log, const char *folder) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    assert_int_equal(ewa_camera_load(context, folder, 0, &camera), EWA_OK);
    assert_expected(&camera, 320.125, -7.5);
    assert_non_null(strstr(log->text, "lens distortion of camera 2 (SIMPLE_RADIAL)"));
    assert_int_equal(ewa_camera_load(context, folder, 1, &camera), EWA_OK);
    assert_true(camera.width_px == 64 && camera.fx_px == 50 && camera.fy_px == 50 && camera.cy_px == 24);
    assert_true(camera.world_to_camera[3] == 1 && camera.world_to_camera[7] == 2 &&
                camera.world_to_camera[11] == 3);
    assert_int_equal(count_cameras(context, folder), 2);
}

TEST(test_colmap) {
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    static const char *const names[] = {"cameras.txt", "images.txt", "cameras.bin", "images.bin"};
    char folder[512], path[600];
    scratch_path("colmap", folder);
    mkdir(folder, 0777);
    for (int i = 0; i < 4; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        remove(path);
    }
    ewa_camera camera;
    ewa_camera_init(&camera);
    assert_int_equal(ewa_camera_load(context, folder, 0, &camera), EWA_ERROR_FORMAT);
    assert_non_null(strstr(log.text, "without a COLMAP model"));
    packer lenses, images;
    make_binary(&lenses, &images);
    snprintf(path, sizeof path, "%s/cameras.txt", folder);
    scratch_write(path, LENSES_TEXT, sizeof LENSES_TEXT - 1);
    snprintf(path, sizeof path, "%s/images.txt", folder);
    scratch_write(path, IMAGES_TEXT, sizeof IMAGES_TEXT - 1);
    check_colmap(context, &log, folder);
    remove(path); // images.txt: only the binary model is whole
    snprintf(path, sizeof path, "%s/cameras.bin", folder);
    scratch_write(path, lenses.bytes, lenses.size_bytes);
    snprintf(path, sizeof path, "%s/images.bin", folder);
    scratch_write(path, images.bytes, images.size_bytes);
    log = (check_log){0};
    check_colmap(context, &log, folder);
}

static ewa_status read_colmap(ewa_context *context, bool is_text, const void *lenses, size_t lenses_bytes,
                              const void *images, size_t images_bytes) {
    uint8_t *first = malloc(lenses_bytes + 1), *second = malloc(images_bytes + 1);
    memcpy(first, lenses, lenses_bytes);
    memcpy(second, images, images_bytes);
    first = realloc(first, lenses_bytes ? lenses_bytes : 1);
    second = realloc(second, images_bytes ? images_bytes : 1);
    ewa_camera_list list = {.context = context, .name = "model"};
    const ewa_status status =
        ewa_camera_list_read_colmap_memory(&list, is_text, first, lenses_bytes, second, images_bytes);
    ewa_camera_list_free(&list);
    free(first);
    free(second);
    return status;
}

TEST(test_broken_colmap) {
    check_log log = {0};
    OWNED(ewa_context_destroy) ewa_context *context = check_context(1, &log);
    packer lenses, images;
    make_binary(&lenses, &images);
    for (size_t length = 0; length < lenses.size_bytes; length++)
        assert_int_equal(read_colmap(context, false, lenses.bytes, length, images.bytes, images.size_bytes),
                         EWA_ERROR_FORMAT);
    for (size_t length = 0; length < images.size_bytes; length++)
        assert_int_equal(read_colmap(context, false, lenses.bytes, lenses.size_bytes, images.bytes, length),
                         EWA_ERROR_FORMAT);
    for (size_t at = 0; at < images.size_bytes; at++) { // whatever comes of it, no harm is done
        images.bytes[at] ^= 0xff;
        read_colmap(context, false, lenses.bytes, lenses.size_bytes, images.bytes, images.size_bytes);
        images.bytes[at] ^= 0xff;
    }
    for (size_t length = 0; length < sizeof LENSES_TEXT - 1; length++)
        read_colmap(context, true, LENSES_TEXT, length, IMAGES_TEXT, sizeof IMAGES_TEXT - 1);
    for (size_t length = 0; length < sizeof IMAGES_TEXT - 1; length++)
        read_colmap(context, true, LENSES_TEXT, sizeof LENSES_TEXT - 1, IMAGES_TEXT, length);
    static const struct {
        const char *lenses, *images, *said;
    } cases[] = {
        {"x", "", "cameras.txt: line 1: camera id"},
        {"\n1 LENS", "", "cameras.txt: line 2: camera model"},
        {"1 PINHOLE 5", "", "width and height"},
        {"1 PINHOLE 5 5 1 1 1", "", "parameter"},
        {"1 PINHOLE 5 5 1 1 1 1,5", "", "parameter"},
        {"1 FOV 5 5 1 1 1 1 1", "", "model FOV"},
        {"", "", "no images"},
        {"", "1 1 0 0 0 1 2 3 9 a", "camera 9, which is missing"},
        {"1 PINHOLE 5 5 1 1 1 1", "1 1 0 0 0 1 2", "images.txt: line 1"},
        {"1 PINHOLE 5 5 1 1 1 1", "1 0 0 0 0 1 2 3 1 a", "image 1: world_to_camera[0] is"},
        {"1 PINHOLE 0 5 1 1 1 1", "4 1 0 0 0 1 2 3 1 a", "image 4: width_px"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        log = (check_log){0};
        assert_int_not_equal(read_colmap(context, true, cases[i].lenses, strlen(cases[i].lenses),
                                         cases[i].images, strlen(cases[i].images)),
                             EWA_OK);
        if (!strstr(log.text, cases[i].said)) fail_msg("said '%s', not '%s'", log.text, cases[i].said);
    }
}

TEST_LOGGED(test_real_files, 1) {
    char path[512];
    ewa_camera camera;
    ewa_camera_init(&camera);
    if (check_data("gaussians/garden_cameras.json", path, sizeof path)) {
        assert_int_equal(count_cameras(context, path), 3);
        assert_int_equal(ewa_camera_load(context, path, 1, &camera), EWA_OK);
        assert_true(camera.width_px == 648 && camera.height_px == 420 && camera.cx_px == 324.1875);
        assert_true(camera.world_to_camera[0] == 0.6966662406921387 && camera.world_to_camera[15] == 1);
    }
    if (check_data("rgbd/posed_lego/transforms_train.json", path, sizeof path)) {
        assert_int_equal(count_cameras(context, path), 5);
        assert_int_equal(ewa_camera_load(context, path, 4, &camera), EWA_OK);
        assert_true(camera.width_px == 800 && camera.height_px == 800); // of the pictures beside it
        assert_true(fabs(camera.fx_px - 400 / tan(0.6911112070083618 / 2)) < 1e-9);
        // The synthetic scenes look at their middle from a distance of 4: it is seen near the picture's
        // middle.
        const double *m = camera.world_to_camera;
        assert_true(m[11] > 3.5 && m[11] < 4.5);
        assert_true(fabs(m[3]) < 0.1 && fabs(m[7]) < 0.1);
    }
    if (check_data("rgbd/livingroom/camera_primesense.json", path, sizeof path)) {
        assert_int_equal(ewa_camera_load(context, path, 0, &camera), EWA_ERROR_FORMAT);
        assert_non_null(strstr(log->text, "'extrinsic' is missing"));
    }
}

static ewa_status save_and_load_work(ewa_context *context, void *user) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    ewa_status status = ewa_camera_save(context, &camera, user);
    if (status == EWA_OK) status = ewa_camera_load(context, user, 0, &camera);
    return status;
}

static ewa_status colmap_work(ewa_context *context, void *user) {
    (void)user;
    return read_colmap(context, true, LENSES_TEXT, sizeof LENSES_TEXT - 1, IMAGES_TEXT,
                       sizeof IMAGES_TEXT - 1);
}

TEST(test_failing_allocations) {
    char path[512];
    scratch_fail_each(save_and_load_work, (void *)(uintptr_t)scratch_path("memory.json", path));
    scratch_fail_each(colmap_work, NULL);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
