#!/usr/bin/env python3
"""Standard output that takes nothing: every command ends with 4 and one line of error, and none leaves a file."""

import os

import harness
import inputs


def full_disk():
    return os.open("/dev/full", os.O_WRONLY)


def closed_pipe():
    reading, writing = os.pipe()
    os.close(reading)
    return writing


def main():
    arguments = harness.read_arguments()
    if not os.path.exists("/dev/full"):
        harness.skip("/dev/full is not here")
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder, harness.Scratch() as out:
        groove = inputs.write_inputs(folder)["groove.png"]
        asset = os.path.join(folder, "asset.glb")
        made = harness.run(arguments.burin, ["convert", groove, "-o", asset])
        verdicts.expect(made.status == 0, "the asset is converted", made)
        commands = (["convert", groove, "-o", os.path.join(out, "a.glb")],
                    ["vectorize", groove, "-o", os.path.join(out, "a.svg"), "--report", os.path.join(out, "a.html"),
                     "--error-map", os.path.join(out, "a.png")],
                    ["render", asset, "-o", os.path.join(out, "a.png"), "--size", "16", "--samples", "1"],
                    ["render", asset, "--top", "-o", os.path.join(out, "a.exr"), "--size", "16"],
                    ["check", asset, "--against", groove, "--max-rms", "0"],
                    ["info", asset], ["validate", asset], ["convert", "--help"], ["--version"])
        for words in commands:
            for lost in (full_disk, closed_pipe):
                stdout = lost()
                outcome = harness.run(arguments.burin, words, stdout=stdout)
                os.close(stdout)
                verdicts.expect(outcome.status == 4, f"{words[0]} into a {lost.__name__}: status is 4", outcome)
                verdicts.expect("error: standard output cannot be written\n" in outcome.stderr,
                                f"{words[0]} into a {lost.__name__}: says so", outcome)
                left = os.listdir(out)
                verdicts.expect(left == [], f"{words[0]} into a {lost.__name__}: leaves {left}", outcome)
    verdicts.finish()


if __name__ == "__main__":
    main()
