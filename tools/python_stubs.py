# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Stubs of the modules of the Python package whose calls take options of the library, for editors and type checkers.

Only what is public is in them. The sources say `**options`, and a decorator, @keywords("ewa_render_options", ...), which structs these are of. A stub has
each option as a keyword argument of its own, with what docs/options.json says of it.
"""
import ast
import json

HEAD = """\
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from python/ewa/{name} and docs/options.json; a test holds it to that. Do not edit.
"""
NUMBERS = {"bool": "bool", "u32": "int", "u64": "int", "f32": "float", "f64": "float"}


def type_of(option):
    """The type of an option; None stands for its default."""
    if option["type"] == "choice":
        words = ", ".join(f'"{word}"' for word in option["range"].split("|"))
        return f"Literal[{words}] | None"
    kind = NUMBERS[option["type"]]
    return f"Sequence[{kind}] | None" if option.get("count") else f"{kind} | None"


def told(option):
    """What is said of an option, in a line."""
    default = option["default"]
    if option["type"] == "choice":
        default = option["range"].split("|")[int(default)]
    elif option["type"] == "bool":
        default = bool(default)
    said = [option["help"]]
    if option["type"] not in ("choice", "bool"):
        said.append(option["range"] + (f" {option['unit']}" if option.get("unit") else ""))
    return "; ".join([*said, f"default {json.dumps(default) if isinstance(default, list) else default}"])


def is_private(name):
    return name.startswith("_") and not name.endswith("__")


class Writer:
    """Writes the stub of one module."""

    def __init__(self, options, own):
        self.options, self.own, self.lines = options, own, []

    def put(self, depth, text):
        self.lines.append("    " * depth + text)

    def keywords_of(self, node):
        """The structs and the members left out of a decorator @keywords, and the other decorators."""
        structs, without, others = None, (), []
        for decorator in node.decorator_list:
            if isinstance(decorator, ast.Call) and isinstance(decorator.func, ast.Name) and decorator.func.id == "keywords":
                structs = [argument.value for argument in decorator.args]
                without = next((ast.literal_eval(keyword.value) for keyword in decorator.keywords), ())
            else:
                others.append(ast.unparse(decorator))
        return structs, without, others

    def function(self, node, depth, structs=None, without=()):
        own_structs, own_without, decorators = self.keywords_of(node)
        structs, without = structs or own_structs, without or own_without
        for decorator in decorators:
            self.put(depth, "@" + decorator)
        result = f" -> {ast.unparse(node.returns)}" if node.returns else ""
        if structs is None:
            self.put(depth, f"def {node.name}({ast.unparse(node.args)}){result}: ...")
            return
        arguments = node.args
        named = {argument.arg for argument in arguments.args + arguments.kwonlyargs}
        arguments.kwarg = None
        plain = ast.unparse(arguments)
        star = "" if arguments.kwonlyargs or arguments.vararg else "*, "
        self.put(depth, f"def {node.name}({plain}{', ' if plain else ''}{star}")
        rows = [(name, option) for struct in structs for name, option in self.options[struct].items()
                if name not in self.own.get(struct, ()) and name not in named and name not in without]
        for name, option in dict(rows).items():
            self.put(depth + 2, f"{name}: {type_of(option)} = None,  # {told(option)}")
        self.put(depth + 2, f"){result}: ...")

    def body(self, nodes, depth):
        before = len(self.lines)
        for node in nodes:
            if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
                self.body([child for child in node.body if not isinstance(child, ast.ClassDef)], depth)
            elif isinstance(node, (ast.Import, ast.ImportFrom)):
                if getattr(node, "module", None) != "_keywords":
                    self.put(depth, ast.unparse(node))
            elif isinstance(node, (ast.FunctionDef, ast.ClassDef)) and is_private(node.name):
                continue
            elif isinstance(node, ast.FunctionDef):
                self.function(node, depth)
            elif isinstance(node, ast.ClassDef):
                self.klass(node, depth)
            elif isinstance(node, ast.AnnAssign) and not is_private(ast.unparse(node.target)):
                self.put(depth, f"{ast.unparse(node.target)}: {ast.unparse(node.annotation)}"
                         + (f" = {ast.unparse(node.value)}" if node.value is not None and depth else ""))
            elif isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
                name, alias = node.targets[0].id, isinstance(node.value, (ast.Subscript, ast.Attribute))
                if name == "__slots__" or (depth and is_private(name)):  # others may be defaults
                    continue
                self.put(depth, f"{name} = {ast.unparse(node.value)}" if alias else f"{name}: Any")
        return len(self.lines) > before

    def klass(self, node, depth):
        structs, without, decorators = self.keywords_of(node)
        for decorator in decorators:
            self.put(depth, "@" + decorator)
        bases = ", ".join([ast.unparse(base) for base in node.bases] +
                          [f"{keyword.arg}={ast.unparse(keyword.value)}" for keyword in node.keywords])
        self.put(depth, f"class {node.name}{f'({bases})' if bases else ''}:")
        before = len(self.lines)
        for member in node.body:
            if isinstance(member, ast.FunctionDef) and member.name == "__init__":
                self.function(member, depth + 1, structs, without)
                self.attributes(member, depth + 1, node)
            else:
                self.body([member], depth + 1)
        if len(self.lines) == before:
            self.put(depth + 1, "...")

    def attributes(self, node, depth, owner):
        """What __init__ sets that the class does not say."""
        said = {member.target.id for member in owner.body
                if isinstance(member, ast.AnnAssign) and isinstance(member.target, ast.Name)}
        for statement in ast.walk(node):
            targets = statement.targets if isinstance(statement, ast.Assign) else (
                [statement.target] if isinstance(statement, ast.AnnAssign) else [])
            for target in targets:
                if isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name) and target.value.id == "self" \
                        and target.attr not in said and not is_private(target.attr):
                    said.add(target.attr)
                    kind = ast.unparse(statement.annotation) if isinstance(statement, ast.AnnAssign) else "Any"
                    self.put(depth, f"{target.attr}: {kind}")


def write_stub(path, options, own):
    """The stub of a module; None: its calls take no options."""
    text = path.read_text()
    if "@keywords(" not in text:
        return None
    writer = Writer(options, own)
    writer.body(ast.parse(text).body, 0)
    lines = [line.rstrip() for line in writer.lines if line != "from __future__ import annotations"]
    return HEAD.format(name=path.name) + "from typing import Any, Literal, Sequence\n" + "\n".join(lines) + "\n"
