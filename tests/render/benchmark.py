#!/usr/bin/env python3
"""Figures against matplotlib, in one interleaved run: the machine's load hits both alike.

    tests/render/benchmark.py BUILD_DIR [RESULTS_DIR]

Needs python3-matplotlib, the targets render_bench, campaign_bench and waverig, and for the figures of a real campaign the
results of the default one (rig/run); without them an example's are timed. Prints medians and ratios; exit status 1 where a limit is missed:
3 panels, 30,000 samples at least 6 times faster warm and 5 times cold; 60 frames of film under 6 s; the figures of a
campaign under 3 s."""
import os
import statistics
import subprocess
import sys
import tempfile
import time

REPEATS = 9
MATPLOTLIB = r"""
import sys, time
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
def once(path):
    rng = np.random.default_rng(1)
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(8, 6), dpi=200, constrained_layout=True)
    t = 0.03 * np.arange(10000)
    for k, axis in enumerate(axes):
        axis.plot(t, 0.5 * np.cos(0.52 * t + k) + 0.02 * rng.standard_normal(10000), linewidth=1, label="trace")
        axis.set_title("Panel", loc="left")
        axis.set_ylabel("Heave (m)")
        axis.grid(True)
        axis.legend(loc="upper right")
    axes[-1].set_xlabel("Time (s)")
    figure.suptitle("Three traces")
    figure.savefig(path)
    plt.close(figure)
if sys.argv[1] == "figure":
    once(sys.argv[2])
else:
    for line in sys.stdin:
        start = time.perf_counter()
        once(sys.argv[2])
        print(f"{1000 * (time.perf_counter() - start):.3f}", flush=True)
"""


def cold(command):
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return 1000 * (time.perf_counter() - start)


class Server:
    def __init__(self, command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.once()  # the first one is cold

    def once(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return float(self.process.stdout.readline())

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    benches = os.path.join(sys.argv[1], "tests", "render")
    bench = os.path.join(benches, "render_bench")
    results = sys.argv[2] if len(sys.argv) > 2 else None
    missed = []

    def report(name, ours, theirs, least):
        a, b = statistics.median(ours), statistics.median(theirs)
        print(f"{name:28s} waverig {a:8.1f} ms   matplotlib {b:8.1f} ms   {b / a:5.1f} times faster (at least {least})")
        if b / a < least:
            missed.append(name)

    def limit(name, milliseconds, most):
        print(f"{name:28s} waverig {milliseconds:8.0f} ms   (at most {most})")
        if milliseconds > most:
            missed.append(name)

    with tempfile.TemporaryDirectory() as folder:
        png = os.path.join(folder, "a.png")
        rival = ["/usr/bin/python3", "-c", MATPLOTLIB]
        pairs = [(cold([bench, "figure", png]), cold([*rival, "figure", png])) for _ in range(REPEATS)]
        report("3 panels, 30,000, cold", [p[0] for p in pairs], [p[1] for p in pairs], 5)
        ours, theirs = Server([bench, "serve", png]), Server([*rival, "serve", png])
        pairs = [(ours.once(), theirs.once()) for _ in range(3 * REPEATS)]
        ours.close()
        theirs.close()
        report("3 panels, 30,000, warm", [p[0] for p in pairs], [p[1] for p in pairs], 6)
        told = lambda *command: float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        limit("film, 60 frames 1280x720", told(os.path.join(benches, "campaign_bench"), "film", os.path.join(folder, "a.mp4")), 6000)
        if results:
            draw = [os.path.join(sys.argv[1], "rig", "waverig"), "figures", results, "--jobs", "2"]
            limit("figures of " + os.path.basename(os.path.normpath(results)), statistics.median(cold(draw) for _ in range(3)), 3000)
        else:
            limit("figures of an example", told(os.path.join(benches, "campaign_bench"), "figures", os.path.join(folder, "figures")), 3000)
    if missed:
        sys.exit("missed: " + ", ".join(missed))


if __name__ == "__main__":
    main()
