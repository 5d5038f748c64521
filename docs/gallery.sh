#!/usr/bin/env bash
# Draws every picture of the README and docs/ into docs/pictures.  ./run.sh gallery
cd "$(dirname "$0")/.."
set -eu
sgm=build/release/cli/sgm
mkdir -p docs/pictures

# draw NAME ARGUMENTS…: docs/pictures/NAME-mesh.png, the mesh at 256 cells, and NAME-field.png, the field itself.
draw() {
  local name=$1
  shift
  for view in mesh field; do
    "$sgm" render "$@" --view "$view" --size 640x640 -q -o "docs/pictures/$name-$view.png"
  done
  echo "docs/pictures/$name-{mesh,field}.png"
}

# inside NAME ARGUMENTS…: docs/pictures/NAME-inside.png, seen from within.
inside() {
  local name=$1
  shift
  "$sgm" render "$@" --camera inside --size 640x640 -q -o "docs/pictures/$name-inside.png"
  echo "docs/pictures/$name-inside.png"
}

draw grotto  examples/grotto.sgm --camera 16,44,52,-1,-3,-1
draw cumulus examples/cumulus.sgm --seed 8 --no-ground
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
draw plain     $clouds/plain.sgm --no-ground
draw humilis   $clouds/humilis.sgm --no-ground
draw mediocris $clouds/mediocris.sgm --no-ground --seed 6
draw congestus $clouds/congestus.sgm --no-ground --seed 9
draw bank      $clouds/bank.sgm --no-ground
draw ring      $clouds/ring.sgm --no-ground
draw ball      $clouds/ball.sgm --no-ground

for name in spire palace hall pagoda apartment cloister skyscraper twist terrace; do
  draw $name examples/buildings/$name.sgm
done
