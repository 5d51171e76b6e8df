#!/bin/bash
# Prints the tables of time and memory against vtracer. Usage: bench/speed/run.sh [options of speed.py]
# Installs what it needs: the packages of the group `bench` and, into build/npm, @neplex/vectorizer.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/packages.sh
install_packages build bench
[ -x build/cli/burin ] || build_burin
if [ ! -d build/npm/node_modules/@neplex/vectorizer ]; then
    npm install --prefix build/npm --no-save --no-audit --no-fund --loglevel=error @neplex/vectorizer@0.1.0
fi
exec /usr/bin/python3 bench/speed/speed.py "$@"
