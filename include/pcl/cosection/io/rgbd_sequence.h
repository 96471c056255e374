// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/camera.h>
#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pcl
{
namespace cosection
{

/** \brief How the files of a sequence are laid out. */
enum class SequenceFormat
{
  Detect,
  CoFusion,    ///< colour/ColorNNNN.*, depth_noise/ or depth/DepthNNNN.*, calibration.txt
  Tum,         ///< associations.txt, or rgb.txt and depth.txt
  SevenScenes, ///< frame-NNNNNN.color.*, frame-NNNNNN.depth.*
};

/** \brief How to read a sequence. */
struct PCL_COSECTION_EXPORT SequenceSource
{
  SequenceFormat format = SequenceFormat::Detect;
  std::string depth_folder;                        ///< of the Co-Fusion layout; empty: depth_noise, else depth
  double depth_scale = 0.0;                        ///< units of a PNG per metre; 0: 5000 for TUM, 1000 for others
  std::optional<std::array<double, 4>> intrinsics; ///< fx, fy, cx, cy in pixels, instead of calibration.txt

  /** \brief \throws InvalidArgument naming the first parameter outside its domain. */
  void
  validate () const;
};

/** \brief One frame of a sequence. */
struct PCL_COSECTION_EXPORT RgbdFrame
{
  std::size_t index = 0; ///< in the sequence
  double stamp = 0.0;    ///< seconds, or the number in the file's name where the data has no times
  Image<float> depth;    ///< metres along the optical axis; NaN: no reading
  Picture colour;        ///< of the depth's size; empty if the frame has none
};

/** \brief A sequence of RGB-D frames in a folder. It holds names only; frames are read one by one, so it may be of any
 * length, and several threads may read. */
class PCL_COSECTION_EXPORT RgbdSequence
{
public:
  /** \brief List the frames of a folder.
   * \throws IoError if there is no such folder, no layout is recognised, a list has a line that is none, there are no frames, or
   * calibration.txt is missing or wrong
   * \throws InvalidArgument if an option is outside its domain */
  explicit RgbdSequence (const std::string& folder, const SequenceSource& source = {});

  std::size_t
  size () const
  {
    return entries_.size ();
  }

  /** \brief By ascending stamps. */
  double
  stamp (std::size_t index) const
  {
    return entries_[index].stamp;
  }

  /** \brief Median time from one frame to the next; 1 for a single frame. */
  double
  period () const
  {
    return period_;
  }

  const PinholeCamera&
  camera () const
  {
    return camera_;
  }

  SequenceFormat
  format () const
  {
    return format_;
  }

  /** \brief Lines about what is odd: depth without colour, stamps twice, a missing number. */
  const std::vector<std::string>&
  warnings () const
  {
    return warnings_;
  }

  /** \brief Read a frame. \throws IoError naming the file, if its depth is missing or damaged, or an image has another size
   * than the camera; a missing or damaged colour image only leaves colour empty and is told in \a warnings. */
  RgbdFrame
  read (std::size_t index, std::vector<std::string>& warnings) const;

private:
  struct Entry
  {
    double stamp;
    std::string depth;  // path
    std::string colour; // empty: none
  };

  void
  listCoFusion (const std::string& depth_folder);
  void
  listTum ();
  void
  listSevenScenes ();
  void
  sortEntries ();
  void
  readCalibration (const SequenceSource& source);

  std::string folder_;
  SequenceFormat format_ = SequenceFormat::Detect;
  double depth_scale_ = 1000.0;
  double period_ = 1.0;
  PinholeCamera camera_;
  std::vector<Entry> entries_;
  std::vector<std::string> warnings_;
};

} // namespace cosection
} // namespace pcl
