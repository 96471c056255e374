// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "observe.h"

#include "pcl_cosection/common/boxes.h"
#include "pcl_cosection/common/lattice_cells.h"
#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/priors/extent_prior.h"
#include "pcl_cosection/priors/proposed/proposed_shape.h"
#include "pcl_cosection/view/outliers/point_clusters.h"
#include "pcl_cosection/view/outliers/repeated_points.h"
#include "pcl_cosection/view/range_image.h"
#include "pcl_cosection/view/visibility/mean_width.h"
#include "pcl_cosection/view/visibility/visibility.h"
#include "place_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <unordered_map>

namespace pcl::cosection {
namespace {

constexpr double outlier_reach_voxels = 3.0;  // cutoff of a point in the data term
constexpr double max_outlier_share = 0.2;     // if more points seem to be outliers, all points are kept
constexpr double least_spacings_across = 5.0; // least middle extent of an object, in supported voxels
constexpr double trimmed_share = 0.005;       // of the points, at either end of each axis of their box
constexpr double min_extent = 1e-6;           // of the coordinates: less is their rounding
constexpr double worth_saying = 0.02;         // share of repeated points
constexpr double points_per_voxel = 3.0;
// So few points per voxel are enough if more would need voxels so large that they lose the shape:
constexpr double least_points_per_voxel = 1.5;
constexpr int least_resolution = 16; // voxels along the longest side, ...
// ... and along the middle one. Mean error of compare_thinned_views 12 in cells of 5 and 10 mm: 2.19 and 3.21 mm with
// 10, 2.13 and 3.09 with 13, 2.20 and 2.94 with 16, but then the worst at 5 mm is 17 mm instead of 11.
constexpr int least_across = 13;
constexpr int least_voxels = 8; // along the longest side, however few points there are
constexpr double voxel_growth = 1.1;
// Voxels smaller than the points' spacing supports, by this factor, are more accurate than coarse ones with less
// smoothing, and than fine ones with the absolute smoothing of coarse ones.
constexpr double finer = 0.65;
// But voxels must not be finer than this multiple of the points' noise, which voxels of three points average.
constexpr double voxels_per_noise = 1.6;
// What is thin gets so many voxels across its mean width. Mean error of scanned things alone on a table: 1.71 mm
// without these and with them 1.59 mm; seen from above 2.04 and 1.73 mm.
constexpr double voxels_across_width = 8.0;
constexpr double finer_if_thin = 0.4; // instead of finer: points fill most voxels of a band in part
// Scanned scissors that are seen from above are 0.9 mm off with this and with 0.8, and 1.3 mm with 1.6.
constexpr double voxels_per_noise_if_thin = 1.2;
constexpr std::size_t points_to_measure_noise = 5; // in a cell
constexpr double noise_cells = 3.0;  // their edge, in supported voxels: smaller cells would clip the noise
constexpr double facing_alike = 0.4; // least length of the mean normal: a cell with less holds two sides of a wall

std::string
nameOf (const ObjectInput& object)
{
  return "object " + std::to_string (object.id);
}

void
checkInput (const Scene& scene, const ObjectInput& object)
{
  const std::size_t poses = object.T_world_object.size (), points = object.points.size ();
  if (poses != 0 && poses != scene.views.size ())
    throw InvalidArgument ("there are " + std::to_string (poses) + " poses for " +
                           std::to_string (scene.views.size ()) + " views");
  if (!firstPose (object).matrix ().allFinite ())
    throw InvalidArgument ("none of its poses is known");
  if (points < scene.options.min_points)
    throw DegenerateInput ("it has " + std::to_string (points) + " points with a normal, at least " +
                           std::to_string (scene.options.min_points) + " are needed");
}

/** \brief Box of an object's points without outliers. \throws DegenerateInput */
Eigen::AlignedBox3d
observedBox (const std::vector<OrientedPoint>& points, int threads)
{
  if (points.empty ())
    throw DegenerateInput ("no points with finite coordinates and a normal");
  if (!std::all_of (points.begin (), points.end (), [] (const OrientedPoint& p) { return p.position.allFinite (); }))
    throw DegenerateInput ("some points have no finite coordinates");
  const auto box = trimmedBox<double> (
      points, trimmed_share, [] (const OrientedPoint& p) { return p.position; }, threads);
  if (!(box.sizes ().maxCoeff () > min_extent * box.min ().cwiseAbs ().maxCoeff ()))
    throw DegenerateInput ("all points lie on one spot");
  return box;
}

/** \brief Voxels of edge \a h with a point in them. */
std::size_t
occupiedVoxels (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box, double h)
{
  const Eigen::Array3i dims = (box.sizes () / h).array ().floor ().cast<int> () + 1;
  std::vector<std::uint8_t> occupied (static_cast<std::size_t> (dims.x ()) * dims.y () * dims.z (), 0);
  std::size_t count = 0;
  for (const OrientedPoint& p : points)
  {
    const Eigen::Vector3d position = p.position.cast<double> ();
    if (!box.contains (position))
      continue;
    const Eigen::Array3i at = ((position - box.min ()) / h).cast<int> ();
    std::uint8_t& voxel = occupied[(static_cast<std::size_t> (at.z ()) * dims.y () + at.y ()) * dims.x () + at.x ()];
    count += voxel == 0;
    voxel = 1;
  }
  return count;
}

/** \brief The smallest voxel size that the points' spacing supports, of those that give at most 64 voxels along the
 * longest side: at least three points in each occupied voxel on average, or 1.5 if there were less than 16 voxels along
 * the longest side or 13 along the middle one. */
double
supportedVoxelSize (const std::vector<OrientedPoint>& points, const Eigen::AlignedBox3d& box)
{
  Eigen::Vector3d sides = box.sizes ();
  std::sort (sides.data (), sides.data () + 3);
  const double longest = sides[2], coarsest = std::min (longest / least_resolution, sides[1] / least_across);
  double h = longest / default_resolution;
  const auto supported = [&] {
    const double wanted = h < coarsest ? points_per_voxel : least_points_per_voxel;
    return static_cast<double> (points.size ()) >= wanted * static_cast<double> (occupiedVoxels (points, box, h));
  };
  while (h < longest / least_voxels && !supported ())
    h *= voxel_growth;
  return h;
}

/** \brief Sums of the points in a cell. */
struct CellOfPoints
{
  std::size_t count = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero ();
  Eigen::Vector3d place = Eigen::Vector3d::Zero ();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero ();

  /** \brief Standard deviation from the plane through their mean with their mean normal. */
  double scatterAlongNormal () const
  {
    const Eigen::Vector3d n = normal.normalized ();
    const double mean = n.dot (place) / static_cast<double> (count);
    const double sum = n.dot (squares * n) - static_cast<double> (count) * mean * mean;
    return std::sqrt (std::max (0.0, sum) / static_cast<double> (count - 1));
  }
};

/** \brief Standard deviation of the points along their normals, median over the surface; 0 with too few points. */
double
noiseOf (const Observation& object)
{
  std::unordered_map<std::uint64_t, CellOfPoints> cells;
  const double per_m = 1.0 / (noise_cells * object.spacing_m);
  for (const OrientedPoint& point : object.points ())
  {
    const Eigen::Vector3d place = point.position.cast<double> () - object.box.min ();
    if (const auto at = cellOf (per_m * place))
    {
      CellOfPoints& cell = cells[keyOf (*at)];
      ++cell.count;
      cell.normal += point.normal.cast<double> ();
      cell.place += place;
      cell.squares += place * place.transpose ();
    }
  }
  std::vector<double> noise_m;
  for (const auto& [key, cell] : cells)
    if (cell.count >= points_to_measure_noise && cell.normal.norm () > facing_alike * static_cast<double> (cell.count))
      noise_m.push_back (cell.scatterAlongNormal ());
  return noise_m.empty () ? 0.0 : upperMedian (noise_m);
}

/** \brief The voxel size of the options. If neither it nor a resolution is given, 64 voxels along the longest side,
 * but voxels no smaller than .65 times those that the points' spacing supports, nor, up to the size of those, than 1.6
 * times the points' noise. Of what is thin, there are up to 96 along the longest side, no smaller than .4 times those
 * that the spacing supports, nor, up to these, than 1.2 times the noise.
 * \throws InvalidArgument */
double
objectVoxelSize (const Observation& object, const CoSectionOptions& options)
{
  const double longest = object.box.sizes ().maxCoeff ();
  const double h = options.voxel_size_m;
  if (h > longest)
  {
    std::ostringstream message;
    message << "voxel size " << h << " m is larger than the object, which is " << longest << " m long";
    throw InvalidArgument (message.str ());
  }
  if (h > 0.0 || options.resolution > 0)
    return h > 0.0 ? h : longest / options.resolution;
  const double finest = longest / default_resolution, noise_m = noiseOf (object);
  const double averaging = object.spacing_m > finest ? std::min (object.spacing_m, voxels_per_noise * noise_m) : 0.0;
  const double usual = std::max ({finer * object.spacing_m, averaging, finest});
  const double width_m = meanWidth (object.views, object.points ());
  if (!(width_m > 0.0))
    return usual;
  return std::min (
      usual, std::max ({width_m / voxels_across_width, longest / thin_resolution, finer_if_thin * object.spacing_m,
                        std::min (object.spacing_m, voxels_per_noise_if_thin * noise_m)}));
}

void
measure (const CoSectionOptions& options, Observation& object)
{
  object.box = observedBox (object.points (), options.threads);
  object.spacing_m = supportedVoxelSize (object.points (), object.box);
  object.voxel_size_m = objectVoxelSize (object, options);
}

/** \brief Marks small groups of points far from all others, which would become separate components. */
std::vector<bool>
findOutliers (const Observation& object)
{
  const std::vector<OrientedPoint>& points = object.points ();
  const double reach_m = outlier_reach_voxels * std::max (object.voxel_size_m, object.spacing_m);
  std::vector<bool> outliers = findOutlierPoints (points, object.box.center (), reach_m);
  const auto count = static_cast<double> (std::count (outliers.begin (), outliers.end (), true));
  if (count > max_outlier_share * static_cast<double> (points.size ()))
    outliers.assign (points.size (), false);
  return outliers;
}

/** \brief Marks points that repeat others, as those of a view that is given twice. */
std::vector<bool>
findRepeated (const std::vector<OrientedPoint>& points, int threads)
{
  std::vector<Eigen::Vector3f> positions;
  for (const OrientedPoint& point : points)
  {
    if (!point.position.allFinite ()) // the object is refused
      return std::vector<bool> (points.size (), false);
    positions.push_back (point.position);
  }
  std::vector<std::size_t> all (points.size ());
  std::iota (all.begin (), all.end (), 0);
  std::vector<bool> repeated (points.size (), true);
  for (const std::size_t p : withoutRepeated (all, positions, threads))
    repeated[p] = false;
  return repeated;
}

/** \brief Marks the points that are left out: repeated ones and outliers. Measures the object by the others. */
std::vector<bool>
leaveOutPoints (const ObjectInput& input, const CoSectionOptions& options, Observation& object, CompletionLog& log)
{
  std::vector<bool> left_out = findRepeated (input.points, options.threads);
  const auto keepOthers = [&] {
    object.inliers.clear ();
    if (std::find (left_out.begin (), left_out.end (), true) != left_out.end ())
      for (std::size_t p = 0; p < left_out.size (); ++p)
        if (!left_out[p])
          object.inliers.push_back (input.points[p]);
    measure (options, object);
  };
  keepOthers ();
  const double repeated = static_cast<double> (object.outliers ()) / static_cast<double> (input.points.size ());
  if (repeated > worth_saying)
    log.warn (nameOf (input) + ": " + std::to_string (std::lround (100.0 * repeated)) +
              " % of its points repeat others, and are left out");
  const std::vector<bool> outliers = findOutliers (object);
  if (std::find (outliers.begin (), outliers.end (), true) == outliers.end ())
    return left_out;
  auto outlier = outliers.begin ();
  for (std::size_t p = 0; p < left_out.size (); ++p)
    if (!left_out[p])
      left_out[p] = *outlier++;
  keepOthers ();
  return left_out;
}

/** \brief The views for which the object's pose is known, and T_object_sensor; not those for free space only. */
OcclusionMap::Views
viewsOf (const Scene& scene, const ObjectInput& object)
{
  OcclusionMap::Views views;
  for (std::size_t v = 0; v < scene.views.size (); ++v)
  {
    if (scene.views[v].use == ViewUse::FreeSpace)
      continue;
    const DepthView& view = scene.views[v].depth;
    const Eigen::Isometry3d T_object_sensor = poseAt (object, v).inverse () * view.T_world_sensor;
    const bool has_reading = std::any_of (view.depth.begin (), view.depth.end (), isReading);
    if (T_object_sensor.matrix ().allFinite () && has_reading)
      views.emplace_back (&view, T_object_sensor);
  }
  return views;
}

void
warnIfFarApart (const ObjectInput& input, const Observation& object, CompletionLog& log)
{
  const double gap_m = gapBetweenGroups (object.points (), object.box);
  if (gap_m > 0.0)
    log.warn (nameOf (input) + ": its points lie in groups " + std::to_string (std::lround (100.0 * gap_m)) +
              " cm apart, each smaller than that: a pose may be wrong, or two things have one label");
}

/** \brief Warn if the voxels that the points support are too large for the object. */
void
warnIfCoarse (const ObjectInput& input, const Observation& object, CompletionLog& log)
{
  const double h = object.spacing_m;
  if (object.extents_m[1] > least_spacings_across * h)
    return;
  std::ostringstream text;
  text << std::fixed << std::setprecision (1);
  text << nameOf (input) << ": its points are so far apart that what is finer than " << 1e3 * h
       << " mm does not show, and it is only " << 1e3 * object.extents_m[1]
       << " mm across (points nearer together tell more)";
  log.warn (text.str ());
}

} // namespace

std::vector<Observation>
observeObjects (const Scene& scene, CompletionMode mode, SceneState& state, CompletionLog& log)
{
  static const std::vector<TriangleMesh> no_proposals;
  const CoSectionOptions& options = scene.options;
  return log.forEachObject ([&] (std::size_t o) {
    const ObjectInput& input = scene.objects[o];
    BodyState& body = state.objects[input.id];
    checkInput (scene, input);
    Observation object;
    object.all_points = &input.points;
    object.fits = std::make_shared<ShapeFits> ();
    object.proposals = state.without_proposals.count (input.id) ? &no_proposals : &input.proposals;
    object.proposed = std::make_shared<ProposedShapes> ();
    object.network = options.completion_network;
    object.views = viewsOf (scene, input);
    std::vector<bool> outliers = leaveOutPoints (input, options, object, log);
    if (!std::equal (body.outliers.begin (), body.outliers.end (), outliers.begin ()))
      body.readPointsAgain ();
    body.outliers = std::move (outliers);
    warnIfFarApart (input, object, log);
    object.extents_m = observedExtents (object.points (), options.threads);
    if (mode == CompletionMode::Once && !scene.fixedVoxelSize ())
      warnIfCoarse (input, object, log);

    if (!options.use_extent_prior)
      return object;
    if (object.views.empty ())
      if (std::optional<DepthView> view = virtualViewpoint (object.points ()))
      {
        object.virtual_view = std::make_shared<const DepthView> (std::move (*view));
        object.views.emplace_back (object.virtual_view.get (), object.virtual_view->T_world_sensor);
      }
    object.hidden = OcclusionMap (object.views, object.points (), options.threads);
    return object;
  });
}

} // namespace pcl::cosection
