# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes of the files and functions in lib, tools and bench, and of the median header of lib.
A function's lines are counted from its opening brace to its closing one, as clang-tidy's readability-function-size does; lambdas
and local types count with the function around them. The text must be formatted by clang-format: a body's brace follows a space,
that of an initialised member does not.
Prints what is above the limits. Usage: sizes.py [ROOT]"""
import pathlib
import re
import statistics
import sys

MOST_FILE_LINES = 400      # of a .cpp file
MOST_FUNCTION_LINES = 60
MOST_MEDIAN_HEADER = 20    # lines of code: contracts may be as long as they must
FOLDERS = ("lib", "tools", "bench")

NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'|'
                      r'^[ \t]*#(?:\\\n|[^\n])*', re.DOTALL | re.MULTILINE)
TEMPLATE = re.compile(r"template <(?:[^<>]|<[^<>]*>)*>|\[\[.*?\]\]|alignas\([^()]*\)|requires \([^()]*\)")
OPERATOR = re.compile(r"operator\s*\S+?\(")
SCOPE = re.compile(r'(?:inline )?(?:namespace|(?:class|struct|union|enum)\b[^(=]*|extern "")')
NAME = re.compile(r"([\w:~]+|operator\s*\S+?)\s*\(")


def code_of(text):
    """The text without comments, literals and directives; line breaks stay."""
    return NOT_CODE.sub(lambda found: "\n" * found[0].count("\n") + ('""' if found[0][0] in "R\"'" else ""), text)


def opens_scope(head):
    """Whether a brace opens a namespace or a type, by the text since the last statement."""
    return SCOPE.match(TEMPLATE.sub("", head).strip()) is not None and "=" not in head and (
        "(" not in TEMPLATE.sub("", head))


def opens_function(head, before):
    """Whether a brace outside all functions opens a body, by that text and the character before the brace."""
    if before != " " or "(" not in head:
        return False
    plain = OPERATOR.sub("operator(", TEMPLATE.sub("", head))
    is_value = re.search(r"(?<![=!<>])=(?!=)", re.sub(r"\([^()]*\)|<[^<>]*>", "", plain)) is not None
    return not is_value or "[" in head  # a value may be a lambda


def functions_of(text):
    """(name, line of its opening brace, lines) of each function, in order."""
    code = code_of(text)
    found, scopes, head, line = [], [], "", 1
    name, depth, first = "", 0, 0  # of the function that is open: depth counts its braces
    parentheses = 0
    for at, letter in enumerate(code):
        line += letter == "\n"
        if depth:
            depth += (letter == "{") - (letter == "}")
            if depth == 0:
                found.append((name, first, line - first))
                head = ""
        elif letter in "()":
            parentheses += 1 if letter == "(" else -1
            head += letter
        elif letter == "{":
            bare = head.strip()
            if opens_scope(bare):
                scopes.append("scope")
                head = ""
            elif parentheses == 0 and opens_function(bare, code[at - 1]):
                found_name = NAME.search(bare)
                name, first, depth = (found_name[1] if found_name else "lambda"), line, 1
            else:
                scopes.append("braces")
        elif letter == "}":
            if scopes and scopes.pop() == "scope":
                head = ""
        elif letter == ";" and parentheses == 0 and (not scopes or scopes[-1] == "scope"):
            head = ""
        else:
            head += letter
    return found


def large_functions(files):
    """files: name to text. Gives (file, function, line, lines), longest first."""
    found = [(file, *function) for file, text in files.items() for function in functions_of(text)
             if function[2] > MOST_FUNCTION_LINES]
    return sorted(found, key=lambda one: (-one[3], one))


def large_files(files):
    """Gives (file, lines) of the .cpp files, longest first."""
    counted = [(file, len(text.splitlines())) for file, text in files.items() if file.endswith(".cpp")]
    return sorted(((file, lines) for file, lines in counted if lines > MOST_FILE_LINES), key=lambda one: (-one[1], one))


def median_header(files):
    """Lines of the median header of lib without blank lines, comments and directives."""
    return statistics.median(sum(1 for line in code_of(text).splitlines() if line.strip()) for file, text in files.items()
                             if file.startswith("lib/") and file.endswith(".hpp"))


def files_of(root):
    return {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
            for folder in FOLDERS for path in sorted((root / folder).rglob("*")) if path.suffix in (".cpp", ".hpp")}


if __name__ == "__main__":
    texts = files_of(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
    for file, lines in large_files(texts):
        print(f"{file}: {lines} lines")
    for file, name, line, lines in large_functions(texts):
        print(f"{file}:{line}: {name}: {lines} lines")
    print(f"median header of lib: {median_header(texts):g} lines of code")
