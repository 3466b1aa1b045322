#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Builds the Python package: a source archive, and from it one wheel for Linux on x86-64 and Python 3.10 and later, with
# oneTBB and the other libraries inside; then tries it in a fresh virtual environment, FOLDER/venv, that has what
# tests/python needs. ISOTET_PYTHON is the Python to build and try with (Debian's), ISOTET_INSTALLED a prefix to take the
# library from instead of compiling it, ISOTET_PAGE the page that isotet.html() fills (isotet docs page; without it that is an error).
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"

if (($# > 1)) || [[ ${1:-} == -* ]]; then
    echo "usage: $0 [FOLDER]    (build/wheel); the wheel is in FOLDER/dist" >&2
    [[ ${1:-} == -h || ${1:-} == --help ]] && exit 0
    exit 2
fi
folder=$(realpath -m "${1:-$root/build/wheel}")
python=${ISOTET_PYTHON:-/usr/bin/python3}
readonly folder python platform=manylinux_2_34_x86_64

install_packages "${packages_to_build[@]}" "${packages_for_python[@]}" || exit

# environment NAME REQUIREMENTS: a new virtual environment in FOLDER.
environment() {
    rm -rf "${folder:?}/$1"
    "$python" -m venv "$folder/$1"
    "$folder/$1/bin/python" -m pip --disable-pip-version-check --no-input install --quiet "${@:2}"
}

# Kept for the next run.
build_tools() {
    local asked=$root/python/build-requirements.txt
    if cmp -s "$asked" "$folder/tools/asked.txt"; then return; fi
    environment tools -r "$asked"
    cp "$asked" "$folder/tools/asked.txt"
}

source_archive() {
    rm -rf "$folder/source"
    "$folder/tools/bin/python" -m build --sdist --no-isolation --outdir "$folder/source" "$root"
}

# From the source archive, so that it is known to build.
raw_wheel() {
    local options=()
    if [[ -n ${ISOTET_INSTALLED:-} ]]; then options+=(--config-settings=cmake.define.ISOTET_INSTALLED="$ISOTET_INSTALLED"); fi
    rm -rf "$folder/raw" "$folder/build"
    CMAKE_BUILD_PARALLEL_LEVEL=$(jobs_that_fit) "$folder/tools/bin/python" -m pip wheel --no-deps --no-build-isolation \
        --wheel-dir "$folder/raw" --config-settings=build-dir="$folder/build" \
        --config-settings=cmake.define.ISOTET_WERROR=ON "${options[@]}" \
        "$folder"/source/*.tar.gz
}

# The licences of the libraries that auditwheel put into the wheel, from the Debian packages that they came from.
add_licences() {
    local licences library package
    licences=$(echo "$1"/isotet-*.dist-info/licenses)
    for library in "$1"/isotet.libs/*; do
        library=$(basename "$library")
        library=${library%%-*}
        package=$(dpkg -S "*/$library.so*" 2>/dev/null | sed 's/[:,].*//' | sort -u | head -n 1)
        if [[ ! -r /usr/share/doc/$package/copyright ]]; then
            echo "no licence was found for $library" >&2
            return 1
        fi
        cp "/usr/share/doc/$package/copyright" "$licences/$library.txt"
    done
    cp "$root/data/licences/Apache-2.0.txt" "$licences" # oneTBB's, to which Debian's file only points
}

repaired_wheel() {
    rm -rf "$folder/repaired" "$folder/unpacked" "$folder/dist"
    mkdir -p "$folder/dist"
    PATH=$folder/tools/bin:$PATH "$folder/tools/bin/auditwheel" repair --plat "$platform" --only-plat --strip \
        --wheel-dir "$folder/repaired" "$folder"/raw/isotet-*.whl
    "$folder/tools/bin/wheel" unpack --dest "$folder/unpacked" "$folder"/repaired/isotet-*.whl
    if [[ -n ${ISOTET_PAGE:-} ]]; then cp "$ISOTET_PAGE" "$(echo "$folder"/unpacked/isotet-*)/isotet/page.html"; fi
    add_licences "$(echo "$folder"/unpacked/isotet-*)"
    "$folder/tools/bin/wheel" pack --dest-dir "$folder/dist" "$folder"/unpacked/isotet-*
    cp "$folder"/source/*.tar.gz "$folder/dist"
}

# First with NumPy alone, then with what the tests need.
try_wheel() {
    environment venv "$folder"/dist/isotet-*.whl
    "$folder/venv/bin/python" -c '
import isotet
surface = isotet.make("kuhn", 16, ["sphere"]).contour(0.5)
assert isotet.check(surface, closed=True).sound
print(isotet.__version__, surface)'
    "$folder/venv/bin/python" -m pip --disable-pip-version-check --no-input install --quiet \
        -r "$root/python/test-requirements.txt"
}

step() {
    say "wheel: ${1//_/ }"
    measured "wheel: ${1//_/ }" in_log "wheel: ${1//_/ }" "$folder/$1.log" bash -euo pipefail -c "$(declare -f); $(declare -p root folder python platform); $1"
}

mkdir -p "$folder"
for name in build_tools source_archive raw_wheel repaired_wheel try_wheel; do step "$name" || exit; done
say "wheel: $(cd "$folder/dist" && echo *.whl), $(stat -c %s "$folder"/dist/*.whl) bytes; tried in $folder/venv"
