"""
Balances of mass, momentum and energy in the history: residuals against the order of the methods, and a seeded imbalance that is named.

Residuals hold the error of the time integration and of the trapezoids over the rows. Where both are of order p, half the step divides
the residual by 2^p; 2^(0.7 p) is asked for, which leaves room for the next order.
"""
import csv
import math
import subprocess
import sys

import apptest

check, near = apptest.check, apptest.near
frond = apptest.Frond(sys.argv[1], sys.argv[2])
frond.env["OMP_NUM_THREADS"] = "1"
QUIET = "progress_every: 0\noutput_every: 1000\n"

frond.write("beam.yaml", """
fluid: false
gravity: [0, 0, -9.81]
beams: rod
beam_rod: {start: [0, 0, 0], end: [1, 0, 0], elements: 4, diameter: 0.04, density: 7200, young: 20e6, end0: pin}
time_end: 0.5
""" + QUIET)
frond.write("couette.yaml", """
domain_lo: [0, 0, 0]
domain_hi: [0.2, 1, 0]
domain_periodic: x
walls: [ymin, ymax]
wall_ymax_velocity: [1, 0, 0]
sph: {dim: 2, dp: 0.05, density: 1000, viscosity: 100, max_speed: 1}
time_end: 1
history_every: 0
""" + QUIET)
frond.write("rest.yaml", """
domain_lo: [0, 0, 0]
domain_hi: [0.4, 0.4, 0]
walls: [xmin, xmax, ymin, ymax]
sph: {dim: 2, dp: 0.05, density: 1000, viscosity: 1, max_speed: 1}
time_end: 0.2
""" + QUIET)
frond.write("dam.yaml", """
gravity: [0, -9.81, 0]
domain_lo: [0, 0, 0]
domain_hi: [0.8, 0.6, 0]
fluid_hi: [0.2, 0.4, 0]
walls: [xmin, xmax, ymin]
sph: {dim: 2, dp: 0.025, density: 1000, viscosity: 0.001, max_speed: 4, slip: free, viscosity_type: artificial, artificial_alpha: 0.02}
time_end: 0.3
""" + QUIET)
frond.write("ball.yaml", """
gravity: [0, 0, -9.81]
domain_lo: [0, 0, 0]
domain_hi: [0.32, 0.32, 0.48]
walls: [xmin, xmax, ymin, ymax, zmin, zmax]
bodies: ball
body_ball: {size: [0.08, 0, 0], density: 3000, position: [0.16, 0.16, 0.3], motion: free}
sph: {dp: 0.04, density: 1000, viscosity: 20, max_speed: 1, background_pressure: 1e4}
time_end: 0.1
""" + QUIET)

frond.write("links.yaml", """
fluid: false
gravity: [0, 0, -9.81]
beams: [rod, tail]
beam_rod: {start: [0, 0, 0], end: [0.5, 0, 0], elements: 3, diameter: 0.04, density: 1500, young: 1e6, end0: pin}
beam_tail: {start: [0.7, 0, 0], end: [1.1, 0.1, 0], elements: 2, diameter: 0.04, density: 1500, young: 1e6}
bodies: hub
body_hub: {shape: box, size: [0.2, 0.1, 0.1], density: 900, position: [0.6, 0, 0], motion: free}
links: [a, b]
link_a: {type: rigid, nodes: rod.end, body: hub}
link_b: {type: ball, nodes: tail.start, body: hub}
time_end: 0.3
history_every: 0
ancf_ts_alpha_radius: 1
""" + QUIET)
frond.write("near.yaml", """
fluid: false
gravity: [0, 0, -9.81]
beams: [rod, cross]
beam_rod: {start: [0, 0, 0], end: [0.5, 0, 0], elements: 3, diameter: 0.04, density: 1500, young: 1e6, velocity: [0, 0, -0.5]}
beam_cross: {start: [0.25, -0.2, -0.05], end: [0.25, 0.2, -0.05], elements: 2, diameter: 0.04, density: 1500, young: 1e6}
bodies: [ball, other]
body_ball: {size: [0.05, 0, 0], density: 900, position: [0.1, 0, 0.072], motion: free, velocity: [0, 0, -1]}
body_other: {size: [0.05, 0, 0], density: 900, position: [0.1, 0, 0.18], motion: free, velocity: [0, 0, -2]}
rigid_roughness: 0.002
rigid_contact_modulus: 1e6
rigid_contact_restitution: 0.7
rigid_lubrication_viscosity: 1
rigid_lubrication_cutoff: 0.01
time_end: 0.1
history_every: 0
""" + QUIET)
frond.write("chain.yaml", """
fluid: false
gravity: [0, 0, -9.81]
beams: rod
beam_rod: {type: lumped, trunks: 4, start: [0, 0, 0], end: [1, 0, 0], diameter: 0.04, density: 1500, young: 1e6, end0: clamp, hinge_damping: 0.5}
bodies: [ball, crank]
body_ball: {size: [0.1, 0, 0], density: 500, position: [2, 0, 0], motion: free, torque: [0, 0, 0.2]}
body_crank: {shape: box, size: [0.1, 0.1, 0.1], position: [2.3, 0, 0], motion: prescribed, velocity: [0, 0.5, 0]}
joints: pull
joint_pull: {type: spring, a: ball, b: crank, point: [2.1, 0, 0], pointb: [2.25, 0, 0], stiffness: 500, damping: 3}
time_end: 0.3
history_every: 0
""" + QUIET)


def run(name, *args):
    """Columns of the history, and what stood on stderr."""
    p = subprocess.run([frond.program, "run", name + ".yaml", "-output_overwrite", *args], cwd=frond.folder, env=frond.env, stdout=subprocess.PIPE,
                       stderr=subprocess.PIPE, universal_newlines=True, timeout=200)
    check(p.returncode == 0, "%s: exit code %d: %s" % (name, p.returncode, p.stderr[:300]))
    with open(frond.path("out_" + name, "history.csv"), newline="") as f:
        rows = list(csv.reader(f))
    return {h.split("[")[0]: [float(r[i]) for r in rows[1:]] for i, h in enumerate(rows[0])}, p.stderr


def falls(what, order, coarse, fine):
    print("%s: residual %.3g, with half the step %.3g: a factor of %.2f" % (what, coarse, fine, abs(coarse / fine)), flush=True)
    check(abs(coarse) > 2 ** (0.7 * order) * abs(fine), "%s: the residual falls from %g to %g only" % (what, coarse, fine))


def beam():
    """alpha2 is of second order; energies are exchanged between three terms."""
    r = []
    for dt in (2e-3, 1e-3):
        h, err = run("beam", "-time_step", repr(dt), "-history_every", "0.01")
        check(not err, "beam: silent: " + err)
        check(h["beams_kinetic"][-1] > 1, "the beam swings")
        r.append(max(map(abs, h["beams_energy_residual"])))
    falls("beam that swings", 2, *r)


def moving_wall():
    """
    The wall's work is kinetic energy and heat. The flow starts at once, so that heat at the first row is that of walls not yet seen: first
    order. Until the other wall is felt the work is 2 mu U^2 w sqrt(t/(pi nu)) (Stokes' first problem; the far wall changes 2 exp(-L^2/nu t) =
    1e-4); markers dp apart see it once the layer is as thick, which misses a part dp/sqrt(nu t) at most.
    """
    r = []
    for dt in (1e-3, 5e-4):
        h, err = run("couette", "-sph_dt", repr(dt))
        check(not err, "moving wall: silent: " + err)
        r.append(h["fluid_energy_residual"][-1])
        exact = -2 * 100 * 0.2 * math.sqrt(1 / (math.pi * 0.1))
        near(h["work_on_walls"][-1] / exact, 1, 0.05 / math.sqrt(0.1), "work on the wall over Stokes'")
        check(abs(h["mass_residual"][-1]) <= 1e-12 * h["fluid_mass"][0], "mass stays")
    print("moving wall: work %.5g J/m, exact %.5g" % (h["work_on_walls"][-1], exact))
    falls("moving wall", 1, *r)


def rest():
    h, err = run("rest")
    bad = [k for k in h if ("residual" in k or "work" in k or "heat" in k or k == "fluid_kinetic") and any(h[k])]
    check(not bad and not err, "closed box at rest: exactly nothing happens, but %s: %s" % (bad, err))


def dam_break():
    """Angular momentum: pressure and artificial viscosity act along x_ab, so that only XSPH and the time step are in its residual."""
    h, err = run("dam")
    part = max(map(abs, h["fluid_energy_residual"])) / h["fluid_energy_scale"][-1]
    check(not err and part < 0.2, "dam break: silent, the residual is %g of the largest term: %s" % (part, err))
    g, err = run("dam", "-sph_xsph", "0")  # XSPH moves markers near walls otherwise than with their momentum
    # trapezoids over rows 1/500 of the time apart: 1e-5 or better for what changes within a twentieth of it
    near(g["body_force_work"][-1], g["fluid_potential"][0] - g["fluid_potential"][-1], 1e-4 * g["body_force_work"][-1], "work of gravity by rows")
    turn = max(map(abs, h["fluid_angular_residual_z"])) / max(map(abs, h["fluid_angular_z"]))
    check(turn < 1e-3, "dam break: the residual of the angular momentum is %g of it" % turn)
    print("dam break: residual of the energy %.3g of the largest term, of the angular momentum %.2g" % (part, turn))


def ball():
    """The body's own balance: its integrator is of second order, the coupling between first and second."""
    r = []
    for dt in (4e-4, 2e-4):
        h, err = run("ball", "-sph_dt", repr(dt))
        check(not err, "ball: silent: " + err)
        r.append([max(map(abs, h["bodies_energy_residual"])), max(map(abs, h["bodies_angular_residual_y"]))])
    for what, coarse, fine in zip(("energy", "angular momentum"), *r):
        falls("ball that falls, " + what, 1, coarse, fine)
    near(h["work_on_bodies"][-1], h["bodies_kinetic"][-1] + h["bodies_potential"][-1] - h["bodies_potential"][0], 2 * r[1][0], "work of the fluid on the ball")


def total(h):
    """Energy of beams and bodies, in contacts, and what became heat; in all rows."""
    names = ["beams_kinetic", "beams_elastic", "beams_potential", "beams_contact", "beams_near_taken", "bodies_kinetic", "bodies_potential",
             "bodies_contact", "bodies_impact", "bodies_lubrication", "joints_taken"]
    return [sum(v) for v in zip(*(h[n] for n in names if n in h))]


def structures():
    """
    Without a fluid: what goes between beams and bodies cancels in the sum of both, whose change is the error of the time integration.
    The attachment and the integrators are of second order (alpha2 at moving supports with spectral radius 1), the resistance held
    over a step of first.
    """
    for scene, order, steps, columns in (("links", 2, (1e-3, 5e-4), ["beams_energy_residual", "beams_angular_residual_y"]),
                                         ("near", 1, (2e-4, 1e-4), ["beams_energy_residual", "bodies_energy_residual"]),
                                         ("chain", 2, (2e-3, 1e-3), ["bodies_energy_residual"])):
        r = []
        for dt in steps:
            h, err = run(scene, "-time_step", repr(dt))
            check(not err, scene + ": silent: " + err)
            r.append([max(map(abs, h[c])) for c in columns])
            if scene == "chain":  # the work of the crank and of the torque comes from outside, the hinges' springs have no column
                continue
            e = total(h)
            r[-1].append(max(abs(x - e[0]) for x in e))
        for c, coarse, fine in zip([*columns, "total"], *r):
            falls("%s, %s" % (scene, c), order, coarse, fine)
        for a in "xyz":
            check(max(map(abs, h["bodies_angular_residual_" + a])) < 1e-10, "%s: angular momentum of the bodies about %s: round-off" % (scene, a))
        if scene == "links":
            check(abs(h["beams_from_bodies"][-1]) > 0.1, "links: beams and bodies exchange energy")
        if scene == "near":
            check(min(h["beams_near_taken"][-1], h["bodies_impact"][-1], h["bodies_lubrication"][-1], max(h["beams_contact"]), max(h["bodies_contact"])) > 1e-4,
                  "near: contact and lubrication of beams and of bodies all take part")
        if scene == "chain":
            check(h["joints_taken"][-1] > 1e-2 and abs(h["bodies_driven"][-1]) > 1e-2, "chain: hinges are damped, bodies driven")


def seeded():
    """A velocity that comes from nowhere is noticed, and the balance that it upsets is named."""
    for scene, fault, names in (("beam", "beam_v,4,100", ["energy of the beams"]), ("dam", "v,50,500", ["momentum", "energy of the fluid"]),
                                ("ball", "body_v,0,100", ["momentum", "energy of the bodies"]), ("near", "body_v,0,100", ["energy of the bodies"]),
                                ("links", "beam_v,4,100", ["energy of the beams"])):
        dry = scene in ("beam", "near", "links")
        h, err = run(scene, "-fault_nan", fault, "-fault_value", "5" if scene == "ball" else "60", "-sph_max_speed" if not dry else "-progress_every",
                     "60" if not dry else "0", *(["-time_step", "2e-4" if scene == "near" else "1e-3"] if dry else []))
        said = [line.split("balance of the ")[1].split(" is off")[0] for line in err.splitlines() if "balance of the " in line]
        for name in names:
            check(name in said, "%s, %s: '%s' is not named: %s" % (scene, fault, name, err[:300]))
        check("mass of the fluid" not in said and len(said) == len(set(said)), "%s: %s" % (scene, said))
        print("%s with %s: warned of %s" % (scene, fault, ", ".join(said)), flush=True)
    h, err = run("beam", "-time_step", "1e-3", "-fault_nan", "beam_v,4,100", "-fault_value", "60", "-audit_energy", "-1")
    check("balance" not in err, "audit_energy -1: no warning")


rest()
beam()
moving_wall()
dam_break()
ball()
structures()
seeded()
apptest.report()
