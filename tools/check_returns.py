#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Whether functions of the library hand on a failure in the one way that docs/conventions.md names (Failures).

    check_returns.py [ROOT]

Read is src/. Fails, and lists,

- "if (status != EWA_OK) return status;": that is EWA_TRY(status), or of a call before it EWA_TRY(call);
- chains of "if (status == EWA_OK) status = ..." from the declaration of status to its return, with nothing to give back
  behind them: these are calls in EWA_TRY.
"""
import re
import sys
from pathlib import Path

HANDED_ON = re.compile(r"if \((\w*[a-z]) != EWA_OK\)\s+return \1;")  # but the macro itself
STEP = r"(?:\s*if \(status == EWA_OK(?: && [^;{}]*?)?\)\s+status\s+=[^;{}]*;|\s*//[^\n]*)"
CHAIN = re.compile(r"\n *(?:const )?ewa_status status\s+=[^;{}]*;" + STEP + r"+\s*return status;")


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent).resolve()
    found = []
    for path in sorted([*(root / "src").rglob("*.[ch]"), *(root / "src").rglob("*.cpp")]):
        text = path.read_text()
        for pattern, what in ((HANDED_ON, "handed on without EWA_TRY"), (CHAIN, "a chain that gives nothing back")):
            for match in pattern.finditer(text):
                line = text.count("\n", 0, match.start() + (match.group()[0] == "\n")) + 1
                found.append(f"{path.relative_to(root)}:{line}: {what}")
    for line in found:
        print(line)
    if not found:
        print("failures are handed on in one way")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
