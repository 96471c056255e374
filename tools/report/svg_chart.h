// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

/** \brief A line of a chart. */
struct ChartSeries
{
  std::string style;                   ///< its class in the style sheet, which has the colour
  std::vector<Eigen::Vector2d> points; ///< a point that is not finite interrupts the line
  bool is_dashed = false;
  bool has_ends = false; ///< a ring at the first and a dot at the last point
};

/** \brief Lines over two axes. */
struct LineChart
{
  std::string title; ///< for those who cannot see it, and above the chart
  std::string x_label, y_label;
  std::vector<ChartSeries> series;
  bool equal_axes = false;    ///< a metre is as long on both
  int height_px = 260;        ///< of 420 in width, at which letters have their size
  double least_height = 1e-3; ///< of the vertical axis: what moves less looks still
};

/** \brief The chart as an SVG element; scales with its width.
 * Lines of more than 400 points are thinned evenly. */
std::string drawLineChart (const LineChart& chart);

/** \brief A part of a bar. */
struct BarPart
{
  std::string style;  ///< its class in the style sheet
  double share = 0.0; ///< of the width, in [0, 1]
};

/** \brief A bar of parts beside each other as an SVG element. \param[in] title for those who cannot see it */
std::string drawBar (const std::vector<BarPart>& parts, const std::string& title, int width_px = 120);

/** \brief Round numbers from \a least to \a most, about \a count of them. */
std::vector<double> ticksBetween (double least, double most, int count);
