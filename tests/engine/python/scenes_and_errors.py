"""Scenes from arrays, and what is refused: one line with the field, the index and the value."""
import unittest

import numpy as np
from sheets import cloth_of, line, model_of, sheet

import weft


class Scenes(unittest.TestCase):
    def test_arrays_come_back(self):
        mesh = sheet(5)
        scene = weft.cloth_from_mesh(mesh).scene
        scene.self_contact = weft.SelfContact(on=True, thickness=0.002, friction=0.1, untangle=True)
        again = weft.SceneDescription()
        for field in ("positions", "velocities", "masses", "fixed", "constraints", "membrane", "bending",
                      "anchors", "seams", "surface", "spheres", "radii", "damping", "air", "friction",
                      "self_contact", "gravity"):
            setattr(again, field, getattr(scene, field))
        self.assertEqual(weft.save_model(weft.build_model(scene)), weft.save_model(weft.build_model(again)))

    def test_fields_are_copies_that_cannot_be_written(self):
        mesh = sheet(3)
        with self.assertRaises(ValueError):
            mesh.positions[0] = 1

    def test_keywords_are_fields(self):
        self.assertEqual(weft.Settings(tolerance=0.5, solver=weft.Solver.yarn).solver, weft.Solver.yarn)
        with self.assertRaisesRegex(weft.Error, "Settings has no field tolerence"):
            weft.Settings(tolerence=1)

    def test_a_value_that_does_not_fit_is_told_in_one_line(self):
        for make, line in (
            (lambda: weft.Settings(tolerance="1%"), "tolerance: '1%' is not a number"),
            (lambda: weft.Settings(solver="yarn"), "solver: 'yarn' is not a Solver: gauss_seidel, direct, yarn, "
                                                   "small_steps, automatic"),
            (lambda: weft.Settings(substeps=1.5), "substeps: 1.5 is not a whole number that fits"),
            (lambda: weft.Pose(rotation=[0, 0, 1]), r"rotation: \[0, 0, 1\] is not four numbers x, y, z, w"),
            (lambda: weft.SceneDescription(gravity=[0, -9.81]), r"gravity: \[0, -9.81\] is not three numbers"),
            (lambda: weft.Body(shape=weft.Ball(radius=1)), r"shape: weft.Ball\(radius=1.0\) is not a BodyShape"),
            (lambda: weft.Body(pose=1), "pose: 1 is not a Pose"),
            (lambda: weft.Changes(masses=3), "masses: 3 is not a list of pairs"),
        ):
            with self.subTest(line=line), self.assertRaisesRegex(weft.Error, f"^{line}$"):
                make()
        cloth = weft.Cloth.create(weft.build_model(weft.cloth_from_mesh(sheet(3)).scene))
        with self.assertRaisesRegex(weft.Error, r"^gravity: \[0, -9.81\] is not three numbers$"):
            cloth.set_gravity([0, -9.81])
        with self.assertRaisesRegex(weft.Error, "^dt: '1/60' is not a number$"):
            cloth.step("1/60")

    def test_parts_of_fields_cannot_be_written(self):
        for owner, field in ((weft.SceneDescription(), "gravity"), (weft.Pose(), "position"),
                             (weft.Ball(), "centre"), (weft.Air(), "wind"), (weft.RigidMotion(), "translation")):
            with self.subTest(field=field), self.assertRaises(ValueError):
                getattr(owner, field)[1] = 1

    def test_objects_show_what_differs_from_the_defaults(self):
        self.assertEqual(repr(weft.Settings(tolerance=0.5, solver=weft.Solver.yarn)),
                         "weft.Settings(tolerance=0.5, solver=Solver.yarn)")
        self.assertEqual(repr(weft.Pose(position=(0, 1, 0))), "weft.Pose(position=[0.0, 1.0, 0.0])")
        self.assertEqual(repr(weft.SceneDescription(positions=[[0, 0, 0]] * 9)),
                         "weft.SceneDescription(positions=<array (9, 3)>)")

    def test_records_have_the_defaults(self):
        links = weft.records(weft.Constraint, 1)
        links["b"], links["rest_length"] = 1, 1
        scene = weft.SceneDescription(positions=[(0, 0, 0), (1, 0, 0)], masses=[1, 1], fixed=[0], constraints=links)
        cloth = weft.Cloth.create(weft.build_model(scene))
        for _ in range(60):
            cloth.step(1 / 60)
        self.assertLess(abs(np.linalg.norm(cloth.position(1)) - 1), 0.01)
        seams, anchors = weft.records(weft.Seam, 2), weft.records(weft.Anchor, 0)
        self.assertEqual((seams["time"][1], seams["strength"][1], anchors.shape), (1, np.inf, (0,)))

    def test_rows_may_leave_out_what_scene_files_may(self):
        link = weft.SceneDescription(constraints=[(0, 1, 2.0)]).constraints
        self.assertEqual(link.tolist(), [(0, 1, 2, 0, 0, np.inf)])
        hinge = ([0, 1, 2, 3], [-1, -1, 1, 1], 0, 2.0)
        bends = weft.SceneDescription(bending=[hinge + (0.1, 0.2), hinge + (0,) * 4]).bending
        self.assertEqual(bends["fold"].tolist(), [0.1, 0])
        self.assertEqual(bends["yield"].tolist(), [0.2, 0])

    def test_one_fixed_particle_is_moved(self):
        made = weft.cloth_from_mesh(sheet(3))
        made.scene.fixed = [4]
        cloth = weft.Cloth.create(weft.build_model(made.scene))
        cloth.place_fixed(4, (0.5, 1, 0.5))
        self.assertEqual(list(cloth.position(4)), [0.5, 1, 0.5])
        with self.assertRaises(weft.Error):
            cloth.move_fixed(4, [(0.5, 1, 0.5)])

    def test_version_is_that_of_the_library(self):
        self.assertEqual(weft.__version__, weft._weft.__version__)

    def test_materials(self):
        cotton = weft.materials()["cotton"]
        self.assertEqual(cotton.density, weft.find_material("cotton").density)
        cotton.warp = -1
        with self.assertRaisesRegex(weft.Error, "^[^\n]*warp[^\n]*-1[^\n]*$"):
            weft.check_material(cotton)
        with self.assertRaisesRegex(weft.Error, "cotton"):
            weft.find_material("tin")


class Refused(unittest.TestCase):
    def refuses(self, pattern, call, *arguments, **keywords):
        with self.assertRaisesRegex(weft.Error, pattern) as caught:
            call(*arguments, **keywords)
        self.assertNotIn("\n", str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)

    def test_scene(self):
        scene = weft.SceneDescription(positions=np.zeros((2, 3)), masses=[1, -2])
        self.refuses(r"masses\[1\].*-2", weft.build_model, scene)
        self.refuses(r"positions: shape \(2, 2\)", weft.SceneDescription, positions=np.zeros((2, 2)))
        self.refuses("positions: not an array", weft.SceneDescription, positions="no")
        self.refuses(r"fixed\[1\]: -1 ", weft.SceneDescription, fixed=[0, -1])
        self.refuses(r"fixed\[0\]: 4294967296 ", weft.SceneDescription, fixed=[2 ** 32])
        self.refuses("fixed: not whole numbers", weft.SceneDescription, fixed=[0.5])
        self.refuses("constraints: not records", weft.SceneDescription, constraints=[(1, 2)])
        self.refuses(r"constraints\[0\].kind: 2", weft.SceneDescription, constraints=[(0, 1, 1.0, 2, 0)])
        self.refuses("faces", weft.MeshDescription().set_faces, [1, 2, 3])
        hinge = ([0, 1, 2, 3], [-1, -1, 1, 1], 0)
        self.refuses("bending: not records", weft.SceneDescription, bending=[hinge])
        links = weft.records(weft.Constraint, 2)
        links["strength"] = 5, 0
        self.refuses(r"constraints\[1\].strength: 0 ", weft.SceneDescription, constraints=links)
        self.refuses(r"seams\[0\].strength: 0 ", weft.SceneDescription, seams=np.zeros(1, weft.Seam))
        self.refuses("type: is none of Constraint, ", weft.records, np.dtype(float), 1)
        self.refuses("count: -1 is below 0", weft.records, weft.Constraint, -1)

    def test_a_cloth_is_unchanged(self):
        cloth = cloth_of(8)
        cloth.step(0.01)
        before = cloth.state_hash()
        self.refuses("dt.*-1", cloth.step, -1)
        self.refuses("tolerance", weft.Cloth.create, line(3), weft.Settings(tolerance=-1))
        self.refuses("position", cloth.write_positions, np.zeros((3, 3)))
        self.refuses("particle", cloth.move_fixed, [63], [(0, 0, 0)])
        self.refuses("particle: 64", cloth.position, 64)
        self.refuses("7", cloth.move_body, 7, weft.Pose())
        self.refuses("radius", weft.build_shape, weft.Ball(radius=-1))
        self.assertEqual(cloth.state_hash(), before)

    def test_buffers(self):
        cloth = line(4)
        cloth = weft.Cloth.create(cloth)
        self.refuses(r"out: shape \(3, 3\) is not \(4, 3\)", cloth.read_positions, np.zeros((3, 3)))
        self.refuses("out: neither float64", cloth.read_positions, np.zeros((4, 3), int))
        self.refuses("out: neither float64", cloth.read_positions, np.zeros((3, 4)).T)
        self.refuses("out: not float32", cloth.read_positions, np.zeros((3, 4), np.float32).T)
        fixed = np.zeros((4, 3))
        fixed.setflags(write=False)
        self.refuses("out: cannot be written", cloth.read_positions, fixed)

    def test_saved_bytes(self):
        cloth = cloth_of(6)
        saved = bytearray(cloth.save_state())
        saved[len(saved) // 2] ^= 1
        self.refuses("", cloth.load_state, bytes(saved))
        self.refuses("", cloth.load_state, memoryview(saved))
        self.refuses("", weft.load_model, b"nothing")


if __name__ == "__main__":
    unittest.main()
