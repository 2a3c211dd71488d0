#!/usr/bin/env bash
# From a fresh Debian machine to a running campaign or a green test run.
#   ./bootstrap.sh run CONFIG [OPTIONS]   install what is missing, build, run the campaign, write its report
#   ./bootstrap.sh test                   ... build program and tests, run the tests
#   ./bootstrap.sh sanitize               ... build with the sanitizers, run what reads bytes, steps particles or has threads
#   ./bootstrap.sh build                  ... build build/grainsweep (Release) and stop
#   ./bootstrap.sh bench [NAME]...        ... run the benchmarks, all or those named (JSON lines)
#   ./bootstrap.sh soak served [MINUTES]  ... attack the live page for ten minutes, or so many, and print what held
#   ./bootstrap.sh package                ... build, then write a Debian package and a relocatable archive to build
#   ./bootstrap.sh docs                   write the documents as a static site to build/site
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
jobs=$(nproc)

usage() {
    sed -n '2,10p' "${BASH_SOURCE[0]}" | sed 's/^# \{0,1\}//' >&2
    exit 2
}

# What the program needs, and what only its tests and benchmarks need: package=file that proves it is there.
program_packages=(
    g++=/usr/bin/g++ cmake=/usr/bin/cmake ninja-build=/usr/bin/ninja git=/usr/bin/git
    libeigen3-dev=/usr/include/eigen3/Eigen/Core libboost-dev=/usr/include/boost/process.hpp
    libboost-filesystem-dev=/usr/include/boost/filesystem.hpp:libboost_filesystem.so libsqlite3-dev=/usr/include/sqlite3.h
    zlib1g-dev=/usr/include/zlib.h nlohmann-json3-dev=/usr/include/nlohmann/json.hpp libfmt-dev=/usr/include/fmt/format.h
    libcli11-dev=/usr/include/CLI/CLI.hpp libxxhash-dev=/usr/include/xxhash.h
    libnlopt-dev=/usr/include/nlopt.h libhwy-dev=/usr/include/hwy/highway.h
    libmuparser-dev=/usr/include/muParser.h libudunits2-dev=/usr/include/udunits2.h:libudunits2.so
    libcairo2-dev=/usr/include/cairo/cairo.h:libcairo.so libxlsxwriter-dev=/usr/include/xlsxwriter.h:libxlsxwriter.so
    fonts-liberation=/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf
    libmicrohttpd-dev=/usr/include/microhttpd.h:libmicrohttpd.so
    libjs-chart.js=/usr/share/javascript/chart.js/chart.min.js
)
test_packages=(
    libgtest-dev=/usr/include/gtest/gtest.h libgmock-dev=/usr/include/gmock/gmock.h
    sqlite3=/usr/bin/sqlite3 python3=/usr/bin/python3 chromium=/usr/bin/chromium
)
docs_packages=(mkdocs=/usr/bin/mkdocs mkdocs-material=/usr/share/mkdocs/themes/material)
sanitize_packages=(g++-aarch64-linux-gnu=/usr/bin/aarch64-linux-gnu-g++)

present() {  # PACKAGE=FILE[:LIBRARY]
    local proof=${1#*=} library=''
    case $proof in *:*) library=${proof#*:} proof=${proof%%:*} ;; esac
    [ -e "$proof" ] || return 1
    [ -z "$library" ] || compgen -G "/usr/lib/*/$library" >/dev/null || [ -e "/usr/lib/$library" ]
}

install_missing() {
    local missing=() entry
    for entry in "$@"; do present "$entry" || missing+=("${entry%%=*}"); done
    [ ${#missing[@]} -eq 0 ] && return
    if [ "$(id -u)" -ne 0 ]; then
        echo "missing packages; as root: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    echo "installing ${missing[*]}" >&2
    export DEBIAN_FRONTEND=noninteractive
    local log
    log=$(mktemp)
    if ! { apt-get update -qq && apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
        tail -n 20 "$log" >&2
        exit 1
    fi
    rm -f "$log"
}

# quiet WHAT COMMAND...: shows the output only when the command fails.
quiet() {
    local what=$1 log
    shift
    log=$(mktemp)
    if ! "$@" >"$log" 2>&1; then
        cat "$log" >&2
        echo "$what failed" >&2
        exit 1
    fi
    rm -f "$log"
}

configure() {  # PRESET OPTIONS...
    local preset=$1
    shift
    quiet "configuring" cmake -S "$here" --preset "$preset" -DCMAKE_UNITY_BUILD=ON "$@"
}

longest_tests() {  # JUNIT_FILE
    echo "the ten longest tests, in seconds:"
    sed -n 's/.*<testcase name="\([^"]*\)".* time="\([0-9.]*\)".*/\2 \1/p' "$1" | sort -rn | sed -n '1,10p'
}

build_program() {
    install_missing "${program_packages[@]}"
    local tests=OFF
    [ -e "$here/build/tests" ] && tests=ON
    (cd "$here" && configure release -DGRAINSWEEP_TESTS=$tests)
    [ -x "$here/build/grainsweep" ] || echo "building (five to eight minutes on two cores)" >&2
    quiet "building" cmake --build "$here/build" -j "$jobs" --target grainsweep command_documents
}

case ${1:-} in
run)
    [ $# -ge 2 ] || usage
    shift
    build_program
    program=$here/build/grainsweep
    [ "$PWD" != "$here" ] || program=build/grainsweep  # as the reader would type it
    said=$(mktemp) code=0
    "$program" run "$@" | tee -i "$said" || code=$?
    database=$(sed -n 's/^database \(.*\) ([^()]*)$/\1/p' "$said")
    rm -f "$said"
    [ -n "$database" ] || exit "$code"
    echo
    "$program" report "$database"
    printf 'then type: %s solve %q --watch case.html\n' "$program" "$1"
    exit "$code"
    ;;
package)
    build_program
    quiet "making the Debian package" cmake -E chdir "$here/build" cpack -G DEB
    (cd "$here/build" && ls -t "$PWD"/grainsweep_*.deb | head -n 1)
    "$here/packaging/archive.sh" "$here/build"
    ;;
build)
    build_program
    ;;
test)
    install_missing "${program_packages[@]}" "${test_packages[@]}"
    (cd "$here" && configure release -DGRAINSWEEP_TESTS=ON)
    cmake --build "$here/build" -j "$jobs"
    # in thirds of a core: tests/CMakeLists.txt
    code=0
    (cd "$here" && ctest --preset release -j "$((3 * jobs))" --output-junit "$here/build/tests.xml") || code=$?
    longest_tests "$here/build/tests.xml"
    exit "$code"
    ;;
sanitize)
    install_missing "${program_packages[@]}" "${test_packages[@]}" "${sanitize_packages[@]}"
    (cd "$here" && configure release -DGRAINSWEEP_TESTS=ON && configure sanitize -DGRAINSWEEP_TESTS=ON &&
        configure thread -DGRAINSWEEP_TESTS=ON)
    # Code that no test runs must at least compile: the benchmarks, and the particle loops for AArch64.
    cmake --build "$here/build" -j "$jobs" --target bench_compiles aarch64_compiles
    cmake --build "$here/build-sanitize" -j "$jobs" --target test_sanitized
    cmake --build "$here/build-thread" -j "$jobs" --target test_sanitized grainsweep
    export GTEST_TOTAL_SHARDS=$((8 * jobs)) TSAN_OPTIONS=halt_on_error=1
    for build in build-sanitize build-thread; do
        seq 0 $((8 * jobs - 1)) | xargs -P "$jobs" -I '{}' \
            env 'GTEST_SHARD_INDEX={}' "$here/$build/tests/test_sanitized" --gtest_brief=1
    done
    # Whole campaigns under the thread sanitizer: new and resumed, on emulated hosts, of a program.
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    sed 's/"points": 256/"points": 20000/' "$here/configs/rehearsal_small.json" >"$folder/many.json"
    for try in first second; do
        "$here/build-thread/grainsweep" run "$folder/many.json" --db "$folder/many.db" -j "$jobs" --quiet
    done
    sed 's/"campaign"/"execution": {"hosts": 2, "workers_per_host": 2}, "campaign"/; s/"points": 256/"points": 5000/' \
        "$here/configs/rehearsal_small.json" >"$folder/hosts.json"
    "$here/build-thread/grainsweep" run "$folder/hosts.json" --db "$folder/hosts.db" --quiet
    "$here/build-thread/grainsweep" run "$here/configs/program_python/heap.json" --db "$folder/heap.db" -j "$jobs" --quiet
    echo "the sanitizers found nothing"
    ;;
bench)
    install_missing "${program_packages[@]}" "${test_packages[@]}"
    (cd "$here" && configure release -DGRAINSWEEP_TESTS=ON)
    quiet "building" cmake --build "$here/build" -j "$jobs" --target grainsweep benchmarks
    shift
    if [ $# -eq 0 ]; then
        for program in "$here"/build/tests/bench_*; do set -- "$@" "${program##*/bench_}"; done
        set -- "$@" overhead scene_cost
    fi
    for name in "$@"; do
        if [ -x "$here/tests/bench/$name.sh" ]; then
            "$here/tests/bench/$name.sh"
        elif [ -x "$here/build/tests/bench_$name" ]; then
            "$here/build/tests/bench_$name"
        else
            echo "no benchmark '$name': there are $(cd "$here/build/tests" && echo bench_* | sed 's/bench_//g') overhead scene_cost" >&2
            exit 2
        fi
    done
    ;;
soak)
    [ "${2:-}" = served ] || usage
    install_missing "${program_packages[@]}" "${test_packages[@]}"
    (cd "$here" && configure release -DGRAINSWEEP_TESTS=ON)
    quiet "building" cmake --build "$here/build" -j "$jobs" --target grainsweep slow_served
    GRAINSWEEP_SOAK_MINUTES=${3:-10} "$here/build/tests/slow_served"
    ;;
docs)
    install_missing "${docs_packages[@]}"
    pages=$here/build/site_source
    rm -rf "$pages"
    mkdir -p "$pages"
    # What pages link to, in the folders of the repository, so that their links hold.
    (cd "$here" && cp --parents -r ./*.md docs stats/*.hpp results_schema/*.sql solver/*/{README.md,*.svg} "$pages")
    # Behind the language of a block stand words for tests/documents: a file's name becomes the block's title.
    find "$pages" -name '*.md' -exec sed -E -i \
        -e 's/^```(json) ([^ ]+\.json)\+?$/```\1 title="\2"/' -e 's/^```([a-z]+) [^"]*$/```\1/' {} +
    quiet "building the site" mkdocs build --strict --clean --config-file "$here/docs/mkdocs.yml"
    echo "the site is in build/site; to read and search it: python3 -m http.server --directory build/site"
    ;;
*)
    usage
    ;;
esac
