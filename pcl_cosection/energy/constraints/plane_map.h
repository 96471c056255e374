// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief A bitmap on a plane, whose cells are set by points. */
class PlaneMap
{
public:
  /** \param[in] margin cells beyond \a low and \a high, at least the radius of close () */
  PlaneMap (const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell, int margin)
      : low_ (low - Eigen::Vector2d::Constant (margin * cell))
      , cell_ (cell)
      , width_ (static_cast<int> ((high.x () - low.x ()) / cell) + 2 * margin + 1)
      , height_ (static_cast<int> ((high.y () - low.y ()) / cell) + 2 * margin + 1)
      , cells_ (static_cast<std::size_t> (width_) * height_, 0)
  {}

  void set (const Eigen::Vector2d& p) { cells_[index (p)] = 1; }

  bool at (const Eigen::Vector2d& p) const
  {
    const Eigen::Vector2d q = (p - low_) / cell_;
    return q.x () >= 0.0 && q.y () >= 0.0 && q.x () < width_ && q.y () < height_ && cells_[index (p)] != 0;
  }

  /** \brief Fill gaps of up to twice \a radius cells. */
  void close (int radius)
  {
    spread (radius, 1);
    spread (radius, 0);
  }

  /** \brief Centres of the cells of each connected component. */
  std::vector<std::vector<Eigen::Vector2d>> parts () const
  {
    std::vector<std::vector<Eigen::Vector2d>> parts;
    std::vector<std::uint8_t> left = cells_;
    std::vector<std::size_t> open;
    for (std::size_t seed = 0; seed < left.size (); ++seed)
    {
      if (!left[seed])
        continue;
      left[seed] = 0;
      open.push_back (seed);
      parts.emplace_back ();
      while (!open.empty ())
      {
        const auto x = static_cast<int> (open.back () % width_);
        const auto y = static_cast<int> (open.back () / width_);
        open.pop_back ();
        parts.back ().emplace_back (low_ + cell_ * Eigen::Vector2d (x + 0.5, y + 0.5));
        for (int j = std::max (0, y - 1); j <= std::min (height_ - 1, y + 1); ++j)
          for (int i = std::max (0, x - 1); i <= std::min (width_ - 1, x + 1); ++i)
          {
            const std::size_t n = static_cast<std::size_t> (j) * width_ + i;
            if (!left[n])
              continue;
            left[n] = 0;
            open.push_back (n);
          }
      }
    }
    return parts;
  }

private:
  std::size_t index (const Eigen::Vector2d& p) const
  {
    const Eigen::Vector2d q = (p - low_) / cell_;
    return static_cast<std::size_t> (q.y ()) * width_ + static_cast<std::size_t> (q.x ());
  }

  /** \brief Dilation of the cells that have \a value, with a square of \a radius cells. */
  void spread (int radius, std::uint8_t value)
  {
    for (const bool along_x : {true, false})
    {
      const std::vector<std::uint8_t> before = cells_;
      for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
          for (int r = -radius; r <= radius; ++r)
          {
            const int i = along_x ? x + r : x;
            const int j = along_x ? y : y + r;
            if (i >= 0 && j >= 0 && i < width_ && j < height_ &&
                before[static_cast<std::size_t> (j) * width_ + i] == value)
              cells_[static_cast<std::size_t> (y) * width_ + x] = value;
          }
    }
  }

  Eigen::Vector2d low_;
  double cell_;
  int width_;
  int height_;
  std::vector<std::uint8_t> cells_;
};

} // namespace pcl::cosection
