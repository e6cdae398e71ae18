#!/usr/bin/env bash
# Says how many files to compile at once: all cores, but no more than the memory can feed.
set -euo pipefail

# The largest translation units (point clouds, sockets) take about 1.5 GB each.
by_memory=$(( $(awk '/^MemAvailable/ {print $2}' /proc/meminfo) / 1500000 ))
cores=$(nproc)
jobs=$(( by_memory < cores ? by_memory : cores ))
echo $(( jobs < 1 ? 1 : jobs ))
