# SPDX-License-Identifier: Apache-2.0
"""The compliance of an organ at every vertex of its surface, as a file. tact-lab condense runs this; --help there says what.

    /usr/bin/python3 -I condense.py JOB.json

Exit status: 0 good, 1 Ctrl-C, 2 bad input. JOB.json has the options by their names and the organ in its mesh's own frame.
"""
import json
import os
import pathlib
import struct
import sys
import time

sys.dont_write_bytecode = True
FOLDER = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "reference")]

import run  # noqa: E402

LABEL = "tact-lab condense"
MESH_SIZE = 1.5  # edge of an element inside over the surface's median edge
ELEMENTS_IN_PATCH = 1.6  # patch radius over element edge: r within 2 % of a half-space's
RING_PITCH_M, RINGS = 0.002, 20
UNREFINED_M = 1e3  # no triangle of the surface is longer
VERSION = 2


def check(organ):
    """Before gmsh and finite elements, which would find it minutes later and know no key."""
    import numpy as np

    import surface
    times = np.unique(surface.edges_of(organ.triangle)[1], return_counts=True)[1]
    if (times == 1).any():
        raise run.Failure(f"the organ's surface has {(times == 1).sum()} open edges, so it has no inside; close it")
    held = organ.held(organ.vertex_m[organ.triangle]).all(axis=1)
    if held.any() and not held.all():
        return
    box = ["[" + ", ".join(f"{x:.4g}" for x in at_m) + "]" for at_m in
           (organ.held_min_m, organ.held_max_m, organ.vertex_m.min(axis=0), organ.vertex_m.max(axis=0))]
    raise run.Failure(f"the held box, elastic.fixed_min_m = {box[0]} to elastic.fixed_max_m = {box[1]}, holds "
                      f"{'every' if held.any() else 'no'} triangle of the organ, which lies in {box[2]} to {box[3]} there; make "
                      "it hold a part (tact-mesh --align proposes one)")


def check_lumps(organ):
    """One at the surface would change the tip's own compliance, which no map has; one outside would not be found."""
    import numpy as np
    for number, lump in enumerate(organ.lumps, 1):
        out_m = organ.vertex_m - lump.center_m
        away_m = np.linalg.norm(out_m, axis=1)
        near = int(away_m.argmin())
        depth_m = out_m[near] @ organ.vertex_normal[near]
        if not depth_m > lump.radius_m:
            raise run.Failure(f"elastic.inclusion {number} of {len(organ.lumps)} has its centre {1e3 * away_m[near]:.3g} mm "
                              f"{'below' if depth_m > 0.0 else 'outside'} the surface at vertex {near} and a radius of "
                              f"{1e3 * lump.radius_m:.3g} mm; move elastic.inclusion.center_m at least its radius below the "
                              "surface")


def median_edge_m(organ):
    import numpy as np
    edge_m = organ.vertex_m[organ.triangle] - organ.vertex_m[np.roll(organ.triangle, -1, axis=1)]
    return float(np.sort(np.linalg.norm(edge_m, axis=2), axis=None)[edge_m.shape[0] * 3 // 2])


def map_bytes(job, organ, radius_m, rows):
    """What model/scene/compliance_file.h says."""
    import numpy as np
    rows = rows.astype("<f4")
    if not np.isfinite(rows).all():
        raise run.Failure(f"{job['out']}: not written, the map holds a value that is no finite number; solve it again with "
                          "another mesh size or patch radius")
    data = struct.pack("<8s4I9d16s", b"TACTCOMP", VERSION, len(rows), rows.shape[1] - 8, job["inclusions_hash"],
                       organ.poisson_ratio, radius_m, job["ring_pitch_m"], *organ.held_min_m, *organ.held_max_m,
                       job["surface_hash"].encode())
    data += b"".join(np.ascontiguousarray(part).tobytes() for part in (rows[:, 0], rows[:, 1:8], rows[:, 8:]))
    checksum = 0xcbf29ce484222325  # FNV-1a
    for byte in data:
        checksum = (checksum ^ byte) * 0x100000001b3 & 0xFFFFFFFFFFFFFFFF
    return data + struct.pack("<Q", checksum)


# Measured: 3000 vertices are 30 000 nodes; the growth is that of nested dissection.
def fill_s(vertices):
    return 3.0 * vertices / 3e3


def factor_s(nodes):
    return 35.0 * (nodes / 3e4)**1.7


def solve_s(vertices, nodes):
    """Of one core."""
    return 120.0 * vertices / 3e3 * (nodes / 3e4)**1.3


def act(job):
    begun_s = time.monotonic()
    import numpy as np

    import body
    import compliance
    import surface
    o = job["organ"]
    organ = body.Organ(*(np.array(o[key]) for key in ("vertex_m", "triangle", "vertex_normal", "fixed_min_m", "fixed_max_m")),
                       youngs_modulus_Pa=1.0, poisson_ratio=o["poisson_ratio"], lumps=tuple(
                           body.Lump(np.array(one["center_m"]), one["radius_m"], one["modulus_ratio"]) for one in job["lumps"]))
    check(organ)
    check_lumps(organ)
    edge_m = median_edge_m(organ)
    size_m = job["mesh_size_m"] or min(MESH_SIZE * edge_m, *(lump.radius_m for lump in organ.lumps), np.inf)
    radius_m = job["patch_radius_m"] or ELEMENTS_IN_PATCH * max(size_m, edge_m)
    job["ring_pitch_m"], rings = job["ring_pitch_m"] or RING_PITCH_M, job["rings"] or RINGS
    with run.folder_of_run():
        vertices, cores = len(organ.vertex_m), len(os.sched_getaffinity(0))
        with run.phase("filling with elements", fill_s(vertices)):
            made = body.make_body(organ, surface.EdgeLengths(np.zeros((1, 3)), 0.0, UNREFINED_M, 0.0, size_m))
        nodes = len(made.node_m)
        with run.phase("factoring", factor_s(nodes)):
            condensed = compliance.Condensation(organ, made, radius_m, job["ring_pitch_m"], rings)
        with run.phase("solving", solve_s(vertices, nodes) / cores):
            rows = condensed.run(cores, "solving")
    data = map_bytes(job, organ, radius_m, rows)
    run.write(pathlib.Path(job["out"]), data)
    report(job, organ, {"rings": rings, "ring_pitch_m": job["ring_pitch_m"], "poisson_ratio": organ.poisson_ratio,
                        "patch_radius_m": radius_m, "mesh_size_m": size_m, "mesh_hash": job["surface_hash"],
                        "nodes": len(made.node_m), "elements": len(made.element)}, np.sort(rows[:, 0]), len(data),
           time.monotonic() - begun_s)


def report(job, organ, facts, r, size, took_s):
    least, median, most = float(r[0]), float(r[len(r) // 2]), float(r[-1])
    if job["json"]:
        print(json.dumps({"format": "tact-condense", "version": 1, "file": job["out"], "bytes": size, "vertices": len(r), **facts,
                          "regular_times_E_per_m": {"least": least, "median": median, "most": most}, "seconds_s": took_s},
                         indent=2), flush=True)
        return
    print(f"{job['out']}: {size} bytes, {len(r)} vertices, {facts['rings']} rings of {1e3 * facts['ring_pitch_m']:.3g} mm, "
          f"nu = {organ.poisson_ratio:.3g}\n"
          f"body   {facts['nodes']} nodes, {facts['elements']} elements of {1e3 * facts['mesh_size_m']:.3g} mm; patch radius "
          f"{1e3 * facts['patch_radius_m']:.3g} mm\n"
          f"r E    {least:.4g} least, {median:.4g} median, {most:.4g} most, 1/m\ntook   {took_s:.0f} s", flush=True)


if __name__ == "__main__":
    sys.exit(run.main(LABEL, act, "nothing was written"))
