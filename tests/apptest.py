"""apptest.py - what the tests of the frond command share: run it, count checks, a small scene."""
import os
import re
import shutil
import subprocess
import sys

checks = failures = 0

# A box of fluid with one wall, a beam and a fixed ball: every part in about a thousand markers.
SCENE = """
scene_name: small
gravity: [0, 0, -9.81]
domain_lo: [0, 0, 0]
domain_hi: [0.4, 0.4, 0.4]
domain_periodic: [x, y]
walls: [zmin, zmax]
beams: rod
beam_rod:
  start: [0.05, 0.2, 0.2]
  end: [0.2, 0.2, 0.2]
  elements: 2
  diameter: 0.06
  density: 2000
  young: 1e6
  end0: clamp
bodies: ball
body_ball:
  shape: sphere
  motion: fixed
  size: [0.06, 0, 0]
  density: 1000
  position: [0.31, 0.2, 0.2]
sph:
  dp: 0.04
  density: 1000
  viscosity: 1
  max_speed: 1
time_end: 0.01
output_every: 0.002
history_every: 0.001
"""


def check(ok, text):
    global checks, failures
    checks += 1
    if not ok:
        failures += 1
        print("FAILED: " + text, flush=True)
    return ok


def near(a, b, tol, text):
    return check(abs(a - b) <= tol, "%s: got %.9g, expected %.9g within %.2g" % (text, a, b, tol))


def report():
    print("%d checks, %d failed" % (checks, failures))
    sys.exit(1 if failures or not checks else 0)


class Frond:
    """The command under test and a clean folder to run it in."""

    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), os.path.abspath(folder)
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        self.env = dict(os.environ, OMP_WAIT_POLICY="PASSIVE")
        self.env.setdefault("OMP_NUM_THREADS", "2")

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, text):
        with open(self.path(name), "w") as f:
            f.write(text)
        return name

    def __call__(self, *args, timeout=120, wrapper=()):
        done = subprocess.run([*wrapper, self.program, *args], cwd=self.folder, env=self.env, timeout=timeout, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, stdin=subprocess.DEVNULL)
        return done.returncode, done.stdout, done.stderr

    def start(self, *args):
        return subprocess.Popen([self.program, *args], cwd=self.folder, env=self.env, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                universal_newlines=True, stdin=subprocess.DEVNULL)

    def runs(self, *args, timeout=300):
        rc, out, err = self(*args, timeout=timeout)
        check(rc == 0, "frond %s: exit code %d: %s" % (" ".join(args), rc, err.strip()))
        return out

    def refuses(self, args, words, code=1):
        """One error line that holds every word (a regular expression each), and the exit code."""
        what = "frond " + " ".join(args)
        try:
            rc, out, err = self(*args, timeout=60)
        except subprocess.TimeoutExpired:
            check(False, what + ": hangs")
            return
        lines = err.splitlines()
        check(rc == code if code is not None else 0 < rc < 4, "%s: exit code %d, expected %s; %s" % (what, rc, code, err[:300]))
        check(len(lines) == 1 and lines[0].startswith("frond: error: "), "%s: not one error line: %r" % (what, err[:600]))
        for word in words:
            check(re.search(word, err, re.I), "%s: the line does not say /%s/: %s" % (what, word, err.strip()[:300]))
