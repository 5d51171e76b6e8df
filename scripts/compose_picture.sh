#!/bin/bash
# Composes one picture: the map, the drawn asset, and one close-up of both under the same light, with bytes and error.
#
#     scripts/compose_picture.sh MAP ASSET VIEW RELIEF U,V OUT.png
#
# VIEW is a drawn view of ASSET; RELIEF is depth divided by extent; U,V is the middle of the close-up.
set -euo pipefail
cd "$(dirname "$0")/.."
map=$1 asset=$2 view=$3 relief=$4 middle=$5 out=$6
build=${BURIN_BUILD:-build}
burin=$build/cli/burin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Figures, read from what burin prints.
value() { sed -n "s/^ *\"$1\": \([^,]*\),\{0,1\}$/\1/p" "$2" | head -n 1; }
$burin info "$asset" --format json >"$work/info.json"
$burin info "$map" --format json >"$work/map.json"
$burin check "$asset" --against "$map" --format json >"$work/check.json"
textures=$(($(value grid_bytes "$work/info.json") + $(value data_bytes "$work/info.json")))
texels=$(($(value width "$work/map.json") * $(value height "$work/map.json")))
percent=$(awk -v x="$(value rms "$work/check.json")" 'BEGIN { printf "%.2f", 100 * x }')
explained=$(awk -v x="$(value explained "$work/check.json")" 'BEGIN { printf "%.2f", 100 * x }')

# The close-up: a square of 0.11 of the map's width, as the shader draws it and as the raster has it.
side=400
$burin render "$asset" --top --size 4096 -o "$work/heights.exr" -q
"$build/samples/shade_heights" "$work/heights.exr" "$middle,0.11" $side "$relief" "$work/near.png"
"$build/samples/shade_heights" "$map" "$middle,0.11" $side "$relief" "$work/raster.png"

# One panel: a picture of side x side pixels with a caption under it.
panel() {
    convert "$1" -depth 8 -colorspace sRGB -resize "${side}x${side}" -background '#202020' -gravity center \
        -extent "${side}x${side}" -gravity south -splice 0x28 -font DejaVu-Sans -pointsize 14 -fill white \
        -annotate +0+6 "$2" "$3"
}
convert "$map" -auto-level "$work/map.png"
panel "$work/map.png" "map: $((texels * 2 / 1024)) KiB as 16-bit texels" "$work/1.png"
panel "$view" "burin: $textures bytes of textures, RMS error $percent %%" "$work/2.png"
panel "$work/raster.png" "close-up of the map, bilinear" "$work/3.png"
panel "$work/near.png" "the same close-up of burin, $explained %% explained" "$work/4.png"
convert \( "$work/1.png" "$work/2.png" +append \) \( "$work/3.png" "$work/4.png" +append \) -append \
    -define png:exclude-chunks=date,time "$out"
