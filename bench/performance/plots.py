"""Plots as SVG, by hand: panels of points and lines on logarithmic axes."""

import dataclasses
import html
import math

WIDE, HIGH = 250, 170            # of a panel's inside
LEFT, GAP, TOP, BETWEEN = 56, 26, 72, 54
STYLES = {                       # colour, width of the line, whether points are squares
    "burin": ("#d55e00", 2.4, True),
    "normal mapping": ("#8a8a8a", 1.5, False),
    "parallax occlusion": ("#0072b2", 1.5, False),
    "relief": ("#56b4e9", 1.5, False),
    "relaxed cones": ("#009e73", 1.5, False),
    "triangles": ("#aa4499", 1.5, False),
    "rays in every pixel": ("#0072b2", 1.5, False),
    "areas": ("#d55e00", 2.4, True),
}


@dataclasses.dataclass
class Panel:
    title: str
    series: dict                 # name: [(x, y)]
    level: float = None          # a dashed line at this height
    ring: tuple = None           # a point to mark


@dataclasses.dataclass
class Axis:
    label: str
    low: float
    high: float
    unit: object = str           # text of a tick


def milliseconds(value):
    return f"{value:g}"


def size_text(value):
    for step, name in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= step:
            return f"{value / step:g} {name}"
    return f"{value:g}"


def logarithmic_axis(label, values, unit):
    """From a little below the least value to a little above the most."""
    low, high = math.log10(min(values)), math.log10(max(values))
    room = max(0.06 * (high - low), 0.08)
    return Axis(label, low - room, high + room, unit)


def linear_axis(label, values):
    low, high = 5 * math.floor(min(values) / 5), 5 * math.ceil(max(values) / 5 + 0.2)
    return Axis(label, low, high)


def decimal_ticks(axis):
    """Powers of ten; over less than two of them also twice and five times these."""
    factors = (1, 2, 5) if axis.high - axis.low < 2 else (1,)
    values = [factor * 10.0 ** power for power in range(math.floor(axis.low), math.ceil(axis.high)) for factor in factors]
    return [value for value in values if axis.low <= math.log10(value) <= axis.high]


def front(points):
    """What no cheaper point is as good as: from the cheapest on, every one that is better than all before."""
    best, kept = -math.inf, []
    for x, y in sorted(points, key=lambda point: (point[0], -point[1])):
        if y > best:
            best = y
            kept.append((x, y))
    return kept


def tag(name, text=None, **words):
    inside = "".join(f" {key.replace('_', '-')}='{value:.1f}'" if isinstance(value, float) else f" {key.replace('_', '-')}='{value}'"
                     for key, value in words.items())
    return f"<{name}{inside}/>" if text is None else f"<{name}{inside}>{html.escape(text)}</{name}>"


class Frame:
    """A panel's place in the picture."""

    def __init__(self, left, top, x, y):
        self.left, self.top, self.x, self.y = float(left), float(top), x, y

    def at(self, point):
        across = (math.log10(point[0]) - self.x.low) / (self.x.high - self.x.low)
        up = (point[1] - self.y.low) / (self.y.high - self.y.low)
        return self.left + WIDE * across, self.top + HIGH * (1 - up)

    def draw_axes(self, with_labels):
        right, bottom = self.left + WIDE, self.top + HIGH
        yield tag("rect", x=self.left, y=self.top, width=WIDE, height=HIGH, fill="#fff", stroke="#bbb")
        for value in decimal_ticks(self.x):
            across = self.at((value, 0))[0]
            yield tag("path", d=f"M{across:.1f} {self.top:.1f}V{bottom:.1f}", stroke="#e4e4e4")
            yield tag("text", self.x.unit(value), x=across, y=bottom + 14, text_anchor="middle")
        step = 10 if self.y.high - self.y.low > 25 else 5
        for value in range(step * math.ceil(self.y.low / step), int(self.y.high) + 1, step):
            height = self.at((1, value))[1]
            yield tag("path", d=f"M{self.left:.1f} {height:.1f}H{right:.1f}", stroke="#e4e4e4")
            if with_labels:
                yield tag("text", f"{value}", x=self.left - 6, y=height + 4, text_anchor="end")
        yield tag("text", self.x.label, x=self.left + WIDE / 2, y=bottom + 29, text_anchor="middle")
        if with_labels:
            yield tag("text", self.y.label, transform=f"translate({self.left - 34:.1f} {self.top + HIGH / 2:.1f}) rotate(-90)", text_anchor="middle")

    def draw(self, panel, with_labels):
        yield from self.draw_axes(with_labels)
        yield tag("text", panel.title, x=self.left + 6, y=self.top - 6, font_weight="bold")
        if panel.level is not None:
            height = self.at((1, panel.level))[1]
            yield tag("path", d=f"M{self.left:.1f} {height:.1f}h{WIDE}", stroke=STYLES["burin"][0], stroke_dasharray="4 3", opacity="0.7")
        for name, points in panel.series.items():
            yield from self.draw_series(name, points)
        if panel.ring is not None:
            x, y = self.at(panel.ring)
            yield tag("circle", cx=x, cy=y, r="6.5", fill="none", stroke=STYLES["burin"][0], stroke_width="1.4")

    def draw_series(self, name, points):
        """All points, pale; those that are worth their price, joined."""
        colour, width, _ = STYLES[name]
        best = front(points)
        others = [self.at(point) for point in points if point not in best]
        if others:
            yield tag("path", d="".join(f"M{x:.1f} {y:.1f}h0" for x, y in others), stroke=colour, stroke_width="2.8", stroke_linecap="round", opacity="0.3")
        places = [self.at(point) for point in best]
        yield tag("polyline", points=" ".join(f"{x:.1f},{y:.1f}" for x, y in places), fill="none", stroke=colour, stroke_width=width, opacity="0.9")
        for x, y in places:
            yield mark(name, x, y)


def mark(name, x, y):
    colour, _, square = STYLES[name]
    if square:
        return tag("rect", x=x - 3, y=y - 3, width="6", height="6", fill=colour)
    return tag("circle", cx=x, cy=y, r="2.6", fill=colour)


def legend(names, remark, left):
    x = float(left)
    for name in names:
        yield mark(name, x, 38.0)
        yield tag("text", name, x=x + 8, y=42)
        x += 28 + 6.1 * len(name)
    if remark:
        yield tag("text", remark, x=float(left - 4), y=60, fill="#666")


def picture(title, rows, y, remark=""):
    """Rows of (panel, x axis), one below the other; the axis of heights is common and labelled on the left."""
    panels = [panel for row in rows for panel, _ in row]
    names = [name for name in STYLES if any(name in panel.series for panel in panels)]
    top = TOP + (18 if remark else 0)
    width = max(LEFT + max(map(len, rows)) * (WIDE + GAP), LEFT + GAP + sum(28 + 6 * len(name) for name in names), LEFT + GAP + int(6.2 * len(remark)))
    height = top + len(rows) * (HIGH + BETWEEN) - 12
    out = [f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {width} {height}' "
           "font-family='DejaVu Sans, sans-serif' font-size='11' fill='#222'>",
           tag("rect", width="100%", height="100%", fill="#fff"),
           tag("text", title, x=LEFT, y=20, font_size="14", font_weight="bold")]
    out += legend(names, remark, LEFT + 4)
    for index, row in enumerate(rows):
        for column, (panel, x) in enumerate(row):
            frame = Frame(LEFT + column * (WIDE + GAP), top + index * (HIGH + BETWEEN), x, y)
            out += frame.draw(panel, column == 0)
    return "\n".join(out) + "\n</svg>\n"


def rivals_plot(scene, views):
    """Error against time and against bytes, `views`: [(view, lines)]."""
    every = [line for _, lines in views for line in lines]
    time = logarithmic_axis("ms of processor time", [line["ms"] for line in every], milliseconds)
    size = logarithmic_axis("bytes of maps or of burin's textures", [line["bytes"] for line in every], size_text)
    rows = []
    for first in range(0, len(views), 3):
        some = views[first:first + 3]
        rows.append([(rivals_panel(f"{view}, by time", lines, "ms"), time) for view, lines in some])
        rows.append([(rivals_panel(f"{view}, by bytes", lines, "bytes"), size) for view, lines in some])
    if len(views) == 1:
        rows = [rows[0] + rows[1]]
    return picture(f"{scene}: error against time and bytes", rows, linear_axis("PSNR, dB", [line["dB"] for line in every]),
                   "Joined: settings that nothing cheaper equals; pale: others. Ring and dashes: burin's default.")


def rivals_panel(title, lines, across):
    series = {}
    for line in lines:
        series.setdefault(line["technique"], []).append((line[across], line["dB"]))
    default = next((line for line in lines if line["technique"] == "burin" and line["setting"] == "default"), None)
    if default is None:
        return Panel(title, series)
    return Panel(title, series, default["dB"], (default[across], default["dB"]))


ATRIUM_SERIES = {"areas": "areas", "relief": "relief", "relaxed": "relaxed cones"}  # by the first word of a row


def atrium_plot(table):
    series = {}
    for row in table.rows:
        name = ATRIUM_SERIES.get(row[0].replace(",", " ").split()[0], "rays in every pixel")
        series.setdefault(name, []).append((float(row[table.column("ms")]), float(row[table.column("PSNR")])))
    points = [point for some in series.values() for point in some]
    x = logarithmic_axis("ms of processor time", [point[0] for point in points], milliseconds)
    panel = Panel("400 x 300 pixels" if "400 x 300" in table.intro else "200 x 150 pixels", series)
    return picture("Atrium: error against time", [[(panel, x)]], linear_axis("PSNR, dB", [point[1] for point in points]))
