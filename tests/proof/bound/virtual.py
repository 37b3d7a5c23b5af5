# SPDX-License-Identifier: Apache-2.0
"""Targets of a virtual call: the functions of that name in the classes that the case makes."""
import re

from machine import Refused, run

CALL = re.compile(r"([A-Za-z_]\w*)\s*\(")


class Classes:
    """`classes`: names of classes without their namespace, of which objects exist."""

    def __init__(self, code, classes, lines, root):
        self.code, self.lines, self.root, self.texts = code, lines, root, {}
        tables = code.elf.virtual_tables()
        plain = demangled(tables)
        self.tables = [table for mangled, of in tables.items() if plain[mangled].split("::")[-1] in classes for table in of]
        missing = set(classes) - {name.split("::")[-1] for name in plain.values()}
        if missing:
            raise Refused(f"no class of the program has a virtual table: {', '.join(sorted(missing))}")
        names = {code.name(t) for table in self.tables for t in table if isinstance(t, int) and t in code.lines}
        self.method = {name: text for name, text in zip(sorted(names), demangle(sorted(names)))}

    def resolve(self, function, at):
        """By the slot where the call names it, and by the names that the source line calls."""
        self.lines.load([at])
        slot = self.slot_of(function, at)
        named = {name for file, line in self.lines.at(at)[:1] for name in CALL.findall(self.line(file, line))}
        found = set()
        for table in self.tables:
            for k, target in enumerate(table):
                if isinstance(target, int) and target in self.code.lines and (slot is None or k == slot) \
                        and method_of(self.method[self.code.name(target)]) in named:
                    found.add(target)
        if not found:
            where = ", ".join(f"{file}:{line}" for file, line in self.lines.at(at)[:3])
            raise Refused(f"an indirect call in {function.name} at {at:#x} ({where}): no class of the case has its target")
        return sorted(found)

    def slot_of(self, function, at):
        match = re.match(r"^\*(?:0x([0-9a-f]+))?\(%r\w+\)$", function.text[at].text)
        if match:
            return int(match[1] or "0", 16) // 8
        register = re.match(r"^\*%(r\w+)$", function.text[at].text)
        if not register:
            return None
        return self.loaded(function, at, register[1])

    def loaded(self, function, at, register):
        """The slot that was loaded into a register on every way to the call, or None."""
        before = {}
        for here, afters in function.next.items():
            for after in afters:
                before.setdefault(after, []).append(here)
        slots, seen, waiting = set(), set(), list(before.get(at, []))
        while waiting:
            here = waiting.pop()
            if here in seen:
                continue
            seen.add(here)
            i = function.text[here]
            load = re.match(rf"^(?:0x([0-9a-f]+))?\(%r\w+\),%{register}$", i.text)
            if load and i.op == "mov":
                slots.add(int(load[1] or "0", 16) // 8)
            elif i.text.endswith(f"%{register}") and not i.op.startswith(("cmp", "test", "push")) or here in function.calls:
                return None
            else:
                waiting += before.get(here, [])
        return slots.pop() if len(slots) == 1 else None

    def line(self, file, number):
        if file not in self.texts:
            path = self.root / file
            self.texts[file] = path.read_text().splitlines() if path.is_file() else []
        lines = self.texts[file]
        return lines[number - 1] if 0 < number <= len(lines) else ""


def method_of(text):
    """respond of tact::model::law::TabulatedLaw::respond(double) const."""
    head = text.split("(")[0]
    return head.split("::")[-1]


def demangle(names):
    if not names:
        return []
    return run("c++filt", *names).splitlines()


def demangled(tables):
    """{mangled: name} of classes."""
    mangled = sorted(tables)
    plain = demangle([f"_ZTV{name}" for name in mangled])
    return dict(zip(mangled, (text.removeprefix("vtable for ") for text in plain)))
