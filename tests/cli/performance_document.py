#!/usr/bin/env python3
"""bench/performance on a few recorded results: what the page says, what it leaves open, its plots, and what happens to results of a
program that fails."""

import json
import os
import re
import stat
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.path.join(ROOT, "bench", "performance", "performance.py")
BLOCKS = ["runs", "headline", "rivals", "rivals plots", "geometry", "atrium", "atrium plot", "pack", "table 2008"]
RIVALS = """Renderer: some renderer. Threads: 2.

### At burin's own error

Text above the table.

| scene | view | burin dB | ms | unreached: best dB | dB | ms | time | bytes | blocks |
|---|---|--:|--:|--:|--:|--:|--:|--:|--:|
"""
ATRIUM = """### Atrium

400 x 300 pixels.

| technique | ms | PSNR | SSIM | off | paper fps |
|---|--:|--:|--:|--:|--:|
| 4 samples | 1000 | 26.00 | 0.8 | 0 | 17.24 |
| 16 samples | 4000 | 34.00 | 0.9 | 0 |  |
| areas, 4 rays where features meet | 800 | 30.00 | 0.9 | 0 | 33.6 |
| relief mapping with 4x full-screen antialiasing | 400 | 25.00 | 0.8 | 9 | 33.1 |
"""
PACK = """## Pack

| elements | number | patterns | bits of a reference | pack s, least | us per element |
|---|--:|--:|--:|--:|--:|
| lines | 10000 | 1 | 16 | 0.01 | 1.00 |
| lines | 1000000 | 1 | 32 | 0.30 | 0.30 |
| lines | 1000000 | 25 | 16 | 2.50 | 2.50 |
"""
failed = 0


def expect(holds, what):
    global failed
    if not holds:
        failed += 1
        print(f"FAILED: {what}")


def line(view, technique, setting, ms, decibels, size):
    return {"scene": "crossing", "view": view, "kind": "grooves", "technique": technique, "setting": setting, "ms": ms, "dB": decibels,
            "bytes": size, "block_bytes": size}


def record(folder, name, day, output, lines=()):
    about = {"command": "bench_" + name, "commit": "c0ffee" + str(day), "date": f"2026-01-0{day}T10:00:00", "machine": "a machine", "cores": 2}
    for suffix, text in ((".md", output), (".json", json.dumps(about)), (".jsonl", "\n".join(json.dumps(one) for one in lines))):
        if text:
            with open(os.path.join(folder, name + suffix), "w", encoding="utf-8") as file:
                file.write(text)


def record_all(folder):
    record(folder, "rivals", 1, RIVALS + "| crossing | near | 40.0 | 10 |  | 41 | 8 | 0.80 | 900 | 40 |\n"
           "| crossing | far | 45.0 | 10 | (41) | 40 | 8 | (2.00) | 100 | 20 |\n",
           [line("near", "burin", "default", 999.0, 40.0, 1000), line("far", "burin", "default", 10.0, 45.0, 1000)])
    near = [line("near", "burin", "default", 10.0, 40.0, 1000), line("near", "relief", "a", 1.0, 20.0, 1e6), line("near", "relief", "b", 2.0, 19.0, 1e6),
            line("near", "relief", "c", 100.0, 41.0, 1e7)]
    record(folder, "rivals.crossing", 2, RIVALS + "| crossing | near | 40.0 | 10 |  | 41 | 30 | 3.00 | 900 | 40 |\n", near)
    record(folder, "atrium", 1, ATRIUM)


def run(*words):
    return subprocess.run([sys.executable, "-B", PROGRAM, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)


def block(text, name):
    return re.search(f"<!-- begin {name} -->\n(.*?)<!-- end {name} -->", text, re.S).group(1)


def figure(text, start):
    """The cells of a row of the list of figures."""
    return next([cell.strip() for cell in row.split("|")[1:-1]] for row in block(text, "headline").split("\n") if row.startswith("| " + start))


def check_text(text):
    expect(text.startswith("By hand.\n") and text.endswith("And this.\n"), "what is written by hand stays")
    rivals = block(text, "rivals")
    expect("| 3.00 |" in rivals and "| 0.80 |" not in rivals, "the newer run's row takes the older one's place")
    expect("(2.00)" in rivals and rivals.startswith("Text above the table."), "rows of the older run alone and the text above stay")
    expect(figure(text, "Raster rivals, grooves")[2].startswith("3 to 3 in the 1 of 2 views"), "views that are reached are counted")
    expect(figure(text, "Raster rivals, grooves")[3] == "met", "3 is at least 1.3")
    expect(figure(text, "Raster rivals: bytes of the map over burin's |")[2].startswith("100 to 900"), "bytes")
    expect(figure(text, "Atrium: areas")[3] == "met", "areas take less time and have less error")
    expect(figure(text, "… time of samples at the error of areas")[2] == "2.5", "half way in dB is half way in the logarithm of time")
    expect(figure(text, "… relief mapping")[2] == "400 against 800 ms, 25.00 against 30.00 dB", "relief mapping beside areas")
    expect(block(text, "geometry").strip() == "Not measured." and figure(text, "Pack: 10^6")[2] == "not measured", "what is missing is called so")
    runs = block(text, "runs")
    expect("c0ffee1" in runs and "c0ffee2" in runs and "some renderer" in runs and "| geometry | not measured" in runs, "runs with commits")


def check_plot(path):
    tree = ElementTree.parse(path).getroot()
    tag = "{http://www.w3.org/2000/svg}"
    width, height = float(tree.get("width")), float(tree.get("height"))
    lines = [[tuple(map(float, point.split(","))) for point in one.get("points").split()] for one in tree.iter(tag + "polyline")]
    inside = all(0 <= x <= width and 0 <= y <= height for one in lines for x, y in one)
    expect(inside and len(lines) == 6, f"{len(lines)} lines: of two techniques near and one far, by time and by bytes")
    joined = [one for one in lines if len(one) == 2]
    expect(len(joined) == 2 and all(a[0] < b[0] and a[1] > b[1] for a, b in joined), "relief: two of three settings joined, dearer and better")
    texts = [one.text for one in tree.iter(tag + "text")]
    expect("near, by time" in texts and "ms of processor time" in texts and "PSNR, dB" in texts and "relief" in texts, "titles, axes, legend")
    expect("999.0" not in "".join(texts) and len(list(tree.iter(tag + "circle"))) >= 4, "a ring in each panel")


def check_measuring(folder, results, page):
    """A program that fails leaves older results alone; one that succeeds is recorded with its command."""
    program = os.path.join(folder, "build", "bench", "pack", "bench_pack")
    os.makedirs(os.path.dirname(program))
    words = ["pack", "--quick", "--build", os.path.join(folder, "build"), "--cache", os.path.join(folder, "cache"), "--results", results, "--out", page]
    for script, status in (("cat <<'X'\n" + PACK + "X", 0), ("echo half; exit 3", 1)):
        with open(program, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + script + "\n")
        os.chmod(program, stat.S_IRWXU)
        done = run(*words)
        expect(done.returncode == status, f"status {done.returncode}, not {status}: {done.stderr.decode()}")
        with open(page, encoding="utf-8") as file:
            text = file.read()
        expect(figure(text, "Pack: 10^6")[2:] == ["0.30 s and 2.50 s", "**missed**"], "2.5 s are more than 2")
        expect(figure(text, "Pack: time per element")[2:] == ["16 bits: 1.00 to 2.50 us, 32 bits: 0.30 to 0.30 us", "**missed**"], "2.5 times as long per element is not linear")
        expect("`bench_pack 100000`" in block(text, "runs"), "the command")
    expect(b"pack" in done.stderr, "the part that failed is named")


def main():
    with tempfile.TemporaryDirectory(prefix="burin_performance_test_") as folder:
        results, page = os.path.join(folder, "results"), os.path.join(folder, "page.md")
        os.makedirs(results)
        record_all(results)
        with open(page, "w", encoding="utf-8") as file:
            file.write("By hand.\n" + "".join(f"<!-- begin {name} -->\nold\n<!-- end {name} -->\n" for name in BLOCKS) + "And this.\n")
        for _ in range(2):  # the second time it is remade from its own blocks
            done = run("--document", "--results", results, "--out", page)
            expect(done.returncode == 0, f"the page is made: {done.stderr.decode()}")
        with open(page, encoding="utf-8") as file:
            check_text(file.read())
        check_plot(os.path.join(folder, "page", "rivals_crossing.svg"))
        check_measuring(folder, results, page)
        expect(run("nonsense").returncode == 2, "a part that is not known is an error")
    print("failed" if failed else "all as expected")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
