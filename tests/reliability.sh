#!/bin/bash
# Runs the suites that docs/reliability.md names and prints how often each misfortune was tried and how often the archive
# held, as rows of Markdown; then how many tests passed. long: also the programs that take hours (built on demand).
# BUILD: the folder of the build, by default build.
set -u
cd "$(dirname "$0")/.."
build=${BUILD:-build}
suites=$(sed -n 's/^|.*| \([A-Z][A-Za-z, ]*\) |$/\1/p' docs/reliability.md | tr -d ' ' | tr ',' '\n' | sort -u)
filter=$(for suite in $suites; do printf '%s.*:*/%s.*:' "$suite" "$suite"; done)
failed=0
run() {
    local log
    log=$(mktemp)
    "$@" >"$log" 2>&1 || { failed=1; grep -a '^\[  FAILED  \]' "$log" | sort -u; }
    grep -aE '^\| .* \| [0-9]+ \| [0-9]+ \|$' "$log"
    echo "$(basename "$1"): $(grep -a '^\[  PASSED  \]' "$log" | tail -n 1)"
    rm -f "$log"
}
echo "| misfortune | tried | held |"
echo "|---|---|---|"
for kind in unit campaign stability; do run "$build/tests/test_$kind" "--gtest_filter=$filter"; done
if [ "${1:-}" = long ]; then
    cmake --build "$build" --target slow_faults slow_soak slow_served >/dev/null || exit 1
    run "$build/tests/slow_faults"
    run "$build/tests/slow_served"
    GRAINSWEEP_SOAK_MINUTES=${GRAINSWEEP_SOAK_MINUTES:-60} run "$build/tests/slow_soak"
fi
exit $failed
