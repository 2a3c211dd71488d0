#!/usr/bin/env bash
# A program of MPI as a case, without Slurm: its ranks count against the cores. With every MPI that is installed (Open
# MPI, MPICH).
#   tests/slurm/mpi.sh GRAINSWEEP
# Exit code 77 where there is no MPI (mpicc with its headers, mpirun).
set -euo pipefail
grainsweep=$(realpath "$1")
sources=$(dirname "$(realpath "$0")")
folder=$(mktemp -d /tmp/gsmpi.XXXXXX)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
tried=0
for mpi in .openmpi .mpich ''; do
    [ "$mpi" != '' ] || [ "$tried" = 0 ] || continue  # the plain names are one of the two
    if ! command -v "mpirun$mpi" >/dev/null || ! "mpicc$mpi" -E -include mpi.h -x c /dev/null >/dev/null 2>&1; then continue; fi
    "mpicc$mpi" -o ranks "$sources/ranks.c"
    oversubscribe=$([ "$mpi" = .mpich ] || echo '"--oversubscribe", ')
    cat >c.json <<JSON
{"campaign": "c", "scene": "program",
 "program": {"command": ["mpirun$mpi", $oversubscribe"-np", "{processes}", "./ranks", "{x}"], "files": ["ranks"], "processes": 3,
  "environment": {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"},
  "parameters": {"x": {"unit": "1"}},
  "observables": {"sum": {"from": {"output": "sum = (.*)"}}, "ranks": {"from": {"output": "ranks = (.*)"}}}},
 "factors": [{"name": "x", "between": [0, 1]}], "design": {"kind": "halton", "points": 6}}
JSON
    "$grainsweep" run c.json --db "c$mpi.db" --quiet
    right=$("$grainsweep" query "c$mpi.db" "SELECT count(*) FROM c WHERE ranks = 3 AND abs(sum - 3 * x) < 1e-12" --format csv | tail -n 1)
    [ "$right" = 6 ] || { echo "mpirun$mpi: only $right of 6 cases are right"; exit 1; }
    echo "mpirun$mpi: 6 of 6 cases"
    tried=1
done
if [ "$tried" = 0 ]; then
    echo "skipped: there is no MPI (mpicc with its headers, mpirun)"
    exit 77
fi
