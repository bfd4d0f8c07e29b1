# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# What Debian's packages give us: spng (PNG in), libdeflate (PNG out), OpenEXRCore (EXR), cJSON (camera
# files), pthreads.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET spng)
pkg_check_modules(DEFLATE REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(CJSON REQUIRED IMPORTED_TARGET libcjson)
find_package(OpenEXR CONFIG REQUIRED)

add_library(ewa_dependencies INTERFACE)
target_link_libraries(ewa_dependencies INTERFACE PkgConfig::SPNG PkgConfig::DEFLATE PkgConfig::CJSON
  OpenEXR::OpenEXRCore Threads::Threads m)
