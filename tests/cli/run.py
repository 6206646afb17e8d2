"""`tendril run` from outside: the streams, the files, the exit codes, starting again from a result, Ctrl-C."""

import json
import os
import pathlib
import signal
import subprocess
import time

from _tendril import CASE, EXAMPLES, PROGRAM, expect, run

pathlib.Path("case.toml").write_text(CASE)

result = expect(run("run", "case.toml", "--json", "r.json"), 0,
                stdout=["free rod", "converged", "certificate"], stderr=["wrote r.json"])
data = json.loads(pathlib.Path("r.json").read_text())
assert data["status"] == "converged" and len(data["steps"]) == 1 and data["steps"][0]["parameter"] is None
assert "fields" not in data["steps"][0] and data["case"]["end"]["axial_force"] == 1
assert expect(run("run", "case.toml", "--quiet"), 0).stderr == ""

only = expect(run("run", "case.toml", "--json", "-", "--fields", "--quiet"), 0)
fields = json.loads(only.stdout)["steps"][0]["fields"]
assert len({len(column) for column in fields.values()}) == 1 and len(fields["S"]) > 100
assert fields["S"][0] == 0 and abs(fields["S"][-1] - 1) < 1e-12

expect(run("run", "case.toml", "--from", "r.json"), 0)
expect(run("run", "case.toml", "--set", 'path={parameter="end.axial_force", values=[1.5, 2.0]}', "--out", "results"), 0,
       stdout=["step 1 of 2: end.axial_force = 1.5", "events"])
names = sorted(p.name for p in pathlib.Path("results").iterdir())
assert names == ["contacts.csv", "fields.csv", "result.json", "rod.pvd", "rod.vtp", "rod_0001.vtp", "rod_0002.vtp",
                 "tube.vtp"], names
steps = json.loads(pathlib.Path("results/result.json").read_text())["steps"]
assert [s["parameter"] for s in steps] == [1.5, 2.0]

# What cannot be written is a file error, and nothing is left of it.
expect(run("run", "case.toml", "--json", "/dev/full"), 6, stderr=["/dev/full"])
expect(run("run", "case.toml", "--json", "none/r.json"), 6, stderr=["none/r.json"])
with open("/dev/full", "w") as full:
    expect(run("run", "case.toml", stdout=full), 6, stderr=["standard output"])
assert not [p for p in os.listdir() if ".part" in p]

# Ctrl-C keeps what is done.
values = ", ".join(str(-7.07 - 0.02 * i) for i in range(5000))
command = [PROGRAM, "run", str(EXAMPLES / "helix_outer_20.toml"), "--json", "kept.json",
           "--set", f"path.values=[{values}]"]
with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
    time.sleep(2.0)
    process.send_signal(signal.SIGINT)
    stderr = process.communicate(timeout=60)[1]
assert process.returncode == 130, (process.returncode, stderr)
kept = json.loads(pathlib.Path("kept.json").read_text())
assert kept["interrupted"] is True and 0 < len(kept["steps"]) < 5000, len(kept["steps"])
