#!/usr/bin/env bash
# Compiles every header of the rooms by itself, as the only include of a file and without precompiled
# headers: each must include what it needs.
#
#   headers_test.sh ROOT COMPILER OPTION...     options: include folders of the dependencies, and -D
#
# DREV_HEADERS="a.hpp b.hpp" in the environment: only these, below ROOT.
set -euo pipefail
root=$1 compiler=$2
shift 2
cd "$root"
if [ -n "${DREV_HEADERS:-}" ]; then
  headers=$DREV_HEADERS
else
  headers=$(find . -regex "./\\(core\\|elements\\|solvers\\|models\\|advice\\|app\\)/.*\\.hpp" | sed 's|^\./||' | sort)
fi
[ -n "$headers" ] || { echo "No header found below $root: nothing was checked."; exit 1; }

# Those that come to core/system.hpp, which includes Eigen, start from Eigen's precompiled sparse matrices: that is a
# matter of time alone, since they include it in any case.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "#include <Eigen/SparseCore>" >"$work/eigen.hpp"
: >"$work/with_eigen"
if [ -f core/system.hpp ]; then
  "$compiler" "$@" -std=c++20 -Wall -Wextra -Wno-unused-function -Werror -x c++-header "$work/eigen.hpp" -o "$work/eigen.hpp.gch"
  echo core/system.hpp >"$work/with_eigen"
  known=0
  while [ "$known" != "$(wc -l <"$work/with_eigen")" ]; do
    known=$(wc -l <"$work/with_eigen")
    sed 's|.*|include [<"](drev/)?&[>"]|' "$work/with_eigen" >"$work/patterns"
    { cat "$work/with_eigen"; xargs grep -lE -f "$work/patterns" <<<"$headers" || true; } | sort -u >"$work/more"
    mv "$work/more" "$work/with_eigen"
  done
fi

failed=0
tr -s ' \n' '\n\n' <<<"$headers" | sed '/^$/d' |
  xargs -P "$(env -u OMP_NUM_THREADS nproc 2>/dev/null || echo 2)" -I{} sh -c '
    header=$1 work=$2; shift 2
    if grep -qxF "$header" "$work/with_eigen"; then set -- "$@" -include "$work/eigen.hpp"; fi
    echo "#include \"$header\"" | "$@" -std=c++20 -fsyntax-only -Wall -Wextra -Wno-unused-function -Werror -I. -x c++ - \
      || { echo "FAILED: $header does not compile by itself" >&2; exit 1; }' sh {} "$work" "$compiler" "$@" || failed=1
[ $failed = 0 ] || exit 1
echo "$(wc -w <<<"$headers") headers compile by themselves."
