#!/usr/bin/env bash
# Installs the Debian package into a folder, uses what is there, and purges it: nothing is left. And unpacks the tarball.
#   deb_test.sh BUILD_FOLDER
set -euo pipefail
build=$(realpath "$1")
source=$(cd "$(dirname "$0")/../.." && pwd)
skip() { echo "$1"; exit 77; }
[ "$(id -u)" = 0 ] || skip "dpkg --root wants to be root"
for tool in dpkg-shlibdeps cpack patchelf; do command -v $tool >/dev/null || skip "$tool isn't installed (dpkg-dev, cmake, patchelf)"; done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$source"
integrations/package.sh "$work" deb
deb=$(ls "$work"/sgm_*.deb)
root=$work/root
mkdir -p "$root"/var/lib/dpkg/{info,updates,triggers}
touch "$root"/var/lib/dpkg/{status,available}
files() { find "$root" -not -path "$root/var/lib/dpkg*" -not -type d | sort; }

# Its dependencies are the system's own, which this root hasn't.
dpkg --root="$root" --force-depends --force-script-chrootless -i "$deb" >"$work/install.log" 2>&1 || { cat "$work/install.log"; exit 1; }
dpkg --root="$root" -s sgm | grep -q '^Status: install ok installed'
dpkg-deb -f "$deb" Depends | grep -q libopenvdb || { echo "the module for volumes has no dependencies"; exit 1; }
for file in bin/sgm bin/sgm-viewer lib/libsgm.so lib/sgm/sgm_volumes.so lib/cmake/sgm/sgmConfig.cmake include/sgm/grammar/pipeline/load.h \
    share/sgm/std/house.sgm share/sgm/examples/tower.sgm share/man/man1/sgm.1.gz share/man/man1/sgm-viewer.1.gz \
    share/bash-completion/completions/sgm share/zsh/vendor-completions/_sgm share/fish/vendor_completions.d/sgm.fish \
    share/applications/sgm-viewer.desktop share/mime/packages/sgm.xml share/icons/hicolor/scalable/apps/sgm.svg \
    share/icons/hicolor/scalable/mimetypes/text-x-sgm.svg share/doc/sgm/copyright; do
  test -e "$root/usr/$file" || { echo "no /usr/$file is installed"; exit 1; }
done

use() { # FOLDER: the programs below it work, far from the tree they were built in
  local sgm=$1/bin/sgm
  (cd "$work" && "$sgm" examples tower >/dev/null && "$sgm" build tower.sgm --resolution 32 -q -o tower.glb -o tower.vdb -o tower.html)
  test -s "$work/tower.vdb"
  "$1/bin/sgm-viewer" --version >/dev/null
  rm "$work"/tower.*
}
use "$root/usr"
LC_ALL=C man -l "$root/usr/share/man/man1/sgm.1.gz" 2>/dev/null | grep -q 'SGM BUILD' || zcat "$root/usr/share/man/man1/sgm.1.gz" | grep -q 'SGM BUILD'
# shellcheck source=/dev/null
(. "$root/usr/share/bash-completion/completions/sgm" && COMP_WORDS=(sgm bui) COMP_CWORD=1 && _sgm && [ "${COMPREPLY[*]}" = build ])
if command -v update-mime-database >/dev/null; then
  XDG_DATA_DIRS=$root/usr/share update-mime-database "$root/usr/share/mime"
  grep -q 'text/x-sgm:\*.sgm' "$root/usr/share/mime/globs"
  find "$root/usr/share/mime" -mindepth 1 -maxdepth 1 -not -name packages -exec rm -r {} +
fi
echo "installed: $(files | wc -l) files; sgm, its volumes, completions and manual work"
dpkg --root="$root" --force-script-chrootless -P sgm >"$work/purge.log" 2>&1 || { cat "$work/purge.log"; exit 1; }
[ -z "$(files)" ] || { echo "left after purging:"; files; exit 1; }
echo "purged: nothing is left"

integrations/package.sh "$work" tarball
tar -C "$work" -xzf "$work"/sgm-*-linux-*.tar.gz
folder=$(ls -d "$work"/sgm-*-linux-*/)
# What is loaded lies in the folder, but for the C and C++ runtime and what belongs to the display.
for file in "$folder"bin/* "$folder"lib/sgm/*.so; do
  ldd "$file" | sed -n 's/.* => \(\/\S*\) .*/\1/p' |
    grep -vE "^$work/|/(libc|libm|libdl|libpthread|librt|libresolv|libstdc\+\+|libgcc_s|libEGL|libGL[A-Za-z]*|libX[A-Za-z0-9]*|libxcb[a-z-]*|libbsd|libmd|ld-linux[^/]*)\.so" &&
    { echo "$file loads these from outside the tarball"; exit 1; }
done
mv "$folder" "$work/moved"
use "$work/moved"
echo "tarball: runs from any folder"
