#!/usr/bin/env bash
# Runs drev and its peers side by side on this machine, on one core, and prints one table of ratios: a
# hand-written loop, the source's program style in Octave, SciPy, SUNDIALS, LAPACK. What is not installed is
# left out and named. Takes some minutes; timings want a machine that does nothing else.
#
#   scripts/peers.sh            prints the table
#   scripts/peers.sh --write    puts it into docs/performance.md too
#
# The peers are Debian's octave, python3-scipy, libsundials-dev, and openTorsion (pip install opentorsion). Other
# interpreters: DREV_OCTAVE, DREV_PYTHON, DREV_OPENTORSION.
set -euo pipefail
case ${1:-} in
  "" | --write) ;;
  *) sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$root"
install_packages
build release --target drev bench_step
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

one_core=()
if taskset -c 0 true 2>/dev/null; then one_core=(taskset -c 0); fi
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

targets=$(cmake --build --preset release --target help)
# run <bench> <package> [test cases]: the program's lines go to the folder; "failed" where a check in it did.
run() {
  local bench=$1 package=$2
  shift 2
  if ! grep -q "^bench_$bench:" <<<"$targets"; then
    echo "left out: bench_$bench ($package)" >>"$folder/lines"
    return
  fi
  build release --target "bench_$bench"
  "${one_core[@]}" "build/release/bin/bench_$bench" "$@" 2>&1 | tee "$folder/last" ||
    echo "failed: bench_$bench $*" >>"$folder/lines"
  grep -E '^(ratio\||left out:)' "$folder/last" >>"$folder/lines" || true
}

run step ""
run octave ""
run scipy ""
run modes liblapack-dev
run sundials libsundials-dev "SUNDIALS held"
run opentorsion ""

{
  processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)
  version=$(git describe --always 2>/dev/null || echo unknown)
  echo "${processor:-unknown processor}, $(date +%F), drev $version."
  echo
  echo "| problem | peer | drev [s] | peer [s] | peer : drev | |"
  echo "|---|---|---|---|---|---|"
  sed -n 's/^ratio//p' "$folder/lines"
  if grep -qv '^ratio' "$folder/lines"; then
    echo
    grep -v '^ratio' "$folder/lines" | sort -u
  fi
} >"$folder/table"
echo
cat "$folder/table"
[ "${1:-}" = --write ] || exit 0
page=docs/performance.md
awk -v table="$folder/table" '
  /^<!-- end of peers.sh -->$/ { inside = 0 }
  !inside { print }
  /^<!-- peers.sh -->$/ { inside = 1; while ((getline line <table) > 0) print line }
' "$page" >"$folder/page"
cp "$folder/page" "$page"
