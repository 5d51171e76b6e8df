#!/usr/bin/env python3
"""Pages of docs/ whose lists and pictures come from the library's own tables.

    samples/generated_pages.py BUILD_FOLDER [NAME...]   draws the pictures (those named alone) and rewrites the lists; needs ImageMagick's convert
    samples/generated_pages.py BUILD_FOLDER --check     ends with 1 where a list is not what the tables say, or a picture is missing
"""

import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PICTURES = os.path.join(ROOT, "samples", "pictures")
BEGIN, END = "<!-- list -->\n", "<!-- end of list -->\n"
SECTION_VIEW = "--size 480x190 --elevation 28 --azimuth 6 --zoom 1.22 --light=-60,35"


def run(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def keep(drawn, name):
    """A picture of 64 colours, which keeps it small."""
    run("convert", drawn, "-colors", "64", "-strip", "PNG8:" + os.path.join(PICTURES, name))


def draw_profiles(build, folder, names):
    """Tiles as solids, whose sides show the sections."""
    burin = os.path.join(build, "cli", "burin")
    run(os.path.join(build, "samples", "make_library"), folder)
    for name in names:
        asset, solid, drawn = (os.path.join(folder, name + suffix) for suffix in (".glb", "_solid.glb", ".png"))
        run(burin, "mesh", asset, "--tile", "-o", solid)
        run(burin, "render", solid, "-o", drawn, *SECTION_VIEW.split())
        keep(drawn, name + ".png")


# Where the near view looks, in uv; where nothing is said, at the middle.
NEAR = {"generate_cracks": "0.65,0.6", "generate_vinyl": "0.3,0.75"}


def draw_generators(build, folder, names):
    """All of a tile, and a part of it near by."""
    burin = os.path.join(build, "cli", "burin")
    for name in names:
        asset, far, near, both = (os.path.join(folder, name + suffix) for suffix in (".glb", "_far.png", "_near.png", ".png"))
        run(burin, "generate", name.removeprefix("generate_"), "-o", asset)
        view = [burin, "render", asset, "--size", "320x240", "--azimuth", "10", "--light=-50,35"]
        run(*view, "--elevation", "55", "--zoom", "1.4", "-o", far)
        run(*view, "--elevation", "45", "--zoom", "6", "--center", NEAR.get(name, "0.5,0.5"), "-o", near)
        run("convert", far, near, "+append", both)
        keep(both, name + ".png")


PAGES = {"profiles.md": ("profiles", draw_profiles), "generators.md": ("generators", draw_generators)}


def names_in(text):
    return re.findall(r"\(\.\./samples/pictures/(\w+)\.png\)", text)


def main():
    build, check = sys.argv[1], "--check" in sys.argv[2:]
    wanted_names = [] if check else sys.argv[2:]
    faults = []
    for page, (table, draw) in PAGES.items():
        path = os.path.join(ROOT, "docs", page)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        listed = run(os.path.join(build, "samples", "make_library"), "--list", table)
        wanted = text.split(BEGIN)[0] + BEGIN + "\n" + listed + END + text.split(END)[1]
        if check:
            faults += [] if wanted == text else [f"docs/{page} is not what make_library --list {table} says"]
            faults += [f"{name}.png is missing" for name in names_in(listed) if not os.path.exists(os.path.join(PICTURES, name + ".png"))]
            continue
        with tempfile.TemporaryDirectory() as folder:
            draw(build, folder, [name for name in names_in(listed) if not wanted_names or name in wanted_names])
        with open(path, "w", encoding="utf-8") as file:
            file.write(wanted)
    for fault in faults:
        print(fault + "; samples/generated_pages.py writes it")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
