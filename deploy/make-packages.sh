#!/usr/bin/env bash
# Builds the Debian packages, in a folder that can install them without internet.
#
#   deploy/make-packages.sh                into var/packages
#   deploy/make-packages.sh --out DIR      into DIR, whose content is replaced
#   deploy/make-packages.sh --no-deps      only our packages, without those that they depend on
#   deploy/make-packages.sh --tree DIR     from what this build tree already has, such as build/dev; builds nothing
#   deploy/make-packages.sh --version V    the packages' version (default: of the project and the commit)
#
# On the host: copy the folder there, then sudo DIR/install.sh chorus-sensor (or chorus-fusion, chorus-tools).
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; }
step() { printf '\n== %s\n' "$*"; }
fail() { printf '\nmake-packages: %s\n' "$*" >&2; exit 1; }

out=var/packages deps=yes tree='' version=''
while (( $# > 0 )); do
  case $1 in
    --out) out=${2:?--out needs a folder}; shift ;;
    --version) version=${2:?--version needs one}; shift ;;
    --no-deps) deps='' ;;
    --tree) tree=${2:?--tree needs a build folder}; shift ;;
    -h|--help) usage; exit 0 ;;
    *) usage >&2; fail "unknown option $1" ;;
  esac
  shift
done

# 0.1.0+20261122.1504.8f4d3d4: a later commit has a higher version, and one can return to an earlier one.
own_version() {
  local number
  number=$(sed -n 's/^project(chorus VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
  if git rev-parse --quiet --verify HEAD >/dev/null 2>&1; then
    TZ=UTC git log -1 --date=format-local:%Y%m%d.%H%M --format="$number+%cd.%h"
  else
    echo "$number"
  fi
}

page_files() {
  local folder
  for folder in services/viewer services/pose-runner; do
    [[ -d $folder/node_modules ]] || npm ci --prefix "$folder" --no-progress
  done
}

# Downloads the dependencies of our packages that a Debian may lack, as apt finds them for an empty system.
download_dependencies() {
  local scratch; scratch=$(mktemp -d)
  mkdir -p "$scratch/archives/partial"
  : > "$scratch/status"
  apt-get -qq -y --no-install-recommends --download-only -o Debug::NoLocking=true -o APT::Sandbox::User=root \
    -o "Dir::State::Status=$scratch/status" -o "Dir::Cache::Archives=$scratch/archives" \
    -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= install "$@"
  local deb priority
  for deb in "$scratch"/archives/*.deb; do
    priority=$(dpkg-deb -f "$deb" Priority)
    case $priority in required|important) continue ;; esac
    cp "$deb" "$out/"
  done
  rm -rf "$scratch"
}

[[ -n "$version" ]] || version=$(own_version)
command -v dpkg-scanpackages >/dev/null || fail "dpkg-scanpackages is missing: apt install dpkg-dev"
page_files
if [[ -z "$tree" ]]; then
  tree=build/package
  step "build of $version"
  launcher=()
  export CCACHE_SLOPPINESS=pch_defines,time_macros
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  cmake --preset package "${launcher[@]}" -DCMAKE_SKIP_RPATH=ON --log-level=WARNING >/dev/null
  cmake --build "$tree" -j "$(deploy/build-jobs.sh)" --target chorus-sensor chorus-sensor-small chorus-fusion chorus chorus-host pages
fi

step "packages"
rm -rf "$tree/packages"
(cd "$tree" && cpack --config CPackConfig.cmake -D CPACK_PACKAGE_VERSION="$version" >cpack.log 2>&1) || { tail -20 "$tree/cpack.log" >&2; fail "cpack failed"; }
rm -rf "$out"
mkdir -p "$out/debug"
out=$(realpath "$out")  # absolute, because apt takes a path without a leading / for the name of a package
cp "$tree"/packages/*.deb "$out/"
cp "$tree"/packages/*.ddeb "$out/debug/" 2>/dev/null || true
if [[ -n "$deps" ]]; then
  step "what they need"
  download_dependencies "$out"/chorus-*.deb chrony  # chrony: without internet a workshop keeps its own time
fi

. /etc/os-release
echo "$ID-$VERSION_ID-$(dpkg --print-architecture)" > "$out/SYSTEM"
cp deploy/package/install.sh "$out/"
(cd "$out" && dpkg-scanpackages --multiversion . /dev/null > Packages 2>/dev/null)
ls "$out" | grep -c '\.deb$' | sed "s|\$| packages in $out: $(du -sh "$out" | cut -f1)|"
