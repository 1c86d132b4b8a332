#!/bin/sh
# The application for a Cortex-M4F (image, emulated board, counting program) and for a 32-bit host: build_application.sh
# FOLDER. Runs after build.sh, whose objects it links.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
firmware=$(cd "$here/.." && pwd)
libsms=$(cd "$firmware/.." && pwd)
out=$1

target="-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16"
eigen=${EIGEN_INCLUDE:-/usr/include/eigen3}
bare="-DNDEBUG -DEIGEN_DONT_VECTORIZE -DEIGEN_MAX_ALIGN_BYTES=0 -DEIGEN_NO_IO -fno-exceptions -fno-rtti
  -fno-threadsafe-statics -fno-use-cxa-atexit -fno-math-errno -ffp-contract=off -ffunction-sections -fdata-sections"
strict="-Wall -Wextra -Wconversion -Wfloat-equal -Wshadow -Wdouble-promotion -Werror"
includes="-I$firmware -I$libsms/include -isystem $eigen"
sources=$(cd "$firmware" && for source in *.cpp; do echo "${source%.cpp}"; done | grep -vx main)

# shellcheck disable=SC2086  # lists of words, from here on
for source in $sources main; do
  optimise=-O2
  case $source in console | settings) optimise=-Os ;; esac
  ${CMAKE_CXX_COMPILER_LAUNCHER-} arm-none-eabi-g++ $target -std=c++14 $optimise $bare $strict $includes -fstack-usage -c "$firmware/$source.cpp" \
    -o "$out/$source.app.arm.o"
done
for source in board_memory board_lockstep count_application; do
  ${CMAKE_CXX_COMPILER_LAUNCHER-} arm-none-eabi-g++ $target -std=c++14 -O2 $bare $strict $includes -I"$here" -c "$here/$source.cpp" \
    -o "$out/$source.arm.o"
done

objects=
for source in $sources; do
  objects="$objects $out/$source.app.arm.o"
done
rm -f "$out/libsms_firmware.arm.a"
# shellcheck disable=SC2086
arm-none-eabi-ar rcs "$out/libsms_firmware.arm.a" $objects

# link NAME LIBRARY STARTUP OBJECT...
link() {
  name=$1 specs=$2 startup=$3
  shift 3
  arm-none-eabi-gcc $target --specs=$specs -nostartfiles -T "$here/mps2.ld" -Wl,--gc-sections \
    -Wl,--no-warn-rwx-segments $startup "$@" "$out/libsms_firmware.arm.a" "$out/libsmsf.arm.a" -lm \
    -Wl,-Map="$out/$name.map" -o "$out/$name.elf"
}
arm-none-eabi-gcc $target -O2 -c "$here/startup_bare.c" -o "$out/startup_bare.o"
crt0=$(arm-none-eabi-gcc $target -print-file-name=rdimon-crt0.o)
link count_application rdimon.specs "$crt0 $out/startup.o" "$out/count_application.arm.o"
link lockstep nano.specs "$out/startup_bare.o" "$out/main.app.arm.o" "$out/board_lockstep.arm.o"
link image nano.specs "$out/startup_bare.o" "$out/main.app.arm.o" "$out/board_memory.arm.o"
