# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public name has a docstring and a stub that agrees with it; every function of the headers is there, or left out for a reason.
Usage: names_test.py SOURCE."""
import ast
import inspect
import pathlib
import re
import subprocess
import sys
import types
import unittest

import thalweg

SOURCE = pathlib.Path(sys.argv.pop()) if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2]
STUBS = pathlib.Path(thalweg.__file__).parent
MODULES = [thalweg._core, *(getattr(thalweg, name) for name in thalweg._core.MODULES)]


ERRORS = {"Error", "BadParameter", "BadInput", "NotConverged", "IoError", "Cancelled", "version", "Picture"}  # without, or in parts


def public(thing):
    return [(name, value) for name, value in vars(thing).items() if not name.startswith("_") and not isinstance(value, types.ModuleType)]


def stub_of(module):
    return ast.parse((STUBS / f"{module.__name__.rpartition('.')[2]}.pyi").read_text(encoding="utf-8"))


def arguments_of(function):
    """Of a stub: names in order, keywords behind *; whether each has a default."""
    args = function.args
    positional = [a.arg for a in args.args]
    defaults = [False] * (len(positional) - len(args.defaults)) + [True] * len(args.defaults)
    return list(zip(positional, defaults)), [(a.arg, d is not None) for a, d in zip(args.kwonlyargs, args.kw_defaults)]


class Names(unittest.TestCase):
    def test_every_public_name_is_documented(self):
        count = 0
        for module in MODULES:
            self.assertTrue(inspect.getdoc(module))
            for name, value in public(module):
                where = f"{module.__name__}.{name}"
                if name in ("MODULES", "VALUES"):
                    continue
                words = inspect.getdoc(value) or ""
                count += 1
                self.assertGreater(len(words), 20, where)
                if inspect.isroutine(value):
                    self.assertIn("\nReturns\n-------\n", words, where)
                elif isinstance(value, type) and not issubclass(value, Exception):
                    for field, getter in public(value):
                        if isinstance(getter, property):
                            self.assertIn(field, value._fields + ("bytes", "length_m", "node_count", "arc_count", "outlets", "basin"), where)
        self.assertGreater(count, 350)
        for name in thalweg.__all__:
            value = getattr(thalweg, name)
            if inspect.isclass(value) or inspect.isfunction(value):
                self.assertTrue(inspect.getdoc(value), name)

    def test_every_number_has_a_unit_and_every_code_a_meaning(self):
        count = codes = 0
        for module in MODULES:
            for name, value in public(module):
                entries = re.findall(r"^(\w+(?:, \w+)*) : ([^\n]*)\n?((?:    [^\n]*\n?)*)", inspect.getdoc(value) or "", re.M)
                for argument, kind, text in entries:
                    if re.search(r"\bfloat\b|float64|float32", kind) and "Callable" not in kind and "dict[" not in kind:
                        count += 1
                        if not re.search("_(m|m2|m3|km2|deg|rad|cells|px|s)$", argument):
                            self.assertIn("[", text, f"{module.__name__}.{name}: {argument}")
                    codes += "Codes, uint8: " in text
        self.assertGreater(count, 600)
        self.assertGreater(codes, 2)
        for text in (inspect.getdoc(thalweg.flow.FlowField), inspect.getdoc(thalweg.flow.FlowField.direction)):
            self.assertRegex(" ".join(text.split()), "Codes, uint8: 0 east, 1 south east, 2 south.*254 no data .the cell has no height")

    def test_stubs_have_docstrings(self):
        for module in MODULES:
            for node in stub_of(module).body:
                if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and "overload" not in ast.dump(node):
                    if node.name not in ERRORS:
                        self.assertGreater(len(ast.get_docstring(node) or ""), 20, node.name)

    def test_stubs_have_the_names_that_are_there(self):
        for module in MODULES:
            stub = stub_of(module)
            declared = {node.name for node in stub.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
            declared |= {node.target.id for node in stub.body if isinstance(node, ast.AnnAssign)}
            self.assertEqual(declared, {name for name, _ in public(module)}, module.__name__)
            for node in stub.body:
                if isinstance(node, ast.ClassDef) and hasattr(getattr(module, node.name), "_fields"):
                    members = {m.name for m in node.body if isinstance(m, (ast.FunctionDef, ast.ClassDef))} - {"__init__"}
                    self.assertEqual(members, {name for name, _ in public(getattr(module, node.name))}, node.name)

    def test_stubs_have_the_signatures_that_are_there(self):
        checked = 0
        for module in MODULES:
            functions = [n for n in stub_of(module).body if isinstance(n, ast.FunctionDef)]
            for node in functions:
                if sum(n.name == node.name for n in functions) > 1:
                    words = inspect.getdoc(getattr(module, node.name))
                    lines = words.split("\nCalls\n-----\n")[1].split("\n\n")[0].split("\n")
                    self.assertEqual(len(lines), sum(n.name == node.name for n in functions), node.name)
                    continue
                signature = inspect.signature(getattr(module, node.name))
                positional = [(p.name, p.default is not p.empty) for p in signature.parameters.values() if p.kind is p.POSITIONAL_OR_KEYWORD]
                keywords = [(p.name, p.default is not p.empty) for p in signature.parameters.values() if p.kind is p.KEYWORD_ONLY]
                self.assertEqual(arguments_of(node), (positional, keywords), f"{module.__name__}.{node.name}")
                checked += 1
        self.assertGreater(checked, 150)

    def test_what_is_left_out_has_a_reason(self):
        said = subprocess.run([sys.executable, SOURCE / "python" / "bind" / "bind.py", "--left-out", SOURCE], capture_output=True,
                              text=True, check=True).stdout
        self.assertNotRegex(said, "does not cross to Python|: it changes its argument$")
        left_out = set(re.findall(r"^([\w:]+): ", said, re.MULTILINE))
        # The stages of the library, as docs/architecture.md names their modules.
        for stage in ["network::prune", "surface::equilibrium", "flow::route", "fractal::midpoint", "blend::paste", "skeleton::grf",
                      "measure::certify", "draw::map", "io::read_dem", "make::make", "geometry::triangulate"]:
            self.assertNotIn(stage, left_out)
            module, name = stage.split("::")
            module = "terrain" if module == "make" else module  # thalweg.make is a function
            self.assertTrue(callable(getattr(getattr(thalweg, module), name)))


if __name__ == "__main__":
    unittest.main()
