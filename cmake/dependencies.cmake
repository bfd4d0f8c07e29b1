# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# What Debian's packages give us, each of which can be left out: a library without it says so when it is asked for
# (docs/install.md). What a static library needs besides is collected as CMake, pkg-config and linkers say it.
find_package(PkgConfig REQUIRED)
add_library(ewa_dependencies INTERFACE)
set(EWA_PARTS "")          # of `ewa --version`
set(EWA_STATIC_NEEDS "")   # targets
set(EWA_STATIC_MODULES "") # PREFIX=module of pkg-config
set(EWA_PC_REQUIRES "")
set(EWA_PC_LIBS "")

# ewa_part(SWITCH TEXT): the option EWA_WITH_SWITCH.
macro(ewa_part switch text)
  option(EWA_WITH_${switch} "${text}" ON)
  if(EWA_WITH_${switch})
    string(TOLOWER ${switch} part)
    string(APPEND EWA_PARTS " ${part}")
  endif()
endmacro()

# ewa_module(SWITCH MODULE TEXT): the same for what pkg-config finds.
macro(ewa_module switch module text)
  ewa_part(${switch} "${text}")
  if(EWA_WITH_${switch})
    pkg_check_modules(${switch} REQUIRED IMPORTED_TARGET ${module})
    target_link_libraries(ewa_dependencies INTERFACE PkgConfig::${switch})
    list(APPEND EWA_STATIC_NEEDS PkgConfig::${switch})
    list(APPEND EWA_STATIC_MODULES ${switch}=${module})
    string(REGEX REPLACE "[<>=].*" "" name ${module})
    string(APPEND EWA_PC_REQUIRES " ${name}")
  endif()
endmacro()

# ewa_library(SWITCH HEADER LIBRARY TEXT [FOLDER]): the same for what comes without a pkg-config file.
macro(ewa_library switch header library text)
  ewa_part(${switch} "${text}")
  if(EWA_WITH_${switch})
    find_path(ewa_${library}_INCLUDE ${header} PATH_SUFFIXES ${ARGN} REQUIRED)
    find_library(ewa_${library}_LIBRARY ${library} REQUIRED)
    add_library(ewa_${library} INTERFACE)
    target_include_directories(ewa_${library} SYSTEM INTERFACE ${ewa_${library}_INCLUDE})
    target_link_libraries(ewa_${library} INTERFACE ${ewa_${library}_LIBRARY})
    target_link_libraries(ewa_dependencies INTERFACE ewa_${library})
    list(APPEND EWA_STATIC_NEEDS ${library})
    string(APPEND EWA_PC_LIBS " -l${library}")
  endif()
endmacro()

ewa_module(SPNG spng "Read PNG by libspng")
ewa_module(DEFLATE libdeflate "Compress PNG, NRRD, SPZ and levels, and unpack levels and SOG, by libdeflate; else they are written uncompressed")
ewa_module(CJSON libcjson "Cameras, scenes, glTF, EPT and SOG, which are JSON, by cJSON")
ewa_module(JPEG libjpeg "Read and write JPEG by libjpeg")
ewa_module(WEBP libwebp "Read WebP by libwebp")
ewa_module(TIFF libtiff-4>=4.5 "Read GeoTIFF of heights by libtiff")
ewa_module(E57 expat "Read E57, whose head is XML, by expat")
ewa_module(ZLIB zlib "Read gzip (volumes, SPZ) by zlib")
ewa_module(ZSTD libzstd "EPT and SPZ in zstandard, by libzstd")
ewa_library(BZIP2 bzlib.h bz2 "Read volumes in bzip2 by libbz2")
# Without it there are no factors, and every system of equations is solved by conjugate gradients (docs/colors.md).
ewa_library(CHOLMOD cholmod.h cholmod "Solve small systems by the factors of CHOLMOD, which Debian builds with parts under the GPL" suitesparse)
# glTF's two kinds of packed meshes. Draco is C++: its one source here needs a compiler for it, and its library libstdc++.
ewa_library(MESHOPT meshoptimizer.h meshoptimizer "Read glTF that meshoptimizer has packed")
ewa_library(DRACO draco/compression/decode.h draco "Read glTF that Draco has packed")
if(EWA_WITH_DRACO)
  enable_language(CXX)
  target_link_libraries(ewa_dependencies INTERFACE stdc++)
  list(APPEND EWA_STATIC_NEEDS stdc++)
  string(APPEND EWA_PC_LIBS " -lstdc++")
endif()
# Loaded when a server is asked for the first time (src/io/http.c), so only its headers are needed.
ewa_part(CURL "Files on servers (http, https), read part by part, by libcurl")
if(EWA_WITH_CURL)
  pkg_check_modules(CURL REQUIRED libcurl>=7.85)
  target_include_directories(ewa_dependencies SYSTEM INTERFACE $<BUILD_INTERFACE:${CURL_INCLUDE_DIRS}>)
endif()
ewa_part(EXR "Read and write OpenEXR")
if(EWA_WITH_EXR)
  find_package(OpenEXR CONFIG REQUIRED)
  target_link_libraries(ewa_dependencies INTERFACE OpenEXR::OpenEXRCore)
  list(APPEND EWA_STATIC_NEEDS OpenEXR::OpenEXRCore)
  string(APPEND EWA_PC_REQUIRES " OpenEXR")
endif()
ewa_part(THREADS "Threads of its own (pthreads); without them a caller's executor has some")
if(EWA_WITH_THREADS)
  find_package(Threads REQUIRED)
  target_link_libraries(ewa_dependencies INTERFACE Threads::Threads)
  list(APPEND EWA_STATIC_NEEDS Threads::Threads)
  string(APPEND EWA_PC_LIBS " -pthread")
endif()
ewa_part(MMAP "Map files into memory; else they are read")
if(NOT EWA_WITH_CJSON)
  target_include_directories(ewa_dependencies SYSTEM INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src/io/no_cjson>)
endif()
target_link_libraries(ewa_dependencies INTERFACE m)
list(APPEND EWA_STATIC_NEEDS m)
string(APPEND EWA_PC_LIBS " -lm")
string(STRIP "${EWA_PARTS}" EWA_PARTS)

# Puts those libraries first that look up the most symbols when a program starts: the loader looks through all before the one
# that has it. It takes a quarter fewer instructions until main().
function(ewa_order_dependencies)
  get_target_property(needs ewa_dependencies INTERFACE_LINK_LIBRARIES)
  foreach(library IN ITEMS stdc++ ewa_draco PkgConfig::EPOXY) # the last becomes the first
    if(library IN_LIST needs)
      list(REMOVE_ITEM needs ${library})
      list(PREPEND needs ${library})
    endif()
  endforeach()
  set_target_properties(ewa_dependencies PROPERTIES INTERFACE_LINK_LIBRARIES "${needs}")
endfunction()
