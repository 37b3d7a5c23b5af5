#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each result in tools/results was made from a commit of this history, and the version is one in the whole tree.

A result names its revision: a commit that others have, without changes. tools/results/exceptions.toml lists those of which
that is not true, each with its reason, until they are measured again; that list only becomes shorter. Without git's history
(an archive, a shallow clone) the commits cannot be looked up, and the rest is judged.

Prints every breach as file: sentence. Exit status 0 or 1.
"""
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import subprocess
import sys
import tomllib

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RESULTS, LIST = "tools/results", "tools/results/exceptions.toml"


def git(*arguments):
    """(exit status, what it says)"""
    done = subprocess.run(["git", "-c", "safe.directory=*", *arguments], cwd=ROOT, capture_output=True, text=True)
    return done.returncode, done.stdout.strip()


def has_history():
    return git("rev-parse", "--is-shallow-repository") == (0, "false")


def is_ancestor(revision):
    return git("merge-base", "--is-ancestor", revision, "HEAD")[0] == 0


def revisions_in(value):
    """Of a result and of its rows: `"revision": "1a2b3c of 2026-01-31"` is 1a2b3c."""
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        if key == "revision":
            yield str(inner).split(" ")[0]
        else:
            yield from revisions_in(inner)


def wrong_with(revisions, known):
    """What is wrong with the revisions of one result, or None. known: is it in the history? None: cannot be asked."""
    if not revisions:
        return "names no revision"
    for revision in sorted(set(revisions)):
        if revision.endswith("-dirty"):
            return f"was made from a changed tree ({revision})"
        if known and not known(revision):
            return f"was made from {revision}, which is not in this history"
    return None


def result_breaches(results, exceptions, known):
    """results: {name: its JSON}, exceptions: {name: {"revision", "reason"}}."""
    for name, result in results.items():
        revisions = list(revisions_in(result))
        wrong, excused = wrong_with(revisions, known), exceptions.get(name)
        if excused is None:
            if wrong:
                yield f"{RESULTS}/{name}.json: {wrong}; commit, then tools/numbers --measure {name}"
        elif excused.get("revision") not in revisions:
            yield f"{RESULTS}/{name}.json: is of another revision than in {LIST}; a new result needs no exception"
        elif len(excused.get("reason", "")) < 20:
            yield f"{LIST}: {name} says no reason"
        elif known and not wrong:
            yield f"{LIST}: {name} is in order by now; take it out"
    for name in sorted(set(exceptions) - set(results)):
        yield f"{LIST}: there is no {RESULTS}/{name}.json"


def growth_breaches(versions):
    """versions: the list as each commit has it, the oldest first, then as it is now."""
    for before, now in zip(versions, versions[1:]):
        for name in sorted(set(now.items()) - set(before.items())):
            yield f"{LIST}: {name[0]} ({name[1]}) was not in it before; it only becomes shorter: measure from a commit"


def revisions_of(text):
    return {name: entry.get("revision", "") for name, entry in tomllib.loads(text).items()}


def list_versions(now):
    _, commits = git("log", "--reverse", "--format=%H", "--", LIST)
    texts = (git("show", f"{commit}:{LIST}") for commit in commits.split())
    return [*(revisions_of(text) for status, text in texts if status == 0), revisions_of(now)]


VERSION_AT = {  # each: the version as written there
    ".github/CITATION.cff": r'^version: "([^"]+)"$',
    "tools/deploy/CHANGELOG.md": r"^## (\S+)",
    "host/web/package.json": r'^  "version": "([^"]+)"',
    "tools/mcap/tact-mcap": r'^VERSION = "([^"]+)"',
    "tools/metrics/tact-metrics": r'^VERSION = "([^"]+)"',
    "tools/plot/tact-plot": r'^VERSION = "([^"]+)"',
    "tools/trial/tact-trial": r'^VERSION = "([^"]+)"'}


def version_breaches(read):
    """read: a file's text, by its path."""
    found = re.search(r"^set\(TACT_VERSION (\S+)\)", read("CMakeLists.txt"), re.M)
    if not found:
        yield "CMakeLists.txt: has no set(TACT_VERSION ...)"
        return
    for path, pattern in VERSION_AT.items():
        written = re.search(pattern, read(path), re.M)
        if not written or written[1] != found[1]:
            yield f"{path}: its version is {written[1] if written else 'missing'}, that of CMakeLists.txt is {found[1]}"


def measures_a_changed_tree():
    """Does tools/numbers run a command although git reports a change?"""
    loader = importlib.machinery.SourceFileLoader("numbers", str(ROOT / "tools/numbers"))
    numbers = importlib.util.module_from_spec(importlib.util.spec_from_loader("numbers", loader))
    loader.exec_module(numbers)
    numbers.git = lambda *arguments: " M model/law/law.cc"
    ran = []
    numbers.MEASURED = {"a": lambda: ran.append(1) or sys.exit("it measures")}
    try:
        numbers.measure("a", False)
    except numbers.Wrong as written:
        return bool(ran) or "model/law/law.cc" not in str(written)
    except SystemExit:
        pass
    return True


def blind_rules():
    """Each rule against a breach of it: the names of those that do not see theirs."""
    def known(revision):
        return revision == "good"

    def of(revision):
        return {"a": {"revision": revision, "values": {}}}
    excused = {"a": {"revision": "bad", "reason": "takes a day on a machine of its own"}}
    files = dict.fromkeys(VERSION_AT, "") | {"CMakeLists.txt": "set(TACT_VERSION 1.0.0-rc1)\n"}
    good_files = {"CMakeLists.txt": files["CMakeLists.txt"], ".github/CITATION.cff": 'version: "1.0.0-rc1"',
                  "tools/deploy/CHANGELOG.md": "## 1.0.0-rc1", "host/web/package.json": '  "version": "1.0.0-rc1"',
                  "tools/mcap/tact-mcap": 'VERSION = "1.0.0-rc1"', "tools/plot/tact-plot": 'VERSION = "1.0.0-rc1"',
                  "tools/metrics/tact-metrics": 'VERSION = "1.0.0-rc1"',
                  "tools/trial/tact-trial": 'VERSION = "1.0.0-rc1"'}
    cases = {
        "a revision that is unknown": result_breaches(of("bad"), {}, known),
        "a changed tree": result_breaches(of("good-dirty"), {}, known),
        "a changed tree without history": result_breaches(of("good-dirty"), {}, None),
        "a row of a changed tree": result_breaches({"a": {"revision": "good", "values": [{"revision": "x-dirty of 2026"}]}},
                                                   {}, known),
        "no revision": result_breaches({"a": {"values": {}}}, {}, known),
        "an exception of another revision": result_breaches(of("worse"), excused, known),
        "an exception without a reason": result_breaches(of("bad"), {"a": {"revision": "bad", "reason": "-"}}, known),
        "an exception that is not needed": result_breaches(of("good"), {"a": {**excused["a"], "revision": "good"}}, known),
        "an exception of nothing": result_breaches({}, excused, known),
        "a list that grows": growth_breaches([{"a": "1"}, {"a": "1", "b": "2"}]),
        "a list whose entry changes": growth_breaches([{"a": "1"}, {"a": "2"}]),
        "a list that grows again": growth_breaches([{"a": "1", "b": "2"}, {"a": "1"}, {"a": "1", "b": "2"}]),
        "another version": version_breaches(files.__getitem__),
        "no version": version_breaches(dict.fromkeys(files, "").__getitem__)}
    blind = [name for name, found in cases.items() if not list(found)]
    order = {"a good result": result_breaches(of("good"), {}, known),
             "an excused one": result_breaches(of("bad"), excused, known),
             "one that cannot be asked": result_breaches(of("bad"), {}, None),
             "a list that shrinks": growth_breaches([{"a": "1", "b": "2"}, {"a": "1"}]),
             "one version": version_breaches(good_files.__getitem__)}
    for name, found in order.items():
        blind += [f"takes for a breach: {name}: {breach}" for breach in found]
    return blind


def main():
    text = (ROOT / LIST).read_text()
    results = {path.stem: json.loads(path.read_text()) for path in sorted((ROOT / RESULTS).glob("*.json"))}
    history = has_history()
    breaches = [f"tests/house/provenance_test.py:1: does not see {name}" for name in blind_rules()]
    breaches += result_breaches(results, tomllib.loads(text), is_ancestor if history else None)
    breaches += growth_breaches(list_versions(text)) if history else []
    breaches += ["tools/numbers:1: measures a changed tree"] if measures_a_changed_tree() else []
    breaches += version_breaches(lambda path: (ROOT / path).read_text())
    print(*breaches, sep="\n", end="\n" if breaches else "")
    print(f"provenance: {len(results)} results, {len(breaches)} wrong")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
