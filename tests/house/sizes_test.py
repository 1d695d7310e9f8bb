# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds lib, tools and bench to small files and functions, and sizes.py to planted ones. Usage: sizes_test.py"""
import pathlib
import unittest

import sizes

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Files of more than 400 lines that stay, each with its reason.
LARGE_FILES = {}
# Functions of more than 60 lines that stay, each with its reason.
LARGE_FUNCTIONS = {}


def names(*lines):
    return [(name, count) for name, _, count in sizes.functions_of("\n".join(lines) + "\n")]


def body(lines):
    return [f"    step({k});" for k in range(lines - 1)] + ["}"]


class Functions(unittest.TestCase):
    def test_nothing(self):
        self.assertEqual(names(""), [])
        self.assertEqual(names("// f() {", "/* g() {", "} */", '#define H() {'), [])

    def test_lines_from_brace_to_brace(self):
        self.assertEqual(names("int f() {", *body(5)), [("f", 5)])
        self.assertEqual(names("int f(int a,", "      int b) {", *body(5)), [("f", 5)])
        self.assertEqual(names("void f() {}"), [("f", 0)])

    def test_in_namespaces_and_types(self):
        self.assertEqual(names("namespace a::b {", "namespace {", "class C : public D<int> {", "public:", "    int f() const {",
                               *body(3), "    int g_ = 0;", "};", "}", "void h() {", *body(2), "}"), [("f", 3), ("h", 2)])

    def test_constructors_templates_operators(self):
        self.assertEqual(names("C::C(int a) : a_(a), b_{a} {", *body(3)), [("C::C", 3)])
        self.assertEqual(names("template <class A, class B = C<int>> A f(B b) {", *body(3)), [("f", 3)])
        self.assertEqual(names("S& operator+=(S const& o) {", *body(3)), [("operator+=", 3)])

    def test_values_are_none(self):
        self.assertEqual(names("int const a = f(1) + S{2}.b;", "std::array<int, 2> const c = {g(1), h(2)};", "T t{u(3)};"), [])

    def test_lambdas(self):
        self.assertEqual(names("auto const f = [](int a) {", *body(3), ";"), [("lambda", 3)])
        self.assertEqual(names("int f() {", "auto const g = [&] {", *body(3), ";", *body(2)), [("f", 7)])

    def test_braces_in_literals_do_not_count(self):
        self.assertEqual(names("int f() {", "    char c = '{';", '    text("{ \\" {");', '    raw(R"(", {)");', "}"), [("f", 4)])


class Planted(unittest.TestCase):
    def test_a_function_at_the_limit_and_one_above(self):
        at, above = (["void f() {", *body(lines)] for lines in (60, 61))
        found = sizes.large_functions({"lib/a.cpp": "\n".join(at), "lib/b.hpp": "\n".join(["", *above])})
        self.assertEqual(found, [("lib/b.hpp", "f", 2, 61)])

    def test_a_file_at_the_limit_and_one_above(self):
        self.assertEqual(sizes.large_files({"a.cpp": "\n" * 400, "b.cpp": "\n" * 401, "c.hpp": "\n" * 999}), [("b.cpp", 401)])

    def test_median_header(self):
        code, comments = "int a;\n", "// b\n\n"
        self.assertEqual(sizes.median_header({"lib/a.hpp": 10 * code + 99 * comments, "lib/b.hpp": 20 * code,
                                              "lib/c.hpp": 90 * code,
                                              "lib/c.cpp": 900 * code, "tools/d.hpp": 900 * code}), 20)


class House(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.files = sizes.files_of(ROOT)
        cls.large_files = {file for file, _ in sizes.large_files(cls.files)}
        cls.large_functions = {(file, name) for file, name, _, _ in sizes.large_functions(cls.files)}

    def test_large_files_have_a_reason(self):
        self.assertEqual(sorted(self.large_files - set(LARGE_FILES)), [])

    def test_large_functions_have_a_reason(self):
        self.assertEqual(sorted(self.large_functions - set(LARGE_FUNCTIONS)), [])

    def test_every_reason_has_its_place(self):
        self.assertEqual(sorted(set(LARGE_FILES) - self.large_files), [])
        self.assertEqual(sorted(set(LARGE_FUNCTIONS) - self.large_functions), [])

    def test_headers_are_short(self):
        self.assertLessEqual(sizes.median_header(self.files), sizes.MOST_MEDIAN_HEADER)


if __name__ == "__main__":
    unittest.main()
