// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_thinned_views [SCENES [FIRST_SEED]]: how well things on random tables are completed from one view that was
// thinned by pcl::VoxelGrid, with normals or without, together with their background or alone.

#include "random_table.h"
#include "thing_scores.h"

#include "pcl_cosection/simulation/sequence_writer.h"
#include <pcl/cosection/evaluation/run_evaluation.h>
#include <pcl/cosection/io/pcd_view.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <pcl/features/impl/normal_3d.hpp> // for points with labels
#include <pcl/filters/impl/voxel_grid.hpp>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZL>;

constexpr int default_scenes = 6;
constexpr std::array<float, 4> cells_m = {0.0f, 0.003f, 0.005f, 0.01f};
constexpr int neighbours = 20;
constexpr std::size_t least_points = 100; // as for pcl_cosection
constexpr float farthest_m = 2.5f;        // else pcl::VoxelGrid has too many cells

struct Row
{
  ThingScores scene, with_normals, alone;
};

/** \brief The readings of each label, one per cell; all of them without a cell. */
std::map<std::uint32_t, Cloud>
thin (const Cloud& view, float cell_m)
{
  std::map<std::uint32_t, Cloud> parts;
  for (const auto& p : view)
    if (p.z < farthest_m)
      parts[p.label].push_back (p);
  for (auto& [label, part] : parts)
  {
    if (cell_m > 0.0f)
    {
      pcl::VoxelGrid<pcl::PointXYZL> grid;
      grid.setInputCloud (std::make_shared<Cloud> (part));
      grid.setLeafSize (cell_m, cell_m, cell_m);
      grid.filter (part);
    }
    for (auto& p : part)
      p.label = label;
    part.sensor_origin_ = view.sensor_origin_;
    part.sensor_orientation_ = view.sensor_orientation_;
  }
  return parts;
}

/** \brief Save it with the normals of pcl::NormalEstimation, whatever is whose. */
void
saveWithNormals (const Cloud& cloud, const std::string& path)
{
  pcl::PointCloud<pcl::PointXYZLNormal> normals;
  pcl::NormalEstimation<pcl::PointXYZL, pcl::PointXYZLNormal> estimation;
  estimation.setInputCloud (std::make_shared<Cloud> (cloud));
  estimation.setKSearch (neighbours);
  estimation.setViewPoint (0.0f, 0.0f, 0.0f);
  estimation.compute (normals);
  for (std::size_t i = 0; i < cloud.size (); ++i)
  {
    normals[i].getVector3fMap () = cloud[i].getVector3fMap ();
    normals[i].label = cloud[i].label;
  }
  normals.sensor_origin_ = cloud.sensor_origin_;
  normals.sensor_orientation_ = cloud.sensor_orientation_;
  pcl::io::savePCDFileBinary (path, normals);
}

std::vector<ObjectResult>
complete (const std::string& path)
{
  LabelledView view = readPcdView (path);
  CoSection scene;
  if (view.view)
    scene.addView (std::move (*view.view));
  scene.setBackground (std::move (view.objects[0].points));
  for (auto& [label, object] : view.objects)
    if (label != 0 && object.points.size () >= least_points)
      scene.addObject ({static_cast<int> (label), std::move (object.points), {}});
  return scene.reconstruct ().objects;
}

void
measure (const SceneRecord& truth, const std::vector<ObjectResult>& meshes, ThingScores& scores)
{
  std::map<std::string, ThingScores> by_name;
  by_name["all"] = std::move (scores);
  measureThings (truth, meshes, by_name);
  scores = std::move (by_name["all"]);
}

void
measureView (const fs::path& folder, float cell_m, Row& row)
{
  ReadingNotes notes;
  const SceneRecord truth = readTruth (folder.string (), notes);
  Cloud view;
  pcl::io::loadPCDFile ((folder / "views" / "View0000.pcd").string (), view);
  const std::map<std::uint32_t, Cloud> parts = thin (view, cell_m);
  Cloud whole = parts.begin ()->second;
  for (auto part = std::next (parts.begin ()); part != parts.end (); ++part)
    whole += part->second;
  const std::string path = (folder / "thinned.pcd").string ();
  pcl::io::savePCDFileBinary (path, whole);
  measure (truth, complete (path), row.scene);
  saveWithNormals (whole, path);
  measure (truth, complete (path), row.with_normals);
  std::vector<ObjectResult> alone;
  for (const auto& [label, part] : parts)
    if (label != 0)
      try
      {
        pcl::io::savePCDFileBinary (path, part);
        for (ObjectResult& object : complete (path))
          alone.push_back (std::move (object));
      }
      catch (const std::exception& error)
      {
        std::printf ("%s\n", error.what ());
      }
  measure (truth, alone, row.alone);
}

void
print (const std::array<Row, cells_m.size ()>& rows)
{
  std::printf ("| cells | things | mean error | worst | with normals | worst | each alone | worst "
               "|\n|---|---|---|---|---|---|---|---|\n");
  for (std::size_t c = 0; c < cells_m.size (); ++c)
  {
    if (cells_m[c] > 0.0f)
      std::printf ("| %.0f mm |", 1e3 * cells_m[c]);
    else
      std::printf ("| none |");
    std::printf (" %zu |", rows[c].scene.errors_m.size ());
    for (const ThingScores* scores : {&rows[c].scene, &rows[c].with_normals, &rows[c].alone})
      std::printf (" %.2f mm | %.1f mm |", 1e3 * scores->meanError (), 1e3 * scores->worstError ());
    std::printf ("\n");
  }
}

} // namespace

int
main (int argc, char** argv)
{
  const int scenes = argc > 1 ? std::atoi (argv[1]) : default_scenes;
  const int first = argc > 2 ? std::atoi (argv[2]) : 0;
  if (scenes < 1 || first < 0 || argc > 3)
  {
    std::fprintf (stderr, "Usage: compare_thinned_views [SCENES [FIRST_SEED]]\n");
    return 2;
  }
  const fs::path folder = fs::temp_directory_path () / ("compare_thinned_views_" + std::to_string (::getpid ()));
  std::array<Row, cells_m.size ()> rows;
  for (int s = first; s < first + scenes; ++s)
  {
    fs::remove_all (folder);
    writeSequence (parseSceneSpec (randomTable (static_cast<unsigned> (s), 1), "random table"), folder.string ());
    for (std::size_t c = 0; c < cells_m.size (); ++c)
      measureView (folder, cells_m[c], rows[c]);
  }
  fs::remove_all (folder);
  print (rows);
}
