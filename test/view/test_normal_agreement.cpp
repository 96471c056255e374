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
