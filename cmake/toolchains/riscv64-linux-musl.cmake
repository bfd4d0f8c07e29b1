# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# 64-bit RISC-V with musl, which runs under qemu (make riscv64).
set(CMAKE_SYSTEM_PROCESSOR riscv64)
include("${CMAKE_CURRENT_LIST_DIR}/linux-musl.cmake")
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-riscv64-static)
