"""Seams against closed forms: how fast they close, with which force, and what holds then."""
import unittest

import numpy as np
from sheets import sheet

import weft

FRAME = 1 / 60
APART = 0.6  # m


def two_particles(time, max_force=np.inf, fixed=()):
    """Of 1 and 2 kg, without gravity."""
    scene = weft.SceneDescription(positions=[(0, 0, 0), (APART, 0, 0)], masses=[1, 2], fixed=fixed,
                                  seams=[(0, 1, time, max_force)], gravity=(0, 0, 0))
    return weft.Cloth.create(weft.build_model(scene))


def gap(cloth, a=0, b=1):
    return np.linalg.norm(cloth.position(a) - cloth.position(b))


class Seams(unittest.TestCase):
    def test_closes_evenly_in_its_time_where_both_masses_say(self):
        cloth = two_particles(time=0.5)
        for frame in range(1, 29):
            report = cloth.step(FRAME)
            self.assertEqual(report.open_seams, 1)
            left = APART * (1 - 2 * FRAME * frame)
            self.assertAlmostEqual(gap(cloth), left, delta=0.02 * left)
        for _ in range(5):
            report = cloth.step(FRAME)
        self.assertEqual(report.open_seams, 0)
        self.assertLessEqual(report.max_seam_gap, 1e-4)
        self.assertEqual((report.late_seams, report.held_apart), (0, 0))
        self.assertEqual((report.worst_seam, report.worst_held), (weft.kNoIndex, weft.kNoIndex))
        self.assertTrue(np.allclose(cloth.position(0), (APART * 2 / 3, 0, 0), atol=1e-3))
        # It holds then, whatever pulls: both go along as one.
        cloth.write_forces([(0, 0, 0), (0, 300, 0)])
        for _ in range(30):
            self.assertLessEqual(cloth.step(FRAME).max_seam_gap, 1e-4)
        self.assertAlmostEqual(cloth.velocity(0)[1], 300 / 3 * 0.5, delta=0.5)

    def test_is_released_and_closes_again(self):
        cloth = two_particles(time=0.5)
        for _ in range(35):
            cloth.step(FRAME)
        cloth.write_forces([(0, 0, 0), (2, 0, 0)])
        cloth.release_seams([0])
        for _ in range(30):
            self.assertEqual(cloth.step(FRAME).open_seams, 0)
        self.assertAlmostEqual(gap(cloth), 0.5 * 0.5**2, delta=0.01)  # 2 N on 2 kg
        cloth.write_forces([])
        cloth.close_seams([0])
        self.assertEqual(cloth.step(FRAME).open_seams, 1)
        for _ in range(40):
            cloth.step(FRAME)
        self.assertLessEqual(gap(cloth), 1e-4)
        with self.assertRaisesRegex(ValueError, "no such seam"):
            cloth.release_seams([1])

    def test_pulls_no_harder_than_it_may(self):
        cloth = two_particles(time=0.1, max_force=0.5, fixed=[0])  # of itself at 6 m/s
        work = 0
        for frame in range(1, 61):
            work += cloth.step(FRAME).seam_work
            left = APART - 0.5 / 2 * (FRAME * frame) ** 2 / 2
            self.assertAlmostEqual(gap(cloth), left, delta=0.01 * left)
        self.assertAlmostEqual(cloth.energy().kinetic, 2 * 0.25 ** 2 / 2, delta=0.003)
        self.assertAlmostEqual(work, cloth.energy().kinetic, delta=0.003)

    def test_panels_of_a_mesh_are_sewn_while_they_move(self):
        mesh = panels(size=5, apart=0.2)
        mesh.seam_time, mesh.seam_force = 0.5, 20
        scene = weft.cloth_from_mesh(mesh).scene
        self.assertEqual(scene.seams[["a", "b"]].tolist(), [(v, v + 25) for v in range(20, 25)])
        self.assertTrue(np.all(scene.seams["time"] == 0.5) and np.all(scene.seams["max_force"] == 20))
        cloth = weft.Cloth.create(weft.build_model(scene))
        opened = [cloth.step(FRAME).open_seams for _ in range(45)]
        self.assertEqual((opened[0], opened[-1]), (5, 0))
        positions = cloth.read_positions()
        self.assertLessEqual(np.linalg.norm(positions[20:25] - positions[45:50], axis=1).max(), 1e-4)


def panels(size, apart):
    """Two sheets, one above the other, each held by the edge that is farthest from the seam."""
    one = sheet(size)
    count = len(one.positions)
    mesh = weft.MeshDescription(
        positions=np.concatenate([one.positions, one.positions + (0, apart, 0)]),
        pins=np.concatenate([one.pins, one.pins + count]), material=one.material,
        seams=[(v, v + count) for v in range(count - size, count)])
    faces = one.corners.reshape(-1, 4)
    mesh.set_faces(np.concatenate([faces, faces + count]))
    return mesh


if __name__ == "__main__":
    unittest.main()
