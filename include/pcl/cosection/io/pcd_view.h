// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/oriented_point.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief How to read a PCD file as a view. */
struct PCL_COSECTION_EXPORT PcdViewOptions
{
  double scale = 1.0;        ///< multiplies all coordinates, the viewpoint's too: 0.001 for millimetres
  bool world_points = false; ///< the points are in the world frame, not in the sensor's
  std::optional<std::array<double, 3>> viewpoint;  ///< where the sensor stood, world frame, metres, instead of the
                                                   ///< header's VIEWPOINT; the points are in the world frame
  std::optional<std::array<double, 4>> intrinsics; ///< fx, fy, cx, cy in pixels, where no pinhole fits the points
  std::string label_field;    ///< name of the field with the labels; empty: label, or else, in upper or lower case and
                              ///< with scalar_ before it or not, labels, class or classification
  int normal_neighbours = 20; ///< nearest points for the normals of an unorganised cloud
  std::size_t max_memory_bytes = 0; ///< refuse clouds that need more; 0: no limit
  int threads = 0;                  ///< 0: all

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief One view of a scene: what belongs to which object, and the rays that measured it. */
struct PCL_COSECTION_EXPORT LabelledView
{
  /** \brief Points of one label. */
  struct Points
  {
    std::vector<OrientedPoint> points; ///< world frame, with a reliable normal
    std::size_t readings = 0;          ///< finite points, with a normal or not
  };

  std::optional<DepthView> view; ///< of an organised cloud from a pinhole camera, or of points seen from the viewpoint
  std::map<std::uint32_t, Points> objects; ///< by label; 0: background
  bool organized = false;                  ///< HEIGHT > 1
  bool has_labels = false;                 ///< without, everything is object 1
  bool has_colour = false;                 ///< the file has rgb or rgba
  bool has_intensity = false;              ///< the file has intensity
  std::vector<std::string> warnings;       ///< one line each, naming the file
};

/** \brief Read a PCD file as one view.
 *
 * The points are in the sensor frame; the VIEWPOINT of the header is the pose of the sensor in the
 * world. An organised cloud (HEIGHT > 1) gives a depth view and normals (computeOrganizedNormals ());
 * an unorganised one has its normals in the file, or gets them from pcl::NormalEstimationOMP, per label.
 * These are turned towards the viewpoint if the points were seen from there, which also gives a depth view
 * (toDepthView ()) and shows which readings are mixed from two surfaces and so have no reliable one; else so
 * that neighbours agree and bodies are on their inner side. If the points are in another frame
 * after all, the sensor is at the VIEWPOINT if they were seen from there, or where the pixels of an organised cloud or
 * the order of an unorganised one put it. Fields: x y z (of any type), label (integer; negative or 65535: ignored;
 * or PcdViewOptions::label_field), rgb or rgba, intensity (a number), normal_x normal_y normal_z (of any length but 0);
 * others are skipped, and a warning tells of those that look like missing labels.
 *
 * \code
 * const LabelledView view = readPcdView ("table.pcd");
 * CoSection scene;
 * scene.addView (*view.view); // if there is one
 * scene.addObject ({1, view.objects.at (1).points, {}});
 * \endcode
 *
 * \throws MemoryLimitExceeded before reading the points
 * \throws IoError if the file is not a well formed PCD file with these fields
 * \throws DegenerateInput if it holds no finite point
 * \throws InvalidArgument if an option is outside its domain */
PCL_COSECTION_EXPORT LabelledView readPcdView (const std::string& path, const PcdViewOptions& options = {});

} // namespace pcl::cosection
