#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The documents of the source tree as HTML, for the package tact-doc. Needs cmark-gfm and git.

    html_pages.py FOLDER      writes FOLDER/index.html, and a page for each *.md of the tree but those of tests/

A link to another page leads there, one to a picture to its copy; of a file that is not in the package the words alone stay.
Commands read as they are typed where tact is installed: build/tactd is tactd, model/scenes/ is /usr/share/tact/scenes/.
"""
import html
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FIRST = "tools/deploy/FIRST_FORCE.md"
PICTURES = (".png", ".svg")
STYLE = """body{font:16px/1.5 "DejaVu Sans",Arial,sans-serif;color:#222;max-width:1000px;margin:24px auto;padding:0 16px}
table{border-collapse:collapse}td,th{border:1px solid #ccc;padding:4px 8px;text-align:left;vertical-align:top}
code,pre{background:#f3f3f3}pre{padding:10px;overflow-x:auto}img{max-width:100%}.path{color:#666}"""
HEAD = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{style}</style></head><body>
<p class="path"><a href="{up}index.html">tact</a> / {path}</p>
"""
NOTE = ("<p class=\"path\">These pages describe the sources of tact. Programs and scenes are named as the packages install them; "
        "<code>tools/...</code> and <code>tests/...</code> are in the sources alone.</p>\n")


def tracked():
    listed = subprocess.run(["git", "-c", "safe.directory=*", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in listed.stdout.splitlines() if not name.startswith("tests/")]


def installed(text):
    """Names of the build folder and the tree as those of the packages."""
    text = re.sub(r"(?<![\w/.-])(?:\./)?build/(tact[a-z-]*)", r"\1", text)
    return re.sub(r"(?<![\w/.-])model/scenes/(?=[\w./]*(?:toml|meshes))", "/usr/share/tact/scenes/", text)


def target_of(link, page, pages, pictures):
    """Where a link of that page leads in FOLDER; None where the package has no such file."""
    path, _, anchor = link.partition("#")
    if re.match(r"[a-z]+:", link) or not path:
        return link
    named = pathlib.PurePosixPath(html.unescape(path))
    whole = []
    for part in (*page.parent.parts, *named.parts):
        if part == ".." and whole:
            whole.pop()
        elif part not in (".", ".."):
            whole.append(part)
    name = "/".join(whole)
    if f"{name}/README.md" in pages:
        name += "/README.md"
    if name not in pages and name not in pictures:
        return None
    up = "../" * len(page.parent.parts)
    return up + (name[:-3] + ".html" if name in pages else name) + ("#" + anchor if anchor else "")


def with_anchors(body):
    """The anchors of headings, as the forge makes them."""
    def anchored(found):
        words = html.unescape(re.sub(r"<[^>]*>", "", found[2])).lower()
        anchor = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        return f'<h{found[1]} id="{html.escape(anchor)}">{found[2]}</h{found[1]}>'
    return re.sub(r"<h(\d)>(.*?)</h\1>", anchored, body, flags=re.S)


def page_html(name, pages, pictures):
    page = pathlib.PurePosixPath(name)
    body = subprocess.run(["cmark-gfm", "-e", "table", "-e", "autolink"], input=installed((ROOT / name).read_text()),
                          capture_output=True, text=True, check=True).stdout
    body = body.replace("<!-- raw HTML omitted -->", "")

    def linked(found):
        target = target_of(found[1], page, pages, pictures)
        return found[2] if target is None else f'<a href="{target}">{found[2]}</a>'

    def drawn(found):
        target = target_of(found[1], page, pages, pictures)
        return "" if target is None else f'<img src="{target}"'
    body = re.sub(r'<a href="([^"]*)"[^>]*>(.*?)</a>', linked, body, flags=re.S)
    body = re.sub(r'<img src="([^"]*)"', drawn, body)
    title = re.search(r"<h1>(.*?)</h1>", body, re.S)
    words = re.sub(r"<[^>]*>", "", title[1]) if title else html.escape(name)
    head = HEAD.format(title=words, style=STYLE, up="../" * len(page.parent.parts), path=html.escape(name))
    return words, head + NOTE + with_anchors(body) + "</body></html>\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    names = tracked()
    pages = [name for name in names if name.endswith(".md")]
    pictures = {name for name in names if name.endswith(PICTURES)}
    titles = {}
    for name in pages:
        titles[name], text = page_html(name, set(pages), pictures)
        path = folder / (name[:-3] + ".html")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        for picture in re.findall(r'<img src="([^":]*)"', text):
            whole = (path.parent / picture).resolve().relative_to(folder.resolve())
            (folder / whole).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / whole, folder / whole)
    order = sorted(pages, key=lambda name: (name != FIRST, name.count("/"), name))
    rows = "".join(f'<li><a href="{name[:-3]}.html">{titles[name]}</a> <span class="path">{html.escape(name)}</span></li>\n'
                   for name in order)
    (folder / "index.html").write_text(HEAD.format(title="tact", style=STYLE, up="", path="all pages") + NOTE +
                                       f"<h1>tact: all pages</h1>\n<ul>\n{rows}</ul>\n</body></html>\n")


if __name__ == "__main__":
    main()
