"""The study on Dask: 200 runs on two workers, one of which is killed on the way; then once more."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(os.environ["WEFT_EXAMPLES"]) / "study.py"
RUNS = 200
SHAPE = ["--seeds", str(RUNS // 8), "--size", "10", "--frames", "60"]


def command(folder, *arguments):
    return [sys.executable, str(SCRIPT), "--out", str(folder), *SHAPE, *arguments]


def files(folder):
    return {file.name: file.read_bytes() for file in folder.glob("*.npy")}


class Study(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_and_kill_a_worker(self, folder):
        """Kills one after 20 runs; returns how many runs ended after that."""
        with subprocess.Popen(command(folder), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True) as study:
            lines = iter(study.stdout.readline, "")
            self.assertEqual(next(lines).strip(), f"{RUNS} runs, {RUNS} to do")
            workers = [int(pid) for pid in next(lines).split()[1:]]
            self.assertEqual(len(workers), 2)
            for _ in range(20):
                next(lines)
            os.kill(workers[0], signal.SIGKILL)
            after = sum(1 for _ in lines)
        self.assertEqual(study.returncode, 0)
        return after

    def test_a_killed_worker_loses_nothing(self):
        spread, serial = self.folder / "spread", self.folder / "serial"
        self.assertEqual(self.run_and_kill_a_worker(spread), RUNS - 20)
        subprocess.run(command(serial, "--serial"), check=True, capture_output=True)
        expected = files(serial)
        self.assertEqual(len(expected), RUNS)
        self.assertEqual(len(set(expected.values())), RUNS)  # they differ from each other
        self.assertEqual(files(spread), expected)

        for name in list(expected)[:3]:
            (spread / name).unlink()
        left = {file: file.stat().st_mtime_ns for file in spread.glob("*.npy")}
        printed = subprocess.run(command(spread), check=True, capture_output=True, text=True).stdout
        self.assertEqual(printed.splitlines()[0], f"{RUNS} runs, 3 to do")
        self.assertEqual(files(spread), expected)
        self.assertEqual({file: file.stat().st_mtime_ns for file in left}, left)


if __name__ == "__main__":
    unittest.main()
