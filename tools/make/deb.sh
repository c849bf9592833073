#!/bin/sh
# Packs what lies in FOLDER/laid-out: deb.sh FOLDER. The packages lie in FOLDER then.
set -eu
folder=$(realpath "$1")
export LAID_OUT="$folder/laid-out" DEB_BUILD_OPTIONS=noautodbgsym
source=$folder/source/ale-slam
mkdir -p "$source"
cp -R firmware/deploy/debian "$source/debian"
unset MAKEFLAGS MFLAGS MAKELEVEL
umask 022
if ! (cd "$source" && dpkg-buildpackage --build=binary --no-check-builddeps --unsigned-changes --unsigned-buildinfo) \
    > "$folder/packing.log" 2>&1; then
    tail -n 30 "$folder/packing.log" >&2
    exit 1
fi
mv "$folder"/source/*.deb "$folder"/source/*.changes "$folder"/source/*.buildinfo "$folder"
rm -rf "$folder/source" "$LAID_OUT"
ls "$folder"/*.deb
