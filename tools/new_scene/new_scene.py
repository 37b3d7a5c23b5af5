# SPDX-License-Identifier: Apache-2.0
"""A mesh in, a scene out: repaired, placed, condensed, and taken by tactd. tact-lab new-scene runs this; --help there says what.

    /usr/bin/python3 -I new_scene.py JOB.json

Exit status: 0 good, 1 Ctrl-C, 2 bad input. JOB.json has the options by their names, the names of the files to make, whether the
mesh can be taken as it is, and the folder of the programs that are asked.
"""
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent / "reference"))

import run  # noqa: E402

LABEL = "tact-lab new-scene"
UNITS_M = {"m": 1.0, "cm": 0.01, "mm": 0.001, "um": 1e-6, "in": 0.0254}
MIN_SIZE_M, MAX_SIZE_M = 0.005, 2.5  # chosen: a lymph node, and a whole person
HELD_RATIO, AROUND_M = 0.1, 0.01  # the lowest part of the organ, in a box that goes beyond it
MAX_DEPTH_M = 0.012  # as the liver's
DEPTH_RATIO = 0.2  # of the height: small strain beyond the tip
PRESS_RATIO = 0.8  # of the working depth
LIVER_PA = 6270.0  # E / (1 - nu^2), of the numbers in text_of
TIP_ALONE = ["--set", "law=rhombus", "--set", "varies_by_place=false"]  # while the map is to come
FILES = ("organ", "tool", "map", "reference", "tool_reference", "scene")  # the scene is the last to appear


def report(step, text):
    print(f"{step:<15}  {text}", flush=True)


class Maker:
    """One organ, in a folder where every file is whole before any appears."""

    def __init__(self, job, folder):
        self.job, self.folder, self.names = job, folder, job["names"]
        self.made = {name: f"{folder}/{os.path.basename(path)}" for name, path in self.names.items()}

    def ask(self, program, *words):
        """The lines that a program beside tact-lab has printed. If it fails, its last one is the error."""
        on_terminal = sys.stderr.isatty()  # then it shows there how far it is, and what went wrong
        with subprocess.Popen([f"{self.job['programs']}/{program}", *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=None if on_terminal else subprocess.STDOUT, text=True, errors="replace",
                              preexec_fn=run.end_with_parent) as child:
            try:
                lines = child.communicate()[0].splitlines()
            except BaseException:
                child.terminate()  # it ends what it has started and written itself
                try:
                    child.wait(3.0)
                except subprocess.TimeoutExpired:
                    child.kill()
                raise
        if child.returncode != 0:
            raise run.Failure(lines[-1] if lines and not on_terminal else f"{program} ended with status {child.returncode}")
        return lines

    def about(self, message):
        """With the folder where the files will come; none is there yet."""
        return message.replace(str(self.folder), os.path.dirname(os.path.abspath(self.names["scene"])))

    def organ(self):
        """What tact-mesh says of the organ; self.made["organ"] is there if it was repaired."""
        job = self.job
        words = [job["source"], "--json", *(["--unit-m", repr(job["unit_m"])] if job["unit_m"] else [])]
        if not job["is_sound"]:
            words += ["--out", self.made["organ"], "--weld", "--drop-degenerate", "--largest", "--hollow-refused",
                      "--close-holes", *(["--smooth"] if job["smooth"] else []), f"--decimate={job['faces']}"]
        said = json.loads("\n".join(self.ask("tact-mesh", *words)))
        for step in said.get("steps", []):
            report(step["step"], step["text"])
        size_m = [high - low for low, high in zip(said["low_m"], said["high_m"])]
        unit = next((name for name, length_m in UNITS_M.items() if length_m == said["unit_m"]), f"{said['unit_m']:g} m")
        report("unit", {"named": f"{unit}, as named", "format": f"{unit}, as glTF is in metres; --unit sets another",
                        "size": f"taken as {unit}: {1e3 * max(size_m):.4g} mm across; --unit sets another"}[said["unit_from"]])
        if said["boundary_edges"] > 0:
            raise run.Failure(f"{job['source']}: {said['boundary_edges']} edges stay open after the repair, so it has no inside; "
                              "close it in a mesh editor")
        if not MIN_SIZE_M <= max(size_m) <= MAX_SIZE_M:
            raise run.Failure(f"{job['source']}: {max(size_m):.3g} m long, and an organ is {MIN_SIZE_M:g} to {MAX_SIZE_M:g} m; "
                              "name its --unit")
        report("organ", f"{said['vertices']} vertices, {said['triangles']} faces, closed, " +
               " x ".join(f"{1e3 * length_m:.3g}" for length_m in size_m) + " mm" +
               (", taken as it is" if job["is_sound"] else ""))
        return said

    def write_scene(self, organ, law):
        text = (FOLDER / "scene.in").read_text().format(**text_of(self.job, organ, law))
        pathlib.Path(self.made["scene"]).write_text(text)

    def choose_law(self):
        """By tact-lab plan, which leaves its choice in this user's cache for this PC; minutes to an hour."""
        made = self.made
        report("reference", "one sphere, by CalculiX: minutes for thousands of vertices")
        self.ask("tact-lab", "reference", made["scene"], "--out", made["reference"])
        report("reference", "the whole tool, by finite elements: as long again")
        # Level 1: the places are nine, and a finer mesh changes their force by 2 %.
        self.ask("tact-lab", "reference", made["scene"], "--tool", "--level", "1", "--out", made["tool_reference"])
        for line in self.ask("tact-lab", "plan", made["scene"], "--reference", made["reference"], "--tool-reference",
                             made["tool_reference"]):
            report("plan", self.about(line))
        self.ask("tactd", made["scene"], "--check")

    def make(self):
        """True if tact-lab plan has chosen the law."""
        organ = self.organ()
        held_max_m = held_box(organ)[1]
        report("place", f"the top comes to the tool; held below z = {1e3 * held_max_m[2]:.4g} mm, the lowest tenth")
        shutil.copy(FOLDER / "forceps.obj", self.made["tool"])
        self.write_scene(organ, "compliance")
        if not self.job["without_map"]:
            report("condense", f"{organ['vertices']} vertices, by finite elements: minutes for thousands")
            self.ask("tact-lab", "condense", self.made["scene"], "--out", self.made["map"])
        # Its own message if it does not take it.
        self.ask("tactd", self.made["scene"], "--check", *(TIP_ALONE if self.job["without_map"] else []))
        is_planned = self.job["plan"]
        if is_planned:
            self.write_scene(organ, "auto")
            try:
                self.choose_law()
            except run.Failure as none:
                is_planned = False
                report("plan", "none: " + self.about(none.message))
                self.write_scene(organ, "compliance")
        report("check", "tactd takes the scene")
        made = [(self.names[name], pathlib.Path(self.made[name])) for name in FILES if os.path.exists(self.made[name])]
        write_all([(path, file.read_bytes()) for path, file in made], self.job["force"])
        for path, _ in made:
            report("wrote", path)
        return is_planned


def held_box(organ):
    """Least and largest corner around the lowest tenth."""
    low_m, high_m = organ["low_m"], organ["high_m"]
    top_m = low_m[2] + HELD_RATIO * (high_m[2] - low_m[2])
    return [x - AROUND_M for x in low_m], [high_m[0] + AROUND_M, high_m[1] + AROUND_M, top_m]


def working_depth_m(organ):
    return min(max(DEPTH_RATIO * (organ["high_m"][2] - organ["low_m"][2]), 1e-3), MAX_DEPTH_M)


def rounded_m(x_m):
    """To a tenth of a micrometre, without -0."""
    return round(x_m * 1e7) / 1e7 + 0.0


def text_of(job, organ, law):
    """What scene.in leaves open, as TOML writes values."""
    def quoted(text):
        return json.dumps(text, ensure_ascii=False)

    def beside(name):
        return quoted(os.path.basename(job["names"][name]))

    def lengths(xs_m):
        return str([rounded_m(x_m) for x_m in xs_m])

    nu, depth_m = job["poisson_ratio"], working_depth_m(organ)
    depth_ratio = depth_m / MAX_DEPTH_M  # a thin organ pulls no further
    of_liver = job["youngs_modulus_Pa"] / (1.0 - nu * nu) / LIVER_PA
    press_m = rounded_m(PRESS_RATIO * depth_m)
    held_min_m, held_max_m = held_box(organ)
    return {"organ": quoted(job["source"]), "name": quoted(job["names"]["name"]), "law": quoted(law), "map": beside("map"),
            "tool": beside("tool"), "mesh": quoted(os.path.abspath(job["source"])) if job["is_sound"] else beside("organ"),
            "mesh_unit_m": organ["unit_m"], "vertex_colors": str(organ["colors"]).lower(),
            "position_m": lengths(-x_m for x_m in organ["top"]["point_m"]), "vertex": organ["top"]["vertex"],
            "fixed_min_m": lengths(held_min_m), "fixed_max_m": lengths(held_max_m),
            "youngs_modulus_Pa": job["youngs_modulus_Pa"], "poisson_ratio": nu, "working_depth_m": rounded_m(depth_m),
            "press_m": press_m, "grip_m": rounded_m(press_m / 2.0), "rhombus_normal_N_per_m": f"{1.604 * of_liver:.4g}",
            "rhombus_tangential_N_per_m": f"{0.8257 * of_liver:.4g}", "pull_N_per_m": f"{50.3 * of_liver:.4g}",
            "tear_force_N": f"{min(max(0.4 * depth_ratio * of_liver, 0.01), 20.0):.4g}"}


def write_all(files, force):
    """[(path, bytes)], in this order: all of them or, unless one takes the place of another, none."""
    parts, made, path = [], [], ""
    try:
        for path, data in files:
            handle, part = tempfile.mkstemp(dir=os.path.dirname(os.path.realpath(path)), prefix=".tact-")
            parts.append(part)
            with open(handle, "wb") as file:
                file.write(data)
                os.fsync(handle)
            os.chmod(part, 0o644)
        for (path, _), part in zip(files, parts):
            if not force and os.path.lexists(path):
                raise FileExistsError
            os.replace(part, os.path.realpath(path))
            made += [] if force else [path]
    except OSError as error:
        for one in made:
            os.unlink(one)
        if isinstance(error, FileExistsError):
            raise run.Failure(f"{path}: exists already and is never overwritten; choose another name") from None
        raise run.Failure(f"{path}: cannot be written: {error.strerror}; check the folder, who may write there and the free "
                          "space") from None
    finally:
        for part in parts:
            pathlib.Path(part).unlink(missing_ok=True)


def act(job):
    with run.folder_of_run():
        with run.Scratch("tact-new-scene") as scratch:
            maker = Maker(job, scratch.path)
            try:
                if not job["without_map"]:
                    run.run_program(["gmsh", "--version"], scratch, "gmsh", 60.0)  # before the minutes of repair
                is_planned = maker.make()
            except run.Failure as failure:
                raise run.Failure(maker.about(failure.message)) from None
    report_next(job, is_planned)


def report_next(job, is_planned):
    scene = shlex.quote(job["names"]["scene"])
    if job["without_map"]:
        print(f"\nFeel its tip alone:\n  tactd {scene} {' '.join(TIP_ALONE)} --free-run --seconds 5\nIts map, minutes:\n"
              f"  tact-lab condense {scene} --out {shlex.quote(job['names']['map'])}")
        return
    report("law", "as tact-lab plan has chosen for this PC" if is_planned else "compliance, from the map")
    print(f"\nFeel it:\n  tactd {scene} --free-run --seconds 5")
    if is_planned:
        print(f"On another PC its times differ; there, once:\n  tact-lab plan {scene} --reference "
              f"{shlex.quote(job['names']['reference'])} --tool-reference {shlex.quote(job['names']['tool_reference'])}")
    elif not job["plan"]:
        print("Is a faster law good enough? The same with --plan --force compares them, by CalculiX.")


if __name__ == "__main__":
    sys.exit(run.main(LABEL, act, "nothing was written"))
