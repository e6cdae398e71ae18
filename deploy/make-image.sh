#!/usr/bin/env bash
# Builds a container image from a Debian root and our packages: an OCI archive that docker, podman and skopeo load.
#
#   deploy/make-image.sh                    chorus-sensor from var/packages into var/images/chorus-sensor.tar
#   deploy/make-image.sh chorus-fusion      the same of another package
#   deploy/make-image.sh --packages DIR --out DIR
#
# Needs mmdebstrap, dpkg-dev and internet (for the root); the packages are those of deploy/make-packages.sh.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; }
step() { printf '\n== %s\n' "$*"; }
fail() { printf '\nmake-image: %s\n' "$*" >&2; exit 1; }

packages=var/packages out=var/images service=chorus-sensor
while (( $# > 0 )); do
  case $1 in
    --packages) packages=${2:?--packages needs a folder}; shift ;;
    --out) out=${2:?--out needs a folder}; shift ;;
    -h|--help) usage; exit 0 ;;
    chorus-sensor|chorus-fusion) service=$1 ;;
    *) usage >&2; fail "unknown argument $1" ;;
  esac
  shift
done
command -v mmdebstrap >/dev/null || fail "mmdebstrap is missing: deploy/install-packages.sh workshop"
[[ -e "$packages/Packages" ]] || fail "there are no packages in $packages: deploy/make-packages.sh makes them"
mkdir -p "$out"
scratch=$(mktemp -d -p /tmp)  # without spaces: it becomes a file: URL
trap 'rm -rf "$scratch"' EXIT

# Only ours: everything else comes from Debian, with its security updates.
mkdir "$scratch/ours"
cp "$packages"/chorus-*.deb "$scratch/ours/"
(cd "$scratch/ours" && dpkg-scanpackages --multiversion . /dev/null > Packages 2>/dev/null)
chmod -R a+rX "$scratch"

step "root with $service"
kind=${service#chorus-}
# shellcheck disable=SC2016  # $1 is the hook's
mmdebstrap --quiet --variant=essential --include="$service,passwd,ca-certificates" \
  --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
  --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
  --customize-hook="install -d -o \$(stat -c %u \"\$1/var/lib/chorus\") -g \$(stat -c %g \"\$1/var/lib/chorus\") -m 750 \"\$1/var/lib/chorus/$kind\"" \
  --customize-hook='sed -i "\\|file://|d" "$1/etc/apt/sources.list" && rm -rf "$1"/var/lib/apt/lists/* "$1"/var/cache/*' \
  bookworm "$scratch/layer.tar" \
  "deb http://deb.debian.org/debian bookworm main" \
  "deb http://deb.debian.org/debian-security bookworm-security main" \
  "deb [trusted=yes] file://$scratch/ours ./"

step "image"
version=$(tar -xOf "$scratch/layer.tar" ./var/lib/dpkg/status \
  | awk -v name="$service" '$1 == "Package:" { mine = $2 == name } mine && $1 == "Version:" { found = $2 } END { print found }')
python3 deploy/package/oci_archive.py "$scratch/layer.tar" "$out/$service.tar" --service "$service" --version "$version" \
  --architecture "$(dpkg --print-architecture)"
du -h "$out/$service.tar"
