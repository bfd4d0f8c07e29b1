# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# ewa_declared(RESULT FOLDER): the functions that the public headers in include/ewa of FOLDER declare.
function(ewa_declared result folder)
  set(declared "")
  file(GLOB headers "${folder}/include/ewa/*.h")
  foreach(header IN LISTS headers)
    file(READ ${header} text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REPLACE ";" "(" text "${text}") # tables end so
    string(REGEX MATCHALL "EWA_API[^({]*[ *]ewa_[a-z0-9_]+\\(" found "${text}")
    list(TRANSFORM found REPLACE ".*[ *](ewa_[a-z0-9_]+)\\(" "\\1")
    list(APPEND declared ${found})
  endforeach()
  set(${result} ${declared} PARENT_SCOPE)
endfunction()
