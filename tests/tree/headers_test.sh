#!/usr/bin/env bash
# Compiles every header of the rooms by itself, as the only include of a file and without precompiled
# headers of drev: each must include what it needs.
#
#   headers_test.sh ROOT COMPILER OPTION...     options: include folders of the dependencies, and -D
#
# DREV_HEADERS="a.hpp b.hpp" in the environment: only these, below ROOT.
#
# Two things save time, and leave nothing out:
#   - a header follows those that it includes anyway, directly or through others, in the same file
#   - headers that include large ones, directly or through others, start from just those, precompiled
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
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
large="Eigen/Core Eigen/SparseCore Eigen/Dense nlohmann/json.hpp drev/core/system.hpp"

# plan: a line a file, with the large headers that its headers come to, "_" for "/", and the headers that it includes.
# shellcheck disable=SC2086
awk -v large="$large" '
  function reach(header, from,    i, list, n) {  # marks what the header that it started from comes to
    if ((from, header) in reached) return
    reached[from, header]
    ++size[from]
    n = split(includes[header], list, " ")
    for (i = 1; i <= n; ++i) {
      if (list[i] in is_large) heavy[from, is_large[list[i]]]
      if (list[i] in includes) reach(list[i], from)
    }
  }
  function largest_left(from,    header, best) {  # of all, or of those that a header comes to with the same large ones
    for (header in left)
      if (from == "" || ((from, header) in reached && class[from] == class[header]))
        if (best == "" || size[header] > size[best]) best = header
    return best
  }
  BEGIN {
    count = split(large, all, " ")
    for (i = 1; i <= count; ++i) {
      name = all[i]
      sub(/^drev\//, "", name)
      is_large[name] = all[i]
    }
  }
  FNR == 1 { includes[FILENAME] = "" }
  /^[ \t]*#[ \t]*include/ {
    name = $0
    sub(/^[^<"]*[<"](drev\/)?/, "", name)
    sub(/[>"].*/, "", name)
    includes[FILENAME] = includes[FILENAME] " " name
  }
  END {
    for (header in includes) {
      reach(header, header)
      for (i = 1; i <= count; ++i)
        if ((header, all[i]) in heavy) { name = all[i]; gsub("/", "_", name); class[header] = class[header] name "+" }
      if (class[header] == "") class[header] = "-"
      left[header]
    }
    while ((header = largest_left("")) != "") {
      set = class[header]
      for (file = ""; header != ""; header = largest_left(header)) {
        file = " " header file
        delete left[header]
      }
      print set file
    }
  }' $headers | sort >"$work/plan"

# A set of large headers is precompiled where several come to it.
printf '"%s"\n' "$@" -std=c++20 -Wall -Wextra -Wno-unused-function -Werror >"$work/options"
cut -d ' ' -f 1 "$work/plan" | sort | uniq -c | while read -r users class; do
  if [ "$class" = - ] || [ "$users" -lt 5 ]; then continue; fi
  for header in $large; do
    case "+$class" in *"+${header//\//_}+"*) echo "#include <$header>" ;; esac
  done >"$work/$class.hpp"
done

jobs=$(env -u OMP_NUM_THREADS nproc 2>/dev/null || echo 2)
precompile() { "$compiler" "@$work/options" -x c++-header "$1" -o "$1.gch"; }
compile() {
  local start=() set=$1
  shift
  if [ -f "$work/$set.hpp" ]; then start=(-include "$work/$set.hpp"); fi
  printf '#include "%s"\n' "$@" | "$compiler" "@$work/options" "${start[@]}" -fsyntax-only -I. -x c++ - ||
    { echo "FAILED: $*: one does not compile by itself" >&2; return 1; }
}
export -f compile precompile
export work compiler
find "$work" -name "*.hpp" -print0 | xargs -0 -r -P "$jobs" -n 1 bash -c 'precompile "$@"' bash || exit 1
xargs -P "$jobs" -L 1 bash -c 'compile "$@"' bash <"$work/plan" || exit 1
echo "$(wc -w <<<"$headers") headers compile by themselves."
