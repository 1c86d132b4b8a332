#!/bin/sh
# What a wheel of sms carries, from source: Eigen and a static Ceres, with their licences.
#
#   packaging/wheel/dependencies.sh FOLDER
#
# Fetches two source archives (5 MB) unless FOLDER/archives has them, compares their SHA-256, and makes FOLDER a CMake
# prefix with licences/. On Debian 12 they come from its package archive, by apt-get, elsewhere from the projects, by curl.
# Ceres is built with its dense solvers alone: SuiteSparse, CXSparse, LAPACK and Eigen's sparse part would bring GPL and LGPL
# code or libraries to carry, and no fit here uses them. Of its log, errors are printed.
set -eu
[ $# = 1 ] || { echo "usage: $0 FOLDER" >&2; exit 2; }
mkdir -p "$1/archives" "$1/licences/eigen" "$1/licences/ceres-solver"
folder=$(cd "$1" && pwd)

fail() {
  printf '%s: %s\n' "$0" "$*" >&2
  exit 1
}

# has FILE SUM: FILE is there, with this SHA-256.
has() {
  [ -f "$1" ] || return 1
  found=$({ sha256sum "$1" 2>/dev/null || shasum -a 256 "$1"; } | cut -d ' ' -f 1)
  [ "$found" = "$2" ] || fail "$1 has the SHA-256 $found, not $2: delete it, and look at where it came from"
}

# from_debian PACKAGE VERSION: its source archive into FOLDER/archives; lists stay in FOLDER/apt, the system's as they are.
from_debian() {
  command -v apt-get >/dev/null || return 1
  mkdir -p "$folder/apt/lists/partial" "$folder/apt/cache/archives/partial"
  if [ ! -s "$folder/apt/sources.list" ]; then
    # shellcheck disable=SC2016  # apt fills these in
    apt-get indextargets --format 'deb-src $(REPO_URI) $(CODENAME) $(COMPONENT)' \
      'Created-By: Packages' 'Component: main' 'Origin: Debian' | sort -u >"$folder/apt/sources.list"
    apt update
  fi
  (cd "$folder/archives" && apt source --download-only "$1=$2")
}

apt() {
  apt-get -q -o Dir::Etc::SourceList="$folder/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null \
    -o Dir::State::Lists="$folder/apt/lists" -o Dir::Cache="$folder/apt/cache" -o APT::Sandbox::User=root "$@"
}

# unpack NAME ARCHIVE: its one folder becomes FOLDER/NAME.
unpack() {
  rm -rf "${folder:?}/$1"
  mkdir "$folder/$1"
  tar -xf "$2" -C "$folder/$1" --strip-components 1
}

! command -v ninja >/dev/null || export CMAKE_GENERATOR=Ninja
build() {
  name=$1
  shift
  cmake -S "$folder/$name" -B "$folder/$name/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$folder" \
    -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_PREFIX_PATH="$folder" -DBUILD_TESTING=OFF "$@"
  cmake --build "$folder/$name/build" --target install --parallel "$(getconf _NPROCESSORS_ONLN)"
}

# Eigen's own archive, which is Debian's as well.
archive=$folder/archives/eigen3_3.4.0.orig.tar.bz2
sum=b4c198460eba6f28d34894e3a5710998818515104d6e74e5cc331ce31e46e626
if ! has "$archive" $sum; then
  from_debian eigen3 3.4.0-4 ||
    curl -fL -o "$archive" https://gitlab.com/libeigen/eigen/-/archive/3.4.0/eigen-3.4.0.tar.bz2
  has "$archive" $sum || fail "$archive was not fetched"
fi
unpack eigen "$archive"
build eigen -DEIGEN_BUILD_DOC=OFF -DEIGEN_BUILD_PKGCONFIG=OFF
cp "$folder/eigen/COPYING.README" "$folder/eigen/COPYING.MPL2" "$folder/eigen/COPYING.BSD" "$folder/eigen/COPYING.APACHE" \
  "$folder/licences/eigen"

# Debian's archive of Ceres is without some test data, hence another sum than the project's.
archive=$folder/archives/ceres-solver_2.1.0+really2.1.0+dfsg.orig.tar.xz
sum=acd5774187a8ea92bdf9e6d1faeb22c00bf30b1ad226ef6e2ade8b7636bbc336
if ! has "$archive" $sum && ! from_debian ceres-solver '2.1.0+really2.1.0+dfsg-1'; then
  archive=$folder/archives/ceres-solver-2.1.0.tar.gz
  sum=f7d74eecde0aed75bfc51ec48c91d01fe16a6bf16bce1987a7073286701e2fc6
  has "$archive" $sum || curl -fL -o "$archive" http://ceres-solver.org/ceres-solver-2.1.0.tar.gz
fi
has "$archive" $sum || fail "$archive was not fetched"
unpack ceres "$archive"
build ceres -DBUILD_SHARED_LIBS=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DMINIGLOG=ON -DMINIGLOG_MAX_LOG_LEVEL=-2 \
  -DGFLAGS=OFF -DSUITESPARSE=OFF -DCXSPARSE=OFF -DACCELERATESPARSE=OFF -DEIGENSPARSE=OFF -DLAPACK=OFF -DCUDA=OFF \
  -DSCHUR_SPECIALIZATIONS=OFF -DBUILD_EXAMPLES=OFF -DBUILD_BENCHMARKS=OFF -DPROVIDE_UNINSTALL_TARGET=OFF
cp "$folder/ceres/LICENSE" "$folder/licences/ceres-solver"
