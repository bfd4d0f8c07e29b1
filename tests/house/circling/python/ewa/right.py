# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT


def right():
    from .left import left

    return left
