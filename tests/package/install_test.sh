#!/usr/bin/env bash
# Installs the build into an empty folder and builds a program of ten lines against it, by CMake and by pkg-config; then runs
# what was installed.  install_test.sh BUILD_FOLDER
set -euo pipefail
build=$(realpath "$1")
source=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/installed" >"$work/install.log"
cmake -S "$source/consumer" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$work/installed" >"$work/configure.log"
cmake --build "$work/consumer" >"$work/build.log"
(cd "$work" && consumer/consumer && test "$(head -c 4 ten.glb)" = glTF && rm ten.glb)
echo "find_package(sgm): ten lines wrote a .glb"

export PKG_CONFIG_PATH="$work/installed/lib/pkgconfig:$work/installed/lib/$(gcc -print-multiarch)/pkgconfig"
libraries=$(pkg-config --variable=libdir sgm)
# shellcheck disable=SC2046
g++ -std=c++20 "$source/consumer/main.cpp" -o "$work/by_pkg_config" $(pkg-config --cflags --libs sgm)
(cd "$work" && LD_LIBRARY_PATH="$libraries" ./by_pkg_config && test -s ten.glb)
echo "pkg-config sgm: ten lines wrote a .glb"

# The installed program finds its standard library and its module for volumes, far from the tree it was built in.
printf 'grammar 1\nuse "std/house.sgm"\nstart A -> cube\n' >"$work/own.sgm"
"$work/installed/bin/sgm" check "$work/own.sgm"
"$work/installed/bin/sgm" build "$work/own.sgm" --resolution 16 -q -o "$work/own.vdb"
test -s "$work/own.vdb"
echo "sgm: installed with its standard library and volumes"
