// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// Damaged or unusual PCD files are read correctly or refused. See also test/fuzz.

#include "common/message_of.h"
#include "common/replaced.h"
#include "common/temporary_folder.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/pcd_view.h>

#include <pcl/io/lzf.h>

#include <gtest/gtest.h>

#include <array>
#include <cstring>

using namespace pcl::cosection;
using test::messageOf;
using test::replaced;

namespace {

const std::string normals = " normal_x normal_y normal_z";

/** \brief A header of float fields x y z, normals and \a label; two points. */
std::string
header (const std::string& encoding, const std::string& label = "label", const std::string& size = "4",
        const std::string& type = "U")
{
  return ("VERSION 0.7\nFIELDS x y z" + normals + " " + label + "\nSIZE 4 4 4 4 4 4 " + size + "\nTYPE F F F F F F " +
          type + "\nCOUNT 1 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA " + encoding +
          "\n");
}

const std::string two_lines = "1 2 3 0 0 1 7\n4 5 6 0 0 1 7\n";

class HostilePcd : public testing::Test
{
protected:
  LabelledView read (const std::string& content) const
  {
    test::writeFile (folder_.file ("a.pcd"), content);
    return (readPcdView (folder_.file ("a.pcd")));
  }

  std::string failure (const std::string& content) const
  {
    return (messageOf<IoError> ([&] { read (content); }));
  }

  /** \brief Expect the points (1, 2, 3) and (4, 5, 6) of label 7. */
  static void expectTwoPoints (const LabelledView& view)
  {
    ASSERT_EQ (view.objects.count (7), 1u);
    const auto& points = view.objects.at (7).points;
    ASSERT_EQ (points.size (), 2u);
    EXPECT_EQ (points[0].position, Eigen::Vector3f (1, 2, 3));
    EXPECT_EQ (points[1].position, Eigen::Vector3f (4, 5, 6));
    EXPECT_EQ (points[1].normal, Eigen::Vector3f (0, 0, 1));
  }

  const test::TemporaryFolder folder_;
};

template <typename T>
void
put (std::string& bytes, T value)
{
  bytes.append (reinterpret_cast<const char*> (&value), sizeof (value));
}

} // namespace

TEST_F (HostilePcd, LinesOfTheHeaderInAnyOrder)
{
  expectTwoPoints (read (header ("ascii") + two_lines));
  const std::string points = "POINTS 2\n", size = "SIZE 4 4 4 4 4 4 4\n";
  std::string early = replaced (header ("ascii"), points, "");
  expectTwoPoints (read (points + early + two_lines));
  expectTwoPoints (read (replaced (early, size, points + size) + two_lines));
}

TEST_F (HostilePcd, LinesOfTheHeaderTwiceAreRefused)
{
  for (const std::string line : {"POINTS 2\n", "SIZE 4 4 4 4 4 4 4\n", "COUNT 1 1 1 1 1 1 1\n", "WIDTH 2\n"})
    EXPECT_NE (failure (replaced (header ("ascii"), line, line + line) + two_lines).find ("two lines"),
               std::string::npos);
  EXPECT_NE (failure (replaced (header ("ascii"), "SIZE", "COLUMNS x\nSIZE") + two_lines).find ("two lines"),
             std::string::npos);
}

TEST_F (HostilePcd, EmptyLinesAndCarriageReturns)
{
  std::string text = "#\n  \n\r\n" + replaced (header ("ascii"), "WIDTH", "\n \t\n# WIDTH 9\nWIDTH") + "\n  \n" +
                     two_lines;
  expectTwoPoints (read (text));
  for (std::size_t i = text.find ('\n'); i != std::string::npos; i = text.find ('\n', i + 2))
    text.insert (i, "\r");
  expectTwoPoints (read (text + " \r\n\r\n"));
}

TEST_F (HostilePcd, PointsThatLookLikeAHeader)
{
  for (std::string body : {"POINTS 1000000\nSIZE 9 9 9 9 9 9 9\n", "\n#\nFIELDS a\nDATA ascii\nPOINTS 77777777\n",
                           "COUNT 4000 1 1 1 1 1 1\nDATA binary_compressed\n"})
  {
    SCOPED_TRACE (body);
    body.resize (56, '\1');
    const LabelledView view = read (header ("binary") + body);
    std::uint32_t label = 0; // the bytes as a label
    std::memcpy (&label, &body[24], sizeof (label));
    EXPECT_EQ (view.objects.count (label), 1u);
  }
  EXPECT_NE (failure (header ("ascii") + "POINTS 1000000\n" + two_lines).find ("not a number"), std::string::npos);
}

TEST_F (HostilePcd, PaddingInACompressedFile)
{
  std::string raw;
  for (const float value : {1.0f, 4.0f, 2.0f, 5.0f, 3.0f, 6.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 1.0f})
    put (raw, value);
  put (raw, 7u);
  put (raw, 7u);
  std::string packed (1000, '\0');
  const unsigned int raw_size = static_cast<unsigned int> (raw.size ());
  const unsigned int size = pcl::lzfCompress (raw.data (), raw_size, &packed[0], 1000u);
  ASSERT_GT (size, 0u);
  std::string file = header ("binary_compressed");
  file = replaced (file, "FIELDS x y", "FIELDS x _ y");
  file = replaced (file, "SIZE 4 4", "SIZE 4 1 4");
  file = replaced (file, "TYPE F F", "TYPE F U F");
  file = replaced (file, "COUNT 1 1", "COUNT 1 4000 1");
  put (file, size);
  put (file, raw_size);
  expectTwoPoints (read (file + packed.substr (0, size)));
  for (unsigned int cut = 0; cut < size; ++cut) // too short, or data that the header announces is missing
    EXPECT_THROW (read (file + packed.substr (0, cut)), IoError) << cut;
  EXPECT_THROW (read (file + std::string (size, '\xff')), IoError);
}

TEST_F (HostilePcd, NumbersThatAFieldCannotHold)
{
  const auto read_label = [this] (const std::string& label, const std::string& size, const std::string& type) {
    return (read (header ("ascii", "label", size, type) + "1 2 3 0 0 1 " + label + "\n4 5 6 0 0 1 " + label + "\n"));
  };
  EXPECT_EQ (read_label ("1.2e+01", "4", "U").objects.count (12), 1u); // numbers as some programs write them
  EXPECT_EQ (read_label ("255", "1", "U").objects.count (255), 1u);
  for (const auto& [label, size, type] : {std::array<const char*, 3>{"256", "1", "U"},
                                          {"128", "1", "I"},
                                          {"-1", "4", "U"},
                                          {"1e30", "8", "I"},
                                          {"inf", "2", "U"}})
  {
    const std::string message = messageOf<IoError> ([&, l = label, s = size, t = type] { read_label (l, s, t); });
    EXPECT_NE (message.find (std::string ("point 0 holds \"") + label + "\", which field label cannot hold"),
               std::string::npos)
        << message;
  }
}

TEST_F (HostilePcd, ViewpointsOutOfThisWorldAreRefused)
{
  for (const std::string viewpoint : {"1e39 0 0 1 0 0 0", "0 0 0 1e300 0 0 0", "nan 0 0 1 0 0 0", "0 0 0 0 0 0 1e999"})
    EXPECT_NE (failure (replaced (header ("ascii"), "0 0 0 1 0 0 0\nP", viewpoint + "\nP") + two_lines)
                   .find ("VIEWPOINT must be"),
               std::string::npos);
}

// The eigenvector that PCL finds for them is not finite.
TEST_F (HostilePcd, NormalsOfPointsAbsurdlyFarApart)
{
  std::string lines = "1 0 0\n0 0 1\n0 3e13 0\n";
  for (int i = 0; i < 16; ++i)
    lines += "0 " + std::to_string (i + 1) + "e-30 0\n";
  const LabelledView view = read ("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 19\nHEIGHT 1\nPOINTS 19\nDATA ascii\n" +
                                  lines);
  EXPECT_EQ (view.objects.at (1).readings, 19u);
  for (const OrientedPoint& point : view.objects.at (1).points)
    EXPECT_NEAR (point.normal.norm (), 1.0f, 1e-5f);
}
