"""The examples beside the Python module run, and say what is so. WEFT_EXAMPLES is their folder."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(os.environ["WEFT_EXAMPLES"])


def run(name, *arguments):
    return subprocess.run([sys.executable, FOLDER / name, *map(str, arguments)], check=True,
                          capture_output=True, text=True).stdout


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.picture = pathlib.Path(folder.name) / "picture.png"

    def check_picture(self):
        self.assertEqual(self.picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_draw_drape(self):
        printed = run("draw_drape.py", "--size", 12, "--seconds", 0.5, "--out", self.picture)
        self.assertLess(float(re.search(r"lowest (\S+) m", printed).group(1)), -0.1)
        self.check_picture()

    def test_fit_stiffness(self):
        printed = run("fit_stiffness.py", "--check", 5e-6, "--cells", 8)
        self.assertAlmostEqual(float(re.search(r"bending (\S+) N m", printed).group(1)), 5e-6, delta=1e-7)

    def test_plot_error(self):
        printed = run("plot_error.py", "--size", 10, "--most", 32, "--out", self.picture)
        errors = [float(e) for e in re.findall(r"(\S+) mm", printed)]
        self.assertEqual(len(errors), 4)
        self.assertLess(errors[-1], errors[0] / 20)  # second order: 64 times less
        self.check_picture()


if __name__ == "__main__":
    unittest.main()
