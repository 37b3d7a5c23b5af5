# SPDX-License-Identifier: Apache-2.0
"""What tools/numbers --measure NAME runs: one function a file of results, from a build in build/.

Each gives the command, as a person would type it, and the values that READMEs quote.
"""
import json
import math
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LIVER = "model/scenes/liver.toml"
LIVER_REFERENCE = "tests/data/reference/liver.json"
LIVER_TOOL = "tests/data/reference/liver_tool.json"
# Its places at finite strain: one where the linear force is another does not count.
FINITE_STRAIN = ["--finite-strain", "tests/data/reference/liver_finite_strain_tool.json"]


def output_of(*command, status=(0,)):
    """What a command prints, run from the root of the tree."""
    done = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if done.returncode not in status:
        raise SystemExit(f"{command[0]}: exit status {done.returncode}\n{done.stderr[-2000:]}")
    return done.stdout


def json_in_file(*command, option, name="", status=(0,)):
    """What a command writes into a file (or the file `name` of a folder) that `option` names."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / name if name else pathlib.Path(folder) / "out.json"
        output_of(*command, option, folder if name else path, status=status)
        return json.loads(path.read_text())


def missed_of(rows):
    """The rows of tools/bench that miss their goal; an indented one with the name of what it belongs to."""
    missed, parent = [], ""
    for row in rows:
        what = row["what"].strip()
        if row["what"].startswith(" "):
            what = f"{parent}: {what}"
        else:
            parent = what.split(",")[0]
        if row["missed"]:
            missed.append({"what": what} | {name: row[name] for name in ("value", "unit", "goal", "command")})
    return missed


# Contact alone, hot, least of many passes: tests/house/budgets_test.py holds these against the last release.
HOT_ROWS = {"two spheres": "contact of two spheres, least of passes, median", "one sphere": "contact of one sphere, median",
            "further sphere": "contact of ten, median of a further sphere"}


def bench():
    """A goal that this machine misses is a result too (status 1)."""
    rows = json_in_file("tools/bench", option="--json", status=(0, 1))
    values = {row["what"].strip(): row["value"] for row in rows}
    return "tools/bench", {
        "tick": {"median_us": values["tick, median"], "p999_us": values["tick, p99.9"],
                 "heap_calls": values["heap calls in the loop"],
                 "page_faults": values["page faults in the loop"],
                 "table_kB": values["law table"], "resident_MB": values["resident memory, peak"],
                 "million_ratio_median": values["tick at a million vertices over 3 116, median"],
                 "million_ratio_p999": values["tick at a million vertices over 3 116, p99.9"]},
        "pose_us": values["pose of eight markers, median"],
        "pose_off_mm": values["off at 2 m with 0.5 px, shown, median"],
        "two_cameras_us": values["of two cameras, median"],
        "two_cameras_p95_mm": values["raw, p95"],
        "arm_us": values["pose of the arm, median"],
        "page_frames_per_s": float(values["page, headless Chromium, software"]),
        "hot_us": {what: values[row] for what, row in HOT_ROWS.items()},
        "missed": missed_of(rows),
    }


def limits():
    command = ["build/tact-limits", LIVER, "--no-pictures", "--json"]
    limits = json.loads(output_of(*command, "--out", tempfile.mkdtemp(), status=(0, 1)))
    wall = limits["wall"]
    return " ".join(command), {
        "passed": sum(case["passed"] for case in [*limits["cases"], wall]),
        "cases": limits["cases_of_plan"],
        "wall": {"without_kN_per_m": wall["bounded_without_N_per_m"] / 1e3,
                 "with_kN_per_m": wall["bounded_with_N_per_m"] / 1e3, "ratio": wall["bounded_ratio"],
                 "rest_kN_per_m": wall["rest_with_N_per_m"] / 1e3, "rest_ratio": wall["rest_ratio"],
                 "swing_without_mm": wall["largest_swing_without_m"] * 1e3,
                 "swing_with_mm": wall["largest_swing_with_m"] * 1e3}}


def verify():
    command = ["build/tact-verify", "tests/data/vectors", "--json"]
    verified = json.loads(output_of(*command, status=(0, 1)))
    return " ".join(command), {"passed": verified["passed"], "cases": verified["passed"] + verified["failed"]}


def size():
    return "tools/tick_size", json_in_file("tools/tick_size", option="--json")


# As liver.toml has them.
LAW_SIZES = {"compliance": "17 curves", "hex_sheet": "15 rings", "disc_stack": "linear 20 layers",
             "disc_series": "9 discs", "membrane": "65 knots", "rhombus": "65 knots", "spring_patch": "500 nodes"}


def chart():
    """RMS error of one sphere over all places of the reference."""
    command = ["build/tact-lab", "chart", LIVER, "--reference", LIVER_REFERENCE]
    values = {}
    for row in json_in_file(*command, option="--out", name="chart.json")["rows"]:
        if row["size"] == LAW_SIZES.get(row["family"]):
            values[row["family"]] = {
                "error_percent": 100 * row["force_rms_ratio"],
                "held_out_percent": 100 * row["held_out_rms_ratio"],
                "median_us": row["tick_median_us"]}
    return " ".join(command) + " --out DIR", values


def tool():
    """The whole tool, as the scene says."""
    command = ["build/tact-lab", "chart", LIVER, "--tool-reference", LIVER_TOOL, *FINITE_STRAIN,
               "--accuracy", "model/scenes/liver.accuracy"]
    values = {}
    for row in json_in_file(*command, option="--out", name="tool.json")["laws"]:
        if row["law"] in LAW_SIZES and "failure" not in row:
            values[row["law"]] = {
                "rms_percent": 100 * row["force_rms_ratio"],
                "unseen_percent": 100 * row["unseen_rms_ratio"],
                "own_percent_at_mm": {mm: 100 * own for mm, own in row["own_worst_ratio_at_mm"].items()},
                "place_rms_percent": {at: 100 * own for at, own in row["place_rms_ratio"].items()},
                "median_us": row["tick_median_us"]}
    return " ".join(command) + " --out DIR", values


# Which solved presses evaluate which scene: the same organ, held alike, and the same spheres.
SCENE_REFERENCES = {"liver": "liver", "liver_twist": "liver", "liver_source": "liver_source",
                    "grasper": "grasper", "heart": "heart", "skin": "skin", "gum": "gum", "maintenance": "maintenance"}
LIGHT_TOUCH_M = 0.001  # shallower presses are solved, and not evaluated


def scenes():
    """Each scene with the law that it ships, under its whole tool; none of the places was in a fit."""
    values = {}
    for scene, reference in SCENE_REFERENCES.items():
        path = f"model/scenes/{scene}"
        chart = json_in_file("build/tact-lab", "chart", f"{path}.toml", "--tool-reference",
                             f"tests/data/reference/{reference}_tool.json", *(FINITE_STRAIN if reference == "liver" else []),
                             "--accuracy", f"{path}.accuracy",
                             option="--out", name="tool.json")
        law = re.search(r'^law = "(\w+)"', (ROOT / f"{path}.toml").read_text(), re.M)[1]
        row = next(row for row in chart["laws"] if row["law"] == law)
        worst = max((r for r in chart["rows"] if r["law"] == law and r["depth_m"] > 0.99 * LIGHT_TOUCH_M),
                    key=lambda r: abs(r["own_error_ratio"]))
        values[scene] = {"law": law, "rms_percent": 100 * row["force_rms_ratio"],
                         "own_percent": 100 * worst["own_error_ratio"], "place": worst["place"],
                         "depth_mm": 1e3 * worst["depth_m"],
                         "within_percent": 100 * row["within_jnd_ratio"], "median_us": row["tick_median_us"]}
    return ("build/tact-lab chart model/scenes/SCENE.toml --tool-reference tests/data/reference/SCENE_tool.json --out DIR; the "
            f"liver's with {' '.join(FINITE_STRAIN)}", values)


def stability():
    """The maps that tools/stability/README.md quotes, with the numbers of their findings."""
    values = {}
    for name in ("integrators", "loop", "loop_delta"):
        command = ["build/tact-lab", "stability", "--only", name, "--no-pictures", "--json"]
        found = json.loads(output_of(*command, "--out", tempfile.mkdtemp(), status=(0, 1)))["maps"][0]
        values[name] = {"rows": found["rows"]}
        for finding in found["findings"]:
            values[name].update(finding["numbers"])
    return "build/tact-lab stability --out DIR --no-pictures --json, of three maps", values


def tracking():
    """Errors of poses and joint updates, by benchmark; the times are bench's."""
    command = ["build/tact-tracking-bench", "model/scenes/maintenance.toml", "--benchmark_format=json"]
    values = {}
    for row in json.loads(output_of(*command, "--benchmark_filter=errors|scene|far|turned"))["benchmarks"]:
        value = values[row["name"].split("/")[0]] = {}
        for name in (name for name in row if name.endswith("_mm") or name in ("joint_updates", "sweeps", "missed")):
            part, _, at = name.rpartition(".")
            (value.setdefault(part, {}) if part else value)[at] = row[name] if row[name] % 1 else int(row[name])
    values["updates_ratio"] = values["scene_full_chain"]["joint_updates"] / values["scene_shoulder_first"]["joint_updates"]
    return " ".join(command), values


def coupling():
    """From a marker that moved to the picture of it; with other load on the machine."""
    return "node tests/browser/operator_latency.mjs build 60", json_in_file(
        "node", "tests/browser/operator_latency.mjs", "build", "60", option="--json")


def measured():
    """Laws against measured silicone: one material is fitted, two evaluate by one factor each."""
    command = ["build/tact-lab", "fit", LIVER, "--set", "varies_by_place=false", "rhombus.area_m2=0",
               "--data", "tests/data/measured/silicone_compression.csv",
               "--depth-column", "compression_mm", "--depth-unit-m", "0.001",
               "--force-column", "load_mean_N", "--scale-by-site", "--held-out", "EF10_50T,EF30_50T",
               "--law", "hex_sheet,rhombus,disc_stack_linear"]
    values = {}
    for percent, deepest_m in ((30, 0.009), (60, 0.018)):
        fit = json.loads(output_of(*command, "--json", "--deepest-m", deepest_m, status=(0, 1)))
        values[f"to_{percent}_percent"] = {
            law["law"]: {site["site"]: {"rms_percent": 100 * site["force"]["rms_ratio"],
                                        "worst_percent": 100 * site["force"]["worst_ratio"],
                                        "factor": site["scale"], "peak_N": site["force"]["peak_N"]}
                         for site in law["sites"]}
            for law in fit["laws"]}
    return " ".join(command) + " --deepest-m METRES", values


def image():
    """From a tree that is built to an emulated PC that is ready; needs root."""
    output = output_of("tests/image/run")
    at = {name: float(re.search(rf"^image: (\d+) s: {name}", output, re.M)[1])
          for name in ("packages", "Debian", "disk", "done")}
    size_GB, used_GB = re.search(r"^image: ([\d.]+) GB, of which ([\d.]+) GB", output, re.M).groups()
    ready_s, linux_s = re.search(r"(\d+) s from power-on, (\d+) s of them", output).groups()
    return "tests/image/run", {
        "package_s": at["Debian"] - at["packages"], "debian_s": at["disk"] - at["Debian"],
        "disk_s": at["done"] - at["disk"], "size_GB": float(size_GB), "used_GB": float(used_GB),
        "login_s": float(re.search(r"BIOS.*login after (\d+) s", output)[1]),
        "ready_s": float(ready_s), "ready_of_linux_s": float(linux_s)}


# compliance.large_strain corrects tip and bending, or neither; with the shipped law and with the exact tip.
STRAINS = {"shipped": [], "shipped_small": ["compliance.large_strain=false"], "exact": ["law=compliance"],
           "exact_small": ["law=compliance", "compliance.large_strain=false"]}


def name_of_place(place):
    """As tools/ground_truth/tool_reference.h has it."""
    if place["vertex"] is not None:
        return str(place["vertex"])
    if place.get("tilt_deg", 0.0):
        return f"tilted {place['tilt_deg']:g}"
    slid_m = math.hypot(*place.get("slid_m", [0.0]))
    return f"slid {1e3 * slid_m:.3g} mm" if slid_m else "hand's"


def finite_strain():
    """The liver under its whole tool against finite elements at finite strain, as shipped and as it could be."""
    command = ["build/tact-lab", "sweep", LIVER, "--reference"]

    def pressed(solved, keys=()):
        reference = f"tests/data/reference/liver_finite_strain{solved}.json"
        return json.loads(output_of(*command, reference, "--json", *(word for key in keys for word in ("--set", key))))

    def worst_of(press):
        depth_m, worst = max(press["off_ratio"], key=lambda at: abs(at[1]))
        return {"worst_percent": 100.0 * worst, "worst_mm": 1e3 * depth_m, "sphere_percent": 100.0 * press["worst_sphere_ratio"]}

    found = {}
    for name, keys in STRAINS.items():
        found[name] = pressed("", keys)
        for place, press in pressed("_12mm", keys).items():
            found[name][place]["off_ratio"] += press["off_ratio"]
            found[name][place]["worst_sphere_ratio"] = max(found[name][place]["worst_sphere_ratio"], press["worst_sphere_ratio"])
    place = {name: worst_of(press) for name, press in found["shipped"].items()}
    unfitted = {name: worst_of(press) for solved in ("_places", "_tool") for name, press in pressed(solved).items()
                if name not in place}
    linear, finite = ({name_of_place(one): {case["depth_m"]: case["force_N"] for case in one["cases"]}
                       for one in json.loads((ROOT / file).read_text())["places"]} for file in (LIVER_TOOL, FINITE_STRAIN[1]))
    return " ".join(command) + " FILE", {
        "linear": {at: {f"{1e3 * depth_m:g}": 100.0 * (force_N / finite[at][depth_m] - 1.0) for depth_m, force_N in one.items()}
                   for at, one in linear.items()},
        "worst_percent": max(abs(one["worst_percent"]) for one in [*place.values(), *unfitted.values()]),
        "place": place, "unfitted": unfitted,
        "strain": {name: {at: {f"{1e3 * depth_m:g}": 100.0 * off for depth_m, off in press["off_ratio"]}
                          for at, press in places.items()} for name, places in found.items()}}


# The hand's site and two that no fit has used; the deepest that CalculiX reaches in minutes. FEniCSx solves the same.
SECOND_SOLVED = [[*where, "--depths", "0.001", "0.002", "0.0035", "0.005"]
                 for where in (["--tilts", "0"], ["--sites", "2051"], ["--sites", "2065"])]


def second_solver():
    """The whole tool of the liver at finite strain by two programs; about an hour of CPU time where nothing is kept."""
    command = ["build/tact-lab", "reference", LIVER, "--tool", "--level", "1"]
    values = {"place": {}}
    for where in SECOND_SOLVED:
        calculix, fenicsx = (json.loads(output_of(*command, *where, "--json", "--finite-strain", solver))["places"]
                             for solver in ("CalculiX", "FEniCSx"))
        for known, place in zip(calculix, fenicsx):
            values["place"].setdefault("hand's" if place["vertex"] is None else str(place["vertex"]), {}).update(
                {f"{1e3 * a['depth_m']:g}": {
                    "calculix_N": a["force_N"], "fenicsx_N": b["force_N"], "percent": 100.0 * (b["force_N"] / a["force_N"] - 1.0),
                    "sphere_percent": max(100.0 * abs(x - y) / a["force_N"] for x, y in zip(a["sphere_N"], b["sphere_N"]))}
                 for a, b in zip(known["cases"], place["cases"])})
    values["worst_percent"] = max(abs(at["percent"]) for place in values["place"].values() for at in place.values())
    return " ".join(command) + " --finite-strain PROGRAM", values


MEASURED = {f.__name__: f for f in (bench, limits, verify, size, chart, tool, scenes, stability, tracking,
                                    coupling, measured, image, finite_strain, second_solver)}
