#!/bin/sh
# cppcheck over everything that is deployed: cppcheck.sh JOBS
exec cppcheck --quiet --error-exitcode=1 --inline-suppr -j "$1" --enable=warning,performance,portability \
    --suppress=missingIncludeSystem --suppress=normalCheckLevelMaxBranches --std=c11 --std=c++17 \
    -I lib -I drivers -I firmware -I tools lib drivers firmware tools
