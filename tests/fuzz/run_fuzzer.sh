#!/bin/sh
# Runs one fuzz target when it has been built (preset fuzz), and says "skipped" to ctest when not.
[ -x "$1" ] || { echo "not built: cmake --preset fuzz && cmake --build build/fuzz --target fuzzers"; exit 77; }
exec "$@"
