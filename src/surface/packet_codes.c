// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// One surfel of a packet in double precision, from its codes, and the code of an angle.
#include "surface/color_form.h"
#include "surface/packets.h"

#include <math.h>
#include <string.h>

static ewa_vec3 oct_decode(int16_t code_x, int16_t code_y) {
    const double u = code_x / 32767.0, v = code_y / 32767.0, z = 1 - fabs(u) - fabs(v), fold = fmax(-z, 0);
    const ewa_vec3 n = vec3_make(u - (u < 0 ? -fold : fold), v - (v < 0 ? -fold : fold), z);
    return vec3_scale(n, 1 / vec3_length(n));
}

/// Two unit vectors that complete n to a right-handed frame.
static void packet_frame(ewa_vec3 n, ewa_vec3 *first, ewa_vec3 *second) {
    const double sign = n.z < 0 ? -1 : 1, a = -1 / (sign + n.z), b = n.x * n.y * a;
    *first = vec3_make(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *second = vec3_make(b, sign + n.y * n.y * a, -n.y);
}

uint16_t ewa_packet_code_angle(const ewa_packet *packet, uint32_t lane, ewa_vec3 axis) {
    ewa_vec3 first, second;
    packet_frame(oct_decode(packet->oct_x[lane], packet->oct_y[lane]), &first, &second);
    double c = vec3_dot(axis, first), t = vec3_dot(axis, second);
    if (t < 0) c = -c, t = -t; // the axis has no sign
    const double sum = fabs(c) + t;
    return (uint16_t)((uint32_t)((sum > 0 ? 1 - c / sum : 0) * 32768 + 0.5) & 0xffff);
}

uint16_t ewa_packet_code_curvature(double curvature) {
    static const double LIMIT = 1e30;
    const float number = (float)fmin(fmax(curvature, -LIMIT), LIMIT);
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return (uint16_t)((bits + 0x8000) >> 16);
}

double ewa_packet_decode_curvature(uint16_t code) {
    const uint32_t bits = (uint32_t)code << 16;
    float number;
    memcpy(&number, &bits, sizeof number);
    return (double)number;
}

ewa_vec3 ewa_packet_center(const ewa_surfels *surfels, uint32_t packet) {
    const ewa_packet_bounds *bounds = &surfels->bounds;
    return vec3_make(bounds->center_x[packet], bounds->center_y[packet], bounds->center_z[packet]);
}

/// The minor sigma over the major one.
static double decode_ratio(uint16_t code) {
    const double root = code / 65535.0, square = root * root;
    return square * square;
}

void ewa_packet_free_billboards(const ewa_packet *packet, uint32_t *cone) {
    bool any = false;
    for (int i = 0; i < EWA_PACKET_LANES; i++) any = any || packet->oct_x[i] == EWA_BILLBOARD;
    if (any) *cone |= (uint32_t)(EWA_CONE_SINE + 1) << 2 * EWA_CONE_BITS;
}

void ewa_packet_decode(const ewa_surfels *surfels, uint32_t index, uint32_t lane, ewa_packet_surfel *surfel) {
    const ewa_packet *packet = &surfels->packets[index];
    surfel->offset = vec3_make((double)packet->x[lane], (double)packet->y[lane], (double)packet->z[lane]);
    surfel->billboard = packet->oct_x[lane] == EWA_BILLBOARD;
    surfel->normal = oct_decode(packet->oct_x[lane], packet->oct_y[lane]);
    ewa_vec3 first, second;
    packet_frame(surfel->normal, &first, &second);
    const double c = 1 - packet->angle[lane] / 32768.0, t = 1 - fabs(c);
    const double major = (double)packet->sigma[lane];
    const ewa_vec3 axis = vec3_add(vec3_scale(first, c), vec3_scale(second, t));
    surfel->axis_u = vec3_scale(axis, major / sqrt(c * c + t * t));
    surfel->axis_v =
        vec3_scale(vec3_cross(surfel->normal, surfel->axis_u), decode_ratio(packet->ratio[lane]));
    const uint16_t codes[3] = {packet->red[lane], packet->green[lane], packet->blue[lane]};
    for (int k = 0; k < 3; k++)
        surfel->color[k] = ewa_color_decode_code(surfels->bounds.colors[index], codes[k]);
    surfel->opacity =
        surfels->opacities ? surfels->opacities[(size_t)index * EWA_PACKET_LANES + lane] / 65535.0 : 1;
}
