// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "ablation_picture.h"

#include "pcl_cosection/rendering/picture.h"
#include "pcl_cosection/sequence/stamp_matching.h"
#include "pcl_cosection/view/look_at.h"
#include <pcl/cosection/rendering/rasterizer.h>

#include <pcl/cosection/simulation/simulated_scene.h>

#include <cmath>

using namespace pcl::cosection;

namespace {

constexpr int panel_px = 180;
constexpr double distance_radii = 4.5;
constexpr double margin = 0.95;
constexpr double from_above = 0.45; // of the direction to the camera, upwards

/** \brief Mean direction from the object to the cameras, object frame. */
Eigen::Vector3d
seenFrom (const SceneRecord::Object& object, const std::vector<StampedPose>& camera)
{
  std::vector<double> stamps;
  for (const StampedPose& pose : camera)
    stamps.push_back (pose.stamp);
  const auto poses = posesAtStamps (object.poses, stamps, stampPeriod (stamps));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  for (std::size_t n = 0; n < camera.size (); ++n)
    if (poses[n])
      sum += (poses[n]->inverse () * camera[n].pose.translation ()).normalized ();
  return sum;
}

} // namespace

PictureRows::PictureRows (const SceneRecord& truth)
{
  std::map<int, TriangleMesh> meshes;
  for (const SceneRecord::Object& object : truth.objects)
  {
    meshes[object.id] = object.mesh;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& v : object.mesh.vertices)
      box.extend (v.cast<double> ());
    const double radius = 0.5 * box.diagonal ().norm ();
    Eigen::Vector3d back = -seenFrom (object, truth.camera);
    back.z () = 0.0;
    back = (back.norm () > 1e-6 ? back.normalized () : Eigen::Vector3d::UnitY ()) +
           from_above * Eigen::Vector3d::UnitZ ();
    Row row;
    const double focal = panel_px / 2.0 / margin * (distance_radii - 1.0);
    row.camera = {panel_px, panel_px, focal, focal, (panel_px - 1) / 2.0, (panel_px - 1) / 2.0};
    row.T_object_camera = lookAt (box.center () + distance_radii * radius * back.normalized (), box.center ());
    rows_[object.id] = row;
  }
  add ("truth", meshes);
}

void
PictureRows::add (const std::string&, const std::map<int, TriangleMesh>& meshes)
{
  for (auto& [id, row] : rows_)
  {
    Rasterizer rasterizer (row.camera, row.T_object_camera);
    const auto found = meshes.find (id);
    if (found != meshes.end ())
    {
      TriangleMesh mesh = found->second;
      mesh.colours.clear ();
      if (!mesh.provenance.empty ())
        mesh.colours = provenanceColours (mesh);
      rasterizer.draw (mesh, 1);
    }
    row.panels.push_back (shade (rasterizer.image (), row.camera));
  }
}

Picture
PictureRows::picture () const
{
  Picture all;
  for (const auto& [id, row] : rows_)
  {
    const Picture line = beside (row.panels);
    all.width = line.width;
    all.height += line.height;
    all.pixels.insert (all.pixels.end (), line.pixels.begin (), line.pixels.end ());
  }
  return all;
}
