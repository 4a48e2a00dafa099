#!/usr/bin/env python3
"""The parts of tools/profile on samples and reports that are given."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from xml.etree import ElementTree

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools/profiling"))

import figures  # noqa: E402
import flame_graph  # noqa: E402
import stacks  # noqa: E402

STEP, RELAX = "weft::Cloth::step", "weft::simd::avx2::relax_quads"
SCRIPT = """
            e3f0 weft::simd::avx2::(anonymous namespace)::relax_quads (/w/weft)
            1aaa weft::Cloth::step (/w/weft)
            0001 main (/w/weft)

            e3f4 weft::simd::avx2::(anonymous namespace)::relax_quads (/w/weft)
            1aaa weft::Cloth::step (/w/weft)
            0001 main (/w/weft)

            e3f0 weft::simd::avx2::(anonymous namespace)::relax_quads (/w/weft)
            1aaa weft::Cloth::step (/w/weft)
            0001 main (/w/weft)

            1bbb weft::Cloth::step (/w/weft)
            0001 main (/w/weft)

            e3f0 __memcpy_avx (/usr/lib/libc.so.6)
            0002 main (/w/weft)
"""
LEVELS = [{"name": "L1", "size": 1000, "bytes_per_second": 1e9},
          {"name": "DRAM", "size": 1e15, "bytes_per_second": 1e8}]


def report():
    return {"scene": "somewhere", "particles": 100, "constraints": 400, "springs": 0,
            "membrane_elements": 50, "bending_elements": 0, "anchors": 0, "solver_used": "small_steps",
            "isa": "avx2", "ms_per_frame": 4, "substeps": 10, "max_error": 0.01,
            "status": "converged", "bytes_per_particle": 20,
            "stages": {"predict": 1, "solve_positions": 2.9, "commit": 0}}


class Stacks(unittest.TestCase):
    def test_samples_are_stacks_from_the_caller_inwards(self):
        samples = stacks.read_stacks(SCRIPT, "/w/weft")
        names = stacks.named(samples)
        self.assertEqual(samples.total(), 5)
        self.assertEqual(names[("main", STEP, RELAX)], 3)
        self.assertEqual(names[("main", "__memcpy_avx")], 1)
        self.assertEqual(stacks.hot_addresses(samples).most_common(1), [(0xe3f0, 2)])

    def test_what_a_step_calls_is_told_apart(self):
        inside, share = stacks.within(stacks.read_stacks(SCRIPT, "/w/weft"), STEP)
        self.assertEqual(share, 0.8)
        self.assertEqual(stacks.self_counts(inside), {RELAX: 3, STEP: 1})

    def test_names_lose_what_stands_in_brackets(self):
        for name, bare in (
                ("weft::Team::for_each<weft::f()::{lambda(int)#1}>", "weft::Team::for_each"),
                ("void weft::sum<float>(std::vector<int> const&) const", "weft::sum"),
                ("weft::A::operator()", "weft::A::operator()"),
                ("weft::share(int)::{lambda(int)#1}::_FUN(int)", "weft::share::lambda::_FUN"),
                ("weft::(anonymous namespace)::run", "weft::run"),
                ("[unknown]", "[unknown]")):
            self.assertEqual(stacks.without_arguments(name), bare)

    def test_rooms_and_short_names(self):
        self.assertEqual([stacks.room_of(n) for n in (RELAX, STEP, "weft::tools::run", "memcpy")],
                         ["kernels", "engine", "program", "libraries"])
        self.assertEqual(stacks.short(RELAX), "relax_quads (avx2)")
        self.assertEqual(stacks.short(STEP), "Cloth::step")


class FlameGraph(unittest.TestCase):
    NAMES = Counter({("a", "b"): 3, ("a", "c"): 1, ("d",): 4})

    def test_a_box_is_as_wide_as_its_samples_and_stands_on_its_caller(self):
        boxes = {box[0]: box[1:] for box in flame_graph.boxes_of(flame_graph.tree_of(self.NAMES))}
        self.assertEqual(boxes, {"a": (4, 0, 0, 0.5), "b": (3, 1, 0, 0.375),
                                 "c": (1, 1, 0.375, 0.125), "d": (4, 0, 0.5, 0.5)})

    def test_the_picture_is_xml_with_a_box_for_each_function(self):
        svg = flame_graph.svg_of(self.NAMES + Counter({("e<&>",): 1}), "x < y")
        boxes = ElementTree.fromstring(svg).findall("{http://www.w3.org/2000/svg}g")
        self.assertEqual(len(boxes), 5)
        self.assertIn("<title>a: 44.4 %, 4 samples</title>", svg)

    def test_what_is_too_narrow_to_see_is_left_out(self):
        names = Counter({("wide",): 100000, ("narrow",): 1})
        self.assertNotIn("narrow", flame_graph.svg_of(names, ""))


class Figures(unittest.TestCase):
    def test_stages_have_time_per_particle_and_substep_and_a_share_of_copying(self):
        predict, solve, commit = figures.stage_rows(report(), LEVELS)
        # 2000 bytes in DRAM take 20 us to copy, 0.2 ms in ten substeps.
        self.assertEqual(predict[:3], ("predict", 1, 0.25))
        self.assertAlmostEqual(predict[3], 1e6 / 10 / 100)
        self.assertAlmostEqual(predict[4], 0.2)
        self.assertAlmostEqual(solve[4], 0.2 / 2.9)
        self.assertEqual(commit[4], 0)
        self.assertAlmostEqual(figures.sum_of_stages(report()), 0.975)

    def test_a_cloth_that_fits_a_cache_is_held_against_that_cache(self):
        small = {**report(), "bytes_per_particle": 10}
        self.assertEqual(figures.level_of(1000, LEVELS)[0], "L1")
        self.assertAlmostEqual(figures.stage_rows(small, LEVELS)[0][4], 0.01)

    def test_kernels_have_the_items_that_they_go_through(self):
        counts = {RELAX: 50, "weft::simd::avx2::membrane_sweep": 25, "weft::simd::avx2::bend": 20,
                  STEP: 4.9, "memcpy": 0.1}
        rows = figures.kernel_rows(counts, report(), LEVELS)
        self.assertEqual([row[0] for row in rows], ["relax_quads (avx2)", "membrane_sweep (avx2)",
                                                    "bend (avx2)", "Cloth::step"])
        self.assertEqual([row[4] for row in rows], ["constraint", "triangle", "particle", "particle"])
        self.assertAlmostEqual(rows[0][3], 1e6 * 2 / 10 / 400)
        self.assertAlmostEqual(rows[1][3], 1e6 * 1 / 10 / 50)

    def test_the_text_fits_a_terminal_and_tells_no_time_without_its_error(self):
        text = figures.text_of(report(), {RELAX: 3, "weft::" + "long_name" * 9: 1},
                               [("kernels/simd/relax.h:7", 0.5)], LEVELS)
        self.assertLessEqual(max(map(len, text.splitlines())), 80)
        self.assertIn("4 ms per frame in 10 substeps, at max error of the law 1 %, converged", text)
        self.assertIn("sum                             97.5 %      3.9\n", text)
        self.assertIn("kernels/simd/relax.h:7", text)
        fast = {**report(), "ms_per_frame": 0.01}
        self.assertIn(" > 100 %\n", figures.text_of(fast, {RELAX: 3}, [], LEVELS))
        many = figures.kernel_rows({f"f{i:02}": 50 - i for i in range(50)}, report(), LEVELS)
        self.assertEqual([row[0] for row in many], [f"f{i:02}" for i in range(20)])


class Program(unittest.TestCase):
    def test_without_perf_and_valgrind_it_stops_with_a_line(self):
        with tempfile.TemporaryDirectory() as empty:
            done = subprocess.run([sys.executable, ROOT / "tools/profile", "hang"],
                                  capture_output=True, text=True,
                                  env={**os.environ, "PATH": empty})
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertIn("perf cannot sample here, and valgrind is missing", done.stderr)

    def test_without_a_scene_it_explains_itself(self):
        done = subprocess.run([sys.executable, ROOT / "tools/profile"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("usage: profile SCENE", done.stdout)


if __name__ == "__main__":
    unittest.main()
