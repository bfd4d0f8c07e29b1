// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What programs see of a frame; src/gl/scene.h is the same in C.

// Of a source (ewa_view).
struct View {
    double focal_x, focal_y, principal_x, principal_y;
    float rotation[9];
    float scale;
    float fx_px, fy_px, inverse_fx, inverse_fy;
    float zoom, fx_zoomed, fy_zoomed;
    float broad;
    float cutoff, cutoff2, inverse_cutoff, center_scale;
    float prefilter2_px2, reach_px;
    float point_x, point_y, point_major, point_minor, point_sigma;
    float tolerance, grazing;
    float exponent_scale, exponent_end;
    float sum_scale, color_scale, depth_scale;
    uint doublings;
    uint flags; // ORTHOGRAPHIC, ...
    float contour_shift, contour_sine2, curvature_scale;
};

const uint ORTHOGRAPHIC = 1u, CULL_BACK = 2u, ELLIPSES = 4u, AFFINE = 8u, SOURCE = 16u, CIRCULAR = 32u, RAYCAST = 64u,
           POINTS = 128u, HIDES = 256u, SEE_THROUGH = 1024u;

// A splat in one field (ewa_record, ewa_load).
struct Record {
    float cx, cy;               // centre, from the middle of the field
    float xx, xy, yy;
    float key, key_x, key_y;
    float bound, bound_x, bound_y; // steep or wide: bound_scale, bound_offset, key_high
    float key_low;
    float red, green, blue;
    uint box;                   // first column | flags | first row << 8 | columns << 16 | rows << 24, in blocks of the field
    float nx, ny, nz, peak;
    float opacity;
    uint extra;                 // material | source << 8
    uint field;                 // column | row << 16
    uint clip;                  // of clipped ones: where their lines are
};

const uint BACK_FACING = 64u, STEEP = 128u, CONCAVE = 16384u, CLIPPED = 32768u;

// A clip line on the screen (ewa_clip_line), and those of a splat (ewa_clip).
struct ClipLine { float x_inward, y_inward, offset, reach, narrow, per_narrow, per_widths, pad; };
struct Clip { ClipLine line[4]; uint count, either, pad0, pad1; };

// A surfel that is drawn by pixel rays (ewa_near_record).
struct Near {
    float u[3], v[3], w[3], z[3];
    float depth_low, depth_high, tolerance;
    float color[3], normal[3], opacity, material[5];
    uint flags; // BACK_FACING, CLIPPED
    uint source, pad0, pad1;
    Clip clip;
};

// The tiles of the band that a record's box lies in.
void tiles_of(uvec2 field, uint box, out uvec2 first, out uvec2 last) {
    uvec2 from_px = field * 128u + uvec2(box & 0x3fu, box >> 8 & 0x3fu) * 4u - first_px;
    first = from_px / tile_side_px;
    last = (from_px + uvec2(box >> 16 & 0x3fu, box >> 24 & 0x3fu) * 4u - 1u) / tile_side_px;
}

layout(std430, binding = 0) readonly buffer ViewBlock { View views[]; };
