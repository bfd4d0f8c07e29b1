# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Installs into a scratch folder and builds the consumer against it, by find_package() and by pkg-config, C and C++,
# shared and static; runs each.
#
# cmake -DBUILD=build -DWORK=scratch -DCONSUMER=folder -DLIBDIR=lib -DCOMPILER=cc -DVERSION=x.y.z -P check_package.cmake
file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}/pc")

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${result}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(run_consumer program)
  run(${program})
  if(NOT output STREQUAL "ewa ${VERSION}\n")
    message(FATAL_ERROR "${program} printed '${output}'")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/cmake -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${WORK}/cmake)
foreach(kind ewa shared static)
  run_consumer(${WORK}/cmake/c_${kind})
  run_consumer(${WORK}/cmake/cpp_${kind})
endforeach()

# The tree may be moved: ewa.pc knows its place relative to itself.
file(RENAME ${WORK}/prefix ${WORK}/moved)
set(ENV{PKG_CONFIG_PATH} "${WORK}/moved/${LIBDIR}/pkgconfig:$ENV{PKG_CONFIG_PATH}")
run(pkg-config --modversion ewa)
if(NOT output STREQUAL "${VERSION}\n")
  message(FATAL_ERROR "pkg-config says version ${output}")
endif()
run(pkg-config --cflags --libs ewa)
separate_arguments(flags UNIX_COMMAND "${output}")
run(${COMPILER} -std=c17 -o ${WORK}/pc/shared ${CONSUMER}/consumer.c ${flags} -Wl,-rpath,${WORK}/moved/${LIBDIR})
run_consumer(${WORK}/pc/shared)
run(pkg-config --cflags --libs --static ewa)
string(REGEX REPLACE "-lewa( |\n)" "-l:libewa.a\\1" output "${output}")
separate_arguments(flags UNIX_COMMAND "${output}")
run(${COMPILER} -std=c17 -o ${WORK}/pc/static ${CONSUMER}/consumer.c ${flags})
run_consumer(${WORK}/pc/static)
