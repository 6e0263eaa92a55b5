#!/usr/bin/env bash
# What clang-format 14 would change in the tree's code, and what clang-tidy 14 finds in some of it. Other releases format
# otherwise.
#
#   format_test.sh format ROOT                 all code
#   format_test.sh tidy ROOT OPTION...         core/law/ and elements/; options: include folders, -D
#
# Skipped (status 77) where the tool is not installed.
set -euo pipefail
what=$1 root=$2
shift 2
cd "$root"
jobs=$(env -u OMP_NUM_THREADS nproc 2>/dev/null || echo 2)
need() {
  command -v "$1" >/dev/null || { echo "SKIPPED: no $1 here (Debian's package $1)"; exit 77; }
}
# Prints the files, and fails where there is none.
code() {
  local files
  files=$(find "$@" \( -name '*.cpp' -o -name '*.hpp' \) | sort)
  [ -n "$files" ] || { echo "No code found below $root: nothing was checked." >&2; exit 1; }
  echo "$files"
}
case $what in
  format)
    need clang-format-14
    files=$(code core elements solvers models advice app python tests)
    xargs -P "$jobs" -n 20 clang-format-14 --dry-run --Werror <<<"$files" ||
      { echo "Run clang-format-14 -i on these files."; exit 1; }
    ;;
  tidy)
    need clang-tidy-14
    files=$(code core/law elements | grep '\.cpp$')
    # Twelve at a time are one file, so that what all of them include is read once.
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    cp .clang-tidy "$work"
    sed "s|.*|#include \"$PWD/&\"|" <<<"$files" | split -l 12 --additional-suffix=.cpp - "$work/part_"
    log=$(find "$work" -name '*.cpp' -print0 |
      xargs -0 -P "$jobs" -I{} clang-tidy-14 --quiet {} -- -std=c++20 -I. "$@" 2>/dev/null) || failed=1
    if [ -n "${failed:-}" ]; then echo "$log"; exit 1; fi
    ;;
  *) sed -n '2,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac
echo "$(wc -l <<<"$files") files: nothing found."
