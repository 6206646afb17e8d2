#!/usr/bin/env bash
# Install the Debian packages that building and testing need, if any is missing. Uses apt as root or through sudo;
# without either, prints the one line to run and exits 2. On systems without dpkg it only names what is needed.
# `tools/setup.sh tests` adds the browser that the tests of the report's page drive.
set -euo pipefail

packages=(
  g++ cmake ninja-build make ccache pkg-config python3 python3-venv python3-dev git ca-certificates
  libeigen3-dev libfmt-dev nlohmann-json3-dev libtomlplusplus-dev libcli11-dev libhdf5-dev
  libpugixml-dev zlib1g-dev
  libgtest-dev libboost-dev libbenchmark-dev clang-format
)
# Node builds the report's page; one that did not come from Debian's packages will do.
command -v npm >/dev/null && command -v node >/dev/null || packages+=(nodejs npm)
[ "${1:-}" != tests ] || command -v chromium >/dev/null || packages+=(chromium)

if ! command -v dpkg-query >/dev/null; then
  echo "setup: not a Debian system; needed are the equivalents of: ${packages[*]}" >&2
  exit 0
fi
missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=()
elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
  as_root=(sudo)
else
  echo "setup: packages are missing and there is neither root nor sudo here; run as root:" >&2
  echo "apt-get update && apt-get install -y --no-install-recommends ${missing[*]}" >&2
  exit 2
fi
echo "setup: installing ${missing[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
install=(env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}")
# The package lists may be absent or old: refresh them only when needed.
"${as_root[@]}" "${install[@]}" >/dev/null 2>&1 || {
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" "${install[@]}" >/dev/null
}
