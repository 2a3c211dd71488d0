#!/usr/bin/env bash
# Makes the pictures of README and docs anew: runs the program and opens its pages in headless Chromium.
#   tests/pictures/make.sh [NAME]...       all, or some of:
#                                          spreading cell bands report drum heap roller hopper profile layers
#                                          window mixer machines mill accuracy
# PROGRAM (build/grainsweep) and CHROMIUM (chromium) may be given in the environment. The pictures go to docs/pictures,
# less than 150 kB each. Fifteen minutes of computing.
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
    awk '/^```json powder.json/ {inside = 1; next} /^```/ {inside = 0} inside' "$here/README.md" >powder.json
    "$program" run powder.json --quiet
    "$program" report powder.db -o whole.html
    sed 's#</head>#<style>main > section[id]:not(\#response):not(\#effects):not(\#explore), details {display: none}</style></head>#' \
        whole.html >report.html
    shoot report.html report 1300 1930 0.6
}

# The process window of the tutorial in docs/calibration.md.
window() {
    local condition="packing_fraction >= 0.42 and empty_share <= 0.03 and layer_roughness <= 0.6"
    "$program" run "$here/configs/cellulose_window.json" --quiet
    "$program" window cellulose_window.db --where "$condition" --maximize speed --next 8 --next-file next.json
    "$program" run next.json --db cellulose_window.db --quiet
    "$program" window cellulose_window.db --campaign cellulose_window --where "$condition" --maximize speed -o window.html
    shoot window.html window 1200 1320 0.6
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

# One case of each of the configs of drum, heap, roller and hopper, late in it.
drum() {
    "$program" solve "$here/configs/drum_speeds.json" --set rpm=24.42 --set friction=0.6 --watch drum.html
    shoot "drum.html#t=0.95" drum 900 640 0.85
}
heap() {
    "$program" solve "$here/configs/heap_friction.json" --set friction=0.7 --set rolling_friction=0.3 --watch heap.html
    shoot "heap.html#t=0.98" heap 900 640 0.85
}
roller() {
    "$program" solve "$here/configs/roller_or_blade.json" --set tool=roller --set speed=0.3 --set gap=0.006 --watch roller.html
    shoot "roller.html#t=0.6" roller 900 640 0.85
}
hopper() {
    "$program" solve "$here/configs/hopper_beverloo.json" --set opening_size=0.037 --watch hopper.html
    shoot "hopper.html#t=0.7" hopper 900 640 0.85
}

# A tool from an STL file: a bar whose front face slopes forward, so that it presses the powder down. mm.
profile() {
    awk 'BEGIN {
        split("0 0 -3 4 -3 25 5 25 5 0", at, " ")  # x, z of five corners, from the edge on, clockwise seen along y
        n = 5
        print "solid profile"
        for (k = 0; k < n; ++k) {
            m = (k + 1) % n
            facet(k, 0, m, 100, m, 0); facet(k, 0, k, 100, m, 100)
        }
        for (k = 1; k + 1 < n; ++k) { facet(0, 0, k, 0, k + 1, 0); facet(0, 100, k + 1, 100, k, 100) }
        print "endsolid profile"
    }
    function corner(k, y) { printf "vertex %g %g %g\n", at[2 * k + 1], y, at[2 * k + 2] }
    function facet(a, ya, b, yb, c, yc) {
        print "facet normal 0 0 0\nouter loop"; corner(a, ya); corner(b, yb); corner(c, yc); print "endloop\nendfacet"
    }' >profile.stl
    cat >profile.json <<'JSON'
{"campaign": "profile", "scene": "powder_spreading",
 "factors": [{"name": "speed", "between": [0.1, 0.8]}],
 "fixed": {"tool": "profile.stl", "gap": 0.006, "friction": 0.3, "rolling_friction": 0.1, "base": "rough", "layer_area": 6e-4},
 "design": {"kind": "halton", "points": 8}}
JSON
    "$program" solve profile.json --set speed=0.3 --watch profile.html
    shoot "profile.html#t=0.6" profile 900 640 0.85
}

# Four layers, one on the other, while the last is spread.
layers() {
    "$program" solve "$here/configs/layers_ten.json" --set surface_energy=1e-4 --set layers=4 --watch layers.html
    shoot "layers.html#t=0.93" layers 900 640 0.85
}

# The mixer of docs/tutorials/my_machine.md as its third step draws it: the first two blocks that write it.
mixer() {
    awk '/^```json mixer.json/ {++block} /^```/ {inside = /^```json mixer.json/ && block < 3; next} inside {print > "block" block}' \
        "$here/docs/tutorials/my_machine.md"
    python3 -c 'import json; a, b = (json.load(open(f)) for f in ("block1", "block2")); \
b["walls"].update(a["walls"]); print(json.dumps({**a, **b}))' >mixer.json
    "$program" draw mixer.json -o mixer.html
    shoot "mixer.html#t=0.37" machine_draw 1000 700 0.7
}

# Power of the mill against its speed, with and without lifters.
mill() {
    "$program" run "$here/configs/laboratory_mill.json" --quiet
    "$program" figure laboratory_mill.db cases --observable power --across speed --up power --colour lifters --width 110mm \
        -o "$pictures/mill_power.png"
}

# Every installed machine as it is drawn, without the controls of the page; machines that fill or
# work only later are shown in a case.
machines() {
    local name
    for name in $("$program" machines --format csv | tail -n +2 | cut -d, -f1); do
        case $name in
            chute | recoater | belt | vibrating_conveyor | vane_feeder | screen)  # they are filled while they run
                "$program" solve "$here/configs/machine_$name.json" --watch "$name.html" --frames 20 ;;
            *) "$program" draw "$name" -o "$name.html" ;;
        esac
        sed -i 's#</head>#<style>header, .watch-bar, .watch-choices, .watch-legends {display: none !important}</style></head>#' "$name.html"
        if [ "$name" = vane_feeder ]; then  # the rotor, not the tall hopper
            sed -i 's#<meta http-equiv="Content-Security-Policy"[^>]*>##; s#</body>#<script>setTimeout(() => { \
const { camera } = grainsweepWatch.player; camera.closer(0.35); camera.shift(0, -0.33); grainsweepWatch.player.draw(); }, 2000)</script></body>#' \
                "$name.html"
        fi
        shoot "$name.html#t=0.6" "machine_$name" 640 480 0.6
    done
}

# Error against cost of small cases: NAME OBSERVABLE TOLERANCE SCENE FACTORS FIXED
costed() {
    cat >"acc_$1.json" <<JSON
{"campaign": "acc_$1", $4, "factors": [$5], "fixed": {$6}, "seed": 5, "design": {"kind": "halton", "points": 32}}
JSON
    "$program" accuracy "acc_$1.json" --points 24 --observable "$2" --tolerance "$3" --quiet -o "accuracy_$1.svg" --width 170mm
    shoot "accuracy_$1.svg" "accuracy_$1" 643 "$(awk -F'height="' '/<svg/ {print int($2 * 4 / 3 + 1)}' "accuracy_$1.svg")" 1.6
}
accuracy() {
    local sizes='"size_distribution": "uniform", "size_spread": 0.1'
    costed spreading mfr 0.02 '"scene": "powder_spreading"' \
        '{"name": "friction", "between": [0.1, 0.4]}, {"name": "gap", "between": [0.0036, 0.0075]}' \
        '"diameter": 0.003, "layer_area": 1e-4, "youngs_modulus": 2e6'
    costed drum angle_cm 0.03 '"scene": "rotating_drum"' \
        '{"name": "friction", "between": [0.2, 0.8]}, {"name": "rpm", "between": [15, 45]}' \
        '"youngs_modulus": 2e5, "drum_diameter": 0.05, "length": 0.025, "diameter": 0.005, "fill": 0.35, "turning_time": 0.4, "measured_time": 0.4, '"$sizes"
    costed heap angle_moment 0.05 '"scene": "heap"' \
        '{"name": "friction", "between": [0.2, 0.8]}, {"name": "rolling_friction", "between": [0.05, 0.3]}' \
        '"youngs_modulus": 5e5, "particles": 150, "tube_diameter": 0.035, "diameter": 0.005, "end_time": 1.2, '"$sizes"
    costed hopper rate 0.04 '"scene": "hopper"' \
        '{"name": "friction", "between": [0.2, 0.8]}, {"name": "opening_size", "between": [0.025, 0.035]}' \
        '"youngs_modulus": 2e5, "particles": 300, "container_diameter": 0.05, "diameter": 0.005, "settle_time": 0.2, "end_time": 2, "stop_share": 0.52, '"$sizes"
    costed v_blender torque 0.03 '"scene": "machine", "machine": "v_blender"' \
        '{"name": "speed", "between": [20, 60]}, {"name": "friction_a", "between": [0.3, 0.8]}' \
        '"stiffness_scale": 0.4, "particles": 120, "diameter": 0.01, "revolutions": 1, "settle_time": 0.2'
}

pictures_there="spreading cell bands report drum heap roller hopper profile layers window mixer machines mill accuracy"
# shellcheck disable=SC2086 # one word each
if [ $# -eq 0 ]; then set -- $pictures_there; fi
for name in "$@"; do
    if [[ " $pictures_there " != *" $name "* ]]; then
        echo "no picture '$name': there are $pictures_there" >&2
        exit 2
    fi
    "$name"
done
