"""Bodies of every kind against closed forms: a particle of 2 kg that lies, slides, rides and falls."""
import math
import unittest

import numpy as np

import weft

GRAVITY, MASS, THICKNESS = 10, 2, 0.005
UP = np.array((0, 1, 0))

BOX = weft.box((1, 0.3, 1))
RAISED = weft.Pose(position=(0, 1, 0))
QUARTER = weft.Pose(rotation=(0, 0, math.sqrt(0.5), math.sqrt(0.5)))  # about z: x becomes y


def plate(height):
    """Two triangles, one-sided, which face up; the origin is in one of them."""
    corners = [(-1, height, -1), (-1, height, 2), (1, height, 2), (1, height, -1)]
    return weft.TriangleMesh(vertices=corners, triangles=[(0, 1, 2), (0, 2, 3)])


# m, where the surface is above the origin
KINDS = [
    (weft.Plane(offset=0.1), weft.Pose(), 0.1),
    (weft.Plane(normal=(0, 2, 0), offset=0.1), weft.Pose(), 0.05),
    (weft.Ball(centre=(0, 0.1, 0), radius=0.2), weft.Pose(), 0.3),
    (weft.Capsule(a=(-0.3, 0.05, 0), b=(0.3, 0.05, 0), radius_a=0.1, radius_b=0.1), weft.Pose(), 0.15),
    (weft.Capsule(a=(0, 0, 0), b=(0.3, 0, 0), radius_a=0.05, radius_b=0.1), QUARTER, 0.4),
    (BOX, weft.Pose(), 0.15),
    (BOX, RAISED, 1.15),
    (weft.Hull(points=np.concatenate([BOX.points, [(0, -2, 0)]])), weft.Pose(), 0.15),
    (weft.HeightField(columns=2, rows=3, spacing_x=2, spacing_z=1, heights=[0.1] * 6),
     weft.Pose(position=(-1, 0, -1)), 0.1),
    (weft.Torus(centre=(0.3, 0, 0), axis=(0, 2, 0), major=0.3, minor=0.1), weft.Pose(), 0.1),
    (plate(0.1), weft.Pose(), 0.1),
    (plate(0.1), RAISED, 1.1),
]


def particle(position, friction=0.3):
    scene = weft.SceneDescription(positions=[position], masses=[MASS], friction=friction)
    settings = weft.Settings(substeps=50)  # what sets in within a substep is not resolved
    return weft.Cloth.create(weft.build_model(scene), settings)


def add(cloth, shape, **fields):
    return cloth.add_body(weft.Body(shape=weft.build_shape(shape), thickness=THICKNESS, **fields))


def run(cloth, steps, dt=0.01):
    reports = [cloth.step(dt) for _ in range(steps)]
    assert all(report.status == weft.Status.converged for report in reports)
    return reports


class Kinds(unittest.TestCase):
    def test_each_bears_what_lies_on_it(self):
        for shape, pose, top in KINDS:
            with self.subTest(shape=shape, top=top):
                cloth = particle((0, top + 0.02, 0))
                body = add(cloth, shape, pose=pose)
                report = run(cloth, 60)[-1]
                self.assertAlmostEqual(cloth.position(0)[1], top + THICKNESS, delta=1e-5)
                self.assertEqual(report.body_contacts, 1)
                self.assertGreater(report.contact_ms.find, 0)
                self.assertGreater(report.contact_ms.sweep, 0)
                self.assertIn("contact_ms <weft.ContactMs: find ", repr(report))
                self.assertTrue(np.allclose(cloth.body_load(body).force, -MASS * GRAVITY * UP, atol=2e-3))
                contact, = cloth.body_contacts()
                self.assertEqual((contact["particle"], contact["body"]), (0, body))
                self.assertTrue(np.allclose(contact["normal"], UP, atol=2e-5))
                self.assertTrue(np.allclose(contact["point"], top * UP, atol=1e-5))
                self.assertGreater(contact["push"], 0)

    def test_one_with_a_mass_falls_and_takes_the_caller_s_force(self):
        cloth = particle((0, -9, 0))
        ball = weft.build_shape(weft.Ball(radius=0.1))
        mass = weft.mass_of(ball, 1000)
        self.assertAlmostEqual(mass.mass, 4000 / 3 * math.pi * 1e-3)
        body = cloth.add_body(weft.Body(shape=ball, pose=RAISED, mass=mass))
        cloth.set_body_velocity(body, weft.BodyVelocity(linear=(1, 0, 0), angular=(0, 2, 0)))
        cloth.set_body_force(body, (0, 0, 3 * mass.mass), (0, 0, 0))
        run(cloth, 20)
        self.assertTrue(np.allclose(cloth.body_pose(body).position, (0.2, 0.8, 0.06)))
        self.assertTrue(np.allclose(cloth.body_velocity(body).linear, (1, -2, 0.6)))
        self.assertTrue(np.allclose(cloth.body_velocity(body).angular, (0, 2, 0)))
        with self.assertRaisesRegex(ValueError, "moves by itself"):
            cloth.move_body(body, weft.Pose())

    def test_a_load_turns_its_body(self):
        cloth = particle((0.25, 0.155, -0.125))
        body = add(cloth, BOX)
        run(cloth, 30)
        arm = cloth.position(0) - THICKNESS * UP
        moment = np.cross(arm, -MASS * GRAVITY * UP)
        self.assertTrue(np.allclose(cloth.body_load(body).moment, moment, atol=2e-3))

    def test_ids_are_not_used_again(self):
        cloth = particle((0, 1, 0))
        self.assertEqual([add(cloth, BOX), add(cloth, plate(0))], [0, 1])
        cloth.remove_body(1)
        self.assertEqual(add(cloth, BOX), 2)
        with self.assertRaisesRegex(weft.Error, "1"):
            cloth.body_load(1)


class Motion(unittest.TestCase):
    def test_friction_is_the_geometric_mean(self):
        angle, friction, time = math.radians(25), 0.2, 0.5
        normal = np.array((-math.sin(angle), math.cos(angle), 0))
        cloth = particle(THICKNESS * normal, friction=0.4)
        add(cloth, weft.Plane(normal=normal), friction=0.1)
        reports = run(cloth, 50)
        way = GRAVITY * (math.sin(angle) - friction * math.cos(angle)) * time ** 2 / 2
        self.assertAlmostEqual(-cloth.position(0)[0] / math.cos(angle), way, delta=0.01 * way)
        force = friction * MASS * GRAVITY * math.cos(angle)
        self.assertAlmostEqual(sum(r.friction_work for r in reports), force * way, delta=0.02 * force * way)

    def test_a_belt_takes_along_as_fast_as_friction_can(self):
        cloth = particle((0, THICKNESS, 0))
        belt = add(cloth, weft.Plane())  # 0.3, as the cloth
        work = 0
        for step in range(1, 51):
            cloth.move_body(belt, weft.Pose(position=(2 * 0.01 * step, 0, 0)))
            work += run(cloth, 1)[0].body_work
        way = 0.3 * GRAVITY * 0.5 ** 2 / 2
        self.assertAlmostEqual(cloth.position(0)[0], way, delta=0.01 * way)
        drawn = 0.3 * MASS * GRAVITY * 2 * 0.5  # force times the way of the belt
        self.assertAlmostEqual(work, drawn, delta=0.02 * drawn)

    def test_a_mesh_that_deforms_lifts(self):
        cloth = particle((0, 0.1 + THICKNESS, 0))
        mesh = add(cloth, plate(0.1))
        for step in range(1, 21):
            cloth.move_body_vertices(mesh, plate(0.1 + 0.01 * step).vertices)
            run(cloth, 1)
        self.assertAlmostEqual(cloth.position(0)[1], 0.3 + THICKNESS, delta=1e-4)
        self.assertAlmostEqual(cloth.velocity(0)[1], 1, delta=1e-2)
        cloth.place_body_vertices(mesh, plate(-2).vertices)
        run(cloth, 10)
        flight = 1 * 0.1 - GRAVITY * 0.1 ** 2 / 2
        self.assertAlmostEqual(cloth.position(0)[1], 0.3 + THICKNESS + flight, delta=1e-3)

    def test_what_is_off_or_elsewhere_is_not_there(self):
        cloth = particle((0, THICKNESS, 0))
        plane = add(cloth, weft.Plane())
        run(cloth, 10)
        self.assertAlmostEqual(cloth.position(0)[1], THICKNESS, delta=1e-6)
        cloth.switch_body(plane, False)
        run(cloth, 10)
        self.assertAlmostEqual(cloth.position(0)[1], THICKNESS - GRAVITY * 0.1 ** 2 / 2, delta=1e-3)
        cloth.place_body(plane, weft.Pose(position=(0, -1, 0)))
        cloth.switch_body(plane, True)
        run(cloth, 60)
        self.assertAlmostEqual(cloth.position(0)[1], -1 + THICKNESS, delta=1e-5)


class Depth(unittest.TestCase):
    def test_what_begins_inside_comes_out_and_the_report_says_how_deep_it_is(self):
        radius = 0.2
        cloth = particle((0, radius - 0.05, 0))
        add(cloth, weft.Ball(radius=radius))
        depths = [0.05 + THICKNESS]
        for _ in range(2):
            report = cloth.step(0.01)
            self.assertEqual(report.status, weft.Status.iteration_limit)
            depth = radius + THICKNESS - np.linalg.norm(cloth.position(0))
            self.assertAlmostEqual(report.max_penetration, depth, delta=1e-6)
            self.assertAlmostEqual(depths[-1] - depth, 2 * 0.01, delta=1e-3)  # at 2 m/s
            depths.append(depth)
        cloth.step(0.01)
        self.assertLess(run(cloth, 5)[-1].max_penetration, 1e-5)

    def test_of_spheres(self):
        scene = weft.SceneDescription(positions=[(0, 0, 0), (0.12, 0, 0), (1, 0, 0)], masses=[1, 1, 1],
                                      fixed=[0], spheres=[0], radii=[0.1, 0.05, 0.02])
        cloth = weft.Cloth.create(weft.build_model(scene))
        self.assertAlmostEqual(cloth.max_penetration(), 0.03, delta=1e-12)


if __name__ == "__main__":
    unittest.main()
