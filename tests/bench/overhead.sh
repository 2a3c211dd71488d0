#!/usr/bin/env bash
# What a case costs beside its computation: no-op cases end to end, durable, with -j2; GNU Parallel with a
# joblog beside it where installed; `status` of the finished database. JSON lines.
#   tests/bench/overhead.sh [CASES]
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
grainsweep=$here/build/grainsweep
cases=${1:-100000}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat >noop.json <<JSON
{"campaign": "noop", "scene": "rehearsal",
 "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]}],
 "design": {"kind": "halton", "points": $cases}}
JSON
now() { date +%s.%N; }
t0=$(now); "$grainsweep" run noop.json -j 2 --quiet >/dev/null; t1=$(now)
awk -v n="$cases" -v a="$t0" -v b="$t1" 'BEGIN { printf "{\"bench\": \"overhead\", \"cases\": %d, \"seconds\": %.3f, \"cases_per_second\": %.0f}\n", n, b - a, n / (b - a) }'
t0=$(now); "$grainsweep" status noop.db >/dev/null; t1=$(now)
awk -v n="$cases" -v a="$t0" -v b="$t1" 'BEGIN { printf "{\"bench\": \"status\", \"cases\": %d, \"seconds\": %.3f}\n", n, b - a }'
if command -v parallel >/dev/null; then
    jobs=2000
    t0=$(now); seq $jobs | parallel -j 2 --joblog joblog true; t1=$(now)
    awk -v n=$jobs -v a="$t0" -v b="$t1" 'BEGIN { printf "{\"bench\": \"gnu_parallel_joblog\", \"cases\": %d, \"seconds\": %.3f, \"cases_per_second\": %.0f}\n", n, b - a, n / (b - a) }'
fi
