#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The public API as data: every function, struct, enumeration, callback and constant of include/ewa.

    dump_api.py           writes docs/api.json anew
    dump_api.py --check   fails when docs/api.json is not what the headers say

A change of docs/api.json is a change of the contract and needs a line in CHANGELOG.md.
"""
import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def squeeze(text):
    return re.sub(r"\s+", " ", text).strip()


def split_enumerators(body):
    return [squeeze(part) for part in body.split(",") if part.strip()]


def split_members(body):
    return [squeeze(part) for part in body.split(";") if part.strip()]


def read_header(path):
    text = path.read_text()
    text = re.sub(r"//[^\n]*", "", text)
    macros = dict(re.findall(r"^#define[ \t]+(EWA_[A-Z0-9_]+)[ \t]+(\S[^\n]*)$", text, re.M))
    macros.pop("EWA_API", None)  # how a symbol is exported, no part of the contract
    text = re.sub(r"^#.*$", "", text, flags=re.M)
    text = text.replace('extern "C" {', "").replace("EWA_API ", "")
    api = {"constants": macros, "enums": {}, "structs": {}, "callbacks": {}, "functions": {}, "tables": []}

    def take(pattern, store):
        nonlocal text
        for match in re.finditer(pattern, text):
            store(match)
        text = re.sub(pattern, "", text)

    def add_enum(match):
        api["enums"][match.group(2) or "anonymous"] = split_enumerators(match.group(1))

    def add_anonymous(match):
        api["enums"].setdefault("anonymous", []).extend(split_enumerators(match.group(1)))

    take(r"static inline[^{;]*\{(?:[^{}]|\{[^{}]*\})*\}", lambda match: None)
    take(r"typedef enum \w+ \{([^}]*)\} (\w+);", add_enum)
    take(r"enum \{([^}]*)\};", add_anonymous)
    take(r"typedef struct (\w+) \{([^}]*)\} \w+;",
         lambda match: api["structs"].update({match.group(1): split_members(match.group(2))}))
    take(r"typedef struct (\w+) \w+;", lambda match: api["structs"].update({match.group(1): "opaque"}))
    take(r"typedef ([^;{}()]*?\b(\w+)\([^;{}]*\));",
         lambda match: api["callbacks"].update({match.group(2): squeeze(match.group(1))}))
    take(r"([\w][\w \n*]*?\b(ewa_\w+)\([^;{}]*\));",
         lambda match: api["functions"].update({match.group(2): squeeze(match.group(1))}))
    take(r"extern const ewa_option_table (\w+);", lambda match: api["tables"].append(match.group(1)))
    rest = text.replace("}", "").strip()
    if rest:
        sys.exit(f"{path.name}: not understood: {squeeze(rest)[:200]}")
    return {kind: items for kind, items in api.items() if items}


def main():
    headers = sorted((ROOT / "include" / "ewa").glob("*.h"))
    api = {header.name: read_header(header) for header in headers}
    text = json.dumps(api, indent=1, sort_keys=True) + "\n"
    target = ROOT / "docs" / "api.json"
    if sys.argv[1:] == ["--check"]:
        if not target.exists() or target.read_text() != text:
            sys.exit("docs/api.json is not what the headers say: run tools/dump_api.py and add a line to CHANGELOG.md")
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        target.write_text(text)


main()
