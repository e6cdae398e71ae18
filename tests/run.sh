#!/usr/bin/env bash
# Everything: installs what is missing, builds, runs all tests.  Ends on ctest's summary.
#   tests/run.sh [ctest arguments, such as -R fusion/]
#   tests/run.sh --sanitize address|thread [ctest arguments]
#     the unit, integration and fusion-system tests instead, built with that sanitizer (presets asan and tsan)
#   tests/run.sh --sanitize address --changed [BASE]
#     only the unit tests of the rooms whose files differ from BASE (default: HEAD~1)
#   tests/run.sh --strict
#     instead: builds the programs of the demo with the release options and warnings as errors, and runs the demo from them
#   tests/run.sh --fuzz
#     instead: builds the libFuzzer targets with clang and runs each for five seconds (CHORUS_FUZZ_SECONDS); the ordinary run only tries
#     their seeds and inputs made from them (the tests corpus/)
#   tests/run.sh --nightly
#     instead, hours: everything under both sanitizers, and every fuzz target for ten minutes (CHORUS_FUZZ_SECONDS)
#   tests/run.sh --workshop
#     instead: makes the packages, installs them into fresh Debian roots without network, and tests them; boots one under systemd; makes a
#     container image and runs it; then uses five roots as hosts of a workshop, each with its own network (as root, minutes)
#   tests/run.sh --arm64
#     instead: compiles the packages of a sensor host for arm64 on amd64, installs them into a Debian root of that architecture, and has the
#     emulated sensor serve a frame (as root, a quarter of an hour; not in CI)
# CHORUS_JOBS=N limits the build (default: all cores, but no more than the memory can feed).
# CHORUS_TARGETS="base.file_test ..." builds only these with --sanitize; then choose the same tests by -R.
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

# npm ci once per lock file: later runs find the stamp and are quick.
npm_packages() {
  local stamp="$1/node_modules/.chorus-lock"
  cmp -s "$1/package-lock.json" "$stamp" && return
  npm ci --prefix "$1" --no-progress
  cp "$1/package-lock.json" "$stamp"
}

if [ "${1:-}" = --workshop ]; then
  deploy/install-packages.sh build workshop
  python3 -B tests/package/installed_root.py
  export CHORUS_PACKAGES=${CHORUS_PACKAGES:-$PWD/var/packages}
  python3 -B tests/package/booted.py
  python3 -B tests/package/container_image.py
  exec python3 -B tests/package/networked_workshop.py
fi

if [ "${1:-}" = --arm64 ]; then
  deploy/install-packages.sh workshop
  exec python3 -B tests/package/arm64_root.py
fi

sanitizer=""
if [ "${1:-}" = --sanitize ]; then
  case "${2:-}" in
    address) preset=asan ;;
    thread) preset=tsan ;;
    *) echo "usage: tests/run.sh --sanitize address|thread [ctest arguments]" >&2; exit 2 ;;
  esac
  sanitizer=$2
  shift 2
fi

if [ "${1:-}" = --changed ]; then
  [ -n "$sanitizer" ] || { echo "--changed goes behind --sanitize address" >&2; exit 2; }
  rooms=$(python3 -B tests/changed_rooms.py "${2:-HEAD~1}")
  [ -n "$rooms" ] || { echo "no room with unit tests was changed"; exit 0; }
  CHORUS_TARGETS=$(printf '%s.tests ' $rooms)
  set -- -L unit -R "^($(tr '\n' '|' <<<"$rooms" | sed 's/|*$//'))/"
fi

launcher=()
export CCACHE_SLOPPINESS=pch_defines,time_macros  # else it keeps nothing that reads a precompiled header
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
jobs=${CHORUS_JOBS:-$(deploy/build-jobs.sh)}

# A finding ends the test in which it occurs. Dynamically linked libraries are not instrumented, so the thread sanitizer is told to ignore
# them (tests/tsan.supp).
run_sanitized() {
  export ASAN_OPTIONS="detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1"
  export UBSAN_OPTIONS="print_stacktrace=1:halt_on_error=1"
  export TSAN_OPTIONS="halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tests/tsan.supp"
  step "build ($preset, $jobs at a time)"
  cmake --preset "$preset" "${launcher[@]}" --log-level=WARNING
  local -a targets=()
  read -ra targets <<<"${CHORUS_TARGETS:-all}"
  cmake --build "build/$preset" -j "$jobs" --target "${targets[@]}"
  step "tests under the $sanitizer sanitizer"
  exec ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" -L '^(unit|integration|fusion-system|corpus)$' "$@"
}

# What people run is built without assertions and with more optimisation, which finds other warnings.
run_strict() {
  step "release, warnings are errors, and its demo"
  cmake --preset strict "${launcher[@]}" --log-level=WARNING
  cmake --build build/strict -j "$jobs" --target chorus-sensor chorus-fusion chorus chorus-ergonomics chorus-evaluation
  local free='import sys; sys.path.insert(0, "tests/support"); from ports import free_ports; print(free_ports(8))'
  deploy/demo.sh --bin build/strict/bin --port "$(python3 -B -c "$free")" --seconds 20
}

# Every fuzz target on inputs as large as its reader takes; found inputs stay in the build tree and are where the next run goes on.
# $1: seconds for each; what follows goes to cmake.
run_fuzz() {
  local seconds=$1; shift
  step "fuzz targets (clang), $seconds s each"
  cmake --preset fuzz "${launcher[@]}" "$@" --log-level=WARNING
  cmake --build build/fuzz -j "$jobs" --target fuzzers
  cmake --preset dev "${launcher[@]}" -DCHORUS_FUZZ_TEST_SECONDS="$seconds" --log-level=WARNING
  local failed=""
  ctest --test-dir build/dev --output-on-failure -j "$(nproc)" -L '^fuzz$' || failed=yes
  cmake --preset dev -UCHORUS_FUZZ_TEST_SECONDS --log-level=WARNING
  [ -z "$failed" ]
}

# A long run puts back the optimisation that a short one does not wait for.
run_nightly() {
  local failed=""
  for one in address thread; do tests/run.sh --sanitize "$one" || failed=yes; done
  run_fuzz "${CHORUS_FUZZ_SECONDS:-600}" \
    -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1 -D_GLIBCXX_ASSERTIONS -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all" || failed=yes
  step "tests of minutes"
  cmake --preset dev "${launcher[@]}" --log-level=WARNING && cmake --build build/dev -j "$jobs"
  npm_packages tests && npm_packages services/viewer
  ctest --test-dir build/dev --output-on-failure -L '^nightly$' || failed=yes
  [ -z "$failed" ]
}

step "packages"
deploy/install-packages.sh build tests
if [ "${1:-}" = --nightly ]; then
  run_nightly
  exit
fi
if [ "${1:-}" = --fuzz ]; then
  run_fuzz "${CHORUS_FUZZ_SECONDS:-5}"
  exit
fi
[ -z "$sanitizer" ] || run_sanitized "$@"
if [ "${1:-}" = --strict ]; then
  npm_packages services/viewer
  run_strict
  exit
fi

# The build needs none of these, and they wait for the network; which tests there are depends on them.
modules=(tests services/viewer services/pose-runner)
(for folder in "${modules[@]}"; do npm_packages "$folder"; done) &
npm=$!
step "build (dev, $jobs at a time)"
configure_dev() { cmake --preset dev "${launcher[@]}" --log-level=WARNING; }
configure_dev
cmake --build build/dev -j "$jobs"
wait "$npm" || { echo "npm could not install what tests need: see above" >&2; exit 1; }
configure_dev
cmake --build build/dev -j "$jobs"
step "every header compiles alone"
cmake --build build/dev -j "$jobs" --target headers_alone

step "tests"
# Many tests wait for their child processes: so run two more than there are cores. Those with a COST start first, else they end alone.
rc=0
summary=$(mktemp)
ctest --test-dir build/dev --output-on-failure -j "$(( $(nproc) + 2 ))" -LE '^nightly$' "$@" | tee "$summary" || rc=$?
step "skipped, and what they wait for"
python3 -B tests/skipped.py build/dev
step "summary"
sed -n '/tests passed,/,$p' "$summary"
rm -f "$summary"
exit "$rc"
