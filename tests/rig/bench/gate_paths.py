# SPDX-License-Identifier: Apache-2.0
"""How many instructions the gate takes while each of its stages acts, from tact-rig-gate, held against
tests/data/bench_baseline.json. The same inputs give the same instructions, so one run is enough."""
import functools

from bench.baseline import ALLOWED_GROWTH

STAGES = ("none", "finite", "fresh", "armed", "workspace", "passivity", "magnitude", "slew", "power", "ramp")
WAYS = ("alone", "longest")


def measure(runs):
    """{stage: {way: instructions}}; empty when no run measured the gate."""
    return next((run.gate for run in runs if run.gate), {})


def every_stage_acts(run):
    """A stage that did not act has no path: it proves nothing. By chance some stage always acts."""
    asked = {(stage, way) for stage in STAGES for way in WAYS} - {("none", "longest")}
    return [f"{stage} never acted ({way}): its path is not known" for stage, way in sorted(asked)
            if not run.gate.get(stage, {}).get(way)]


def compare(measured, known):
    """Complaints, one sentence for each path that grew."""
    return [f"gate, {stage}, {way}: took {known.get(stage, {}).get(way)} instructions, now {value}: make it "
            "shorter, or change the baseline with a reason in the commit (tests/rig/run --write-baseline)"
            for stage, ways in measured.items() for way, value in ways.items()
            if value is not None and value > (known.get(stage, {}).get(way) or 0) * ALLOWED_GROWTH]


def table(known):
    """Markdown: a row for each stage, and one for the gate when none acts."""
    grouped = functools.partial("{:,}".format)
    lines = ["| stage of the gate that acts | by its own inputs | among others, the longest |", "|---|---|---|"]
    for stage in STAGES if known else ():
        ways = (known[stage][way] for way in WAYS)
        lines.append(f"| {stage} | " + " | ".join("-" if value is None else grouped(value).replace(",", " ")
                                                  for value in ways) + " |")
    return "\n".join(lines) + "\n"
