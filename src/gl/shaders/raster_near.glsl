// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Surfels at the eye's plane, and huge ones: no ellipse, but what pixel rays meet (ewa_near_record_set()). They may be seen
// anywhere, so their box is the band. What they are goes by the names of an ellipse's numbers, as there are few of those.

vec3 ray_u, ray_v, ray_w, ray_z; // linear on the picture: u = U / W, v = V / W, z = Z / W

// A vector's product with pixel rays (x, y, 1).
vec3 linear_on_picture(vec3 by) {
    vec2 g = by.xy * focal.zw;
    return vec3(g, by.z - dot(g, place.zw));
}

void set_rays(vec3 p, vec3 u, vec3 v) {
    if (has(ORTHOGRAPHIC)) {
        vec2 tilt = -n.xy / n.z;
        vec2 by_u = (u.xy + u.z * tilt) / dot(u, u), by_v = (v.xy + v.z * tilt) / dot(v, v);
        ray_u = linear_on_picture(vec3(by_u, -dot(by_u, p.xy)));
        ray_v = linear_on_picture(vec3(by_v, -dot(by_v, p.xy)));
        ray_w = vec3(0.0, 0.0, 1.0);
        ray_z = linear_on_picture(vec3(tilt, p.z - dot(tilt, p.xy)));
        return;
    }
    vec3 across = cross(u, v);
    float size = length(across);
    ray_u = linear_on_picture(cross(v, p) / size);
    ray_v = linear_on_picture(cross(p, u) / size);
    ray_w = linear_on_picture(across / size);
    ray_z = vec3(0.0, 0.0, dot(across, p) / size);
}

void emit_near(uint lane) {
    vec2 projected = base + offset * focal.xy;
    vec3 p = has(ORTHOGRAPHIC) ? vec3((projected - place.zw) * focal.zw, z)
                               : vec3(packet_at.zw * packet_rest.z + packet_rest.xy, packet_rest.z) + turn(local.xyz) * zoomed.w;
    float np = has(ORTHOGRAPHIC) ? n.z : dot(n, p);
    if (!is_wanted(np) || abs(np) < EDGE_ON * (has(ORTHOGRAPHIC) ? 1.0 : length(p))) return;
    vec3 u = axis * sigma;
    set_rays(p, u, cross(n, u) * ratio);
    shape = vec4(ray_u, ray_z.x);
    key_at = vec4(ray_v, ray_z.y);
    extra = vec4(ray_w, ray_z.z);
    float steepness = length(n.xy * focal.zw / np) * (has(ORTHOGRAPHIC) ? 1.0 : p.z * p.z);
    float grazing = min(kernel.w * steepness, GRAZING_TOLERANCE * kernel.x * sigma);
    range = vec4(p.z - half_range, p.z + half_range, depth.x * sigma + depth.y * grazing, p.z);
    facing = np;
    peak = 1.0;
    find_payload();
#if WITH_CLIPS
    slope = p.xy / p.z;
    find_lines(lane, projected);
#endif
    emit_box(vec2(-1.0), place.xy + 1.0);
}
