#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds Release, and runs sgm.
#   ./run.sh                      models examples/grotto.sgm into out/ and says where the results are
#   ./run.sh ARGUMENTS…           runs `sgm ARGUMENTS…`, e.g. ./run.sh build examples/tower.sgm -o tower.glb
#   ./run.sh bench [ARGUMENTS…]   measures field → mesh beside a dense sweep, OpenVDB and the machine (docs/performance.md)
#   ./run.sh view FILE            opens the window about a grammar
#   ./run.sh gallery [NAME…]      draws the pictures of docs/ and README, and measures the times on the gallery's page
#   ./run.sh package [FOLDER] [WHAT]   writes what other programs install, as the Blender add-on's zip, into out/
#   ./run.sh site [FOLDER]        makes a site of docs/ with search in out/site (it wants mkdocs)
#   ./run.sh fuzz [TIME] [TARGET…]  runs the fuzz targets of tests/fuzz/run.sh (10m each) and counts what they have had
cd "$(dirname "$0")"
PRESET=release
. cmake/setup.sh
case "${1:-}" in
  bench)
    build bench && shift
    case " $* " in *" --meshes "*) install_judge ;; esac
    exec build/release/tests/bench/bench "$@" ;;
  fuzz) shift && exec tests/fuzz/run.sh "$@" ;;
  package) shift && exec integrations/package.sh "$@" ;;
  site) shift && exec integrations/site/build.py "$@" ;;
  view) build sgm sgm-viewer sgm_volumes ;;
  gallery) build sgm sgm-viewer sgm_volumes bench && shift && exec docs/gallery.sh "$@" ;;
esac
sgm=build/release/cli/sgm
if [ $# -gt 0 ]; then
  build sgm sgm_volumes
  exec "$sgm" "$@"
fi
# The mesh and the picture first: what writes volumes takes a minute more to build.
build sgm
mkdir -p out
"$sgm" build examples/grotto.sgm -o out/grotto.glb --report out/grotto.json
"$sgm" render examples/grotto.sgm -o out/grotto.png
build sgm_volumes
"$sgm" build examples/grotto.sgm -o out/grotto.vdb
echo
echo "A mesh:    out/grotto.glb   (drop it into Blender, Houdini, Unreal or Godot)"
echo "A volume:  out/grotto.vdb"
echo "A picture: out/grotto.png"
echo "Figures:   out/grotto.json"
echo "Edit examples/grotto.sgm and run this again; ./run.sh --help shows the commands."
