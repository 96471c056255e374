// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "polygon_soup.h"

#include <string>

namespace pcl::cosection {

/** \brief Faces of a PLY file, ASCII or binary of either byte order: polygons and triangle strips.
 * All decoders throw IoError, whose message is only the reason. */
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
