#!/usr/bin/python3
"""Prints, as Markdown tables, the time and memory of `burin convert` beside those of vtracer on the same files.

    bench/speed/speed.py [--burin build/cli/burin] [--npm build/npm] [--runs N] [--threads N] [--folder FOLDER]
                         [--only WORD] [--no-series]

Both are whole processes: start, read and decode the PNG, vectorize, write the result. vtracer is @neplex/vectorizer of
npm in binary mode, its default preset; run.sh installs it. The maps are those of ../shared/data/height, enlarged
(bicubic) or repeated to 4096 x 4096; the series is one of them from 512 x 512 to 8192 x 8192. They are made once and
stay in FOLDER.
"""

import argparse
import os
import shutil
import statistics
import sys
import tempfile
import time

from PIL import Image

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
Image.MAX_IMAGE_PIXELS = None
SIDE = 4096
SERIES = [512, 1024, 2048, 4096, 8192]
SERIES_MAP = "brick_mask_2k.jpg"
# Enlarged to 4096 x 4096.
ENLARGED = ["brick_mask_2k.jpg", "playcanvas_canyon_height_4k.jpg", "pk02_panels01a_h.png",
            "evillair_ex_concrete_floor1_h.png", "oga_crate01_height_from_alpha_512.png", "pk02_floor_cyl02_h.png",
            "trak5_pipes_h.png", "evillair_ex_wall_panel3_h.png"]
# Repeated as they are, to 4096 x 4096.
REPEATED = ["evillair_ex_concrete_floor1_h.png", "pk02_panels01a_h.png", "oga_crate01_height_from_alpha_512.png",
            "pk02_floor_cyl02_h.png", "trak5_pipes_h.png", "evillair_ex_wall_panel3_h.png"]


def read_grey(path):
    """The channel that burin takes: red where red, green and blue are equal, alpha where nothing else varies."""
    image = Image.open(path)
    if image.mode in ("RGBA", "LA") and len(set(image.convert("L").getextrema())) == 1:
        return image.getchannel("A")
    return image.convert("L")


def repeated(image, side):
    result = Image.new("L", (side, side))
    for y in range(0, side, image.height):
        for x in range(0, side, image.width):
            result.paste(image, (x, y))
    return result


def make_inputs(shared, folder, with_series):
    """(name, path) of the maps of 4096 x 4096; (side, path) of the series."""
    def made(name, make):
        path = os.path.join(folder, name + ".png")
        if not os.path.exists(path):
            make().save(path + ".part", format="PNG", compress_level=3)
            os.rename(path + ".part", path)
        return path

    def enlarge(source, side):
        return lambda: read_grey(os.path.join(shared, source)).resize((side, side), Image.BICUBIC)

    def repeat(source):
        return lambda: repeated(read_grey(os.path.join(shared, source)), SIDE)

    maps = [(s, made(f"enlarged_{SIDE}_{s}", enlarge(s, SIDE))) for s in ENLARGED]
    maps += [(s + ", repeated", made("repeated_" + s, repeat(s))) for s in REPEATED]
    series = [(n, made(f"enlarged_{n}_{SERIES_MAP}", enlarge(SERIES_MAP, n))) for n in SERIES] if with_series else []
    return maps, series


class Cost:
    """Seconds on the clock, seconds of processors, bytes of memory at the peak."""

    def __init__(self, wall, cpu, peak):
        self.wall, self.cpu, self.peak = wall, cpu, peak


def run_once(words):
    """One process, alone in a child of ours, so that the peak of its memory is its own."""
    start = time.monotonic()
    child = os.fork()
    if child == 0:
        with open(os.devnull, "w", encoding="ascii") as nothing:
            os.dup2(nothing.fileno(), 1)
            os.execvp(words[0], words)
    _, status, used = os.wait4(child, 0)
    if status != 0:
        sys.exit(f"{' '.join(words)}: status {status}")
    return Cost(time.monotonic() - start, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024)


def run_least(words, runs):
    """The least of several runs: what else the machine does only ever adds."""
    costs = [run_once(words) for _ in range(runs)]
    return Cost(min(c.wall for c in costs), min(c.cpu for c in costs), max(c.peak for c in costs))


def base_memory(burin, folder):
    """What the process takes for a map of next to no texels."""
    path = os.path.join(folder, "least.png")
    Image.linear_gradient("L").resize((16, 16)).save(path)
    return run_once([burin, "convert", path, "-o", os.path.join(folder, "least.glb"), "-q"]).peak


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--burin", default=os.path.join(ROOT, "build", "cli", "burin"))
    parser.add_argument("--npm", default=os.path.join(ROOT, "build", "npm"))
    parser.add_argument("--shared", default=os.path.join(ROOT, "..", "shared", "data", "height"))
    parser.add_argument("--folder", default=os.path.join(tempfile.gettempdir(), "burin_speed"))
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--only", default="", help="only maps whose name holds this")
    parser.add_argument("--no-series", action="store_true")
    arguments = parser.parse_args()
    os.makedirs(arguments.folder, exist_ok=True)
    if shutil.which("node") is None:
        sys.exit("node is not installed; the packages nodejs and npm would work")
    maps, series = make_inputs(arguments.shared, arguments.folder, not arguments.no_series)

    def burin(path):
        return run_least([arguments.burin, "convert", path, "-o", os.path.join(arguments.folder, "burin.glb"), "-q",
                          "--threads", str(arguments.threads)], arguments.runs)

    def vtracer(path):
        return run_least(["node", os.path.join(HERE, "vtracer.js"), arguments.npm, path,
                          os.path.join(arguments.folder, "vtracer.svg")], arguments.runs)

    base = base_memory(arguments.burin, arguments.folder)
    print(f"{SIDE} x {SIDE} texels, {arguments.threads} threads, least of {arguments.runs} runs. "
          f"Memory without the {base / 1e6:.0f} MB of a map of 16 x 16 texels.\n")
    print("| map | burin s | of processors | bytes per texel | vtracer s | of processors | bytes per texel | ratio |")
    print("|---|---|---|---|---|---|---|---|")
    ratios = []
    for name, path in maps:
        if arguments.only not in name:
            continue
        ours, theirs = burin(path), vtracer(path)
        ratios.append(ours.wall / theirs.wall)
        print(f"| {name} | {ours.wall:.2f} | {ours.cpu:.2f} | {(ours.peak - base) / SIDE ** 2:.1f} | {theirs.wall:.2f} | "
              f"{theirs.cpu:.2f} | {theirs.peak / SIDE ** 2:.1f} | {ratios[-1]:.2f} |", flush=True)
    if ratios:
        print(f"\nRatio: median {statistics.median(ratios):.2f}, greatest {max(ratios):.2f}.")
    if series:
        print(f"\n{SERIES_MAP} from {SERIES[0]} to {SERIES[-1]}.\n")
        print("| side | burin s | of processors | microseconds per texel | bytes per texel |\n|---|---|---|---|---|")
    for side, path in series:
        ours = burin(path)
        print(f"| {side} | {ours.wall:.2f} | {ours.cpu:.2f} | {1e6 * ours.wall / side ** 2:.3f} | "
              f"{(ours.peak - base) / side ** 2:.1f} |", flush=True)


if __name__ == "__main__":
    main()
