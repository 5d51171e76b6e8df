#!/usr/bin/env python3
"""Two runs, and runs with 1 and 2 threads, give equal bytes: convert, the heights of render --top, and check."""

import argparse
import hashlib
import os

import harness
import inputs


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def compare_runs(verdicts, burin, what, make):
    """`make(threads, path)` gives the arguments of a run that writes path."""
    with harness.Scratch() as folder:
        digests = []
        for number, threads in enumerate(("1", "1", "2", "3")):
            path = os.path.join(folder, f"run{number}" + what[1])
            outcome = harness.run(burin, make(threads, path))
            if not verdicts.expect(outcome.status == 0, f"{what[0]} with {threads} threads", outcome):
                return
            digests.append(digest(path))
        verdicts.expect(digests[0] == digests[1], f"{what[0]}: two runs give equal bytes")
        verdicts.expect(len(set(digests)) == 1, f"{what[0]}: 1, 2 and 3 threads give equal bytes")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("--plate", required=True)
    parser.add_argument("--shared", required=True)
    arguments = parser.parse_args()
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        places = inputs.write_inputs(folder)
        maps = [places["groove.png"], places["noise.png"], arguments.plate]
        shared = os.path.join(arguments.shared, "height", "evillair_ex_wall_panel3_h.png")
        if os.path.exists(shared):
            maps.append(shared)
        for path in maps:
            compare_runs(verdicts, arguments.burin, ("convert " + os.path.basename(path), ".glb"),
                         lambda threads, out, path=path: ["convert", path, "-o", out, "--threads", threads, "-q"])
        asset = os.path.join(folder, "asset.glb")
        made = harness.run(arguments.burin, ["convert", places["groove.png"], "-o", asset])
        verdicts.expect(made.status == 0, "convert for render", made)
        compare_runs(verdicts, arguments.burin, ("render --top", ".exr"),
                     lambda _, out: ["render", asset, "--top", "-o", out, "--size", "128x128"])
        compare_runs(verdicts, arguments.burin, ("render", ".png"),
                     lambda _, out: ["render", asset, "-o", out, "--size", "64x64", "--samples", "2"])
    verdicts.finish()


if __name__ == "__main__":
    main()
