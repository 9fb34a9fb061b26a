#!/usr/bin/env python3
"""Figures against matplotlib, in one interleaved run: the machine's load hits both alike.

    tests/render/benchmark.py BUILD_DIR [RESULTS_DIR]

Needs python3-matplotlib, the targets render_bench, campaign_bench and waverig, and for the figures of a real campaign the
results of the default one (rig/run); without them an example's are timed. Prints medians and ratios; exit status 1 where a limit is missed:
3 panels, 30,000 samples at least 6 times faster warm and 5 times cold; 60 frames of film under 6 s; the figures of a
campaign under 3 s."""
import os
import resource
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
    """Milliseconds on the clock and of the processors."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1000 * wall, 1000 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


class Server:
    def __init__(self, command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.once()  # the first one is cold

    def processors(self):
        with open(f"/proc/{self.process.pid}/stat", encoding="utf-8") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return 1000 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def once(self):
        before = self.processors()
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return float(self.process.stdout.readline()), self.processors() - before

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

    def report(name, pairs, least):
        ours, theirs = [p[0] for p in pairs], [p[1] for p in pairs]
        a, b = (statistics.median(t[0] for t in times) for times in (ours, theirs))
        print(f"{name:28s} waverig {a:8.1f} ms   matplotlib {b:8.1f} ms   {b / a:5.1f} times faster (at least {least})")
        a_cpu, b_cpu = (statistics.mean(t[1] for t in times) for times in (ours, theirs))
        print(f"{'   of the processors':28s} waverig {a_cpu:8.1f} ms   matplotlib {b_cpu:8.1f} ms   {b_cpu / a_cpu:5.1f} times less")
        if b / a < least:
            missed.append(name)

    def limit(name, command, most):
        times = [cold(command) for _ in range(3)]
        wall, processors = (statistics.median(t[k] for t in times) for k in (0, 1))
        print(f"{name:28s} waverig {wall:8.0f} ms   (at most {most}), of the processors {processors:.0f} ms")
        if wall > most:
            missed.append(name)

    with tempfile.TemporaryDirectory() as folder:
        png = os.path.join(folder, "a.png")
        rival = ["/usr/bin/python3", "-c", MATPLOTLIB]
        pairs = [(cold([bench, "figure", png]), cold([*rival, "figure", png])) for _ in range(REPEATS)]
        report("3 panels, 30,000, cold", pairs, 5)
        ours, theirs = Server([bench, "serve", png]), Server([*rival, "serve", png])
        pairs = [(ours.once(), theirs.once()) for _ in range(3 * REPEATS)]
        ours.close()
        theirs.close()
        report("3 panels, 30,000, warm", pairs, 6)
        campaign_bench = os.path.join(benches, "campaign_bench")
        limit("film, 60 frames 1280x720", [campaign_bench, "film", os.path.join(folder, "a.mp4")], 6000)
        if results:
            waverig = os.path.join(sys.argv[1], "rig", "waverig")
            limit("figures of " + os.path.basename(os.path.normpath(results)), [waverig, "figures", results, "--jobs", "2"], 3000)
        else:
            limit("figures of an example", [campaign_bench, "figures", os.path.join(folder, "figures")], 3000)
    if missed:
        sys.exit("missed: " + ", ".join(missed))


if __name__ == "__main__":
    main()
