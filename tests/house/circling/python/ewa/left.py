# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT


def left():
    from .right import right

    return right
