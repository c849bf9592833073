#!/bin/sh
# Lays out another architecture's libraries for linking: cross.sh DEBIAN-ARCHITECTURE FOLDER PACKAGE...
# Debian's own packages, unpacked into FOLDER; the machine itself is left as it is, and nobody needs to be root.
set -eu
architecture=$1
folder=$(realpath -m "$2")
shift 2
rm -rf "$folder"
mkdir -p "$folder/apt/lists/partial" "$folder/apt/archives/partial" "$folder/debs"
: > "$folder/apt/status"
apt() {
    apt-get -qq -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" \
        -o Dir::State::Lists="$folder/apt/lists" -o Dir::State::status="$folder/apt/status" \
        -o Dir::Cache="$folder/apt" -o Acquire::Languages=none -o Acquire::Retries=3 -o APT::Sandbox::User= "$@"
}
# One archive of several may be in the middle of an update: the download tells whether what is there is enough.
apt update || true
(cd "$folder/debs" && apt download "$@")
for package in "$folder"/debs/*.deb; do
    dpkg-deb -x "$package" "$folder"
done
rm -rf "$folder/apt" "$folder/debs"
