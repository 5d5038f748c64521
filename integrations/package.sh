#!/usr/bin/env bash
# Writes what is installed elsewhere into a folder, each where what makes it is there: the Blender add-on and Godot's importer as
# zips, the VS Code extension (npm), the Python module as a wheel (pybind11-dev, patchelf), the Debian package (dpkg-dev) and a
# tarball of programs that runs wherever it is unpacked (patchelf).
#   integrations/package.sh [FOLDER] [blender|godot|vscode|python|deb|tarball]      (out, all)
set -eu
cd "$(dirname "$0")/.."
folder=$(realpath -m "${1:-out}")
mkdir -p "$folder"

# archive NAME FOLDER FILES…: a zip with the files of FOLDER in the order of their names.
archive() {
  local name=$1 from=$2
  shift 2
  rm -f "$folder/$name"
  (cd "$from" && cmake -E tar cf "$folder/$name" --format=zip --mtime="2000-01-01 00:00:00" "$@")
  echo "$folder/$name"
}

addon() {
  # shellcheck disable=SC2046  # names without blanks
  archive sgm_blender.zip integrations/blender $(cd integrations/blender && find sgm_blender -name '*.py' | LC_ALL=C sort)
}

# The extension with its one library, as VS Code's installer wants it.
extension() {
  local stage
  stage=$(mktemp -d)
  trap 'rm -rf "$stage"' RETURN
  mkdir "$stage/extension"
  (cd integrations/vscode && cp -r package.json package-lock.json language-configuration.json README.md ./*.js preview.html syntaxes "$stage/extension")
  cp LICENSE "$stage/extension/LICENSE.txt"
  npm ci --prefix "$stage/extension" --omit=dev --no-audit --no-fund --silent >/dev/null
  rm -rf "$stage/extension/package-lock.json" "$stage/extension/node_modules/.package-lock.json" "$stage/extension/node_modules/.bin"
  cp integrations/vscode/vsix/*.xml "$stage"
  cp integrations/vscode/vsix/extension.vsixmanifest "$stage"
  (cd "$stage" && find . -type f | LC_ALL=C sort | sed 's,^./,,') >"$stage.files"
  # shellcheck disable=SC2046
  archive sgm-language.vsix "$stage" --files-from="$stage.files"
  rm "$stage.files"
}

importer() {
  # shellcheck disable=SC2046
  archive sgm_godot.zip integrations/godot $(cd integrations/godot && find addons -type f | LC_ALL=C sort)
}

# built TARGET…: brings the release build up to date.
built() {
  # shellcheck source=cmake/setup.sh
  (. cmake/setup.sh && build "$@")
}

wheel() {
  built sgm_python sgm_shared sgm_volumes
  integrations/python/wheel.sh build/release "$folder"
}

programs="sgm sgm-viewer sgm_shared sgm_volumes desktop"

deb() {
  # shellcheck disable=SC2086
  built $programs
  local stage
  stage=$(mktemp -d)
  trap 'rm -rf "$stage"' RETURN
  (cd build/release && cpack -G DEB -B "$stage" >"$stage.log" 2>&1) || { cat "$stage.log" >&2; return 1; }
  rm "$stage.log"
  mv "$stage"/*.deb "$folder"
  ls "$folder"/sgm_*.deb
}

tarball() {
  # shellcheck disable=SC2086
  built $programs
  local stage name
  stage=$(mktemp -d)
  trap 'rm -rf "$stage"' RETURN
  name=sgm-$(sed -n 's/^CMAKE_PROJECT_VERSION:[A-Z]*=//p' build/release/CMakeCache.txt)-linux-$(uname -m)
  DESTDIR='' cmake --install build/release --strip --prefix "$stage/$name" >/dev/null
  integrations/bundle.sh "$stage/$name/lib" "$stage/$name"/bin/* "$stage/$name"/lib/libsgm.so "$stage/$name"/lib/sgm/*.so
  cp README.md LICENSE "$stage/$name"
  tar -C "$stage" --sort=name --owner=0 --group=0 --numeric-owner --mtime=2000-01-01 -czf "$folder/$name.tar.gz" "$name"
  echo "$folder/$name.tar.gz"
}

# may COMMAND PACKAGE KIND: whether what makes a kind is there; says so where it isn't.
may() {
  command -v "$1" >/dev/null && return 0
  echo "$2 isn't installed: no $3 is packed" >&2
  return 1
}

case ${2:-} in
  blender) addon ;;
  godot) importer ;;
  vscode) extension ;;
  python) wheel ;;
  deb) deb ;;
  tarball) tarball ;;
  '')
    addon
    importer
    if may npm npm "VS Code extension"; then extension; fi
    if may pybind11-config pybind11-dev "Python wheel" && may patchelf patchelf "Python wheel"; then wheel; fi
    if may dpkg-shlibdeps dpkg-dev "Debian package"; then deb; fi
    if may patchelf patchelf tarball; then tarball; fi ;;
  *)
    echo "there is no package '$2'; there are blender godot vscode python deb tarball" >&2
    exit 2 ;;
esac
