# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Kernels are written once (src/<room>/<name>_body.h) and compiled once per instruction set; only they get
# machine flags, and all that they include is static, so that none lends code to files without.
set(kernel_level -O3)
if(EWA_SANITIZE OR EWA_BUILD_FUZZERS)
  set(kernel_level -O1) # at -O3, the checks in the inlined bodies take minutes to compile
endif()
if(CMAKE_C_COMPILER_ID STREQUAL "GNU")
  # GCC does not see that an unrolled loop reads the columns that one before it has set. Clang, which does, stays on.
  list(APPEND kernel_level -Wno-maybe-uninitialized)
endif()
set(flags_portable -Wno-psabi)
if(EWA_BUILD_FUZZERS)
  # Fuzz targets are of readers; clang takes a quarter of an hour to put all checks into these.
  list(APPEND kernel_level -fno-sanitize=all)
  list(APPEND flags_portable -fno-sanitize=all)
endif()
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "wasm32") # which has no other set
  list(APPEND flags_portable -Os)
  if(EWA_RELAXED_SIMD)
    list(APPEND flags_portable -mrelaxed-simd)
    set_property(SOURCE src/base/context.c TARGET_DIRECTORY ewa_objects APPEND PROPERTY COMPILE_OPTIONS -mrelaxed-simd)
  endif()
endif()
set(flags_avx2 ${kernel_level} -mavx2 -mfma)
set(flags_avx512 ${kernel_level} -mavx512f -mavx512dq -mavx512bw -mavx512vl -mavx2 -mfma)
set(flags_neon ${kernel_level})
# Nothing is divided that is not asked for: whoever looks at the flags of floating point finds none of the library's.
set(flags_quiet "")
if(CMAKE_C_COMPILER_ID MATCHES "Clang" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(flags_quiet -ffp-exception-behavior=maytrap)
endif()
set(instruction_sets portable)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND instruction_sets avx2 avx512)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64|ARM64")
  list(APPEND instruction_sets neon)
endif()

# Those that take the longest come first.
foreach(body surface/pipeline_add_all surface/pipeline_add_material surface/pipeline_add_opacity surface/pipeline_add_normal
    surface/pipeline_add_color surface/pipeline adjoint/kernels adjoint/discs cloud/cells cloud/neighbours estimate/local homogeneous/clip_batch surface/groups surface/pack
    texture/texture volume/gaussian volume/kernels warp/warp)
  foreach(set ${instruction_sets})
    string(TOUPPER ${set} SET)
    set(source ${PROJECT_BINARY_DIR}/kernels/${body}_${set}.c)
    file(CONFIGURE OUTPUT ${source} CONTENT "#define WIDE_${SET}\n#include \"${body}_body.h\"\n")
    target_sources(ewa_objects PRIVATE ${source})
    set(flags ${flags_${set}})
    if(body STREQUAL "adjoint/discs")
      # Compilers make vectors of its loops where both sides of a choice may be computed. No number depends on it.
      list(APPEND flags -fno-trapping-math)
    endif()
    if(body STREQUAL "homogeneous/clip_batch")
      list(APPEND flags ${flags_quiet})
    endif()
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${flags}")
  endforeach()
endforeach()
