# SPDX-License-Identifier: Apache-2.0
"""Tables of READMEs that are written from results: between the comments `numbers: NAME` and `end`.

Each function takes load(name), the values of tools/results/NAME.json, and gives the lines. A goal
that was not met says so.
"""
import textwrap


def judged(value, goal, text):
    return text if value <= goal else f"{text}: **missed**"


def measured(load):
    """The five numbers of the front page, and every row of the bench that misses its goal."""
    bench, limits, verify = (load(name) for name in ("bench", "limits", "verify"))
    tick = bench["tick"]
    rows = [
        ("tick of the liver on a stock kernel, median",
         judged(tick["median_us"], 3, f"{tick['median_us']:.1f} us"), "3 us", "tools/bench"),
        ("the same, p99.9", judged(tick["p999_us"], 20, f"{tick['p999_us']:.0f} us"), "20 us", "tools/bench"),
        ("heap calls and page faults in the loop",
         judged(tick["heap_calls"] + tick["page_faults"], 0, f"{tick['heap_calls']} and {tick['page_faults']}"),
         "0", "tools/bench"),
        ("cases of misuse and fault in which the force kept every limit",
         judged(limits["cases"], limits["passed"], f"{limits['passed']} of {limits['cases']}"), "all",
         "build/tact-limits"),
        ("published cases of laws, kinematics, protocols, tracking",
         judged(verify["cases"], verify["passed"], f"{verify['passed']} of {verify['cases']}"), "all",
         "build/tact-verify"),
    ]
    yield from ("| what | measured | goal | command |", "|---|---|---|---|")
    for what, value, goal, command in rows:
        yield f"| {what} | {value} | {goal} | `{command}` |"
    # The first two are rows of their own, and say so themselves.
    missed = [f"{row['what'].strip()} {row['value']} {row['unit']}".strip() + f" ({row['goal']})" for row in bench["missed"]
              if row["what"] not in ("tick, median", "tick, p99.9")]
    if missed:
        yield ""
        yield from textwrap.wrap(f"Goals of `tools/bench` that were **missed**: {'; '.join(missed)}.", 130,
                                 break_long_words=False, break_on_hyphens=False)


def tick_size(load):
    """How small the controller is."""
    size, goal = load("size"), 2500
    lines = {name: size[device]["lines"] for name, device in
             (("simulated delta", "sim"), ("ODrives", "odrive"), ("Falcon", "falcon"))}
    told = ", ".join(judged(count, goal, f"{count} ({name})") for name, count in lines.items())
    yield f"Lines between read and write: {told}; goal {goal} (`tools/tick_size`)."


SCENES = {"compliance": "`liver.toml` with `--set 'law=\"compliance\"'`", "hex_sheet": "`skin.toml`, `maintenance.toml`",
          "disc_stack": "`heart.toml`", "rhombus": "`liver.toml`", "spring_patch": "`gum.toml`"}
RMS_GOAL_PERCENT, OWN_GOAL_PERCENT = {"compliance": 3.0}, {"compliance": 7.0}  # of others 5 and 10


def goals_of(law):
    return RMS_GOAL_PERCENT.get(law, 5.0), OWN_GOAL_PERCENT.get(law, 10.0)


def laws(load):
    """Each law in the liver: the whole tool, one sphere, and what a tick costs."""
    yield from ("| law | scenes | tool, RMS of the peak | own force, worst place | one sphere, RMS "
                "| tick: detect, render, limit |",
                "|---|---|---|---|---|---|")
    chart, tools = load("chart"), load("tool")
    for law, scenes in SCENES.items():
        rms, own = goals_of(law)
        value = tools[law]
        worst = max(value["own_percent_at_mm"].values(), key=abs)
        yield (f"| `{law}` | {scenes} | {judged(value['rms_percent'], rms, '%.3g %%' % value['rms_percent'])} | "
               f"{judged(abs(worst), own, f'{worst:+.3g} %')} | {chart[law]['error_percent']:.3g} % | "
               f"{value['median_us']:.2g} us |")


def finite_strain(load):
    """The shipped liver where it bends: the worst of 1 to 10 mm, whole tool and one jaw."""
    names = {"hand_site": "where the hand presses", "vertex_1586": "a rim", "vertex_2743": "a narrow rim, radius 14 mm"}
    yield from ("| place | whole tool, goal 7 % | one jaw, of the tool's force, goal 10 % |", "|---|---|---|")
    for place, value in load("finite_strain")["place"].items():
        whole, jaw = value["worst_percent"], value["sphere_percent"]
        yield (f"| {names[place]} | {judged(abs(whole), 7.0, f'{whole:+.2g} %')} at {value['worst_mm']:.2g} mm | "
               f"{judged(jaw, 10.0, f'{jaw:.2g} %')} |")


def known_errors(load):
    """How far the tool's force is off at its worst place and depth, in the words of the front page."""
    told = "* **Known errors** of the whole tool's force, the largest that was found ([laws](#the-laws))."
    for goal in sorted({goals_of(law)[1] for law in SCENES}):
        met, missed = [], []
        for law in (law for law in SCENES if goals_of(law)[1] == goal):
            worst = max(load("tool")[law]["own_percent_at_mm"].values(), key=abs)
            (met if abs(worst) <= goal else missed).append(f"`{law}` {worst:+.2g} %".replace(" ", "\N{NO-BREAK SPACE}"))
        parts = [f"{', '.join(laws)} {verdict}" for laws, verdict in ((met, "met"), (missed, "**missed**")) if laws]
        told += f" Goal {goal:.0f} %: {', '.join(parts)}."
    for line in textwrap.wrap(told, 130, break_long_words=False, break_on_hyphens=False, subsequent_indent="  "):
        yield line.replace("\N{NO-BREAK SPACE}", " ")


def tool(load):
    """Each law with the whole tool: the error of the peak, and of the own force at the worst place."""
    values = load("tool")
    depths = next(iter(values.values()))["own_percent_at_mm"]
    head = ["law", "RMS, of the peak", *(f"own force, {mm} mm" for mm in depths), "worst place", "detect, render, limit"]
    yield f"| {' | '.join(head)} |"
    yield "|" + "---|" * len(head)
    for law, value in values.items():
        rms, own = goals_of(law)
        place, worst = max(value["place_rms_percent"].items(), key=lambda at: at[1])
        cells = [f"`{law}`", judged(value["rms_percent"], rms, f"{value['rms_percent']:.3g} %"),
                 *(judged(abs(off), own, f"{off:+.3g} %") for off in value["own_percent_at_mm"].values()),
                 f"{place}: {worst:.3g} %", f"{value['median_us']:.2g} us"]
        yield f"| {' | '.join(cells)} |"


def silicone(load):
    """Laws against measured silicone; of its own peak, own factor for each material."""
    yield from ("| law | strain | EF10_100T, fitted | EF10_50T, held out | EF30_50T, held out | worst sample |",
                "|---|---|---|---|---|---|")
    for strain, laws_of in load("measured").items():
        for law in ("hex_sheet", "rhombus", "disc_stack_linear"):
            sites = laws_of[law]
            cells = [f"{sites[site]['rms_percent']:.2g} %" for site in ("EF10_100T", "EF10_50T", "EF30_50T")]
            worst = max(site["worst_percent"] for site in sites.values())
            yield (f"| `{law}` | to {strain.split('_')[1]} % | {' | '.join(cells)} | "
                   f"{judged(worst, 7, f'{worst:.2g} %')} |")


TABLES = {f.__name__: f for f in (measured, tick_size, known_errors, laws, finite_strain, tool, silicone)}
