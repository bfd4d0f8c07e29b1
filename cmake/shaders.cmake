# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# The library carries the shaders of src/gl as text: each becomes <name>.c in the build folder, a string ewa_shader_<name>.
if(NOT EWA_HAS_GL)
  return()
endif()
foreach(name average band codes cull divide edges eye_dome fill gaussian_draw gaussian_frame gaussian_list gaussian_project masks packet passes raster_cover raster_lines raster_near raster_payload raster_project raster_scene
    raster_splat raster_surface raster_vertex scan scene selftest setup share_below sort splat sums surface volume_buckets volume_draw volume_place volume_scene volume_sort wide)
  set(source ${PROJECT_SOURCE_DIR}/src/gl/shaders/${name}.glsl)
  set(made ${PROJECT_BINARY_DIR}/shaders/${name}.c)
  add_custom_command(OUTPUT ${made}
    COMMAND ${CMAKE_COMMAND} -DNAME=${name} -DSOURCE=${source} -DMADE=${made}
            -P ${PROJECT_SOURCE_DIR}/cmake/shader.cmake
    DEPENDS ${source} ${PROJECT_SOURCE_DIR}/cmake/shader.cmake VERBATIM)
  target_sources(ewa_objects PRIVATE ${made})
endforeach()
