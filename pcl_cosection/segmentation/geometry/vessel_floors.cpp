// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "vessel_floors.h"

#include "pcl_cosection/common/robust_weights.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <map>

namespace pcl::cosection {
namespace {

constexpr int min_floor_px = 40; ///< the mean of so many is six times as exact as a reading
constexpr int contact_px = 4;    ///< from a part to what touches it, as findRoomEdges () has it
// In 109 views of scanned things the parts of a table that objects enclose lie within 0.4 standard deviations of a
// reading of the table around, and floors 1.1 or more above it.
constexpr float raised_sigmas = 0.75f;
constexpr int rounds = 5; ///< of the robust fit

/** \brief A connected part of a surface. */
struct SurfacePart
{
  std::vector<int> pixels;
  Eigen::AlignedBox2i box;             ///< in the image
  std::map<std::uint32_t, int> beside; ///< pixels at which an object goes on from it, by its label
};

class VesselFloors
{
public:
  VesselFloors (const DepthGrid& grid, const Room& room, std::vector<std::uint32_t>& labels)
      : grid_ (grid)
      , room_ (room)
      , labels_ (labels)
      , part_of_ (connectPixels (grid, 1, [&] (int i, int j) {
                    return onRoom (i) && onRoom (j) && room.surface_of[i] == room.surface_of[j];
                  }).numbers ([&] (std::size_t i) { return onRoom (static_cast<int> (i)); }))
  {
    for (int i = 0; i < static_cast<int> (part_of_.size ()); ++i)
      if (part_of_[i] >= 0)
      {
        if (part_of_[i] == static_cast<int> (parts_.size ())) // its first pixel
          parts_.emplace_back ();
        parts_[part_of_[i]].pixels.push_back (i);
        parts_[part_of_[i]].box.extend (Eigen::Vector2i (i % grid.width, i / grid.width));
      }
    findContacts ();
  }

  void label ()
  {
    std::vector<std::pair<int, std::uint32_t>> floors;
    for (int k = 0; k < static_cast<int> (parts_.size ()); ++k)
      if (const auto object = std::max_element (parts_[k].beside.begin (), parts_[k].beside.end (),
                                                [] (const auto& a, const auto& b) { return a.second < b.second; });
          object != parts_[k].beside.end () && isRaised (k))
        floors.emplace_back (k, object->first);
    for (const auto& [part, object] : floors)
      for (const int i : parts_[part].pixels)
        labels_[i] = object;
  }

private:
  bool onRoom (int i) const { return (labels_[i] == 0 && room_.surface_of[i] >= 0); }

  void findContacts ()
  {
    forEachLine (grid_, [&] (int first, int stride, int steps, int) {
      int last = -1;
      for (int k = 0; k < steps; ++k)
      {
        const int i = first + k * stride, j = first + last * stride;
        if (part_of_[i] < 0 && labels_[i] == 0)
          continue;
        if (last >= 0 && k - last <= contact_px && grid_.continuous (i, j, k - last))
          for (const auto& [on, beside] : {std::make_pair (i, j), std::make_pair (j, i)})
            if (part_of_[on] >= 0 && labels_[beside] > 0)
              ++parts_[part_of_[on]].beside[labels_[beside]];
        last = k;
      }
    });
  }

  /** \brief Whether a part is higher than the rest of its surface, as a plane fits this to heights around the part. */
  bool isRaised (int k) const
  {
    const SurfacePart& part = parts_[k];
    const Eigen::AlignedBox2i image (Eigen::Vector2i::Zero (), Eigen::Vector2i (grid_.width - 1, grid_.height - 1));
    if (static_cast<int> (part.pixels.size ()) < min_floor_px || (part.box.min ().array () == 0).any () ||
        (part.box.max ().array () == image.max ().array ()).any ())
      return (false);
    const SupportSurface& surface = room_.surfaces[room_.surface_of[part.pixels.front ()]];
    const auto terms = [&] (int i) {
      return Eigen::Vector3d (1.0, i % grid_.width - part.box.center ().x (),
                              i / grid_.width - part.box.center ().y ());
    };
    const Eigen::Vector2i size = part.box.sizes () + Eigen::Vector2i::Ones ();
    const Eigen::AlignedBox2i around = Eigen::AlignedBox2i (part.box.min () - size, part.box.max () + size)
                                           .intersection (image);
    std::vector<int> others;
    for (int v = around.min ().y (); v <= around.max ().y (); ++v)
      for (int u = around.min ().x (); u <= around.max ().x (); ++u)
        if (const int i = v * grid_.width + u;
            part_of_[i] >= 0 && part_of_[i] != k && room_.surface_of[i] == room_.surface_of[part.pixels.front ()])
          others.push_back (i);
    if (others.size () < part.pixels.size ())
      return (false);
    Eigen::Vector3d plane = Eigen::Vector3d::Zero ();
    for (int round = 0; round < rounds; ++round)
    {
      Eigen::Matrix3d lhs = Eigen::Matrix3d::Zero ();
      Eigen::Vector3d rhs = Eigen::Vector3d::Zero ();
      for (const int i : others)
      {
        const Eigen::Vector3d t = terms (i);
        const double height_m = surface.height (grid_.points[i]);
        const double weight = huberWeight<double> (std::abs (height_m - plane.dot (t)), grid_.sigma (i));
        lhs += weight * t * t.transpose ();
        rhs += weight * height_m * t;
      }
      plane = lhs.ldlt ().solve (rhs);
    }
    double raised_m = 0.0, sigma_m = 0.0;
    for (const int i : part.pixels)
    {
      raised_m += surface.height (grid_.points[i]) - plane.dot (terms (i));
      sigma_m += grid_.sigma (i);
    }
    return (raised_m > raised_sigmas * sigma_m);
  }

  const DepthGrid& grid_;
  const Room& room_;
  std::vector<std::uint32_t>& labels_;
  const std::vector<int> part_of_; ///< one per pixel, -1 for none
  std::vector<SurfacePart> parts_;
};

} // namespace

void
labelVesselFloors (const DepthGrid& grid, const Room& room, std::vector<std::uint32_t>& labels)
{
  VesselFloors (grid, room, labels).label ();
}

} // namespace pcl::cosection
