# SPDX-License-Identifier: Apache-2.0
"""What every FIFO thread of tactd asks of the kernel and suffers from it, per tick, as a table."""


def table(runs):
    """Markdown; empty when no run was traced."""
    lines = []
    for run in runs:
        ticks = run.threads.get(("tact-loop", "sys_clock_nanosleep"), 0)
        for thread in dict.fromkeys(thread for thread, _ in run.threads) if ticks else ():
            per_tick = {what: count / ticks for (of, what), count in run.threads.items() if of == thread}
            calls = ", ".join(f"{what.removeprefix('sys_')} {rate:.2f}" for what, rate in per_tick.items()
                              if what.startswith("sys_"))
            lines.append(f"| {run.case.back_end.name} | {thread} | {calls} | {per_tick['switch']:.2f} | "
                         f"{per_tick['page_fault']:g} | {per_tick['migration']:g} |")
    head = ["| back end | thread | system calls a tick | switches a tick | page faults | "
            "migrations (the guest has one CPU: always 0) |",
            "|---|---|---|---|---|---|"]
    return "\n".join(head + lines) + "\n" if lines else ""
