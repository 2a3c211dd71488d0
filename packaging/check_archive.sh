#!/usr/bin/env bash
# Tests the relocatable archive on a bare Debian 12, as an ordinary user: packaging/check_archive.sh ARCHIVE ROOT
# ROOT: folder with the files of a bare system. If it does not exist, mmdebstrap fills it; MIRROR names another mirror.
# Needs root, for chroot. Prints what it runs.
set -euo pipefail
[ $# -eq 2 ] || { sed -n '2,4p' "$0" >&2; exit 2; }
archive=$1 root=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
user=1000

if [ ! -e "$root" ]; then
    mmdebstrap --mode=root --variant=essential --format=directory bookworm "$root" ${MIRROR:+"$MIRROR"}
fi
home=$root/home/reader
rm -rf "$home"
mkdir -p "$home" "$root/tmp"
chmod 1777 "$root/tmp"
cp "$archive" "$home/"
sed -n '/^```json powder.json$/,/^```$/p' "$here/../README.md" | sed '1d;$d' >"$home/powder.json"
chown -R "$user:$user" "$home"

# inside < SCRIPT: runs it in the bare system as the user, with /proc and a few devices, in processes that end with it.
inside() {
    # shellcheck disable=SC2016
    unshare --mount --pid --fork --kill-child bash -c '
        mount -t proc proc "$1/proc"
        mount -t tmpfs tmpfs "$1/dev"
        mknod -m 666 "$1/dev/null" c 1 3
        mknod -m 666 "$1/dev/urandom" c 1 9
        ln -s /proc/self/fd "$1/dev/fd"
        mkdir -m 1777 "$1/dev/shm"
        exec chroot --userspec="$2:$2" "$1" env -i HOME=/home/reader PATH=/usr/bin:/bin TERM=dumb /bin/bash -s
    ' bash "$root" "$user"
}

inside <<'INSIDE'
set -euo pipefail
cd
echo "user $(id -u), $(ldd --version | head -n 1), $(find / -xdev -name 'libcairo*' -o -xdev -name '*.ttf' -o -xdev -name 'udunits2.xml' 2>/dev/null | wc -l) files of cairo, fonts and units"
mkdir 'a folder'
tar -C 'a folder' -xzf grainsweep-*.tar.gz
folder=$(echo "$HOME/a folder"/grainsweep-*)
export PATH="$folder/bin:$PATH"
configs=$folder/share/grainsweep/configs

run() {
    echo "\$ $*"
    "$@" 2>&1 | tail -n 6
}

run grainsweep --version
run grainsweep run "$configs/quickstart.json" -j 2
run grainsweep report quickstart.db
grep -q 'Chart.js' quickstart.html
run grainsweep figure quickstart.db effects -o effects.pdf
run grainsweep figure quickstart.db effects -o effects.png
grep -aq LiberationSans effects.pdf
run grainsweep query quickstart.db 'SELECT * FROM quickstart LIMIT 3' --format xlsx -o rows.xlsx
run grainsweep plan powder.json
run grainsweep solve powder.json --watch case.html
run grainsweep draw v_blender -o blender.html
run grainsweep verify quickstart.db

echo '$ workers on two emulated hosts, killed and resumed'
sed 's/"campaign"/"execution": {"hosts": 2, "workers_per_host": 2}, "campaign"/' "$configs/rehearsal_small.json" >hosts.json
run grainsweep run hosts.json --db hosts.db --max-cases 50 || true
run grainsweep run hosts.json --db hosts.db

for share in 1/2 2/2; do run grainsweep work "$configs/rehearsal_small.json" --spool spool --share $share -j 1; done
run grainsweep collect tasks.db spool
[ "$(grainsweep dump tasks.db | md5sum)" = "$(grainsweep dump hosts.db | md5sum)" ] && echo 'the same results on both ways'

echo '$ grainsweep serve quickstart.db'
grainsweep serve quickstart.db --port 0 >address &
for _ in $(seq 100); do [ -s address ] && break; sleep 0.1; done
address=$(cat address)
port=${address#http://127.0.0.1:} port=${port%%/*}
exec 3<>"/dev/tcp/127.0.0.1/$port"
printf 'GET /%s HTTP/1.0\r\nHost: 127.0.0.1:%s\r\n\r\n' "${address#*/*/*/}" "$port" >&3
head -n 1 <&3
kill %1

echo '$ the folder moves'
mv "$folder" "$HOME/moved"
run "$HOME/moved/bin/grainsweep" figure quickstart.db moments -o moments.svg || run "$HOME/moved/bin/grainsweep" figure quickstart.db effects -o moments.svg
[ -s moments.svg ]
test -s "$HOME/moved/share/man/man1/grainsweep.1"
test -s "$HOME/moved/share/bash-completion/completions/grainsweep"
test -s "$HOME/moved/share/doc/grainsweep/docs/install.md"
echo 'the archive works'
INSIDE
