#!/usr/bin/env bash
# Copies the shared libraries that programs and modules need into a folder, and lets both find them there, wherever the whole
# is moved. Left out is what every system has and what belongs to its display: the C and C++ runtime, OpenGL, X11. Wants patchelf.
#   integrations/bundle.sh FOLDER FILE…
set -eu
folder=$(realpath "$1")
shift
command -v patchelf >/dev/null || { echo "patchelf isn't installed (apt-get install patchelf)" >&2; exit 1; }
theirs='^(ld-linux.*|linux-vdso|libc|libm|libdl|libpthread|librt|libresolv|libutil|libstdc\+\+|libgcc_s|libGL|libGLX|libGLdispatch|libOpenGL|libEGL|libX[A-Za-z0-9]*|libxcb.*|libX11-xcb|libbsd|libmd)\.so'

# Names and places of what a file needs, itself and through others.
needed() { LD_LIBRARY_PATH=$folder ldd "$1" | sed -n 's/^\s*\(\S*\) => \(\/\S*\) .*/\1 \2/p'; }

for file in "$@"; do
  while read -r name from; do
    [[ $name =~ $theirs ]] || [ -e "$folder/$name" ] || cp -L "$from" "$folder/$name"
  done < <(needed "$file")
done
for library in "$folder"/*.so*; do
  chmod 755 "$library"
  patchelf --set-rpath '$ORIGIN' "$library"
done
for file in "$@"; do
  [ "$(dirname "$(realpath "$file")")" = "$folder" ] ||
    patchelf --set-rpath "\$ORIGIN/$(realpath --relative-to="$(dirname "$file")" "$folder")" "$file"
done
