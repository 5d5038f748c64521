#!/usr/bin/env bash
# Draws the pictures of the README and docs/ into docs/pictures, and measures what the gallery page says of times.
#   ./run.sh gallery            all of it
#   ./run.sh gallery NAME…      the pictures of these objects of docs/gallery.txt
#   ./run.sh gallery times      the times alone: on a calm machine
#   ./run.sh gallery window     the pictures of the window (apt-get install xvfb xdotool imagemagick)
#   ./run.sh gallery sheet      the tutorial's sheet of variations
#   ./run.sh gallery town       the plan, patterns and pictures of the town, for docs/town.md (apt-get install librsvg2-bin)
#   ./run.sh gallery addon      three towers and a cloud by the Blender add-on (apt-get install blender), for docs/blender.md
#   ./run.sh gallery blender    two models in Blender (apt-get install blender), for docs/programs.md
cd "$(dirname "$0")/.."
set -eu
sgm=build/release/cli/sgm
mkdir -p docs/pictures/footprints docs/pictures/tutorial docs/pictures/town
export drawn
drawn=$(mktemp -d)
trap 'rm -rf "$drawn"' EXIT

# keep PNG NAME SIZE: docs/pictures/NAME.jpg, at most SIZE pixels wide and high (apt-get install imagemagick).
keep() {
  /usr/bin/convert "$1" -resize "$3x$3>" -background white -flatten -sampling-factor 4:2:0 -quality 82 -strip "docs/pictures/$2.jpg"
  echo "docs/pictures/$2.jpg"
}

# draw NAME OPTIONS INSIDE RENDER: NAME-mesh.jpg, the mesh at 256 cells, NAME-RENDER.jpg, the field itself or a cloud as fog,
# and NAME-inside.jpg.
draw() {
  local name=$1 view
  for view in mesh "$4"; do
    # shellcheck disable=SC2086  # options are words
    "$sgm" render $2 --resolution 256 --view "$view" --size 640x640 -q -o "$drawn/a.png"
    keep "$drawn/a.png" "$name-$view" 600
  done
  if [ -n "$3" ]; then
    # shellcheck disable=SC2086,SC2001
    "$sgm" render $(sed 's/--camera [^ ]*//' <<<"$2") $3 --camera inside --size 640x640 -q -o "$drawn/a.png"
    keep "$drawn/a.png" "$name-inside" 600
  fi
}

# small NAME OPTIONS: NAME.jpg, of 320 pixels unless the options say otherwise
small() {
  local size="--size 320x320"
  case $2 in *--size*) size= ;; esac
  # shellcheck disable=SC2086
  "$sgm" render $2 $size -q -o "$drawn/a.png"
  keep "$drawn/a.png" "$1" 800
}

# grammar_after STEP: tower.sgm in the drawing folder, the grammar after that step of docs/tutorial.md
grammar_after() { awk -v step="$1" -f docs/tutorial.awk docs/tutorial.md >"$drawn/tower.sgm"; }

# step NAME OPTIONS: NAME.jpg, the model after the step of the tutorial that the options begin with
step() {
  grammar_after "${2%% *}"
  small "$1" "$drawn/tower.sgm --size 480x600 ${2#* }"
}

# The sheet of variations that the tutorial's tower has.
sheet() {
  "$sgm" mutate examples/tutorial.sgm --rows 2 --cols 4 --spread .6 --size 200x280 -q -o "$drawn/a.png"
  keep "$drawn/a.png" tutorial/9-sheet 800
}

# The last section of the page is what bench prints.
times() {
  local page=docs/gallery.md fresh
  fresh=$(mktemp)
  sed '/^## Field to mesh$/,$d' "$page" >"$fresh"
  build/release/tests/bench/bench --gallery docs/gallery.txt --threads 2 --repeats 5 >>"$fresh"
  cat "$fresh" >"$page"
  rm "$fresh"
  echo "$page"
}

blender() {
  local models
  models=$(mktemp -d)
  "$sgm" build examples/buildings/palace.sgm --resolution 256 -q -o "$models/palace.glb"
  "$sgm" build examples/cumulus.sgm --resolution 160 --format-option grids=fog --format-option edge=60 --format-option wisps=.6 -q -o "$models/cumulus.vdb"
  command blender -b --factory-startup --python docs/blender.py -- "$models"/palace.glb "$models"/cumulus.vdb "$drawn/a.png" >/dev/null
  rm -r "$models"
  keep "$drawn/a.png" blender 800
}

addon() {
  integrations/package.sh "$drawn" blender >/dev/null
  command blender -b --factory-startup --python docs/blender_addon.py -- "$drawn/sgm_blender.zip" "$sgm" "$drawn" >/dev/null
  keep "$drawn/a.png" blender-addon 800
}

# The town's plan, and its roads by other patterns.
town() {
  local pattern
  "$sgm" build examples/city/town.sgm -q -o "$drawn/a.svg"
  /usr/bin/convert -density 100 "$drawn/a.svg" "$drawn/a.png"
  keep "$drawn/a.png" town/plan 700
  for pattern in grown raster radial field; do
    "$sgm" build examples/city/town.sgm -q --set side=1200m --set pattern=$pattern -o "$drawn/a.svg"
    /usr/bin/convert -background white -density 60 "$drawn/a.svg" -resize 540x540 -gravity center -extent 540x540 "$drawn/$pattern.png"
  done
  montage "$drawn/grown.png" "$drawn/raster.png" "$drawn/radial.png" "$drawn/field.png" -tile 4x1 -geometry +0+0 "$drawn/a.png"
  keep "$drawn/a.png" town/patterns 800
  "$sgm" build examples/city/quarter.sgm -q -o "$drawn/a.svg"
  /usr/bin/convert -density 100 -background white "$drawn/a.svg" "$drawn/a.png"
  keep "$drawn/a.png" town/curves 500
  "$sgm" render examples/city/town.sgm --view mesh --cell 4 --object-cell .8 --size 1600x900 --camera "1150,620,1500,-150,-60,-150" -q -o "$drawn/a.png"
  keep "$drawn/a.png" town/town 800
  "$sgm" render examples/city/town.sgm --set side=1000 --view mesh --cell 1 --object-cell .25 --size 1400x900 --camera "330,180,330,-30,20,-30" -q -o "$drawn/a.png"
  keep "$drawn/a.png" town/centre 800
  "$sgm" render examples/city/hills.sgm --view mesh --cell 2.2 --object-cell .6 --size 1400x800 --camera "560,250,640,-60,-10,-80" -q -o "$drawn/a.png"
  keep "$drawn/a.png" town/hills 800
}

# shoot NAME FILE SIZE WORDS: NAME.jpg, the window about FILE on a display of its own after xdotool did what WORDS say.
shoot() {
  local report
  report=$(mktemp)
  LIBGL_ALWAYS_SOFTWARE=1 XDG_STATE_HOME=$report.state xvfb-run -a -s "-screen 0 $3x24" bash -c '
    set -eu
    settled() { until grep -q "\"drawn\": true" "$1" && grep -q "\"busy\": false" "$1"; do sleep 0.3; done; }
    build/release/cli/sgm-viewer "$2" --report "$1" &
    settled "$1"
    # shellcheck disable=SC2086  # words
    xdotool $3
    sleep 1
    settled "$1"
    sleep 1
    import -window root "$drawn/a.png"
    kill %1' _ "$report" "$2" "$4"
  rm -rf "$report" "$report.state"
  keep "$drawn/a.png" "$1" 800
}

# The window with a shape selected, and with the sliders of the tutorial's fifth step.
window() {
  shoot window examples/tower.sgm 1280x800 "mousemove 590 340 click 1 mousemove 1000 770"
  grammar_after 5
  shoot tutorial/5-sliders "$drawn/tower.sgm" 1280x800 "mousemove 968 56 click 1 mousemove 640 790"
}

case $* in times | window | sheet | town | blender | addon) "$*"; exit ;; esac
known=0
while IFS='|' read -r family name options inside; do
  name=${name// /}
  render=field
  case $family in "#"*) continue ;; cloud*) render=fog ;; esac
  case " $* " in "  " | *" $name "*) ;; *) continue ;; esac
  known=$((known + 1))
  case $family in kifs* | plan*) small "$name" "$options" ;; step*) step "$name" "${options# }" ;; *) draw "$name" "$options" "${inside:-}" "$render" ;; esac
done <docs/gallery.txt
[ $# -eq 0 ] && times
[ $# -eq 0 ] || [ $known -eq $# ] || { echo "gallery: not all of '$*' are in docs/gallery.txt" >&2; exit 2; }
