#!/usr/bin/env bash
# Campaigns under a Slurm of emulated nodes on this machine, disturbed in one way each; all must end in the dump of a
# run without Slurm.
#   tests/slurm/loopback.sh GRAINSWEEP SCENARIO
# SCENARIO: calm, host_killed, node_killed, spreading (a node killed under a real campaign), cancelled, requeued,
# controller, walltime, array, mpi (a case is a program of MPI), mpi_nodes (and needs several nodes)
# The cluster is made by `slurm-loopback` (start DIR, stop DIR, env DIR, kill-node DIR NODE, kill-ctld DIR, start-ctld
# DIR), named by the environment variable SLURM_LOOPBACK or found on the search path. Exit code 77 where it, or Slurm
# itself, is not installed.
set -euo pipefail
grainsweep=$(realpath "$1")
sources=$(dirname "$(realpath "$0")")
scenario=$2
loopback=${SLURM_LOOPBACK:-$(command -v slurm-loopback || true)}
export PATH=$PATH:/usr/sbin:/sbin
skip() {
    echo "skipped: $1"
    exit 77
}
[ -n "$loopback" ] && [ -x "$loopback" ] || skip "no slurm-loopback: SLURM_LOOPBACK is not set, and it is not on the search path"
command -v slurmctld munged sbatch >/dev/null || skip "Slurm is not installed (packages slurm-wlm, munge)"

folder=$(mktemp -d /tmp/gsslurm.XXXXXX)
cluster=$folder/slurm
finish() {
    local code=$?
    "$loopback" stop "$cluster" >/dev/null 2>&1 || true
    if [ $code -ne 0 ]; then
        echo "--- $scenario failed; what the jobs wrote:"
        tail -n 20 "$folder"/*.out 2>/dev/null || true
    fi
    rm -rf "$folder"
    exit $code
}
trap finish EXIT
mkdir "$cluster"
"$loopback" start "$cluster" --nodes 3 --cpus 2
eval "$("$loopback" env "$cluster")"
cd "$folder"

# campaign NAME POINTS SECONDS EXECUTION > file; SECONDS "spreading": powder spread by a blade
campaign() {
    if [ "$3" = spreading ]; then
        cat <<JSON
{"campaign": "$1", "scene": "powder_spreading",
 "factors": [{"name": "cohesion", "between": [0, 100000]}, {"name": "gap", "between": [0.0025, 0.005]},
             {"name": "speed", "between": [1.0, 1.5]}],
 "fixed": {"diameter": 0.002}, "design": {"kind": "halton", "points": $2}, "execution": $4}
JSON
        return
    fi
    cat <<JSON
{"campaign": "$1", "scene": "rehearsal",
 "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
 "fixed": {"response": "ishigami", "noise": 0.1, "wait_seconds": $3},
 "design": {"kind": "halton", "points": $2}, "execution": $4}
JSON
}
# The hosts of this cluster, into $hosts_there; whether there are three.
three_hosts() {
    hosts_there=($(processes_with "SLURM_JOB_ID=$job" "$grainsweep host"))
    [ ${#hosts_there[@]} -eq 3 ]
}
srun_host='["srun", "--nodes=1", "--ntasks=1", "--cpus-per-task=2", "--exact", "--mem=100"]'
hosts="{\"hosts\": 3, \"workers_per_host\": 2, \"launcher\": $srun_host}"
query() { "$grainsweep" query c.db "$1" --format csv 2>/dev/null | tail -n 1; }
finished() { query "SELECT count(outcome) FROM c"; }
# until SECONDS COMMAND...: waits until it succeeds
until_so() {
    local end=$((SECONDS + $1))
    shift
    until "$@"; do
        [ $SECONDS -lt $end ] || { echo "waited in vain: $*"; return 1; }
        sleep 0.2
    done
}
at_least() { [ "$(finished || echo 0)" -ge "$1" ] 2>/dev/null; }
# All of its tasks; a controller that does not answer says nothing.
is_over() {
    local states
    states=$(squeue -h -j "$1" -t all -o %T 2>/dev/null) || return 1
    [ -n "$states" ] && ! grep -qvxE "COMPLETED|FAILED|CANCELLED|TIMEOUT|NODE_FAIL" <<<"$states"
}
# A job that runs the campaign in its allocation: submitted NAME SBATCH-OPTION...
submitted() {
    cat >job.sh <<'JOB'
#!/bin/bash
# Older Slurms (22.05) do not set it.
export SLURM_JOB_END_TIME=${SLURM_JOB_END_TIME:-$(date -d "$(squeue -h -j $SLURM_JOB_ID -o %e)" +%s 2>/dev/null)}
$GRAINSWEEP run c.json --db c.db --quiet
code=$?
echo "exit code $code"
if [ $code -eq 75 ]; then scontrol requeue $SLURM_JOB_ID; sleep 30; fi
exit $code
JOB
    GRAINSWEEP=$grainsweep sbatch --parsable --export=ALL --requeue --no-kill --open-mode=append -o job.out \
        --mem=100 "$@" job.sh
}
in_three_nodes() { submitted --nodes=3 --ntasks-per-node=1 --cpus-per-task=2 --mem=200 "$@"; }
# Processes of this cluster whose environment has a line ENVIRONMENT and whose command line begins with WORDS.
processes_with() { # ENVIRONMENT WORDS
    local process environment
    for process in /proc/[0-9]*; do
        environment=$({ tr '\0' '\n' <"$process/environ"; } 2>/dev/null) || continue
        grep -qx "SLURM_CONF=$SLURM_CONF" <<<"$environment" || continue
        grep -qx -- "$1" <<<"$environment" || continue
        [[ "$({ tr '\0' ' ' <"$process/cmdline"; } 2>/dev/null)" == "$2"* ]] && echo "${process#/proc/}"
    done
    return 0
}
expect_the_rows_of_a_run() {
    campaign c "$1" "$2" '{"workers": 2}' >plain.json
    "$grainsweep" run plain.json --db plain.db --quiet
    "$grainsweep" dump plain.db >plain.txt
    "$grainsweep" dump c.db >c.txt
    cmp plain.txt c.txt
    [ "$(wc -l <c.txt)" -gt "$1" ]
    "$grainsweep" verify c.db >/dev/null
}
expect_no_crash() {
    local crashed
    crashed=$("$grainsweep" query c.db "SELECT count(*) FROM attempt WHERE outcome IN ('crashed', 'timed_out')" --format csv | tail -n 1)
    [ "$crashed" = 0 ] || { echo "$crashed attempts crashed"; return 1; }
}
has_ended() { grep -q "^exit code" job.out 2>/dev/null || is_over "$1"; }
settled_in() { # SECONDS JOB
    until_so "$1" has_ended "$2"
    grep -q "^exit code 0" job.out || { echo "the job did not end with 0"; return 1; }
}

case $scenario in
calm)
    campaign c 64 0.2 "$hosts" >c.json
    job=$(in_three_nodes)
    settled_in 120 "$job"
    expect_the_rows_of_a_run 64 0.2
    expect_no_crash
    [ "$(query "SELECT count(*) FROM attempt")" = 64 ]
    ;;
host_killed)
    campaign c 64 1 "$hosts" >c.json
    job=$(in_three_nodes)
    until_so 60 at_least 12
    until_so 60 three_hosts # two of them may have settled the 12
    kill -KILL "${hosts_there[@]:0:2}"
    settled_in 180 "$job"
    expect_the_rows_of_a_run 64 1
    expect_no_crash
    ;;
node_killed | spreading)
    # Enough cases that the job is not over before the node is dead, also on a loaded machine.
    seconds=0.5 cases=160
    [ $scenario != spreading ] || { seconds=spreading cases=64; }
    campaign c $cases $seconds "$hosts" >c.json
    job=$(in_three_nodes)
    until_so 60 at_least 24
    batch=$(squeue -h -j "$job" -o %B)
    victim=n3
    [ "$batch" != n3 ] || victim=n2
    "$loopback" kill-node "$cluster" $victim
    # What ran there dies with it: its step daemons, and what they started.
    killed=0
    there=($(processes_with "SLURMD_NODENAME=$victim" ""))
    for process in "${there[@]}"; do
        parent=$(sed 's/.*) . //; s/ .*//' "/proc/$process/stat" 2>/dev/null || echo 0)
        if [ "$(cat "/proc/$parent/comm" 2>/dev/null)" = slurmstepd ]; then kill -KILL "$parent"; fi
    done
    for process in "${there[@]}"; do kill -KILL "$process" 2>/dev/null && killed=$((killed + 1)); done
    [ $killed -ge 3 ] || { echo "only $killed processes ran on $victim"; exit 1; }
    settled_in 240 "$job"
    expect_the_rows_of_a_run $cases $seconds
    expect_no_crash
    ;;
cancelled)
    campaign c 64 0.5 "$hosts" >c.json
    job=$(in_three_nodes)
    until_so 60 at_least 24
    scancel "$job"
    until_so 60 is_over "$job"
    rm -f job.out
    [ "$(finished)" -lt 64 ]
    job=$(in_three_nodes)
    settled_in 180 "$job"
    expect_the_rows_of_a_run 64 0.5
    expect_no_crash
    ;;
requeued)
    # As a pre-emption does it.
    campaign c 64 0.5 "$hosts" >c.json
    job=$(in_three_nodes)
    until_so 60 at_least 16
    scontrol requeue "$job"
    until_so 400 grep -qs "^exit code 0" job.out
    expect_the_rows_of_a_run 64 0.5
    ;;
controller)
    campaign c 160 0.5 "$hosts" >c.json
    job=$(in_three_nodes)
    until_so 60 at_least 8
    sleep 6 # it saves its state every few seconds, and without the job's there it would start the job again
    "$loopback" kill-ctld "$cluster"
    until_so 60 at_least 110
    "$loopback" start-ctld "$cluster"
    settled_in 180 "$job"
    expect_the_rows_of_a_run 160 0.5
    expect_no_crash
    ;;
walltime)
    # Slurm counts time limits in minutes and looks seldom; the campaign's own limit is the shorter one.
    campaign c 36 1 "{\"hosts\": 3, \"workers_per_host\": 2, \"walltime\": 9, \"launcher\": $srun_host}" >c.json
    job=$(in_three_nodes --time=5)
    # Slurm lets a requeued job wait for two minutes, and started earlier it may be refused by its nodes.
    until_so 500 grep -qs "^exit code 0" job.out
    [ "$(grep -c "^exit code 75" job.out)" -ge 1 ] || { echo "it was never out of time"; exit 1; }
    expect_the_rows_of_a_run 36 1
    expect_no_crash
    # The end of the job counts where the file gives no limit.
    campaign c 1 100 '{"workers": 1}' >c.json
    mkdir end && cd end && cp ../c.json .
    job=$(submitted --ntasks=1 --time=1)
    until_so 120 grep -qs "^exit code 75" job.out
    scancel "$job"
    [ "$(query "SELECT count(*) FROM attempt WHERE outcome = 'abandoned'")" = 1 ]
    cd ..
    ;;
mpi)
    # Three nodes of two cores: a host on each, which runs one case of two ranks at a time. mpirun inside a step must
    # not look for the allocation: it starts its ranks on its own node.
    { command -v mpicc mpirun >/dev/null && mpicc -E -include mpi.h -x c /dev/null >/dev/null 2>&1; } ||
        skip "there is no MPI (mpicc with its headers, mpirun)"
    mpicc -o ranks "$sources/ranks.c"
    cat >c.json <<JSON
{"campaign": "c", "scene": "program",
 "program": {"command": ["mpirun", "-np", "{processes}", "./ranks", "{x}"], "files": ["ranks"], "processes": 2,
  "environment": {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"},
  "parameters": {"x": {"unit": "1"}},
  "observables": {"sum": {"from": {"output": "sum = (.*)"}}, "ranks": {"from": {"output": "ranks = (.*)"}}}},
 "factors": [{"name": "x", "between": [0, 1]}], "design": {"kind": "halton", "points": 24},
 "execution": {"hosts": 3, "launcher": $srun_host}}
JSON
    job=$(in_three_nodes)
    settled_in 180 "$job"
    [ "$(query "SELECT count(*) FROM c WHERE ranks = 2 AND abs(sum - 2 * x) < 1e-12")" = 24 ]
    [ "$(query "SELECT count(DISTINCT host) FROM attempt JOIN attempt_computer USING (computer_id)")" -ge 1 ]
    expect_no_crash
    ;;
mpi_nodes)
    # A case of six ranks on three nodes of two cores: srun starts them in the allocation, MPICH by PMI-2.
    command -v mpicc.mpich >/dev/null || skip "there is no MPICH (mpicc.mpich)"
    srun --mpi=list 2>&1 | grep -q pmi2 || skip "this Slurm has no PMI-2"
    mpicc.mpich -o ranks "$sources/ranks.c"
    cat >c.json <<JSON
{"campaign": "c", "scene": "program",
 "program": {"command": ["srun", "--mpi=pmi2", "-n", "{processes}", "./ranks", "{x}"], "files": ["ranks"], "processes": 6,
  "parameters": {"x": {"unit": "1"}},
  "observables": {"sum": {"from": {"output": "sum = (.*)"}}, "ranks": {"from": {"output": "ranks = (.*)"}},
                  "nodes": {"from": {"output": "nodes = (.*)"}}}},
 "factors": [{"name": "x", "between": [0, 1]}], "design": {"kind": "halton", "points": 12}, "execution": {"workers": 1}}
JSON
    job=$(in_three_nodes)
    settled_in 180 "$job"
    [ "$(query "SELECT count(*) FROM c WHERE ranks = 6 AND nodes = 3 AND abs(sum - 6 * x) < 1e-12")" = 12 ]
    expect_no_crash
    ;;
array)
    campaign c 96 0.5 '{"workers": 2}' >c.json
    cat >task.sh <<'JOB'
#!/bin/bash
$GRAINSWEEP work c.json --spool spool --lease 5 --quiet
echo "exit code $?"
JOB
    job=$(GRAINSWEEP=$grainsweep sbatch --parsable --export=ALL --requeue --array=1-6 --cpus-per-task=2 --mem=100 \
        -o task.%a.out task.sh)
    RANDOM=7
    for moment in 1 2 3 4; do
        sleep $((1 + RANDOM % 2))
        case $moment in
        1) scancel "${job}_$((1 + RANDOM % 3))" ;;
        2) scontrol requeue "${job}_$((1 + RANDOM % 3))" 2>/dev/null || true ;;
        *)
            victims=($(processes_with ".*" "$grainsweep work"))
            [ ${#victims[@]} -eq 0 ] || kill -KILL "${victims[RANDOM % ${#victims[@]}]}" 2>/dev/null || true
            ;;
        esac
        "$grainsweep" collect c.db spool --quiet || true # at any time
    done
    until_so 240 is_over "$job"
    GRAINSWEEP=$grainsweep sbatch --wait --export=ALL --array=1-2 --cpus-per-task=2 --mem=100 -o last.%a.out task.sh
    "$grainsweep" collect c.db spool
    # Slurm kills what takes longer to end than its KillWait, workers before their task: those attempts have crashed.
    expect_the_rows_of_a_run 96 0.5
    ;;
*)
    echo "no scenario '$scenario'" >&2
    exit 2
    ;;
esac
echo "$scenario: the dump is that of a run without Slurm"
