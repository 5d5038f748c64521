#!/usr/bin/env bash
# Fractals meshed at 256 cells by Mandelbulber2 (apt-get install mandelbulber2) and by sgm: CPU-seconds of the whole program,
# triangles, bytes a triangle. Prints the table of docs/lab/fractals.md.
cd "$(dirname "$0")/../.."
set -eu
command -v mandelbulber2 >/dev/null || { echo "mandelbulber.sh: apt-get install mandelbulber2" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sgm=$PWD/build/release/cli/sgm

# settings NAME FORMULA HALF-SIZE, more settings on stdin: the file Mandelbulber2 reads.
settings() {
  cat >"$work/$1.fract" - <<END
# Mandelbulber settings file
# version 2.20
# only modified parameters
[main_parameters]
formula_1 $2;
mesh_color false;
mesh_file_mode 1;
mesh_output_filename $work/$1.ply;
voxel_custom_limit_enabled true;
voxel_limit_min -$3 -$3 -$3;
voxel_limit_max $3 $3 $3;
voxel_samples_x 256;
voxel_samples_y 256;
voxel_samples_z 256;
[fractal_1]
END
  cat >>"$work/$1.fract"
}

# measured NAME FILE COMMAND…: a row; of three runs the least time, for noise only adds.
measured() {
  local name=$1 file=$2 seconds triangles
  shift 2
  TIMEFORMAT='%U %S'
  seconds=$(for _ in 1 2 3; do { time "$@" >"$work/log" 2>&1; } 2>&1; done | awk '{ print $1 + $2 }' | sort -n | awk 'NR == 1 { printf "%.2f", $1 }')
  triangles=$(head -c 2000 "$file" | grep -a '^element face' | cut -d' ' -f3)
  echo "| $name | $seconds | $triangles | $((($(stat -c %s "$file") + triangles - 1) / triangles)) |"
}

settings sponge 7 1.01 </dev/null
settings kifs 10 2.1 <<'END'
IFS_abs_x true;
IFS_abs_y true;
IFS_abs_z true;
IFS_direction_5 0.7071067811865476 -0.7071067811865476 0;
IFS_direction_6 0.7071067811865476 0 -0.7071067811865476;
IFS_direction_7 0 0.7071067811865476 -0.7071067811865476;
IFS_enabled_5 true;
IFS_enabled_6 true;
IFS_enabled_7 true;
IFS_menger_sponge_mode true;
IFS_offset 2 2 1;
IFS_scale 3;
END

echo "| at 256 | CPU-seconds | triangles | bytes a triangle |"
echo "|---|---|---|---|"
measured "Mandelbulber2, Menger sponge" "$work/sponge.ply" mandelbulber2 -n -C -V ply "$work/sponge.fract"
measured "Mandelbulber2, KIFS with the sponge's numbers" "$work/kifs.ply" mandelbulber2 -n -C -V ply "$work/kifs.fract"
ours() { measured "$1" "$work/ours.ply" "$sgm" build "${@:2}" --resolution 256 --format-option attributes=none -q -o "$work/ours.ply"; }
ours "sgm, Menger sponge" examples/kifs/figures.sgm --start Menger --set passes=4
while read -r name; do
  printf 'grammar 1\nuse "std/kifs.sgm"\nstart Test -> Box size (16, 12, 12) clad %s\n' "$name" >"$work/test.sgm"
  ours "sgm, $name" "$work/test.sgm" --keep grounded
done < <(sed -n 's/^terminal \([a-z]*\) = ornament.*/\1/p' grammar/std/kifs.sgm)
