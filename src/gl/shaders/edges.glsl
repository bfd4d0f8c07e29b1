// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// What lies behind the first surface of a tile, surface by surface, while some pixel of it is open: src/surface/edges.c,
// pipeline_edges.h (compose). A pixel by each invocation.

float merged_alpha(float alpha, float coverage) {
    float through = wf_sub(1.0, alpha);
    for (int i = 1; i < MERGED_SURFACES; i++) {
        float share = wf_min(wf_max(wf_fma(coverage, 4.0, float(-4 * i - 2)), 0.0), 1.0);
        if (!(0.0 < share)) break;
        through = wf_mul(through, wf_sub(1.0, wf_mul(alpha, share)));
    }
    return wf_sub(1.0, through);
}

// The alpha of a surface whose edge is cut by lines, as the first one's is.
float cut_alpha(Surface s, float alpha) {
    float first = surface_alpha(FINALIZED(0u), FINALIZED(uint(CHANNELS) - 1u), true, BEHIND(4u));
    float uncut = surface_alpha(s.sums[0], s.sums[CHANNELS - 1], false, 0.0);
    float left = wf_sub(1.0, first), over = s.cover;
    float along = wf_fma(BEHIND(6u), s.cut_y, wf_mul(BEHIND(5u), s.cut_x));
    float beside = wf_max(wf_sub(over, first), 0.0);
    float hidden = wf_div(beside, 0.0 < left ? left : 1.0);
    float related = wf_min(wf_mul(wf_abs(along), 2.0), 1.0);
    return wf_fma(related, wf_sub(0.0 < along ? hidden : uncut, over), over);
}

// Gathers the next surface of the pixel, which is open or not; returns its key. All of the group come here together.
float gather(Tile tile, uvec2 in_field, bool open, float beyond, bool merged) {
    float largest = -INF;
    uint first = tile.next - tile.count;
    if (!merged) {
        start_lists(open, -INF, beyond);
        find_nearest(first, tile.next, in_field, open, beyond, -INF, largest);
#if WITH_NEARS
        if (open) find_near(tile.first_near, tile.end_near, in_field, beyond, largest);
#endif
    }
    bool found = open && (merged || -INF < largest);
    float bound = merged ? MIN_KEY_OF_ALL : largest;
    start_lists(found, bound, beyond);
    if (nobody_looks()) return largest;
    for (uint i = first; i < tile.next; i += unit_splats)
        add_splats(i, min(i + unit_splats, tile.next), in_field, beyond, bound);
#if WITH_NEARS
    for (uint i = tile.first_near; found && i < tile.end_near; i += unit_splats)
        add_nears(i, min(i + unit_splats, tile.end_near), in_field, beyond, bound);
#endif
    return largest;
}

// Some drivers end loops that go on for long (llvmpipe's end after 65,535 turns of all of them together), and say nothing. Then
// this one ends early, too.
bool loops_go_on() {
    uint turns = 0u;
    for (uint i = 0u; i < layers; i++) turns++;
    return turns == layers;
}

void main() {
    uint number = work_number();
    if (number >= tile_count || tiles[number].open == 0u) return;
    Tile tile = tiles[number];
    uvec2 in_band = uvec2(number % tiles_per_row, number / tiles_per_row) * uint(TILE_PX) + gl_LocalInvocationID.xy;
    bool inside = all(lessThan(in_band, band_px));
    pixel_count = band_px.x * band_px.y;
    pixel = inside ? in_band.y * band_px.x + in_band.x : 0u;
    in_picture = first_px + in_band;
    float beyond = inside ? PASSED : -INF;
    vec4 behind = vec4(0.0);
    for (uint layer = 1u; layer < layers; layer++) {
        bool merged = merge_last != 0u && layer + 1u == layers;
        if (gl_LocalInvocationIndex == 0u) still_open = 0u;
#if WITH_CLIPS
        if (gl_LocalInvocationIndex < uint(TILE_PX / 4 * TILE_PX / 4)) cut_blocks[gl_LocalInvocationIndex] = 0u;
#endif
        barrier();
        float key = gather(tile, in_picture & 127u, -INF < beyond, beyond, merged);
        bool block_is_cut = false;
#if WITH_CLIPS
        barrier();
        uvec2 block = gl_LocalInvocationID.xy / 4u;
        block_is_cut = cut_blocks[block.y * uint(TILE_PX / 4) + block.x] != 0u;
#endif
        Surface s;
        for (uint c = 0u; c < uint(CHANNELS); c++) s.sums[c] = 0.0;
        s.cover = s.cut_x = s.cut_y = 0.0;
        if (inside) s = finalize(block_is_cut, false, merged, key);
        vec3 color = shade(s.sums);
        bool with_cut = block_is_cut && !merged;
        float alpha = surface_alpha(s.sums[0], s.sums[CHANNELS - 1], with_cut, s.cover);
        if (inside && with_cut && BEHIND(7u) != 0.0 && !has(to.flags, TRANSPARENT)) alpha = cut_alpha(s, alpha);
        if (merged) alpha = merged_alpha(alpha, wf_mul(s.sums[0], to.unit_coverage_inverse));
        float share = wf_mul(wf_sub(1.0, behind.a), alpha);
        for (int c = 0; c < 3; c++) behind[c] = wf_fma(color[c], share, behind[c]);
        behind.a = wf_add(behind.a, share);
        beyond = inside && -INF < key && behind.a < 1.0 ? key : -INF;
        if (-INF < beyond) still_open = 1u;
        barrier();
        if (still_open == 0u) break;
        barrier();
    }
    if (inside)
        for (uint c = 0u; c < 4u; c++) BEHIND(c) = behind[c];
    if (!loops_go_on()) atomicAdd(stopped_count, 1u);
}
