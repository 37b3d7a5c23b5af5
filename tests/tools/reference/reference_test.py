#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tact-lab reference as a person meets it; its plans, its geometry, its cache and its solvers in the files beside this.

    python3 tests/tools/reference/reference_test.py BUILD_DIR [plan_test | solve_test | surface_test | ...]

Needs python3-scipy, gmsh and, where a test says so, CalculiX, which Debian 13 does not have. Exit status 0 or 1.
"""
import io
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest.mock

from support import BUILD, LIVER, Solves, needs_calculix, tact_lab

import run


class Program(Solves):
    def environment(self, **scripts):
        """With these shell scripts as programs, before those of the PC."""
        for name, script in scripts.items():
            path = self.folder / name
            path.write_text(f"#!/bin/sh\n{script}\n")
            path.chmod(0o755)
        return {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}", "TMPDIR": str(self.folder)}

    def refuses(self, arguments, message, **settings):
        self.assertEqual(tact_lab(arguments, **settings), (2, f"tact-lab reference: {message}\n"))

    def test_reports_its_options_with_units(self):
        status, text = tact_lab(["--help"])
        self.assertEqual(status, 0)
        for word in ("--depths", "m, above 0", "--self-check", "apt install gmsh python3-scipy\ncalculix-ccx"):
            self.assertIn(word, text)

    def test_refuses_what_cannot_be_solved(self):
        self.refuses([], "no scene given; see tact-lab reference --help")
        self.refuses([LIVER, "--sites", 99999], "site 99999 is no vertex of liver_3116.obj; they are 0 to 3115")
        for depths in ("0.002,0.001", "0.001,0.001", "1.5"):
            self.refuses([LIVER, "--sites", 1714, "--depths", depths], "--depths must rise, all above 0 and at most 0.02 m "
                         "(5 tool radii); give metres: 0.001,0.002")
        self.refuses([LIVER, "--tool", "--sites", 125], "site 125 lies in the held box, elastic.fixed_min_m to "
                     "elastic.fixed_max_m; choose another, or move the box")
        self.refuses(["--self-check", "/nowhere"], "/nowhere/organ_patch.json: no such file; give the folder "
                     "tests/data/reference")
        self.refuses([LIVER, "--sites", 1714, "--out", "/nowhere/liver.json"], "/nowhere/liver.json: cannot be written: No such "
                     "file or directory; check the folder, who may write there and the free space")

    @needs_calculix
    def test_refuses_an_organ_that_nothing_holds(self):
        self.refuses([LIVER, "--sites", 1714, "--cache", self.folder, "--set", "elastic.fixed_min_m=[5,5,5]",
                      "--set", "elastic.fixed_max_m=[6,6,6]"],
                     "no triangle of the organ lies in the held box, so it would fly away; move elastic.fixed_min_m and "
                     "elastic.fixed_max_m (tact-mesh --align proposes them)")

    def test_says_what_to_install_and_leaves_no_file(self):
        out = self.folder / "out.json"
        self.refuses([LIVER, "--sites", 1714, "--out", out], "gmsh is not installed; apt install gmsh",
                     env={**os.environ, "PATH": "/nowhere"})
        self.assertFalse(out.exists())

    def test_jobs_of_one_site_share_its_coarse_solve(self):
        environment = self.environment(ccx="echo This is Version 2.20", gmsh='[ "$1" = --version ] && echo 4.8.4 && exit\n'
                                       f"echo once >> {self.folder}/calls; sleep 0.5; exit 3")
        status, text = tact_lab([LIVER, "--sites", 1714, "--jobs", 4, "--cache", self.folder / "cache"], env=environment)
        self.assertEqual(status, 2)
        self.assertIn("gmsh ended with status 3", text)
        self.assertEqual((self.folder / "calls").read_text(), "once\n")
        self.assertEqual(len(list(self.folder.glob("tact-gmsh-*/gmsh.log"))), 1, "for a person to look into")
        self.assertIn(str(next(self.folder.glob("tact-gmsh-*/gmsh.log"))), text)

    def test_reports_large_strain_without_a_solution_and_keeps_the_rest(self):
        # Solves every linear case by 1 mN a moved node, and no other.
        only_linear = r"""[ "$1" = -v ] && echo This is Version 2.20 && exit
if grep -q NLGEOM case.inp; then
  grep -q CONTACT case.inp && echo ball >> "$TMPDIR/loads" || echo bond >> "$TMPDIR/loads"
  echo no convergence; exit 201
fi
awk -F, '/^[*]/ { set = "" } /^[*]NSET/ { set = $2; next }
  set == "NSET=FORCED" { for (i = 1; i <= NF; ++i) if ($i) moved = moved $i " 1 0 0\n" }
  set == "NSET=REPORTED" { for (i = 1; i <= NF; ++i) if ($i) reported = reported $i " 0 0 0\n" }
  END {
    print "forces (fx,fy,fz) for set FORCED and time 1\n\n" moved
    print "displacements (vx,vy,vz) for set REPORTED and time 1\n\n" reported
  }' case.inp > case.dat"""
        asked = [LIVER, "--sites", 1714, "--depths", "0.002,0.007", "--level", 1, "--cache", self.folder / "cache"]
        environment = self.environment(ccx=only_linear)
        status, text = tact_lab([*asked, "--large-strain", 1714], env=environment)
        self.assertEqual(status, 0, text)
        for what in ("press of 2 mm", "press of 7 mm", "pull of 2 mm"):
            self.assertIn(f"tact-lab reference: left out: vertex 1714, {what} with large strain: CalculiX found no solution: ccx "
                          "ended with status 201", text)
        self.assertNotIn("pull of 7 mm", text, "beyond 1.3 radii of 4 mm")
        self.assertIn("left out: pulls with large strain beyond 5.2 mm", text)
        self.assertNotIn("neo-Hookean", text)
        self.assertEqual(text.count("  linear\n"), 4, "press and pull, 2 and 7 mm")
        loads = (self.folder / "loads").read_text().split()
        self.assertEqual((loads.count("ball"), loads.count("bond")), (4, 2), "2 and 7 mm at two levels, 2 mm at two levels")
        with open("/dev/full", "w") as full:
            again = subprocess.run([BUILD / "tact-lab", "reference", *map(str, asked)], env=environment, stdout=full,
                                   stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual((again.returncode, again.stderr), (2, "tact-lab reference: standard output cannot be written: No space "
                                                            "left on device; check where it goes\n"))

    def test_ctrl_c_ends_it_at_once_and_leaves_nothing(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            environment = self.environment(gmsh='[ "$1" = --version ] && echo 4.8.4 && exit\n'
                                           f"echo $$ >> {self.folder}/pids; sleep 60")
            words = [BUILD / "tact-lab", "reference", LIVER, "--tool", "--jobs=2", "--sites=1586", f"--cache={self.folder}/cache"]
            solver = subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            pids = self.folder / "pids"
            until_s = time.monotonic() + 60.0
            while not (pids.exists() and len(pids.read_text().split()) == 2) and time.monotonic() < until_s:
                time.sleep(0.05)
            self.assertEqual(len(pids.read_text().split()), 2, "both jobs are at work")
            sent_s = time.monotonic()
            solver.send_signal(number)
            text = solver.communicate(timeout=10)[0]
            self.assertLess(time.monotonic() - sent_s, 1.0)
            self.assertEqual((solver.returncode, text), (1, "tact-lab reference: interrupted; what was solved is kept, the same "
                                                         "command goes on from there\n"))
            for pid in pids.read_text().split():
                command = pathlib.Path(f"/proc/{pid}/cmdline")  # of a zombie: empty
                self.assertFalse(command.exists() and command.read_bytes(), "gmsh ends, too")
            pids.unlink()
            self.assertEqual({path.name for path in self.folder.iterdir()}, {"gmsh"})


class Jobs(Solves):
    def test_after_a_failure_no_other_begins_and_the_results_keep_their_order(self):
        def work(number):
            (self.folder / str(number)).touch()
            if number == 1:
                raise run.Failure("one", run.Code.NO_SOLUTION)
            time.sleep(0.5 if number == 0 else 0.0)
            return 10 * number

        self.assertEqual(run.run_jobs(work, [5, 3, 4], 2, "test"), [50, 30, 40])
        with self.assertRaises(run.Failure) as failed:
            run.run_jobs(work, [0, 1, 2], 2, "test")
        self.assertEqual((failed.exception.message, failed.exception.code), ("one", run.Code.NO_SOLUTION))
        self.assertFalse((self.folder / "2").exists())

    def test_a_terminal_shows_how_much_is_left(self):
        terminal = io.StringIO()
        terminal.isatty = lambda: True
        with unittest.mock.patch("sys.stderr", terminal):
            run.show_progress("tact-lab reference", 1, 4, time.monotonic() - 10.0)
        self.assertEqual(terminal.getvalue(), "\r\033[Ktact-lab reference: 1 of 4 (25 %) about 30 s left ")

    def test_no_job_outlives_its_parent(self):
        script = f"""import pathlib, sys, time
sys.path.insert(0, "{pathlib.Path(run.__file__).parent}")
import run
def work(_):
    pathlib.Path("{self.folder}/begun").touch()
    time.sleep(3)
    pathlib.Path("{self.folder}/ended").touch()
run.run_jobs(work, [0], 1, "")"""
        parent = subprocess.Popen(["/usr/bin/python3", "-c", script])
        while not (self.folder / "begun").exists():
            time.sleep(0.05)
        parent.kill()
        parent.wait()
        time.sleep(4)
        self.assertFalse((self.folder / "ended").exists())


if __name__ == "__main__":
    names = sys.argv[2:] or ["__main__", "cache_test", "finite_strain_test", "plan_test", "solve_test", "surface_test"]
    tests = unittest.defaultTestLoader.loadTestsFromNames(names)
    sys.exit(not unittest.TextTestRunner(verbosity=1).run(tests).wasSuccessful())
