# SPDX-License-Identifier: MIT OR Apache-2.0
"""Source of the documentation's site: every page of the repository at its path, formulas as MathML, which browsers draw.

    source.py FOLDER

Formulas are those that the forge renders: `$…$` in a line, `$$…$$` on lines of their own.
"""

import pathlib
import re
import shutil
import subprocess
import sys

from latex2mathml.converter import convert

PAGES = ["*.md", "*.svg", "*.png", "LICENSE-*", "*.toml"]
"""Patterns of what pages are and what they link."""
CODE = re.compile(r"(^```.*?^```|`[^`\n]+`)", re.DOTALL | re.MULTILINE)
FORMULA = re.compile(r"\$\$(.+?)\$\$|(?<![\w$])\$(?!\s)([^$\n]+?)(?<!\s)\$(?![\w$])", re.DOTALL)


def mathml(found):
    """A formula as one line of MathML, in which Markdown finds nothing of its own."""
    display, inline = found.groups()
    text = convert(display or inline, display="block" if display else "inline")
    return re.sub(r"[*_|\[\]\\]", lambda sign: f"&#{ord(sign[0])};", text)


def page(text):
    """The page with its formulas converted; code stays as it is."""
    parts = CODE.split(text)
    return "".join(part if number % 2 else FORMULA.sub(mathml, part) for number, part in enumerate(parts))


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    target = pathlib.Path(sys.argv[1])
    listed = subprocess.run(["git", "ls-files", "-z", *PAGES], cwd=root, check=True, capture_output=True, text=True)
    for name in filter(None, listed.stdout.split("\0")):
        path = target / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if name.endswith(".md"):
            path.write_text(page((root / name).read_text()))
        else:
            shutil.copy(root / name, path)


main()
