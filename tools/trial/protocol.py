# SPDX-License-Identifier: Apache-2.0
"""A protocol as TOML: what is compared, in which blocks and orders. Errors are sentences: what, where, what to write."""
import dataclasses
import hashlib
import pathlib
import random
import tomllib

from methods import METHODS, SETTINGS

NEEDED = object()
TOP = {"name": (str, NEEDED), "scene": (str, NEEDED), "seed": (int, NEEDED), "parameter": (str, NEEDED), "task": (str, "2ifc"),
       "question": (str, "Which was stiffer, 1 or 2?"), "interval_s": (float, 0.0), "pause_s": (float, 0.0),
       "order": (str, "random"), "block": (list, NEEDED)}
BLOCK = {"name": (str, NEEDED), "reference": (float, NEEDED), "method": (str, NEEDED), "repeats_of_block": (int, 1),
         "set": (dict, {})}


class Wrong(Exception):
    """A sentence: what, where, what to write."""


@dataclasses.dataclass
class Block:
    name: str
    reference: float
    method: str
    repeats_of_block: int
    set: dict
    settings: dict


@dataclasses.dataclass
class Protocol:
    path: pathlib.Path
    digest: str
    name: str
    scene: pathlib.Path
    seed: int
    parameter: str
    task: str
    question: str
    interval_s: float
    pause_s: float
    order: str
    block: list

    def run_order(self):
        """Blocks as they run, and the random numbers of intervals and levels, by the seed."""
        rng = random.Random(self.seed)
        blocks = [block for block in self.block for _ in range(block.repeats_of_block)]
        if self.order == "random":
            rng.shuffle(blocks)
        return blocks, rng


def take(table, keys, where):
    """The values of the keys, checked for their type."""
    for key in table:
        if key not in keys:
            raise Wrong(f"{where}: knows no {key}; one of {', '.join(keys)}")
    out = {}
    for key, (kind, default) in keys.items():
        value = table.get(key, default)
        if value is NEEDED:
            raise Wrong(f"{where}: has no {key}; write {key} = {'...' if kind is not str else chr(34) + '...' + chr(34)}")
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if not isinstance(value, kind) or isinstance(value, bool):
            raise Wrong(f"{where}: {key} = {value!r} is no {kind.__name__}")
        out[key] = value
    return out


def settings_of(table, method, where):
    """Of the method, checked against their ranges."""
    out = {}
    for key in table:
        if key not in SETTINGS[method]:
            raise Wrong(f"{where}: {method} knows no {key}; one of {', '.join(SETTINGS[method])}")
    for key, (default, least, most) in SETTINGS[method].items():
        value = table.get(key, default)
        if value is None:
            raise Wrong(f"{where}: {method} needs {key}, {least:g} to {most:g}")
        many = value if key == "levels" and isinstance(value, list) and value else [value]
        for one in many:
            if not isinstance(one, (int, float)) or isinstance(one, bool) or not least <= size(key, one) <= most:
                raise Wrong(f"{where}: {key} = {value!r} must be {'a list of ' if key == 'levels' else ''}{least:g} to {most:g}"
                            f"{', or -0.9 to -0.001 where the comparison is the smaller' if key == 'levels' else ''}")
            if isinstance(default, int) and not isinstance(one, int):
                raise Wrong(f"{where}: {key} = {value!r} must be whole")
        out[key] = many if key == "levels" else value
    return out


def size(key, value):
    """A level may be below 0, down to -0.9: then the comparison is the smaller one."""
    return -value if key == "levels" and -0.9 <= value < 0.0 else value


def block_of(table, where):
    if not isinstance(table, dict):
        raise Wrong(f"{where}: is no table; write [[block]]")
    found = take({key: value for key, value in table.items() if key in BLOCK}, BLOCK, where)
    if found["method"] not in METHODS:
        raise Wrong(f"{where}: method = {found['method']!r} is none of {', '.join(METHODS)}")
    if not found["reference"] > 0.0:
        raise Wrong(f"{where}: reference = {found['reference']:g} must be above 0")
    if found["repeats_of_block"] < 1:
        raise Wrong(f"{where}: repeats_of_block = {found['repeats_of_block']} must be 1 or more")
    own = {key: value for key, value in table.items() if key not in BLOCK}
    return Block(**found, settings=settings_of(own, found["method"], where))


def read(path):
    path = pathlib.Path(path)
    try:
        data = path.read_bytes()
        table = tomllib.loads(data.decode())
    except OSError as error:
        raise Wrong(f"{path}: {error.strerror}; check the name") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Wrong(f"{path}: is no TOML: {error}") from None
    found = take(table, TOP, str(path))
    for key, words in (("task", ("2ifc",)), ("order", ("random", "as_written"))):
        if found[key] not in words:
            raise Wrong(f"{path}: {key} = {found[key]!r} is none of {', '.join(words)}")
    for key in ("interval_s", "pause_s"):
        if not 0.0 <= found[key] <= 600.0:
            raise Wrong(f"{path}: {key} = {found[key]:g} must be 0 to 600 s")
    if not found["block"]:
        raise Wrong(f"{path}: has no [[block]]")
    found["block"] = [block_of(block, f"{path}: block {i}") for i, block in enumerate(found["block"], 1)]
    found["scene"] = path.parent / found["scene"]
    if not found["scene"].is_file():
        raise Wrong(f"{path}: scene = \"{found['scene']}\": no such file; its path is relative to the protocol")
    return Protocol(path, hashlib.sha256(data).hexdigest(), **found)
