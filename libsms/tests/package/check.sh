#!/bin/sh
# libsms as a user gets it: built without Python and Ceres, installed, found by CMake and by pkg-config, linked into C99
# programs, and the float archive held against the list of what firmware may call. Run at the top of the checkout; works
# in build/core, build/prefix and build/consumer.
set -eu

cmake --preset core
cmake --build --preset core
rm -rf build/prefix build/consumer
cmake --install build/core

echo "-- find_package(sms)"
cmake -S libsms/tests/package -B build/consumer -G Ninja -DCMAKE_PREFIX_PATH="$PWD/build/prefix"
cmake --build build/consumer
ctest --test-dir build/consumer --no-tests=error --output-on-failure

echo "-- pkg-config"
pc=$(find build/prefix -name sms.pc)
PKG_CONFIG_PATH=$PWD/$(dirname "$pc")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046  # the flags are words
cc -std=c99 -pedantic -Wall -Wextra -Werror libsms/tests/c_consumer.c -o build/consumer/by_pkg_config \
  $(pkg-config --cflags --libs sms)
build/consumer/by_pkg_config | tee build/consumer/by_pkg_config.txt
grep -q "^libsms $(pkg-config --modversion sms) float+double c++201402L no-exceptions no-rtti$" \
  build/consumer/by_pkg_config.txt

# shellcheck disable=SC2046
cc -std=c99 -pedantic -Wall -Wextra -Werror libsms/tests/c_pneumatics.c -o build/consumer/pneumatics \
  $(pkg-config --cflags --libs sms)
build/consumer/pneumatics

echo "-- each header alone, in C99 and C++14"
for header in build/prefix/include/sms/*.h; do
  [ "${header##*/}" != structs.h ] || continue # is included with what it makes
  printf '#include "sms/%s"\nint main(void) { return 0; }\n' "${header##*/}" >build/consumer/alone.c
  # shellcheck disable=SC2046  # the flags are words
  cc -std=c99 -pedantic -Wall -Wextra -Werror -fsyntax-only $(pkg-config --cflags sms) build/consumer/alone.c
  # shellcheck disable=SC2046
  c++ -std=c++14 -pedantic -Wall -Wextra -Werror -fsyntax-only -x c++ $(pkg-config --cflags sms) build/consumer/alone.c
done

echo "-- what the float archive calls"
archive=$(find build/prefix -name libsmsf.a)
nm --defined-only --format=posix "$archive" | awk 'NF > 1 { print $1 }' | sort -u >build/consumer/defined.txt
nm --undefined-only --format=posix "$archive" | awk 'NF > 1 { print $1 }' | sort -u >build/consumer/undefined.txt
sed 's/#.*//; s/[[:space:]]*$//; /^$/d' libsms/firmware_symbols.txt | sort -u >build/consumer/allowed.txt
calls=$(comm -23 build/consumer/undefined.txt build/consumer/defined.txt)
echo "$calls"
refused=$(echo "$calls" | comm -23 - build/consumer/allowed.txt)
if [ -n "$refused" ]; then
  printf 'libsmsf.a calls %s, which libsms/firmware_symbols.txt does not allow\n' "$(echo "$refused" | paste -sd ' ')" >&2
  exit 1
fi
