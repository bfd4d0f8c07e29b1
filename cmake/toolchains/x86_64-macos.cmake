# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# macOS on Intel's processors.
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(triple x86_64-macos)
include("${CMAKE_CURRENT_LIST_DIR}/macos.cmake")
