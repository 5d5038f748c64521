#!/usr/bin/env bash
# Configures a build without OpenVDB, CGAL and the window in an empty folder, on a system that has none of their packages
# as far as CMake sees, and looks for their libraries in what would be built.  options_test.sh
set -euo pipefail
source=$(realpath "$(dirname "$0")/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

hidden='imgui|glfw3|freetype2'
cat >"$work/pkg-config" <<END
#!/bin/sh
for word; do case \$word in ${hidden//|/|}) echo "\$word is hidden" >&2; exit 1 ;; esac; done
exec $(command -v pkg-config) "\$@"
END
chmod +x "$work/pkg-config"
configure() {
  cmake -S "$source" -B "$work/$1" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPKG_CONFIG_EXECUTABLE="$work/pkg-config" \
    -DCMAKE_DISABLE_FIND_PACKAGE_{OpenVDB,CGAL,GMP,MPFR,TBB,X11}=ON "${@:2}" >"$work/$1.log" 2>&1
}
for option in SGM_OPENVDB SGM_CGAL SGM_WINDOW; do
  others=$(printf '%s\n' SGM_OPENVDB SGM_CGAL SGM_WINDOW | grep -v "$option" | sed 's/.*/-D&=OFF/')
  # shellcheck disable=SC2086
  if configure "$option" $others; then echo "$option: the package is hidden, yet it configures"; exit 1; fi
done
configure lean -DSGM_OPENVDB=OFF -DSGM_CGAL=OFF -DSGM_WINDOW=OFF || { tail -n 20 "$work/lean.log"; exit 1; }
if grep -E -m 5 'libopenvdb|libgmp|-lgmp|mpfr|libimgui|-limgui|glfw|freetype|libX11|libtbb' "$work/lean/build.ninja"; then
  echo "would be linked without need"
  exit 1
fi
echo "without OpenVDB, CGAL and the window: configured"
