# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Renderers on graphics processors (src/gl) where libepoxy is found; drivers are looked for when they are used.
set(EWA_WITH_GL AUTO CACHE STRING "Build the renderers on graphics processors: AUTO (where libepoxy is found), OFF")
set_property(CACHE EWA_WITH_GL PROPERTY STRINGS AUTO OFF)
set(EWA_HAS_GL OFF)
if(NOT EWA_WITH_GL STREQUAL "OFF" AND NOT EWA_BUILD_FUZZERS)
  pkg_check_modules(EPOXY IMPORTED_TARGET epoxy)
  pkg_check_modules(EGL IMPORTED_TARGET egl) # its header
  if(EPOXY_FOUND AND EGL_FOUND)
    set(EWA_HAS_GL ON)
    list(APPEND EWA_STATIC_NEEDS PkgConfig::EPOXY ${CMAKE_DL_LIBS})
    list(APPEND EWA_STATIC_MODULES EPOXY=epoxy)
    string(APPEND EWA_PC_REQUIRES " epoxy")
    string(APPEND EWA_PC_LIBS " -ldl")
    string(APPEND EWA_PARTS " gl")
    target_link_libraries(ewa_dependencies INTERFACE PkgConfig::EPOXY ${CMAKE_DL_LIBS})
  endif()
endif()
