"""Forces, air, springs, materials and reports against closed forms."""
import math
import unittest

import numpy as np
from sheets import cloth_of, model_of, sheet

import weft


def cloth_of_scene(settings=weft.Settings(), **fields):
    return weft.Cloth.create(weft.build_model(weft.SceneDescription(**fields)), settings)


def run(cloth, steps, dt=0.01):
    reports = [cloth.step(dt) for _ in range(steps)]
    assert all(report.status == weft.Status.converged for report in reports)
    return reports


def plate(**air):
    """A level triangle of 0.5 m^2 and 6 kg, whose corners nothing joins."""
    return cloth_of_scene(positions=[(0, 0, 0), (1, 0, 0), (0, 0, 1)], masses=[2, 2, 2],
                          air=weft.Air(triangles=[(0, 1, 2)], **air))


class Forces(unittest.TestCase):
    def test_gravity_and_forces(self):
        cloth = cloth_of_scene(positions=[(0, 0, 0), (1, 0, 0)], masses=[2, 4], gravity=(0, -10, 0))
        cloth.write_forces([(2, 20, 0), (0, 0, 4)])
        run(cloth, 50)
        self.assertTrue(np.allclose(cloth.read_velocities(), [(0.5, 0, 0), (0, -5, 0.5)], atol=1e-5))
        cloth.write_forces([])
        cloth.set_gravity((0, 0, 2))
        run(cloth, 50)
        self.assertTrue(np.allclose(cloth.read_velocities(), [(0.5, 0, 1), (0, -5, 1.5)], atol=1e-5))

    def test_wind_bears_a_plate_and_presses_it_down(self):
        bears = math.sqrt(2 * 6 * 10 / (1.2 * 0.5 * 2))  # m/s: 1/2 density A drag v^2 = m g
        cloth = plate(density=1.2, drag=2, wind=(0, bears, 0))
        run(cloth, 20)
        self.assertLess(np.abs(cloth.read_velocities()).max(), 1e-3)
        cloth.set_wind((0, -bears, 0))
        run(cloth, 1, dt=0.001)
        self.assertTrue(np.allclose(cloth.read_velocities(), (0, -2 * 10 * 0.001, 0), atol=3e-4))

    def test_a_wind_that_blows_along_a_plate_does_nothing(self):
        cloth = plate(drag=2, lift=1, wind=(9, 0, 0))
        run(cloth, 1, dt=0.001)
        self.assertTrue(np.allclose(cloth.read_velocities(), (0, -0.01, 0), atol=1e-4))

    def test_ram_pressure_bears_a_plate(self):
        bears = math.sqrt(2 * 6 * 10 / (1.2 * 0.5 * 1.5))  # m/s
        cloth = plate(density=1.2, ram=1.5, wind=(0, bears, 0))
        run(cloth, 20)
        self.assertLess(np.abs(cloth.read_velocities()).max(), 1e-3)

    def test_pressures(self):
        cloth = cloth_of_scene(weft.Settings(scheme=weft.Scheme.implicit),
                               positions=[(0, 0, 0), (0, 0, 1), (1, 0, 0)], masses=[2, 2, 2],
                               surface=[(0, 1, 2)], gravity=(0, 0, 0),
                               pressures=[weft.Pressure(pressure=24)])
        run(cloth, 1)
        self.assertTrue(np.allclose(cloth.read_velocities(), (0, 0.02, 0), atol=1e-6))  # p A t / m
        cloth.set_pressure(-24)
        run(cloth, 1)
        self.assertTrue(np.allclose(cloth.read_velocities(), 0, atol=1e-6))
        self.assertEqual([now.pressure for now in cloth.pressures()], [-24])
        cloth.set_pressure([weft.Pressure(pressure=12, triangles=[0]), weft.Pressure(pressure=36)])
        run(cloth, 1)
        self.assertTrue(np.allclose(cloth.read_velocities(), (0, 0.04, 0), atol=1e-6))
        cloth.set_pressure(0)
        self.assertEqual(cloth.pressures(), [])
        for wrong, message in ((math.nan, r"pressures\[0\].pressure: .*nan"),
                               ([weft.Pressure(pressure=1, gas=True)], r"pressures\[0\].gas: "),
                               ([weft.Pressure(pressure=1, triangles=[4])],
                                r"pressures\[0\].triangles\[0\]: .*4")):
            with self.assertRaisesRegex(weft.Error, message):
                cloth.set_pressure(wrong)
        with self.assertRaises(ValueError):
            cloth.set_pressure("high")

    def test_a_gas_keeps_its_pressure_times_its_volume(self):
        corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        cloth = cloth_of_scene(positions=corners, masses=[1] * 4, gravity=(0, 0, 0),
                               surface=[(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
        cloth.set_pressure([weft.Pressure(pressure=1000, gas=True, ambient=5000)])
        self.assertAlmostEqual(cloth.pressures()[0].volume, 1 / 6, 12)
        run(cloth, 3)
        now = cloth.pressures()[0]
        self.assertGreater(now.volume, 0.18)
        self.assertAlmostEqual((5000 + now.pressure) * now.volume, 1000, 6)

    def test_all_motion_decays(self):
        cloth = cloth_of_scene(positions=[(0, 0, 0)], velocities=[(3, 0, 0)], masses=[1],
                               gravity=(0, 0, 0), damping=weft.Damping(motion=2))
        run(cloth, 50)
        self.assertAlmostEqual(cloth.velocity(0)[0], 3 * math.exp(-2 * 0.5), delta=1e-3)


class Springs(unittest.TestCase):
    def test_strain_and_energy_of_what_is_written(self):
        cloth = cloth_of_scene(positions=[(0, 0, 0), (1, 0, 0), (2, 0, 0)], masses=[1, 1, 1], fixed=[0],
                               constraints=[(0, 1, 1, 0, 0.01), (1, 2, 1, 1, 0.02)])
        cloth.write_positions([(0, 0, 0), (1.03, 0, 0), (1.9, 2, 0)])
        cloth.write_velocities([(0, 0, 0), (0, 3, 0), (0, 0, 0)])
        strain, energy = cloth.strain(), cloth.energy()
        stretched = math.hypot(0.87, 2) - 1
        self.assertAlmostEqual(strain.max, stretched, delta=1e-9)
        self.assertAlmostEqual(strain.rms, math.sqrt((0.03 ** 2 + stretched ** 2) / 2), delta=1e-9)
        self.assertEqual(strain.worst_constraint, 1)
        self.assertEqual(strain.worst_element, weft.kNoIndex)
        self.assertAlmostEqual(energy.kinetic, 4.5, delta=1e-12)
        self.assertAlmostEqual(energy.potential, 10 * 2, delta=1e-12)
        elastic = 0.03 ** 2 / 2 / 0.01 + stretched ** 2 / 2 / 0.02
        self.assertAlmostEqual(energy.elastic, elastic, delta=1e-6 * elastic)
        self.assertAlmostEqual(energy.total(), energy.kinetic + energy.potential + energy.elastic, 12)

    def test_a_spring_is_stretched_by_its_weight(self):
        cloth = cloth_of_scene(positions=[(0, 0, 0), (0, -1, 0)], masses=[1, 3], fixed=[0],
                               constraints=[(0, 1, 1, 0, 0.002)], damping=weft.Damping(motion=10))
        run(cloth, 200)
        self.assertAlmostEqual(cloth.position(1)[1], -1 - 3 * 10 * 0.002, delta=1e-4)
        cloth.change(weft.Changes(compliances=[(0, 0.004)], rest_lengths=[(0, 0.9)], masses=[(1, 5)]))
        run(cloth, 200)
        self.assertAlmostEqual(cloth.position(1)[1], -0.9 - 5 * 10 * 0.004, delta=1e-4)


class Materials(unittest.TestCase):
    def test_a_material_of_the_caller(self):
        mesh = sheet(9, material=None, pins=[])
        mesh.material = weft.Material(density=0.4, warp=800, weft=300, shear=20, bending=1e-5,
                                      damping_stretch=0.01, damping_bending=0.02, damping_motion=0.5,
                                      drag=1.5, lift=0.7, thickness=0.002, friction=0.4)
        scene = weft.cloth_from_mesh(mesh).scene
        self.assertAlmostEqual(scene.masses.sum(), 0.4, delta=1e-12)  # of 1 m^2
        layers = scene.self_contact
        self.assertEqual((layers.on, layers.thickness, layers.friction), (False, 0.002, 0.4))
        damping, air = scene.damping, scene.air
        self.assertEqual((damping.stretch, damping.bending, damping.motion), (0.01, 0.02, 0.5))
        self.assertEqual((air.drag, air.lift, len(air.triangles)), (1.5, 0.7, 2 * 64))
        cloth = weft.Cloth.create(weft.build_model(scene))
        # The warp of what lies level runs along x.
        for stretched, stiffness in (((1.001, 1, 1), 800), ((1, 1, 1.001), 300)):
            cloth.write_positions(scene.positions * stretched)
            energy = stiffness * 0.001 ** 2 / 2
            self.assertAlmostEqual(cloth.energy().elastic, energy, delta=0.05 * energy)

    def test_the_warp_follows_the_texture(self):
        mesh = sheet(3)
        texture = mesh.positions[mesh.corners][:, [0, 2]]  # v along z
        self.assertTrue(np.allclose(weft.warp_from_texture(mesh, texture), (0, 0, 1)))
        with self.assertRaisesRegex(weft.Error, "texture"):
            weft.warp_from_texture(mesh, texture[1:])


class Reports(unittest.TestCase):
    def test_what_a_step_says(self):
        cloth = cloth_of(9, substeps=7)
        report = cloth.step(0.01)
        self.assertEqual((report.substeps, report.asleep), (7, False))
        self.assertAlmostEqual(report.max_strain, cloth.strain().max, delta=1e-9)
        self.assertAlmostEqual(report.rms_strain, cloth.strain().rms, delta=1e-9)
        self.assertEqual(report.worst_constraint, cloth.strain().worst_constraint)
        self.assertEqual(report.failed_particle, weft.kNoIndex)
        self.assertEqual(len(report.stage_seconds), len(weft.Stage.__members__))
        self.assertGreater(report.stage_seconds[int(weft.Stage.solve_positions)], 0)
        self.assertGreater(report.motion_error, 0)
        ms = report.contact_ms
        self.assertEqual((ms.find, ms.sweep, ms.verify), (0, 0, 0))
        self.assertRegex(repr(report), r"\A<weft.StepReport: \w+, substeps 7, .*max_strain [\d.e-]+, .*>\Z")
        self.assertNotIn("halvings", repr(report))

    def test_a_lift_is_work_of_its_pin(self):
        cloth = cloth_of_scene(positions=[(0, 0, 0), (0, -1, 0)], masses=[1, 2], fixed=[0],
                               constraints=[(0, 1, 1, 0, 0)])
        work = 0
        for step in range(1, 101):
            cloth.move_fixed([0], [(0, 0.002 * step, 0)])
            work += cloth.step(0.01).pin_work
        raised = 2 * 10 * 0.2 + 2 * 0.2 ** 2 / 2  # m g h and m v^2 / 2
        self.assertAlmostEqual(work, raised, delta=0.02 * raised)

    def test_what_is_not_finite_changes_nothing(self):
        cloth = cloth_of(5)
        cloth.write_forces(np.full((25, 3), 1e308))
        before = cloth.state_hash()
        report = cloth.step(0.01)
        self.assertEqual(report.status, weft.Status.non_finite_input)
        self.assertFalse(weft.committed(report.status))
        self.assertNotEqual(report.failed_particle, weft.kNoIndex)
        self.assertEqual(cloth.state_hash(), before)

    def test_what_rests_falls_asleep_until_it_is_woken(self):
        scene = weft.SceneDescription(positions=[(0, 0, 0), (0, -1, 0)], masses=[1, 1], fixed=[0],
                                      constraints=[(0, 1, 1, 0, 0)])
        cloth = weft.Cloth.create(weft.build_model(scene), weft.Settings(sleep=True))
        reports = [cloth.step(0.01) for _ in range(100)]
        self.assertEqual((reports[20].asleep, reports[-1].asleep), (False, True))
        self.assertEqual(reports[-1].substeps, 0)
        cloth.set_gravity((10, 0, 0))
        self.assertFalse(cloth.step(0.01).asleep)
        self.assertGreater(cloth.velocity(1)[0], 0.05)


class Frames(unittest.TestCase):
    def test_a_teleport_and_a_share_of_a_motion(self):
        cloth = weft.Cloth.create(model_of(sheet(6)))
        run(cloth, 5)
        positions, velocities = cloth.read_positions(), cloth.read_velocities()
        about = np.array((1, 2, 3))
        motion = weft.RigidMotion(translation=(0.5, 0, 0), rotation=(0, math.pi / 2, 0), about=about)
        cloth.teleport(motion)
        turn = np.array([(0, 0, 1), (0, 1, 0), (-1, 0, 0)])
        expected = about + (positions - about) @ turn.T + (0.5, 0, 0)
        self.assertTrue(np.allclose(cloth.read_positions(), expected, atol=1e-12))
        self.assertTrue(np.allclose(cloth.read_velocities(), velocities @ turn.T, atol=1e-12))
        cloth.carry(weft.RigidMotion(translation=(0, 4, 0)), 0.25)
        self.assertTrue(np.allclose(cloth.read_positions(), expected + (0, 1, 0), atol=1e-12))


if __name__ == "__main__":
    unittest.main()
