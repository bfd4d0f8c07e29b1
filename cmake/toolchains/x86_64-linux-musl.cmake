# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# x86-64 with musl: a program for every Linux (make musl).
set(CMAKE_SYSTEM_PROCESSOR x86_64)
include("${CMAKE_CURRENT_LIST_DIR}/linux-musl.cmake")
