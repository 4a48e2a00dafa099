"""What a step costs from Python, beside the same step from C++.

    PYTHONPATH=build/engine/python python3 perf/python_cost.py build/perf/weft_python_cost

A level sheet of cotton that hangs from one edge, in one thread: one of 100 x 100 particles, and 1,000
of 20 x 20 as a batch. Both run in turns, and the states must be equal. Times are those of the
processor: the best of each, and the median of the turns' ratios.
"""
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import weft


def sheet(size):
    i, j = np.mgrid[0:size, 0:size]
    number = np.arange(size * size).reshape(size, size)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    mesh = weft.MeshDescription(positions=np.stack([i, 0 * i, j], axis=-1).reshape(-1, 3) / (size - 1),
                                pins=number[0], material=weft.find_material("cotton"))
    mesh.set_faces(faces.reshape(-1, 4))
    return weft.build_model(weft.cloth_from_mesh(mesh).scene)


def in_python(model, cloths, steps):
    made = [weft.Cloth.create(model) for _ in range(cloths)]
    step = made[0].step if cloths == 1 else weft.Batch(made).step_all
    for i in range(steps):
        if i == steps // 10:
            start = time.process_time()
        step(0.01)
    return time.process_time() - start, f"{made[-1].state_hash():016x}"


def in_cpp(program, file, cloths, steps):
    printed = subprocess.run([program, file, str(cloths), str(steps)], check=True, capture_output=True,
                             text=True).stdout.split()
    return float(printed[0]), printed[1]


def compare(program, folder, size, cloths, steps, turns):
    model = sheet(size)
    file = pathlib.Path(folder) / "model"
    file.write_bytes(weft.save_model(model))
    cpp, python = [], []
    for _ in range(turns):
        cpp.append(in_cpp(program, file, cloths, steps))
        python.append(in_python(model, cloths, steps))
    assert len({state for _, state in cpp + python}) == 1, "states differ"
    best = [1000 * min(runs)[0] / (steps - steps // 10) for runs in (cpp, python)]
    ratio = statistics.median(own / its for (own, _), (its, _) in zip(python, cpp))
    print(f"{cloths} x {size}^2: {best[0]:.4f} ms a step in C++, {best[1]:.4f} in Python "
          f"({100 * (best[1] / best[0] - 1):+.1f} %; in the median {100 * (ratio - 1):+.1f} %)")


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        compare(program, folder, 100, 1, 200, 7)
        compare(program, folder, 20, 1000, 40, 7)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
