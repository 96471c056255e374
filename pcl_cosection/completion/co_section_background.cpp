// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "co_section_run.h"

#include "pcl_cosection/mesh/mesh_attributes.h"
#include "volume_layout.h"
#include "voxel_size.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

// The part of a run that completes the background: near the objects, or all of it.

namespace pcl::cosection
{

namespace
{

constexpr double background_voxels_per_object_voxel = 2.0; // of what the points support, or what is asked for
constexpr double background_only_resolution = 128.0;       // voxels along the longest side, if there is no object
constexpr double whole_background_voxel_m = 0.02;          // or smaller, if that gives no more than
constexpr double whole_background_resolution = 128.0;      // voxels along the longest side
constexpr double most_whole_voxels = 256.0 * 256.0 * 256.0;
constexpr double whole_margin_vox = 4.0;
constexpr double growth_vox = 12.0; // beyond where a background that is followed has grown to, as it will grow again

/** \brief A box that is larger than a grid, and by more than it has to where it is. */
Eigen::AlignedBox3d
withRoomToGrow (const Eigen::AlignedBox3d& box, const VoxelGrid& grid)
{
  const Eigen::AlignedBox3d before = boxOf (grid);
  const double room = growth_vox * grid.voxel_size_m;
  Eigen::AlignedBox3d larger = box;
  for (int a = 0; a < 3; ++a)
  {
    if (box.min ()[a] < before.min ()[a])
      larger.min ()[a] -= room;
    if (box.max ()[a] > before.max ()[a])
      larger.max ()[a] += room;
  }
  const bool fits = (larger.sizes ().array () / grid.voxel_size_m + 1.0).prod () <= most_whole_voxels;
  return fits ? larger : box;
}

} // namespace

std::vector<Eigen::AlignedBox3d>
CoSectionRun::backgroundBoxes () const
{
  std::vector<Eigen::AlignedBox3d> boxes;
  if (!scene_.options.whole_background)
    for (const Object& object : objects_)
    {
      if (!object.alive ())
        continue;
      Eigen::AlignedBox3d box;
      for (const Eigen::Isometry3d& T : relativePoses (object, nullptr))
        for (const Eigen::Vector3d& corner : corners (boxOf (object.volume ().grid ())))
          box.extend (T * corner);
      boxes.push_back (box);
    }
  if (boxes.empty ())
  {
    Eigen::AlignedBox3d box;
    for (const OrientedPoint& p : scene_.background)
      if (p.position.allFinite ())
        box.extend (p.position.cast<double> ());
    boxes.push_back (box);
  }
  return uniteOverlapping (std::move (boxes));
}

double
CoSectionRun::backgroundVoxelSize (const std::vector<Eigen::AlignedBox3d>& boxes) const
{
  if (scene_.options.background_voxel_size_m > 0.0)
    return scene_.options.background_voxel_size_m;
  double smallest = std::numeric_limits<double>::infinity ();
  for (const Object& object : objects_)
    if (object.alive ())
      smallest = std::min (smallest, fixedVoxelSize (scene_.options) ? object.voxel_size_m : object.spacing_m);
  const double side = boxes.empty () ? 0.0 : boxes.front ().sizes ().maxCoeff ();
  if (!scene_.options.whole_background)
    return std::isfinite (smallest) ? background_voxels_per_object_voxel * smallest : side / background_only_resolution;
  double voxel = std::min (whole_background_voxel_m, side / whole_background_resolution);
  if (const IncrementalState* earlier = earlierBody (memory_.background, 0)) // stays, unless it is too small
    voxel = earlier->grid ().voxel_size_m;
  while (((boxes.front ().sizes ().array () + 2.0 * whole_margin_vox * voxel) / voxel + 1.0).prod () >
         most_whole_voxels)
    voxel *= 2.0;
  return voxel;
}

std::vector<PlaneContinuation>
CoSectionRun::continuedPlanes () const
{
  std::vector<PlaneContinuation> planes;
  for (const Object& object : objects_)
  {
    if (!object.alive () || object.planes.empty ())
      continue;
    Eigen::AlignedBox3d box;
    for (const Eigen::Isometry3d& T : relativePoses (object, nullptr))
      for (const Eigen::Vector3d& corner : corners (boxOf (object.volume ().grid ())))
        box.extend (T * corner);
    for (const Eigen::Vector4d& plane : object.planes)
      planes.push_back ({plane, box});
  }
  // Where planes of several objects overlap the last one counts; it must not depend on the objects' order.
  std::sort (planes.begin (), planes.end (), [] (const PlaneContinuation& a, const PlaneContinuation& b) {
    const auto key = [] (const PlaneContinuation& p) {
      return std::array<double, 7>{p.plane[0],           p.plane[1],           p.plane[2],          p.plane[3],
                                   p.region.min ().x (), p.region.min ().y (), p.region.min ().z ()};
    };
    return key (a) < key (b);
  });
  return planes;
}

template <typename Function>
void
CoSectionRun::guardedBackground (Function&& f)
{
  try
  {
    f ();
  }
  catch (const Cancelled&)
  {
    throw;
  }
  catch (const Error& e)
  {
    result_.warnings.push_back (std::string ("the background was left out: ") + e.what ());
  }
  catch (const std::bad_alloc&)
  {
    result_.warnings.push_back ("the background was left out: not enough memory");
  }
}

void
CoSectionRun::createBackground ()
{
  if (scene_.background.empty ())
    return;
  const std::vector<Eigen::AlignedBox3d> boxes = backgroundBoxes ();
  const double voxel = backgroundVoxelSize (boxes);
  if (scene_.options.whole_background)
  {
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant (whole_margin_vox * voxel);
    Eigen::AlignedBox3d box (boxes.front ().min () - margin, boxes.front ().max () + margin);
    IncrementalState& body = memory_.background;
    if (body.volume && body.grid ().voxel_size_m == voxel && scene_.options.max_memory_bytes == 0)
      box = withRoomToGrow (box, body.grid ());
    guardedBackground ([&] { place (body, 0, box, voxel, false); });
    return;
  }
  for (const Eigen::AlignedBox3d& box : boxes)
    guardedBackground ([&] {
      auto piece = std::make_unique<IncrementalState> ();
      place (*piece, -1, box, voxel, false);
      pieces_.push_back (std::move (piece));
    });
}

std::vector<IncrementalState*>
CoSectionRun::backgroundBodies ()
{
  std::vector<IncrementalState*> bodies;
  if (memory_.background.volume)
    bodies.push_back (&memory_.background);
  for (const std::unique_ptr<IncrementalState>& piece : pieces_)
    bodies.push_back (piece.get ());
  return bodies;
}

void
CoSectionRun::solveBackground (IncrementalState& body, const std::vector<PlaneContinuation>& planes,
                               UpdateOutput output)
{
  ShapeVolume& volume = *body.volume;
  timed ("constraints", [&] { volume.prepare (*body.evidence, planes); });
  if (mode_ == Mode::Once)
    body.evidence.reset ();
  if (!volume.hasData ())
    return;
  BackgroundResult piece;
  timed ("solve", [&] {
    const ProgressCallback progress = [this] (const std::string&, double f) {
      report ("background", 0.05 + 0.25 * f);
      return true;
    };
    piece.solver = mode_ == Mode::Follow ? volume.follow (progress) : volume.solve (Resolution::Full, progress);
    piece.solved_share = volume.solvedShare ();
  });
  if (output == UpdateOutput::Meshes)
    timed ("mesh", [&] {
      TriangleMesh mesh = volume.trimmedMesh (scene_.background);
      transferAttributes (scene_.background, volume.grid (), mesh);
      appendMesh (result_.background, mesh);
    });
  piece.signed_distance = std::make_shared<SignedDistanceField> (volume.solvedField ());
  background_.push_back (piece.signed_distance);
  result_.background_pieces.push_back (std::move (piece));
}

void
CoSectionRun::solveBackground (UpdateOutput output)
{
  const std::vector<IncrementalState*> bodies = backgroundBodies ();
  if (bodies.empty ())
    return;
  const std::vector<PlaneContinuation> planes = continuedPlanes ();
  for (IncrementalState* body : bodies)
    guardedBackground ([&] { solveBackground (*body, planes, output); });
  pieces_.clear ();
}

} // namespace pcl::cosection
