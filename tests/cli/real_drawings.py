#!/usr/bin/env python3
"""Every drawing of samples and of shared/data/svg packs, validates and renders; the single-stroke fonts engrave a line; damaged drawings give an answer
or an error that names the place."""

import argparse
import glob
import os

import harness


def pack(verdicts, burin, drawing, output, *more):
    outcome = harness.run(burin, ["pack", drawing, "-o", output, "--size", "0.2", *more])
    verdicts.expect(outcome.status == 0, f"{os.path.basename(drawing)} packs", outcome)
    outcome = harness.run(burin, ["validate", output])
    verdicts.expect(outcome.status == 0, f"{os.path.basename(drawing)} is valid", outcome)
    outcome = harness.run(burin, ["render", output, "-o", output + ".png", "--size", "64x48", "--samples", "1"])
    verdicts.expect(outcome.status == 0, f"{os.path.basename(drawing)} renders", outcome)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("--shared", required=True)
    parser.add_argument("--samples", required=True)
    arguments = parser.parse_args()
    own = sorted(glob.glob(os.path.join(arguments.samples, "*.svg")))
    drawings = sorted(glob.glob(os.path.join(arguments.shared, "svg", "*.svg")))
    if not drawings:
        harness.skip("no drawings in " + arguments.shared)
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        output = os.path.join(folder, "a.glb")
        page = os.path.join(folder, "page.svg")
        with open(page, "w", encoding="utf-8") as file:
            file.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 60"><path id="way" d="M5 40Q100 10 195 40" stroke="red"/></svg>')
        verdicts.expect(len(own) > 0, "there are drawings of burin's own")
        for drawing in own + drawings:
            if os.path.basename(drawing).startswith("hershey"):
                pack(verdicts, arguments.burin, page, output, "--text", "Burin 2026", "--font", drawing, "--text-path", "way")
            else:
                pack(verdicts, arguments.burin, drawing, output)
        broken = sorted(glob.glob(os.path.join(arguments.shared, "broken", "*.svg")))
        verdicts.expect(len(broken) > 0, "there are damaged drawings")
        for drawing in broken:
            outcome = harness.run(arguments.burin, ["pack", drawing, "-o", os.path.join(folder, "b.glb")])
            named = outcome.status == 0 or harness.one_line_error(outcome) and "line " in outcome.stderr
            verdicts.expect(outcome.status in (0, 3) and named, f"{os.path.basename(drawing)} is read, or its line named", outcome)
    verdicts.finish()


if __name__ == "__main__":
    main()
