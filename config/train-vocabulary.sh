#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# Makes vocabulary.glv, the vocabulary that is built in, anew: from simulated worlds of every kind
# that has texture, with 64 and 128 beams. The same bytes each time.
# Usage: config/train-vocabulary.sh build/glint   (3 GB in TMPDIR, some minutes)
set -eu
glint=$(realpath "${1:?usage: config/train-vocabulary.sh build/glint}")
cd "$(dirname "$0")"
captures=$(mktemp -d)
trap 'rm -rf "$captures"' EXIT

for world in building campus corridor floors hill parking room stairs street; do
  for seed in 31 32; do
    beams=$([ $seed = 31 ] && echo 64 || echo 128)
    "$glint" simulate --world $world --seed $seed --beams "$beams" --seconds 10 --rest 0 \
      --out "$captures/$world-$seed"
  done
done
"$glint" train-vocabulary "$captures"/*/capture.pcap --every 4 --out vocabulary.glv
