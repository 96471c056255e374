#!/usr/bin/env bash
# Builds the Debian packages, and installs, uses and removes them in a new Debian; see usage ().
set -euo pipefail

usage ()
{
  cat << 'END'
Usage: packages.sh [--packages DIR] [--suite SUITE] [--keep] [--help]

Builds the Debian packages from nothing, checks them with lintian, installs them with apt in a new minimal Debian, runs the
commands of the README there, builds the project of test/consumer with them, uses the module for Python if there is one, and
removes them: no file may be left. Needs root, and a mirror of Debian that apt of this system knows.

  --packages DIR  the packages in DIR instead of new ones
  --suite SUITE   the release that they are for (default: this system's; others need --packages, see newer_debian.sh)
  --keep          keep the build and the new Debian
  --help          this text

Exit status: 0 all is well, 1 something is wrong, 2 wrong usage, 77 there is no root, no mmdebstrap or no mirror.
END
}

# shellcheck source=test/debian_root.sh
source "$(dirname "${BASH_SOURCE[0]}")/debian_root.sh"
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

suite=$(host_suite)
packages_dir=""
keep=false
while [[ $# -gt 0 ]]; do
  case $1 in
    --packages | --suite)
      if [[ $# -lt 2 ]]; then
        echo "$script: $1 needs a value" >&2
        exit 2
      fi
      if [[ $1 == --suite ]]; then suite=$2; else packages_dir=$2; fi
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
if [[ -z $packages_dir && $suite != "$(host_suite)" ]]; then
  echo "$script: packages for $suite are built there: test/newer_debian.sh --suite $suite --packages DIR" >&2
  exit 2
fi
require_roots "$suite"

work=$(mktemp --directory)
root=$work/root
build=$source_dir/build-package-test # in the source's folder, as ccache then knows what build/ compiled

clean_up ()
{
  if $keep; then
    echo "$script: kept $work" "$([[ -n $packages_dir ]] || echo "and $build")" >&2
  else
    rm --recursive --force --one-file-system "$work"
    [[ -n $packages_dir ]] || rm --recursive --force "$build"
  fi
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

if [[ -n $packages_dir ]]; then
  packages=("$(cd "$packages_dir" && pwd)"/*.deb)
else
  step "Build the packages"
  rm --recursive --force "$build"
  cmake -S "$source_dir" --preset package -B "$build" > "$work/configure.log" || { cat "$work/configure.log"; exit 1; }
  cmake --build "$build" --parallel "$(nproc)" --target package > "$work/build.log" ||
    { tail --lines=60 "$work/build.log"; exit 1; }
  packages=("$build"/*.deb)
fi
[[ -e ${packages[0]} ]] || fail "there are no packages"
names=()
for package in "${packages[@]}"; do
  names+=("$(dpkg-deb --field "$package" Package)")
  printf '%10d bytes  %s\n' "$(stat --format=%s "$package")" "$(basename "$package")"
done

step "lintian"
if command -v lintian > /dev/null; then
  lintian --allow-root --no-cfg --profile debian --fail-on error "${packages[@]}" | tee "$work/lintian.log"
  echo "$(wc --lines < "$work/lintian.log") warnings"
else
  echo "lintian is not installed"
fi

step "A new Debian $suite"
make_root "$suite" "$root" ca-certificates
in_root "$root" apt-get update --quiet > "$work/update.log" 2>&1 || { cat "$work/update.log"; exit 1; }
mkdir "$root/tmp/packages" "$root/tmp/consumer"
cp "${packages[@]}" "$root/tmp/packages"
cp --recursive "$source_dir/test/consumer/." "$root/tmp/consumer"

# What comes with the packages is installed first, so that the list of files below has nothing but theirs.
step "Install what the packages depend on"
# shellcheck disable=SC2016 # a variable of the inner shell
others=$(in_root "$root" sh -c 'apt-get install --simulate /tmp/packages/*.deb' | awk '$1 == "Inst" { print $2 }' |
  grep --invert-match --line-regexp --fixed-strings --file=<(printf '%s\n' "${names[@]}"))
# shellcheck disable=SC2086 # a list
in_root "$root" apt-get install --yes --quiet $others cmake g++ ninja-build > "$work/install.log" 2>&1 ||
  { tail --lines=20 "$work/install.log"; exit 1; }

# All files but those that apt, dpkg and ldconfig keep for themselves, and what commands were asked to write.
list_files ()
{
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./dev -o -path ./tmp -o -path ./run \
    -o -path ./var/cache/apt -o -path ./var/lib/apt -o -path ./var/log -o -path ./var/lib/dpkg \
    -o -path ./var/cache/ldconfig \) -prune -o -print | sort)
}
list_files > "$work/before"

step "Install the packages"
in_root "$root" sh -c 'apt-get install --yes --quiet /tmp/packages/*.deb' > "$work/install.log" 2>&1 ||
  { tail --lines=20 "$work/install.log"; exit 1; }
list_files > "$work/installed"
echo "$(comm -13 "$work/before" "$work/installed" | wc --lines) files and folders of ${#names[@]} packages"

step "Run the programs"
# shellcheck disable=SC2016 # variables of the inner shell
in_root "$root" bash -euc '
  export OMP_WAIT_POLICY=passive
  demo=/usr/share/pcl_cosection/demo
  mkdir /tmp/demo
  cd /tmp/demo
  pcl_cosection "$demo/table.pcd" completed/
  pcl_cosection_segment "$demo/table.pcd" labelled.pcd
  pcl_cosection_export --format mjcf completed/ simulation/
  pcl_cosection_simulate "$demo/playground.json" sequence
  pcl_cosection_fusion --masks sequence/mask sequence run
  pcl_cosection_evaluate run run sequence
  pcl_cosection_report --truth sequence -o report.html run
  pcl_cosection_viewer --screenshot picture.png run
  for program in /usr/bin/pcl_cosection*; do
    "$program" --version
    test -s "/usr/share/man/man1/${program##*/}.1.gz"
  done'

step "Build the consumer project"
# shellcheck disable=SC2016 # variables of the inner shell
in_root "$root" bash -euc '
  cd /tmp/consumer
  cmake -G Ninja -S . -B build -DCMAKE_BUILD_TYPE=Release > configure.log || { cat configure.log; exit 1; }
  cmake --build build > build.log || { cat build.log; exit 1; }
  for program in consumer detect_objects reconstruct_sphere remove_ghost simulate_sphere draw_scene; do
    if [[ $program != draw_scene ]] || dpkg-query --show libpcl-cosection-visualization-dev > /dev/null 2>&1; then
      "build/$program"
    fi
  done'

if in_root "$root" dpkg-query --show python3-pcl-cosection > /dev/null 2>&1; then
  step "Use the module for Python"
  cp "$source_dir/test/packages_python.py" "$root/tmp"
  in_root "$root" python3 /tmp/packages_python.py
fi

step "Remove the packages"
in_root "$root" apt-get purge --yes --quiet "${names[@]}" > "$work/purge.log" 2>&1 ||
  { tail --lines=20 "$work/purge.log"; exit 1; }
list_files > "$work/after"
if ! diff "$work/before" "$work/after"; then
  fail "installing and removing the packages changed the files above (<: lost, >: left)"
fi
if in_root "$root" ldconfig --print-cache | grep cosection; then
  fail "ldconfig still knows a library"
fi
echo "no file is left, and no other is gone"
