// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <pcl/cosection/common/export.h>
#include <pcl/cosection/common/image.h>
#include <pcl/cosection/io/rgbd_sequence.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl::cosection
{

/** \brief Masks of instances for the frames of a sequence: a folder of PNGs of one channel of 8 or 16 bits, a file per
 * frame that has one. A pixel is the number of an instance, 0 none. A name ends in the frame's number or stamp:
 * Mask0003.png, 0.033333.png. Several threads may read. */
class PCL_COSECTION_EXPORT MaskSequence
{
public:
  /** \brief List the masks for a sequence.
   * \throws IoError if there is no such folder, it has no masks, or none of them matches a frame */
  MaskSequence (const std::string& folder, const RgbdSequence& sequence);

  /** \brief How many files there are. */
  std::size_t size () const { return paths_.size (); }

  /** \brief The file for a frame: that of the nearest stamp if it is less than half a frame period away; else nothing.
   */
  std::optional<std::string> file (double stamp) const;

  /** \brief Read the mask for a frame; nothing if there is none.
   * \throws IoError naming the file, if it is damaged, is no mask, or has another size than the depth */
  std::optional<Image<std::uint16_t>> read (double stamp) const;

  /** \brief Lines about what is odd: files that match no frame, or whose names have no number; two of one number. */
  const std::vector<std::string>& warnings () const { return warnings_; }

private:
  double half_period_;
  int width_;
  int height_;
  std::vector<double> stamps_; // ascending
  std::vector<std::string> paths_;
  std::vector<std::string> warnings_;
};

} // namespace pcl::cosection
