# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Which compiler is for C++, should a part want it: the window, Draco.

# The same one for both languages: sanitizers do not mix.
if(CMAKE_C_COMPILER_ID MATCHES "Clang" AND NOT CMAKE_CXX_COMPILER AND NOT "$ENV{CXX}")
  find_program(EWA_CLANG_CXX NAMES ${CMAKE_C_COMPILER}++ clang++)
  if(EWA_CLANG_CXX)
    set(CMAKE_CXX_COMPILER ${EWA_CLANG_CXX})
  endif()
endif()
include(CheckLanguage)
check_language(CXX)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
