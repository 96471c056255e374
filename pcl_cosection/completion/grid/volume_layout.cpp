// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "volume_layout.h"

#include "pcl_cosection/common/byte_text.h"
#include "pcl_cosection/common/trimmed_box.h"
#include "pcl_cosection/energy/body_energy.h"
#include "pcl_cosection/priors/extent_bounds.h"
#include "pcl_cosection/view/visibility/visibility.h"

#include "pcl_cosection/common/parallel.h"
#include "pcl_cosection/priors/extent_prior.h"
#include "pcl_cosection/volume/distance_transform.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr double outlier_share = 0.005; // of the points, at either end of each axis
constexpr int min_axis = 8;             // voxels
constexpr double max_axis = 8192;       // voxels
constexpr double min_extent_m = 1e-6;
// Cells along the longest side in the search for the region where an object may be. It is no whole number, so that
// sides do not run along the borders of cells.
constexpr double possible_cells = 20.6;
constexpr double possible_margin_vox = 6.0; // around that region

/** \brief Whether any view sees a place free. */
class AnySeesFree
{
public:
  AnySeesFree (const OcclusionMap::Views& views, double margin_m) : views_ (views), margin_m_ (margin_m)
  {
    for (const auto& [view, T_points_sensor] : views)
      T_sensor_points_.push_back (T_points_sensor.inverse ());
  }

  bool operator() (const Eigen::Vector3d& p) const
  {
    for (std::size_t v = 0; v < views_.size (); ++v)
      if (visibilityOf (T_sensor_points_[v] * p, *views_[v].first, margin_m_) == PointVisibility::Free)
        return true;
    return false;
  }

private:
  const OcclusionMap::Views& views_;
  double margin_m_;
  std::vector<Eigen::Isometry3d> T_sensor_points_;
};

/** \brief Whether a place is lower than \a height_m above any of the planes. */
bool
isBelow (const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& p, double height_m)
{
  return std::any_of (planes.begin (), planes.end (),
                      [&] (const Eigen::Vector4d& plane) { return plane.head<3> ().dot (p) + plane[3] < height_m; });
}

} // namespace

VoxelGrid
layoutBox (const Eigen::AlignedBox3d& box, double voxel_size_m)
{
  VoxelGrid grid;
  grid.voxel_size_m = voxel_size_m;
  const Eigen::Vector3d cells = box.sizes () / voxel_size_m;
  if (!(cells.maxCoeff () < max_axis))
  {
    std::ostringstream message;
    message << "voxel size " << voxel_size_m << " m gives " << cells.maxCoeff () << " voxels along one side; at most "
            << max_axis << " are possible";
    throw InvalidArgument (message.str ());
  }
  for (int a = 0; a < 3; ++a)
    grid.dims[a] = std::max (min_axis, static_cast<int> (std::ceil (cells[a])) + 1);
  grid.origin_m = box.center () - 0.5 * voxel_size_m * (grid.dims.cast<double> () - Eigen::Vector3d::Ones ());
  return grid;
}

void
checkMemory (const VoxelGrid& grid, std::size_t limit_bytes, std::size_t used_bytes)
{
  const std::size_t bytes = estimateBytes (grid);
  if (limit_bytes == 0 || (used_bytes < limit_bytes && bytes <= limit_bytes - used_bytes))
    return;
  std::ostringstream message;
  message << "a volume of " << grid.dims.x () << " x " << grid.dims.y () << " x " << grid.dims.z () << " voxels needs "
          << byteText (bytes) << "; " << byteText (limit_bytes) << " are allowed";
  if (used_bytes > 0)
    message << ", of which points, views and other volumes take " << byteText (used_bytes);
  message << ": use larger voxels or allow more memory";
  throw MemoryLimitExceeded (message.str ());
}

Eigen::AlignedBox3d
observedBox (const std::vector<OrientedPoint>& points, int threads)
{
  if (points.empty ())
    throw DegenerateInput ("no points with finite coordinates and a normal");
  if (!std::all_of (points.begin (), points.end (), [] (const OrientedPoint& p) { return p.position.allFinite (); }))
    throw DegenerateInput ("some points have no finite coordinates");
  const auto box = trimmedBox<double> (
      points, outlier_share, [] (const OrientedPoint& p) { return p.position; }, threads);
  if (!(box.sizes ().maxCoeff () > min_extent_m))
    throw DegenerateInput ("all points lie on one spot");
  return box;
}

Eigen::AlignedBox3d
possibleBox (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& observed,
             const Eigen::AlignedBox3d& known, const Eigen::Vector3d& extents_m, double voxel_size_m,
             const OcclusionMap::Views& views, const OcclusionMap& places, const std::vector<Eigen::Vector4d>& planes,
             int threads)
{
  const ExtentPrior prior;
  VoxelGrid cells;
  cells.voxel_size_m = observed.sizes ().maxCoeff () / possible_cells;
  const double farthest = prior.farthest (extents_m);
  cells.dims = ((observed.sizes ().array () + 2.0 * farthest) / cells.voxel_size_m).ceil ().cast<int> () + 1;
  cells.origin_m = observed.center () -
                   0.5 * cells.voxel_size_m * (cells.dims.cast<double> () - Eigen::Vector3d::Ones ());
  std::vector<std::uint8_t> data (cells.size (), 0);
  const double cells_per_m = 1.0 / cells.voxel_size_m;
  for (const OrientedPoint& point : points)
  {
    const Eigen::Vector3d p = point.position.cast<double> ();
    if (!observed.contains (p))
      continue;
    const Eigen::Array3i at = (cells_per_m * (p - cells.origin_m).array () + 0.5).cast<int> (); // the nearest: positive
    data[cells.index (at.x (), at.y (), at.z ())] = 1;
  }
  const std::vector<float> distance = distanceTransform (cells.dims, data, threads);
  const auto allowed = [&] (Hidden hidden) {
    return static_cast<float> (allowedFactor (prior, hidden) * (extents_m / cells.voxel_size_m)[1]);
  };
  const float most = std::max ({allowed (Hidden::ByObject), allowed (Hidden::ByOther), allowed (Hidden::Nothing)});
  const double margin = 0.5 * cells.voxel_size_m + possible_margin_vox * voxel_size_m;
  const AnySeesFree free (views, cells.voxel_size_m);
  Eigen::AlignedBox3d box = observed.merged (known);
  for (int k = 0; k < cells.dims.z (); ++k)
    for (int j = 0; j < cells.dims.y (); ++j)
      for (int i = 0; i < cells.dims.x (); ++i)
      {
        const Eigen::Vector3d p = cells.center (i, j, k);
        const float away = distance[cells.index (i, j, k)];
        if (away > most || box.contains (p) || isBelow (planes, p, 0.5 * cells.voxel_size_m) || free (p))
          continue;
        if (away <= allowed (places.at (p)))
          box.extend (p);
      }
  // Whole voxels from the observed box, so that the lattice depends on that box alone.
  const auto whole = [&] (const Eigen::Vector3d& beyond) {
    return Eigen::Vector3d (voxel_size_m * ((beyond.array () + margin) / voxel_size_m).ceil ());
  };
  return {observed.min () - whole (observed.min () - box.min ()),
          observed.max () + whole (box.max () - observed.max ())};
}

Eigen::AlignedBox3d
unseenBox (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& observed,
           const Eigen::AlignedBox3d& within, double voxel_size_m, const OcclusionMap::Views& views,
           const std::vector<Eigen::Vector4d>& planes, double layer_m)
{
  VoxelGrid cells;
  cells.voxel_size_m = observed.sizes ().maxCoeff () / possible_cells;
  cells.dims = (within.sizes () / cells.voxel_size_m).array ().ceil ().cast<int> () + 1;
  cells.origin_m = within.min ();
  const AnySeesFree free (views, cells.voxel_size_m);
  const auto isUnseen = [&] (const Eigen::Vector3d& p) { // and not only behind single pixels without a reading
    bool unseen = !free (p);
    for (int side = 0; side < 6 && unseen; ++side)
      unseen = !free (p + (side % 2 == 0 ? 0.5 : -0.5) * cells.voxel_size_m * Eigen::Vector3d::Unit (side / 2));
    return unseen;
  };
  std::vector<bool> reached (cells.size (), false);
  std::vector<Eigen::Vector3i> open;
  Eigen::AlignedBox3d box = observed;
  const auto reach = [&] (const Eigen::Vector3i& cell) {
    reached[cells.index (cell.x (), cell.y (), cell.z ())] = true;
    box.extend (cells.center (cell.x (), cell.y (), cell.z ()));
    open.push_back (cell);
  };
  for (const OrientedPoint& point : points)
    if (const auto cell = cells.nearest (point.position.cast<double> ()))
      if (!reached[cells.index (cell->x (), cell->y (), cell->z ())])
        reach (*cell);
  while (!open.empty ())
  {
    const Eigen::Vector3i cell = open.back ();
    open.pop_back ();
    for (int side = 0; side < 6; ++side)
    {
      Eigen::Vector3i next = cell;
      next[side / 2] += side % 2 == 0 ? -1 : 1;
      if (!cells.contains (next.x (), next.y (), next.z ()) || reached[cells.index (next.x (), next.y (), next.z ())])
        continue;
      const Eigen::Vector3d p = cells.center (next.x (), next.y (), next.z ());
      if (!isBelow (planes, p, layer_m) && isUnseen (p))
        reach (next);
    }
  }
  const double margin = cells.voxel_size_m + possible_margin_vox * voxel_size_m;
  return {box.min ().array () - margin, box.max ().array () + margin};
}

Eigen::AlignedBox3d
boxOf (const VoxelGrid& grid)
{
  return {grid.origin_m, grid.center (grid.dims.x () - 1, grid.dims.y () - 1, grid.dims.z () - 1)};
}

std::vector<Eigen::Vector3d>
corners (const Eigen::AlignedBox3d& box)
{
  std::vector<Eigen::Vector3d> points;
  for (int c = 0; c < 8; ++c)
    points.push_back (box.corner (static_cast<Eigen::AlignedBox3d::CornerType> (c)));
  return points;
}

std::vector<Eigen::AlignedBox3d>
uniteOverlapping (std::vector<Eigen::AlignedBox3d> boxes)
{
  bool changed = true;
  while (changed)
  {
    changed = false;
    for (std::size_t i = 0; i < boxes.size (); ++i)
      for (std::size_t j = boxes.size (); j-- > i + 1;)
        if (boxes[i].intersects (boxes[j]))
        {
          boxes[i].extend (boxes[j]);
          boxes.erase (boxes.begin () + static_cast<std::ptrdiff_t> (j));
          changed = true;
        }
  }
  return boxes;
}

} // namespace pcl::cosection
