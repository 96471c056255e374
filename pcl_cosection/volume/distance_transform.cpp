// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "distance_transform.h"
#include "pcl_cosection/common/parallel.h"
#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl::cosection {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity ();

/** \brief Squared distance along one row of voxels to the nearest one in \a mask. */
void
transformRow (const std::uint8_t* mask, float* squared, int n)
{
  float distance = infinity;
  for (int i = 0; i < n; ++i)
  {
    distance = (mask[i] != 0 ? 0.0f : distance + 1.0f);
    squared[i] = distance;
  }
  distance = infinity;
  for (int i = n - 1; i >= 0; --i)
  {
    distance = (mask[i] != 0 ? 0.0f : distance + 1.0f);
    const float nearest = std::min (squared[i], distance);
    squared[i] = nearest * nearest;
  }
}

/** \brief The lower envelope of parabolas of Felzenszwalb and Huttenlocher, for lines of \a length
 * samples; keeps its workspace from line to line. */
class LowerEnvelope
{
public:
  explicit LowerEnvelope (int length)
      : length_ (length)
      , apex_ (length)
      , height_ (length)
      , begin_ (length + 1)
      , half_reciprocal_ (length)
  {
    for (int n = 1; n < length; ++n)
      half_reciprocal_[n] = 0.5 / n;
  }

  /** \brief f (q) := min_p (q - p)^2 + f (p), in place. */
  void transform (float* f)
  {
    int last = -1; // parabolas in the envelope - 1
    for (int q = 0; q < length_; ++q)
    {
      if (f[q] == infinity)
        continue;
      const double height = static_cast<double> (f[q]) + static_cast<double> (q) * q;
      double begin = -std::numeric_limits<double>::infinity ();
      while (last >= 0)
      {
        // where the new parabola falls below the last one
        begin = (height - height_[last]) * half_reciprocal_[q - apex_[last]];
        if (begin > begin_[last])
          break;
        --last;
      }
      ++last;
      apex_[last] = q;
      height_[last] = height;
      begin_[last] = (last == 0 ? -std::numeric_limits<double>::infinity () : begin);
    }
    if (last < 0)
      return;
    begin_[last + 1] = std::numeric_limits<double>::infinity ();
    int current = 0;
    for (int q = 0; q < length_; ++q)
    {
      while (begin_[current + 1] < q)
        ++current;
      const int apex = apex_[current];
      f[q] = static_cast<float> (height_[current] + static_cast<double> (q) * (q - 2 * apex));
    }
  }

private:
  int length_;
  std::vector<int> apex_;
  std::vector<double> height_; // f (apex) + apex^2
  std::vector<double> begin_;  // where each parabola becomes the lowest
  std::vector<double> half_reciprocal_;
};

/** \brief Transform \a columns neighbouring lines whose samples are \a stride apart, through a
 * small transposed copy, so that memory is read and written in whole cache lines. */
class LineBatch
{
public:
  static constexpr int columns = 16;

  explicit LineBatch (int length)
      : length_ (length)
      , lines_ (static_cast<std::size_t> (columns) * length)
      , envelope_ (length)
  {}

  template <typename Finish> void transform (float* first, int count, std::size_t stride, Finish&& finish)
  {
    for (int q = 0; q < length_; ++q)
      for (int c = 0; c < count; ++c)
        lines_[static_cast<std::size_t> (c) * length_ + q] = first[q * stride + c];
    for (int c = 0; c < count; ++c)
      envelope_.transform (&lines_[static_cast<std::size_t> (c) * length_]);
    for (int q = 0; q < length_; ++q)
      for (int c = 0; c < count; ++c)
        first[q * stride + c] = finish (lines_[static_cast<std::size_t> (c) * length_ + q]);
  }

private:
  int length_;
  std::vector<float> lines_;
  LowerEnvelope envelope_;
};

} // namespace

std::vector<float>
distanceTransform (const Eigen::Vector3i& dims, const std::vector<std::uint8_t>& mask, int threads)
{
  if (dims.minCoeff () < 0 || mask.size () != static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z ())
    throw InvalidArgument ("distance transform: the mask must have one value per voxel");
  std::vector<float> distance (mask.size ());
  if (mask.empty ())
    return distance;
  const std::size_t row = dims.x ();
  const std::size_t slice = row * dims.y ();

  parallelChunks (0, dims.z (), threads, [&] (int first, int last) {
    LineBatch batch (dims.y ());
    for (int k = first; k < last; ++k)
    {
      for (int j = 0; j < dims.y (); ++j)
        transformRow (&mask[k * slice + j * row], &distance[k * slice + j * row], dims.x ());
      for (int i = 0; i < dims.x (); i += LineBatch::columns)
        batch.transform (&distance[k * slice + i], std::min (LineBatch::columns, dims.x () - i), row,
                         [] (float squared) { return squared; });
    }
  });
  parallelChunks (0, dims.y (), threads, [&] (int first, int last) {
    LineBatch batch (dims.z ());
    for (int j = first; j < last; ++j)
      for (int i = 0; i < dims.x (); i += LineBatch::columns)
        batch.transform (&distance[j * row + i], std::min (LineBatch::columns, dims.x () - i), slice,
                         [] (float squared) { return std::sqrt (squared); });
  });
  return distance;
}

} // namespace pcl::cosection
