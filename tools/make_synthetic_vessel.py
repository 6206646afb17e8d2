#!/usr/bin/env python3
"""Write the synthetic vessel of the guidewire example (examples/data/synthetic_vessel.csv).

A centreline of aorto-iliac size, in millimetres, over 0 <= z <= 170:
    x(z)      = 25 (1 + tanh((z - 80)/18)) - x0      the branch turns aside by 50 mm and back
    y(z)      = 10 sin(2 pi z/130)                   a gentle sway out of that plane
    radius(z) = 3.5 + 5.5/(1 + exp((z - 75)/8))      9 mm to 3.5 mm at the bifurcation
with x0 such that x(0) = 0; one point per millimetre of z. Curvature times radius stays below 0.25.
"""
import math
import pathlib

Z_END = 170


def point(z):
    x = 25 * (math.tanh((z - 80) / 18) - math.tanh(-80 / 18))
    y = 10 * math.sin(2 * math.pi * z / 130)
    radius = 3.5 + 5.5 / (1 + math.exp((z - 75) / 8))
    return x, y, float(z), radius


def main():
    path = pathlib.Path(__file__).resolve().parent.parent / "examples" / "data" / "synthetic_vessel.csv"
    rows = ["x_mm,y_mm,z_mm,radius_mm"]
    rows += [",".join(f"{v:.6f}" for v in point(z)) for z in range(Z_END + 1)]
    path.write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
