#!/usr/bin/env python3
"""Two runs, and runs with 1, 2 and 3 threads, give equal bytes: convert, both kinds of render, and what check prints.

With --shared-map NAME that map of ../shared/data is converted and nothing else; SKIPPED where it is not here."""

import argparse
import hashlib
import os

import harness
import inputs


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def compare_runs(verdicts, burin, what, suffix, make):
    """`make(threads, path)` gives the arguments of a run. The file that it writes is compared, or, where the suffix is
    None, what it prints."""
    with harness.Scratch() as folder:
        results = []
        for number, threads in enumerate(("1", "1", "2", "3")):
            path = os.path.join(folder, f"run{number}{suffix}")
            outcome = harness.run(burin, make(threads, path), timeout=240)
            if not verdicts.expect(outcome.status == 0, f"{what} with {threads} threads", outcome):
                return
            results.append(digest(path) if suffix else outcome.stdout)
        verdicts.expect(results[0] != "", f"{what}: there is something to compare")
        verdicts.expect(results[0] == results[1], f"{what}: two runs give equal bytes")
        verdicts.expect(len(set(results)) == 1, f"{what}: 1, 2 and 3 threads give equal bytes")


def compare_conversions(verdicts, burin, path):
    compare_runs(verdicts, burin, "convert " + os.path.basename(path), ".glb",
                 lambda threads, out: ["convert", path, "-o", out, "--threads", threads, "-q"])


def compare_readers(verdicts, burin, folder, groove):
    """The commands that read an asset."""
    asset = os.path.join(folder, "asset.glb")
    made = harness.run(burin, ["convert", groove, "-o", asset])
    verdicts.expect(made.status == 0, "convert for render and check", made)
    compare_runs(verdicts, burin, "render --top", ".exr",
                 lambda _, out: ["render", asset, "--top", "-o", out, "--size", "128x128"])
    compare_runs(verdicts, burin, "render", ".png",
                 lambda _, out: ["render", asset, "-o", out, "--size", "64x64", "--samples", "2"])
    for reader in ("truth", "shader"):
        compare_runs(verdicts, burin, "check --with " + reader, None,
                     lambda threads, _, reader=reader: ["check", asset, "--against", groove, "--with", reader,
                                                        "--threads", threads, "--format", "json"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    given = parser.add_mutually_exclusive_group(required=True)
    given.add_argument("--plate", help="the sample plate: compare everything that needs no shared map")
    given.add_argument("--shared-map", help="a map of SHARED/height: compare its conversions alone")
    parser.add_argument("--shared")
    arguments = parser.parse_args()
    verdicts = harness.Verdicts()
    if arguments.shared_map:
        path = os.path.join(harness.shared_data(arguments, "height"), arguments.shared_map)
        compare_conversions(verdicts, arguments.burin, path)
        verdicts.finish()
    with harness.Scratch() as folder:
        places = inputs.write_inputs(folder)
        for path in (places["groove.png"], places["noise.png"], arguments.plate):
            compare_conversions(verdicts, arguments.burin, path)
        compare_readers(verdicts, arguments.burin, folder, places["groove.png"])
    verdicts.finish()


if __name__ == "__main__":
    main()
