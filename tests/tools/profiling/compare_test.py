#!/usr/bin/env python3
"""perf/compare tells changes from noise, on runs that are given."""
import importlib.machinery
import importlib.util
import itertools
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
PROGRAM = pathlib.Path(__file__).resolve().parents[3] / "perf/compare"
loader = importlib.machinery.SourceFileLoader("compare", str(PROGRAM))
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
loader.exec_module(compare)

NOISE = [1.00, 1.05, 0.97, 1.02, 0.99, 1.08, 0.95]


def benchmark_json(times):
    entries = [{"name": name, "run_type": "iteration", "cpu_time": t, "time_unit": "us"}
               for name, all_times in times.items() for t in all_times]
    entries.append({"name": "a_mean", "run_type": "aggregate", "cpu_time": 1, "time_unit": "us"})
    return json.dumps({"context": {}, "benchmarks": entries})


class Chance(unittest.TestCase):
    def test_it_is_the_share_of_all_orders_that_differ_as_much(self):
        for m, n in ((2, 3), (3, 4), (4, 4)):
            everything = range(m + n)
            wrong = []
            for chosen in itertools.combinations(everything, m):
                others = [k for k in everything if k not in chosen]
                wrong.append(sum(x > y for x in chosen for y in others))
            for chosen, u in zip(itertools.combinations(everything, m), wrong):
                others = [k for k in everything if k not in chosen]
                least = min(u, m * n - u)
                as_far = sum(min(w, m * n - w) <= least for w in wrong)
                expected = min(1, as_far / math.comb(m + n, m)) if 2 * least < m * n else 1
                self.assertAlmostEqual(compare.chance(list(chosen), others), expected)

    def test_many_repetitions_take_the_normal_distribution_which_agrees_with_counting(self):
        a, b = list(range(0, 24, 2)), [x + 5.5 for x in range(0, 24, 2)]
        counted = compare.chance(a, b)
        more = compare.chance(a + [11], b + [11.5])
        self.assertGreater(counted, 0.005)
        self.assertLess(abs(math.log(more / counted)), 0.7)

    def test_equal_times_differ_in_nothing(self):
        self.assertEqual(compare.chance([1, 1, 1, 1], [1, 1, 1, 1]), 1)


class Verdicts(unittest.TestCase):
    def rows(self, a, b):
        return {row[0]: row for row in compare.compare(a, b)[0]}

    def test_changes_beyond_noise_are_told_both_ways(self):
        rows = self.rows({"same": NOISE, "up": NOISE, "down": NOISE},
                         {"same": NOISE[::-1], "up": [1.3 * t for t in NOISE],
                          "down": [0.7 * t for t in NOISE]})
        self.assertEqual([rows[name][-1] for name in ("same", "up", "down")],
                         ["", "slower", "faster"])
        self.assertAlmostEqual(rows["up"][5], 1.3)

    def test_a_change_within_the_spread_is_not_told(self):
        self.assertEqual(self.rows({"x": NOISE}, {"x": [1.02 * t for t in NOISE]})["x"][-1], "")

    def test_a_change_that_matters_to_nobody_is_not_told(self):
        quiet = [1 + 1e-5 * i for i in range(7)]
        self.assertEqual(self.rows({"x": quiet}, {"x": [1.005 * t for t in quiet]})["x"][-1], "")
        self.assertEqual(self.rows({"x": quiet}, {"x": [1.02 * t for t in quiet]})["x"][-1],
                         "slower")

    def test_among_many_benchmarks_luck_is_expected(self):
        lucky = [1.00, 1.01, 1.02, 1.03], [1.04, 1.05, 1.06, 1.07]
        alone = self.rows({"x": lucky[0]}, {"x": lucky[1]})
        self.assertEqual(alone["x"][-1], "slower")
        many = {f"other{i}": NOISE for i in range(20)}
        among = self.rows({"x": lucky[0], **many}, {"x": lucky[1], **many})
        self.assertEqual(among["x"][-1], "")

    def test_three_repetitions_tell_nothing(self):
        rows, alone = compare.compare({"x": [1, 1.1, 1.2]}, {"x": [2, 2.1, 2.2]})
        self.assertEqual(rows[0][-1], "")
        self.assertIn("3 repetitions tell nothing", compare.text_of(rows, alone, 3))


class Program(unittest.TestCase):
    def run_on(self, *contents):
        with tempfile.TemporaryDirectory() as folder:
            paths = []
            for i, content in enumerate(contents):
                path = pathlib.Path(folder) / f"{i}.json"
                path.write_text(content)
                paths.append(path)
            return subprocess.run([sys.executable, PROGRAM, *paths], capture_output=True, text=True)

    def test_it_prints_a_table_and_ends_with_1_if_something_is_slower(self):
        a = benchmark_json({"kernel/20": NOISE, "gone": NOISE})
        b = benchmark_json({"kernel/20": [2 * t for t in NOISE]})
        slower = self.run_on(a, b)
        self.assertEqual(slower.returncode, 1)
        self.assertIn("kernel/20          1 us ±3 %          2 us ±3 %   2.000  slower\n", slower.stdout)
        self.assertIn("0 faster, 1 slower, 0 within noise\nin one file alone: gone\n", slower.stdout)
        self.assertNotIn("a_mean", slower.stdout)
        self.assertEqual(self.run_on(b, a).returncode, 0)

    def test_what_cannot_be_compared_is_told_in_a_line(self):
        good = benchmark_json({"x": NOISE})
        for bad, word in (("{", "is not the JSON"), ("[1]", "is not the JSON"),
                          (benchmark_json({"y": NOISE}), "no benchmark in common")):
            refused = self.run_on(good, bad)
            self.assertEqual(refused.returncode, 2)
            self.assertEqual(refused.stderr.count("\n"), 1)
            self.assertIn(word, refused.stderr)
        missing = subprocess.run([sys.executable, PROGRAM, "none.json", "none.json"],
                                 capture_output=True, text=True)
        self.assertEqual(missing.returncode, 2)
        self.assertIn("cannot read 'none.json'", missing.stderr)


if __name__ == "__main__":
    unittest.main()
