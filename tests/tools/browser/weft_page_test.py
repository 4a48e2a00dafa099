#!/usr/bin/env python3
"""usage: weft_page_test.py BUILD_FOLDER

Builds weft in a page (tools/web/build) and opens it from disk in headless Chromium: a corner is dragged and frames
converge, each choice counts, the figures are those of the library, and the console is silent. Exits with 77 where
Emscripten, node or the browser is missing.
"""
import math
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools/viewer"))
import chromium  # noqa: E402

FOLDER = pathlib.Path(sys.argv.pop() if len(sys.argv) > 1 else "build/web")
BUILD = pathlib.Path(__file__).resolve().parents[3] / "tools/web/build"


class WeftInAPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = chromium.Page(chromium.find())

    @classmethod
    def tearDownClass(cls):
        cls.page.close()

    def setUp(self):
        self.page.scheme("light")
        self.page.resize(800, 600)

    def tearDown(self):
        self.assertEqual(self.page.complaints, [])

    def open(self, choices):
        self.page.open(FOLDER / "cloth.html", choices)

    def frames(self, count):
        first = int(self.page.get("weft.frame"))
        self.page.wait(f"weft.frame >= {first + count}", 120)

    def mouse(self, kind, place):
        self.page.call("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left",
                       buttons=0 if kind == "mouseReleased" else 1, clickCount=1)

    def choose(self, name, value):
        self.page.get(f"(() => {{ const it = document.getElementById('{name}'); it.value = '{value}';"
                      "for (const kind of ['input', 'change']) it.dispatchEvent(new Event(kind, { bubbles: true })); })()")

    def shown(self, name):
        return self.page.get(f"document.getElementById('shown-{name}').textContent")

    def test_a_corner_is_dragged_and_frames_converge(self):
        self.open("scene=sheet&side=16")
        self.frames(60)
        corner = 0
        at = self.page.get(f"weft.project({corner})")
        inside = self.page.get("weft.project(17)")
        grip = [a + 0.2 * (b - a) for a, b in zip(at, inside)]
        place = self.page.get(f"weft.cloth.place({corner})")
        self.mouse("mousePressed", grip)
        self.assertEqual(self.page.get("document.body.dataset.held"), str(corner))
        aim = [grip[0] + 60, grip[1] - 40]
        self.mouse("mouseMoved", aim)
        self.frames(60)
        held = self.page.get(f"weft.cloth.place({corner})")
        self.assertGreater(math.dist(place, held), 0.1)
        self.assertLess(math.dist(self.page.get(f"weft.project({corner})"), aim), 1)
        self.assertEqual(self.shown("status"), "converged")
        self.assertLessEqual(float(self.shown("error").removesuffix(" %")), 1)
        self.assertEqual(self.page.get("document.body.dataset.status"), "converged")
        self.mouse("mouseReleased", aim)
        self.frames(40)
        self.assertIsNone(self.page.get("document.body.dataset.held ?? null"))
        self.assertLess(self.page.get(f"weft.cloth.place({corner})")[1], held[1] - 0.05)
        self.assertEqual(self.shown("status"), "converged")

    def test_beside_the_cloth_the_pointer_turns_the_camera(self):
        self.open("scene=sheet&side=16&play=0")
        before = self.page.get("weft.picture.camera.position.toArray()")
        self.page.drag((20, 300), (60, 310))
        self.page.wait(f"weft.picture.camera.position.x !== {before[0]}")
        self.assertIsNone(self.page.get("document.body.dataset.held ?? null"))

    def test_choices_count_and_the_cloth_goes_on(self):
        self.open("scene=sheet&side=16")
        self.frames(30)
        self.page.click("#play")
        place = self.page.get("weft.cloth.place(5)")
        self.choose("material", "denim")
        self.choose("tolerance", "0.003")
        self.choose("substeps", "32")
        self.page.click("#self")
        self.assertEqual(self.page.get("weft.cloth.place(5)"), place)
        self.page.click("#play")
        self.frames(30)
        self.assertEqual(self.shown("substepsDone"), "32")
        self.assertEqual(self.shown("status"), "converged")
        self.assertLessEqual(float(self.shown("error").removesuffix(" %")), 0.3)
        self.assertEqual(self.page.get("document.getElementById('self').getAttribute('aria-pressed')"), "true")
        calm = self.page.get("weft.cloth.place(5)")
        self.choose("wind", "10")
        self.frames(40)
        self.assertGreater(math.dist(calm, self.page.get("weft.cloth.place(5)")), 0.05)
        self.choose("side", "24")
        self.assertEqual(self.page.get("document.getElementById('particles').textContent"), str(24 * 24))
        self.assertTrue(self.page.get("document.getElementById('notice').hidden"))

    def test_a_skirt_walks_and_a_sheet_lies_over_a_ball(self):
        self.open("scene=skirt&side=16")
        self.frames(40)
        self.assertEqual(self.shown("status"), "converged")
        pose = self.page.get("Array.from(weft.cloth.motion.bodies[0].poses)")
        self.assertGreater(abs(pose[3]), 0.01)
        self.page.click("#scene-drape")
        self.assertEqual(self.page.get("document.getElementById('title').textContent"), "weft: over a ball")
        self.choose("side", "16")
        self.frames(80)
        self.assertEqual(self.shown("status"), "converged")
        self.assertGreater(int(self.shown("contacts")), 20)
        lowest = self.page.get("Math.min(...weft.cloth.motion.places[0].filter((_, i) => i % 3 === 1))")
        self.assertGreater(lowest, -0.001)

    def test_it_fits_a_phone_and_touch_takes_hold(self):
        self.page.resize(390, 844, touch=True)
        self.open("scene=sheet&side=16")
        self.assertEqual(self.page.get("document.body.dataset.panel"), "closed")
        self.assertLessEqual(self.page.get("document.documentElement.scrollWidth"), 390)
        self.frames(2)
        at = self.page.get("weft.project(120)")
        point = [{"x": at[0], "y": at[1]}]
        self.page.call("Input.dispatchTouchEvent", type="touchStart", touchPoints=point)
        self.page.wait("document.body.dataset.held !== undefined")
        self.page.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.page.wait("document.body.dataset.held === undefined")


if __name__ == "__main__":
    if not chromium.find():
        print("weft_page_test: there is no Chromium, nothing was tested")
        sys.exit(77)
    built = subprocess.run([BUILD, FOLDER], check=False)
    if built.returncode != 0:
        sys.exit(built.returncode)
    unittest.main(verbosity=2)
