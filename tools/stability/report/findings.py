# SPDX-License-Identifier: Apache-2.0
"""What the tables of tact-lab stability must show.

A row is {column: value}; None is a number that is not finite, and breaks what reads it. Facts are what the columns do not say.
"""
import math

MIN_STABLE_RATIO = 0.95  # of a limit: HL-1 is exact for low frequencies alone, and the search ends within 1 %
FOUGHT = "fights the limits of the gate"
HELD = (FOUGHT, "20 lost in a row: the gate lets go and latches", "stays below the limits of the gate")
BOUNCES = "bounces on the surface within the limits of the gate"


def finding(holds, message, **numbers):
    return {"holds": bool(holds), "sentence": message,
            "numbers": {name: float(value) if math.isfinite(value) else None for name, value in numbers.items()}}


def ratio(row, column, to):
    return row[column] / row[to] if row[to] != 0 else math.inf


def spread(values):
    """The least and the largest; both are no number if one value is none."""
    values = list(values)
    return (math.nan, math.nan) if any(map(math.isnan, values)) else (min(values, default=math.inf), max(values, default=0.0))


def within(values, least, most, claim):
    low, high = spread(values)
    return finding(least < low and high < most, f"{claim}: measured {low:.3f} to {high:.3f} of it")


def gate(rows):
    held, fought = sum(row["beyond_the_line"] in HELD for row in rows), sum(row["beyond_the_line"] == FOUGHT for row in rows)
    return finding(held == len(rows) and fought > 0, "three times beyond the line the gate keeps |F| and |dF| in bounds in "
                   f"{held} of {len(rows)} cells; {fought} of them fight its limits", held=held, at_the_limits=fought)


def integrators(rows, _):
    off = [row for row in rows if row["theory"] != row["measured"]]
    share = (len(rows) - len(off)) / len(rows)
    rest = "".join(f"\n        {row['method']} z {row['z']:.4g} zeta {row['zeta']:.3g}: radius "
                   f"{row['theory_growth_per_step']:.6f}" for row in off)
    # What shrinks faster is gone before it can be measured.
    _, worst = spread(abs(ratio(row, "measured_growth_per_step", "theory_growth_per_step") - 1) for row in rows
                      if row["theory_growth_per_step"] > 0.5)
    # Right on the line a growth that is too small to be measured counts as none.
    yield finding(share >= 0.995, f"the oscillator grows where its amplification matrix says in {100 * share:.3f} % of "
                  f"{len(rows)} cells{'; the others, right on the line:' if rest else ''}{rest}", agree_percent=100 * share)
    yield finding(worst < 1e-3, f"growth a step agrees within {worst:.1e}, where it is above 1/2")


def law_limits(rows, _):
    kept = sum(row["gate"] == "in bounds" for row in rows)
    beyond = [row["status"] for row in rows if row["depth_ratio"] > 1]  # only there a law has to say that it is
    said = beyond.count("saturated")
    yield finding(all(math.isfinite(row["force_N"]) for row in rows), "no law gives a force that is not a number")
    yield finding(said == len(beyond), f"beyond its range every law says so: {said} of {len(beyond)} cells")
    yield finding(kept == len(rows), f"through the gate |F| and |dF| stay in bounds in {kept} of {len(rows)} cells")


def law_lines(rows, _):
    def study(name):
        return [row for row in rows if row["study"] == name]

    def worst_error(name):
        return spread(abs(row["measured"] - row["theory"]) for row in study(name))[1]

    def doubled(name):
        values = [row["measured"] for row in study(name)]
        return values[-1] / values[len(values) // 2]
    refused = all((row["what_happens"] == "grows to flat") == (row["measured"] >= -1e-9) for row in study("disc_cone"))
    ring, node, sheet = doubled("hex_ring"), doubled("hex_node"), abs(doubled("hex_sheet") - 1)
    yield finding(worst_error("disc_cone") < 1e-3 and refused,
                  "a disc's least slope is k (1 - eta^2/2); beyond sqrt 2 it is refused")
    yield finding(worst_error("disc_rate") == 0, "the layers that move follow T_i < 1/rate: fewer on a faster loop")
    yield finding(worst_error("rhombus_snap") < 0.02, "a unit's least slope is kN - kT (1 - cos theta0); below zero it snaps")
    yield finding(ring > 1.7 and node > 2.9,
                  f"twice the rings make the printed hex force {ring:.2f} (ring) and {node:.2f} (node) times larger")
    yield finding(sheet < 1e-3, f"twice the rings change the energy form by {sheet:.1e}")


def loop(rows, _):
    ratios = [ratio(row, "largest_without_growth_N_per_m", "theory_grow_N_per_m") for row in rows]
    # Here the formula is the limit itself, not only a bound.
    bare = [value for row, value in zip(rows, ratios) if row["hand"] == "bare" and not row["friction_N"] > 0]
    below, (least, _), (bare_least, bare_largest) = sum(value < 1 for value in ratios), spread(ratios), spread(bare)
    # HL-2 is zero without friction: nothing to compare.
    rest, _ = spread(ratio(row, "largest_at_rest_N_per_m", "theory_safe_N_per_m") for row in rows
                     if row["theory_safe_N_per_m"] > 0)
    yield finding(least > MIN_STABLE_RATIO, f"no cell grows below {MIN_STABLE_RATIO} K, K = b / (T/2 + t_d): {below} of "
                  f"{len(rows)} grow below K, the least measured limit is {least:.3f} K", below=below, least_ratio=least)
    yield finding(rest > MIN_STABLE_RATIO, f"every cell below {MIN_STABLE_RATIO} min(K, 2 c / D) comes to rest: the least "
                  f"measured limit is {rest:.3f} of min(K, 2 c / D)")
    yield finding(bare_least > MIN_STABLE_RATIO and bare_largest < 1.25, f"in the {len(bare)} cells without hand and friction "
                  f"the measured limit is {bare_least:.3f} to {bare_largest:.3f} K", bare=len(bare), bare_least_ratio=bare_least,
                  bare_largest_ratio=bare_largest)
    yield gate(rows)


def loop_laws(rows, facts):
    def measured(with_memory):
        return [row["measured_over_theory"] for row in rows if (row["law"] in facts["with_memory"]) == with_memory]
    low, high = spread(measured(True))
    yield within(measured(False), 0.9, 1.2, "every closed-form law at every depth loses stability where its tangent passes "
                 "b / (T/2 + t_d)")
    # Memory only helps, so its spread has no upper end.
    yield finding(low > 0.9, "laws with memory are stable at least as far, with the tangent that one tick can meet: measured "
                  f"{low:.2f} to {high:.2f} of it")
    yield gate(rows)


def loop_delta(rows, _):
    low, high = spread(row["controller_over_theory"] for row in rows)
    alike_low, alike_high = spread(ratio(row, "controller_N_per_m", "one_degree_N_per_m") for row in rows)
    bounced = sum(row["beyond_the_line"] == BOUNCES for row in rows)
    kept = bounced + sum(row["beyond_the_line"] == "comes to rest" for row in rows)
    yield finding(low > 0.85 and high < 1.3, "the whole controller with the simulated Delta loses stability at "
                  f"{low:.2f} to {high:.2f} of b / (T/2 + t_d)", least_ratio=low, largest_ratio=high)
    yield finding(alike_low > 0.8 and alike_high < 1.25,
                  f"and at {alike_low:.2f} to {alike_high:.2f} of what the independent loop of one degree of freedom gives")
    yield finding(kept == len(rows) and bounced > 0, "three times beyond it |F| and |dF| stay in bounds in "
                  f"{kept} of {len(rows)} cells; {bounced} of them bounce on the surface")


def ticks(rows, _):
    # Wide: the theory is about the mean, and a run is one draw.
    yield within([row["measured_over_theory"] for row in rows], 0.7, 1.5,
                 "held forces cost stiffness as (2 b / T) E[n] / E[n^2] says")
    yield gate(rows)


def loss(rows, facts):
    held_mJ, gate_mJ = (1e3 * spread(row[column] for row in rows)[1] for column in ("hold_gift_J", "gate_gift_J"))
    # As a share of the slew limit: what a tick may do depends on the rate.
    _, step = spread(row["gate_max_step_N"] * row["rate_Hz"] / facts["slew_N_per_s"] for row in rows)
    late = [row for row in rows if (row["lost_in_a_row"] - 2) / row["rate_Hz"] >= 0.01]
    latches = all((row["state"] == "latched") == (row["lost_in_a_row"] >= 20) for row in rows)  # counted in samples at every rate
    yield finding(all(row["gate_force_N"] == 0 for row in late),
                  "10 ms after the second lost sample the force is zero, or latched at 20")
    yield finding(latches, "20 lost in a row latch, 19 do not")
    yield finding(gate_mJ < held_mJ, f"a hand that withdraws is given at most {gate_mJ:.3f} mJ by the gate, {held_mJ:.3f} mJ "
                  "by a held force and still growing")
    yield finding(step <= 1 + 1e-9, f"letting go never changes the force faster than {step:.2f} of the slew limit")


CHECKS = {check.__name__: check for check in (integrators, law_limits, law_lines, loop, loop_laws, loop_delta, ticks, loss)}


def findings_of(name, rows, facts):
    """Of the table of a map, as --json has them."""
    return list(CHECKS[name]([{column: math.nan if value is None else value for column, value in row.items()} for row in rows],
                             facts))
