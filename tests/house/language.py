# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps out of what users read the phrases that plain technical English has no use for. Prints one line a phrase; exit
status 1 when there is one. Usage: language.py [ROOT]

Users read: README.md, CHANGELOG.md and docs/, the samples, the string literals of lib/ and tools/ (help, messages,
findings, reports), the comments of the library's public headers (the reference), the string literals of web/src/ (the
report page), and what scripts/demo prints."""
import pathlib
import re
import sys

# What is ruled out, and what to write instead. A blank stands for any white space: line ends do not hide a phrase.
PHRASES = [
    (r"papers? 00\d", "name a paper by its authors and year"),
    (r"\bthe papers?(?:'s?)?\b(?! of \w+(?:,| and) )", "name a paper by its authors and year"),
    (r"\bthat which\b|\bthose which\b|\bwhat is none\b", "what, those that"),
    (r"\b(?:whence|thence|hence(?:forth)?|hitherto|thereof|therein|wherein|whereby|herein|albeit|lest|aught|naught|ere)\b",
     "a word of today"),
    (r"\banew\b", "again, or re-: reorder, recompute"),
    (r"\bso many (?:times|cells|rows|steps|sweeps|points)\b", "this factor, this many"),
    (r"\b(?:has|have) it(?: that)?(?=[ ,.;:)])", "by, as in"),
    (r"\bout come\b", "X writes Y"),
    (r"\bby chance\b|\bevery chance\b|\bseed of chance\b|\bland by chance\b", "random"),
    (r"\bmade land\b|\bland made\b", "synthetic terrain"),
    (r"\breal lands?\b", "reference DEM"),
    (r"\b(?:is|are|was|were|be) told\b(?! apart)|, told\b|\btold (?:under|on|by)\b", "reported, listed"),
    (r"\bnobody\b|\bknown to none\b", "unknown"),
    (r"(?<!there )(?<!There )\bis no (?!longer\b|more than\b)", "is not a"),
    (r"\b(?:is|are) none (?:of|but)\b|[;,] \{\} is none\b", "is not one of"),
    (r"\b(?:files|programs|people|things|rivers|figures) of others\b", "other files"),
    (r"\bother people's\b|\bothers' programs\b", "other programs"),
    (r"\b(?:is|are) wanted\b|\bwhat was asked\b|\bis asked for\b|\basked to have\b", "is required; write X"),
    (r"\bmake left\b|\b(?:what|folder|all) (?:that )?make leaves\b|\bthalweg left\b", "written by make"),
    (r"\bbrought into\b|\bbring (?:\S+ )?into\b", "reproject to"),
    (r"\bpassed over\b", "skipped"),
    (r"\btaken for\b(?! granted)", "treated as"),
    (r"\bin the words of\b", "in the schema of"),
    (r"\bfigures by which\b|\bby which experts\b", "morphometric indices"),
    (r"\bsays? no format\b|\bgives? no context\b", "say what is missing"),
    (r"\bwhose they are\b|\bas running water would\b|\bkeep their water\b", "say it plainly"),
    (r"\bshall\b", "must, or the plain verb"),
    (r"\bupon\b", "on"),
]
COMPILED = [(re.compile(pattern, re.IGNORECASE), instead) for pattern, instead in PHRASES]
# Decisions were written for the library's authors; papers are named there as well.
NUMBERED_PAPERS = COMPILED[:1]

LITERAL = re.compile(r'R"(?P<mark>[^(\s]*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<text>(?:\\.|[^"\\\n])*)"|'
                     r"'(?:\\.|[^'\\\n])+'|//[^\n]*|/\*.*?\*/|#\s*include[^\n]*", re.DOTALL)
SCRIPT_LITERAL = re.compile(r"'((?:\\.|[^'\\])*)'|\"((?:\\.|[^\"\\])*)\"|`((?:\\.|[^`\\])*)`")
ESCAPED = {r"\n": " ", r"\t": " ", r"\"": '"'}


def literals(text):
    """The string literals of C++ as (line number, text); those that the compiler joins are one."""
    joined, end = None, 0
    for found in LITERAL.finditer(text):
        content = found["raw"] if found["raw"] is not None else found["text"]
        if content is None:
            continue
        for code, plain in ESCAPED.items():
            content = content.replace(code, plain)
        if joined and not text[end:found.start()].strip():
            joined = joined[0], joined[1] + content
        else:
            if joined:
                yield joined
            joined = text.count("\n", 0, found.start()) + 1, content
        end = found.end()
    if joined:
        yield joined


def comments(text):
    """What a header says to Doxygen as (line number, text), lines that follow one another as one."""
    first, words = 0, []
    for number, line in enumerate([*text.splitlines(), ""], 1):
        found = re.search(r"///<? ?(.*)", line)
        if found and (not words or first + len(words) == number):
            first = first if words else number
            words.append(found[1])
        elif words:
            yield first, "\n".join(words)
            first, words = number, [found[1]] if found else []


def script_literals(text):
    """The string literals of a script as (line number, text)."""
    for number, line in enumerate(text.splitlines(), 1):
        for found in SCRIPT_LITERAL.finditer(re.sub(r"(^|\s)//.*", "", line)):
            yield number, found[1] or found[2] or found[3] or ""


def texts_of(name, text):
    """What users read of a file as (line number, text)."""
    path = pathlib.PurePath(name)
    if path.suffix == ".md" or name == "scripts/demo":
        yield 1, text
    elif path.suffix == ".toml":
        yield from enumerate(text.splitlines(), 1)
    elif path.suffix in (".cpp", ".hpp"):
        yield from literals(text)
        if path.suffix == ".hpp" and path.parts[0] == "lib" and "internal" not in path.parts:
            yield from comments(text)
    elif path.suffix == ".js":
        yield from script_literals(text)


def squeezed(text):
    """A text with one blank for any white space, and the line (from 0) of each of its characters."""
    kept, lines, line = [], [], 0
    for part in re.finditer(r"\s+|\S", text):
        kept.append(" " if part[0].isspace() else part[0])
        lines.append(line)
        line += part[0].count("\n")
    return "".join(kept), lines


def faults_of(name, text):
    """Phrases that are ruled out in what users read of a file as (line number, text)."""
    phrases = NUMBERED_PAPERS if name.startswith("docs/decisions/") else COMPILED
    for first, words in texts_of(name, text):
        plain, lines = squeezed(words)
        for pattern, instead in phrases:
            for found in pattern.finditer(plain):
                yield first + lines[found.start()], f"'{found[0]}': write {instead}"


def is_read_by_users(name):
    path = pathlib.PurePath(name)
    if name in ("README.md", "CHANGELOG.md", "scripts/demo"):
        return True
    return (path.parts[0] in ("docs", "samples") and path.suffix in (".md", ".toml")) or (
        path.parts[0] in ("lib", "tools") and path.suffix in (".cpp", ".hpp")) or (
        path.parts[:2] == ("web", "src") and path.suffix == ".js")


def violations(root, names):
    root = pathlib.Path(root)
    return [f"{name}:{number}: {words}" for name in names if is_read_by_users(name)
            for number, words in faults_of(name, (root / name).read_text(encoding="utf-8"))]


if __name__ == "__main__":
    import rules
    where = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    faults = violations(where, rules.files_of(where))
    print("\n".join(faults) if faults else "no phrase that is ruled out")
    sys.exit(1 if faults else 0)
