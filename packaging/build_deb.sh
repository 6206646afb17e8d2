#!/usr/bin/env bash
# Debian packages from this tree, into build/deb. Needs debhelper and the build dependencies of packaging/debian/control.
# The changelog's version comes from CMakeLists.txt; the page of the release build goes in if there is one.
set -euo pipefail
cd "$(dirname "$0")/.."
version=$(sed -n 's/^project(tendril VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
tree=build/deb/tendril-$version
rm -rf build/deb
mkdir -p "$tree"
git archive HEAD | tar -x -C "$tree"
cp -r "$tree/packaging/debian" "$tree/debian"
[ ! -f build/release/web/report.html ] || cp build/release/web/report.html "$tree/debian/report.html"
cat >"$tree/debian/changelog" <<CHANGES
tendril ($version) unstable; urgency=medium

  * See CHANGELOG.md.

 -- The Tendril authors <tendril@localhost>  $(git log -1 --format=%cD)
CHANGES
cd "$tree"
dpkg-buildpackage -b -us -uc
ls -l ../*.deb
