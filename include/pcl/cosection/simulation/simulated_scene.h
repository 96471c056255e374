// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief A body of known shape, metres, in its own frame. */
class PCL_COSECTION_EXPORT Shape
{
public:
  /** \brief Shared pointer to what is constant. */
  using ConstPtr = std::shared_ptr<const Shape>;

  virtual ~Shape ();

  /** \brief Signed distance of \a p to the surface, metres, negative inside. */
  virtual double distance (const Eigen::Vector3d& p) const = 0;

  /** \brief Whether distance () is computed from a formula, to rounding errors; else the shape is its mesh, and the
   * distance is interpolated in a grid, up to an eighth of its size and with the right sign beyond. */
  virtual bool isAnalytic () const = 0;

  /** \brief Where distance () says which side of the surface a point is on. */
  virtual bool isSupported (const Eigen::Vector3d& p) const;

  /** \brief The surface as triangles: vertices on the surface, no farther from it than \a chord_m between them; closed
   * unless the shape is infinite or an open mesh. */
  virtual TriangleMesh tessellate (double chord_m) const = 0;
};

/** \brief A polygon in a plane, counter-clockwise or clockwise, not closed by a repeated point, metres. */
using Polygon2d = std::vector<Eigen::Vector2d>;

/** \brief All lengths are metres; \throws InvalidArgument if one is not positive and finite. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeSphere (double radius);

/** \brief Centred at the origin; edges and corners rounded by \a rounding, within the given size. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeBox (const Eigen::Vector3d& size, double rounding = 0.0);

/** \brief The inside of a box, centred at the origin: matter is outside of it. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeRoom (const Eigen::Vector3d& size);

/** \brief About z, from z = 0 to \a height. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeCylinder (double radius, double height);

/** \brief About z from z = 0, where it has \a bottom_radius, to \a height; one radius may be zero. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeCone (double bottom_radius, double top_radius, double height);

/** \brief Everything within \a radius of the segment from the origin to (0, 0, length). */
PCL_COSECTION_EXPORT Shape::ConstPtr makeCapsule (double radius, double length);

/** \brief About z in the plane z = 0; \a radius of the centre line, \a tube_radius around it. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeTorus (double radius, double tube_radius);

/** \brief A profile (distance from the axis, z) turned about z: cups, bottles, bowls, vases.
 * \throws InvalidArgument if it has less than three points, a negative distance, crosses itself or has no area */
PCL_COSECTION_EXPORT Shape::ConstPtr makeRevolution (const Polygon2d& profile);

/** \brief An outline (x, y) from z = 0 to \a height. \throws InvalidArgument as makeRevolution () */
PCL_COSECTION_EXPORT Shape::ConstPtr makeExtrusion (const Polygon2d& outline, double height);

/** \brief Matter below the plane z = 0; its mesh is a square of \a extent. */
PCL_COSECTION_EXPORT Shape::ConstPtr makeHalfSpace (double extent);

/** \brief A mesh, multiplied by \a scale. If parts of it are open, what is inside is known near its triangles only.
 * \throws InvalidArgument if it has no triangles, or is not finite */
PCL_COSECTION_EXPORT Shape::ConstPtr makeMeshShape (TriangleMesh mesh, double scale = 1.0);

/** \brief Values at times, and between them a smooth curve that never leaves the range of the two values beside it.
 *
 * Each component is a cubic Hermite curve whose tangents are those of F. N. Fritsch and J. Butland, "A method for
 * constructing local monotone piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 1984: zero where the values
 * turn or stay. Before the first and after the last time the value stays. */
class PCL_COSECTION_EXPORT KeyedVector
{
public:
  /** \brief A curve through keys, seconds and metres.
   * \throws InvalidArgument if there is no key, a position is not within a million metres, a time not within a billion
   * seconds, or the times do not grow by a microsecond at least. */
  KeyedVector (std::vector<double> times, std::vector<Eigen::Vector3d> values);

  /** \brief Value at \a time, seconds. */
  Eigen::Vector3d at (double time) const;

private:
  std::vector<double> times_;
  std::vector<Eigen::Vector3d> values_;
  std::vector<Eigen::Vector3d> tangents_; // per second
};

/** \brief Orientations at times, and between them a smooth turn that never turns farther than the two beside it.
 *
 * Between two keys the orientation is R_i exp (h (t)), where the components of the rotation vector h run from zero to
 * that of the shortest turn to the next key, monotone as KeyedVector's; the angular velocity is continuous. */
class PCL_COSECTION_EXPORT KeyedRotation
{
public:
  /** \brief A turn through keys, seconds.
   * \throws InvalidArgument as KeyedVector, or if a turn is half a revolution or nearly so: its axis is not defined.
   */
  KeyedRotation (std::vector<double> times, std::vector<Eigen::Quaterniond> values);

  /** \brief Orientation at \a time, seconds. */
  Eigen::Quaterniond at (double time) const;

private:
  std::vector<double> times_;
  std::vector<Eigen::Quaterniond> values_;
  std::vector<Eigen::Vector3d> turns_; // rotation vector from key i to i + 1, frame of key i
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> rates_; // of h at the ends of turn i, per second
};

/** \brief How a body or a camera moves. */
class PCL_COSECTION_EXPORT KeyedMotion
{
public:
  /** \brief Stays where it is. */
  explicit KeyedMotion (const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity ());

  /** \brief Moves and turns. */
  KeyedMotion (KeyedVector position, KeyedRotation rotation);

  /** \brief Moves, and looks at a target that moves as well. */
  KeyedMotion (KeyedVector position, KeyedVector target, const Eigen::Vector3d& up);

  /** \brief Pose in the world at \a time, seconds. */
  Eigen::Isometry3d at (double time) const;

private:
  KeyedVector position_;
  std::optional<KeyedRotation> rotation_;
  std::optional<KeyedVector> target_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ ();
};

/** \brief What a structured-light camera makes of the true depth.
 *
 * Such a camera measures the disparity d = fx B / z between its picture and that of its projector: an error of s pixels
 * is one of z^2 / (fx B) s in depth. Where a depth is read varies by a fraction of a pixel, and there is none where the
 * pattern is seen too flat, torn by an edge, or not at all because something else stands in the projector's light.
 * After K. Khoshelham and S. O. Elberink, "Accuracy and resolution of Kinect depth data", Sensors 2012, C. V. Nguyen et
 * al., "Modeling Kinect sensor noise", 3DIMPVT 2012, and A. Handa et al., "A benchmark for RGB-D visual odometry", ICRA
 * 2014. */
struct PCL_COSECTION_EXPORT DepthNoise
{
  double baseline_m = 0.075;        ///< from the camera to the projector, which is on its right
  double disparity_sigma_px = 0.06; ///< standard deviation
  double disparity_step_px = 0.125; ///< disparities are multiples of it; 0: of nothing
  double lateral_sigma_px = 0.5;    ///< of where a depth is read, each way
  double grazing_begin_rad = 1.31;  ///< angle between ray and normal from which on readings fail ...
  double grazing_end_rad = 1.51;    ///< ... and at which all do
  double edge_dropout = 0.4;        ///< probability that a reading at a depth edge fails
  double edge_step = 0.03;          ///< a depth edge is a step of more than this fraction of the depth
  double dropout = 0.002;           ///< probability that any reading fails
  double min_m = 0.3;               ///< nearest depth
  double max_m = 8.0;               ///< farthest depth
  bool shadows = true;              ///< of the projector's light

  /** \brief Check all values. \throws InvalidArgument naming the first one outside its domain. */
  void validate () const;
};

/** \brief Depth as the camera measures it. The result depends on \a seed and \a frame, not on threads.
 * \param[in] depth metres along the optical axis, NaN: nothing there
 * \param[in] normals unit, sensor frame, one per pixel
 * \param[in] camera of the image
 * \param[in] noise of the camera
 * \param[in] seed, frame which random numbers
 * \return metres, NaN: no reading */
PCL_COSECTION_EXPORT Image<float> measureDepth (const Image<float>& depth, const std::vector<Eigen::Vector3f>& normals,
                                                const PinholeCamera& camera, const DepthNoise& noise,
                                                std::uint64_t seed, std::uint64_t frame);

/** \brief A shape as a part of a body. */
struct PCL_COSECTION_EXPORT BodyPart
{
  Shape::ConstPtr shape;                                          ///< metres, in the frame of the part
  Eigen::Isometry3d T_body_part = Eigen::Isometry3d::Identity (); ///< metres
  TriangleMesh::Colour colour{180, 180, 180};                     ///< red, green, blue
  std::string file{};                                             ///< of a mesh; empty: the shape comes from none
};

/** \brief A rigid thing of a scene. */
struct PCL_COSECTION_EXPORT SceneBody
{
  std::string name;            ///< part of file names; of the background: room or background
  int id = 0;                  ///< in the masks; 0: the background
  std::vector<BodyPart> parts; ///< the shape is their union
  KeyedMotion motion;          ///< T_world_body
  double pattern_size_m = 0.0; ///< period of the pattern on its surface; 0: plain

  /** \brief Signed distance of \a p (body frame) to the union of the parts, metres: exact outside and on the surface;
   * inside, no more than the true depth. */
  double distance (const Eigen::Vector3d& p) const;

  /** \brief Whether distance () says on which side \a p is. */
  bool isSupported (const Eigen::Vector3d& p) const;

  /** \brief The surface, body frame: of one part, its triangles; of several, that of their union, without what is
   * inside; of the background, all parts as they are. */
  TriangleMesh surface (double chord_m) const;
};

/** \brief How depth is stored. */
enum class DepthFormat
{
  Png, ///< 16 bit, whole units
  Exr, ///< 32-bit floating point, metres
};

/** \brief Everything that determines a simulated sequence. */
struct PCL_COSECTION_EXPORT SimulatedScene
{
  PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5}; ///< of all frames
  KeyedMotion camera_motion;                                  ///< T_world_camera
  int frames = 1;                                             ///< number of them
  double rate = 30.0;                                         ///< frames per second
  std::uint64_t seed = 1;                                     ///< of the noise
  std::optional<DepthNoise> noise;                            ///< nothing: depth is exact
  DepthFormat depth_format = DepthFormat::Png;                ///< of the files
  double depth_scale = 1000.0;                                ///< units of a PNG per metre
  bool exact_depth = false;                                   ///< also without noise
  int views_every = 0;                                        ///< frames from one point cloud to the next; 0: none
  std::vector<SceneBody> bodies;                              ///< the background is the first
  std::string spec;                                           ///< what it was read from, if anything

  /** \brief Time of a frame, seconds. */
  double timeOf (int frame) const { return frame / rate; }

  /** \brief Check all values. \throws InvalidArgument naming what is not right: no frames, two bodies with one id or
   * name ... */
  void validate () const;
};

/** \brief Read the description of a scene: JSON, comments allowed; doc/pcl_cosection_simulate.md has its fields.
 * \param[in] text the description
 * \param[in] name what messages call it, a file's name for instance
 * \param[in] folder where the names of mesh files begin
 * \throws InvalidArgument naming the field, if it is unknown, missing or not right
 * \throws IoError if a mesh file cannot be read */
PCL_COSECTION_EXPORT SimulatedScene parseSceneSpec (const std::string& text, const std::string& name,
                                                    const std::string& folder = ".");

/** \brief Read the description of a scene from a file; mesh files are found beside it. \throws as parseSceneSpec () */
PCL_COSECTION_EXPORT SimulatedScene loadSceneSpec (const std::string& path);

/** \brief What the scene was read from, with its present seed, noise and views, and the full names of its mesh files;
 * empty if it was not read from anything. */
PCL_COSECTION_EXPORT std::string effectiveSpec (const SimulatedScene& scene);

/** \brief A scene that comes with the library. */
struct PCL_COSECTION_EXPORT ScenePreset
{
  std::string name;    ///< for the program's --preset
  std::string meaning; ///< one line for a user
  std::string spec;    ///< for parseSceneSpec ()
};

/** \brief Objects on a table; toys that drive on a floor; an object that is lifted, turned and put on another. */
PCL_COSECTION_EXPORT const std::vector<ScenePreset>& scenePresets ();

} // namespace pcl::cosection
