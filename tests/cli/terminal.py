"""Starter cases that run as they are, completion and the manual page."""

import json
import os
import pathlib
import shutil
import subprocess

from _tendril import expect, run

shutil.rmtree("starters", ignore_errors=True)
for name in ("vessel", "well", "helix", "straight"):
    told = expect(run("init", name, "-o", "starters"), 0, stderr=[f"next: tendril run starters/{name}.toml"])
    expect(run("check", f"starters/{name}.toml"), 0)
    solved = expect(run("run", f"starters/{name}.toml", "--quiet", "--json", "-"), 0)
    result = json.loads(solved.stdout)
    assert result["status"] == "converged" and result["steps"][-1]["contacts"], name  # each shows what it is for
    text = pathlib.Path(f"starters/{name}.toml").read_text()
    assert text.count("  # ") >= 8, name  # it says what its numbers are

# What is there is not replaced by accident; a typo is answered.
pathlib.Path("starters/helix.toml").write_text("mine")
expect(run("init", "helix", "-o", "starters"), 6, stderr=["starters/helix.toml", "--force"])
assert pathlib.Path("starters/helix.toml").read_text() == "mine"
expect(run("init", "helix", "-o", "starters", "--force"), 0)
expect(run("init", "vesel"), 2, stderr=["did you mean `vessel`"])


def completed(*words):
    """What bash offers for the last word."""
    script = ('source ./tendril.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _tendril; echo "${COMPREPLY[@]}"')
    told = subprocess.run(["bash", "-c", script, "bash", *words], capture_output=True, text=True, check=True)
    assert told.stderr == "", told.stderr
    return told.stdout.split()


pathlib.Path("tendril.bash").write_text(expect(run("completion", "bash"), 0).stdout)
assert completed("tendril", "ch") == ["check"]
assert completed("tendril", "run", "--fi") == ["--fields"]
assert completed("tendril", "init", "") == ["vessel", "well", "helix", "straight"]
assert completed("tendril", "explain", "tube.axis.p") == ["tube.axis.pitch_angle", "tube.axis.points"]
assert completed("tendril", "run", "case") == []  # left to the shell: files
assert completed("tendril", "--ver") == ["--version"]
for shell in ("zsh", "fish"):
    script = expect(run("completion", shell), 0, stdout=["--fields" if shell == "zsh" else "-l fields", "vessel"]).stdout
    pathlib.Path(f"tendril.{shell}").write_text(script)
    if shutil.which(shell):  # its syntax, where the shell is there to tell
        subprocess.run([shell, "-n", f"tendril.{shell}"], check=True)
expect(run("completion", "tcsh"), 2, stderr=["bash, zsh, fish"])

page = expect(run("man"), 0, stdout=[".TH TENDRIL 1", "tendril run CASE", "\\-\\-fields", "exit codes"]).stdout
if shutil.which("groff"):
    told = subprocess.run(["groff", "-man", "-Tutf8", "-ww"], input=page, capture_output=True, text=True, check=True,
                          env=dict(os.environ, LC_ALL="C.UTF-8"))
    assert told.stderr == "", told.stderr
