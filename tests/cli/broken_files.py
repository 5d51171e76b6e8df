#!/usr/bin/env python3
"""Every file of ../shared/data/broken as MAP and as --model: a clear message and a documented exit code, or a correct
result where the file is merely unusual; never a crash, a hang, or a partial file."""

import argparse
import concurrent.futures
import os

import harness
import inputs

LIMIT_SECONDS = 10
WHOLE_MAP_BYTES = 300000  # a file as large is a whole map with a damaged label, whose conversion takes what it takes
WHOLE_MAP_SECONDS = 60
ALLOWED = (0, 2, 3, 5)  # done, usage, input, not available here
# Files that readers must take: valid, if rare. The others may be refused or read.
MUST_READ = ("png_edge_valid_", "tif_edge_valid_no_rows", "tif_edge_valid_BigTIFF", "jpg_edge_valid_", "jpg_edge_arithmetic",
             "tif_edge_valid_gradient", "tif_edge_valid_int16", "exr_edge_valid_")
# Files that no reader may take as a height map.
MUST_REFUSE = ("png_bad_x", "exr_bad_", "glb_bad_", "gltf_bad_", "svg_bad_", "tga_", "dds_", "bmp_")


def judge(verdicts, outcome, what, output, limit):
    verdicts.expect(outcome.status != "timeout", f"{what}: ends within {limit} s", outcome)
    verdicts.expect(outcome.status in ALLOWED, f"{what}: a documented exit code", outcome)
    if outcome.status == 0:
        verdicts.expect(os.path.exists(output), f"{what}: the output exists", outcome)
    else:
        verdicts.expect(harness.one_line_error(outcome), f"{what}: one line of error", outcome)


def check_no_rest(verdicts, folder, outcome, what):
    """After a failure nothing is left; after success the output alone."""
    left = os.listdir(folder)
    verdicts.expect(left == (["out.glb"] if outcome.status == 0 else []), f"{what}: leaves {left}", outcome)


def validated(verdicts, burin, output, what):
    outcome = harness.run(burin, ["validate", output])
    verdicts.expect(outcome.status == 0, f"{what}: what was written validates", outcome)


def is_whole_map(path):
    return os.path.getsize(path) > WHOLE_MAP_BYTES


def try_file(verdicts, burin, path, arguments, what):
    with harness.Scratch() as folder:
        output = os.path.join(folder, "out.glb")
        limit = WHOLE_MAP_SECONDS if is_whole_map(path) else LIMIT_SECONDS
        outcome = harness.run(burin, ["convert"] + arguments + ["-o", output], timeout=limit)
        judge(verdicts, outcome, what, output, limit)
        check_no_rest(verdicts, folder, outcome, what)
        if outcome.status == 0:
            validated(verdicts, burin, output, what)
        else:
            print(f"  {what}: {outcome.stderr.strip()}")
    return outcome


def check_name(verdicts, burin, folder, groove, name):
    path = os.path.join(folder, name)
    outcome = try_file(verdicts, burin, path, [path], f"{name} as MAP")
    if name.startswith(MUST_READ):
        verdicts.expect(outcome.status == 0, f"{name} is read", outcome)
    if name.startswith(MUST_REFUSE):
        verdicts.expect(outcome.status == 3, f"{name} is refused as input", outcome)
    model = try_file(verdicts, burin, path, [groove, "--model", path], f"{name} as --model")
    if name.startswith(("png_", "jpg_", "tif_", "exr_", "bmp_", "tga_", "dds_", "glb_bad_glb", "svg_")):
        verdicts.expect(model.status == 3, f"{name} is refused as model", model)
    for command in ("info", "validate"):
        seen = harness.run(burin, [command, path], timeout=LIMIT_SECONDS)
        verdicts.expect(seen.status in (0, 1, 3), f"{command} {name}: a documented exit code", seen)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    parser.add_argument("--shared", required=True)
    arguments = parser.parse_args()
    folder = harness.shared_data(arguments, "broken")
    harness.limit_memory(6 << 30)
    verdicts = harness.Verdicts()
    with harness.Scratch() as scratch:
        groove = inputs.write_inputs(scratch)["groove.png"]
        # Whole maps take all cores, and others beside them would lengthen what is bounded. The rest is done by one.
        names = sorted(os.listdir(folder))
        whole = [name for name in names if is_whole_map(os.path.join(folder, name))]
        for name in whole:
            check_name(verdicts, arguments.burin, folder, groove, name)
        with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
            rest = [name for name in names if name not in whole]
            for one in [pool.submit(check_name, verdicts, arguments.burin, folder, groove, name) for name in rest]:
                one.result()
    verdicts.finish()


if __name__ == "__main__":
    main()
