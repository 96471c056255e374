// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "free_space_view.h"
#include <pcl/cosection/common/oriented_point.h>

namespace pcl::cosection {

/** \brief How much the depth along a ray must exceed that of a point for the point to be free where there are no
 * voxels, metres: the larger of 0.5 % of the sensor's working range and of 3 sigma_z of depthNoiseSigma (). */
double pointMargin (const DepthView& view, double depth_m);

/** \brief What depth views say about one point. */
struct FreeSpaceVotes
{
  int free = 0;    ///< views that look through the point
  int surface = 0; ///< views that see a surface there
};

/** \brief Ask depth views about points, as HullConstraint does about voxels.
 *
 * A view looks through a point when every reading around the point's pixel is farther than the point by more than the
 * margin. Around it means as far as the margin reaches sideways, so that a point a little off a surface that a view
 * grazes is not taken for free. A view sees a surface at a point when its reading there is within the margin. Missing
 * readings say nothing; a reading at a depth edge says at most that there is a surface, and that only if at least three
 * of its eight neighbours are of the same depth: a flying pixel does not vouch for itself.
 *
 * \param[in] points world frame, metres; not finite: no votes
 * \param[in] margin_m 0: pointMargin ()
 * \param[in] threads 0: all; the result does not depend on it
 * \return one per point. O (points * views), times the pixels that the margin covers where a point is in front */
std::vector<FreeSpaceVotes> voteOnPoints (const std::vector<Eigen::Vector3f>& points,
                                          const std::vector<FreeSpaceView>& views, double margin_m = 0.0,
                                          int threads = 0);

/** \brief Add the votes of one more view.
 * \param[in] points any frame
 * \param[in] T_points_sensor pose of the sensor in that frame, whatever that of the view
 * \param[in,out] votes one per point, to which those of the view are added
 * \throws InvalidArgument if there are not as many votes as points */
void addVotes (const std::vector<Eigen::Vector3f>& points, const FreeSpaceView& view,
               const Eigen::Isometry3d& T_points_sensor, std::vector<FreeSpaceVotes>& votes, double margin_m = 0.0,
               int threads = 0);

/** \brief How well depth views agree with the points of a body, some of which are asked about: a view whose pose is
 * wrong looks through points that others have measured, and so does one of a thing that has moved. */
class ViewAgreement
{
public:
  explicit ViewAgreement (const std::vector<OrientedPoint>& points);

  /** \param[in] number of the view */
  void add (int number, const FreeSpaceView& view, const Eigen::Isometry3d& T_points_sensor, int threads);

  struct Contradiction
  {
    double share = 0.0; ///< of the points that a view sees, or would see if it did not look through them: the latter
    int view = 0;       ///< its number
  };

  /** \brief The largest; but of many views every twentieth may be worse. */
  Contradiction worst () const;

  /** \brief Whether there are views with readings, none of which says anything about a tenth of the points. */
  bool nothingSeen () const { return has_readings_ && of_views_.empty (); }

  /** \brief Share in [0, 1] of normals that point away from a view, among those of points that it sees. */
  double turnedAwayShare () const { return seen_ == 0 ? 0.0 : static_cast<double> (turned_away_) / seen_; }

private:
  std::vector<Eigen::Vector3f> positions_, normals_;
  std::vector<Contradiction> of_views_;
  bool has_readings_ = false;
  int seen_ = 0, turned_away_ = 0; // over all views
};

} // namespace pcl::cosection
