#!/usr/bin/env bash
# Installs Chorus from this folder, without internet: ./install.sh chorus-sensor | chorus-fusion | chorus-tools ...
#   ./install.sh --list PACKAGE... prints which packages of this folder that would install here, and changes nothing.
# Neither reads nor changes the system's own package sources.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
list=''
[[ ${1:-} != --list ]] || { list=yes; shift; }
(( $# > 0 )) || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
[[ -e "$folder/SYSTEM" && -e "$folder/Packages" ]] ||
  { echo "install: $folder is not complete; copy again all that deploy/make-packages.sh made" >&2; exit 1; }
for name in "$@"; do
  [[ $name != -* ]] && grep -Fqx "Package: ${name%%=*}" "$folder/Packages" && continue
  echo "install: there is no package $name here; there are:" "$(sed -n 's/^Package: \(chorus-\)/\1/p' "$folder/Packages" | sort -u | tr '\n' ' ')" >&2
  exit 1
done
(( EUID == 0 )) || { echo "install: run this as root (sudo $0 $*)" >&2; exit 1; }
. /etc/os-release
built_for=$(cat "$folder/SYSTEM")
if [[ "${ID:-}-${VERSION_ID:-}-$(dpkg --print-architecture)" != "$built_for" ]]; then
  echo "install: these packages are for $built_for, and this is ${PRETTY_NAME:-another system} on" \
    "$(dpkg --print-architecture)" >&2
  exit 1
fi

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
chmod 755 "$scratch"
mkdir -p "$scratch/lists/partial" "$scratch/archives/partial"
echo "deb [trusted=yes] copy:$folder ./" > "$scratch/sources.list"
apt=(apt-get -q -o DPkg::Lock::Timeout=120 -o "Dir::Etc::SourceList=$scratch/sources.list" -o Dir::Etc::SourceParts=/dev/null
  -o "Dir::State::Lists=$scratch/lists" -o "Dir::Cache::Archives=$scratch/archives"
  -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User=root)
install=(install -y --no-install-recommends --allow-downgrades)
if [[ -n $list ]]; then
  "${apt[@]}" update >/dev/null
  # Lines 'copy:FOLDER/./FILE' NAME SIZE HASH, where FILE is written as in a URL.
  "${apt[@]}" -qq --print-uris "${install[@]}" "$@" | sed -n "s|^'copy:$folder/\./\([^']*\)'.*|\1|p" |
    while read -r file; do printf '%b\n' "${file//%/\\x}"; done
  exit
fi
"${apt[@]}" update
DEBIAN_FRONTEND=noninteractive "${apt[@]}" "${install[@]}" \
  -o Dpkg::Options::=--force-confdef -o Dpkg::Options::=--force-confold "$@"  # keeps the user's changes
