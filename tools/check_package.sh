#!/usr/bin/env bash
# The Python package as users get it: an sdist, a wheel from that sdist, the wheel installed into an empty environment with
# nothing of this tree in reach, and a case solved there. Needs the release build (for the program to compare with).
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD dist=build/dist
rm -rf "$dist" build/package
mkdir -p build/package/tmp
# The sdist is unpacked and compiled below build/, with the paths of the release build relative to it, so that objects that
# ccache has are taken from there; the report's page of the release build is used again.
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 TMPDIR=$root/build/package/tmp
page=$root/build/release/web/report.html
settings=()
[ ! -f "$page" ] || settings+=(-Ccmake.define.TENDRIL_REPORT_HTML="$page")
build/venv/bin/python -m build --outdir "$dist" "${settings[@]}" >build/package/log 2>&1 || { tail -50 build/package/log; exit 1; }
ls -l "$dist"

"$(readlink -f build/venv/bin/python)" -m venv build/package/venv
build/package/venv/bin/python -m pip install --quiet --disable-pip-version-check "$dist"/*.whl
build/release/bin/tendril run examples/s_bend.toml --json build/package/program.json --fields --quiet >/dev/null
cd build/package
env -u PYTHONPATH venv/bin/python - "$root" <<'PY'
import importlib.metadata, importlib.util, json, pathlib, sys
import tendril

root = pathlib.Path(sys.argv[1])
package = pathlib.Path(tendril.__file__).parent
assert package.is_relative_to(root / "build/package/venv"), package
version = importlib.metadata.version("tendril")
assert version == tendril.__version__ and f"project(tendril VERSION {version} " in (root / "CMakeLists.txt").read_text()
for name in ("py.typed", "_core.pyi", "plot.py"):
    assert (package / name).is_file(), name
strangers = [str(f) for f in importlib.metadata.files("tendril") if f.parts[0] not in ("tendril", f"tendril-{version}.dist-info")]
assert not strangers, strangers
assert not importlib.util.find_spec("pandas"), "the environment is meant to be empty"
result = tendril.load(root / "examples/s_bend.toml").solve()
told = json.loads(pathlib.Path("program.json").read_text())["steps"][-1]
assert result.converged and result.contacts.force.tolist() == [c["force"] for c in told["contacts"]]
assert result.x.tolist() == told["fields"]["x"]
print(f"tendril {version} from the wheel: {result}, the same numbers as the program")
PY
