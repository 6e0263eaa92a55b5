#!/usr/bin/env bash
# Builds drev and runs the camshaft. On a fresh Debian 12 or Ubuntu 24.04 it installs what it needs first.
#
#   scripts/run.sh [parameters of `drev run camshaft`]     e.g. scripts/run.sh --out result
#
# Results go to results/camshaft unless --out says otherwise.
set -euo pipefail
start=$PWD
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$root"
install_packages
build release --target drev

out=""
take=0
for argument in "$@"; do
  if [ $take = 1 ]; then out=$argument take=0; fi
  case $argument in
    --out) take=1 ;;
    --out=*) out=${argument#--out=} ;;
  esac
done
options=("$@")
if [ -z "$out" ]; then
  out=$root/results/camshaft
  options+=(--out "$out")
  mkdir -p "$root/results"
  echo '*' >"$root/results/.gitignore"
fi

cd "$start"
status=0
"$root/build/release/bin/drev" run camshaft "${options[@]}" || status=$?
if [ $status != 0 ]; then
  echo "drev: the run ended with status $status" >&2
  exit $status
fi
if [ -d "$out" ]; then
  echo
  echo "Results are in $(cd "$out" && pwd):"
  (cd "$out" && find . -type f | sed 's|^\./|  |' | sort)
fi
