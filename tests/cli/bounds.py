#!/usr/bin/env python3
"""Bounds on error and bytes: what is written keeps them; one that cannot be kept is refused with a value that does work."""

import argparse
import json
import os
import re
import struct

import harness
import inputs


def stored_residual(path):
    """Bytes of the residual in a glb: of the view of its image."""
    with open(path, "rb") as file:
        data = file.read()
    document = json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])
    detail = document["materials"][0]["extensions"]["BURIN_materials_path_detail"]
    if "residualTexture" not in detail:
        return 0
    image = document["images"][document["textures"][detail["residualTexture"]["index"]]["source"]]
    return document["bufferViews"][image["bufferView"]]["byteLength"]


class Runs:
    def __init__(self, arguments, verdicts, folder):
        self.burin, self.verdicts = arguments.burin, verdicts
        made = inputs.write_inputs(folder)
        self.map, self.noise = made["plate.png"], made["noise.png"]
        self.asset = os.path.join(folder, "a.glb")

    def convert(self, words, map_file=None):
        if os.path.exists(self.asset):
            os.remove(self.asset)
        return harness.run(self.burin, ["convert", map_file or self.map, "-o", self.asset, "--format", "json"] + words)

    def kept(self, words, map_file=None):
        """Figures of a conversion that must succeed, checked against what the written asset gives."""
        map_file = map_file or self.map
        outcome = self.convert(words, map_file)
        if not self.verdicts.expect(outcome.status == 0, f"{words} are kept", outcome):
            return None
        figures = json.loads(outcome.stdout)
        textures = figures["bytes"]["grid_texture"] + figures["bytes"]["data_texture"]
        total = textures + stored_residual(self.asset)
        self.verdicts.expect(figures["bytes"]["total"] == total, f"{words}: {total} bytes are stated", outcome)
        shares = figures["by_class"]
        self.verdicts.expect(abs(shares["steps"] + shares["lines"] + shares["left"] - 1) < 1e-12, "shares add up to 1")
        self.verdicts.expect(abs(1 - shares["left"] - figures["explained"]) < 1e-12, "what is left is not explained")
        check = harness.run(self.burin, ["check", self.asset, "--against", map_file, "--format", "json"])
        measured = json.loads(check.stdout)
        for key in ("p999", "rms", "max", "explained"):
            self.verdicts.expect(measured[key] == figures[key], f"{words}: {key} is that of the file", check)
        return dict(figures, textures=textures, total=total)

    def refused(self, words, pattern):
        """The value that the refusal of these words names."""
        outcome = self.convert(words)
        self.verdicts.expect(outcome.status == 2 and harness.one_line_error(outcome), f"{words} are refused", outcome)
        self.verdicts.expect(not os.path.exists(self.asset), f"{words}: no file is left", outcome)
        found = re.search(pattern, outcome.stderr)
        self.verdicts.expect(found, f"{words}: a value that works is named", outcome)
        return found.group(1) if found else None


def check_residual(runs, verdicts):
    """Of a map that is not path-like, the residual is nearly all of the bytes."""
    free = runs.kept([], runs.noise)
    bound = free["total"] - 1
    figures = runs.kept(["--max-bytes", str(bound)], runs.noise)
    verdicts.expect(free["bytes"]["residual_file"] > free["textures"], f"{free['bytes']}")
    verdicts.expect(figures["total"] <= bound, f"textures and residual keep {bound} bytes: {figures['bytes']}")
    notes = [note["note"] for note in figures["notes"]]
    verdicts.expect(any("within --max-bytes" in note for note in notes), f"that is said: {notes}")


def check_search(runs, verdicts, plate):
    """Curves of letters and arcs come far closer to the map than they are without a bound."""
    words = ["--size", "0.2", "--depth", "0.0032"]
    free = runs.kept(words, plate)
    bound = 0.15
    close = runs.kept(words + ["--max-error", str(bound)], plate)
    verdicts.expect(close and close["p999"] * 100 <= 3 * bound < free["p999"] * 100, f"{bound} % is kept, without: {free['p999']}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("--plate", required=True, help="the sample map")
    arguments = parser.parse_args()
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        runs = Runs(arguments, verdicts, folder)
        free = runs.kept([])
        verdicts.expect(free["by_class"]["steps"] > 0.5 and free["by_class"]["lines"] > 0.005, "both classes explain")
        verdicts.expect(free["paths_by_kind"] == {"steps": 1, "grooves": 1, "ridges": 0}, f"{free['paths_by_kind']}")

        tight = free["textures"] * 3 // 4
        small = runs.kept(["--max-bytes", str(tight)])
        verdicts.expect(small["textures"] <= tight and small["bounds"]["max_bytes"] == tight, f"{tight} bytes are kept")
        least = runs.refused(["--max-bytes", "1"], r"limit of 1 bytes .* cannot be kept: .*; (\d+) bytes works")
        verdicts.expect(runs.kept(["--max-bytes", least])["total"] <= int(least), f"{least} bytes work as promised")
        runs.refused(["--max-bytes", str(int(least) * 7 // 8)], r"; (\d+) bytes works")
        runs.refused(["--max-bytes", "900", "--cell-size", "0.02"], r"with cells of the size that was asked for; (\d+) bytes works")
        runs.refused(["--max-bytes", "2K", "--max-error", "0.001"], r"the closest paths within 2048 bytes err .*; ([\d.]+) % works")
        verdicts.expect(runs.kept(["--max-bytes", "1G"])["bounds"]["max_bytes"] == 2**30, "1G is a GiB")
        check_residual(runs, verdicts)

        bound = free["p999"] * 101
        easy = runs.kept(["--max-error", f"{bound:.6f}"])
        verdicts.expect(easy["textures"] == free["textures"], "a bound that is kept anyway changes nothing")
        best = runs.refused(["--max-error", "0.001"], r"error of 0.001 % of range cannot be kept: .*; ([\d.]+) % works")
        verdicts.expect(runs.kept(["--max-error", best])["p999"] * 100 <= float(best), f"{best} % works as promised")
        # The groove ends at the left border elsewhere than at the right one, so that the map is better not joined there.
        runs.refused(["--max-error", "0.1"], r"by ([\d.]+) % but for the borders, .*: wrap clamp; [\d.]+ % works")
        verdicts.expect(runs.kept(["--max-error", "0.1", "--wrap", "clamp"]), "without a seam the bound is kept")
        check_search(runs, verdicts, arguments.plate)
    verdicts.finish()


if __name__ == "__main__":
    main()
