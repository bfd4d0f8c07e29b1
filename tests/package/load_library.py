# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Opens the library of a package by its bindings alone, where numpy is not to be had, and makes a context:

  load_library.py FOLDER_OF_THE_PACKAGE
"""
from __future__ import annotations

import ctypes
import importlib.util
import sys
from pathlib import Path

package = Path(sys.argv[1])
found = importlib.util.spec_from_file_location("bindings", package / "_bindings.py")
assert found and found.loader
b = importlib.util.module_from_spec(found)
found.loader.exec_module(b)
library = next(path for path in package.iterdir() if path.suffix in (".so", ".dylib", ".dll"))
functions = b.Functions(ctypes.CDLL(str(library)))  # fails where a function is missing
context = ctypes.c_void_p()
assert functions.ewa_context_create(None, ctypes.byref(context)) == 0
print(f"Python {sys.version.split()[0]}, ewa {functions.ewa_version().decode()} of {library}: opened, a context made")
functions.ewa_context_destroy(ctypes.byref(context))
