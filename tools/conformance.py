#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Ties the tests to the manuals: docs/statements/*.txt on one side, `proves:` marks in tests/ on the other.

    tools/conformance.py            writes docs/conformance.md and docs/errata.md
    tools/conformance.py --check    fails when a page is stale, a mark names an unknown statement, the lists do not
                                    agree with the lists of sections, figures and tables, or a DP-V0 statement marked
                                    `test` has no test
    tools/conformance.py --open     prints the open statements
    --allow-open                    with --check: open statements are printed, not an error

A mark is a comment in a test source or in a text table under tests/:

    // proves: VPC3C 5.3.2-03, APC3 4.3-07, E018  (C++; `# proves:` in text tables and Python)

It stands directly above a TEST, TEST_F, TEST_P, TYPED_TEST or a table row, or inside a test body. `-03..07` names a run
of ids; a mark that ends in a comma goes on in the next comment line.
"""
from __future__ import annotations

import argparse
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

MANUALS = {"vpc3c": ("VPC3C", "VPC3+C user manual, revision 3.04"), "apc3": ("APC3", "APC3 user manual, version 2.2")}
# The chapters about DP-V0: here a statement marked `test` must have one.
DP_V0 = {"VPC3C": ("4", "5", "6"), "APC3": ("3", "4", "5", "A")}
SOURCES = (".cpp", ".hpp", ".h", ".c", ".txt", ".inc", ".py")

ID = re.compile(r"(VPC3C|APC3) ([0-9A]+(?:\.[0-9]+)*)-([0-9]{2})(?:\.\.([0-9]{2}))?")
ERRATUM = re.compile(r"E[0-9]{3}")
MARK = re.compile(r"^\s*(//|#|///)\s*proves:\s*(.*)$")
TEST = re.compile(r"^\s*(?:TEST|TEST_F|TEST_P|TYPED_TEST)\(\s*(\w+)\s*,\s*(\w+)\s*\)")
HOW = re.compile(r"^(test|untestable: \S.*|later: \S.*)$")


@dataclass
class Statement:
    manual: str
    section: str
    number: int
    text: str
    how: str
    place: str = ""
    tests: list[str] = field(default_factory=list)

    @property
    def id(self) -> str:
        return f"{self.manual} {self.section}-{self.number:02d}"

    @property
    def in_scope(self) -> bool:
        return self.section.split(".")[0] in DP_V0[self.manual]

    @property
    def status(self) -> str:
        if self.how == "test":
            return "covered" if self.tests else "open"
        return "covered" if self.tests else self.how.split(":")[0]


@dataclass
class Erratum:
    """A contradiction: what a Statement is, with a place and a decision instead of a section."""
    id: str
    where: str
    text: str
    decision: str
    how: str
    tests: list[str] = field(default_factory=list)


@dataclass
class Index:
    names: dict[tuple[str, str], str] = field(default_factory=dict)  # (kind, number) -> name
    headings: set[str] = field(default_factory=set)
    counts: dict[str, int] = field(default_factory=dict)


class Problems(list):
    def add(self, text: str) -> None:
        self.append(text)


def read_statements(path: Path, manual: str, problems: Problems) -> list[Statement]:
    statements: list[Statement] = []
    seen: set[str] = set()
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        parts = [p.strip() for p in line.split(" | ")]
        match = ID.fullmatch(parts[0])
        if len(parts) not in (3, 4) or not match or match[4] or match[1] != manual or not parts[1] or not HOW.match(parts[2]):
            problems.add(f"{path.name}:{number}: not `id | statement | how | place`: {line}")
            continue
        if parts[0] in seen:
            problems.add(f"{path.name}:{number}: {parts[0]} stands twice")
            continue
        seen.add(parts[0])
        statements.append(Statement(manual, match[2], int(match[3]), parts[1], parts[2], parts[3] if len(parts) == 4 else ""))
    return statements


def read_errata(path: Path, problems: Problems) -> list[Erratum]:
    errata: list[Erratum] = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        parts = [p.strip() for p in line.split(" | ")]
        if len(parts) != 5 or parts[0] != f"E{len(errata) + 1:03d}" or not all(parts) or not HOW.match(parts[4]):
            problems.add(f"{path.name}:{number}: not the next `id | where | contradiction | decision | how`: {line}")
            continue
        errata.append(Erratum(*parts))
    return errata


def read_index(path: Path, problems: Problems) -> Index:
    index = Index()
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if count := re.fullmatch(r"# count: (\w+) (\d+)", line):
            index.counts[count[1]] = int(count[2])
        elif line.strip() and not line.startswith("#"):
            parts = [p.strip() for p in line.split(" | ")]
            kind, _, place = parts[0].partition(" ")
            if kind not in ("section", "figure", "table") or not place or len(parts) < 2:
                problems.add(f"{path.name}:{number}: not `kind number | name`: {line}")
                continue
            if (kind, place) in index.names:
                problems.add(f"{path.name}:{number}: {parts[0]} stands twice")
            index.names[(kind, place)] = parts[1]
            if parts[2:] == ["heading"]:
                index.headings.add(place)
    return index


def check_index(name: str, index: Index, statements: list[Statement], problems: Problems) -> None:
    for kind in ("section", "figure", "table"):
        have = sum(1 for k, _ in index.names if k == kind)
        if have != index.counts.get(kind, 0):
            problems.add(f"{name}: {have} {kind}s listed, {index.counts.get(kind, 0)} counted in the manual")
    sections = {s.section for s in statements}
    places = {s.place for s in statements if s.place}
    for kind, number in index.names:
        if kind == "section" and number not in sections and number not in index.headings:
            problems.add(f"{name}: section {number} has no statement")
        if kind != "section" and f"{kind} {number}" not in places:
            problems.add(f"{name}: {kind} {number} has no statement")
    for section in sorted(sections):
        if ("section", section) not in index.names:
            problems.add(f"{name}: statements of section {section}, which the manual does not have")
    for place in sorted(places):
        if tuple(place.split(" ", 1)) not in index.names:
            problems.add(f"{name}: statements of {place}, which the manual does not have")


def ids_of(text: str, where: str, problems: Problems) -> list[str]:
    ids: list[str] = []
    for part in text.split(","):
        part = part.strip()
        if not part:
            continue
        match = ID.fullmatch(part)
        if ERRATUM.fullmatch(part):
            ids.append(part)
            continue
        if not match:
            problems.add(f"{where}: not a statement id: `{part}`")
            continue
        first, last = int(match[3]), int(match[4] or match[3])
        if last < first:
            problems.add(f"{where}: empty run: `{part}`")
        ids += [f"{match[1]} {match[2]}-{n:02d}" for n in range(first, last + 1)]
    return ids


def row_name(line: str, path: Path) -> str:
    """The name of a table row: its first string, else its first word."""
    if text := re.search(r'"([^"\\]+)"', line):
        return f"{path.stem}: {text[1]}"
    words = re.findall(r"[\w+.-]+", line)
    return f"{path.stem}: {words[0] if words else 'row'}"


def scan_file(path: Path, problems: Problems) -> list[tuple[str, list[str]]]:
    """All (test name, statement ids) of one file."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    found: list[tuple[str, list[str]]] = []
    enclosing = ""
    i = 0
    while i < len(lines):
        if test := TEST.match(lines[i]):
            enclosing = f"{test[1]}.{test[2]}"
        elif lines[i].startswith("}"):
            enclosing = ""
        mark = MARK.match(lines[i])
        if not mark:
            i += 1
            continue
        where, text = f"{path.name}:{i + 1}", mark[2].strip()
        i += 1
        while text.endswith(",") and i < len(lines) and (more := re.match(r"^\s*(?://|#)\s*(.*)$", lines[i])):
            text += " " + more[1].strip()
            i += 1
        ids = ids_of(text, where, problems)
        below = i
        while below < len(lines) and re.match(r"^\s*(//|#|$)", lines[below]):
            below += 1
        name = ""
        if below < len(lines) and (test := TEST.match(lines[below])):
            name = f"{test[1]}.{test[2]}"
        elif enclosing:
            name = enclosing
        elif below < len(lines):
            name = row_name(lines[below], path)
        else:
            problems.add(f"{where}: a mark with no test below it")
        if not ids:
            problems.add(f"{where}: a mark without ids")
        if name:
            found.append((name, ids))
    return found


def attach(tests: Path, statements: dict[str, Statement | Erratum], problems: Problems) -> None:
    for path in sorted(tests.rglob("*")):
        if path.suffix not in SOURCES or not path.is_file() or path.name == "conformance_test.py":
            continue
        for name, ids in scan_file(path, problems):
            for one in ids:
                statement = statements.get(one)
                if statement is None:
                    problems.add(f"{path.name}: {name} claims {one}, which is in no list")
                elif statement.how.startswith("untestable"):
                    problems.add(f"{path.name}: {name} claims {one}, which is marked untestable")
                elif name not in statement.tests:
                    statement.tests.append(name)
    for statement in statements.values():
        statement.tests.sort()


def counts_of(statements: list[Statement]) -> dict[str, int]:
    counts = {"covered": 0, "open": 0, "later": 0, "untestable": 0}
    for s in statements:
        counts[s.status] += 1
    return counts


def cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace(">", "&gt;")


def shown(statement: Statement | Erratum) -> str:
    if statement.tests:
        return ", ".join(f"`{t}`" for t in statement.tests)
    return "**none yet**" if statement.how == "test" else cell(statement.how.split(": ", 1)[1])


def natural(number: str) -> list[tuple[int, int]]:
    return [(0, int(p)) if p.isdigit() else (1, 0) for p in re.split(r"[.-]", number)]


def render(lists: dict[str, tuple[list[Statement], Index]]) -> str:
    out = ["# Conformance: what the manuals say, and the tests that show it", "",
           "Generated by `tools/conformance.py` from `docs/statements/` and the `proves:` marks in `tests/`; do not edit.", "",
           "covered: a test shows it. open: no test yet. later: belongs to a later part of the model.",
           "untestable: software cannot show it; the reason stands in the table.", "",
           "| Manual | statements | covered | open | later | untestable | DP-V0 chapters | open there |",
           "|---|---:|---:|---:|---:|---:|---|---:|"]
    for key, (statements, _) in lists.items():
        prefix, title = MANUALS[key]
        counts = counts_of(statements)
        scope = counts_of([s for s in statements if s.in_scope])
        out.append(f"| {title} | {len(statements)} | {counts['covered']} | {counts['open']} | {counts['later']} | "
                   f"{counts['untestable']} | {', '.join(DP_V0[prefix])} | {scope['open']} |")
    for key, (statements, index) in lists.items():
        out += ["", f"## {MANUALS[key][1]}"]
        kinds = [f"{sum(1 for k, _ in index.names if k == kind)} {kind}s" for kind in ("section", "figure", "table")
                 if index.counts.get(kind)]
        out += ["", f"{', '.join(kinds)}, {len(statements)} statements."]
        for number in sorted((n for k, n in index.names if k == "section"), key=natural):
            out += ["", f"### {number} {index.names[('section', number)]}"]
            rows = [s for s in statements if s.section == number]
            if not rows:
                out += ["", "Heading only."]
                continue
            out += ["", "| Id | Statement | Place | Status | Shown by |", "|---|---|---|---|---|"]
            out += [f"| {s.id} | {cell(s.text)} | {s.place} | {s.status} | {shown(s)} |" for s in rows]
    return "\n".join(out) + "\n"


def render_errata(errata: list[Erratum]) -> str:
    out = ["# Errata: contradictions in the sources, and what the model does", "",
           "Generated by `tools/conformance.py` from `docs/statements/errata.txt` and the `proves:` marks in `tests/`; do not edit.",
           "", "M: VPC3+C user manual, revision 3.04. A: APC3 user manual, version 2.2 (en and zh: its editions).",
           "R: the project's engineering reference.", "",
           "| Id | Where | Contradiction | Decision | Shown by |", "|---|---|---|---|---|"]
    out += [f"| {e.id} | {cell(e.where)} | {cell(e.text)} | {cell(e.decision)} | {shown(e)} |" for e in errata]
    return "\n".join(out) + "\n"


Lists = dict[str, tuple[list[Statement], Index]]


def load(root: Path, problems: Problems) -> tuple[Lists, list[Erratum]]:
    lists: Lists = {}
    errata = read_errata(root / "docs" / "statements" / "errata.txt", problems)
    for key, (prefix, _) in MANUALS.items():
        folder = root / "docs" / "statements"
        statements = read_statements(folder / f"{key}.txt", prefix, problems)
        index = read_index(folder / f"{key}_index.txt", problems)
        check_index(key, index, statements, problems)
        lists[key] = (statements, index)
    known: dict[str, Statement | Erratum] = {s.id: s for statements, _ in lists.values() for s in statements}
    attach(root / "tests", known | {e.id: e for e in errata}, problems)
    return lists, errata


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parent.parent)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--allow-open", action="store_true")
    parser.add_argument("--open", action="store_true")
    arguments = parser.parse_args(argv)

    problems = Problems()
    lists, errata = load(arguments.root, problems)
    pages = {"conformance.md": render(lists), "errata.md": render_errata(errata)}
    everything = [s for statements, _ in lists.values() for s in statements]
    missing = [s for s in everything if s.in_scope and s.status == "open"]
    untested = [e for e in errata if e.how == "test" and not e.tests]
    if arguments.open:
        for s in everything:
            if s.status == "open":
                print(f"{s.id} | {s.text}")
        for e in untested:
            print(f"{e.id} | {e.text}")
    if arguments.check:
        for name, page in pages.items():
            path = arguments.root / "docs" / name
            if not path.exists() or path.read_text(encoding="utf-8") != page:
                problems.add(f"docs/{name} is stale: run tools/conformance.py")
        if not arguments.allow_open:
            for s in [*missing, *untested]:
                problems.add(f"{s.id} has no test: {s.text}")
    elif not arguments.open:
        for name, page in pages.items():
            (arguments.root / "docs" / name).write_text(page, encoding="utf-8")
    for problem in problems:
        print(problem, file=sys.stderr)
    counts = counts_of(everything)
    if not arguments.open:
        print(f"{len(everything)} statements: {counts['covered']} covered, {counts['open']} open ({len(missing)} of DP-V0), "
              f"{counts['later']} later, {counts['untestable']} untestable; {len(errata)} errata, {len(untested)} open")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
