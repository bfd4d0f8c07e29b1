// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Tests of the program on the same points and faces at the origin, at map coordinates and at coordinates that
// count from the centre of the earth: the same picture, byte for byte, and the same digits in every file.
#include "check.h"
#include "cli/run_ewa.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PLACES = 3, POINTS = 6000 };

static const char *const names[PLACES] = {"near", "map", "earth"};
static const long long shifts_mm[PLACES][3] = {
    {0, 0, 0}, {500000000, 4200000000, 100000}, {4123456000, 654321000, 4808080000}};

static int set_up(void **state) { return scratch_enter("places"); }

/// Writes a number of millimetres as metres.
static int put_metres(FILE *file, long long mm) {
    return fprintf(file, "%s%lld.%03lld ", mm < 0 ? "-" : "", llabs(mm) / 1000, llabs(mm) % 1000);
}

/// Hills of points with colours, as a text whose lines are as `ewa convert` writes them.
static void write_points(int place) {
    char name[32];
    snprintf(name, sizeof name, "%s.xyz", names[place]);
    FILE *file = fopen(scratch_path(name), "w");
    assert_non_null(file);
    fputs("//X Y Z R G B\n", file);
    for (int i = 0; i < POINTS; i++) {
        const long long x = (long long)i * 7919 % 20011, y = (long long)i * 6007 % 15013;
        const long long z = 1500 + (long long)(700 * sin((double)x / 2500) * cos((double)y / 3100));
        const long long mm[3] = {x, y, z};
        for (int c = 0; c < 3; c++) put_metres(file, mm[c] + shifts_mm[place][c]);
        fprintf(file, "%d %d %d\n", i % 256, i / 7 % 256, i / 29 % 256);
    }
    fclose(file);
}

TEST(test_points) {
    static const char *const suffixes[] = {"xyz", "csv", "ply", "pcd", "las", "laz"};
    for (int p = 0; p < PLACES; p++) {
        write_points(p);
        for (size_t s = 0; s < sizeof suffixes / sizeof suffixes[0]; s++) {
            if (s) run_done("ewa convert %s.xyz -o %s.%s", names[p], names[p], suffixes[s]);
            run_done("ewa render %s.%s -o %s_%s.png --size 200x150 --view iso --up 0,0,1", names[p],
                     suffixes[s], names[p], suffixes[s]);
            char path[64];
            snprintf(path, sizeof path, "%s_%s.png", names[p], suffixes[s]);
            if (!scratch_same("near_xyz.png", path)) fail_msg("%s is another picture", path);
        }
    }
}

/// Lines of a file up to and with the third number of each, for files whose other columns may differ.
static char *read_places(const char *name) {
    FILE *file = fopen(scratch_path(name), "r");
    assert_non_null(file);
    char *all = malloc(64 * POINTS), *at = all, line[512];
    assert_non_null(all);
    while (fgets(line, sizeof line, file)) {
        int blanks = 0;
        if (line[0] == '/') continue;
        for (const char *c = line; *c && blanks < 3; c++) {
            blanks += *c == ' ';
            *at++ = *c;
        }
    }
    *at = '\0';
    fclose(file);
    return all;
}

TEST(test_digits) {
    static const char *const suffixes[] = {"xyz", "csv", "las", "laz"};
    for (int p = 0; p < PLACES; p++) {
        write_points(p);
        char path[64];
        snprintf(path, sizeof path, "%s.xyz", names[p]);
        OWNED(check_free) char *wanted = read_places(path);
        for (size_t s = 1; s < sizeof suffixes / sizeof suffixes[0]; s++) {
            run_done("ewa convert %s.xyz -o there.%s && ewa convert there.%s -o back.xyz", names[p],
                     suffixes[s], suffixes[s]);
            OWNED(check_free) char *got = read_places("back.xyz");
            if (strcmp(wanted, got) != 0) fail_msg("%s by way of %s has other digits", names[p], suffixes[s]);
        }
    }
}

/// A ball of triangles with decimals of a millimetre.
static void write_mesh(int place, const char *suffix) {
    enum { RINGS = 12, SIDES = 24 };
    const bool off = strcmp(suffix, "off") == 0;
    char name[32];
    snprintf(name, sizeof name, "%s.%s", names[place], suffix);
    FILE *file = fopen(scratch_path(name), "w");
    assert_non_null(file);
    if (off) fprintf(file, "OFF\n%d %d 0\n", RINGS * SIDES, 2 * (RINGS - 1) * SIDES);
    for (int r = 0; r < RINGS; r++)
        for (int s = 0; s < SIDES; s++) {
            const double up = 3.1 * (r + 0.5) / RINGS, round = 6.283185307179586 * s / SIDES;
            const double place_m[3] = {sin(up) * cos(round), sin(up) * sin(round), 1.5 * cos(up)};
            if (!off) fputs("v ", file);
            for (int c = 0; c < 3; c++) put_metres(file, llround(1000 * place_m[c]) + shifts_mm[place][c]);
            fputc('\n', file);
        }
    for (int r = 0; r + 1 < RINGS; r++)
        for (int s = 0; s < SIDES; s++) {
            const int first = r * SIDES + s, next = r * SIDES + (s + 1) % SIDES, one = off ? 0 : 1;
            const char *head = off ? "3 " : "f ";
            fprintf(file, "%s%d %d %d\n", head, first + one, first + SIDES + one, next + SIDES + one);
            fprintf(file, "%s%d %d %d\n", head, first + one, next + SIDES + one, next + one);
        }
    fclose(file);
}

/// The matrix of a camera that counts from the centre of the earth holds its place to a nanometre, which a
/// pixel may show; test_cli_mesh.c says how few.
TEST(test_meshes) {
    static const char *const suffixes[] = {"obj", "off"};
    for (int p = 0; p < PLACES - 1; p++)
        for (int s = 0; s < 2; s++) {
            write_mesh(p, suffixes[s]);
            run_done("ewa render %s.%s -o %s_%s.png --size 200x150 --view iso --up 0,0,1", names[p],
                     suffixes[s], names[p], suffixes[s]);
            char path[64];
            snprintf(path, sizeof path, "%s_%s.png", names[p], suffixes[s]);
            if (!scratch_same("near_obj.png", path)) fail_msg("%s is another picture", path);
        }
}

int main(void) { return RUN_TESTS(set_up, NULL); }
