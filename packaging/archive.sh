#!/usr/bin/env bash
# Writes the relocatable archive: packaging/archive.sh BUILD_FOLDER. Prints its name.
# It holds the installed files and all libraries but those of the C library, with the data that they read.
set -euo pipefail
build=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
oldest_glibc=2.36  # as docs/install.md states

version=$("$build/grainsweep" --version | sed -n '1s/^grainsweep //p')
name=grainsweep-$version-linux-$(uname -m)
stage=$build/archive/$name
rm -rf "$build/archive"
cmake --install "$build" --prefix "$stage" --strip >"$build/archive.log"
cmake -D "STAGE=$stage" -P "$here/libraries.cmake"

# Data of libraries: units, and the font of figures.
share=$stage/share/grainsweep
mkdir -p "$share/udunits" "$share/fonts"
cp /usr/share/xml/udunits/*.xml "$share/udunits"
cp /usr/share/fonts/truetype/liberation/LiberationSans-*.ttf "$here/fonts/fonts.conf" "$share/fonts"

# Licences of everything that is not ours.
licences=$stage/share/doc/grainsweep/licences
mkdir -p "$licences"
for file in "$stage"/lib/grainsweep/*.so.* udunits2.xml LiberationSans-Regular.ttf chart.min.js; do
    owner=$(dpkg-query -S "*/${file##*/}" 2>/dev/null | sed -n '1s/:.*//p' || true)
    [ -n "$owner" ] || { echo "archive: ${file##*/} belongs to no package, so its licence is unknown" >&2; exit 1; }
    cp "/usr/share/doc/$owner/copyright" "$licences/$owner"
done
for headers in libeigen3-dev libboost-dev nlohmann-json3-dev libcli11-dev libhwy-dev; do
    cp "/usr/share/doc/$headers/copyright" "$licences/$headers"
done

# The newest symbol version of the C library that a file needs decides where the archive runs.
needed=$(find "$stage" -type f \( -name grainsweep -o -name '*.so*' \) -exec objdump -T {} + |
    grep -oE 'GLIBC_[0-9]+\.[0-9]+' | sed 's/GLIBC_//' | sort -uV | tail -n 1)
if [ "$(printf '%s\n' "$needed" "$oldest_glibc" | sort -V | tail -n 1)" != "$oldest_glibc" ]; then
    echo "archive: it needs glibc $needed, and docs/install.md promises $oldest_glibc" >&2
    exit 1
fi

tar -C "$build/archive" --sort=name --owner=0 --group=0 --numeric-owner -czf "$build/$name.tar.gz" "$name"
echo "$build/$name.tar.gz"
