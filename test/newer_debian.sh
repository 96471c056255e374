#!/usr/bin/env bash
# Builds the source and runs its quick tests in another release of Debian; see usage ().
set -euo pipefail

usage ()
{
  cat << 'END'
Usage: newer_debian.sh [--suite SUITE] [--packages DIR] [--ccache DIR] [--jobs N] [--keep] [--help]

Makes a new Debian of another release, installs there what install_dependencies.sh says, builds the source as it is in this
folder, and runs the tests labelled quick. Takes an hour on two cores. Needs root, and a mirror of Debian that apt of this
system knows.

  --suite SUITE   code name of the release (default: trixie, Debian 13)
  --packages DIR  build the Debian packages too, into DIR (test/packages.sh --suite SUITE --packages DIR tries them)
  --ccache DIR    keep what the compiler made in DIR, for the next time
  --jobs N        how many compilers or tests run at once (default: as many as there are processors)
  --keep          keep the new Debian
  --help          this text

Exit status: 0 all is well, 1 something is wrong, 2 wrong usage, 77 there is no root, no mmdebstrap or no mirror.
END
}

# shellcheck source=test/debian_root.sh
source "$(dirname "${BASH_SOURCE[0]}")/debian_root.sh"
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

suite=trixie
packages_dir=""
ccache_dir=""
jobs=$(nproc)
keep=false
while [[ $# -gt 0 ]]; do
  case $1 in
    --suite | --packages | --ccache | --jobs)
      if [[ $# -lt 2 ]]; then
        echo "$script: $1 needs a value" >&2
        exit 2
      fi
      case $1 in
        --suite) suite=$2 ;;
        --packages) packages_dir=$2 ;;
        --ccache) ccache_dir=$2 ;;
        --jobs) jobs=$2 ;;
      esac
      shift
      ;;
    --keep) keep=true ;;
    --help)
      usage
      exit 0
      ;;
    *)
      echo "$script: unknown option '$1'" >&2
      usage >&2
      exit 2
      ;;
  esac
  shift
done
require_roots "$suite"

work=$(mktemp --directory)
root=$work/root

clean_up ()
{
  if $keep; then
    echo "$script: kept $work" >&2
  else
    rm --recursive --force --one-file-system "$work"
  fi
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

step "A new Debian $suite"
make_root "$suite" "$root" ca-certificates git
bind_mounts=""
if [[ -n $ccache_dir ]]; then
  mkdir --parents "$ccache_dir"
  bind_mounts="$(cd "$ccache_dir" && pwd)=/var/cache/ccache"
fi

# As git sees it, with changes that are not committed; tests ask git which files there are.
mkdir "$root/source"
(cd "$source_dir" && git ls-files --cached --others --exclude-standard -z | tar --create --null --files-from=-) |
  tar --extract --directory "$root/source" --no-same-owner
in_root "$root" sh -ec 'cd /source && git init --quiet && git add --all'

step "Install what building and testing needs"
in_root "$root" /source/install_dependencies.sh > "$work/install.log" 2>&1 ||
  { tail --lines=20 "$work/install.log"; exit 1; }

step "Build"
# shellcheck disable=SC2016 # variables of the inner shell
in_root "$root" bash -euc '
  export CCACHE_DIR=/var/cache/ccache CCACHE_BASEDIR=/source
  cd /source
  cmake --preset release
  cmake --build --preset release --parallel "$1"' build "$jobs"

step "Test"
# shellcheck disable=SC2016
in_root "$root" bash -euc '
  export OMP_WAIT_POLICY=passive
  ctest --test-dir /source/build --output-on-failure --no-tests=error --label-regex "^quick\$" --parallel "$1"' test "$jobs"

if [[ -n $packages_dir ]]; then
  step "Build the packages"
  # shellcheck disable=SC2016
  in_root "$root" bash -euc '
    export CCACHE_DIR=/var/cache/ccache CCACHE_BASEDIR=/source
    cd /source
    cmake --preset package > /tmp/configure.log || { cat /tmp/configure.log; exit 1; }
    cmake --build --preset package --parallel "$1"' package "$jobs"
  mkdir --parents "$packages_dir"
  cp "$root"/source/build-package/*.deb "$packages_dir"
fi
