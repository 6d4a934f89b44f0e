"""Grids and probes of a scene: a tank at rest, where p = rho g (H - z), and a stream that carries all markers along, where the flow is known.

Pressures: the linear fit is exact for linear fields and the density differs from its hydrostatic start by less than rho g H/(rho c_s^2) = 1e-2 within the run's 5 ms, so 1 % of rho g H is the bound.
"""
import os
import subprocess
import sys

import h5py
import numpy as np

import apptest

frond = apptest.Frond(sys.argv[1], sys.argv[2])
TANK = """
scene_name: tank
gravity: [0, 0, -9.81]
domain_lo: [0, 0, 0]
domain_hi: [0.4, 0.4, 0.4]
domain_periodic: [x, y]
walls: zmin
fluid_hi: [0.4, 0.4, 0.2]
sph:
  dp: 0.02
  density: 1000
  viscosity: 0.01
  sound_speed: 20
time_end: 0.005
output_every: 0.0025
history_every: 0
grids: all, slice, line
grid_all_spacing: 0.05
grid_all_lo: [0, 0, 0]
grid_all_hi: [0.35, 0.35, 0.4]
grid_slice:
  lo: [0, 0.21, 0.02]
  hi: [0.4, 0.21, 0.16]
  mapping: linear
grid_line:
  lo: [0.1, 0.1, 0]
  hi: [0.1, 0.1, 0.2]
  mapping: linear
probes: foot, dry, lid
probe_foot_position: [0.13, 0.2, 0]
probe_dry_position: [0.13, 0.2, 0.39]
probe_lid:
  type: plane
  position: [0, 0, 0.1]
  edge1: [0.4, 0, 0]
  edge2: [0, 0.4, 0]
"""
frond.write("tank.yaml", TANK)
out = frond.runs("run", "tank.yaml")
full = 1000 * 9.81 * 0.2
rows = np.genfromtxt(frond.path("out_tank", "history.csv"), delimiter=",", names=True, deletechars="")
apptest.near(rows["foot_p[Pa]"][0], full, 0.01 * full, "pressure at the bottom, start")
apptest.near(rows["foot_p[Pa]"][-1], full, 0.01 * full, "pressure at the bottom, end")
apptest.near(rows["lid_p[Pa]"][-1], full / 2, 0.01 * full, "mean pressure on a plane")
apptest.near(rows["lid_area[m^2]"][-1], 0.16, 1e-12, "wetted area of a plane")
apptest.check(rows["dry_fraction[1]"][-1] == 0 and rows["dry_p[Pa]"][-1] == 0, "a dry probe says 0")
frames = sorted(n for n in os.listdir(frond.path("out_tank")) if n.startswith("frame_"))
apptest.check(len(frames) == 3, "3 frames: %s" % frames)
for name in frames:
    with h5py.File(frond.path("out_tank", name)) as f:
        g = f["grids/all"]
        apptest.check(g["pressure"].shape == (9, 8, 8) and g["velocity"].shape == (9, 8, 8, 3), "shape of a volume %s" % (g["pressure"].shape,))
        apptest.check(np.isnan(g["pressure"][-1]).all() and (g["fraction"][-1] == 0).all(), "no number above the fluid")
        apptest.check(g["velocity"].attrs["unit"] in ("m/s", b"m/s") and abs(g.attrs["step_z"] - 0.05) < 1e-12, "unit and step")
        s = f["grids/slice"]
        z = s.attrs["origin_z"] + s.attrs["step_z"] * np.arange(s["pressure"].shape[0])
        apptest.check(s["pressure"].shape == (8, 1, 21), "shape of a slice %s" % (s["pressure"].shape,))
        apptest.near(np.abs(s["pressure"][:, 0, :] - (9810 * (0.2 - z))[:, None]).max(), 0, 0.01 * full, name + ": pressure in a slice")
        apptest.check(f["grids/line/pressure"].shape == (11, 1, 1), "shape of a line")

# ParaView's file has a block for each grid and every dataset that it names is there.
text = open(frond.path("out_tank", "run.xdmf")).read()
apptest.check(text.count("3DCORECTMesh") == 9 and text.count("grids/slice/pressure") == 3, "grids in run.xdmf")

# All markers move with 0.5 m/s along x in a periodic box without walls: the flow through a plane is 0.5 A.
STREAM = """
scene_name: stream
domain_lo: [0, 0, 0]
domain_hi: [0.4, 0.4, 0]
domain_periodic: [x, y]
fluid_velocity: [0.5, 0, 0]
sph: {dim: 2, dp: 0.02, density: 1000, viscosity: 0.01, max_speed: 1}
time_end: 0.01
probes: gate
probe_gate: {type: plane, position: [0.103, 0.1, 0], edge1: [0, 0.2, 0]}
"""
frond.write("stream.yaml", STREAM)
frond.runs("run", "stream.yaml")
rows = np.genfromtxt(frond.path("out_stream", "history.csv"), delimiter=",", names=True, deletechars="")
apptest.near(rows["gate_flow[m^2/s]"][-1], 0.1, 1e-6, "flow of a stream")
apptest.near(rows["gate_massflow[kg/m/s]"][-1], 100, 1e-3, "mass flow of a stream")

# Wrong input.
for option, words in (
    ("-grid_slice_spacing -1", ["grid_slice_spacing", "positive"]),
    ("-grid_slice_spacing 1e-9", ["grid_slice_spacing", "points"]),
    ("-grid_slice_hi 0,0,-1", ["grid_slice_hi", "below"]),
    ("-grid_slice_lo 5,5,5 -grid_slice_hi 6,6,6", ["grid 'slice'", "outside of the domain"]),
    ("-probe_foot_position 0,0,7", ["probe_foot_position", "outside of the domain"]),
    ("-probe_foot_type plane", ["probe 'foot'", "probe_foot_edge1"]),
    ("-probe_lid_edge2 1,0,0", ["edges are parallel"]),
    ("-probe_lid_edge1 0,0,0", ["edge", "> 0"]),
    ("-probes foot,foot", ["probes", "twice"]),
    ("-probes nose", ["nose", "position"]),
    ("-grid_slice_mapping cubic", ["mapping", "none of"]),
):
    frond.refuses(["run", "tank.yaml", "-output_dir", "refused", *option.split()], words)
apptest.check(not os.path.exists(frond.path("refused")), "a refused run leaves no folder behind")
apptest.report()
