#!/usr/bin/env bash
# Installs what is missing: install-packages.sh PURPOSE...  (build, tests, bench, workshop; see packages.txt)
# Runs as root or through sudo; when nothing is missing it needs neither.  Any Node.js from version 18 on, with npm, in
# PATH will do; otherwise it installs Debian's.
set -euo pipefail
cd "$(dirname "$0")"
readonly least_node=18

wanted_packages() {
  local purposes=" $* "
  while read -r package purpose _; do
    [[ -z "$package" || "$package" == \#* ]] && continue
    [[ "$purposes" == *" ${purpose:-build} "* ]] && echo "$package"
  done < packages.txt
  if ! have_node; then echo nodejs; echo npm; fi
}

have_node() {
  local version
  command -v npm >/dev/null || return 1
  version=$(node --version 2>/dev/null) || return 1
  version=${version#v}
  (( ${version%%.*} >= least_node ))
}

installed() {
  [[ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

as_root() {
  if (( EUID == 0 )); then "$@"
  elif command -v sudo >/dev/null; then sudo "$@"
  else
    echo "install-packages: neither root nor sudo; please install: ${missing[*]}" >&2
    exit 1
  fi
}

(( $# > 0 )) || { echo "usage: install-packages.sh build|tests|bench|workshop ..." >&2; exit 2; }
command -v dpkg-query >/dev/null || { echo "install-packages: this needs Debian or a relative" >&2; exit 1; }

missing=()
while read -r package; do
  installed "$package" || missing+=("$package")
done < <(wanted_packages "$@")

if (( ${#missing[@]} == 0 )); then
  echo "packages: all there"
  exit 0
fi
echo "packages: installing ${missing[*]}"
readonly wait_for_lock=(-o DPkg::Lock::Timeout=300)
as_root apt-get "${wait_for_lock[@]}" -qq update
as_root env DEBIAN_FRONTEND=noninteractive apt-get "${wait_for_lock[@]}" -qq -y \
  --no-install-recommends install "${missing[@]}"
