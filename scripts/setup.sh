# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by ./demo and ./test: installs the packages of packages.txt where any is missing, and says so.

missing_packages() {
  local wanted installed
  wanted=$(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' packages.txt | sort -u)
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' 2>/dev/null | sed -n 's/^installed //p' | sort -u)
  comm -23 <(echo "$wanted") <(echo "$installed")
}

install_packages() {
  local missing as_root=() log=build/setup.log
  if ! command -v dpkg-query >/dev/null; then
    echo "setup: this is not Debian: install what packages.txt lists by hand" >&2
    return 1
  fi
  missing=$(missing_packages)
  [ -z "$missing" ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "setup: missing packages, and neither root nor sudo to install them: $(echo $missing)" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "setup: installing $(echo "$missing" | wc -l) Debian packages (log: $log)"
  mkdir -p build
  if ! { "${as_root[@]}" apt-get update &&
         "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing; } \
       >"$log" 2>&1; then
    echo "setup: installing failed; the end of $log:" >&2
    tail -n 5 "$log" >&2
    return 1
  fi
}

# build_release PROGRAM...: these only, for the tests take most of a whole build.
build_release() {
  local log=build/release.log
  mkdir -p build
  echo "building $* (log: $log; the first time takes some minutes)"
  if ! { cmake --preset release && cmake --build --preset release --target "$@"; } >"$log" 2>&1; then
    echo "the build failed; the end of $log:" >&2
    tail -n 30 "$log" >&2
    return 1
  fi
}
