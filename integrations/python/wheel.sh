#!/usr/bin/env bash
# Packs the built Python module into a wheel that needs numpy alone: it holds the library, what that links to, and the
# standard library of grammars.  integrations/python/wheel.sh BUILD_FOLDER FOLDER
set -eu
build=$(realpath "$1")
folder=$(realpath "$2")
here=$(cd "$(dirname "$0")" && pwd)
python=$(sed -n 's/^SGM_PYTHON:[A-Z]*=//p' "$build/CMakeCache.txt")
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:[A-Z]*=//p' "$build/CMakeCache.txt")
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT

DESTDIR="" cmake --install "$build" --component python --strip --prefix "$stage" >/dev/null
strip --strip-unneeded "$stage"/sgm/lib/*.so*
"$here/../bundle.sh" "$stage/sgm/lib" "$stage"/sgm/_sgm*.so "$stage"/sgm/lib/*.so*

glibc=$(getconf GNU_LIBC_VERSION | sed 's/.* //; s/\./_/')
tag=$("$python" -c 'import sys; v = "cp%d%d" % sys.version_info[:2]; print(v + "-" + v)')-manylinux_${glibc}_$(uname -m)
info=$stage/sgm-$version.dist-info
mkdir "$info"
cat >"$info/METADATA" <<END
Metadata-Version: 2.1
Name: sgm
Version: $version
Summary: Shape grammars and implicit surfaces: grammars become meshes, fields and level sets
License: GPL-3.0-or-later
Requires-Python: >=3.9
Requires-Dist: numpy>=1.19
Description-Content-Type: text/markdown

$(sed '1,/^$/d' "$here/../../docs/python.md")
END
cat >"$info/WHEEL" <<END
Wheel-Version: 1.0
Generator: sgm
Root-Is-Purelib: false
Tag: $tag
END
cp "$here/../../LICENSE" "$info"
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-946684800}  # equal files make equal wheels
"$python" -m wheel pack "$stage" -d "$folder" >/dev/null
echo "$folder/sgm-$version-$tag.whl"
