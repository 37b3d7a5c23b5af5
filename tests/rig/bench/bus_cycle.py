"""How long a cycle of the bus takes: from its sign (estimates due, SYNC, report sent) to the torque
that follows from it, and the part of the emulated device in it. Guest time, 1 kHz."""


def rows(runs):
    """(back end, median, p99, longest, own median, own longest), us, of every timed run."""
    found = {}
    for run in runs:
        cycle, own = run.emulator.get("bus_cycle_ns"), run.emulator.get("own_share_ns")
        if run.case.timed and cycle and own:
            found[run.case.back_end.name] = [cycle["median"], cycle["p99"], cycle["max"],
                                             own["median"], own["max"]]
    return [(name, *(value / 1000 for value in values)) for name, values in found.items()]


def measure(runs):
    """{back end: {median_us, p99_us, own_us}} for the baseline; of several seeds the last."""
    return {name: {"median_us": round(median), "p99_us": round(p99), "own_us": round(own)}
            for name, median, p99, _, own, _ in rows(runs)}


def table(runs):
    lines = ["| back end | cycle, median | 99 % | longest | of it the emulator's, median | longest |",
             "|---|---|---|---|---|---|"]
    for name, *values in rows(runs):
        lines.append(f"| {name} | " + " | ".join(f"{value:.0f} us" for value in values) + " |")
    return "\n".join(lines) + "\n" if len(lines) > 2 else ""
