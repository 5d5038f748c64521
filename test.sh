#!/usr/bin/env bash
# Installs what is missing, builds everything and passes the tests.  ./test.sh [ctest arguments]
#   PRESET=sanitize ./test.sh   the same under another preset of CMakePresets.json: debug, clang, sanitize or tsan
cd "$(dirname "$0")"
. cmake/setup.sh
build all
[ "$PRESET" != tsan ] || export TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp die_after_fork=0"
exec ctest --test-dir "build/$PRESET" --output-on-failure -j 2 "$@"
