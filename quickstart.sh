#!/bin/bash
# From a fresh Debian 12 to a picture: installs what is missing, builds to build/, converts burin's sample plate, draws it,
# and composes out/quickstart.png.
set -euo pipefail
cd "$(dirname "$0")"
source scripts/packages.sh

install_packages build
build_burin -DBURIN_BUILD_TESTS=OFF -DBURIN_BUILD_BENCH=OFF

mkdir -p out
burin=build/cli/burin
echo; echo "Writing the sample height map out/plate.png ..."
build/samples/make_samples out

echo; echo "$burin convert out/plate.png -o out/plate.glb --size 0.2 --depth 0.0032"
$burin convert out/plate.png -o out/plate.glb --size 0.2 --depth 0.0032

echo; echo "$burin check out/plate.glb --against out/plate.png"
$burin check out/plate.glb --against out/plate.png

echo; echo "Drawing ..."
$burin render out/plate.glb -o out/plate_view.png --size 600x600 --zoom 1.25 --samples 9
scripts/compose_picture.sh out/plate.png out/plate.glb out/plate_view.png 0.016 0.395,0.225 out/quickstart.png
echo; echo "The picture is out/quickstart.png"
