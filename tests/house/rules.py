# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rules of the house that no compiler keeps. Prints one line a violation; exit status 1 when there is one.
Usage: rules.py [ROOT]"""
import collections
import pathlib
import re
import subprocess
import sys

# Which modules a module may include, besides itself. Stage modules meet in those of the program, which include
# those before them.
BELOW = ["core", "geometry", "solver", "flow"]
STAGES = ["growth", "network", "skeleton", "surface", "fractal", "blend", "measure", "draw", "io"]
PROGRAM = ["recipe", "make", "report", "export", "ensemble", "commands"]
MODULES = {"core": [], "geometry": ["core"], "solver": ["core"], "flow": ["core"],
           "studio": BELOW + STAGES + PROGRAM + ["serve"]}
MODULES.update({name: BELOW + STAGES + PROGRAM[:number] for number, name in enumerate(PROGRAM)})
MODULES.update({stage: BELOW for stage in STAGES})
MODULES["serve"] = ["core"]

# The folders of modules where these have an order: each may include those before it.
FOLDERS = {"io": ["files", "gdal", "crs", "qgis", "tables", "raster", "network", "mesh", "sources"]}

# Which foreign headers (by how their names begin) a module's .cpp files may include.
FOREIGN = {
    "core": ["oneapi/tbb/", "Random123/"],
    "geometry": ["CGAL/", "boost/geometry/", "boost/iterator/"],
    "solver": ["Eigen/", "unsupported/Eigen/", "CL/", "petsc", "mpi.h"],
    "skeleton": ["noise/", "libnoise/"],
    "surface": ["muParser"],
    "draw": ["cairo", "fontconfig/", "png.h"],
    "io": ["gdal", "ogr", "cpl_", "proj.h", "OpenEXR/", "laszip/", "boost/crc.hpp"],
    "serve": ["boost/asio/", "boost/beast/"],
    "recipe": ["toml++/", "nlohmann/"],
    "make": ["nlohmann/"],
    "report": ["toml++/", "nlohmann/"],
    "export": ["nlohmann/"],
    "ensemble": ["nlohmann/"],
    "commands": ["nlohmann/"],
    "studio": ["nlohmann/"],
    "tools": ["CLI/", "nlohmann/", "spdlog/", "mpi.h"],
}
FOREIGN_ANYWHERE = ["fmt/", "boost/graph/", "boost/property_map/"]
# The headers of ours with foreign ones in them, for .cpp files alone: a StreamNetwork for Boost's algorithms, and worded errors.
FOREIGN_IN_HEADERS = {"thalweg/core/stream_network_graph.hpp": ["boost/graph/", "boost/iterator/", "boost/property_map/"],
                      "thalweg/core/run/refuse.hpp": ["fmt/"]}
# The folders of tools, with those each may include; main.cpp includes any.
TOOLS = {"commands": ["help", "ranks", "terminal"], "help": [], "ranks": [], "terminal": []}
SYSTEM = re.compile(r"[a-z_0-9]+$|(sys/[a-z]+|unistd|fcntl|signal|spawn|dlfcn|malloc)\.h$")  # C++ headers have no suffix

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SPDX = ("SPDX-FileCopyrightText: the thalweg authors", "SPDX-License-Identifier: GPL-3.0-or-later")

LIBM = ("pow|exp|exp2|expm1|log2|log10|log1p|sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|cbrt|hypot|"
        "fma|erf|erfc|tgamma|lgamma")
# Bare log( is only libm's where <cmath> is at hand: a Run has a log of its own.
LIBM_CALL = re.compile(r"\bstd::(?:%s|log)[fl]?\b|(?<![\w:.>])(?:::)?(?:%s)[fl]?\(" % (LIBM, LIBM))
LIBM_LOG = re.compile(r"(?<![\w:.>])(?:::)?log[fl]?\(")
# Pictures promise no bytes; elementary is what replaces libm.
LIBM_FREE_OF = ("lib/thalweg/draw/", "lib/thalweg/core/numbers/elementary.")

# In the library: what gives other results with another standard library, processor or number of threads.
UNREPEATABLE = re.compile(r"\bstd::(?:shuffle|sample|random_device|reduce|transform_reduce|execution|hash)\b|"
                          r"\bstd::rand\b|(?<![\w:.>])s?rand\(|\bparallel_reduce\b|#\s*include\s*<(?:random|execution)>")
DISTRIBUTION = re.compile(r"\b(?:std::)?(?:uniform_int|uniform_real|normal|bernoulli|binomial|geometric|poisson|exponential|"
                          r"gamma|weibull|extreme_value|lognormal|chi_squared|cauchy|fisher_f|student_t|discrete|"
                          r"piecewise_constant|piecewise_linear)_distribution\b")
# thalweg::Error takes the function that throws as an argument of its own, and users read the other.
PREFIX = re.compile(r'"([a-z]+)\.\w+: ')
# Where a call names the function that throws: what begins the call, and which of its arguments that is.
PLACES = [(re.compile(r"\bthrow (?:BadParameter|BadInput|NotConverged|IoError|Cancelled|NotDrawn)\("), 0),
          (re.compile(r"\brefuse_if<\w+>\("), 1), (re.compile(r"\brequire_in\("), 0),
          (re.compile(r"\brequire_same_grid\("), 2), (re.compile(r"\bAbout const \w+\{"), 0)]
PLACE = re.compile(r'"(\w+)\.(\w+)"')
LITERAL = re.compile(r'R"([^()\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
# Findings are values: Run::report and line_of() print them, and nothing reads their words.
WARNING_AS_TEXT = re.compile(r"""["'`]warning: |(?:starts_with|startswith|startsWith)\(["'`]warning""")
# What GDAL says of a band: OpenedHeights asks for all of it, so that every command reads a DEM alike.
OTHER_DOOR = re.compile(r"GetMaskFlags|GetUnitType|(?<!GDAL_OF_VECTOR \| )GDAL_OF_RASTER(?! \| GDAL_OF_VECTOR)")
DOORS = ("lib/thalweg/io/raster/opened_heights.cpp", "lib/thalweg/io/gdal/", "lib/thalweg/io/raster/web_tiles.cpp")
# rapidcheck gives its verdict back; a test that does not look at it cannot fail.
UNASKED = re.compile(r"^\s*rc::check\(")
# A value that flows and that a function would change for its caller. Only the reader of recipes does so.
CHANGED_VALUE = re.compile(r"(?<![\w<])(?:\w+::)?(Recipe|Plan|Rivers|Terrain|Assessment|MakeResult)& ?\w*[,)]")
READER = "lib/thalweg/recipe/"
# What opens and closes a namespace, and a type defined in one, as clang-format writes them.
NAMESPACE = re.compile(r"(?:inline )?namespace(?: ([\w:]+))? \{|\} // namespace")
TYPE = re.compile(r"(?:struct|class|union|enum class|enum) (\w+)(?![\w:])[^;]*\{")
FLAGS = re.compile(r"-march=|-mtune=|-mfma|-mavx|-ffast-math|-Ofast|-funsafe-math|-ffp-contract=fast")

MACHINE_PATH = re.compile(r"(?<![\w.}$)*-])/(?:work|home|root|tmp|Users)(?![\w.-])")
FETCHED = re.compile(r"FetchContent|ExternalProject|CPMAddPackage|\b(?:pip3?|conan|vcpkg|cargo|gem) install\b(?! --no-index)|"
                     r"\b(?:curl|wget) |pypi\.org|pythonhosted\.org|crates\.io|anaconda\.org|"
                     r"(?:ghcr|docker|quay)\.io", re.IGNORECASE)
LOCK_HOST = re.compile(r'"resolved": *"https?://(?!registry\.npmjs\.org/)[^"\s]+')

CPP = (".cpp", ".hpp", ".inc")
COMMENTED = {*CPP, ".cmake", ".py", ".sh", ".js", ".ts"}  # suffixes that take the SPDX lines
PICTURES = {".png", ".jpg", ".tif", ".gpkg", ".shp", ".dbf"}
# Built by vite from web/src and minified: what their text looks like is chance.
GENERATED = {"web/dist/report.html", "web/dist/terrain.html"}
RULES_THEMSELVES = {"tests/house/rules.py", "tests/house/rules_test.py"}


def files_of(root):
    """The files of the repository: what git knows and what it would add; without git, all but what is built."""
    git = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                         capture_output=True)
    if git.returncode == 0 and git.stdout:
        names = git.stdout.decode().split("\0")
    else:
        names = [str(p.relative_to(root)) for p in root.rglob("*")]
    left_out = (".git", "build", "out", "valley", "shared")
    return sorted({n for n in names if n and n.split("/")[0] not in left_out and (root / n).is_file()})


def place(name):
    """The module of a source file: a folder of lib/thalweg, "tools", or None."""
    parts = name.split("/")
    if parts[:2] == ["lib", "thalweg"] and len(parts) > 2:
        return parts[2].removesuffix(".hpp")
    return "tools" if parts[0] == "tools" else None


def begins(name, beginnings):
    return any(name.startswith(b) for b in beginnings)


def check_own_include(name, header):
    """What is wrong with an include of one file in tools by another, or None."""
    folder, target = (pathlib.PurePath(path).parent.as_posix() for path in (name.removeprefix("tools/"), header))
    if target not in TOOLS:
        return f'"{header}": write "FOLDER/FILE.hpp", FOLDER one of {", ".join(TOOLS)}'
    if folder not in (".", target) and target not in TOOLS.get(folder, []):
        return f'{folder} includes "{header}": dependencies point one way'
    return None


def check_folders(name, header):
    """What is wrong with an include between the folders of one module, or None."""
    module, own = pathlib.PurePath(name).parts[2:4]
    target = pathlib.PurePath(header).parts[2]
    order = FOLDERS[module]
    for folder in (own, target):
        if folder not in order:
            return f"{module}/{folder} has no place in the order of {module}'s folders: tests/house/rules.py"
    if order.index(target) > order.index(own):
        return f"{module}/{own} includes <{header}>: {module}'s folders include those before them"
    return None


def check_include(name, module, quoted, header):
    """What is wrong with one include of a file in lib or tools, or None."""
    if quoted:
        return check_own_include(name, header) if module == "tools" else f'"{header}": write <thalweg/...>'
    if header in FOREIGN_IN_HEADERS and name.endswith(".hpp"):
        return f"<{header}> includes foreign headers: it belongs in a .cpp file"
    if header.startswith("thalweg/"):
        target = header.split("/")[1]
        if "/internal/" in header and (module != target or (name.endswith(".hpp") and "/internal/" not in name)):
            return f"<{header}> is for the .cpp files of {target} alone"
        if module in FOLDERS and target == module and len(pathlib.PurePath(name).parts) > 4:
            return check_folders(name, header)
        if module == "tools" or target == module or target in MODULES[module]:
            return None
        what = "stage modules meet in the program's" if target in STAGES and module in STAGES else "dependencies point one way"
        return f"{module} includes <{header}>: {what}"
    if SYSTEM.match(header):
        return None
    if name.endswith(".hpp"):
        if module == "tools" or begins(header, FOREIGN_IN_HEADERS.get(name.removeprefix("lib/"), [])):
            return None
        return f"foreign <{header}> in a header: it belongs in a .cpp file"
    if begins(header, FOREIGN_ANYWHERE) or begins(header, FOREIGN.get(module, [])):
        return None
    return f"foreign <{header}> does not belong to {module}"


def check_source(name, lines):
    """Violations of one C++ file as (line number, text)."""
    module = place(name)
    in_lib = name.startswith("lib/")
    if in_lib and module not in MODULES:
        yield 1, f"lib/thalweg/{module or '?'} is no module: add it to the table of tests/house/rules.py"
        return
    has_cmath = any(re.match(r"\s*#\s*include\s*<(cmath|math\.h)>", line) for line in lines)
    for number, line in enumerate(lines, 1):
        code = line.split("//")[0]
        include = INCLUDE.match(line)
        if include and module:
            fault = check_include(name, module, include[1] == '"', include[2])
            if fault:
                yield number, fault
        if include and re.search(r"\.cpp$", include[2]):
            yield number, "a .cpp file is included"
        if module in (*PROGRAM, "tools") and not name.startswith(READER) and (found := CHANGED_VALUE.search(code)):
            yield number, f"{found[1]}&: values that flow are not changed; take it by value or const and return one"
        if found := DISTRIBUTION.search(code):
            yield number, f"{found[0]}: distributions differ between libraries; use core/numbers/random.hpp"
        if module and (found := PREFIX.search(code)) and found[1] in MODULES and "std::logic_error" not in code:
            yield number, f"{found[0]}: an error takes its function as an argument; write a key as key = value or [section]"
        if not in_lib:
            if UNASKED.search(code) and not lines[max(number - 2, 0)].endswith("("):
                yield number, "rc::check: its verdict is not looked at; write ASSERT_TRUE(rc::check(...))"
            continue
        if found := WARNING_AS_TEXT.search(code):
            yield number, f"{found[0]}: a warning is a finding; return it as a value"
        if (found := OTHER_DOOR.search(code)) and not name.startswith(DOORS):
            yield number, f"{found[0]}: heights of rasters are read by OpenedHeights alone (io/raster/opened_heights.cpp)"
        if found := UNREPEATABLE.search(code):
            yield number, f"{found[0]}: not the same everywhere"
        if not begins(name, LIBM_FREE_OF):
            found = LIBM_CALL.search(code) or (LIBM_LOG.search(code) if has_cmath else None)
            if found:
                yield number, f"{found[0].rstrip('(')} of libm has other bits on other machines; use core/numbers/elementary.hpp"


def argument_at(text, begin, number):
    """An argument of a call, whose arguments begin there; "" where it has fewer."""
    depth = 0
    at = begin
    while at < len(text):
        literal = LITERAL.match(text, at)
        if literal and not (text[at] == "'" and text[at - 1].isalnum()):  # 1'000 is a number
            at = literal.end()
            continue
        if text[at] in "([{":
            depth += 1
        elif text[at] in ")]}":
            depth -= 1
        if depth < 0 or (depth == 0 and text[at] == ","):
            if number == 0 or depth < 0:
                return text[begin:at].strip() if number == 0 else ""
            number -= 1
            begin = at + 1
        at += 1
    return ""


def check_places(sources):
    """Errors of the library that name a function or type as their place which no header of their module declares."""
    headers = collections.defaultdict(str)
    for name, lines in sources:
        if name.endswith(".hpp"):
            headers[place(name)] += "\n".join(line.split("//")[0] for line in lines)
    for name, lines in sources:
        module = place(name)
        text = "\n".join(lines)
        for begin, number in PLACES:
            for call in begin.finditer(text):
                found = PLACE.fullmatch(argument_at(text, call.end(), number))
                if not found:
                    continue
                line = text.count("\n", 0, call.start()) + 1
                if found[1] != module:
                    yield f"{name}:{line}: {found[0]}: an error names its own module"
                elif not re.search(r"\b(?:class|struct) %s\b|\b%s\(" % (found[2], found[2]), headers[module]):
                    yield f"{name}:{line}: {found[0]}: no header of {module} declares it; name the function that was called"


def types_of(lines):
    """The types of a C++ file that others see as (line number, name with its namespaces)."""
    spaces = []
    for number, line in enumerate(lines, 1):
        if found := NAMESPACE.match(line):
            if line.startswith("}"):
                spaces = spaces[:-1]
            elif not line.rstrip().endswith("}"):
                spaces.append(found[1])
        elif (found := TYPE.match(line)) and None not in spaces:
            yield number, "::".join([*spaces, found[1]])


def check_types(sources):
    """Types of one name that two files of the library define: they would share their functions, whichever comes first."""
    seen = {}
    for name, lines in sources:
        for number, full in types_of(lines):
            if full in seen:
                yield f"{name}:{number}: {full} is also defined in {seen[full]}"
            seen[full] = name


def check_umbrellas(sources):
    """Headers lib/thalweg/MODULE.hpp that do not begin with what the module takes and gives, or do not include just its public
    headers."""
    public = collections.defaultdict(set)
    included = {}
    for name, lines in sources:
        path = pathlib.PurePath(name)
        if name.endswith(".hpp") and len(path.parts) == 3:
            included[place(name)] = {INCLUDE.match(line)[2] for line in lines if INCLUDE.match(line)}
            if place(name) != "core" and not any(re.match("///.*[→↔]", line) for line in lines):
                yield f"{name}:1: say what the module takes and gives: /// DEM → flow directions"
        elif name.endswith(".hpp") and "internal" not in path.parts and name.removeprefix("lib/") not in FOREIGN_IN_HEADERS:
            public[place(name)].add(name.removeprefix("lib/"))
    for module, headers in sorted(included.items()):
        for header in sorted(headers ^ public[module]):
            yield f"lib/thalweg/{module}.hpp:1: {header}: this header includes the public headers of {module}, all and no others"


def check_text(name, lines):
    """Violations of any text file as (line number, text)."""
    path = pathlib.PurePath(name)
    takes_spdx = path.suffix in COMMENTED or path.name == "CMakeLists.txt" or (lines and lines[0].startswith("#!"))
    if takes_spdx and not all(any(s in line for line in lines[:4]) for s in SPDX):
        yield 1, "the two SPDX lines are missing"
    if name in RULES_THEMSELVES or name in GENERATED:
        return
    if path.parts[0] in ("qgis", "python", "web", "tools"):
        for number, line in enumerate(lines, 1):
            if found := WARNING_AS_TEXT.search(line):
                yield number, f"{found[0]}: read findings, not words"
    builds = path.name in ("CMakeLists.txt", "CMakePresets.json") or path.suffix == ".cmake"
    for number, line in enumerate(lines, 1):
        if found := MACHINE_PATH.search(line):
            yield number, f"{found[0]}: a path of one machine"
        if found := FETCHED.search(line):
            yield number, f"{found[0].strip()}: only Debian packages and npm packages by lock file"
        if path.name == "package-lock.json" and (found := LOCK_HOST.search(line)):
            yield number, f"{found[0]}: a foreign registry"
        if builds and (found := FLAGS.search(line.split("#")[0])):
            yield number, f"{found[0]}: changes bits from machine to machine"


def violations(root):
    """Every violation under a folder, as printable lines."""
    root = pathlib.Path(root)
    sources = []
    names = files_of(root)
    found = []
    for name in names:
        data = (root / name).read_bytes()
        if pathlib.PurePath(name).suffix in PICTURES or b"\0" in data:
            continue
        lines = data.decode("utf-8", "replace").splitlines()
        faults = list(check_text(name, lines))
        if name.endswith(CPP):
            faults += check_source(name, lines)
        if name.endswith(CPP) and name.startswith("lib/"):
            sources.append((name, lines))
        found += [f"{name}:{number}: {text}" for number, text in sorted(faults)]
    return found + list(check_types(sources)) + list(check_places(sources)) + list(check_umbrellas(sources))


if __name__ == "__main__":
    faults = violations(sys.argv[1] if len(sys.argv) > 1 else ".")
    print("\n".join(faults) if faults else "every rule is kept")
    sys.exit(1 if faults else 0)
