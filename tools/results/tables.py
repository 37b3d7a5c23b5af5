# SPDX-License-Identifier: Apache-2.0
"""Tables of READMEs that are written from results: between the comments `numbers: NAME` and `end`.

Each function takes load(name), the values of tools/results/NAME.json, and gives the lines. A goal
that was not met says so.
"""
import pathlib
import sys
import textwrap

TOOLS = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOOLS / "chart"))
import scenes as of_scenes  # noqa: E402


def against_goal(value, goal, text):
    return text if value <= goal else f"{text}: **missed**"


def measured(load):
    """The five numbers of the front page, and every row of the bench that misses its goal."""
    bench, limits, verify = (load(name) for name in ("bench", "limits", "verify"))
    tick = bench["tick"]
    rows = [
        ("tick of the liver on a stock kernel, median",
         against_goal(tick["median_us"], 3, f"{tick['median_us']:.1f} us"), "3 us", "tools/bench"),
        ("the same, p99.9", against_goal(tick["p999_us"], 20, f"{tick['p999_us']:.0f} us"), "20 us", "tools/bench"),
        ("heap calls and page faults in the loop",
         against_goal(tick["heap_calls"] + tick["page_faults"], 0, f"{tick['heap_calls']} and {tick['page_faults']}"),
         "0", "tools/bench"),
        ("cases of misuse and fault in which the force kept every limit",
         against_goal(limits["cases"], limits["passed"], f"{limits['passed']} of {limits['cases']}"), "all",
         "build/tact-limits"),
        ("published cases of laws, kinematics, protocols, tracking",
         against_goal(verify["cases"], verify["passed"], f"{verify['passed']} of {verify['cases']}"), "all",
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
    counts = ", ".join(against_goal(count, goal, f"{count} ({name})") for name, count in lines.items())
    yield f"Lines of code between read and write: {counts}; goal {goal}."


RMS_GOAL_PERCENT, OWN_GOAL_PERCENT = {"compliance": 3.0}, {"compliance": 7.0}  # of others 5 and 10


def goals_of(law):
    return RMS_GOAL_PERCENT.get(law, 5.0), OWN_GOAL_PERCENT.get(law, 10.0)


SCENE_GOAL_PERCENT = {"rms": 3.0, "own": 7.0}  # of the law that a scene ships
# Why a scene misses its goal; said only where it does.
REASONS = {
    "liver": "[rim](tools/chart/README.md)",
    "liver_source": "published: 530 N/m",
    "grasper": "spheres overlap",
    "gum": "a hollow, computed as flat",
}
SAME_PRESSES = {"liver_twist": "liver"}  # in the row of the other, if its values are the same


def off(percent):
    """+3.4 %, -12 %, +870 %"""
    return f"{percent:+.2g} %" if abs(percent) < 100 else f"{percent:+.0f} %"


def printed_of(value):
    """What its row says but for the time."""
    return {key: f"{number:.3g}" if isinstance(number, float) else number for key, number in value.items() if key != "median_us"}


def rows_of_scenes(load):
    """(names, value) of each row."""
    rows = {}
    for scene, value in load("scenes").items():
        other = SAME_PRESSES.get(scene)
        same = other in rows and all(printed_of(rows[other][1])[key] == text for key, text in printed_of(value).items())
        if same:
            rows[other][0].append(scene)
        else:
            rows[scene] = ([scene], value)
    return rows.values()


def scenes(load):
    """Each scene with the law that it ships: the whole tool against its solid."""
    yield from ("| scene | law | RMS error, of the peak | largest error from 1 mm on | tick | missed because |",
                "|---|---|---|---|---|---|")
    for names, value in rows_of_scenes(load):
        rms, own = value["rms_percent"], value["own_percent"]
        missed = rms > SCENE_GOAL_PERCENT["rms"] or abs(own) > SCENE_GOAL_PERCENT["own"]
        at = "the hand's site" if value["place"] == "hand's" else f"vertex {value['place']}"
        yield (f"| {', '.join(f'`{name}`' for name in names)} | `{value['law']}` | "
               f"{against_goal(rms, SCENE_GOAL_PERCENT['rms'], off(rms)[1:])} | "
               f"{against_goal(abs(own), SCENE_GOAL_PERCENT['own'], off(own))} at {at}, {value['depth_mm']:.2g} mm | "
               f"{value['median_us']:.2g} us | {REASONS.get(names[0], 'not known') if missed else ''} |")


PLACES = {"hand's": "where the hand presses", "1586": "a rim", "2743": "a narrow rim, radius 14 mm"}


def finite_strain(load):
    """The shipped liver where it bends: the worst from 1 mm on, whole tool and one jaw."""
    yield from ("| place | whole tool, goal 7 %, of the hand's 3 % | one jaw, of the tool's force, goal 10 % |", "|---|---|---|")
    for place, name in PLACES.items():
        value = load("finite_strain")["place"][place]
        whole, jaw, goal = value["worst_percent"], value["sphere_percent"], 3.0 if place == "hand's" else 7.0
        yield (f"| {name} | {against_goal(abs(whole), goal, f'{whole:+.2g} %')} at {value['worst_mm']:.2g} mm | "
               f"{against_goal(jaw, 10.0, f'{jaw:.2g} %')} |")


def unfitted(load):
    """The shipped liver where no fit and no choice has seen it, and with the tool tilted."""
    yield from ("| place | whole tool, goal 7 % | one jaw, of the tool's force, goal 10 % |", "|---|---|---|")
    for place, value in load("finite_strain")["unfitted"].items():
        name = place if place.startswith("slid") else f"vertex {place}"
        name = f"the hand's site, {place} degrees" if place.startswith("tilted") else name
        whole, jaw = value["worst_percent"], value["sphere_percent"]
        yield (f"| {name} | {against_goal(abs(whole), 7.0, f'{whole:+.2g} %')} at {value['worst_mm']:.2g} mm | "
               f"{against_goal(jaw, 10.0, f'{jaw:.2g} %')} |")


def second_solver(load):
    """The whole tool at finite strain by two programs."""
    places = load("second_solver")["place"]
    depths = list(places["hand's"])
    yield f"| place | {' | '.join(f'{mm} mm' for mm in depths)} | one jaw, of the tool's force |"
    yield "|---|" + "---|" * (len(depths) + 1)
    for place, at in places.items():
        jaw = max(one["sphere_percent"] for one in at.values())
        name = "the hand's site" if place == "hand's" else f"vertex {place}"
        cells = [f"{one['percent']:+.2g} %" for one in at.values()] + [f"{jaw:.2g} %"]
        yield f"| {name} | {' | '.join(cells)} |"


def linear(load):
    """How far the linear force of the whole tool is off that at finite strain."""
    places = load("finite_strain")["linear"]
    depths = list(places["hand's"])
    yield f"| place | {' | '.join(f'{mm} mm' for mm in depths)} |"
    yield "|---|" + "---|" * len(depths)
    for place, at in places.items():
        name = {"hand's": "the hand's site"}.get(place, f"vertex {place}" if place.isdigit() else place)
        yield f"| {name} | {' | '.join(f'{at[mm]:+.1f} %' for mm in depths)} |"


STRAINS = {"shipped": "`rhombus` (shipped): tip and bending", "shipped_small": "`rhombus`, `large_strain = false`: neither",
           "exact": "`compliance`: tip and bending", "exact_small": "`compliance`, `large_strain = false`: neither"}


def strains(load):
    """What large strain does to the force."""
    found = load("finite_strain")["strain"]
    depths = list(found["shipped"]["1586"])
    yield f"| law | place | {' | '.join(f'{mm} mm' for mm in depths)} |"
    yield "|---|---|" + "---|" * len(depths)
    for name, words in STRAINS.items():
        for place in PLACES:
            yield f"| {words} | {PLACES[place]} | {' | '.join(f'{found[name][place][mm]:+.1f} %' for mm in depths)} |"


def scene_laws(load):
    """The largest local error from 1 mm on, of every law of each scene with committed figures; the law that it ships is bold."""
    found = of_scenes.errors_of(TOOLS.parent / "model/scenes", load("finite_strain"))
    shipped = load("scenes")
    laws = sorted({law for of_scene in found.values() for law in of_scene})
    yield f"| scene | {' | '.join(f'`{law}`' for law in laws)} |"
    yield "|---|" + "---|" * len(laws)
    for scene in shipped:
        cells = []
        for law in laws:
            error = found[scene].get(law)
            text = off(error.percent) + (" (finite strain)" if error.reference == of_scenes.FINITE else "") if error else ""
            cells.append(f"**{text}**" if law == shipped[scene]["law"] else text)
        yield f"| `{scene}` | {' | '.join(cells)} |"


def known_errors(load):
    """How far the force of each scene's tool is off at its worst place and depth, in the words of the front page."""
    met, missed = [], []
    for names, value in rows_of_scenes(load):
        own = value["own_percent"]
        text = f"`{names[0]}` {off(own)}".replace(" ", "\N{NO-BREAK SPACE}")
        (met if abs(own) <= SCENE_GOAL_PERCENT["own"] else missed).append(text)
    parts = [f"{', '.join(names)} {verdict}" for names, verdict in ((met, "met"), (missed, "**missed**")) if names]
    text = ("* **Known errors**: largest error of the force at depths from 1 mm on ([laws](#the-laws)), goal "
            f"{SCENE_GOAL_PERCENT['own']:.0f} %: {'; '.join(parts)}.")
    for line in textwrap.wrap(text, 130, break_long_words=False, break_on_hyphens=False, subsequent_indent="  "):
        yield line.replace("\N{NO-BREAK SPACE}", " ")


ONE_SPRING = {"disc_stack": " (linear: cannot, as it is one spring)"}


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
        cells = [f"`{law}`{ONE_SPRING.get(law, '')}", against_goal(value["rms_percent"], rms, f"{value['rms_percent']:.3g} %"),
                 *(against_goal(abs(off), own, f"{off:+.3g} %") for off in value["own_percent_at_mm"].values()),
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
                   f"{against_goal(worst, 7, f'{worst:.2g} %')} |")


TABLES = {f.__name__: f for f in (measured, tick_size, known_errors, scenes, scene_laws, finite_strain, unfitted, linear,
                                  second_solver, strains, tool, silicone)}
