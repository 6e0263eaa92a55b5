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

failed=0
tr -s ' \n' '\n\n' <<<"$headers" | sed '/^$/d' |
  xargs -P "$(env -u OMP_NUM_THREADS nproc 2>/dev/null || echo 2)" -I{} sh -c '
    header=$1; shift
    echo "#include \"$header\"" | "$@" -std=c++20 -fsyntax-only -Wall -Wextra -Wno-unused-function -Werror -I. -x c++ - \
      || { echo "FAILED: $header does not compile by itself" >&2; exit 1; }' sh {} "$compiler" "$@" || failed=1
[ $failed = 0 ] || exit 1
echo "$(wc -w <<<"$headers") headers compile by themselves."
