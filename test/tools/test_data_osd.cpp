// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Real views of objects on a table, without truth: what any sensible completion of them must hold.

#include "common/data_folder.h"
#include "mesh_measures.h"
#include "tool_run.h"

#include "common/temporary_folder.h"

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/io/mesh_io.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr std::size_t least_points = 500;
constexpr double near_m = 0.01;
constexpr double least_near_share = 0.95;
constexpr double free_margin_m = 0.03;
constexpr double most_free_share = 0.01;
constexpr double most_below_table_m = 0.015;
constexpr double most_diagonal_ratio = 1.5;
constexpr double least_border_vox = 3.0; // cut flat otherwise

constexpr double table_reach_m = 0.4;
constexpr double table_tolerance_m = 0.01;
constexpr std::size_t least_table_points = 1000;
constexpr std::size_t area_samples = 50000;
constexpr unsigned seed = 1;

/** \brief The views known to be there, and whatever else is. */
std::set<std::string>
viewNames ()
{
  std::set<std::string> names = {"learn0", "learn20", "learn33", "test0", "test10", "test45"};
  std::error_code absent;
  for (const fs::directory_entry& entry : fs::directory_iterator (dataFolder ("osd"), absent))
    if (entry.path ().extension () == ".pcd")
      names.insert (entry.path ().stem ().string ());
  return (names);
}

/** \brief The view as its file says, without the library's reader. The sensor's frame is the world's. */
struct Scene
{
  std::map<std::uint32_t, std::vector<Eigen::Vector3d>> points; ///< finite ones by label
  DepthView view;
  FittedPlane table;
};

Scene
loadScene (const std::string& path)
{
  pcl::PointCloud<pcl::PointXYZL> cloud;
  if (pcl::io::loadPCDFile (path, cloud) != 0)
    throw std::runtime_error (path + ": cannot be read");
  if (!cloud.sensor_origin_.head<3> ().isZero () || std::abs (cloud.sensor_orientation_.w ()) != 1.0f)
    throw std::runtime_error (path + ": the sensor's frame is not the world's");

  Scene scene;
  std::vector<Eigen::Vector3f> positions;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  std::size_t count = 0;
  for (const pcl::PointXYZL& p : cloud)
  {
    positions.push_back (p.getVector3fMap ());
    const bool reading = positions.back ().allFinite ();
    scene.view.depth.push_back (reading ? p.z : std::numeric_limits<float>::quiet_NaN ());
    if (!reading)
      continue;
    scene.points[p.label].push_back (positions.back ().cast<double> ());
    if (p.label != 0)
    {
      sum += scene.points[p.label].back ();
      ++count;
    }
  }
  const std::optional<PinholeCamera> camera = fitPinholeCamera (positions, static_cast<int> (cloud.width),
                                                                static_cast<int> (cloud.height));
  if (!camera || count == 0)
    throw std::runtime_error (path + ": not a pinhole's image of objects");
  scene.view.camera = *camera;

  const Eigen::Vector3d centroid = sum / static_cast<double> (count);
  std::vector<Eigen::Vector3d> around;
  for (const Eigen::Vector3d& p : scene.points[0])
    if ((p - centroid).norm () <= table_reach_m)
      around.push_back (p);
  const std::optional<FittedPlane> table = fitDominantPlane (around, table_tolerance_m, seed);
  if (!table || table->inliers < least_table_points)
    throw std::runtime_error (path + ": there is no table around the objects");
  scene.table = *table;
  return (scene);
}

/** \brief The view measured something more than 3 cm behind \a p, in the pixel of \a p and in all pixels less
 * than \a beside_m away from it at its depth. */
bool
inFreeSpace (const DepthView& view, const Eigen::Vector3d& p, double beside_m = 0.0)
{
  if (!(p.z () > 0.0))
    return (false);
  const Eigen::Vector2d pixel = view.camera.project (p);
  const auto seenThrough = [&] (long u, long v) {
    if (u < 0 || v < 0 || u >= view.camera.width || v >= view.camera.height)
      return (false);
    const double depth = view.at (static_cast<int> (u), static_cast<int> (v));
    return (std::isfinite (depth) && depth > p.z () + free_margin_m);
  };
  if (!seenThrough (std::lround (pixel.x ()), std::lround (pixel.y ())))
    return (false);
  const double radius = beside_m * view.camera.fx / p.z ();
  for (long v = std::lround (pixel.y () - radius); v <= std::lround (pixel.y () + radius); ++v)
    for (long u = std::lround (pixel.x () - radius); u <= std::lround (pixel.x () + radius); ++u)
      if (std::hypot (pixel.x () - u, pixel.y () - v) < radius && !seenThrough (u, v))
        return (false);
  return (true);
}

double
shareWithin (const std::vector<double>& distances, double limit)
{
  const auto count = std::count_if (distances.begin (), distances.end (), [limit] (double d) { return (d <= limit); });
  return (static_cast<double> (count) / static_cast<double> (distances.size ()));
}

struct Measures
{
  bool closed = false;
  double voxel_size_m = 0.0;
  double near_share = 0.0;       ///< of the points, within 1 cm of the mesh
  double near_voxel_share = 0.0; ///< of the points, within a voxel of the mesh
  double free_share = 0.0;       ///< of the area, in space seen free
  double free_voxel_share = 0.0; ///< of the area, in it by more than a voxel beside what was seen
  double below_table_m = 0.0;    ///< 99th percentile over the area; negative: above
  double diagonal_ratio = 0.0;   ///< the mesh's box to its points'
  double border_vox = 0.0;       ///< least distance of a vertex to the box of the voxel centres; negative: outside
};

Measures
measure (const Scene& scene, const std::vector<Eigen::Vector3d>& points, const TriangleMesh& mesh,
         const VolumeBox& volume, double voxel_size_m)
{
  Measures result;
  result.closed = computeTopology (mesh).closed_manifold;
  result.voxel_size_m = voxel_size_m;

  const ExactMeshDistance distance (mesh);
  std::vector<double> distances;
  for (const Eigen::Vector3d& p : points)
    distances.push_back (distance (p));
  result.near_share = shareWithin (distances, near_m);
  result.near_voxel_share = shareWithin (distances, voxel_size_m);

  const std::vector<Eigen::Vector3d> samples = sampleByArea (mesh, area_samples, seed);
  std::vector<double> depths;
  std::size_t free = 0, free_by_voxel = 0;
  for (const Eigen::Vector3d& p : samples)
  {
    free += inFreeSpace (scene.view, p);
    free_by_voxel += inFreeSpace (scene.view, p, voxel_size_m);
    depths.push_back (-scene.table.height (p));
  }
  result.free_share = static_cast<double> (free) / static_cast<double> (samples.size ());
  result.free_voxel_share = static_cast<double> (free_by_voxel) / static_cast<double> (samples.size ());
  result.below_table_m = percentile (depths, 0.99);

  std::vector<Eigen::Vector3d> vertices;
  result.border_vox = std::numeric_limits<double>::infinity ();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
  {
    vertices.push_back (vertex.cast<double> ());
    const double inside = std::min ((vertices.back () - volume.centres.min ()).minCoeff (),
                                    (volume.centres.max () - vertices.back ()).minCoeff ());
    result.border_vox = std::min (result.border_vox, inside / volume.voxel_size_m);
  }
  result.diagonal_ratio = boxDiagonal (vertices, 0.0) / boxDiagonal (points, 0.01);
  return (result);
}

/** \brief What is wrong with an object; negated comparisons, so that NaN is wrong. */
std::vector<std::string>
failingBars (const Measures& m)
{
  std::vector<std::string> bars;
  if (!m.closed)
    bars.emplace_back ("closed");
  if (!(m.near_share >= least_near_share))
    bars.emplace_back ("near");
  if (!(m.free_share <= most_free_share))
    bars.emplace_back ("free");
  if (!(m.below_table_m <= most_below_table_m))
    bars.emplace_back ("below");
  if (!(m.diagonal_ratio <= most_diagonal_ratio))
    bars.emplace_back ("box");
  if (!(m.border_vox > least_border_vox))
    bars.emplace_back ("border");
  return (bars);
}

std::string
describe (const Measures& m)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision (2) << (m.closed ? "closed" : "OPEN") << ", voxel " << 1000.0 * m.voxel_size_m
       << " mm, points near " << 100.0 * m.near_share << " % (1 cm) " << 100.0 * m.near_voxel_share
       << " % (1 voxel), area in free space " << 100.0 * m.free_share << " % (by a voxel " << 100.0 * m.free_voxel_share
       << " %), below the table " << 1000.0 * m.below_table_m << " mm, box " << m.diagonal_ratio << ", to the border "
       << m.border_vox << " voxels";
  return (text.str ());
}

class OsdView : public testing::TestWithParam<std::string>
{
protected:
  void SetUp () override
  {
    file_ = (dataFolder ("osd") / (GetParam () + ".pcd")).string ();
    if (!fs::exists (file_))
      GTEST_SKIP () << file_ << " is absent; PCL_COSECTION_DATA can name the folder of the shared data";
  }

  /** \brief Complete the view. \return the summary; null if there is none */
  nlohmann::json complete () const
  {
    ToolRun tool ({file_, "meshes", "--json", "summary.json", "--save-sdf", "--quiet"}, folder_.file (""));
    const int status = tool.wait ();
    EXPECT_EQ (status, 0) << GetParam () << ": " << tool.errors ();
    std::ifstream summary (folder_.file ("summary.json"));
    return (summary ? nlohmann::json::parse (summary) : nlohmann::json ());
  }

  std::optional<Measures> measureObject (const Scene& scene, const nlohmann::json& summary, std::uint32_t label) const
  {
    const std::string name = folder_.file ("meshes/object_" + std::to_string (label));
    const std::optional<VolumeBox> volume = readVolumeBox (name + ".vti");
    const auto& objects = summary.at ("objects");
    const auto object = std::find_if (objects.begin (), objects.end (),
                                      [label] (const nlohmann::json& o) { return (o.at ("label") == label); });
    if (!fs::exists (name + ".ply") || !volume || object == objects.end ())
      return (std::nullopt);
    return (measure (scene, scene.points.at (label), loadPlyMesh (name + ".ply"), *volume,
                     object->at ("voxel_size_m").get<double> ()));
  }

  const TemporaryFolder folder_;
  std::string file_;
};

TEST_P (OsdView, CompletionsAgreeWithTheViewAndTheTable)
{
  const Scene scene = loadScene (file_);
  std::cout << "[osd] " << GetParam () << ": table of " << scene.table.inliers << " points, rms "
            << 1000.0 * scene.table.rms_m << " mm" << std::endl;
  const nlohmann::json summary = complete ();
  ASSERT_TRUE (summary.is_object ()) << GetParam () << ": no summary was written";
  const auto& timings = summary.at ("timings_s");
  const double seconds = (timings.at ("total").get<double> () - timings.at ("read").get<double> ()) /
                         static_cast<double> (std::max<std::size_t> (1, summary.at ("objects").size ()));

  for (const auto& [label, points] : scene.points)
  {
    if (label == 0 || points.size () < least_points)
      continue;
    std::ostringstream line;
    line << GetParam () << " object " << label << ": " << points.size () << " points, ";
    const std::optional<Measures> measures = measureObject (scene, summary, label);
    if (!measures)
    {
      std::cout << "[osd] " << line.str () << "NO MESH" << std::endl;
      ADD_FAILURE () << line.str () << "no mesh, no volume or no entry in the summary";
      continue;
    }
    std::string failing;
    for (const std::string& bar : failingBars (*measures))
      failing += " " + bar;
    line << describe (*measures) << std::fixed << std::setprecision (2) << ", " << seconds << " s";
    std::cout << "[osd] " << line.str () << (failing.empty () ? "" : "; FAILS") << failing << std::endl;
    EXPECT_TRUE (failing.empty ()) << line.str () << "\nfails:" << failing;
  }
}

INSTANTIATE_TEST_SUITE_P (Osd, OsdView, testing::ValuesIn (viewNames ()),
                          [] (const testing::TestParamInfo<std::string>& info) {
                            std::string name = info.param;
                            std::replace_if (
                                name.begin (), name.end (), [] (unsigned char c) { return (std::isalnum (c) == 0); },
                                '_');
                            return (name);
                          });

} // namespace
