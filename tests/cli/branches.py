"""`tendril branches`: the list, its JSON, wrong usage."""

import json
from pathlib import Path

from _tendril import CASE, expect, run

# the shared case without its load, in compression
straight = CASE[: CASE.index("[load]")].replace("axial_force = 1.0", "axial_force = -20.0")
Path("straight.toml").write_text(straight)

# Below Euler's load, 39.5, the straight rod is the only state.
told = expect(run("branches", "straight.toml", "--json", "states.json", "--quiet"), 0, stdout=["1 state found", "on the axis"])
states = json.loads(Path("states.json").read_text())
assert len(states["steps"]) == len(states["branches"]) == 1, states["branches"]
assert states["steps"][0]["stability"] == "stable"
assert states["branches"][0]["on_axis"] and abs(states["branches"][0]["energy"]) < 1e-12
assert json.loads(expect(run("branches", "straight.toml", "--json", "-", "--quiet"), 0).stdout)["branches"]
expect(run("branches"), 2, stderr=["CASE"])
expect(run("branches", "none.toml"), 6)
expect(run("completion", "bash"), 0, stdout=["branches"])
expect(run("man"), 0, stdout=["tendril branches"])
