# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# What ./run and ./test share: installing packages, building a preset. Sourced by both, from the repository's top.

say() { printf '%s\n' "$*" >&2; }
die() { say "$1"; exit "${2:-1}"; }

# packages SECTION...: the package names of these sections of packages.txt.
packages() {
    awk -v wanted=" $* " '
        /^\[/ { section = substr($1, 2, index($1, "]") - 2); next }
        /^[a-z0-9]/ && index(wanted, " " section " ") { print $1 }' packages.txt
}

# need SECTION...: installs what is missing of these sections; without root says how and stops with 3.
need() {
    if ! command -v dpkg-query >/dev/null; then
        say "This is not Debian; make sure you have what packages.txt lists under: $*"
        return
    fi
    local missing
    # shellcheck disable=SC2016  # the format is dpkg-query's
    mapfile -t missing < <(comm -23 <(packages "$@" | sort -u) \
        <(packages "$@" | xargs dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' 2>/dev/null | awk '$1 == "ii" { print $2 }' | sort -u))
    [ "${#missing[@]}" -eq 0 ] && return
    local line="apt-get install -y --no-install-recommends ${missing[*]}"
    if [ "$(id -u)" -ne 0 ]; then
        say "Some Debian packages are missing. As root, run:"
        say "  $line"
        exit 3
    fi
    say "Installing ${#missing[@]} Debian packages: ${missing[*]}"
    mkdir -p build
    export DEBIAN_FRONTEND=noninteractive
    # shellcheck disable=SC2086  # the line is the very one printed to people without root
    if ! { apt-get update && $line; } </dev/null >build/packages.log 2>&1; then
        tail -n 30 build/packages.log >&2
        die "Could not install the packages; all of the output is in build/packages.log"
    fi
}

# quietly LOG COMMAND...: runs it with its output in LOG; on a terminal the last line shows; on failure, the log's end.
quietly() {
    local log=$1 status=0
    shift
    mkdir -p "$(dirname "$log")"
    if [ -t 2 ]; then
        "$@" 2>&1 </dev/null | tee "$log" | while IFS= read -r line; do printf '\r\033[K%.*s' "$(($(tput cols 2>/dev/null || echo 80) - 1))" "$line" >&2; done
        status=${PIPESTATUS[0]}
        printf '\r\033[K' >&2
    else
        "$@" >"$log" 2>&1 </dev/null || status=$?
    fi
    if [ "$status" -ne 0 ]; then
        grep -nE -m 20 'error|FAILED|undefined reference' "$log" >&2 || true
        say "--- end of $log:"
        tail -n 40 "$log" >&2
    fi
    return "$status"
}

# build PRESET [TARGET...]: configures when needed and builds. One at a time per preset.
build() {
    local preset=$1 target targets=()
    shift
    for target in "$@"; do targets+=(--target "$target"); done
    if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] && command -v ccache >/dev/null; then
        export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
    fi
    mkdir -p build
    (
        flock 9
        if [ ! -f "build/$preset/build.ninja" ] || [ "${RECONFIGURE:-0}" = 1 ]; then
            quietly "build/$preset-configure.log" cmake --preset "$preset" || exit 1
        fi
        quietly "build/$preset-build.log" cmake --build "build/$preset" "${targets[@]}" || exit 1
    ) 9>"build/$preset.lock"
}
