# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Installs into a scratch folder and builds the consumer against it, by find_package() and by pkg-config, C and C++,
# shared and static; runs each. Looks for the other installed files.
#
# cmake -DBUILD=build -DWORK=scratch -DCONSUMER=folder -DLIBDIR=lib -DCOMPILER=cc -DVERSION=x.y.z
#   [-DALSO="path of an installed file;..."] -P check_package.cmake
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

# What is no part of the library: pages of the manual and completion by the program's tables, the desktop's files, the licence.
foreach(path share/man/man1/ewa.1 share/man/man1/ewa-render.1 share/man/man1/ewa-bench.1 share/bash-completion/completions/ewa
    share/zsh/site-functions/_ewa share/fish/vendor_completions.d/ewa.fish share/doc/ewa/LICENSE ${ALSO})
  file(SIZE ${WORK}/prefix/${path} bytes)
  if(bytes LESS 500)
    message(FATAL_ERROR "${path}: ${bytes} bytes")
  endif()
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
