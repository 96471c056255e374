// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// compare_equivariance [VIEWS]: how the completed meshes of three simulated things change, each seen in several single
// views, when the world is shifted, scaled or turned. A table of the distance between the reference and the mesh that
// was moved back, as a share of the length of the thing.

#include "complete_views.h"
#include "completion/mesh_distance.h"

#include "pcl_cosection/simulation/sequence_writer.h"
#include <pcl/cosection/simulation/simulated_scene.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

using namespace pcl::cosection;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZL>;

constexpr int default_views = 5;
constexpr double reach = 0.1; // of the length; distances are clamped to this

/** \brief x' = rotation (scale x) + shift. */
struct Change
{
  std::string name;
  double scale = 1.0;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero ();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity ();
};

struct Row
{
  double sum = 0.0, worst_mean = 0.0, largest = 0.0; ///< shares of the length
  int meshes = 0, missing = 0;
};

std::vector<Change>
allChanges ()
{
  std::vector<Change> changes;
  changes.push_back ({"shift by 1 m", 1.0, {1.0, 0.0, 0.0}, Eigen::Quaterniond::Identity ()});
  changes.push_back ({"shift by 1 km", 1.0, {600.0, -800.0, 0.0}, Eigen::Quaterniond::Identity ()});
  changes.push_back ({"shift by 100 km", 1.0, {6e4, 8e4, 0.0}, Eigen::Quaterniond::Identity ()});
  changes.push_back ({"shift to (5e5, 5.4e6, 300)", 1.0, {5e5, 5.4e6, 300.0}, Eigen::Quaterniond::Identity ()});
  for (const char* scale : {"0.001", "0.01", "0.03", "0.1", "10", "1000"})
    changes.push_back (
        {std::string ("scale ") + scale, std::atof (scale), Eigen::Vector3d::Zero (), Eigen::Quaterniond::Identity ()});
  const std::array<Eigen::Quaterniond, 4> rotations = {
      Eigen::Quaterniond (0.8, 0.1, -0.3, 0.5), Eigen::Quaterniond (0.2, 0.7, 0.6, -0.3),
      Eigen::Quaterniond (-0.5, 0.4, 0.1, 0.7), Eigen::Quaterniond (0.1, -0.6, 0.8, 0.2)};
  for (std::size_t r = 0; r < rotations.size (); ++r)
    changes.push_back (
        {"rotation " + std::to_string (r + 1), 1.0, Eigen::Vector3d::Zero (), rotations[r].normalized ()});
  return changes;
}

/** \brief A cup, a box and a bottle on a table, seen from all around by a camera with its noise. */
std::string
sceneOf (int views)
{
  json keys = json::array ();
  for (int v = 0; v < views; ++v)
  {
    const double angle = 0.4 + 2.0 * M_PI * v / views;
    keys.push_back ({{"time", v},
                     {"position", {0.75 * std::cos (angle), 0.75 * std::sin (angle), 0.45 + 0.05 * (v % 3)}},
                     {"look_at", {0.0, 0.0, 0.05}}});
  }
  const json cup = {{"type", "revolution"},
                    {"profile", {{0, 0}, {0.034, 0}, {0.042, 0.1}, {0.038, 0.1}, {0.03, 0.004}, {0, 0.004}}}};
  const json box = {{"type", "box"}, {"size", {0.12, 0.08, 0.14}}, {"rounding", 0.002}, {"position", {0, 0, 0.07}}};
  const json bottle = {{"type", "revolution"},
                       {"profile", {{0, 0}, {0.04, 0}, {0.04, 0.1}, {0.016, 0.14}, {0.016, 0.18}, {0, 0.18}}}};
  json objects = json::array ();
  const auto add = [&] (const char* name, const json& shape, double x, double y, double yaw_deg) {
    const json key = {{"position", {x, y, 0.0005}}, {"rpy_deg", {0.0, 0.0, yaw_deg}}};
    objects.push_back ({{"name", name}, {"id", objects.size () + 1}, {"shape", shape}, {"keys", json::array ({key})}});
  };
  add ("cup", cup, -0.16, 0.08, 0.0);
  add ("box", box, 0.15, 0.1, 25.0);
  add ("bottle", bottle, 0.02, -0.16, 0.0);
  const json table = {{"type", "box"}, {"size", {1.5, 1.2, 0.04}}, {"position", {0, 0, -0.02}}};
  return json ({{"frames", views},
                {"rate", 1},
                {"seed", 1},
                {"camera", {{"width", 640}, {"height", 480}, {"keys", keys}}},
                {"views", {{"every", 1}}},
                {"background", {{"parts", json::array ({table})}}},
                {"objects", objects}})
      .dump ();
}

/** \brief Save a view of the changed world. Only its points' scale and its VIEWPOINT change, which PCL would round. */
void
saveChanged (const fs::path& from, const Change& change, const fs::path& to)
{
  Cloud cloud;
  pcl::io::loadPCDFile (from.string (), cloud);
  for (auto& p : cloud)
    p.getVector3fMap () = (change.scale * p.getVector3fMap ().cast<double> ()).cast<float> ();
  pcl::io::savePCDFileBinary (to.string (), cloud);
  const auto contentOf = [] (const fs::path& path) {
    std::ifstream file (path, std::ios::binary);
    return std::string (std::istreambuf_iterator<char> (file), {});
  };
  const std::string field = "VIEWPOINT";
  const auto lineOf = [&] (const std::string& content) {
    const std::size_t begin = content.find (field);
    return std::make_pair (begin, content.find ('\n', begin) - begin);
  };
  const std::string original = contentOf (from);
  const auto [begin, length] = lineOf (original);
  std::istringstream values (original.substr (begin + field.size (), length - field.size ()));
  std::array<double, 7> v{};
  for (double& value : v)
    values >> value;
  const Eigen::Vector3d place = change.rotation * (change.scale * Eigen::Vector3d (v[0], v[1], v[2])) + change.shift;
  const Eigen::Quaterniond turned = change.rotation * Eigen::Quaterniond (v[3], v[4], v[5], v[6]);
  std::ostringstream line;
  line.precision (std::numeric_limits<double>::max_digits10);
  line << field << ' ' << place.x () << ' ' << place.y () << ' ' << place.z () << ' ' << turned.w () << ' '
       << turned.x () << ' ' << turned.y () << ' ' << turned.z ();
  std::string content = contentOf (to);
  const auto [old_begin, old_length] = lineOf (content);
  content.replace (old_begin, old_length, line.str ());
  std::ofstream (to, std::ios::binary) << content;
}

/** \brief The meshes of a view by their numbers, in the unchanged world. */
std::map<int, TriangleMesh>
complete (const fs::path& path, const Change& change)
{
  Settings settings;
  settings.inputs = {path.string ()};
  CompletedViews completed = completeViews (settings, SceneReaders::ofFiles (), {}, {});
  std::map<int, TriangleMesh> meshes;
  for (ObjectResult& object : completed.scene.objects)
  {
    for (Eigen::Vector3f& vertex : object.mesh.vertices)
    {
      const Eigen::Vector3d moved = vertex.cast<double> () + (completed.origin - change.shift);
      vertex = (change.rotation.inverse () * moved / change.scale).cast<float> ();
    }
    meshes[object.id] = std::move (object.mesh);
  }
  return meshes;
}

double
lengthOf (const TriangleMesh& mesh)
{
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend (vertex);
  return box.sizes ().maxCoeff ();
}

/** \brief Of the vertices of both from the other one. */
void
addDistances (const TriangleMesh& reference, const TriangleMesh& mesh, Row& row)
{
  const double length_m = lengthOf (reference);
  double sum = 0.0, largest = 0.0, count = 0.0;
  const auto measure = [&] (const TriangleMesh& from, const TriangleMesh& to) {
    const test::MeshDistance distance (to, reach * length_m);
    for (const Eigen::Vector3f& vertex : from.vertices)
    {
      const double share = distance (vertex.cast<double> ()) / length_m;
      sum += share;
      largest = std::max (largest, share);
      count += 1.0;
    }
  };
  measure (reference, mesh);
  measure (mesh, reference);
  const double mean = sum / count;
  row.sum += mean;
  row.worst_mean = std::max (row.worst_mean, mean);
  row.largest = std::max (row.largest, largest);
  ++row.meshes;
}

} // namespace

int
main (int argc, char** argv)
{
  const int views = argc > 1 ? std::atoi (argv[1]) : default_views;
  if (views < 1 || argc > 2)
  {
    std::fprintf (stderr, "Usage: compare_equivariance [VIEWS]\n");
    return 2;
  }
  const fs::path folder = fs::temp_directory_path () / ("compare_equivariance_" + std::to_string (::getpid ()));
  writeSequence (parseSceneSpec (sceneOf (views), "three things"), folder.string ());
  const std::vector<Change> changes = allChanges ();
  std::vector<Row> rows (changes.size ());
  const fs::path changed = folder / "changed.pcd";
  for (int v = 0; v < views; ++v)
  {
    std::ostringstream name;
    name << "View" << std::string (v < 10 ? "000" : "00") << v << ".pcd";
    const fs::path view = folder / "views" / name.str ();
    const std::map<int, TriangleMesh> references = complete (view, {});
    for (std::size_t c = 0; c < changes.size (); ++c)
    {
      saveChanged (view, changes[c], changed);
      const std::map<int, TriangleMesh> meshes = complete (changed, changes[c]);
      for (const auto& [id, reference] : references)
        if (const auto found = meshes.find (id); found != meshes.end () && !found->second.empty ())
          addDistances (reference, found->second, rows[c]);
        else
          ++rows[c].missing;
    }
  }
  fs::remove_all (folder);
  std::printf ("| change | meshes | mean | worst mean | largest |\n|---|---|---|---|---|\n");
  for (std::size_t c = 0; c < changes.size (); ++c)
  {
    const Row& row = rows[c];
    std::printf ("| %s | %d | %.1e | %.1e | %.1e |\n", changes[c].name.c_str (), row.meshes,
                 row.sum / std::max (1, row.meshes), row.worst_mean, row.largest);
    if (row.missing > 0)
      std::printf ("%d meshes are missing\n", row.missing);
  }
}
