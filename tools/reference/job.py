# SPDX-License-Identifier: Apache-2.0
"""A job from the scene to the file. It has the options by their names and, without self_check, the scene: organ, tool, hand and
reference sites, lengths in the mesh's own frame.
"""
import pathlib
import sys
from dataclasses import replace

import numpy as np

import body
import cache as caches
import calculix
import finite_strain
import plan as plans
import run
import self_check
import texts
import tool_plan

LABEL = "tact-lab reference"


def organ_of(job):
    o = job["organ"]
    arrays = [np.array(o[key]) for key in ("vertex_m", "triangle", "vertex_normal", "fixed_min_m", "fixed_max_m")]
    return body.Organ(*arrays, o["youngs_modulus_Pa"], o["poisson_ratio"], o["mesh"], o["mesh_hash"])


def plan_of(job):
    depths_m = job["depths_m"] or plans.DEPTHS_M
    sites = job["sites"] or [site["vertex"] for site in job["reference_sites"]]
    plan = plans.Plan(organ_of(job), job["tool"][0]["radius_m"], sites, depths_m, job["large_strain"], job["level"])
    plans.check(plan)
    if plan.large_strain_sites and depths_m[-1] > plans.LARGE_PULL * plan.tool_radius_m:
        # Reported, not refused: the rest of the plan is worth its hours.
        print(f"{LABEL}: left out: pulls with large strain beyond {plans.LARGE_PULL * plan.tool_radius_m * 1e3:.3g} mm "
              f"({plans.LARGE_PULL:g} tool radii); no mesh that bears them is fine enough", file=sys.stderr)
    return plan


def name_of(what):
    """ "vertex 12, press of 10 mm with large strain" """
    return (f"vertex {what.vertex}, {'press' if what.depth_m > 0 else 'pull'} of {abs(what.depth_m) * 1e3:g} mm"
            f"{' with large strain' if what.large_strain else ''}")


def solve_all(cache, cases, processes):
    """A Case for each, in their order. At large strain some depths have no solution: such a case is None, and reported."""
    def work(what):
        try:
            return cache.case(what)
        except run.Failure as failure:
            if what.large_strain and failure.code == run.Code.NO_SOLUTION:
                return failure  # no mesh bears every pull: that is an answer, no failure of the run
            raise

    solved = run.run_jobs(work, cases, processes, LABEL)
    for what, case in zip(cases, solved):
        if isinstance(case, run.Failure):
            print(f"{LABEL}: left out: {name_of(what)}: {case.message}", file=sys.stderr)
    return [None if isinstance(case, run.Failure) else case for case in solved]


def solver_versions():
    gmsh = body.gmsh_version()
    return f"CalculiX {calculix.version()}, gmsh {gmsh}"


def solve_sphere(job):
    """The file's text and the table."""
    plan, solver = plan_of(job), solver_versions()
    cache = caches.Cache(job["cache"], plan.organ, solver)
    if job["sideways"]:
        rows = plans.sideways_rows(plan, solve_all(cache, plans.sideways_cases(plan), job["jobs"]))
        return texts.sideways(plan, solver, rows)
    # First what all presses of a site need, so that no two of them solve it at the same time.
    solve_all(cache, [caches.probe_of(vertex, plan.tool_radius_m) for vertex in plan.sites], job["jobs"])
    solved = solve_all(cache, plans.cases_of(plan), job["jobs"])
    sites = [(vertex, plans.cases_of_site(plan, vertex, solved)) for vertex in plan.sites]
    return texts.sphere(plan, solver, sites)


def solve_tool(job):
    """The file's text and the table."""
    organ, hand, tool = organ_of(job), job["hand"], job["tool"]
    depths_m = job["depths_m"] or tool_plan.DEPTHS_M
    nearest = int(np.linalg.norm(organ.vertex_m - hand["site_m"], axis=1).argmin())
    plans.check(plans.Plan(organ, tool[0]["radius_m"], job["sites"] or [nearest], depths_m, [], job["level"]))
    places = tool_plan.Places(organ, np.array([s["offset_m"] for s in tool]), np.array([s["radius_m"] for s in tool]),
                              np.array(hand["inward"]), depths_m[-1], job["away_from_edges"])
    fitted = [site["vertex"] for site in job["reference_sites"] if not site["held_out"]]
    tool_places = tool_plan.places_of(places, hand, fitted, job["sites"], job["tilts_deg"])
    if job["finite_strain"]:
        solver = finite_strain.version(job["finite_strain"])
        presses = tool_plan.finite_presses_of(places, tool_places, depths_m, job["level"], job["finite_strain"])
        solved = run.run_jobs(caches.Cache(job["cache"], organ, solver).finite_cases, presses, job["jobs"], LABEL)
        return texts.tool(places, solver, [replace(place, cases=cases) for place, cases in zip(tool_places, solved)])
    solver = f"tact, gmsh {body.gmsh_version()}"
    if job["skin"]:
        tool_places = [replace(place, skin=tool_plan.surface_around(organ, place)) for place in tool_places]
    cache = caches.Cache(job["cache"], organ, solver)
    presses = tool_plan.presses_of(places, tool_places, depths_m, job["level"])
    tool_places = tool_plan.assemble(tool_places, run.run_jobs(cache.tool_cases, presses, job["jobs"], LABEL))
    return texts.tool(places, solver, tool_places)


def act(job):
    with run.folder_of_run():
        if job["self_check"]:
            return 0 if self_check.self_check(job["self_check"], job["jobs"]) else 1
        text, table = solve_tool(job) if job["tool_together"] else solve_sphere(job)
    if job["out"]:
        run.write(pathlib.Path(job["out"]), text)
    print(text if job["json"] else table, end="", flush=True)
    return 0
