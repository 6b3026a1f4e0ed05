#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Installs hone, builds examples/custom_backend against the installed tree as its author would, and renders with it:
#   custom_backend.sh SOURCE_DIR BUILD_DIR
# The image must be Embree's, bit for bit.
set -euo pipefail
source=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cmake --install "$build" --prefix "$work/first" >install.log
mv first prefix # an installed tree may be moved
hone=$work/prefix/bin/hone
"$hone" check prt | grep -q "^$work/prefix/" # its own graphs, not the source tree's
"$hone" check oracle table1 >check.log # with all graphs that they use
cp -r "$source/examples/custom_backend" mine
cmake -S mine -B built -DCMAKE_PREFIX_PATH="$work/prefix" >configure.log
cmake --build built >build.log
plugin=$work/built/libcustom.so

render() {
    "$hone" render prt --scene builtin:cornell --size 96x64 --set samples=2 --device none --quiet "$@"
}
render --set backend=embree -o embree
render --set backend=custom -o custom --plugin "$plugin"
"$hone" compare embree/prt.exr custom/prt.exr --max-differing-bits 0

# The installed folder is searched; a working directory is not.
if (cd built && render --set backend=custom -o nothing) 2>refused.log; then
    echo "a plug-in was loaded from the working directory"; exit 1
fi
grep -q 'no trace backend "custom"' refused.log
find prefix -type d -path '*/hone/plugins' -exec cp "$plugin" {} \;
render --set backend=custom -o installed
cmp custom/prt.exr installed/prt.exr
