# SPDX-License-Identifier: Apache-2.0
# Sourced by the scripts of this folder: packages, configure, build. Needs $root.

say() { printf '== %s\n' "$*"; }
stop() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

packages_of() { # GROUP...
  local group name
  for group in "$@"; do sed -n "s/^$group: //p" "$root/tools/packages"; done | tr ' ' '\n' | sort -u |
    while read -r name; do
      case $name in *'|'*) one_of "$name" ;; *) printf '%s\n' "$name" ;; esac
    done
}

# Of NAME|NAME... the first that is installed or that this system knows, or the first.
one_of() {
  local name
  for name in ${1//|/ }; do
    if is_installed "$name" || [ -n "$(apt-cache madison "$name" 2>/dev/null)" ]; then
      printf '%s\n' "$name"
      return
    fi
  done
  printf '%s\n' "${1%%|*}"
}

is_installed() {
  # A Node.js from elsewhere brings npm along, and refuses Debian's.
  [ "$1" = npm ] && command -v npm >/dev/null && return
  [ "$(dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null)" = 'ii ' ]
}

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    stop "needs root to install packages, and there is no sudo; install these first: ${missing[*]}"
  fi
}

# Sets `missing` to what of the groups is not installed.
find_missing() { # GROUP...
  local package
  missing=()
  for package in $(packages_of "$@"); do
    [[ " ${unpacked[*]:-} " = *" $package "* ]] && continue
    is_installed "$package" || missing+=("$package")
  done
}

# Installs what is missing of the groups; touches neither network nor root when all is there.
install_packages() { # GROUP...
  missing=()
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    [ -n "${FDCG_SKIP_PACKAGES:-}" ] && return
    printf 'This is not a Debian system. What Debian calls these packages is needed:\n' >&2
    packages_of "$@" | sed 's/^/  /' >&2
    stop 'install them by the means of your system, then run this again with FDCG_SKIP_PACKAGES=1'
  fi
  find_missing "$@"
  [ ${#missing[@]} -eq 0 ] && return
  say "installing ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  as_root apt-get update -q </dev/null || stop 'apt-get update failed; is there a network?'
  find_missing "$@" # names that differ between systems are known now
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" </dev/null ||
    stop "apt-get could not install: ${missing[*]}"
}

# Packages of a group that are not installed are unpacked into build/packages instead, without what they depend on, and left out
# by install_packages from then on. Sets `prefix` to where they are, or to nothing.
unpack_packages() { # GROUP
  local package archive
  unpacked=() prefix=
  command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || return 0
  for package in $(packages_of "$1"); do is_installed "$package" || unpacked+=("$package"); done
  [ ${#unpacked[@]} -eq 0 ] && return
  if [ -z "$(apt-cache madison "${unpacked[0]}" 2>/dev/null)" ]; then
    as_root apt-get update -q || stop 'apt-get update failed; is there a network?'
    mapfile -t unpacked < <(packages_of "$1") # names that differ between systems are known now
  fi
  prefix=$root/build/packages/usr
  mkdir -p "$root/build/packages"
  (cd "$root/build/packages" && apt-get download -q "${unpacked[@]}" >&2) || stop "could not fetch ${unpacked[*]}"
  for archive in "$root"/build/packages/*.deb; do dpkg-deb -x "$archive" "$root/build/packages"; done
}

# As many as there are cores, but no more than memory holds at 1.5 GB each: what the largest unit takes, with room.
build_jobs() {
  local cores memory_kb fitting
  cores=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo 2>/dev/null)
  fitting=$((${memory_kb:-1500000} / 1500000))
  [ "$fitting" -ge 1 ] || fitting=1
  [ "$fitting" -lt "$cores" ] && echo "$fitting" || echo "$cores"
}

configure() { # PRESET [ARGUMENT OF CMAKE...]
  say "configuring ($1)"
  cmake --preset "$@" >"$root/build/configure-$1.log" 2>&1 || {
    cat "$root/build/configure-$1.log" >&2
    stop 'cmake failed'
  }
}

build() { # PRESET [TARGET...]
  local preset=$1 jobs
  shift
  jobs=$(build_jobs)
  say "building ($preset, $jobs jobs)"
  cmake --build --preset "$preset" --parallel "$jobs" ${1:+--target "$@"} || stop 'the build failed'
}
