// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Camera files in JSON, told apart by their members: ours, Open3D's PinholeCameraParameters and
// PinholeCameraTrajectory, transforms.json of nerfstudio and instant-ngp, nerfstudio's camera paths, cameras.json of
// INRIA's Gaussian splatting, and stacks of matrices as gsplat takes them (viewmats, Ks).
#include "base/base.h"
#include "base/platform.h"
#include "io/camera/file.h"
#include "io/image/png.h"
#include "io/json_text.h"
#include "io/referenced_file.h"
#include "math/angle.h"

#include <stdio.h>
#include <string.h>

enum { WHERE_BYTES = 64 };

typedef struct source {
    ewa_camera_list *list;
    const char *path;        // of the file, or NULL
    char where[WHERE_BYTES]; // of the object that is read: "", or such as "frames[3]"
    bool warned;             // of distortion
    bool size_warned;        // of a size that is guessed
} source;

static ewa_status fail_member(const source *in, const char *member, const char *what) {
    return ewa_fail(in->list->context, EWA_ERROR_FORMAT, "%s: %s%smember '%s' %s", in->list->name, in->where,
                    in->where[0] ? ": " : "", member, what);
}

static const cJSON *find(const cJSON *object, const char *member) {
    return cJSON_GetObjectItemCaseSensitive(object, member);
}

static ewa_status read_number(const source *in, const cJSON *object, const char *member, double *value) {
    const cJSON *item = find(object, member);
    if (!item) return fail_member(in, member, "is missing");
    if (!cJSON_IsNumber(item)) return fail_member(in, member, "is not a number");
    *value = item->valuedouble;
    return EWA_OK;
}

/// Leaves `value` alone when there is no such member.
static ewa_status read_optional(const source *in, const cJSON *object, const char *member, double *value) {
    return find(object, member) ? read_number(in, object, member, value) : EWA_OK;
}

static ewa_status read_side(const source *in, const cJSON *object, const char *member, uint32_t *side_px) {
    double value = 0;
    EWA_TRY(read_number(in, object, member, &value));
    if (!(value >= 1 && value <= UINT32_MAX) || value != (double)(uint32_t)value)
        return fail_member(in, member, "is not a positive whole number");
    *side_px = (uint32_t)value;
    return EWA_OK;
}

static ewa_status read_size(const source *in, const cJSON *object, ewa_camera *camera) {
    EWA_TRY(read_side(in, object, "width", &camera->width_px));
    return read_side(in, object, "height", &camera->height_px);
}

/// Appends the numbers of an array, nested or not, while there is room; false when anything else is in it or
/// there are more.
static bool flatten(const cJSON *array, double *values, int *count, int maximum) {
    if (!cJSON_IsArray(array)) return false;
    const cJSON *item;
    cJSON_ArrayForEach(item, array) {
        if (cJSON_IsArray(item)) {
            if (!flatten(item, values, count, maximum)) return false;
        } else {
            if (!cJSON_IsNumber(item) || *count == maximum) return false;
            values[(*count)++] = item->valuedouble;
        }
    }
    return true;
}

/// Reads an array of exactly `wanted` numbers, flat or in rows.
static ewa_status read_array(const source *in, const cJSON *item, const char *member, int wanted,
                             double *values) {
    if (!item) return fail_member(in, member, "is missing");
    int count = 0;
    if (flatten(item, values, &count, wanted) && count == wanted) return EWA_OK;
    char what[64];
    snprintf(what, sizeof what, "is not an array of %d numbers", wanted);
    return fail_member(in, member, what);
}

/// Adds a camera with the name of the picture that it took, where its object has one.
static ewa_status add(const source *in, const cJSON *object, const ewa_camera *camera) {
    EWA_TRY(ewa_camera_list_add(in->list, in->where, camera));
    const char *picture = cJSON_GetStringValue(find(object, "file_path"));
    if (!picture) picture = cJSON_GetStringValue(find(object, "img_name"));
    return picture && picture[0] ? ewa_camera_list_name(in->list, (ewa_text){picture, strlen(picture)}) : EWA_OK;
}

static ewa_status read_native(const source *in, const cJSON *object) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    const cJSON *projection = find(object, "projection");
    if (projection) {
        const char *text = cJSON_GetStringValue(projection);
        if (text && strcmp(text, "orthographic") == 0)
            camera.projection = EWA_ORTHOGRAPHIC;
        else if (!text || strcmp(text, "perspective") != 0)
            return fail_member(in, "projection", "is neither \"perspective\" nor \"orthographic\"");
    }
    EWA_TRY(read_size(in, object, &camera));
    EWA_TRY(read_number(in, object, "fx", &camera.fx_px));
    EWA_TRY(read_number(in, object, "fy", &camera.fy_px));
    EWA_TRY(read_number(in, object, "cx", &camera.cx_px));
    EWA_TRY(read_number(in, object, "cy", &camera.cy_px));
    EWA_TRY(read_array(in, find(object, "world_to_camera"), "world_to_camera", 16, camera.world_to_camera));
    return add(in, object, &camera);
}

/// INRIA: `rotation` and `position` are camera to world, the principal point is in the middle.
static ewa_status read_inria(const source *in, const cJSON *object) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    double rotation[9], position[3];
    EWA_TRY(read_size(in, object, &camera));
    EWA_TRY(read_number(in, object, "fx", &camera.fx_px));
    EWA_TRY(read_number(in, object, "fy", &camera.fy_px));
    EWA_TRY(read_array(in, find(object, "rotation"), "rotation", 9, rotation));
    EWA_TRY(read_array(in, find(object, "position"), "position", 3, position));
    camera.cx_px = 0.5 * camera.width_px;
    camera.cy_px = 0.5 * camera.height_px;
    ewa_camera_set_inverse(&camera, rotation, position);
    return add(in, object, &camera);
}

/// Where Open3D has pixel centres at whole numbers, ours are at halves: the middle of 640 pixels is its
/// 319.5.
static const double OPEN3D_SHIFT_PX = 0.5;

/// Open3D's PinholeCameraIntrinsic; the matrix is column-major.
static ewa_status read_open3d_lens(const source *in, const cJSON *intrinsic, ewa_camera *camera) {
    double k[9];
    EWA_TRY(read_size(in, intrinsic, camera));
    EWA_TRY(read_array(in, find(intrinsic, "intrinsic_matrix"), "intrinsic_matrix", 9, k));
    if (k[3] != 0) return fail_member(in, "intrinsic_matrix", "is skewed");
    camera->fx_px = k[0];
    camera->fy_px = k[4];
    camera->cx_px = k[6] + OPEN3D_SHIFT_PX;
    camera->cy_px = k[7] + OPEN3D_SHIFT_PX;
    return EWA_OK;
}

/// Open3D's PinholeCameraParameters; the extrinsic matrix is column-major too.
static ewa_status read_open3d(const source *in, const cJSON *object) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    const cJSON *intrinsic = find(object, "intrinsic");
    if (!intrinsic) return fail_member(in, "intrinsic", "is missing");
    double extrinsic[16];
    EWA_TRY(read_open3d_lens(in, intrinsic, &camera));
    EWA_TRY(read_array(in, find(object, "extrinsic"), "extrinsic", 16, extrinsic));
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) camera.world_to_camera[4 * r + c] = extrinsic[4 * c + r];
    return ewa_camera_list_add(in->list, in->where, &camera);
}

/// A lens alone: a camera at the origin where that will do.
static ewa_status read_lens_alone(const source *in, const cJSON *intrinsic) {
    if (!in->list->lens_suffices)
        return ewa_fail(in->list->context, EWA_ERROR_FORMAT,
                        "%s: holds an intrinsic matrix only: member 'extrinsic' is missing", in->list->name);
    ewa_camera camera;
    ewa_camera_init(&camera);
    EWA_TRY(read_open3d_lens(in, intrinsic, &camera));
    return ewa_camera_list_add(in->list, in->where, &camera);
}

/// Calls `read` for each object of an array.
static ewa_status read_each(source *in, const cJSON *array, const char *member,
                            ewa_status (*read)(const source *in, const cJSON *object)) {
    if (!cJSON_IsArray(array) || !array->child) return fail_member(in, member, "is not an array of cameras");
    size_t index = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, array) {
        snprintf(in->where, sizeof in->where, "%s[%zu]", member, index++);
        EWA_TRY(read(in, item));
    }
    return EWA_OK;
}

/// gsplat: world-to-camera matrices and intrinsic matrices, row-major, one size for all.
static ewa_status read_stacks(source *in, const cJSON *object, const cJSON *matrices) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    EWA_TRY(read_size(in, object, &camera));
    const cJSON *intrinsics = find(object, "Ks");
    if (!cJSON_IsArray(intrinsics)) return fail_member(in, "Ks", "is missing or not an array");
    const cJSON *matrix = matrices->child, *intrinsic = intrinsics->child;
    for (size_t index = 0; matrix; matrix = matrix->next, intrinsic = intrinsic->next, index++) {
        snprintf(in->where, sizeof in->where, "camera %zu", index);
        double k[9];
        EWA_TRY(read_array(in, matrix, matrices->string, 16, camera.world_to_camera));
        EWA_TRY(read_array(in, intrinsic, "Ks", 9, k));
        if (k[1] != 0) return fail_member(in, "Ks", "is skewed");
        camera.fx_px = k[0];
        camera.fy_px = k[4];
        camera.cx_px = k[2];
        camera.cy_px = k[5];
        EWA_TRY(ewa_camera_list_add(in->list, in->where, &camera));
    }
    return EWA_OK;
}

/// Takes the size from the PNG picture of a frame, as the synthetic NeRF scenes want it: "file_path" beside
/// the JSON file, with or without ".png". Theirs are all square and of one size, which is taken where there is no picture and
/// the lens is told by an angle.
static ewa_status read_picture_size(source *in, const cJSON *frame, bool by_angle, ewa_camera *camera) {
    enum { NERF_SIDE_PX = 800 };
    const char *picture = cJSON_GetStringValue(find(frame, "file_path"));
    char name[EWA_PATH_BYTES], reason[EWA_REASON_BYTES];
    ewa_file file;
    bool found = false;
    for (int attempt = 0; picture && in->path && attempt < 2 && !found; attempt++) {
        const int length = snprintf(name, sizeof name, "%s%s", picture, attempt ? ".png" : "");
        found = length > 0 && (size_t)length < sizeof name &&
                ewa_referenced_file_map(in->list->context, in->path, (ewa_text){name, (size_t)length}, &file, reason);
    }
    if (!found && by_angle) {
        camera->width_px = camera->height_px = NERF_SIDE_PX;
        if (!in->size_warned)
            ewa_report(in->list->context, EWA_SEVERITY_WARNING,
                       "%s: %s: says no size, and its picture is not there: taken as %d x %d pixels, as those of synthetic NeRF scenes are",
                       in->list->name, in->where, NERF_SIDE_PX, NERF_SIDE_PX);
        in->size_warned = true;
        return EWA_OK;
    }
    if (!found) return fail_member(in, "w", "is missing, and so is the frame's picture");
    const ewa_status status = ewa_png_recognise(file.bytes, file.size_bytes)
                                  ? ewa_png_size(in->list->context, name, file.bytes, file.size_bytes,
                                                 &camera->width_px, &camera->height_px)
                                  : fail_member(in, "w", "is missing, and the frame's picture is not PNG");
    ewa_file_unmap(in->list->context, &file);
    return status;
}

/// The lens of one frame: members of the frame win over those of the file.
static ewa_status read_frame_lens(source *in, const cJSON *root, const cJSON *frame,
                                  ewa_camera *camera) {
    const cJSON *levels[2] = {root, frame};
    double width = 0, height = 0, fx = 0, fy = 0, cx = -1, cy = -1, angle_x = 0, angle_y = 0;
    bool has_centre_x = false, has_centre_y = false;
    for (int level = 0; level < 2; level++) {
        const cJSON *object = levels[level];
        const struct {
            const char *member;
            double *value;
        } optional[] = {{"w", &width},
                        {"h", &height},
                        {"fl_x", &fx},
                        {"fl_y", &fy},
                        {"cx", &cx},
                        {"cy", &cy},
                        {"camera_angle_x", &angle_x},
                        {"camera_angle_y", &angle_y}};
        for (size_t i = 0; i < sizeof optional / sizeof optional[0]; i++) {
            EWA_TRY(read_optional(in, object, optional[i].member, optional[i].value));
        }
        has_centre_x |= find(object, "cx") != NULL;
        has_centre_y |= find(object, "cy") != NULL;
    }
    if (width == 0 && height == 0) {
        EWA_TRY(read_picture_size(in, frame, fx == 0 && fy == 0 && angle_x > 0, camera));
    } else {
        if (!(width >= 1 && width <= UINT32_MAX && height >= 1 && height <= UINT32_MAX) ||
            width != (double)(uint32_t)width || height != (double)(uint32_t)height)
            return fail_member(in, "w or h", "is not a positive whole number");
        camera->width_px = (uint32_t)width;
        camera->height_px = (uint32_t)height;
    }
    if (fx == 0 && angle_x > 0 && angle_x < EWA_PI) fx = 0.5 * camera->width_px / ewa_tan(0.5 * angle_x);
    if (fy == 0 && angle_y > 0 && angle_y < EWA_PI) fy = 0.5 * camera->height_px / ewa_tan(0.5 * angle_y);
    if (fx == 0) fx = fy;
    if (fx == 0) return fail_member(in, "fl_x or camera_angle_x", "is missing or out of range");
    camera->fx_px = fx;
    camera->fy_px = fy == 0 ? fx : fy;
    camera->cx_px = has_centre_x ? cx : 0.5 * camera->width_px;
    camera->cy_px = has_centre_y ? cy : 0.5 * camera->height_px;
    return EWA_OK;
}

/// The lens of one frame: members of the frame win over those of the file. Where lenses are not taken, one that the file
/// tells is left out, with a warning; a fisheye is refused.
static ewa_status read_distortion(source *in, const cJSON *root, const cJSON *frame, ewa_lens *lens) {
    static const char *const names[] = {"k1", "k2", "k3", "k4", "p1", "p2"};
    const cJSON *levels[2] = {root, frame};
    const char *model = "OPENCV";
    double values[6] = {0};
    for (int level = 0; level < 2; level++) {
        const char *named = cJSON_GetStringValue(find(levels[level], "camera_model"));
        if (named) model = named;
        for (size_t i = 0; i < 6; i++) EWA_TRY(read_optional(in, levels[level], names[i], &values[i]));
    }
    const bool fisheye = strcmp(model, "OPENCV_FISHEYE") == 0;
    const bool pinhole = strcmp(model, "PINHOLE") == 0 || strcmp(model, "SIMPLE_PINHOLE") == 0;
    const bool takes = in->list->takes_lenses;
    *lens = (ewa_lens){.model = fisheye ? EWA_LENS_FISHEYE : EWA_LENS_PINHOLE};
    if (!(pinhole || (fisheye && takes) || strcmp(model, "OPENCV") == 0))
        return ewa_fail(in->list->context, EWA_ERROR_UNSUPPORTED, "%s: member 'camera_model' is %s, not a pinhole",
                        in->list->name, model);
    if (takes && !fisheye && values[3] != 0)
        return ewa_fail(in->list->context, EWA_ERROR_UNSUPPORTED, "%s: lens distortion k4 = %g of a lens that is no fisheye",
                        in->list->name, values[3]);
    for (int i = 0; i < 6; i++) {
        if (values[i] == 0) continue;
        *(i < 4 ? &lens->radial[i] : &lens->tangential[i - 4]) = values[i];
        if (!fisheye) lens->model = EWA_LENS_BROWN;
        if (takes || in->warned) continue;
        ewa_report(in->list->context, EWA_SEVERITY_WARNING, "%s: lens distortion (%s = %g) is left out", in->list->name,
                   names[i], values[i]);
        in->warned = true;
    }
    return EWA_OK;
}

/// Places a camera by a matrix from camera to world whose camera axes are as in OpenGL (x right, y up, z backward).
static void place_by_opengl(const double matrix[16], ewa_camera *camera) {
    double rotation[9], centre[3];
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) rotation[3 * r + c] = c == 0 ? matrix[4 * r] : -matrix[4 * r + c];
        centre[r] = matrix[4 * r + 3];
    }
    ewa_camera_set_inverse(camera, rotation, centre);
}

/// nerfstudio, instant-ngp.
static ewa_status read_transforms(source *in, const cJSON *root, const cJSON *frames) {
    if (!cJSON_IsArray(frames) || !frames->child)
        return fail_member(in, "frames", "is not an array of frames");
    size_t index = 0;
    const cJSON *frame;
    cJSON_ArrayForEach(frame, frames) {
        snprintf(in->where, sizeof in->where, "frames[%zu]", index++);
        ewa_camera camera;
        ewa_camera_init(&camera);
        double matrix[16];
        EWA_TRY(read_array(in, find(frame, "transform_matrix"), "transform_matrix", 16, matrix));
        ewa_lens lens;
        EWA_TRY(read_frame_lens(in, root, frame, &camera));
        EWA_TRY(read_distortion(in, root, frame, &lens));
        place_by_opengl(matrix, &camera);
        EWA_TRY(add(in, frame, &camera));
        ewa_camera_list_set_lens(in->list, &lens);
    }
    return EWA_OK;
}

/// nerfstudio's viewer: one size for all cameras, each with its angle from top to bottom.
static ewa_status read_camera_path(source *in, const cJSON *root, const cJSON *path) {
    static const double DEGREES = EWA_PI / 180;
    const char *type = cJSON_GetStringValue(find(root, "camera_type"));
    if (type && strcmp(type, "perspective") != 0)
        return ewa_fail(in->list->context, EWA_ERROR_UNSUPPORTED, "%s: member 'camera_type' is %.40s, not perspective",
                        in->list->name, type);
    if (!cJSON_IsArray(path) || !path->child) return fail_member(in, "camera_path", "is not an array of cameras");
    uint32_t width_px, height_px;
    EWA_TRY(read_side(in, root, "render_width", &width_px));
    EWA_TRY(read_side(in, root, "render_height", &height_px));
    size_t index = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, path) {
        snprintf(in->where, sizeof in->where, "camera_path[%zu]", index++);
        ewa_camera camera;
        ewa_camera_init(&camera);
        double matrix[16], fov_deg = 0;
        EWA_TRY(read_array(in, find(item, "camera_to_world"), "camera_to_world", 16, matrix));
        EWA_TRY(read_number(in, item, "fov", &fov_deg));
        if (!(fov_deg > 0 && fov_deg < 180)) return fail_member(in, "fov", "is not between 0 and 180 degrees");
        camera.width_px = width_px, camera.height_px = height_px;
        camera.fx_px = camera.fy_px = 0.5 * height_px / ewa_tan(0.5 * fov_deg * DEGREES);
        camera.cx_px = 0.5 * width_px, camera.cy_px = 0.5 * height_px;
        place_by_opengl(matrix, &camera);
        EWA_TRY(add(in, item, &camera));
    }
    return EWA_OK;
}

/// One camera of an array at the top: ours or INRIA's.
static ewa_status read_element(const source *in, const cJSON *object) {
    return find(object, "rotation") || find(object, "position") ? read_inria(in, object)
                                                                : read_native(in, object);
}

/// Reads the cameras of a scene file: its keyframes, and before them the camera from which it is seen, unless only the way
/// of a film is wanted.
static ewa_status read_scene(source *in, const cJSON *root) {
    const cJSON *camera = in->list->of_film ? NULL : find(root, "camera"), *keyframes = find(root, "keyframes");
    if (!camera && !keyframes)
        return fail_member(in, "keyframes", in->list->of_film ? "is missing: these are the cameras of a film"
                                                              : "is missing, and so is 'camera'");
    if (camera) {
        snprintf(in->where, sizeof in->where, "camera");
        EWA_TRY(read_native(in, camera));
        in->where[0] = 0;
    }
    return keyframes ? read_each(in, keyframes, "keyframes", read_element) : EWA_OK;
}

static ewa_status read_root(source *in, const cJSON *root) {
    if (cJSON_IsArray(root)) return read_each(in, root, "cameras", read_element);
    const cJSON *item;
    if ((item = find(root, "frames"))) return read_transforms(in, root, item);
    if ((item = find(root, "camera_path"))) return read_camera_path(in, root, item);
    if (find(root, "ewa_scene")) return read_scene(in, root);
    if ((item = find(root, "parameters"))) return read_each(in, item, "parameters", read_open3d);
    if (find(root, "extrinsic") || find(root, "intrinsic")) return read_open3d(in, root);
    if (find(root, "intrinsic_matrix")) return read_lens_alone(in, root);
    for (int i = 0; i < 2; i++) {
        item = find(root, i ? "viewmats" : "viewmats_world_to_camera");
        if (cJSON_IsArray(item)) return read_stacks(in, root, item);
    }
    return read_native(in, root);
}

ewa_status ewa_camera_list_read_tree(ewa_camera_list *list, const cJSON *root) {
    source in = {.list = list, .path = NULL};
    return read_root(&in, root);
}

ewa_status ewa_camera_list_read_json(ewa_camera_list *list, const char *path, const uint8_t *bytes,
                                     size_t size_bytes) {
    ewa_json json;
    EWA_TRY(ewa_json_parse(list->context, list->name, "a camera file", bytes, size_bytes, &json));
    source in = {.list = list, .path = path};
    ewa_status status = read_root(&in, json.root);
    ewa_json_free(list->context, &json);
    return status;
}
