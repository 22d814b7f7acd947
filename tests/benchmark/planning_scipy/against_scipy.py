#!/usr/bin/python3
"""Reference inflation and reference spline against SciPy: same inputs, in turns, medians of CPU time.

against_scipy.py PROGRAM MAP_FILE...   (./run bench planning scipy)

PROGRAM is planning_scipy, which answers one line on its standard output for each on its input and
times itself (see its main.cpp). Asked of us (issue 4): inflation at least 5 times as fast and equal
in every cell for sigma 1 to 4, the spline through 1000 points faster. Exit code 1 when a figure is
missed, 0 also when SciPy is not here: then nothing was compared, and a line says so.
"""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

try:
    import numpy as np
    from scipy.interpolate import splev, splprep
    from scipy.ndimage import gaussian_filter
except ImportError as error:
    print(f"SciPy is not on this machine ({error}): not compared. Debian: apt install python3-scipy")
    sys.exit(0)

ROUNDS = 15
ASKED_INFLATION = 5.0
ASKED_SPLINE = 1.0


class Ours:
    """The C++ side, kept running so that start-up is no part of any time."""

    def __init__(self, program):
        self.process = subprocess.Popen(
            [program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, *words):
        self.process.stdin.write(" ".join(str(word) for word in words) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().split()
        if not answer:
            sys.exit(f"planning_scipy ended while answering: {words}")
        return answer


def cpu_ms(work):
    begin = time.process_time()
    result = work()
    return 1e3 * (time.process_time() - begin), result


def row(what, ours_ms, scipy_ms, asked, equal):
    """Prints one line of the table; False when what was asked for is missed."""
    ratio = statistics.median(scipy_ms) / statistics.median(ours_ms)
    met = ratio >= asked and equal
    print(f"| {what:<44} | {statistics.median(ours_ms):9.3f} | {statistics.median(scipy_ms):9.3f} "
          f"| {ratio:6.1f} | {'yes' if equal else 'NO'} | at least {asked:g}{'' if met else ' MISSED'} |",
          flush=True)
    return met


def inflation(ours, folder, map_file):
    raw, out = folder / "grid", folder / "inflated"
    width, height = (int(word) for word in ours.ask("grid", map_file, raw))
    grid = np.fromfile(raw, np.int8).reshape(height, width)
    # What the thesis does in map mode 1 (unknown ground is passable): obstacles are what is above 0.
    obstacles = (grid > 0).astype(np.int64) * 100
    met = True
    for sigma in (1, 2, 3, 4):
        ours_ms, scipy_ms = [], []
        for _ in range(ROUNDS):
            ours_ms.append(float(ours.ask("inflate", sigma, out)[0]))
            spent, blurred = cpu_ms(lambda: gaussian_filter(obstacles, sigma=sigma) != 0)
            scipy_ms.append(spent)
        lethal = np.fromfile(out, np.uint8).reshape(height, width) != 0
        equal = bool((lethal == blurred).all())
        name = f"{pathlib.Path(map_file).stem}, inflation, sigma {sigma}"
        met &= row(name, ours_ms, scipy_ms, ASKED_INFLATION, equal)
    return met


def winding_cells(count):
    """Cells of a winding way, no two in a row the same."""
    a = 0.02 * np.arange(count)
    return np.round(np.stack([20.0 * np.sin(a) + 100.0 * a, 50.0 * np.cos(2.0 * a)], axis=1))


def spline(ours, folder):
    points, out = folder / "points", folder / "curve"
    cells = winding_cells(1000)
    cells.astype(np.float64).tofile(points)
    sites = np.linspace(0.0, 1.0, 101)  # the thesis samples 100 segments
    met = True
    for smoothing in (0, 2, 4, 6):
        ours_ms, scipy_ms = [], []
        for _ in range(ROUNDS):
            ours_ms.append(float(ours.ask("spline", smoothing, len(cells), points, out)[0]))

            def fit():
                curve, _ = splprep([cells[:, 0], cells[:, 1]], k=3, s=smoothing)
                return np.stack(splev(sites, curve), axis=1)

            spent, theirs = cpu_ms(fit)
            scipy_ms.append(spent)
        apart = np.abs(np.fromfile(out).reshape(-1, 2) - theirs).max()
        name = f"spline, 1000 points, s = {smoothing} (apart {apart:.1e} cells)"
        met &= row(name, ours_ms, scipy_ms, ASKED_SPLINE, bool(apart < 0.01))
    return met


def main():
    program, maps = sys.argv[1], sys.argv[2:]
    # Both on one core, in turns: whoever shares the machine slows both down alike.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    print("| against SciPy                                | ours, ms  | SciPy, ms | times  | equal | asked |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        ours = Ours(program)
        met = all([inflation(ours, folder, map_file) for map_file in maps])
        met &= spline(ours, folder)
    if not maps:
        print("the maps are not here: inflation was not compared")
    sys.exit(0 if met else 1)


if __name__ == "__main__":
    main()
