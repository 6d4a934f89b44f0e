"""Wrong input to the frond command: one line that names the field, its value and the rule, and an exit code that is not 0."""
import os
import resource
import sys

import apptest

frond = apptest.Frond(sys.argv[1], sys.argv[2])
frond.write("small.yaml", apptest.SCENE)
frond.write("afile", "not a folder\n")


def bad(options, *words, code=1):
    frond.refuses(["run", "small.yaml", *options.split()], words, code)


# Material, geometry and resolution.
for value in ("-2e5", "0", "nan", "inf"):
    bad("-beam_rod_young " + value, "young", r"-2e\+?0?5|-200000|\b0|nan|inf", "positive|finite|number")
for value in ("-1000", "0"):
    bad("-beam_rod_density " + value, "density", value, "positive|> 0")
    bad("-sph_density " + value, "density", value, "positive|> 0")
    bad("-beam_rod_diameter " + ("-0.06" if value != "0" else "0"), "diameter", "positive")
    bad("-sph_dp " + ("-0.04" if value != "0" else "0"), "sph_dp", "positive|needed|> 0|set")
    bad("-sph_h " + ("-0.04" if value != "0" else "0"), "sph_h", "positive|> 0|at least")
    bad("-beam_rod_elements " + ("-3" if value != "0" else "0"), "elements", "at least 1")
    bad("-body_ball_size " + ("-0.06,0,0" if value != "0" else "0,0,0"), "ball", "size|radius", "positive|> 0")
bad("-sph_viscosity -1", "viscosity", "-1")
bad("-sph_h_over_dp 0.5", "h", r"0\.5|0\.02")
bad("-sph_h 0.02", "h", r"0\.02|0\.5")
bad("-beam_rod_end 0.05,0.2,0.2", "rod", "start and end", "length")
bad("-beam_rod_diameter 0.01", "rod", "diameter|thin", r"0\.01", r"0\.04")
bad("-beam_rod_EI -1e3", "beam_rod_EI", "positive")
bad("-beam_rod_curvature 1", r"normal = \(0\.?, 0\.?, 0\.?\)", "plane")
bad("-beam_rod_pretension nan", "pretension")
bad("-beam_rod_pretension -1e12", "pretension", "EA")
bad("-beam_rod_inner 0.06", "inner = 0.06", "0.06\\)")
bad("-beam_rod_width 0.1", "width = 0.1", "round")

bad("-ancf_ts_type irk", "ts_type irk", "cannot integrate beams", "alpha2")

# Time.
bad("-ancf_substeps 0", "substeps", "0", "1")
bad("-time_end 0", "time_end", "positive")
bad("-time_end -1", "time_end", "-1", "positive")
bad("-time_step 1e-3", "time_step", "sph_dt")
bad("-sph_dt 1", "sph_dt|time step", "1")
bad("-sph_dt 0", "sph_dt")
bad("-fluid false", "time_step", "needed")
bad("-output_every -1", "output_every", "-1")
bad("-history_every -1", "history_every", "-1")

# The domain.
bad("-domain_hi 0.4,0.4,-1", "domain_hi", "domain_lo")
bad("-fluid_hi 0.4,0.4,0", "fluid", "no fluid|above")
bad("-fluid_hi 0.01,0.01,0.01", "no fluid")
bad("-fluid_hi 9,9,9", "inside the domain")
bad("-walls xmin,zmin", "xmin", "periodic")
bad("-walls zmid", "walls", "zmid", "none of")
bad("-domain_periodic q", "domain_periodic", "q", "none of")
bad("-wall_zmax_velocity 0,0,1", "wall_zmax_velocity", "along itself")
bad("-wall_xmin_velocity 0,1,0", "wall_xmin_velocity", "walls")
bad("-sph_dim 4", "sph_dim", "4", "2 or 3")
bad("-sph_dp 1e-6", "sph_dp", "markers")
bad("-gravity 0,0", "gravity", "2 numbers", "3")
bad("-gravity 0,0,down", "gravity", "down", "not a number")

bad("-domain_hi 0.41,0.4,0.4", "periodic axis x", r"0\.41", r"0\.04")
bad("-body_ball_position 0.2,0.2,2", "ball", "outside of the domain", "z = 2")
bad("-beam_rod_start 0.2,0.2,-1 -beam_rod_end 0.2,0.2,-0.5", "rod", "outside of the domain")
bad("-body_ball_shape mesh", "ball", "body_ball_file", "STL")
bad("-body_ball_shape mesh -body_ball_file nosuch.stl", "nosuch.stl", code=3)
bad("-body_ball_shape cone", "shape", "cone", "none of")
bad("-body_ball_lock q", "lock", "none of")
bad("-beams none", "beam_rod_", "does not list 'rod'")

# Markers on top of one another.
bad("-beams rod,twin -beam_twin_start 0.05,0.2,0.2 -beam_twin_end 0.2,0.2,0.2 -beam_twin_elements 2 -beam_twin_diameter 0.06 "
    "-beam_twin_density 2000 -beam_twin_young 1e6", "on top|overlap|closer|same place|coincide")
bad("-bodies ball,twin -body_twin_shape sphere -body_twin_motion fixed -body_twin_size 0.06,0,0 -body_twin_position 0.31,0.2,0.2",
    "on top|overlap|closer|same place|coincide")

# Names.
bad("-beams rod,rod", "beams", "rod", "twice")
bad("-beams ../rod", "beams", "letters")
bad("-scene_name ../../x", "scene_name", "letters")
bad("-bodies ball,rod", "rod", "beam")
bad("-beams stick", "stick", "needs", "start")

# Links between beams.
PAIR = ("-beams rod,arm -beam_arm_start 0.2,0.2,0.2 -beam_arm_end 0.2,0.35,0.2 -beam_arm_elements 2 -beam_arm_diameter 0.06 "
        "-beam_arm_density 2000 -beam_arm_young 1e6 -beam_arm_end0 free -links knee ")
bad(PAIR, "link 'knee'", "link_knee_nodes")
bad(PAIR + "-link_knee_nodes rod.end", "link_knee_nodes", "1 node", "2 or more")
bad(PAIR + "-link_knee_nodes rod.end,leg.start", "link_knee_nodes", "no beam 'leg'")
bad(PAIR + "-link_knee_nodes rod.end,arm", "link_knee_nodes", "'arm' is no node")
for node in ("3", "-1", "middle"):
    bad(PAIR + "-link_knee_nodes rod.end,arm." + node, "link_knee_nodes", node, "beam 'arm'", "start, end or 0 to 2")
bad(PAIR + "-link_knee_nodes rod.end,arm.1", "link 'knee'", "node 1 of beam 'arm'", r"0\.075 m", "beam 'rod'", "same point")
bad(PAIR + "-link_knee_nodes rod.end,rod.2", "link 'knee'", "node 2 of beam 'rod'", "already")
bad(PAIR + "-links knee,twin -link_knee_nodes rod.end,arm.start -link_twin_nodes arm.start,rod.end", "link 'twin'", "link 'knee'",
    "already")
bad(PAIR + "-link_knee_nodes rod.end,arm.start -link_knee_type glued", "link_knee_type", "glued", "ball, rigid")
bad(PAIR + "-link_knee_nodes rod.end,arm.start -beam_rod_end1 clamp -beam_arm_end0 clamp", "link 'knee'", "supports fix more")
bad(PAIR + "-link_knee_nodes rod.end,arm.start -link_knee_type rigid -beam_arm_end 0.35,0.20001,0.2", "link 'knee'",
    "rad from one line")
bad(PAIR + "-link_knee_nodes rod.end,arm.start -beam_arm_velocity 0,0,1", "link 'knee'", "tear")
bad(PAIR + "-link_knee_nodes rod.end,arm.start -ancf_pc_type blocktri", "ancf_pc_type blocktri", "joints")
bad("-links knee -link_knee_nodes rod.end,rod.start", "link 'knee'", r"0\.15 m")
bad("-links knee -beam_rod_type lumped -link_knee_nodes rod.end,rod.start", "link_knee_nodes", "'rod' is lumped", "joints")

# Links to bodies: rod's end lies 0.05 m off the ball.
HELD = ("-body_ball_motion free -body_ball_position 0.25,0.2,0.2 -links held -link_held_nodes rod.end -link_held_body ball "
        "-beam_rod_end 0.19,0.2,0.2 ")
bad(HELD + "-link_held_body box", "link_held_body", "no body 'box'")
bad(HELD + "-bodies none", "link_held_body|body_ball", "no body 'ball'|does not list")
bad(HELD + "-link_held_nodes rod.start", "link 'held'", "beam_rod_end0 = clamp", "leave it free")
bad(HELD + "-body_ball_position 0.32,0.2,0.2", "link 'held'", r"0\.07 m outside of body", "diameter")
bad(HELD + "-link_held_nodes rod.end,rod.2", "link 'held'", "already")
bad(HELD + "-body_ball_velocity 0,0,1", "link 'held'", "same velocity", r"\(0\.?, 0\.?, 1")
bad(HELD + "-body_ball_omega 0,0,1 -body_ball_position 0.19,0.2,0.2 -link_held_type rigid", "on top|overlap|closer|link 'held'")
bad(HELD + "-couple_attach_iterations 0", "couple_attach_iterations", "1 or more")
bad(HELD + "-couple_attach_tolerance 1", "couple_attach_tolerance", r"\(0, 1\)")

# Options that nobody knows, and values that are none.
bad("-beam_rod_yuong 1e6", "unknown option beam_rod_yuong", "beam_rod_young")
bad("-sph_viscosty 2", "unknown option sph_viscosty", "sph_viscosity")
bad("-completely_else 2", "unknown option completely_else")
bad("-time_end soon", "time_end", "soon", "not a number")
bad("-sph_viscosity thick", "sph_viscosity", "thick")
bad("-couple_loads quadratic", "couple_loads", "quadratic", "constant linear")
bad("-beam_rod_elements 2.5", "elements", r"2\.5", "whole")
bad("-fluid maybe", "fluid", "maybe", "true nor false")
bad("-beam_rod_end1 glued", "end1", "glued", "free, pin, clamp")
bad("-time_end", "time_end", "no value")
bad("-output_fields colour", "output_fields", "colour", "none of")

# Scene files.
base = apptest.SCENE
for name, text, words, code in (
    ("tab.yaml", "time_end: 1\n\tsph: 2\n", ["tab.yaml", "not valid YAML", "line 2"], 1),
    ("open.yaml", base + "\nbodies: [ball\n", ["open.yaml", "not valid YAML", "line 3[0-9]"], 1),
    ("nested.yaml", base + "\na: " + "[" * 200000 + "\n", ["nested.yaml", "line 3[0-9]", "64 brackets"], 1),
    ("long.yaml", base + "\n# " + "x" * (1 << 20) + "\n", ["long.yaml", "longer than 1 MiB"], 3),
    ("text.yaml", "hello world\n", ["text.yaml", "not valid YAML|sets nothing"], 1),
    ("empty.yaml", "", ["empty.yaml", "sets nothing"], 1),
    ("novalue.yaml", base + "\nsph_gamma:\n", ["sph_gamma", "no value"], 1),
    ("binary.yaml", "a: 1\0\0\n", ["binary.yaml", "text"], 3),
    ("misspelt.yaml", base.replace("max_speed", "maxspeed"), ["unknown option sph_maxspeed", "sph_max_speed"], 1),
    ("misspelt2.yaml", base.replace("time_end:", "tmie_end:"), ["unknown option tmie_end", "time_end"], 1),
    ("nodomain.yaml", base.replace("domain_hi", "domian_hi"), ["domain_hi", "domian_hi"], 1),
):
    frond.write(name, text)
    frond.refuses(["run", name], words, code)
    frond.refuses(["check", name], words, code)
frond.refuses(["run", "nosuch.yaml"], ["nosuch.yaml", "No such file"], 3)
frond.refuses(["run", "."], ["folder"], 3)

# Output folders: these must fail for root too.
bad("-output_dir /dev/null/x", "output_dir", "/dev/null", code=3)
bad("-output_dir afile", "output_dir", "afile", code=3)
bad("-output_dir afile/deep/er", "output_dir", "afile", code=3)
for folder in ("/dev/null/x", "afile", "afile/deep/er"):
    frond.refuses(["check", "small.yaml", "-output_dir", folder], ["output_dir", folder.split("/deep")[0]], 3)

# The command line itself.
frond.refuses(["dance"], ["dance", "no command"])
frond.refuses(["run"], ["scene file"])
frond.refuses(["run", "small.yaml", "small.yaml"], ["small.yaml", "neither an option"])

left = [n for n in os.listdir(frond.folder) if n.startswith("out_")]
apptest.check(not left, "refused runs left folders behind: %s" % left)
# 10^12 of anything: a clear answer, that of the count and not of the memory; it takes 0.2 s of processor time,
# 10 s are allowed (sanitizers, a busy machine).
small = apptest.SCENE.replace("domain_periodic: [x, y]", "").replace("walls: [zmin, zmax]", "")
frond.write("open.yaml", small)
frond.write("dry.yaml", small + "fluid: false\ntime_step: 1e-3\n")
WIDE = ["-domain_hi", "1e5,1e5,1e5", "-fluid_hi", "0.4,0.4,0.4"]
for scene, args, words in (
    ("open", ["-sph_dp", "4e-5"], ["sph_dp", r"1e\+12 markers", "fewer than"]),
    ("open", ["-domain_hi", "1e5,1e5,1e5"], ["sph_dp", "markers", "fewer than"]),
    ("open", [*WIDE, "-walls", "zmin"], ["box", "lattice sites", "larger sph_dp"]),
    ("open", [*WIDE, "-body_ball_shape", "box", "-body_ball_size", "2e4,2e4,2e4"], ["20000", "markers", "fewer than 1e8"]),
    ("open", [*WIDE, "-body_ball_shape", "cylinder", "-body_ball_size", "2e4,2e4,0"], ["20000", "markers", "fewer than 1e8"]),
    ("open", ["-grids", "g", "-grid_g_spacing", "4e-5"], ["grid_g_spacing", "points"]),
    ("open", ["-probes", "q", "-probe_q_type", "plane", "-probe_q_position", "0.1,0.1,0.1", "-probe_q_edge1", "4e4,0,0", "-probe_q_edge2", "0,4e4,0"], ["q", "points|too|must|larger"]),
    ("dry", ["-beam_rod_elements", "2000000000"], ["rod", "elements", "fewer than 5e7"]),
    ("dry", ["-beam_rod_elements", "1000000000000"], ["beam_rod_elements", "too large"]),
    ("dry", ["-beam_rod_type", "lumped", "-beam_rod_trunks", "2000000000"], ["beam_rod_trunks", "1e6"]),
    ("dry", ["-rigid_contact_modulus", "1e6", "-rigid_roughness", "1e-3", "-body_ball_shape", "box", "-body_ball_size", "0.1,0.1,0.1", "-rigid_shortrange_spacing", "1e-7"],
     ["box", "markers", "fewer than 1e8"]),
    ("dry", ["-rigid_contact_modulus", "1e6", "-rigid_roughness", "1e-3", "-couple_shortrange_samples", "1000000000"], ["couple_shortrange_samples", "64"]),
):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    frond.refuses(["check", scene + ".yaml", *args], words)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    apptest.check(spent < 10, "%s %s: the answer took %.3g s of processor time" % (scene, args, spent))

apptest.report()
