#!/bin/sh
# Builds the packages again from a copy of the tree in another folder, with other clock, language and rights of new files, and
# compares them with those of PACKAGES, byte for byte: same_packages.sh PACKAGES [VARIABLE=VALUE]...
set -eu
packages=$(realpath "$1")
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
copy=$folder/another/place
mkdir -p "$copy"
git ls-files --cached --others --exclude-standard -z | tar --create --null --files-from=- | tar --extract --directory "$copy"
git -C "$copy" init --quiet && git -C "$copy" add --all
unset MAKEFLAGS MFLAGS MAKELEVEL MAKEOVERRIDES ALE_BUILD ALE_RESULTS
umask 027
export TZ=Pacific/Kiritimati LC_ALL=C.UTF-8 CCACHE_DISABLE=1
make --directory "$copy" --no-print-directory -s -j2 "$@" deb > "$folder/log" 2>&1 || { tail -n 30 "$folder/log" >&2; exit 1; }
different=0
for package in "$packages"/*.deb; do
    if cmp "$package" "$copy/build/packages/$(basename "$package")"; then
        echo "$(basename "$package"): the same bytes"
    else
        different=1
    fi
done
exit $different
