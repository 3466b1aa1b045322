# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# A oneTBB that the thread sanitizer understands: Debian's library gives false races, one built with the sanitizer does
# not. Its source is Debian's own source package, from the mirror that this machine already uses. Sourced, never run.

# Kernels with many random address bits leave g++ 12's sanitizers no room for their shadow memory.
without_random_addresses=()
if setarch -R true 2>/dev/null; then without_random_addresses=(setarch -R); fi

# The lines of apt's configuration for source packages, from those for binary packages. Lists are read into a folder of
# our own: the machine's configuration and lists stay as they are.
source_list_of_this_machine() {
    local lists=$1 keyring=/usr/share/keyrings/debian-archive-keyring.gpg option=
    if [[ -r $keyring ]]; then option="[signed-by=$keyring] "; fi
    apt-get -o Dir::State::lists="$lists" indextargets --format "\$(ORIGIN)|deb-src $option\$(REPO_URI) \$(RELEASE) \$(COMPONENT)" \
        'Created-By: Packages' | sed -n 's/^Debian|//p' | sort -u
}

download_tbb_source() {
    local folder=$1
    mkdir -p "$folder/lists/partial"
    local options=(-o Dir::State::lists="$folder/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=
        -o APT::Sandbox::User= -o Acquire::Retries=3)
    apt-get "${options[@]}" update || return
    source_list_of_this_machine "$folder/lists" >"$folder/sources.list" || return
    options+=(-o Dir::Etc::SourceList="$folder/sources.list" -o Dir::Etc::SourceParts=-)
    apt-get "${options[@]}" update || return
    (cd "$folder" && apt-get "${options[@]}" source --download-only onetbb)
}

install_tbb_for_thread_sanitizer() {
    local folder=$1
    rm -rf "$folder"
    mkdir -p "$folder/source"
    download_tbb_source "$folder" || return
    tar -xf "$folder"/onetbb_*.orig.tar.* -C "$folder/source" --strip-components=1 || return
    cmake -G Ninja -S "$folder/source" -B "$folder/build" -DCMAKE_BUILD_TYPE=Release -DTBB_SANITIZE=thread \
        -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_TEST=OFF -DCMAKE_INSTALL_PREFIX="$folder/installed" || return
    cmake --build "$folder/build" -j "$(jobs_that_fit)" || return
    cmake --install "$folder/build" || return
    touch "$folder/done"
}

# thread_sanitizer_tbb FOLDER: leaves an installed oneTBB in FOLDER/installed, once.
thread_sanitizer_tbb() {
    if [[ -e $1/done ]]; then return; fi
    say "thread: builds oneTBB with the sanitizer from Debian's source package"
    in_log "thread: oneTBB" "$1.log" install_tbb_for_thread_sanitizer "$1"
}
