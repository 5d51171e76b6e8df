#!/usr/bin/env python3
"""Draws every scene and rewrites the list in README.md, from what make_samples and burin say.

    samples/pictures.py BUILD_FOLDER        needs make_samples, burin, and ImageMagick's convert
"""

import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
BEGIN, END = "<!-- scenes -->\n", "<!-- end of scenes -->\n"


def run(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def draw(build, folder, name, options):
    """A picture of 128 colours, which keeps it small."""
    drawn = os.path.join(folder, name + ".png")
    run(os.path.join(build, "cli", "burin"), "render", os.path.join(folder, name + ".glb"), "--output", drawn,
        "--size", "400x300", "--antialiasing", "points", "--samples", "16", *options.split())
    kept = os.path.join(HERE, "pictures", name + ".png")
    run("convert", drawn, "-colors", "128", "-strip", "PNG8:" + kept)


def entry(line):
    name, source, elements, textures, file, options = line.split("; ")
    return f"""### {name}

![{name}](pictures/{name}.png)

After {source}: {int(elements)} lines and curves, {int(textures):,} bytes of textures; the file has {int(file):,} bytes with mesh and fallback.

    burin render {name}.glb --output {name}.png --size 400x300 --antialiasing points --samples 16 {options}

"""


def main():
    build = sys.argv[1]
    os.makedirs(os.path.join(HERE, "pictures"), exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        lines = run(os.path.join(build, "samples", "make_samples"), folder, "scenes").splitlines()
        for line in lines:
            draw(build, folder, line.split("; ")[0], line.split("; ")[-1])
    path = os.path.join(HERE, "README.md")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    with open(path, "w", encoding="utf-8") as file:
        file.write(before + BEGIN + "\n" + "".join(map(entry, lines)) + END + after)


if __name__ == "__main__":
    main()
