// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/visualization/run_scene.h>
#include <pcl/cosection/visualization/scene_picture.h>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief The colour of an object, the same in every run; of RunScene::background, grey. */
TriangleMesh::Colour instanceColour (int id);

/** \brief The colour of each vertex of an object's surface, or the background's. Grey where it is not known, such as
 * the provenance of a TSDF. */
PCL_COSECTION_EXPORT std::vector<TriangleMesh::Colour> surfaceColours (const RunScene& scene, int id,
                                                                       SurfaceMode surface, ColourMode colour);

/** \brief What surfaces are called on the command line, in the order of SurfaceMode. */
PCL_COSECTION_EXPORT const std::vector<std::string>& surfaceNames ();

/** \brief What colours are called, in the order of ColourMode. */
PCL_COSECTION_EXPORT const std::vector<std::string>& colourNames ();

/** \brief A colour and what it means. */
struct LegendEntry
{
  TriangleMesh::Colour colour;
  std::string text;
};

/** \brief What colours mean: entries, or a scale with errorColour (share) from \a least to \a most. */
struct ColourLegend
{
  std::vector<LegendEntry> entries;
  std::string title;
  double least = 0.0; ///< at share 0
  double most = 0.0;  ///< at share 1; as \a least: there is no scale
  bool more = false;  ///< the last colour stands for larger values, too

  bool hasScale () const { return most != least; }
};

/** \brief What the colours mean; empty for real ones. */
PCL_COSECTION_EXPORT ColourLegend legendOf (const RunScene& scene, ColourMode colour);

/** \brief A line below a picture: which frame it is, what is in it, what its colours are. */
PCL_COSECTION_EXPORT std::string sceneCaption (const RunScene& scene, double stamp, SurfaceMode surface,
                                               ColourMode colour);

} // namespace pcl::cosection
