# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the public headers of lib/thalweg, as clang-format lays them out: namespaces, structs with their fields,
enumerations and functions, each with its comment. It reads what the headers hold, not all that C++ allows."""
from __future__ import annotations

import dataclasses
import pathlib
import re


@dataclasses.dataclass
class Parameter:
    type: str
    name: str
    default: str | None


@dataclasses.dataclass
class Function:
    space: str  # "surface"; "" for namespace thalweg
    name: str
    returns: str
    parameters: list[Parameter]
    comment: str
    header: str


@dataclasses.dataclass
class Field:
    type: str
    name: str
    default: str | None
    comment: str


@dataclasses.dataclass
class Struct:
    space: str
    name: str  # "Diagram::Site" of a nested one
    bases: list[str]
    fields: list[Field]
    comment: str
    header: str


@dataclasses.dataclass
class Enumeration:
    space: str
    name: str
    values: list[tuple[str, str]]  # name, comment
    numbers: dict[str, int]  # of names that are given one
    comment: str
    header: str


@dataclasses.dataclass
class Headers:
    functions: list[Function] = dataclasses.field(default_factory=list)
    structs: list[Struct] = dataclasses.field(default_factory=list)
    enumerations: list[Enumeration] = dataclasses.field(default_factory=list)
    aliases: dict[tuple[str, str], str] = dataclasses.field(default_factory=dict)  # (space, name): type


def split_at(text: str, separator: str) -> list[str]:
    """Splits at a separator outside of brackets."""
    parts, depth, part = [], 0, ""
    for sign in text:
        depth += sign in "<({["
        depth -= sign in ">)}]"
        if sign == separator and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += sign
    return [p.strip() for p in [*parts, part] if p.strip()]


def without_brackets(text: str) -> str:
    """The text with what stands in brackets <> left out."""
    out, depth = "", 0
    for sign in text:
        depth += sign == "<"
        if depth == 0:
            out += sign
        depth -= sign == ">"
    return out


class Reader:
    """Reads one header statement by statement: a statement ends at ; or at the brace that it opens."""

    def __init__(self, path: pathlib.Path, headers: Headers, name: str) -> None:
        self.lines = path.read_text(encoding="utf-8").splitlines()
        self.at = 0
        self.headers = headers
        self.name = name
        head = [line for line in self.lines[:6] if line.startswith(("/// \\internal", "/// \\cpponly"))]
        self.marks = " ".join(line.split()[1] for line in head)  # of all functions of the header

    def skip_block(self, opened: str) -> None:
        depth = opened.count("{") - opened.count("}")
        while depth > 0:
            line = self.lines[self.at].split("//")[0]
            self.at += 1
            depth += line.count("{") - line.count("}")

    def statement(self) -> tuple[str, str, str] | None:
        """The next one: the comment above it, its text, and the comment behind it; None at the end of the block."""
        above: list[str] = []
        text, behind = "", []
        while self.at < len(self.lines):
            line = self.lines[self.at].strip()
            if not text:
                if not line or line.startswith("#") or (line.startswith("//") and not line.startswith("///")):
                    if not line:
                        above = []
                    self.at += 1
                    continue
                if line.startswith("///"):
                    above.append(line[3:].removeprefix(" "))
                    self.at += 1
                    continue
                if line in ("public:", "private:", "protected:"):
                    self.at += 1
                    continue
                if line.startswith("}"):
                    return None
            self.at += 1
            code, _, comment = line.partition("///<")
            if comment:
                behind.append(comment.strip())
            code = code.split("//")[0].strip()
            text = f"{text} {code}".strip()
            opened = text.count("{") - text.count("}")
            if text.endswith((";", "{")) and (
                opened <= 0
                or re.match(r"(namespace|struct|class|enum|template|friend)\b", text)
                or ")" in text
                and text.endswith("{")
            ):
                break
            if text.endswith("}") and opened == 0 and "(" in text.split("{")[0]:  # a function in one line
                break
        if not text:
            return None
        while behind and self.at < len(self.lines) and self.lines[self.at].strip().startswith("///<"):
            behind.append(self.lines[self.at].strip()[4:].strip())
            self.at += 1
        return "\n".join(above), text, " ".join(behind)

    def read(self, space: str, outer: str = "") -> list[Field]:
        """The rest of a block; of a struct its fields."""
        fields: list[Field] = []
        while (found := self.statement()) is not None:
            above, text, behind = found
            self.take(space, outer, above, text, behind, fields)
        if self.at < len(self.lines):  # the closing brace
            self.at += 1
        return fields

    def take(self, space: str, outer: str, above: str, text: str, behind: str, fields: list[Field]) -> None:
        scope = f"{outer}::" if outer else ""
        if match := re.match(r"namespace ([\w:]+) \{$", text):
            whole = f"thalweg::{space}::{match[1]}" if space else match[1]
            self.read(whole.removeprefix("thalweg").removeprefix("::"))
        elif match := re.match(r"struct (\w+)(?: : ([\w:, ]+))? \{$", text):
            bases = [b.strip().removeprefix("public ") for b in (match[2] or "").split(",") if b.strip()]
            inner = self.read(space, scope + match[1])
            self.headers.structs.append(Struct(space, scope + match[1], bases, inner, above, self.name))
        elif match := re.match(r"struct (\w+) \{(.*)\};$", text):
            inner = [f for part in match[2].split(";") if part.strip() for f in [self.field(part.strip() + ";", "", "")] if f]
            self.headers.structs.append(Struct(space, scope + match[1], [], inner, above, self.name))
        elif match := re.match(r"enum (?:class )?(\w+)(?: : [\w:]+)? \{(.*)", text):
            self.enumeration(space, scope + match[1], above or behind, match[2])
        elif match := re.match(r"using (\w+) = (.+);$", text):
            self.headers.aliases[space, scope + match[1]] = match[2]
        elif text.endswith("{"):
            self.skip_block(text)
        elif text.endswith("}"):
            pass
        elif re.match(r"(struct|class|friend|template|extern|static|inline|constexpr|explicit|typedef|\[\[)\b", text):
            pass
        elif "(" in without_brackets(text.split("=")[0].split("{")[0]):
            if not outer:
                self.function(space, above, text)
        elif outer:
            if (made := self.field(text, above, behind)) is not None:
                fields.append(made)

    def field(self, text: str, above: str, behind: str) -> Field | None:
        match = re.match(r"(.+?[\s&*>])(\w+)(?: = (.*)|(\{.*\}))?;$", text)
        if match is None or "operator" in text:
            return None
        comment = behind or " ".join(above.split("\n"))
        return Field(match[1].strip(), match[2], match[3] or match[4], comment)

    def enumeration(self, space: str, name: str, comment: str, first: str) -> None:
        text = first
        values: list[tuple[str, str]] = []
        numbers: dict[str, int] = {}
        if "}" not in text:
            above: list[str] = []
            while not (line := self.lines[self.at].strip()).startswith("}"):
                self.at += 1
                if line.startswith("///<") and values:
                    values[-1] = (values[-1][0], f"{values[-1][1]} {line[4:].strip()}")
                    continue
                if line.startswith("//"):
                    above.append(line.lstrip("/ "))
                    continue
                code, _, behind = line.partition("///<")
                for word in code.split("//")[0].split(","):
                    if word.strip():
                        name_, _, number = (part.strip() for part in word.partition("="))
                        values.append((name_, behind.strip() or " ".join(above)))
                        if number.isdigit():
                            numbers[name_] = int(number)
                above = []
            self.at += 1
        else:
            values = [(w.split("=")[0].strip(), "") for w in text.split("}")[0].split(",") if w.strip()]
        self.headers.enumerations.append(Enumeration(space, name, values, numbers, comment, self.name))

    def function(self, space: str, above: str, text: str) -> None:
        depth = 0
        begin = end = -1
        for place, sign in enumerate(text):
            depth += sign == "<"
            depth -= sign == ">"
            if sign == "(" and depth == 0 and begin < 0:
                begin = place
            if sign == ")":
                end = place
        head = text[:begin].strip()
        match = re.match(r"(.+?[\s&*>])(\w+)$", head)
        if match is None or "operator" in head:
            return
        parameters = []
        for part in split_at(text[begin + 1 : end], ","):
            declared, _, default = part.partition(" = ")
            one = re.match(r"(.+?[\s&*>])(\w+)$", declared.strip())
            if one is None:
                return
            parameters.append(Parameter(one[1].strip(), one[2], default.strip() or None))
        comment = f"{self.marks} {above}" if self.marks else above
        self.headers.functions.append(Function(space, match[2], match[1].strip(), parameters, comment, self.name))


def read_headers(lib: pathlib.Path, modules: list[str]) -> Headers:
    """Reads the public headers of modules.
    lib: the folder with thalweg/ in it."""
    headers = Headers()
    for module in modules:
        for path in sorted((lib / "thalweg" / module).rglob("*.hpp")):
            if "internal" not in path.parts:
                reader = Reader(path, headers, path.relative_to(lib).as_posix())
                reader.read("")
    return headers
