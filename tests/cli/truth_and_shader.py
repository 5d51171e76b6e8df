#!/usr/bin/env python3
"""Flat maps with steps: what `check` finds by the evaluator and by the shader is the same."""

import json
import os

import harness
import inputs


def figures(verdicts, burin, asset, path, more):
    outcome = harness.run(burin, ["check", asset, "--against", path, "--format", "json"] + more)
    # A driver that is here and refuses a shader is a failure.
    if outcome.status == 5 and "shader" not in outcome.err:
        harness.skip("no OpenGL context here")
    return json.loads(outcome.stdout) if verdicts.expect(outcome.status == 0, "checks", outcome) else None


def main():
    arguments = harness.read_arguments()
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        for name, data in inputs.flat_maps().items():
            path, asset = os.path.join(folder, name + ".png"), os.path.join(folder, name + ".glb")
            with open(path, "wb") as file:
                file.write(data)
            outcome = harness.run(arguments.burin, ["convert", path, "-o", asset])
            if not verdicts.expect(outcome.status == 0, f"{name} converts", outcome):
                continue
            own = harness.run(arguments.burin, ["validate", asset])
            verdicts.expect(own.status == 0, f"{name} is valid", own)
            truth = figures(verdicts, arguments.burin, asset, path, [])
            shader = figures(verdicts, arguments.burin, asset, path, ["--with", "shader"])
            if not truth or not shader:
                continue
            print(f"{name}: explained {truth['explained']:.4f} and {shader['explained']:.4f}, "
                  f"RMS {truth['rms']:.5f} and {shader['rms']:.5f}", flush=True)
            verdicts.expect(abs(truth["explained"] - shader["explained"]) <= 0.01, f"{name}: explained agrees")
            verdicts.expect(abs(truth["rms"] - shader["rms"]) <= 0.003, f"{name}: RMS agrees")
    verdicts.finish()


if __name__ == "__main__":
    main()
