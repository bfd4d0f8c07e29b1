// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// make_synthetic_data FOLDER: point clouds, a part, cameras and what is broken; pictures and volumes are
// other files' work.
#include "tests/data/synthetic_data.h"
#include "tests/data/facts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

FILE *synthetic_open(const char *folder, const char *relative) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, relative);
    for (char *slash = path + 1; (slash = strchr(slash, '/')); slash++) {
        *slash = 0;
        mkdir(path, 0777);
        *slash = '/';
    }
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

void synthetic_put(const char *folder, const char *relative, const void *bytes, size_t size_bytes) {
    FILE *file = synthetic_open(folder, relative);
    if (size_bytes && fwrite(bytes, 1, size_bytes, file) != size_bytes) exit(1);
    if (fclose(file)) exit(1);
}

void synthetic_text(const char *folder, const char *relative, const char *text) {
    synthetic_put(folder, relative, text, strlen(text));
}

void *synthetic_memory(size_t size_bytes) {
    void *memory = calloc(size_bytes ? size_bytes : 1, 1);
    if (!memory) exit(1);
    return memory;
}

double synthetic_noise(uint64_t place) {
    uint64_t z = (place + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

// ---- Point clouds

typedef enum encoding {
    ASCII,
    LITTLE,
    BIG,
} encoding;

/// Bytes of a number in an order, whatever the machine's.
static void put_ordered(FILE *file, const void *number, size_t size_bytes, bool big) {
    const uint16_t one = 1;
    const bool machine_is_big = *(const uint8_t *)&one == 0;
    const uint8_t *bytes = number;
    for (size_t i = 0; i < size_bytes; i++)
        fputc(bytes[big == machine_is_big ? i : size_bytes - 1 - i], file);
}

/// The position of a point: the box's corners first, then anywhere in it.
static double coordinate(const double low[3], const double high[3], uint64_t point, int axis) {
    if (point == 0) return low[axis];
    if (point == 1) return high[axis];
    return low[axis] + (high[axis] - low[axis]) * synthetic_noise(3 * point + (uint64_t)axis);
}

/// A cloud in the encoding and types that its number says, with normals and colours around the positions.
static void put_cloud(const char *folder, size_t number) {
    static const char *const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const uint64_t count = model_facts[number].points;
    const bool doubles = model_facts[number].high[2] > 1e6 || number % 5 == 4;
    const encoding as = strstr(model_facts[number].path, "_be")   ? BIG
                        : count > 50000                           ? LITTLE
                        : strstr(model_facts[number].path, "_le") ? LITTLE
                                                                  : (encoding)(number % 3);
    // The two byte orders of one model hold the same numbers.
    const bool plain = strstr(model_facts[number].path, "_be") || strstr(model_facts[number].path, "_le");
    FILE *file = synthetic_open(folder, model_facts[number].path);
    const char *type = doubles && !plain ? "double" : "float";
    fprintf(file, "ply\nformat %s 1.0\ncomment a synthetic file\nelement vertex %llu\n", formats[as],
            (unsigned long long)count);
    fprintf(file, "property %s x\nproperty %s y\nproperty %s z\n", type, type, type);
    fprintf(file, "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n");
    for (uint64_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            const double value = coordinate(model_facts[number].low, model_facts[number].high, i, c);
            const float rounded = (float)value;
            if (as == ASCII)
                fprintf(file, "%.17g ", doubles && !plain ? value : (double)rounded);
            else if (doubles && !plain)
                put_ordered(file, &value, sizeof value, as == BIG);
            else
                put_ordered(file, &rounded, sizeof rounded, as == BIG);
        }
        for (int c = 0; c < 3; c++) {
            const int code = (int)(256 * synthetic_noise(7 * i + (uint64_t)c));
            if (as == ASCII)
                fprintf(file, "%d%c", code, c < 2 ? ' ' : '\n');
            else
                fputc(code, file);
        }
    }
    if (fclose(file)) exit(1);
}

static void put_broken_clouds(const char *folder) {
    synthetic_text(folder, "hostile/mesh/empty.ply", "");
    synthetic_text(folder, "hostile/mesh/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply",
                   "ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty float x\nproperty float "
                   "y\nproperty");
    synthetic_text(
        folder, "hostile/mesh/assimp_issue623.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n0 0 0\n1 0 0\n");
    synthetic_text(folder, "hostile/mesh/pdal_no_vertex.ply", "ply \nformat ascii 1.0\nend_header\n");
    synthetic_text(
        folder, "hostile/mesh/pdal_unsized_dims.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty ushort y\nproperty char x\nproperty double i\n"
        "property int j\nend_header\n12346 1 1234567890.00000 12345\n");
    synthetic_text(
        folder, "gaussians/guitar.compressed.ply",
        "ply\nformat binary_little_endian 1.0\nelement chunk 1\nproperty float min_x\nelement vertex 1\n"
        "property uint packed_position\nproperty uint packed_rotation\nend_header\n0123456789ab");
    synthetic_text(folder, "hostile/mesh/draco_inf_nan.obj", "v inf nan 0\nv 0 0 0\nv 1 0 0\nf 1 2 3\n");
}

/// A bracket of six sides: eight convex edges and one that is not, two ends.
static void put_part(const char *folder) {
    static const double outline[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const int caps[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    FILE *file = synthetic_open(folder, "models/fuze/fuze.obj");
    for (int level = 0; level < 2; level++)
        for (int i = 0; i < 6; i++)
            fprintf(file, "v %.9g %.9g %.9g\n", 0.01 * outline[i][0], 0.01 * outline[i][1], 0.02 * level);
    for (int i = 0; i < 6; i++) {
        const int a = i + 1, b = (i + 1) % 6 + 1;
        fprintf(file, "f %d %d %d\nf %d %d %d\n", a, b, b + 6, a, b + 6, a + 6);
    }
    for (int i = 0; i < 4; i++) {
        fprintf(file, "f %d %d %d\n", caps[i][2] + 1, caps[i][1] + 1, caps[i][0] + 1);
        fprintf(file, "f %d %d %d\n", caps[i][0] + 7, caps[i][1] + 7, caps[i][2] + 7);
    }
    if (fclose(file)) exit(1);
}

// ---- Cameras

static void put_cameras(const char *folder) {
    const double cosine = 0.6966662406921387, sine = sqrt(1 - cosine * cosine);
    FILE *file = synthetic_open(folder, "gaussians/garden_cameras.json");
    fprintf(file, "{\"width\": 648, \"height\": 420, \"viewmats_world_to_camera\": [");
    for (int i = 0; i < 3; i++)
        fprintf(file, "%s[[%.17g, %.17g, 0, 0.1], [%.17g, %.17g, 0, -0.2], [0, 0, 1, %d], [0, 0, 0, 1]]",
                i ? ", " : "", i == 1 ? cosine : 1, i == 1 ? -sine : 0, i == 1 ? sine : 0,
                i == 1 ? cosine : 1, i);
    fprintf(file, "], \"Ks\": [");
    for (int i = 0; i < 3; i++)
        fprintf(file, "%s[[480.5, 0, 324.1875], [0, 481.25, 210.0625], [0, 0, 1]]", i ? ", " : "");
    fprintf(file, "]}\n");
    if (fclose(file)) exit(1);
    // Cameras around the middle, at a distance of 4, that look along -z, as OpenGL's do.
    file = synthetic_open(folder, "rgbd/posed_lego/transforms_train.json");
    fprintf(file, "{\"camera_angle_x\": 0.6911112070083618, \"frames\": [");
    for (int i = 0; i < 5; i++) {
        const double c = cos(1.1 * i), s = sin(1.1 * i);
        fprintf(file,
                "%s{\"file_path\": \"./train/r_%d\", \"transform_matrix\": [[%.17g, 0, %.17g, %.17g], "
                "[%.17g, 0, %.17g, "
                "%.17g], [0, 1, 0, 0], [0, 0, 0, 1]]}",
                i ? ", " : "", i, -s, c, 4 * c, c, s, 4 * s);
    }
    fprintf(file, "]}\n");
    if (fclose(file)) exit(1);
    synthetic_text(
        folder, "rgbd/livingroom/camera_primesense.json",
        "{\"width\": 640, \"height\": 480, \"intrinsic_matrix\": [525.0, 0, 0, 0, 525.0, 0, 319.5, "
        "239.5, 1]}\n");
    file = synthetic_open(folder, "rgbd/livingroom/trajectory.log");
    for (int i = 0; i < 5; i++) {
        const double c = cos(0.3 * i), s = sin(0.3 * i);
        fprintf(file, "%d %d %d\n%.17g 0 %.17g %d\n0 1 0 0.5\n%.17g 0 %.17g 2\n0 0 0 1\n", i, i, i + 1, c, s,
                i, -s, c);
    }
    if (fclose(file)) exit(1);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "make_synthetic_data FOLDER\n");
        return 2;
    }
    for (size_t i = 0; i < sizeof model_facts / sizeof *model_facts; i++) put_cloud(argv[1], i);
    put_broken_clouds(argv[1]);
    put_part(argv[1]);
    put_cameras(argv[1]);
    synthetic_images(argv[1]);
    synthetic_volumes(argv[1]);
    return 0;
}
