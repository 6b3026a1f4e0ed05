#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Installs hone, builds examples/custom_pass and what `hone new-pass` writes against the installed tree, as their
# authors would, and renders with them:
#   custom_pass.sh SOURCE_DIR BUILD_DIR
# Works without a Vulkan device: rays say what is seen.
set -euo pipefail
source=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "$1"; exit 1; }

cmake --install "$build" --prefix "$work/prefix" >install.log
hone=$work/prefix/bin/hone
build_plugin() {
    cmake -S "$1" -B "$1/build" -DCMAKE_PREFIX_PATH="$work/prefix" >configure.log
    cmake --build "$1/build" >build.log
}
render() {
    "$hone" render "$@" --scene builtin:cornell --size 48x32 --set visibility=rays --device none --quiet
}

# The example: where nothing is wrong nothing is traced, where all is asked for the end is pure ray tracing.
cp -r "$source/examples/custom_pass" mine
build_plugin mine
plugin=$work/mine/build/libcustom_pass.so
graph=mine/silhouettes.json
"$hone" passes error.silhouettes --plugin "$plugin" | grep -q '(plug-in silhouettes)' || fail "the pass is not listed"
render $graph --plugin "$plugin" --set samples=2 --set threshold=1 -o untouched
"$hone" compare untouched/color.png untouched/raster.png --max-differing-bits 0 >/dev/null
render $graph --plugin "$plugin" --set samples=2 --set scope=all -o whole
"$hone" render prt --scene builtin:cornell --size 48x32 --set samples=2 --device none --quiet -o prt
"$hone" compare whole/silhouettes.exr prt/prt.exr --max-differing-bits 0 >/dev/null

# Without the plug-in the graph is refused, and says what is missing.
if render $graph -o nothing 2>refused.log; then fail "a pass was there without its plug-in"; fi
grep -q 'plug-in "silhouettes" is not loaded' refused.log || fail "the missing plug-in is not named"

# The template builds as it is, and is not written twice.
"$hone" new-pass error.my_metric -o new >new.log
build_plugin new
render new/error_my_metric.json --plugin new/build/liberror_my_metric_plugin.so -o made
test -s made/error.png || fail "the new pass made no picture"
status=0
"$hone" new-pass error.my_metric -o new 2>again.log || status=$?
test $status -eq 7 || fail "a folder was overwritten"
grep -q 'not empty' again.log
