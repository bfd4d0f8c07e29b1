# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# What Debian's packages give us: spng (PNG in), libdeflate (PNG out), OpenEXRCore (EXR), cJSON (camera
# files), libjpeg (JPEG in), Assimp (meshes in), pthreads.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET spng)
pkg_check_modules(DEFLATE REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(CJSON REQUIRED IMPORTED_TARGET libcjson)
pkg_check_modules(JPEG REQUIRED IMPORTED_TARGET libjpeg)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp>=5.0)
find_package(OpenEXR CONFIG REQUIRED)

add_library(ewa_dependencies INTERFACE)
target_link_libraries(ewa_dependencies INTERFACE PkgConfig::SPNG PkgConfig::DEFLATE PkgConfig::CJSON
  PkgConfig::JPEG PkgConfig::ASSIMP OpenEXR::OpenEXRCore Threads::Threads m)
