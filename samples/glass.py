#!/usr/bin/env python3
"""Makes all materials of a binary glTF file clear glass.

    samples/glass.py IN.glb OUT.glb [THICKNESS]     metres; above 0 the mesh bounds a body, 0 (the default) makes thin walls
"""

import json
import struct
import sys

HEADER, CHUNK = 12, 8


def main():
    source, target = sys.argv[1:3]
    thickness = float(sys.argv[3]) if len(sys.argv) > 3 else 0.0
    with open(source, "rb") as file:
        data = file.read()
    length = struct.unpack("<I", data[HEADER:HEADER + 4])[0]
    document = json.loads(data[HEADER + CHUNK:HEADER + CHUNK + length])
    rest = data[HEADER + CHUNK + length:]
    glass = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5}}
    if thickness > 0:
        glass["KHR_materials_volume"] = {"thicknessFactor": thickness}
    for material in document["materials"]:
        material.setdefault("extensions", {}).update(glass)
        material.setdefault("pbrMetallicRoughness", {}).update({"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0})
    document["extensionsUsed"] = sorted({*document.get("extensionsUsed", []), *glass})
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(target, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, HEADER + CHUNK + len(text) + len(rest)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + rest)


if __name__ == "__main__":
    main()
