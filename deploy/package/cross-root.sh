#!/usr/bin/env bash
# Runs a command in a Debian root that holds the cross compiler for arm64 and our libraries for it, so that the machine itself gets no
# packages of another architecture.  As root.
#
#   deploy/package/cross-root.sh COMMAND...     in the project's folder, which has the same path in the root
#
# The root is var/cross-arm64 (1.3 GB); it is made when it is missing, or was made for other packages.
set -euo pipefail
cd "$(dirname "$0")/../.."

fail() { printf '\ncross-root: %s\n' "$*" >&2; exit 1; }

readonly root=$PWD/var/cross-arm64

wanted_packages() {
  local package _ kind
  echo crossbuild-essential-arm64 pkgconf:arm64 qemu-user-static ccache
  while read -r package _ kind; do
    case $kind in
      tool) echo "$package" ;;
      library) echo "$package:arm64" ;;
    esac
  done < deploy/packages.txt
}

make_root() {
  command -v mmdebstrap >/dev/null || fail "mmdebstrap is missing: deploy/install-packages.sh workshop"
  printf '\n== Debian root with the cross compiler in %s\n' "$root" >&2
  rm -rf "$root"
  mkdir -p "$(dirname "$root")"
  mmdebstrap --quiet --mode=root --variant=apt --architectures=amd64,arm64 --include="$(tr -s ' \n' ',' <<<"$wanted")" \
    bookworm "$root" >&2
  echo "$wanted" > "$root/etc/chorus-packages"
}

(( $# > 0 )) || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; }
(( EUID == 0 )) || fail "run as root, because it makes a Debian root and enters it"
[[ "$(dpkg --print-architecture)" == amd64 ]] || fail "only amd64 compiles for arm64"
wanted=$(wanted_packages)
[[ "$(cat "$root/etc/chorus-packages" 2>/dev/null)" == "$wanted" ]] || make_root

cache=${CCACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/ccache}
mkdir -p "$cache"
# What is mounted is seen by the command only, and ends with it.
# shellcheck disable=SC2016  # the variables are the inner shell's
exec unshare --mount bash -euc '
  root=$1 project=$2 cache=$3
  shift 3
  mount --make-rprivate /
  mount -t proc proc "$root/proc"
  mount -t tmpfs dev "$root/dev"
  for device in null zero urandom random; do touch "$root/dev/$device"; mount --bind "/dev/$device" "$root/dev/$device"; done
  ln -s /proc/self/fd "$root/dev/fd"
  for folder in "$project" "$cache"; do mkdir -p "$root$folder"; mount --bind "$folder" "$root$folder"; done
  exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "CCACHE_DIR=$cache" \
    CCACHE_SLOPPINESS=pch_defines,time_macros chroot "$root" env --chdir="$project" "$@"
' _ "$root" "$PWD" "$cache" "$@"
