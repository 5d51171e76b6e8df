#!/bin/sh
# Prints the table of resolution independence. Usage: bench/resolution/run.sh [build folder] [options of resolution]
# Takes some minutes: three surfaces of 8192 x 8192 are sampled for every row.
set -e
here=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$here/build}
[ $# -gt 0 ] && shift
cmake --build "$build" --target resolution
echo "## The whole way: map, trace, refine"
"$build/bench/resolution/resolution" --start vectorized "$@"
echo
echo "## Refinement alone: the drawing bent by 0.3 texels, profiles 5 % off"
"$build/bench/resolution/resolution" --start disturbed "$@"
