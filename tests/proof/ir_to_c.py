# SPDX-License-Identifier: Apache-2.0
"""From LLVM's assembly of a function without loops to C that a prover reads.

    translate(assembly, functions, contracts) -> C text

Each place of memory that an instruction uses is a variable of its own, named by the parameter it
belongs to, its offset in bytes and its type: the double at byte 592 of `%gate` is `gate_592_d`. So
the prover sees numbers alone, no pointers. A function of `contracts` is not translated but called by
the name and with the pointers that are given there. What is not understood raises Unknown: no
instruction is skipped. Arithmetic is left to the functions ADD, SUB, MUL, SQUARE, DIV, SQRT of arithmetic.h.
"""
import re

from ir_function import BYTES, C_TYPE, KIND, Function, Unknown, name_of, without_parentheses


def functions_of(assembly, names, contracts):
    lines, at = assembly.splitlines(), 0
    while at < len(lines):
        found = re.match(r"^define .*?@([\w.]+)\((.*)\).*\{$", lines[at])
        if found:
            end = lines.index("}", at)
            if found[1] in names:
                yield Function(found[1], without_parentheses(found[2]), lines[at + 1:end],
                               contracts)
            at = end
        at += 1


def spread(functions):
    """The places of all functions: a copy of memory makes those of its source in its target, and back."""
    places = set().union(*(f.places for f in functions))
    grew = True
    while grew:
        size = len(places)
        for f in functions:
            for _, to, to_at, origin, at, count in f.copies:
                for base, offset, kind in list(places):
                    if base == origin and at <= offset < at + count:
                        places.add((to, offset - at + to_at, kind))
                    if base == to and to_at <= offset < to_at + count:
                        places.add((origin, offset - to_at + at, kind))
        grew = len(places) > size
    ordered = sorted(places)
    for (base, offset, kind), (other, start, _) in zip(ordered, ordered[1:]):
        if base == other and offset + BYTES[kind] > start:
            raise Unknown(f"{base}: what lies at {offset} is read as two types")
    return ordered


def lines_of(line, places):
    if isinstance(line, str):
        yield line
    elif line[0] == "zero":
        _, base, at, size = line
        for other, offset, kind in places:
            if other == base and at <= offset < at + size:
                yield f"{name_of(base, offset, kind)} = 0;"
    else:
        _, to, to_at, origin, at, size = line
        for other, offset, kind in places:
            if other == origin and at <= offset < at + size:
                yield f"{name_of(to, offset - at + to_at, kind)} = {name_of(origin, offset, kind)};"


def translate(assembly, names, contracts):
    functions = list(functions_of(assembly, names, contracts))
    missing = set(names) - {f.name for f in functions}
    if missing:
        raise Unknown(f"no function {', '.join(sorted(missing))}")
    places = spread(functions)
    types = {kind: C_TYPE[name] for name, kind in KIND.items()}
    text = [f"{types[kind]} {name_of(base, offset, kind)};" for base, offset, kind in places]
    text.append("static void forget(void) {")
    text += [f"{name_of(*place)} = ANY({types[place[2]]});" for place in places]
    text.append("}")
    text.append("#ifdef TACT_COPIES")  # for same.cc: what each place holds, and whether it is the same
    for base in sorted({place[0] for place in places}):
        mine = [place for place in places if place[0] == base]
        word = base.replace(".", "_")
        text.append(f"static void load_{word}(const char* from) {{")
        text += [f"memcpy(&{name_of(*place)}, from + {place[1]}, {BYTES[place[2]]});" for place in mine]
        text.append(f"}}\nstatic bool is_same_{word}(const char* as) {{\nreturn true")
        text += [f"&& is_same(&{name_of(*place)}, as + {place[1]}, {BYTES[place[2]]})" for place in mine]
        text.append(";\n}")
    text.append("#endif")
    for f in functions:
        parameters = ", ".join(f"{C_TYPE[kind]} {name}" for name, kind in f.parameters.items()) or "void"
        text.append(f"{C_TYPE[f.returns] if f.returns else 'void'} {f.name}({parameters}) {{")
        text += [f"{C_TYPE[kind]} {name};" for name, kind in f.values.items() if name not in f.parameters]
        for line in f.lines:
            text += lines_of(line, places)
        text.append("}")
    return "\n".join(text) + "\n"
