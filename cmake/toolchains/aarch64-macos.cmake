# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# macOS on Apple's processors.
set(CMAKE_SYSTEM_PROCESSOR arm64)
set(triple aarch64-macos)
include("${CMAKE_CURRENT_LIST_DIR}/macos.cmake")
