# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Both libraries define nothing outside of the name space ewa_, and the shared one exactly what the headers declare.
#
# cmake -DNM=nm -DSHARED=libewa.so -DSTATIC=libewa.a -DROOT=source -P check_symbols.cmake
include(${CMAKE_CURRENT_LIST_DIR}/../../cmake/declared.cmake)
function(list_symbols result)
  execute_process(COMMAND ${NM} --defined-only --extern-only --format=posix ${ARGN} OUTPUT_VARIABLE text
    RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${NM} ${ARGN} failed")
  endif()
  string(REGEX MATCHALL "[^\n]+" lines "${text}")
  list(FILTER lines INCLUDE REGEX "^[^ ]+ [A-Z] ")
  # Inline functions of C++ headers are weak, in every archive that uses them; the linker keeps one of each.
  list(FILTER lines EXCLUDE REGEX "^(_Z|DW\\.ref\\.)[^ ]* [VW] ")
  list(TRANSFORM lines REPLACE " .*" "")
  set(${result} ${lines} PARENT_SCOPE)
endfunction()

list_symbols(exported --dynamic ${SHARED})
list_symbols(archived ${STATIC})
set(foreign ${exported} ${archived})
list(FILTER foreign EXCLUDE REGEX "^ewa_")
if(foreign)
  message(FATAL_ERROR "symbols outside of ewa_: ${foreign}")
endif()

ewa_declared(declared ${ROOT})
set(undeclared ${exported})
list(REMOVE_ITEM undeclared ${declared})
set(undefined ${declared})
list(REMOVE_ITEM undefined ${exported})
if(undeclared OR undefined)
  message(FATAL_ERROR "exported but in no header: ${undeclared}\ndeclared but not exported: ${undefined}")
endif()
list(LENGTH exported count)
message(STATUS "${count} functions and tables")
