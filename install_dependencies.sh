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
  # Python module, and pcl_cosection_batch
  pybind11-dev
  python3-dev
  python3-distributed
  python3-numpy
  python3-pip
  python3-setuptools
  python3-venv
  python3-wheel
  # training of the learned prior
  python3-onnx
  python3-torch
  # tests, benchmarks, documentation
  libgtest-dev
  libbenchmark-dev
  libmujoco-dev
  liburdfdom-dev
  libbullet-dev
  chromium
  clang-format
  clang-tidy
  doxygen
  git
  mypy
  python3
  python3-matplotlib
  python3-opencv
  xvfb
  xdotool
  # Debian packages, and their test
  dpkg-dev
  file
  lintian
  mmdebstrap
)
# Not in Debian 13. Tests that need them are left out there.
where_there_are=(
  libsdformat-dev
)

if ! command -v dpkg-query > /dev/null; then
  echo "install_dependencies.sh: not a Debian system; nothing installed. Needed are, in Debian's names: ${packages[*]}" >&2
  exit 0
fi

is_installed ()
{
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2> /dev/null || true) == installed* ]]
}

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
optional=()
for package in "${where_there_are[@]}"; do
  is_installed "$package" || optional+=("$package")
done
# Where only those are missing, and no list of packages has them, nothing can be done about it.
if [[ ${#missing[@]} -eq 0 ]] && ! apt-cache show "${optional[@]}" > /dev/null 2>&1; then
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

# install_missing: the packages that are missing, and those of the optional ones that there are.
install_missing ()
{
  local package wanted=("${missing[@]}")
  for package in "${optional[@]}"; do
    if apt-cache show "$package" > /dev/null 2>&1; then
      wanted+=("$package")
    fi
  done
  echo "Installing ${wanted[*]}"
  apt_get install --no-install-recommends "${wanted[@]}"
}

# The lists of packages may be absent or out of date; fetch them only if installing fails.
if ! install_missing; then
  apt_get update
  install_missing
fi
