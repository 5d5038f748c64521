#!/usr/bin/env bash
# Writes what other programs install into a folder: the Blender add-on as a zip and, where npm is there to fetch what it
# needs, the VS Code extension.
#   integrations/package.sh [FOLDER] [blender|vscode]      (out, both)
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
case ${2:-} in
  blender) addon ;;
  vscode) extension ;;
  *)
    addon
    if command -v npm >/dev/null; then extension; else echo "npm isn't installed: no VS Code extension is packed" >&2; fi ;;
esac
