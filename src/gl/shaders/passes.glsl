// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The two passes over some splats of one tile (src/surface/pipeline_passes.h, pipeline_payload.h, pipeline_sums.h,
// pipeline_side_sums.h). PASS is 1 for visibility, 2 for the sums, over units of work; 4 has both, for what lies behind the
// first surface (edges.glsl). Splats come in batches: first each invocation takes some of them, copies them to the memory of
// the group and notes at the pixels which of them they have to look at (masks.glsl); then each is a pixel and looks at these.

layout(local_size_x = TILE_PX, local_size_y = TILE_PX) in;

layout(std430, binding = 3) buffer TileBlock { Tile tiles[]; };
layout(std430, binding = 5) readonly buffer RecordBlock { Record records[]; };
layout(std430, binding = 6) readonly buffer ListBlock { uvec2 list[]; }; // record; its box
#if PASS != 4
layout(std430, binding = 1) buffer NearestBlock { uint nearest[]; };
layout(std430, binding = 7) readonly buffer UnitBlock { uvec4 units[]; }; // tile; first, end of the list or of near ones; near
#endif
#if PASS == 2
#define ADD(to, what) atomicAdd(to, uint(what))
#else
#define ADD(to, what) to += uint(what)
#endif
layout(location = 0) uniform uint part;

// Parts take units or tiles in turns.
uint work_number() { return group_number() * parts + part; }

#if WITH_CLIPS && PASS == 4
shared uint cut_blocks[TILE_PX / 4 * TILE_PX / 4];
#endif

#if PASS != 1
int low[CHANNELS];
#if WITH_FINE
int low_fine[CHANNELS];
#endif

const float BIAS = 12582912.0;
const int BIAS_BITS = 0x4b400000;

int units_of(float weight, float factor) { return floatBitsToInt(wf_fma(weight, factor, BIAS)) - BIAS_BITS; }

// What that leaves, in units of its own.
int fine_units(float weight, float factor) {
    float after = wf_fma(weight, factor, BIAS);
    float left = wf_odd(wf_fma(weight, factor, wf_sub(BIAS, after)));
    return units_of(FINE_SCALE, left);
}

void add_word(uint channel, uint word, int value, bool is_back_facing) {
    if (value == 0) return;
    uint at = (channel * WORDS + word) * pixel_count + pixel;
    if (is_back_facing) {
        ADD(is_back[at], value & 0xffff);
        ADD(is_back[at + pixel_count], value >> 16);
    } else {
        ADD(sums[at], value & 0xffff);
        ADD(sums[at + pixel_count], value >> 16);
    }
}

void add_channel(uint channel, float weight, float factor, bool is_back_facing, bool fine) {
    int value = units_of(weight, factor);
    if (is_back_facing)
        add_word(channel, 0u, value, true);
    else
        low[channel] += value;
#if WITH_FINE || WITH_DEPTH || WITH_CLIPS
    if (!fine) return;
    int rest = fine_units(weight, factor);
#if WITH_FINE
    if (!is_back_facing) {
        low_fine[channel] += rest;
        return;
    }
#endif
    add_word(channel, 2u, rest, is_back_facing);
#endif
}

#if WITH_CLIPS
void add_cut(Clip clip, Sample s, float whole_weight) {
    float off = wf_mul(wf_sub(1.0, s.share), PER_CUT);
    float cut_weight = wf_mul(wf_min(off, 1.0), whole_weight);
    if (!(0.0 < cut_weight)) return;
    float decides[2];
    for (int i = 0; i < 2; i++) decides[i] = clip.either != 0u ? s.line[i] : wf_sub(1.0, s.line[i]);
    float sum = wf_add(decides[0], decides[1]);
    float x = wf_fma(decides[0], clip.line[0].x_inward, wf_mul(decides[1], clip.line[1].x_inward));
    float y = wf_fma(decides[0], clip.line[0].y_inward, wf_mul(decides[1], clip.line[1].y_inward));
    if (clip.count > 2u && clip.either != 0u) {
        float off_first = wf_sub(1.0, s.first), share = wf_div(off_first, 0.0 < sum ? sum : 1.0);
        x = wf_mul(x, share);
        y = wf_mul(y, share);
        sum = off_first;
    }
    for (uint i = 2u; i < clip.count; i++) {
        float decides_too = wf_sub(1.0, s.line[i]);
        x = wf_fma(decides_too, clip.line[i].x_inward, x);
        y = wf_fma(decides_too, clip.line[i].y_inward, y);
        sum = wf_add(sum, decides_too);
    }
    float scaled = wf_div(1.0, 0.0 < sum ? sum : 1.0);
    float parts[4] = float[4](s.share, 1.0, wf_mul(scaled, x), wf_mul(scaled, y));
    for (uint c = 0u; c < 4u; c++) {
        int value = units_of(1.0, wf_odd_product(cut_weight, parts[c]));
        uint at = c * 2u * pixel_count + pixel;
        ADD(cut[at], value & 0xffff);
        ADD(cut[at + pixel_count], value >> 16);
    }
#if PASS == 2
    uvec2 block = uvec2(pixel % band_px.x, pixel / band_px.x) / 4u;
    cut[8u * pixel_count + block.y * ((band_px.x + 3u) / 4u) + block.x] = 1u;
#else
    uvec2 block = gl_LocalInvocationID.xy / 4u;
    cut_blocks[block.y * uint(TILE_PX / 4) + block.x] = 1u;
#endif
}
#endif

float depth_share(View view, float key, float bound) {
    float share = has(view.flags, ORTHOGRAPHIC) ? wf_mul(key, -view.depth_scale) : wf_div(bound, key);
    return wf_odd(wf_min(wf_max(share, -1.0), ALMOST_ONE));
}

// What a splat adds (payload): peak, colour, normal, opacity, material.
struct Payload {
    float peak;
    vec3 color, normal;
    float opacity, material[5];
};

void add_splat(Payload p, View view, Sample s, float bound, bool is_back_facing, bool fine) {
    float weight = exponential(s.exponent, view.doublings);
#if WITH_CLIPS
    weight = wf_mul(weight, s.share);
#endif
    bool depth_too = WITH_DEPTH != 0 && PASS == 2;
    add_channel(0u, weight, p.peak, is_back_facing, fine || depth_too);
    for (uint i = 0u; i < 3u; i++) add_channel(1u + i, weight, p.color[i], is_back_facing, fine);
#if WITH_NORMAL
    for (uint i = 0u; i < 3u; i++) add_channel(4u + i, weight, p.normal[i], is_back_facing, fine);
#endif
#if WITH_DEPTH
    if (depth_too)
        add_channel(DEPTH_CHANNEL, wf_mul(weight, p.peak), depth_share(view, s.key, bound), is_back_facing, true);
#endif
#if WITH_MATERIAL
    for (uint i = 0u; i < 5u; i++) add_channel(8u + i, weight, p.material[i], is_back_facing, fine);
#endif
#if WITH_OPACITY
    add_channel(CHANNELS - 1u, weight, p.opacity, is_back_facing, fine);
#endif
}
#endif

// A batch: what of its splats pixels look at, and a bit for each of them at each pixel that may be reached.
const uint THREADS = uint(TILE_PX * TILE_PX), BATCH = 128u, BATCH_WORDS = BATCH / 32u;
shared vec4 batch_shape[BATCH], batch_keys[BATCH], batch_bounds[BATCH];
shared uvec4 batch_rest[BATCH]; // box, extra, number of the record, bits of the peak
shared uint reached[BATCH_WORDS * THREADS]; // [word][pixel]
// A bit for each pixel that takes part; the least key that one of them looks for, and below which they look: as orders. The least
// of a batch is the other of the two of the batch before, so that both may be told at once.
shared uint active_rows[TILE_PX], least[2], most;

// Begins lists: whether this pixel takes part, and for which keys.
void start_lists(bool looks, float from, float beyond) {
    uint me = gl_LocalInvocationIndex;
    barrier();
    if (me == 0u) {
        least[0] = 0xffffffffu;
        most = 0u;
    }
    if (me < uint(TILE_PX)) active_rows[me] = 0u;
    for (uint i = 0u; i < BATCH_WORDS; i++) reached[i * THREADS + me] = 0u;
    barrier();
    if (looks) {
        atomicOr(active_rows[gl_LocalInvocationID.y], 1u << gl_LocalInvocationID.x);
        atomicMin(least[0], order_of(from));
        atomicMax(most, order_of(beyond));
    }
    barrier();
}

// Nobody takes part, which all know after start_lists().
bool nobody_looks() { return least[0] == 0xffffffffu; }

// Takes the batch from `first` on of a list that ends at `end`; `finding`: of what hides only what may raise the nearest keys. The
// tile lies at `origin` of its field.
void take_batch(uint first, uint end, ivec2 origin, bool finding, uint turn) {
    float from_key = float_of(least[finding ? turn & 1u : 0u]);
    for (uint slot = gl_LocalInvocationIndex; slot < BATCH && first + slot < end; slot += THREADS) {
        uint number = list[first + slot].x;
        Record r = records[number];
        uint flags = views[r.extra >> 8].flags;
        if (finding && !has(flags, HIDES)) continue;
#if PASS == 4
        if (has(r.box, CONCAVE)) continue;
#endif
        ivec2 from, to;
        clip_box(r.box, origin, from, to);
        vec2 middle = vec2(r.cx, r.cy) + 63.5, low = vec2(origin + from) - middle, high = vec2(origin + to - 1) - middle;
        float up_to = finding ? bound_limit(r, low, high, has(flags, ORTHOGRAPHIC)) : key_limit(r, low, high, 1.0);
        if (finding ? up_to <= from_key : up_to < from_key) continue;
#if PASS == 4
        if (float_of(most) <= key_limit(r, low, high, -1.0)) continue;
#endif
        batch_shape[slot] = vec4(r.cx, r.cy, r.xx, r.xy);
        batch_keys[slot] = vec4(r.yy, r.key, r.key_x, r.key_y);
        batch_bounds[slot] = vec4(r.bound, r.bound_x, r.bound_y, r.key_low);
        batch_rest[slot] = uvec4(r.box, r.extra, number, floatBitsToUint(r.peak));
        bool rows = has_rows(r);
        vec2 from_center = vec2(origin) - middle;
        for (int y = from.y; y < to.y; y++) {
            uint bits = active_rows[y] & (1u << to.x) - (1u << from.x);
            if (rows) bits &= row_mask(r, from_center.x, from_center.y + float(y));
            uint at = slot / 32u * THREADS + uint(y * TILE_PX);
            for (; bits != 0u; bits &= bits - 1u) atomicOr(reached[at + uint(findLSB(bits))], 1u << (slot & 31u));
        }
    }
}

// The next splat of the batch that may reach the pixel; each goes on by itself, so that those of a group that work do so together.
bool next_splat(inout uint word, inout uint bits, out uint slot) {
    slot = 0u;
    while (bits == 0u) {
        if (word == BATCH_WORDS) return false;
        uint at = word * THREADS + gl_LocalInvocationIndex;
        bits = reached[at];
        reached[at] = 0u;
        word++;
    }
    slot = (word - 1u) * 32u + uint(findLSB(bits));
    bits &= bits - 1u;
    return true;
}

// What a pixel looks at of a splat.
Record batch_record(uint slot) {
    vec4 shape = batch_shape[slot], keys = batch_keys[slot], bounds = batch_bounds[slot];
    uvec4 rest = batch_rest[slot];
    return Record(shape.x, shape.y, shape.z, shape.w, keys.x, keys.y, keys.z, keys.w, bounds.x, bounds.y, bounds.z, bounds.w,
                  0.0, 0.0, 0.0, rest.x, 0.0, 0.0, 0.0, uintBitsToFloat(rest.w), 0.0, rest.y, 0u, 0u);
}

// A splat of the batch at a pixel; it counts before `beyond` and within its clip lines.
Sample sample_listed(Record r, uint number, vec2 at, View view, float beyond) {
    Sample s = sample_record(r, at, view);
#if PASS == 4
    s.counts = s.counts && s.key < beyond;
#endif
#if WITH_CLIPS
    if (s.counts && has(r.box, CLIPPED)) clip_at(clips[records[number].clip], at, s);
#endif
    return s;
}

vec2 place_in_field(uvec2 in_field) { return vec2(float(in_field.x) - 63.5, float(in_field.y) - 63.5); }

#if PASS != 2
// Raises `largest` to the keys of z + eps of those of a list that count before `beyond`. `before` is known of the pixel.
void find_nearest(uint first, uint end, uvec2 in_field, bool looks, float beyond, float before, inout float largest) {
    vec2 at = place_in_field(in_field);
    ivec2 origin = ivec2(in_field - gl_LocalInvocationID.xy);
    for (uint turn = 0u; first < end; first += BATCH, turn++) {
        take_batch(first, end, origin, true, turn);
        if (gl_LocalInvocationIndex == 0u) least[turn + 1u & 1u] = 0xffffffffu;
        barrier();
        for (uint word = 0u, bits = 0u, slot; next_splat(word, bits, slot);) {
            Record r = batch_record(slot);
            View view = views[r.extra >> 8];
            Sample s = sample_listed(r, batch_rest[slot].z, at, view, beyond);
            if (s.counts) largest = wf_max(s.bound, largest);
        }
        if (looks) atomicMin(least[turn + 1u & 1u], order_of(wf_max(before, largest)));
        barrier();
    }
}

#if WITH_NEARS
// The same of near surfels.
void find_near(uint first, uint end, uvec2 in_field, float beyond, inout float largest) {
    vec2 at = place_in_field(in_field);
    for (uint i = first; i < end; i++) {
        View view = views[nears[i].source];
        if (!has(view.flags, HIDES)) continue;
        Sample s = sample_near(nears[i], at, view);
#if PASS == 4
        s.counts = s.counts && s.key < beyond;
#endif
        if (s.counts) largest = wf_max(s.bound, largest);
    }
}
#endif
#endif

#if PASS != 1
void clear_channels() {
    for (int i = 0; i < CHANNELS; i++) low[i] = 0;
#if WITH_FINE
    for (int i = 0; i < CHANNELS; i++) low_fine[i] = 0;
#endif
}

void add_channels() {
    for (uint i = 0u; i < uint(CHANNELS); i++) add_word(i, 0u, low[i], false);
#if WITH_FINE
    for (uint i = 0u; i < uint(CHANNELS); i++) add_word(i, 2u, low_fine[i], false);
#endif
}

// Adds a splat of the batch whose key reaches `bound`, likewise.
void add_listed(uint slot, vec2 at, float beyond, float bound) {
    Record shape = batch_record(slot);
    uint number = batch_rest[slot].z;
    View view = views[shape.extra >> 8];
    Sample s = sample_listed(shape, number, at, view, beyond);
    if (!(s.counts && bound <= s.key)) return;
    Record r = records[number];
    Payload p;
    p.peak = r.peak;
    p.color = vec3(r.red, r.green, r.blue);
    p.normal = vec3(r.nx, r.ny, r.nz);
    p.opacity = r.opacity;
#if WITH_MATERIAL
    for (uint k = 0u; k < 5u; k++) p.material[k] = wf_odd(wf_mul(to.materials[(r.extra & 255u) * 5u + k], r.peak));
#endif
#if RAYS
    p.peak = wf_odd_product(p.peak, s.gain);
    for (int k = 0; k < 3; k++) {
        p.color[k] = wf_odd_product(p.color[k], s.gain);
        p.normal[k] = wf_odd_product(p.normal[k], s.gain);
    }
    p.opacity = wf_odd_product(p.opacity, s.gain);
#if WITH_MATERIAL
    for (int k = 0; k < 5; k++) p.material[k] = wf_odd_product(p.material[k], s.gain);
#endif
#endif
    bool fine = WITH_FINE != 0;
#if WITH_CLIPS
    if (has(r.box, CLIPPED)) {
        add_cut(clips[r.clip], s, wf_mul(exponential(s.exponent, view.doublings), p.peak));
        fine = true;
    }
#endif
    add_splat(p, view, s, bound, has(r.box, BACK_FACING), fine);
}

// Adds to the sums of the pixel those of a list.
void add_splats(uint first, uint end, uvec2 in_field, float beyond, float bound) {
    vec2 at = place_in_field(in_field);
    ivec2 origin = ivec2(in_field - gl_LocalInvocationID.xy);
    clear_channels();
    for (; first < end; first += BATCH) {
        take_batch(first, end, origin, false, 0u);
        barrier();
        for (uint word = 0u, bits = 0u, slot; next_splat(word, bits, slot);) add_listed(slot, at, beyond, bound);
        barrier();
    }
    add_channels();
}

#if WITH_NEARS
// The same of near surfels.
void add_nears(uint first, uint end, uvec2 in_field, float beyond, float bound) {
    vec2 at = place_in_field(in_field);
    clear_channels();
    for (uint i = first; i < end; i++) {
        Near r = nears[i];
        View view = views[r.source];
        Sample s = sample_near(r, at, view);
#if PASS == 4
        s.counts = s.counts && s.key < beyond;
#endif
        if (!(s.counts && bound <= s.key)) continue;
        float peak = wf_mul(s.gain, view.sum_scale);
        Payload p;
        p.peak = wf_odd(peak);
        for (int k = 0; k < 3; k++) {
            p.color[k] = wf_odd_product(peak, r.color[k]);
            p.normal[k] = wf_odd_product(peak, r.normal[k]);
        }
        p.opacity = wf_odd_product(peak, r.opacity);
        for (int k = 0; k < 5; k++) p.material[k] = wf_odd_product(peak, r.material[k]);
        bool fine = WITH_FINE != 0;
#if WITH_CLIPS
        if (has(r.flags, CLIPPED)) {
            add_cut(r.clip, s, wf_mul(exponential(s.exponent, view.doublings), peak));
            fine = true;
        }
#endif
        add_splat(p, view, s, bound, has(r.flags, BACK_FACING), fine);
    }
    add_channels();
}
#endif
#endif

#if PASS != 4
void main() {
    if (work_number() >= unit_count) return;
    uvec4 unit = units[work_number()];
    uvec2 in_band = uvec2(unit.x % tiles_per_row, unit.x / tiles_per_row) * uint(TILE_PX) + gl_LocalInvocationID.xy;
    bool inside = all(lessThan(in_band, band_px));
    uvec2 in_field = (first_px + in_band) & 127u;
    uint here = inside ? in_band.y * band_px.x + in_band.x : 0u;
    float known = inside ? float_of(nearest[here]) : -INF; // others may raise it meanwhile
#if PASS == 1
    float largest = -INF;
#if WITH_NEARS
    if (unit.w != 0u) {
        if (inside) find_near(unit.y, unit.z, in_field, INF, largest);
    } else
#endif
    {
        start_lists(inside, known, INF);
        find_nearest(unit.y, unit.z, in_field, inside, INF, known, largest);
    }
    if (inside && known < largest) atomicMax(nearest[here], order_of(largest));
#else
    pixel = here;
    pixel_count = band_px.x * band_px.y;
    bool looks = known > -INF;
#if WITH_NEARS
    if (unit.w != 0u) {
        if (looks) add_nears(unit.y, unit.z, in_field, INF, known);
        return;
    }
#endif
    start_lists(looks, known, INF);
    if (!nobody_looks()) add_splats(unit.y, unit.z, in_field, INF, known);
#endif
}
#endif
