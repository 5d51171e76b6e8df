#!/usr/bin/env python3
"""Areas against rays on real maps: converts each map, draws it from five sides both ways, and counts the pixels that differ.

    bench/runtime/maps.py BUILD_FOLDER OUT_FOLDER MAP...

Writes NAME_VIEW.png into OUT_FOLDER: 16 rays a pixel, the default, and four times their difference. A bug of the areas shows as a patch, and as pixels off by
more than 64 of 255; differences everywhere are those of four samples from sixteen. Needs Pillow.
"""

import math
import os
import subprocess
import sys

from PIL import Image, ImageChops

VIEWS = (("6", "60", "0.4,0.45"), ("2", "25", "0.5,0.5"), ("16", "75", "0.55,0.6"), ("1", "50", "0.5,0.5"), ("3", "12", "0.5,0.5"))
RAYS = ("--antialiasing", "points", "--samples", "16")


def run(*words):
    subprocess.run(words, check=True, capture_output=True)


def drawn(burin, asset, view, path, *more):
    zoom, elevation, center = view
    run(burin, "render", asset, "--output", path, "--size", "320x240", "--zoom", zoom, "--elevation", elevation, "--azimuth", "37",
        "--center", center, "--quiet", *more)
    return Image.open(path).convert("RGB")


def compare(burin, asset, view, path):
    rays, areas = drawn(burin, asset, view, path, *RAYS), drawn(burin, asset, view, path)
    difference = ImageChops.difference(rays, areas)
    counts = difference.convert("L").histogram()
    squares = sum(count * (value % 256) ** 2 for value, count in enumerate(difference.histogram()))
    psnr = 10 * math.log10(255 ** 2 * 3 * rays.width * rays.height / max(squares, 1e-9))
    page = Image.new("RGB", (3 * rays.width, rays.height))
    for i, picture in enumerate((rays, areas, difference.point(lambda value: min(4 * value, 255)))):
        page.paste(picture, (i * rays.width, 0))
    page.save(path)
    return psnr, sum(counts[17:]), sum(counts[65:])


def main():
    build, out, maps = sys.argv[1], sys.argv[2], sys.argv[3:]
    burin = os.path.join(build, "cli", "burin")
    print("| map | zoom, elevation | dB | off by more than 16 | by more than 64 |\n|---|---|--:|--:|--:|")
    for path in maps:
        name = os.path.splitext(os.path.basename(path))[0]
        asset = os.path.join(out, name + ".glb")
        run(burin, "convert", path, "--output", asset, "--depth", "0.02", "--quiet")
        for i, view in enumerate(VIEWS):
            psnr, some, many = compare(burin, asset, view, os.path.join(out, f"{name}_{i}.png"))
            print(f"| {name} | {view[0]}, {view[1]} | {psnr:.1f} | {some} | {many} |", flush=True)


if __name__ == "__main__":
    main()
