#!/usr/bin/env python3
"""Rules of the source tree that a compiler does not check. Prints every breach, ends with 1 when there is any."""

import os
import re
import sys

SOURCES = (".cpp", ".hpp", ".h", ".c", ".glsl", ".frag", ".vert")
LONGEST_FILE = 600
HEAVY = r"<(opencv2|CGAL|OpenImageIO|tiny_gltf|nlohmann)[/.]"
PRINTS = r"\b(std::cout|std::cerr|std::clog|printf|fprintf|puts|fputs|perror)\b|\bstd::exit\b|[^_\w.:>]exit\s*\("


def source_files(root, folders):
    for folder in folders:
        for place, _, names in os.walk(os.path.join(root, folder)):
            for name in sorted(names):
                if name.endswith(SOURCES):
                    yield os.path.relpath(os.path.join(place, name), root)


def without_comments(text):
    text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), text, flags=re.S)
    return re.sub(r"//[^\n]*", "", text)


def includes(text):
    return re.findall(r'^\s*#\s*include\s+([<"][^>"]+[>"])', text, re.M)


def breaches_of(path, text):
    code = without_comments(text)
    top = path.split("/")[0]
    if text.count("\n") > LONGEST_FILE:
        yield f"has {text.count(chr(10))} lines, {LONGEST_FILE} at most"
    if top in ("format", "lib", "reference", "runtime-shaders"):
        for number, line in enumerate(code.split("\n"), 1):
            if re.search(PRINTS, line):
                yield f"line {number} prints or exits; only cli does"
            if re.search(r"#\s*include\s*<iostream>", line):
                yield f"line {number} includes <iostream>"
    public = path.startswith(("format/include", "lib/include", "format/layout.h"))
    for name in includes(text):
        if path.endswith((".hpp", ".h")) and re.match(HEAVY, name) and public:
            yield f"is a public header and includes {name}"
        if top == "format" and re.match(r"<burin/(?!format/|result)", name):
            yield f"includes {name}: format knows nothing of lib"
        if top in ("format", "lib") and re.search(r"runtime-shaders|^[<\"](core|cpp|gl)/", name):
            yield f"includes {name}: lib does not know the shaders"
        if path.startswith("runtime-shaders/core") and name != '"layout.h"' and "core" not in name and "/" in name:
            yield f"includes {name}: the decoder knows layout.h alone"
        if top in ("format", "lib", "runtime-shaders") and re.search(r"cli/|options\.hpp\"", name) and "cli" in name:
            yield f"includes {name}: nothing knows cli"
    if re.search(r"keep in sync|must match|\bTODO\b|\bFIXME\b|\bXXX\b", text, re.I):
        yield "holds a promise instead of a check (keep in sync, must match, TODO)"


def header_breaches(path, text):
    """A public header is at least a third comment."""
    lines = [line for line in text.split("\n") if line.strip()]
    comments = sum(1 for line in lines if line.lstrip().startswith("//") or " // " in line)
    if len(lines) > 30 and comments < 0.3 * len(lines):
        yield f"has comments on {100 * comments // len(lines)} % of its lines; a public header is half contract"


def main():
    root = sys.argv[1]
    count, found = 0, 0
    for path in source_files(root, ("format", "lib", "reference", "cli", "runtime-shaders", "tests", "samples", "bench")):
        with open(os.path.join(root, path), encoding="utf-8") as file:
            text = file.read()
        count += 1
        breaches = list(breaches_of(path, text))
        if path.startswith(("format/include", "lib/include")):
            breaches += header_breaches(path, text)
        for breach in breaches:
            found += 1
            print(f"{path}: {breach}")
    print(f"{count} files, {found} breaches")
    sys.exit(1 if found or not count else 0)


if __name__ == "__main__":
    main()
