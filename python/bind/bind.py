# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the bindings of the library to Python from its headers: C++ for pybind11 (glue.hpp), docstrings in numpydoc's form,
and type stubs.
Usage: bind.py SOURCE OUT: SOURCE/lib has the headers; OUT gets NAME.cpp of each module, records.hpp and stubs/NAME.pyi.
       bind.py --left-out SOURCE: the functions of the modules that Python does not have, and why.
In a comment, \\internal says that a function is for the modules above, \\cpponly that a function or an enumeration is
for C++ alone; in the head of a header each holds for all its functions."""
from __future__ import annotations

import collections
import keyword
import pathlib
import re
import sys
import textwrap
import unicodedata

from headers import Enumeration, Field, Function, Headers, Parameter, Struct, read_headers, split_at

MODULES = [
    "geometry",
    "solver",
    "flow",
    "growth",
    "network",
    "skeleton",
    "surface",
    "fractal",
    "blend",
    "measure",
    "draw",
    "io",
    "recipe",
    "make",
    "report",
    "exports",
    "ensemble",
    "commands",
]

# The folder of a namespace, and how Python calls it, where these differ: make and ensemble are functions there.
FOLDERS = {"exports": "export"}
CALLED = {"exports": "export", "make": "terrain", "ensemble": "members"}

RUN = ["threads", "progress", "log", "device"]
NUMBERS = {
    "double": "float",
    "float": "float",
    "int": "int",
    "std::int64_t": "int",
    "std::uint64_t": "int",
    "std::int32_t": "int",
    "std::uint32_t": "int",
    "std::uint8_t": "int",
    "std::size_t": "int",
    "char": "int",
}
DTYPES = {
    "double": "np.float64",
    "float": "np.float32",
    "int": "np.int32",
    "std::int64_t": "np.int64",
    "std::int32_t": "np.int32",
    "std::uint32_t": "np.uint32",
    "std::uint8_t": "np.uint8",
    "std::size_t": "np.int64",
    "char": "np.uint8",
    "Vec2": "np.float64",
    "Vec3": "np.float64",
    "Cell": "np.int64",
    "std::uint64_t": "np.uint64",
}
TEXTS = {"std::string", "std::string_view", "char const*", "io::Source"}
# What only the library makes: parts of a terrain that belong together.
ONLY_MADE = {("recipe", "Plan")} | {("make", name) for name in ("Ground", "Planform", "Terrain", "Water", "MakeResult", "Assessment", "SurfaceMeasures", "Rivers", "RiverFile")}
# By hand: by_hand.cpp binds it.
BY_HAND = {("", "StreamNetwork"), ("draw", "Picture")}
# These cross in another way: by glue.hpp, or as keywords.
NOT_RECORDS = {
    ("", "Finding"),
    ("", "Check"),
    ("", "Vec2"),
    ("", "Vec3"),
    ("", "Cell"),
    ("io", "Source"),
    ("", "Run"),
}


def bare(type_: str) -> str:
    """A type without const, reference and space around it."""
    text = type_.strip().removesuffix("&").strip()
    text = text.removesuffix(" const").removeprefix("const ").strip()
    return text


def arguments_of(type_: str) -> tuple[str, list[str]]:
    """A template and its arguments."""
    match = re.match(r"([\w:]+)<(.*)>$", type_)
    return (match[1], split_at(match[2], ",")) if match else (type_, [])


def called(space: str) -> str:
    """How Python calls the module of a namespace."""
    return CALLED.get(space, space)


def safe(name: str) -> str:
    return name + "_" if keyword.iskeyword(name) else name


class Binder:
    def __init__(self, source: pathlib.Path) -> None:
        self.headers: Headers = read_headers(source / "lib", ["core", *(FOLDERS.get(m, m) for m in MODULES)])
        self.cite = self.citations((source / "docs" / "references.bib").read_text(encoding="utf-8"))
        self.structs = {(s.space, s.name): s for s in self.headers.structs}
        self.enumerations = {(e.space, e.name): e for e in self.headers.enumerations}
        self.left_out: list[tuple[str, str]] = []
        self.functions: dict[str, list[Function]] = collections.defaultdict(list)  # by space, overloads beside one another
        self.records: dict[tuple[str, str], Struct] = {}
        self.by_hand = self.functions_by_hand()
        self.choose()

    @staticmethod
    def functions_by_hand() -> set[tuple[str, str]]:
        """The functions that by_hand.cpp binds, by space."""
        text = (pathlib.Path(__file__).parent / "by_hand.cpp").read_text(encoding="utf-8")
        return {
            (match[1], name)
            for match in re.finditer(r"^void define_(\w+)_by_hand\(.*?^\}", text, re.MULTILINE | re.DOTALL)
            for name in re.findall(r'add_function\(\s*module, "(\w+)"', match[0])
        }

    @staticmethod
    def citations(bib: str) -> dict[str, tuple[str, str]]:
        """By key: as a text names a work, and the work."""

        def accented(match: re.Match[str]) -> str:
            return unicodedata.normalize(
                "NFC", match[2] + {'"': "\u0308", "'": "\u0301", "`": "\u0300", "^": "\u0302", "~": "\u0303"}[match[1]]
            )

        found = {}
        for key, body in re.findall(r"^@\w+\{(\w+), (.*)\}$", bib, re.MULTILINE):
            body = re.sub(r"\{\\([\"'`^~])(\w)\}", accented, body)
            fields = {
                k: re.sub(r"[{}]", "", v).replace("--", "-")
                for k, v in re.findall(r"(\w+) = \{((?:[^{}]|\{[^{}]*\})*)\}", body)
            }
            authors = fields["author"].split(" and ")
            names = [a.split(",")[0] for a in authors]
            who = names[0] if len(names) == 1 else " and ".join(names) if len(names) == 2 else f"{names[0]} et al."
            where = next(
                (fields[k] for k in ("journal", "booktitle", "publisher", "school", "institution", "note") if k in fields), ""
            )
            year = fields.get("year", "")
            found[key] = (
                f"{who} {year}".strip(),
                " ".join(f"{'; '.join(authors)} {year}: {fields['title']}. {where}".split()).rstrip(".") + ".",
            )
        return found

    # -- What there is ------------------------------------------------------------------------------------------------

    def resolve(self, name: str, space: str, outer: str = "") -> tuple[str, str] | None:
        """The struct or enumeration that a name means in a namespace, within structs."""
        scopes = []
        parts = outer.split("::") if outer else []
        while parts:
            scopes.append((space, "::".join([*parts, name])))
            parts.pop()
        scopes += [(space, name), ("", name)]
        if "::" in name:
            first, rest = name.split("::", 1)
            scopes.append((first, rest))
        for scope in scopes:
            if scope in self.structs or scope in self.enumerations or scope in BY_HAND or scope in self.headers.aliases:
                return scope
        return None

    def expanded(self, type_: str, space: str, outer: str = "") -> str:
        """A type without aliases and with whole names: "vector<flow::Reach>"."""
        text = bare(type_)
        if text.endswith("*"):
            return self.expanded(text[:-1], space, outer) + "*" if text != "char const*" else text
        name, arguments = arguments_of(text)
        if arguments:
            return f"{name}<{', '.join(self.expanded(a, space, outer) for a in arguments)}>"
        if name in NUMBERS or name in TEXTS or name == "bool" or name.startswith("std::"):
            return name
        scope = self.resolve(name, space, outer)
        if scope is None:
            return name
        if scope in self.headers.aliases:
            return self.expanded(self.headers.aliases[scope], scope[0], scope[1].rpartition("::")[0])
        return f"{scope[0]}::{scope[1]}" if scope[0] else scope[1]

    def scope_of(self, whole: str) -> tuple[str, str]:
        first, _, rest = whole.partition("::")
        return (first, rest) if rest and first in ["core", *MODULES] else ("", whole)

    def names_in(self, whole: str) -> list[tuple[str, str]]:
        """The structs of ours that a whole type is made of."""
        found = []
        for word in re.findall(r"[\w:]+", re.sub(r"std::function<.*>", "", whole)):
            scope = self.scope_of(word)
            if scope in self.structs and scope not in NOT_RECORDS:
                found.append(scope)
        return found

    def can_cross(self, whole: str) -> bool:
        """Whether glue.hpp has a way for a type."""
        name, arguments = arguments_of(whole.removesuffix("*").removesuffix(" const"))
        if whole.startswith("std::function"):
            return whole.startswith("std::function<double(double")
        if name in ("std::vector", "std::optional", "std::span", "Required"):
            return self.can_cross(bare(arguments[0])) and "LargePages" not in whole
        if name in ("std::pair", "std::map", "std::variant"):
            return all(self.can_cross(a) for a in arguments)
        if name == "std::array":
            return self.can_cross(arguments[0])
        if name == "Raster":
            return arguments[0] in DTYPES or self.scope_of(arguments[0]) in self.enumerations
        if name in NUMBERS or name in TEXTS or name in ("bool", "std::monostate", "void"):
            return True
        scope = self.scope_of(name)
        return (
            scope in self.enumerations
            or scope in BY_HAND
            or (scope in self.structs and scope not in {("", "Run"), ("", "NetworkDraft")})
        )

    def fields_of(self, scope: tuple[str, str]) -> list[tuple[tuple[str, str], Field, str]]:
        """The fields of a struct, those of its bases first: the struct that has it, the field, its whole type."""
        struct = self.structs[scope]
        found = []
        for base in struct.bases:
            of = self.resolve(base, struct.space)
            if of is not None and of in self.structs:
                found += self.fields_of(of)
        return found + [(scope, f, self.expanded(f.type, struct.space, struct.name)) for f in struct.fields]

    def is_sheet(self, whole: str) -> bool:
        """Whether a struct refers to values of others: its fields become arguments."""
        scope = self.scope_of(whole)
        return scope in self.structs and any(f.type.endswith("const&") for f in self.structs[scope].fields)

    def is_params(self, function: Function, number: int) -> bool:
        """Whether an argument's fields become keywords."""
        whole = self.expanded(function.parameters[number].type, function.space)
        is_last = number == len(function.parameters) - 1 or (
            number == len(function.parameters) - 2 and self.is_run(function.parameters[-1])
        )
        return whole.endswith("Params") and is_last and self.scope_of(whole) in self.structs

    @staticmethod
    def is_run(parameter: Parameter) -> bool:
        return bare(parameter.type) == "Run"

    def is_word(self, takes: list[str], gives: str) -> bool:
        """Whether a function gives the word of an enumeration, or finds the enumeration by its word."""
        gives = arguments_of(gives)[1][0] if gives.startswith("std::optional<") else gives
        if gives in TEXTS:
            return len(takes) == 1 and self.scope_of(takes[0]) in self.enumerations
        return self.scope_of(gives) in self.enumerations and bool(takes) and all(t in TEXTS for t in takes)

    def choose(self) -> None:
        for function in self.headers.functions:
            whole = f"{function.space}::{function.name}" if function.space else function.name
            types = [self.expanded(p.type, function.space) for p in function.parameters if not self.is_run(p)]
            reason = None
            if "\\internal" in function.comment:
                reason = "for modules above"
            if reason is None and "\\cpponly" in function.comment:
                reason = "for C++ alone"
            if reason is None and (function.space, function.name) in self.by_hand:
                reason = "by_hand.cpp has it"
            if reason is None and self.is_word(types, self.expanded(function.returns, function.space)):
                reason = "a word is a str"
            if reason is None and any(re.search(r"(?<!const)&$", p.type.replace(" &", "&")) for p in function.parameters):
                reason = "it changes its argument"
            if reason is None and not all(self.can_cross(t) for t in [*types, self.expanded(function.returns, function.space)]):
                reason = "a type of it does not cross to Python"
            if reason is None and "::" in function.space:
                reason = "a part of a stage"
            if reason is not None:
                self.left_out.append((whole, reason))
            else:
                self.functions[function.space].append(function)
        waiting: list[tuple[str, str]] = []
        for functions in self.functions.values():
            for function in functions:
                waiting += self.names_in(self.expanded(function.returns, function.space))
                for number, parameter in enumerate(function.parameters):
                    whole = self.expanded(parameter.type, function.space)
                    if self.is_params(function, number) or self.is_sheet(whole):
                        for _, _, type_ in self.fields_of(self.scope_of(whole)):
                            waiting += self.names_in(type_)
                    else:
                        waiting += self.names_in(whole)
        waiting.append(("", "Grid"))
        while waiting:
            scope = waiting.pop()
            if (
                scope in self.records
                or scope in BY_HAND
                or scope in NOT_RECORDS
                or self.is_sheet("::".join(filter(None, scope)))
            ):
                continue
            self.records[scope] = self.structs[scope]
            for _, _, type_ in self.fields_of(scope):
                if self.can_cross(type_):
                    waiting += self.names_in(type_)
            if "::" in scope[1] and (scope[0], scope[1].rpartition("::")[0]) in self.structs:
                waiting.append((scope[0], scope[1].rpartition("::")[0]))

    # -- Words --------------------------------------------------------------------------------------------------------

    def literal(self, default: str | None, whole: str) -> str:
        """A default as Python writes it, or "..."."""
        name, _ = arguments_of(whole)
        if default is None or default in ("{}", f"{whole}{{}}"):
            if name == "std::optional" or whole.endswith("*") or name == "Raster" or whole.startswith("std::function"):
                return "None"
            if name in ("std::vector", "std::map"):
                return "()" if name == "std::vector" else "{}"
            if whole in TEXTS:
                return "''"
            if whole in NUMBERS:
                return "0.0" if NUMBERS[whole] == "float" else "0"
            if whole == "bool":
                return "False"
            scope = self.scope_of(whole)
            if scope in self.enumerations:
                return repr(self.enumerations[scope].values[0][0])
            if whole in ("Vec2", "Vec3", "Cell"):
                return {"Vec2": "(0.0, 0.0)", "Vec3": "(0.0, 0.0, 0.0)", "Cell": "(0, 0)"}[whole]
            return "None" if scope in self.records else "..."
        text = default.replace("'", "")
        if text in ("true", "false"):
            return text.capitalize()
        if text in ("nullptr", "std::nullopt"):
            return "None"
        if re.fullmatch(r'"[^"\\]*"', text):
            return repr(text[1:-1])
        if re.fullmatch(r"-?\d+", text) and whole in NUMBERS:
            return f"{text}.0" if NUMBERS[whole] == "float" else text
        if re.fullmatch(r"-?[\d.]+(e-?\d+)?", text) and whole in NUMBERS:
            return text
        if (match := re.fullmatch(r"[\w:]*::(\w+)", text)) and self.scope_of(whole) in self.enumerations:
            return repr(match[1])
        return "..."

    def words_of(self, scope: tuple[str, str]) -> list[str]:
        return [v for v, _ in self.enumerations[scope].values]

    def python_type(self, whole: str, into: bool, module: str) -> str:
        """The annotation of a type. into: of an argument."""
        name, arguments = arguments_of(whole)
        if whole.endswith("*") and whole != "char const*":
            return self.python_type(whole[:-1].removesuffix(" const"), into, module) + " | None"
        if whole in TEXTS:
            return "str | os.PathLike[str]" if into else "str"
        if whole == "bool" or whole in NUMBERS:
            return NUMBERS.get(whole, "bool")
        if whole in ("void", "std::monostate"):
            return "None"
        if whole in ("Finding", "Check"):
            return "dict[str, Any]"
        if name == "Required":
            return self.python_type(arguments[0], into, module)
        if whole in ("Vec2", "Vec3", "Cell"):
            one = "int" if whole == "Cell" else "float"
            return "npt.ArrayLike" if into else f"tuple[{', '.join([one] * (3 if whole == 'Vec3' else 2))}]"
        if name == "std::optional":
            inner = self.python_type(arguments[0], into, module)
            return inner if inner.endswith("| None") else inner + " | None"
        if name == "Raster":
            return "RasterLike" if into else "Raster"
        if name in ("std::vector", "std::span", "std::array"):
            element = bare(arguments[0])
            if name == "std::vector" and (element in DTYPES or (arguments_of(element)[0] == "std::array")):
                inner = element if element in DTYPES else arguments_of(element)[1][0]
                return "npt.ArrayLike" if into else f"npt.NDArray[{DTYPES.get(inner, 'np.float64')}]"
            if name == "std::vector" and arguments_of(element)[0] == "std::pair" and not into:
                pair = arguments_of(element)[1]
                if pair[0] in TEXTS:
                    return f"dict[str, {self.python_type(pair[1], into, module)}]"
            if into:
                return "npt.ArrayLike" if element in DTYPES else f"Sequence[{self.python_type(element, into, module)}]"
            return f"{'list[' if name == 'std::vector' else 'tuple['}{self.python_type(element, into, module)}" + (
                "]" if name == "std::vector" else ", ...]"
            )
        if name == "std::pair":
            return f"tuple[{', '.join(self.python_type(a, into, module) for a in arguments)}]"
        if name == "std::map":
            return f"{'Mapping' if into else 'dict'}[str, {self.python_type(arguments[1], into, module)}]"
        if name == "std::variant":
            return " | ".join(dict.fromkeys(self.python_type(a, into, module) for a in arguments))
        if whole.startswith("std::function"):
            return "Callable[[float], float] | None"
        scope = self.scope_of(whole)
        if scope in self.enumerations:
            return f"Literal[{', '.join(repr(w) for w in self.words_of(scope))}]" if into else "str"
        shown = scope[1].replace("::", ".")
        if scope[0] and scope[0] != module:
            shown = f"_{called(scope[0])}.{shown}"  # no property has such a name
        if into and scope in self.records:
            if self.is_held_raster(scope):
                return f"{shown} | RasterLike"
            return f"{shown} | dict[str, Any]"
        return shown

    def is_held_raster(self, scope: tuple[str, str]) -> bool:
        return scope in {("", "Valley"), ("", "Skeleton")}

    def prose(self, text: str) -> str:
        text = re.sub(r"\\cite (\w+)", lambda m: self.cite[m[1]][0], text)
        text = re.sub(r"(\w)::(\w)", r"\1.\2", text.replace("\\\\", "\\").replace("nullptr", "None"))
        return " ".join(text.split())

    def parsed(self, comment: str) -> dict[str, object]:
        """The parts of a comment: said, params, returns, throws, source."""
        parts: dict[str, object] = {"said": "", "params": {}, "returns": "", "throws": [], "source": ""}
        blocks: list[tuple[str, str]] = [("said", "")]
        for line in comment.split("\n"):
            # two of them may stand in one line
            for piece in re.split(r"(?=\\(?:param|return|throws|pre|post|tparam)\b)", line):
                if match := re.match(r"\\(param|return|throws|pre|post|tparam)\s*(.*)", piece):
                    blocks.append((match[1], match[2]))
                elif match := re.match(r"Source: (.*)", piece):
                    blocks.append(("source", match[1]))
                elif not piece.strip() and blocks[-1][0] != "said":
                    blocks.append(("said", ""))
                else:
                    blocks[-1] = (blocks[-1][0], f"{blocks[-1][1]} {piece}" if piece.strip() else blocks[-1][1] + "\n")
        params: dict[str, str] = {}
        throws: list[tuple[str, str]] = []
        said: list[str] = []
        for kind, text in blocks:
            if kind == "param" and (match := re.match(r"(\w+(?:,\w+)*)\s*(.*)", text, re.DOTALL)):
                for name in match[1].split(","):
                    params[name] = self.prose(match[2])
            elif kind == "return":
                parts["returns"] = self.prose(text)
            elif kind == "throws" and (match := re.match(r"(\w+)\s*(.*)", text, re.DOTALL)):
                throws.append((match[1], self.prose(match[2])))
            elif kind == "source":
                parts["source"] = self.prose(text)
            elif kind == "pre":
                said.append(self.prose(f"Requires: {text}"))
            elif kind in ("said", "post") and text.strip():
                said.append(self.prose(text))
        parts["said"] = "\n\n".join(said)
        parts["params"] = params
        parts["throws"] = throws
        return parts

    # -- One function -------------------------------------------------------------------------------------------------

    def arguments(self, function: Function) -> list[dict[str, str]]:
        """What Python passes: name, kind (positional, keyword), type (whole), default (None: it must be given), says."""
        said = self.parsed(function.comment)
        params = said["params"]
        assert isinstance(params, dict)
        found: list[dict[str, str]] = []
        given = {p.name for p in function.parameters}
        for number, parameter in enumerate(function.parameters):
            if self.is_run(parameter):
                continue
            whole = self.expanded(parameter.type, function.space)
            if self.is_params(function, number) or self.is_sheet(whole):
                for _, field, type_ in self.fields_of(self.scope_of(whole)):
                    if not self.can_cross(type_) or field.name in given:  # the argument, not its name for messages
                        continue
                    is_given = field.type.endswith("const&")
                    must = is_given or arguments_of(type_)[0] == "Required"
                    found.append(
                        {
                            "name": safe(field.name),
                            "kind": "positional" if is_given else "keyword",
                            "type": type_,
                            "default": "" if must else self.literal(field.default, type_),
                            "says": self.prose(field.comment),
                        }
                    )
            else:
                is_pointer = whole.endswith("*") and whole != "char const*"
                found.append(
                    {
                        "name": safe(parameter.name),
                        "kind": "positional",
                        "type": whole,
                        "default": "None"
                        if is_pointer
                        else ""
                        if parameter.default is None
                        else self.literal(parameter.default, whole),
                        "says": params.get(parameter.name, ""),
                    }
                )
        found.sort(key=lambda a: a["kind"] != "positional")
        positional = [a for a in found if a["kind"] == "positional"]
        for argument, after in zip(positional[-2::-1], positional[:0:-1]):
            if not after["default"]:
                argument["default"] = ""  # what may be None is given all the same
        names = [a["name"] for a in found]
        if len(set(names)) != len(names) or set(names) & set(RUN):
            raise SystemExit(f"bind.py: {function.space}::{function.name}: an argument has the name of another: {names}")
        return found

    def signature(self, function: Function, stub: bool) -> str:
        found = self.arguments(function)
        parts = []
        for argument in found:
            if argument["kind"] == "keyword" and "*" not in parts:
                parts.append("*")
            annotation = f": {self.python_type(argument['type'], True, function.space)}" if stub else ""
            default = "" if not argument["default"] else f" = {argument['default']}" if stub else f"={argument['default']}"
            if stub and argument["default"] == "None" and not annotation.endswith("| None"):
                annotation += " | None"
            if stub and argument["default"] in ("()", "{}"):
                default = " = ..."
            parts.append(f"{argument['name']}{annotation}{default}")
        if any(self.is_run(p) for p in function.parameters):
            if "*" not in parts:
                parts.append("*")
            parts += (
                [
                    "threads: int = 0",
                    "progress: Progress = None",
                    "log: Callable[[str], object] | None = None",
                    "device: Literal['cpu', 'opencl'] = 'cpu'",
                ]
                if stub
                else ["threads=0", "progress=None", "log=None", "device='cpu'"]
            )
        returns = (
            f" -> {self.python_type(self.expanded(function.returns, function.space), False, function.space)}" if stub else ""
        )
        return f"{safe(function.name)}({', '.join(parts)}){returns}"

    def words_for(self, argument: dict[str, str], module: str) -> list[str]:
        """The entry of an argument or attribute in a docstring."""
        type_ = re.sub(r"\b_([a-z]+\.)", r"\1", self.python_type(argument["type"], argument.get("kind", "") != "", module))
        type_ = (
            re.sub(r"Literal\[(.*?)\]", r"{\1}", type_).replace("npt.NDArray", "ndarray").replace("npt.ArrayLike", "array_like")
        )
        type_ = type_.replace("os.PathLike[str]", "path").replace("np.", "")
        default = argument.get("default", "")
        says = argument["says"]
        scope = self.scope_of(argument["type"])
        if scope in self.enumerations:
            told = [f"'{v}': {self.prose(c)}" for v, c in self.enumerations[scope].values if c]
            says = ". ".join(filter(None, [says.rstrip("."), "; ".join(told)]))
        says = self.with_unit(says, argument["type"], argument["name"])
        says = ". ".join(filter(None, [says.rstrip("."), self.codes(argument["type"])]))
        lines = [f"{argument['name']} : {type_}" + (f", default {default}" if default not in ("", "...") else "")]
        return lines + ([self.wrapped(says, "    ")] if says else [])

    @staticmethod
    def with_unit(says: str, whole: str, name: str) -> str:
        """What is said of a value, with its unit: positions are metres, other numbers of which no unit is said have none."""
        if "[" in says or re.search(r"_(m|m2|m3|km2|deg|rad|cells|px|s)$", name):
            return says
        numbers = whole
        while arguments_of(numbers)[0] in ("std::vector", "std::optional", "std::span"):
            numbers = bare(arguments_of(numbers)[1][0])
        if numbers in ("Vec2", "Vec3"):
            return f"[m] {says}".strip()
        return f"[-] {says}".strip() if numbers in ("double", "float") else says

    def codes(self, whole: str) -> str:
        """What the numbers of a raster of an enumeration mean; "" of any other type."""
        name, arguments = arguments_of(whole)
        if name != "Raster" or self.scope_of(arguments[0]) not in self.enumerations:
            return ""
        enumeration = self.enumerations[self.scope_of(arguments[0])]
        told, number = [], 0
        for word, comment in enumeration.values:
            number = enumeration.numbers.get(word, number)
            told.append(f"{number} {word.replace('_', ' ')}" + (f" ({self.prose(comment)})" if comment else ""))
            number += 1
        return f"Codes, uint8: {', '.join(told)}"

    @staticmethod
    def wrapped(text: str, indent: str = "") -> str:
        return "\n\n".join(
            textwrap.fill(
                p, 100, initial_indent=indent, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
            )
            for p in text.split("\n\n")
        )

    def docstring(self, overloads: list[Function]) -> str:
        """numpydoc, with the signature in the form that inspect reads where there is one."""
        function = max(overloads, key=lambda f: len(f.comment))
        said = self.parsed(function.comment)
        signatures = [self.signature(f, False) for f in overloads]
        text = f"{signatures[0] if len(overloads) == 1 else self.common_signature(overloads)}\n--\n\n"
        summary = str(said["said"])
        text += self.wrapped(summary or f"Gives {function.name.replace('_', ' ')}.") + "\n"
        if len(overloads) > 1:
            text += "\nCalls\n-----\n" + "\n".join(signatures) + "\n"
        every: dict[str, dict[str, str]] = {}
        for one in [function, *overloads]:
            for argument in self.arguments(one):
                if argument["name"] not in every or not every[argument["name"]]["says"]:
                    every[argument["name"]] = argument
        runs = any(self.is_run(p) for f in overloads for p in f.parameters)
        if every or runs:
            text += "\nParameters\n----------\n"
            for argument in every.values():
                text += "\n".join(self.words_for(argument, function.space)) + "\n"
            if runs:
                text += (
                    "threads, progress, log, device\n    How the work runs, as for `thalweg.make`; the result is the same.\n"
                )
        returned = self.expanded(function.returns, function.space)
        type_ = self.python_type(returned, False, function.space).replace("npt.NDArray", "ndarray").replace("np.", "")
        type_ = re.sub(r"\b_([a-z]+\.)", r"\1", type_)
        text += f"\nReturns\n-------\n{type_}\n" + (
            self.wrapped(str(said["returns"]), "    ") + "\n" if said["returns"] else ""
        )
        throws = said["throws"]
        assert isinstance(throws, list)
        if throws:
            text += "\nRaises\n------\n" + "".join(
                f"{name}\n{self.wrapped(why or 'As the stages it calls.', '    ')}\n" for name, why in throws
            )
        cited = sorted({self.cite[key][1] for f in overloads for key in re.findall(r"\\cite (\w+)", f.comment)})
        if said["source"] or cited:
            text += (
                "\nReferences\n----------\n" + "\n\n".join(self.wrapped(t) for t in [str(said["source"]), *cited] if t) + "\n"
            )
        return text

    def common_signature(self, overloads: list[Function]) -> str:
        """One signature for all forms, as inspect reads it: *others from where they differ."""
        forms = [self.arguments(f) for f in overloads]
        positional = [[a["name"] for a in form if a["kind"] == "positional"] for form in forms]
        longest = max(positional, key=len)
        parts: list[str] = []
        for number, name in enumerate(longest):
            if any(form[number : number + 1] != [name] for form in positional):
                parts.append("*others")
                break
            parts.append(name)
        keywords = {a["name"]: a["default"] or "None" for form in forms for a in form if a["kind"] == "keyword"}
        if any(self.is_run(p) for f in overloads for p in f.parameters):
            keywords |= {"threads": "0", "progress": "None", "log": "None", "device": "'cpu'"}
        if keywords:
            parts += ([] if parts and parts[-1] == "*others" else ["*"]) + [f"{name}={default}" for name, default in keywords.items()]
        return f"{safe(overloads[0].name)}({', '.join(parts)})"

    # -- C++ ----------------------------------------------------------------------------------------------------------

    def held(self, whole: str, name: str, handle: str, place: str) -> str:
        scope = self.scope_of(whole)
        if scope in self.records or scope in BY_HAND:
            return f"        Held<{whole}> const arg_{name}({handle}, {place});\n"
        kind = "std::string" if whole in ("std::string_view", "char const*") else whole
        if match := re.match(r"std::span<(.*?)(?: const)?>$", whole):
            kind = f"std::vector<{match[1]}>"
        return f"        auto const arg_{name} = take<{kind}>({handle}, {place});\n"

    def passed(self, whole: str, name: str) -> str:
        scope = self.scope_of(whole)
        if whole == "char const*":
            return f"arg_{name}.c_str()"
        return f"*arg_{name}" if scope in self.records or scope in BY_HAND else f"arg_{name}"

    def body(self, function: Function) -> str:
        text = ""
        passed = []
        runs = False
        says = self.parsed(function.comment)["params"]
        assert isinstance(says, dict)
        for number, parameter in enumerate(function.parameters):
            if self.is_run(parameter):
                runs = True
                passed.append("run")
                continue
            whole = self.expanded(parameter.type, function.space)
            name = safe(parameter.name)
            if self.is_params(function, number) or self.is_sheet(whole):
                text += self.flattened(whole, {p.name for p in function.parameters})
                passed.append("params" if self.is_params(function, number) else "sheet")
                continue
            if whole.endswith("*") and whole != "char const*":
                pointed = whole[:-1].strip().removesuffix("const").strip()
                text += (
                    f"        std::optional<Held<{pointed}>> arg_{name};\n"
                    f'        if (py::handle const value = in.next("{name}"); value && !value.is_none()) {{\n'
                    f'            arg_{name}.emplace(value, in.place("{name}"));\n        }}\n'
                )
                passed.append(f"arg_{name} ? &**arg_{name} : nullptr")
                continue
            if parameter.default is None:
                is_value = whole.startswith("Raster<") and not re.search(r"empty|without cells", says.get(parameter.name, ""))
                given = "required_value" if is_value else "required"
                text += self.held(whole, name, f'in.{given}("{name}")', f'in.place("{name}")')
            else:
                kind = "std::string" if whole in ("std::string_view", "char const*") else whole
                default = parameter.default
                if default == "{}":
                    default = ""
                elif not default.startswith('"') and re.search(r"[A-Za-z_]\w*::", default) and not default.startswith("std::"):
                    default = f"{function.space}::{default}" if self.scope_of(whole)[0] == function.space else default
                text += f'        {kind} arg_{name}{{{default}}};\n        in.field("{name}", arg_{name});\n'
                passed.append(f"arg_{name}")
                continue
            passed.append(self.passed(whole, name))
        call = f"thalweg::{function.space}::{function.name}" if function.space else f"thalweg::{function.name}"
        lead = "return in.run([&](Run const& run) {" if runs else "return in.call([&] {"
        return text + f"        {lead} return {call}({', '.join(passed)}); }});\n"

    def flattened(self, whole: str, given: set[str]) -> str:
        """Declares the value of a struct, params or sheet, of which each field is an argument.
        given: names of the function's own arguments"""
        scope = self.scope_of(whole)
        variable = "params" if whole.endswith("Params") else "sheet"
        before = initial = after = ""
        for _, field, type_ in self.fields_of(scope):
            if not self.can_cross(type_) or field.name in given:
                continue
            name = safe(field.name)
            if field.type.endswith("const&"):
                before += self.held(type_, name, f'in.required("{name}")', f'in.place("{name}")')
                initial += f".{field.name} = {self.passed(type_, name)}, "
            elif arguments_of(type_)[0] == "Required":
                inner = arguments_of(type_)[1][0]
                initial += f'.{field.name} = take<{inner}>(in.required_by_name("{name}"), in.place("{name}")), '
            elif type_.endswith("*") and type_ != "char const*":
                pointed = type_[:-1].strip().removesuffix("const").strip()
                record = self.scope_of(pointed) in self.records or self.scope_of(pointed) in BY_HAND
                kind = f"Held<{pointed}>" if record else pointed
                before += f"        std::optional<{kind}> arg_{name};\n"
                made = (
                    f'arg_{name}.emplace(value, in.place("{name}"))'
                    if record
                    else (f'arg_{name}.emplace(take<{pointed}>(value, in.place("{name}")))')
                )
                after += (
                    f'        if (py::handle const value = in.named("{name}"); value && !value.is_none()) {{\n            {made};\n'
                    f"            {variable}.{field.name} = &*{'*' if record else ''}arg_{name};\n        }}\n"
                )
            elif self.is_taken(type_):
                after += f'        in.option("{name}", {variable}.{field.name});\n'
        if self.scope_of(whole) in self.structs and not initial:
            return f"{before}        {whole} {variable};\n{after}"
        return f"{before}        {whole} {variable}{{{initial.rstrip(', ')}}};\n{after}"

    def is_taken(self, whole: str) -> bool:
        """Whether Python can give a value of a type."""
        return self.can_cross(whole) and not re.search(r"char const\*|std::string_view|std::span|\*$|\bCheck\b", whole)

    def overloaded(self, overloads: list[Function]) -> str:
        if len(overloads) == 1:
            return self.body(overloads[0])

        # What takes records of ours is asked first: others take anything.
        def known(function: Function) -> list[tuple[int, str, str]]:
            found = []
            for number, parameter in enumerate(p for p in function.parameters if not self.is_run(p)):
                whole = self.expanded(parameter.type, function.space)
                scope = self.scope_of(whole)
                if (
                    (scope in self.records or scope in BY_HAND)
                    and parameter.default is None
                    and not whole.endswith("Params")
                    and not self.is_held_raster(scope)
                ):
                    found.append((number, safe(parameter.name), whole))
            return found

        ordered = sorted(overloads, key=lambda f: -len(known(f)))
        text = "        switch (in.choose({\n"
        for function in ordered:
            found = self.arguments(function)
            positional = [a for a in found if a["kind"] == "positional"]
            names = ", ".join(f'"{a["name"]}"' for a in positional)
            keywords = ", ".join(f'"{a["name"]}"' for a in found if a["kind"] == "keyword")
            required = sum(not a["default"] for a in positional)
            runs = "true" if any(self.is_run(p) for p in function.parameters) else "false"
            tests = " && ".join(f'is_given<{whole}>(args.peek({number}, "{name}"))' for number, name, whole in known(function))
            types = f", [](Args& args) {{ return {tests}; }}" if tests else ""
            text += f"            Args::Form{{{{{names}}}, {required}, {{{keywords}}}, {runs}{types}}},\n"
        text += "        })) {\n"
        for number, function in enumerate(ordered):
            label = f"case {number}:" if number < len(ordered) - 1 else "default:"
            text += f"        {label} {{\n{self.body(function)}        }}\n"
        return text + "        }\n"

    def is_made(self, scope: tuple[str, str]) -> bool:
        """Whether Python can make a record of its fields."""
        fields = [(f, t) for _, f, t in self.fields_of(scope)]
        return (scope not in ONLY_MADE and any(self.is_taken(t) for _, t in fields)
                and not any(arguments_of(t)[0] == "Required" or (f.default is None and t.endswith("*")) for f, t in fields))

    def record_declaration(self, scope: tuple[str, str]) -> str:
        whole = "::".join(filter(None, scope))
        takes = [f for _, f, t in self.fields_of(scope) if self.is_taken(t)]
        can = f"std::is_default_constructible_v<{whole}>" if self.is_made(scope) else "false"
        name = scope[1].replace("::", ".")
        parts = [f"{safe(f.name)}={self.literal(f.default, t)}" for _, f, t in self.fields_of(scope) if self.is_taken(t)]
        signature = f"__init__(self, {', '.join(parts)})\\n--\\n\\n"
        return f"""template <> struct Fields<{whole}> {{
    static constexpr bool can_be_made = {can};
    static constexpr bool is_raster = {'true' if self.is_held_raster(scope) else 'false'};
    static constexpr char const* name = "{name}";
    static constexpr char const* signature = "{signature}";
    static {whole} made(Args& in);
    static {whole} take(py::handle value, Place const& place) {{ return take_record<{whole}>(value, place); }}
}};
"""

    def record_definition(self, scope: tuple[str, str]) -> str:
        whole = "::".join(filter(None, scope))
        takes = [(f, t) for _, f, t in self.fields_of(scope) if self.is_taken(t)]
        if not self.is_made(scope):
            return ""
        text = f"{whole} Fields<{whole}>::made(Args& in) {{\n    {whole} made{{}};\n"
        for field, _ in takes:
            text += f'    in.field("{safe(field.name)}", made.{field.name});\n'
        return text + "    in.done();\n    require_sound(made);\n    return made;\n}\n\n"

    def record_words(self, scope: tuple[str, str]) -> str:
        struct = self.structs[scope]
        said = self.parsed(struct.comment)
        text = (
            self.wrapped(str(said["said"])) or f"A value of thalweg.{'.'.join(filter(None, (called(scope[0]), scope[1]))).replace('::', '.')}."
        ) + "\n\nAttributes\n----------\n"
        for _, field, type_ in self.fields_of(scope):
            if self.can_cross(type_):
                argument = {"name": safe(field.name), "type": type_, "says": self.prose(field.comment)}
                text += "\n".join(self.words_for(argument, scope[0])) + "\n"
        return text

    def record_binding(self, scope: tuple[str, str]) -> str:
        whole = "::".join(filter(None, scope))
        name = scope[1].rpartition("::")[2]
        outer = scope[1].rpartition("::")[0]
        parent = f'type_{outer.replace("::", "_")}' if outer and (scope[0], outer) in self.records else "module"
        module = f"thalweg.{called(scope[0])}" if scope[0] else "thalweg._core"
        text = (
            f'    auto type_{scope[1].replace("::", "_")} = add_record<{whole}>({parent}, "{name}", R"words({self.record_words(scope)})words", '
            f'"{module}");\n'
        )
        return text

    def getters(self, scope: tuple[str, str]) -> str:
        whole = "::".join(filter(None, scope))
        variable = f"type_{scope[1].replace('::', '_')}"
        text = ""
        names = []
        for of, field, type_ in self.fields_of(scope):
            if not self.can_cross(type_):
                continue
            names.append(f'"{safe(field.name)}"')
            owner = "::".join(filter(None, of))
            says = self.with_unit(self.prose(field.comment), type_, field.name)
            says = ". ".join(filter(None, [says.rstrip("."), self.codes(type_)])).replace('"', '\\"').replace("\\u", "\\\\u")
            text += f'    add_getter({variable}, "{safe(field.name)}", R"words({says})words", &get<{whole}, &{owner}::{field.name}>);\n'
        return text + f"    finish_record({variable}, {{{', '.join(names)}}});\n"

    def grouped(self, space: str) -> list[list[Function]]:
        by_name: dict[str, list[Function]] = collections.defaultdict(list)
        for function in self.functions.get(space, []):
            by_name[function.name].append(function)
        return [self.without_covered(overloads) for overloads in by_name.values()]

    def without_covered(self, overloads: list[Function]) -> list[Function]:
        """Without those that another one does too: with the same arguments, and options besides."""

        def covers(one: Function, other: Function) -> bool:
            mine, others = self.arguments(one), self.arguments(other)
            given = [(a["name"], a["type"]) for a in mine if not a["default"]]
            return given == [(a["name"], a["type"]) for a in others if not a["default"]] and {a["name"] for a in others} < {
                a["name"] for a in mine
            }

        return [f for f in overloads if not any(covers(one, f) for one in overloads)]

    def records_in(self, space: str) -> list[tuple[str, str]]:
        return sorted((s for s in self.records if s[0] == space), key=lambda s: (s[1].count("::"), s[1]))

    def write_records_header(self) -> str:
        text = "".join(f"#include <thalweg/{FOLDERS.get(m, m)}.hpp>\n" for m in ["core", *MODULES])
        text += '\n#include "glue.hpp"\n\nnamespace thalweg::python {\n\n'
        others = ", ".join(f'{{"{FOLDERS.get(m, m)}", "{called(m)}"}}' for m in CALLED if FOLDERS.get(m, m) != called(m))
        text += "/// How Python calls the modules that it calls otherwise.\n"
        text += f"constexpr std::pair<std::string_view, std::string_view> renamed[] = {{{others}}};\n\n"
        for scope, enumeration in sorted(self.enumerations.items()):
            if "\\cpponly" in enumeration.comment:
                continue
            whole = "::".join(filter(None, scope))
            names = ", ".join(f'"{w}"' for w in self.words_of(scope))
            values = ", ".join(f"{whole}::{w}" for w in self.words_of(scope))
            count = len(enumeration.values)
            text += f"""template <> struct Words<{whole}> {{
    static constexpr std::array<char const*, {count}> names = {{{names}}};
    static constexpr std::array<{whole}, {count}> values = {{{values}}};
    static char const* of({whole} value) {{
        for (std::size_t i = 0; i < values.size(); ++i) {{
            if (values[i] == value) {{
                return names[i];
            }}
        }}
        return "?";
    }}
}};
"""
        for scope in sorted(self.records):
            text += self.record_declaration(scope)
        return f"#pragma once\n// Written by python/bind/bind.py.\n{text}\n}} // namespace thalweg::python\n"

    def write_module(self, space: str) -> str:
        name = space or "core"
        text = f"""// Written by python/bind/bind.py.
#include "records.hpp"
#include "by_hand.hpp"

namespace thalweg::python {{

"""
        for scope in self.records_in(space):
            text += self.record_definition(scope)
        text += f"void declare_{name}(py::module_& module) {{\n"
        for scope in self.records_in(space):
            text += self.record_binding(scope)
            text += self.getters(scope)
        text += f"    (void)module;\n}}\n\nvoid define_{name}(py::module_& module) {{\n    (void)module;\n"
        text += f"    using namespace thalweg{'::' + space if space else ''};\n"
        for overloads in self.grouped(space):
            words = self.docstring(overloads)
            text += (
                f'    add_function(module, "{safe(overloads[0].name)}", R"words({words})words", [](Args& in) -> py::object {{\n'
                f"{self.overloaded(overloads)}    }});\n"
            )
        return text + "}\n\n} // namespace thalweg::python\n"

    # -- Stubs --------------------------------------------------------------------------------------------------------

    def write_stub(self, space: str) -> str:
        lines: list[str] = []
        records = self.records_in(space)

        def write_record(scope: tuple[str, str], indent: str) -> None:
            name = scope[1].rpartition("::")[2]
            lines.append(f"{indent}class {name}:")
            inner = indent + "    "
            lines.extend(stub_words(self.record_words(scope), inner))
            for nested in records:
                if nested[1].rpartition("::")[0] == scope[1]:
                    write_record(nested, inner)
            takes = [(f, t) for _, f, t in self.fields_of(scope) if self.is_taken(t)]
            if self.is_made(scope):
                parts = []
                for field, type_ in takes:
                    default = self.literal(field.default, type_)
                    annotation = self.python_type(type_, True, space)
                    if default == "None" and not annotation.endswith("| None"):
                        annotation += " | None"
                    parts.append(f"{safe(field.name)}: {annotation} = {'...' if default in ('()', '{}') else default}")
                lines.append(f"{inner}def __init__(self, {', '.join(parts)}) -> None: ...")
            for _, field, type_ in self.fields_of(scope):
                if self.can_cross(type_):
                    shown = self.python_type(type_, False, space)
                    if arguments_of(type_)[0] == "Raster" and re.search(r"without cells|empty", field.comment):
                        shown = "Raster | None"
                    lines.append(f"{inner}@property\n{inner}def {safe(field.name)}(self) -> {shown}: ...")
            if scope == ("", "ElevatedNetwork"):
                lines.extend(f"{inner}{line}" for line in AS_TABLES)
            lines.append(f"{inner}def as_dict(self) -> dict[str, Any]: ...")

        for scope in records:
            if "::" not in scope[1] or (scope[0], scope[1].rpartition("::")[0]) not in self.records:
                write_record(scope, "")
        for overloads in self.grouped(space):
            for number, function in enumerate(overloads):
                if len(overloads) > 1:
                    lines.append("@overload")
                lines.append(f"def {self.signature(function, True)}:" + (" ..." if number else ""))
                if not number:
                    lines.extend(stub_words(self.docstring(overloads).split("\n--\n\n", 1)[1], "    "))
        return "\n".join(lines) + "\n"


def stub_words(text: str, indent: str) -> list[str]:
    """A docstring in a stub."""
    words = text.strip().replace("\\", "\\\\")
    if words.endswith('"'):
        words += " "
    lines = f'"""{words}"""'.split("\n")
    return [f"{indent}{line}".rstrip() for line in lines]


# What the package adds to networks.
AS_TABLES = [
    "def to_geodataframe(self, layer: str = 'arcs', *, crs: object = None) -> geopandas.GeoDataFrame: ...",
    "def to_networkx(self) -> networkx.DiGraph[Any]: ...",
]
STUB_HEAD = """# Written by python/bind/bind.py.
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
import numpy.typing as npt

from thalweg._raster import Raster, RasterLike
from thalweg._show import Progress
"""


def main() -> None:
    if sys.argv[1] == "--left-out":
        for whole, why in Binder(pathlib.Path(sys.argv[2])).left_out:
            print(f"{whole}: {why}")
        return
    source, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    binder = Binder(source)
    written: dict[pathlib.Path, str] = {out / "records.hpp": binder.write_records_header()}
    by_hand = pathlib.Path(__file__).parent
    words = dict(re.findall(r'"(\w+)",\s*R"words\((.*?)\)words"', (by_hand / "by_hand.cpp").read_text(encoding="utf-8"), re.S))
    for space in ["", *MODULES]:
        written[out / f"{space or 'core'}.cpp"] = binder.write_module(space)
        stub = binder.write_stub(space)
        extra = by_hand / f"by_hand_{space or 'core'}.pyi"
        if extra.exists():
            for line in extra.read_text(encoding="utf-8").splitlines():
                named = re.match(r"(?:class|def) (\w+)", line)
                said = words.get(named[1], "").split("\n--\n\n")[-1] if named else ""
                if not line.startswith("# SPDX"):
                    stub += (line.removesuffix(" ...") if said else line) + "\n"
                    stub += "".join(f"{one}\n" for one in stub_words(said, "    ")) if said else ""
        others = sorted(called(m) for m in MODULES if m != space and re.search(rf"\b_{called(m)}\.", stub))
        values = sorted({s[1] for s in [*binder.records, *BY_HAND] if s[0] == "" and "::" not in s[1]}) if space else []
        head = STUB_HEAD + "".join(f"from thalweg import {m} as _{m}\n" for m in others)
        used = [v for v in values if re.search(rf"(?<![\w.]){v}\b", stub)]
        head += f"from thalweg._core import {', '.join(used)}\n" if used else ""
        if not space:
            top = sorted(set(re.findall(r"^(?:class|def) (\w+)", stub, re.MULTILINE)) - {"version"})
            head += f"\n__all__ = {top}\n"
        written[out / "stubs" / ("_core.pyi" if not space else f"{called(space)}.pyi")] = f"{head}\n{stub}"
    (out / "stubs").mkdir(parents=True, exist_ok=True)
    for path, text in written.items():
        if not path.exists() or path.read_text(encoding="utf-8") != text:  # what did not change is not compiled again
            path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
