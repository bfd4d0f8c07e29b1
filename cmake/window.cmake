# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# What the window of `ewa view` needs: SDL2, and Dear ImGui, which is C++. EWA_HAS_WINDOW says whether it is all there.
# Only viewer/sdl uses it; the language is enabled here because CMake wants it for the whole tree.
set(EWA_WITH_WINDOW AUTO CACHE STRING "Build the window of 'ewa view': AUTO (where SDL2, Dear ImGui and a C++ compiler are found), OFF")
set_property(CACHE EWA_WITH_WINDOW PROPERTY STRINGS AUTO OFF)
set(EWA_HAS_WINDOW OFF)
if(EWA_WITH_WINDOW STREQUAL "OFF" OR NOT EWA_BUILD_CLI OR EWA_BUILD_FUZZERS)
  return()
endif()
pkg_check_modules(SDL2 IMPORTED_TARGET sdl2>=2.26)
# Later versions take events in another way.
pkg_check_modules(IMGUI IMPORTED_TARGET imgui>=1.86 imgui<1.87)
# The same compiler for both languages: sanitizers do not mix.
if(CMAKE_C_COMPILER_ID MATCHES "Clang" AND NOT CMAKE_CXX_COMPILER AND NOT "$ENV{CXX}")
  find_program(EWA_CLANG_CXX NAMES ${CMAKE_C_COMPILER}++ clang++)
  if(EWA_CLANG_CXX)
    set(CMAKE_CXX_COMPILER ${EWA_CLANG_CXX})
  endif()
endif()
include(CheckLanguage)
check_language(CXX)
if(SDL2_FOUND AND IMGUI_FOUND AND CMAKE_CXX_COMPILER)
  enable_language(CXX)
  set(CMAKE_CXX_STANDARD 17)
  set(CMAKE_CXX_STANDARD_REQUIRED ON)
  set(CMAKE_CXX_EXTENSIONS OFF)
  set(EWA_HAS_WINDOW ON)
endif()
