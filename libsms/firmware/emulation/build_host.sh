#!/bin/sh
# The host's side of ./dev firmware: the lockstep program, the application for a 32-bit host, the poisoned build:
# build_host.sh FOLDER 32|64
set -eu
here=$(cd "$(dirname "$0")" && pwd)
firmware=$(cd "$here/.." && pwd)
libsms=$(cd "$firmware/.." && pwd)
out=$1 bits=$2
eigen=${EIGEN_INCLUDE:-/usr/include/eigen3}
flags="-DNDEBUG -DEIGEN_DONT_VECTORIZE -DEIGEN_MAX_ALIGN_BYTES=0 -fno-exceptions -fno-rtti -fno-math-errno
  -ffp-contract=off -Wall -Wextra -Wdouble-promotion -Werror -I$firmware -I$here -I$firmware/tests -I$libsms/include
  -isystem $eigen"
sources=$(cd "$firmware" && for source in *.cpp; do echo "${source%.cpp}"; done | grep -vx main)

# compile MACHINE STANDARD SOURCE OBJECT
compile() {
  # shellcheck disable=SC2086  # lists of words
  ${CMAKE_CXX_COMPILER_LAUNCHER-} g++ $1 -std=$2 -O2 $flags -c "$3" -o "$4"
}

machine="-m$bits"
[ "$bits" = 64 ] || machine="-m32 -msse2 -mfpmath=sse"
objects=
for source in $sources; do
  compile "$machine" c++14 "$firmware/$source.cpp" "$out/$source.$bits.o"
  objects="$objects $out/$source.$bits.o"
done
compile "$machine" c++14 "$libsms/src/info.cpp" "$out/info.$bits.o"
compile "$machine" c++17 "$firmware/tests/fault_table.cpp" "$out/fault_table.$bits.o"
# shellcheck disable=SC2086
g++ $machine "$out/fault_table.$bits.o" "$out/info.$bits.o" $objects -o "$out/fault_table.$bits"
[ "$bits" = 64 ] || exit 0

compile "$machine" c++17 "$here/lockstep.cpp" "$out/lockstep.o"
compile "$machine" c++14 "$libsms/src/mechanism_double.cpp" "$out/mechanism_double.o"
compile "$machine" c++14 "$libsms/src/plant_double.cpp" "$out/plant_double.o"
# shellcheck disable=SC2086
g++ "$out/lockstep.o" "$out/mechanism_double.o" "$out/plant_double.o" "$out/info.$bits.o" $objects -o "$out/lockstep.host"
for source in $(echo "$sources" | grep -vx sms_firmware); do
  # shellcheck disable=SC2086
  ${CMAKE_CXX_COMPILER_LAUNCHER-} g++ -std=c++14 $flags -include "$here/poison.h" -c "$firmware/$source.cpp" \
    -o "$out/$source.poisoned.o"
done
