# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The reference of the interface in C as pages, a page a header: what docs/api.json lists, as the headers comment it."""
import json
import re

STATEMENT_NAMES = (r"^#define (EWA_\w+)", r"^typedef (?:struct|enum|union) (\w+)", r"^typedef [^;{]*?\b(ewa_\w+)\(",
                   r"\b(ewa_\w+)\(", r"\b(ewa_\w+);")


def statements(text):
    """(comment, code) of each declaration of a header, in order; what stands in lines without a gap is one."""
    body = text.split("_H\n", 2)[2]  # behind its guard
    body = re.sub(r"#ifdef __cplusplus\n[^#]*#endif\n?|#define EWA_API.*\n", "", body)
    found, comment, code, depth = [], [], [], 0

    def flush():
        if code:
            found.append(("\n".join(comment), "\n".join(code)))
        comment.clear(), code.clear()

    for line in body.split("\n"):
        if not depth and not line.strip():
            flush()
        elif not depth and line.startswith("//"):
            if code and not code[-1].endswith("\\"):
                flush()
            comment.append(line.lstrip("/").strip())
        elif depth or not re.match(r"#(?:include|ifndef|ifdef|if|else|elif|endif)\b", line):
            code.append(line)
            stripped = line.split("//")[0]
            depth += stripped.count("{") + stripped.count("(") - stripped.count("}") - stripped.count(")")
    flush()
    return [(comment, code.replace("EWA_API ", "")) for comment, code in found]


def names_of(code):
    """What a declaration declares; enumerators without a type are told by their own names."""
    names = []
    for line in code.split("\n"):
        for pattern in STATEMENT_NAMES:
            match = re.search(pattern, line.split("//")[0])
            if match and not line.startswith((" ", "}")):
                names.append(match.group(1))
                break
    return names or re.findall(r"\bEWA_\w+", code)[:1]


def escape(words):
    """Text of a comment as Markdown, but for what it marks as code."""
    return re.sub(r"([\\*_<>\[\]#|])", r"\\\1", words)


def prose(comment, homes, here):
    """A comment with pages, and names of the interface, linked to where they are told."""
    def link(match):
        name, rest = match.group(1), match.group(2) or ""
        home = homes.get(name)
        return f"[`{name}{rest}`]({'' if home == here else home + '.md'}#{name})" if home else f"`{name}{rest}`"

    parts = re.split(r"(`[^`]*`)", comment)
    for i in range(0, len(parts), 2):
        words = re.split(r"((?<!\w)(?:ewa_\w+|EWA_\w+)(?:\(\)|\.\w+)?|docs/\w+\.md)", parts[i])
        for j in range(0, len(words), 2):
            words[j] = escape(words[j])
        for j in range(1, len(words), 2):
            words[j] = re.sub(r"^docs/(\w+\.md)$", r"[\1](../\1)", re.sub(r"^(\w+)(\(\)|\.\w+)?$", link, words[j]))
        parts[i] = "".join(words)
    return "".join(parts)


def write(root, folder):
    """Writes the pages; returns their names, and what of docs/api.json is on none."""
    listed = json.loads((root / "docs/api.json").read_text())
    headers = {name.removesuffix(".h"): (root / "include/ewa" / name).read_text() for name in sorted(listed)}
    read = {name: statements(text) for name, text in headers.items()}
    homes = {told: name for name, found in read.items() for _, code in found for told in names_of(code)}
    folder.mkdir(parents=True)
    for name, found in read.items():
        head = re.match(r"// SPDX[^\n]*\n// SPDX[^\n]*\n//\n((?://[^\n]*\n)+)", headers[name])
        said = re.sub(r"(?m)^// ?", "", head.group(1)) if head else ""
        lines = [f"# ewa/{name}.h", "", prose(said.strip(), homes, name), ""]
        for comment, code in found:
            told = names_of(code)
            if not told:
                continue
            lines += [f"## {told[0]} {{#{told[0]}}}", ""]
            lines += ["".join(f'<a id="{other}"></a>' for other in told[1:]), ""] if told[1:] else []
            lines += ["```c", code, "```", "", prose(comment, homes, name), ""]
        (folder / f"{name}.md").write_text("\n".join(lines))
    index = ["# Interface in C", "", "Every header of `include/ewa`; `#include <ewa/ewa.h>` has them all.", "",
             "| header | what |", "|---|---|"]
    for name in read:
        text = (folder / f"{name}.md").read_text().split("\n\n")[1]
        index.append(f"| [{name}.h]({name}.md) | {re.split(r'(?<=[.:;]) ', ' '.join(text.split()))[0].rstrip(':;')} |")
    (folder / "index.md").write_text("\n".join(index) + "\n")
    known = {told for header in listed.values() for kind in ("functions", "structs", "callbacks", "constants", "tables")
             for told in header.get(kind, ())}
    return list(read), sorted(known - set(homes))
