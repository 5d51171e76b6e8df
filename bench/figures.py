#!/usr/bin/env python3
"""Prints, as a Markdown table, what burin makes of the maps of ../shared/data/height.

    bench/figures.py [--burin build/cli/burin] [--npm build/npm] [--pictures FOLDER] [--without-shader] [MAP...]

Each map is converted, validated twice, drawn, and checked by the evaluator and by the shader. With --pictures the drawn
views stay in that folder.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "tests", "cli"))
import gltf_validator  # noqa: E402

MAPS = [
    "evillair_ex_concrete_floor1_h.png", "pk02_panels01a_h.png", "pk02_floor_cyl02_h.png",
    "oga_crate01_height_from_alpha_512.png", "brick_mask_2k.jpg", "trak5_tile1_h.png", "evillair_ex_wall_panel3_h.png",
    "scratches_gold01_1k_clean_gray.png", "sponza_background_bump.png", "trak5_pipes_h.png",
    "pk01_wall03_h_CONSTANT.png", "vulkan_terrain_heightmap_r16_16bit.png", "3dtextures_rock_ore001_disp_1k.png",
    "3dtextures_crystal_metal001_disp_1k.png", "sponza_column_a_bump.png",
]
HEAD = ["map", "texels", "paths", "lines + quadratics", "profiles", "explained", "texels per element",
        "texture bytes (grid + data)", "of raw 8 bit", "file", "RMS %", "p99.9 %", "edge RMS texels (lost)",
        "shader RMS %", "normals off, degrees: paths alone, with residual", "residual texels", "of the map's",
        "residual bytes (PNG)", "of raw 8 bit, all textures", "seconds", "findings: burin / official", "path-like"]


def run_json(words, allowed=(0,)):
    done = subprocess.run(words + ["--format", "json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode not in allowed:
        raise RuntimeError(f"{' '.join(words)}: {done.returncode} {done.stderr.decode().strip()}")
    return json.loads(done.stdout)


def draw(burin, asset, folder, name):
    """Three views: all of it, and two close-ups."""
    views = {"all": [], "near": ["--zoom", "8", "--center", "0.37,0.41"], "nearer": ["--zoom", "24", "--center", "0.62,0.3"]}
    for view, words in views.items():
        path = os.path.join(folder, f"{name}_{view}.png")
        subprocess.run([burin, "render", asset, "-o", path, "-q"] + words, check=True)


def edge_text(edges):
    """RMS over the edges found, and the share that is farther than two texels."""
    return f"{edges['rms_found']:.3f} ({100 * edges['lost']:.1f} %)" if edges["length"] else "no edges"


def row_of(arguments, name, folder):
    path = os.path.join(arguments.shared, name)
    asset = os.path.join(folder, name + ".glb")
    stats = run_json([arguments.burin, "convert", path, "-o", asset])
    found = run_json([arguments.burin, "validate", asset], (0, 1))
    official = gltf_validator.validate(arguments.npm, asset)
    figures = run_json([arguments.burin, "check", asset, "--against", path])
    shader = None
    if not arguments.without_shader:
        shader = run_json([arguments.burin, "check", asset, "--against", path, "--with", "shader"])
    draw(arguments.burin, asset, arguments.pictures or folder, os.path.splitext(name)[0])
    lines, quadratics = stats["elements"]["lines"], stats["elements"]["quadratics"]
    grid, data = stats["bytes"]["grid_texture"], stats["bytes"]["data_texture"]
    width, height = stats["map"]["width"], stats["map"]["height"]
    normals, residual = stats["normal_error"], stats["residual"]
    texels, residual_bytes = residual["width"] * residual["height"], stats["bytes"]["residual_file"]
    per_element = stats["path_length_texels"] / (lines + quadratics) if lines + quadratics else 0
    return [os.path.splitext(name)[0], f"{width}x{height}", stats["paths"], f"{lines} + {quadratics}",
            stats["profiles"], f"{figures['explained']:.4f}", f"{per_element:.1f}",
            f"{grid + data} ({grid} + {data})", f"1/{width * height / (grid + data):.1f}", stats["bytes"]["file"],
            f"{100 * figures['rms']:.3f}", f"{100 * figures['p999']:.2f}", edge_text(figures["edges"]),
            f"{100 * shader['rms']:.3f}" if shader else "-",
            f"{normals['paths_alone']:.2f}, {normals['with_residual']:.2f}",
            f"{residual['width']}x{residual['height']}" if texels else "none",
            f"1/{width * height / texels:.0f}" if texels else "0", residual_bytes,
            f"1/{width * height / (grid + data + residual_bytes):.1f}", f"{sum(stats['seconds'].values()):.1f}",
            f"{found['errors']} / {official['issues']['numErrors'] if official else 'absent'}",
            "yes" if stats["path_like"] else "no"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--burin", default=os.path.join(ROOT, "build", "cli", "burin"))
    parser.add_argument("--npm", default=os.path.join(ROOT, "build", "npm"))
    parser.add_argument("--shared", default=os.path.join(ROOT, "..", "shared", "data", "height"))
    parser.add_argument("--pictures")
    parser.add_argument("--without-shader", action="store_true", help="OSMesa takes up to a minute a map")
    parser.add_argument("maps", nargs="*", default=MAPS)
    arguments = parser.parse_args()
    if arguments.pictures:
        os.makedirs(arguments.pictures, exist_ok=True)
    print("| " + " | ".join(HEAD) + " |\n|" + "---|" * len(HEAD), flush=True)
    failed = False
    with tempfile.TemporaryDirectory(prefix="burin_figures_") as folder:
        for name in arguments.maps:
            try:
                print("| " + " | ".join(str(cell) for cell in row_of(arguments, name, folder)) + " |", flush=True)
            except (RuntimeError, subprocess.SubprocessError, OSError) as error:
                failed = True
                print(f"| {name} | {error} |", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
