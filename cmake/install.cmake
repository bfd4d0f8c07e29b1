# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# What `cmake --install` puts down: both libraries, the headers, ewa.pc, the CMake package, the licence.
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ewa)
foreach(kind shared static)
  install(TARGETS ewa_${kind} EXPORT ewa_${kind}_targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}) # a DLL
  install(EXPORT ewa_${kind}_targets NAMESPACE ewa:: DESTINATION ${package_dir} FILE ewa-${kind}-targets.cmake)
endforeach()
install(DIRECTORY include/ewa DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

configure_package_config_file(cmake/ewa-config.cmake.in ${PROJECT_BINARY_DIR}/ewa-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ewa-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ewa-config.cmake ${PROJECT_BINARY_DIR}/ewa-config-version.cmake
  DESTINATION ${package_dir})

if(NOT SKBUILD) # whose package names its licence
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()

# A wheel has the shared library in its package (pyproject.toml).
if(SKBUILD)
  install(TARGETS ewa_shared LIBRARY DESTINATION ewa COMPONENT python RUNTIME DESTINATION ewa COMPONENT python)
endif()

# ewa.pc finds its prefix from its own place, so that the tree may be moved.
set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}/${pc_dir}
  OUTPUT_VARIABLE prefix_from_pc)
configure_file(cmake/ewa.pc.in ${PROJECT_BINARY_DIR}/ewa.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/ewa.pc DESTINATION ${pc_dir})
