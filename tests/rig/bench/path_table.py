# SPDX-License-Identifier: Apache-2.0
"""The tables of longest paths in firmware/README.md, made from the baseline of the bench."""
import json

from bench import gate_paths
from bench.baseline import PHASES, read, read_gate

BEGIN, END = "<!-- made by tests/rig/run --write-baseline -->\n", "<!-- end -->\n"


def tables(baseline):
    """Of the phases of a tick, and of the stages of the gate."""
    bounds = json.loads((baseline.parent / "tick_bounds.json").read_text())
    known = read(baseline)[0]
    return "\n".join((table(known), bound_table(known, bounds), gate_paths.table(read_gate(baseline))))


def table(known):
    """Markdown: a row for each back end or law, a column for each phase, in instructions."""
    lines = ["| back end or law | " + " | ".join(PHASES) + " |", "|---|" + "---|" * len(PHASES)]
    for name, phases in sorted(known.items()):
        lines.append(f"| {name} | " + " | ".join(f"{phases[phase]['longest_ns']:,}".replace(",", " ")
                                                 for phase in PHASES) + " |")
    return "\n".join(lines) + "\n"


def bound_table(known, bounds):
    """Markdown: the longest of a phase on the bench beside its bound by tests/proof/bound."""
    lines = ["| back end or law | phase | longest on the bench | bound | ratio |", "|---|---|---|---|---|"]
    for name, phases in sorted(bounds.items()):
        for phase, bound in phases.items():
            seen = known[name][phase]["longest_ns"]
            lines.append(f"| {name} | {phase} | {seen:,} | {bound:,} ".replace(",", " ") + f"| {bound / seen:.1f} |")
    return "\n".join(lines) + "\n"


def split(readme, mark=BEGIN):
    """The text before the table, the table, and the text after it."""
    head, begin, rest = readme.partition(mark)
    old, end, tail = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"no table between {mark.strip()} and {END.strip()}")
    return head + begin, old, end + tail


def write(text, path, mark=BEGIN):
    """`text`: what tables() gives, or another table of the bench."""
    head, _, tail = split(path.read_text(), mark)
    path.write_text(head + text + tail)


def compare(text, path):
    """A complaint when the file does not hold `text`."""
    _, old, _ = split(path.read_text())
    return [] if old == text else [
        f"{path.name} in {path.parent.name}/ has other tables than the baseline of the bench gives: "
        "tests/rig/run --write-baseline"]
