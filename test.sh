#!/bin/bash
# Installs what the tests need, builds, and runs every test through CTest. Works on a fresh Debian 12.
#
#     ./test.sh                  everything
#     ./test.sh -L unit          the arguments go to CTest: one kind, -R name, --rerun-failed, ...
set -euo pipefail
cd "$(dirname "$0")"
source scripts/packages.sh

install_packages build test
build_burin -DBURIN_BUILD_TESTS=ON

# The official glTF validator, for tests/cli. Where the registry cannot be reached those tests say SKIPPED.
if [ ! -d build/npm/node_modules/gltf-validator ]; then
    echo "Installing gltf-validator from the npm registry into build/npm ..."
    mkdir -p build/npm
    npm install --prefix build/npm --no-save --no-audit --no-fund --loglevel=error gltf-validator@2.0.0-dev.3.10 ||
        echo "gltf-validator could not be installed; its tests will be skipped"
fi

exec ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
