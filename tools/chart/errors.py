# SPDX-License-Identifier: Apache-2.0
"""How far a law is from the reference, in numbers: pure functions over what was measured.

force   e = F - F_ref;        RMS and worst over sites and depths, of the peak |F_ref|
local   e of a press over |F_ref| of the same place and depth: light touch counts as much as a deep press
shape   e_j = u_j - u_ref,j;  RMS over the rings of a case, of its |depth|; then RMS and worst over the cases

Press and pull count alike. A case counts as right where |e| is within what a hand notices, 7 % of |F_ref|.
"""
import math

LOCAL_DEPTHS_M = {"1mm": 0.001, "2mm": 0.002, "5mm": 0.005, "10mm": 0.010}
SAME_DEPTH_M = 1e-6
SAME_TIME_RATIO = 0.10  # medians of one machine within this of each other are one time


def rms(values):
    """NaN of nothing."""
    values = list(values)
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else math.nan


def largest(values):
    """In size, with its sign; NaN of nothing."""
    return max(values, key=abs, default=math.nan)


def over(value, size):
    return value / size if size else math.inf if value else math.nan


def shape_error(sample):
    pairs = zip(sample["ring_m"], sample["reference_ring_m"])
    return rms((a - b) / sample["depth_m"] for a, b in pairs if a is not None and b is not None)


def summarize(samples, noticeable):
    """Of one sphere, by the names of the chart's columns."""
    e = [s["force_N"] - s["reference_N"] for s in samples]
    size = [abs(s["reference_N"]) for s in samples]
    peak = max(size, default=math.nan)
    of_peak = [over(error, peak) for error in e]
    local = [over(error, own) for error, own in zip(e, size)]
    sites = {s["site"] for s in samples}

    def of(values, wanted):
        return [value for value, s in zip(values, samples) if wanted(s)]

    def of_site(site):
        own_peak = max(of(size, lambda s: s["site"] == site))
        return rms(over(error, own_peak) for error in of(e, lambda s: s["site"] == site))

    shape = [error for error in map(shape_error, samples) if math.isfinite(error)]
    return {
        "force_rms_ratio": rms(of_peak),
        "force_worst_ratio": max(map(abs, of_peak), default=0.0),
        "press_rms_ratio": rms(of(of_peak, lambda s: s["depth_m"] > 0)),
        "pull_rms_ratio": rms(of(of_peak, lambda s: s["depth_m"] <= 0)),
        "held_out_rms_ratio": rms(of(of_peak, lambda s: s["held_out"])),
        "worst_site_rms_ratio": max(map(of_site, sites), default=0.0),
        **{f"own_worst_{mm}_ratio": largest(of(local, lambda s: abs(s["depth_m"] - depth) <= SAME_DEPTH_M))
           for mm, depth in LOCAL_DEPTHS_M.items()},
        "own_worst_ratio": max(map(abs, of(local, lambda s: s["depth_m"] > 0)), default=0.0),
        "within_jnd_ratio": over(sum(abs(x) <= noticeable for x in local), len(samples)),
        "shape_rms_ratio": rms(shape),
        "shape_worst_ratio": max(shape, default=0.0),
        "cases": len(samples)}


def tool_samples(forces_N, places):
    """Each force of the whole tool with its place and depth."""
    return [{"at": at, "place": place["place"], "unseen": place["unseen"], "force_N": force, **case,
             "local": over(force, case["reference_N"]) - 1.0}
            for force, (at, place, case) in zip(forces_N, ((at, place, case) for at, place in enumerate(places)
                                                           for case in place["cases"]))]


def summarize_tool(samples, noticeable):
    """Of the whole tool; `place_rms_ratio` is of each place's own peak, `own_worst_ratio` of each depth with its sign."""
    def errors(wanted, peak):
        return [over(s["force_N"] - s["reference_N"], peak) for s in wanted]

    def peak_of(wanted):
        return max(abs(s["reference_N"]) for s in wanted)

    peak = peak_of(samples)
    places = {s["at"]: [other for other in samples if other["at"] == s["at"]] for s in samples}
    depths = dict.fromkeys(s["depth_m"] for s in samples)
    own = {depth: largest(s["local"] for s in samples if s["depth_m"] == depth) for depth in depths}
    return {"force_rms_ratio": rms(errors(samples, peak)),
            "force_worst_ratio": max(map(abs, errors(samples, peak))),
            "unseen_rms_ratio": rms(errors([s for s in samples if s["unseen"]], peak)),
            "within_jnd_ratio": sum(abs(s["local"]) <= noticeable for s in samples) / len(samples),
            "own_worst_ratio": own,
            "own_largest_ratio": max(map(abs, own.values())),
            "place_rms_ratio": {of[0]["place"]: rms(errors(of, peak_of(of))) for of in places.values()}}


def front_of(points):
    """Of (time, error): the points that no other beats in both, fastest first; of equal points the first."""
    front = []
    for at in sorted((i for i, p in enumerate(points) if all(map(math.isfinite, p))), key=lambda i: (*points[i], i)):
        if not front or points[at][1] < points[front[-1]][1]:  # what is slower has to be nearer to be worth it
            front.append(at)
    return front
