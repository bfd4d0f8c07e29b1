# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# What Debian's packages give us: spng (PNG in), libdeflate (PNG out), OpenEXRCore (EXR), cJSON (camera
# files, glTF), libjpeg (JPEG), libwebp (WebP in), libtiff (GeoTIFF), expat (E57), CHOLMOD of SuiteSparse (sparse factors), zlib and
# libbz2 (volumes in), libzstd (EPT), meshoptimizer and Draco (glTF), pthreads.
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
ewa_find_library(ewa_bzip2 bzlib.h bz2)
# Without it there are no factors, and every system of equations is solved by conjugate gradients (docs/colors.md).
option(EWA_WITH_CHOLMOD "Solve small systems by the factors of CHOLMOD, which Debian builds with parts under the GPL" ON)
set(EWA_CHOLMOD_INSTALLED "") # what a static library needs, as CMake and pkg-config say it
set(EWA_CHOLMOD_PC_LIBS "")
set(EWA_CHOLMOD_TARGET "")
if(EWA_WITH_CHOLMOD)
  ewa_find_library(ewa_cholmod cholmod.h cholmod suitesparse)
  set(EWA_CHOLMOD_INSTALLED "cholmod;")
  set(EWA_CHOLMOD_PC_LIBS "-lcholmod ")
  set(EWA_CHOLMOD_TARGET ewa_cholmod)
endif()

option(EWA_WITH_TIFF "Read GeoTIFF of heights by libtiff" ON)
set(EWA_HAS_TIFF OFF)
set(EWA_TIFF_INSTALLED "")
set(EWA_TIFF_PC "")
set(EWA_TIFF_TARGET "")
if(EWA_WITH_TIFF)
  pkg_check_modules(TIFF REQUIRED IMPORTED_TARGET libtiff-4>=4.5)
  set(EWA_HAS_TIFF ON)
  set(EWA_TIFF_INSTALLED "PkgConfig::TIFF;")
  set(EWA_TIFF_PC " libtiff-4")
  set(EWA_TIFF_TARGET PkgConfig::TIFF)
endif()

# glTF's two kinds of packed meshes. Draco is C++: its one source here needs a compiler for it, and its library libstdc++.
option(EWA_WITH_MESHOPT "Read glTF that meshoptimizer has packed" ON)
option(EWA_WITH_DRACO "Read glTF that Draco has packed" ON)
set(EWA_PACKED_INSTALLED "")
set(EWA_PACKED_PC_LIBS "")
set(EWA_PACKED_TARGETS "")
if(EWA_WITH_MESHOPT)
  ewa_find_library(ewa_meshopt meshoptimizer.h meshoptimizer)
  string(APPEND EWA_PACKED_INSTALLED "meshoptimizer;")
  string(APPEND EWA_PACKED_PC_LIBS "-lmeshoptimizer ")
  list(APPEND EWA_PACKED_TARGETS ewa_meshopt)
endif()
if(EWA_WITH_DRACO)
  enable_language(CXX)
  ewa_find_library(ewa_draco draco/compression/decode.h draco)
  target_link_libraries(ewa_draco INTERFACE stdc++)
  string(APPEND EWA_PACKED_INSTALLED "draco;stdc++;")
  string(APPEND EWA_PACKED_PC_LIBS "-ldraco -lstdc++ ")
  list(APPEND EWA_PACKED_TARGETS ewa_draco)
endif()

add_library(ewa_dependencies INTERFACE)
target_link_libraries(ewa_dependencies INTERFACE PkgConfig::SPNG PkgConfig::DEFLATE PkgConfig::CJSON
  PkgConfig::JPEG PkgConfig::WEBP ${EWA_TIFF_TARGET} PkgConfig::EXPAT PkgConfig::ZLIB PkgConfig::ZSTD ${EWA_CHOLMOD_TARGET} ${EWA_PACKED_TARGETS} ewa_bzip2 OpenEXR::OpenEXRCore Threads::Threads m)
