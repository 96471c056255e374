// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection {

/** \brief The sums of the data term, and the planes that the calling thread may write. */
struct SplatTarget
{
  float* weight;
  float* weighted_target;
  float* count;
  int nx, ny;
  int first_plane, last_plane;
};

/** \brief A buffer of the planes of a strip of the volume to which points are being added.
 *
 * A point changes some fifty rows of three arrays, which in a large volume lie on as many pages of memory. In the
 * buffer they are close together. Complete planes are added to the volume. */
class SplatTile
{
public:
  static constexpr int width = 32; // of a strip along x, voxels

  /** \param[in] reach cutoff of a point's Gaussian, voxels */
  SplatTile (const SplatTarget& to, int reach)
      : to_ (to)
      , reach_ (reach)
      , stride_ ((width + 2 * reach) / block * block + 2 * block) // whole blocks, and those read behind a row
  {
    while (slots_ < static_cast<std::size_t> (2 * reach + 1))
      slots_ *= 2;
    values_.assign (slots_ * to.ny * 3 * stride_, 0.0f);
    touched_.assign (slots_ * to.ny, 0);
  }

  /** \brief Begin the \a n th strip; all planes must be finished. */
  void start (int n)
  {
    x_ = n * width - 2 * reach_;
    next_ = to_.first_plane;
  }

  /** \brief The weights of plane \a k from voxel \a i on. Row j begins rowStride () * j values later; weighted targets
   * and counts follow arrayStride () and 2 arrayStride () values later. */
  float* plane (int i, int k) { return values_.data () + slot (k) * to_.ny * rowStride () + (i - x_); }

  std::size_t rowStride () const { return 3 * stride_; }

  std::size_t arrayStride () const { return stride_; }

  /** \brief The blocks of a row that hold the n voxels from \a i on, as bits for touch (). */
  std::uint16_t blocks (int i, int n) const
  {
    const int first = (i - x_) / block;
    const int last = (i - x_ + n - 1) / block;
    return static_cast<std::uint16_t> ((2u << last) - (1u << first));
  }

  /** \brief Mark blocks as changed: only those are added to the volume. */
  void touch (int k, int first_row, int rows, std::uint16_t blocks)
  {
    std::uint16_t* touched = touched_.data () + slot (k) * to_.ny + first_row;
    for (int j = 0; j < rows; ++j)
      touched[j] |= blocks;
  }

  /** \brief Add the planes before \a plane to the volume; no later point may change them. */
  void finishBefore (int plane)
  {
    for (; next_ < std::min (plane, to_.last_plane); ++next_)
      for (int j = 0; j < to_.ny; ++j)
        if (std::uint16_t& touched = touched_[slot (next_) * to_.ny + j])
        {
          for (int b = 0; touched >> b; ++b)
            if (touched >> b & 1)
              finishBlock (j, b);
          touched = 0;
        }
  }

private:
  static constexpr int block = 8; // voxels

  std::size_t slot (int k) const { return static_cast<std::size_t> (k) & (slots_ - 1); }

  void finishBlock (int j, int b)
  {
    float* from = values_.data () + (slot (next_) * to_.ny + j) * rowStride () + b * block;
    const int x = x_ + b * block;
    const int begin = std::max (0, -x);
    const int end = std::min (block, to_.nx - x);
    const std::ptrdiff_t row = (static_cast<std::ptrdiff_t> (next_) * to_.ny + j) * to_.nx + x;
    for (float* array : {to_.weight, to_.weighted_target, to_.count})
    {
      for (int i = begin; i < end; ++i)
        array[row + i] += from[i];
      std::fill_n (from, block, 0.0f);
      from += stride_;
    }
  }

  SplatTarget to_;
  int reach_;
  int x_ = 0;    // of the first value of a row
  int next_ = 0; // first plane that is not complete
  std::size_t slots_ = 1;
  std::size_t stride_;
  std::vector<float> values_;          // [slot][row][array][x]
  std::vector<std::uint16_t> touched_; // blocks, by [slot][row]
};

} // namespace pcl::cosection
