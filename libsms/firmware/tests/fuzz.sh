#!/bin/sh
# Frames and characters under libFuzzer with the sanitizers: fuzz.sh FOLDER SECONDS. The corpus beside this file is where
# it starts; what it finds anew stays in FOLDER/corpus. `fuzz.sh FOLDER keep` then puts the least of both that reaches
# the same code into corpus/found, which fuzz_corpus.cpp runs in every test.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
firmware=$(cd "$here/.." && pwd)
libsms=$(cd "$firmware/.." && pwd)
out=$1 seconds=$2
mkdir -p "$out/corpus"
objects=
flags="-O1 -g -fno-math-errno -ffp-contract=off -I$firmware -I$libsms/include -isystem ${EIGEN_INCLUDE:-/usr/include/eigen3}"
sanitizers="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all"
for source in "$firmware"/*.cpp "$here"/fuzz_application.cpp; do
  [ "$source" != "$firmware/main.cpp" ] || continue
  object=$out/$(basename "$source" .cpp).o
  # shellcheck disable=SC2086  # lists of words
  clang++ -std=c++17 $flags $sanitizers -c "$source" -o "$object"
  objects="$objects $object"
done
# shellcheck disable=SC2086
clang++ -fsanitize=fuzzer,address,undefined $objects -o "$out/fuzz_application"
cd "$out"
if [ "$seconds" = keep ]; then
  rm -rf kept && mkdir kept
  ./fuzz_application -merge=1 -use_counters=0 -max_len=2048 kept "$here/corpus" corpus
  rm -rf "$here/corpus/found" && mv kept "$here/corpus/found"
  exit 0
fi
./fuzz_application -max_total_time="$seconds" -max_len=2048 -print_final_stats=1 corpus "$here/corpus"
