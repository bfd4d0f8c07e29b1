// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// probe write FILE SOURCE_DIR SCRATCH [SECTION...]   runs the calls, for every instruction set that the CPU
// has probe compare FILE FILE                            0: the same to a pixel's 1/255 and 1e-3; 1: prints
// what differs
#include "tests/probe/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void put_header(probe *to, const char *name, probe_kind kind, size_t count) {
    char whole[256] = {0};
    const uint64_t numbers[2] = {(uint64_t)kind, count};
    snprintf(whole, sizeof whole, "%s%s", to->prefix, name);
    fwrite(whole, 1, sizeof whole, to->file);
    fwrite(numbers, sizeof *numbers, 2, to->file);
}

void probe_doubles(probe *to, const char *name, probe_kind kind, const double *values, size_t count) {
    put_header(to, name, kind, count);
    fwrite(values, sizeof *values, count, to->file);
}

void probe_floats(probe *to, const char *name, probe_kind kind, const float *values, size_t count) {
    put_header(to, name, kind, count);
    for (size_t i = 0; i < count; i++) {
        const double value = (double)values[i];
        fwrite(&value, sizeof value, 1, to->file);
    }
}

void probe_number(probe *to, const char *name, double value) {
    probe_doubles(to, name, PROBE_NUMBERS, &value, 1);
}

void probe_status(probe *to, const char *name, ewa_status status) { probe_number(to, name, (double)status); }

void probe_cloud(probe *to, const char *name, const ewa_cloud *cloud) {
    char part[128];
    probe_number(to, name, cloud ? (double)ewa_cloud_point_count(cloud) : -1);
    if (!cloud) return;
    double origin[3];
    ewa_cloud_origin(cloud, origin);
    snprintf(part, sizeof part, "%s origin", name);
    probe_doubles(to, part, PROBE_NUMBERS, origin, 3);
    for (uint32_t i = 0; i < ewa_cloud_attribute_count(cloud); i++) {
        const ewa_attribute *attribute = ewa_cloud_attribute_at(cloud, i);
        const uint64_t points = ewa_cloud_point_count(cloud);
        const size_t count = (size_t)points * attribute->component_count;
        OWNED(check_free) double *values = calloc(count ? count : 1, sizeof *values);
        if (!values) abort();
        ewa_attribute_read_f64(attribute, 0, points, values);
        snprintf(part, sizeof part, "%s %s %d", name, attribute->name, (int)attribute->type);
        probe_doubles(to, part, PROBE_NUMBERS, values, count);
    }
}

void probe_image(probe *to, const char *name, const ewa_image *image) {
    char part[128];
    snprintf(part, sizeof part, "%s %u x %u x %u", name, image->width_px, image->height_px,
             image->channel_count);
    probe_floats(to, part, PROBE_PICTURE, image->pixels,
                 image->pixels ? (size_t)image->width_px * image->height_px * image->channel_count : 0);
}

void probe_camera(probe *to, const char *name, const ewa_camera *camera) {
    double numbers[23] = {camera->projection, camera->width_px, camera->height_px, camera->fx_px,
                          camera->fy_px,      camera->cx_px,    camera->cy_px};
    memcpy(numbers + 7, camera->world_to_camera, sizeof camera->world_to_camera);
    for (int i = 0; i < 23; i++) {
        char part[128];
        snprintf(part, sizeof part, "%s %d", name, i);
        probe_number(to, part, numbers[i]);
    }
}

ewa_frame probe_frame(const ewa_camera *camera, bool normals) {
    const size_t count = (size_t)camera->width_px * camera->height_px;
    ewa_frame frame = {.rgba8 = calloc(count, 4),
                       .rgba = calloc(count, 4 * sizeof(float)),
                       .depth = calloc(count, sizeof(float)),
                       .normal = normals ? calloc(count, 3 * sizeof(float)) : NULL,
                       .coverage = calloc(count, sizeof(float))};
    if (!frame.rgba8 || !frame.rgba || !frame.depth || (normals && !frame.normal) || !frame.coverage) abort();
    return frame;
}

void probe_frame_free(ewa_frame *frame) {
    free(frame->rgba8);
    free(frame->rgba);
    free(frame->depth);
    free(frame->normal);
    free(frame->coverage);
}

void probe_frame_put(probe *to, const char *name, const ewa_camera *camera, const ewa_frame *frame) {
    const size_t count = (size_t)camera->width_px * camera->height_px;
    char part[128];
    double *codes = calloc(4 * count, sizeof *codes);
    if (!codes) abort();
    for (size_t i = 0; i < 4 * count; i++) codes[i] = frame->rgba8[i] / 255.0;
    snprintf(part, sizeof part, "%s rgba8", name);
    probe_doubles(to, part, PROBE_PICTURE, codes, 4 * count);
    free(codes);
    snprintf(part, sizeof part, "%s rgba", name);
    probe_floats(to, part, PROBE_PICTURE, frame->rgba, 4 * count);
    snprintf(part, sizeof part, "%s depth", name);
    probe_floats(to, part, PROBE_PLANE, frame->depth, count);
    snprintf(part, sizeof part, "%s coverage", name);
    probe_floats(to, part, PROBE_PLANE, frame->coverage, count);
    snprintf(part, sizeof part, "%s normal", name);
    if (frame->normal) probe_floats(to, part, PROBE_PICTURE, frame->normal, 3 * count);
}

ewa_camera probe_view(const ewa_bounds *bounds, double x, double y, double z, bool orthographic) {
    ewa_camera camera;
    ewa_camera_init(&camera);
    camera.width_px = 64, camera.height_px = 64;
    const double direction[3] = {x, y, z}, up[3] = {0, 0, 1};
    if (orthographic)
        ewa_camera_set_ortho(&camera, 1);
    else
        ewa_camera_set_fov(&camera, 50);
    ewa_camera_frame(&camera, bounds, direction, up, 0.05);
    return camera;
}

double probe_random(uint64_t *state) {
    uint64_t x = *state;
    x ^= x >> 12, x ^= x << 25, x ^= x >> 27;
    *state = x;
    return (double)((x * 0x2545f4914f6cdd1du) >> 11) / 9007199254740992.0;
}

// ---- Comparing two runs

typedef struct record {
    char name[256];
    uint64_t kind, count;
    double *values;
} record;

/// False at the end.
static bool read_record(FILE *file, record *read) {
    uint64_t numbers[2];
    if (fread(read->name, 1, sizeof read->name, file) != sizeof read->name || fread(numbers, 8, 2, file) != 2)
        return false;
    read->kind = numbers[0], read->count = numbers[1];
    read->values = malloc(read->count ? read->count * sizeof(double) : 1);
    return read->values && fread(read->values, sizeof(double), read->count, file) == read->count;
}

static double tolerance(const record *list, double a, double b) {
    double largest = 0;
    for (uint64_t i = 0; i < list->count; i++)
        if (isfinite(list->values[i])) largest = fmax(largest, fabs(list->values[i]));
    if (list->kind == PROBE_PICTURE) return 1 / 255.0;
    if (list->kind == PROBE_PLANE) return largest / 255;
    return 1e-3 * fmax(fmax(fabs(a), fabs(b)), 1e-3 * largest);
}

static bool same(double a, double b, const record *list, bool exactly) {
    if (a == b || (isnan(a) && isnan(b))) return true;
    if (exactly || !isfinite(a) || !isfinite(b)) return false;
    return fabs(a - b) <= tolerance(list, a, b);
}

static int compare(const char *left, const char *right, bool exactly) {
    FILE *files[2] = {fopen(left, "rb"), fopen(right, "rb")};
    int differing = 0;
    record read[2];
    bool more[2] = {false, false};
    while (files[0] && files[1]) {
        for (int i = 0; i < 2; i++) more[i] = read_record(files[i], &read[i]);
        if (!more[0] || !more[1]) break;
        bool equal = !strcmp(read[0].name, read[1].name) && read[0].count == read[1].count;
        for (uint64_t i = 0; equal && i < read[0].count; i++)
            equal = same(read[0].values[i], read[1].values[i], &read[0], exactly);
        if (!equal && differing++ < 5) printf("differs: %s\n", read[0].name);
        for (int i = 0; i < 2; i++) free(read[i].values);
    }
    if (!files[0] || !files[1] || more[0] != more[1]) printf("one ends before the other\n"), differing++;
    for (int i = 0; i < 2; i++)
        if (files[i]) fclose(files[i]);
    return differing > 0;
}

static const struct {
    const char *name;
    void (*run)(probe *to);
    bool vectors; ///< has loops per instruction set
} sections[] = {
    {"math", probe_math, true},
    {"files", probe_files, false},
    {"generated", probe_generated, false},
    {"estimates", probe_estimates, true},
    {"edited", probe_edited, false},
    {"solids", probe_solids, true},
    {"features", probe_features, true},
    {"textured", probe_textured, true},
    {"sampled", probe_sampled, true},
    {"pictures", probe_pictures, true},
    {"splats", probe_splats, true},
    {"resample", probe_resample, true},
    {"volumes", probe_volumes, true},
};

static bool wanted(const char *name, int count, char **names) {
    bool found = count == 0;
    for (int i = 0; i < count; i++) found = found || !strcmp(names[i], name);
    return found;
}

/// How often and by what the calls are run.
typedef struct way {
    const char *name;
    uint32_t mask, threads;
} way;

/// False where there is no context. What the processor does not have is left out.
static bool run_sections(probe *to, const way *by, int count, char **names) {
    WITH_DEFAULTS(ewa_context_options, options);
    options.cpu_mask = by->mask;
    options.thread_count = by->threads;
    if (ewa_context_create(&options, &to->context) != EWA_OK) return false;
    const bool whole = by->mask == EWA_CPU_ALL,
               has = whole || ewa_context_cpu_features(to->context) == by->mask;
    for (size_t i = 0; has && i < sizeof sections / sizeof *sections; i++) {
        if (!wanted(sections[i].name, count, names) || (!whole && !sections[i].vectors)) continue;
        snprintf(to->prefix, sizeof to->prefix, "%s%s: ", by->name, sections[i].name);
        sections[i].run(to);
    }
    ewa_context_destroy(&to->context);
    return true;
}

static int write_all(const char *path, const char *source_dir, const char *scratch, int count, char **names) {
    static const way ways[] = {{"best ", EWA_CPU_ALL, 1}, {"avx2 ", EWA_CPU_AVX2, 1}, {"plain ", 0, 1}};
    probe to = {.file = fopen(path, "wb"), .source_dir = source_dir, .scratch = scratch};
    bool whole = to.file;
    for (int i = 0; whole && i < 3; i++) {
        to.brief = i > 0;
        whole = run_sections(&to, &ways[i], count, names);
    }
    return (to.file && fclose(to.file)) || !whole ? 2 : 0;
}

/// One section at a time, so that the lists stay short: one thread with everything is what the others are
/// held to.
static int hold_same(int way_count, const char *source_dir, const char *scratch, int count, char **names) {
    static const way ways[] = {{"", EWA_CPU_ALL, 1}, {"", EWA_CPU_ALL, 3}, {"", EWA_CPU_AVX2, 2}, {"", 0, 3}};
    char paths[2][1024];
    int differing = 0;
    for (size_t s = 0; s < sizeof sections / sizeof *sections; s++)
        for (int i = 0; wanted(sections[s].name, count, names) && i < way_count; i++) {
            char *one[1] = {(char *)(uintptr_t)sections[s].name};
            if (i >= 2 && !sections[s].vectors) continue;
            snprintf(paths[i > 0], sizeof paths[0], "%s/same-%s-%d", scratch, sections[s].name, i > 0);
            probe to = {.file = fopen(paths[i > 0], "wb"),
                        .source_dir = source_dir,
                        .scratch = scratch,
                        .brief = true};
            if (!to.file || !run_sections(&to, &ways[i], 1, one)) return 2;
            const long size = ftell(to.file);
            if (fclose(to.file)) return 2;
            if (i == 0 || size == 0) continue;
            if (compare(paths[0], paths[1], true)) {
                printf("%s: not the same for %u threads and instructions %#x\n", sections[s].name,
                       ways[i].threads, ways[i].mask);
                differing++;
            }
        }
    return differing > 0;
}

int main(int argc, char **argv) {
    if (argc == 4 && !strcmp(argv[1], "compare")) return compare(argv[2], argv[3], false);
    if (argc >= 4 && !strcmp(argv[1], "same")) return hold_same(4, argv[2], argv[3], argc - 4, argv + 4);
    if (argc >= 4 && !strcmp(argv[1], "threads")) return hold_same(2, argv[2], argv[3], argc - 4, argv + 4);
    if (argc >= 5 && !strcmp(argv[1], "write"))
        return write_all(argv[2], argv[3], argv[4], argc - 5, argv + 5);
    fprintf(stderr, "probe write FILE SOURCE_DIR SCRATCH [SECTION...] | compare FILE FILE | same|threads "
                    "SOURCE_DIR SCRATCH "
                    "[SECTION...]\n");
    return 2;
}
