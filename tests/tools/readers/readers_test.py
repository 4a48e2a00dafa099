"""usage: readers_test.py WEFT

Programs of others read what a run wrote, and have the vertices that our files of OBJ have: Blender a
point cache, VTK's Python the series for ParaView. Those that this machine lacks are skipped; without
any of them the exit status is 77.
"""
import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

WEFT = pathlib.Path(sys.argv.pop(1)).resolve()
HERE = pathlib.Path(__file__).resolve().parent
FRAMES = [0, 1, 7, 12]


def has_vtk():
    return importlib.util.find_spec("vtkmodules") is not None


def obj_places(file):
    """Of the object "cloth", which is the first."""
    places = []
    for line in file.read_text().splitlines():
        kind, *numbers = line.split() or [""]
        if kind == "o" and numbers != ["cloth"]:
            break
        if kind == "v":
            places.append([float(number) for number in numbers[:3]])
    return places


class Readers(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder = pathlib.Path(self.holder.name)
        outs = [f"--out={self.folder / name}" for name in ("frame_%04d.obj", "motion.pc2", "motion.pvd")]
        subprocess.run([WEFT, "run", "hang", "--material", "cotton", "--size", "9", "--steps", "12", *outs],
                       check=True, stdout=subprocess.DEVNULL)
        shutil.copy(self.folder / "frame_0000.obj", self.folder / "start.obj")

    def assert_ours(self, found, frame):
        ours = obj_places(self.folder / f"frame_{frame:04d}.obj")
        self.assertEqual(len(found), len(ours))
        for one, other in zip(found, ours):
            for a, b in zip(one, other):
                self.assertAlmostEqual(a, b, delta=2e-7)  # a rounding of floats near 1

    @unittest.skipUnless(shutil.which("blender"), "there is no Blender")
    def test_blender_has_the_vertices_of_each_frame(self):
        printed = subprocess.run(
            ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
             HERE / "read_in_blender.py", "--", self.folder, *map(str, FRAMES)],
            check=True, capture_output=True, text=True).stdout
        lines = [line for line in printed.splitlines() if line.startswith("places ")]
        self.assertEqual(len(lines), 1, printed)
        for frame, found in zip(FRAMES, json.loads(lines[0].removeprefix("places ")), strict=True):
            self.assert_ours(found, frame)

    @unittest.skipUnless(has_vtk(), "there is no VTK for Python")
    def test_vtk_has_the_vertices_of_each_frame(self):
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        for frame in FRAMES:
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(self.folder / f"motion_{frame:04d}.vtu"))
            reader.Update()
            grid = reader.GetOutput()
            places = [grid.GetPoint(i) for i in range(grid.GetNumberOfPoints())]
            self.assert_ours(places, frame)
            self.assertGreater(grid.GetNumberOfCells(), 0)
            self.assertTrue(grid.GetPointData().HasArray("velocity"))
            self.assertTrue(grid.GetCellData().HasArray("tension"))


if __name__ == "__main__":
    if not shutil.which("blender") and not has_vtk():
        print("neither Blender nor VTK for Python is here")
        sys.exit(77)
    unittest.main()
