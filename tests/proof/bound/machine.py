# SPDX-License-Identifier: Apache-2.0
"""The code of a program: its functions as blocks of instructions, with jump tables and virtual tables."""
import bisect
import collections
import re
import struct
import subprocess

LINE = re.compile(r"^\s*([0-9a-f]+):\t(\S+)\s*(.*)$")
HEAD = re.compile(r"^([0-9a-f]+) <(.*)>:$")
DIRECT = re.compile(r"^([0-9a-f]+)(?: <([^>+]+(?:@plt)?)(\+0x[0-9a-f]+)?>)?$")
PREFIXES = {"bnd", "notrack", "lock", "rep", "repz", "repnz", "data16", "cs"}
REPEATED = ("movs", "stos", "cmps", "scas", "lods")

Instruction = collections.namedtuple("Instruction", "at op text prefixes")


class Refused(Exception):
    """Code that this tool cannot bound; the text says which and where."""


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Elf:
    """Sections, relocations and symbols of a 64-bit little-endian file."""

    def __init__(self, path):
        self.path = str(path)
        with open(path, "rb") as file:
            self.data = file.read()
        start, size, count, names = (struct.unpack_from("<Q", self.data, 0x28)[0],
                                     *struct.unpack_from("<HHH", self.data, 0x3a))
        heads = [struct.unpack_from("<IIQQQQIIQQ", self.data, start + i * size) for i in range(count)]
        self.sections = [h for h in heads if h[3]]  # with an address
        text = heads[names]
        self.names = {h[3]: self.data[text[4] + h[0]:].split(b"\0", 1)[0].decode() for h in self.sections}
        self.pointer = {}  # address -> address that the loader writes there, or the name of a symbol
        for line in run("objdump", "-R", self.path).splitlines():
            words = line.split()
            if len(words) == 3 and words[1] == "R_X86_64_RELATIVE":
                self.pointer[int(words[0], 16)] = int(words[2].rpartition("+")[2], 16)
            elif len(words) == 3 and words[1].startswith("R_X86_64_"):
                self.pointer[int(words[0], 16)] = re.split("[@+]", words[2])[0]
        self.symbols = collections.defaultdict(list)
        self.sizes = {}
        for line in run("nm", "-S", "--defined-only", self.path).splitlines():
            words = line.split()
            if len(words) == 4:
                self.symbols[int(words[0], 16)].append(words[3])
                self.sizes[words[3]] = (int(words[0], 16), int(words[1], 16))

    def bytes_at(self, address, count):
        for _, kind, _, begin, offset, size, *_ in self.sections:
            if kind == 1 and begin <= address and address + count <= begin + size:
                return self.data[offset + address - begin:offset + address - begin + count]
        raise Refused(f"no bytes at {address:#x}")

    def virtual_tables(self):
        """{mangled class: [[target, ...] of each table]}; a slot that the loader does not fill ends a table."""
        tables = {}
        for name, (begin, size) in self.sizes.items():
            if not name.startswith("_ZTV"):
                continue
            groups = [[]]
            for at in range(begin + 16, begin + size, 8):
                target = self.pointer.get(at)
                if target is None and struct.unpack("<q", self.bytes_at(at, 8))[0] < 0:
                    groups.append([])  # offset to the top: a further base
                else:
                    groups[-1].append(target)
            tables[name[4:]] = [groups[0]] + [group[1:] for group in groups[1:]]
        return tables


class Code:
    """The instructions of a program, a function at a time."""

    def __init__(self, path):
        self.elf = Elf(path)
        self.lines = {}  # address of a symbol -> its lines of text
        here = None
        for line in run("objdump", "-d", "-w", "--no-show-raw-insn", self.elf.path).splitlines():
            if line.endswith(">:"):
                head = HEAD.match(line)
                here = self.lines.setdefault(int(head[1], 16), [head[2]])
            elif here is not None and line.startswith(" "):
                here.append(line)
        self.starts = sorted(self.lines)
        self.parsed = {}

    def symbol_of(self, address):
        return self.starts[bisect.bisect_right(self.starts, address) - 1]

    def name(self, address):
        return self.lines[address][0]

    def is_part(self, address):
        """A part of a function that the compiler has moved away, not a function."""
        return re.search(r"\.cold(\.\d+)?$", self.name(address)) is not None

    def instruction(self, address):
        start = self.symbol_of(address)
        if start not in self.parsed:
            table = [parse(line) for line in self.lines[start][1:]]
            self.parsed[start] = {i.at: (i, after.at if after else None)
                                  for i, after in zip(table, table[1:] + [None])}
        found = self.parsed[start].get(address)
        if found is None:
            raise Refused(f"no instruction at {address:#x} in {self.name(start)}")
        return found


def parse(line):
    match = LINE.match(line)
    if not match:
        raise Refused(f"not understood: {line}")
    op, text, prefixes = match[2], match[3], []
    while op in PREFIXES:
        prefixes.append(op)
        op, _, text = text.partition(" ")
        text = text.strip()
    return Instruction(int(match[1], 16), op, text.strip(), tuple(prefixes))


class Function:
    """Blocks and edges of one function; what it calls."""

    def __init__(self, code, entry, until=None):
        """`until`: the address of a call with which the function counts as left."""
        self.code, self.entry, self.until = code, entry, until
        self.name = code.name(code.symbol_of(entry))
        self.next = {}  # address of an instruction -> addresses that may follow in this function
        self.calls = {}  # address -> address, name of an imported function, or None: indirect
        self.text = {}
        waiting = [entry]
        while waiting:
            at = waiting.pop()
            if at in self.next:
                continue
            self.text[at], after = code.instruction(at)
            self.next[at] = self.successors(self.text[at], after)
            waiting += self.next[at]
        self.exits = {at for at, after in self.next.items() if not after}
        self.make_blocks()

    def successors(self, i, after):
        if i.op in ("ret", "retq"):
            return []
        if i.op in ("ud2", "hlt"):
            self.calls[i.at] = "trap"
            return []
        if i.op in ("call", "callq"):
            self.calls[i.at] = self.target(i)
            return [after] if after is not None and i.at != self.until else []
        if i.op in ("jmp", "jmpq"):
            return self.jump(i)
        if i.op.startswith("j") or i.op.startswith("loop"):
            target = self.target(i)
            if self.is_own(target):
                return [after, target]
            raise Refused(f"a conditional jump out of {self.name} at {i.at:#x}: {i.text}")
        if after is None:
            raise Refused(f"{self.name} runs out of its end at {i.at:#x}")
        return [after]

    def is_own(self, target):
        """False: the start of another function, or an imported one."""
        return isinstance(target, int) and (target == self.entry or target not in self.code.lines or
                                            self.code.is_part(target))

    def target(self, i):
        """Of a call or jump: an address, the name of an imported function, or None."""
        direct = DIRECT.match(i.text)
        if direct and direct[2] and direct[2].endswith("@plt"):
            return direct[2][:-len("@plt")]
        if direct:
            return int(direct[1], 16)
        slot = re.match(r"^\*0x[0-9a-f]+\(%rip\)\s+# ([0-9a-f]+)", i.text)
        if slot:  # through the table of imported names
            return self.code.elf.pointer.get(int(slot[1], 16))
        return None

    def jump(self, i):
        target = self.target(i)
        if target is None:
            return self.jump_table(i)
        if self.is_own(target):
            return [target]
        self.calls[i.at] = target  # the last call of the function
        return []

    def jump_table(self, i):
        """Offsets from the table's own address, as far as they lead into this function."""
        before = self.window(i.at, 16)
        for j in reversed(before):
            table = re.search(r"\(%rip\),%\w+\s+# ([0-9a-f]+)", j.text) if j.op == "lea" else None
            if table and any(k.op == "movslq" and ",4)" in k.text for k in before):
                begin = int(table[1], 16)
                return sorted(self.entries(begin)) or self.refuse(i)
        if i.text.startswith("*%") or "(%r" in i.text:  # the last call of a virtual function
            self.calls[i.at] = None
            return []
        return self.refuse(i)

    def refuse(self, i):
        raise Refused(f"an indirect jump in {self.name} at {i.at:#x}: {i.text}")

    def entries(self, begin):
        found, own = set(), self.code.symbol_of(self.entry)
        for k in range(4096):
            try:
                target = begin + struct.unpack("<i", self.code.elf.bytes_at(begin + 4 * k, 4))[0]
            except Refused:
                break
            start = self.code.symbol_of(target) if target >= self.code.starts[0] else None
            base = self.name.split(".")[0]
            if start != own and not (start and self.code.is_part(start) and self.code.name(start).split(".")[0] == base):
                break
            found.add(target)
        return found

    def window(self, at, count):
        """The instructions before an address, by address."""
        start = self.code.symbol_of(at)
        self.code.instruction(at)
        return [i for i, _ in self.code.parsed[start].values() if i.at < at][-count:]

    def make_blocks(self):
        heads = {self.entry}
        came = collections.Counter(t for after in self.next.values() for t in after)
        for at, after in self.next.items():
            if len(after) != 1:
                heads.update(after)
            heads.update(t for t in after if came[t] > 1)
        self.block = {}  # head -> instructions
        for head in heads:
            body = [head]
            while len(self.next[body[-1]]) == 1 and self.next[body[-1]][0] not in heads:
                body.append(self.next[body[-1]][0])
            self.block[head] = body
        self.edges = {head: sorted(set(self.next[body[-1]])) for head, body in self.block.items()}

    def length(self, head):
        """Instructions of a block; a repeated one counts as often as its counter says."""
        body = self.block[head]
        return sum(self.repeats(at, body[:k]) for k, at in enumerate(body))

    def repeats(self, at, before):
        i = self.text[at]
        if not i.op.startswith(REPEATED) or not set(i.prefixes) & {"rep", "repz", "repnz"}:
            return 1
        for j in (self.text[k] for k in reversed(before)):
            constant = re.match(r"^\$0x([0-9a-f]+),%[er]cx$", j.text)
            if constant and j.op.startswith("mov"):
                return int(constant[1], 16)
            if re.search(r"%[er]?cx$", j.text) or j.op.startswith("call"):
                break
        raise Refused(f"a repeated instruction of unknown length in {self.name} at {at:#x}: {i.op} {i.text}")
