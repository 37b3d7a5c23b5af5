# SPDX-License-Identifier: Apache-2.0
"""Wake-up times beside those of cyclictest, which ran in the same guest."""
import statistics

MOST_OVER_PEER = 1.2


def like_peer(runs):
    """Wake-up p99.9 at most 1.2 times that of cyclictest in the same guest, both FIFO 80 at 1 kHz.

    Of several seeds the middle one counts: in about one run of twenty cyclictest's grid, which begins
    anywhere, falls on another timer of the kernel again and again, which adds 2.5 us to that run alone."""
    own_ns = [run.report["phases"]["wake"]["p99.9_ns"] for run in runs if run.report]
    peer_ns = [peer_percentile_ns(run.text("peer.txt"), 0.999) for run in runs if run.report]
    if not own_ns or None in peer_ns:
        return ["no wake-up times to compare with cyclictest's"]
    own, peer = statistics.median(own_ns), statistics.median(peer_ns)
    return [] if own <= MOST_OVER_PEER * peer else [
        f"wake-up p99.9 is {own:.0f} ns, more than {MOST_OVER_PEER} times cyclictest's {peer:.0f} ns"]


def like_peer_too(run):
    """The same of one run, with the same load."""
    return like_peer([run])


def table(runs):
    """Markdown: a row for each run that has both; empty without any."""
    lines = ["| case, seed | tactd | cyclictest | ratio |", "|---|---|---|---|"]
    for run in runs:
        peer_ns = peer_percentile_ns(run.text("peer.txt"), 0.999) if run.report and run.text("peer.txt") else None
        if peer_ns:
            own_ns = run.report["phases"]["wake"]["p99.9_ns"]
            lines.append(f"| {run.name} | {own_ns} ns | {peer_ns} ns | {own_ns / peer_ns:.2f} |")
    return "\n".join(lines) + "\n" if len(lines) > 2 else ""


def peer_percentile_ns(text, share):
    """Least latency such that at least this share of cyclictest's wake-ups is not above it; None
    without a histogram or when values overflowed it."""
    rows = [line.split() for line in text.splitlines() if line[:1].isdigit()]
    total = sum(int(count) for _, count in rows)
    totals = [line for line in text.splitlines() if line.startswith("# Total")]
    if total == 0 or int(totals[0].split()[-1]) != total:
        return None
    seen = 0
    for latency_ns, count in rows:
        seen += int(count)
        if seen >= share * total:
            return int(latency_ns)
    return None
