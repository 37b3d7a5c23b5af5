# SPDX-License-Identifier: Apache-2.0
"""What is said and kept of late ticks: sentences, sums, the trace around them, the sums of each day for tact-jitter history."""
import collections
import datetime
import json
import os
import pathlib

from late_reason import Tick
from late_tracefs import Wrong

MOST_KEPT = 1000  # late ticks; all are counted
MOST_NAMES = 200
MOST_TRACED = 100  # late ticks with all lines of the trace
MOST_DAYS, MOST_OF_A_DAY = 366, 8
TRACE_HEAD = "# tact-jitter late 1 "
HEAD_KEYS = {"thread", "usual_us", *Tick._fields}


class Report:
    """Late ticks, one after the other, and who made how many."""

    def __init__(self, quiet=False):
        self.quiet, self.ticks, self.late = quiet, collections.deque(maxlen=MOST_KEPT), 0
        self.names, self.traced, self.new = {}, collections.deque(maxlen=MOST_TRACED), collections.Counter()

    def add(self, answer, tick, usual_us, lines):
        self.late += 1
        self.ticks.append(answer)
        self.traced.append((answer, tick, usual_us, lines))
        name = full_name(answer)
        if name not in self.names and len(self.names) >= MOST_NAMES:
            name = "others"
        row = self.names.setdefault(name, {"kind": answer["kind"], "ticks": 0, "longest_us": 0.0, "explains_us": 0.0})
        row["ticks"] += 1
        row["longest_us"] = max(row["longest_us"], answer["late_us"])
        row["explains_us"] = round(row["explains_us"] + answer["explains_us"], 1)
        self.new[answer["name"]] += 1
        if not self.quiet:
            print(message(answer), flush=True)

    def summary(self, ticks):
        yield f"{self.late} of {ticks} ticks were late"
        for name, row in sorted(self.names.items(), key=lambda pair: -pair[1]["ticks"]):
            yield f"  {row['ticks']:7}  longest {row['longest_us']:8.0f} us  {name}"

    def to_json(self, program, threshold_us, watching, missing):
        return {"format": "tact-jitter-late", "version": 1, "utc": now().isoformat(timespec="seconds"), "program": program,
                "kernel": os.uname().release, "threshold_us": threshold_us, "period_us": watching.period_ns / 1000,
                "ticks": watching.ticks, "late": self.late, "not_traced": missing, "names": self.names,
                "late_ticks": list(self.ticks)}

    def trace(self, thread):
        """The lines around the newest late ticks, as --from reads them."""
        for answer, tick, usual_us, lines in self.traced:
            head = json.dumps({"thread": thread, "usual_us": usual_us, **tick._asdict()})
            text = "".join(f"{'# lost' if line is None else line}\n" for line in lines)
            yield f"{TRACE_HEAD}{head}\n# {message(answer)}\n{text}"


def read_trace(path):
    """(thread, usual_us, fields of the Tick, lines) of each tick in a file of --trace."""
    try:
        text = pathlib.Path(path).read_text(encoding="latin-1")
        for part in text.split(TRACE_HEAD)[1:]:
            head, *lines = part.removesuffix("\n").split("\n")
            about = json.loads(head)
            if set(about) != HEAD_KEYS or not all(isinstance(value, (int, float)) for value in about.values()):
                raise ValueError("a head is damaged")
            yield (about.pop("thread"), about.pop("usual_us"), about,
                   [None if line == "# lost" else line for line in lines if line == "# lost" or not line.startswith("#")])
    except (OSError, ValueError) as error:
        raise Wrong(f"{path}: {getattr(error, 'strerror', None) or error}; name a file that --trace wrote") from None


def now():
    return datetime.datetime.now(datetime.timezone.utc)


def full_name(answer):
    """With what distinguishes two of the same name."""
    name = answer["name"]
    if answer.get("timer"):
        name += f" ({answer['timer']})"
    if answer.get("thread"):
        name += f" in {answer['thread']}"
    if answer.get("pid"):
        name += f" (pid {answer['pid']}, {answer['priority']})"
    return f"{name} ({answer['meaning']})" if "meaning" in answer else name


def message(answer):
    out = f"{answer['due_ns'] / 1e9:.6f} s: {answer['late_us']:.0f} us late: {full_name(answer)}"
    if answer["kind"] != "not known":
        out += f", {answer.get('duration_us', answer['explains_us']):.0f} us, explains {100 * answer['explains']:.0f} %"
    for key in ("faults", "address", "code_at", "kHz", "meanwhile", "why"):
        if key in answer:
            out += f"; {answer[key] if key in ('meanwhile', 'why') else key + ' ' + str(answer[key])}"
    if answer["skipped"] > 0:
        out += f"; {answer['skipped']} periods skipped"
    if answer["kind"] == "not known" and answer["others"]:
        out += "; seen: " + ", ".join(f"{one['name']} {one['us']:.0f} us" for one in answer["others"])
    return out


def add_to_history(path, report):
    """{date: {name: late ticks}}, for tact-jitter history: a year of days, the most frequent names of each."""
    if not report.new:
        return
    path = pathlib.Path(path)
    try:
        days = json.loads(path.read_text()) if path.exists() else {}
        day = collections.Counter(days.get(now().date().isoformat(), {}))
        day.update(report.new)
        days[now().date().isoformat()] = dict(day.most_common(MOST_OF_A_DAY))
        fresh = path.with_name(path.name + ".new")
        fresh.write_text(json.dumps({date: days[date] for date in sorted(days)[-MOST_DAYS:]}) + "\n")
        fresh.replace(path)
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise Wrong(f"{path}: {getattr(error, 'strerror', None) or error}; remove it, or name another by --history") from None
    report.new.clear()
