# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pages of docs/ quote of runs, compared with runs and written anew from them. A page quotes in four ways:

An indented block right behind a block of commands (```sh, lines that begin with "$ "), and lines behind a command in such a
block, are what the last command prints. A block elsewhere names its command in a line before it:

    <!-- printed by COMMAND -->

Its lines are printed one after another; a line "..." stands for others between them, "..." at the end of a line for its rest.
Times at the ends of lines do not count, and stay.

Numbers in text and tables have a comment behind them:

    <!-- figures
    $ thalweg make samples/island.toml -o out/island
    island = report("out/island")
    {} arcs reach {} outlets <- island.network.arcs, island.network.outlets
    -->

Its lines are commands that are run, names for values, and PHRASE <- VALUE, ...: the phrase stands in the text above, with a
number for each {}, and each number is the value, with as many decimals as are quoted. A value is Python, with report(FOLDER),
the report.json of a folder that commands left; said(COMMAND), what a command prints, of the page or not; found(PATTERN, TEXT),
the number that a regular expression captures; heights(FILE), a raster as an array; json and median.

In Python, print(...)  # TEXT prints TEXT.

Each function gives the page as it should be; a page that is right comes back as it is."""
import difflib
import json
import pathlib
import re
import statistics
import types

BLOCK = re.compile(r"^(?P<sh>```sh\n(?P<lines>.*?)^```\n)(?:\n(?P<printed>(?: {4}[^\n]*\S\n|\n(?= {4}))+))?|"
                   r"^<!-- printed by (?P<named>[^\n]*) -->\n\n(?P<of_named>(?: {4}[^\n]*\S\n)+)", re.S | re.M)
FIGURES = re.compile(r"^<!-- figures\n(.*?)^-->", re.S | re.M)
TIME = re.compile(r" +\d+\.\d s$")
NUMBER = r"([-−]?(?:\d{1,3}(?:[ \u202f]\d{3})+(?:\.\d+)?|\d*\.?\d+)(?![.\d]*\d))"
PRINT = re.compile(r"^( *print\(.*\)  # )(.*)$", re.M)


class Fault(Exception):
    """What is quoted cannot be found among what was printed, or the other way round."""


def commands_of(text):
    """The commands of a page, in their order."""
    blocks = re.findall(r"^```sh\n(.*?)^```", text, re.S | re.M)
    return [line[2:] for block in blocks for line in block.splitlines() if line.startswith("$ ")]


def plain(command):
    """A command without what run_docs.py reads in it."""
    return re.sub(r"\s*# exit \d+\s*$", "", command)


def key_of(line):
    """The first word of a line that is no number."""
    return next((word for word in line.split() if not word[0].isdigit()), "")


def place_of(line, printed, start):
    """Where a quoted line stands among the printed ones: as it is, else by its first word."""
    whole = TIME.sub("", line)
    for same in (lambda new: TIME.sub("", shortened(new, line)) == whole, lambda new: key_of(new) == key_of(line)):
        for place in range(start, len(printed)):
            if same(printed[place]):
                return place
    raise Fault(f"no line such as '{line.strip()}' is printed")


def shortened(line, quoted):
    """A printed line with as many words as the quoted one has before its "..."."""
    if not quoted.endswith("..."):
        return line
    words = quoted.removesuffix("...").split()
    if " ".join(line.split()[:len(words)]) == " ".join(words):
        return quoted
    kept = re.match(r"(?:\s*\S+){0,%d}" % len(words), line)[0]
    return kept.rstrip(",;:") + quoted[len(quoted.removesuffix("...").rstrip(" ,;:")):]


def as_printed(quoted, printed):
    """The quoted lines as they should be, by the lines that were printed."""
    right, at, run = [], 0, []
    for line in [*quoted, "..."]:
        if line.strip() != "...":
            run.append(line)
            continue
        if run:
            first = place_of(run[0], printed, at)
            at = 1 + (place_of(run[-1], printed, first + 1) if len(run) > 1 else first)
            known = {key_of(old): old for old in run}
            for new in printed[first:at]:
                old = known.get(key_of(new), new)
                new = shortened(new, old)
                time = TIME.search(old)
                right.append(TIME.sub(lambda now, was=time: was[0].strip().rjust(len(now[0])), new) if time else new)
            run = []
        right.append(line)
    return right[:-1]


def with_blocks(text, said):
    """The page with what its commands print. said(COMMAND) gives what one printed."""
    def lines_of(command):
        return [line.rstrip() for line in said(command).splitlines()]

    def indented(lines, command):
        quoted = [line[4:] for line in lines.rstrip("\n").split("\n")]
        return "".join(f"    {line}".rstrip() + "\n" for line in as_printed(quoted, lines_of(command)))

    def right(block):
        if block["named"] is not None:
            return block[0].removesuffix(block["of_named"]) + indented(block["of_named"], block["named"])
        parts, command = [], None
        for is_command, lines in grouped(block["lines"].splitlines()):
            if not is_command and command is not None and all(line.strip() for line in lines):
                lines = as_printed(lines, lines_of(command))
            parts += lines
            command = plain(lines[-1][2:]) if is_command else command
        inside = "```sh\n" + "".join(line + "\n" for line in parts) + "```\n"
        if block["printed"] is None or command is None:
            return inside + block[0].removeprefix(block["sh"])
        return inside + "\n" + indented(block["printed"], command)

    if text.count("<!-- printed by ") != sum(block["named"] is not None for block in BLOCK.finditer(text)):
        raise Fault("an empty line and an indented block stand behind each <!-- printed by COMMAND -->")
    return BLOCK.sub(right, text)


def grouped(lines):
    """Lines in groups: commands, and what stands between them."""
    groups = []
    for line in lines:
        kind = line.startswith("$ ")
        if not groups or groups[-1][0] != kind:
            groups.append((kind, []))
        groups[-1][1].append(line)
    return groups


def as_quoted(old, value):
    """A value as a number of the page is written: with as many decimals, with or without gaps between thousands."""
    bare = old.replace("−", "-")
    decimals = len(bare.partition(".")[2])
    new = f"{value:.{decimals}f}"
    whole, dot, rest = new.partition(".")
    gap = next((sign for sign in " \u202f" if sign in bare), " " if len(bare.partition(".")[0]) < 5 else "")
    if len(whole.lstrip("-")) >= 5 or (gap in bare and gap):
        whole = f"{int(whole):,}".replace(",", gap)
    if bare.lstrip("-").startswith(".") and whole.lstrip("-") == "0":
        whole = whole.replace("0", "")
    new = whole + dot + rest
    return new.replace("-", "−") if "−" in old else new


def with_numbers(text, phrase, values):
    """The text with values in place of the numbers of a phrase, where it stands last."""
    pieces = [r"\s+".join(re.escape(word) for word in re.split(r"\s+", piece)) for piece in phrase.split("{}")]
    if len(pieces) - 1 != len(values):
        raise Fault(f"'{phrase}' has {len(pieces) - 1} numbers, and there are {len(values)} values")
    found = list(re.finditer(r"(?<![\d.])" * phrase.startswith("{}") + NUMBER.join(pieces), text))
    if not found:
        raise Fault(f"'{phrase}' does not stand above its figures")
    for group, value in reversed(list(enumerate(values, 1))):
        start, end = found[-1].span(group)
        text = text[:start] + as_quoted(found[-1][group], value) + text[end:]
    return text


def with_figures(text, names):
    """The page with the values of its comments. names are what values are made of: values_of()."""
    names = dict(names)
    for number in range(len(FIGURES.findall(text))):
        comment = list(FIGURES.finditer(text))[number]
        above, below = text[:comment.start()], text[comment.start():]
        for line in comment[1].splitlines():
            phrase, arrow, value = line.partition(" <- ")
            if line.startswith("$ "):
                names["said"](line[2:])
            elif arrow:
                above = with_numbers(above, phrase, eval(f"({value},)", names))
            elif re.match(r"\w+ = ", line):
                exec(line, names)
            else:
                raise Fault(f"'{line}' is no command, no NAME = VALUE and no PHRASE <- VALUE")
        text = above + below
    return text


def with_prints(block, printed):
    """Python whose comments say what it printed, a line a print()."""
    if len(printed) != len(PRINT.findall(block)):
        raise Fault(f"{len(printed)} lines are printed, and {len(PRINT.findall(block))} comments say so")
    lines = iter(printed)
    return PRINT.sub(lambda match: match[1] + next(lines), block)


def quotes(text):
    """Whether a page quotes what commands print."""
    return bool(FIGURES.search(text)) or any(
        block["named"] or block["printed"] or any(line.strip() for is_command, lines in grouped(block["lines"].splitlines())
                                                  if not is_command for line in lines) for block in BLOCK.finditer(text))


def values_of(place, said):
    """The names for values: of what the commands of a page left in a folder, and of what they said."""
    def report(folder):
        text = (pathlib.Path(place) / folder / "report.json").read_text(encoding="utf-8")
        return json.loads(text, object_hook=lambda keys: types.SimpleNamespace(**keys))

    def found(pattern, text):
        match = re.search(pattern, text)
        if match is None:
            raise Fault(f"'{pattern}' is not in what was printed")
        return float(match[1])

    def heights(file):
        import numpy
        from osgeo import gdal

        dataset = gdal.Open(str(pathlib.Path(place) / file))  # a band lives no longer
        band = dataset.GetRasterBand(1)
        values = band.ReadAsArray().astype(float)
        return numpy.where(values == band.GetNoDataValue(), numpy.nan, values)

    return {"report": report, "said": said, "found": found, "heights": heights, "json": json, "median": statistics.median}


def differences(page, text, right):
    """Lines of a page that differ from what they should be, as PAGE:LINE: what stands there, and what should."""
    old, new, faults = text.splitlines(), right.splitlines(), []
    for what, a, b, c, d in difflib.SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if what != "equal":
            faults.append(f"{page}:{a + 1}: stale\n" + "".join(f"  - {line}\n" for line in old[a:b])
                          + "".join(f"  + {line}\n" for line in new[c:d]))
    return faults
