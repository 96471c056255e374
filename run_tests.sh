#!/usr/bin/env bash
# Builds everything and runs the tests; see usage ().
set -euo pipefail

usage ()
{
  cat << 'END'
Usage: run_tests.sh [--all] [--sanitize | --sanitize-threads] [--help]

Installs missing Debian packages, builds into build/ and runs the tests labelled quick and data,
among them a project that uses the installed package, and the documentation with warnings as errors.

  --all               the slow tests too
  --sanitize          with AddressSanitizer and UndefinedBehaviorSanitizer, into build-sanitize/
  --sanitize-threads  only the test of several threads, with ThreadSanitizer, into build-sanitize-threads/
  --help              this text

Tests of real data read $PCL_COSECTION_DATA, else ../shared/data beside this folder, and are
skipped where that is absent.
END
}

selection=(--label-regex '^(quick|data)$')
preset=release
build=build
for argument in "$@"; do
  case $argument in
    --all) selection=() ;;
    --sanitize)
      preset=sanitize
      build="build-sanitize"
      ;;
    --sanitize-threads)
      preset=sanitize-threads
      build="build-sanitize-threads"
      selection=(--tests-regex 'Concurrency\.')
      ;;
    --help)
      usage
      exit 0
      ;;
    *)
      echo "run_tests.sh: unknown option '$argument'" >&2
      usage >&2
      exit 2
      ;;
  esac
done

cd "$(dirname "${BASH_SOURCE[0]}")"
jobs=$(nproc)
export TSAN_OPTIONS="suppressions=$PWD/test/tsan_suppressions.txt"

step ()
{
  echo "== $*"
}

step "Dependencies"
./install_dependencies.sh
step "Configure $build/"
cmake --preset "$preset"
step "Build with $jobs jobs"
cmake --build --preset "$preset" --parallel "$jobs"
step "Test"
# Several tests run at once: threads that wait by spinning would hold each other up.
export OMP_WAIT_POLICY=passive
ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel "$jobs" "${selection[@]}"
