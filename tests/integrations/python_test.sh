#!/usr/bin/env bash
# Packs the Python module into a wheel, installs that into a fresh virtual environment, and runs its tests and its notebook there.
#   python_test.sh BUILD_FOLDER         the tests
#   python_test.sh BUILD_FOLDER bench   what the module costs over the library
set -euo pipefail
build=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
skip() { echo "$1"; exit 77; }
ls "$build"/integrations/python/sgm/_sgm*.so >/dev/null 2>&1 || skip "no Python module was built: pybind11-dev isn't installed"
command -v patchelf >/dev/null || skip "patchelf isn't installed"
python=$(sed -n 's/^SGM_PYTHON:[A-Z]*=//p' "$build/CMakeCache.txt")
"$python" -c 'import ensurepip, numpy, wheel' 2>/dev/null || skip "$python lacks numpy, wheel or venv (python3-numpy python3-wheel python3-venv)"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$here/../../integrations/python/wheel.sh" "$build" "$work"
"$python" -m venv --system-site-packages "$work/fresh"  # numpy is the system's
"$work/fresh/bin/pip" install -q --no-index --no-deps "$work"/*.whl
cd "$work"
export PYTHONPATH=
if [ "${2:-}" = bench ]; then
  fresh/bin/python "$here/python_bench.py" "$here/../../examples"
  exit
fi
fresh/bin/python "$here/python_test.py" "$here/../../examples"
# What the module loads lies within it, but for what every system has.
ldd fresh/lib/python3*/site-packages/sgm/lib/*.so* | sed -n 's/.* => \(\/\S*\) .*/\1/p' | sort -u |
  grep -vE "^$work/|/(libc|libm|libdl|libpthread|librt|libstdc\+\+|libgcc_s|libresolv|ld-linux[^/]*)\.so" && { echo "is loaded from outside the wheel"; exit 1; }
if fresh/bin/python -c 'import mypy' 2>/dev/null; then
  # What the stubs say is what the module has; and the package's own annotations hold.
  printf '%s\n' 'sgm\._sgm\.[A-Z]\w*' 'sgm\._sgm\.\w+\.__init__' >unlike  # pybind11's metaclass, and classes without constructor
  fresh/bin/python -m mypy.stubtest sgm._sgm --ignore-missing-stub --ignore-unused-allowlist --allowlist unlike
  fresh/bin/python -m mypy --no-error-summary -p sgm
else
  echo "mypy isn't installed: the types weren't checked"
fi
