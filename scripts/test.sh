#!/usr/bin/env bash
# Builds and runs every test; then the unit tests once more under the address and undefined-behaviour
# sanitizers. On a fresh Debian 12 or Ubuntu 24.04 it installs what it needs first.
#
#   scripts/test.sh            everything
#   scripts/test.sh --quick    without the sanitizers
#
# The Python package is built and tested with tools from PyPI, in an environment of its own (build/venv); where PyPI
# cannot be reached, that is left out. The last line is what CTest ran. DREV_WARNINGS_AS_ERRORS=ON in the environment
# makes warnings errors.
set -euo pipefail
quick=0
for argument in "$@"; do
  case $argument in
    --quick) quick=1 ;;
    *) sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
  esac
done
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$root"

ran=""
finish() {
  local status=$?
  for job in "${building:-}" "${peers:-}"; do [ -z "$job" ] || kill "$job" 2>/dev/null || true; done
  if [ $status != 0 ] && [ -z "${failed:-}" ]; then ran="${ran:+$ran; the rest }not run"; fi
  echo "CTest: $ran${skipped_python:-}"
  exit $status
}
trap finish EXIT

# run_tests <preset> <suffix>: runs CTest and adds "<n> tests, <n> failed<suffix>" to $ran.
run_tests() {
  local report=$root/build/$1-tests.xml status=0
  rm -f "$report"
  ctest --preset "$1" --parallel "$jobs" --output-junit "$report" || status=$?
  [ -f "$report" ] || fail "CTest left no report of preset $1"
  count() { sed -n "s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p" "$report" | head -n 1; }
  local skipped
  skipped=$(count skipped)
  ran="${ran:+$ran; }$(count tests) tests, $(count failures) failed"
  if [ "${skipped:-0}" != 0 ]; then ran="$ran, $skipped skipped"; fi
  ran="$ran$2"
  return $status
}

packages+=(libopenmpi-dev openmpi-bin)                # studies over the ranks of MPI
packages+=(valgrind python3-h5py python3-jsonschema)  # count instructions; read and check results
packages+=(clang-format-14 clang-tidy-14)             # this release alone formats as the tree is formatted
# Opens reports. Ubuntu's is a snap, which could not: that test is skipped there.
if grep -qx ID=debian /etc/os-release 2>/dev/null; then packages+=(chromium fonts-dejavu-core); fi
packages+=(python3-dev python3-venv)  # the Python package; its own tools come from PyPI
install_packages
source "$root/scripts/python_env.sh"
export DREV_PYTHON_PACKAGE=""
if make_python_env; then
  DREV_PYTHON_PACKAGE=$python_env/bin/python
  install_into_python_env tests/python/peers.txt &  # while the rest is built
  peers=$!
else
  skipped_python="; the Python package is not built or tested: $(cat build/venv-requirements.why)"
fi
build release
if [ $quick = 0 ]; then  # Tests leave part of the processors unused: the next build takes it.
  (renice -n 19 $BASHPID >/dev/null; build asan-ubsan) >build/asan-ubsan-build.log 2>&1 &
  building=$!
fi
if [ -n "${peers:-}" ] && ! wait "$peers"; then
  skipped_python="; Python tests that need more are skipped: $(cat build/venv-peers.why)"
fi
peers=""
run_tests release "" || failed=1
if [ $quick = 0 ]; then
  wait "$building" || { cat build/asan-ubsan-build.log >&2; fail "the build under sanitizers failed"; }
  building=""
  run_tests asan-ubsan " under sanitizers" || failed=1
fi
[ -z "${failed:-}" ]
