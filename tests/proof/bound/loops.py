# SPDX-License-Identifier: Apache-2.0
"""The loops of a control-flow graph, by strongly connected parts: what is left of one without the edges to its header
holds the loops inside it."""
import collections

from machine import Refused

# `is_plain`: one way in and one way back. Else two loops of the source may have become one cycle.
Loop = collections.namedtuple("Loop", "header back blocks is_plain")


def components(blocks, after):
    """Strongly connected sets of more than one block or with an edge to itself (Tarjan)."""
    index, low, on, stack, found, count = {}, {}, set(), [], [], 0
    for start in blocks:
        if start in index:
            continue
        work = [(start, iter(after[start]))]
        index[start] = low[start] = count
        count += 1
        stack.append(start)
        on.add(start)
        while work:
            here, rest = work[-1]
            for b in rest:
                if b not in index:
                    index[b] = low[b] = count
                    count += 1
                    stack.append(b)
                    on.add(b)
                    work.append((b, iter(after[b])))
                    break
                if b in on:
                    low[here] = min(low[here], index[b])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[here])
                if low[here] == index[here]:
                    part = set(stack[stack.index(here):])
                    del stack[stack.index(here):]
                    on -= part
                    if len(part) > 1 or here in after[here]:
                        found.append(part)
    return found


def loops(entry, edges, where):
    """All loops, outer ones first. A cycle with two entries has a block that each pass goes through, or is refused."""
    found, waiting = [], components(sorted(edges), edges)
    while waiting:
        part = waiting.pop()
        entries = {a for b, afters in edges.items() if b not in part for a in afters if a in part} | ({entry} & part)
        inside = {b: [a for a in edges[b] if a in part] for b in part}
        header = next(iter(entries)) if len(entries) == 1 else common_block(part, entries, inside, where)
        back = sorted((b, header) for b in part if header in inside[b])
        found.append(Loop(header, back, part, len(entries) == 1 and len(back) == 1))
        waiting += without(part, {header}, inside)
    return sorted(found, key=lambda loop: -len(loop.blocks))


def common_block(part, entries, inside, where):
    """A block on all cycles through an entry, and on no other cycle."""
    inner = without(part, entries, inside)
    for header in sorted(part - set().union(*inner)):
        if sorted(map(sorted, without(part, {header}, inside))) == sorted(map(sorted, inner)):
            return header
    raise Refused(f"a cycle with two entries in {where}, at {min(part):#x}")


def without(part, headers, inside):
    """The cycles that are left without the edges to these blocks."""
    return components(sorted(part), {b: [a for a in afters if a not in headers] for b, afters in inside.items()})


def parent(loop, all_loops):
    """The smallest other loop around this one, or None."""
    around = [o for o in all_loops if loop.blocks < o.blocks]
    return min(around, key=lambda o: len(o.blocks)) if around else None


def entering(entry, edges, loop):
    """The edges into a loop from outside; True as well: the function begins in it."""
    return [(b, a) for b, afters in edges.items() if b not in loop.blocks for a in afters if a in loop.blocks], \
        entry in loop.blocks
