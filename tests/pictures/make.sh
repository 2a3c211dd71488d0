#!/usr/bin/env bash
# Makes the pictures of README and docs anew: runs the program and opens its pages in headless Chromium.
#   tests/pictures/make.sh [NAME]...       all, or some of: spreading cell bands report
# PROGRAM (build/grainsweep) and CHROMIUM (chromium) may be given in the environment. The pictures go to docs/pictures,
# less than 150 kB each. Two minutes of computing.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=${PROGRAM:-$here/build/grainsweep}
chromium=${CHROMIUM:-chromium}
pictures=$here/docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$pictures"
cd "$work"

# shoot PAGE NAME WIDTH HEIGHT SCALE: the top of a page as docs/pictures/NAME.png.
# WebGL is drawn by the processor; virtual time lets scripts and animations come to an end.
shoot() {
    local file="$pictures/$2.png"
    "$chromium" --headless --no-sandbox --hide-scrollbars --use-angle=swiftshader --enable-unsafe-swiftshader \
        --user-data-dir="$work/browser" --force-device-scale-factor="$5" --window-size="$3,$4" \
        --virtual-time-budget=8000 --screenshot="$file" "file://$work/$1" >"$work/browser.log" 2>&1 ||
        { cat "$work/browser.log" >&2; exit 1; }
    local size
    size=$(stat -c %s "$file")
    if [ "$size" -ge 150000 ]; then
        echo "$file has $size bytes; make the window or the scale smaller" >&2
        exit 1
    fi
    echo "$file ($size bytes)"
}

# The campaign of the README, on its report page: three of its sections.
report() {
    awk '/^```json trial.json/ {inside = 1; next} /^```/ {inside = 0} inside' "$here/README.md" >trial.json
    "$program" run trial.json --quiet
    "$program" report trial.db -o whole.html
    sed 's#</head>#<style>main > section[id]:not(\#response):not(\#effects):not(\#explore), details {display: none}</style></head>#' \
        whole.html >report.html
    shoot report.html report 1300 1930 0.6
}

# Powder under the blade, halfway through the sweep.
spreading() {
    "$program" solve "$here/configs/quickstart.json" --set diameter=0.002 --set gap=0.004 --set width=40 --watch spreading.html
    shoot "spreading.html#t=0.93" spreading 900 640 0.85
}

# Powder leaving a Gyroid cell at a fifth of the study's size.
cell() {
    "$program" solve "$here/configs/gupta_quick.json" --set cell=gyroid --set cohesion=25000 --set edge=30 --set gravity=32.7 \
        --set end_time=2 --watch cell.html
    shoot "cell.html#t=0.4" cell 900 640 0.75
}

# Particles gathered at two side walls of the vibrated cube, seen along x, without the slice of the flow.
bands() {
    "$program" solve "$here/configs/lappa2024_run29.json" --set coupling=two_way --set end_time=0.5 --set cells=20 \
        --set steps_per_period=16 --watch bands.html
    sed -i "s#</body>#<script>{ const p = grainsweepWatch.player; p.chooseSlice(-1); p.look('side'); p.camera.turn(0.15, 0.12); \
p.show(59); }</script></body>#" bands.html
    shoot bands.html bands 900 640 0.85
}

if [ $# -eq 0 ]; then set -- spreading cell bands report; fi
for name in "$@"; do
    case $name in
        spreading | cell | bands | report) "$name" ;;
        *)
            echo "no picture '$name': there are spreading cell bands report" >&2
            exit 2
            ;;
    esac
done
