#!/usr/bin/env bash
# Counts the instructions of three small runs (runs.cpp) under valgrind and compares them with recorded ones.
#
#   count.sh [--record] PROGRAM COMPILER FILE
#
# FILE has lines "COMPILER RUN COUNT". More than 10 % above fails; more than 10 % below asks to record again,
# which --record does for this compiler. Counted are drev's own code and what is compiled into it: libraries
# choose theirs by the machine, and valgrind shows every machine with AVX2 as the same one. Without valgrind,
# AVX2 or a record for the compiler it is skipped (status 77).
set -euo pipefail
record=0
if [ "${1:-}" = --record ]; then record=1; shift; fi
program=$1 compiler=$2 file=$3
skip() {
  echo "SKIPPED: $*"
  exit 77
}
command -v valgrind >/dev/null || skip "no valgrind here (package valgrind)"
grep -qw avx2 /proc/cpuinfo 2>/dev/null || skip "this processor has no AVX2: other code would run"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export OPENBLAS_NUM_THREADS=1 OPENBLAS_CORETYPE=Haswell

# count <run>: instructions inside measured() that lie in the program itself.
count() {
  valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect=measured \
    --compress-strings=no --compress-pos=no "$program" "$1" >"$folder/log" 2>&1 ||
    { cat "$folder/log" >&2; return 1; }
  awk -v own="ob=$(readlink -f "$program")" '
    /^ob=/ { mine = $0 == own }
    /^calls=/ { getline; next }
    /^[0-9]/ && mine { sum += $2 }
    END { printf "%.0f\n", sum }' "$folder/out"
}

status=0 known=0
for run in held gears modes; do
  now=$(count "$run")
  echo "$compiler $run $now" >>"$folder/counts"
  before=$(awk -v key="$compiler $run" '$1 " " $2 == key { print $3 }' "$file")
  if [ -z "$before" ]; then
    echo "$run: $now instructions; none recorded for $compiler"
    continue
  fi
  known=1
  change=$(awk -v now="$now" -v before="$before" 'BEGIN { printf "%+.1f", 100 * (now / before - 1) }')
  echo "$run: $now instructions, recorded $before: $change %"
  if awk -v x="$change" 'BEGIN { exit !(x > 10) }'; then
    echo "FAILED: $run takes $change % more instructions than recorded"
    status=1
  elif awk -v x="$change" 'BEGIN { exit !(x < -10) }'; then
    echo "Record this gain, so that it stays: cmake --build --preset release --target record_instructions"
  fi
done
if [ $record = 1 ]; then
  { awk -v key="$compiler" '$1 != key' "$file"; cat "$folder/counts"; } >"$folder/file"
  cp "$folder/file" "$file"
  exit 0
fi
[ $known = 1 ] || skip "no counts recorded for $compiler"
exit $status
