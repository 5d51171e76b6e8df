#!/usr/bin/env python3
"""Maps made by others, from ../shared/data/height: convert, validate (burin's own and the official validator), render,
check, within the bounds that burin promises. One map a run."""

import argparse
import json
import os

import gltf_validator
import harness

# Name, and what must hold: least explained, least texels of path per element, most bytes of both textures, most bytes
# as a share of the raw 8-bit map. None: no bound.
BOUNDS = {
    "evillair_ex_concrete_floor1_h.png": (0.995, 12, 65536, 1 / 32),
    "pk02_panels01a_h.png": (0.985, 12, 65536, 1 / 16),
    "pk02_floor_cyl02_h.png": (0.98, 8, 65536, 1 / 8),
    "oga_crate01_height_from_alpha_512.png": (0.995, 12, 65536, 1 / 32),
    "brick_mask_2k.jpg": (0.995, 8, 65536, 1 / 40),
    "trak5_tile1_h.png": (0.985, 8, None, 1 / 16),
    "evillair_ex_wall_panel3_h.png": (0.995, 12, None, 1 / 30),
    "scratches_gold01_1k_clean_gray.png": (0.6, 12, None, 1 / 8),
    "sponza_background_bump.png": (0.75, 6, None, 1 / 4),
    "trak5_pipes_h.png": (0.975, None, None, 1 / 16),
}
CONSTANT = "pk01_wall03_h_CONSTANT.png"
TERRAIN = "vulkan_terrain_heightmap_r16_16bit.png"


def convert(verdicts, burin, path, output):
    outcome = harness.run(burin, ["convert", path, "-o", output, "--format", "json"], timeout=240)
    if not verdicts.expect(outcome.status == 0, "converts", outcome):
        verdicts.finish()
    print(outcome.stdout)
    return json.loads(outcome.stdout)


def check_validators(verdicts, arguments, output):
    own = harness.run(arguments.burin, ["validate", output])
    verdicts.expect(own.status == 0, "burin validate finds no error", own)
    official = gltf_validator.validate(arguments.npm, output)
    if official is None:
        print("the official validator is not here: that part is SKIPPED")
        return
    verdicts.expect(official["issues"]["numErrors"] == 0, "the official validator finds no error",
                    json.dumps(official["issues"], indent=1))


def check_render(verdicts, burin, folder, output):
    picture = os.path.join(folder, "view.png")
    outcome = harness.run(burin, ["render", output, "-o", picture, "--size", "160x120", "--samples", "2"])
    verdicts.expect(outcome.status == 0 and os.path.getsize(picture) > 100, "renders", outcome)


def check_figures(verdicts, burin, path, output):
    outcome = harness.run(burin, ["check", output, "--against", path, "--format", "json"])
    if verdicts.expect(outcome.status == 0, "checks", outcome):
        print(outcome.stdout)
        return json.loads(outcome.stdout)
    return None


def check_bounds(verdicts, name, stats, figures):
    explained, texels_per_element, most_bytes, most_share = BOUNDS[name]
    elements = stats["elements"]["lines"] + stats["elements"]["quadratics"]
    textures = stats["bytes"]["grid_texture"] + stats["bytes"]["data_texture"]
    raw = stats["map"]["width"] * stats["map"]["height"]
    if explained is not None:
        verdicts.expect(figures["explained"] >= explained, f"explained {figures['explained']:.4f} >= {explained}")
    if texels_per_element is not None:
        mean = stats["path_length_texels"] / max(elements, 1)
        verdicts.expect(mean >= texels_per_element, f"{mean:.1f} texels per element >= {texels_per_element}")
    if most_bytes is not None:
        verdicts.expect(textures < most_bytes, f"{textures} bytes of textures < {most_bytes}")
    if most_share is not None and stats["path_like"]:
        verdicts.expect(textures < most_share * raw, f"{textures} bytes of textures < {most_share} of {raw}")


def check_special(verdicts, name, stats):
    if name == CONSTANT:
        verdicts.expect(stats["paths"] == 0, "a constant map gives no path")
        verdicts.expect(stats["notes"], "and a note says so")
    if name == TERRAIN:
        textures = stats["bytes"]["grid_texture"] + stats["bytes"]["data_texture"]
        raw = stats["map"]["width"] * stats["map"]["height"]
        verdicts.expect(not stats["path_like"], "the terrain is not path-like")
        verdicts.expect(any("not path-like" in note["note"] for note in stats["notes"]), "and a note says so")
        verdicts.expect(textures <= raw / 16, f"{textures} bytes of textures do not explode")
        verdicts.expect(sum(stats["seconds"].values()) < 60, "nor does the time")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("--shared", required=True)
    parser.add_argument("--npm", required=True, help="folder with node_modules")
    parser.add_argument("map")
    arguments = parser.parse_args()
    path = os.path.join(harness.shared_data(arguments, "height"), arguments.map)
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        output = os.path.join(folder, "out.glb")
        stats = convert(verdicts, arguments.burin, path, output)
        check_validators(verdicts, arguments, output)
        check_render(verdicts, arguments.burin, folder, output)
        figures = check_figures(verdicts, arguments.burin, path, output)
        if arguments.map in BOUNDS and figures:
            check_bounds(verdicts, arguments.map, stats, figures)
        check_special(verdicts, arguments.map, stats)
    verdicts.finish()


if __name__ == "__main__":
    main()
