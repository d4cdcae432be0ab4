#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# Writes glint.toml and the presets anew from the table of keys in daemon/config.cpp.
# Usage: config/regenerate.sh build/glintd
set -eu
glintd=$(realpath "${1:?usage: config/regenerate.sh build/glintd}")
cd "$(dirname "$0")"

{
  echo "# Glint configuration. Every key stands here with its default; a key may be left out."
  echo "# glintd --print-config prints the effective values, glintd --check-config checks a change."
  echo
  "$glintd" --config /dev/null --print-config
} > glint.toml

for preset in paper full; do
  {
    echo "# Preset $preset: the values of its slam keys, for --config or for copying into glint.toml."
    echo
    "$glintd" --config /dev/null --set "slam.preset=$preset" --print-config |
      sed -n '/^\[slam\]/,/^$/{/^$/d;p}'
  } > "$preset.toml"
done
