#!/usr/bin/env bash
# What a case costs beside its computation: no-op cases end to end, durable, with -j2, and GNU Parallel with a joblog
# beside it where installed; the same through a host (execution.hosts). Then a million of them: the plan, the time until the first case begins, the run, its
# memory, the same run again with nothing left to do. Programs as cases: one that does nothing, once per case, beside
# GNU Parallel, and one in C++ that stays alive and answers line by line. JSON lines; memory is the resident memory of the main program at
# its highest, MB of 10^6 bytes.
#   tests/bench/overhead.sh [CASES [MANY]]
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
grainsweep=$here/build/grainsweep
cases=${1:-100000}
many=${2:-1000000}
jobs=2000 # of GNU Parallel: enough to tell its rate
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

now() { date +%s.%N; }
# campaign NAME CASES [MEMBERS] > file
campaign() {
    cat <<JSON
{"campaign": "$1", "scene": "rehearsal",${3:-}
 "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]}],
 "design": {"kind": "halton", "points": $2}}
JSON
}
# watched COMMAND...: seconds, and kB at most, into $seconds and $memory; what the command writes goes nowhere
watched() {
    local start process seen
    start=$(now)
    "$@" >/dev/null &
    process=$!
    memory=0
    while seen=$(awk '/VmHWM/ { print $2 }' "/proc/$process/status" 2>/dev/null) && [ -n "$seen" ]; do
        memory=$seen
        sleep 0.1
    done
    wait "$process"
    seconds=$(awk -v a="$start" -v b="$(now)" 'BEGIN { print b - a }')
}
# told BENCH CASES [WHAT VALUE]...: one line
told() {
    awk -v bench="$1" -v n="$2" -v s="$seconds" -v kb="$memory" -v more="${3:-}" 'BEGIN {
        printf "{\"bench\": \"%s\", \"cases\": %d, \"seconds\": %.3f, \"cases_per_second\": %.0f, \"memory_mb\": %.0f%s}\n",
            bench, n, s, n / s, kb * 1024 / 1e6, more }'
}

campaign noop "$cases" >noop.json
watched "$grainsweep" run noop.json -j 2 --quiet
told overhead "$cases"
watched "$grainsweep" status noop.db
told status "$cases"

campaign hosted "$cases" ' "execution": {"hosts": 1, "workers_per_host": 2},' >hosted.json
watched "$grainsweep" run hosted.json --quiet
told overhead_through_a_host "$cases"

if command -v parallel >/dev/null; then
    memory=0
    t0=$(now); seq $jobs | parallel -j 2 --joblog joblog true; t1=$(now)
    seconds=$(awk -v a="$t0" -v b="$t1" 'BEGIN { print b - a }')
    awk -v n=$jobs -v many="$many" -v s="$seconds" 'BEGIN {
        printf "{\"bench\": \"gnu_parallel_joblog\", \"cases\": %d, \"seconds\": %.3f, \"cases_per_second\": %.0f, ", n, s, n / s
        printf "\"seconds_of_%d_at_this_rate\": %.0f}\n", many, many * s / n }'
fi

cat >command.json <<JSON
{"campaign": "command", "scene": "program", "program": {"command": ["true"], "cost_seconds": 0.005},
 "factors": [{"name": "x", "between": [0, 1]}], "design": {"kind": "halton", "points": $jobs}}
JSON
watched "$grainsweep" run command.json -j 2 --quiet
told program_command "$jobs"
cat >twice.cpp <<'CPP'
#include <cstdlib>
#include <iostream>
#include <string>
int main() {
    for (std::string line; std::getline(std::cin, line);)
        std::cout << "{\"observables\":{\"y\":" << 2 * std::strtod(line.c_str() + line.find("\"x\":") + 4, nullptr) << "}}" << std::endl;
}
CPP
if c++ -O2 -o twice twice.cpp; then
    cat >lines.json <<JSON
{"campaign": "lines", "scene": "program",
 "program": {"command": ["./twice"], "files": ["twice"], "protocol": "lines", "observables": {"y": {"unit": "1"}}},
 "factors": [{"name": "x", "between": [0, 1]}], "design": {"kind": "halton", "points": $((10 * jobs))}}
JSON
    watched "$grainsweep" run lines.json -j 2 --quiet
    told program_lines "$((10 * jobs))"
fi

campaign many "$many" >many.json
watched "$grainsweep" plan many.json
told plan_many "$many"
start=$(now)
watched "$grainsweep" run many.json -j 2 --quiet
begun=$("$grainsweep" query many.db "SELECT min(started) FROM attempt" --format csv | tail -n 1)
told overhead_many "$many" "$(awk -v a="$start" -v b="$(date -d "$begun" +%s.%N)" \
    'BEGIN { printf ", \"first_case_after\": %.2f", b - a }')"
watched "$grainsweep" run many.json -j 2 --quiet
told nothing_left_of_many "$many"
