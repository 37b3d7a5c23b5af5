#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The pictures of the READMEs are not older than what they show: tools/pictures.json has digests of both.

usage: tests/house/pictures_test.py [--write PICTURE...]     for tools/pictures, which makes them

A comment changes no digest, nor does the layout of a TOML file. Prints every breach. Exit status 0 or 1.
"""
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DIGESTS = ROOT / "tools/pictures.json"
PAGE = ["host/web/index.html", "host/web/package-lock.json", "host/web/src/"]
SCENE = "model/scenes/"
ACCURACY = [f"{SCENE}{name}.accuracy" for name in ("grasper", "gum", "heart", "liver", "liver_source", "liver_twist",
                                                   "maintenance", "skin")]
# A folder is all of its tracked files. Of a scene its meshes are part.
SHOWN = {
    "host/page.png": [*PAGE, SCENE + "liver.toml"],
    "host/cut.png": [*PAGE, SCENE + "gum.toml"],
    "host/maintenance.png": [*PAGE, *(f"{SCENE}maintenance.{name}" for name in
                                      ("toml", "tracking.toml", "observations.jsonl"))],
    "tools/chart/chart.png": ["tools/chart/picture.py", "tools/chart/scenes.py", *ACCURACY,
                              *(f"tools/results/{name}.json" for name in ("tool", "scenes", "finite_strain", "peers"))],
}
COMMENT = {".ts": re.compile(r"^\s*(?://|/?\*).*\n", re.M), ".py": re.compile(r"^\s*#.*\n", re.M)}


def content(path, data):
    """What a picture can show of a file."""
    if path.endswith(".toml"):
        return json.dumps(tomllib.loads(data.decode()), sort_keys=True).encode()
    comment = COMMENT.get(pathlib.Path(path).suffix)
    return comment.sub("", data.decode()).encode() if comment else data


def files_of(paths, tracked, read):
    """Sorted, with the meshes and the map that a scene names."""
    files = {name for path in paths for name in tracked if name == path or path.endswith("/") and name.startswith(path)}
    for name in [name for name in files if re.fullmatch(SCENE + r"\w+\.toml", name)]:
        scene = tomllib.loads(read(name).decode())
        files |= {SCENE + scene[part][key] for part, key in (("organ", "mesh"), ("tool", "mesh"), ("compliance", "map"))
                  if key in scene.get(part, {})}
    return sorted(files)


def digest(files, read):
    whole = hashlib.sha256()
    for name in files:
        whole.update(hashlib.sha256(content(name, read(name))).digest() + name.encode())
    return whole.hexdigest()[:16]


def digests_of(picture, tracked, read):
    return {"shows": digest(files_of(SHOWN[picture], tracked, read), read),
            "picture": hashlib.sha256(read(picture)).hexdigest()[:16]}


def breaches(recorded, now):
    for picture in sorted({*recorded, *now}):
        then, today = recorded.get(picture), now.get(picture)
        if today is None or then is None:
            yield f"tools/pictures.json: {picture}: is in one of tools/pictures.json and SHOWN"
        elif then["picture"] != today["picture"]:
            yield f"{picture}: was not made by tools/pictures"
        elif then["shows"] != today["shows"]:
            yield f"{picture}: is older than what it shows: tools/pictures {pathlib.Path(picture).stem}"


def blind_rules():
    """Each rule against a breach of it: the names of those that do not see theirs."""
    then, files = {"a.png": {"shows": "1", "picture": "2"}}, {"b.toml": b"x = 1 # c\n", "b.ts": b"// c\nlet x;\n"}
    cases = {"an older picture": breaches(then, {"a.png": {"shows": "3", "picture": "2"}}),
             "a picture of another origin": breaches(then, {"a.png": {"shows": "1", "picture": "3"}}),
             "a picture without digest": breaches({}, then), "a digest without picture": breaches(then, {})}
    blind = [name for name, found in cases.items() if not list(found)]
    same = {"b.toml": b"# d\nx=1\n", "b.ts": b"let x;\n"}
    for name in files:
        if digest([name], files.get) != digest([name], same.get):
            blind.append(f"takes a comment for a change: {name}")
        if digest([name], files.get) == digest([name], {name: files[name].replace(b"x", b"y")}.get):
            blind.append(f"a change of {name}")
    return blind


def main():
    listed = subprocess.run(["git", "-c", "safe.directory=*", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True)
    tracked = [name for name in listed.stdout.split("\0") if (ROOT / name).is_file()]
    recorded = json.loads(DIGESTS.read_text()) if DIGESTS.exists() else {}
    now = {picture: digests_of(picture, tracked, lambda name: (ROOT / name).read_bytes()) for picture in SHOWN}
    if sys.argv[1:2] == ["--write"]:
        DIGESTS.write_text(json.dumps({**recorded, **{picture: now[picture] for picture in sys.argv[2:]}}, indent=1) + "\n")
        return 0
    found = list(breaches(recorded, now))
    for picture, paths in SHOWN.items():
        found += [f"tests/house/pictures_test.py: {path}: no such file" for path in paths
                  if not any(name.startswith(path) for name in tracked)]
    found += [f"tests/house/pictures_test.py: a breach of this rule is not seen: {rule}" for rule in blind_rules()]
    print(*(f"{breach}\n" for breach in found), sep="", end="")
    print(f"pictures: {len(now)} pictures, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
