#!/bin/sh
# SPDX-License-Identifier: MIT
# Installs what is built into a folder of its own, moves that (nothing installed may name where it was built or put), and
# builds the examples against it, by find_package and by pkg-config; runs them.
#   installed_examples.sh SOURCE BUILD
set -eu
source=$1 build=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cmake --install "$build" --prefix "$scratch/first" >/dev/null
mv "$scratch/first" "$scratch/usr"
named=$(grep -rlF -e "$build" -e "$scratch/first" "$scratch/usr" || true)
if [ -n "$named" ]; then
  echo "installed files name the build tree or the first prefix: $named"
  exit 1
fi

cmake -G Ninja -S "$source/examples/library" -B "$scratch/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$scratch/usr" >/dev/null
cmake --build "$scratch/build" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
ctest --test-dir "$scratch/build" --output-on-failure

# The suite of experiments, as tests of CTest and, where there is pytest, of that.
suite=$scratch/usr/share/mixloop/examples/suite
cmake -G Ninja -S "$suite" -B "$scratch/suite" -DCMAKE_PREFIX_PATH="$scratch/usr" >/dev/null
ctest --test-dir "$scratch/suite" --output-on-failure
if python3 -c 'import pytest' 2>/dev/null; then
  MIXLOOP=$scratch/usr/bin/mixloop python3 -m pytest -q -p no:cacheprovider "$suite"
fi

PKG_CONFIG_PATH=$(dirname "$(find "$scratch/usr" -name mixloop.pc)")
export PKG_CONFIG_PATH
c++ -o "$scratch/by_pkg_config" "$source/examples/library/1_mass_matrix.cpp" $(pkg-config --cflags --libs mixloop)
LD_LIBRARY_PATH=$(pkg-config --variable=libdir mixloop) "$scratch/by_pkg_config"

echo '#include <mixloop/mixloop.hpp>' >"$scratch/header.cpp"
start=$(date +%s%N)
c++ $(pkg-config --cflags mixloop) -c -o "$scratch/header.o" "$scratch/header.cpp"
echo "mixloop/mixloop.hpp compiles in $((($(date +%s%N) - start) / 1000000)) ms"
