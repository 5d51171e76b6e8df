#!/usr/bin/env python3
"""Draws every scene and rewrites the list in README.md, from what make_samples and burin say.

    samples/pictures.py BUILD_FOLDER [SCENE...]     needs make_samples, burin, and ImageMagick's convert

With names only these are drawn; the list is that of all scenes.
The suit of armour is drawn where ../shared/data is; without it its picture and its figures stay as they are.
"""

import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
BEGIN, END = "<!-- scenes -->\n", "<!-- end of scenes -->\n"
BEGIN_BODY, END_BODY = "<!-- armour -->\n", "<!-- end of armour -->\n"
ARMOUR = "../shared/data/models/oga_knight_armor.gltf"
ARMOUR_VIEW = "--azimuth -25 --elevation 8 --zoom 3.2 --center 0.39,0.1 --environment room --light -70,40"


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


def armour_entry(build, folder):
    """The engraving on a model that is not burin's; nothing where the model is not here."""
    model = os.path.join(os.path.dirname(HERE), ARMOUR)
    if not os.path.exists(model):
        print(f"{ARMOUR} is not here: its picture stays")
        return None
    run(os.path.join(build, "samples", "make_samples"), folder, "engraved_armour", model)
    drawn, asset = os.path.join(folder, "suit_of_armour.png"), os.path.join(folder, "engraved_armour.glb")
    run(os.path.join(build, "cli", "burin"), "render", asset, "--output", drawn, "--size", "600x450", *ARMOUR_VIEW.split())
    run("convert", drawn, "-colors", "128", "-strip", "PNG8:" + os.path.join(HERE, "pictures", "suit_of_armour.png"))
    return f"""
The same engraving on a suit of armour whose texture coordinates are cut into hundreds of charts: grooves run on over the seams as far as the drawing
fits, and end in walls where it does not. The model is "knight" by piacenti (opengameart.org, CC BY 3.0) and not part of this repository.
The file has {os.path.getsize(asset):,} bytes, {os.path.getsize(asset) - os.path.getsize(model):,} more than the model.

![suit of armour](pictures/suit_of_armour.png)

    make_samples . engraved_armour {ARMOUR}
    burin render engraved_armour.glb --output armour.png --size 600x450 {ARMOUR_VIEW}

"""


def replaced(text, begin, end, middle):
    return text.split(begin)[0] + begin + middle + end + text.split(end)[1]


def main():
    build, names = sys.argv[1], sys.argv[2:]
    os.makedirs(os.path.join(HERE, "pictures"), exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        lines = run(os.path.join(build, "samples", "make_samples"), folder, "scenes").splitlines()
        for name, options in ((line.split("; ")[0], line.split("; ")[-1]) for line in lines):
            if not names or name in names:
                draw(build, folder, name, options)
        armour = None if names else armour_entry(build, folder)
    path = os.path.join(HERE, "README.md")
    with open(path, encoding="utf-8") as file:
        text = replaced(file.read(), BEGIN, END, "\n" + "".join(map(entry, lines)))
    if armour:
        text = replaced(text, BEGIN_BODY, END_BODY, armour)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
