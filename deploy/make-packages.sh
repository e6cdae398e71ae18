#!/usr/bin/env bash
# Builds the Debian packages, in a folder that can install them without internet.
#
#   deploy/make-packages.sh                into var/packages
#   deploy/make-packages.sh --out DIR      into DIR, whose content is replaced
#   deploy/make-packages.sh --no-deps      only our packages, without those that they depend on
#   deploy/make-packages.sh --tree DIR     from what this build tree already has, such as build/dev; builds nothing
#   deploy/make-packages.sh --version V    the packages' version (default: of the project and the commit)
#   deploy/make-packages.sh --arch arm64   chorus-sensor and chorus-common for arm64, compiled on amd64 in a Debian root (as root),
#                                          into var/packages-arm64
#
# On the host: copy the folder there, then sudo DIR/install.sh chorus-sensor (or chorus-fusion, chorus-evaluation, ...).
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; }
step() { printf '\n== %s\n' "$*"; }
fail() { printf '\nmake-packages: %s\n' "$*" >&2; exit 1; }

own_arch=$(dpkg --print-architecture)
readonly own_arch
arch=$own_arch out='' deps=yes tree='' version=''
while (( $# > 0 )); do
  case $1 in
    --out) out=${2:?--out needs a folder}; shift ;;
    --version) version=${2:?--version needs one}; shift ;;
    --no-deps) deps='' ;;
    --arch) arch=${2:?--arch needs arm64}; shift ;;
    --tree) tree=${2:?--tree needs a build folder}; shift ;;
    -h|--help) usage; exit 0 ;;
    *) usage >&2; fail "unknown option $1" ;;
  esac
  shift
done

# 0.5.0+20261122.1504.8f4d3d4: a later commit has a higher version, and one can return to an earlier one.
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
  local apt=(apt-get -qq -y --no-install-recommends -o Debug::NoLocking=true -o APT::Sandbox::User=root
    -o "Dir::State::Status=$scratch/status" -o "Dir::Cache::Archives=$scratch/archives"
    -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=)
  if [[ $arch != "$own_arch" ]]; then  # with lists of its own, because the system's are of other architectures
    mkdir -p "$scratch/lists/partial"
    apt+=(-o "APT::Architecture=$arch" -o "APT::Architectures=$arch" -o "Dir::State::Lists=$scratch/lists")
    "${apt[@]}" update
  fi
  "${apt[@]}" --download-only install "$@"
  local deb priority
  for deb in "$scratch"/archives/*.deb; do
    priority=$(dpkg-deb -f "$deb" Priority)
    case $priority in required|important) continue ;; esac
    cp "$deb" "$out/"
  done
  rm -rf "$scratch"
}

preset=package programs=(chorus-sensor chorus-sensor-small chorus-fusion chorus-ergonomics chorus-evaluation chorus chorus-host)
inside=()  # goes before what must run where the compiler is
if [[ $arch != "$own_arch" ]]; then
  [[ $arch == arm64 ]] || fail "packages can be made for $own_arch and, cross-compiled, for arm64"
  preset=package-arm64 programs=(chorus-sensor-small chorus-host)
  inside=(deploy/package/cross-root.sh)
fi
[[ -n "$out" ]] || { out=var/packages; [[ $arch == "$own_arch" ]] || out+=-$arch; }
[[ -n "$version" ]] || version=$(own_version)
command -v dpkg-scanpackages >/dev/null || fail "dpkg-scanpackages is missing: apt install dpkg-dev"
[[ $arch != "$own_arch" ]] || page_files
if [[ -z "$tree" ]]; then
  tree=build/$preset
  step "build of $version for $arch"
  launcher=()
  export CCACHE_SLOPPINESS=pch_defines,time_macros
  "${inside[@]}" which ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  "${inside[@]}" cmake --preset "$preset" "${launcher[@]}" -DCMAKE_SKIP_RPATH=ON --log-level=WARNING >/dev/null
  "${inside[@]}" cmake --build "$tree" -j "$(deploy/build-jobs.sh)" --target "${programs[@]}" pages
fi

step "packages"
rm -rf "$tree/packages"
"${inside[@]}" cpack --config "$tree/CPackConfig.cmake" -D CPACK_PACKAGE_VERSION="$version" >"$tree/cpack.log" 2>&1 || { tail -20 "$tree/cpack.log" >&2; fail "cpack failed"; }
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
echo "$ID-$VERSION_ID-$arch" > "$out/SYSTEM"
cp deploy/package/install.sh "$out/"
(cd "$out" && dpkg-scanpackages --multiversion . /dev/null > Packages 2>/dev/null)
ls "$out" | grep -c '\.deb$' | sed "s|\$| packages in $out: $(du -sh "$out" | cut -f1)|"
