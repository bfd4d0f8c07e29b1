# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Renderers on graphics processors (src/gl) where libepoxy is found; drivers are looked for when they are used.
set(EWA_WITH_GL AUTO CACHE STRING "Build the renderers on graphics processors: AUTO (where libepoxy is found), OFF")
set_property(CACHE EWA_WITH_GL PROPERTY STRINGS AUTO OFF)
set(EWA_HAS_GL OFF)
set(EWA_GL_INSTALLED "") # what a static library needs, as CMake, pkg-config and linkers say it
set(EWA_GL_PC "")
set(EWA_GL_PC_LIBS "")
if(NOT EWA_WITH_GL STREQUAL "OFF" AND NOT EWA_BUILD_FUZZERS)
  pkg_check_modules(EPOXY IMPORTED_TARGET epoxy)
  pkg_check_modules(EGL IMPORTED_TARGET egl) # its header
  if(EPOXY_FOUND AND EGL_FOUND)
    set(EWA_HAS_GL ON)
    set(EWA_GL_INSTALLED "PkgConfig::EPOXY;${CMAKE_DL_LIBS};")
    set(EWA_GL_PC " epoxy")
    set(EWA_GL_PC_LIBS " -ldl")
    target_link_libraries(ewa_dependencies INTERFACE PkgConfig::EPOXY ${CMAKE_DL_LIBS})
  endif()
endif()
