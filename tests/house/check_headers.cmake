# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Every public header compiles alone, twice, as C17 and as C++17, without a warning; every inner header as C17.
#
# cmake -DROOT=source -DWORK=scratch -DCOMPILER=cc -P check_headers.cmake
file(MAKE_DIRECTORY "${WORK}")
file(GLOB public RELATIVE "${ROOT}/include" "${ROOT}/include/ewa/*.h")
file(GLOB_RECURSE inner RELATIVE "${ROOT}/src" "${ROOT}/src/*.h")
# Bodies that are compiled once per instruction set, their parts and their wide types are no headers of their own.
list(FILTER inner EXCLUDE REGEX "(_body|/wide[a-z0-9_]*)\\.h$")
set(wrong "")

function(compile header language)
  string(REPLACE "/" "_" name "${header}")
  if(language STREQUAL "c++")
    set(source "${WORK}/${name}.cpp")
  else()
    set(source "${WORK}/${name}.c")
  endif()
  file(WRITE "${source}" "#include \"${header}\"\n#include \"${header}\"\nint ewa_unit_is_not_empty;\n")
  execute_process(COMMAND ${COMPILER} -fsyntax-only -x ${language} ${ARGN} -I${ROOT}/include "${source}"
    ERROR_VARIABLE message RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    set(wrong "${wrong}${header} as ${language}:\n${message}" PARENT_SCOPE)
  endif()
endfunction()

foreach(header IN LISTS public)
  compile(${header} c -std=c17 -Wall -Wextra -pedantic -Werror)
  compile(${header} c++ -std=c++17 -Wall -Wextra -pedantic -Werror)
endforeach()
foreach(header IN LISTS inner)
  file(READ "${ROOT}/src/${header}" text LIMIT 400)
  if(text MATCHES "\n// Part of ")
    continue()
  endif()
  compile(${header} c -std=c17 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wno-unused-function -Werror -I${ROOT}/src)
endforeach()
if(NOT public)
  message(FATAL_ERROR "no headers under ${ROOT}/include/ewa")
endif()
if(wrong)
  message(FATAL_ERROR "${wrong}")
endif()
