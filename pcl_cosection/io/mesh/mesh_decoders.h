// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Polygons as files have them, unchecked: any number of corners, indices that may not exist. */
struct PolygonSoup
{
  std::vector<Eigen::Vector3d> points;
  std::vector<std::int64_t> corners; ///< indices of points, those of one polygon behind those of another
  std::vector<std::size_t> ends;     ///< where each polygon ends in \a corners

  /** \brief End a polygon: its corners are those that were added since the last one. */
  void endPolygon () { ends.push_back (corners.size ()); }

  void addPolygon (const std::vector<std::int64_t>& polygon)
  {
    corners.insert (corners.end (), polygon.begin (), polygon.end ());
    endPolygon ();
  }

  /** \brief Add the triangles of a strip: each has three consecutive indices, and every other one is turned. */
  void addStrip (const std::vector<std::int64_t>& strip)
  {
    for (std::size_t n = 2; n < strip.size (); ++n)
    {
      const bool turned = n % 2 != 0;
      for (const std::size_t m : {n - 2, turned ? n : n - 1, turned ? n - 1 : n})
        corners.push_back (strip[m]);
      endPolygon ();
    }
  }
};

/** \brief The mesh of a PLY file that saveMesh () wrote, or of another one of triangles: text or either byte order,
 * properties and indices of any type; properties that it does not know are skipped.
 * All decoders throw IoError, whose message is only the reason. \param[in] origin is subtracted from the vertices */
TriangleMesh decodePly (const std::string& bytes, const Eigen::Vector3d& origin);

/** \brief Faces of a PLY file, ASCII or binary of either byte order: polygons and triangle strips. */
PolygonSoup decodePlyPolygons (const std::string& bytes);

/** \brief Faces of an STL file, ASCII or binary. */
PolygonSoup decodeStl (const std::string& bytes);

/** \brief Faces of a Wavefront OBJ file; points, lines and free forms are skipped. */
PolygonSoup decodeObj (const std::string& bytes);

/** \brief Faces of an OFF file of text, with or without normals, colours and texture coordinates. */
PolygonSoup decodeOff (const std::string& bytes);

/** \brief Polygons and triangle strips of VTK's legacy format, ASCII or binary. */
PolygonSoup decodeVtk (const std::string& bytes);

/** \brief Polygons and triangle strips of VTK's XML format (.vtp). */
PolygonSoup decodeVtp (const std::string& bytes);

} // namespace pcl::cosection
