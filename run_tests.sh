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
build=build
options=()
targets=()
for argument in "$@"; do
  case $argument in
    --all) selection=() ;;
    --sanitize)
      build=build-sanitize
      # Debug keeps the assertions, also Eigen's. -O2 builds more slowly than -O1, and tests run in half the time.
      options=(-DPCL_COSECTION_SANITIZE=ON -DPCL_COSECTION_BUILD_BENCHMARKS=OFF
        -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O2 -g1")
      ;;
    --sanitize-threads)
      build=build-sanitize-threads
      options=(-DPCL_COSECTION_SANITIZE=thread -DPCL_COSECTION_BUILD_BENCHMARKS=OFF)
      targets=(--target test_completion)
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
export TSAN_OPTIONS="suppressions=$PWD/test/tsan_suppressions.txt" # also while the build asks programs for their tests

step ()
{
  echo "== $*"
}

step "Dependencies"
./install_dependencies.sh
step "Configure $build/"
cmake -G Ninja -S . -B "$build" "${options[@]}"
step "Build with $jobs jobs"
cmake --build "$build" --parallel "$jobs" "${targets[@]}"
step "Test"
# Several tests run at once: threads that wait by spinning would hold each other up.
export OMP_WAIT_POLICY=passive
ctest --test-dir "$build" --output-on-failure --no-tests=error --parallel "$jobs" "${selection[@]}"
