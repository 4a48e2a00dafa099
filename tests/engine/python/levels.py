"""Levels of detail and copies: a mesh that follows another, a shape and a state that are taken over."""
import unittest

import numpy as np
from sheets import cloth_of, model_of, sheet

import weft

MAP = np.array([(1.3, 0.2, -0.1), (0.1, 0.9, 0.3), (-0.2, 0.1, 0.8)])
PLACE = np.array((3, -5, 2))
TURN = np.array([(0, 0, 1), (0, 1, 0), (-1, 0, 0)])  # a quarter about y


def bowl(positions):
    """In the place of a level square."""
    x, z = positions[:, 0] - 0.5, positions[:, 2] - 0.5
    return np.stack([positions[:, 0], 0.5 * (x * x - z * z), positions[:, 2]], axis=-1)


class Levels(unittest.TestCase):
    def setUp(self):
        self.mesh, self.other = sheet(6), sheet(17)

    def make(self):
        self.made = weft.cloth_from_mesh(self.mesh)
        self.cloth = weft.Cloth.create(weft.build_model(self.made.scene))
        self.surface = weft.map_surface(self.mesh, self.made, self.other)

    def test_a_finer_mesh_follows_every_affine_map(self):
        self.make()
        self.cloth.write_positions(self.cloth.read_positions() @ MAP.T + PLACE)
        found, normals = self.surface.read_vertices(self.cloth)
        self.assertEqual(found.shape, (17 * 17, 3))
        self.assertLess(np.abs(found - (self.other.positions @ MAP.T + PLACE)).max(), 3e-6)
        normal = np.cross(MAP[:, 0], MAP[:, 2])
        self.assertTrue(np.allclose(np.abs(normals @ normal), np.linalg.norm(normal), atol=1e-5))

    def test_a_bent_one_follows_rigid_motions_at_its_distance(self):
        self.mesh.positions = bowl(self.mesh.positions)
        self.other.positions = bowl(self.other.positions) + (0, 0.02, 0)
        self.make()
        start, _ = self.surface.read_vertices(self.cloth)
        self.assertLess(np.abs(start - self.other.positions).max(), 1e-6)
        self.cloth.write_positions(self.cloth.read_positions() @ TURN.T + PLACE)
        near = self.surface.clone().read_vertices(self.cloth, origin=PLACE)[0]
        self.assertLess(np.abs(near - self.other.positions @ TURN.T).max(), 2e-6)

    def test_a_mesh_that_is_far_is_refused(self):
        self.make()
        self.other.positions = self.other.positions + (0, 0.5, 0)
        with self.assertRaisesRegex(weft.Error, "0.5"):
            weft.map_surface(self.mesh, self.made, self.other, max_distance=0.4)
        self.assertEqual(weft.map_surface(self.mesh, self.made, self.other, 0.6).vertex_count(), 17 * 17)

    def test_another_level_takes_shape_and_velocities(self):
        self.make()
        turning, moving = np.array((0.1, 2, -0.3)), np.array((1, 0, 0.5))
        self.cloth.write_positions(self.cloth.read_positions() @ TURN.T + PLACE)
        self.cloth.change(weft.Changes(release=self.mesh.pins))
        self.cloth.write_velocities(moving + np.cross(turning, self.cloth.read_positions()))
        fine = weft.Cloth.create(model_of(sheet(17, pins=[])))
        self.surface.copy_shape(self.cloth, fine)
        expected = self.other.positions @ TURN.T + PLACE
        self.assertLess(np.abs(fine.read_positions() - expected).max(), 2e-6)
        velocities = moving + np.cross(turning, expected)
        self.assertLess(np.abs(fine.read_velocities() - velocities).max(), 1e-5)
        before = fine.state_hash()
        with self.assertRaises(weft.Error):
            self.surface.copy_shape(fine, self.cloth)
        with self.assertRaisesRegex(weft.Error, "to: "):
            self.surface.copy_shape(fine, fine)
        self.assertEqual(fine.state_hash(), before)


class States(unittest.TestCase):
    def setUp(self):
        self.cloth = cloth_of(9)
        self.ball = self.cloth.add_body(weft.Body(shape=weft.build_shape(
            weft.Ball(centre=(0.7, -0.25, 0.5), radius=0.2))))
        self.cloth.set_gravity((0, -8, 0))
        for _ in range(15):
            self.cloth.step(0.01)

    def test_a_copy_goes_on_as_the_other_does(self):
        other = weft.Cloth.create(self.cloth.model)
        other.copy_state(self.cloth)
        touched = 0
        for _ in range(15):
            self.cloth.step(0.01)
            touched = max(touched, other.step(0.01).body_contacts)
            self.assertEqual(other.state_hash(), self.cloth.state_hash())
        self.assertGreater(touched, 0)
        self.assertEqual(other.body_load(self.ball).force.tolist(),
                         self.cloth.body_load(self.ball).force.tolist())

    def test_with_a_tolerance_of_its_own(self):
        exact = weft.Cloth.create(self.cloth.model, weft.Settings(tolerance=1e-3))
        exact.copy_state(self.cloth)
        self.assertTrue(np.array_equal(exact.read_positions(), self.cloth.read_positions()))
        self.assertTrue(np.array_equal(exact.read_velocities(), self.cloth.read_velocities()))
        self.assertEqual(exact.settings.tolerance, 1e-3)
        for _ in range(5):
            report = exact.step(0.01)
            self.assertEqual(report.status, weft.Status.converged)
            self.assertLessEqual(report.max_error, 1e-3)

    def test_of_another_model_it_is_refused(self):
        other = cloth_of(8)
        other.step(0.01)
        before = other.state_hash()
        with self.assertRaises(weft.Error):
            other.copy_state(self.cloth)
        self.assertEqual(other.state_hash(), before)


if __name__ == "__main__":
    unittest.main()
