// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/surface/free_space_filter.h>

#include "free_space_votes.h"
#include "pcl_cosection/common/console_errors.h"

#include <pcl/filters/impl/filter_indices.hpp> // the base's own applyFilter (): libpcl_filters need not be loaded
#include <pcl/point_types.h>

#include <cmath>
#include <string>

namespace pcl::cosection {

FreeSpaceFilterBase::FreeSpaceFilterBase () = default;
FreeSpaceFilterBase::FreeSpaceFilterBase (const FreeSpaceFilterBase& other) = default;
FreeSpaceFilterBase& FreeSpaceFilterBase::operator= (const FreeSpaceFilterBase& other) = default;
FreeSpaceFilterBase::~FreeSpaceFilterBase () = default;

bool
FreeSpaceFilterBase::addView (const DepthView& view)
{
  return reportErrors ("cosection::FreeSpaceFilter::addView", [&] {
    view.validate ();
    views_.emplace_back (view);
  });
}

bool
FreeSpaceFilterBase::addCloud (const std::optional<DepthView>& view)
{
  if (view)
    return addView (*view);
  PCL_ERROR (
      "[pcl::cosection::FreeSpaceFilter::addView] The cloud is not the image of a pinhole camera in its sensor's "
      "frame; it is left out.\n");
  return false;
}

void
FreeSpaceFilterBase::clearViews ()
{
  views_.clear ();
}

bool
FreeSpaceFilterBase::setMargin (float margin_m)
{
  return reportErrors ("cosection::FreeSpaceFilter::setMargin", [&] {
    if (!(margin_m >= 0.0f) || !std::isfinite (margin_m))
      throw InvalidArgument ("margin must be positive, in metres, or 0 for that of the sensor's noise");
    margin_m_ = margin_m;
  });
}

bool
FreeSpaceFilterBase::setMinimumViews (int views)
{
  return reportErrors ("cosection::FreeSpaceFilter::setMinimumViews", [&] {
    if (views < 1)
      throw InvalidArgument ("minimum of views is " + std::to_string (views) + "; it must be at least 1");
    minimum_views_ = views;
  });
}

std::vector<std::uint8_t>
FreeSpaceFilterBase::contradicted (const std::vector<Eigen::Vector3f>& points) const
{
  if (views_.empty ())
    PCL_WARN ("[pcl::cosection::FreeSpaceFilter::applyFilter] There is no view; every finite point passes.\n");
  const std::vector<FreeSpaceVotes> votes = voteOnPoints (points, views_, margin_m_, static_cast<int> (threads_));
  std::vector<std::uint8_t> contradicted (points.size ());
  for (std::size_t n = 0; n < points.size (); ++n)
    contradicted[n] = votes[n].free >= minimum_views_ && votes[n].free > votes[n].surface ? 1 : 0;
  return contradicted;
}

} // namespace pcl::cosection

BOOST_PP_SEQ_FOR_EACH (PCL_COSECTION_TEMPLATE, pcl::cosection::FreeSpaceFilter, PCL_COSECTION_XYZ_POINT_TYPES)
