#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The public API as data: every function, struct, enumeration, callback and constant of include/ewa.

    dump_api.py           writes docs/api.json anew
    dump_api.py --check   fails when docs/api.json is not what the headers say, or when these say another range or
                          default of a member than the library's table of options (docs/options.json)

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


NUMBER = r"-?(?:inf|\d+(?:\.\d+)?(?:e-?\d+)?)"


def read_comments(path):
    """The comments of the members of each struct: before them, or behind them."""
    members = {}
    for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\n\} \w+;", path.read_text(), re.S):
        before, comment, declaration = [], [], ""
        for line in body.split("\n"):
            code, _, text = line.partition("//")
            declaration += code.strip() + " "
            if text.startswith("/<") and not declaration.strip():
                comment.append(text[2:])
            elif text.startswith("/<"):
                before.append(text[2:])
            elif text:
                before.append(text[1:])
            if ";" in declaration:
                comment = before
                for member in re.findall(r"(\w+)(?:\[[^]]*\])*\s*[,;]", declaration):
                    members[name, member] = comment
                before, declaration = [], ""
    return {key: squeeze(" ".join(comment)) for key, comment in members.items()}


def read_ranges(text):
    return [(r[0], *map(float, r[1:-1].split(",")), r[-1]) for r in re.findall(rf"[\[(]{NUMBER}, {NUMBER}[\])]", text)]


def check_comments(headers):
    """What the headers say otherwise than the tables of options."""
    comments, wrong, checked = {}, [], 0
    for header in headers:
        comments.update(read_comments(header))
    for struct, options in json.loads((ROOT / "docs" / "options.json").read_text()).items():
        for name, option in options.items():
            comment = comments.get((struct, name))
            if comment is None:
                wrong.append(f"{struct}.{name}: no such member")
                continue
            said, wanted = read_ranges(comment), read_ranges(option["range"])
            if said != wanted and (said or option["type"].startswith("f")) and "(-inf, inf)" != option["range"]:
                wrong.append(f"{struct}.{name}: the range is {option['range']}")
            first = option["default"][0] if isinstance(option["default"], list) else option["default"]
            for number, divisor in re.findall(rf"default ({NUMBER})(?:/(\d+))?", comment):
                checked += 1
                if abs(float(number) / float(divisor or 1) - first) > 1e-12 * abs(first):
                    wrong.append(f"{struct}.{name}: 'default {number}' is not {first:g}")
            checked += len(said)
    if wrong or checked < 50:
        sys.exit("\n".join(wrong) or f"only {checked} ranges and defaults found in the headers")


def main():
    headers = sorted((ROOT / "include" / "ewa").glob("*.h"))
    api = {header.name: read_header(header) for header in headers}
    text = json.dumps(api, indent=1, sort_keys=True) + "\n"
    target = ROOT / "docs" / "api.json"
    if sys.argv[1:] == ["--check"]:
        if not target.exists() or target.read_text() != text:
            sys.exit("docs/api.json is not what the headers say: run tools/dump_api.py and add a line to CHANGELOG.md")
        check_comments(headers)
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        target.write_text(text)


main()
