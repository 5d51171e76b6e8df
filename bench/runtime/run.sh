#!/bin/sh
# Prints the tables of the runtime. Usage: bench/runtime/run.sh [build folder] [questions and options of bench_runtime]
# All questions take hours on two cores, most of it for the truth's pictures, which are kept in the build folder;
# --quick takes about half an hour, one question about one scene (--scene NAME) minutes.
set -e
here=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$here/build}
[ $# -gt 0 ] && shift
cmake --build "$build" --target bench_runtime
mkdir -p "$build/bench/runtime/truth"
"$build/bench/runtime/bench_runtime" --cache "$build/bench/runtime/truth" "$@"
