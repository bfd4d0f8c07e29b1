// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Files of the data set that tests read, and what is in them. Where the data set is not there, synthetic
// files are made of these facts (synthetic_data.h).
#ifndef EWA_TESTS_FACTS_H
#define EWA_TESTS_FACTS_H

#include "ewa/ewa.h"

/// A point cloud: how many points, and where.
static const struct {
    const char *path;
    uint64_t points;
    double low[3], high[3];
} model_facts[] = {
    {"models/bunny_zipper_ascii.ply",
     35947,
     {-0.0946899, 0.0329874, -0.0618736},
     {0.0610091, 0.187321, 0.0587997}},
    {"models/lucy_100k_tri.ply", 49987, {225.906, -388.421, -605.89}, {1156.03, 145.348, 991.332}},
    {"models/dragon_100k_tri_normals.ply",
     50002,
     {-98.6693, -41.3035, -57.2507},
     {103.146, 49.2598, 76.8579}},
    {"models/igea_tristrips.ply", 134345, {-0.034556, -0.049669, -0.049538}, {0.034556, 0.049669, 0.049538}},
    {"models/laurana50k_colour.ply", 27861, {-256.461, -400.909, -1764.56}, {211.248, 101.182, -1472.79}},
    {"models/rangemap_lato000.ply", 44461, {-41.5001, -73.1827, -800.04}, {56.6248, 35.2212, -724.794}},
    {"models/pepper_artec_multitexture.ply",
     14980,
     {-31.0585, -61.6852, -2.36095},
     {29.3337, 74.251, 48.8348}},
    {"models/head_lps/head_vertexcolour.ply",
     9279,
     {-4.27632, -3.97255, -2.59038},
     {4.27632, 3.97255, 2.59036}},
    {"models/head_lps/head_surfels_100k.ply",
     100000,
     {-4.2744, -3.97182, -2.58985},
     {4.2758, 3.97204, 2.58349}},
    {"models/meshlab_textured/TextureDouble.ply", 8, {0, 0, 0}, {3, 1, 0}},
    {"models/variants/draco_cube_att.ply", 24, {0, 0, 0}, {1, 1, 1}},
    {"models/variants/draco_int_point_cloud.ply", 16, {-797, 249, 1}, {-409, 517, 8}},
    {"models/variants/draco_float_two_att_point_cloud.ply", 3, {4.1, 2.6, 1.4}, {4.9, 2.9, 7.7}},
    {"models/variants/draco_float_inf_point_cloud.ply", 16, {-797, 276, 1}, {-479, 517, 8}},
    {"models/variants/draco_point_cloud_test_pos_norm.ply",
     4,
     {37.9345, 8.42107, 1.34474},
     {44.0828, 19.2937, 3.51623}},
    {"models/variants/draco_test_extra_whitespace.ply", 3, {0.25, 0.1, 0}, {0.75, 0.9, 0}},
    {"models/variants/draco_test_more_datatypes.ply", 3, {0.25, 0.1, 0}, {0.75, 0.9, 0}},
    {"models/variants/draco_test_pos_color.ply", 114, {-1, -1, -1}, {1, 1, 1}},
    {"models/variants/draco_test_pos_color_ascii.ply", 114, {-1, -1, -1}, {1, 1, 1}},
    {"models/variants/draco_cube_quads.ply", 8, {0, 0, 0}, {1, 1, 1}},
    {"models/variants/draco_delim_test.ply", 24, {-0.0759899, 0.22797, -12.621}, {12.6143, 12.2344, 0}},
    {"models/variants/dolphins.ply", 855, {-477.202, -86.61, -180.377}, {349.473, 86.61, 566.654}},
    {"models/variants/dolphins_colored.ply", 855, {-477.202, -86.61, -180.377}, {349.473, 86.61, 566.654}},
    {"models/variants/dolphins_be.ply", 855, {-477.202, -86.61, -180.377}, {349.473, 86.61, 566.654}},
    {"models/variants/dolphins_le.ply", 855, {-477.202, -86.61, -180.377}, {349.473, 86.61, 566.654}},
    {"models/variants/assimp_cube_binary.ply", 8, {0, 0, 0}, {1, 1, 1}},
    {"models/variants/assimp_cube_binary_header_with_RN_newline.ply", 8, {0, 0, 0}, {1, 1, 1}},
    {"models/variants/assimp_cube_binary_starts_with_nl.ply", 8, {5.96753, 0, 0}, {6.96753, 1, 1}},
    {"models/variants/assimp_cube_uv.ply", 24, {-1, -1, -1}, {1, 1, 1}},
    {"models/variants/assimp_float-color.ply", 3, {0, 0, 0}, {200, 200, 0}},
    {"models/variants/assimp_points.ply", 4, {0, 0, 0}, {0, 1, 1}},
    {"clouds/ply/lion_takanawa_normals_colour.ply",
     341989,
     {-4.985, 1.039, -3.445},
     {-0.789, 6.7235, 1.1235}},
    {"clouds/ply/pond_normals_colour_psz.ply",
     70051,
     {-1.50206, 0.571367, -2.63168},
     {1.97647, 1.09156, 0.509945}},
    {"clouds/ply/Guanyin_colour.ply",
     238154,
     {-0.510808, 0.002058, -0.370374},
     {0.474869, 1.29293, 0.453506}},
    {"gaussians/pc_short_100_sh3.ply", 100, {-0.932074, -0.472956, 0.332892}, {0.0834385, 0.478113, 1.56834}},
    {"hostile/mesh/pdal_issue_2421.ply", 1, {1.23457, 12345.7, 1234567890}, {1.23457, 12345.7, 1234567890}},
};

/// A volume below volumes/: its size, its type as read, and its range.
static const struct {
    const char *name;
    uint32_t dims[3];
    ewa_type type;
    double low, high;
} volume_facts[] = {
    {"aneurism.vti", {256, 256, 256}, EWA_U8, 0, 255},
    {"engine_256x256x128_uint8.raw.gz", {256, 256, 128}, EWA_U8, 0, 255},
    {"tooth.nrrd", {103, 94, 161}, EWA_U8, 0, 255},
    {"mri_head_128.nrrd", {128, 128, 128}, EWA_U8, 0, 240},
    {"stent.nrrd", {128, 128, 256}, EWA_F32, 0, 1},
    {"neghip.mha", {70, 70, 70}, EWA_U8, 0, 255},
    {"HeadMRVolume.mhd", {48, 62, 42}, EWA_U8, 0, 255},
    {"headsq_64x64x93_uint16le.raw.gz", {64, 64, 93}, EWA_U16, 0, 3926},
    {"ironProt.vtk", {68, 68, 68}, EWA_U8, 0, 255},
    {"teem_fmob-c4h.nrrd", {32, 40, 16}, EWA_F32, 0.013749523860323675, 1.049265265249152},
    {"avg152T1_RL_nifti.nii.gz", {91, 109, 91}, EWA_U8, 0, 255},
    {"chris_MRA.nii.gz", {200, 256, 120}, EWA_U8, 0, 254},
    {"anatomical.nii", {33, 41, 25}, EWA_I16, -610, 30393},
    {"nrrd_variants/BallBinary30x30x30_bz2.nrrd", {30, 30, 30}, EWA_I16, 0, 257},
    {"nrrd_variants/test2d_ascii.nrrd", {3, 9, 1}, EWA_U16, 1, 27},
};

#endif
