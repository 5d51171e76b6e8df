#!/usr/bin/env python3
"""Measures burin beside its rivals and judges, and remakes docs/performance.md and its plots from the results that there are.

    bench/performance/run.sh [PART ...] [--quick] [--finest SIZE] [--scene NAME ...] [--document]

Without parts all are measured, one after the other (hours on two cores, most of it for the truth's pictures and the rivals' maps, which are kept
in the build folder; --quick takes an hour or two). What was measured lies in docs/performance/results, a run of one scene beside the run of all;
a newer row takes the place of an older one. --document measures nothing.
"""

import argparse
import dataclasses
import datetime
import json
import os
import shlex
import subprocess
import sys
import tempfile
import time

import document
from results import read_runs

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


@dataclasses.dataclass
class Part:
    program: str                 # below build/bench, and a target of the build
    words: list = dataclasses.field(default_factory=list)
    quick: list = dataclasses.field(default_factory=lambda: ["--quick"])
    scenes: bool = True          # understands --scene
    cache: bool = True           # understands --cache
    lines: bool = False          # understands --lines
    pictures: bool = False       # draws plots of its own


PARTS = {
    "rivals": Part("rivals/bench_rivals", quick=["--quick"], lines=True),
    "figure12": Part("rivals/bench_figure12"),
    "geometry": Part("geometry/bench_geometry"),
    "reference": Part("runtime/bench_runtime", ["reference"]),
    "atrium": Part("runtime/bench_runtime", ["atrium"], scenes=False),
    "tables": Part("runtime/bench_runtime", ["tables"]),
    "grid": Part("runtime/bench_runtime", ["grid"], pictures=True),
    "memory": Part("runtime/bench_runtime", ["memory"]),
    "pack": Part("pack/bench_pack", quick=["100000"], scenes=False, cache=False),
    "shares": Part("reference/bench_reference", quick=["--count", "500"], scenes=False, cache=False),
}


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else os.uname().machine


def commit():
    """Of what is measured: results that lie about in docs are no change of it."""
    def git(*words):
        done = subprocess.run(["git", "-C", ROOT, *words], stdout=subprocess.PIPE, check=False)
        return done.stdout.decode().strip() if done.returncode == 0 else "unknown"
    changed = git("status", "--porcelain", "--untracked-files=no", "--", ":/", ":!/docs")
    return git("rev-parse", "--short=7", "HEAD") + (" and changes" if changed else "")


def words_of(part, scene, arguments):
    words = part.words + (part.quick if arguments.quick else [])
    if part.lines and arguments.finest:
        words = words + ["--finest", str(arguments.finest)]
    if part.scenes:
        words = words + (["--scene", scene] if scene else [])
    return words


def measure(name, scene, arguments):
    """Runs one part; its results appear only when it has come to its end."""
    part = PARTS[name]
    words = words_of(part, scene, arguments)
    base = os.path.join(arguments.results, name + (f".{scene}" if scene else ""))
    with tempfile.TemporaryDirectory(prefix="burin_performance_") as folder:
        lines, output = os.path.join(folder, "lines"), os.path.join(folder, "output")
        extra = ["--cache", arguments.cache] if part.cache else []
        extra += ["--lines", lines] if part.lines else []
        extra += ["--pictures", os.path.splitext(arguments.out)[0]] if part.pictures else []
        about = {"command": shlex.join([os.path.basename(part.program)] + words), "commit": commit(),
                 "date": datetime.datetime.now().isoformat(timespec="seconds"), "machine": machine(), "cores": os.cpu_count()}
        start = time.monotonic()
        with open(output, "wb") as file:
            subprocess.run([os.path.join(arguments.build, "bench", part.program)] + words + extra, stdout=file, check=True)
        about["seconds"] = round(time.monotonic() - start)
        for source, suffix in [(output, ".md")] + ([(lines, ".jsonl")] if part.lines else []):
            with open(source, encoding="utf-8") as file:
                document.write(base + suffix, file.read())
        document.write(base + ".json", json.dumps(about, indent=1) + "\n")
    if not scene:
        forget_scenes(name, arguments.results)


def forget_scenes(name, results):
    """A run of all scenes stands for those of single ones before it."""
    for file in os.listdir(results):
        if file.startswith(name + ".") and os.path.splitext(file)[0] != name:
            os.remove(os.path.join(results, file))


def measure_all(arguments):
    """True where every part came to its end; the others are told of."""
    os.makedirs(arguments.results, exist_ok=True)
    os.makedirs(arguments.cache, exist_ok=True)
    os.makedirs(os.path.splitext(arguments.out)[0], exist_ok=True)
    whole = True
    for name in arguments.parts or PARTS:
        for scene in arguments.scene if PARTS[name].scenes and arguments.scene else [""]:
            print(f"{name} {scene} ...", flush=True)
            try:
                measure(name, scene, arguments)
            except (subprocess.CalledProcessError, OSError) as error:
                print(f"performance: error: {name} {scene}: {error}; its older results stay", file=sys.stderr)
                whole = False
    return whole


def parse():
    build = os.path.join(ROOT, "build")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--quick", action="store_true", help="smaller pictures, fewer runs")
    parser.add_argument("--scene", action="append", help="only this one; more than once if wanted; atrium, pack and shares have none")
    parser.add_argument("--finest", type=int, help="rivals' maps: 512 to 8192, the default, texels per side")
    parser.add_argument("--document", action="store_true", help="measure nothing")
    parser.add_argument("--build", default=build)
    parser.add_argument("--cache", default=os.path.join(build, "bench", "truth"))
    parser.add_argument("--results", default=os.path.join(ROOT, "docs", "performance", "results"))
    parser.add_argument("--out", default=os.path.join(ROOT, "docs", "performance.md"))
    arguments = parser.parse_args()
    unknown = [part for part in arguments.parts if part not in PARTS]
    if unknown:
        parser.error(f"'{unknown[0]}' is no part; parts: {', '.join(PARTS)}")
    return arguments


def main():
    arguments = parse()
    whole = arguments.document or measure_all(arguments)
    document.update(arguments.out, PARTS, read_runs(arguments.results))
    sys.exit(0 if whole else 1)


if __name__ == "__main__":
    main()
