// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which way is up in things whose up is known, in all kinds of files, turned: how many are right is printed and held.
#include "bodies.h"
#include "framing/upright.h"

#include <string.h>

static double made[BODY_POINTS][3];

/// What became of a corpus.
typedef struct score {
    int right, all;
} score;

/// Chooses for the points, which have z up and get y up where `axis` is 1. What is wrong is told where it has a name.
static void judge(ewa_up_convention convention, int axis, const char *what, const char *kind, double azimuth, score *sum) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, middle[3];
    static double offsets[BODY_POINTS][3];
    for (size_t i = 0; i < BODY_POINTS; i++) {
        const double *p = made[i];
        const double q[3] = {p[0], axis == 1 ? p[2] : p[1], axis == 1 ? -p[1] : p[2]};
        for (int c = 0; c < 3; c++) {
            offsets[i][c] = q[c];
            low[c] = fmin(low[c], q[c]);
            high[c] = fmax(high[c], q[c]);
        }
    }
    for (int c = 0; c < 3; c++) middle[c] = 0.5 * (low[c] + high[c]);
    for (size_t i = 0; i < BODY_POINTS; i++)
        for (int c = 0; c < 3; c++) offsets[i][c] -= middle[c];
    const ewa_upright chosen = ewa_upright_choose(BODY_POINTS, (const double(*)[3])offsets, middle, convention);
    const bool right = chosen.axis == axis && !chosen.reversed;
    sum->all++;
    sum->right += right;
    if (!right && what)
        print_message("%s, %s, turned by %g: %s%c (%s)\n", what, kind, azimuth * 57.29577951308232, chosen.reversed ? "-" : "",
                      "xyz"[chosen.axis], chosen.why);
}

static const double AZIMUTHS[] = {0, 0.35, 1.5707963267948966, 3.7};
enum { AZIMUTH_COUNT = sizeof AZIMUTHS / sizeof AZIMUTHS[0] };

/// Bodies as their kind of file has them are right, all of them.
TEST(usual) {
    (void)state;
    static const struct {
        ewa_up_convention convention;
        int axis;
        const char *kind;
    } kinds[] = {{EWA_UP_Y_USUAL, 1, "OBJ"}, {EWA_UP_Z_USUAL, 2, "STL"}, {EWA_UP_Y_REQUIRED, 1, "glTF"}, {EWA_UP_Z_SURVEYED, 2, "E57"}};
    score sum = {0, 0};
    for (int b = 0; b < BODY_COUNT; b++)
        for (int a = 0; a < AZIMUTH_COUNT; a++) {
            body_points(&BODIES[b], AZIMUTHS[a], made, BODY_POINTS);
            for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
                judge(kinds[k].convention, kinds[k].axis, BODIES[b].name, kinds[k].kind, AZIMUTHS[a], &sum);
        }
    print_message("bodies as usual: %d of %d right\n", sum.right, sum.all);
    assert_int_equal(sum.right, sum.all);
}

/// Where the kind of a file says nothing, or has it otherwise, bases and halves tell: at least as many as here. The others
/// have none (a tree, a mushroom, of kinds with an axis), or sides that are as good (a sofa, the back of a car).
TEST(measured) {
    (void)state;
    static const struct {
        ewa_up_convention convention;
        int axis;
        const char *kind;
        int right; ///< of BODY_COUNT * AZIMUTH_COUNT, 64
    } kinds[] = {{EWA_UP_ANY, 1, "PLY, y up", 63},
                 {EWA_UP_ANY, 2, "PLY, z up", 58},
                 {EWA_UP_Y_USUAL, 2, "OBJ, z up", 37},
                 {EWA_UP_Z_USUAL, 1, "STL, y up", 34}};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        score sum = {0, 0};
        print_message("%s, not seen:", kinds[k].kind);
        for (int b = 0; b < BODY_COUNT; b++) {
            score own = {0, 0};
            for (int a = 0; a < AZIMUTH_COUNT; a++) {
                body_points(&BODIES[b], AZIMUTHS[a], made, BODY_POINTS);
                judge(kinds[k].convention, kinds[k].axis, NULL, NULL, AZIMUTHS[a], &own);
            }
            if (own.right < own.all) print_message(" %s (%d of %d);", BODIES[b].name, own.all - own.right, own.all);
            sum.right += own.right, sum.all += own.all;
        }
        print_message("\n%s: %d of %d right\n", kinds[k].kind, sum.right, sum.all);
        assert_true(sum.right >= kinds[k].right);
    }
}

/// What is surveyed has z up, whichever of its walls is largest.
TEST(surveyed) {
    (void)state;
    score sum = {0, 0};
    for (int s = 0; s < SURVEY_COUNT; s++)
        for (int inside = 0; inside < 2; inside++)
            for (int a = 0; a < AZIMUTH_COUNT; a++) {
                survey_points(s, inside, made, BODY_POINTS);
                for (size_t i = 0; i < BODY_POINTS; i++) {
                    const double x = made[i][0], y = made[i][1];
                    made[i][0] = cos(AZIMUTHS[a]) * x - sin(AZIMUTHS[a]) * y;
                    made[i][1] = sin(AZIMUTHS[a]) * x + cos(AZIMUTHS[a]) * y;
                }
                judge(EWA_UP_Z_SURVEYED, 2, SURVEY_NAMES[s], inside ? "LAS" : "LAS, moved", AZIMUTHS[a], &sum);
            }
    print_message("what is surveyed: %d of %d right\n", sum.right, sum.all);
    assert_int_equal(sum.right, sum.all);
}

int main(void) { return RUN_TESTS(NULL, NULL); }
