#!/usr/bin/env bash
# Runs every program on known inputs and prints a hash for each output; see usage ().
set -uo pipefail

usage ()
{
  cat << 'END'
Usage: fingerprints.sh [--help] BUILD OUT

Runs the programs of BUILD/bin, each with one thread, on the demo, the presets and the shared data, into the new folder OUT.
Prints a line "HASH  NAME" for each output and for what each program says, and writes them to OUT/fingerprints.txt.
Times are left out, so that two builds which compute the same print the same: a refactoring compares with

  test/fingerprints.sh build_before before && test/fingerprints.sh build_after after
  diff before/fingerprints.txt after/fingerprints.txt

Reads $PCL_COSECTION_DATA, else ../shared/data beside this folder; what is absent there is left out.
END
}

if [[ ${1:-} == --help ]]; then
  usage
  exit 0
fi
if [[ $# -ne 2 ]]; then
  usage >&2
  exit 2
fi
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bin=$(cd "$1/bin" && pwd) || exit 2
mkdir "$2" || exit 2
out=$(cd "$2" && pwd)
data=$(cd "${PCL_COSECTION_DATA:-$root/../shared/data}" 2> /dev/null && pwd || true)
export OMP_WAIT_POLICY=passive
cd "$out" || exit 2

# run NAME PROGRAM ARGUMENT...: what the program says, and its exit status, go to NAME.log.
run ()
{
  local name=$1 program=$2
  shift 2
  echo "$name" >&2
  "$bin/$program" --threads 1 "$@" < /dev/null > "$name.log" 2>&1
  echo "exit status $?" >> "$name.log"
}

# The jobs below are independent of each other.
demo ()
{
  local table=$root/doc/demo/table.pcd
  run demo pcl_cosection --json demo.json "$table" demo
  run demo_bounds pcl_cosection --save-hull --save-bounds --save-sdf "$table" demo_bounds
  run demo_paper pcl_cosection --preset paper --resolution 32 "$table" demo_paper
  run demo_jacobi pcl_cosection --solver fast-jacobi --resolution 24 --max-iterations 200 "$table" demo_jacobi
  local constraints
  for constraints in none hull intersection; do
    run "demo_$constraints" pcl_cosection --constraints $constraints "$table" "demo_$constraints"
  done
  run demo_union pcl_cosection --max-faces 2000 "$table" demo.stl
  run demo_segment pcl_cosection_segment --json demo_segment.json "$table" demo_labelled.pcd
  run playground pcl_cosection_simulate "$root/doc/demo/playground.json" playground
  run playground_run pcl_cosection_fusion --masks playground/mask playground playground_run
  run playground_score pcl_cosection_evaluate run --json playground_score.json playground_run playground
  strip_times playground_run/summary.json
  run playground_report pcl_cosection_report --truth playground -o playground_report.html playground_run
  run playground_picture pcl_cosection_viewer --screenshot playground.png --size 640x480 playground_run
}

presets ()
{
  local preset
  for preset in table toys stack; do
    run "$preset" pcl_cosection_simulate --preset $preset --frames 0:41 "$preset"
  done
  run table_run pcl_cosection_fusion --frames 0:30 --camera-trajectory table/gt-cam-0.txt --masks table/mask table table_run
  run table_motion pcl_cosection_fusion --frames 0:15 --segmentation geometric table table_geometric
  run toys_motion pcl_cosection_fusion --frames 0:25 --segmentation motion toys toys_motion
  run table_score pcl_cosection_evaluate run --json table_score.json table_run table
  run stack_views pcl_cosection stack/views/*.pcd stack_meshes
}

real_clouds ()
{
  local cloud name
  for cloud in "$data"/osd/*.pcd "$data"/pcl/*.pcd "$data"/real/*/view.pcd "$data"/real/robot/*.pcd; do
    [[ -f $cloud ]] || continue
    name=${cloud#"$data"/}
    name=${name//\//_}
    name=${name%.pcd}
    run "$name" pcl_cosection --json "$name.json" "$cloud" "$name"
    if [[ $cloud == */osd/* ]]; then
      run "${name}_segment" pcl_cosection_segment "$cloud" "${name}_labelled.pcd"
    fi
  done
}

# One view of a few scanned things, alone on a table.
household ()
{
  local thing
  for thing in blue_moon plastic_pear power_drill blue_cup book_3 mini_claw_hammer_1; do
    [[ -f $data/household/$thing.ply ]] || continue
    cat > "$thing.json" << END
{"frames": 1, "camera": {"keys": [{"position": [0.35, -0.45, 0.4], "look_at": [0, 0, 0.04]}]},
 "background": {"parts": [{"type": "box", "size": [1.2, 1.2, 0.04], "position": [0, 0, -0.02]}]},
 "views": {"every": 1}, "depth": {"noise": {}},
 "objects": [{"name": "thing", "shape": {"type": "mesh", "file": "$data/household/$thing.ply"}}]}
END
    run "${thing}_scene" pcl_cosection_simulate "$thing.json" "${thing}_scene"
    run "$thing" pcl_cosection "${thing}_scene/views/View0000.pcd" "$thing"
    run "${thing}_score" pcl_cosection_evaluate mesh --json "${thing}_score.json" "${thing}_scene/gt-mesh/thing.ply" "$thing/object_1.ply"
    rm -rf "${thing}_scene"
  done
}

sequences ()
{
  local cars=$data/toycars
  if [[ -d $cars ]]; then
    run toycars_given pcl_cosection_fusion --frames 0:40 --camera-trajectory "$cars/gt-cam-0.txt" --masks "$cars/mask" \
      --object-trajectory "1=$cars/gt-truck-1.txt" --object-trajectory "2=$cars/gt-car-2.txt" \
      --object-trajectory "3=$cars/gt-crate-3.txt" "$cars" toycars_given
    run toycars_tracked pcl_cosection_fusion --frames 0:40 --masks "$cars/mask" --save-keyframes --deterministic "$cars" toycars_tracked
    run toycars_score pcl_cosection_evaluate run --json toycars_score.json toycars_tracked "$cars"
    strip_times toycars_tracked/summary.json toycars_given/summary.json
    run toycars_report pcl_cosection_report --truth "$cars" --compare toycars_given -o toycars_report.html toycars_tracked
    run toycars_picture pcl_cosection_viewer --screenshot toycars.png --colour provenance --view behind --size 640x480 toycars_tracked
  fi
  if [[ -d $data/kitchen ]]; then
    run kitchen pcl_cosection_fusion --frames 0:25 "$data/kitchen" kitchen
    run kitchen_score pcl_cosection_evaluate trajectory --json kitchen_score.json "$data/kitchen/groundtruth.txt" kitchen/trajectory/camera.txt
  fi
  if [[ -d $data/hands ]]; then
    run hands pcl_cosection_fusion --frames 0:40 --segmentation geometric "$data/hands" hands
  fi
}

# Times and rates, and the number of threads that the machine has, are no results.
strip_times ()
{
  python3 - "$@" << 'END'
import json, sys

def strip(value):
    if isinstance(value, dict):
        return {k: strip(v) for k, v in value.items() if not k.endswith(("timings_s", "frames_per_second", "_s", "version"))}
    if isinstance(value, list):
        return [strip(v) for v in value]
    return value

for name in sys.argv[1:]:
    with open(name) as file:
        value = json.load(file)
    with open(name, "w") as file:
        json.dump(strip(value), file, indent=1, sort_keys=True)
END
}

[[ -n $data ]] || echo "fingerprints.sh: no shared data: only the demo and the presets" >&2
demo &
presets &
wait
if [[ -n $data ]]; then
  sequences &
  real_clouds
  household
  wait
fi

find . -name '*.json' ! -name scene.json -print0 | while IFS= read -r -d '' file; do strip_times "$file"; done
# Paths of this machine and durations in what the programs say, and in pages.
find . \( -name '*.log' -o -name '*.json' -o -name '*.html' \) -exec sed -i -E \
  -e "s#$out/?##g; s#$data/?##g; s#$root/?##g; s#$bin/?##g" \
  -e 's#[0-9.e+-]+ (s|ms|seconds|frames/s|frames per second)\b#TIME#g' {} +
find . -type f ! -name fingerprints.txt ! -path '*/.*' -print0 | sort -z | xargs -0 sha256sum | sed -E 's/^([0-9a-f]{16})[0-9a-f]*/\1/' | tee fingerprints.txt
