// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Which pixels of a tile a splat may add to: never fewer than the exact test of splat.glsl takes, and hardly more. So that what
// is left out changes no byte, all of it may be rounded as a device likes: MARGIN is 64 roundings of a float, of which
// sample_splat() makes fewer than 16 with the terms of a sum.

const float MARGIN = 1.0 / 262144.0;

// Pixels of a row that a splat may reach, bit by bit from the tile's first, which lies at dx_first from the splat's centre: where
// xx dx^2 + xy dy dx + yy dy^2 is below the end, of which the roots in dx are two.
uint row_mask(Record r, float dx_first, float dy) {
    float b = r.xy * dy, inside = 4.0 * r.xx * exponent_end * (1.0 + MARGIN);
    float root2 = b * b * (1.0 + MARGIN) - 4.0 * (r.xx * dy) * (r.yy * dy) * (1.0 - 2.0 * MARGIN) + inside;
    if (root2 < 0.0) return 0u;
    float scale = 0.5 / (r.xx * (1.0 - MARGIN)), middle = -b * scale, reach = sqrt(root2) * scale;
    float slack = 1.0 / 64.0 + (abs(middle) + abs(dx_first) + reach) / 65536.0, at = middle - dx_first;
    uint first = uint(clamp(ceil(at - reach - slack), 0.0, float(TILE_PX)));
    uint end = uint(clamp(floor(at + reach + slack) + 1.0, 0.0, float(TILE_PX)));
    return first < end ? (1u << end) - (1u << first) : 0u;
}

// Whether row_mask() is sure of a splat: its numbers are far from the ends of floats. Of raycast ones no ellipse is known.
bool has_rows(Record r) {
    return RAYS == 0 && 1e-12 < r.xx && r.xx < 1e12 && 1e-12 < r.yy && r.yy < 1e12 && abs(r.cx) < 1e6 && abs(r.cy) < 1e6;
}

// The pixels [first, end) of a tile, whose first lies at `origin` of its field, that the blocks of a splat's box have.
void clip_box(uint box, ivec2 origin, out ivec2 first, out ivec2 end) {
    ivec2 from = ivec2(box & 0x3fu, box >> 8 & 0x3fu) * 4, size = ivec2(box >> 16 & 0x3fu, box >> 24 & 0x3fu) * 4;
    first = clamp(from - origin, 0, int(TILE_PX));
    end = clamp(from + size - origin, 0, int(TILE_PX));
}

// What the keys of a splat are below (turn 1) or above (turn -1) between two places beside its centre; so those of z + eps.
float key_limit(Record r, vec2 low, vec2 high, float turn) {
    vec2 slope = vec2(r.key_x, r.key_y), along = turn * max(turn * slope * low, turn * slope * high);
    vec2 size = abs(slope) * max(abs(low), abs(high));
    float key = r.key + along.x + along.y + turn * MARGIN * (abs(r.key) + size.x + size.y);
    return RAYS != 0 || has(r.box, STEEP) ? min(max(key, r.key_low), r.bound_y) : key;
}

float bound_limit(Record r, vec2 low, vec2 high, bool orthographic) {
    if (RAYS == 0 && !has(r.box, STEEP)) {
        vec2 slope = vec2(r.bound_x, r.bound_y), along = max(slope * low, slope * high);
        vec2 size = abs(slope) * max(abs(low), abs(high));
        return r.bound + along.x + along.y + MARGIN * (abs(r.bound) + size.x + size.y);
    }
    float key = key_limit(r, low, high, 1.0);
    if ((RAYS != 0 || !orthographic) && !(r.bound > 0.0)) {
        if (!(0.0 < r.key_low && 0.0 < key && 0.0 <= r.bound_x)) return INF;
        return key / (r.bound_x * key + 1.0) * (1.0 + MARGIN);
    }
    return r.bound * key + r.bound_x + MARGIN * (abs(r.bound * key) + abs(r.bound_x));
}
