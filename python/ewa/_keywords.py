# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Options as keyword arguments that `help()`, `inspect` and completion show, with what the library's tables say of each."""
from __future__ import annotations

import inspect
import re
import textwrap
from typing import Any, Callable, TypeVar

from . import _bindings as b
from ._options import OWN
from ._struct import Option, table

_Callable = TypeVar("_Callable", bound=Callable[..., Any])
_TYPE = b.ewa_option_type
_NUMBERS = {int(_TYPE.EWA_OPTION_BOOL): "bool", int(_TYPE.EWA_OPTION_U32): "int", int(_TYPE.EWA_OPTION_U64): "int",
            int(_TYPE.EWA_OPTION_F32): "float", int(_TYPE.EWA_OPTION_F64): "float"}


def keywords(*structs: str, without: tuple[str, ...] = ()) -> Callable[[_Callable], _Callable]:
    """Make the members of structs of options known as the keyword arguments that a call, or a class, takes by `**options`.

    `without` are members that it does not take. Of its docstring, the paragraph `**options` becomes what the tables say of
    each; what stands there as "``name``: text" is added to that one, in place of its default.
    """

    def decorate(function: _Callable) -> _Callable:
        called: Any = function.__init__ if inspect.isclass(function) else function
        signature = inspect.signature(called)
        parameters = [parameter for parameter in signature.parameters.values() if parameter.kind is not parameter.VAR_KEYWORD]
        options = {name: option for struct in structs for name, option in table(struct).items()
                   if name not in OWN.get(struct, ()) and name not in signature.parameters and name not in without}
        parameters += [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=_annotation(option))
                       for name, option in options.items()]
        called.__signature__ = signature.replace(parameters=parameters)
        called.option_structs = structs
        if function.__doc__:
            function.__doc__ = _described(inspect.cleandoc(function.__doc__), options)
        return function

    return decorate


def _annotation(option: Option) -> str:
    """The type of an option; None stands for its default."""
    if option.kind == _TYPE.EWA_OPTION_CHOICE:
        return f"Literal[{', '.join(map(repr, option.words))}] | None"
    return f"Sequence[{_NUMBERS[option.kind]}] | None" if option.length else f"{_NUMBERS[option.kind]} | None"


def _described(text: str, options: dict[str, Option]) -> str:
    """A docstring with a paragraph for each option in place of that of all."""
    match = re.search(r"^\*\*\w+\n((?:[ \t]+.*\n?|\n(?=[ \t]+\S))*)", text, re.M)
    if match is None:
        return text
    remark = " ".join(match.group(1).split())
    remarks = dict(re.findall(r"``(\w+)``: (.*?)(?= ``\w+``: |$)", remark))
    lines = []
    for name, option in options.items():
        kind = "{" + ", ".join(f'"{word}"' for word in option.words) + "}" if option.kind == _TYPE.EWA_OPTION_CHOICE else (
            _NUMBERS[option.kind] + (f" sequence of {option.length}" if option.length else ""))
        lines.append(f"{name} : {kind}, optional")
        said = option.help[:1].upper() + option.help[1:] + "."
        if option.kind not in (_TYPE.EWA_OPTION_CHOICE, _TYPE.EWA_OPTION_BOOL) and option.allowed != "(-inf, inf)":
            said += f" {option.allowed[:1].upper()}{option.allowed[1:]}{' ' + option.unit if option.unit else ''}."
        said += " " + remarks.get(name, f"Default: {option.default}.")
        lines += textwrap.wrap(said, 100, initial_indent="    ", subsequent_indent="    ", break_on_hyphens=False)
    return text[:match.start()] + "\n".join(lines) + "\n" + text[match.end():]
