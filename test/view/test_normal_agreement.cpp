// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Normals that contradict those of their neighbours, and what is done about them.

#include "io/pcd_view_fixture.h"

#include "pcl_cosection/view/normals/normal_agreement.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

struct Surface
{
  std::vector<Eigen::Vector3f> points, normals;

  void add (const Eigen::Vector3f& point, const Eigen::Vector3f& normal)
  {
    points.push_back (point);
    normals.push_back (normal);
  }

  /** \brief As an unorganised PCD file. */
  std::string file () const
  {
    std::ostringstream rows;
    for (std::size_t n = 0; n < points.size (); ++n)
      rows << points[n].transpose () << ' ' << normals[n].transpose () << '\n';
    return header (static_cast<int> (points.size ()), 1, "ascii", "x y z normal_x normal_y normal_z", "4 4 4 4 4 4",
                   "F F F F F F") +
           rows.str ();
  }
};

Surface
cylinder (const Eigen::Vector3f& centre, float radius_m)
{
  std::mt19937 random (5);
  std::uniform_real_distribution<float> uniform (0.0f, 1.0f);
  Surface surface;
  for (int n = 0; n < 4000; ++n)
  {
    const float angle = 6.2831853f * uniform (random);
    const Eigen::Vector3f outward (std::cos (angle), std::sin (angle), 0.0f);
    surface.add (centre + radius_m * outward + 0.2f * uniform (random) * Eigen::Vector3f::UnitZ (), outward);
  }
  return surface;
}

/** \brief Both sides of a sheet. */
Surface
sheet (float thickness_m)
{
  std::mt19937 random (6);
  std::uniform_real_distribution<float> uniform (0.0f, 1.0f);
  Surface surface;
  for (int n = 0; n < 4000; ++n)
  {
    const float side = n % 2 == 0 ? 1.0f : -1.0f;
    surface.add ({uniform (random), uniform (random), 0.5f * side * thickness_m}, {0.0f, 0.0f, side});
  }
  return surface;
}

/** \brief Flip a share of the normals. */
void
flip (Surface& surface, double share)
{
  std::mt19937 random (7);
  std::bernoulli_distribution chosen (share);
  for (Eigen::Vector3f& normal : surface.normals)
    if (chosen (random))
      normal = -normal;
}

double
contradicting (const Surface& surface)
{
  return contradictingShare (surface.points, surface.normals);
}

} // namespace

TEST (SlantOfNormals, IsThatToThePlanesOfNeighbours)
{
  const Surface right = cylinder ({0.0f, 0.0f, 0.8f}, 0.05f);
  const auto slantOf = [&] (auto&& changed) {
    std::vector<Eigen::Vector3f> normals (right.normals.size ());
    std::transform (right.normals.begin (), right.normals.end (), normals.begin (), changed);
    return slantOfNormals (right.points, normals);
  };
  EXPECT_LT (slantOf ([] (const Eigen::Vector3f& n) { return n; }), 0.05);
  EXPECT_LT (slantOf ([] (const Eigen::Vector3f& n) -> Eigen::Vector3f { return -n; }), 0.05) << "of any sign";
  std::mt19937 random (7);
  std::normal_distribution<float> gauss;
  EXPECT_NEAR (slantOf ([&] (const Eigen::Vector3f&) {
                 return Eigen::Vector3f (gauss (random), gauss (random), gauss (random)).normalized ();
               }),
               2.0 / 3.0, 0.05);
  // Turned about the axis of the cylinder, all by the same angle.
  for (const float degrees : {17.0f, 46.0f})
  {
    const float angle = degrees * static_cast<float> (M_PI) / 180.0f;
    const Eigen::AngleAxisf turn (angle, Eigen::Vector3f::UnitZ ());
    EXPECT_NEAR (slantOf ([&] (const Eigen::Vector3f& n) -> Eigen::Vector3f { return turn * n; }),
                 std::pow (std::sin (angle), 2.0f), 0.05)
        << degrees;
  }
}

TEST (NormalAgreement, OfBodiesAndSheetsHasNoContradiction)
{
  Surface body = cylinder ({0, 0, 0}, 0.05f), thin = sheet (0.002f); // the points are 16 mm apart
  EXPECT_EQ (contradicting (body), 0.0);
  EXPECT_EQ (contradicting (thin), 0.0);
  flip (body, 1.0);
  flip (thin, 1.0);
  EXPECT_EQ (contradicting (body), 0.0);
  EXPECT_EQ (contradicting (thin), 0.0);
}

TEST (NormalAgreement, FlippedNormalsContradict)
{
  Surface body = cylinder ({0, 0, 0}, 0.05f);
  flip (body, 0.4);
  EXPECT_NEAR (contradicting (body), 0.48, 0.03); // two neighbours of which one is flipped
  Surface half = cylinder ({0, 0, 0}, 0.05f);
  for (std::size_t n = 0; n < half.points.size (); ++n)
    if (half.points[n].z () > 0.1f)
      half.normals[n] = -half.normals[n];
  EXPECT_GT (contradicting (half), 0.01);
}

using NormalsOfFiles = PcdView;

TEST_F (NormalsOfFiles, AreTurnedPartByPartWhereTheyContradict)
{
  Surface two = cylinder ({0, 0, 0}, 0.05f);
  const Surface other = cylinder ({1, 0, 0}, 0.03f);
  two.points.insert (two.points.end (), other.points.begin (), other.points.end ());
  two.normals.insert (two.normals.end (), other.normals.begin (), other.normals.end ());
  flip (two, 0.45);
  const LabelledView view = readPcdView (write (two.file ()));
  ASSERT_EQ (view.warnings.size (), 1u);
  EXPECT_NE (view.warnings[0].find ("normals of neighbours contradict each other; 4"), std::string::npos)
      << view.warnings[0];
  for (const OrientedPoint& point : view.objects.at (1).points)
  {
    const Eigen::Vector3f centre (point.position.x () > 0.5f ? 1.0f : 0.0f, 0.0f, point.position.z ());
    EXPECT_GT (point.normal.dot ((point.position - centre).normalized ()), 0.99f);
  }
}

TEST_F (NormalsOfFiles, StayWhereTheyAgree)
{
  const Surface thin = sheet (0.004f);
  const LabelledView view = readPcdView (write (thin.file ()));
  EXPECT_EQ (view.warnings, std::vector<std::string> ());
  ASSERT_EQ (view.objects.at (1).points.size (), thin.points.size ());
  for (std::size_t n = 0; n < thin.points.size (); ++n)
    EXPECT_EQ (view.objects.at (1).points[n].normal, thin.normals[n]);
}

/** \brief As of pcl::NormalEstimation, whose viewpoint is the origin if it is not set. */
TEST_F (NormalsOfFiles, OfAnotherViewpointAreTurnedOneByOne)
{
  const Eigen::Vector3f centre (0.0f, 0.0f, 0.8f);
  for (const float other : {1.0f, -1.0f}) // most then point away, or most do not
  {
    SCOPED_TRACE (other);
    const Surface whole = cylinder (centre, 0.05f);
    const Eigen::Vector3f seen_from (0.0f, -1.0f, 0.9f), estimated_for (1.0f, 0.3f * other, 0.9f);
    Surface seen;
    for (std::size_t n = 0; n < whole.points.size (); ++n)
      if (whole.normals[n].dot (seen_from - whole.points[n]) > 0.02f)
        seen.add (whole.points[n],
                  whole.normals[n] * (whole.normals[n].dot (estimated_for - whole.points[n]) > 0.0f ? 1.0f : -1.0f));
    PcdViewOptions options;
    options.viewpoint = {seen_from.x (), seen_from.y (), seen_from.z ()};
    const LabelledView view = readPcdView (write (seen.file ()), options);
    ASSERT_TRUE (view.view);
    ASSERT_EQ (view.warnings.size (), 1u);
    EXPECT_NE (view.warnings[0].find ("point away from the VIEWPOINT"), std::string::npos) << view.warnings[0];
    for (const OrientedPoint& point : view.objects.at (1).points)
      ASSERT_GT (point.normal.dot (seen_from - point.position), 0.0f);
  }
}

/** \brief Mixed pixels around an object would be a body of the background beside it. */
TEST_F (NormalsOfFiles, OfScatteredPointsAroundObjectsAreNotUsed)
{
  std::ostringstream rows;
  std::size_t count = 0;
  const auto add = [&] (const Eigen::Vector3f& point, const Eigen::Vector3f& normal, int label) {
    rows << point.transpose () << ' ' << normal.transpose () << ' ' << label << '\n';
    ++count;
  };
  const Surface body = cylinder ({0.0f, 0.0f, 0.0f}, 0.05f);
  for (std::size_t n = 0; n < body.points.size (); ++n)
    add (body.points[n], body.normals[n], 1);
  for (int i = -40; i <= 40; ++i)
    for (int j = -40; j <= 40; ++j)
      add ({0.006f * i, 0.006f * j, 0.0f}, {0.0f, 0.0f, 1.0f}, 0);
  std::mt19937 random (8);
  std::uniform_real_distribution<float> uniform (-1.0f, 1.0f);
  for (int n = 0; n < 40; ++n)
    add ({0.15f * uniform (random), 0.15f * uniform (random), 0.1f + 0.05f * uniform (random)}, {1.0f, 0.0f, 0.0f}, 0);
  const std::string file = header (static_cast<int> (count), 1, "ascii", "x y z normal_x normal_y normal_z label",
                                   "4 4 4 4 4 4 4", "F F F F F F U") +
                           rows.str ();
  for (const OrientedPoint& point : readPcdView (write (file)).objects.at (0).points)
    EXPECT_LT (point.position.z (), 0.01f);
}
