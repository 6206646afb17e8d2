"""Stresses in the result: where the case gives modulus and section; against the fields; the warning at large strain."""

import json
import math
import pathlib

from _tendril import CASE, expect, run

wire = CASE.replace("bending_stiffness = 1.0\ntorsional_stiffness = 0.75",
                    "young_modulus = 2.0e7\npoisson_ratio = 0.3\nouter_diameter = {outer}\ninner_diameter = 0.02")


def solved(outer):
    pathlib.Path("wire.toml").write_text(wire.format(outer=outer), encoding="utf-8")
    result = expect(run("run", "wire.toml", "--json", "wire.json", "--fields"), 0, stdout=["largest von Mises"])
    return result, json.loads(pathlib.Path("wire.json").read_text(encoding="utf-8"))["steps"][0]


result, step = solved(0.03)
assert "warning" not in result.stdout, result.stdout
area = math.pi / 4 * (0.03**2 - 0.02**2)
inertia = math.pi / 64 * (0.03**4 - 0.02**4)
fields = step["fields"]
largest = 0.0
for F3, M1, M2, M3 in zip(fields["F3"], fields["M1"], fields["M2"], fields["M3"]):
    normal = abs(F3) / area + math.hypot(M1, M2) * 0.015 / inertia
    largest = max(largest, math.hypot(normal, math.sqrt(3) * M3 * 0.015 / (2 * inertia)))
stress = step["stress"]
# The fields are sampled ten times more coarsely than the report: their largest value may lie a little below.
assert 1 - 1e-12 <= stress["von_mises"] / largest <= 1 + 1e-4, (stress, largest)
# No torque: the strain is the normal stress over E.
assert math.isclose(stress["strain_max"], stress["von_mises"] / 2.0e7, rel_tol=1e-9), stress
assert math.isclose(abs(stress["axial"]) + stress["bending"], stress["von_mises"], rel_tol=1e-9), stress

# Stiffnesses alone tell no stress.
pathlib.Path("plain.toml").write_text(CASE, encoding="utf-8")
assert "von Mises" not in expect(run("run", "plain.toml", "--json", "plain.json"), 0).stdout
assert "stress" not in json.loads(pathlib.Path("plain.json").read_text(encoding="utf-8"))["steps"][0]

# A rod pulled by far more than it bears.
expect(run("run", "wire.toml", "--set", "end.axial_force=250.0"), 0, stdout=["largest strain in the section is", "above 2 %"])
