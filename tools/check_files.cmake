# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Fails for sources without the two SPDX lines and a head comment, and for sources of more than 1,500 lines; names
# those of more than 600. Fails where the library writes numbers as the locale has them. Fails for packages of others and for files of more than 1 MiB beside the sources.
#
# cmake -DROOT=folder -P check_files.cmake
file(GLOB_RECURSE files RELATIVE "${ROOT}" "${ROOT}/include/*.h" "${ROOT}/src/*.[ch]" "${ROOT}/src/*.cpp" "${ROOT}/cli/*.[ch]"
  "${ROOT}/examples/*.[ch]" "${ROOT}/tests/*.[ch]" "${ROOT}/bench/*.[ch]" "${ROOT}/scenes/*.[ch]" "${ROOT}/import/*.[ch]"
  "${ROOT}/viewer/*.[ch]" "${ROOT}/viewer/*.cpp")
set(wrong "")
foreach(path IN LISTS files)
  file(READ "${ROOT}/${path}" text)
  if(NOT text MATCHES "^// SPDX-FileCopyrightText: [^\n]*\n// SPDX-License-Identifier: MIT\n//\n// ")
    string(APPEND wrong "${path}: no SPDX lines followed by a head comment\n")
  endif()
  if(path MATCHES "^src/" AND NOT path MATCHES "^src/base/format[.]" AND text MATCHES "vsnprintf\\(|[^_]snprintf\\([^;]*%[0-9.]*[gefGEF][^a-z]")
    string(APPEND wrong "${path}: numbers by snprintf(), which writes a comma in some locales; ewa_format() does not\n")
  endif()
  string(REGEX REPLACE "[^\n]+" "" line_feeds "${text}")
  string(LENGTH "${line_feeds}" lines)
  if(lines GREATER 1500)
    string(APPEND wrong "${path}: ${lines} lines\n")
  elseif(lines GREATER 600)
    message(STATUS "${path}: ${lines} lines")
  endif()
endforeach()
file(GLOB strays RELATIVE "${ROOT}" "${ROOT}/*" "${ROOT}/python/*" "${ROOT}/docs/*" "${ROOT}/docs/gallery/*")
foreach(path IN LISTS strays)
  if(IS_DIRECTORY "${ROOT}/${path}")
    continue()
  endif()
  file(SIZE "${ROOT}/${path}" size_bytes)
  if(path MATCHES "\\.(whl|zip|tar|gz|tgz|deb|so|a)$")
    string(APPEND wrong "${path}: a package or a library\n")
  elseif(size_bytes GREATER 1048576)
    string(APPEND wrong "${path}: ${size_bytes} bytes\n")
  endif()
endforeach()
if(wrong)
  message(FATAL_ERROR "${wrong}")
endif()
list(LENGTH files count)
message(STATUS "${count} files")
