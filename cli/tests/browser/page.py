#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the live page in a browser, against a running server or one that is started here.

    cli/tests/browser/run [--pictures FOLDER] [NAME ...]
    page.py --start BINARY [--pictures FOLDER] [NAME ...]
    page.py --url http://127.0.0.1:8091/ [--pictures FOLDER] [NAME ...]

`run` beside this file fetches what it needs and builds `BINARY`, the command `hapticore`. The browser is Debian's Chromium, or
what the variable CHROMIUM names. NAMEs choose tests; without one all run. The last line counts them; a failure makes the exit status 1.
"""

import argparse
import importlib.util
import itertools
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import traceback

from playwright.sync_api import expect, sync_playwright

WALL_N = 0.3
"""Force at which a wall counts as felt, N."""
PICTURES = 20
"""Pictures a second that the page must reach."""
WINDOWS = 20
"""In one of at most this many windows of time: other programs take the processor from a browser that draws in software."""
PATIENCE_MS = 20_000
"""How long a state may take to come; it comes much earlier on a machine that is not busy."""

expect.set_options(timeout=PATIENCE_MS)


class Visit:
    """A page of the server in a context of its own, with what it wrote to the console."""

    def __init__(self, browser, url, scene="?scene=peg", width=1280, height=900, **context):
        self.context = browser.new_context(viewport={"width": width, "height": height}, **context)
        self.context.set_default_timeout(PATIENCE_MS)
        self.page = self.context.new_page()
        self.problems = []
        self.page.on("console", lambda message: message.type in ("error", "warning") and self.problems.append(message.text))
        self.page.on("pageerror", lambda error: self.problems.append(str(error)))
        self.url, self.scene = url, scene

    def __enter__(self):
        self.open()
        return self

    def __exit__(self, kind, *_):
        self.context.close()
        if kind is None:
            assert not self.problems, f"console: {self.problems}"

    def open(self):
        self.page.goto(self.url + self.scene)
        self.wait("document.querySelectorAll('#pads tr').length > 0 && document.querySelector('#sheet').dataset.slot > 0")
        # A link to a scene that is open already changes nothing; another one is set up first.
        self.wait("document.querySelector('#notice').hidden")

    def wait(self, condition):
        """Waits for a condition in JavaScript. Playwright's own wait would need `unsafe-eval`, which the page forbids."""
        end_s = time.monotonic() + PATIENCE_MS / 1e3
        while not self.page.evaluate(condition):
            assert time.monotonic() < end_s, f"not within {PATIENCE_MS} ms: {condition}"
            self.page.wait_for_timeout(20)

    def restart(self):
        """Starts the scene again, so that no test depends on what another one has left."""
        self.page.evaluate("document.querySelector('#scene').dispatchEvent(new Event('change'))")
        self.wait("parseFloat(document.querySelector('#slot-now').textContent) < 1")
        self.wait("parseFloat(document.querySelector('#slot-now').textContent) > 2.1")

    def row(self, number):
        """Cells of a pad's row by their heads."""
        heads = self.page.locator("#pads-card thead th").all_inner_texts()
        cells = self.page.locator("#pads tr").nth(number).locator("th, td").all_inner_texts()
        return dict(zip(heads, cells, strict=True))

    def force(self, number):
        return float(self.row(number)["Force, N"].replace("−", "-").replace("–", "nan"))

    def pad_at(self, number):
        """Pixels of a pad on the sheet."""
        row = self.row(number)
        x, y = (float(row[key].replace("−", "-")) for key in ("x, mm", "y, mm"))
        sheet = self.page.locator("#sheet")
        box, scale = sheet.bounding_box(), float(sheet.get_attribute("data-scale"))
        return box["x"] + box["width"] / 2 + x * scale, box["y"] + box["height"] / 2 - y * scale

    def push(self, move, numbers=(0,), steps=60):
        """Calls `move(step)` until all these pads are braked by the wall; their largest forces."""
        most = dict.fromkeys(numbers, 0.0)
        for step in range(steps):
            move(step)
            self.page.wait_for_timeout(60)
            for number in numbers:
                most[number] = max(most[number], self.force(number))
            if min(most.values()) >= WALL_N:
                return most
        raise AssertionError(f"forces reached {most} N, expected {WALL_N} N")

    def slot(self):
        return int(self.page.locator("#sheet").get_attribute("data-slot"))


def opens_and_runs(browser, url, _):
    """The page shows peg, its four pads and a device time that goes on."""
    with Visit(browser, url) as visit:
        expect(visit.page.locator("#scene")).to_have_value("peg")
        assert visit.page.locator("#pads tr").count() == 4
        expect(visit.page.locator("#banner")).to_be_hidden()
        first = visit.slot()
        visit.wait(f"document.querySelector('#sheet').dataset.slot > {first} + 100")


def mouse_meets_the_wall(browser, url, _):
    """A drag of the first pad on the sheet meets the wall; dragged back, the pad is free again."""
    with Visit(browser, url) as visit:
        visit.restart()
        mouse = visit.page.mouse
        x, y = visit.pad_at(0)
        mouse.move(x, y)
        mouse.down()
        visit.push(lambda step: mouse.move(x - step, y))
        assert visit.row(0)["State"] in ("in wall", "limited", "sticking", "noisy"), visit.row(0)
        expect(visit.page.locator("#speech")).to_contain_text("first:")
        mouse.move(x + 25, y, steps=25)
        expect(visit.page.locator("#pads tr").first.locator(".state")).to_have_text("free")
        mouse.up()


def keys_meet_the_wall(browser, url, _):
    """Key 2 chooses the second pad; arrows push it into the wall by steps of 1 mm."""
    with Visit(browser, url) as visit:
        visit.restart()
        visit.page.keyboard.press("2")
        expect(visit.page.locator("#pads tr").nth(1)).to_have_class("chosen")
        visit.push(lambda _: visit.page.keyboard.press("ArrowLeft"), [1])
        assert visit.force(0) < WALL_N


def touches_lead_a_pad_each(browser, url, _):
    """Two fingers on the sheet push two pads into the wall at the same time, without scrolling the page."""
    with Visit(browser, url, width=390, height=844, has_touch=True, is_mobile=True) as visit:
        visit.restart()
        touch = visit.context.new_cdp_session(visit.page)
        starts = [visit.pad_at(0), visit.pad_at(3)]

        def points(step):
            return [{"x": x - step, "y": y, "id": k} for k, (x, y) in enumerate(starts)]

        touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": points(0)})

        def move(step):
            touch.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": points(step)})

        visit.push(move, [0, 3])
        touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
        assert visit.page.evaluate("scrollY") == 0


def loupe_drags_by_touch(browser, url, _):
    """One finger in the loupe leads the chosen pad."""
    with Visit(browser, url, width=390, height=844, has_touch=True, is_mobile=True) as visit:
        visit.restart()
        loupe = visit.page.locator("#loupe")
        loupe.scroll_into_view_if_needed()
        box = loupe.bounding_box()
        x, y = box["x"] + box["width"] - 5, box["y"] + box["height"] / 2
        touch = visit.context.new_cdp_session(visit.page)
        touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [{"x": x, "y": y}]})

        def move(step):
            touch.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [{"x": x - 5 * step, "y": y}]})

        visit.push(move)
        touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def space_freezes(browser, url, _):
    """Space holds the picture while the device goes on; space again follows it."""
    with Visit(browser, url) as visit:
        visit.page.keyboard.press("Space")
        expect(visit.page.locator("#freeze")).to_have_attribute("aria-pressed", "true")
        held = visit.slot()
        visit.page.wait_for_timeout(500)
        assert visit.slot() == held
        visit.page.keyboard.press("Space")
        visit.wait(f"document.querySelector('#sheet').dataset.slot > {held} + 400")


def strips_zoom_and_scrub(browser, url, _):
    """A drag across the strips zooms and holds; the pointer there moves the sheet in time; a double click follows again."""
    with Visit(browser, url) as visit:
        # The page knows only the frames since it was opened.
        begun_s = float(visit.page.locator("#slot-now").inner_text().split(" s")[0])
        visit.wait(f"parseFloat(document.querySelector('#slot-now').textContent) > {begun_s + 3}")
        box = visit.page.locator("#strips .u-over").first.bounding_box()
        mouse, y = visit.page.mouse, box["y"] + box["height"] / 2
        mouse.move(box["x"] + box["width"] * 0.85, y)
        mouse.down()
        mouse.move(box["x"] + box["width"] * 0.98, y, steps=4)
        mouse.up()
        expect(visit.page.locator("#freeze")).to_have_text("Follow")
        held = visit.slot()
        mouse.move(box["x"] + box["width"] * 0.3, y, steps=4)
        visit.wait(f"document.querySelector('#sheet').dataset.slot < {held}")
        mouse.dblclick(box["x"] + box["width"] * 0.3, y)
        expect(visit.page.locator("#freeze")).to_have_text("Freeze")
        visit.wait(f"document.querySelector('#sheet').dataset.slot > {held} + 100")


def command_and_link_are_copied(browser, url, _):
    """The clipboard receives a command, then a link that opens the same scene."""
    with Visit(browser, url, permissions=["clipboard-read", "clipboard-write"]) as visit:
        for button, beginning in (("#copy-command", "hapticore simulate peg"), ("#copy-link", f"{url}?scene=peg")):
            visit.page.locator(button).click()
            expect(visit.page.locator("#notice")).to_contain_text("Copied: ")
            text = visit.page.evaluate("navigator.clipboard.readText()")
            assert text.startswith(beginning), text


def full_stop_runs_one_slot(browser, url, _):
    """A full stop pauses, runs exactly one slot and shows its codes; `Run` goes on."""
    with Visit(browser, url) as visit:
        visit.page.keyboard.press(".")
        expect(visit.page.locator("#pause")).to_have_text("Run")
        expect(visit.page.locator("#slot-channels button")).to_have_count(8)
        before = visit.slot()
        for number in range(1, 4):
            visit.page.keyboard.press(".")
            visit.wait(f"document.querySelector('#sheet').dataset.slot == {before + number}")
        visit.page.locator("#pause").click()
        visit.wait(f"document.querySelector('#sheet').dataset.slot > {before} + 100")
        expect(visit.page.locator("#pause")).to_have_text("Pause")


def recording_downloads_a_scene(browser, url, binary):
    """A recording of a drag is saved as a scene file; the command, where it is given, runs it."""
    with Visit(browser, url) as visit:
        record = visit.page.locator("#record")
        record.click()
        expect(record).to_have_text("Stop and save")
        visit.wait("parseFloat(document.querySelector('#slot-now').textContent) > 0.3")
        for _ in range(5):
            visit.page.keyboard.press("ArrowLeft")
            visit.page.wait_for_timeout(50)
        with visit.page.expect_download() as download:
            record.click()
        expect(record).to_have_text("Record")
        name = download.value.suggested_filename
        assert re.fullmatch(r"[\w.-]+\.toml", name), name
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / name
            download.value.save_as(file)
            assert "[[pad]]" in file.read_text() or binary is None, file.read_text()[:400]
            if binary:
                run = subprocess.run([binary, "simulate", name, "--out", "out"], cwd=folder, capture_output=True, text=True)
                assert (pathlib.Path(folder) / "out").exists(), run.stderr


def lost_connection_is_plain(browser, url, _):
    """Without a connection a banner says so, every state is `lost`, values are grey; they come back by themselves."""
    visit = Visit(browser, url)
    sockets, refuse = [], []

    def route(socket):
        if refuse:
            return socket.close()
        socket.connect_to_server()
        return sockets.append(socket)

    visit.page.route_web_socket("**/ws*", route)
    with visit:
        refuse.append(True)
        sockets[0].close()
        expect(visit.page.locator("#banner")).to_contain_text("No connection")
        expect(visit.page.locator("#pads .state").first).to_have_text("lost")
        assert set(visit.page.locator("#pads .state").all_inner_texts()) == {"lost"}
        assert visit.row(0)["Age, ms"] == "–"
        assert "grayscale" in visit.page.locator("#cards").evaluate("cards => getComputedStyle(cards).filter")
        visit.page.keyboard.press("ArrowLeft")
        expect(visit.page.locator("#notice")).to_contain_text("not sent")
        refuse.clear()
        expect(visit.page.locator("#banner")).to_be_hidden()
        expect(visit.page.locator("#pads .state").first).not_to_have_text("lost")


def links_open_scenes(browser, url, _):
    """A link opens its scene with its settings; the address and the links of other pages have them; an unknown preset is refused."""
    with Visit(browser, url, "?scene=hockey&set=sensor.noise_ppm_rms=40") as visit:
        expect(visit.page.locator("#scene")).to_have_value("hockey")
        assert "set=sensor.noise_ppm_rms=40" in visit.page.url
        with Visit(browser, url, "", permissions=["clipboard-read", "clipboard-write"]) as other:
            other.page.locator("#copy-link").click()
            expect(other.page.locator("#notice")).to_contain_text("Copied: ")
            copied = other.page.evaluate("navigator.clipboard.readText()")
            assert "scene=hockey" in copied and "set=sensor.noise_ppm_rms=40" in copied, copied
        visit.page.goto(url + "?preset=nonsense")
        expect(visit.page.locator("#notice")).to_contain_text("preset: expected one of")
        visit.page.locator("#scene").select_option("peg")
        expect(visit.page.locator("#pads tr").first).to_contain_text("first")
        visit.wait("location.search.includes('scene=peg')")


def presets_open(browser, url, _):
    """Every preset opens, shows its hint, and frames follow."""
    with Visit(browser, url) as visit:
        buttons = visit.page.locator("#presets button")
        assert buttons.count() == 7
        for k in range(7):
            buttons.nth(k).click()
            expect(buttons.nth(k)).to_have_attribute("aria-pressed", "true")
            visit.wait("document.querySelector('#notice').hidden")
            visit.wait("parseFloat(document.querySelector('#slot-now').textContent) > 0.2")
            assert "preset=" in visit.page.url
            assert len(visit.page.locator("#hint").inner_text()) > 20
        visit.page.locator("#scene").select_option("peg")
        visit.wait("location.search.includes('scene=peg')")


def strike(visit):
    """Drags the left mallet into the puck, at the middle of the table, until the puck goes to the right."""
    visit.wait("parseFloat(document.querySelector('#slot-now').textContent) > 0.6")
    x, y = visit.pad_at(0)
    scale = float(visit.page.locator("#sheet").get_attribute("data-scale"))
    mouse = visit.page.mouse
    mouse.move(x, y)
    mouse.down()
    goes_right = "parseFloat(document.querySelector('#sheet').dataset.speed) > 20"
    for step in range(31):
        mouse.move(x + 4.5 * step * scale, y)
        visit.page.wait_for_timeout(15)
        if visit.page.evaluate(goes_right):
            return
    visit.wait(goes_right)


def let_go(visit):
    """Gives the left mallet back to the scene, which has it far from the middle."""
    visit.page.mouse.up()
    visit.page.get_by_text("Let go").click()
    visit.wait("parseFloat(document.querySelector('#pads tr').cells[7].innerText.replace('−', '-')) < -100")


def a_strike_sends_the_puck(browser, url, _):
    """A mallet that is dragged into the puck sends it off; the resting mallet opposite, or the table's end, turns it round."""
    with Visit(browser, url, "?preset=air-hockey") as visit:
        sheet = visit.page.locator("#sheet")
        expect(visit.page.locator("#serve")).to_be_visible()
        expect(sheet).to_have_attribute("data-puck", "0,0")
        expect(visit.page.locator("#score")).to_have_text("0 : 0")
        strike(visit)
        assert float(sheet.get_attribute("data-puck").split(",")[0]) > 0
        visit.wait("parseFloat(document.querySelector('#sheet').dataset.speed) <= 0")
        let_go(visit)
        visit.page.locator("#serve").click()
        expect(sheet).to_have_attribute("data-puck", "0,0")
        strike(visit)
        let_go(visit)
        visit.page.keyboard.press("n")
        expect(sheet).to_have_attribute("data-puck", "0,0")
    with Visit(browser, url) as visit:
        expect(visit.page.locator("#serve")).to_be_hidden()


def axe_finds_nothing(browser, url, _):
    """axe-core finds no violation at 390 and 1280 pixels, light and dark."""
    axe = pathlib.Path(importlib.util.find_spec("axe_playwright_python").submodule_search_locations[0]) / "axe.min.js"
    for scene, width in itertools.product(("?scene=peg", "?preset=air-hockey"), (390, 1280)):
        for scheme in ("light", "dark"):
            with Visit(browser, url, scene, width=width, color_scheme=scheme) as visit:
                visit.page.locator("#take-slot").click()
                visit.page.locator("#words summary").click()
                visit.page.evaluate(axe.read_text())
                found = visit.page.evaluate("axe.run().then((result) => result.violations)")
                text = [(of["id"], [node["html"][:120] for node in of["nodes"]][:3]) for of in found]
                assert not found, f"{scene}, {width} px, {scheme}: {text}"


def nothing_overflows(browser, url, _):
    """Neither a phone nor a desk's screen scrolls sideways."""
    for scene, width in itertools.product(("?scene=peg", "?preset=air-hockey"), (320, 390, 768, 1280, 1920)):
        with Visit(browser, url, scene, width=width) as visit:
            visit.page.locator("#take-slot").click()
            expect(visit.page.locator("#slot-channels button")).to_have_count(8)
            excess = visit.page.evaluate("document.documentElement.scrollWidth - innerWidth")
            assert excess <= 0, f"{scene}, {width} px: {excess} px too wide"


PICTURES_JS = """(seconds) => new Promise((resolve) => {
  const canvases = ['#sheet', '#loupe', '#strips canvas'].map((name) => document.querySelector(name));
  const small = new OffscreenCanvas(64, 64).getContext('2d', { willReadFrequently: true });
  const paint = () => {
    small.clearRect(0, 0, 64, 64);
    for (const canvas of canvases) small.drawImage(canvas, canvas.width - 64, canvas.height / 2 - 32, 64, 64, 0, 0, 64, 64);
    return small.getImageData(0, 0, 64, 64).data.reduce((sum, byte) => (31 * sum + byte) % 1000003, 7);
  };
  const begun = performance.now();
  let [slot, hash, count] = [0, 0, 0];
  const look = () => {
    const now = document.querySelector('#sheet').dataset.slot;
    if (now !== slot) {
      const painted = paint();
      if (painted !== hash) count++;
      [slot, hash] = [now, painted];
    }
    if (performance.now() - begun < 1000 * seconds) requestAnimationFrame(look);
    else resolve(count / seconds);
  };
  look();
})"""


def pictures_a_second(browser, url, _):
    """At least twenty pictures a second have both a new slot and other pixels."""
    with Visit(browser, url) as visit:
        rates = []
        while max(rates, default=0) < PICTURES and len(rates) < WINDOWS:
            rates.append(visit.page.evaluate(PICTURES_JS, 1.5))
        load = f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
        print(f"  pictures a second: {', '.join(f'{rate:.0f}' for rate in rates)}; {load}")
        assert max(rates) >= PICTURES, rates


def take_pictures(browser, url, folder):
    """Pictures of the page while the first pad is in the wall."""
    sizes = [("wide", 1280, 900, 1), ("phone", 390, 844, 2)]
    for (name, width, height, scale), scheme in itertools.product(sizes, ("light", "dark")):
        with Visit(browser, url, width=width, height=height, color_scheme=scheme, device_scale_factor=scale) as visit:
            visit.restart()
            visit.push(lambda _, visit=visit: visit.page.keyboard.press("ArrowLeft"))
            visit.page.locator("#take-slot").click()
            expect(visit.page.locator("#slot-channels button")).to_have_count(8)
            visit.page.wait_for_timeout(500)
            # A browser that draws in software may need long for a page that never rests.
            visit.page.screenshot(path=folder / f"{name}-{scheme}.png", full_page=True, timeout=4 * PATIENCE_MS)
        with Visit(browser, url, "?preset=air-hockey", width, height, color_scheme=scheme, device_scale_factor=scale) as visit:
            strike(visit)
            visit.page.keyboard.press("Space")
            visit.page.screenshot(path=folder / f"game-{name}-{scheme}.png", full_page=True, timeout=4 * PATIENCE_MS)


TESTS = [
    opens_and_runs, mouse_meets_the_wall, keys_meet_the_wall, touches_lead_a_pad_each, loupe_drags_by_touch, space_freezes,
    strips_zoom_and_scrub, full_stop_runs_one_slot, recording_downloads_a_scene, command_and_link_are_copied,
    lost_connection_is_plain, links_open_scenes, presets_open, a_strike_sends_the_puck, axe_finds_nothing, nothing_overflows, pictures_a_second,
]


def start(binary):
    """Starts the server at a free port: the process and its address."""
    command = [binary, "live", "peg", "--port", "0"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    for line in process.stdout:
        if found := re.search(r"http://\S+", line):
            return process, found[0]
    raise SystemExit(f"{binary} live ended with status {process.wait()} before it printed an address")


def run(test, browser, url, binary):
    begun = time.monotonic()
    try:
        test(browser, url, binary)
    except Exception:  # One that fails must not keep the others from running.
        print(f"FAILED {test.__name__}\n{traceback.format_exc(limit=-3)}", flush=True)
        return False
    print(f"ok {test.__name__} ({time.monotonic() - begun:.1f} s)", flush=True)
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--url", help="address of a running server")
    parser.add_argument("--start", metavar="BINARY", help="the hapticore command, to start a server")
    parser.add_argument("--pictures", metavar="FOLDER", type=pathlib.Path, help="where pictures of the page go")
    parser.add_argument("names", nargs="*", metavar="NAME", help="tests to run")
    options = parser.parse_args()
    if bool(options.url) == bool(options.start):
        parser.error("expected either --url or --start")
    binary = options.start and str(pathlib.Path(options.start).resolve())
    process, url = start(binary) if binary else (None, options.url)
    try:
        with sync_playwright() as playwright:
            chromium = os.environ.get("CHROMIUM", "/usr/bin/chromium")
            browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
            tests = [test for test in TESTS if not options.names or test.__name__ in options.names]
            passed = sum(run(test, browser, url, binary) for test in tests)
            if options.pictures:
                options.pictures.mkdir(parents=True, exist_ok=True)
                take_pictures(browser, url, options.pictures)
            browser.close()
    finally:
        if process:
            process.terminate()
            process.wait()
    print(f"{passed} passed, {len(tests) - passed} failed")
    return 0 if tests and passed == len(tests) else 1


if __name__ == "__main__":
    sys.exit(main())
