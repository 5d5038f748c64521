#!/usr/bin/env bash
# Runs the fuzz targets over their corpora.  tests/fuzz/run.sh [SECONDS] [TARGET…]   (600 seconds each, all targets)
# What is found on the way stays in build/fuzz/corpus, so that a later run goes on from there; an input that crashes, hangs
# or takes more than 2 GB is written to build/fuzz and ends the run with an error.
cd "$(dirname "$0")/../.."
set -eu
command -v clang++ >/dev/null || { echo "fuzzing needs clang++ with libFuzzer (apt-get install clang)" >&2; exit 1; }
seconds="${1:-600}"
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- mesh syntax
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz >build/fuzz.log 2>&1
for target in "$@"; do
  case "$target" in
    mesh) seeds="tests/fuzz/mesh" longest=4000 ;;
    syntax) seeds="tests/bad tests/syntax grammar/std examples" longest=1500 ;;
    *) echo "no fuzz target is called '$target'; there are mesh and syntax" >&2; exit 2 ;;
  esac
  ninja -C build/fuzz "fuzz_$target" >>build/fuzz.log
  mkdir -p "build/fuzz/corpus/$target"
  # shellcheck disable=SC2086
  "build/fuzz/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=5 -max_len="$longest" -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix=build/fuzz/ "build/fuzz/corpus/$target" $seeds 2>"build/fuzz/$target.log" ||
    { tail -n 40 "build/fuzz/$target.log"; exit 1; }
  echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "build/fuzz/$target.log") inputs in $seconds s, nothing found"
done
