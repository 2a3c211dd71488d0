"""One case of powder spreading by LIGGGHTS, as scene `program` starts it: reads inputs.json, writes the blade and the
first positions, runs the deck in.spread beside it, and leaves result.json. The same experiment as the scene
powder_spreading: a layer settles between two gates, then a box-shaped blade sweeps it.
Needs the program liggghts (3.8)."""
import json
import math
import random
import subprocess

asked = json.load(open("inputs.json"))
x = asked["inputs"]
d, gap, speed = x["diameter"], x["gap"], x["speed"]
rho, dt = 7980.0, 1e-5
front, thick, top, layer = 0.015, 0.005, 0.150, 0.090  # blade's face, its thickness and upper end, length of the layer, m
width = 10 * d
mass = rho * math.pi / 6 * d**3
count = round(400e-6 * width / (math.pi / 6 * d**3))


def start():
    """A cubic lattice with a jitter, and small velocities."""
    draw = random.Random(asked["seed"])
    jitter = lambda size: [size * draw.uniform(-1, 1) for _ in range(3)]
    nx, ny = int((layer - 0.1 * d) / (1.1 * d)), int(width / (1.1 * d))
    step = [(layer - 0.1 * d) / nx, width / ny, 1.1 * d]
    x0 = []
    for k in range(count):
        place = [k % nx, k // nx % ny, k // (nx * ny)]
        p = [(q + 0.5) * h + o + j for q, h, o, j in zip(place, step, [front + 0.05 * d, 0, 0.05 * d], jitter(0.05 * d))]
        x0.append([p[0], p[1] % width, p[2]])
    return x0, [jitter(0.1) for _ in x0]


def write_start(file, x0, v0):
    head = f"spreading\n\n{count} atoms\n1 atom types\n\n-0.06 0.3 xlo xhi\n0 {width!r} ylo yhi\n-0.001 0.16 zlo zhi\n\nAtoms\n\n"
    file.write(head)
    for i, p in enumerate(x0, 1):
        file.write(f"{i} 1 {d!r} {rho!r} {p[0]:.17g} {p[1]:.17g} {p[2]:.17g}\n")
    file.write("\nVelocities\n\n")
    for i, v in enumerate(v0, 1):
        file.write(f"{i} {v[0]:.17g} {v[1]:.17g} {v[2]:.17g} 0 0 0\n")


def write_blade(file):
    """A box without its ends, front and back in strips: LIGGGHTS refuses triangles that are long beside the period."""
    ys, zs = [width * k / 4 for k in range(5)], [gap + (top - gap) * k / 5 for k in range(6)]
    quads = []
    for y0, y1 in zip(ys, ys[1:]):
        for z0, z1 in zip(zs, zs[1:]):
            quads.append([(front, y0, z0), (front, y1, z0), (front, y1, z1), (front, y0, z1)])
            quads.append([(front - thick, y1, z0), (front - thick, y0, z0), (front - thick, y0, z1), (front - thick, y1, z1)])
        quads.append([(front - thick, y0, gap), (front - thick, y1, gap), (front, y1, gap), (front, y0, gap)])
        quads.append([(front - thick, y1, top), (front - thick, y0, top), (front, y0, top), (front, y1, top)])
    file.write("solid blade\n")
    for a, b, c, e in quads:
        for corners in ((a, b, c), (a, c, e)):
            u, v = ([q - o for q, o in zip(other, corners[0])] for other in corners[1:])
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            file.write(" facet normal %g %g %g\n  outer loop\n" % tuple(q / math.hypot(*n) for q in n))
            for p in corners:
                file.write("   vertex %.9g %.9g %.9g\n" % p)
            file.write("  endloop\n endfacet\n")
    file.write("endsolid blade\n")


def frames(name):
    """Step and x of every particle, dump by dump."""
    with open(name) as lines:
        while lines.readline():
            step = int(lines.readline())
            lines.readline()
            n = int(lines.readline())
            for _ in range(5):
                lines.readline()
            yield step, [float(lines.readline().split()[0]) for _ in range(n)]


with open("start.data", "w") as file:
    write_start(file, *start())
with open("blade.stl", "w") as file:
    write_blade(file)
sweep = round(0.070 / speed / dt)
subprocess.run(["liggghts", "-in", "in.spread", "-log", "log.txt", "-screen", "screen.txt", "-var", "sweep", str(sweep)],
               check=True, stdout=subprocess.DEVNULL)

# Net number of particles that the blade has passed, over its travel from 20 mm to the end.
behind = [(step * dt, sum(p < front + speed * step * dt for p in places)) for step, places in frames("sweep.dump")]
steady = [one for one in behind if one[0] * speed >= 0.020 - 1e-9]
(t1, n1), (t2, n2) = steady[0], steady[-1]
json.dump({"mfr": (n2 - n1) * mass / (t2 - t1) / (width * gap * speed * rho), "particles": count,
           "time": [t for t, _ in behind], "behind": [n for _, n in behind]}, open("result.json", "w"))
