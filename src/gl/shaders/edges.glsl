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

// A tile is gone over in steps of at most `unit_splats`, of each surface first those that find it and then those that add it up.
// A dispatch takes `most_steps` of them, so that none takes long, and leaves the rest to the next round.
layout(location = 1) uniform uint most_steps;
layout(location = 2) uniform uint round_number;
layout(location = 3) uniform uint is_last_round; // that the host has asked for

uint steps_for(uint count) { return (count + unit_splats - 1u) / unit_splats; }

// Takes a step; `largest` is the nearest key that was found, or up to which is added. All of the group come here together. Returns
// whether some pixel looks.
bool take_step(Tile tile, uint step, bool adding, uvec2 in_field, bool looks, float beyond, inout float largest) {
    uint lists = steps_for(tile.count);
    start_lists(looks, largest, beyond);
    if (nobody_looks()) return false;
    if (step < lists) {
        uint first = tile.next - tile.count + step * unit_splats, end = min(first + unit_splats, tile.next);
        if (adding)
            add_splats(first, end, in_field, beyond, largest);
        else
            find_nearest(first, end, in_field, looks, beyond, -INF, largest);
    }
#if WITH_NEARS
    else if (looks) {
        uint first = tile.first_near + (step - lists) * unit_splats, end = min(first + unit_splats, tile.end_near);
        if (adding)
            add_nears(first, end, in_field, beyond, largest);
        else
            find_near(first, end, in_field, beyond, largest);
    }
#endif
    return true;
}

// Puts the surface whose sums are there under those before it.
void compose(inout vec4 behind, bool inside, bool block_is_cut, bool merged, float key) {
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
    uint layer = tile.open, step = tile.step, left = most_steps, steps = steps_for(tile.count) + steps_for(tile.end_near - tile.first_near);
    float beyond = inside ? PASSED : -INF, largest = inside && step != 0u ? FOUND : -INF;
    vec4 behind = vec4(0.0);
    if (inside) behind = vec4(BEHIND(0u), BEHIND(1u), BEHIND(2u), BEHIND(3u));
#if WITH_CLIPS
    uvec2 block = gl_LocalInvocationID.xy / 4u;
    uint in_tile = block.y * uint(TILE_PX / 4) + block.x;
    uint flag = 8u * pixel_count + in_band.y / 4u * ((band_px.x + 3u) / 4u) + in_band.x / 4u;
    bool leads = inside && all(equal(gl_LocalInvocationID.xy & 3u, uvec2(0u)));
    if (gl_LocalInvocationIndex < uint(TILE_PX / 4 * TILE_PX / 4)) cut_blocks[gl_LocalInvocationIndex] = 0u;
    barrier();
    if (leads) {
        cut_blocks[in_tile] = cut[flag];
        cut[flag] = 0u;
    }
#endif
    for (; layer < layers; layer++) {
        bool merged = merge_last != 0u && layer + 1u == layers, open = -INF < beyond;
        if (step == 0u) {
            largest = merged ? MIN_KEY_OF_ALL : -INF;
            step = merged ? steps : 0u;
        }
        if (gl_LocalInvocationIndex == 0u) still_open = 0u;
        barrier();
        for (; step < 2u * steps && left != 0u; step++, left--) {
            bool adding = step >= steps, looks = open && (!adding || -INF < largest);
            if (!take_step(tile, adding ? step - steps : step, adding, in_picture & 127u, looks, beyond, largest)) step = 2u * steps - 1u;
        }
        if (step < 2u * steps) break;
        step = 0u;
        bool block_is_cut = false;
#if WITH_CLIPS
        barrier();
        block_is_cut = cut_blocks[in_tile] != 0u;
        barrier();
        if (leads) cut_blocks[in_tile] = 0u;
#endif
        compose(behind, inside, block_is_cut, merged, largest);
        beyond = inside && -INF < largest && behind.a < 1.0 ? largest : -INF;
        if (-INF < beyond) still_open = 1u;
        barrier();
        if (still_open == 0u) layer = layers - 1u;
        barrier();
    }
    bool ends = layer >= layers;
    if (inside) {
        for (uint c = 0u; c < 4u; c++) BEHIND(c) = behind[c];
        PASSED = beyond;
        FOUND = largest;
    }
#if WITH_CLIPS
    barrier();
    if (leads) cut[flag] = cut_blocks[in_tile];
#endif
    if (gl_LocalInvocationIndex == 0u) {
        tiles[number].open = ends ? 0u : layer;
        tiles[number].step = step;
        if (ends)
            atomicMax(round_count, round_number + 1u);
        else if (is_last_round != 0u)
            atomicAdd(unfinished_count, 1u);
    }
    if (!loops_go_on()) atomicAdd(stopped_count, 1u);
}
