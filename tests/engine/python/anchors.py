"""Anchors against closed forms: a particle of 1 kg, and the anchor that keeps it near a point."""
import math
import unittest

import numpy as np

import weft

GRAVITY = 10  # m/s^2, along -y
INFINITE = math.inf


def one_particle(max_distance=INFINITE, normal=(0, 0, 0), backstop_distance=0.0, backstop_radius=0.0):
    """It begins at its point, the origin."""
    anchor = (0, (0, 0, 0), normal, max_distance, backstop_distance, backstop_radius)
    model = weft.build_model(weft.SceneDescription(positions=[(0, 0, 0)], masses=[1], anchors=[anchor]))
    assert weft.describe(model).anchors == 1
    return weft.Cloth.create(model, weft.Settings(substeps=50))


def run(cloth, steps, dt=0.01):
    reports = [cloth.step(dt) for _ in range(steps)]
    assert all(report.status == weft.Status.converged for report in reports)
    return reports[-1]


class Anchors(unittest.TestCase):
    def assert_at(self, cloth, expected, within=1e-4):
        self.assertLess(np.linalg.norm(cloth.position(0) - expected), within)

    def test_with_distance_0_it_is_where_the_point_is(self):
        cloth = one_particle(max_distance=0)
        before = np.zeros(3)
        for frame in range(1, 30):
            point = np.array((math.sin(0.1 * frame), 1 - math.cos(0.1 * frame), 0))
            cloth.move_anchors([point])
            self.assertLess(run(cloth, 1).max_anchor_error, 1e-7)
            self.assert_at(cloth, point, 1e-7)
            self.assertTrue(np.allclose(cloth.velocity(0), 100 * (point - before), atol=1e-4))
            before = point

    def test_it_hangs_as_low_as_it_may(self):
        cloth = one_particle(max_distance=0.1)
        self.assertLessEqual(run(cloth, 50).max_anchor_error, 1e-4)
        self.assert_at(cloth, (0, -0.1, 0))
        cloth.limit_anchors([weft.AnchorLimit(max_distance=0.3)])
        run(cloth, 50)
        self.assert_at(cloth, (0, -0.3, 0))
        cloth.scale_anchors(0.5)
        run(cloth, 50)
        self.assert_at(cloth, (0, -0.15, 0))

    def test_a_backstop_bears_it_until_it_is_let_go(self):
        cloth = one_particle(normal=(0, 3, 0), backstop_distance=0.02, backstop_radius=INFINITE)
        run(cloth, 50)
        self.assert_at(cloth, (0, -0.02, 0))
        cloth.limit_anchor(0, weft.AnchorLimit(max_distance=INFINITE, backstop=False))
        run(cloth, 30)
        self.assertAlmostEqual(cloth.position(0)[1], -0.02 - GRAVITY * 0.3 ** 2 / 2, delta=1e-3)

    def test_it_slides_down_a_backstop_that_leans(self):
        angle = math.radians(30)
        normal = np.array((math.sin(angle), math.cos(angle), 0))
        cloth = one_particle(normal=normal, backstop_radius=INFINITE)
        run(cloth, 50)
        way = GRAVITY * math.sin(angle) * 0.5 ** 2 / 2
        down = np.array((math.cos(angle), -math.sin(angle), 0))
        self.assert_at(cloth, way * down, 0.01 * way)
        # The plane is turned upright: the particle is in it, whichever way it came there.
        cloth.move_anchors([(0.1, 0, 0)], normals=[(2, 0, 0)])
        run(cloth, 1)
        self.assertGreaterEqual(cloth.position(0)[0], 0.1 - 1e-4)

    def test_refused(self):
        cloth = one_particle(max_distance=0.1)
        run(cloth, 5)
        before = cloth.state_hash()
        for pattern, call, argument in (
                ("points", cloth.move_anchors, np.zeros((2, 3))),
                (r"points\[0\]", cloth.move_anchors, [(0, math.nan, 0)]),
                ("limits", cloth.limit_anchors, []),
                ("max_distance.*-1", cloth.limit_anchors, [weft.AnchorLimit(max_distance=-1)]),
                ("scale.*-1", cloth.scale_anchors, -1)):
            with self.assertRaisesRegex(weft.Error, pattern):
                call(argument)
        self.assertEqual(cloth.state_hash(), before)


if __name__ == "__main__":
    unittest.main()
