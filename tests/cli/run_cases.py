#!/usr/bin/env python3
"""Runs the cases of one JSON file: command, status, stdout, stderr, files.

A case:
    name        what it shows
    arguments   words after `burin`; {groove.png} is an input of inputs.py, {out} the case's own folder,
                {asset} a glb converted from groove.png
    status      exit code
    stdout      regular expressions that each match; an empty list: nothing may be printed
                with `--format json` among the words and a status of 0 or 1, stdout must, besides, be JSON with the
                keys of cli/JSON.md
    stderr      the same; a status other than 0 and 1 must, besides, give one line of the documented error form
    files       names in {out} that must exist afterwards; everything else in {out} is a failure
    environment variables to set
"""

import argparse
import json
import os
import re

import documented_keys
import harness
import inputs


def fill(text, places):
    """Puts paths in place of {names}."""
    for name, path in places.items():
        text = text.replace("{" + name + "}", path)
    return text


def check_text(verdicts, case, what, patterns, text, outcome):
    if patterns == []:
        verdicts.expect(text == "", f"{case['name']}: {what} must be empty", outcome)
    for pattern in patterns or []:
        verdicts.expect(re.search(pattern, text, re.M), f"{case['name']}: {what} matches {pattern!r}", outcome)


def asks_for_json(words):
    return "json" in [after for word, after in zip(words, words[1:]) if word == "--format"]


def check_json(verdicts, case, outcome):
    try:
        result = json.loads(outcome.stdout)
    except ValueError as fault:
        verdicts.expect(False, f"{case['name']}: stdout is JSON, but {fault}", outcome)
        return
    different = list(documented_keys.differences(case["arguments"][0], result))
    verdicts.expect(not different, f"{case['name']}: keys as documented, but {different}", outcome)


def run_case(verdicts, burin, case, places, folder):
    out = os.path.join(folder, "out_" + re.sub(r"\W", "_", case["name"]))
    os.mkdir(out)
    known = dict(places, out=out)
    arguments = [fill(word, known) for word in case["arguments"]]
    outcome = harness.run(burin, arguments, folder=out, environment=case.get("environment"))
    verdicts.expect(outcome.status == case["status"], f"{case['name']}: status is {case['status']}", outcome)
    check_text(verdicts, case, "stdout", case.get("stdout"), outcome.stdout, outcome)
    check_text(verdicts, case, "stderr", case.get("stderr"), outcome.stderr, outcome)
    if case["status"] in (0, 1) and asks_for_json(arguments):
        check_json(verdicts, case, outcome)
    if case["status"] not in (0, 1):
        verdicts.expect(harness.one_line_error(outcome), f"{case['name']}: one line of error", outcome)
        verdicts.expect(outcome.stdout == "", f"{case['name']}: nothing on stdout", outcome)
    left = sorted(os.listdir(out))
    verdicts.expect(left == sorted(case.get("files", [])), f"{case['name']}: files {left}", outcome)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("cases")
    arguments = parser.parse_args()
    verdicts = harness.Verdicts()
    with open(arguments.cases, encoding="utf-8") as file:
        cases = json.load(file)
    with harness.Scratch() as folder:
        places = inputs.write_inputs(folder)
        places["asset"] = os.path.join(folder, "asset.glb")
        if any("{asset}" in word for case in cases for word in case["arguments"]):
            made = harness.run(arguments.burin, ["convert", places["groove.png"], "-o", places["asset"]])
            verdicts.expect(made.status == 0, "the asset of the cases is converted", made)
        for case in cases:
            run_case(verdicts, arguments.burin, case, places, folder)
    verdicts.finish()


if __name__ == "__main__":
    main()
