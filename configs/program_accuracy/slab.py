"""Cooling of a hot slab that radiates into a room: finite volumes over half of its thickness, explicit steps.

    rho c dT/dt = k d2T/dx2,   k dT/dx = 0 in the middle,   -k dT/dx = emissivity sigma (T^4 - T_room^4) at the surface

Usage: slab.py CONDUCTIVITY EMISSIVITY THICKNESS CELLS, in W/m/K, 1, m. Prints the temperature of the surface after 120 s
and the heat that the slab has lost until then. The error of the cells is of second order, and the time of a run grows
with their third power.
"""
import sys

SIGMA = 5.670374419e-8  # W/m2/K4
HEAT_CAPACITY = 3.9e6  # J/m3/K
HOT, ROOM = 1200.0, 293.15  # K
END = 120.0  # s


def main():
    conductivity, emissivity, thickness = (float(word) for word in sys.argv[1:4])
    cells = int(sys.argv[4])
    dx = thickness / 2 / cells
    dt = 0.4 * HEAT_CAPACITY * dx * dx / conductivity
    steps = int(END / dt) + 1
    dt = END / steps
    number = conductivity * dt / (HEAT_CAPACITY * dx * dx)
    temperature = [HOT] * cells
    lost = 0.0
    for _ in range(steps):
        surface = surface_of(temperature[-1], conductivity, emissivity, dx)
        flux = emissivity * SIGMA * (surface**4 - ROOM**4)
        before = temperature
        temperature = [
            here + number * (left - 2 * here + right)
            for left, here, right in zip([before[0]] + before[:-1], before, before[1:] + [before[-1]])
        ]
        temperature[-1] -= flux * dt / (HEAT_CAPACITY * dx)
        lost += flux * dt
    print("surface =", surface_of(temperature[-1], conductivity, emissivity, dx))
    print("lost =", lost)


def surface_of(cell, conductivity, emissivity, dx):
    """Temperature of the surface, half a cell from the middle of the last one, by Newton's method."""
    surface = cell
    for _ in range(3):
        balance = 2 * conductivity * (cell - surface) / dx - emissivity * SIGMA * (surface**4 - ROOM**4)
        surface += balance / (2 * conductivity / dx + 4 * emissivity * SIGMA * surface**3)
    return surface


main()
