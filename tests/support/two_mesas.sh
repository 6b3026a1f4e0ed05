#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# Puts Mesa's software Vulkan driver from Debian 12's backports beside the installed one, without
# installing it, so that tests can run on both:
#
#     VK_DRIVER_FILES=$(tests/support/two_mesas.sh) ctest --preset release
#
# Prints the driver manifest's path. Everything lies in build/mesa25 (or the folder given); a second
# call downloads nothing. Needs no root. Exits 1 and says why where the driver cannot be had.
set -eu

cd "$(dirname "$0")/../.."
mkdir -p "${1:-build/mesa25}"
folder=$(cd "${1:-build/mesa25}" && pwd)
manifest=$folder/lvp_icd.json

fail() {
    echo "two_mesas.sh: $1" >&2
    exit 1
}

if [ ! -f "$manifest" ]; then
    for tool in apt-get dpkg-deb; do
        command -v $tool >/dev/null || fail "no $tool: this works on Debian 12 only"
    done

    # Apt with lists and caches of its own: the system's stay as they are.
    mkdir -p "$folder/lists/partial" "$folder/cache/archives/partial"
    site=$(apt-get indextargets --format '$(SITE)' 'Codename: bookworm' 'Created-By: Packages' | head -1)
    [ -n "$site" ] || fail "apt knows no mirror of Debian 12; apt-get update first"
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $site bookworm-backports main" \
        >"$folder/sources.list"
    apt() {
        apt-get -qq -o Dir::Etc::sourcelist="$folder/sources.list" -o Dir::Etc::sourceparts=- \
            -o Dir::State::lists="$folder/lists" -o Dir::Cache="$folder/cache" \
            -o APT::Sandbox::User= "$@"
    }
    apt update >&2 || fail "bookworm-backports cannot be reached"
    (cd "$folder" && apt download mesa-vulkan-drivers >&2) ||
        fail "mesa-vulkan-drivers cannot be downloaded"
    dpkg-deb -x "$folder"/mesa-vulkan-drivers_*.deb "$folder/root"

    # Debian 12's own libLLVM 15 and libdrm serve this driver; only its manifest must name the
    # unpacked library.
    library=$(echo "$folder"/root/usr/lib/*/libvulkan_lvp.so)
    [ -f "$library" ] || fail "the package holds no libvulkan_lvp.so"
    missing=$(ldd -r "$library" 2>&1 | grep -E "not found|undefined symbol") &&
        fail "the driver does not load here: $missing"
    sed "s|\"library_path\": *\"[^\"]*\"|\"library_path\": \"$library\"|" \
        "$folder"/root/usr/share/vulkan/icd.d/lvp_icd*.json >"$manifest.new"
    mv "$manifest.new" "$manifest"
fi
echo "$manifest"
