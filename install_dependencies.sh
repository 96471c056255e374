#!/usr/bin/env bash
# Installs the Debian packages that building, testing and documenting pcl_cosection needs. This is
# the only list of them. Does nothing, quickly, when all of them are there.
set -euo pipefail

packages=(
  # build
  cmake
  g++
  ninja-build
  ccache
  # library
  libpcl-dev
  libvtk9-dev
  libeigen3-dev
  libpng-dev
  libqhull-dev
  libopencv-dev
  libonnx-dev
  libprotobuf-dev
  libx11-dev
  # tools
  libcli11-dev
  nlohmann-json3-dev
  libjs-three
  # pcl_cosection_batch
  python3-distributed
  # training of the learned prior; python3-numpy also for pcl_cosection_batch
  python3-numpy
  python3-onnx
  python3-torch
  # tests, benchmarks, documentation
  libgtest-dev
  libbenchmark-dev
  libmujoco-dev
  liburdfdom-dev
  libsdformat-dev
  libbullet-dev
  chromium
  clang-format
  clang-tidy
  doxygen
  git
  mypy
  python3
  xvfb
  xdotool
)

if ! command -v dpkg-query > /dev/null; then
  echo "install_dependencies.sh: not a Debian system; nothing installed. Needed are, in Debian's names: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2> /dev/null || true)
  if [[ $state != installed* ]]; then
    missing+=("$package")
  fi
done
if [[ ${#missing[@]} -eq 0 ]]; then
  exit 0
fi

as_root=()
if [[ $EUID -ne 0 ]]; then
  if ! command -v sudo > /dev/null; then
    echo "install_dependencies.sh: please run as root: apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

apt_get ()
{
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --yes --quiet "$@"
}

echo "Installing ${missing[*]}"
# The lists of packages may be absent or out of date; fetch them only if installing fails.
if ! apt_get install --no-install-recommends "${missing[@]}"; then
  apt_get update
  apt_get install --no-install-recommends "${missing[@]}"
fi
