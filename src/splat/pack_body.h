// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Body of the packing kernels (KERNEL): loops over lanes that the compiler turns into vectors of whatever
// instruction set the including file is compiled for. Reductions halve, so that their order is the same in
// all.
//
// Octahedral normals: Meyer et al., "On Floating-Point Normal Vectors", 2010.
#include "splat/pack.h"

#include <math.h>

enum { LANES = EWA_PACKET_LANES };

#define EACH_LANE(i) for (int i = 0; i < LANES; i++)

#define REDUCE(name, expression)                                                                             \
    static inline double name(const double value[LANES]) {                                                   \
        double r[LANES];                                                                                     \
        EACH_LANE(i) r[i] = value[i];                                                                        \
        for (int i = 0; i < 8; i++) {                                                                        \
            const double a = r[i], b = r[i + 8];                                                             \
            r[i] = (expression);                                                                             \
        }                                                                                                    \
        for (int i = 0; i < 4; i++) {                                                                        \
            const double a = r[i], b = r[i + 4];                                                             \
            r[i] = (expression);                                                                             \
        }                                                                                                    \
        for (int i = 0; i < 2; i++) {                                                                        \
            const double a = r[i], b = r[i + 2];                                                             \
            r[i] = (expression);                                                                             \
        }                                                                                                    \
        const double a = r[0], b = r[1];                                                                     \
        return (expression);                                                                                 \
    }

REDUCE(least_lane, a < b ? a : b)
REDUCE(most_lane, a > b ? a : b)
REDUCE(sum_lanes, a + b)

/// Encodes the normals and replaces them by what their codes mean.
static inline void code_normals(const ewa_lanes *lanes, ewa_packet *packet, double normal[3][LANES]) {
    int32_t code_x[LANES], code_y[LANES];
    EACH_LANE(i) {
        const double nx = lanes->normal[0][i], ny = lanes->normal[1][i], nz = lanes->normal[2][i];
        const double scale = 1 / (fabs(nx) + fabs(ny) + fabs(nz));
        const double u = nx * scale, v = ny * scale;
        const double folded_u = copysign(1 - fabs(v), u), folded_v = copysign(1 - fabs(u), v);
        const double x = nz < 0 ? folded_u : u, y = nz < 0 ? folded_v : v;
        code_x[i] = (int32_t)(x * 32767 + copysign(0.5, x));
        code_y[i] = (int32_t)(y * 32767 + copysign(0.5, y));
    }
    EACH_LANE(i) packet->oct_x[i] = (int16_t)code_x[i];
    EACH_LANE(i) packet->oct_y[i] = (int16_t)code_y[i];
    EACH_LANE(i) {
        const double u = code_x[i] / 32767.0, v = code_y[i] / 32767.0, z = 1 - fabs(u) - fabs(v);
        const double fold = z < 0 ? -z : 0;
        const double x = u - copysign(fold, u), y = v - copysign(fold, v);
        const double scale = 1 / sqrt(x * x + y * y + z * z);
        normal[0][i] = x * scale, normal[1][i] = y * scale, normal[2][i] = z * scale;
    }
}

void KERNEL(const ewa_lanes *lanes, const double origin_world[3], double cutoff, ewa_packet *packet,
            ewa_packet_bound *bound) {
    float *const position[3] = {packet->x, packet->y, packet->z};
    double local[3][LANES], normal[3][LANES], far2[LANES], cosine[LANES], reach[LANES];
    enum { ULPS = 16 }; // single precision of centre, radius and axis, rounded to the safe side
    const double slack = ULPS * 0x1p-24;
    double center[3], axis[3], size = 0;
    for (int c = 0; c < 3; c++) {
        const double origin = origin_world[c];
        EACH_LANE(i) position[c][i] = (float)(lanes->center_world[c][i] - origin);
        EACH_LANE(i) local[c][i] = (double)position[c][i];
        bound->center[c] = (float)(0.5 * (least_lane(local[c]) + most_lane(local[c])));
        center[c] = (double)bound->center[c];
        size += fabs(center[c]);
    }
    EACH_LANE(i) packet->sigma[i] = (float)lanes->sigma_world[i];
    int32_t ratio[LANES];
    EACH_LANE(i) ratio[i] = (int32_t)(lanes->ratio[i] * 65535 + 0.5);
    EACH_LANE(i) packet->ratio[i] = (uint16_t)ratio[i];
    code_normals(lanes, packet, normal);
    for (int c = 0; c < 3; c++) axis[c] = sum_lanes(normal[c]);
    const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (int c = 0; c < 3; c++) axis[c] = length > 0 ? axis[c] / length : c == 2;
    EACH_LANE(i) {
        const double x = local[0][i] - center[0], y = local[1][i] - center[1], z = local[2][i] - center[2];
        far2[i] = x * x + y * y + z * z;
        cosine[i] = normal[0][i] * axis[0] + normal[1][i] * axis[1] + normal[2][i] * axis[2];
    }
    EACH_LANE(i) reach[i] = sqrt(far2[i]) + cutoff * (double)packet->sigma[i];
    bound->radius = (float)(most_lane(reach) * (1 + slack) + slack * size);
    for (int c = 0; c < 3; c++) bound->axis[c] = (float)axis[c];
    const double least_cosine = length > 0 ? least_lane(cosine) : -1;
    const double sine2 = 1 - least_cosine * least_cosine;
    bound->cone_sine = least_cosine <= 0 ? 2.0f : (float)(sqrt(sine2 > 0 ? sine2 : 0) + slack);
}
