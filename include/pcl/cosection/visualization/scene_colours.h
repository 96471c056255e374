// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/visualization/run_scene.h>

#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief What the colour of a surface tells. */
enum class ColourMode
{
  Real,       ///< what the camera saw
  Instance,   ///< a colour for each object
  Provenance, ///< why the surface is where it is
  Confidence, ///< how near a reading is
  Error,      ///< the distance to the truth
};

/** \brief The colour of an object, the same in every run; of RunScene::background, grey. */
PCL_COSECTION_EXPORT TriangleMesh::Colour instanceColour (int id);

/** \brief Of each vertex of an object's surface, or the background's. Where it does not tell what is asked for, as the
 * TSDF of provenance: grey. */
PCL_COSECTION_EXPORT std::vector<TriangleMesh::Colour> surfaceColours (const RunScene& scene, int id,
                                                                       SurfaceMode surface, ColourMode colour);

/** \brief A colour and what it means. */
struct PCL_COSECTION_EXPORT LegendEntry
{
  TriangleMesh::Colour colour;
  std::string text;
};

/** \brief What colours mean: entries, or a scale with errorColour (share) from \a least to \a most. */
struct PCL_COSECTION_EXPORT ColourLegend
{
  std::vector<LegendEntry> entries;
  std::string title;
  double least = 0.0; ///< at share 0
  double most = 0.0;  ///< at share 1; as \a least: there is no scale
  bool more = false;  ///< the last colour stands for larger values, too

  bool hasScale () const { return most != least; }
};

/** \brief What the colours mean; nothing to tell of real ones. */
PCL_COSECTION_EXPORT ColourLegend legendOf (const RunScene& scene, ColourMode colour);

} // namespace pcl::cosection
