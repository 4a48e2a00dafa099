"""Makes the type hints of the module of the signatures that its functions and properties have:

    PYTHONPATH=build/engine/python python3 tests/engine/python/make_stub.py > engine/python/weft/__init__.pyi

The test engine/python/stubs fails where the file is another one.
"""
import inspect
import re

HEAD = '''"""Type hints of the module; its docstrings document every name. Made by make_stub.py."""
from collections.abc import Iterable
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

'''
SIGNATURE = re.compile(r"\w*\((.*)\) -> (.*)")
ARRAY = r"\bnumpy\.ndarray(\[[\w.]+\])?"
SHORTER = [(r"weft\._weft\.", ""), (r"\bList\[", "list["), (r"\bTuple\[", "tuple["), (r"\bDict\[", "dict["),
           (r"\bhandle\b", "Any"), (r"\b[iI]terable\b", "Iterable[Any]"),
           (r"\[\d+\]", ""), (r"\b(list|dict)\b(?!\[)", r"\1[Any]"), (r"dict\[Any\]", "dict[Any, Any]"),
           (r"Optional\[([^][]*(\[[^][]*\])?)\]", r"\1 | None"), (r"\bbuffer\b", "Any"),
           (r"\bos\.PathLike\b", "str | PathLike[str]"), (r"^dtype$", "np.dtype[np.void]")]


def shorter(kind):
    for pattern, name in SHORTER:
        kind = re.sub(pattern, name, kind)
    return re.sub(r"Union\[(.*)\]", lambda union: union[1].replace(", ", " | "), kind)


def returned(kind):
    return shorter(re.sub(ARRAY, "NDArray[Any]", kind)).replace("object", "Any")


def taken(kind):
    """Arrays may be given as whatever NumPy makes an array of; those that are optional are filled."""
    kind = re.sub(r"Optional\[" + ARRAY + r"\]", "NDArray[Any] | None", kind)
    return shorter(re.sub(ARRAY, "ArrayLike", kind)).replace("object", "ArrayLike")


def signature(function):
    return SIGNATURE.match(function.__doc__.strip().split("\n")[0]).groups()


def parts(text):
    """Split at the commas that are in no brackets."""
    found, depth = [""], 0
    for letter in text:
        depth += (letter in "[(<") - (letter in "])>")
        if letter == "," and depth == 0:
            found.append("")
        else:
            found[-1] += letter
    return [part.strip() for part in found if part.strip()]


def parameter(text):
    if text.startswith("*"):
        return "**fields: Any"
    name, _, kind = text.partition(": ")
    kind, has_default, default = kind.partition(" = ")
    hint = taken(kind)
    if default == "None" and not hint.endswith("None"):
        hint += " | None"
    return "self" if name == "self" else f"{name}: {hint}" + (" = ..." if has_default else "")


def function(name, it, in_class=False):
    given, result = signature(it)
    parameters = [parameter(part) for part in parts(given)]
    if in_class and parameters and parameters[0].startswith("arg0"):
        parameters[0] = "self"
    return f"def {name}({', '.join(parameters)}) -> {returned(result)}: ..."


def read(its_property):
    return returned(signature(its_property.fget)[1])


def of_property(name, it):
    kind = read(it)
    if it.fset is None:
        return ["@property", f"def {name}(self) -> {kind}: ..."]
    asked = taken(parts(signature(it.fset)[0])[1].partition(": ")[2])
    if asked == kind:
        return [f"{name}: {kind}"]
    return ["@property", f"def {name}(self) -> {kind}: ...",
            f"@{name}.setter", f"def {name}(self, value: {asked}) -> None: ..."]


def member(owner, name, it):
    if hasattr(owner, "__members__"):
        return [f"{name}: {owner.__name__}"] if name in owner.__members__ else []
    if isinstance(it, property):
        return of_property(name, it)
    if isinstance(it, staticmethod):
        return ["@staticmethod", function(name, it.__func__)]
    is_public = not name.startswith("_") or name in ("__init__", "__len__")
    if not is_public or not SIGNATURE.match(it.__doc__ or ""):
        return []
    return [function(name, it, in_class=True)]


def of_class(owner):
    bases = [base.__name__ for base in owner.__bases__ if base.__module__ == "builtins" and base is not object]
    lines = [line for name, it in vars(owner).items() for line in member(owner, name, it)]
    head = f"class {owner.__name__}" + (f"({', '.join(bases)})" if bases else "") + ":"
    return "\n".join([head] + ["    " + line for line in lines]) if lines else head + " ..."


def stub(module):
    constants, classes, functions = ["__version__: str"], [], []
    for name, it in vars(module).items():
        if name.startswith("_"):
            continue
        if inspect.isclass(it):
            classes.append(of_class(it))
        elif inspect.isroutine(it):
            functions.append(function(name, it))
        elif not inspect.ismodule(it):
            constants.append(f"{name}: " + ("int" if isinstance(it, int) else "np.dtype[np.void]"))
    return HEAD + "\n".join(constants) + "\n\n\n" + "\n\n\n".join(classes) + "\n\n\n" + "\n".join(functions) + "\n"


if __name__ == "__main__":
    import weft
    print(stub(weft), end="")
