// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl::cosection
{

/** \brief Where the sums of the data term go, and the planes that the calling thread may touch. */
struct SplatTarget
{
  float* weight;
  float* weighted_target;
  float* count;
  int nx, ny;
  int first_plane, last_plane;
};

/** \brief The planes of a strip of a volume that points are just being added to.
 *
 * A point reaches some fifty rows of three arrays, which in a large volume lie on as many pages of memory. Here they
 * are close together. Planes that are complete are added to the volume. */
class SplatTile
{
public:
  static constexpr int width = 32; // along x, of the voxels that points are in

  /** \param[in] reach voxels between a point and the farthest that it reaches */
  SplatTile (const SplatTarget& to, int reach)
      : to_ (to)
      , reach_ (reach)
      , stride_ ((width + 2 * reach) / block * block + 2 * block) // whole blocks, and what is read behind a row
  {
    while (slots_ < static_cast<std::size_t> (2 * reach + 1))
      slots_ *= 2;
    values_.assign (slots_ * to.ny * 3 * stride_, 0.0f);
    touched_.assign (slots_ * to.ny, 0);
  }

  /** \brief Go to the points whose voxels are the \a n th strip; all planes must be finished. */
  void start (int n)
  {
    x_ = n * width - 2 * reach_;
    next_ = to_.first_plane;
  }

  /** \brief The weights of plane \a k from voxel \a i on; those of row j begin rowStride () * j behind them, the
   * weighted targets and counts arrayStride () behind each other. */
  float* plane (int i, int k) { return values_.data () + slot (k) * to_.ny * rowStride () + (i - x_); }

  std::size_t rowStride () const { return 3 * stride_; }

  std::size_t arrayStride () const { return stride_; }

  /** \brief The blocks of a row that n voxels from \a i on are in, for touch (). */
  std::uint16_t blocks (int i, int n) const
  {
    const int first = (i - x_) / block;
    const int last = (i - x_ + n - 1) / block;
    return static_cast<std::uint16_t> ((2u << last) - (1u << first));
  }

  /** \brief What was not said to be touched is not added to the volume. */
  void touch (int k, int first_row, int rows, std::uint16_t blocks)
  {
    std::uint16_t* touched = touched_.data () + slot (k) * to_.ny + first_row;
    for (int j = 0; j < rows; ++j)
      touched[j] |= blocks;
  }

  /** \brief Add the planes before \a plane, which no point to come reaches, to the volume. */
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
