# SPDX-License-Identifier: Apache-2.0
"""chart.svg and chart.png: local error over time of laws, shipped scenes and peers; below, the laws of every scene.

    /usr/bin/python3 picture.py FOLDER     of committed results alone
"""
import collections
import json
import math
import os
import pathlib
import sys
import textwrap

sys.dont_write_bytecode = True
TOOLS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TOOLS / "chart"), str(TOOLS / "reference")]

import run  # noqa: E402
import scenes as of_scenes  # noqa: E402
import tables  # noqa: E402

LAW_INKS = ("#0072B2", "#009E73", "#56B4E9", "#6A3D9A", "#8C564B", "#332288", "#666666")
PEER_INKS = ("#D55E00", "#CC3311", "#882255", "#E69F00")
LAW_MARKS, PEER_MARKS = "osv^DPX", "<>ph"
MOST_PERCENT, LEAST_PERCENT = 500.0, 1.0  # chosen: what is off by more is drawn at the edge, with its number
GOOD, NEAR, FAR = "#CFE8CF", "#FBE8B5", "#F4C7B8"  # of a table cell


def pyplot():
    try:
        import matplotlib
    except ImportError:
        raise run.Failure("python3-matplotlib is missing, so the tables are written and the pictures are not; apt install "
                          "python3-matplotlib") from None
    matplotlib.use("Agg")
    matplotlib.rcParams.update({"font.size": 9, "svg.hashsalt": "tact", "axes.spines.top": False, "axes.spines.right": False})
    from matplotlib import pyplot
    return pyplot


def values_beside(path, name):
    """Of a result file in the folder of another; none where there is none."""
    file = pathlib.Path(path).parent / name
    return json.loads(file.read_text())["values"] if path and file.is_file() else {}


def shown(family):
    return family.replace("_", " ")


def sizes_text(sizes):
    """ "17 to 129 knots"; nothing of a law that has one size."""
    first, last = sizes[0], sizes[-1]
    if first == last:
        return "" if first == "as the scene says" else ", " + first
    return f", {first.split(' ')[0]} to {last}" if first.split(" ")[1:] == last.split(" ")[1:] else f", {len(sizes)} sizes"


def families_of(rows):
    """{name: rows} of those that were measured, a form of discs by itself."""
    out = collections.defaultdict(list)
    for row in rows:
        if row["tick_median_us"] > 0.0 and math.isfinite(tables.local_error(row)):
            out[row["family"] + ("" if row["form"] == "-" else " " + row["form"])].append(row)
    return out


def percent_of(row):
    return min(max(100 * tables.local_error(row), LEAST_PERCENT), MOST_PERCENT)


def draw_points(axes, rows, kind, inks, marks, size):
    found = families_of(row for row in rows if row["kind"] == kind)
    for i, (name, own) in enumerate(found.items()):
        sizes = [row["size"].removeprefix(row["form"] + " ") for row in own]
        axes.plot([row["tick_median_us"] for row in own], [percent_of(row) for row in own], ":", lw=1, ms=size,
                  marker=marks[i % len(marks)], color=inks[i % len(inks)], mec="white", mew=0.5,
                  label=shown(name) + sizes_text(sizes))


def draw_front(axes, rows):
    points = [(row["tick_median_us"], percent_of(row)) for row in tables.front_rows(rows)]
    if points:
        us, percent = zip((points[0][0], MOST_PERCENT), *points, (axes.get_xlim()[1], points[-1][1]))
        axes.step(us, percent, where="post", lw=5, color="#DDDDDD", zorder=0, label="front of tact's laws")


def place_names(figure, axes, points, others):
    """Each name beside its point, at the first of eight places where it covers no mark, no name and no axis."""
    from matplotlib import patheffects
    taken = [(x - 11, y - 9, x + 11, y + 11) for x, y in axes.transData.transform([point[:2] for point in points])]
    taken += [(x - 6, y - 6, x + 6, y + 6) for x, y in axes.transData.transform(others)]
    for x, y, name in points:
        for dx, dy, across in ((9, 0, "left"), (-9, 0, "right"), (0, 13, "center"), (0, -13, "center"), (9, 10, "left"),
                               (9, -10, "left"), (-9, 10, "right"), (-9, -10, "right")):
            text = axes.annotate(name, (x, y), (dx, dy), textcoords="offset points", ha=across, va="center", fontweight="bold",
                                 path_effects=[patheffects.withStroke(linewidth=3, foreground="white")])
            box = text.get_window_extent(figure.canvas.get_renderer())
            if box.x0 > axes.bbox.x0 and not any(box.x0 < x1 and x0 < box.x1 and box.y0 < y1 and y0 < box.y1
                                                 for x0, y0, x1, y1 in taken):
                break
            text.remove()
        else:  # no place is free
            text = axes.annotate(name, (x, y), (9, 9), textcoords="offset points", fontweight="bold")
            box = text.get_window_extent(figure.canvas.get_renderer())
        taken.append((box.x0, box.y0, box.x1, box.y1))


def draw_scenes(figure, axes, shipped, others):
    """Stars: filled where the reference is of finite strain."""
    points = []
    for name, (law, us, error) in shipped.items():
        percent = min(abs(error.percent), MOST_PERCENT / 1.25)
        finite = error.reference == of_scenes.FINITE
        axes.plot(us, percent, "*", ms=15, mec="black", mfc="black" if finite else "none", zorder=5)
        beyond = f", off by {abs(error.percent):.0f} % (above)" if percent < abs(error.percent) else ""
        points.append((us, percent, f"{name}{beyond}"))
    place_names(figure, axes, points, others)
    for ink, name in (("black", "finite strain"), ("none", "linear reference")):
        axes.plot([], [], "*", ms=11, mec="black", mfc=ink, ls="", label=f"shipped scene, {name}")


def speed_panel(figure, axes, rows, shipped):
    axes.set(xscale="log", yscale="log", xlabel="time of a tick, median, us (detect, render and limit of the whole tool; "
             "of a peer its answer to one sphere)", ylabel="largest local error of the force, % of the force there")
    draw_points(axes, rows, "tact", LAW_INKS, LAW_MARKS, 7)
    draw_points(axes, rows, "peer", PEER_INKS, PEER_MARKS, 8)
    us = [row["tick_median_us"] for row in rows if row["tick_median_us"] > 0] + [s.median_us for s in shipped.values()]
    axes.set_xlim(min(us) / 4, max(us) * 2)
    axes.set_ylim(LEAST_PERCENT, MOST_PERCENT)
    draw_front(axes, rows)
    for scale in (axes.xaxis, axes.yaxis):
        scale.set_major_formatter(lambda value, _: f"{value:g}")
    axes.axhline(7, ls="--", lw=1, color="#555555")
    axes.annotate("a hand notices 7 %", (0.6, 7), xycoords=("axes fraction", "data"), xytext=(0, -3), va="top", ha="center",
                  textcoords="offset points", color="#555555")
    if shipped:
        draw_scenes(figure, axes, shipped, [(row["tick_median_us"], percent_of(row)) for of in families_of(rows).values()
                                            for row in of])
    handles, labels = axes.get_legend_handles_labels()
    peer_names = [shown(name) for name in families_of(row for row in rows if row["kind"] == "peer")]
    labels = ["peer: " + label if label.split(",")[0] in peer_names else label for label in labels]
    axes.legend(handles, labels, loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=8.5)


def ink_of(percent):
    return GOOD if abs(percent) <= 7 else NEAR if abs(percent) <= 14 else FAR


def laws_panel(axes, found, shipped):
    """A row for each law, a column for each scene; a frame around the law that a scene ships."""
    names = list(found)
    laws = sorted({law for of_scene in found.values() for law in of_scene})
    axes.set(xlim=(0, len(names)), ylim=(len(laws), 0), xticks=[x + 0.5 for x in range(len(names))], xticklabels=names,
             yticks=[y + 0.5 for y in range(len(laws))], yticklabels=map(shown, laws))
    axes.tick_params(length=0)
    axes.xaxis.tick_top()
    for x, name in enumerate(names):
        for y, law in enumerate(laws):
            error = found[name].get(law)
            text = "-" if error is None else f"{error.percent:+.0f} %" if abs(error.percent) >= 100 else (
                f"{error.percent:+.1f} %")
            finite = error is not None and error.reference == of_scenes.FINITE
            axes.fill([x, x + 1, x + 1, x], [y, y, y + 1, y + 1], fc="white" if error is None else ink_of(error.percent),
                      ec="white", lw=2)
            axes.text(x + 0.5, y + (0.36 if finite else 0.5), text, ha="center", va="center",
                      fontweight="bold" if finite else "normal")
            if finite:
                axes.text(x + 0.5, y + 0.73, "finite strain", ha="center", va="center", fontsize=7)
    for x, name in enumerate(names):
        if name in shipped and shipped[name].law in laws:
            y = laws.index(shipped[name].law)
            axes.fill([x + .02, x + .98, x + .98, x + .02], [y + .05, y + .05, y + .95, y + .95], fc="none", ec="black", lw=2)
    for spine in axes.spines.values():
        spine.set_visible(False)


def caption(rows, job):
    whole = any(row["kind"] == "tact" and math.isfinite(row["tool_own_worst_ratio"]) for row in rows)
    judged = "linear reference of the whole tool" if whole else "linear reference of one sphere, not of the whole tool"
    parts = [f"Laws of {job['scene']['name']}: {judged}, measured on {job['provenance']['machine']}, revision "
             f"{job['provenance']['revision'] or 'unknown'}."]
    if job["scenes"]:
        scenes = json.loads(pathlib.Path(job["scenes"]).read_text())
        parts.append(f"Scenes: each with its own law, revision {scenes['revision']}, on {scenes['machine']}.")
    peers = tables.source_of_peers(rows)
    parts += [f"Peers: one sphere on the same organ, linear reference;{peers.removeprefix('peers:')}."] if peers else []
    return "\n".join(textwrap.fill(part, 170) for part in parts)


def draw(rows, job):
    """Their paths."""
    plot = pyplot()
    finite = values_beside(job["scenes"], "finite_strain.json")
    shipped = of_scenes.shipped_of(values_beside(job["scenes"], os.path.basename(job["scenes"])), finite)
    found = of_scenes.errors_of(pathlib.Path(job["scene"]["path"]).parent, finite) if shipped else {}
    figure = plot.figure(figsize=(12, 10.4 if found else 6.4), dpi=100)
    grid = figure.add_gridspec(2 if found else 1, 1, height_ratios=[2.1, 1] if found else [1], left=0.1, right=0.75,
                               top=0.945, bottom=0.075 if found else 0.17, hspace=0.35)
    speed_panel(figure, figure.add_subplot(grid[0]), rows, shipped)
    figure.suptitle(f"{job['scene']['name']}: speed against local error of its laws" +
                    (", of the shipped scenes" if shipped else ""), x=0.1, ha="left", fontsize=13)
    if found:
        axes = figure.add_subplot(grid[1])
        laws_panel(axes, found, shipped)
        axes.set_title("largest local error from 1 mm on, of each law that a scene describes; framed: the law that it ships; "
                       "linear reference where no other is named", fontsize=9, loc="left", pad=22)
    figure.text(0.1, 0.008, caption(rows, job), fontsize=8, color="#555555", va="bottom")
    paths = [pathlib.Path(job["out"]) / f"chart.{kind}" for kind in ("svg", "png")]
    for path in paths:
        figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else {})
    plot.close(figure)
    return paths


def committed():
    """(rows, job) of the committed results: the liver's laws as the scene has them, peers, scenes."""
    results = TOOLS / "results"
    found, peers = (json.loads((results / f"{name}.json").read_text()) for name in ("tool", "peers"))
    laws = [{"kind": "tact", "family": law, "size": "as the scene says", "form": "-", "tick_median_us": value["median_us"],
             "tool_own_worst_ratio": max(map(abs, value["own_percent_at_mm"].values())) / 100, "own_worst_ratio": math.nan}
            for law, value in found["values"].items()]
    scene = {"name": "liver", "path": str(TOOLS.parent / "model/scenes/liver.toml")}
    return laws + tables.read_rows(peers["rows"], "peers.json"), {
        "scene": scene, "scenes": str(results / "scenes.json"),
        "provenance": {"machine": found["machine"], "revision": found["revision"]}}


if __name__ == "__main__":
    drawn, asked = committed()
    print(*draw(drawn, {**asked, "out": sys.argv[1]}), sep="\n")
