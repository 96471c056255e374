// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// A background in overlapping blocks is that of a single volume.

#include "completion/analytic_scene.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/surface/co_section.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

constexpr double room_voxel_m = 0.025;

/** \brief Largest difference of the fields of blocks from that of a single volume near the surface, voxels. */
double
largestDifference (const SceneResult& blocks, const SignedDistanceField& single)
{
  constexpr double near_vox = 2.0;
  double largest = 0.0;
  std::size_t count = 0;
  for (const BackgroundResult& piece : blocks.background_pieces)
  {
    const SignedDistanceField& field = *piece.signed_distance;
    for (int k = 0; k < field.grid.dims.z (); ++k)
      for (int j = 0; j < field.grid.dims.y (); ++j)
        for (int i = 0; i < field.grid.dims.x (); ++i)
        {
          const std::size_t n = field.grid.index (i, j, k);
          const auto value = single.sample (field.grid.center (i, j, k));
          if (!field.supported[n] || !value || std::abs (*value) > near_vox * room_voxel_m)
            continue;
          largest = std::max (largest, std::abs (field.values[n] - *value) / room_voxel_m);
          ++count;
        }
  }
  EXPECT_GT (count, 10000u);
  return largest;
}

/** \brief The middles of the edges of one triangle. */
std::vector<Eigen::Vector3f>
boundaryEdges (const TriangleMesh& mesh)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& triangle : mesh.triangles)
    for (int n = 0; n < 3; ++n)
      ++edges[std::minmax (triangle[n], triangle[(n + 1) % 3])];
  std::vector<Eigen::Vector3f> middles;
  for (const auto& [edge, count] : edges)
    if (count == 1)
      middles.push_back (0.5f * (mesh.vertices[edge.first] + mesh.vertices[edge.second]));
  return middles;
}

/** \brief Largest distance of a place of \a from to the nearest of \a to, metres. */
float
farthest (const std::vector<Eigen::Vector3f>& from, const std::vector<Eigen::Vector3f>& to)
{
  float largest = 0.0f;
  for (const Eigen::Vector3f& place : from)
  {
    float nearest = std::numeric_limits<float>::infinity ();
    for (const Eigen::Vector3f& other : to)
      nearest = std::min (nearest, (place - other).squaredNorm ());
    largest = std::max (largest, std::sqrt (nearest));
  }
  return largest;
}

/** \brief A room of 1.6 x 1.2 x 1 m with two things in it, all of it background, seen from within. */
class BlocksOfBackground : public testing::Test
{
protected:
  BlocksOfBackground ()
  {
    const Distance inside = placed (box ({0.8, 0.6, 0.5}), Eigen::Vector3d (0.0, 0.0, 0.5));
    const Distance crate = placed (box ({0.15, 0.2, 0.2}), Eigen::Vector3d (0.35, 0.1, 0.2));
    const Distance ball = placed (sphere (0.2), Eigen::Vector3d (-0.3, -0.2, 0.2));
    scene_.add (0, [=] (const Eigen::Vector3d& p) { return std::min ({-inside (p), crate (p), ball (p)}); });
  }

  static CoSectionOptions options (int block, int threads = 0)
  {
    CoSectionOptions options;
    options.whole_background = true;
    options.background_voxel_size_m = room_voxel_m;
    options.background_block_vox = block;
    options.solver.tolerance_vox = 0.003;
    options.threads = threads;
    return options;
  }

  /** \brief Look around. */
  CoSection task (const CoSectionOptions& options, int views = 8) const
  {
    CoSection task (options);
    for (int n = 0; n < views; ++n)
      look (task, n);
    return task;
  }

  RenderedView see (int n) const
  {
    const double azimuth = 0.785 * n;
    const Eigen::Vector3d eye (-0.1 * std::cos (azimuth), -0.1 * std::sin (azimuth), 0.7);
    const Eigen::Vector3d target (std::cos (azimuth), std::sin (azimuth), n % 2 == 0 ? 0.2 : 0.4);
    return scene_.render ({120, 90, 70.0, 70.0, 59.5, 44.5}, lookAt (eye, target));
  }

  void look (CoSection& task, int n) const
  {
    const RenderedView seen = see (n);
    task.addView (seen.view);
    task.addBackground (seen.points.at (0));
  }

  AnalyticScene scene_;
};

} // namespace

TEST_F (BlocksOfBackground, GiveTheFieldAndTheMeshOfASingleVolume)
{
  const SceneResult single = task (options (256)).reconstruct ();
  ASSERT_EQ (single.background_pieces.size (), 1u);
  const MeshTopology whole = computeTopology (single.background);
  for (const int edge : {32, 48})
  {
    SCOPED_TRACE (edge);
    const SceneResult blocks = task (options (edge)).reconstruct ();
    EXPECT_GT (blocks.background_pieces.size (), 8u);
    EXPECT_TRUE (blocks.warnings.empty ());
    const double difference = largestDifference (blocks, *single.background_pieces[0].signed_distance);
    std::printf ("blocks of %d: %zu pieces, %.3f voxels\n", edge, blocks.background_pieces.size (), difference);
    EXPECT_LT (difference, 0.1);
    const MeshTopology joined = computeTopology (blocks.background);
    EXPECT_EQ (joined.non_manifold_edges, 0);
    EXPECT_EQ (joined.non_manifold_vertices, whole.non_manifold_vertices);
    EXPECT_EQ (joined.components, whole.components);
    EXPECT_NEAR (joined.boundary_edges, whole.boundary_edges, 0.02 * whole.boundary_edges);
    EXPECT_LT (farthest (boundaryEdges (blocks.background), boundaryEdges (single.background)), 2.0 * room_voxel_m);
    EXPECT_EQ (blocks.background.sigma_m.size (), blocks.background.vertices.size ());
    EXPECT_EQ (blocks.background.provenance.size (), blocks.background.vertices.size ());
  }
}

TEST_F (BlocksOfBackground, CoverTheSurfaceWithoutGaps)
{
  const SceneResult result = task (options (32)).reconstruct ();
  for (std::size_t v = 0; v < result.background.vertices.size (); v += 7)
  {
    const Eigen::Vector3d place = result.background.vertices[v].cast<double> ();
    const bool is_covered = std::any_of (result.background_pieces.begin (), result.background_pieces.end (),
                                         [&] (const BackgroundResult& piece) {
                                           const auto value = piece.signed_distance->sampleSupported (place);
                                           return value && std::abs (*value) < 0.1 * room_voxel_m;
                                         });
    ASSERT_TRUE (is_covered) << place.transpose ();
  }
}

TEST_F (BlocksOfBackground, AreTheSameForAnyNumberOfThreads)
{
  const SceneResult one = task (options (32, 1)).reconstruct ();
  const SceneResult two = task (options (32, 2)).reconstruct ();
  EXPECT_EQ (one.background.vertices, two.background.vertices);
  EXPECT_EQ (one.background.triangles, two.background.triangles);
  EXPECT_EQ (one.background.sigma_m, two.background.sigma_m);
  ASSERT_EQ (one.background_pieces.size (), two.background_pieces.size ());
  for (std::size_t n = 0; n < one.background_pieces.size (); ++n)
    EXPECT_EQ (one.background_pieces[n].signed_distance->values, two.background_pieces[n].signed_distance->values);
}

TEST_F (BlocksOfBackground, BoundObjects)
{
  AnalyticScene scene;
  scene.add (0, halfSpace (Eigen::Vector4d::UnitZ ()));
  scene.add (1, placed (sphere (0.12), Eigen::Vector3d (0.05, 0.0, 0.12)));
  const RenderedView seen = scene.render (smallCamera (), lookAt ({-0.9, 0.2, 0.7}, {0.0, 0.0, 0.1}));
  std::map<int, double> penetration; // by edge of blocks
  for (const int edge : {32, 256})
  {
    CoSectionOptions of_task = options (edge);
    of_task.use_planes = false; // the background alone bounds the object
    CoSection task (of_task);
    task.addView (seen.view);
    task.setBackground (seen.points.at (0));
    task.addObject ({1, seen.points.at (1), {}});
    const SceneResult result = task.reconstruct ();
    ASSERT_TRUE (result.objects[0].error.empty ()) << result.objects[0].error;
    EXPECT_EQ (result.background_pieces.size () > 1, edge == 32);
    penetration[edge] = result.objects[0].penetration_m;
    float lowest = 1.0f;
    for (const Eigen::Vector3f& p : result.objects[0].mesh.vertices)
      lowest = std::min (lowest, p.z ());
    EXPECT_GT (lowest, -room_voxel_m);
  }
  EXPECT_NEAR (penetration[32], penetration[256], 0.1 * room_voxel_m);
}

TEST_F (BlocksOfBackground, GetLargerVoxelsRatherThanMoreMemory)
{
  CoSectionOptions little = options (32);
  little.max_memory_bytes = 10u << 20;
  const SceneResult result = task (little, 2).reconstruct ();
  ASSERT_EQ (result.warnings.size (), 1u);
  EXPECT_NE (result.warnings[0].find ("voxels larger than 0.025 m"), std::string::npos) << result.warnings[0];
  ASSERT_FALSE (result.background_pieces.empty ());
  EXPECT_GT (result.background_pieces[0].signed_distance->grid.voxel_size_m, 1.5 * room_voxel_m);
  EXPECT_FALSE (result.background.empty ());
}

TEST_F (BlocksOfBackground, CanBeCancelledAndReportProgress)
{
  CoSection room = task (options (32), 2);
  double last = 0.0;
  int calls = 0;
  room.reconstruct ([&] (const std::string&, double fraction) {
    EXPECT_GE (fraction, last);
    last = fraction;
    ++calls;
    return true;
  });
  EXPECT_EQ (last, 1.0);
  for (const int at : {calls / 4, calls / 2, 3 * calls / 4})
  {
    int n = 0;
    EXPECT_THROW (room.reconstruct ([&] (const std::string&, double) { return ++n < at; }), Cancelled);
    n = 0;
    CoSection followed = task (options (32), 2);
    EXPECT_THROW (followed.update (UpdateOutput::Fields, [&] (const std::string&, double) { return ++n < at; }),
                  Cancelled);
    EXPECT_FALSE (followed.update ().background.empty ()); // goes on
  }
}

TEST_F (BlocksOfBackground, UpdatesSolveWhatHasChanged)
{
  // All have the same lattice, as some points of the whole room are known from the start.
  std::vector<OrientedPoint> size;
  for (int n = 0; n < 8; ++n)
  {
    const std::vector<OrientedPoint> all = see (n).points.at (0);
    for (std::size_t p = 0; p < all.size (); p += 4)
      size.push_back (all[p]);
  }
  CoSection followed = task (options (32), 4);
  followed.addBackground (size);
  followed.update ();
  const SceneResult unchanged = followed.update (UpdateOutput::Fields);
  for (const BackgroundResult& piece : unchanged.background_pieces)
    EXPECT_EQ (piece.solved_share, 0.0);
  const auto expectLocalUpdate = [&] (const std::vector<int>& views, double most) {
    const SceneResult after = followed.update ();
    const auto solved = std::count_if (after.background_pieces.begin (), after.background_pieces.end (),
                                       [] (const BackgroundResult& piece) { return piece.solved_share > 0.0; });
    EXPECT_GT (solved, 0);
    EXPECT_LE (static_cast<double> (solved), most * static_cast<double> (after.background_pieces.size ()));
    CoSection fresh (options (256));
    fresh.addBackground (size);
    for (const int n : views)
      look (fresh, n);
    const double difference = largestDifference (after, *fresh.reconstruct ().background_pieces.at (0).signed_distance);
    std::printf ("%td of %zu solved, %.3f voxels\n", solved, after.background_pieces.size (), difference);
    EXPECT_LT (difference, 0.1);
    EXPECT_EQ (computeTopology (after.background).non_manifold_edges, 0);
  };
  look (followed, 4);
  expectLocalUpdate ({0, 1, 2, 3, 4}, 0.9);
  look (followed, 5);
  look (followed, 6);
  expectLocalUpdate ({0, 1, 2, 3, 4, 5, 6}, 0.9);
  followed.removeViews ({false, false, true, false, false, false, false});
  expectLocalUpdate ({0, 1, 3, 4, 5, 6}, 1.0);
}

TEST_F (BlocksOfBackground, Grow)
{
  CoSection followed (options (32));
  for (int n = 0; n < 6; ++n)
  {
    look (followed, n);
    const SceneResult result = followed.update ();
    const MeshTopology mesh = computeTopology (result.background);
    EXPECT_EQ (mesh.non_manifold_edges, 0);
    EXPECT_LT (mesh.boundary_edges, 0.2 * static_cast<double> (result.background.triangles.size ()));
  }
  EXPECT_GT (followed.update (UpdateOutput::Fields).background_pieces.size (), 40u);
}

TEST_F (BlocksOfBackground, SizesAreChecked)
{
  for (const int edge : {-1, 1, 31, 1025})
    EXPECT_THROW (CoSection (options (edge)), InvalidArgument) << edge;
  EXPECT_NO_THROW (CoSection (options (0)));
}
