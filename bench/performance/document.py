"""docs/performance.md: what stands between `<!-- begin NAME -->` and `<!-- end NAME -->` is made from the results, the rest is written by hand."""

import os
import re

import judge
import plots
from results import merged, merged_lines

VIEWS = ["near", "middle", "far", "far away", "60 degrees", "80 degrees"]
# Block of the document: the part, the title of its table, and how many cells name a row.
TABLES = {
    "rivals": ("rivals", "At burin's own error", 2), "fixed": ("rivals", "At 30 dB", 2),
    "techniques": ("rivals", "Every technique at burin's own error", 2),
    "figure12": ("figure12", "Near and far", 3),
    "geometry": ("geometry", "Time at equal error", 2), "geometry memory": ("geometry", "Memory at equal error", 1),
    "reference": ("reference", "The reference renderer", 2), "shares": ("shares", "Shares of footprints", 1),
    "atrium": ("atrium", "Atrium", 1), "tables": ("tables", "The tables of the papers", 2),
    "memory": ("memory", "Memory", 1), "grid": ("grid", "Cell size", 3), "pack": ("pack", "Pack", 3),
}
# [2008] table 1, figures 10 left and right: seconds and kilobytes of its own method, of ray-traced geometry and of relief mapping.
PAPER_2008 = {"parallel_grooves": ("10 left", 26, 16, 95, 656, 0.043, 256), "crossing_scratches": ("10 right", 27, 19, 114, 53000, 0.029, 4096)}


def provenance(parts, runs):
    out = ["| part | command | commit | date | machine | renderer |", "|---|---|---|---|---|---|"]
    for part in parts:
        for run in runs.get(part, []):
            about = run.about
            note = f" {about['note']}" if about.get("note") else ""
            out.append(f"| {part} | `{about['command']}`{note} | {about['commit']} | {about['date'][:16].replace('T', ' ')} | "
                       f"{about['machine']}, {about['cores']} cores | {run.renderer()} |")
        if part not in runs:
            out.append(f"| {part} | not measured | | | | |")
    return "\n".join(out)


def table_block(runs, part, title, keys):
    table = merged(runs.get(part, []), title, keys)
    if table is None or not table.rows:
        return "Not measured."
    return (table.intro + "\n\n" if table.intro else "") + table.text()


def own_2008(runs, scene):
    """Ratios of time and bytes, geometry's over the reference renderer's."""
    times, memory = merged(runs.get("geometry", []), "Time at equal error", 2), merged(runs.get("geometry", []), "Memory at equal error", 1)
    of_scene = lambda table: [row for row in table.rows if row[0] == scene] if table else []
    ratios = [sorted((row[column] for row in of_scene(times)), key=judge.number) for column in (6, 9) if of_scene(times)]
    time = " / ".join(some[len(some) // 2] for some in ratios) or judge.NOT_MEASURED
    grid = of_scene(memory)
    return time, f"{grid[0][5]} (exact mesh), {grid[0][-1]} (grid)" if grid else judge.NOT_MEASURED


def table_2008(runs):
    out = ["| figure | scene | paper: method | geometry | relief map | paper: geometry over method, time | bytes | here: time, uniform / adaptive, median of views | bytes |",
           "|---|---|--:|--:|--:|--:|--:|--:|--:|"]
    for scene, (figure, seconds, kilobytes, geometry, geometry_kb, relief, relief_kb) in PAPER_2008.items():
        time, size = own_2008(runs, scene)
        out.append(f"| {figure} | {scene} | {seconds} s, {kilobytes} KB | {geometry} s, {geometry_kb} KB | {relief} s, {relief_kb} KB | "
                   f"{geometry / seconds:.1f} | {geometry_kb / kilobytes:.0f} | {time} | {size} |")
    return "\n".join(out)


def scenes_drawn(views):
    """{scene: [(view, lines)]}, views in the order of VIEWS."""
    scenes = {}
    for scene, view in sorted(views, key=lambda key: VIEWS.index(key[1]) if key[1] in VIEWS else len(VIEWS)):
        scenes.setdefault(scene, []).append((view, views[scene, view]))
    return dict(sorted(scenes.items(), key=lambda item: (-len(item[1]), item[0])))


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def draw_plots(runs, folder, link):
    """Writes the plots; returns the blocks that show them."""
    pictures = []
    for scene, views in scenes_drawn(merged_lines(runs.get("rivals", []))).items():
        write(os.path.join(folder, f"rivals_{scene}.svg"), plots.rivals_plot(scene, views))
        pictures.append(f"![{scene}: error against time and bytes]({link}/rivals_{scene}.svg)")
    atrium = merged(runs.get("atrium", []), "Atrium", 1)
    if atrium is not None:
        write(os.path.join(folder, "atrium.svg"), plots.atrium_plot(atrium))
    grid = sorted(name for name in os.listdir(folder) if name.startswith("grid_") and name.endswith(".svg"))
    return {"grid plots": "\n\n".join(f"![{name[5:-4]}: time against cell size]({link}/{name})" for name in grid) or "Not drawn in these runs.",
            "rivals plots": "\n\n".join(pictures) or "Not measured.",
            "atrium plot": f"![Atrium: error against time]({link}/atrium.svg)" if atrium else "Not measured."}


def remake(text, blocks):
    """The document with its blocks made anew; KeyError where it has one that nobody makes."""
    return re.sub(r"(<!-- begin (.*?) -->\n).*?(<!-- end \2 -->)", lambda found: found[1] + blocks[found[2]] + "\n" + found[3], text, flags=re.S)


def update(path, parts, runs):
    folder = os.path.splitext(path)[0]
    os.makedirs(folder, exist_ok=True)
    blocks = {name: table_block(runs, *which) for name, which in TABLES.items()}
    blocks |= {"runs": provenance(parts, runs), "headline": judge.headline(runs), "table 2008": table_2008(runs)}
    blocks |= draw_plots(runs, folder, os.path.basename(folder))
    with open(path, encoding="utf-8") as file:
        text = file.read()
    write(path, remake(text, blocks))
