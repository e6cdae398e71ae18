#!/usr/bin/env bash
# Everything: installs what is missing, builds, runs all tests.  Ends on ctest's summary.
#   tests/run.sh [ctest arguments, such as -R fusion/]
# CHORUS_JOBS=N limits the build (default: all cores, but no more than the memory can feed).
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

# The largest translation units (point clouds, sockets) take about 1.5 GB each.
build_jobs() {
  local by_memory=$(( $(awk '/^MemAvailable/ {print $2}' /proc/meminfo) / 1500000 ))
  local cores; cores=$(nproc)
  local jobs=$(( by_memory < cores ? by_memory : cores ))
  echo $(( jobs < 1 ? 1 : jobs ))
}

# npm ci once per lock file: a second run finds the stamp and is quick.
npm_packages() {
  local stamp="$1/node_modules/.chorus-lock"
  cmp -s "$1/package-lock.json" "$stamp" && return
  npm ci --prefix "$1" --no-progress
  cp "$1/package-lock.json" "$stamp"
}

launcher=()
export CCACHE_SLOPPINESS=pch_defines,time_macros  # else it keeps nothing that reads a precompiled header
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
jobs=${CHORUS_JOBS:-$(build_jobs)}

step "packages"
deploy/install-packages.sh build tests
npm_packages tests
npm_packages services/viewer

step "build (dev, $jobs at a time)"
cmake --preset dev "${launcher[@]}" --log-level=WARNING
cmake --build build/dev -j "$jobs"
step "every header compiles alone"
cmake --build build/dev -j "$jobs" --target all_verify_interface_header_sets

step "fuzz targets (clang)"
cmake --preset fuzz "${launcher[@]}" --log-level=WARNING
cmake --build build/fuzz -j "$jobs" --target fuzzers

step "tests"
exec ctest --test-dir build/dev --output-on-failure -j "$(nproc)" "$@"
