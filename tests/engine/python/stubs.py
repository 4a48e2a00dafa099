"""Type hints are those that make_stub.py makes of the module; everything has a docstring."""
import ast
import importlib.resources
import inspect
import re
import unittest

import make_stub
import weft


def public(owner):
    return {name for name in vars(owner) if not name.startswith("_")}


class Stubs(unittest.TestCase):
    def test_hints(self):
        files = importlib.resources.files(weft)
        stub = (files / "__init__.pyi").read_text()
        self.assertEqual(stub.splitlines(), make_stub.stub(weft).splitlines(), make_stub.__doc__)
        self.assertTrue((files / "py.typed").is_file())

    def test_names(self):
        stub = ast.parse(make_stub.stub(weft)).body
        classes = {node.name: node for node in stub if isinstance(node, ast.ClassDef)}
        others = {node.name if isinstance(node, ast.FunctionDef) else node.target.id
                  for node in stub if isinstance(node, (ast.FunctionDef, ast.AnnAssign))}
        self.assertEqual(set(classes) | others - {"__version__"}, public(weft))
        fields = [node.name for node in classes["StepReport"].body]
        self.assertLessEqual({"status", "max_error", "stage_seconds"}, set(fields))

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
