# SPDX-License-Identifier: Apache-2.0
"""Solved cases on disk, one file each, found again by everything they depend on.

The key is a text that names mesh, material, held box, site, load, mesh level, method and solver; the file's name is its hash
and the file repeats the whole key. A file that cannot be read counts as absent: the case is solved again.
"""
import hashlib
import json
import pathlib
from dataclasses import asdict, replace

import contact
import finite_strain
import indentation
import tool_press
from run import Failure, write

METHOD = 3  # raise it whenever the same key would give another answer
PROBE_CONTACT = 0.75  # of R at depth R: a little less than a half-space has
FALL_RINGS = 17  # chosen: sixteen steps over a radius


class Cache:
    def __init__(self, folder, organ, solver):
        """solver: names and versions of the programs."""
        self.folder, self.organ, self.solver = pathlib.Path(folder), organ, solver

    def key(self, what, lengths):
        o = self.organ
        return (f"method {METHOD}, {self.solver}; mesh {o.mesh_hash}; E {o.youngs_modulus_Pa} Pa, nu {o.poisson_ratio}; held "
                f"{o.held_min_m.tolist()} to {o.held_max_m.tolist()} m; {what!r}; edges {lengths.fine_m:.9g} m, growth "
                f"{lengths.growth}, to {lengths.largest_m:.9g} m")

    def path(self, key):
        return self.folder / (hashlib.sha256(key.encode()).hexdigest()[:16] + ".json")

    def find(self, key, kind):
        """The objects of a dataclass `kind` that were kept, or None."""
        try:
            kept = json.loads(self.path(key).read_text())
            return [kind(**one) for one in kept["solved"]] if kept["key"] == key else None
        except (OSError, ValueError, LookupError, TypeError):
            return None

    def keep(self, key, solved):
        """Any number of processes may keep the same case: one of them wins, all succeed."""
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            pass  # write says it better
        try:
            write(self.path(key), json.dumps({"key": key, "solved": [asdict(one) for one in solved]}) + "\n")
        except Failure as failure:
            raise Failure(f"{failure.message}, or name another --cache") from None

    def solve(self, what, module, kind):
        """As asked, from the cache or solved and kept."""
        key = self.key(what, module.edge_lengths(self.organ, what))
        solved = self.find(key, kind)
        if solved is None:
            solved = module.solve(self.organ, what)
            self.keep(key, solved)
        return solved

    def case(self, what):
        """The Case of an Indentation. A press without a contact radius is solved coarsely first; that force gives the radius."""
        if what.depth_m > 0.0 and not what.contact_radius_m:  # a bond's radius is the tool's
            probe, radius_m = probe_of(what.vertex, what.tool_radius_m), what.tool_radius_m
            pitch_m = radius_m / (FALL_RINGS - 1)
            tip = contact.TipContact(self.organ.contact_modulus_Pa, radius_m,
                                     contact.surface_fall_m(self.organ, what.vertex, FALL_RINGS, pitch_m), pitch_m)
            compliance_m_per_N = tip.compliance_m_per_N(probe.depth_m, self.case(probe).force_N)
            what = replace(what, contact_radius_m=tip.contact_radius_m(what.depth_m, compliance_m_per_N))
        return self.solve(what, indentation, indentation.Case)[0]

    def tool_cases(self, what):
        return self.solve(what, tool_press, tool_press.ToolCase)

    def finite_cases(self, what):
        return self.solve(what, finite_strain, tool_press.ToolCase)


def probe_of(vertex, tool_radius_m):
    """The coarse solve that every press on a vertex needs first."""
    return indentation.Indentation(vertex, tool_radius_m, tool_radius_m, level=indentation.COARSEST,
                                   contact_radius_m=PROBE_CONTACT * tool_radius_m)
