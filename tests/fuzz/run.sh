#!/usr/bin/env bash
# Fuzzes.  tests/fuzz/run.sh [TIME] [TARGET…]   (10m each, all targets; TIME in seconds, or as 90s, 10m, 2h)
#   mesh maps syntax grammar          libFuzzer under AddressSanitizer and UndefinedBehaviorSanitizer, by clang++
#   mesh_by_number maps_by_number syntax_by_number    the same targets in the Release build, inputs by number: many times as fast
#   format check lower models edits incremental    inputs by number, through the tests of the Release build
# All go on where the last run ended: corpora stay in build/fuzz/corpus, and tests/fuzz/tally.txt holds how many inputs each
# target has had. An input that crashes, hangs or takes more than 2 GB ends the run with an error.
cd "$(dirname "$0")/../.."
set -eu
time="${1:-10m}"
[ $# -eq 0 ] || shift
case "$time" in
  *h) seconds=$((${time%h} * 3600)) ;;
  *m) seconds=$((${time%m} * 60)) ;;
  *) seconds="${time%s}" ;;
esac
[ $# -gt 0 ] || set -- mesh maps syntax grammar mesh_by_number maps_by_number syntax_by_number format check lower models edits incremental
tally=tests/fuzz/tally.txt

had() { sed -n "s/^$1 //p" "$tally"; }
count() {  # TARGET INPUTS
  sed -i "s/^$1 .*/$1 $(($(had "$1") + $2))/" "$tally"
  echo "$1: $2 inputs, nothing found; $(had "$1") in all"
}

coverage_guided() {  # TARGET LONGEST SEEDS…
  command -v clang++ >/dev/null || { echo "fuzzing $1 needs clang++ with libFuzzer (apt-get install clang)" >&2; exit 1; }
  target="$1" longest="$2"
  shift 2
  [ -f build/fuzz/build.ninja ] || cmake --preset fuzz -DSGM_UNITY=ON >build/fuzz.log 2>&1
  ninja -C build/fuzz "fuzz_$target" >>build/fuzz.log
  mkdir -p "build/fuzz/corpus/$target"
  # Weighing inputs by rare features (entropic) takes half of the time of targets with 20,000 features and more.
  ASAN_OPTIONS=malloc_context_size=3:quarantine_size_mb=32 "build/fuzz/tests/fuzz/fuzz_$target" -max_total_time="$seconds" \
    -entropic=0 -reduce_inputs=0 -timeout=20 -max_len="$longest" -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix=build/fuzz/ "build/fuzz/corpus/$target" "$@" 2>"build/fuzz/$target.log" ||
    { tail -n 40 "build/fuzz/$target.log"; exit 1; }
  count "$target" "$(sed -n 's/^stat::number_of_executed_units: *//p' "build/fuzz/$target.log")"
}

uninstrumented() {  # TARGET INPUTS-A-ROUND SEEDS…
  target="$1" inputs="$2"
  shift 2
  ninja -C build/release "fuzz_$target" >build/fuzz.log
  end=$(($(date +%s) + seconds)) done=0
  while [ "$(date +%s)" -lt "$end" ]; do
    "build/release/tests/fuzz/fuzz_$target" $(($(had "$target") + done)) "$inputs" "$@"
    done=$((done + inputs))
  done
  count "$target" "$done"
}

by_number() {  # TARGET MODULE TEST INPUTS-A-ROUND
  ninja -C build/release "test_$2" >build/fuzz.log
  end=$(($(date +%s) + seconds)) done=0
  while [ "$(date +%s)" -lt "$end" ]; do
    SGM_FUZZ_FIRST=$(($(had "$1") + done)) SGM_FUZZ_MUTANTS="$4" "build/release/tests/$2/test_$2" --gtest_filter="$3" >build/fuzz.log 2>&1 ||
      { grep -v '^\[' build/fuzz.log | head -n 60; exit 1; }
    done=$((done + $4))
  done
  count "$1" "$done"
}

for target in "$@"; do
  case "$target" in
    mesh) coverage_guided mesh 4000 tests/fuzz/mesh ;;
    maps) coverage_guided maps 2000 tests/fuzz/maps ;;
    syntax) coverage_guided syntax 1500 tests/bad tests/syntax grammar/std examples ;;
    grammar) coverage_guided grammar 3000 tests/bad tests/syntax grammar/std examples ;;
    mesh_by_number) uninstrumented mesh_by_number 100000 tests/fuzz/mesh ;;
    maps_by_number) uninstrumented maps_by_number 400000 tests/fuzz/maps ;;
    syntax_by_number) uninstrumented syntax_by_number 100000 tests/bad tests/syntax examples ;;
    format) by_number format syntax 'Fuzz.Mutants*' 20000 ;;
    check) by_number check rules 'Fuzz.Mutants*' 6000 ;;
    lower) by_number lower lower 'Fuzz.Mutants*' 4000 ;;
    models) by_number models pipeline 'RandomModels.*' 200 ;;
    edits) by_number edits document 'RandomEdits.KeepText*' 1000 ;;
    incremental) by_number incremental pipeline 'RandomDrags.*' 300 ;;
    *) echo "no fuzz target is called '$target'" >&2; exit 2 ;;
  esac
done
