// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Linear colours to sRGB bytes: src/wide/pixels.h. After wide.glsl.

const float octaves[16] = float[16](3.53472114, 4.71828699, 6.29815722, 8.40703106, 11.2220402, 14.9796267, 19.9954033,
                                    26.6906605, 35.627758, 47.5573502, 63.4814453, 84.7375641, 113.111076, 150.985184,
                                    201.541031, 269.024994);

uint srgb_code(float linear_) {
    uint bits = floatBitsToUint(linear_);
    float m = uintBitsToFloat(bits & 0x7fffffu | 0x3f800000u), m2 = wf_mul(m, m);
    float root = wf_fma(m2, wf_fma(m2, wf_fma(m, 0.0054353733, -0.0514170193), wf_fma(m, 0.2085678072, -0.4917302076)),
                        wf_fma(m, 0.9528149418, 0.3763302953));
    float curve = wf_fma(octaves[bits >> 23 & 15u], root, CURVE_OFFSET);
    float line = wf_fma(linear_, LINE_SLOPE, 0.5);
    return uint(linear_ <= 0.0031308 ? line : curve);
}

// Premultiplied, to straight bytes.
uint color_code(vec4 color) {
    float alpha = wf_clamp(color.a, 0.0, 1.0);
    bool visible = 0.0 < color.a;
    float inverse_ = wf_keep(visible, wf_div(1.0, visible ? alpha : 1.0));
    uint code = uint(wf_fma(alpha, 255.0, 0.5)) << 24;
    for (int i = 0; i < 3; i++)
        code |= srgb_code(wf_clamp(wf_mul(color[i], inverse_), 0.0, 1.0)) << 8 * i;
    return code;
}
