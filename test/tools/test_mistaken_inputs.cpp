// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// What is given is not what the program takes it for: it finds out, or says so.

#include "any_cloud_fixture.h"

#include <Eigen/Geometry>

#include <functional>
#include <sstream>

using namespace pcl::cosection;

namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

class MistakenInput : public AnyCloud
{
protected:
  /** \brief The ball of writeSphere () with its points changed. */
  void saveChanged (const std::string& name, const std::function<void (pcl::PointNormal&)>& change) const
  {
    writeSphere (path ("ball.pcd"), 4000);
    Cloud cloud;
    pcl::io::loadPCDFile (path ("ball.pcd"), cloud);
    for (pcl::PointNormal& p : cloud)
      change (p);
    pcl::io::savePCDFileBinary (path (name), cloud);
  }

  /** \brief Points with labels, ascii. */
  void saveLabelled (const std::string& name, const std::vector<std::pair<Eigen::Vector3f, std::string>>& points) const
  {
    std::ostringstream file;
    file << "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH " << points.size ()
         << "\nHEIGHT 1\nPOINTS " << points.size () << "\nDATA ascii\n";
    for (const auto& [p, label] : points)
      file << p.transpose () << ' ' << label << '\n';
    write (name, file.str ());
  }

  std::vector<Eigen::Vector3f> ball () const
  {
    writeSphere (path ("ball.pcd"), 1000);
    Cloud cloud;
    pcl::io::loadPCDFile (path ("ball.pcd"), cloud);
    std::vector<Eigen::Vector3f> points;
    for (const pcl::PointNormal& p : cloud)
      points.emplace_back (p.getVector3fMap ());
    return points;
  }

  bool isSaid (const std::string& part) const { return errors_.find (part) != std::string::npos; }
};

} // namespace

TEST_F (MistakenInput, NormalsThatAreNotOfThePointsAreEstimatedAgain)
{
  const std::string warning = "not those of the surface";
  saveChanged ("right.pcd", [] (pcl::PointNormal&) {});
  ASSERT_EQ (run ({"right.pcd", "right.ply"}), 0) << errors_;
  EXPECT_FALSE (isSaid (warning)) << errors_;
  const Eigen::AngleAxisf turn (1.0f, Eigen::Vector3f (1.0f, 2.0f, 3.0f).normalized ());
  saveChanged ("moved.pcd", [&] (pcl::PointNormal& p) { p.getVector3fMap () = turn * p.getVector3fMap (); });
  saveChanged ("placeholder.pcd", [] (pcl::PointNormal& p) { p.getNormalVector3fMap () = Eigen::Vector3f::UnitZ (); });
  for (const std::string name : {"moved", "placeholder"})
  {
    ASSERT_EQ (run ({name + ".pcd", name + ".ply"}), 0) << errors_;
    EXPECT_TRUE (isSaid (warning)) << errors_;
    EXPECT_NEAR (volume (name + ".ply"), ball_m3, 0.03 * ball_m3) << name;
  }
  // A few degrees, as of normals that others estimated, are none of this.
  const Eigen::AngleAxisf little (0.3f, Eigen::Vector3f::UnitY ());
  saveChanged ("other.pcd",
               [&] (pcl::PointNormal& p) { p.getNormalVector3fMap () = little * p.getNormalVector3fMap (); });
  ASSERT_EQ (run ({"other.pcd", "other.ply"}), 0) << errors_;
  EXPECT_FALSE (isSaid (warning)) << errors_;
}

TEST_F (MistakenInput, ClustersThatCountFromZeroAreWarnedOf)
{
  const std::string warning = "add 1 to all";
  for (const char* none : {"-1", "nan"})
  {
    std::vector<std::pair<Eigen::Vector3f, std::string>> points;
    for (const Eigen::Vector3f& p : ball ())
    {
      points.emplace_back (p, "0");
      points.emplace_back (p + 0.3f * Eigen::Vector3f::UnitX (), "1");
      points.emplace_back (2.0f * p, none);
    }
    saveLabelled ("clusters.pcd", points);
    ASSERT_EQ (run ({"clusters.pcd", "out"}), 0) << errors_;
    EXPECT_TRUE (isSaid (warning)) << errors_;
    ASSERT_EQ (run ({"--background", "1", "clusters.pcd", "out"}), 0) << errors_; // it is known what 0 is
    EXPECT_FALSE (isSaid (warning)) << errors_;
  }
}

TEST_F (MistakenInput, LabelsThatAreNoneAreSummedUp)
{
  std::vector<std::pair<Eigen::Vector3f, std::string>> points;
  int label = 1;
  for (const Eigen::Vector3f& p : ball ())
    points.emplace_back (p, std::to_string (points.size () < 300 ? 1 : ++label));
  saveLabelled ("many.pcd", points);
  ASSERT_EQ (run ({"many.pcd", "out"}), 0) << errors_;
  EXPECT_TRUE (isSaid ("680 more labels are skipped")) << errors_;
  EXPECT_LT (std::count (errors_.begin (), errors_.end (), '\n'), 30) << errors_;
}

TEST_F (MistakenInput, PlanesFarFromAllObjectsAreWarnedOf)
{
  const std::string warning = "is the sign of D right?";
  writeSphere (path ("ball.pcd"), 4000); // its lowest point has z = 0.4
  for (const auto& [planes, is_far] : std::vector<std::pair<std::vector<std::string>, bool>>{
           {{"--plane", "0,0,1,-0.4"}, false},
           {{"--plane", "0,0,1,0.4"}, true},
           {{"--plane", "0,0,2,-800"}, true},                           // millimetres
           {{"--plane", "0,0,1,0.4", "--plane", "0,0,1,-0.4"}, false}}) // the floor as well
  {
    std::vector<std::string> arguments = planes;
    arguments.insert (arguments.end (), {"ball.pcd", "ball.ply"});
    ASSERT_EQ (run (arguments), 0) << errors_;
    EXPECT_EQ (isSaid (warning), is_far) << planes[1] << '\n' << errors_;
    EXPECT_NEAR (volume ("ball.ply"), ball_m3, 0.03 * ball_m3) << planes[1];
  }
}

TEST_F (MistakenInput, AnOrganisedCloudThatIsNoImageIsAsWithoutAnOrder)
{
  // The heights that a scanner above measures of a box of 18 x 20 x 6 cm, which is at no place of the cloud.
  pcl::PointCloud<pcl::PointXYZL> map (140, 140);
  for (int v = 0; v < 140; ++v)
    for (int u = 0; u < 140; ++u)
    {
      pcl::PointXYZL& p = map.at (u, v);
      const bool on_box = std::abs (u - 69.5f) < 45.0f && std::abs (v - 69.5f) < 50.0f;
      p.getVector3fMap () = Eigen::Vector3f (0.002f * static_cast<float> (u - 70), 0.002f * static_cast<float> (v - 70),
                                             on_box ? 0.06f : 0.0f); // zero is no reading to a camera
      p.label = on_box;
    }
  pcl::io::savePCDFileBinary (path ("map.pcd"), map);
  ASSERT_EQ (run ({"--world-points", "map.pcd", "map.ply"}), 0) << errors_;
  EXPECT_TRUE (isSaid ("as if without an order")) << errors_;
  pcl::PointCloud<pcl::PointXYZL> list = map;
  list.width = 140 * 140;
  list.height = 1;
  pcl::io::savePCDFileBinary (path ("list.pcd"), list);
  ASSERT_EQ (run ({"--world-points", "list.pcd", "list.ply"}), 0) << errors_;
  EXPECT_EQ (volume ("map.ply"), volume ("list.ply"));
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : loadMesh (path ("map.ply")).vertices)
    box.extend (vertex);
  EXPECT_NEAR (box.min ().z (), 0.0f, 0.002f); // below the top, not above it
  EXPECT_NEAR (box.max ().z (), 0.06f, 0.002f);
}
