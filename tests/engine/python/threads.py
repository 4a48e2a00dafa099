"""Steps leave Python's lock to others; a cloth that is in use is refused."""
import threading
import time
import unittest

import numpy as np
from sheets import cloth_of

import weft


def long_steps(cloth, began, ended):
    began.set()
    for _ in range(3):
        cloth.step(0.1)
    ended.set()


class TwoThreads(unittest.TestCase):
    def setUp(self):
        self.cloth = cloth_of(60, tolerance=1e-4, substeps=1000)
        self.began, self.ended = threading.Event(), threading.Event()
        self.thread = threading.Thread(target=long_steps, args=(self.cloth, self.began, self.ended))
        self.addCleanup(self.thread.join)
        self.thread.start()

    def test_others_go_on_while_a_cloth_steps(self):
        self.began.wait()
        ticks = 0
        while not self.ended.is_set():
            time.sleep(0.001)
            ticks += 1
        # A step that kept the lock would let this loop go round between steps alone.
        self.assertGreater(ticks, 10)

    def test_a_cloth_in_use_is_refused(self):
        refused = 0
        while not self.ended.is_set():
            try:
                self.cloth.read_positions()
            except weft.Error as error:
                self.assertEqual(str(error), "cloth: another thread uses it")
                refused += 1
                with self.assertRaises(weft.Error):
                    weft.Batch([self.cloth]).step_all(0.01)
                break
        self.assertEqual(refused, 1)
        self.thread.join()
        self.assertTrue(np.all(np.isfinite(self.cloth.read_positions())))


class Arenas(unittest.TestCase):
    def test_an_arena_changes_no_bit(self):
        alone, helped = cloth_of(60), cloth_of(60)
        arena = weft.Arena(2)
        for _ in range(5):
            alone.step(0.01)
            helped.step(0.01, arena)
        self.assertEqual(alone.state_hash(), helped.state_hash())
        with self.assertRaisesRegex(weft.Error, "threads: 0"):
            weft.Arena(0)


if __name__ == "__main__":
    unittest.main()
