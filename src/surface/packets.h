// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The resident form of a cloud, and one surfel of it back in double precision.
#ifndef EWA_SRC_SURFACE_PACKETS_H
#define EWA_SRC_SURFACE_PACKETS_H

#include "ewa/render.h"
#include "homogeneous/vec.h"
#include "surface/packet.h"

/// The clip lines of a surfel: keep toward.(q - center) + offset >= 0 for q in its plane, in the surfels'
/// unit; toward is a unit vector of the plane, or 0 and offset 1 where there is no line.
typedef struct ewa_surfel_clip {
    float toward[2][3], offset[2];
    bool either;
} ewa_surfel_clip;

struct ewa_surfels {
    ewa_context *context;
    uint64_t serial; ///< of its packets: another for each set of surfels
    uint32_t count, packet_count;
    uint64_t left_out_count;
    uint32_t *points; ///< [packet][lane]: of the cloud, or EWA_NO_POINT; NULL: not kept
    ewa_packet *packets;
    uint8_t *materials; ///< [packet][lane]; NULL: all are `material`
    uint8_t material, max_material;
    uint16_t *opacities;    ///< [packet][lane], times 65535; NULL: all are opaque
    uint16_t *curvatures;   ///< [packet][lane]: upper halves of floats, per length in packets; NULL: all are 0
    uint16_t *clip_masks;   ///< [packet]: bit per lane that has a clip line; NULL: none has
    uint32_t *clip_first;   ///< [packet]: of its lanes' in `clips`
    ewa_surfel_clip *clips; ///< `clip_count` of them, in the order of packets and lanes
    uint64_t clip_count;
    ewa_packet_bounds bounds; ///< views into `bounds_memory`
    void *bounds_memory;
    size_t bounds_stride;   ///< packet_count rounded up to a full vector
    double origin_world[3]; ///< of the packets' centres
    double unit;            ///< of all lengths in packets, world units; a power of two near their sigmas
    ewa_bounds extent;      ///< of the surfels' centres, from the origin, in world units
    double reach_world;     ///< no surfel reaches farther from its packet's centre
    double largest_sigmas_world[2]; ///< no major or minor axis is larger
    double largest_color;           ///< a power of two that no number of a colour is beyond
    bool fine_colors;               ///< some are large, and others far smaller
    double cutoff;
    bool ellipses;   ///< some kernel is not a circle
    bool billboards; ///< some may be without a normal
    bool colored;    ///< the cloud had colours
    double unit_coverage;
    ewa_surfels *coarser;                            ///< the next level of detail; NULL: none
    bool with_opacities, with_materials, with_clips; ///< of a proxy: what its original has (proxy.h)
};

/// Colours up to so much keep enough digits in one word of a sum (surface/pipeline_sums.h), as do those of
/// which none is much smaller than the largest.
#define EWA_PLAIN_COLORS 16.0

enum { EWA_BOUNDS_BYTES = 3 * sizeof(double) + 2 * sizeof(uint16_t) + sizeof(uint32_t) }; ///< of a packet

/// ewa_surfels_create() of surfels that remember their points: `points` of the first level.
ewa_status ewa_surfels_create_kept(const ewa_cloud *cloud, const ewa_surfels_options *options, ewa_surfels **surfels);

/// ewa_surfels_create() of surfels whose unit coverage is known; 0: measured.
ewa_status ewa_surfels_create_covering(const ewa_cloud *cloud, const ewa_surfels_options *options, double unit_coverage, ewa_surfels **surfels);

/// Makes room for `packet_count` packets, zero bounds included, instead of those that were there.
ewa_status ewa_packets_allocate(ewa_surfels *surfels, uint32_t packet_count);

/// Clears the lanes from `count` on.
void ewa_packet_empty_lanes(ewa_packet *packet, uint32_t count);

/// Sets the views of `bounds` into `bounds_memory`.
void ewa_packets_view_bounds(ewa_surfels *surfels);

/// Sets what is known of all packets together: reach_world, largest_sigmas_world, largest_color,
/// fine_colors.
void ewa_packets_sum_up(ewa_surfels *surfels);

/// One surfel of a packet; lengths in the surfels' unit, axes of length sigma.
typedef struct ewa_packet_surfel {
    ewa_vec3 offset; ///< from the packet's centre
    ewa_vec3 axis_u, axis_v, normal; ///< of billboards any
    bool billboard;
    double color[3], opacity;
} ewa_packet_surfel;

/// Decodes lane `lane` of packet `packet`, as the kernels do but in double precision.
void ewa_packet_decode(const ewa_surfels *surfels, uint32_t packet, uint32_t lane, ewa_packet_surfel *surfel);

/// Codes the direction of an axis, without its sign, as the diamond angle in [0, 2) in the frame of the lane's
/// normal, which is coded by then: 1 - c / (|c| + t).
uint16_t ewa_packet_code_angle(const ewa_packet *packet, uint32_t lane, ewa_vec3 axis);

/// Codes a curvature per length in packets as the upper half of a float.
uint16_t ewa_packet_code_curvature(double curvature);

/// Returns the curvature of such a code.
double ewa_packet_decode_curvature(uint16_t code);

/// Tells the cone of a packet that billboards have no normals.
void ewa_packet_free_billboards(const ewa_packet *packet, uint32_t *cone);

/// Returns a packet's centre, from the origin in the surfels' unit.
ewa_vec3 ewa_packet_center(const ewa_surfels *surfels, uint32_t packet);

/// Estimates q0 (docs/math.md section 7): the median over a sample of surfels of sigma_u sigma_v density
/// (1 - exp(-F^2 / 2)), each surfel counting at least itself within its own support.
double ewa_packets_unit_coverage(const ewa_surfels *surfels);

#endif
