// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/free_space_filter.h>

#include <pcl/common/point_tests.h>
#include <pcl/console/print.h>
#include <pcl/filters/impl/filter_indices.hpp> // the base's own applyFilter (): libpcl_filters need not be loaded
#include <pcl/point_types.h>

#include <cmath>
#include <string>

namespace pcl::cosection
{

template <typename PointT>
FreeSpaceFilter<PointT>::FreeSpaceFilter (bool extract_removed_indices) : Base (extract_removed_indices)
{
  filter_name_ = "cosection::FreeSpaceFilter";
}

template <typename PointT> FreeSpaceFilter<PointT>::~FreeSpaceFilter () = default;

template <typename PointT>
void
FreeSpaceFilter<PointT>::addView (const DepthView& view)
{
  view.validate ();
  views_.emplace_back (view);
}

template <typename PointT>
void
FreeSpaceFilter<PointT>::clearViews ()
{
  views_.clear ();
}

template <typename PointT>
void
FreeSpaceFilter<PointT>::setMargin (float margin_m)
{
  if (!(margin_m >= 0.0f) || !std::isfinite (margin_m))
    throw InvalidArgument ("margin must be positive, in metres, or 0 for that of the sensor's noise");
  margin_m_ = margin_m;
}

template <typename PointT>
void
FreeSpaceFilter<PointT>::setMinimumViews (int views)
{
  if (views < 1)
    throw InvalidArgument ("minimum of views is " + std::to_string (views) + "; it must be at least 1");
  minimum_views_ = views;
}

template <typename PointT>
void
FreeSpaceFilter<PointT>::setNumberOfThreads (unsigned int threads)
{
  threads_ = threads;
}

template <typename PointT>
void
FreeSpaceFilter<PointT>::applyFilter (Indices& indices)
{
  if (views_.empty ())
    PCL_WARN ("[pcl::%s::applyFilter] There is no view; every finite point passes.\n", getClassName ().c_str ());
  std::vector<Eigen::Vector3f> points;
  points.reserve (indices_->size ());
  for (const auto i : *indices_)
    points.push_back ((*input_)[i].getVector3fMap ());
  const std::vector<FreeSpaceVotes> votes = voteOnPoints (points, views_, margin_m_, static_cast<int> (threads_));

  Indices passed, removed; // what they go to may be the indices of the input
  passed.reserve (votes.size ());
  for (std::size_t n = 0; n < votes.size (); ++n)
  {
    const auto i = (*indices_)[n];
    const bool contradicted = votes[n].free >= minimum_views_ && votes[n].free > votes[n].surface;
    if (pcl::isXYZFinite ((*input_)[i]) && contradicted == negative_)
      passed.push_back (i);
    else if (extract_removed_indices_)
      removed.push_back (i);
  }
  indices = std::move (passed);
  *removed_indices_ = std::move (removed);
}

} // namespace pcl::cosection

#define PCL_INSTANTIATE_CosectionFreeSpaceFilter(T) template class pcl::cosection::FreeSpaceFilter<T>;
