#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The same trajectory gives the same bytes from GCC and Clang, at -O0, -O2 and -O3 -march=native.
# Usage: same_bits.sh SOURCE_DIR FDCG_PROGRAM WORK_DIR
set -euo pipefail
source_dir=$1 fdcg=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
mesh=$source_dir/testdata/meshes/good/saddles.off
"$fdcg" compile "$mesh" -o "$work/f64.fdcg" -q
"$fdcg" compile "$mesh" -o "$work/f32.fdcg" --precision f32 -q

build() { # NAME CC CXX FLAGS...
  local name=$1 cc=$2 cxx=$3
  shift 3
  local objects=() source
  for source in "$source_dir"/runtime/src/*.cpp; do
    "$cxx" -std=c++20 -ffp-contract=off -fno-math-errno -fno-exceptions -fno-rtti "$@" -I"$source_dir/runtime/include" \
      -I"$source_dir/runtime/src" -c "$source" -o "$work/$name-$(basename "$source").o"
    objects+=("$work/$name-$(basename "$source").o")
  done
  "$cc" -std=c11 -Wall -Wextra -Wpedantic -Werror -ffp-contract=off "$@" -I"$source_dir/runtime/include" \
    "$source_dir/tests/contract/step_log.c" "${objects[@]}" -lm -o "$work/$name"
}

compilers=0
for pair in "gcc g++" "clang clang++"; do
  read -r cc cxx <<<"$pair"
  command -v "$cxx" >/dev/null || continue
  compilers=$((compilers + 1))
  for flags in "-O0" "-O2" "-O3 -march=native"; do
    name="$cc$(tr -d ' ' <<<"$flags")"
    # shellcheck disable=SC2086
    build "$name" "$cc" "$cxx" $flags
    for precision in f64 f32; do
      "$work/$name" "$work/$precision.fdcg" 60000 >"$work/$name.$precision.log"
      cmp "$work/gcc-O0.$precision.log" "$work/$name.$precision.log"
    done
    echo "$name: same bits"
  done
done
states=$(awk '{print $7}' "$work/gcc-O0.f64.log" | sort | uniq -c | tr '\n' ';')
echo "$compilers compilers agree; ticks by state: $states"
[ "$compilers" = 2 ] || { echo "clang++ is missing: only GCC was compared" >&2; exit 1; }
[ "$(awk '{print $7}' "$work/gcc-O0.f64.log" | sort -u | wc -l)" = 4 ]
