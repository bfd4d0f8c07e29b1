# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# What Debian's packages give us: spng (PNG in), libdeflate (PNG out), OpenEXRCore (EXR), cJSON (camera
# files, glTF), libjpeg (JPEG in), libwebp (WebP in), expat (E57), CHOLMOD of SuiteSparse (sparse factors), zlib and
# libbz2 (volumes in), libzstd (EPT), pthreads.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET spng)
pkg_check_modules(DEFLATE REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(CJSON REQUIRED IMPORTED_TARGET libcjson)
pkg_check_modules(JPEG REQUIRED IMPORTED_TARGET libjpeg)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(EXPAT REQUIRED IMPORTED_TARGET expat)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
find_package(OpenEXR CONFIG REQUIRED)

# These two come without a pkg-config file.
function(ewa_find_library target header library)
  find_path(${target}_INCLUDE ${header} PATH_SUFFIXES ${ARGN} REQUIRED)
  find_library(${target}_LIBRARY ${library} REQUIRED)
  add_library(${target} INTERFACE)
  target_include_directories(${target} SYSTEM INTERFACE ${${target}_INCLUDE})
  target_link_libraries(${target} INTERFACE ${${target}_LIBRARY})
endfunction()
ewa_find_library(ewa_cholmod cholmod.h cholmod suitesparse)
ewa_find_library(ewa_bzip2 bzlib.h bz2)

add_library(ewa_dependencies INTERFACE)
target_link_libraries(ewa_dependencies INTERFACE PkgConfig::SPNG PkgConfig::DEFLATE PkgConfig::CJSON
  PkgConfig::JPEG PkgConfig::WEBP PkgConfig::EXPAT PkgConfig::ZLIB PkgConfig::ZSTD ewa_cholmod ewa_bzip2 OpenEXR::OpenEXRCore Threads::Threads m)
