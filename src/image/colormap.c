// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours for numbers.
//
// Based on: viridis by Nathaniel Smith and Stéfan van der Walt, 2015; turbo by Anton Mikhailov, "Turbo, An
// Improved Rainbow Colormap for Visualization", 2019. Both are sampled at 33 places; lines between them stay
// within 2/255 of the full tables.
#include "ewa/image.h"

enum { KNOTS = 33 };

static const uint8_t viridis[KNOTS][3] = {
    {68, 1, 84},    {71, 13, 96},   {72, 24, 106},  {72, 35, 116},  {71, 45, 123},  {69, 54, 129},
    {66, 64, 134},  {63, 73, 137},  {59, 82, 139},  {55, 90, 141},  {51, 99, 141},  {47, 106, 142},
    {44, 114, 142}, {41, 122, 142}, {38, 129, 142}, {35, 137, 142}, {33, 144, 140}, {31, 152, 139},
    {31, 159, 136}, {33, 166, 133}, {40, 174, 128}, {49, 181, 123}, {62, 188, 116}, {76, 194, 108},
    {93, 201, 99},  {110, 206, 88}, {130, 211, 76}, {150, 216, 63}, {171, 220, 50}, {192, 223, 36},
    {213, 226, 26}, {234, 229, 26}, {253, 231, 37}};

static const uint8_t turbo[KNOTS][3] = {
    {48, 18, 59},   {57, 42, 115},  {64, 64, 161},   {68, 86, 199},  {70, 107, 227}, {70, 127, 246},
    {66, 147, 255}, {55, 167, 250}, {41, 187, 236},  {29, 205, 216}, {24, 220, 195}, {30, 232, 176},
    {49, 242, 153}, {76, 249, 126}, {107, 253, 100}, {138, 255, 77}, {163, 253, 60}, {184, 247, 53},
    {204, 237, 52}, {222, 224, 55}, {237, 208, 58},  {248, 192, 58}, {253, 174, 53}, {254, 152, 44},
    {251, 128, 34}, {245, 104, 23}, {236, 82, 15},   {224, 64, 9},   {210, 49, 5},   {192, 35, 2},
    {172, 23, 1},   {149, 13, 1},   {122, 4, 3}};

void ewa_colormap_color(ewa_colormap colormap, double number, uint8_t srgb[3]) {
    const double clamped = number > 0 ? (number < 1 ? number : 1) : 0;
    if (colormap != EWA_COLORMAP_VIRIDIS && colormap != EWA_COLORMAP_TURBO) {
        srgb[0] = srgb[1] = srgb[2] = (uint8_t)(255 * clamped + 0.5);
        return;
    }
    const uint8_t(*table)[3] = colormap == EWA_COLORMAP_TURBO ? turbo : viridis;
    const double place = clamped * (KNOTS - 1);
    const int knot = place < KNOTS - 2 ? (int)place : KNOTS - 2;
    const double share = place - knot;
    for (int c = 0; c < 3; c++)
        srgb[c] = (uint8_t)((1 - share) * table[knot][c] + share * table[knot + 1][c] + 0.5);
}
