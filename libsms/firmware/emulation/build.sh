#!/bin/sh
# Builds the float archive for a Cortex-M4F and count.c for it and for this host: build.sh FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
libsms=$(cd "$here/../.." && pwd)
out=$1
mkdir -p "$out"

target="-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16"
eigen=${EIGEN_INCLUDE:-/usr/include/eigen3}
core="-std=c++14 -O3 -DNDEBUG -DSMS_FLOAT_ONLY -DEIGEN_DONT_VECTORIZE -DEIGEN_MAX_ALIGN_BYTES=0 -DEIGEN_NO_IO
  -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-use-cxa-atexit -fno-math-errno -ffp-contract=off
  -ffunction-sections -fdata-sections -Wall -Wextra -Wdouble-promotion -Werror
  -I$libsms/include -I$libsms/src -isystem $eigen"
c="-std=c99 -O2 -ffp-contract=off -I$libsms/include"

# shellcheck disable=SC2086  # lists of words
for source in info mechanism_float plant_float; do
  arm-none-eabi-g++ $target $core -fstack-usage -c "$libsms/src/$source.cpp" -o "$out/$source.arm.o"
  g++ $core -c "$libsms/src/$source.cpp" -o "$out/$source.host.o"
done
rm -f "$out/libsmsf.arm.a"
arm-none-eabi-ar rcs "$out/libsmsf.arm.a" "$out/info.arm.o" "$out/mechanism_float.arm.o" "$out/plant_float.arm.o"

# shellcheck disable=SC2086
{
  arm-none-eabi-gcc $target -O2 -c "$here/startup.c" -o "$out/startup.o"
  arm-none-eabi-gcc $target $c -c "$here/count.c" -o "$out/count.arm.o"
  arm-none-eabi-gcc $target --specs=rdimon.specs -nostartfiles -T "$here/mps2.ld" -Wl,--gc-sections \
    -Wl,--no-warn-rwx-segments "$(arm-none-eabi-gcc $target -print-file-name=rdimon-crt0.o)" \
    "$out/startup.o" "$out/count.arm.o" "$out/libsmsf.arm.a" -lm -Wl,-Map="$out/count.map" -o "$out/count.elf"
  gcc $c "$here/count.c" "$out/info.host.o" "$out/mechanism_float.host.o" "$out/plant_float.host.o" -lm -o "$out/count.host"
}
