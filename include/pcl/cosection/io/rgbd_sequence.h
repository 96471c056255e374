// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/io/trajectory.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief How the files of a sequence are laid out. */
enum class SequenceFormat
{
  Detect,
  CoFusion, ///< colour|color/ColorNNNN.*, depth_noise/ or depth/ with DepthNNNN.exr (metres) or .png, calibration.txt
  Tum,      ///< associations.txt, or depth.txt and rgb.txt
  SevenScenes, ///< frame-NNNNNN.color.*, frame-NNNNNN.depth.*, frame-NNNNNN.pose.txt
};

/** \brief How to read a sequence. */
struct PCL_COSECTION_EXPORT SequenceSource
{
  SequenceFormat format = SequenceFormat::Detect;
  std::string depth_folder;                        ///< of the Co-Fusion layout; empty: depth_noise, else depth
  double depth_scale = 0.0;                        ///< units of a PNG per metre; 0: 5000 for TUM, 1000 for others
  std::optional<std::array<double, 4>> intrinsics; ///< fx, fy, cx, cy in pixels, instead of calibration.txt

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void validate () const;
};

/** \brief Where one frame of a sequence is. */
struct PCL_COSECTION_EXPORT FrameFiles
{
  double stamp = 0.0; ///< seconds, or the number in the file's name where the data has no times
  std::string depth;  ///< path
  std::string colour; ///< path; empty: none
  std::string pose;   ///< path; empty: none
};

/** \brief One frame of a sequence. */
struct PCL_COSECTION_EXPORT RgbdFrame
{
  std::size_t index = 0; ///< in the sequence
  double stamp = 0.0;    ///< seconds, or the number in the file's name where the data has no times
  Image<float> depth;    ///< metres along the optical axis; NaN: no reading
  Picture colour;        ///< of the depth's size; empty if the frame has none
};

/** \brief A sequence of RGB-D frames in a folder.
 *
 * It holds names only; frames are read one by one, so it may be of any length, and several threads may read. In detail:
 * * The numbers of the Co-Fusion and the 7-Scenes layout may start anywhere, have any number of digits, and gaps.
 * * A list of TUM's layout has lines "stamp file", associations.txt "stamp file stamp file" with colour and depth in
 * either order. Without it, a depth image has the colour image nearest in time, up to 0.02 s, and none has two. The
 * stamp of a frame is that of its depth.
 * * calibration.txt is "fx fy cx cy [width height]" in pixels; without a size, that of the first depth image that can
 * be read is taken. 7-Scenes' layout does without: 585 585 320 240 640 480.
 * * Of 7-Scenes' layout, a depth of 65535 is no reading.
 *
 * \code
 * const RgbdSequence sequence ("toycars");
 * std::vector<std::string> warnings;
 * for (std::size_t n = 0; n < sequence.size (); ++n)
 *   use (sequence.read (n, warnings).depth, sequence.camera ());
 * \endcode
 * FrameReader reads ahead and skips what is damaged. */
class PCL_COSECTION_EXPORT RgbdSequence
{
public:
  /** \brief List the frames of a folder.
   * \throws IoError if there is no such folder, no layout is recognised, a list has a line that is none, there are no
   * frames, calibration.txt is missing or wrong, or no depth image tells the size
   * \throws InvalidArgument if an option is outside its domain */
  explicit RgbdSequence (const std::string& folder, const SequenceSource& source = {});

  std::size_t size () const { return files_.size (); }

  /** \brief By ascending stamps. */
  const FrameFiles& files (std::size_t index) const { return files_[index]; }

  double stamp (std::size_t index) const { return files_[index].stamp; }

  std::vector<double> stamps () const;

  /** \brief Median time from one frame to the next; 1 for a single frame. */
  double period () const { return period_; }

  const PinholeCamera& camera () const { return camera_; }

  /** \brief What was asked for or detected. */
  SequenceFormat format () const { return format_; }

  /** \brief Units of a PNG per metre. */
  double depthScale () const { return depth_scale_; }

  /** \brief Lines about what is odd: depth without colour, stamps twice, missing numbers. */
  const std::vector<std::string>& warnings () const { return warnings_; }

  /** \brief Read a frame. A colour image that is missing, damaged or of another aspect than the depth leaves colour
   * empty and is told in \a warnings; one of the same aspect is brought to the depth's size. Depths that seem to have
   * the wrong unit are told there, too.
   * \throws IoError naming the file, if its depth is missing or damaged, or has another size than the camera
   * \throws InvalidArgument if there is no such frame */
  RgbdFrame read (std::size_t index, std::vector<std::string>& warnings) const;

  /** \brief T_world_camera of a frame as 7-Scenes' pose file gives it; nothing if there is none. One that is not finite
   * or not rigid (the tracking was lost) counts as none and is told in \a warnings. \throws InvalidArgument if there is
   * no such frame */
  std::optional<Eigen::Isometry3d> givenPose (std::size_t index, std::vector<std::string>& warnings) const;

  /** \brief T_world_camera of all frames that have one, by ascending stamps. */
  std::vector<StampedPose> givenTrajectory (std::vector<std::string>& warnings) const;

private:
  void setCamera (const std::string& folder, const SequenceSource& source);

  void takeSizeOfFirstDepth (const std::string& folder);

  SequenceFormat format_ = SequenceFormat::Detect;
  double depth_scale_ = 1000.0;
  double period_ = 1.0;
  PinholeCamera camera_;
  std::string size_source_; // for messages
  std::vector<FrameFiles> files_;
  std::vector<std::string> warnings_;
};

} // namespace pcl::cosection
