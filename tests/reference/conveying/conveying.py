#!/usr/bin/env python3
"""Five machines that convey, by LIGGGHTS 3.8.0: writes start and deck, runs, measures.

    conveying.py CASE SEED         prints a JSON line of measured numbers; CASE: a key of CASES
    conveying.py deck CASE FOLDER  writes start, deck and meshes of seed 1 into a folder
    conveying.py table LINES.json OTHERS.json  replaces rows of ensembles.csv by such lines, of LIGGGHTS and of grainsweep

Needs python3 with numpy, and liggghts on the PATH. SI units. What is measured: README.md.
"""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
MESHES = HERE.parents[2] / "configs" / "machines"
G = 9.81
CASES = {
    "conveyor_K1.6": dict(machine="conveyor", K=1.6),
    "conveyor_K2.4": dict(machine="conveyor", K=2.4),
    "ribbon_rpm60": dict(machine="ribbon", rpm=60.0),
    "belt_slope10": dict(machine="belt", slope=10.0),
    "screen_slope20": dict(machine="screen", slope=20.0),
    "vane_rpm120": dict(machine="vane", rpm=120.0),
}
# Pairs of types, restitution, friction, rolling friction; the last type is the walls'.
PAIRS = {
    "conveyor": {"AA": (0.2, 0.6, 0.2), "AW": (0.2, 0.6, 0.2)},
    "ribbon": {"AA": (0.5, 0.5, 0.1), "AB": (0.55, 0.4, 0.08), "BB": (0.6, 0.3, 0.06),
               "AW": (0.5, 0.4, 0.1), "BW": (0.6, 0.4, 0.1)},
    "belt": {"AA": (0.5, 0.5, 0.1), "AW": (0.5, 0.5, 0.1)},
    "screen": {a + b: (0.5, 0.4, 0.05) for a in "ABCD" for b in "ABCDW"},
    "vane": {"AA": (0.5, 0.4, 0.1), "AW": (0.5, 0.3, 0.1)},
}
DENSITY = 2500.0


def head(machine, types, boundary, skin, dt, slope=0.0, box=None, along="x"):
    """With a box: it starts empty, and grains that leave the box are gone."""
    def matrix(which):
        pairs = PAIRS[machine]
        entries = [pairs.get(a + b) or pairs.get(b + a) or (0.5, 0.0, 0.0) for a in types for b in types]
        return f"peratomtypepair {len(types)} " + " ".join(f"{e[which]:.9g}" for e in entries)

    n = len(types)
    begin = "read_data init.data"
    if box:
        begin = f"region box block {' '.join('%.9g' % b for b in box)} units box\ncreate_box {n} box"
    down = math.radians(slope)
    sine, gravity = f"{math.sin(down):.17g}", "0. 0. -1."
    if slope:
        gravity = (f"{sine} 0." if along == "x" else f"0. {sine}") + f" {-math.cos(down):.17g}"
    return f"""atom_style granular
atom_modify map array
boundary {boundary}
newton off
communicate single vel yes
units si
{begin}
neighbor {skin:.9g} bin
neigh_modify every 1 delay 0 check yes
fix m1 all property/global youngsModulus peratomtype {' '.join(['5e6'] * n)}
fix m2 all property/global poissonsRatio peratomtype {' '.join(['0.3'] * n)}
fix m3 all property/global coefficientRestitution {matrix(0)}
fix m4 all property/global coefficientFriction {matrix(1)}
fix m5 all property/global coefficientRollingFriction {matrix(2)}
fix m6 all property/global coefficientRollingViscousDamping peratomtypepair {n} {' '.join(['0.3'] * n * n)}
pair_style gran model hertz tangential history rolling_friction epsd
pair_coeff * *
timestep {dt:.9g}
fix grav all gravity {G} vector {gravity}
fix integr all nve/sphere
thermo 20000
thermo_modify lost {"error" if machine in ("conveyor", "ribbon") else "ignore"} norm no
"""


WALL = "wall/gran model hertz tangential history rolling_friction epsd"


def write_start(folder, types, box, rows, rng):
    """rows: type number, diameter, position; velocities uniform within 0.05 m/s in each direction."""
    with open(folder / "init.data", "w") as f:
        f.write(f"start\n\n{len(rows)} atoms\n{len(types)} atom types\n\n")
        for k, axis in enumerate("xyz"):
            f.write(f"{box[2 * k]:.9g} {box[2 * k + 1]:.9g} {axis}lo {axis}hi\n")
        f.write("\nAtoms\n\n")
        for i, (kind, d, x) in enumerate(rows):
            f.write(f"{i + 1} {kind} {d:.9g} {DENSITY:.9g} {x[0]:.9g} {x[1]:.9g} {x[2]:.9g}\n")
        f.write("\nVelocities\n\n")
        for i in range(len(rows)):
            u = 0.05 * (2 * rng.random(3) - 1)
            f.write(f"{i + 1} {u[0]:.6g} {u[1]:.6g} {u[2]:.6g} 0 0 0\n")


def lattice(count, spacing, low, high, jitter, rng):
    """Cubic lattice from the bottom up, stretched across to fill the box."""
    nx, ny = (max(1, int((high[k] - low[k]) / spacing)) for k in (0, 1))
    points = []
    while len(points) < count:
        iz, rest = divmod(len(points), nx * ny)
        iy, ix = divmod(rest, nx)
        points.append([low[0] + (ix + 0.5) * (high[0] - low[0]) / nx, low[1] + (iy + 0.5) * (high[1] - low[1]) / ny,
                       low[2] + (iz + 0.5) * spacing])
    return np.array(points) + jitter * (2 * rng.random((count, 3)) - 1)


def frames(file):
    """Rows id, type, x, y, z, vx, vy, vz, radius of every dump, ordered by id."""
    with open(file) as f:
        while f.readline():
            f.readline()
            f.readline()
            n = int(f.readline())
            for _ in range(5):
                f.readline()
            a = np.array(" ".join(f.readline() for _ in range(n)).split(), float).reshape(n, 9)
            yield a[np.argsort(a[:, 0])]


DUMP = "id type x y z vx vy vz radius"


def run(folder, deck, run_it):
    (folder / "in.deck").write_text(deck)
    if not run_it:
        return
    with open(folder / "out", "w") as out:
        code = subprocess.call(["liggghts", "-in", "in.deck", "-log", "log", "-screen", "screen"], cwd=folder,
                               stdout=out, stderr=out, env=dict(os.environ, OMP_NUM_THREADS="1"))
    if code != 0:
        raise SystemExit(f"failed in {folder}\n" + (folder / "log").read_text(errors="replace")[-1500:])


def conveyor(case, folder, rng, run_it):
    """In the frame of the trough: the plane rests, and every grain has the inertial force -m a(t) of the trough."""
    d, count, length, width, frequency, angle = 0.004, 400, 0.08, 0.024, 25.0, math.radians(30)
    w, steps = 2 * math.pi * frequency, 800
    dt = 1 / frequency / steps
    az = case["K"] * G / w**2
    ax = az / math.tan(angle)
    mass = math.pi / 6 * d**3 * DENSITY
    x = lattice(count, 1.15 * d, (0, 0, 0.05 * d), (length, width, 1), 0.05 * d, rng)
    x[:, 0] %= length
    x[:, 1] %= width
    write_start(folder, "AW", (0, length, 0, width, -0.01, 0.2), [(1, d, q) for q in x], rng)
    deck = head("conveyor", "AW", "p p f", 0.2 * d, dt)
    deck += f"fix trough all {WALL} primitive type 2 zplane 0.0\nrun {round(0.1 / dt)}\nreset_timestep 0\n"
    for name, amplitude in (("x", ax), ("z", az)):
        deck += f"variable f{name} equal {mass * amplitude * w * w:.17g}*sin({w * dt:.17g}*step)\n"
    deck += f"fix inertia all addforce v_fx 0.0 v_fz\nrun {20 * steps}\n"
    deck += f"dump d all custom {steps // 50} dump.txt {DUMP}\nrun {30 * steps}\n"
    run(folder, deck, run_it)
    if not run_it:
        return None
    speed, height = [], []
    for a in frames(folder / "dump.txt"):
        speed.append(a[:, 5].mean())
        height.append(a[:, 4].mean())
    return count, dict(transport_speed=float(np.mean(speed[1:])), height=float(np.mean(height[1:])))


def cylinder_stl(file, radius, x0, x1, facets, rings):
    """Prism about x with the cross-section's area of the circle, in rings: LIGGGHTS loses contacts of long triangles."""
    outer = radius * math.sqrt(2 * math.pi / facets / math.sin(2 * math.pi / facets))
    at = [(outer * math.cos(2 * math.pi * k / facets), outer * math.sin(2 * math.pi * k / facets))
          for k in range(facets)]
    with open(file, "w") as f:
        f.write("solid shaft\n")
        for k in range(facets * rings):
            (ya, za), (yb, zb) = at[k % facets], at[(k + 1) % facets]
            a, b = (x0 + (x1 - x0) * (k // facets + end) / rings for end in (0, 1))
            for t in (((a, ya, za), (b, ya, za), (b, yb, zb)), ((a, ya, za), (b, yb, zb), (a, yb, zb))):
                f.write("facet normal 0 0 0\nouter loop\n" + "".join("vertex %.9g %.9g %.9g\n" % v for v in t) +
                        "endloop\nendfacet\n")
        f.write("endsolid shaft\n")


def lacey(x, v, of_a, cell):
    """Lacey index by volume over cubic cells with edges at multiples of `cell`; cells with a solid fraction of 0.2."""
    _, c = np.unique(np.floor(x / cell).astype(int), axis=0, return_inverse=True)
    c = c.ravel()
    volume, a = np.bincount(c, v), np.bincount(c, v * of_a)
    used = volume >= 0.2 * cell**3
    p = (v * of_a).sum() / v.sum()
    va, vb = (v[of_a] ** 2).sum() / v[of_a].sum(), (v[~of_a] ** 2).sum() / v[~of_a].sum()
    s2 = (volume[used] * (a[used] / volume[used] - p) ** 2).sum() / volume[used].sum()
    s0 = p * (1 - p)
    sr = s0 * (p * vb + (1 - p) * va) / volume[used].mean()
    return float((s0 - s2) / (s0 - sr))


def ribbon(case, folder, rng, run_it):
    d, count, length, trough, turns, dt = 0.005, 1600, 0.12, 0.045, 3, 6e-5
    per_turn = 20 * round(60 / case["rpm"] / dt / 20)
    rows = []
    for kind, (x0, x1) in ((1, (0.0005, length / 2 - 0.0001)), (2, (length / 2 + 0.0001, length - 0.0005))):
        x = lattice(count // 2, 1.15 * d, (x0, -trough + 0.0005, 0.042), (x1, trough - 0.0005, 1), 0.05 * d, rng)
        rows += [(kind, d * (1 + 0.1 * (2 * rng.random() - 1)), q) for q in x]
    top = max(q[2] for _, _, q in rows)
    write_start(folder, "ABW", (-0.002, length + 0.002, -0.047, 0.047, -0.047, top + 0.02), rows, rng)
    cylinder_stl(folder / "shaft.stl", 0.006, -0.001, length + 0.001, 48, 30)
    for name in ("ribbon.stl", "ribbon_trough.stl"):
        shutil.copy(MESHES / name, folder / name)
    deck = head("ribbon", "ABW", "f f f", 0.2 * d, dt)
    deck += "fix trough all mesh/surface file ribbon_trough.stl type 3 curvature 9 curvature_tolerant yes\n"
    for name in ("ribbon", "shaft"):
        deck += (f"fix {name} all mesh/surface/stress file {name}.stl type 3 curvature 1 "
                 "curvature_tolerant yes reference_point 0. 0. 0.\n")
    deck += f"fix meshes all {WALL} mesh n_meshes 3 meshes trough ribbon shaft\n"
    for name, plane in (("left", "xplane 0.0"), ("right", f"xplane {length}"), ("front", f"yplane {-trough}"),
                        ("back", f"yplane {trough}")):
        deck += f"fix {name} all {WALL} primitive type 3 {plane}\n"
    deck += f"run {round(0.3 / dt)}\nreset_timestep 0\n"
    for name in ("ribbon", "shaft"):
        deck += (f"fix turn_{name} all move/mesh mesh {name} rotate origin 0. 0. 0. axis 1. 0. 0. "
                 f"period {per_turn * dt:.17g}\n")
    deck += f"fix load all ave/time 1 {per_turn // 20} {per_turn // 20} f_ribbon[4] f_shaft[4] file load.txt\n"
    deck += f"dump d all custom {per_turn} dump.txt {DUMP}\nrun {turns * per_turn}\n"
    run(folder, deck, run_it)
    if not run_it:
        return None
    *_, last = frames(folder / "dump.txt")
    v, of_a = 4 / 3 * math.pi * last[:, 8] ** 3, last[:, 1] == 1
    load = np.array([[float(q) for q in line.split()] for line in open(folder / "load.txt") if line[0] != "#"])
    return count, dict(torque=float((load[:, 1] + load[:, 2]).mean()), lacey=lacey(last[:, 2:5] + 1.5, v, of_a, 0.015))


def prime(seed, number):
    q = 15485863 + 2 * (1000 * seed + 100 * number)
    while any(q % k == 0 for k in range(3, math.isqrt(q) + 1, 2)):
        q += 2
    return q


def plates(file, rectangles):
    """rectangles: corner, two edges, number of cells along each."""
    with open(file, "w") as f:
        f.write("solid plates\n")
        for corner, u, v, nu, nv in rectangles:
            corner, u, v = (np.array(q, float) for q in (corner, u, v))
            for i in range(nu):
                for j in range(nv):
                    a, b, c, d = (corner + u * k / nu + v * m / nv
                                  for k, m in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
                    for t in ((a, b, c), (a, c, d)):
                        f.write("facet normal 0 0 0\nouter loop\n" +
                                "".join("vertex %.9g %.9g %.9g\n" % tuple(q) for q in t) + "endloop\nendfacet\n")
        f.write("endsolid plates\n")


def slope_of(times, values):
    return float(np.polyfit(times, values, 1)[0])


def belt(case, folder, rng, run_it):
    """The belt is a plane with a surface velocity; grains that pass its end are gone."""
    d, length, width, speed, rate, dt = 0.004, 0.4, 0.024, 0.8, 0.15, 5e-5
    seed, every = int(rng.integers(1, 1000)), round(0.02 / dt)
    deck = head("belt", "AW", "f p f", 0.2 * d, dt, -case["slope"], (-0.02, length, 0, width, -0.05, 0.2))
    deck += f"""fix belt all {WALL} primitive type 2 zplane 0.0 shear x {speed}
fix back all {WALL} primitive type 2 xplane 0.0
fix tA all particletemplate/sphere {prime(seed, 1)} atom_type 1 density constant {DENSITY} radius constant {d / 2}
fix dist all particledistribution/discrete {prime(seed, 2)} 1 tA 1.0
region feed block 0.01 0.07 0. {width} 0.03 0.06 units box
fix ins all insert/rate/region seed {prime(seed, 3)} distributiontemplate dist nparticles 10000000 massrate {rate} """
    deck += f"""insert_every {every} overlapcheck yes all_in yes vel constant 0. 0. -0.5 region feed ntry_mc 10000
run {round((0.4 + 1.3 * length / speed) / dt)}
dump d all custom {round(0.01 / dt)} dump.txt {DUMP}
run {round(1 / dt)}
"""
    run(folder, deck, run_it)
    if not run_it:
        return None
    front, end = 0.45 * length, 0.85 * length
    mass, momentum, height = [], [], []
    for a in frames(folder / "dump.txt"):
        a = a[(a[:, 2] > front) & (a[:, 2] < end)]
        m = math.pi / 6 * d**3 * DENSITY
        mass.append(m * len(a))
        momentum.append(m * a[:, 5].sum())
        height.append(a[:, 4].mean())
    return 0, dict(load=float(np.mean(mass) / (end - front)), powder_speed=float(np.mean(momentum) / np.mean(mass)),
                   height=float(np.mean(height)))


def screen(case, folder, rng, run_it):
    """In the frame of the deck, whose wires rest: grains have its inertial force, and the feed moves against it.

    The deck runs along y, because LIGGGHTS exchanges the components of y cylinders.
    """
    aperture, wire, openings, stroke, frequency, rate, dt = 0.005, 0.003, 10, 0.002, 20.0, 0.06, 2.5e-5
    start, measured = 0.8, 2.0
    pitch = aperture + wire
    deck_length, width, w = openings * pitch, 5 * aperture, 2 * math.pi * frequency
    sizes = [0.5 * aperture, 0.7 * aperture, 0.9 * aperture, 1.1 * aperture]
    seed, every = int(rng.integers(1, 1000)), round(0.02 / dt)
    plates(folder / "lip.stl", [((0, -0.02, wire / 2), (width, 0, 0), (0, 0.02, 0), 5, 4)])
    deck = head("screen", "ABCDW", "p f f", 0.2 * sizes[0], dt, case["slope"],
                (0, width, -0.03, deck_length + 0.15, -0.12, 0.2), "y")
    deck += f"fix back all {WALL} primitive type 5 yplane -0.02\n"
    deck += "fix lip all mesh/surface file lip.stl type 5 curvature 1 curvature_tolerant yes\n"
    deck += f"fix meshes all {WALL} mesh n_meshes 1 meshes lip\n"
    for k in range(openings + 1):
        deck += f"fix wire{k} all {WALL} primitive type 5 xcylinder {wire / 2} {k * pitch:.9g} 0.\n"
    deck += f"variable fz atom mass*{stroke * w * w:.17g}*sin({w * dt:.17g}*step)\nfix inertia all addforce 0. 0. v_fz\n"
    for k, size in enumerate(sizes):
        deck += (f"fix t{k} all particletemplate/sphere {prime(seed, 10 + k)} atom_type {k + 1} "
                 f"density constant {DENSITY} radius constant {size / 2:.9g}\n")
    deck += (f"fix dist all particledistribution/discrete/massbased {prime(seed, 1)} 4 "
             "t0 0.25 t1 0.25 t2 0.25 t3 0.25\n")
    low = wire + 2 * stroke + 0.006
    for k in range(1, 6):  # five phases of the vibration, each fed once in 0.1 s
        t = 0.02 * k
        shift, speed = stroke * math.sin(w * t), stroke * w * math.cos(w * t)
        deck += f"region feed{k} block 0. {width} -0.018 0.02 {low - shift:.9g} {low + 0.04 - shift:.9g} units box\n"
        deck += (f"fix ins{k} all insert/rate/region seed {prime(seed, 1 + k)} distributiontemplate dist "
                 f"nparticles 10000000 massrate {rate / 5:.9g} start {k * every} insert_every {5 * every} "
                 f"overlapcheck yes all_in yes vel constant 0. 0.3 {-0.5 - speed:.9g} region feed{k} ntry_mc 10000\n")
    deck += f"run {round(start / dt)}\ndump d all custom {every // 4} dump.txt {DUMP}\nrun {round(measured / dt)}\n"
    run(folder, deck, run_it)
    if not run_it:
        return None
    bottom, far, before = -2 * wire - stroke, deck_length + pitch / 2, {}
    passed = {kind: ([0.0], [0.0]) for kind in range(1, 5)}
    times = []
    for i, a in enumerate(frames(folder / "dump.txt")):
        z = a[:, 4] + stroke * math.sin(w * (start + 0.005 * i))
        now = {int(r[0]): (r[3], zi, int(r[1])) for r, zi in zip(a, z)}
        steps = {kind: [0.0, 0.0] for kind in passed}
        for one, (y, zi, kind) in now.items():
            if one in before:
                m = DENSITY * math.pi / 6 * sizes[kind - 1] ** 3
                if before[one][1] >= bottom > zi and y < far:
                    steps[kind][0] += m
                elif before[one][0] < far <= y and zi > bottom:
                    steps[kind][1] += m
        for kind in passed:
            for side in (0, 1):
                passed[kind][side].append(passed[kind][side][-1] + steps[kind][side])
        times.append(0.005 * i)
        before = now
    found = {}
    for kind, name in ((1, "fine"), (2, "middle"), (3, "near")):
        below, beyond = (slope_of(times[::10], passed[kind][side][1::10]) for side in (0, 1))
        found["passed_" + name] = below / (below + beyond)
    return 0, found


def vane(case, folder, rng, run_it):
    d, count, rotor, hub, clearance, length, inlet, vanes = 0.004, 4200, 0.04, 0.01, 0.005, 0.024, 0.025, 6
    dt, settle, turns = 5e-5, 0.4, 1
    casing, seal = rotor + clearance, rotor + 0.001
    filled = count * (1.3 * d) ** 3 / (2 * inlet * length) + 0.02
    top, top_left = math.sqrt(casing**2 - inlet**2), math.sqrt(seal**2 - inlet**2)
    half, half_left = math.atan2(top, inlet), math.atan2(top_left, inlet)
    x = lattice(count, 1.15 * d, (-inlet + 0.0005, 0, casing + 0.002 + 0.5 * d), (inlet - 0.0005, length, 1), 0.05 * d,
                rng)
    x[:, 1] %= length
    high = casing + filled + 0.022
    write_start(folder, "AW", (-0.06, 0.06, 0, length, -0.1, high), [(1, d, q) for q in x], rng)
    across = (0, length, 0)
    housing = [((inlet, 0, top), (0, 0, filled + 0.02), across, 60, 4),
               ((-inlet, 0, top_left), (0, 0, top - top_left + filled + 0.02), across, 60, 4)]
    outer = casing / math.cos(half / 12)
    at = [np.array((outer * math.cos((k / 6 - 1) * half), 0, outer * math.sin((k / 6 - 1) * half))) for k in range(13)]
    housing += [(a, b - a, across, 2, 4) for a, b in zip(at, at[1:])]
    at = []
    for k in range(13):
        r, angle = (casing + (seal - casing) * k / 12) / math.cos(half / 12), (half + half_left) * k / 12 - half
        at.append(np.array((-r * math.cos(angle), 0, r * math.sin(angle))))
    housing += [(a, b - a, across, 2, 4) for a, b in zip(at, at[1:])]
    plates(folder / "housing.stl", housing)
    turning = []
    for k in range(vanes):
        u = np.array((math.cos(2 * math.pi * k / vanes), 0, -math.sin(2 * math.pi * k / vanes)))
        turning.append((hub * u, (rotor - hub) * u, across, 6, 4))
    facets = 24
    outer = hub * math.sqrt(2 * math.pi / facets / math.sin(2 * math.pi / facets))
    at = [outer * np.array((math.cos(2 * math.pi * k / facets), 0, math.sin(2 * math.pi * k / facets)))
          for k in range(facets + 1)]
    turning += [(a, b - a, across, 1, 8) for a, b in zip(at, at[1:])]
    plates(folder / "rotor.stl", turning)
    deck = head("vane", "AW", "f p f", 0.2 * d, dt)
    deck += "fix housing all mesh/surface file housing.stl type 2 curvature 1 curvature_tolerant yes\n"
    deck += ("fix rotor all mesh/surface/stress file rotor.stl type 2 curvature 1 curvature_tolerant yes "
             "reference_point 0. 0. 0.\n")
    per_turn = 100 * round(60 / case["rpm"] / dt / 100)
    deck += f"fix meshes all {WALL} mesh n_meshes 2 meshes housing rotor\nrun {round(settle / dt)}\nreset_timestep 0\n"
    deck += (f"fix turn all move/mesh mesh rotor rotate origin 0. 0. 0. axis 0. 1. 0. period {per_turn * dt:.17g}\n"
             f"run {per_turn // 2}\n")
    deck += f"fix load all ave/time 1 {per_turn // 100} {per_turn // 100} f_rotor[5] file load.txt\n"
    deck += f"dump d all custom {per_turn // 100} dump.txt {DUMP}\nrun {turns * per_turn}\n"
    run(folder, deck, run_it)
    if not run_it:
        return None
    m = math.pi / 6 * d**3 * DENSITY
    left, carried = [], []
    for a in frames(folder / "dump.txt"):
        left.append(m * (a[:, 4] > -casing).sum())
        r, angle = np.hypot(a[:, 2], a[:, 4]), np.arctan2(a[:, 4], a[:, 2])
        carried.append(m * ((r < casing) & (np.abs(angle) < half)).sum())
    times = per_turn * dt / 100 * np.arange(len(left))
    load = np.array([[float(q) for q in line.split()] for line in open(folder / "load.txt") if line[0] != "#"])
    pockets = math.pi * (casing**2 - hub**2) * length
    return count, dict(rate=-slope_of(times, left),
                       solid_fraction=float(np.mean(carried) / (DENSITY * pockets * half / math.pi)),
                       torque=float(load[:, 1].mean()))


def measure(name, seed, folder=None):
    case = CASES[name]
    scratch = pathlib.Path(folder or tempfile.mkdtemp(prefix="conveying_"))
    scratch.mkdir(exist_ok=True)
    found = globals()[case["machine"]](case, scratch, np.random.default_rng(seed), folder is None)
    if folder is None:
        shutil.rmtree(scratch)
        print(json.dumps(dict(case=name, seed=seed, n=found[0], measured=found[1])), flush=True)


def values_of(file):
    values = {}
    for one in sorted(map(json.loads, open(file)), key=lambda one: (one["case"], one["seed"])):
        for quantity, value in one["measured"].items():
            values.setdefault((one["case"], one["n"], quantity), []).append(value)
    return values


def write_table(lines, others):
    """`others`: lines of grainsweep, whose scatter is pooled with that of LIGGGHTS."""
    theirs = {(case, quantity): x for (case, _, quantity), x in values_of(others).items()}
    fresh = values_of(lines)
    kept = [row for row in open(HERE / "ensembles.csv").readlines()[1:] if row.split(",")[0] not in {k[0] for k in fresh}]
    with open(HERE / "ensembles.csv", "w") as f:
        f.write("case,seeds,n,quantity,mean,sd,standard_error,sd_pooled,degrees_of_freedom,tolerance,values\n")
        f.writelines(kept)
        for (case, n, quantity), x in fresh.items():
            both = [x, theirs[case, quantity]]
            freedom = sum(len(one) - 1 for one in both)
            sd = np.std(x, ddof=1)
            pooled = math.sqrt(sum(np.var(one) * len(one) for one in both) / freedom)
            f.write(f"{case},{len(x)},{n},{quantity},{np.mean(x):.6g},{sd:.3g},{sd / math.sqrt(len(x)):.3g},"
                    f"{pooled:.3g},{freedom},{3 * pooled * math.sqrt(2 / len(x)):.3g},"
                    f"{' '.join('%.6g' % q for q in x)}\n")


if __name__ == "__main__":
    if sys.argv[1] == "table":
        write_table(sys.argv[2], sys.argv[3])
    elif sys.argv[1] == "deck":
        measure(sys.argv[2], 1, sys.argv[3])
    else:
        measure(sys.argv[1], int(sys.argv[2]))
