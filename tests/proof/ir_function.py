# SPDX-License-Identifier: Apache-2.0
"""One function of LLVM's assembly as lines of C; ir_to_c.py puts them together."""
import re

KIND = {"double": "d", "i64": "q", "i32": "i", "i16": "s", "i8": "b"}
BYTES = {"d": 8, "q": 8, "i": 4, "s": 2, "b": 1}
C_TYPE = {"double": "double", "i64": "uint64_t", "i32": "uint32_t", "i16": "uint16_t", "i8": "uint8_t",
          "i1": "bool"}
SIGNED = {"i64": "int64_t", "i32": "int32_t", "i16": "int16_t", "i8": "int8_t"}
NAME = r'[%@](?:"[^"]*"|[\w.$-]+)'
ARITHMETIC = {"fadd": "ADD", "fsub": "SUB", "fmul": "MUL", "fdiv": "DIV"}
INTEGER = {"add": "+", "sub": "-", "and": "&", "or": "|", "xor": "^", "mul": "*"}
UNSIGNED_ORDER = {"eq": "==", "ne": "!=", "ugt": ">", "uge": ">=", "ult": "<", "ule": "<="}
SIGNED_ORDER = {"sgt": ">", "sge": ">=", "slt": "<", "sle": "<="}
ORDERED = {"oeq": "==", "ogt": ">", "oge": ">=", "olt": "<", "ole": "<="}
UNORDERED = {"une": "==", "ule": ">", "ult": ">=", "uge": "<", "ugt": "<="}  # each is a not
INTRINSIC = {"llvm.fabs.f64": "FABS", "llvm.sqrt.f64": "SQRT", "llvm.maxnum.f64": "FMAX", "llvm.minnum.f64": "FMIN",
             "fmax": "FMAX", "fmin": "FMIN", "sqrt": "SQRT"}


class Unknown(Exception):
    """An instruction, or a use of memory, that this translation does not know."""


def c_name(name):
    return "v_" + re.sub(r"\W", "_", name.lstrip("%@"))


def constant(word, kind):
    if kind == "double":
        if word.startswith("0x"):
            return f"BITS(0x{word[2:]}ull)"
        return f"({word})"
    if word in ("true", "false"):
        return "1" if word == "true" else "0"
    return f"(({C_TYPE[kind]}){word}ll)"


def without_parentheses(text):
    shorter = re.sub(r"\([^()]*\)", "", text)
    return shorter if shorter == text else without_parentheses(shorter)


def name_of(base, offset, kind):
    return f"{base.replace('.', '_')}_{offset}_{kind}"


class Function:
    """One function of the assembly: its text in C, and the places that it uses."""

    def __init__(self, name, signature, body, contracts):
        self.name, self.places, self.values, self.contracts = name, set(), {}, contracts
        self.copies = []
        self.place_of = {}  # pointer: (object, offset)
        for kind, word in re.findall(r"\b(ptr|double|i1|i8|i16|i32|i64)\b[^,]*?(%[\w.]+)(?:,|$)", signature):
            if kind == "ptr":
                self.place_of[word] = (word[1:], 0)
            else:
                self.values[c_name(word)] = kind
        self.parameters = dict(self.values)
        self.blocks = self.split(body)
        self.lines = [line for block in self.blocks for line in self.block(*block)]

    @staticmethod
    def split(body):
        blocks, label = [], "entry"
        lines = []
        for line in body:
            found = re.match(r'^("?[\w.$-]+"?):', line)
            if found:
                if lines:
                    blocks.append((label, lines))
                label, lines = found[1].strip('"'), []
            elif line.strip():
                lines.append(re.sub(r"( #\d+)?(,? !\w+.*)?$", "", line.strip()))
        return [*blocks, (label, lines)]

    def operand(self, word, kind):
        word = word.strip()
        if word.startswith("%"):
            return c_name(word)
        return constant(word, kind)

    def place(self, pointer):
        if pointer not in self.place_of:
            raise Unknown(f"{self.name}: where does {pointer} point?")
        return self.place_of[pointer]

    def slot(self, pointer, kind):
        base, offset = self.place(pointer)
        self.places.add((base, offset, KIND[kind]))
        return f"{base.replace('.', '_')}_{offset}_{KIND[kind]}"

    def block(self, label, lines):
        yield f"l_{re.sub(chr(92) + 'W', '_', label)}: ;"
        for line in lines:
            if " = phi " not in line:
                yield from self.instruction(label, line)

    def assign(self, target, kind, text):
        self.values[c_name(target)] = kind
        return [f"{c_name(target)} = {text};"]

    def edges(self, label, to):
        """What each phi of the block `to` gets from here; all at once, then the jump."""
        given = []
        for name, lines in self.blocks:
            if name != to:
                continue
            for line in lines:
                found = re.match(rf"^({NAME}) = phi (\w+) (.*)$", line)
                if not found:
                    continue
                for word, origin in re.findall(r"\[ ([^,]+), %(\"[^\"]*\"|[\w.$-]+) \]", found[3]):
                    if origin.strip('"') == label:
                        given.append((found[1], found[2], self.operand(word, found[2])))
                        break
                else:
                    raise Unknown(f"{self.name}: no value from {label}: {line}")
        before = [f"{C_TYPE[kind]} t{i} = {value};" for i, (_, kind, value) in enumerate(given)]
        after = []
        for i, (target, kind, _) in enumerate(given):
            after += self.assign(target, kind, f"t{i}")
        jump = f"goto l_{re.sub(chr(92) + 'W', '_', to)};"
        return "{ " + " ".join([*before, *after, jump]) + " }"

    def instruction(self, label, line):
        for pattern, act in PATTERNS:
            found = pattern.match(line)
            if found:
                return act(self, label, *found.groups())
        raise Unknown(f"{self.name}: {line}")

    # One method an instruction; each gives lines of C.
    def do_alloca(self, _, target):
        self.place_of[target] = (self.name + "_" + re.sub(r"\W", "_", target[1:]), 0)
        return []

    def do_gep(self, _, target, base, offset):
        name, at = self.place(base)
        self.place_of[target] = (name, at + int(offset))
        return []

    def do_load(self, _, target, kind, pointer):
        return self.assign(target, kind, self.slot(pointer, kind))

    def do_store(self, _, kind, value, pointer):
        return [f"{self.slot(pointer, kind)} = {self.operand(value, kind)};"]

    def do_arithmetic(self, _, target, what, left, right):
        if what == "fmul" and left == right:
            return self.assign(target, "double", f"SQUARE({self.operand(left, 'double')})")
        return self.assign(target, "double",
                           f"{ARITHMETIC[what]}({self.operand(left, 'double')}, {self.operand(right, 'double')})")

    def do_fneg(self, _, target, word):
        return self.assign(target, "double", f"-{self.operand(word, 'double')}")

    def do_integer(self, _, target, what, kind, left, right):
        text = f"{self.operand(left, kind)} {INTEGER[what]} {self.operand(right, kind)}"
        return self.assign(target, kind, f"({C_TYPE[kind]})({text})")

    def do_fcmp(self, _, target, order, left, right):
        a, b = self.operand(left, "double"), self.operand(right, "double")
        if order in ORDERED:
            text = f"({a} {ORDERED[order]} {b})"
        elif order in UNORDERED:
            text = f"!({a} {UNORDERED[order]} {b})"
        else:
            text = {"one": f"({a} < {b} || {a} > {b})", "ueq": f"!({a} < {b} || {a} > {b})",
                    "uno": f"({a} != {a} || {b} != {b})", "ord": f"({a} == {a} && {b} == {b})"}[order]
        return self.assign(target, "i1", text)

    def do_icmp(self, _, target, order, kind, left, right):
        a, b = self.operand(left, kind), self.operand(right, kind)
        if order in SIGNED_ORDER:
            text = f"({SIGNED[kind]}){a} {SIGNED_ORDER[order]} ({SIGNED[kind]}){b}"
        else:
            text = f"{a} {UNSIGNED_ORDER[order]} {b}"
        return self.assign(target, "i1", text)

    def do_select(self, _, target, choice, kind, yes, no):
        text = f"{self.operand(choice, 'i1')} ? {self.operand(yes, kind)} : {self.operand(no, kind)}"
        return self.assign(target, kind, text)

    def do_cast(self, _, target, what, kind, word, to):
        word = self.operand(word, kind)
        if what in ("sext", "sitofp") and kind != "i1":
            word = f"({SIGNED[kind]}){word}"
        elif what in ("sext", "sitofp"):
            raise Unknown(f"{self.name}: {what} of i1")
        if to == "i1":
            word = f"{word} & 1"
        return self.assign(target, to, f"({C_TYPE[to]})({word})")

    def do_br(self, label, to):
        return [self.edges(label, to.strip('"'))]

    def do_branch(self, label, choice, yes, no):
        return [f"if ({self.operand(choice, 'i1')}) {self.edges(label, yes.strip(chr(34)))}",
                f"else {self.edges(label, no.strip(chr(34)))}"]

    def do_ret(self, _, kind, word):
        self.returns = kind
        return [f"return {self.operand(word, kind)};"]

    def do_ret_void(self, _):
        self.returns = None
        return ["return;"]

    def do_memset(self, _, pointer, size):
        base, offset = self.place(pointer)
        return [("zero", base, offset, int(size))]

    def do_memcpy(self, _, to, origin, size):
        copy = ("copy", *self.place(to), *self.place(origin), int(size))
        self.copies.append(copy)
        return [copy]

    def do_call(self, _, target, kind, name, words):
        if name in self.contracts:
            return self.assign(target, kind, self.contract(name, words))
        operands = [self.operand(word.split()[-1], kind) for word in words.split(",")]
        if name in INTRINSIC:
            return self.assign(target, kind, f"{INTRINSIC[name]}({', '.join(operands)})")
        if name in ("llvm.smax.i64", "llvm.smin.i64"):
            a, b = (f"(int64_t){o}" for o in operands)
            return self.assign(target, kind, f"{a} {'>' if 'max' in name else '<'} {b} ? {operands[0]} : {operands[1]}")
        raise Unknown(f"{self.name}: calls {name}")

    def do_call_void(self, _, name, words):
        if name not in self.contracts:
            raise Unknown(f"{self.name}: calls {name}")
        return [self.contract(name, words) + ";"]

    def contract(self, name, words):
        """The call of a function that has a contract. A pointer is given as the addresses of the
        numbers behind it, by their count, or as the offset that it has in its object: "at"."""
        short, pointers = self.contracts[name]
        pointers, given = list(pointers), []
        for word in without_parentheses(words).split(","):
            kind, name = word.split()[0], word.split()[-1]
            if kind != "ptr":
                given.append(self.operand(name, kind))
                continue
            (base, offset), behind = self.place(name), pointers.pop(0)
            if behind == "at":
                given.append(str(offset))
                continue
            for at in range(offset, offset + 8 * behind, 8):
                self.places.add((base, at, "d"))
                given.append("&" + name_of(base, at, "d"))
        return f"{short}({', '.join(given)})"

    def do_nothing(self, _, *rest):
        return []


W = r"([^,]+)"
PATTERNS = [(re.compile(pattern + "$"), act) for pattern, act in [
    (rf"({NAME}) = alloca .*", Function.do_alloca),
    (rf"({NAME}) = getelementptr .*i8, ptr ({NAME}), i64 (-?\d+)", Function.do_gep),
    (rf"({NAME}) = load (\w+), ptr ({NAME}), align \d+", Function.do_load),
    (rf"store (\w+) {W}, ptr ({NAME}), align \d+", Function.do_store),
    (rf"({NAME}) = (fadd|fsub|fmul|fdiv) double {W}, {W}", Function.do_arithmetic),
    (rf"({NAME}) = fneg double {W}", Function.do_fneg),
    (rf"({NAME}) = (add|sub|and|or|xor|mul)(?: nuw| nsw| disjoint)* (\w+) {W}, {W}", Function.do_integer),
    (rf"({NAME}) = fcmp (\w+) double {W}, {W}", Function.do_fcmp),
    (rf"({NAME}) = icmp(?: samesign)? (\w+) (\w+) {W}, {W}", Function.do_icmp),
    (rf"({NAME}) = select i1 {W}, (\w+) {W}, \w+ {W}", Function.do_select),
    (rf"({NAME}) = (zext|sext|trunc|uitofp|sitofp)(?: nneg| nuw| nsw)* (\w+) {W} to (\w+)", Function.do_cast),
    (r"br label %(\S+)", Function.do_br),
    (rf"br i1 {W}, label %(\S+), label %(\S+)", Function.do_branch),
    (r"ret void", Function.do_ret_void),
    (r"ret (\w+) (\S+)", Function.do_ret),
    (rf"(?:tail )?call void @llvm\.memset\.[\w.]+\(ptr .*?({NAME}), i8 0, i64 (\d+), i1 false\)", Function.do_memset),
    (rf"(?:tail )?call void @llvm\.memcpy\.[\w.]+\(ptr .*?({NAME}), ptr .*?({NAME}), i64 (\d+), i1 false\)",
     Function.do_memcpy),
    (r"(?:tail )?call void @llvm\.(?:lifetime|experimental\.noalias)\..*", Function.do_nothing),
    (rf"({NAME}) = (?:tail )?call (?:noundef |zeroext )*(\w+) @([\w.]+)\((.*)\)", Function.do_call),
    (r"(?:tail )?call void @([\w.]+)\((.*)\)", Function.do_call_void),
]]
