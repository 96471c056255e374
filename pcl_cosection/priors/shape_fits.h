// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pcl_cosection/priors/shape/symmetric_extent.h"

#include <Eigen/Core>

#include <array>
#include <map>
#include <optional>

namespace pcl::cosection {

/** \brief The symmetric extents of one object's points, one per support plane, each fitted once. */
class ShapeFits
{
public:
  /** \brief The extent of an object that stands on a plane, or without a known plane.
   * \param[in] fit computes the extent at the first call with this plane */
  template <typename Fit> const SymmetricExtent& of (const std::optional<Eigen::Vector4d>& plane, Fit&& fit)
  {
    const Key key = plane ? Key{(*plane)[0], (*plane)[1], (*plane)[2], (*plane)[3]} : Key{};
    auto found = fits_.find (key);
    if (found == fits_.end ())
      found = fits_.emplace (key, fit ()).first;
    return found->second;
  }

private:
  using Key = std::array<double, 4>; // a plane; zeros: no plane
  std::map<Key, SymmetricExtent> fits_;
};

} // namespace pcl::cosection
