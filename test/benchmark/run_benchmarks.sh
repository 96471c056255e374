#!/usr/bin/env bash
# Measures and prints a table; see usage ().
set -euo pipefail

usage ()
{
  cat << 'END'
Usage: run_benchmarks.sh [--update] [--repetitions N] [--help] [BUILD_FOLDER]

Runs the benchmarks in BUILD_FOLDER/bin (default: build beside the sources) and prints a table in
Markdown, the best of the repetitions in each row. The machine should have nothing else to do.

  --update         put the table into doc/benchmarks.md, too
  --repetitions N  3 unless given
  --help           this text
END
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$root/build
repetitions=3
update=false
while [[ $# -gt 0 ]]; do
  case $1 in
    --update) update=true ;;
    --repetitions)
      repetitions=${2:?--repetitions needs a number}
      shift
      ;;
    --help)
      usage
      exit 0
      ;;
    -*)
      echo "run_benchmarks.sh: unknown option '$1'" >&2
      usage >&2
      exit 2
      ;;
    *) build=$1 ;;
  esac
  shift
done

results=$(mktemp -d)
trap 'rm -r "$results"' EXIT

for benchmark in solver scaling data_term poisson scene; do
  if [[ ! -x $build/bin/bench_$benchmark ]]; then
    echo "run_benchmarks.sh: there is no $build/bin/bench_$benchmark; build it first" >&2
    exit 1
  fi
  echo "bench_$benchmark ..." >&2
  "$build/bin/bench_$benchmark" --benchmark_repetitions="$repetitions" \
    --benchmark_out="$results/$benchmark.json" --benchmark_out_format=json > /dev/null 2> "$results/log" ||
    { cat "$results/log" >&2; exit 1; }
done

# Google Benchmark writes a key per line: "benchmark key smallest largest" over the repetitions.
awk -F'"' '
  /"run_name":/ { name = $4; sub (/\/(iterations:[0-9]+\/)?real_time$/, "", name) }
  /"run_type":/ { single = $4 == "iteration" }
  single && /": [-+0-9.e]+,?$/ {
    value = $3; sub (/^: /, "", value); sub (/,$/, "", value); value += 0
    key = name " " $2
    if (!(key in smallest) || value < smallest[key]) smallest[key] = value
    if (!(key in largest) || value > largest[key]) largest[key] = value
  }
  END { for (key in smallest) print key, smallest[key], largest[key] }
' "$results"/*.json > "$results/values"

value () # <column> <benchmark> <key> <format> [<factor>]
{
  awk -v name="$2" -v key="$3" -v format="$4" -v factor="${5:-1}" -v column="$1" \
    '$1 == name && $2 == key { printf format, factor * $column; found = 1 } END { exit !found }' "$results/values" ||
    { echo "run_benchmarks.sh: no $3 of $2" >&2; exit 1; }
}
least ()
{
  value 3 "$@"
}
most ()
{
  value 4 "$@"
}
ratio () # <benchmark> <benchmark>
{
  awk -v a="$(least "$1" real_time %g)" -v b="$(least "$2" real_time %g)" 'BEGIN { printf "%.1f", a / b }'
}

setting ()
{
  sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"
}

table ()
{
  local threads type flags
  threads=$(nproc)
  type=$(setting CMAKE_BUILD_TYPE)
  flags=$(setting "CMAKE_CXX_FLAGS_${type^^}")
  echo "$threads cores, $("$(setting CMAKE_CXX_COMPILER)" --version | head -n 1), $type ($flags); best of $repetitions."
  echo
  echo "| what | measured | bar |"
  echo "|---|---|---|"
  echo "| multigrid, 64³, whole energy, from nothing | $(least multigrid real_time %.2f) s ($(most multigrid multigrid_rms_vox %.4f) voxel from the minimum) | ≤ 0.3 s |"
  local fast_jacobi=fastJacobiInAHundredTimesTheTime
  echo "| Fast Jacobi in 100 × the time of multigrid ($(least $fast_jacobi fast_jacobi_s %.0f) s) | $(least $fast_jacobi fast_jacobi_rms_vox %.3f) voxel from the minimum | > 0.05 |"
  echo "| multigrid, 128³ | $(least scaling/128 real_time %.2f) s, $(ratio scaling/128 scaling/64) × 64³ | ≤ 10 × |"
  echo "| multigrid, 256³ | $(least scaling/256 real_time %.1f) s, $(ratio scaling/256 scaling/128) × 128³ | ≤ 10 × |"
  echo "| memory per voxel at the peak, 64³, 128³, 256³ | $(most scaling/64 bytes_per_voxel %.1f), $(most scaling/128 bytes_per_voxel %.1f), $(most scaling/256 bytes_per_voxel %.1f) bytes | ≤ 48 |"
  echo "| data term, σ = 1, one core; 64³, 128³, 256³ | $(most dataTerm/64 items_per_second %.1f 1e-6), $(most dataTerm/128 items_per_second %.1f 1e-6), $(most dataTerm/256 items_per_second %.1f 1e-6) million points/s | ≥ 3 |"
  echo "| \`pcl::Poisson\`, depth 6, 100,000 points → mesh | $(least poisson/1 real_time %.2f) s; $(least "poisson/$threads" real_time %.2f) s with $threads threads | |"
  echo "| \`HessianIMLS\`, the same points, volume of 64³ | $(least hessianImls64Volume real_time %.2f) s | no slower |"
  echo "| \`HessianIMLS\`, the same points, 64 voxels along the object (volume of $(least hessianImls64Object longest_axis %.0f)³) | $(least hessianImls64Object real_time %.2f) s | |"
  echo "| three objects on a table, one view of 640 × 480, to meshes | $(least scene real_time %.2f) s | |"
}

table > "$results/table.md"
cat "$results/table.md"
if $update; then
  document=$root/doc/benchmarks.md
  awk -v table="$results/table.md" '
    /<!-- end of table -->/ { skip = 0 }
    !skip { print }
    /<!-- table -->/ { print ""; while ((getline line < table) > 0) print line; print ""; skip = 1 }
  ' "$document" > "$results/document.md"
  cp "$results/document.md" "$document"
fi
