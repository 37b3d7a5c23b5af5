# SPDX-License-Identifier: Apache-2.0
"""Debian's Python for one case: the interpreter, and the modules that a script of the tree imports. The guest's root has none."""
import pathlib
import subprocess

PYTHON = pathlib.Path("/usr/bin/python3").resolve()
LIST = """
import encodings.ascii, encodings.latin_1, runpy, sys
sys.argv = [sys.argv[1], "--help"]
sys.stdout = open("/dev/null", "w")
try:
    runpy.run_path(sys.argv[0], run_name="__main__")
except SystemExit:
    pass
for module in list(sys.modules.values()):
    if getattr(module, "__file__", None):
        print(module.__file__, file=sys.__stdout__)
"""


def python_files(script):
    """(host file, name in the guest) of what `python FILE` needs; PYTHONHOME is /tact/python."""
    done = subprocess.run([PYTHON, "-c", LIST, script], capture_output=True, text=True, check=True)
    files = [(PYTHON, "python/bin/python3")]
    for line in done.stdout.splitlines():
        path = pathlib.Path(line)
        if path.is_relative_to("/usr/lib/python3"):
            continue  # of Debian's packages, which import by themselves
        if path.is_relative_to("/usr/lib"):
            files.append((path, f"python/lib/{path.relative_to('/usr/lib')}"))
    own = sorted(pathlib.Path(script).parent.iterdir())
    return files + [(path, f"{path.parent.name}/{path.name}") for path in own if path.is_file()]
