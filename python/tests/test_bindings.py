# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The bindings are what the headers say, and the structs lie in memory as the library's do."""
from __future__ import annotations

import ctypes
import inspect
import re
import shutil
import subprocess
import sys
import unittest

from common import ROOT, Case

import ewa
from ewa import _bindings as b
from ewa import _options, _struct
from ewa._options import OWN
from ewa._library import functions, library


class Bindings(Case):
    @unittest.skipUnless((ROOT / "tools" / "dump_python.py").exists(), "not in a checkout")
    def test_are_made_from_the_headers(self) -> None:
        done = subprocess.run([sys.executable, str(ROOT / "tools" / "dump_python.py"), "--check"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_options_lie_where_the_tables_say(self) -> None:
        for table in b.TABLES:
            rows = b.ewa_option_table.in_dll(library, table)
            struct = getattr(b, rows.name.decode())
            self.assertEqual(rows.struct_size, ctypes.sizeof(struct), table)
            for i in range(rows.option_count):
                row = rows.options[i]
                name = row.name.decode()
                self.assertEqual(row.offset, getattr(struct, name).offset, f"{table}: {name}")

    @unittest.skipUnless(shutil.which("cc") and (ROOT / "include").exists(), "no compiler, or not in a checkout")
    def test_structs_have_the_sizes_of_c(self) -> None:
        names = [name for name, kind in vars(b).items()
                 if isinstance(kind, type) and issubclass(kind, ctypes.Structure)]
        lines = ['#include "ewa/ewa.h"', "#include <stdio.h>", "int main(void) {"]
        for name in names:
            last = getattr(b, name)._fields_[-1][0]
            lines.append(f'printf("%zu %zu\\n", sizeof({name}), offsetof({name}, {last}));')
        with open(self.path("sizes.c"), "w", encoding="utf-8") as file:
            file.write("\n".join(lines + ["return 0; }"]))
        subprocess.run(["cc", "-I", str(ROOT / "include"), self.path("sizes.c"), "-o", self.path("sizes")], check=True)
        said = subprocess.run([self.path("sizes")], capture_output=True, text=True, check=True).stdout.split("\n")
        for name, line in zip(names, said):
            struct = getattr(b, name)
            ours = f"{ctypes.sizeof(struct)} {getattr(struct, struct._fields_[-1][0]).offset}"
            self.assertEqual(line, ours, name)

    def test_every_option_can_be_set(self) -> None:
        for table in b.TABLES:
            struct = table[:-len("_table")]
            for name, option in _struct.table(struct).items():
                made = getattr(b, struct)()
                value: object = option.words[-1] if option.kind == b.ewa_option_type.EWA_OPTION_CHOICE else (
                    True if option.kind == b.ewa_option_type.EWA_OPTION_BOOL else
                    int(option.words[-1]) if option.words else
                    max(1 if option.kind < b.ewa_option_type.EWA_OPTION_F32 else 0.5, option.low + option.low_open))
                if option.kind in (b.ewa_option_type.EWA_OPTION_U32, b.ewa_option_type.EWA_OPTION_U64) \
                        and not option.words:
                    value = int(value)  # type: ignore[call-overload]
                _struct.fill(made, struct, {name: [value] * option.length if option.length else value}, own=True)

    def test_keyword_arguments_are_known_and_told(self) -> None:
        """Completion and help() show every option of the library's tables with what these say."""
        calls = {ewa.render: ("ewa_render_options", "ewa_surfels_options"), ewa.Cloud.estimate: ("ewa_estimate_options",),
                 ewa.Context: ("ewa_context_options", "ewa_limits"), ewa.Scene: ("ewa_surfels_options",),
                 ewa.warp: ("ewa_warp_options",), ewa.Mesh.sample: ("ewa_mesh_sample_options",)}
        for call, structs in calls.items():
            shown, told = inspect.signature(call).parameters, inspect.getdoc(call) or ""
            self.assertNotIn("**", told)
            self.assertFalse([p for p in shown.values() if p.kind is p.VAR_KEYWORD])
            for struct in structs:
                for name, option in _struct.table(struct).items():
                    if name not in OWN.get(struct, ()):
                        self.assertIs(shown[name].kind, inspect.Parameter.KEYWORD_ONLY)
                        self.assertIn(f"\n{name} : ", told)
                        self.assertIn(option.help[1:30], " ".join(told.split()))

    def test_types_have_the_keyword_arguments(self) -> None:
        """Type checkers and editors read `**options: Unpack[...]` of the sources: it names what the calls take."""
        count = 0
        for module in [value for name, value in sys.modules.items() if name.startswith("ewa.")]:
            calls = [value for value in vars(module).values() if getattr(value, "__module__", "") == module.__name__]
            calls += [member for kind in calls if inspect.isclass(kind) for member in vars(kind).values()]
            for call in [call for call in calls if inspect.isfunction(call) and hasattr(call, "option_structs")]:
                said = " ".join(map(str, call.__annotations__.values()))
                [name] = re.findall(r"Unpack\[(\w+)\]", said)
                typed = getattr(module, name, None) or getattr(_options, name)
                code = call.__code__
                own = code.co_varnames[:code.co_argcount + code.co_kwonlyargcount]
                shown = {p.name for p in inspect.signature(call).parameters.values() if p.kind is not p.VAR_POSITIONAL}
                self.assertEqual(shown - set(own), set(typed.__annotations__), call)
                count += 1
        self.assertGreater(count, 20)

    def test_library_has_the_version_of_the_package(self) -> None:
        version = (functions.ewa_version() or b"").decode()
        self.assertEqual(version, f"{b.EWA_VERSION_MAJOR}.{b.EWA_VERSION_MINOR}.{b.EWA_VERSION_PATCH}")
        if (ROOT / "pyproject.toml").exists():
            self.assertIn(f'\nversion = "{version}"\n', (ROOT / "pyproject.toml").read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
