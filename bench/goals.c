// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What the figures of ewa bench ought to be, and what others reach.
#include "bench/goals.h"

#include <math.h>
#include <string.h>

enum { GOAL_THREADS = 2, STANDARD_WIDTH = 1280, STANDARD_HEIGHT = 1024 };

/// Milliseconds of a frame. `covered_px` 0: whatever the scene's splats cover.
static const struct frame_goal {
    const char *scene;
    double splats, covered_px, floor_ms, target_ms;
} frame_goals[] = {
    {"plane", 1e6, 9, 16, 10},  {"plane", 1e6, 25, 24, 15}, {"plane", 1e6, 100, 54, 33},
    {"color", 1e6, 9, 14, 8.8}, {"color", 1e6, 25, 21, 13}, {"color", 1e6, 100, 43, 27},
    {"large", 1e7, 9, 150, 95}, {"points", 1e6, 0, 10, 6},  {"hidden", 2.5e6, 9, 22, 14},
};

/// What a way of drawing may cost: its time over that of the scene as it is, or the other way round.
static const struct way_goal {
    const char *way, *figure;
    bool is_less; ///< the way leaves out what the figure is about
    double floor, target;
} way_goals[] = {
    {"3 layers", "3 layers to opaque", false, 2.5, 2},
    {"no edges", "edges on to off", true, 1.05, 1.03},
    {"no light", "light on to off", true, 1.1, 1.05},
};

/// Milliseconds of a frame of sphere and torus, back faces culled, by MeshLab's splatting code through
/// software OpenGL on two cores: the best of the programs that draw true splats.
static const struct peer_time {
    double splats;
    uint32_t width_px, height_px;
    double time_ms;
} peer_times[] = {
    {1e5, 1280, 1024, 162}, {1e6, 1280, 1024, 549}, {5e6, 1280, 1024, 2140},
    {1e5, 512, 512, 84},    {1e6, 512, 512, 380},   {5e6, 512, 512, 1560},
};

static bool near(double a, double b) { return fabs(a - b) <= 0.01 * fabs(b); }

size_t bench_goals_frames(const bench_frame_row *row, bench_goal goals[BENCH_MAX_GOALS]) {
    const bench_scene *scene = row->scene;
    const double points = (double)row->info.point_count, median_ms = 1e3 * row->total.median;
    const bool standard = scene->camera.width_px == STANDARD_WIDTH &&
                          scene->camera.height_px == STANDARD_HEIGHT && row->threads == GOAL_THREADS;
    const bool all_sets = strcmp(row->cpu, "all") == 0;
    size_t count = 0;
    for (size_t i = 0; standard && all_sets && i < sizeof frame_goals / sizeof frame_goals[0]; i++) {
        const struct frame_goal *goal = &frame_goals[i];
        if (strcmp(goal->scene, scene->name) != 0 || !near(points, goal->splats)) continue;
        if (goal->covered_px > 0 && !near(scene->covered_px, goal->covered_px)) continue;
        goals[count++] = (bench_goal){"median", "ms", median_ms, goal->floor_ms, goal->target_ms};
        if (row->one_thread_s > 0)
            goals[count++] =
                (bench_goal){"second core", "x", row->one_thread_s / row->total.quartile, 1.85, 1.95};
        if (i == 0)
            goals[count++] =
                (bench_goal){"resident", "B/point", (double)row->info.resident_bytes / points, 32, 24};
    }
    if (standard && strcmp(scene->name, "plane") == 0 && strcmp(row->cpu, "avx2") == 0 && row->all_sets_s > 0)
        goals[count++] =
            (bench_goal){"AVX2 to AVX-512", "x", row->total.quartile / row->all_sets_s, 2.2, 1.8};
    if (standard && all_sets && strcmp(scene->name, "culled") == 0) {
        const double bin_s = row->stage_s[0] / row->threads;
        goals[count++] =
            (bench_goal){"culled whole", "G/s", 1e-9 * (double)row->stats.culled_count / bin_s, 2, 5};
    }
    for (size_t i = 0;
         standard && all_sets && row->first_way_s > 0 && i < sizeof way_goals / sizeof way_goals[0]; i++) {
        const struct way_goal *goal = &way_goals[i];
        if (strcmp(goal->way, row->way) != 0) continue;
        const double more = row->total.quartile / row->first_way_s;
        goals[count++] =
            (bench_goal){goal->figure, "x", goal->is_less ? 1 / more : more, goal->floor, goal->target};
    }
    return count;
}

/// Files of points on one core: bytes or points a second. docs/files.md says of what machine.
static const struct file_goal {
    const char *stage;
    bool points;
    double floor;
} file_goals[] = {
    {"read LAS", false, 1500},          {"read LAZ, format 3", true, 3}, {"read LAZ, format 7", true, 3},
    {"write LAZ, format 3", true, 4.2}, {"read PCD", false, 1500},       {"read XYZ", false, 300},
};

static size_t file_goal_of(const bench_stage_row *row, bench_goal goals[BENCH_MAX_GOALS]) {
    for (size_t i = 0; row->threads == 1 && i < sizeof file_goals / sizeof file_goals[0]; i++) {
        const struct file_goal *goal = &file_goals[i];
        if (strcmp(row->stage, goal->stage) != 0) continue;
        const double amount = 1e-6 * (double)(goal->points ? row->item_count : row->bytes);
        goals[0] = (bench_goal){"one core", goal->points ? "M points/s" : "MB/s", amount / row->time.median,
                                goal->floor, goal->floor};
        return 1;
    }
    return 0;
}

size_t bench_goals_stage(const bench_stage_row *row, bench_goal goals[BENCH_MAX_GOALS]) {
    const double megabytes_per_s = 1e-6 * (double)row->bytes / row->time.median, ms = 1e3 * row->time.median;
    const bool million = near((double)row->item_count, 1e6);
    if (strcmp(row->stage, "read PLY") == 0 && row->threads == 1)
        goals[0] = (bench_goal){"one core", "MB/s", megabytes_per_s, 2000, 5000};
    else if (strcmp(row->stage, "read PLY, ASCII") == 0 && row->threads == 1)
        goals[0] = (bench_goal){"one core", "MB/s", megabytes_per_s, 200, 400};
    else if (strncmp(row->stage, "normals and radii", strlen("normals and radii")) == 0 &&
             row->threads == GOAL_THREADS && million)
        goals[0] = (bench_goal){"median", "ms", ms, 400, 180};
    else if (strcmp(row->stage, "PNG, RGB") == 0 && row->threads == GOAL_THREADS &&
             row->item_count == STANDARD_WIDTH * STANDARD_HEIGHT)
        goals[0] = (bench_goal){"median", "ms", ms, 25, 10};
    else
        return file_goal_of(row, goals);
    return 1;
}

double bench_goal_ratio(const bench_goal *goal, double wanted) {
    return goal->target < goal->floor ? goal->value / wanted : wanted / goal->value;
}

double bench_peer_ms(const bench_scene *scene) {
    const double points = (double)ewa_cloud_point_count(scene->cloud);
    for (size_t i = 0; i < sizeof peer_times / sizeof peer_times[0]; i++) {
        const struct peer_time *peer = &peer_times[i];
        if (strcmp(scene->name, "peer") == 0 && near(points, peer->splats) &&
            scene->camera.width_px == peer->width_px && scene->camera.height_px == peer->height_px)
            return peer->time_ms;
    }
    return 0;
}
