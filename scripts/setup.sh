# Sourced by run.sh and test.sh: installs what drev needs on Debian 12 and Ubuntu 24.04, and builds it.
# Installs Debian packages only, asks for nothing, and does nothing where all of it is there.

packages=(g++ cmake ninja-build libeigen3-dev libsuitesparse-dev libarpack2-dev
          libcli11-dev nlohmann-json3-dev libhdf5-dev libboost-random-dev libminizip-dev libnlopt-dev libexpat1-dev libtomlplusplus-dev
          libjs-dygraphs
          catch2)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

fail() {
  echo "drev: $*" >&2
  exit 1
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | head -n 1)" = installed ] ||
      echo "$package"
  done
}

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo -n "$@"; fi
}

install_packages() {
  [ -z "${DREV_SKIP_SETUP:-}" ] || return 0
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    fail "this system has no apt-get. Install by hand what Debian calls: ${packages[*]}
Then run this again with DREV_SKIP_SETUP=1."
  fi
  local missing
  mapfile -t missing < <(missing_packages)
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ] && ! sudo -n true 2>/dev/null; then
    fail "no right to install packages without a password. Run once, then this again:
  sudo apt-get update && sudo apt-get install ${missing[*]}"
  fi
  echo "Installing Debian packages: ${missing[*]}"
  local apt=(env DEBIAN_FRONTEND=noninteractive NEEDRESTART_MODE=a
             apt-get -q -y -o DPkg::Lock::Timeout=300)
  as_root "${apt[@]}" update >/dev/null || echo "drev: apt-get update failed; trying with what apt knows" >&2
  as_root "${apt[@]}" install --no-install-recommends "${missing[@]}" >/dev/null ||
    fail "could not install: ${missing[*]}"
}

jobs=$(nproc 2>/dev/null || echo 2)

# build <preset> <targets or options of cmake --build>. DREV_WARNINGS_AS_ERRORS=ON in the environment is
# passed on (not to the sanitizers: with them, g++ warns of what is not there).
build() {
  local preset=$1 options=()
  shift
  if [ -n "${DREV_WARNINGS_AS_ERRORS:-}" ] && [ "$preset" != asan-ubsan ]; then
    options+=("-DDREV_WARNINGS_AS_ERRORS=$DREV_WARNINGS_AS_ERRORS")
  fi
  if [ "$preset" = release ] && [ -n "${DREV_PYTHON_PACKAGE+given}" ]; then
    options+=("-DDREV_PYTHON_PACKAGE=$DREV_PYTHON_PACKAGE")
  fi
  echo "Building preset $preset"
  # --fresh needs CMake 3.24; a tree that was moved or made by another generator is configured again.
  local cache=build/$preset/CMakeCache.txt
  if [ -f "$cache" ] && ! { grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache" &&
      grep -qx "CMAKE_GENERATOR:INTERNAL=Ninja" "$cache"; }; then
    rm -rf "build/$preset/CMakeFiles" "$cache"
  fi
  local log=build/$preset.log
  mkdir -p build
  if ! cmake --preset "$preset" "${options[@]}" >"$log" 2>&1; then
    cat "$log" >&2
    fail "CMake could not configure preset $preset"
  fi
  cmake --build --preset "$preset" --parallel "$jobs" "$@" || fail "preset $preset does not build"
}
