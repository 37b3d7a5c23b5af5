# SPDX-License-Identifier: Apache-2.0
"""limits.html of limits.json: first the verdict and the limits that were tested, then a row for each case, the curves, the
hazards. tact-limits starts this; `python3 limits_page.py DIR` makes the page and its pictures again."""
import csv
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))  # where page.py lies, built and installed

import page  # noqa: E402

PANELS, COLUMNS = 12, 2  # fill an A4 page, and their words are still read there
WIDTH_PX, PANEL_PX, HEAD_PX, WALL_PX = 900, 190, 30, 380
STYLES = {"pass": "ok", "pass at a tighter limit": "ok", "FAIL": "bad"}


def curves(cases, number, folder):
    """Of each case: what was commanded, what the gate let through, what the device was handed, and the limit as two lines."""
    torque = [case["drives"] == "torque" for case in cases]
    rows = -(-len(cases) // COLUMNS)
    return page.draw(
        folder, "curves" if number == 1 else f"curves_{number}", "curves.gp", width_px=WIDTH_PX,
        height_px=HEAD_PX + rows * PANEL_PX, rows=rows, cases=[case["case"] for case in cases],
        limits=[case["torque_limit_Nm" if turned else "force_limit_N"] for case, turned in zip(cases, torque)],
        seconds=[case["duration_s"] for case in cases], columns=[6 if turned else 3 for turned in torque],
        failed=[int(not case["passed"]) for case in cases],
        causes=["none" if case["cause_s"] is None else case["cause_s"] for case in cases])


def pictures_of(data, folder):
    """SVG: the curves, then the wall."""
    cases = data["cases"]
    drawn = [curves(cases[first:first + PANELS], first // PANELS + 1, folder) for first in range(0, len(cases), PANELS)]
    if "wall" not in data:
        return {"curves": drawn}
    with open(folder / "wall.csv", encoding="utf-8", newline="") as file:
        stiffness = [float(row["stiffness_N_per_m"]) for row in csv.DictReader(file)]
    return {"curves": drawn, "picture": page.draw(
        folder, "wall", "wall.gp", width_px=WIDTH_PX, height_px=WALL_PX, softest=stiffness[0], stiffest=stiffness[-1],
        bounded_N_per_m=data["wall"]["bounded_without_N_per_m"])}


def facts(data):
    report, pc, sha256, simulated = data["report"], data["environment"], data["sha256"], data["simulated"]
    yield "Report number", report["number"]
    yield "Tested by", report["tester"]
    yield "Place", report["place"]
    yield "Serial numbers", "; ".join(report["serial_numbers"])
    yield "Begun, ended", f"{report['began']}, {report['ended']}"
    yield "Host", f"{report['host']}: {pc['cpu']}, Linux {pc['kernel']}"
    yield "Device", data["device"] + (" (SIMULATED, on simulated time)" if simulated else "")
    yield "Scene", f"{data['scene']} ({data['scene_path']}), hash {data['scene_hash']}"
    yield "Rate", (f"{data['rate_Hz']:g} Hz: times are whole ticks of {1e3 / data['rate_Hz']:g} ms, their resolution")
    if not simulated and not data["hard_real_time"]:  # simulated time needs no real time: the line would frighten for nothing
        yield "Real time", f"this PC gives no hard real time; force capped to {100 * data['force_share']:g} %"
    if not simulated:
        yield "Guards", ("the watch above the loop, the runaway guard" + (", the" if data["call_filter"] else "; no") +
                         " filter on the loop's system calls")
    yield "Limits checksum", f"{data['limits_checksum']} (SHA-256 {sha256['limits']})"
    yield "Limits checksum that tactd shows on this PC", data["limits_checksum_on_this_pc"]
    yield "SHA-256 of the scene", sha256["scene"]
    yield "SHA-256 of tact-limits", sha256["tact_limits"]
    yield "SHA-256 of tactd", (f"{sha256['tactd']} ({data['tactd_path']})" if data["tactd_path"] else
                               "none lies beside tact-limits")
    yield "Software", f"tact {pc['revision']}, {pc['compiler']}"
    yield "Command", data["command"]


def limit_row(number, row):
    def with_unit(value):
        return f"{value:.4g} {row['unit']}"
    seen = row["largest"] > 0 or row["kept"] != "not reached"
    return {"name": row["limit"], "key": row["key"], "kept": row["kept"], "style": STYLES.get(row["kept"], "part-text"),
            "limit": with_unit(row["value"]), "scene": with_unit(row["scene_value"]), "pc": with_unit(row["on_this_pc"]),
            f"is_{number}": True, "largest": with_unit(row["largest"]) if seen else "-",
            "reached_by": ", ".join(row["reached_by"]) or "-",
            "tighter": [{"case": own["case"], "limit": with_unit(own["value"]), "largest": with_unit(own["largest"]),
                         "holds": own["holds"]} for own in row["tighter"]]}


def tightened(limits):
    units = {"power_W": "W", "energy_J": "J", "continuous_force_N": f"N RMS over {limits.get('thermal_time_s', 0):g} s"}
    return "".join(f" Here at most {limits[key]:.3g} {unit}." for key, unit in units.items() if key in limits)


def plain(value):
    """Four digits, and none of them an exponent: an impulse of 10^6 N for a reader who knows none."""
    return f"{value:.4g}" if value < 1e4 else f"{value:.0f}"


def case_row(case):
    checks = case["checks"]
    # What the case asks besides the limits, which are the same for all: from its stage on.
    first = next((i for i, check in enumerate(checks) if check["sentence"].startswith("the stage ")), len(checks))
    broken = [check["sentence"] for check in checks if not check["holds"]]

    def in_ms(seconds):
        return "-" if seconds is None else f"{1e3 * seconds:.4g} ms"
    return {"name": case["case"], "what": case["what"], "tightened": tightened(case["tightened"]), "broken": broken,
            "injected": "" if case["cause"] == "played" else case["cause"], "has_broken": bool(broken),
            "criteria": "; ".join(check["sentence"] for check in checks[first:]),
            "commanded": plain(case["largest_commanded_N"]) + " N", "written": f"{case['largest_written_N']:.4g} N",
            "overshoot": f"{case['overshoot_N']:.3g} N", "zero": in_ms(case["time_to_zero_s"]),
            "allowed": in_ms(case["allowed_zero_s"]), "stages": case["stages"], "fault": case["fault_name"],
            "holds": case["passed"]}


def requirement_row(requirement, own_cases):
    """`own_cases`: of each test that this program itself is."""
    parts, words = [requirement["by"]], requirement["in_this_run"]
    if requirement["stages"]:
        parts.append("stage " + ", ".join(requirement["stages"]))
    if requirement["faults"]:
        names = [f"{number} {name}" for number, name in zip(requirement["faults"], requirement["fault_names"])]
        parts.append(("faults " if len(names) > 1 else "fault ") + ", ".join(names))
    return {"id": requirement["id"], "text": requirement["text"], "acts_by": "; ".join(parts),
            "tests": ", ".join(requirement["tests"]),
            "here": [{"name": name, "words": words[name], "style": STYLES.get(words[name], "quiet")}
                     for test in requirement["tests"] for name in own_cases.get(test, [])]}


def left_out(data):
    groups = {}
    for out in data["not_run"]:
        groups.setdefault(out["why"], []).append(out["case"])
    return [{"why": why, "names": ", ".join(names)} for why, names in groups.items()]


def html_of(data, pictures):
    pictures, cases, other = pictures or {"curves": []}, data["cases"], data["other_limits"]
    failed = sum(not one["passed"] for one in cases + [data[key] for key in ("wall",) if key in data])
    kept = data["cases_played"] > 0 and not failed
    svg = [page.inline_svg(one, number) for number, one in enumerate(pictures["curves"])]
    table = data["hazard_table"]
    own_cases = {test["id"]: test["names"] for test in table["tests"] if test["by"] == "tact-limits"}
    more = {"played": data["cases_played"], "not_played": len(data["not_run"]), "none_played": not data["cases_played"],
            "failed": failed, "all_kept": kept and not data["not_run"], "part_kept": kept and bool(data["not_run"]),
            "has_left_out": bool(data["not_run"]), "left_out": left_out(data), "has_cases": bool(cases),
            "facts": [{"name": name, "value": value} for name, value in facts(data)],
            "limits": [limit_row(number, row) for number, row in enumerate(data["limits"])],
            "cases": [case_row(case) for case in cases], "has_curves": bool(svg), "curves": svg,
            "any_injected": any(case["cause"] != "played" for case in cases),
            "hazards": [hazard | {"requirements": [requirement_row(one, own_cases) for one in hazard["requirements"]]}
                        for hazard in table["hazards"]],
            "tests": [test | {"names": ", ".join(test["names"]), "style": STYLES.get(test["result"], "part-text")}
                      for test in table["tests"]],
            "limits_sha256": data["sha256"]["limits"], "scene_sha256": data["sha256"]["scene"],
            "has_overrides": bool(data["overrides"]), "force_N": f"{data['limits'][0]['scene_value']:g}",
            "full_W": f"{other['full_power_W']:.3g}", "brake_J": f"{other['least_energy_J']:.3g}"}
    more.update((key, f"{other[key]:g}") for key in ("speed_mps", "workspace_radius_m", "workspace_half_length_m", "recovery_W"))
    if "wall" in data:
        picture = pictures.get("picture")
        more["wall"] = data["wall"] | {"theory": f"{data['wall']['theory_N_per_m']:.4g}",
                                       "picture": page.inline_svg(picture, len(svg)) if picture else ""}
    return page.page_of("limits.html", data | data["report"] | more)


if __name__ == "__main__":
    sys.exit(page.main("tact-limits", "limits.json", "limits.html", pictures_of, html_of))
