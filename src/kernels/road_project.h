// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Part of road_body.h: packets to tiles, surfels to records, records to classes.
//
// Based on: Zwicker, Rasanen, Botsch, Dachsbacher, Pauly, "Perspective Accurate Splatting", 2004, section 4,
// in the sheared form of math.md section 3, which single precision needs.
#ifndef EWA_SRC_KERNELS_ROAD_PROJECT_H
#define EWA_SRC_KERNELS_ROAD_PROJECT_H

static inline wf wf_clamp(wf a, float low, float high) {
    return wf_min(wf_max(a, wf_set(low)), wf_set(high));
}
static inline wf wf_negate(wf a) { return wf_sub(wf_set(-0.0f), a); }

/// Rows of a rotation times a vector.
static inline void rotate(const float m[9], wf x, wf y, wf z, wf out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] =
            wf_fma(wf_set(m[3 * i]), x, wf_fma(wf_set(m[3 * i + 1]), y, wf_mul(wf_set(m[3 * i + 2]), z)));
}

static inline void to_camera(const ewa_view *view, wf x, wf y, wf z, wf out[3]) {
    rotate(view->rotation, x, y, z, out);
    for (int i = 0; i < 3; i++) out[i] = wf_fma(wf_set(view->scale), out[i], wf_set(view->translation[i]));
}

static inline float tile_count(uint32_t side_px, uint32_t tile_px) {
    return (float)((side_px + tile_px - 1) / tile_px);
}

/// The tiles between two pixel coordinates along one axis, as floats within [0, tile_count].
static inline void tile_range(wf low_px, wf high_px, float tile_px, float tiles, wf *first, wf *end) {
    const wf per_px = wf_set(1.0f / tile_px);
    *first = wf_clamp(wf_floor(wf_mul(low_px, per_px)), 0, tiles);
    *end = wf_clamp(wf_add(wf_floor(wf_mul(high_px, per_px)), wf_set(1)), 0, tiles);
}

static uint32_t cull(const ewa_view *view, const ewa_packet_bounds *bounds, uint32_t first, uint32_t count,
                     ewa_tile_rect *rects) {
    const float tile_px = (float)view->tile_px;
    const float tiles_x = tile_count(view->width_px, view->tile_px),
                tiles_y = tile_count(view->height_px, view->tile_px);
    const wf margin_px = wf_set(view->reach_px + 1);
    uint32_t culled = 0;
    for (uint32_t i = 0; i < count; i += 16) {
        const uint32_t p = first + i;
        wf c[3], axis[3];
        to_camera(view, wf_load(bounds->center_x + p), wf_load(bounds->center_y + p),
                  wf_load(bounds->center_z + p), c);
        const wf r = wf_mul(wf_load(bounds->radius + p), wf_set(view->scale));
        wm alive, near;
        wf x, y, half_x, half_y;
        if (view->orthographic) {
            alive = wf_lt(wf_negate(r), c[2]);
            near = wm_of_bits(0);
            x = wf_fma(c[0], wf_set(view->fx_px), wf_set(view->cx_px));
            y = wf_fma(c[1], wf_set(view->fy_px), wf_set(view->cy_px));
            half_x = wf_mul(r, wf_set(view->fx_px));
            half_y = wf_mul(r, wf_set(view->fy_px));
        } else {
            alive = wf_lt(wf_negate(r), c[2]);
            for (int k = 0; k < 4; k++) {
                const float *n = view->side_planes[k];
                const wf d =
                    wf_fma(wf_set(n[0]), c[0], wf_fma(wf_set(n[1]), c[1], wf_mul(wf_set(n[2]), c[2])));
                alive = wm_and(alive, wf_lt(wf_negate(r), d));
            }
            near = wf_le(c[2], wf_mul(r, wf_set((float)EWA_NEAR_RATIO)));
            // The tight box of a sphere's outline: D = r^2 I - c'c (math.md section 3).
            const wf r2 = wf_mul(r, r), z2 = wf_mul(c[2], c[2]);
            const wf inverse = wf_div(wf_set(1), wf_sub(z2, r2));
            const wf rx = wf_sqrt(wf_max(wf_fma(c[0], c[0], wf_sub(z2, r2)), wf_set(0)));
            const wf ry = wf_sqrt(wf_max(wf_fma(c[1], c[1], wf_sub(z2, r2)), wf_set(0)));
            const wf zi = wf_mul(c[2], inverse), ri = wf_mul(r, inverse);
            x = wf_fma(wf_mul(c[0], zi), wf_set(view->fx_px), wf_set(view->cx_px));
            y = wf_fma(wf_mul(c[1], zi), wf_set(view->fy_px), wf_set(view->cy_px));
            half_x = wf_mul(wf_mul(rx, ri), wf_set(view->fx_px));
            half_y = wf_mul(wf_mul(ry, ri), wf_set(view->fy_px));
        }
        if (view->cull_back) {
            rotate(view->rotation, wf_load(bounds->axis_x + p), wf_load(bounds->axis_y + p),
                   wf_load(bounds->axis_z + p), axis);
            const wf sine = wf_load(bounds->cone_sine + p);
            wm behind;
            if (view->orthographic) {
                behind = wf_lt(sine, axis[2]);
            } else {
                const wf along = wf_fma(axis[0], c[0], wf_fma(axis[1], c[1], wf_mul(axis[2], c[2])));
                const wf length = wf_sqrt(wf_fma(c[0], c[0], wf_fma(c[1], c[1], wf_mul(c[2], c[2]))));
                behind = wf_lt(wf_fma(length, sine, r), along);
            }
            alive = wm_and(alive, wm_not(behind));
        }
        const wf mx = wf_add(half_x, margin_px), my = wf_add(half_y, margin_px);
        wf x0, x1, y0, y1;
        tile_range(wf_sub(x, mx), wf_add(x, mx), tile_px, tiles_x, &x0, &x1);
        tile_range(wf_sub(y, my), wf_add(y, my), tile_px, tiles_y, &y0, &y1);
        x0 = wf_select(near, wf_set(0), x0), x1 = wf_select(near, wf_set(tiles_x), x1);
        y0 = wf_select(near, wf_set(0), y0), y1 = wf_select(near, wf_set(tiles_y), y1);
        alive = wm_and(alive, wm_and(wf_lt(x0, x1), wf_lt(y0, y1)));
        int32_t corners[4][16];
        wi_store(corners[0], wi_from_f(wf_keep(alive, x0)));
        wi_store(corners[1], wi_from_f(wf_keep(alive, y0)));
        wi_store(corners[2], wi_from_f(wf_keep(alive, x1)));
        wi_store(corners[3], wi_from_f(wf_keep(alive, y1)));
        const uint32_t here = count - i < 16 ? count - i : 16;
        for (uint32_t k = 0; k < here; k++) {
            rects[p + k] = (ewa_tile_rect){(uint16_t)corners[0][k], (uint16_t)corners[1][k],
                                           (uint16_t)corners[2][k], (uint16_t)corners[3][k]};
            culled += corners[0][k] == corners[2][k];
        }
    }
    return culled;
}

/// Unit normals from their octahedral form.
static inline void decode_normals(const ewa_packet *packet, wf n[3]) {
    const wf unit = wf_set(1.0f / 32767.0f);
    const wf u = wf_mul(wf_from_i(wi_load_i16(packet->oct_x)), unit);
    const wf v = wf_mul(wf_from_i(wi_load_i16(packet->oct_y)), unit);
    const wf z = wf_sub(wf_sub(wf_set(1), wf_abs(u)), wf_abs(v));
    const wf fold = wf_max(wf_negate(z), wf_set(0));
    const wf x = wf_sub(u, wf_select(wf_lt(u, wf_set(0)), wf_negate(fold), fold));
    const wf y = wf_sub(v, wf_select(wf_lt(v, wf_set(0)), wf_negate(fold), fold));
    const wf length2 = wf_fma(x, x, wf_fma(y, y, wf_mul(z, z)));
    const wf inverse = wf_div(wf_set(1), wf_sqrt(length2));
    n[0] = wf_mul(x, inverse), n[1] = wf_mul(y, inverse), n[2] = wf_mul(z, inverse);
}

/// Unit major axes: the frame of ewa_packet_frame() turned by the diamond angle.
static inline void decode_axes(const ewa_packet *packet, const wf n[3], wf axis[3]) {
    const wf t = wf_mul(wf_from_i(wi_load_u16(packet->angle)), wf_set(1.0f / 32768.0f));
    wf c = wf_sub(wf_set(1), t);
    wf s = wf_sub(wf_set(1), wf_abs(c));
    const wf inverse = wf_div(wf_set(1), wf_sqrt(wf_fma(c, c, wf_mul(s, s))));
    c = wf_mul(c, inverse), s = wf_mul(s, inverse);
    const wf sign = wf_select(wf_lt(n[2], wf_set(0)), wf_set(-1), wf_set(1));
    const wf a = wf_div(wf_set(-1), wf_add(sign, n[2]));
    const wf b = wf_mul(wf_mul(n[0], n[1]), a);
    // First frame vector (1 + sign nx^2 a, sign b, -sign nx), second (b, sign + ny^2 a, -ny).
    const wf ux = wf_fma(wf_mul(sign, n[0]), wf_mul(n[0], a), wf_set(1)), uy = wf_mul(sign, b);
    const wf uz = wf_negate(wf_mul(sign, n[0])), vy = wf_fma(wf_mul(n[1], n[1]), a, sign);
    axis[0] = wf_fma(c, ux, wf_mul(s, b));
    axis[1] = wf_fma(c, uy, wf_mul(s, vy));
    axis[2] = wf_fnma(s, n[1], wf_mul(c, uz));
}

static inline wf decode_color(const ewa_view *view, const uint16_t *values, int channel) {
    return wf_fma(wf_from_i(wi_load_u16(values)), wf_set(view->color_scale[channel]),
                  wf_set(view->color_offset[channel]));
}

/// Class of a box: rows within columns, so that a class's neighbours share their unrolled column count.
static inline wi box_classes(wi columns, wi rows) {
    const wi row_class = wi_sub(wi_min(rows, wi_set(EWA_ROW_CLASSES)), wi_set(1));
    const wi column = wi_sub(wi_min(columns, wi_set(EWA_COLUMN_CLASSES + 1)), wi_set(1));
    const wi scaled = wi_add(wi_shl(column, 2), column); // times EWA_ROW_CLASSES
    return wi_min(wi_add(scaled, row_class), wi_set(EWA_WIDE_CLASS));
}

static inline void setup_packet(const ewa_view *view, const ewa_packet *packet, uint32_t id,
                                const ewa_tile *tile, ewa_run *run) {
    const wf one = wf_set(1), zero = wf_set(0);
    const float cutoff2 = view->cutoff2;
    wf p[3], n_world[3], n[3], axis[3] = {zero, zero, zero};
    to_camera(view, wf_load(packet->x), wf_load(packet->y), wf_load(packet->z), p);
    const wf sigma = wf_mul(wf_load(packet->sigma), wf_set(view->scale));
    decode_normals(packet, n_world);
    rotate(view->rotation, n_world[0], n_world[1], n_world[2], n);

    // Sigma = minor^2 (I - n'n) + extra axis'axis.
    wf minor = sigma, minor2 = wf_mul(sigma, sigma), extra = zero;
    if (view->ellipses) {
        wf axis_world[3];
        decode_axes(packet, n_world, axis_world);
        rotate(view->rotation, axis_world[0], axis_world[1], axis_world[2], axis);
        minor = wf_mul(sigma, wf_mul(wf_from_i(wi_load_u16(packet->ratio)), wf_set(1.0f / 65535.0f)));
        const wf major2 = minor2;
        minor2 = wf_mul(minor, minor);
        extra = wf_sub(major2, minor2);
    }
    const wf sigma33 =
        wf_fma(minor2, wf_fma(n[0], n[0], wf_mul(n[1], n[1])), wf_mul(extra, wf_mul(axis[2], axis[2])));
    const wf range2 = wf_mul(wf_set(cutoff2), sigma33), range = wf_sqrt(range2);

    wm alive = wf_lt(zero, sigma);
    wf inverse_z, x0, y0, facing; // facing: n.p / pz, orthographic nz
    if (view->orthographic) {
        alive = wm_and(alive, wf_lt(zero, p[2]));
        inverse_z = one, x0 = zero, y0 = zero, facing = n[2];
    } else {
        alive = wm_and(alive, wf_lt(wf_negate(range), p[2]));
        inverse_z = wf_div(one, p[2]);
        x0 = wf_mul(p[0], inverse_z), y0 = wf_mul(p[1], inverse_z);
        facing = wf_fma(n[0], x0, wf_fma(n[1], y0, n[2]));
    }
    wm near = wm_of_bits(0);
    if (!view->orthographic) {
        near = wm_and(alive, wf_le(p[2], wf_mul(range, wf_set((float)EWA_NEAR_RATIO))));
        alive = wm_and(alive, wm_not(near));
        for (uint32_t bits = wm_bits(near), lane = 0; bits; bits >>= 1, lane++)
            if (bits & 1) run->near_surfels[run->near_count++] = id * EWA_PACKET_LANES + lane;
    }
    if (view->cull_back) alive = wm_and(alive, wf_lt(facing, zero));
    if (!wm_bits(alive)) return;

    // The sheared covariance G Sigma G' (math.md section 3), with b = axis_xy - x0 axis_z.
    const wf m1 = wf_fnma(x0, n[2], n[0]), m2 = wf_fnma(y0, n[2], n[1]);
    const wf b1 = wf_fnma(x0, axis[2], axis[0]), b2 = wf_fnma(y0, axis[2], axis[1]);
    const wf e1 = wf_mul(extra, b1), e2 = wf_mul(extra, b2);
    const wf s11 = wf_fma(minor2, wf_fnma(m1, m1, wf_fma(x0, x0, one)), wf_mul(e1, b1));
    const wf s22 = wf_fma(minor2, wf_fnma(m2, m2, wf_fma(y0, y0, one)), wf_mul(e2, b2));
    const wf s12 = wf_fma(minor2, wf_fnma(m1, m2, wf_mul(x0, y0)), wf_mul(e1, b2));
    const wf s13 = wf_fnma(minor2, wf_fma(m1, n[2], x0), wf_mul(e1, axis[2]));
    const wf s23 = wf_fnma(minor2, wf_fma(m2, n[2], y0), wf_mul(e2, axis[2]));

    // Centre c relative to the projected p, variance V, both in pixels; k = -1/D33.
    const wf fx = wf_set(view->fx_px), fy = wf_set(view->fy_px);
    wf k = one, c1 = zero, c2 = zero;
    if (!view->orthographic) {
        k = wf_mul(inverse_z, inverse_z);
        if (!view->affine) {
            k = wf_div(one, wf_fnma(wf_set(cutoff2), sigma33, wf_mul(p[2], p[2])));
            const wf f2k = wf_mul(wf_set(-cutoff2), k);
            c1 = wf_mul(f2k, s13), c2 = wf_mul(f2k, s23);
        }
    }
    const wf c1f = wf_mul(c1, wf_set(1 / view->cutoff)), c2f = wf_mul(c2, wf_set(1 / view->cutoff));
    const wf v11 = wf_mul(wf_mul(fx, fx), wf_fma(c1f, c1f, wf_mul(s11, k)));
    const wf v22 = wf_mul(wf_mul(fy, fy), wf_fma(c2f, c2f, wf_mul(s22, k)));
    const wf v12 = wf_mul(wf_mul(fx, fy), wf_fma(c1f, c2f, wf_mul(s12, k)));
    // |V| in closed form: -|D| is (F^2 minor major n.p)^2, so nothing cancels for edge-on surfels.
    const wf plane = view->orthographic ? facing : wf_mul(facing, p[2]);
    const wf area = wf_mul(wf_mul(wf_mul(minor, sigma), wf_mul(fx, fy)), plane);
    const wf det = wf_mul(wf_mul(area, area), wf_mul(wf_mul(k, k), view->orthographic ? one : k));
    const wf h2 = wf_set(view->prefilter2_px2);
    const wf w11 = wf_add(v11, h2), w22 = wf_add(v22, h2);
    const wf det_filtered = wf_fma(h2, wf_add(wf_add(v11, v22), h2), det);
    // Without a prefilter an edge-on splat is a line of no area: it covers no pixel.
    alive = wm_and(alive, wf_lt(wf_mul(wf_set((float)EWA_FLAT), wf_mul(w11, w22)), det_filtered));
    const wf inverse_det = wf_div(one, det_filtered);
    const wf scaled = wf_mul(inverse_det, wf_set(view->exponent_scale));
    const wf weight = wf_mul(wf_sqrt(wf_mul(det, inverse_det)), wf_set((float)EWA_INVERSE_TWO_PI));

    // Key plane: 1/z (orthographic: -z), its clamps and the tolerance.
    wf key, key_x, key_y, key_low, key_high, per_px;
    const wf floor_facing =
        view->orthographic ? wf_set((float)EWA_EDGE_ON)
                           : wf_mul(wf_set((float)EWA_EDGE_ON), wf_sqrt(wf_fma(x0, x0, wf_fma(y0, y0, one))));
    const wf raised = wf_max(wf_abs(facing), floor_facing);
    const wf tilt = wf_div(wf_select(wf_lt(facing, zero), wf_set(-1), one), raised);
    key_x = wf_mul(wf_mul(wf_mul(n[0], tilt), inverse_z), wf_set(1 / view->fx_px));
    key_y = wf_mul(wf_mul(wf_mul(n[1], tilt), inverse_z), wf_set(1 / view->fy_px));
    const wf slope = wf_sqrt(wf_fma(key_x, key_x, wf_mul(key_y, key_y)));
    const wf c1_px = wf_mul(c1, fx), c2_px = wf_mul(c2, fy);
    if (view->orthographic) {
        key = wf_negate(p[2]);
        key_low = wf_negate(wf_add(p[2], range)), key_high = wf_sub(range, p[2]);
        per_px = slope;
    } else {
        key = wf_fma(key_x, c1_px, wf_fma(key_y, c2_px, inverse_z));
        key_low = wf_div(one, wf_add(p[2], range)), key_high = wf_div(one, wf_sub(p[2], range));
        per_px = wf_mul(slope, wf_mul(p[2], p[2]));
    }
    const wf grazing =
        wf_min(wf_mul(wf_set(view->reach_px), per_px), wf_mul(wf_set(view->grazing_limit), sigma));
    const wf tolerance = wf_fma(wf_set(view->tolerance), sigma, grazing);

    // The box of pixels whose centres the ellipse may hold, in the tile, in blocks.
    const wf px = view->orthographic ? p[0] : x0, py = view->orthographic ? p[1] : y0;
    const wf cx = wf_add(wf_fma(px, fx, wf_set(view->cx_px - (float)tile->x_px)), c1_px);
    const wf cy = wf_add(wf_fma(py, fy, wf_set(view->cy_px - (float)tile->y_px)), c2_px);
    const wf half_x = wf_mul(wf_set(view->cutoff), wf_sqrt(w11)),
             half_y = wf_mul(wf_set(view->cutoff), wf_sqrt(w22));
    const float right = (float)tile->width_px, bottom = (float)tile->height_px;
    const wf low_x = wf_add(wf_floor(wf_sub(wf_sub(cx, half_x), wf_set(0.5f))), one);
    const wf low_y = wf_add(wf_floor(wf_sub(wf_sub(cy, half_y), wf_set(0.5f))), one);
    const wf high_x = wf_floor(wf_sub(wf_add(cx, half_x), wf_set(0.5f)));
    const wf high_y = wf_floor(wf_sub(wf_add(cy, half_y), wf_set(0.5f)));
    const wf first_x = wf_max(low_x, zero), last_x = wf_min(high_x, wf_set(right - 1));
    const wf first_y = wf_max(low_y, zero), last_y = wf_min(high_y, wf_set(bottom - 1));
    alive = wm_and(alive, wm_and(wf_le(first_x, last_x), wf_le(first_y, last_y)));
    const uint32_t alive_bits = wm_bits(alive);
    if (!alive_bits) return;
    const wi column = wi_sar(wi_from_f(wf_keep(alive, first_x)), 2),
             row = wi_sar(wi_from_f(wf_keep(alive, first_y)), 2);
    const wi columns = wi_add(wi_sub(wi_sar(wi_from_f(wf_keep(alive, last_x)), 2), column), wi_set(1));
    const wi rows = wi_add(wi_sub(wi_sar(wi_from_f(wf_keep(alive, last_y)), 2), row), wi_set(1));
    const wi box = wi_or(wi_or(column, wi_shl(row, 8)), wi_or(wi_shl(columns, 16), wi_shl(rows, 24)));

    // Normals towards the viewer.
    const wm away = wf_lt(zero, facing);
    for (int i = 0; i < 3; i++) n[i] = wf_select(away, wf_negate(n[i]), n[i]);

    wf rows16[16] = {
        wf_sub(wf_from_i(wi_shl(column, 2)), cx),
        wf_sub(wf_from_i(wi_shl(row, 2)), cy),
        wf_mul(w22, scaled),
        wf_mul(wf_mul(v12, wf_set(-2)), scaled),
        wf_mul(w11, scaled),
        weight,
        key,
        key_x,
        key_y,
        key_low,
        key_high,
        tolerance,
        decode_color(view, packet->red, 0),
        decode_color(view, packet->green, 1),
        decode_color(view, packet->blue, 2),
        wf_of_bits(box),
    };
    w_transpose(rows16);
    float normals[64];
    w_store4(normals, n[0], n[1], n[2], zero);
    int32_t classes[16];
    wi_store(classes, box_classes(columns, rows));
    uint32_t at = run->count;
    for (uint32_t lane = 0; lane < 16; lane++) {
        wf_store((float *)(void *)&run->records[at], rows16[lane]);
        memcpy(run->normals[at], &normals[4 * lane], 4 * sizeof(float));
        run->classes[at] = (uint8_t)classes[lane];
        at += alive_bits >> lane & 1;
    }
    run->count = at;
}

static void setup(const ewa_view *view, const ewa_packet *packets, const uint32_t *packet_ids, uint32_t count,
                  const ewa_tile *tile, ewa_run *run) {
    enum { AHEAD = 8, LINE_BYTES = 64 };
    run->count = 0;
    run->near_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (i + AHEAD < count) {
            const char *later = (const char *)&packets[packet_ids[i + AHEAD]];
            for (size_t line = 0; line < sizeof(ewa_packet) + LINE_BYTES - 1; line += LINE_BYTES)
                __builtin_prefetch(later + line);
        }
        setup_packet(view, &packets[packet_ids[i]], packet_ids[i], tile, run);
    }
}

static void sort(const ewa_run *run, bool with_normals, ewa_record *records, float (*normals)[4],
                 uint16_t class_first[EWA_CLASS_COUNT + 1]) {
    uint16_t at[EWA_CLASS_COUNT] = {0};
    for (uint32_t i = 0; i < run->count; i++) at[run->classes[i]]++;
    uint16_t sum = 0;
    for (int c = 0; c < EWA_CLASS_COUNT; c++) {
        class_first[c] = sum;
        sum = (uint16_t)(sum + at[c]);
        at[c] = class_first[c];
    }
    class_first[EWA_CLASS_COUNT] = sum;
    for (uint32_t i = 0; i < run->count; i++) {
        const uint32_t to = at[run->classes[i]]++;
        wf_store((float *)(void *)&records[to], wf_load((const float *)(const void *)&run->records[i]));
        if (with_normals) memcpy(normals[to], run->normals[i], sizeof normals[to]);
    }
}

#endif
