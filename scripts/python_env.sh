# Sourced by test.sh: makes build/venv, an environment of Python's own with what the Python package is built and tested
# with, from PyPI. Quick where it is made already.

python_env=$root/build/venv

# install_into_python_env <requirements file>: 0: all of it is there; else the reason is in build/venv-NAME.why.
install_into_python_env() {
  local name log stamp
  name=$(basename "$1" .txt)
  log=$root/build/venv-$name.log stamp=$python_env/$name.installed
  rm -f "$root/build/venv-$name.why"
  if cmp -s "$1" "$stamp"; then return 0; fi
  echo "Installing tests/python/$name.txt into build/venv"
  if ! "$python_env/bin/python" -m pip install --quiet --disable-pip-version-check -r "$1" >"$log" 2>&1; then
    echo "pip could not install tests/python/$name.txt: $(grep -m 1 ERROR "$log" || tail -n 1 "$log")" \
      >"$root/build/venv-$name.why"
    return 1
  fi
  cp "$1" "$stamp"
}

# make_python_env: the environment with tests/python/requirements.txt. 0: it is there; else as above.
make_python_env() {
  local interpreter=${DREV_PYTHON_BASE:-/usr/bin/python3}
  mkdir -p "$root/build"
  if ! "$python_env/bin/python" -c '' 2>/dev/null; then
    rm -rf "$python_env"
    if ! "$interpreter" -m venv "$python_env" >"$root/build/venv.log" 2>&1; then
      echo "$interpreter -m venv failed" >"$root/build/venv-requirements.why"
      return 1
    fi
  fi
  install_into_python_env "$root/tests/python/requirements.txt"
}
