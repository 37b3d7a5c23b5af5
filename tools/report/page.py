# SPDX-License-Identifier: Apache-2.0
"""What the pages of tact-limits and tact-jitter have in common: a template and its data, pictures by gnuplot, an exit status.

A page is one file: it loads nothing and has no script. Its template is written in Mustache, of which this is known: {{name}}
(escaped), {{{name}}} (as it is), {{.}}, {{#name}} and {{^name}} to {{/name}}, {{! remark }}, and {{>mark}} where the data has
`holds`. Standard library alone: these programs run on haptics PCs.
"""
import argparse
import html
import json
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
MARK = "{{#holds}}<span class=ok>pass</span>{{/holds}}{{^holds}}<span class=bad>FAIL</span>{{/holds}}"
TAG = re.compile(r"{{([#^])(\w+)}}(.*?){{/\2}}|{{{([\w.]+)}}}|{{([\w.]+)}}", re.S)
TIME_LIMIT_S = 120


class Failure(Exception):
    """What, where, the remedy."""


def value_of(name, scopes):
    if name == ".":
        return scopes[-1]
    for scope in reversed(scopes):
        if isinstance(scope, dict) and name in scope:
            return scope[name]
    return None


def filled(template, scopes):
    def fill(tag):
        sign, section, inner, raw, name = tag.groups()
        if section:
            value = value_of(section, scopes)
            if sign == "^":
                return "" if value else filled(inner, scopes)
            return "".join(filled(inner, scopes + [one]) for one in (value if isinstance(value, list) else [value]) if value)
        value = value_of(raw or name, scopes)
        if value is None:
            raise Failure(f"the template names {raw or name}, the data do not; reinstall tact-tools")
        return str(value) if raw else html.escape(str(value))
    return TAG.sub(fill, template)  # what is filled in is not read again


def page_of(template, data):
    text = re.sub(r"{{!.*?}}", "", (HERE / template).read_text()).replace("{{>mark}}", MARK)
    text = re.sub(r"(?m)^({{[#^/]\w+}})\n", r"\1", text)
    return filled(text, [data, {"style": (HERE / "page.css").read_text()}])


def inline_svg(svg, number):
    """To stand within a page: without its XML head, its ids made its own by the number."""
    own = rf"\1d{number}_"
    return re.sub(r"""(\bid=["']|href=["']#|url\(#)""", own, svg[svg.find("<svg"):])


def literal(value):
    """Of gnuplot: a number, a text, or a list for words()."""
    if isinstance(value, (int, float)):
        return str(value)
    text = value if isinstance(value, str) else " ".join(f'"{word}"' for word in value) + " "
    return "'" + text.replace("'", "''") + "'"


def assignment(name, value):
    """Of a name with $: the rows of a data block."""
    return f"{name} << EOD\n{value}EOD" if name[0] == "$" else f"{name} = {literal(value)}"


def draw(folder, name, script, **variables):
    """NAME.svg and .png by a script beside this file, or at its path, kept with its variables as NAME.gp; the SVG."""
    lines = [f"# Draw again, in this folder: gnuplot -e \"kind='png'\" {name}.gp"]
    lines += [assignment(*variable) for variable in {"name": name, **variables}.items()]
    kept = folder.absolute() / f"{name}.gp"
    kept.write_text("\n".join(lines) + "\n" + (HERE / "plot.gp").read_text() + (HERE / script).read_text())
    for kind in ("svg", "png"):
        try:
            done = subprocess.run(["gnuplot", "-e", f"kind='{kind}'", kept], cwd=folder, stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, errors="replace", check=False, timeout=TIME_LIMIT_S)
        except FileNotFoundError:
            raise Failure("gnuplot is not installed; apt install gnuplot-nox") from None
        except subprocess.TimeoutExpired:
            raise Failure(f"gnuplot took longer than {TIME_LIMIT_S} s; its script is {folder}/{name}.gp") from None
        if done.returncode or not (folder / f"{name}.{kind}").is_file():
            raise Failure(f"gnuplot drew no {folder}/{name}.{kind}; its script is {folder}/{name}.gp: {done.stderr.strip()}")
    return (folder / f"{name}.svg").read_text()


def write(path, text):
    part = path.with_name(path.name + ".part")
    part.write_text(text)
    os.replace(part, path)


def main(program, source, target, pictures_of, html_of):
    """DIR/source, the JSON of the program, becomes DIR/target. `html_of` takes the JSON and what `pictures_of` gave."""
    parser = argparse.ArgumentParser(description=f"Makes {target} of the {source} of {program}.")
    parser.add_argument("folder", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--no-pictures", action="store_true", help="needs no gnuplot")
    parser.add_argument("--status", type=int, default=0, metavar="N", help=f"what {program} found, the exit status of a good end")
    asked = parser.parse_args()
    try:
        data = json.loads((asked.folder / source).read_text())
        drawn = None
        if not asked.no_pictures:
            try:
                drawn = pictures_of(data, asked.folder)
            except Failure as failure:  # without gnuplot the numbers are there all the same
                print(f"{program}: no pictures: {failure}", file=sys.stderr)
        write(asked.folder / target, html_of(data, drawn))
        return asked.status
    except KeyboardInterrupt:
        why, status = "interrupted", 1
    except (Failure, OSError) as error:
        why, status = error, 2
    except Exception as error:  # pylint: disable=broad-except
        why, status = f"{source} is not as expected ({type(error).__name__}: {error}); make it again, and reinstall tact-tools", 2
    print(f"{program}: {asked.folder / target} is not written: {why}; {source} in the same folder has all results, "
          f"and `python3 {HERE / sys.argv[0]} {asked.folder}` tries again", file=sys.stderr)
    return status
