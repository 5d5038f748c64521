# Shared by run.sh and test.sh: installs what is missing and builds a preset (Release). Sourced, from the repo root.
set -eu

packages="g++ cmake ninja-build ccache pkg-config
  libopenvdb-dev libboost-iostreams-dev libopenmesh-dev libcgal-dev libpolyclipping-dev libtbb-dev libxsimd-dev libfmt-dev
  nlohmann-json3-dev libsimdjson-dev libtinygltf-dev libstb-dev libmeshoptimizer-dev libdraco-dev libcli11-dev libcpp-httplib-dev libpng-dev libjpeg62-turbo-dev libtiff-dev zlib1g-dev libopenexr-dev libepoxy-dev libegl-dev libglfw3-dev libimgui-dev libfreetype-dev fonts-roboto-unhinted fonts-hack-ttf libegl1 libgl1-mesa-dri
  libgtest-dev libgmock-dev glslang-tools universal-ctags xvfb xdotool libopenvdb-tools
  pybind11-dev python3-numpy python3-venv python3-wheel patchelf"

install_missing() {
  missing=""
  for p in $packages; do
    dpkg-query -W -f '${db:Status-Status}' "$p" 2>/dev/null | grep -qx installed || missing="$missing $p"
  done
  [ -n "$missing" ] || return 0
  as_root=""
  [ "$(id -u)" = 0 ] || as_root=sudo
  echo "Installing:$missing"
  $as_root apt-get update -q >/dev/null
  # shellcheck disable=SC2086
  DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -q --no-install-recommends $missing >build/apt.log 2>&1 ||
    { tail -n 20 build/apt.log; echo "Installing failed: see build/apt.log" >&2; exit 1; }
}

# build TARGET…: configures $PRESET once, for a short first build, then builds; quiet unless something is to be done or fails.
PRESET="${PRESET:-release}"
build() {
  [ -f "build/$PRESET/build.ninja" ] || cmake --preset "$PRESET" -DSGM_UNITY=ON >"build/configure-$PRESET.log" 2>&1 ||
    { tail -n 30 "build/configure-$PRESET.log"; exit 1; }
  ninja -C "build/$PRESET" -n "$@" | grep -q 'no work to do' && return 0
  echo "Building (a first build takes some minutes)…"
  ninja -C "build/$PRESET" -j "${JOBS:-2}" "$@" >"build/build-$PRESET.log" 2>&1 ||
    { grep -A 12 -m 5 'FAILED\|error' "build/build-$PRESET.log"; exit 1; }
}

# npm's manifold-3d, the judge of `bench --meshes`, where npm is there to fetch it; bench says so where it isn't.
install_judge() {
  [ ! -d build/node_modules/manifold-3d ] && command -v npm >/dev/null || return 0
  npm install --prefix build --no-audit --no-fund --omit=optional manifold-3d@3.5.4 >build/npm.log 2>&1 || tail -n 5 build/npm.log >&2
}

mkdir -p build
install_missing
