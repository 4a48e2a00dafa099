"""Plots the error of motion against the time of a frame, over the number of substeps.

    python3 plot_error.py --size 30 --out error.png

The error is the distance to a run of many more substeps in double precision, at most over all particles.
"""
import argparse
import time

import matplotlib
import numpy as np

import weft

matplotlib.use("Agg")
import matplotlib.pyplot as plt

FRAMES = 24
FRAME = 1 / 60  # s


def sheet(size):
    """A level sheet of rigid edges, 1 m wide, that hangs from one of them."""
    i, j = np.mgrid[0:size, 0:size]
    number = np.arange(size * size).reshape(size, size)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    mesh = weft.MeshDescription(positions=np.stack([i, 0 * i, j], axis=-1).reshape(-1, 3) / (size - 1),
                                pins=number[0])
    mesh.set_faces(faces.reshape(-1, 4))
    return weft.build_model(weft.cloth_from_mesh(mesh).scene)


def run(model, substeps, backend=weft.Backend.simd):
    """Positions at the end, and s of a frame."""
    cloth = weft.Cloth.create(model, weft.Settings(substeps=substeps, backend=backend,
                                                   solver=weft.Solver.small_steps))
    start = time.perf_counter()
    for _ in range(FRAMES):
        cloth.step(FRAME)
    return cloth.read_positions(), (time.perf_counter() - start) / FRAMES


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--size", type=int, default=30)
    options.add_argument("--most", type=int, default=32, help="substeps; the reference has 16 times as many")
    options.add_argument("--out", default="error.png")
    given = options.parse_args()
    model = sheet(given.size)
    true, _ = run(model, 16 * given.most, weft.Backend.reference)
    numbers = [2 ** k for k in range(2, given.most.bit_length())]
    rows = []
    for substeps in numbers:
        positions, seconds = run(model, substeps)
        rows.append((1000 * seconds, 1000 * np.linalg.norm(positions - true, axis=1).max()))
        print(f"{substeps:5d} substeps: {rows[-1][0]:.3f} ms a frame, {rows[-1][1]:.3g} mm")
    plt.loglog(*zip(*rows), "o-")
    for substeps, (x, y) in zip(numbers, rows):
        plt.annotate(str(substeps), (x, y))
    plt.xlabel("ms a frame")
    plt.ylabel("distance to the true motion, mm")
    plt.savefig(given.out, dpi=120)


if __name__ == "__main__":
    main()
