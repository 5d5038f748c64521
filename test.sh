#!/usr/bin/env bash
# Installs what is missing, builds everything and passes the tests.  ./test.sh [ctest arguments]
cd "$(dirname "$0")"
. cmake/setup.sh
build all
exec ctest --test-dir build/release --output-on-failure -j 2 "$@"
