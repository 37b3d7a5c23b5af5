# SPDX-License-Identifier: Apache-2.0
"""Results as the files that tact-lab reads (JSON, one case a line, numbers to some digits) and as tables."""
import json
import re

import numpy as np

from indentation import RING_PITCH_M


def short(value, digits=7):
    """Numbers, and those in lists and arrays, to so many digits."""
    if isinstance(value, (list, tuple, np.ndarray)):
        return [short(one, digits) for one in value]
    return float(f"{value:.{digits}g}") if isinstance(value, float) else value


def file_text(schema, organ, solver, **rest):
    head = {"schema": f"{schema}/1", "mesh": organ.mesh, "mesh_hash": organ.mesh_hash, "solver": solver,
            "youngs_modulus_Pa": organ.youngs_modulus_Pa, "poisson_ratio": organ.poisson_ratio,
            "fixed_min_m": short(organ.held_min_m), "fixed_max_m": short(organ.held_max_m)}
    return re.sub(r'((?<=\[)| )(?=\{"(vertex|depth_m)|"(sites|places|cases)")', "\n ", json.dumps(head | rest)) + "\n"


def case_of(case, **more):
    return {"depth_m": short(case.depth_m, 6), "force_N": short(case.force_N, 6),
            "force_error_ratio": short(case.force_error_ratio, 3), **more}


def percent(error_ratio):
    return "-" if error_ratio is None else f"{100.0 * error_ratio:.2f}"


def table(head, rows):
    return "\n".join([head, *rows]) + "\n"


def sphere(plan, solver, sites):
    """File and table; sites: [(vertex, [Case])]."""
    organ = plan.organ
    data = [{"vertex": vertex, "point_m": short(organ.vertex_m[vertex]), "direction": short(-organ.vertex_normal[vertex]),
             "cases": [case_of(c, large_strain=c.large_strain, contact_radius_m=short(c.contact_radius_m, 6),
                               profile_m=short(c.profile_m, 4)) for c in cases]} for vertex, cases in sites]
    rows = (f"{vertex:>6} {c.depth_m * 1e3:>9.3g} {c.contact_radius_m * 1e3:>11.3f} {c.force_N:>10.5f} "
            f"{percent(c.force_error_ratio):>11}  {'neo-Hookean' if c.large_strain else 'linear'}"
            for vertex, cases in sites for c in cases)
    return (file_text("tact-reference", organ, solver, tool_radius_m=plan.tool_radius_m, ring_pitch_m=RING_PITCH_M, sites=data),
            table("vertex  depth mm  contact mm    force N  mesh err %  material", rows))


def sideways(plan, solver, solved):
    """File and table; solved: as sideways_rows."""
    data = [{"vertex": c.vertex, "along": short(c.along), "held": c.held, "contact_radius_m": short(c.contact_radius_m, 6),
             "stiffness_N_per_m": short(stiffness, 6), "error_ratio": short(error, 3)} for c, stiffness, error in solved]
    rows = (f"{c.vertex:>6} {c.contact_radius_m * 1e3:>9.3g} {'yes' if c.held else 'no':>6} {stiffness:>8.2f} "
            f"{percent(error):>11}" for c, stiffness, error in solved)
    return (file_text("tact-sideways-reference", plan.organ, solver, cases=data),
            table("vertex radius mm   held      N/m  mesh err %", rows))


def tool(places, solver, tool_places):
    """File and table; each of tool_places has its cases."""
    spheres = [{"offset_m": short(offset_m), "radius_m": short(radius_m)}
               for offset_m, radius_m in zip(places.offset_m, places.radius_m.tolist())]
    data = [{"vertex": place.vertex, **({"slid_m": short(place.slid_m)} if np.any(place.slid_m) else {}),
             **({"tilt_deg": place.tilt_deg} if place.tilt_deg else {}),
             "point_m": short(place.point_m), "direction": short(place.direction),
             "orientation_wxyz": short(place.orientation, 9), **({"skin": place.skin} if place.skin else {}),
             "cases": [case_of(c, sphere_N=short(c.sphere_N, 6), **({"skin_m": short(c.skin_m, 4)} if c.skin_m else {}))
                       for c in place.cases]} for place in tool_places]
    rows = (f"{place.name:>9} {c.depth_m * 1e3:>9.3g} {c.force_N:>10.5f} {percent(c.force_error_ratio):>11}  " +
            " ".join(f"{force_N:.5f}" for force_N in c.sphere_N) for place in tool_places for c in place.cases)
    return (file_text("tact-tool-reference", places.organ, solver, spheres=spheres, places=data),
            table("    place  depth mm    force N  mesh err %  of each sphere N", rows))
