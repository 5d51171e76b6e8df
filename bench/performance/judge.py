"""The figures that were asked for, beside those reached: rows of what, asked, reached, and whether it is met."""

import math
import statistics

from results import merged, merged_lines

LEAST_DECIBELS = 34.0   # where burin itself stays below, its ratio says nothing
NOT_MEASURED = "not measured"
# Asked of each kind of scene: of the least ratio of times, and of the median.
KINDS = {"grooves": (1.3, 3.0), "ridges and CSG": (1.0, 2.0)}


def number(text):
    """Of '12.3', '(12.3)', '> 12.3'."""
    return float(text.strip("()> "))


def verdict(met, runs):
    """`met`: True, False, or a word of its own. Of some scenes or views alone nothing is met for good."""
    if isinstance(met, str):
        return met
    whole = any(" --scene " not in run.about["command"] and " --view " not in run.about["command"] for run in runs)
    return ("met" if whole else "met so far") if met else "**missed**"


def row(what, asked, reached, met=""):
    return [what, asked, reached, met]


def missing(*rows):
    return [[what, asked, NOT_MEASURED, ""] for what, asked in rows]


def plain(value):
    if math.isinf(value):
        return "unreached"
    return f"{value:.0f}" if value >= 100 else f"{value:.2g}"


def kinds_of(runs):
    return {scene: line.get("kind") for (scene, _), lines in merged_lines(runs).items() for line in lines[:1]}


def finest_map(runs):
    """Texels per side of the largest map that was asked."""
    return max((line.get("size", 0) for run in runs for line in run.lines), default=0)


def raster_times(kind, rows, table, finest):
    least_asked, median_asked = KINDS[kind]
    times = [row[table.column("time")] for row in rows]
    reached = [number(time) for time in times if not time.startswith("(")]
    below = [number(time) for time in times if time.startswith("(")]
    middle = statistics.median_high(reached + [math.inf] * len(below))
    text = f"{plain(min(reached))} to {plain(max(reached))} in the {len(reached)} of {len(rows)} views where a rival comes to burin's error" \
        if reached else f"no rival comes to burin's error in any of {len(rows)} views"
    out = [row(f"Raster rivals, {kind}: time of the fastest at burin's error over burin's, every view", f"≥ {least_asked:g}", text,
               all(ratio >= least_asked for ratio in reached)),
           row("… the median, unreached counted as slower than any", f"≥ {median_asked:g}", f"{plain(middle)} (maps to {finest}²)",
               "unreached" if math.isinf(middle) else middle >= median_asked)]
    if below:
        out.append(row("… unreached: a decibel below the rivals' best, burin at its fastest", "", f"{plain(min(below))} to {plain(max(below))}, "
                       f"median {plain(statistics.median_high(below))}, {len(below)} views; above 1 in {sum(ratio > 1 for ratio in below)}"))
    return out


def raster_bytes(rows, table):
    for name, asked in (("bytes", 50), ("blocks", 15)):
        ratios = [number(row[table.column(name)]) for row in rows]
        what = "Raster rivals: bytes of the map over burin's" + (", block-compressed" if name == "blocks" else "")
        yield row(what, f"≥ {asked} in every view", f"{plain(min(ratios))} to {plain(max(ratios))}, median {plain(statistics.median_high(ratios))}; "
                  f"{sum(ratio < asked for ratio in ratios)} of {len(ratios)} views below", min(ratios) >= asked)


def raster(runs):
    table = merged(runs.get("rivals", []), "At burin's own error", 2)
    if table is None:
        return missing(("Raster rivals: time at burin's error over burin's, every view; the median", "≥ 1.3; ≥ 3 (ridges and CSG 1; 2)"),
                       ("Raster rivals: bytes of the map over burin's; block-compressed", "≥ 50; ≥ 15"))
    kinds = kinds_of(runs["rivals"])
    strong = [row for row in table.rows if len(row) == len(table.head) and float(row[table.column("burin dB")]) >= LEAST_DECIBELS]
    out = []
    for kind in KINDS:
        rows = [row for row in strong if kinds.get(row[0], "grooves") == kind]
        out += raster_times(kind, rows, table, finest_map(runs["rivals"])) if rows else missing((f"Raster rivals, {kind}", "as above"))
    return out + list(raster_bytes(strong, table)) + fixed(runs)


def fixed(runs):
    table = merged(runs["rivals"], "At 30 dB", 2)
    ratios = [number(row[-1]) for row in table.rows if len(row) == len(table.head) and row[-1]] if table else []
    if not ratios:
        return missing(("Raster rivals at 30 dB: time over burin's", "told; rivals may win"))
    return [row("Raster rivals at 30 dB: time of the fastest over burin's", "told; rivals may win",
                f"{plain(min(ratios))} to {plain(max(ratios))}, median {plain(statistics.median_high(ratios))}, {len(ratios)} views")]


def geometry(runs):
    times = merged(runs.get("geometry", []), "Time at equal error", 2)
    asked = ("≥ 8 in the median", "≥ 4 in the median (paper: 3.7 to 4.2)", "≥ 1", "≥ 100 (paper: 41 to 2800)")
    names = ("Reference renderer against Embree on the exact mesh: time, uniform samples", "… adaptive samples",
             "… at 80 degrees, the lower of both", "Reference renderer against a displaced grid: bytes")
    out = missing(*zip(names[:3], asked[:3]))
    if times is not None and times.rows:
        out = [median_row(names[i], asked[i], [row[column] for row in times.rows], least) for i, (column, least) in enumerate(((6, 8), (9, 4)))]
        steep = [min(number(row[6]), number(row[9])) for row in times.rows if row[1] == "80 degrees"]
        out += [row(names[2], asked[2], f"{plain(min(steep))} to {plain(max(steep))}, {len(steep)} scenes", min(steep) >= 1)] if steep \
            else missing((names[2], asked[2]))
    memory = merged(runs.get("geometry", []), "Memory at equal error", 1)
    if memory is None or not memory.rows:
        return out + missing((names[3], asked[3]))
    ratios = [number(row[-1]) for row in memory.rows]
    return out + [row(names[3], asked[3], f"{plain(min(ratios))} to {plain(max(ratios))}, {len(ratios)} scenes", min(ratios) >= 100)]


def median_row(what, asked, texts, least):
    """Of ratios some of which are bounds from below."""
    ratios = [number(text) for text in texts]
    bounds = sum(text.startswith(">") for text in texts)
    middle = statistics.median_high(ratios)
    text = f"median {plain(middle)}, {plain(min(ratios))} to {plain(max(ratios))}, {len(ratios)} views"
    return row(what, asked, text + (f", of which {bounds} are bounds from below" if bounds else ""), middle >= least)


def reference(runs):
    table = merged(runs.get("reference", []), "The reference renderer", 2)
    names = ("Shader and reference renderer: PSNR between them", "… time of the reference over the shader's, both on this CPU")
    asked = ("≥ 35 dB", "told (paper, GPU against CPU: over 1500)")
    if table is None or not table.rows:
        return missing(*zip(names, asked))
    between = [float(row[4]) for row in table.rows]
    ratios = [float(row[5]) / float(row[6]) for row in table.rows]
    return [row(names[0], asked[0], f"{min(between):.1f} to {max(between):.1f}, median {statistics.median(between):.1f}, {len(between)} views", min(between) >= 35),
            row(names[1], asked[1], f"{plain(min(ratios))} to {plain(max(ratios))}, median {plain(statistics.median(ratios))}")]


def shares(runs):
    table = merged(runs.get("shares", []), "Shares of footprints", 1)
    name, asked = "Reference renderer: shares of 10^4 footprints of each case against rays", "mean error ≤ 0.5 %"
    if table is None:
        return missing((name, asked))
    most = max(float(row[table.column(column)]) for row in table.rows for column in ("seen, mean", "lit, mean"))
    return [row(name, asked, f"{most:.3f} % at most, {len(table.rows)} cases", most <= 0.5)]


def at_equal_error(table, wanted):
    """Milliseconds of rays in every pixel at a PSNR, by the logarithm of time between the samples that were drawn; None beyond them."""
    rays = [(float(row[table.column("PSNR")]), float(row[table.column("ms")])) for row in table.rows if "sample" in row[0]]
    for (low, fast), (high, slow) in zip(rays, rays[1:]):
        if low <= wanted <= high:
            return fast * (slow / fast) ** ((wanted - low) / (high - low))
    return None


def atrium(runs):
    table = merged(runs.get("atrium", []), "Atrium", 1)
    name, asked = "Atrium: areas against 4 samples", "less time and less error (paper: 33.6 against 17.2 fps)"
    if table is None:
        return missing((name, asked))
    rows = {row[0]: row for row in table.rows}
    four = rows["4 samples"]
    areas = next(row for row in table.rows if row[0].startswith("areas, 4 rays"))
    time, error = table.column("ms"), table.column("PSNR")
    out = [row(name, asked, f"{areas[time]} against {four[time]} ms, {areas[error]} against {four[error]} dB",
               float(areas[time]) < float(four[time]) and float(areas[error]) > float(four[error]))]
    equal = at_equal_error(table, float(areas[error]))
    if equal is not None:
        out.append(row("… time of samples at the error of areas, interpolated, over that of areas", "", plain(equal / float(areas[time]))))
    relief = rows.get("relief mapping with 4x full-screen antialiasing")
    if relief is not None:
        out.append(row("… relief mapping with 4x full-screen antialiasing against areas", "told (paper: 33.1 against 33.6 fps)",
                       f"{relief[time]} against {areas[time]} ms, {relief[error]} against {areas[error]} dB"))
    return out


def pack(runs):
    table = merged(runs.get("pack", []), "Pack", 3)
    names = ("Pack: 10^6 elements", "Pack: time per element from 10^4 elements on")
    asked = ("under 2 s on 2 cores", "linear: the most at most twice the least, by bits of a reference")
    if table is None:
        return missing(*zip(names, asked))
    large = [float(row[table.column("pack s, least")]) for row in table.rows if int(row[1]) >= 900000]
    each = {}  # by the bits of a reference
    for cells in table.rows:
        if int(cells[1]) >= 9000:
            each.setdefault(cells[table.column("bits of a reference")], []).append(float(cells[table.column("us per element")]))
    out = [row(names[0], asked[0], " and ".join(f"{seconds:.2f} s" for seconds in large), max(large) < 2)] if large else missing((names[0], asked[0]))
    spans = ", ".join(f"{bits} bits: {min(times):.2f} to {max(times):.2f} us" for bits, times in sorted(each.items()))
    return out + ([row(names[1], asked[1], spans, all(max(times) <= 2 * min(times) for times in each.values()))] if each else [])


def papers(runs):
    table = merged(runs.get("tables", []), "The tables of the papers", 2)
    if table is None:
        return missing(("Bytes of the papers' scenes", "told"))
    less = [row for row in table.rows if float(row[table.column("kB")]) <= float(row[table.column("paper kB")])]
    return [row("Bytes of scenes of the papers' classes, beside the papers' own", "told", f"fewer in {len(less)} of {len(table.rows)}")]


JUDGES = (("rivals", raster), ("geometry", geometry), ("reference", reference), ("shares", shares), ("atrium", atrium), ("pack", pack),
          ("tables", papers))


def headline(runs):
    out = ["| figure | asked | reached | |", "|---|---|---|---|"]
    for part, judge in JUDGES:
        out += [f"| {what} | {asked} | {reached} | {verdict(met, runs.get(part, []))} |" for what, asked, reached, met in judge(runs)]
    return "\n".join(out)
