#!/bin/sh
# clang-tidy, two at a time ($JOBS), one file each (of a second one it says that a va_list is uninitialised): tidy.sh BUILD FILE...
# Generated types of LCM and DDS are taken as system headers.
build=$1
shift
flags="-Ilib -Idrivers -Ifirmware -Itools -Itests -isystem $build/lcmtypes -isystem $build/dds -isystem /usr/include/eigen3 -D_GNU_SOURCE"
tidy() {
    extension=$1
    standard=$2
    shift 2
    for file in "$@"; do
        case $file in *."$extension") echo "$file" ;; esac
    done | xargs -r -P "${JOBS:-2}" -n 1 sh -c 'clang-tidy --quiet "$@" -- '"-std=$standard $flags"' 2>/dev/null' tidy
}
status=0
tidy c c11 "$@" || status=1
tidy cpp c++17 "$@" || status=1
exit $status
