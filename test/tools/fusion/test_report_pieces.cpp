// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// What a report is made of: texts that end no script, meshes as letters, colours, sizes.

#include "base64.h"
#include "common/temporary_folder.h"
#include "embedding.h"
#include "report_content.h"
#include "scene_data.h"

#include "pcl_cosection/visualization/scene_legend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

using namespace pcl::cosection;

namespace {

std::uint32_t
numberAt (const std::vector<std::uint8_t>& bytes, std::size_t place, std::size_t size)
{
  std::uint32_t number = 0;
  for (std::size_t n = 0; n < size; ++n)
    number |= static_cast<std::uint32_t> (bytes.at (place * size + n)) << (8 * n);
  return (number);
}

/** \brief A grid of so many vertices each way, curved. */
TriangleMesh
sheet (std::uint32_t side)
{
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < side; ++v)
    for (std::uint32_t u = 0; u < side; ++u)
    {
      mesh.vertices.emplace_back (0.013f * static_cast<float> (u) - 1.0f, 0.007f * static_cast<float> (v),
                                  std::sin (0.1f * static_cast<float> (u + v)));
      mesh.colours.push_back ({static_cast<std::uint8_t> (u), static_cast<std::uint8_t> (v), 200});
      mesh.provenance.push_back (static_cast<std::uint8_t> ((u + v) % 4));
      mesh.confidence.push_back (static_cast<float> (u) / static_cast<float> (side));
    }
  for (std::uint32_t v = 0; v + 1 < side; ++v)
    for (std::uint32_t u = 0; u + 1 < side; ++u)
    {
      const std::uint32_t a = v * side + u;
      mesh.triangles.push_back ({a, a + 1, a + side});
      mesh.triangles.push_back ({a + 1, a + side + 1, a + side});
    }
  return (mesh);
}

/** \brief What page/report.js makes of it. */
TriangleMesh
unembed (const Json& json)
{
  TriangleMesh mesh;
  const std::vector<std::uint8_t> positions = fromBase64 (json["positions"]), indices = fromBase64 (json["indices"]);
  const std::size_t index_bytes = json["index_bytes"];
  for (std::size_t v = 0; v < json["vertices"].get<std::size_t> (); ++v)
  {
    Eigen::Vector3d p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[static_cast<Eigen::Index> (axis)] = json["min"][axis].get<double> () +
                                            json["size"][axis].get<double> () * numberAt (positions, 3 * v + axis, 2) /
                                                65535.0;
    mesh.vertices.push_back (p.cast<float> ());
  }
  for (std::size_t t = 0; t < json["triangles"].get<std::size_t> (); ++t)
    mesh.triangles.push_back ({numberAt (indices, 3 * t, index_bytes), numberAt (indices, 3 * t + 1, index_bytes),
                               numberAt (indices, 3 * t + 2, index_bytes)});
  return (mesh);
}

} // namespace

TEST (ReportPieces, JsonCannotEndItsScript)
{
  const std::string text = asScriptText ({{"name", "</script><script>alert(1)</script><!--"}});
  EXPECT_EQ (text.find ('<'), std::string::npos);
  EXPECT_EQ (Json::parse (text)["name"], "</script><script>alert(1)</script><!--");
}

TEST (ReportPieces, Base64)
{
  // RFC 4648, section 10.
  const std::vector<std::pair<std::string, std::string>> examples = {{"", ""},
                                                                     {"f", "Zg=="},
                                                                     {"fo", "Zm8="},
                                                                     {"foo", "Zm9v"},
                                                                     {"foob", "Zm9vYg=="},
                                                                     {"fooba", "Zm9vYmE="},
                                                                     {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, letters] : examples)
    EXPECT_EQ (toBase64 (bytes.data (), bytes.size ()), letters);
}

/** \brief Indices of 16 and of 32 bits. */
TEST (ReportPieces, MeshesComeBack)
{
  for (const std::uint32_t side : {20u, 256u, 257u})
  {
    const TriangleMesh mesh = sheet (side);
    std::vector<double> errors_m (mesh.vertices.size (), 0.005);
    errors_m[1] = 0.3;
    errors_m[2] = std::numeric_limits<double>::quiet_NaN ();
    const Json json = embedMesh (mesh, errors_m, 0.01);
    EXPECT_EQ (json["index_bytes"], side > 256 ? 4 : 2);
    const TriangleMesh back = unembed (json);
    EXPECT_EQ (back.triangles, mesh.triangles);
    ASSERT_EQ (back.vertices.size (), mesh.vertices.size ());
    const Eigen::Vector3f tolerance (0.013f * static_cast<float> (side), 0.007f * static_cast<float> (side), 2.0f);
    for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_NEAR (back.vertices[v][axis], mesh.vertices[v][axis], 0.51f * tolerance[axis] / 65535.0f + 1e-6f);
    const std::vector<std::uint8_t> colours = fromBase64 (json["colours"]),
                                    provenance = fromBase64 (json["provenance"]);
    EXPECT_EQ (provenance, mesh.provenance);
    ASSERT_EQ (colours.size (), 3 * mesh.vertices.size ());
    EXPECT_TRUE (std::equal (colours.begin (), colours.end (), mesh.colours[0].begin ()));
    const std::vector<std::uint8_t> confidence = fromBase64 (json["confidence"]), error = fromBase64 (json["error"]);
    for (std::size_t v = 0; v < mesh.vertices.size (); ++v)
      ASSERT_NEAR (confidence.at (v) / 255.0, mesh.confidence[v], 0.51 / 255.0);
    EXPECT_EQ (error[0], 128);
    EXPECT_EQ (error[1], 255);
    EXPECT_EQ (error[2], 255); // not known: as bad as can be
  }
}

TEST (ReportPieces, MeshesThatCannotBeEmbedded)
{
  TriangleMesh mesh = sheet (3);
  mesh.triangles.push_back ({0, 1, 9});
  EXPECT_THROW (embedMesh (mesh), std::invalid_argument);
  mesh.triangles.pop_back ();
  EXPECT_THROW (embedMesh (mesh, {0.1}), std::invalid_argument);
  mesh.colours.pop_back ();
  EXPECT_THROW (embedMesh (mesh), std::invalid_argument);
  EXPECT_EQ (embedMesh (TriangleMesh ())["triangles"], 0);
  TriangleMesh flat;
  flat.vertices.assign (3, Eigen::Vector3f (1, 2, 3));
  flat.triangles = {{0, 1, 2}};
  EXPECT_NEAR (unembed (embedMesh (flat)).vertices[1].z (), 3.0f, 1e-6f);
}

TEST (ReportPieces, MeshesForDisplayAreSmall)
{
  const TriangleMesh mesh = sheet (60);
  EXPECT_EQ (forDisplay (mesh, 100000).triangles, mesh.triangles);
  EXPECT_LE (forDisplay (mesh, 1000).triangles.size (), 1000u);
  TriangleMesh broken = mesh;
  broken.triangles.push_back (broken.triangles[0]); // no manifold
  EXPECT_EQ (forDisplay (broken, 1000).triangles, broken.triangles);
}

/** \brief The style sheet has the colours that pictures have. */
TEST (ReportPieces, ColoursAreThoseOfThePictures)
{
  const std::string style = test::readFile (std::string (PCL_COSECTION_SOURCE_DIR) + "/tools/report/page/report.css");
  constexpr int colours = 10; // after which they repeat
  for (int id = 1; id <= 25; ++id)
  {
    const TriangleMesh::Colour colour = instanceColour (id);
    char rule[64];
    std::snprintf (rule, sizeof (rule), ".s%d { --c: #%02x%02x%02x }", (id - 1) % colours + 1, colour[0], colour[1],
                   colour[2]);
    EXPECT_NE (style.find (rule), std::string::npos) << rule;
  }
}

TEST (ReportPieces, SizesAreThoseOfThingsAsTheyStand)
{
  const Eigen::Vector3d up = Eigen::Vector3d (0.3, -0.5, 0.8).normalized ();
  const Eigen::Vector3d x = up.unitOrthogonal (), y = up.cross (x);
  TriangleMesh box; // 0.3 x 0.2 on the ground, 0.1 high, turned somehow
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector2d level = Eigen::Rotation2Dd (0.7) *
                                  Eigen::Vector2d (corner & 1 ? 0.3 : 0.0, corner & 2 ? 0.2 : 0.0);
    box.vertices.push_back ((5.0 * x + level.x () * x + level.y () * y + (corner & 4 ? 0.1 : 0.0) * up).cast<float> ());
  }
  EXPECT_TRUE (standingSize (box, up).isApprox (Eigen::Vector3d (0.3, 0.2, 0.1), 1e-4))
      << standingSize (box, up).transpose ();
  EXPECT_EQ (standingSize (TriangleMesh (), up), Eigen::Vector3d (0, 0, 0));
}

TEST (ReportPieces, NamesOfFolders)
{
  EXPECT_EQ (lastPartOf ("a/b/"), "b");
  EXPECT_EQ (lastPartOf ("b"), "b");
  EXPECT_EQ (lastPartOf ("a/./b/../c//"), "c");
  EXPECT_NE (lastPartOf ("."), ".");
  EXPECT_EQ (lastPartOf ("/"), "/");
}
