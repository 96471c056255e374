// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "picture_canvas.h"

#include "error_picture.h"

#include <opencv2/imgproc.hpp>

#include <array>
#include <cmath>
#include <cstdio>

namespace pcl::cosection {
namespace {

const cv::Scalar ink (45, 45, 45);
constexpr double label_size = 0.5;

std::string
shortText (double value)
{
  std::array<char, 32> text;
  std::snprintf (text.data (), text.size (), "%.3g", value);
  return text.data ();
}

} // namespace

PictureCanvas::PictureCanvas (int width, int height, int oversampling)
    : width_ (width)
    , height_ (height)
    , oversampling_ (oversampling)
    , pixels_ (height * oversampling, width * oversampling, cv::Vec3b (255, 255, 255))
{}

cv::Rect
PictureCanvas::enlarged (const cv::Rect& box) const
{
  const cv::Rect large (box.x * oversampling_, box.y * oversampling_, box.width * oversampling_,
                        box.height * oversampling_);
  return large & cv::Rect (0, 0, pixels_.cols, pixels_.rows);
}

void
PictureCanvas::write (const std::string& text, int x, int y, double size)
{
  cv::putText (pixels_, text, cv::Point (x * oversampling_, y * oversampling_), cv::FONT_HERSHEY_SIMPLEX,
               size * oversampling_, ink, oversampling_, cv::LINE_AA);
}

int
PictureCanvas::widthOf (const std::string& text, double size) const
{
  int base = 0;
  return cv::getTextSize (text, cv::FONT_HERSHEY_SIMPLEX, size * oversampling_, oversampling_, &base).width /
             oversampling_ +
         1;
}

void
PictureCanvas::veil (const cv::Rect& box, double share)
{
  PictureCanvas::Pixels part = pixels_ (enlarged (box));
  for (cv::Vec3b& pixel : part)
    for (int channel = 0; channel < 3; ++channel)
      pixel[channel] = static_cast<std::uint8_t> (std::lround (share * 255.0 + (1.0 - share) * pixel[channel]));
}

void
PictureCanvas::fill (const cv::Rect& box, const TriangleMesh::Colour& colour)
{
  pixels_ (enlarged (box)).setTo (cv::Scalar (colour[0], colour[1], colour[2]));
}

void
PictureCanvas::drawScale (const cv::Rect& box, const CanvasScale& scale)
{
  const int n = oversampling_;
  for (int v = 0; v < box.height * n; ++v)
  {
    const double share = static_cast<double> (v) / (box.height * n - 1);
    const auto colour = errorColour (scale.upside_down ? share : 1.0 - share);
    cv::line (pixels_, cv::Point (box.x * n, box.y * n + v), cv::Point ((box.x + box.width) * n, box.y * n + v),
              cv::Scalar (colour[0], colour[1], colour[2]));
  }
  constexpr int line_px = 20;
  for (std::size_t line = 0; line < scale.title.size (); ++line)
    write (scale.title[line], box.x, box.y - 16 - line_px * static_cast<int> (scale.title.size () - 1 - line),
           label_size);
  constexpr int steps = 4;
  for (int step = 0; step <= steps; ++step)
  {
    const int y = box.y + box.height - box.height * step / steps;
    cv::line (pixels_, cv::Point ((box.x + box.width) * n, y * n), cv::Point ((box.x + box.width + 6) * n, y * n), ink,
              n, cv::LINE_AA);
    const double at = scale.upside_down ? steps - step : step;
    write (shortText (scale.least + (scale.most - scale.least) * at / steps) +
               (step == steps && scale.more ? " +" : ""),
           box.x + box.width + 12, y + 5, label_size);
  }
}

Picture
PictureCanvas::picture () const
{
  Pixels small;
  cv::resize (pixels_, small, cv::Size (width_, height_), 0.0, 0.0, cv::INTER_AREA);
  Picture picture (width_, height_);
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u)
      picture.at (u, v) = {small (v, u)[0], small (v, u)[1], small (v, u)[2]};
  return picture;
}

} // namespace pcl::cosection
