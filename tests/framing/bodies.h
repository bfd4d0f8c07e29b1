// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Things that stand, by their surfaces: z up, seen from -y, about a metre or some metres large.
#ifndef EWA_TESTS_BODIES_H
#define EWA_TESTS_BODIES_H

#include "check.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

enum { BODY_POINTS = 40000 };

typedef enum solid { BOX, BALL, TUBE } solid; ///< a tube's axis is z

/// A part: its middle and half of its sizes; it has `weight` shares of the points.
typedef struct part {
    solid solid;
    double middle[3], half[3];
    int weight;
} part;

enum { BODY_PARTS = 16 };

typedef struct body {
    const char *name;
    part parts[BODY_PARTS]; ///< up to the first without a size
} body;

static const body BODIES[] = {
    {"figure, arms down, flat back",
     {{BALL, {0, 0, 1.68}, {0.1, 0.11, 0.13}, 1}, {BOX, {0, 0, 1.2}, {0.2, 0.11, 0.32}, 3},
      {TUBE, {-0.27, 0, 1.15}, {0.05, 0.06, 0.35}, 1}, {TUBE, {0.27, 0, 1.15}, {0.05, 0.06, 0.35}, 1},
      {TUBE, {-0.1, 0.02, 0.45}, {0.08, 0.09, 0.45}, 2}, {TUBE, {0.1, 0.02, 0.45}, {0.08, 0.09, 0.45}, 2},
      {BOX, {-0.1, -0.03, 0.03}, {0.05, 0.14, 0.03}, 1}, {BOX, {0.1, -0.03, 0.03}, {0.05, 0.14, 0.03}, 1}}},
    {"figure, arms out",
     {{BALL, {0, 0, 1.68}, {0.1, 0.11, 0.13}, 1}, {BOX, {0, 0, 1.2}, {0.2, 0.1, 0.32}, 3},
      {BOX, {0, 0.02, 1.42}, {0.85, 0.06, 0.06}, 2},
      {TUBE, {-0.1, 0.01, 0.45}, {0.08, 0.09, 0.45}, 2}, {TUBE, {0.1, 0.01, 0.45}, {0.08, 0.09, 0.45}, 2},
      {BOX, {-0.1, -0.04, 0.03}, {0.05, 0.14, 0.03}, 1}, {BOX, {0.1, -0.04, 0.03}, {0.05, 0.14, 0.03}, 1}}},
    {"bust",
     {{BALL, {0, 0, 0.5}, {0.12, 0.13, 0.17}, 2}, {TUBE, {0, 0.02, 0.3}, {0.07, 0.07, 0.1}, 1},
      {BALL, {0, 0, 0.13}, {0.26, 0.14, 0.14}, 2}, {BOX, {0, 0, 0.02}, {0.2, 0.12, 0.02}, 1}}},
    {"chair",
     {{BOX, {0, 0, 0.45}, {0.22, 0.22, 0.02}, 2}, {BOX, {0, 0.2, 0.7}, {0.22, 0.02, 0.25}, 2},
      {BOX, {-0.2, -0.2, 0.22}, {0.02, 0.02, 0.22}, 1}, {BOX, {0.2, -0.2, 0.22}, {0.02, 0.02, 0.22}, 1},
      {BOX, {-0.2, 0.2, 0.22}, {0.02, 0.02, 0.22}, 1}, {BOX, {0.2, 0.2, 0.22}, {0.02, 0.02, 0.22}, 1}}},
    {"table",
     {{BOX, {0, 0, 0.73}, {0.8, 0.4, 0.02}, 4}, {BOX, {-0.75, -0.35, 0.36}, {0.03, 0.03, 0.36}, 1},
      {BOX, {0.75, -0.35, 0.36}, {0.03, 0.03, 0.36}, 1}, {BOX, {-0.75, 0.35, 0.36}, {0.03, 0.03, 0.36}, 1},
      {BOX, {0.75, 0.35, 0.36}, {0.03, 0.03, 0.36}, 1}}},
    {"car",
     {{BOX, {0, 0, 0.6}, {0.85, 2.1, 0.3}, 4}, {BALL, {0, 0.2, 0.95}, {0.75, 1.2, 0.5}, 2},
      {BALL, {0, -2.1, 0.55}, {0.8, 0.2, 0.25}, 1}, {BALL, {0, 2.1, 0.6}, {0.8, 0.2, 0.3}, 1},
      {BALL, {-0.75, -1.3, 0.32}, {0.12, 0.32, 0.32}, 1}, {BALL, {0.75, -1.3, 0.32}, {0.12, 0.32, 0.32}, 1},
      {BALL, {-0.75, 1.3, 0.32}, {0.12, 0.32, 0.32}, 1}, {BALL, {0.75, 1.3, 0.32}, {0.12, 0.32, 0.32}, 1}}},
    {"house",
     {{BOX, {0, 0, 1.5}, {4, 3, 1.5}, 3}, {BOX, {0, 0, 3.2}, {4.3, 2.4, 0.2}, 1}, {BOX, {0, 0, 3.7}, {4.3, 1.6, 0.3}, 1},
      {BOX, {0, 0, 4.3}, {4.3, 0.6, 0.3}, 1}, {BOX, {2, 0.8, 4.6}, {0.3, 0.3, 0.6}, 1}}},
    {"animal on four legs",
     {{BALL, {0, 0, 0.75}, {0.2, 0.55, 0.22}, 3}, {BALL, {0, -0.65, 1.0}, {0.12, 0.2, 0.15}, 1},
      {TUBE, {-0.12, -0.4, 0.3}, {0.05, 0.05, 0.3}, 1}, {TUBE, {0.12, -0.4, 0.3}, {0.05, 0.05, 0.3}, 1},
      {TUBE, {-0.12, 0.4, 0.3}, {0.05, 0.05, 0.3}, 1}, {TUBE, {0.12, 0.4, 0.3}, {0.05, 0.05, 0.3}, 1},
      {TUBE, {0, 0.58, 0.7}, {0.02, 0.02, 0.2}, 1}}},
    {"bottle", {{TUBE, {0, 0, 0.1}, {0.04, 0.04, 0.1}, 2}, {BALL, {0, 0, 0.2}, {0.04, 0.04, 0.04}, 1}, {TUBE, {0, 0, 0.26}, {0.015, 0.015, 0.04}, 1}}},
    {"lamp",
     {{TUBE, {0, 0, 0.015}, {0.15, 0.15, 0.015}, 1}, {TUBE, {0, 0, 0.7}, {0.015, 0.015, 0.7}, 1},
      {BALL, {0, 0, 1.45}, {0.2, 0.2, 0.17}, 2}}},
    {"vase", {{BALL, {0, 0, 0.2}, {0.15, 0.15, 0.19}, 3}, {TUBE, {0, 0, 0.02}, {0.09, 0.09, 0.02}, 1}, {TUBE, {0, 0, 0.42}, {0.06, 0.06, 0.05}, 1}}},
    {"tree", {{TUBE, {0, 0, 1}, {0.15, 0.15, 1}, 1}, {BALL, {0, 0, 3}, {1.4, 1.3, 1.3}, 4}, {TUBE, {0, 0, 0.04}, {0.5, 0.5, 0.04}, 1}}},
    {"sofa",
     {{BOX, {0, 0, 0.22}, {0.9, 0.42, 0.2}, 2}, {BOX, {0, 0.35, 0.5}, {0.9, 0.1, 0.35}, 1}, {BOX, {-0.85, 0, 0.35}, {0.1, 0.42, 0.27}, 1},
      {BOX, {0.85, 0, 0.35}, {0.1, 0.42, 0.27}, 1}}},
    {"mushroom", {{TUBE, {0, 0, 0.05}, {0.025, 0.025, 0.05}, 1}, {BALL, {0, 0, 0.11}, {0.07, 0.07, 0.035}, 3}}},
    {"column", {{BOX, {0, 0, 0.1}, {0.5, 0.5, 0.1}, 1}, {TUBE, {0, 0, 1.6}, {0.3, 0.3, 1.4}, 3}, {BOX, {0, 0, 3.1}, {0.42, 0.42, 0.1}, 1}}},
    {"piano", {{BOX, {0, 0.2, 0.6}, {0.75, 0.15, 0.6}, 3}, {BOX, {0, -0.1, 0.7}, {0.75, 0.2, 0.05}, 1}, {BOX, {-0.7, -0.1, 0.33}, {0.04, 0.18, 0.33}, 1},
      {BOX, {0.7, -0.1, 0.33}, {0.04, 0.18, 0.33}, 1}}},
};
enum { BODY_COUNT = sizeof BODIES / sizeof BODIES[0] };

/// A point on the surface of a part.
static inline void part_point(const part *of, check_random *random, double p[3]) {
    double u[3], length2 = 0;
    do {
        length2 = 0;
        for (int c = 0; c < 3; c++) {
            u[c] = check_uniform(random, -1, 1);
            length2 += u[c] * u[c];
        }
    } while (!(length2 > 0.01 && length2 < 1));
    if (of->solid == BALL)
        for (int c = 0; c < 3; c++) u[c] /= sqrt(length2);
    if (of->solid == BOX) {
        const int face = (int)check_uniform(random, 0, 6);
        for (int c = 0; c < 3; c++) u[c] = check_uniform(random, -1, 1);
        u[face / 2 % 3] = face % 2 ? 1 : -1;
    }
    if (of->solid == TUBE) {
        const double angle = check_uniform(random, 0, 6.283185307179586), kind = check_uniform(random, 0, 6);
        const double r = kind < 4 ? 1 : sqrt(check_uniform(random, 0, 1));
        u[0] = r * cos(angle), u[1] = r * sin(angle);
        u[2] = kind < 4 ? check_uniform(random, -1, 1) : kind < 5 ? 1 : -1;
    }
    for (int c = 0; c < 3; c++) p[c] = of->middle[c] + of->half[c] * u[c];
}

/// Fills points of a body, turned about z.
static inline void body_points(const body *of, double azimuth, double (*points)[3], size_t count) {
    check_random random = {29};
    int total = 0;
    for (int k = 0; k < BODY_PARTS && of->parts[k].half[0] > 0; k++) total += of->parts[k].weight;
    for (size_t i = 0; i < count; i++) {
        int k = 0;
        for (int left = (int)check_uniform(&random, 0, total); k < BODY_PARTS; k++) {
            left -= of->parts[k].weight;
            if (left < 0) break;
        }
        double p[3];
        part_point(&of->parts[k], &random, p);
        points[i][0] = cos(azimuth) * p[0] - sin(azimuth) * p[1];
        points[i][1] = sin(azimuth) * p[0] + cos(azimuth) * p[1];
        points[i][2] = p[2];
    }
}

/// What an instrument surveys: kinds of places, z up, metres.
typedef enum survey { SURVEY_ROOM, SURVEY_FACADE, SURVEY_STREET, SURVEY_HILL, SURVEY_WOOD, SURVEY_QUARRY, SURVEY_COUNT } survey;
static const char *const SURVEY_NAMES[] = {"room", "facade alone", "street with a facade", "hill", "wood", "quarry face"};

/// The instrument stands at the origin, 1.6 above the ground, where `inside`, else off from all.
static inline void survey_points(survey of, bool inside, double (*points)[3], size_t count) {
    check_random random = {31};
    for (size_t i = 0; i < count; i++) {
        const double u = check_uniform(&random, 0, 1), v = check_uniform(&random, -1, 1), w = check_uniform(&random, -1, 1);
        double p[3];
        switch (of) {
        case SURVEY_ROOM: // floor, ceiling, four walls, of which the instrument sees one best
            if (u < 0.2) p[0] = 3 * v, p[1] = 2 * w, p[2] = u < 0.08 ? -1.6 : 1.1;
            else if (u < 0.7) p[0] = 3 * v, p[1] = -2, p[2] = -0.25 + 1.35 * w;
            else if (u < 0.8) p[0] = 3 * v, p[1] = 2, p[2] = -0.25 + 1.35 * w;
            else p[0] = u < 0.9 ? -3 : 3, p[1] = 2 * v, p[2] = -0.25 + 1.35 * w;
            break;
        case SURVEY_FACADE: // windows are set back
            p[0] = 12 * v, p[2] = 6 + 6 * w, p[1] = -15 + (fmod(p[0] + 30, 3) < 1 && fmod(p[2] + 30, 3) < 1.5 ? -0.3 : 0);
            break;
        case SURVEY_STREET:
            if (u < 0.5) p[0] = 15 * v, p[1] = -9, p[2] = 4 + 5.6 * w;
            else if (u < 0.8) p[0] = 15 * v, p[1] = 9 * w, p[2] = -1.6 + 0.06 * p[0];
            else p[0] = 15 * v, p[1] = 9 + 0.5 * check_uniform(&random, 0, 1), p[2] = 1 + 2 * w;
            break;
        case SURVEY_HILL:
            p[0] = 40 * v, p[1] = 40 * w, p[2] = -1.6 + 9 * exp(-(p[0] * p[0] + (p[1] - 30) * (p[1] - 30)) / 400) + 0.08 * p[1];
            break;
        case SURVEY_WOOD: // trunks and crowns on a slope
            if (u < 0.4) p[0] = 20 * v, p[1] = 20 * w, p[2] = -1.6 + 0.1 * p[0];
            else {
                const double x = floor(4 * v) * 5 + 2.5, y = floor(4 * w) * 5 + 2.5, a = check_uniform(&random, 0, 6.283185307179586);
                const double h = check_uniform(&random, 0, 12), r = h < 5 ? 0.2 : 2 * check_uniform(&random, 0, 1);
                p[0] = x + r * cos(a), p[1] = y + r * sin(a), p[2] = -1.6 + 0.1 * x + h;
            }
            break;
        default: // a face of rock and the ground before it
            if (u < 0.7) p[0] = 10 * v, p[2] = 3 + 4.6 * w, p[1] = -8 - 0.15 * p[2] + 0.4 * sin(2 * p[0]) * cos(3 * p[2]);
            else p[0] = 10 * v, p[1] = -4 + 4 * w, p[2] = -1.6 + 0.3 * sin(p[0]) * cos(p[1]) ;
        }
        for (int c = 0; c < 3; c++) points[i][c] = p[c] + (inside ? 0 : 25);
    }
}

#endif
