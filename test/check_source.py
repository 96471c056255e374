#!/usr/bin/env python3
"""Checks the rules of CONTRIBUTING.md that a program can check, and prints a line for each violation.

Usage: check_source.py [--help]      exit status 0: none, 1: some, 2: wrong usage

* no line of a source file is longer than 120 columns;
* no folder has more than 25 sources, and there are no more than 45 public headers;
* no function is longer than 80 lines, kernels apart, and no class has more than 20 private functions;
* no two headers define a class of the same name;
* a room includes only itself, rooms below it and public headers;
* sources and documents use the words of the field.
"""
import collections
import pathlib
import re
import subprocess
import sys

MAX_COLUMNS = 120
MAX_SOURCES = 25
MAX_PUBLIC_HEADERS = 45
MAX_FUNCTION_LINES = 80
MAX_PRIVATE_FUNCTIONS = 20
KERNELS = ("hessian_rows.h", "row_kernels.h", "row_kernels.cpp")  # loops that are written out for speed

# From the lowest room to the highest; rooms of one line do not include each other.
ROOMS = [
    ["common"],
    ["mesh"],
    ["volume"],
    ["io"],
    ["physics"],
    ["rendering"],
    ["view"],
    ["energy"],
    ["priors"],
    ["completion"],
    ["tracking", "segmentation"],
    ["sequence"],
    ["simulation", "evaluation"],
    ["fusion"],
    ["visualization"],
]

# Where a word is better than one that only the authors know. Change logs are free.
WORDS = {
    r"left.?overs?": "residual clusters",
    r"open.places": "rays without return",
    r"hidden.?places": "occlusion map",
    r"FollowedBody": "incremental state",
    r"[Ss]trays?\b": "outlier",
    r"[Cc]rumbs?\b": "small component",
    r"\b[Ll]umps?\b": "small component",
    r"assumed.?view": "virtual viewpoint",
    r"planeOfContact": "contact boundary plane",
    r"facing.?points": "normal-bin occupancy",
    r"takeAlong": "attach",
    r"removeScraps|\bscraps?\b": "drop",
    r"(?<!clang-)\b[Tt]idy\b": "prune",
    r"PlaneClaims|plane.?claims": "plane labelling",
    r"image.?damage": "integrity check",
    r"[Nn]obody'?s\b": "unassigned",
    r"[Ii]nexact": "unreliable",
    r"object.?unions": "object merging",
    r"length.?memory": "object size filter",
    r"FrameKnowledge|frame.?knowledge": "frame context",
    r"\b[Dd]oubt": "rejection reason",
    r"hangs? together": "connected",
    r"implied.?support": "inferred support plane",
    r"[Uu]pright": "vertical",
    r"steep.?surfaces|SteepSurfaces": "grazing-angle surfaces",
    r"\b(is|are|be|was|were|been|being) told\b|\b[Tt]elling\b": "observed, observable",
    r"addIntersection": "addObstacle",
    r"brief (The same|As above|More of)\b": "what differs",
    r"(?<!there )\b(is|are) none\b": "a sentence with its noun",
}


def tracked(*patterns):
    names = subprocess.run(["git", "ls-files", *patterns], capture_output=True, text=True, check=True).stdout.split("\n")
    return [pathlib.Path(name) for name in names if name and pathlib.Path(name).exists()]


def check_columns(path, lines):
    for number, line in enumerate(lines, 1):
        if len(line) > MAX_COLUMNS:
            yield f"{path}:{number}: {len(line)} columns"


def check_functions(path, lines):
    """Blocks that begin and end in the same column below a function's head."""
    begins = {}
    for number, line in enumerate(lines, 1):
        indent = len(line) - len(line.lstrip())
        if line.strip() == "{":
            begins[indent] = number
        elif re.match(r"\s*}", line) and indent in begins:
            begin = begins.pop(indent)
            head = " ".join(lines[max(0, begin - 4):begin - 1])
            head = re.split(r"[;}]", head)[-1]
            is_function = "(" in head and not re.search(r"\b(class|struct|namespace|enum|union|switch|for|while|if)\b", head)
            if is_function and number - begin + 1 > MAX_FUNCTION_LINES:
                yield f"{path}:{begin}: a function of {number - begin + 1} lines"


def check_classes(path, text):
    for match in re.finditer(r"^class [^;{]*\n{\n(.*?)^};", text, re.S | re.M):
        name = re.findall(r"(\w+)(?: final)?(?: :|\n)", match.group(0))[0]
        private = re.split(r"^(?:public|protected):", match.group(1).split("private:", 1)[-1], flags=re.M)[0]
        if "private:" not in match.group(1):
            continue
        functions = re.findall(r"^  (?:template <[^\n]*> |static |inline |virtual )*[\w][\w:<>,&* ]*? (\w+) \([^;{]*\)"
                               r"(?: const)?(?: override)?(?: noexcept)?\s*[;{]", private, re.M)
        if len(functions) > MAX_PRIVATE_FUNCTIONS:
            yield f"{path}: class {name} has {len(functions)} private functions"


def check_rooms(path, text):
    level = {room: n for n, rooms in enumerate(ROOMS) for room in rooms}
    parts = path.parts
    if parts[0] != "pcl_cosection" or len(parts) < 3:
        return
    for included in re.findall(r'#include "pcl_cosection/(\w+)/', text):
        if included != parts[1] and level[included] >= level[parts[1]]:
            yield f"{path}: the room {parts[1]} includes the room {included}, which is not below it"


def classes_of(text):
    """Names of the classes that a header defines in its namespace, not in another class or in templates."""
    return re.findall(r"^(?:struct|class)(?: [A-Z_]+_EXPORT)? (\w+)(?!\w|::)[^;()]*$", text, re.MULTILINE)


def check_names(headers):
    """Two classes of one name in one namespace make a program that crashes, where both are used in some template."""
    where = collections.defaultdict(list)
    for path, text in headers:
        for space in re.findall(r"^namespace ([\w:]+)\s*{", text, re.MULTILINE)[:1]:
            for name in classes_of(text):
                where[space, name].append(str(path))
    return [f"{space}::{name}: defined in {', '.join(paths)}" for (space, name), paths in where.items()
            if len(paths) > 1]


def check_words(path, lines):
    for number, line in enumerate(lines, 1):
        for word, better in WORDS.items():
            found = re.search(word, line)
            if found:
                yield f"{path}:{number}: '{found.group(0)}': write '{better}'"


def main():
    if len(sys.argv) > 1:
        print(__doc__)
        return 0 if sys.argv[1:] == ["--help"] else 2
    sources = tracked("*.h", "*.hpp", "*.cpp")
    violations = check_names([(path, path.read_text()) for path in sources
                              if path.suffix == ".h" and path.parts[0] != "test"])
    for path in sources:
        text = path.read_text()
        lines = text.split("\n")
        violations += check_columns(path, lines)
        if path.parts[0] != "test" and path.name not in KERNELS:
            violations += check_functions(path, lines)
            violations += check_classes(path, text)
        violations += check_rooms(path, text)
        violations += check_words(path, lines)
    for path in tracked("*.md", "*.sh", "*.cmake", "*CMakeLists.txt"):
        if path.name != "CHANGES.md":
            violations += check_words(path, path.read_text().split("\n"))
    for path in tracked("python/*.py", "test/python/*.py"):
        violations += check_columns(path, path.read_text().split("\n"))
    for folder, count in collections.Counter(path.parent for path in sources).items():
        if count > MAX_SOURCES:
            violations.append(f"{folder}: {count} sources")
    public = [path for path in sources if path.parts[0] == "include"]
    if len(public) > MAX_PUBLIC_HEADERS:
        violations.append(f"include: {len(public)} public headers")
    print("\n".join(violations))
    print(f"{len(violations)} violations in {len(sources)} sources")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
