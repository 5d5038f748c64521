#!/usr/bin/env bash
# Draws every picture of the README and docs/ into docs/pictures.  ./run.sh gallery
cd "$(dirname "$0")/.."
set -eu
sgm=build/release/cli/sgm
mkdir -p docs/pictures

# both VIEW NAME ARGUMENTS…: docs/pictures/NAME-mesh.png, the mesh at 256 cells, and NAME-VIEW.png.
both() {
  local render=$1 name=$2
  shift 2
  for view in mesh "$render"; do
    "$sgm" render "$@" --view "$view" --size 640x640 -q -o "docs/pictures/$name-$view.png"
  done
  echo "docs/pictures/$name-{mesh,$render}.png"
}

# draw NAME ARGUMENTS…: with NAME-field.png, the field itself.
draw() { both field "$@"; }

# cloud NAME CAMERA ARGUMENTS…: with NAME-fog.png, from below and with the sun aside.
cloud() {
  local name=$1 camera=$2
  shift 2
  both fog "$name" "$@" --no-ground --camera "$camera"
}

# inside NAME ARGUMENTS…: docs/pictures/NAME-inside.png, seen from within.
inside() {
  local name=$1
  shift
  "$sgm" render "$@" --camera inside --size 640x640 -q -o "docs/pictures/$name-inside.png"
  echo "docs/pictures/$name-inside.png"
}

draw grotto  examples/grotto.sgm --camera 16,44,52,-1,-3,-1
cloud cumulus 1479,23,-115,-54,203,66 examples/cumulus.sgm --seed 8
draw tower   examples/tower.sgm
draw figure1 examples/figure1.sgm
draw joints  examples/joints.sgm
inside grotto examples/grotto.sgm --set cut=5m

caves=examples/caves
draw regular   $caves/regular.sgm --camera 15,28,27,0,-2,0
draw irregular $caves/irregular.sgm --seed 3 --camera 26,14,56,2,-2,0
draw branching $caves/branching.sgm --camera 24,50,44,0,-2,1
draw halls     $caves/halls.sgm --camera 24,58,50,0,-2,1
draw dripstone $caves/dripstone.sgm --camera 10,6,66,1,-1,0
draw mine      $caves/mine.sgm --camera 40,62,56,2,-4,2
inside regular   $caves/regular.sgm --set open=none
inside irregular $caves/irregular.sgm --seed 3 --set open=none
inside branching $caves/branching.sgm --set open=none
inside halls     $caves/halls.sgm --set open=none
inside dripstone $caves/dripstone.sgm --set open=none
inside mine      $caves/mine.sgm --set open=none

clouds=examples/clouds
cloud plain     1152,-30,-142,-17,107,-4 $clouds/plain.sgm
cloud humilis   1269,-55,-109,-21,97,43 $clouds/humilis.sgm
cloud mediocris 1687,209,-250,-122,422,-37 $clouds/mediocris.sgm --seed 6
cloud congestus 4782,895,-617,-58,1465,-47 $clouds/congestus.sgm --seed 9
cloud bank      1330,-150,2020,-123,131,89 $clouds/bank.sgm
cloud ring      1605,-707,-198,3,-6,2 $clouds/ring.sgm
cloud ball      1371,-169,-154,-10,-7,8 $clouds/ball.sgm

for name in spire palace hall pagoda apartment cloister skyscraper twist terrace; do
  draw $name examples/buildings/$name.sgm
done
