#!/usr/bin/env python3
"""An output that is one of the files the command reads, under whatever name, is refused with 2 and stays as it was."""

import os
import shutil

import harness
import inputs


def refuse(verdicts, burin, words, kept, what):
    with open(kept, "rb") as file:
        before = file.read()
    outcome = harness.run(burin, words)
    verdicts.expect(outcome.status == 2, f"{what}: status is 2", outcome)
    verdicts.expect(harness.one_line_error(outcome) and "another name works" in outcome.stderr, f"{what}: says so", outcome)
    with open(kept, "rb") as file:
        verdicts.expect(file.read() == before, f"{what}: the input stays")


def main():
    arguments = harness.read_arguments()
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        groove = inputs.write_inputs(folder)["groove.png"]
        asset = os.path.join(folder, "asset.glb")
        made = harness.run(arguments.burin, ["convert", groove, "-o", asset])
        verdicts.expect(made.status == 0, "the asset is converted", made)

        # The suffix says nothing about the content: a map may be called .glb, an asset .png.
        map_glb, asset_png = os.path.join(folder, "map.glb"), os.path.join(folder, "asset.png")
        shutil.copyfile(groove, map_glb)
        shutil.copyfile(asset, asset_png)
        symbolic, hard = os.path.join(folder, "symbolic.glb"), os.path.join(folder, "hard.glb")
        os.symlink(map_glb, symbolic)
        os.link(map_glb, hard)
        around = os.path.join(folder, "..", os.path.basename(folder), "map.glb")
        for name in (map_glb, symbolic, hard, around):
            refuse(verdicts, arguments.burin, ["convert", map_glb, "-o", name], map_glb, f"convert onto {name}")
        refuse(verdicts, arguments.burin, ["convert", symbolic, "-o", map_glb], map_glb, "convert of a link onto its file")
        refuse(verdicts, arguments.burin, ["convert", groove, "--model", asset, "-o", asset], asset, "convert onto --model")
        map_png, map_html, map_svg = (os.path.join(folder, "map." + suffix) for suffix in ("png", "html", "svg"))
        for name, option in ((map_png, "--error-map"), (map_html, "--report")):
            shutil.copyfile(groove, name)
            words = ["convert", name, "-o", os.path.join(folder, "new.glb"), option, name]
            refuse(verdicts, arguments.burin, words, name, f"convert with {option} onto the map")
        shutil.copyfile(groove, map_svg)
        refuse(verdicts, arguments.burin, ["vectorize", map_svg, "-o", map_svg], map_svg, "vectorize onto the map")
        for words in ([], ["--top"]):
            refuse(verdicts, arguments.burin, ["render", asset_png, "-o", asset_png] + words, asset_png, f"render {words}")

        for suffix, words in ((".svg", ["--mask"]), (".glb", ["--model"])):
            read = os.path.join(folder, "read" + suffix)
            shutil.copyfile(groove if suffix == ".svg" else asset, read)
            refuse(verdicts, arguments.burin, ["generate", "scratches", "-o", read, *words, read], read, f"generate onto {words[0]}")

        # What was there but is not read is replaced as ever.
        again = harness.run(arguments.burin, ["convert", map_glb, "-o", asset])
        verdicts.expect(again.status == 0, "an older output is replaced", again)
    verdicts.finish()


if __name__ == "__main__":
    main()
