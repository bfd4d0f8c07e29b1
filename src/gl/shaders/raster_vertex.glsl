// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The vertex program: one corner of the box of a surfel.

void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // nowhere
    shape = key_at = range = extra = vec4(0.0);
#if PASS != 1
    color = normal = vec4(0.0);
#endif
#if WITH_CLIPS
    for (int i = 0; i < MAX_LINES; i++) lines[i] = vec3(0.0, 0.0, 1.0);
    line_bits = 0u;
#endif
#if PASS == 3
    material = vec4(0.0);
    reflection = 0.0;
#endif
    uint lane = uint(gl_InstanceID) & 15u;
    sigma = local.w * zoomed.w;
    alive = 0.0 < sigma && (packet_bits.y >> lane & 1u) != 0u;
    if (!alive) return;
    place_surfel();
    if (has(POINTS)) {
        make_point();
    } else {
        turn_surfel();
        find_range();
        find_covariance();
    }
#if NEAR
    if (alive && by_rays) emit_near(lane);
#else
    alive = alive && !by_rays && is_wanted(facing);
    find_shape();
    if (!alive) return;
    vec2 projected = base + offset * focal.xy, moved = shift * zoomed.xy;
    bool clipped = ((packet_bits.y >> 16u | packet_bits.z) >> lane & 1u) != 0u;
    bool concave;
    vec2 away = contour_way(clipped, concave);
    if (concave && behind != 0 && !has(SEE_THROUGH)) return;
    shape.xy = projected + moved + away;
    find_depths(moved + away);
    find_payload();
    if (has(RAYCAST)) find_ray();
#if WITH_CLIPS
    find_lines(lane, projected);
#endif
    emit_box(shape.xy - half_px - MARGIN_PX, shape.xy + half_px + MARGIN_PX);
#endif
}
