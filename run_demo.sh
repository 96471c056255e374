#!/usr/bin/env bash
# Builds the tools and shows what they do: one view completed to meshes and a picture, then a simulated sequence from images to a
# report of what came out.
set -euo pipefail

if [[ $# -gt 0 ]]; then
  echo "Usage: run_demo.sh    (no options; writes to demo_output/)" >&2
  [[ $# -eq 1 && $1 == --help ]] && exit 0
  exit 2
fi

cd "$(dirname "${BASH_SOURCE[0]}")"
output=demo_output
export OMP_WAIT_POLICY="${OMP_WAIT_POLICY:-passive}" # the machine may have other work to do

echo "== Build"
./install_dependencies.sh
cmake -G Ninja -S . -B build
cmake --build build --parallel "$(nproc)" --target pcl_cosection_tool draw_scene \
  pcl_cosection_simulate pcl_cosection_fusion pcl_cosection_evaluate pcl_cosection_report

mkdir -p "$output"
echo "== One view: complete the objects of doc/demo/table.pcd, draw them"
build/bin/pcl_cosection --json "$output/summary.json" doc/demo/table.pcd "$output/meshes"
build/bin/draw_scene doc/demo/table.pcd "$output/meshes" "$output/before_after.png"

echo "== A sequence: simulate doc/demo/playground.json"
rm -rf "$output/sequence" # the program writes new folders only
build/bin/pcl_cosection_simulate doc/demo/playground.json "$output/sequence"
echo "== Track and complete what moves in it; nothing but images and masks is given"
build/bin/pcl_cosection_fusion --masks "$output/sequence/mask" "$output/sequence" "$output/run"
echo "== Compare with the truth"
build/bin/pcl_cosection_evaluate run "$output/run" "$output/sequence"
echo "== Report"
build/bin/pcl_cosection_report --truth "$output/sequence" -o "$output/report.html" "$output/run"

echo
echo "Wrote $output/:"
echo "  before_after.png   one view: the points | the meshes | the meshes from behind, by provenance:"
echo "                     grey observed, orange inferred, blue bounded by free space,"
echo "                     green bounded by another body"
echo "  meshes/            the meshes of that picture"
echo "  sequence/          the simulated images and the truth"
echo "  run/               trajectories and meshes from the sequence"
echo "  report.html        what became of the sequence, to look at: open it in a browser"
