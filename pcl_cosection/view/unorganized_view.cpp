// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "sensor_view.h"

#include "pcl_cosection/view/normals/estimated_normals.h"
#include "pcl_cosection/view/normals/normal_agreement.h"
#include "pcl_cosection/view/outliers/mixed_pixels.h"
#include "pcl_cosection/view/outliers/repeated_points.h"
#include "pcl_cosection/view/outliers/separate_parts.h"
#include "pcl_cosection/view/scan/merged_views.h"
#include "range_image.h"

#include <pcl/cosection/surface/normals.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace pcl::cosection {
namespace {

constexpr float away_cosine = -0.2f;  // of a normal that clearly points away from the viewpoint
constexpr double least_filled = 0.01; // share of normals with a direction, of which fields have some
constexpr double worth_saying = 0.02; // share of the normals
// Share of pairs of neighbours, by the root of the number of points: half of what the border between two halves of a
// body has.
constexpr double least_contradicting = 0.5;
constexpr double few = 0.1; // share of the normals of a label that differ from the others, which are left as they are
constexpr double surely_inward = 0.3; // outward share of a body whose normals are flipped
// Length of the mean normal of a background that has a side; of random ones to one side, 0.5.
constexpr float one_sided = 0.7f;
constexpr std::size_t least_background = 100; // points, to decide on a side
constexpr double decisive = 0.75;             // share of a piece that faces to one side
// slantOfNormals (): half of that of random directions. Of estimated ones on real clouds (OSD, YCB-Video, RealSense,
// robots' tables; 68 labels) it is at most 0.07.
constexpr double strange_slant = 1.0 / 3.0;

/** \brief How much of what of all normals has a sign does have a positive one. */
class Share
{
public:
  void add (float value) { (value > 0.0f ? positive_ : negative_) += std::abs (value); }

  bool isKnown () const { return positive_ + negative_ > 0.0; }

  double get () const { return isKnown () ? positive_ / (positive_ + negative_) : 0.5; }

private:
  double positive_ = 0.0, negative_ = 0.0;
};

/** \brief How much of a piece of the background faces the objects near it; all of them, if there is none near. */
double
facingShare (const Surroundings& objects, const std::vector<Eigen::Vector3f>& points,
             const std::vector<Eigen::Vector3f>& normals)
{
  Share near, all;
  for (std::size_t i = 0; i < points.size (); ++i)
    for (const auto& [label, box] : objects)
    {
      const float facing = normals[i].dot (box.center () - points[i]);
      all.add (facing);
      if (box.contains (points[i]))
        near.add (facing);
    }
  return near.isKnown () ? near.get () : all.get ();
}

/** \brief How much of a piece of an object faces away from what it stands on; zero: not known. */
double
awayShare (const Eigen::Vector3f& away, const std::vector<Eigen::Vector3f>& points,
           const std::vector<Eigen::Vector3f>& normals)
{
  Share share;
  for (const Eigen::Vector3f& normal : normals)
    share.add (normal.dot (away));
  return std::max (share.get (), 1.0 - share.get ()) >= decisive ? share.get () : outwardShare (points, normals);
}

/** \brief The direction away from the nearest of the planes on which things stand, at an object; zero without any. */
Eigen::Vector3f
awayFromPlane (const PcdViewOptions& options, const std::vector<std::size_t>& indices, const SensorCloud& cloud)
{
  const Eigen::Isometry3d T = Eigen::Translation3d (cloud.origin) * cloud.T_world_sensor; // of the planes' world
  Eigen::Vector3d away = Eigen::Vector3d::Zero ();
  double nearest = std::numeric_limits<double>::infinity ();
  for (const auto& [a, b, c, d] : options.planes)
  {
    const Eigen::Vector3d normal (a, b, c);
    double sum = 0.0, sum_of_sizes = 0.0;
    for (const std::size_t i : indices)
    {
      const double height = normal.dot (T * cloud.positions[i].cast<double> ()) + d;
      sum += height;
      sum_of_sizes += std::abs (height);
    }
    if (const double distance = sum_of_sizes / normal.norm (); distance < nearest)
    {
      nearest = distance;
      away = std::copysign (1.0, sum) * (T.linear ().transpose () * normal.normalized ());
    }
  }
  return away.cast<float> ();
}

/** \brief The side of the background near an object on which that is; zero if it has none, as a bin's walls. */
Eigen::Vector3f
sideOf (const Eigen::AlignedBox3f& surroundings, const Members& members, const SensorCloud& cloud)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero ();
  std::size_t count = 0;
  if (const auto background = members.find (0); background != members.end ())
    for (const std::size_t i : background->second)
      if (cloud.normals[i].allFinite () && surroundings.contains (cloud.positions[i]))
      {
        sum += cloud.normals[i].cast<double> ();
        ++count;
      }
  if (!(count >= least_background && sum.norm () > one_sided * static_cast<double> (count)))
    return Eigen::Vector3f::Zero ();
  return sum.normalized ().cast<float> ();
}

/** \brief Calls orient (label, indices, rightShare) for the background and then for each object, where it is not known
 * where they were seen from.
 *
 * The background faces the objects near it. These face away from a plane that is given, or from the background, as all
 * that was seen of them, also the inside of a bowl, was seen from its outer side; where that does not say enough,
 * bodies are on the inner side. Scattered points of the background near objects, mixed pixels between these and what is
 * behind them, lose their normals. */
template <typename Orient>
void
orientParts (const PcdViewOptions& options, const Members& members, SensorCloud& cloud, Orient&& orient)
{
  const Surroundings objects = surroundingsOf (members, cloud);
  const BackgroundParts background = partsOfBackground (objects, members, cloud);
  for (const std::vector<std::size_t>* part : {&background.near, &background.far})
    orient (0, *part, [&] (const auto& points, const auto& normals) { return facingShare (objects, points, normals); });
  leaveOutScattered (options, objects, background.near, cloud);
  for (const auto& [label, indices] : members)
    if (label != 0)
    {
      const Eigen::Vector3f away = options.planes.empty () ? sideOf (objects.at (label), members, cloud)
                                                           : awayFromPlane (options, indices, cloud);
      orient (label, indices,
              [&away] (const auto& points, const auto& normals) { return awayShare (away, points, normals); });
    }
}

/** \brief Estimate the normals of an unorganised cloud of which it is not known where it was seen from; those of
 * neighbours agree (orientConsistently ()). */
void
addConsistentNormals (const PcdViewOptions& options, const Members& members, SensorCloud& cloud)
{
  orientParts (options, members, cloud, [&] (std::uint32_t, const auto& indices, const auto& rightShare) {
    addNormals (options, indices, cloud,
                [&] (const auto& points, auto& normals) { orientConsistently (points, normals, rightShare); });
  });
}

/** \brief Labels of whose normals neighbours contradict each other. */
std::set<std::uint32_t>
contradictingLabels (const Members& members, const SensorCloud& cloud)
{
  std::set<std::uint32_t> labels;
  for (const auto& [label, indices] : members)
    if (contradictingShare (pick (cloud.positions, indices), pick (cloud.normals, indices)) >
        least_contradicting / std::sqrt (static_cast<double> (indices.size ())))
      labels.insert (label);
  return labels;
}

/** \brief Turn normals of the file so that neighbours agree. \return the share that was turned */
double
mendContradictions (const PcdViewOptions& options, const std::set<std::uint32_t>& labels, const Members& members,
                    SensorCloud& cloud)
{
  std::size_t turned = 0, all = 0;
  orientParts (options, members, cloud, [&] (std::uint32_t label, const auto& indices, const auto& rightShare) {
    all += indices.size ();
    if (labels.count (label) == 0)
      return;
    std::vector<Eigen::Vector3f> normals = pick (cloud.normals, indices);
    orientConsistently (pick (cloud.positions, indices), normals, rightShare);
    std::size_t changed = 0;
    for (std::size_t k = 0; k < indices.size (); ++k)
      changed += normals[k].dot (cloud.normals[indices[k]]) < 0.0f;
    if (static_cast<double> (std::min (changed, indices.size () - changed)) <
        few * static_cast<double> (indices.size ()))
      return; // outliers, as where points are sparse
    turned += changed;
    for (std::size_t k = 0; k < indices.size (); ++k)
      cloud.normals[indices[k]] = normals[k];
  });
  return all == 0 ? 0.0 : static_cast<double> (turned) / static_cast<double> (all);
}

/** \brief Turn normals that clearly point away from the viewpoint, which is the origin: all, if most do, also those at
 * grazing angles. If some still do, their signs tell nothing, as where they were estimated for another viewpoint: each
 * is turned towards this one.
 * \return the share of those that pointed away */
double
turnTowardsViewpoint (float away, SensorCloud& cloud)
{
  const auto shareBelow = [&] (float cosine) {
    std::size_t below = 0, all = 0;
    for (std::size_t i = 0; i < cloud.positions.size (); ++i)
      if (cloud.positions[i].allFinite () && cloud.normals[i].allFinite ())
      {
        ++all;
        below += -cloud.positions[i].normalized ().dot (cloud.normals[i]) < cosine * cloud.normals[i].norm ();
      }
    return all == 0 ? 0.0 : static_cast<double> (below) / static_cast<double> (all);
  };
  const auto turnIf = [&] (const auto& isToTurn) {
    for (std::size_t i = 0; i < cloud.positions.size (); ++i)
      if (isToTurn (i))
        cloud.normals[i] = -cloud.normals[i];
  };
  const double opposed = shareBelow (0.0f);
  if (opposed > 0.5)
    turnIf ([] (std::size_t) { return true; });
  const double turned = shareBelow (away);
  if (turned > worth_saying)
    away = 0.0f;
  turnIf ([&] (std::size_t i) {
    return cloud.positions[i].allFinite () &&
           -cloud.positions[i].normalized ().dot (cloud.normals[i]) < away * cloud.normals[i].norm ();
  });
  return opposed > 0.5 ? opposed : turned;
}

/** \brief Check normals of the file against the shape, where no viewpoint gives their sign. */
void
checkWithoutViewpoint (const std::string& path, const PcdViewOptions& options, const Members& members,
                       SensorCloud& cloud, LabelledView& result)
{
  for (const auto& [label, indices] : members)
  {
    if (label == 0 || indices.size () < RangeImage::min_points)
      continue;
    const Eigen::Vector3f away = awayFromPlane (options, indices, cloud);
    const double outward = awayShare (away, pick (cloud.positions, indices), pick (cloud.normals, indices));
    if (outward >= surely_inward)
      continue;
    for (const std::size_t i : indices)
      cloud.normals[i] = -cloud.normals[i];
    result.warnings.push_back (path + ": the normals " +
                               (result.has_labels ? "of label " + std::to_string (label) + " " : std::string ()) +
                               "point inward; they were turned");
  }
}

/** \brief Fields without values, all zero or not finite, count as absent. */
void
dropUnfilledNormals (SensorCloud& cloud)
{
  const auto filled = std::count_if (cloud.normals.begin (), cloud.normals.end (), [] (const Eigen::Vector3f& normal) {
    return normal.allFinite () && !normal.isZero (0.0f);
  });
  if (static_cast<double> (filled) < least_filled * static_cast<double> (cloud.normals.size ()))
    cloud.normals.clear ();
}

/** \brief Normals that are not those of the surface count as absent, as they are where points were moved without them.
 */
void
dropStrangeNormals (const std::string& path, const Members& members, SensorCloud& cloud, LabelledView& result)
{
  if (cloud.normals.empty ())
    return;
  for (const auto& [label, indices] : members)
    if (indices.size () >= RangeImage::min_points &&
        slantOfNormals (pick (cloud.positions, indices), pick (cloud.normals, indices)) > strange_slant)
    {
      cloud.normals.clear ();
      result.warnings.push_back (path + ": its normals " +
                                 (cloud.has_labels ? "of label " + std::to_string (label) + " " : std::string ()) +
                                 "are not those of the surface through its points (were these moved without them, as "
                                 "by pcl::transformPointCloud?); all were estimated again");
      return;
    }
}

/** \brief Whether there are only things: what was around them was cut away. */
bool
areCutOut (const Members& members)
{
  return members.count (0) == 0;
}

/** \brief Leave out wrong readings at the edges of things, and what is behind things that were cut out too large. */
void
leaveOutWrongReadings (const std::string& path, const PcdViewOptions& options, const Members& members,
                       const Surroundings& objects, const BackgroundParts& background, SensorCloud& cloud,
                       LabelledView& result)
{
  std::vector<const DepthView*> views = {&*result.view};
  for (const DepthView& view : result.other_views)
    views.push_back (&view);
  bool are_pixels = false; // with wrong readings
  for (const DepthView* view : views)
  {
    for (const auto& [label, indices] : members)
      if (label != 0)
        are_pixels |= leaveOutTrails (options, *view, indices, cloud);
    leaveOutMixedPixels (*view, cloud);
  }
  if (areCutOut (members)) // else its surroundings tell
    for (const auto& [label, indices] : members)
      if (const double apart = leaveOutSeparateParts (options, indices, cloud); apart > worth_saying)
        result.warnings.push_back (path + ": " + percentText (apart) + " of the points" +
                                   (result.has_labels ? " of label " + std::to_string (label) : std::string ()) +
                                   " are apart from the others, and are left out");
  leaveOutScattered (options, objects, background.near, cloud);
  if (are_pixels && areCutOut (members))
    result.warnings.push_back (path + ": its points are pixels of an image, without their order and what is around: "
                                      "wrong readings at the edges of objects may be taken for them (give the image "
                                      "with labels, or organised, without readings elsewhere)");
}

} // namespace

void
completeUnorganized (const std::string& path, const PcdViewOptions& options, SensorCloud& cloud, LabelledView& result)
{
  if (const double repeated = leaveOutRepeated (options.threads, cloud); repeated > worth_saying)
    result.warnings.push_back (path + ": " + percentText (repeated) + " of its points repeat others, and are left out");
  const Members members = membersOf (cloud);
  const std::vector<std::string> warnings = result.warnings;
  viewFromSensor (path, options, members, cloud, result);
  if (!result.view)
  {
    std::vector<std::string> of_one_view = std::exchange (result.warnings, warnings);
    if (completeMerged (path, options, cloud, result))
      return;
    result.warnings = std::move (of_one_view);
  }
  if (result.view && result.other_views.empty () && areCutOut (members))
    result.view = withSurroundings (*result.view);
  setWorkingRange (members, cloud, result);
  dropUnfilledNormals (cloud);
  dropStrangeNormals (path, members, cloud, result);
  const bool given = !cloud.normals.empty ();
  if (!given)
    cloud.normals.assign (cloud.positions.size (), Eigen::Vector3f::Constant (nan_value));
  const Surroundings objects = surroundingsOf (members, cloud);
  const BackgroundParts background = partsOfBackground (objects, members, cloud);
  const std::set<std::uint32_t> contradicting = given ? contradictingLabels (members, cloud)
                                                      : std::set<std::uint32_t> ();
  if (!result.view && given)
  {
    if (contradicting.empty ()) // else with mending
      leaveOutScattered (options, objects, background.near, cloud);
    if (const double turned = contradicting.empty () ? 0.0
                                                     : mendContradictions (options, contradicting, members, cloud);
        turned > 0.0)
      result.warnings.push_back (path + ": normals of neighbours contradict each other; " + percentText (turned) +
                                 " of all were turned so that they agree");
    checkWithoutViewpoint (path, options, members, cloud, result);
  }
  else if (!result.view)
  {
    addConsistentNormals (options, members, cloud);
    result.warnings.push_back (path +
                               ": where its points were seen from is not known; their normals were turned so that "
                               "neighbours agree, and hollow things " +
                               "may be filled or inside out (better: " +
                               (cloud.has_viewpoint ? "give merged views as separate INPUTs, each with its VIEWPOINT"
                                                    : "give --viewpoint, set the VIEWPOINT") +
                               ", or add fields normal_x normal_y normal_z)");
  }
  if (!result.view)
    return;

  if (!given)
  {
    addNormals (options, background.near, cloud);
    addNormals (options, background.far, cloud);
    for (const auto& [label, indices] : members)
      if (label != 0)
        addNormals (options, indices, cloud);
  }
  if (const double turned = turnTowardsViewpoint (given && contradicting.empty () ? away_cosine : 0.0f, cloud);
      given && turned > worth_saying)
    result.warnings.push_back (path + ": " + percentText (turned) +
                               " of the normals point away from the VIEWPOINT; they were turned");
  leaveOutWrongReadings (path, options, members, objects, background, cloud, result);
}

} // namespace pcl::cosection
