# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of places in lib, tools and tests that share six or more equal lines of code. Prints one line a pair.
Blank lines, comments, includes, pragmas and lines of punctuation alone do not count, nor do
they end a run. White space is folded.
Usage: twins.py [ROOT]"""
import collections
import pathlib
import re
import sys

LEAST = 6  # equal lines that make a pair
FOLDERS = ("lib", "tools", "tests")
SUFFIXES = (".cpp", ".hpp", ".inc")
PASSED_OVER = re.compile(r"//|\*|/\*|#\s*(include|pragma)|[\W_]*$")


def lines_of(text):
    """The lines that count, as (number from 1, folded text)."""
    folded = ((number, " ".join(line.split())) for number, line in enumerate(text.splitlines(), 1))
    return [(number, line) for number, line in folded if not PASSED_OVER.match(line)]


def twins(files):
    """files: name to text. Gives (name, first line, name, first line, equal lines) for each pair of longest runs, in order."""
    lines = {name: lines_of(text) for name, text in sorted(files.items())}
    starts = collections.defaultdict(list)
    for name, counted in lines.items():
        for at in range(len(counted) - LEAST + 1):
            starts[tuple(line for _, line in counted[at:at + LEAST])].append((name, at))
    matches = set()
    for places in starts.values():
        for k, (one, i) in enumerate(places):
            matches.update((one, i, other, j) for other, j in places[k + 1:] if one != other or j - i >= LEAST)
    pairs = []
    for one, i, other, j in sorted(matches):
        if (one, i - 1, other, j - 1) in matches:
            continue  # within a run that begins earlier
        windows = 1
        while (one, i + windows, other, j + windows) in matches:
            windows += 1
        pairs.append((one, lines[one][i][0], other, lines[other][j][0], windows + LEAST - 1))
    return pairs


def files_of(root):
    return {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
            for folder in FOLDERS for path in sorted((root / folder).rglob("*")) if path.suffix in SUFFIXES}


if __name__ == "__main__":
    found = twins(files_of(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")))
    for a, a_line, b, b_line, count in found:
        print(f"{a}:{a_line} ~ {b}:{b_line}: {count} equal lines")
    print(f"{len(found)} pairs")
