# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The reference of the Python package as pages: what `help()` says of each public name of the module `ewa`."""
import inspect
import re


def markdown(doc):
    """A docstring of numpy's form as Markdown."""
    doc = re.sub(r":(?:\w+:)?\w+:`([^`]*)`", r"`\1`", doc).replace("``", "`")
    lines, section = [], ""
    text = doc.split("\n")
    for i, line in enumerate(text):
        under = text[i + 1] if i + 1 < len(text) else ""
        if re.fullmatch(r"-{3,}", line):
            continue
        if re.fullmatch(r"-{3,}", under):
            section = line
            lines += ["", f"**{line}**", ""]
        elif section and line and not line.startswith(" ") and section not in ("Notes", "Examples"):
            name, _, kind = line.partition(" : ")
            kind = kind.replace("`", "")
            lines += ["", f"- `{name}`" + (f" : `{kind}`" if kind else ""), ""]
        else:
            lines.append(line)
    text = "\n".join(lines)
    return re.sub(r"(?m)^((?:>>>|\.\.\.) .*(?:\n(?:>>>|\.\.\.) .*)*)", r"```python\n\1\n```", text)


def signature(name, call):
    try:
        return re.sub(r"(: |-> )'([^']*)'", r"\1\2", f"{name}{inspect.signature(call)}")  # annotations are texts
    except (TypeError, ValueError):
        return name


def described(name, thing):
    """A heading, how it is called and what it is, of a function, a method or a property."""
    if isinstance(thing, property):
        shown, doc = name, inspect.getdoc(thing)
    else:
        shown, doc = signature(name, getattr(thing, "__func__", thing)), inspect.getdoc(thing)
    shown = re.sub(r"\((?:self|cls)(?:, )?", "(", shown)
    code = [] if isinstance(thing, property) else ["```python", wrapped(shown), "```", ""]
    return [f"## {name} {{#{name}}}", "", *code, markdown(doc or ""), ""]


def wrapped(shown):
    """A long signature with an argument a line."""
    if len(shown) <= 100:
        return shown
    head, _, rest = shown.partition("(")
    depth, parts, part = 0, [], ""
    body, _, result = rest.rpartition(")")
    for letter in body:
        depth += {"[": 1, "(": 1, "]": -1, ")": -1}.get(letter, 0)
        if letter == "," and not depth:
            parts.append(part.strip())
            part = ""
        else:
            part += letter
    parts.append(part.strip())
    return head + "(\n" + "".join(f"    {part},\n" for part in parts) + ")" + result


def write(module, folder):
    """Writes a page of the functions and one of each class; returns their names."""
    folder.mkdir(parents=True)
    things = {name: getattr(module, name) for name in module.__all__}
    classes = {name: thing for name, thing in things.items() if inspect.isclass(thing) and not issubclass(thing, Exception)}
    errors = {name: thing for name, thing in things.items() if inspect.isclass(thing) and issubclass(thing, Exception)}
    calls = {name: thing for name, thing in things.items() if inspect.isroutine(thing)}
    lines = ["# Functions", ""]
    for name, thing in calls.items():
        lines += described(name, thing)
    (folder / "functions.md").write_text("\n".join(lines))
    lines = ["# Exceptions", ""]
    for name, thing in errors.items():
        lines += [f"## {name}", "", f"`{', '.join(base.__name__ for base in thing.__bases__)}`", "", markdown(inspect.getdoc(thing) or ""), ""]
    (folder / "exceptions.md").write_text("\n".join(lines))
    for name, thing in classes.items():
        lines = [f"# {name}", "", "```python", wrapped(signature(name, thing)), "```", "",
                 markdown(inspect.getdoc(thing) or ""), ""]
        for member, value in vars(thing).items():
            if not member.startswith("_") and (inspect.isroutine(value) or isinstance(value, (property, classmethod, staticmethod))):
                lines += described(member, value)
        (folder / f"{name}.md").write_text("\n".join(lines))
    told = [f"| [{name}]({name}.md) | {first_line(thing)} |" for name, thing in classes.items()]
    told += [f"| [{name}()](functions.md#{name}) | {first_line(thing)} |" for name, thing in calls.items()]
    (folder / "index.md").write_text("# Python package\n\n" + markdown(inspect.getdoc(module) or "") + "\n\n| name | what |\n|---|---|\n"
                                     + "\n".join(told) + "\n")
    return list(classes)


def first_line(thing):
    return markdown((inspect.getdoc(thing) or "").split("\n")[0]).strip().replace("|", "\\|")
