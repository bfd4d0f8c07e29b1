// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What all programs see of a band of rows; ewa_gl_band_block of src/gl/scene.h. And keys as numbers.

layout(std140, binding = 0) uniform BandBlock {
    uvec2 picture_px; // where it ends
    uvec2 band_px;    // size, whole blocks
    uvec2 first_px;   // of the band in the picture
    uint tiles_per_row, tile_count, tile_side_px;
    float exponent_end;
    uint layered;     // what is behind the first surface is drawn
    uint with_codes;
    int rgba_at, depth_at, normal_at, coverage_at; // in `planes`, or -1
};

bool has(uint flags, uint flag) { return (flags & flag) != 0u; }

// Floats as numbers that keep their order; 0 is below all.
uint order_of(float f) {
    uint bits = floatBitsToUint(f);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float float_of(uint order) {
    return uintBitsToFloat((order & 0x80000000u) != 0u ? order & 0x7fffffffu : ~order);
}
const uint NEVER = 0x007fffffu; // order_of(-INF)
