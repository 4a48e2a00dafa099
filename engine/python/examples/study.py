"""A study: parameters x seeds, each run a trajectory in a file, spread by Dask's distributed scheduler.

    python3 study.py --out study --seeds 25                 # two workers on this machine
    python3 study.py --out study --seeds 25 --scheduler tcp://host:8786   # workers that run already
    python3 study.py --out study --seeds 25 --serial        # no Dask

A run's file, an array (frames, particles, 3), gets its name when it is whole. So a study that was
stopped goes on where it was, and a worker that is killed costs the run that it was in, which another
one repeats. The bits are the same whoever computes them. The workers of a scheduler elsewhere must
have weft, and the folder under the same path.
"""
import argparse
import itertools
import os
import pathlib
import tempfile

import numpy as np

import weft

BENDINGS = [1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3]  # N m


def flag(bending, size):
    """A sheet of cotton of this bending stiffness, 1 m wide, that hangs from one edge."""
    i, j = np.mgrid[0:size, 0:size]
    number = np.arange(size * size).reshape(size, size)
    faces = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    cotton = weft.find_material("cotton")
    cotton.bending = bending
    mesh = weft.MeshDescription(positions=np.stack([i, 0 * i, j], axis=-1).reshape(-1, 3) / (size - 1),
                                pins=number[0], material=cotton)
    mesh.set_faces(faces.reshape(-1, 4))
    return weft.build_model(weft.cloth_from_mesh(mesh).scene)


def trajectory(bending, seed, size, frames):
    cloth = weft.Cloth.create(flag(bending, size))
    blow = np.random.default_rng(seed).normal(0, 0.5, (cloth.particle_count(), 3))
    cloth.write_velocities(blow)  # m/s; fixed particles stay at rest
    out = np.empty((frames, cloth.particle_count(), 3))
    for frame in out:
        cloth.step(1 / 60)
        cloth.read_positions(frame)
    return out


def run(file, *of_run):
    """Writes one trajectory: whole, or not at all under this name."""
    handle, unfinished = tempfile.mkstemp(dir=os.path.dirname(file), suffix=".unfinished")
    with os.fdopen(handle, "wb") as out:
        np.save(out, trajectory(*of_run))
        out.flush()
        os.fsync(out.fileno())
    os.replace(unfinished, file)
    return file


def pending(given):
    """Arguments of the runs that have no file yet."""
    folder = pathlib.Path(given.out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for bending, seed in itertools.product(BENDINGS, range(given.seeds)):
        file = folder / f"bending_{bending:g}_seed_{seed}.npy"
        if not file.exists():
            yield str(file), bending, seed, given.size, given.frames


def run_by_dask(runs, given):
    from dask.distributed import Client, LocalCluster, as_completed
    where = given.scheduler or LocalCluster(n_workers=given.workers, threads_per_worker=1,
                                            host="127.0.0.1", dashboard_address=None)
    with Client(where) as client:
        print("workers", *client.run(os.getpid).values(), flush=True)
        futures = client.map(run, *zip(*runs), pure=False, retries=3)
        for future in as_completed(futures):
            print(future.result(), flush=True)
    if not given.scheduler:
        where.close()


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--out", required=True, help="folder of the trajectories")
    options.add_argument("--seeds", type=int, default=25)
    options.add_argument("--size", type=int, default=20)
    options.add_argument("--frames", type=int, default=120)
    options.add_argument("--workers", type=int, default=2)
    options.add_argument("--scheduler", help="address of one that runs already")
    options.add_argument("--serial", action="store_true", help="in this process")
    given = options.parse_args()
    runs = list(pending(given))
    print(f"{len(BENDINGS) * given.seeds} runs, {len(runs)} to do", flush=True)
    if given.serial:
        for one in runs:
            run(*one)
    elif runs:
        run_by_dask(runs, given)


if __name__ == "__main__":
    main()
