#!/usr/bin/env python3
"""usage: page_test.py WEFT

Runs scenes with the program WEFT, and opens their pages in headless Chromium: they play, the picture
changes, the figures are those of the report, keys, touch and sizes work, and the console is silent.
Exits with 77 where there is no browser.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools/viewer"))
import chromium  # noqa: E402

WEFT = sys.argv.pop() if len(sys.argv) > 1 else "weft"


def weft(*arguments):
    result = subprocess.run([WEFT, *map(str, arguments)], capture_output=True, text=True)
    if result.returncode not in (0, 3):  # 3: a tolerance was missed
        raise RuntimeError(result.stderr)
    return result.stdout


def pixels(png):
    """Rows of bytes of an 8-bit PNG, and how many bytes a pixel has."""
    width, height = (int.from_bytes(png[at:at + 4], "big") for at in (16, 20))
    channels = {2: 3, 6: 4}[png[25]]
    data, at = b"", 8
    while at < len(png):
        size, kind = int.from_bytes(png[at:at + 4], "big"), png[at + 4:at + 8]
        if kind == b"IDAT":
            data += png[at + 8:at + 8 + size]
        at += size + 12
    raw, stride = zlib.decompress(data), width * channels
    rows, above = [], bytearray(stride)
    for y in range(height):
        rule, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            a, b = (row[x - channels] if x >= channels else 0), above[x]
            c = above[x - channels] if x >= channels else 0
            if rule == 1:
                row[x] = (row[x] + a) & 255
            elif rule == 2:
                row[x] = (row[x] + b) & 255
            elif rule == 3:
                row[x] = (row[x] + (a + b) // 2) & 255
            elif rule == 4:
                nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))
                row[x] = (row[x] + nearest[2]) & 255
        rows.append(row)
        above = row
    return rows, channels


def changed_share(before, after, box):
    """The share of the pixels within x, y, width, height that differ clearly."""
    (one, channels), (other, _) = pixels(before), pixels(after)
    x, y, width, height = map(int, box)
    count = 0
    for row in range(y, y + height):
        for at in range(x * channels, (x + width) * channels, channels):
            count += max(abs(one[row][at + k] - other[row][at + k]) for k in range(3)) > 24
    return count / (width * height)


STAGE = "(() => { const b = document.getElementById('picture').getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()"


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        weft("run", "corners", "--size", 41, "--steps", 100, "--out", cls.at / "corners.html",
             "--out", cls.at / "corners.motion", "--json", cls.at / "corners.json", "--out",
             cls.at / "corners.pc2")
        weft("run", "mannequin", "--size", 20, "--steps", 60, "--out", cls.at / "dressed.html")
        weft("run", "corners", "--size", 41, "--steps", 100, "--tolerance", 0.05, "--out",
             cls.at / "loose.motion", "--json", cls.at / "loose.json")
        weft("view", cls.at / "corners.motion", cls.at / "loose.motion", "--out",
             cls.at / "both.html")
        cls.page = chromium.Page(chromium.find())

    @classmethod
    def tearDownClass(cls):
        cls.page.close()
        cls.folder.cleanup()

    def setUp(self):
        self.page.scheme("light")
        self.page.resize(800, 560)

    def tearDown(self):
        self.assertEqual(self.page.complaints, [])

    def open(self, name, choices=""):
        self.page.open(self.at / name, choices)

    def shown(self, figure, result=0):
        cell = f"document.querySelector('[data-figure={figure}][data-result=\"{result}\"]')"
        return self.page.get(f"[{cell}.dataset.value, {cell}.textContent]")

    def frame(self):
        return int(self.page.get("document.body.dataset.sample").split()[0])

    def test_it_plays_and_the_picture_changes(self):
        self.open("corners.html", "play=0")
        before, box = self.page.picture(), self.page.get(STAGE)
        self.assertEqual(self.frame(), 0)
        self.page.key(" ")
        self.page.wait("Number(document.body.dataset.sample) > 20")
        self.page.key(" ")
        self.assertFalse(self.page.get("weft.page.player.isPlaying"))
        stopped = self.frame()
        after = self.page.picture()
        self.assertGreater(changed_share(before, after, box), 0.02)
        self.assertEqual(self.frame(), stopped)

    def test_figures_are_those_of_the_report(self):
        report = json.loads((self.at / "corners.json").read_text())
        self.open("corners.html", "play=0")
        self.assertEqual(self.shown("max_strain"), ["", "–"])  # no step led to the start
        self.page.key("End")
        self.page.wait("document.body.dataset.sample === '100'")
        value, text = self.shown("energy")
        self.assertEqual(float(value), report["energy_end"])
        self.assertEqual(float(text.removesuffix(" J")), float(f"{report['energy_end']:.4g}"))
        strains = self.page.get("weft.motions[0].figures.max_strain")
        worst = max((x, sample) for sample, x in enumerate(strains) if x is not None)[1]
        # The report measures again, in another order.
        self.assertLess(abs(strains[worst] / report["max_strain"] - 1), 1e-9)
        self.page.get(f"weft.page.player.pauseAt({worst} * 0.01)")
        self.page.wait(f"document.body.dataset.sample === '{worst}'")
        value, text = self.shown("max_strain")
        self.assertEqual(float(value), strains[worst])
        self.assertEqual(float(text.removesuffix(" %")), float(f"{100 * report['max_strain']:.3g}"))

    def test_places_are_those_of_the_point_cache(self):
        import array
        cache = array.array("f", (self.at / "corners.pc2").read_bytes()[32:])
        self.open("corners.html", "play=0")
        places = self.page.get("[0, 1, 2, 57, 100].map((t) => Array.from(weft.motions[0].places[t]))")
        quantum = self.page.get("weft.motions[0].quantum")
        count = 3 * 41 * 41
        worst = 0
        for sample, list_of in zip([0, 1, 2, 57, 100], places):
            expected = cache[sample * count:(sample + 1) * count]
            self.assertEqual(len(list_of), count)
            worst = max(worst, max(abs(a - b) for a, b in zip(list_of, expected)))
        self.assertLess(worst, 0.51 * quantum)
        self.assertGreater(worst, 0.4 * quantum)

    def test_switches_change_the_picture(self):
        self.open("dressed.html", "play=0&time=0.5")
        box = self.page.get(STAGE)
        for key, least in [("h", 0.02), ("b", 0.01), ("c", 0.02), ("w", 0.01), ("d", 0.5)]:
            before = self.page.picture()
            self.page.key(key)
            self.page.get("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            with self.subTest(key=key):
                self.assertGreater(changed_share(before, self.page.picture(), box), least)
        self.assertEqual(self.page.get("document.getElementById('legend').hidden"), False)
        self.assertGreater(self.page.get("Math.max(...weft.motions[0].contacts.map((c) => c.length))"), 10)

    def test_two_results_have_one_camera_and_one_clock(self):
        self.open("both.html", "play=0&time=0.6")
        x, y, width, height = self.page.get(STAGE)
        half = width / 2
        for result, name in enumerate(["corners", "loose"]):
            report = json.loads((self.at / f"{name}.json").read_text())
            largest = self.page.get(f"Math.max(...weft.motions[{result}].figures.max_strain)")
            self.assertLess(abs(largest / report["max_strain"] - 1), 1e-9)
            self.assertEqual(float(self.shown("max_strain", result)[0]),
                             self.page.get(f"weft.motions[{result}].figures.max_strain[60]"))
        before = self.page.picture()
        self.page.drag((half / 2, 200), (half / 2 + 90, 230))
        self.page.get("new Promise((done) => setTimeout(done, 300))")
        after = self.page.picture()
        for left in (0, half + 2):
            self.assertGreater(changed_share(before, after, (left, 80, half - 4, height - 90)), 0.01)

    def test_touch_and_the_size_of_a_phone(self):
        self.page.resize(390, 844, touch=True)
        self.open("corners.html", "play=0")
        self.assertEqual(self.page.get("document.body.dataset.panel"), "closed")
        self.assertLessEqual(self.page.get("document.documentElement.scrollWidth"), 390)
        before = self.page.get("weft.page.picture.camera.position.toArray()")
        self.page.drag((200, 300), (260, 320), touch=True)
        self.page.wait(f"weft.page.picture.camera.position.x !== {before[0]}")
        chart = self.page.get("(() => { const b = document.getElementById('chart').getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()")
        middle = (chart[0] + chart[2] / 2, chart[1] + chart[3] / 2)
        self.page.drag((middle[0] - 40, middle[1]), middle, touch=True)
        self.page.wait("document.body.dataset.sample === '50'")
        self.page.resize(844, 390, touch=True)
        self.page.wait("document.getElementById('picture').clientWidth > 500")
        self.assertLessEqual(self.page.get("document.documentElement.scrollHeight"), 390)

    def test_dark_is_dark(self):
        self.page.scheme("dark")
        self.open("corners.html", "play=0")
        rows, channels = pixels(self.page.picture())
        self.assertLess(sum(rows[200][channels * 20:channels * 20 + 3]), 200)
        self.assertEqual(self.page.get("weft.page.theme"), "dark")

    def test_a_page_without_a_result_says_so(self):
        text = (self.at / "corners.html").read_text()
        at = text.index('<script class="result"')
        (self.at / "none.html").write_text(text[:at] + text[text.index("</script>", at) + 9:])
        with self.assertRaisesRegex(RuntimeError, "no result"):
            self.open("none.html")


if __name__ == "__main__":
    if not chromium.find():
        print("page_test: there is no Chromium, nothing was tested")
        sys.exit(77)
    unittest.main(verbosity=2)
