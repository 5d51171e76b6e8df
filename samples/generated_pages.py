#!/usr/bin/env python3
"""Pages of docs/ whose lists and pictures come from the library's own tables.

    samples/generated_pages.py BUILD_FOLDER           draws the pictures and rewrites the lists; needs ImageMagick's convert
    samples/generated_pages.py BUILD_FOLDER --check   ends with 1 where a list is not what the tables say, or a picture is missing
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
    run(os.path.join(build, "samples", "make_profiles"), folder)
    for name in names:
        asset, solid, drawn = (os.path.join(folder, name + suffix) for suffix in (".glb", "_solid.glb", ".png"))
        run(burin, "mesh", asset, "--tile", "-o", solid)
        run(burin, "render", solid, "-o", drawn, *SECTION_VIEW.split())
        keep(drawn, name + ".png")


PAGES = {"profiles.md": ("make_profiles", draw_profiles)}


def names_in(text):
    return re.findall(r"\(\.\./samples/pictures/(\w+)\.png\)", text)


def main():
    build, check = sys.argv[1], "--check" in sys.argv[2:]
    faults = []
    for page, (program, draw) in PAGES.items():
        path = os.path.join(ROOT, "docs", page)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        listed = run(os.path.join(build, "samples", program), "--list")
        wanted = text.split(BEGIN)[0] + BEGIN + "\n" + listed + END + text.split(END)[1]
        if check:
            faults += [] if wanted == text else [f"docs/{page} is not what {program} --list says"]
            faults += [f"{name}.png is missing" for name in names_in(listed) if not os.path.exists(os.path.join(PICTURES, name + ".png"))]
            continue
        with tempfile.TemporaryDirectory() as folder:
            draw(build, folder, names_in(listed))
        with open(path, "w", encoding="utf-8") as file:
            file.write(wanted)
    for fault in faults:
        print(fault + "; samples/generated_pages.py writes it")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
