#!/usr/bin/env python3
"""Patterns and recipes in JSON, as their schemas describe them and as burin reads them.

Every sample is valid, packs, and shows relief; what vectorize writes is valid and gives the asset of its drawing; what is wrong is
refused by both, reader and schema; and so is what a sample becomes when one of its values is spoilt, as far as the schema says."""

import argparse
import copy
import json
import os
import random
import re
import subprocess

import jsonschema

import harness
import inputs

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SAMPLES = os.path.join(ROOT, "samples", "patterns")
RECIPES = os.path.join(ROOT, "samples", "recipes")
SEED = 20260611

# Sets one value of the pattern below, and says what the reader answers. The first word is the place that the message names.
BASE = {
    "units": "mm", "size": 10, "depth": 2,
    "profiles": [{"name": "groove", "shape": "vee", "width": 1, "height": -1}, {"points": [[-1, 0], [0, -1], [1, 0]]}],
    "materials": [{"name": "steel", "metallic": 1}],
    "perturbations": [{"name": "wave", "kind": "sine", "width": 0.1, "wavelength": 1}],
    "paths": [{"profile": "groove", "points": [[1, 5], [9, 5]]}, {"profile": 1, "d": "M5 1 V9", "material": "steel", "perturbation": "wave"}],
    "regions": [{"outline": "M2 2 H4 V4 H2 Z", "level": -0.5}],
}
WRONG = [
    ("paths[0].profil", lambda p: p["paths"][0].update(profil=p["paths"][0].pop("profile")), r'did you mean "profile"\?'),
    ("paths[0]", lambda p: p["paths"][0].pop("profile"), '"profile" is missing'),
    ("paths[0]", lambda p: p["paths"][0].pop("points"), '"d" .* or "points"'),
    ("paths[1]", lambda p: p["paths"][1].update(points=[[0, 0], [1, 1]]), '"d" .* or "points"'),
    ("paths[0].points[1]", lambda p: p["paths"][0]["points"].__setitem__(1, [9]), "a list of 1 does not work here; a list of 2 does"),
    ("paths[0].points[1][0]", lambda p: p["paths"][0]["points"].__setitem__(1, ["9", 5]), '"9" does not work here; a number does'),
    ("paths[0].points", lambda p: p["paths"][0].update(points=[]), "an empty list"),
    ("paths[0].width_scale", lambda p: p["paths"][0].update(width_scale=4), "4 is out of its range; 0 to below 4 works"),
    ("paths[0].width_scale[1]", lambda p: p["paths"][0].update(width_scale=[1, -0.5]), "-0.5 is out of its range"),
    ("paths[0].caps", lambda p: p["paths"][0].update(caps="rund"), '"rund" does not work here; "hip", "butt", "round" or "taper" does'),
    ("paths[0].join", lambda p: p["paths"][0].update(join="miter"), '"mitre", "round" or "bevel" does'),
    ("paths[0].level", lambda p: p["paths"][0].update(level=None), "null does not work here; a number does"),
    ("paths[0].closed", lambda p: p["paths"][0].update(closed=1), "true or false"),
    ("paths[0].at.count[0]", lambda p: p["paths"][0].update(at={"step": [1, 1], "count": [0, 1]}), "0 is out of its range; 1 to 1024 works"),
    ("paths[0].at.count[0]", lambda p: p["paths"][0].update(at={"step": [1, 1], "count": [1.5, 1]}), "a whole number"),
    ("paths[0].at", lambda p: p["paths"][0].update(at=[]), "a list of 1 to"),
    ("paths[1].material", lambda p: p["paths"][1].update(material=-1), "-1 is out of its range; 0 to 1 works"),
    ("paths", lambda p: p.update(paths={}), "an object does not work here; a list does"),
    ("paths[0]", lambda p: p["paths"].__setitem__(0, 7), "an object in braces"),
    ("profiles[0]", lambda p: p["profiles"][0].update(points=[[0, 0], [1, 1]]), 'one of "points", "shape" and "step"'),
    ("profiles[0]", lambda p: p["profiles"][0].pop("width"), '"width" is missing'),
    ("profiles[0].height", lambda p: p["profiles"][0].update(height=0), "a height of 0 is no relief"),
    ("profiles[0].width", lambda p: p["profiles"][0].update(width=0), "0 is out of its range; more than 0 works"),
    ("profiles[1].points", lambda p: p["profiles"][1].update(points=[[0, 0]]), "a list of 1 .* 2 to 32"),
    ("profiles[1].points", lambda p: p["profiles"][1].update(points=[[i, 0] for i in range(33)]), "a list of 33 .* 2 to 32"),
    ("profiles[1].facets[0]", lambda p: p["profiles"][1].update(facets=["inside", "internal"]), '"automatic", "internal" or "external"'),
    ("profiles[1].width", lambda p: p["profiles"][1].update(width=1), "no property of this name"),
    ("materials[0].metallic", lambda p: p["materials"][0].update(metallic=2), "2 is out of its range; 0 to 1 works"),
    ("materials[0].base_color", lambda p: p["materials"][0].update(base_color=[1, 1]), "3 to 4"),
    ("materials[0].colour", lambda p: p["materials"][0].update(colour=[1, 1, 1]), "no property of this name"),
    ("perturbations[0].kind", lambda p: p["perturbations"][0].update(kind="sinus"), '"sine", "polynomial" or "noise"'),
    ("perturbations[0]", lambda p: p["perturbations"][0].pop("wavelength"), '"wavelength" is missing'),
    ("perturbations[0].seed", lambda p: p["perturbations"][0].update(seed=1), "no property of this name"),
    ("perturbations[0].octaves", lambda p: p["perturbations"][0].update(kind="noise", octaves=9), "1 to 8 works"),
    ("perturbations[0].width", lambda p: p["perturbations"][0].update(kind="polynomial", width=[1] * 5), "a list of 5"),
    ("regions[0]", lambda p: p["regions"][0].pop("level"), '"level" is missing'),
    ("regions[0].outline", lambda p: p["regions"][0].update(outline=3), "path data as in SVG, or a list of points"),
    ("regions[0].edge", lambda p: p["regions"][0].update(edge=-1), "-1 is out of its range; 0 or more works"),
    ("regions[0].edge", lambda p: p["regions"][0].update(edge={"shape": "vee"}), '"width" is missing'),
    ("regions[0].caps", lambda p: p["regions"][0].update(caps="hip"), "no property of this name"),
    ("size", lambda p: p.update(size=0), "0 is out of its range; more than 0 works"),
    ("size", lambda p: p.update(size=[1, 2, 3]), "a list of 2"),
    ("depth", lambda p: p.update(depth=-1), "-1 is out of its range"),
    ("", lambda p: p.pop("depth"), '"depth" is missing'),
    ("units", lambda p: p.update(units="inch"), '"m", "cm", "mm", "um" or "in"'),
    ("units", lambda p: p.update(units={"plane": "m"}), '"height" is missing'),
    ("wrap", lambda p: p.update(wrap="mirror"), '"repeat" or "clamp"'),
    ("base_offset", lambda p: p.update(base_offset=-1), "0 or more works"),
    ("tolerance", lambda p: p.update(tolerance=0), "more than 0 works"),
]
# Wrong in ways that no schema can say.
WRONG_FOR_READERS = [
    ("paths[0].profile", lambda p: p["paths"][0].update(profile="grove"), '"grove" is no name in "profiles"; did you mean "groove"\\?'),
    ("paths[0].profile", lambda p: p["paths"][0].update(profile="vee"), '"vee" is a shape and no name in "profiles"; {"shape": "vee", '),
    ("paths[0].profile", lambda p: p["paths"][0].update(profile=2), "2 is out of its range; 0 to 1 works"),
    ("paths[1].material", lambda p: p["paths"][1].update(material=2), "2 is out of its range; 0 to 1 works"),
    ("paths[1].perturbation", lambda p: p["paths"][1].update(perturbation="x"), '"x" is no name in "perturbations", which has wave'),
    ("paths[0].width_scale", lambda p: p["paths"][0].update(width_scale=[1, 1, 1]), r"a list of 3 for 1 elements; one number, \[start, end\], 2 numbers"),
    ("paths[1].d", lambda p: p["paths"][1].update(d="M5 1 V"), "path data ends too early"),
    ("paths[1].d", lambda p: p["paths"][1].update(d="M5 1 X9"), "path data has 'X' at character 6"),
    ("paths[1].d", lambda p: p["paths"][1].update(d="M5 1"), "it draws nothing"),
    ("paths[0].points", lambda p: p["paths"][0].update(points=[[1, 1], [1, 1]]), "it draws nothing"),
    ("profiles[1].name", lambda p: p["profiles"][1].update(name="groove"), "names an entry before it"),
    ("profiles[0].shape", lambda p: p["profiles"][0].update(shape="spline"), "spline"),
    ("profiles[1].facets", lambda p: p["profiles"][1].update(facets=["internal"]), "a list of 2"),
    ("regions[0].level", lambda p: p["regions"][0].update(level=0), "as high as the ground around it"),
    ("regions[0].edge.points", lambda p: p["regions"][0].update(edge={"points": [[-1, 0], [1, 1]]}), "rises by 0.001 m .* and the region by -5e-04 m"),
    ("regions[0].outline", lambda p: p["regions"][0].update(outline="M0 0 H2 H0 Z"), "encloses no area"),
    ("paths[0]", lambda p: p["paths"][0].update(at={"step": [0, 0], "count": [1024, 1024]}) or p["paths"][0].update(
        points=[[i, 0] for i in range(9)]), "elements up to here, limit 4194304"),
]
# Text that is no JSON, or more than is read.
DAMAGED = [
    ("", r":1:0: syntax error.*unexpected end"),
    ("{", r":1:1: syntax error.*unexpected end"),
    ('{"size": 1,\n "depth": NaN}', r":2:\d+: syntax error.*invalid literal"),
    ('{"size": 1,\n "depth": 1e999}', r":2:\d+: number overflow"),
    ('{"size": 1,\n "size": 2, "depth": 1}', r":2: size: this name stands twice in its object, before on line 1"),
    ('{"size": 1, "depth": 1, "x": ' + "[" * 100000, "nested deeper than 64 levels"),
    ('{"size": 1,\n\n "depth": "\xff"}'.encode("latin-1"), r":3:\d+: syntax error.*UTF-8"),
    ('{"size": 1, "depth": 1} x', r":1:25: syntax error"),
    ("[]", ":1: an empty list does not work here; an object in braces does"),
]


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def write(path, content):
    with open(path, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())
    return path


def schema(name):
    loaded = read_json(os.path.join(ROOT, "format", name))
    jsonschema.Draft202012Validator.check_schema(loaded)
    return jsonschema.Draft202012Validator(loaded)


class Checker:
    """Runs burin on documents and compares its answer with the schema's."""

    def __init__(self, burin, folder):
        self.burin, self.folder, self.verdicts = burin, folder, harness.Verdicts()
        self.pattern = schema("pattern.schema.json")

    def path(self, name):
        return os.path.join(self.folder, name)

    def pack(self, document, name="p.json"):
        text = document if isinstance(document, (str, bytes)) else json.dumps(document, indent=1)
        return harness.run(self.burin, ["pack", write(self.path(name), text), "-o", self.path("p.glb"), "-q"])

    def expect(self, condition, what, outcome=""):
        return self.verdicts.expect(condition, what, outcome)

    def done(self, arguments):
        outcome = harness.run(self.burin, arguments)
        return self.expect(outcome.status == 0, "burin " + " ".join(arguments), outcome)


def bytes_of(path):
    with open(path, "rb") as file:
        return file.read()


def check_sample(checker, name):
    """Valid, packs, is seen, and keeps what it is through the writer's words."""
    path = os.path.join(SAMPLES, name)
    faults = list(checker.pattern.iter_errors(read_json(path)))
    checker.expect(not faults, f"{name} is valid, but {faults[:1]}")
    asset, picture = checker.path(name + ".glb"), checker.path(name + ".png")
    if not checker.done(["pack", path, "-o", asset]):
        return
    checker.done(["validate", asset])
    if checker.done(["render", asset, "-o", picture, "--size", "96x72", "--samples", "1"]):
        flat = checker.path("flat.png")
        empty = dict(read_json(path), paths=[], regions=[], profiles=[])
        checker.pack(empty, "flat.json")
        checker.done(["render", checker.path("p.glb"), "-o", flat, "--size", "96x72", "--samples", "1"])
        checker.expect(bytes_of(picture) != bytes_of(flat), f"{name} shows relief")


def check_vectorized(checker):
    """What vectorize writes is valid, and packs."""
    places = inputs.write_inputs(checker.folder)
    for name in ("plate.png", "constant.png"):
        written = checker.path(name + ".json")
        if checker.done(["vectorize", places[name], "-o", written, "-q"]):
            faults = list(checker.pattern.iter_errors(read_json(written)))
            checker.expect(not faults, f"{written} is valid, but {faults[:1]}")
            checker.done(["pack", written, "-o", checker.path("again.glb")])


def check_refused(checker, place, outcome, answer):
    begin = r"burin \w+: error: \S*\.json:\d+: " + (re.escape(place) + ": " if place else "")
    checker.expect(outcome.status == 3 and harness.one_line_error(outcome) and re.match(begin + ".*" + answer, outcome.stderr),
                   f"refused at {place!r} with {answer!r}", outcome)


def check_wrong(checker):
    checker.expect(checker.pattern.is_valid(BASE) and checker.pack(BASE).status == 0, "the pattern that is spoilt is right")
    for place, spoil, answer in WRONG + WRONG_FOR_READERS:
        document = copy.deepcopy(BASE)
        spoil(document)
        check_refused(checker, place, checker.pack(document), answer)
        by_schema = (place, spoil, answer) in WRONG
        checker.expect(checker.pattern.is_valid(document) != by_schema, f"the schema {'refuses' if by_schema else 'takes'} {place}: {answer}")
    for text, answer in DAMAGED:
        outcome = checker.pack(text)
        checker.expect(outcome.status == 3 and re.search(answer, outcome.stderr), f"damaged: {answer}", outcome)


def nodes(value, path=()):
    yield path
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield from nodes(inner, path + (key,))


def spoil_one(document, chance):
    """Another value at a place that chance names."""
    path = chance.choice([path for path in nodes(document) if path])
    holder = document
    for key in path[:-1]:
        holder = holder[key]
    kind = chance.randrange(3)
    if kind == 0 and isinstance(holder, dict):
        holder[str(path[-1]) + "x"] = holder.pop(path[-1])
    elif kind == 1:
        del holder[path[-1]]
    else:
        holder[path[-1]] = chance.choice([None, True, -1, 0, 1.5, 1e300, "", "steel", "Z", [], [1], [[1, 2]], {}, {"kind": "sine"}])
    return path


def check_spoilt(checker, count):
    """What the schema refuses, the reader refuses as well, and never in another way than with one line."""
    print("seed", SEED)
    chance = random.Random(SEED)
    refused = 0
    for i in range(count):
        name = chance.choice(sorted(os.listdir(SAMPLES)))
        document = read_json(os.path.join(SAMPLES, name))
        path = spoil_one(document, chance)
        outcome = checker.pack(document)
        valid = checker.pattern.is_valid(document)
        refused += not valid
        checker.expect(outcome.status in (0, 3) and (valid or outcome.status == 3),
                       f"{i}: {name} with another {path}: valid {valid}, status {outcome.status}", outcome)
        checker.expect(outcome.status == 0 or harness.one_line_error(outcome), f"{i}: {name} with another {path}: one line", outcome)
    checker.expect(refused > count // 4, f"{refused} of {count} are refused by the schema")


def options_of(burin, command):
    shown = subprocess.run([burin, command, "--help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^ +--([a-z0-9-]+)", shown, re.M))


def check_recipe_schema(checker, recipe):
    """A pattern of a recipe has the options of both commands, but those that a recipe has once."""
    once = {"output", "model", "report", "error-map", "threads", "format", "quiet", "help"}
    options = (options_of(checker.burin, "convert") | options_of(checker.burin, "pack")) - once
    stated = set(recipe.schema["properties"]["patterns"]["items"]["properties"]) - {"from", "note"}
    checker.expect({name.replace("-", "_") for name in options} == stated, f"options {sorted(options)}, schema {sorted(stated)}")


def two_commands(checker, model, patterns, output):
    """Command after command, each on what the one before wrote."""
    for i, (command, file, options) in enumerate(patterns):
        target = output if i + 1 == len(patterns) else checker.path(f"step{i}.glb")
        checker.done([command, file, "-o", target, "--model", model] + options)
        model = target


def check_recipes(checker):
    recipe = schema("recipe.schema.json")
    check_recipe_schema(checker, recipe)
    for name in sorted(os.listdir(RECIPES)):
        if name.endswith(".json"):
            document = read_json(os.path.join(RECIPES, name))
            checker.expect(recipe.is_valid(document), f"{name} is valid")
            made, by_hand = checker.path("recipe.glb"), checker.path("by_hand.glb")
            if checker.done(["build", os.path.join(RECIPES, name), "-o", made]):
                checker.done(["validate", made])
                steps = [("pack", os.path.join(RECIPES, p["from"]), ["--material", p["material"]]) for p in document["patterns"]]
                two_commands(checker, os.path.join(RECIPES, document["model"]), steps, by_hand)
                checker.expect(bytes_of(made) == bytes_of(by_hand), f"{name} gives the bytes of one command after the other")
    check_own_recipe(checker, recipe)


def check_own_recipe(checker, recipe):
    """A map and a pattern, an output beside the recipe, and what is wrong."""
    places = inputs.write_inputs(checker.folder)
    base = {"model": "two_materials.gltf", "output": "made.glb", "patterns": [
        {"from": "groove.png", "material": "slate", "depth": 0.02, "size": [0.5, 0.5], "wrap": "clamp", "residual": "none"},
        {"from": "b.json", "material": "brass", "cell_size": 0.001}]}
    write(checker.path("b.json"), json.dumps(BASE))
    checker.expect(recipe.is_valid(base), "the recipe is valid")
    file = write(checker.path("recipe.json"), json.dumps(base))
    if checker.done(["build", file]):
        by_hand = checker.path("by_hand.glb")
        two_commands(checker, places["two_materials.gltf"],
                     [("convert", places["groove.png"], ["--material", "slate", "--depth", "0.02", "--size", "0.5x0.5", "--wrap", "clamp", "--residual", "none"]),
                      ("pack", checker.path("b.json"), ["--material", "brass", "--cell-size", "0.001"])], by_hand)
        checker.expect(bytes_of(checker.path("made.glb")) == bytes_of(by_hand), "a map and a pattern give the bytes of one command after the other")
    wrong = [
        ("patterns[0].dept", lambda r: r["patterns"][0].update(dept=1), 'did you mean "depth"', True),
        ("patterns[1].depth", lambda r: r["patterns"][1].update(depth=1), "no property of this name here", False),
        ("patterns[0].depth", lambda r: r["patterns"][0].update(depth=0), "--depth '0' is out of its range", True),
        ("patterns[0].polarity", lambda r: r["patterns"][0].update(polarity="up"), "height, depth works", True),
        ("patterns[0].size", lambda r: r["patterns"][0].update(size=[1]), "a list of 2", True),
        ("patterns[1].tex_coord", lambda r: r["patterns"][1].update(tex_coord=8), "--tex-coord '8' is out of its range", True),
        ("patterns[1]", lambda r: r["patterns"][1].update(tex_coord=1), "TEXCOORD_1", False),
        ("patterns[1]", lambda r: r["patterns"][1].update(material="slate"), r"material 'slate' carries the pattern of patterns\[0\] already", False),
        ("patterns[1]", lambda r: r["patterns"][1].update(material="wood"), "wood", False),
        ("patterns[1]", lambda r: r["patterns"][1].update({"from": "none.json"}), "none.json", False),
        ("patterns[1]", lambda r: r["patterns"][1].pop("from"), '"from" is missing', True),
        ("patterns", lambda r: r.update(patterns=[]), "an empty list", True),
        ("plane", lambda r: r.update(plane=1), '"model" is given too', True),
        ("patterns", lambda r: r.pop("model"), 'several patterns need a "model"', False),
        ("outputs", lambda r: r.update(outputs="x.glb"), 'did you mean "output"', True),
    ]
    os.remove(checker.path("made.glb"))
    for place, spoil, answer, by_schema in wrong:
        document = copy.deepcopy(base)
        spoil(document)
        write(file, json.dumps(document, indent=1))
        check_refused(checker, place, harness.run(checker.burin, ["build", file]), answer)
        checker.expect(recipe.is_valid(document) != by_schema, f"the schema {'refuses' if by_schema else 'takes'} {place}: {answer}")
        checker.expect(not os.path.exists(checker.path("made.glb")), f"{place}: nothing is written")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("--spoilt", type=int, default=150)
    arguments = parser.parse_args()
    with harness.Scratch() as folder:
        checker = Checker(arguments.burin, folder)
        samples = sorted(os.listdir(SAMPLES))
        checker.expect(len(samples) >= 5, "there are samples")
        for name in samples:
            check_sample(checker, name)
        check_vectorized(checker)
        check_wrong(checker)
        check_recipes(checker)
        check_spoilt(checker, arguments.spoilt)
    checker.verdicts.finish()


if __name__ == "__main__":
    main()
