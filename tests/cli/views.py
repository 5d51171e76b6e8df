#!/usr/bin/env python3
"""What people look at: the report is whole in itself and shows what was measured, the error map is the error."""

import base64
import html.parser
import json
import os
import re
import shutil
import struct
import zlib

import harness
import inputs


class Page(html.parser.HTMLParser):
    """What a page holds; tags that are opened are closed."""

    VOID = ("meta", "img", "br", "rect", "path")

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.images, self.paths, self.headings = [], set(), [], {}, []
        self.outside, self.title = [], ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        for name, value in attributes:
            if name in ("src", "href", "srcset") and not value.startswith("data:"):
                self.outside.append(value)
            if name == "src":
                self.images.append(base64.b64decode(value.removeprefix("data:image/png;base64,"), validate=True))
            if tag == "path" and name == "class":
                self.paths[value] = self.paths.get(value, 0) + 1
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in self.VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise ValueError(f"</{tag}> closes nothing")

    def handle_data(self, data):
        if self.open and self.open[-1] == "h3":
            self.headings.append(data)
        if self.open and self.open[-1] == "title":
            self.title += data


def size_of(png):
    return struct.unpack(">II", png[16:24])


def decode_rgb(png):
    """Rows of (r, g, b) of an 8-bit RGB or grey PNG without interlacing, as burin writes them."""
    width, height, bits, colors = struct.unpack(">IIBB", png[16:26])
    assert bits == 8 and colors in (0, 2)
    channels = 3 if colors == 2 else 1
    data, at = b"", 8
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IDAT":
            data += png[at + 8:at + 8 + length]
        at += length + 12
    raw, rows, before = zlib.decompress(data), [], bytearray(width * channels)
    for y in range(height):
        start = y * (width * channels + 1)
        row = unfilter(raw[start], bytearray(raw[start + 1:start + 1 + width * channels]), before, channels)
        rows.append([tuple(row[x * channels:x * channels + channels]) * (3 // channels) for x in range(width)])
        before = row
    return rows


def unfilter(kind, row, before, channels):
    for i in range(len(row)):
        left = row[i - channels] if i >= channels else 0
        up, corner = before[i], before[i - channels] if i >= channels else 0
        nearest = min((left, up, corner), key=lambda v: (abs(left + up - corner - v), (left, up, corner).index(v)))
        row[i] = (row[i] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
    return row


def check_page(verdicts, text, figures, side):
    page = Page(text)
    verdicts.expect(page.open == [], f"every tag is closed, {page.open}")
    verdicts.expect(not page.outside and "script" not in page.tags and "url(" not in text, f"nothing is loaded: {page.outside}")
    whole = [image for image in page.images if size_of(image) == (side, side)]
    verdicts.expect(len(whole) == 4, f"four pictures of the whole map, {len(whole)}")
    verdicts.expect(set(page.paths) == {"steps", "grooves"}, f"paths by kind, {page.paths}")
    spots = [re.fullmatch(r"texel (\d+), (\d+): ([\d.]+) % of range too (high|low)", h).groups() for h in page.headings]
    errors = [float(spot[2]) for spot in spots]
    verdicts.expect(1 <= len(spots) <= 8 and errors == sorted(errors, reverse=True), f"close-ups, the worst first: {errors}")
    verdicts.expect(abs(errors[0] - 100 * figures["max"]) < 0.0051, f"the first is the largest error, {errors[0]}")
    verdicts.expect(len(page.images) == 4 + 4 * len(spots), "four pictures in each close-up")
    places = [(int(x), int(y)) for x, y, _, _ in spots]
    apart = all(max(abs(a[0] - b[0]), abs(a[1] - b[1])) >= 20 for i, a in enumerate(places) for b in places[:i])
    verdicts.expect(apart, f"close-ups do not overlap: {places}")
    return page


def main():
    arguments = harness.read_arguments()
    verdicts = harness.Verdicts()
    with harness.Scratch() as folder:
        places = inputs.write_inputs(folder)
        name = {kind: os.path.join(folder, "made." + kind) for kind in ("glb", "html", "png", "exr", "svg")}
        words = ["convert", places["plate.png"], "-o", name["glb"], "--report", name["html"], "--error-map", name["png"]]
        made = harness.run(arguments.burin, words + ["--format", "json"])
        verdicts.expect(made.status == 0, "converts", made)
        figures = json.loads(made.stdout)
        with open(name["html"], encoding="utf-8") as file:
            text = file.read()
        with open(name["png"], "rb") as file:
            error_map = file.read()
        page = check_page(verdicts, text, figures, 96)
        verdicts.expect(error_map in page.images, "the page shows the error map itself")
        command = " ".join(["burin"] + words + ["--format", "json"])
        verdicts.expect(f"<code>{command}</code>" in text, "the page names its command line")
        version = harness.run(arguments.burin, ["--version"]).stdout.strip()
        verdicts.expect(version in text, "and the version")

        rows = decode_rgb(error_map)
        red = sum(r > b for row in rows for r, _, b in row)
        blue = sum(b > r for row in rows for r, _, b in row)
        verdicts.expect(red and blue, f"{red} texels too high, {blue} too low")
        numbers = harness.run(arguments.burin, ["vectorize", places["plate.png"], "-o", name["svg"], "--error-map", name["exr"]])
        verdicts.expect(numbers.status == 0, "the error as numbers", numbers)
        described = json.loads(harness.run(arguments.burin, ["info", name["exr"], "--format", "json"]).stdout)
        low, high = described["values"]["source_low"], described["values"]["source_high"]
        verdicts.expect(low < 0 < high and abs(max(-low, high) - figures["max"]) < 1e-6,
                        f"from {low} to {high}, the largest error is {figures['max']}")
        odd = os.path.join(folder, 'a<b>&"c.png')
        shutil.copyfile(places["constant.png"], odd)
        constant = harness.run(arguments.burin, ["vectorize", odd, "-o", name["svg"], "--report", name["html"]])
        with open(name["html"], encoding="utf-8") as file:
            empty = Page(file.read())
        verdicts.expect(constant.status == 0 and empty.open == [], "an odd name", constant)
        verdicts.expect(empty.title == 'a<b>&"c.png', f"the title is the file's name, {empty.title}")
        verdicts.expect(len(empty.images) == 4 and empty.headings == [], "a constant map has no worst place")

        threads = harness.run(arguments.burin, words + ["--threads", "1"])
        with open(name["html"], encoding="utf-8") as file:
            again = file.read()
        shown = f"<code>{' '.join(['burin'] + words + ['--threads', '1'])}</code>"
        verdicts.expect(threads.status == 0 and again.replace(shown, f"<code>{command}</code>") == text,
                        "the same page with one thread")
    verdicts.finish()


if __name__ == "__main__":
    main()
