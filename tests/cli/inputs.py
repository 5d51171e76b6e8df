"""The small inputs of the command line tests, made here: no file of anyone else is needed."""

import base64
import json
import math
import os
import struct
import zlib


def png(width, height, rows, bits=16):
    """A grey PNG; rows hold integers of `bits` bits."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    code = "B" if bits == 8 else "H"
    raw = b"".join(b"\0" + struct.pack(">%d%s" % (width, code), *row) for row in rows)
    header = struct.pack(">IIBBBBB", width, height, bits, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")


def sampled(width, height, surface, samples=4):
    """16-bit rows of the box-filtered surface(x, y) in [0, 1], x and y in texels."""
    rows = []
    for j in range(height):
        row = []
        for i in range(width):
            total = 0.0
            for b in range(samples):
                for a in range(samples):
                    total += surface(i + (a + 0.5) / samples, j + (b + 0.5) / samples)
            row.append(min(65535, max(0, round(65535 * total / samples**2))))
        rows.append(row)
    return rows


def groove(x, y):
    """Two V grooves that cross, one of them slanting, on a map of 96 x 96 texels."""
    first = max(0.0, 1.0 - abs(y - 48.0) / 6.0)
    second = max(0.0, 1.0 - abs((x - 40.0) * 0.8 - (y - 48.0) * 0.6) / 6.0)
    return 1.0 - 0.8 * max(first, second)


def plate(x, y):
    """A raised plate with a groove across it, on a map of 96 x 96 texels: steps and lines."""
    ground = 0.8 if abs(x - 48.0) < 30.0 and abs(y - 50.0) < 24.0 else 0.3
    return ground - 0.25 * max(0.0, 1.0 - abs(y - 0.2 * x - 40.0) / 4.0)


def noise_rows(side, seed=12345):
    """Rows of white noise from a linear congruential generator."""
    rows = []
    state = seed
    for _ in range(side):
        row = []
        for _ in range(side):
            state = (state * 6364136223846793005 + 1442695040888963407) % 2**64
            row.append(state >> 48)
        rows.append(row)
    return rows


def plane_gltf(materials):
    """Two triangles for each material, with normals and uv, embedded."""
    positions = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1)
    normals = struct.pack("<12f", *([0, 1, 0] * 4))
    uvs = struct.pack("<8f", 0, 0, 1, 0, 1, 1, 0, 1)
    indices = struct.pack("<6H", 0, 2, 1, 0, 3, 2)
    data = positions + normals + uvs + indices
    views, offset = [], 0
    for part in (positions, normals, uvs, indices):
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part)})
        offset += len(part)
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3}
    return json.dumps({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [dict(primitive, material=i) for i in range(len(materials))]}],
        "materials": [{"name": name} for name in materials],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 1]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    })


def broken_texture_gltf():
    """A model whose base colour is half a PNG."""
    document = json.loads(plane_gltf(["brass"]))
    half = png(8, 8, [[128] * 8] * 8, bits=8)[:50]
    document["images"] = [{"uri": "data:image/png;base64," + base64.b64encode(half).decode()}]
    document["textures"] = [{"source": 0}]
    document["materials"][0]["pbrMetallicRoughness"] = {"baseColorTexture": {"index": 0}}
    return json.dumps(document)


def radiance_hdr():
    """A sky of 4 x 2 texels, bright above."""
    return (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + bytes([128, 160, 255, 128]) * 4
            + bytes([90, 80, 70, 126]) * 4)


LETTERS = ("#### #   # ### ", "#    ##  # #  #", "###  # # # #  #", "#    #  ## #  #", "#### #   # ###")


def flat_maps(side=128):
    """Maps of two levels whose steps run through the centres of cells, or meet in corners: {name: bytes of a PNG}."""

    def letters(x, y):
        column, row = (x - 16) // 6, (y - 48) // 6
        inked = 0 <= row < len(LETTERS) and 0 <= column < len(LETTERS[row]) and LETTERS[row][column] == "#"
        return 0 if inked else 255

    surfaces = {
        "stripes": lambda x, y: 255 * (x // 8 % 2),
        "slanting": lambda x, y: 255 * ((x + y) // 16 % 2),
        "checkers": lambda x, y: 255 * ((x // 16 + y // 16) % 2),
        "letters": letters,
        "plates": lambda x, y: 255 if abs(x - 63.5) < 30 and abs(y - 63.5) < 45 else 90,
    }
    return {name: png(side, side, [[surface(x, y) for x in range(side)] for y in range(side)], bits=8)
            for name, surface in surfaces.items()}


STROKES = {"units": "mm", "size": 20, "depth": 2, "paths": [
    {"profile": {"shape": "vee", "width": 1, "height": -1}, "d": "M2 10 H18 M10 2 Q12 8 10 18"}],
    "regions": [{"outline": "M2 2 H6 V6 H2 Z", "level": -0.5}]}
RECIPE = {"model": "two_materials.gltf", "patterns": [{"from": "strokes.json", "material": "slate"}, {"from": "groove.png", "material": "brass"}]}

OBJ = """v 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 3/3 2/2\nf 1/1 4/4 3/3\n"""


DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="80mm" viewBox="0 0 100 80">
<rect class="special" x="10" y="10" width="30" height="20"/>
<path id="way" d="M10 60 C 30 40 70 40 90 60" fill="none" stroke="#000" stroke-width="2"/>
<path d="M50 20 H90" fill="none" stroke="#f00" stroke-width="3"/><path id="special" d="M50 30 H90" fill="none" stroke="#000"/>
<text x="5" y="5">words</text>
</svg>
"""
FONT = """<svg xmlns="http://www.w3.org/2000/svg"><defs><font horiz-adv-x="600"><font-face units-per-em="1000"/>
<glyph unicode="A" d="M100 0 L300 700 L500 0 M200 250 H400"/></font></defs></svg>
"""
# A line over the plate of OBJ, a little above it, in edges as Blender writes them; one that is far away; and no line at all.
LINES = "o groove\nv 0.3 0.01 0.4\nv 1.0 0.01 0.9\nv 1.7 0.01 1.5\nl 2 3\nl 1 2\n"


def write_inputs(folder):
    """Writes every input into the folder and returns {name: path}, the placeholders of the cases."""
    side = 96
    grooves = png(side, side, sampled(side, side, groove))
    files = {
        "groove.png": grooves,
        "groove_named.xyz": grooves,
        "groove_depth.png": png(side, side, sampled(side, side, lambda x, y: 1.0 - groove(x, y))),
        "wide.png": png(64, 32, sampled(64, 32, lambda x, y: 0.2 if math.hypot(x - 32, y - 16) < 9 else 0.9)),
        "plate.png": png(side, side, sampled(side, side, plate)),
        "constant.png": png(16, 16, [[128] * 16] * 16, bits=8),
        "one_texel.png": png(1, 1, [[200]], bits=8),
        "noise.png": png(128, 128, noise_rows(128)),
        "truncated.png": grooves[: len(grooves) // 2],
        "empty.png": b"",
        "words.txt": b"burin reads height maps and this is none\n",
        "words.png": b"burin reads height maps and this is none\n",
        "two_materials.gltf": plane_gltf(["brass", "slate"]).encode(),
        "one_material.gltf": plane_gltf(["brass"]).encode(),
        "lines.obj": LINES.encode(),
        "far_lines.obj": LINES.replace("v 1.0 0.01", "v 1.0 5.0").encode(),
        "broken_texture.gltf": broken_texture_gltf().encode(),
        "sky.hdr": radiance_hdr(),
        "drawing.svg": DRAWING.encode(),
        "cut.svg": DRAWING[:150].encode(),
        "empty.svg": b'<svg xmlns="http://www.w3.org/2000/svg" width="10mm" height="10mm"/>',
        "font.svg": FONT.encode(),
        "plane.obj": OBJ.encode(),
        "strokes.json": json.dumps(STROKES).encode(),
        "space_recipe.json": json.dumps({"model": "plane.obj", "patterns": [{"paths_3d": "lines.obj", "stroke": "groove vee 10mm 40mm"}]}).encode(),
        "recipe.json": json.dumps(RECIPE).encode(),
        "broken.gltf": b'{"asset": {"version": "2.0"}, "scenes": [',
        "no_pattern.gltf": plane_gltf(["brass"]).encode(),
        "bad_magic.glb": b"glTX" + struct.pack("<II", 2, 12),
        "short.glb": b"glTF" + struct.pack("<II", 2, 4000),
    }
    paths = {}
    for name, data in files.items():
        path = os.path.join(folder, name)
        with open(path, "wb") as file:
            file.write(data)
        paths[name] = path
    return paths
