#!/bin/bash
# Measures burin beside all rivals and judges and remakes docs/performance.md. Usage: bench/performance/run.sh [options of performance.py]
# Installs what it needs and builds the benches to build/.
set -euo pipefail
cd "$(dirname "$0")/../.."
case " $* " in
*" --document "* | *" --help "* | *" -h "*) ;;
*)
    source scripts/packages.sh
    install_packages build test
    cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release
    cmake --build build --target bench_rivals bench_figure12 bench_geometry bench_runtime bench_pack bench_reference
    ;;
esac
exec /usr/bin/python3 -B bench/performance/performance.py "$@"
