"""
Faults of a run of the frond command: signals and kills at random moments, a full disk, a folder that goes, a read-only one, too little memory, NaN
in every field; and determinism. app_faults.py PROGRAM FOLDER [SOURCE] [KILLS]: with KILLS only that many kills.
"""
import glob
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import app_checkpoint as base
import apptest

check, frond = base.check, base.frond
random.seed(20261)
FIXED = ["run", "all.yaml", "-sph_dt", "1e-4", "-audit", "true", "-audit_energy", "-1"]


def start(args, **kw):
    return subprocess.Popen([frond.program, *args], cwd=frond.folder, env=frond.env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                            stdin=subprocess.DEVNULL, **kw)


def moment(process, name, known, steps):
    """Wait for a random moment of this life: soon after the start, or when so many checkpoints more are there, whatever a step takes; then a little."""
    if random.random() < 0.25:
        time.sleep(random.uniform(0, 0.3))
        return
    goal = known + random.uniform(0, steps)
    while process.poll() is None:
        last = base.checkpoints(name)
        if last and base.number(last[-1]) >= goal:
            break
        time.sleep(0.002)
    time.sleep(random.uniform(0, 0.06))


def lives(name, signals, wanted, steps):
    """A run that is ended by signals at random moments and started again from its last checkpoint, until `wanted` signals have met it after a new
    checkpoint of that life. If it is done before, its bits are compared and it begins again from nothing."""
    args = [*FIXED, "-time_end", repr(steps * 1e-4), "-output_every", "5e-3", "-history_every", "1e-3"]
    frond.runs(*args, "-output_dir", name + "_whole")
    args += ["-output_dir", name, "-checkpoint_every", "8e-4"]
    hits = setups = restarts = fresh = life = whole = frames = 0
    while life < 20 * wanted + 40:
        life += 1
        again = base.checkpoints(name)
        known = base.number(again[-1]) if again else 0
        process = start([*args, "-restart", name] if again else [*args, "-output_overwrite"])
        restarts += bool(again)
        fresh += not again
        sent = None
        if hits < wanted:
            moment(process, name, known, 2 * steps / wanted)
            sent = random.choice(signals)
            process.send_signal(sent)  # nothing happens if it has ended
        out, err = process.communicate(timeout=300)
        if process.returncode == 0:
            whole += 1
            frames = base.same_run(name + "_whole", name, name)
            left = glob.glob(frond.path(name, "*.part"))
            check(not left, "%s: unfinished files are left: %s" % (name, left))
            shutil.rmtree(frond.path(name))
            if hits >= wanted:
                break
            continue
        allowed = (-sent, 128 + sent) if sent else ()
        # before the run has begun a signal ends it at once, and MPI may have words of its own about that
        if not check(process.returncode in allowed and (process.returncode < 0 or not err.strip()), "%s, life %d: exit code %d: %s" % (name, life, process.returncode, err.strip()[:300])):
            break
        if sent != signal.SIGKILL and process.returncode == 128 + sent and "checkpoint of step" in out:
            check(base.number(base.checkpoints(name)[-1]) == int(re.search(r"checkpoint of step (\d+)", out).group(1)), name + ": the checkpoint named is there")
        now = base.checkpoints(name)
        if now and base.number(now[-1]) > known:
            hits += 1
        else:
            setups += 1
    check(hits >= wanted, "%s: %d of %d signals met the run" % (name, hits, wanted))
    check(restarts > wanted // 2, "%s: only %d restarts" % (name, restarts))
    check(whole > 0, "%s: not done in %d lives" % (name, life))
    print("%s: %d signals (%s) after the first checkpoint of a life, %d more before; %d starts from nothing, %d restarts; done %d times: %d frames, %d steps with the bits of a run without" %
          (name, hits, ", ".join(sorted(s.name for s in signals)), setups, fresh, restarts, whole, frames, steps), flush=True)
    shutil.rmtree(frond.path(name + "_whole"))


def one_line(code, out, err, words, what, want=3):
    check(code == want, "%s: exit code %d, expected %d: %s" % (what, code, want, err.strip()[:300]))
    lines = err.strip().splitlines()
    check(len(lines) == 1 and lines[0].startswith("frond: error: "), "%s: not one error line: %r" % (what, err[:500]))
    for word in words:
        check(re.search(word, err), "%s: the line does not say /%s/: %s" % (what, word, err.strip()[:300]))


RUN = [*FIXED, "-time_end", "8e-3", "-output_every", "1e-3", "-history_every", "1e-3"]


def file_limit():
    """No file may grow beyond the limit: the checkpoint, then the history, meets it."""
    frond.runs(*RUN, "-output_dir", "limit_whole")

    def limited(size, args):
        """The limit comes once the run is under way: MPI has files of its own."""
        p = start([*RUN, "-output_dir", "limit", "-output_overwrite", "-checkpoint_every", "2e-3", *args])
        while not os.path.exists(frond.path("limit", "frame_00000.h5")) and p.poll() is None:
            time.sleep(0.002)
        resource.prlimit(p.pid, resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
        return finish(p)

    one_line(*limited(200000, []), [r"cannot write the checkpoint 'limit/checkpoint_\d+.h5", "File too large"], "a checkpoint beyond the size limit")
    check(len(base.frames("limit")) >= 2, "the frames before are there")
    shutil.rmtree(frond.path("limit"))
    one_line(*limited(20000, ["-checkpoint_every", "-1"]), ["cannot write", "File too large|disk full"], "a frame beyond the size limit")
    # go on when there is room again
    p = start([*RUN, "-output_dir", "limit", "-output_overwrite", "-checkpoint_every", "4e-3", "-time_end", "6e-3"])
    check(p.wait() == 0, "the shorter run is done")
    frond.runs(*RUN, "-output_dir", "limit", "-restart", "limit/checkpoint_000000040.h5")
    base.same_run("limit_whole", "limit", "limit")


def finish(p):
    out, err = p.communicate(timeout=120)
    return p.returncode, out, err


def mounted(size, options=""):
    """A small tmpfs on `disk`, where that is allowed."""
    os.makedirs(frond.path("disk"), exist_ok=True)
    return subprocess.run(["mount", "-t", "tmpfs", "-o", "size=%d%s" % (size, options), "none", frond.path("disk")], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL).returncode == 0


def unmount():
    subprocess.run(["umount", frond.path("disk")], check=False)


def full_disk():
    if not mounted(2500000):
        print("full disk: SKIPPED, mounting a tmpfs is not allowed here (the size limit is tested)")
        return
    try:
        p = start([*RUN, "-output_dir", "disk/run", "-checkpoint_every", "1e-3", "-checkpoint_keep", "50"])
        code, out, err = finish(p)
        one_line(code, out, err, ["cannot write", "No space left|disk full"], "a full disk")
        good = base.checkpoints("disk/run")
        check(len(good) >= 1, "checkpoints before are there")
        for f in base.frames("disk/run"):
            base.arrays(f)
        # what is there is whole: go on elsewhere
        shutil.copytree(frond.path("disk/run"), frond.path("rescued"))
        frond.runs(*RUN, "-output_dir", "rescued", "-restart", "rescued")
        base.same_run("limit_whole", "rescued", "rescued from a full disk")
        print("full disk: stopped with '%s', went on elsewhere from step %d with the same bits" % (err.strip()[:90], base.number(good[-1])), flush=True)
        subprocess.run(["mount", "-o", "remount,ro", frond.path("disk")], check=True)
        one_line(*finish(start([*RUN, "-output_dir", "disk/other"])), ["disk/other", "Read-only file system"], "a read-only file system")
        one_line(*finish(start([*RUN, "-output_dir", "disk/run", "-restart", "disk/run"])), ["disk/run", "Read-only file system"], "a restart on a read-only one")
    finally:
        unmount()


def folder_goes():
    p = start([*RUN, "-time_end", "1", "-output_dir", "gone", "-checkpoint_every", "1e-3"])
    for _ in range(400):
        if base.checkpoints("gone"):
            break
        time.sleep(0.02)
    shutil.rmtree(frond.path("gone"), ignore_errors=True)
    one_line(*finish(p), ["gone", "No such file"], "the folder goes during the run")


def no_memory():
    """Set-up with too little memory ends in one line, whichever allocation it is that fails."""
    frond.write("big.yaml", base.SCENE.replace("dp: 0.04", "dp: 0.01"))
    said = 0
    for megabytes in (150, 200, 250, 300, 350, 400):
        p = start(["run", "big.yaml", "-time_end", "1e-9", "-output_dir", "big", "-output_overwrite"],
                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20)))
        code, out, err = finish(p)
        lines = [line for line in err.splitlines() if line.startswith("frond: error: ")]
        check(code >= 0 or "MPI_Init" in err, "%d MB: a crash, signal %d" % (megabytes, -code))
        if code and lines:
            said += 1
            check(len(lines) == 1 and re.search("out of memory", lines[0]), "%d MB: %s" % (megabytes, err[:300]))
    check(said >= 1, "no limit met the set-up of frond")
    print("memory: %d limits met frond itself, all ended in one line" % said, flush=True)


def not_a_number():
    names = {"x": r"position of marker 300 \(fluid\)", "v": r"velocity of marker 300 \(fluid\)", "rho": r"density of marker 300 \(fluid\)",
             "beam_x": "position of node 1 of beam 'rod'", "beam_slope": "position of node 1 of beam 'rod'", "beam_v": "velocity of node 1 of beam 'rod'",
             "beam_slope_v": "velocity of node 1 of beam 'rod'", "body_x": "position of body 'cube'", "body_q": "position of body 'cube'",
             "body_v": "velocity of body 'cube'", "body_omega": "velocity of body 'cube'"}
    for field, words in names.items():
        where = 300 if field in ("x", "v", "rho") else 1
        folder = "nan_" + field
        p = start([*RUN, "-output_dir", folder, "-fault_nan", "%s,%d,23" % (field, where)])
        code, out, err = finish(p)
        one_line(code, out, err, ["first value that is not finite is the " + words + ", before step 24"], "NaN in " + field, 2)
        check("last good frame is %s/frame_00002.h5" % folder in out, "NaN in %s: the last good frame is named: %s" % (field, out[-300:]))
        good = base.checkpoints(folder)
        check(len(good) == 1 and base.number(good[-1]) <= 23 and "-restart " + os.path.relpath(good[-1], frond.folder) in out, "NaN in %s: the checkpoint" % field)
        for f in base.frames(folder):
            bad = [k for k, v in base.arrays(f).items() if v is not None and not base.np.isfinite(v).all()]
            check(not bad, "NaN in %s: %s has some in %s" % (field, f, bad))
        frond.runs(*RUN, "-output_dir", folder, "-restart", folder)
        base.same_run("limit_whole", folder, "NaN in %s and restart without" % field)
    print("NaN in each of %s: origin named, restart has the bits of a run without" % ", ".join(names), flush=True)


def too_fast():
    """A fluid as fast as sound, here as a share of it that falling for 2 ms or more reaches, ends in one line; the checkpoint goes on when told."""
    code, out, err = finish(start([*RUN, "-output_dir", "fast", "-sph_speed_stop", "0.025"]))
    one_line(code, out, err, [r"speed 0\.25\d* m/s at step [1-7]\d,", "of the speed of sound 10", "sph_speed_stop = 0.025"], "too fast", 2)
    good = base.checkpoints("fast")
    check(len(good) == 1 and "-restart " + os.path.relpath(good[-1], frond.folder) in out, "too fast: the checkpoint: %s" % out[-300:])
    frond.runs(*RUN, "-output_dir", "fast", "-restart", "fast", "-sph_speed_stop", "0")
    base.same_run("limit_whole", "fast", "too fast, and restart without the stop")
    print("a fluid too fast: one line, restart without the stop has the bits of a run without", flush=True)


def determinism():
    """Fluid, beams and bodies: the same bits on repeat and for any number of threads."""
    for k, (threads, extra) in enumerate((("1", []), ("1", []), ("2", []), ("3", []), ("7", []))):
        frond.env["OMP_NUM_THREADS"] = threads
        frond.runs(*FIXED, "-time_end", "3e-2", "-output_every", "1e-2", "-checkpoint_every", "1.5e-2", *extra, "-output_dir", "same%d" % k)
        if k:
            base.same_run("same0", "same%d" % k, "%s threads" % threads)
    frond.env["OMP_NUM_THREADS"] = "1"
    print("the same bits on repeat and with 1, 2, 3 and 7 threads", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 4:
        kills = int(sys.argv[4])
        lives("kills", [signal.SIGKILL], kills, 60 * kills)
    else:
        determinism()
        file_limit()
        full_disk()
        folder_goes()
        not_a_number()
        too_fast()
        no_memory()
        lives("signals", [signal.SIGTERM, signal.SIGINT], 6, 1200)
        lives("kills", [signal.SIGKILL], 10, 1500)
    apptest.report()
