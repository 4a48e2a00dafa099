"""Type hints name what the module has, with its parameters; everything has a docstring."""
import ast
import importlib.resources
import inspect
import re
import unittest

import weft

STUB = ast.parse((importlib.resources.files(weft) / "__init__.pyi").read_text())
OF_ENUMERATIONS = {"name", "value"}


def is_property(node):
    marks = [ast.unparse(mark) for mark in node.decorator_list]
    return "property" in marks or any(mark.endswith(".setter") for mark in marks)


def hinted(body):
    """Names, and for functions their parameters."""
    found = {}
    for node in body:
        if isinstance(node, ast.FunctionDef) and is_property(node):
            found[node.name] = None
        elif isinstance(node, ast.FunctionDef):
            found[node.name] = [a.arg for a in node.args.args if a.arg != "self"]
        elif isinstance(node, ast.ClassDef):
            found[node.name] = None
        elif isinstance(node, ast.AnnAssign):
            found[node.target.id] = None
    return found


def public(owner):
    return {name for name in vars(owner) if not name.startswith("_")}


def parameters(function):
    signature = re.match(r"\w+\((.*?)\) -> ", function.__doc__)
    return [name for name in re.findall(r"(?:^|, )(\w+):", signature.group(1)) if name != "self"]


class Stubs(unittest.TestCase):
    def check(self, owner, body, where):
        names = hinted(body)
        self.assertEqual({n for n in names if not n.startswith("_")}, public(owner) - OF_ENUMERATIONS, where)
        for name, hints in names.items():
            member = getattr(owner, name)
            if hints is not None and not name.startswith("_"):
                self.assertEqual(hints, parameters(member), f"{where}.{name}")

    def test_module(self):
        self.check(weft, STUB.body, "weft")
        self.assertTrue((importlib.resources.files(weft) / "py.typed").is_file())

    def test_classes(self):
        for node in STUB.body:
            if isinstance(node, ast.ClassDef) and node.name != "Error":
                self.check(getattr(weft, node.name), node.body, node.name)

    def test_docstrings(self):
        for name in public(weft):
            member = getattr(weft, name)
            if inspect.isclass(member) or inspect.isroutine(member):
                self.assertTrue(member.__doc__, name)
            if inspect.isclass(member) and not hasattr(member, "__members__"):
                for own in public(member):
                    text = getattr(member, own).__doc__ or ""
                    self.assertTrue(re.sub(r"\A\w+\(.*?\) -> .*\n*", "", text).strip(), f"{name}.{own}")


if __name__ == "__main__":
    unittest.main()
