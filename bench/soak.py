#!/usr/bin/python3
"""
soak.py PROGRAM FOLDER [SECONDS] - the frond command for an hour (3600 s) of wall time on a scene with fluid, beams and bodies.

A shear flow drags a clamped ANCF beam, a beam of rigid trunks, a pendulum and a turning cube; a checkpoint each 2 s of simulated time. Memory and
processor time are sampled, invariants come from the history. Prints a verdict; the exit code is 0 when all bounds hold:
  memory      resident size in the last quarter at most 1 % above that of the second quarter, plus the rows of history, which are kept
  time a step processor time a step, the least of windows of a thirtieth of the run (other programs slow some of them down through caches and
              shared cores): in the last quarter at most 10 % off the second one
  invariants  the fluid's mass to round-off, so that no marker is lost; momentum residual <= 4e-6 of the largest impulse: the pair forces on a marker,
              about 6 p dp^2 = 40 N at the bottom, are 60 times its weight, and each is off by 2^-24 in single precision; what the transfer loses
              <= 1e-9 of the forces; energies of beams and bodies bounded by twice their largest value in the first half
The first eighth of the time is the start of the flow and not judged.
"""
import csv
import os
import signal
import subprocess
import sys
import time

SCENE = """
scene_name: soak
gravity: [0, 0, -9.81]
domain_lo: [0, 0, 0]
domain_hi: [0.6, 0.36, 0.4]
domain_periodic: [x, y]
walls: [zmin, zmax]
wall_zmax_velocity: [0.2, 0.02, 0]
beams: [rod, chain]
beam_elements: 4
beam_diameter: 0.06
beam_density: 1200
beam_young: 2e4
beam_rod: {start: [0.1, 0.1, 0.05], end: [0.1, 0.1, 0.25], end0: clamp}
beam_chain: {type: lumped, start: [0.1, 0.28, 0.05], end: [0.1, 0.28, 0.25], end0: clamp, hinge_damping: 1e-3}
bodies: [ball, cube]
body_density: 1500
body_motion: free
body_ball: {shape: sphere, size: [0.05, 0, 0], position: [0.35, 0.1, 0.2]}
body_cube: {shape: box, size: [0.08, 0.08, 0.08], position: [0.45, 0.27, 0.2], lock: [x, y, z]}
joints: pin
joint_pin: {type: hinge, a: ball, point: [0.35, 0.1, 0.3], axis: [0, 1, 0], damping: 1e-3}
sph:
  dp: 0.04
  density: 1000
  viscosity: 1
  max_speed: 3
output_every: 50
history_every: 0.5
checkpoint_every: 2
progress_every: 1
time_end: 1e6
"""


def sample(pid):
    """Resident size (bytes) and processor time (s) of a process."""
    with open("/proc/%d/stat" % pid) as f:
        fields = f.read().rsplit(")", 1)[1].split()
    return int(fields[21]) * os.sysconf("SC_PAGE_SIZE"), (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def steps_done(log):
    """Steps in the last progress line."""
    with open(log) as f:
        words = [line.split("step")[1].split()[0] for line in f if "step " in line and line.startswith("t =")]
    return int(words[-1]) if words else 0


def run(program, folder, seconds):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "soak.yaml"), "w") as f:
        f.write(SCENE)
    log = os.path.join(folder, "log.txt")
    samples, start = [], time.time()
    with open(log, "w") as out:
        process = subprocess.Popen([os.path.abspath(program), "run", "soak.yaml", "-output_overwrite"], cwd=folder, stdout=out, stderr=subprocess.STDOUT)
        while process.poll() is None and time.time() - start < seconds:
            time.sleep(min(10, seconds / 40))
            if process.poll() is None:
                samples.append((time.time() - start, *sample(process.pid), steps_done(log)))
        process.send_signal(signal.SIGTERM)
        code = process.wait(timeout=120)
    return samples, code, time.time() - start


def history(folder):
    with open(os.path.join(folder, "out_soak", "history.csv"), newline="") as f:
        rows = list(csv.reader(f))
    return {h.split("[")[0]: [float(r[i]) for r in rows[1:]] for i, h in enumerate(rows[0])}, len(rows) - 1


def window_costs(samples):
    """Processor time a step (ms) of each window of samples."""
    n = max(1, len(samples) // 8)
    return [1e3 * (b[2] - a[2]) / max(b[3] - a[3], 1) for a, b in zip(samples, samples[n:])]


def mean(x):
    return sum(x) / len(x)


def main():
    program, folder = sys.argv[1:3]
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 3600
    samples, code, wall = run(program, folder, seconds)
    h, rows = history(folder)
    bad = []

    def judge(ok, text):
        print(("ok      " if ok else "FAILED  ") + text)
        if not ok:
            bad.append(text)

    n = len(samples)
    second, last = samples[n // 4 : n // 2], samples[3 * n // 4 :]
    rss = [mean([s[1] for s in part]) / 1e6 for part in (second, last)]
    cost = [min(window_costs(part)) for part in (second, last)]
    average = [1e3 * (part[-1][2] - part[0][2]) / max(part[-1][3] - part[0][3], 1) for part in (second, last)]
    kept = rows * len(h) * 8 / 1e6
    print("soak: %.0f s of wall time, %d steps, %.1f s simulated, %d rows, %d samples" % (wall, h["step"][-1], h["time"][-1], rows, n))
    judge(code == 128 + signal.SIGTERM, "the run ends by the signal with code %d" % code)
    judge(rss[1] <= 1.01 * rss[0] + 2 * kept, "memory: %.2f MB in the second quarter, %.2f MB in the last, largest %.2f MB (history kept: %.2f MB)" %
          (*rss, max(s[1] for s in samples) / 1e6, kept))
    judge(abs(cost[1] / cost[0] - 1) <= 0.1, "processor time a step: %.4f ms in the second quarter, %.4f ms in the last (%+.2f %%); means %.4f and %.4f ms" %
          (*cost, 100 * (cost[1] / cost[0] - 1), *average))
    mass = max(abs(m / h["fluid_mass"][0] - 1) for m in h["fluid_mass"])
    judge(mass <= 1e-12, "mass of the fluid: changes by %.1e at most" % mass)
    residual = max(max(abs(h["momentum_residual_" + c][i]) for c in "xyz") / h["momentum_scale"][i] for i in range(1, rows))
    judge(residual <= 4e-6, "momentum: residual %.2e of the largest impulse at most" % residual)
    force = max(abs(f) for k in h if k.endswith(("_fx", "_fz")) for f in h[k])
    judge(max(h["transfer_force_lost"]) <= 1e-9 * force, "transfer: %.2e of %.3g N lost at most" % (max(h["transfer_force_lost"]), force))
    first = rows // 8
    for k in ("fluid_kinetic", "beams_kinetic", "beams_elastic", "bodies_kinetic", "fluid_speed_max", "fluid_compression_max"):
        early, late = max(h[k][first : rows // 2]), max(h[k][rows // 2 :])
        judge(late <= 2 * early, "%s: at most %.4g in the first half, %.4g in the second" % (k, early, late))
    print("verdict: %s" % ("FAILED: %d bounds" % len(bad) if bad else "flat: every bound holds"))
    sys.exit(1 if bad else 0)


main()
