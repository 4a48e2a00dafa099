"""What is read of a cloth, a batch and a surface, views' lifetimes, and saved states."""
import gc
import pathlib
import tempfile
import unittest

import numpy as np
from sheets import cloth_of, line, model_of, sheet

import weft


class Cloths(unittest.TestCase):
    def test_positions_in_any_buffer(self):
        cloth = cloth_of(9)
        cloth.step(0.01)
        new = cloth.read_positions()
        self.assertEqual(new.tolist(), [cloth.position(i).tolist() for i in range(cloth.particle_count())])
        out = np.empty_like(new)
        self.assertIs(cloth.read_positions(out), out)
        self.assertTrue(np.array_equal(out, new))
        vertices = np.full((len(new), 8), 7, np.float32)
        cloth.read_positions(vertices[:, :3], origin=(0.25, 0, 0))
        cloth.read_velocities(vertices[:, 3:6])
        self.assertTrue(np.array_equal(vertices[:, :3], (new - (0.25, 0, 0)).astype(np.float32)))
        self.assertTrue(np.array_equal(vertices[:, 3:6], cloth.read_velocities().astype(np.float32)))
        self.assertTrue(np.all(vertices[:, 6:] == 7))

    def test_saved_and_loaded(self):
        cloth = cloth_of(9)
        cloth.add_body(weft.Body(shape=weft.build_shape(weft.Ball(centre=(0.5, -0.3, 0.5), radius=0.25))))
        for _ in range(10):
            cloth.step(0.01)
        again = weft.Cloth.create(weft.load_model(bytearray(weft.save_model(cloth.model))))
        again.load_state(np.frombuffer(cloth.save_state(), np.uint8))
        other = cloth.clone()
        for one in (cloth, again, other):
            one.step(0.01)
        self.assertEqual(cloth.state_hash(), again.state_hash())
        self.assertEqual(cloth.state_hash(), other.state_hash())

    def test_recorded(self):
        cloth = cloth_of(9)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "cloth.weft")
            cloth.begin_recording(file, note="from Python")
            cloth.step(0.01)
            before = file.stat().st_size
            cloth.end_recording()
            self.assertGreater(file.stat().st_size, before)
            self.assertIn(b"from Python", file.read_bytes())
            with self.assertRaisesRegex(weft.Error, "path: cannot be written"):
                cloth.begin_recording(pathlib.Path(folder, "no", "such"))
        with self.assertRaisesRegex(weft.Error, "nothing is being recorded"):
            cloth.end_recording()

    def test_bodies_bear_the_cloth(self):
        cloth = weft.Cloth.create(model_of(sheet(9, pins=[])))
        plane = cloth.add_body(weft.Body(shape=weft.build_shape(weft.Plane()), pose=weft.Pose(
            position=(0, -0.001, 0))))
        for _ in range(100):
            cloth.step(0.01)
        weight = 10 * weft.cloth_from_mesh(sheet(9)).scene.masses.sum()
        self.assertAlmostEqual(cloth.body_load(plane).force[1], -weight, delta=1e-3 * weight)
        contacts = cloth.body_contacts()
        self.assertEqual(contacts.dtype, weft.BodyContact)
        self.assertTrue(np.all(contacts["body"] == plane) and len(contacts) == 81)
        self.assertTrue(np.allclose(contacts["normal"], (0, 1, 0)))

    def test_changes_and_pins(self):
        cloth = cloth_of(9)
        cloth.move_fixed([0, 1], cloth.read_positions()[:2] + (0, 0.01, 0))
        cloth.step(0.01)
        self.assertEqual(cloth.position(1)[1], 0.01)
        cloth.change(weft.Changes(release=range(9), masses=[(3, 0.01)], damping=weft.Damping(motion=1)))
        cloth.step(0.01)
        self.assertGreater(cloth.position(1)[1], 0.018)  # let go at 1 m/s, it flies on
        with self.assertRaisesRegex(weft.Error, r"masses\[0\]"):
            weft.Changes(masses=[3])


class Batches(unittest.TestCase):
    def test_the_bits_of_each_alone(self):
        model = model_of(sheet(8))
        cloths = [weft.Cloth.create(model) for _ in range(6)]
        batch = weft.Batch(cloths)
        start = batch.read_positions()
        self.assertEqual(start.shape, (6, 64, 3))
        start[:, :, 1] += 0.1 * np.arange(6)[:, None]
        batch.write_positions(start)
        alone = [cloth.clone() for cloth in cloths]
        for _ in range(5):
            self.assertEqual(batch.step_all(0.01, weft.Arena(2)), 0)
            for cloth in alone:
                cloth.step(0.01)
        self.assertEqual([c.state_hash() for c in cloths], [c.state_hash() for c in alone])
        out = np.empty((6, 64, 3))
        self.assertIs(batch.read_positions(out), out)
        self.assertTrue(np.array_equal(out[3], alone[3].read_positions()))
        self.assertEqual(batch.report(2).status, weft.Status.converged)

    def test_refused(self):
        cloths = [weft.Cloth.create(line(count)) for count in (3, 4)]
        batch = weft.Batch(cloths)
        self.assertEqual(batch.step_all(-1), 2)
        with self.assertRaisesRegex(weft.Error, "dt"):
            batch.report(1)
        with self.assertRaisesRegex(weft.Error, r"cloths\[1\]: 4 particles"):
            batch.read_positions()
        with self.assertRaisesRegex(weft.Error, r"cloths\[2\]: it is in the batch"):
            weft.Batch(cloths + cloths[:1])
        with self.assertRaisesRegex(weft.Error, "cloth: 2"):
            batch.report(2)

    def test_what_is_refused_of_one_cloth_changes_none(self):
        cloths = [weft.Cloth.create(model_of(sheet(4))) for _ in range(3)]
        batch = weft.Batch(cloths)
        batch.step_all(0.01)
        cloths[1].move_fixed([0], [(0, 0.1, 0)])  # which written positions would cancel
        copies = [cloth.clone() for cloth in cloths]
        good = batch.read_positions() + 0.01
        bad, short, flat = good.copy(), good[:2], good[:, :, :2]
        bad[2, 5, 1] = np.nan
        for name, write in (("positions", batch.write_positions), ("velocities", batch.write_velocities),
                            ("forces", batch.write_forces)):
            with self.assertRaisesRegex(weft.Error, rf"^cloths\[2\]: {name}\[5\].*nan"):
                write(bad)
            for shape in (short, flat, good[0]):
                with self.assertRaisesRegex(weft.Error, f"^{name}: shape"):
                    write(shape)
            with self.assertRaisesRegex(weft.Error, f"^{name}: not an array of numbers"):
                write([["text"]])
        with self.assertRaisesRegex(weft.Error, "^positions: shape"):
            batch.write_positions([])
        batch.step_all(0.01)
        for cloth, copy in zip(cloths, copies):
            copy.step(0.01)
            self.assertEqual(cloth.state_hash(), copy.state_hash())

    def test_velocities_and_forces_of_all(self):
        cloths = [weft.Cloth.create(model_of(sheet(4, pins=[]))) for _ in range(3)]
        batch = weft.Batch(cloths)
        velocities = np.zeros((3, 16, 3))
        velocities[:, :, 0] = np.arange(3)[:, None]
        batch.write_velocities(velocities)
        self.assertTrue(np.array_equal(batch.read_velocities(), velocities))
        masses = weft.cloth_from_mesh(sheet(4)).scene.masses
        batch.write_forces(masses[:, None] * np.array((0, 10 + 1, 0)) * np.ones((3, 1, 1)))
        self.assertEqual(batch.step_all(0.01), 0)
        self.assertTrue(np.allclose(batch.read_velocities(), velocities + (0, 0.01, 0), atol=1e-5))
        batch = weft.Batch([cloth_of(4) for _ in range(2)])
        batch.write_forces(np.ones((2, 16, 3)))
        batch.write_forces([])
        batch.step_all(0.01)
        alone = cloth_of(4)
        alone.step(0.01)
        self.assertTrue(np.array_equal(batch.read_positions()[1], alone.read_positions()))

    def test_keeps_its_cloths(self):
        batch = weft.Batch([cloth_of(5), cloth_of(5)])
        gc.collect()
        self.assertEqual(batch.step_all(0.01), 0)


class Surfaces(unittest.TestCase):
    def test_vertices_and_normals(self):
        mesh = sheet(7)
        made = weft.cloth_from_mesh(mesh)
        surface = weft.surface_of_mesh(mesh, made)
        cloth = weft.Cloth.create(weft.build_model(made.scene))
        positions, normals = surface.read_vertices(cloth)
        self.assertTrue(np.array_equal(positions, cloth.read_positions()[made.particle_of_vertex].astype("f4")))
        self.assertTrue(np.allclose(np.abs(normals), (0, 1, 0)))
        finer = weft.map_surface(mesh, made, sheet(13))
        self.assertTrue(np.allclose(finer.read_vertices(cloth)[0], sheet(13).positions, atol=1e-6))
        vertices = np.zeros((49, 8), np.float32)
        surface.read_vertices(cloth, vertices[:, :3], vertices[:, 3:6])
        self.assertTrue(np.array_equal(vertices[:, 3:6], normals))

    def test_triangles_stay_as_they_were_read(self):
        mesh = sheet(7)
        surface = weft.surface_of_mesh(mesh, weft.cloth_from_mesh(mesh))
        triangles = surface.triangles()
        expected = triangles.copy()
        del surface
        gc.collect()
        self.assertTrue(np.array_equal(triangles, expected))
        with self.assertRaises(ValueError):
            triangles[0] = 0

    def test_surfaces_follow_tears(self):
        mesh = sheet(7)
        mesh.material = weft.Material(density=0.5, warp=200, weft=200, shear=20, bending=1e-6)
        mesh.material.strength = 4
        mesh.pins = [0, 1, 2, 3, 4, 5, 6, 42, 43, 44, 45, 46, 47, 48]
        made = weft.cloth_from_mesh(mesh)
        cloth = weft.Cloth.create(weft.build_model(made.scene))
        surface = weft.surface_of_mesh(mesh, made)
        finer = weft.map_surface(mesh, made, sheet(13))
        triangles = surface.triangles()
        before = triangles.copy()
        self.assertFalse(surface.follow(cloth))
        stretch = 0
        while cloth.particle_count() == 49 and stretch < 0.5:
            stretch += 2e-3
            for pin in mesh.pins[7:]:
                cloth.move_fixed(pin, mesh.positions[pin] * [1 + stretch, 1, 1])
            cloth.step(1 / 60)
        self.assertGreater(cloth.particle_count(), 49)
        with self.assertRaisesRegex(weft.Error, r"from: has torn, so follow\(\) comes first"):
            surface.read_vertices(cloth)
        for each in (surface, finer):
            self.assertTrue(each.follow(cloth))
            self.assertFalse(each.follow(cloth))
            count = each.vertex_count()
            self.assertEqual(each.read_vertices(cloth)[0].shape, (count, 3))
            split_from = each.split_from()
            self.assertTrue(np.all(split_from < count - len(split_from)))
            self.assertEqual(each.triangles().max() + 1, count)
        self.assertGreater(surface.vertex_count(), 49)
        self.assertEqual(surface.vertex_count(), 49 + len(surface.split_from()))
        self.assertTrue(np.array_equal(triangles, before))


if __name__ == "__main__":
    unittest.main()
