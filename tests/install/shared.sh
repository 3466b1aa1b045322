#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# shared.sh STAGE CONSUMER FOLDER CXX: links shared libraries from the objects of the installed static ones, which were
# compiled for both, and a consumer against them by what pkg-config says. Nothing but isotet's own names may be shown, and
# templates of the standard library, which show themselves.
set -euo pipefail
stage=$1 consumer=$2 folder=$3 cxx=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

rm -rf "$folder"
mkdir -p "$folder"
cp -r "$stage" "$folder/prefix"
lib=$(realpath "$(dirname "$(find "$folder/prefix" -name libisotet.a)")")
export PKG_CONFIG_PATH=$lib/pkgconfig

# link NAME NEEDED...: a library without names that are nowhere.
link() {
    local name=$1
    shift
    "$cxx" -shared -Wl,--no-undefined -Wl,-soname,"lib$name.so" -Wl,-rpath,'$ORIGIN' -o "$lib/lib$name.so" \
        -Wl,--whole-archive "$lib/lib$name.a" -Wl,--no-whole-archive -L"$lib" "$@"
    local foreign
    foreign=$(nm -DC --defined-only "$lib/lib$name.so" | cut -d' ' -f3- |
        grep -vE 'isotet::|^isotet_[a-z_]*$|(^|[ <])(std|__gnu_cxx)::' || true)
    if [[ -n $foreign ]]; then
        echo "lib$name.so shows what is not isotet's:"
        head <<<"$foreign"
        return 1
    fi
}
link isotet -ltbb -lfmt -lmeshoptimizer -lpthread
link isotet_vulkan -lisotet -lfmt -ldl
link isotet_render -lisotet_vulkan -lisotet -lfmt -lfreetype
link isotet_io -lisotet -lfmt -lpng -lwebpmux -lwebp -ldeflate -llz4 -llzma -lpugixml -ldl
rm "$lib"/libisotet_io.a "$lib"/libisotet.a "$lib"/libisotet_vulkan.a "$lib"/libisotet_render.a

read -ra flags < <(pkg-config --cflags --libs isotet-render isotet-io)
for component in isotet vulkan render io; do
    "$cxx" "$consumer/$component.cpp" "${flags[@]}" -Wl,-rpath,"$lib" -o "$folder/$component"
    "$folder/$component"
done

# The C functions: from C, and from Python's ctypes without a header.
c_flags=()
for flag in "${flags[@]}"; do [[ $flag == -std=* ]] || c_flags+=("$flag"); done
cc -std=c99 -Wall -Wextra -Wpedantic -Werror "$here/c_face/main.c" "${c_flags[@]}" -lm -Wl,-rpath,"$lib" \
    -o "$folder/c_face"
(cd "$folder" && ./c_face)
(cd "$folder" && python3 -B "$here/c_face/face.py" "$lib/libisotet_io.so")

echo "$(nm -DC --defined-only "$lib/libisotet.so" | wc -l) names of libisotet.so"
