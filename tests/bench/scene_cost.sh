#!/usr/bin/env bash
# What a particle and step cost in the scenes that users run, beside the settled bed of bench_dem, measured in turns in
# one run: the first case of each campaign on one core, and the README's example with and without attraction.
# Nanoseconds of processor time, settling and measuring included; `ratio` divides by the mean of the bed's before and
# after. JSON lines.
#   tests/bench/scene_cost.sh [CONFIG]...
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
grainsweep=$here/build/grainsweep
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -r "$here/configs/." "$folder"
cd "$folder"

# bed: ns per particle and step of the settled bed on the fastest instruction path, as the program takes it
bed() {
    "$here/build/tests/bench_dem" --scene settled_20k --steps 1000 | sed -n 's/.*"ns_mean": \([0-9.]*\).*/\1/p' | sort -g | head -n 1
}

# The README's example, and the same powder without attraction.
awk '/^```json powder.json/ {inside = 1; next} /^```/ {inside = 0} inside' "$here/README.md" >readme.json
sed 's|"jkr", "surface_energy": "0.1 mJ/m2"|"sjkr", "cohesion": 0|' readme.json >readme_no_attraction.json

names=("$@")
if [ $# -eq 0 ]; then
    names=(quickstart readme readme_no_attraction hopper_beverloo heap_friction roller_or_blade
        laboratory_tapped_density tpms_vibration gupta_quick)
fi
for name in "${names[@]}"; do
    before=$(bed)
    "$grainsweep" run "$name.json" --db "$name.db" -j 1 --max-cases 1 --quiet >/dev/null 2>&1 || true
    after=$(bed)
    "$grainsweep" query "$name.db" --format csv "SELECT 1e9 * sum(cpu_seconds) / sum(particle_steps), sum(cpu_seconds),
        sum(particle_steps) FROM attempt" | tail -n 1 | tr ',' ' ' | {
        read -r cost seconds steps
        awk -v name="$name" -v cost="$cost" -v seconds="$seconds" -v steps="$steps" -v a="$before" -v b="$after" 'BEGIN {
            printf "{\"bench\": \"scene_cost\", \"campaign\": \"%s\", \"ns\": %.1f, \"bed_ns\": %.1f, \"ratio\": %.2f, \"seconds\": %.1f, \"particle_steps\": %.3g}\n",
                name, cost, (a + b) / 2, 2 * cost / (a + b), seconds, steps }'
    }
done
