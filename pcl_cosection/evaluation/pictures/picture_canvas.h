// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/image.h>
#include <pcl/cosection/common/triangle_mesh.h>

#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief What a scale of errorColour () means. */
struct CanvasScale
{
  std::vector<std::string> title; ///< lines above it
  double least = 0.0;             ///< of the first colour, at the lower end
  double most = 1.0;              ///< of the last colour, at the upper end
  bool more = false;              ///< the upper end stands for larger values, too
  bool upside_down = false;       ///< the first colour is at the upper end
};

/** \brief A picture with letters. Everything is drawn larger, for smooth edges; positions and sizes are pixels of the
 * result. */
class PictureCanvas
{
public:
  using Pixels = cv::Mat_<cv::Vec3b>; ///< red, green, blue, as in Picture

  /** \param[in] oversampling so many pixels along each axis become one */
  PictureCanvas (int width, int height, int oversampling);

  /** \brief What is drawn on; \a oversampling times as wide and high as the result. */
  Pixels& pixels () { return pixels_; }

  /** \brief Letters that begin at (x, y) and stand on it. \param[in] size 0.5 is some 11 pixels high */
  void write (const std::string& text, int x, int y, double size);

  /** \brief How wide write () would be. */
  int widthOf (const std::string& text, double size) const;

  /** \brief Make what is there brighter, so that letters can be read on it. */
  void veil (const cv::Rect& box, double share = 0.78);

  void fill (const cv::Rect& box, const TriangleMesh::Colour& colour);

  /** \brief A scale of colours with five numbers to its right. \param[in] box of the colours alone */
  void drawScale (const cv::Rect& box, const CanvasScale& scale);

  Picture picture () const;

private:
  cv::Rect enlarged (const cv::Rect& box) const;

  int width_, height_, oversampling_;
  Pixels pixels_;
};

} // namespace pcl::cosection
