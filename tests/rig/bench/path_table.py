"""The table of longest paths in firmware/README.md, made from the baseline of the bench."""
from bench.baseline import PHASES

BEGIN, END = "<!-- made by tests/rig/run --write-baseline -->\n", "<!-- end -->\n"


def table(known):
    """Markdown: a row for each back end or law, a column for each phase, in instructions."""
    lines = ["| back end or law | " + " | ".join(PHASES) + " |", "|---|" + "---|" * len(PHASES)]
    for name, phases in sorted(known.items()):
        lines.append(f"| {name} | " + " | ".join(f"{phases[phase]['longest_ns']:,}".replace(",", " ")
                                                 for phase in PHASES) + " |")
    return "\n".join(lines) + "\n"


def split(readme):
    """What stands before the table, the table, and what stands after it."""
    head, begin, rest = readme.partition(BEGIN)
    old, end, tail = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"no table between {BEGIN.strip()} and {END.strip()}")
    return head + begin, old, end + tail


def write(known, path):
    head, _, tail = split(path.read_text())
    path.write_text(head + table(known) + tail)


def compare(known, path):
    """A complaint when the table is not the one that the baseline gives."""
    _, old, _ = split(path.read_text())
    return [] if old == table(known) else [
        f"{path.name} in {path.parent.name}/ has another table of longest paths than {len(known)} baselines "
        "give: tests/rig/run --write-baseline"]
