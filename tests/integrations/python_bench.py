"""What the Python module costs over the library it calls: values at points, and a mesh's arrays.  python_bench.py EXAMPLES"""
import os
import sys
import time

import numpy as np

import sgm

EXAMPLES = sys.argv[1]


def best(times, work):
    """The least of some times, for noise only adds."""
    taken = []
    for _ in range(times):
        begin = time.perf_counter()
        work()
        taken.append(time.perf_counter() - begin)
    return min(taken)


def measure_values():
    model = sgm.load(os.path.join(EXAMPLES, "buildings/palace.sgm")).model()
    (lo, hi) = model.bounds
    points = np.random.default_rng(3).uniform(lo, hi, (1_000_000, 3)).astype(np.float32)
    ours = best(3, lambda: model.values(points))
    plain = min(model._core._evaluation_seconds(points) for _ in range(3))
    print(f"values at 10^6 points: {ours:.3f} s, the library's own evaluation {plain:.3f} s")


def measure_arrays():
    for name, options in (("buildings/palace.sgm", {}), ("grotto.sgm", {"surface": "cubes", "tolerance": 0})):
        grammar = sgm.load(os.path.join(EXAMPLES, name))
        shares = []
        for _ in range(3):
            model = grammar.model()
            mesh = model.mesh(256, **options)
            begin = time.perf_counter()
            arrays = mesh.positions, mesh.normals, mesh.triangles, mesh.origins
            views = time.perf_counter() - begin
            build = sum(model.stages.values()) + sum(mesh.stages.values()) - mesh.stages["arrays"]
            shares.append((mesh.stages["arrays"] + views) / build)
        print(f"{name} at 256: {len(arrays[2])} triangles in {build:.3f} s, arrays {100 * min(shares):.2f} % more")


measure_values()
measure_arrays()
