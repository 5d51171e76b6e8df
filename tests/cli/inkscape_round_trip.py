#!/usr/bin/env python3
"""A drawing of vectorize goes through Inkscape, which moves a path, deletes one and copies one, and is packed again: the surface is
another one where those paths lie, and the same everywhere else."""

import argparse
import os
import re
import shutil
import struct
import subprocess
import xml.etree.ElementTree
import zlib

import harness
import views

SVG = "{http://www.w3.org/2000/svg}"


def paths_of(drawing):
    root = xml.etree.ElementTree.parse(drawing).getroot()
    return {node.get("id"): dict(node.attrib) for node in root.iter(SVG + "path") if node.get("data-burin-profile") is not None}


def edit(drawing, edited, folder):
    actions = ("select-by-id:path-2;delete;select-clear;select-by-id:path-5;transform-translate:12,-8;select-clear;"
               f"select-by-id:path-0;duplicate;transform-translate:0,30;export-filename:{edited};export-do")
    environment = dict(os.environ, HOME=folder)
    return subprocess.run(["inkscape", f"--actions={actions}", drawing], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          timeout=300, check=False)


def numbers(text):
    return [float(word) for word in re.findall(r"-?\d+\.?\d*(?:[eE][-+]?\d+)?", text)]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("--plate", required=True)
    arguments = parser.parse_args()
    if shutil.which("inkscape") is None:
        harness.skip("inkscape is not installed")
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        place = lambda name: os.path.join(folder, name)
        outcome = harness.run(arguments.burin, ["vectorize", arguments.plate, "-o", place("a.svg"), "--size", "0.2", "--depth", "0.0032"])
        verdicts.expect(outcome.status == 0, "the plate is vectorized", outcome)
        # What the drawing says is what was found: packed again it is the same file, whatever wrote it.
        for name in ("a", "b"):
            outcome = harness.run(arguments.burin, ["pack", place("a.svg"), "-o", place(name + ".glb"), "--format", "json"])
            verdicts.expect(outcome.status == 0, "the drawing packs", outcome)
        saved = subprocess.run(["inkscape", f"--actions=export-filename:{place('saved.svg')};export-do", place("a.svg")],
                               env=dict(os.environ, HOME=folder), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300, check=False)
        verdicts.expect(saved.returncode == 0 and os.path.exists(place("saved.svg")), "Inkscape saves the drawing", saved.stdout.decode())
        outcome = harness.run(arguments.burin, ["pack", place("saved.svg"), "-o", place("saved.glb")])
        verdicts.expect(outcome.status == 0, "what Inkscape saved packs", outcome)
        with open(place("a.glb"), "rb") as one, open(place("saved.glb"), "rb") as other:
            verdicts.expect(one.read() == other.read(), "saved by Inkscape without a change it packs to the same bytes")

        edited = edit(place("a.svg"), place("edited.svg"), folder)
        verdicts.expect(edited.returncode == 0 and os.path.exists(place("edited.svg")), "Inkscape edits the drawing", edited.stdout.decode())
        before, after = paths_of(place("a.svg")), paths_of(place("edited.svg"))
        copies = [name for name in after if name not in before]
        verdicts.expect("path-2" not in after and len(copies) == 1, f"one path is gone and one new: {copies}")
        same = [name for name in after if name in before and name != "path-5"]
        changed = [name for name in same if before[name]["d"] != after[name]["d"] or after[name].get("transform")]
        verdicts.expect(not changed and len(same) == len(before) - 2, f"the others are as they were: {changed}")
        outcome = harness.run(arguments.burin, ["pack", place("edited.svg"), "-o", place("edited.glb"), "--format", "json"])
        verdicts.expect(outcome.status == 0, "the edited drawing packs", outcome)
        for name in ("a", "edited"):
            outcome = harness.run(arguments.burin, ["render", "--top", place(name + ".glb"), "-o", place(name + ".png"), "--size", "256"])
            verdicts.expect(outcome.status == 0, "heights are drawn", outcome)
        compare_heights(verdicts, place, before, after, copies)
    verdicts.finish()


def compare_heights(verdicts, place, before, after, copies):
    """Heights differ only within the boxes of the paths that were touched, and do differ there."""
    one, other = (grey_rows(place(name + ".png")) for name in ("a", "edited"))
    width, height = len(one[0]), len(one)
    touched = [before["path-2"], before["path-5"], after["path-5"]] + [after[name] for name in copies]
    boxes = [box_of(path, width) for path in touched]
    outside = inside = 0
    for y in range(height):
        for x in range(width):
            if one[y][x] == other[y][x]:
                continue
            if any(low_x <= x <= high_x and low_y <= y <= high_y for low_x, low_y, high_x, high_y in boxes):
                inside += 1
            else:
                outside += 1
    verdicts.expect(outside == 0, f"{outside} texels differ away from what was touched")
    verdicts.expect(inside > 100, f"{inside} texels differ where paths were touched")


def grey_rows(name):
    """Rows of a 16-bit grey PNG without interlacing, as burin writes heights."""
    with open(name, "rb") as file:
        png = file.read()
    width, height = views.size_of(png)
    data, at = b"", 8
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IDAT":
            data += png[at + 8:at + 8 + length]
        at += length + 12
    raw, rows, before = zlib.decompress(data), [], bytearray(2 * width)
    for y in range(height):
        start = y * (2 * width + 1)
        before = views.unfilter(raw[start], bytearray(raw[start + 1:start + 1 + 2 * width]), before, 2)
        rows.append(struct.unpack(f">{width}H", bytes(before)))
    return rows


def box_of(path, width):
    """Texels that the path may change: absolute coordinates of `d`, moved by a translation, grown by the stroke's width. A path that
    Inkscape wrote in relative coordinates has its box over the whole map."""
    margin = 2.0 * float(path.get("stroke-width", "0")) + 0.001
    if re.search("[a-y]", path["d"]):
        return 0, 0, width, width
    values = numbers(path["d"])
    shift = numbers(path["transform"]) if path.get("transform", "").startswith("translate") else [0.0, 0.0]
    scale = width / 0.2
    xs, ys = [x + shift[0] for x in values[0::2]], [y + (shift[1] if len(shift) > 1 else 0.0) for y in values[1::2]]
    return ((min(xs) - margin) * scale, (min(ys) - margin) * scale, (max(xs) + margin) * scale, (max(ys) + margin) * scale)


if __name__ == "__main__":
    main()
