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
if(SDL2_FOUND AND IMGUI_FOUND AND CMAKE_CXX_COMPILER)
  enable_language(CXX)
  set(EWA_HAS_WINDOW ON)
endif()
