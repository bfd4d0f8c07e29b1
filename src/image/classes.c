// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Colours and names of classes of points.
// Based on: ASPRS, "LAS Specification 1.4 - R15", 2019, table 17 (codes and names; the colours are ours).
#include "ewa/image.h"

#include <stdio.h>

static const struct {
    const char *name;
    uint8_t srgb[3];
} known[] = {
    {"never classified", {150, 150, 150}},
    {"unclassified", {190, 190, 190}},
    {"ground", {160, 110, 60}},
    {"low vegetation", {165, 215, 95}},
    {"medium vegetation", {85, 175, 65}},
    {"high vegetation", {25, 110, 45}},
    {"building", {220, 80, 50}},
    {"low point", {235, 70, 205}},
    {"key point", {110, 75, 45}},
    {"water", {50, 115, 220}},
    {"rail", {95, 65, 140}},
    {"road surface", {95, 100, 110}},
    {"overlap", {250, 190, 120}},
    {"wire guard", {250, 225, 80}},
    {"wire conductor", {250, 170, 20}},
    {"transmission tower", {60, 190, 200}},
    {"wire connector", {190, 150, 230}},
    {"bridge deck", {125, 60, 80}},
    {"high noise", {250, 30, 110}},
};

enum { KNOWN = sizeof known / sizeof known[0] };

/// The colour of a hue in [0, 6) of a wheel of lightness `light` and strength `strong`.
static void wheel(double hue, double light, double strong, uint8_t srgb[3]) {
    for (int c = 0; c < 3; c++) {
        double off = hue - 2 * c; // red at 0, green at 2, blue at 4
        off = off > 3 ? off - 6 : off < -3 ? off + 6 : off;
        off = off < 0 ? -off : off;
        const double full = off <= 1 ? 1 : off < 2 ? 2 - off : 0;
        srgb[c] = (uint8_t)(255 * (light * (1 - strong + strong * full)) + 0.5);
    }
}

void ewa_class_color(uint32_t code, uint8_t srgb[3]) {
    if (code < KNOWN) {
        for (int c = 0; c < 3; c++) srgb[c] = known[code].srgb[c];
        return;
    }
    // Hues by the golden ratio lie far from those before them, and three lightnesses tell neighbours on the wheel apart.
    static const double lights[] = {0.95, 0.7, 0.85}, strengths[] = {0.75, 0.8, 0.45};
    const uint32_t turn = (uint32_t)((code - KNOWN + 1) * UINT64_C(2654435769)); // 2^32 / golden ratio
    wheel(6 * (turn * 0x1p-32), lights[code % 3], strengths[code % 3], srgb);
}

void ewa_class_name(uint32_t code, char name[EWA_CLASS_NAME_BYTES]) {
    if (code < KNOWN)
        snprintf(name, EWA_CLASS_NAME_BYTES, "%s", known[code].name);
    else
        snprintf(name, EWA_CLASS_NAME_BYTES, "class %u", code);
}

static char plain(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c == '_' || c == '-' ? ' ' : c;
}

bool ewa_class_find(const char *name, uint32_t *code) {
    if (!name || !code) return false;
    for (uint32_t i = 0; i < KNOWN; i++) {
        const char *a = name, *b = known[i].name;
        while (*a && plain(*a) == *b) a++, b++;
        if (*a || *b) continue;
        *code = i;
        return true;
    }
    return false;
}
