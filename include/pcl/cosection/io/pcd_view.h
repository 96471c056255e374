// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/oriented_point.h>

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief Where the axes of a sensor point. */
enum class SensorAxes
{
  Optical, ///< x right, y down, z forward, as of PCL, ROS' optical frames and OpenCV
  OpenGl,  ///< x right, y up, z backward, as of renderers and cameras' viewers
};

/** \brief How to read a PCD or PLY file as a view. */
struct PCL_COSECTION_EXPORT PcdViewOptions
{
  double scale = 1.0;        ///< multiplies all coordinates, the viewpoint's too: 0.001 for millimetres
  bool world_points = false; ///< the points are in the world frame, not in the sensor's
  std::optional<std::array<double, 3>> viewpoint; ///< where the sensor stood, world frame, metres, instead of the
                                                  ///< header's VIEWPOINT; the points are in the world frame
  SensorAxes axes = SensorAxes::Optical;          ///< of the points, or of the sensor's pose if they are in the world
  std::optional<std::array<double, 3>> origin;    ///< world frame, metres; what is read is relative to it. Nothing: the
                                                  ///< world's, or near the points if these are too far for floats
  std::optional<std::array<double, 4>> intrinsics; ///< fx, fy, cx, cy in pixels, where no pinhole fits the points
  std::string label_field; ///< name of the field with the labels; empty: label, or else, in upper or lower case and
                           ///< with scalar_ before it or not, labels, class or classification
  std::vector<std::uint32_t> labels; ///< one per point, instead of those of the file, found in these readings: they
                                     ///< are taken as exact, and not mended; empty: none are given
  std::vector<std::uint32_t> background_labels; ///< empty: 0; else, label 0 is an object unless it is one of them
  std::vector<std::uint32_t> ignored_labels;    ///< of points that are left out, beside negative ones and 65535
  std::vector<std::array<double, 4>> planes; ///< a x + b y + c z + d = 0 (world, metres) on which things stand: where
                                             ///< nothing tells the side of a surface, matter is between it and these
  int normal_neighbours = 20;                ///< nearest points for the normals of an unorganised cloud
  std::size_t max_memory_bytes = 0;          ///< refuse clouds that need more; 0: no limit
  int threads = 0;                           ///< 0: all

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

  /** \brief Origin of the frame of the points and of the view, in the world frame, metres; not zero only where
   * coordinates are too far from the world's origin for single precision (PcdViewOptions::origin). */
  Eigen::Vector3d origin = Eigen::Vector3d::Zero ();

  std::optional<DepthView> view; ///< of an organised cloud from a pinhole camera, or of points seen from the viewpoint
  std::vector<DepthView> other_views;      ///< further ones, of a sensor that sees all around or of a merged cloud
  std::map<std::uint32_t, Points> objects; ///< by label; 0: background
  bool organized = false;                  ///< HEIGHT > 1
  bool has_labels = false;                 ///< without, everything is object 1
  bool has_colour = false;                 ///< the file has rgb or rgba
  bool has_intensity = false;              ///< the file has intensity
  std::vector<std::string> warnings;       ///< one line each, naming the file
};

/** \brief Read a PCD or PLY file as one view.
 *
 * The points are in the sensor frame; the VIEWPOINT of the header is the pose of the sensor in the
 * world. An organised cloud (HEIGHT > 1) gives a depth view and normals (computeOrganizedNormals ());
 * an unorganised one has its normals in the file, or gets them from pcl::NormalEstimationOMP, per label.
 * These are turned towards the viewpoint if the points were seen from there, which also gives a depth view
 * (toDepthView ()) and shows which readings are mixed from two surfaces and so have no reliable one; else so
 * that neighbours agree and bodies are on their inner side. If the points are in another frame
 * after all, the sensor is at the VIEWPOINT if they were seen from there, or where the pixels of an organised cloud or
 * the order of an unorganised one put it. Fields: x y z (of any type), label (integer; negative or 65535: ignored;
 * or PcdViewOptions::label_field), rgb or rgba or red green blue, intensity (a number), normal_x normal_y normal_z (nx
 * ny nz; of any length but 0); others are skipped, and a warning tells of those that look like missing labels. Of a PLY
 * file the vertices are read, and the camera that pcl::PLYWriter writes.
 *
 * \code
 * const LabelledView view = readPcdView ("table.pcd");
 * CoSection scene;
 * scene.addView (*view.view); // if there is one
 * scene.addObject ({1, view.objects.at (1).points, {}});
 * \endcode
 *
 * \throws MemoryLimitExceeded before reading the points
 * \throws IoError if the file is not a well formed PCD or PLY file with these fields, or has rounded its coordinates to
 * more than half of the distance between points
 * \throws DegenerateInput if it holds no finite point
 * \throws InvalidArgument if an option is outside its domain */
PCL_COSECTION_EXPORT LabelledView readPcdView (const std::string& path, const PcdViewOptions& options = {});

/** \brief Read a cloud in memory as a view.
 * \param[in] cloud with the fields of a file; colours in one field, rgb or rgba
 * \param[in] T_world_sensor its viewpoint, metres
 * \param[in] options how to read it
 * \param[in] name for messages
 * \throws MemoryLimitExceeded, DegenerateInput, InvalidArgument as readPcdView (), the latter also if the bytes are not
 * those that the fields ask for; IoError if a field that is needed is missing, or of another type */
PCL_COSECTION_EXPORT LabelledView toLabelledView (const PCLPointCloud2& cloud, const Eigen::Isometry3d& T_world_sensor,
                                                  const PcdViewOptions& options = {},
                                                  const std::string& name = "the cloud");

} // namespace pcl::cosection
