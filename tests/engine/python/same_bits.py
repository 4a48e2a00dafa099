"""What Python steps comes to the bits of the weft program. WEFT_PROGRAM names it."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import scene_files
from sheets import sheet

import weft

PROGRAM = os.environ["WEFT_PROGRAM"]
STEPS = 25


def hash_of_run(*arguments):
    """The hash of STEPS frames of 0.01 s, and how often a body was touched at most."""
    printed = subprocess.run([PROGRAM, "run", *map(str, arguments), "--steps", str(STEPS), "--json", "-"],
                             check=True, capture_output=True, text=True).stdout
    report = json.loads(printed[printed.index("{"):])
    return report["state_hash"], report["body_contacts"]


def hash_of(cloth):
    touched = 0
    for _ in range(STEPS):
        touched = max(touched, cloth.step(0.01).body_contacts)
    return f"{cloth.state_hash():016x}", touched


def octahedron(centre, radius):
    corners = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float)
    faces = [(2, 4, 0), (2, 0, 5), (2, 5, 1), (2, 1, 4), (3, 0, 4), (3, 5, 0), (3, 1, 5), (3, 4, 1)]
    return np.asarray(centre) + radius * corners, faces


class SameBits(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return pathlib.Path(self.folder.name) / name

    def test_scene_file_with_a_hull(self):
        file = self.path("table.json")
        subprocess.run([PROGRAM, "scene", "table", "--size", "14", "--out", file], check=True,
                       capture_output=True)
        scene, bodies = scene_files.read_scene(file)
        cloth = weft.Cloth.create(weft.build_model(scene))
        for body in bodies:
            cloth.add_body(body)
        own = hash_of(cloth)
        self.assertGreater(own[1], 0)
        self.assertEqual(own, hash_of_run(file))

    def test_mesh_on_a_mesh(self):
        scene = weft.cloth_from_mesh(sheet(15, pins=[0, 1])).scene
        vertices, triangles = octahedron((0.5, -0.31, 0.5), 0.3)
        cloth = weft.Cloth.create(weft.build_model(scene))
        cloth.add_body(weft.Body(shape=weft.build_shape(
            weft.TriangleMesh(vertices=vertices, triangles=triangles))))
        own = hash_of(cloth)
        self.assertGreater(own[1], 0)
        file = self.path("sheet.json")
        scene_files.write_scene(file, scene, [
            {"shape": "mesh", "vertices": vertices.tolist(), "triangles": triangles}])
        self.assertEqual(own, hash_of_run(file))


if __name__ == "__main__":
    unittest.main()
