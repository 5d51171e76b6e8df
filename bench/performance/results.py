"""Results as they lie in a folder: of each run NAME.md, what its program printed; NAME.json, what it was run with; and of some NAME.jsonl, a
JSON object for each point of a plot. NAME is a part, or a part and a scene with a dot between them."""

import dataclasses
import json
import os
import re


@dataclasses.dataclass
class Table:
    title: str
    intro: str
    head: list
    rule: str
    rows: list

    def column(self, name):
        return self.head.index(name)

    def text(self):
        lines = [self.head_text(), self.rule] + ["| " + " | ".join(row) + " |" for row in self.rows]
        return "\n".join(lines)

    def head_text(self):
        return "| " + " | ".join(self.head) + " |"


@dataclasses.dataclass
class Run:
    part: str
    about: dict  # command, commit, date, machine, cores; perhaps note
    output: str
    lines: list

    def renderer(self):
        found = re.search(r"^Renderer: (.*?)\. Threads", self.output, re.M)
        return found.group(1) if found else "none, C++ alone"


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")] if line.strip() != "|" else []


def read_tables(text):
    """Tables in Markdown, each with the heading above it and the text between both. Rows of another width are a program's remarks (a scene
    that is refused), and stay as they are."""
    tables, title, intro, table = [], "", [], None
    for line in text.split("\n"):
        if line.startswith("#"):
            title, intro, table = line.lstrip("# "), [], None
        elif re.fullmatch(r"\|[-:| ]+\|", line) and intro:
            table = Table(title, "\n".join(intro[:-1]).strip(), cells(intro[-1]), line, [])
            tables.append(table)
        elif table is not None and line.startswith("|"):
            table.rows.append(cells(line))
        else:
            if table is not None:
                table, intro = None, []
            intro.append(line)
    return tables


def read_run(folder, name):
    base = os.path.join(folder, name)
    with open(base + ".json", encoding="utf-8") as file:
        about = json.load(file)
    with open(base + ".md", encoding="utf-8") as file:
        output = file.read()
    lines = []
    if os.path.exists(base + ".jsonl"):
        with open(base + ".jsonl", encoding="utf-8") as file:
            lines = [json.loads(line) for line in file if line.strip()]
    return Run(name.split(".")[0], about, output, lines)


def read_runs(folder):
    """The runs of every part, the oldest first."""
    names = sorted(name[:-5] for name in os.listdir(folder) if name.endswith(".json")) if os.path.isdir(folder) else []
    runs = {}
    for run in sorted((read_run(folder, name) for name in names), key=lambda run: run.about["date"]):
        runs.setdefault(run.part, []).append(run)
    return runs


def merged(runs, title, keys):
    """The table of that title over all runs, or None. Rows with the same first `keys` cells are one: the newest."""
    found = [table for run in runs for table in read_tables(run.output) if table.title == title]
    if not found:
        return None
    rows = {}
    for table in found:
        for row in table.rows:
            rows[tuple(row[:keys])] = row
    last = found[-1]
    return Table(last.title, last.intro, last.head, last.rule, list(rows.values()))


def merged_lines(runs):
    """{(scene, view): lines}, of each the newest run's."""
    views = {}
    for run in runs:
        own = {}
        for line in run.lines:
            own.setdefault((line["scene"], line["view"]), []).append(line)
        views.update(own)
    return views
