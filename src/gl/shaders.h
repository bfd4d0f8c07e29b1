// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// The sources of src/gl/shaders, which the build makes into strings.
#ifndef EWA_SRC_GL_SHADERS_H
#define EWA_SRC_GL_SHADERS_H

extern const char ewa_shader_average[], ewa_shader_band[], ewa_shader_codes[], ewa_shader_cull[], ewa_shader_divide[], ewa_shader_edges[],
    ewa_shader_eye_dome[], ewa_shader_fill[], ewa_shader_gaussian_draw[], ewa_shader_gaussian_frame[], ewa_shader_gaussian_list[],
    ewa_shader_gaussian_project[], ewa_shader_masks[], ewa_shader_packet[], ewa_shader_passes[], ewa_shader_raster_cover[],
    ewa_shader_raster_lines[], ewa_shader_raster_near[], ewa_shader_raster_payload[],
    ewa_shader_raster_project[], ewa_shader_raster_scene[], ewa_shader_raster_splat[],
    ewa_shader_raster_surface[], ewa_shader_raster_vertex[], ewa_shader_scan[], ewa_shader_scene[], ewa_shader_selftest[],
    ewa_shader_setup[], ewa_shader_share_below[], ewa_shader_sort[], ewa_shader_splat[], ewa_shader_sums[], ewa_shader_surface[], ewa_shader_volume_buckets[],
    ewa_shader_volume_draw[], ewa_shader_volume_place[], ewa_shader_volume_scene[], ewa_shader_volume_sort[], ewa_shader_wide[];

#endif
