#!/usr/bin/env bash
# A program of MPI as a case, without Slurm: its ranks count against the cores.
#   tests/slurm/mpi.sh GRAINSWEEP
# Exit code 77 where there is no MPI (mpicc with its headers, mpirun).
set -euo pipefail
grainsweep=$(realpath "$1")
sources=$(dirname "$(realpath "$0")")
if ! command -v mpirun >/dev/null || ! mpicc -E -include mpi.h -x c /dev/null >/dev/null 2>&1; then
    echo "skipped: there is no MPI (mpicc with its headers, mpirun)"
    exit 77
fi
folder=$(mktemp -d /tmp/gsmpi.XXXXXX)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mpicc -o ranks "$sources/ranks.c"
cat >c.json <<'JSON'
{"campaign": "c", "scene": "program",
 "program": {"command": ["mpirun", "--oversubscribe", "-np", "{processes}", "./ranks", "{x}"], "files": ["ranks"], "processes": 3,
  "environment": {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"},
  "parameters": {"x": {"unit": "1"}},
  "observables": {"sum": {"from": {"output": "sum = (.*)"}}, "ranks": {"from": {"output": "ranks = (.*)"}}}},
 "factors": [{"name": "x", "between": [0, 1]}], "design": {"kind": "halton", "points": 6}}
JSON
"$grainsweep" run c.json --db c.db --quiet
right=$("$grainsweep" query c.db "SELECT count(*) FROM c WHERE ranks = 3 AND abs(sum - 3 * x) < 1e-12" --format csv | tail -n 1)
[ "$right" = 6 ] || { echo "only $right of 6 cases are right"; exit 1; }
