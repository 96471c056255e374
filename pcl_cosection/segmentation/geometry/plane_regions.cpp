// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "plane_regions.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <set>

namespace pcl::cosection {
namespace {

constexpr float strip_m = 0.06f;      ///< what is narrower along a row or a column is a strip
constexpr int gap_px = 6;             ///< without readings, that do not divide a region
constexpr float beside_sigmas = 3.0f; ///< what is farther from a plane is before or behind it
constexpr float border_sigmas = 1.0f; ///< the same beside a region's border
constexpr int probe_px = 4;           ///< beyond it, where it is looked at what is there
constexpr int border_reach_px = 3;    ///< pixels around a border's that determine its direction
constexpr float free_share = 0.35f;   ///< of the border of a face that ends freely
constexpr float longest_step = 8.0f;  ///< of a pixel on a plane seen at a small angle, relative to one that faces
constexpr int seam_px = 3;            ///< readings on no plane that there may be at an edge
constexpr float edge_cosine = 0.7f;   ///< between the normals of planes that meet at one
constexpr int directions = 12;        ///< in which regions are measured, over half a turn
constexpr int speck_px = 16;          ///< what is smaller does not show how a region beside it ends

class Division
{
public:
  Division (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces, const std::vector<int>& surface_of)
      : grid_ (grid)
      , surfaces_ (surfaces)
      , surface_of_ (surface_of)
      , strip_ (surface_of.size (), 0)
  {
    for (int k = 0; k < directions; ++k)
    {
      const float angle = 3.14159265f * static_cast<float> (k) / directions;
      axes_[k] = Eigen::Vector2f (std::cos (angle), std::sin (angle));
    }
  }

  PlaneRegions run (float max_object_size_m)
  {
    forEachLine (grid_, [&] (int first, int stride, int steps, int axis) { markStrips (first, stride, steps, axis); });
    DisjointSets sets (surface_of_.size ());
    connect (sets);
    number (sets);
    measureAllBorders ();
    joinBehind (max_object_size_m, sets);
    number (sets);
    measureAllBorders ();
    measureEdges ();
    return {std::move (region_of_), std::move (regions_)};
  }

private:
  /** \brief Steps along a row and a column on the plane of a pixel, metres. */
  std::array<Eigen::Vector3f, 2> pixelSteps (int i) const
  {
    const Eigen::Vector3f& normal = surfaces_[surface_of_[i]].normal;
    const Eigen::Vector3f ray = grid_.points[i] / grid_.points[i].z ();
    const float facing = std::min (-1.0f / longest_step, normal.dot (ray));
    const float pixel_m = grid_.pitch * grid_.points[i].z ();
    return {pixel_m * (Eigen::Vector3f::UnitX () - ray * (normal.x () / facing)),
            pixel_m * (Eigen::Vector3f::UnitY () - ray * (normal.y () / facing))};
  }

  /** \brief A line's runs on one plane that are short: 1 + the axis along which the plane is narrow. Single pixels that
   * are on no plane, or another one, do not end a run. */
  void markStrips (int first, int stride, int steps, int axis)
  {
    int surface = -1, begin = 0, last = 0, others = 0;
    float length = 0.0f;
    const auto finish = [&] {
      for (int k = begin; surface >= 0 && length < strip_m && k <= last; ++k)
        if (surface_of_[first + k * stride] == surface)
          strip_[first + k * stride] = static_cast<char> (1 + axis);
      surface = -1;
    };
    for (int k = 0; k < steps; ++k)
    {
      const int i = first + k * stride;
      if (!grid_.valid (i))
        continue;
      if (surface >= 0 && surface_of_[i] == surface)
      {
        length += pixelSteps (i)[axis].norm () * static_cast<float> (k - last);
        last = k;
        others = 0;
        continue;
      }
      if (surface >= 0 && ++others == 1)
        continue;
      finish ();
      if (surface_of_[i] >= 0)
      {
        surface = surface_of_[i];
        begin = last = k;
        others = 0;
        length = pixelSteps (i)[axis].norm ();
      }
    }
    finish ();
  }

  bool alike (int i, int j) const { return (surface_of_[i] == surface_of_[j] && strip_[i] == strip_[j]); }

  /** \brief Unite neighbours, parts of a strip along its line, and parts that missing readings divide. What is nearer
   * and divides parts of a plane is remembered. */
  void connect (DisjointSets& sets)
  {
    const auto unite = [&sets] (int i, int j) {
      sets.unite (static_cast<std::size_t> (i), static_cast<std::size_t> (j));
    };
    forEachLine (grid_, [&] (int first, int stride, int steps, int axis) {
      std::vector<int> last (surfaces_.size (), -1), last_strip (surfaces_.size (), -1);
      for (int k = 0; k < steps; ++k)
      {
        const int i = first + k * stride, surface = surface_of_[i];
        if (surface < 0)
          continue;
        if (const int before = last[surface]; before >= 0)
        {
          const int j = first + before * stride;
          const Between between = before + 1 == k ? Between () : lookBetween (first, stride, before, k);
          if (!between.behind && between.before == 0 && k - before <= gap_px && alike (i, j))
            unite (i, j);
          else if (!between.behind && between.before > between.beside)
            hidden_.emplace_back (j, i);
        }
        last[surface] = k;
        if (strip_[i] != 2 - axis)
          continue;
        if (const int before = last_strip[surface]; before >= 0 && before + 1 < k)
          if (const Between between = lookBetween (first, stride, before, k); !between.behind && between.before == 0)
            unite (i, first + before * stride);
        last_strip[surface] = k;
      }
    });
  }

  /** \brief Readings between two pixels of a line that are on one plane, as to that plane. */
  struct Between
  {
    int before = 0;
    int beside = 0; ///< on no plane, or another one, and not clearly before or behind
    bool behind = false;
  };

  Between lookBetween (int first, int stride, int begin, int end) const
  {
    Between result;
    const int surface = surface_of_[first + end * stride];
    for (int k = begin + 1; k < end && !result.behind; ++k)
    {
      const int i = first + k * stride;
      if (!grid_.valid (i) || surface_of_[i] == surface)
        continue;
      const float height = surfaces_[surface].height (grid_.points[i]) / grid_.sigma (i);
      result.behind = height < -beside_sigmas;
      ++(height > beside_sigmas ? result.before : result.beside);
    }
    return (result);
  }

  /** \brief Number the sets and measure their regions. */
  void number (DisjointSets& sets)
  {
    regions_.clear ();
    region_of_ = sets.numbers ([&] (std::size_t i) { return surface_of_[i] >= 0; });
    std::vector<Eigen::AlignedBox<float, directions>> extents; // along those directions
    for (int i = 0; i < static_cast<int> (surface_of_.size ()); ++i)
    {
      if (region_of_[i] < 0)
        continue;
      if (region_of_[i] == static_cast<int> (regions_.size ())) // its first pixel
      {
        regions_.emplace_back ();
        regions_.back ().surface = surface_of_[i];
        extents.emplace_back ();
      }
      PlaneRegion& region = regions_[region_of_[i]];
      ++region.pixels;
      const auto [along_row, along_column] = pixelSteps (i);
      region.area_m2 += along_row.cross (along_column).norm ();
      const Eigen::Vector2f place = surfaces_[region.surface].place (grid_.points[i]);
      Eigen::Matrix<float, directions, 1> along;
      for (int k = 0; k < directions; ++k)
        along[k] = axes_[k].dot (place);
      extents[region_of_[i]].extend (along);
    }
    for (std::size_t k = 0; k < regions_.size (); ++k)
    {
      const Eigen::Matrix<float, directions, 1> sizes = extents[k].sizes ();
      regions_[k].length_m = sizes.head<directions / 2> ().cwiseMax (sizes.tail<directions / 2> ()).minCoeff ();
    }
  }

  /** \brief Borders are measured beyond specks, as readings near an edge are, and those of the specks by themselves. */
  void measureAllBorders ()
  {
    for (const bool specks : {false, true})
      measureBorders (specks);
  }

  bool isSpeck (int i) const { return (region_of_[i] >= 0 && regions_[region_of_[i]].pixels < speck_px); }

  void measureBorders (bool specks)
  {
    forEachLine (grid_, [&] (int first, int stride, int steps, int axis) {
      int last = -1;
      for (int k = 0; k < steps; ++k)
      {
        const int i = first + k * stride;
        if (!grid_.valid (i) || (!specks && isSpeck (i)))
          continue;
        const int j = first + last * stride;
        if (last >= 0 && region_of_[i] != region_of_[j] && k - last <= grid_.shadowWidth ())
        {
          const auto beyond = [&] (int begin, int step) { // at a crease heights begin with 0
            int pixel = first + begin * stride;
            for (int n = begin + step; std::abs (n - begin) <= probe_px && n >= 0 && n < steps; n += step)
              if (const int next = first + n * stride; grid_.valid (next) && region_of_[next] == region_of_[pixel])
                pixel = next;
            return (pixel);
          };
          if (isSpeck (i) == specks)
            addBorder (i, beyond (last, -1), axis);
          if (isSpeck (j) == specks)
            addBorder (j, beyond (k, 1), axis);
        }
        last = k;
      }
    });
  }

  /** \brief The convex edges at which two planes meet. */
  void measureEdges ()
  {
    forEachLine (grid_, [&] (int first, int stride, int steps, int axis) {
      int last = -1, seam = 0;
      for (int k = 0; k < steps; ++k)
      {
        const int i = first + k * stride, j = first + last * stride;
        if (region_of_[i] < 0)
        {
          seam += grid_.valid (i);
          continue;
        }
        if (last >= 0 && seam <= seam_px && region_of_[i] != region_of_[j] && isEdge (i, j, k - last))
        {
          regions_[region_of_[i]].edge_m[region_of_[j]] += borderLength (i, axis);
          regions_[region_of_[j]].edge_m[region_of_[i]] += borderLength (j, axis);
        }
        last = k;
        seam = 0;
      }
    });
  }

  bool isEdge (int i, int j, int steps) const
  {
    const SupportSurface& a = surfaces_[surface_of_[i]];
    const SupportSurface& b = surfaces_[surface_of_[j]];
    return (a.normal.dot (b.normal) < edge_cosine && a.height (grid_.points[j]) < 0.0f &&
            b.height (grid_.points[i]) < 0.0f && grid_.continuous (i, j, std::min (steps, seam_px)));
  }

  /** \brief The region of pixel \a i ends there along \a axis; pixel \a j is beyond. */
  void addBorder (int i, int j, int axis)
  {
    if (region_of_[i] < 0)
      return;
    PlaneRegion& region = regions_[region_of_[i]];
    const float length = borderLength (i, axis);
    region.border_m += length;
    if (region_of_[j] >= 0 && regions_[region_of_[j]].surface == region.surface)
    {
      region.continued_m[region_of_[j]] += length;
      return;
    }
    const float height = surfaces_[region.surface].height (grid_.points[j]) / grid_.sigma (j);
    if (height > border_sigmas)
      region.before_m[region_of_[j]] += length;
    else if (height < -border_sigmas)
      region.free_m += length;
  }

  /** \brief Length of the border that crosses the side of a pixel: a slanted border crosses sides along both axes, and
   * each counts as much as it faces the border. */
  float borderLength (int i, int axis) const
  {
    Eigen::Vector2f outward = Eigen::Vector2f::Zero ();
    const int u = i % grid_.width, v = i / grid_.width;
    for (int dv = -border_reach_px; dv <= border_reach_px; ++dv)
      for (int du = -border_reach_px; du <= border_reach_px; ++du)
        if (u + du >= 0 && v + dv >= 0 && u + du < grid_.width && v + dv < grid_.height &&
            region_of_[(v + dv) * grid_.width + u + du] == region_of_[i])
          outward -= Eigen::Vector2f (static_cast<float> (du), static_cast<float> (dv));
    if (outward.squaredNorm () < 1e-6f)
      outward = Eigen::Vector2f::Unit (axis);
    outward.normalize ();
    const auto [along_row, along_column] = pixelSteps (i);
    return (std::abs (outward[axis]) * (outward.x () * along_column - outward.y () * along_row).norm ());
  }

  /** \brief Join regions that what is nearer divides, unless both end freely and neither is long. */
  void joinBehind (float max_object_size_m, DisjointSets& sets)
  {
    std::vector<char> open (regions_.size ()); // whether it may go on behind what is nearer
    for (std::size_t k = 0; k < regions_.size (); ++k)
    {
      float ends = regions_[k].free_m;
      for (const auto& [other, length] : regions_[k].before_m)
        ends += length;
      open[k] = regions_[k].length_m > max_object_size_m || regions_[k].free_m <= free_share * ends;
    }
    std::set<std::pair<int, int>> done;
    for (const auto& [i, j] : hidden_)
      if ((open[region_of_[i]] || open[region_of_[j]]) &&
          done.emplace (std::minmax (region_of_[i], region_of_[j])).second)
        sets.unite (static_cast<std::size_t> (i), static_cast<std::size_t> (j));
  }

  const DepthGrid& grid_;
  const std::vector<SupportSurface>& surfaces_;
  const std::vector<int>& surface_of_;
  std::array<Eigen::Vector2f, directions> axes_;
  std::vector<char> strip_;                 ///< one per pixel: 0, or 1 + the axis along which its plane is narrow
  std::vector<std::pair<int, int>> hidden_; ///< pixels of one plane that what is nearer divides
  std::vector<int> region_of_;
  std::vector<PlaneRegion> regions_;
};

} // namespace

PlaneRegions
dividePlanes (const DepthGrid& grid, const std::vector<SupportSurface>& surfaces, const std::vector<int>& surface_of,
              float max_object_size_m)
{
  return (Division (grid, surfaces, surface_of).run (max_object_size_m));
}

} // namespace pcl::cosection
