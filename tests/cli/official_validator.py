#!/usr/bin/env python3
"""What burin writes from its own small inputs passes the official glTF validator without an error, and the rectangle without a
warning."""

import argparse
import json
import os

import gltf_validator
import harness
import inputs

MODELS = (None, "one_material.gltf", "plane.obj")
MAPS = ("groove.png", "constant.png", "noise.png", "one_texel.png")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("--npm", required=True, help="folder with node_modules")
    arguments = parser.parse_args()
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        places = inputs.write_inputs(folder)
        output = os.path.join(folder, "out.glb")
        for height_map in MAPS:
            for model in MODELS:
                onto = ["--model", places[model]] if model else []
                outcome = harness.run(arguments.burin, ["convert", places[height_map], "-o", output] + onto)
                verdicts.expect(outcome.status == 0, f"{height_map} onto {model} converts", outcome)
                report = gltf_validator.validate(arguments.npm, output)
                if report is None:
                    harness.skip("gltf-validator is not installed (npm registry out of reach)")
                issues = report["issues"]
                # A model without tangents is warned of; burin's own rectangle has them.
                clean = issues["numErrors"] == 0 and (model is not None or issues["numWarnings"] == 0)
                verdicts.expect(clean, f"{height_map} onto {model}: no error, no warning", json.dumps(issues, indent=1))
    verdicts.finish()


if __name__ == "__main__":
    main()
