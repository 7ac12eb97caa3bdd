#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of reports in a browser: each bundled scene's page at 390 and 1280 pixels, light and dark.

    cli/tests/browser/run --reports [--pictures FOLDER] [SCENE ...]

Held: axe-core finds no violation, the page is no wider than the screen, nothing is written to the console, and its own links
lead somewhere. Scenes run at fidelity `fixed`, and as long as their files say.
"""

import argparse
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from playwright.sync_api import sync_playwright

WIDTHS = (390, 1280)
SCHEMES = ("light", "dark")

BROKEN_LINKS_JS = """[...document.querySelectorAll('a[href^="#"]')]
  .map((link) => link.getAttribute('href').slice(1)).filter((id) => id && !document.getElementById(id))"""
EXCESS_JS = "document.documentElement.scrollWidth - innerWidth"


def scenes(binary):
    """Names of the bundled scenes."""
    listed = subprocess.run([binary, "scenes", "--json"], check=True, capture_output=True, text=True)
    return [scene["name"] for scene in json.loads(listed.stdout)]


def report(binary, scene, folder):
    """Runs a scene; its page, and the files beside it that it links."""
    out = folder / scene
    subprocess.run([binary, "simulate", scene, "--out", out, "-q"], check=False, stdout=subprocess.DEVNULL)
    return out / "report.html"


def problems_of(page, axe):
    """What is wrong with the page that is shown, a line each."""
    page.evaluate(axe)
    found = page.evaluate("axe.run().then((result) => result.violations)")
    yield from (f"{of['id']}: {[node['html'][:120] for node in of['nodes']][:3]}" for of in found)
    if (excess := page.evaluate(EXCESS_JS)) > 0:
        yield f"{excess} px too wide"
    yield from (f"link to #{name}, which is not there" for name in page.evaluate(BROKEN_LINKS_JS))


def check(browser, path, axe, pictures):
    """Problems of one report, each with width and colours."""
    links = set()
    for width in WIDTHS:
        for scheme in SCHEMES:
            context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
            page = context.new_page()
            said = []
            page.on("console", lambda message, said=said: said.append(message.text))
            page.on("pageerror", lambda error, said=said: said.append(str(error)))
            page.goto(path.as_uri())
            links |= set(page.evaluate("[...document.querySelectorAll('a')].map((link) => link.href)"))
            for problem in [*said, *problems_of(page, axe)]:
                yield f"{width} px, {scheme}: {problem}"
            if pictures:
                page.screenshot(path=pictures / f"{path.parent.name}-{width}-{scheme}.png", full_page=True)
            context.close()
    for link in sorted(links):
        file = link.split("#")[0].removeprefix("file://")
        if link.startswith("file://") and not pathlib.Path(file).exists():
            yield f"link to {file}, which is not there"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary", type=pathlib.Path, help="the command hapticore")
    parser.add_argument("--pictures", type=pathlib.Path, help="folder for screenshots")
    parser.add_argument("scenes", nargs="*", help="names of scenes [default: all]")
    args = parser.parse_intermixed_args()
    binary = args.binary.resolve()
    if args.pictures:
        args.pictures.mkdir(parents=True, exist_ok=True)
    package = importlib.util.find_spec("axe_playwright_python").submodule_search_locations[0]
    axe = (pathlib.Path(package) / "axe.min.js").read_text()
    failed = 0
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        chromium = os.environ.get("CHROMIUM", "/usr/bin/chromium")
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        for scene in args.scenes or scenes(binary):
            problems = list(check(browser, report(binary, scene, pathlib.Path(folder)), axe, args.pictures))
            failed += bool(problems)
            print("\n  ".join([f"{'FAILED' if problems else 'ok'} report of {scene}", *problems]), flush=True)
        browser.close()
    print(f"{failed} reports failed")
    sys.exit(failed > 0)


main()
