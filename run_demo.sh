#!/usr/bin/env bash
# Builds the tool, completes the objects of doc/demo/table.pcd and draws what came out.
set -euo pipefail

if [[ $# -gt 0 ]]; then
  echo "Usage: run_demo.sh    (no options; writes to demo_output/)" >&2
  [[ $# -eq 1 && $1 == --help ]] && exit 0
  exit 2
fi

cd "$(dirname "${BASH_SOURCE[0]}")"
output=demo_output

echo "== Build"
./install_dependencies.sh
cmake -G Ninja -S . -B build
cmake --build build --parallel "$(nproc)" --target pcl_cosection_tool draw_scene

echo "== Complete the objects of doc/demo/table.pcd"
mkdir -p "$output"
build/bin/pcl_cosection --json "$output/summary.json" doc/demo/table.pcd "$output/meshes"

echo "== Draw"
build/bin/draw_scene doc/demo/table.pcd "$output/meshes" "$output/before_after.png"

echo
echo "Wrote $output/:"
echo "  meshes/object_<label>.ply  closed meshes of the objects, with provenance and confidence per vertex"
echo "  meshes/background.ply      the table"
echo "  summary.json               sizes, volumes, times"
echo "  before_after.png           the points | the meshes | the meshes from behind, by provenance:"
echo "                             grey observed, orange inferred, blue bounded by free space,"
echo "                             green bounded by another body"
