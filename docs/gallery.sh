#!/usr/bin/env bash
# Draws every picture of the README and docs/ into docs/pictures.  ./run.sh gallery
cd "$(dirname "$0")/.."
set -eu
sgm=build/release/cli/sgm
mkdir -p docs/pictures
for name in grotto cumulus tower figure1 joints; do
  for view in field mesh; do
    "$sgm" render "examples/$name.sgm" --view "$view" --size 640x640 -q -o "docs/pictures/$name-$view.png"
  done
  echo "docs/pictures/$name-{field,mesh}.png"
done
"$sgm" render examples/grotto.sgm --set cut=5m --camera inside --size 640x640 -q -o docs/pictures/grotto-inside.png
echo "docs/pictures/grotto-inside.png"
