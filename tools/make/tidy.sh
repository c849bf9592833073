#!/bin/sh
# clang-tidy, two files at a time: tidy.sh BUILD FILE...   Generated LCM types are taken as system headers.
build=$1
shift
flags="-Ilib -Idrivers -Ifirmware -Itools -isystem $build/lcmtypes -isystem /usr/include/eigen3 -D_GNU_SOURCE"
tidy() {
    extension=$1
    standard=$2
    shift 2
    for file in "$@"; do
        case $file in *."$extension") echo "$file" ;; esac
    done | xargs -r -P 2 -n 4 sh -c 'clang-tidy --quiet "$@" -- '"-std=$standard $flags"' 2>/dev/null' tidy
}
status=0
tidy c c11 "$@" || status=1
tidy cpp c++17 "$@" || status=1
exit $status
