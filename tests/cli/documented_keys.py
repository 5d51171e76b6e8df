"""The keys of --format json: what cli/JSON.md says against what the program prints."""

import os
import re

DOCUMENT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "cli", "JSON.md")
ROW = re.compile(r"^\| `([^`]+)` \| (text|boolean|integer|number)(, optional)? \|", re.M)


def read_document():
    """{section: {key: (kind, optional)}}."""
    with open(DOCUMENT, encoding="utf-8") as file:
        sections = re.split(r"^## (.+)$", file.read(), flags=re.M)[1:]
    return {name: {key: (kind, bool(optional)) for key, kind, optional in ROW.findall(text)}
            for names, text in zip(sections[::2], sections[1::2]) for name in names.split(" and ")}


def section_of(command, result):
    if command != "info":
        return command
    return "info of an asset" if "materials" in result else "info of a map"


def is_kind(value, kind):
    if isinstance(value, bool):
        return kind == "boolean"
    if kind == "number":
        return value is None or isinstance(value, (int, float))
    return isinstance(value, {"text": str, "integer": int}.get(kind, ()))


def flatten(value, key=""):
    """(key, value) of all that is neither object nor array, keys as the document writes them."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from flatten(inner, f"{key}.{name}" if key else name)
    elif isinstance(value, list):
        for inner in value:
            yield from flatten(inner, key + "[]")
    else:
        yield key, value


def holders(value, key):
    """Every object that should hold the last name of `key`, or None where one on the way is missing."""
    head, dot, rest = key.partition(".")
    if not dot:
        return [value]
    if not isinstance(value, dict) or head.removesuffix("[]") not in value:
        return [None]
    inner = value[head.removesuffix("[]")]
    if not head.endswith("[]"):
        return holders(inner, rest)
    return [holder for entry in inner for holder in holders(entry, rest)]


def differences(command, result):
    """Sentences on where the result and the document differ; empty when they agree."""
    section = section_of(command, result)
    keys = read_document()[section]
    for key, (_, optional) in keys.items():
        name = key.rpartition(".")[2]
        if not optional and not all(holder is not None and name in holder for holder in holders(result, key)):
            yield f"{section}: {key} is documented and missing"
    for key, value in flatten(result):
        if key not in keys:
            yield f"{section}: {key} is printed and not documented"
        elif not is_kind(value, keys[key][0]):
            yield f"{section}: {key} is {value!r} and documented as {keys[key][0]}"
