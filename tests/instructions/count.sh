#!/usr/bin/env bash
# Counts the instructions of runs (runs.cpp) under valgrind and compares them with recorded ones, and with limits.
#
#   count.sh [--record] PROGRAM COMPILER FILE LIMITS RUN...
#
# FILE has lines "COMPILER RUN COUNT". More than 10 % above fails; more than 10 % below asks to record again,
# which --record does for this compiler. Counted are drev's own code and what is compiled into it: libraries
# choose theirs by the machine, and valgrind shows every machine with AVX2 as the same one. LIMITS has lines "RUN MOST": a count,
# libraries included, above it fails with any compiler. Without valgrind or AVX2 it is skipped (status 77), and where there is
# neither a record for the compiler nor a limit.
set -euo pipefail
record=0
if [ "${1:-}" = --record ]; then record=1; shift; fi
program=$1 compiler=$2 file=$3 limits=$4
shift 4
skip() {
  echo "SKIPPED: $*"
  exit 77
}
command -v valgrind >/dev/null || skip "no valgrind here (package valgrind)"
grep -qw avx2 /proc/cpuinfo 2>/dev/null || skip "this processor has no AVX2: other code would run"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export OPENBLAS_NUM_THREADS=1 OPENBLAS_CORETYPE=Haswell

# count <run>: instructions inside measured() that lie in the program itself, and all of them.
count() {
  valgrind --tool=callgrind --callgrind-out-file="$folder/out" --toggle-collect=measured \
    --compress-strings=no --compress-pos=no "$program" "$1" >"$folder/log" 2>&1 ||
    { cat "$folder/log" >&2; return 1; }
  awk -v own="ob=$(readlink -f "$program")" '
    /^ob=/ { mine = $0 == own }
    /^calls=/ { getline; next }
    /^[0-9]/ { all += $2; if (mine) sum += $2 }
    END { printf "%.0f %.0f\n", sum, all }' "$folder/out"
}

status=0 known=0
for run; do
  count "$run" >"$folder/count"
  read -r now all <"$folder/count"
  echo "$compiler $run $now" >>"$folder/counts"
  most=$(awk -v run="$run" '$1 == run { print $2 }' "$limits")
  if [ -n "$most" ]; then
    known=1
    echo "$run: $all instructions, libraries included, of at most $most"
    if [ "$all" -gt "$most" ]; then
      echo "FAILED: $run takes $all instructions, more than its limit of $most"
      status=1
    fi
  fi
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
