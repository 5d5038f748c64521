#!/usr/bin/env bash
# Bundles the page's script with three.js and 3d-tiles-renderer from npm.  bundle.sh WORK_FOLDER OUTPUT
# Where npm isn't there or can't fetch them, OUTPUT is a script that says so: sgm builds without.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$1 output=$2
mkdir -p "$work"
cp "$here"/package.json "$here"/package-lock.json "$here"/*.js "$work"
if command -v npm >/dev/null && (cd "$work" && npm ci --no-audit --no-fund >npm.log 2>&1) &&
    "$work/node_modules/esbuild/bin/esbuild" "$work/main.js" --bundle --minify --format=iife --target=es2022 \
      --legal-comments=eof --log-level=error --outfile="$output.part"; then
  {
    cat "$output.part"
    # What esbuild leaves of licences is a line; theirs ask for the whole.
    for package in three 3d-tiles-renderer; do
      printf '\n/* %s\n' "$package"
      sed 's|\*/|* /|g' "$work/node_modules/$package/LICENSE"
      printf '*/\n'
    done
  } >"$output"
else
  echo "The page of baked cities has no viewer: npm could not fetch its packages (see $work/npm.log)." >&2
  printf '%s\n' "document.getElementById('told').textContent = 'This sgm was built without npm, so its page has no viewer: build it where npm is installed.';" >"$output"
fi
rm -f "$output.part"
