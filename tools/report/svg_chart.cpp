// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "svg_chart.h"

#include "html_writer.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace
{

constexpr double width = 420.0;
constexpr double left = 46.0, right = 12.0, top = 10.0, bottom = 38.0; ///< beside the field of the lines
constexpr std::size_t most_points = 400;
constexpr double least_width = 1e-3; ///< metres, seconds or frames
constexpr int bar_height_px = 10;

std::string
number (double value, const char* format = "%.1f")
{
  char text[32];
  std::snprintf (text, sizeof (text), format, value);
  return (std::string (text) == "-0.0" ? "0.0" : text);
}

std::string
tickText (double value, double step)
{
  const int decimals = std::clamp (static_cast<int> (std::ceil (-std::log10 (step) - 1e-9)), 0, 6);
  char text[32];
  std::snprintf (text, sizeof (text), "%.*f", decimals, std::abs (value) < 1e-9 * step ? 0.0 : value);
  return (text);
}

/** \brief Where numbers are in the picture. */
struct Axes
{
  Axes (const LineChart& chart) : field_width (width - left - right), field_height (chart.height_px - top - bottom)
  {
    for (const ChartSeries& series : chart.series)
      for (const Eigen::Vector2d& point : series.points)
        if (point.allFinite ())
          box.extend (point);
    if (box.isEmpty ())
      box.extend (Eigen::Vector2d::Zero ());
    for (int axis = 0; axis < 2; ++axis)
    {
      const double range = std::max (box.sizes ()[axis], axis == 0 ? least_width : chart.least_height),
                   middle = box.center ()[axis];
      const double margin = axis == 0 && !chart.equal_axes ? 0.0 : 0.06 * range;
      box.min ()[axis] = middle - 0.5 * range - margin;
      box.max ()[axis] = middle + 0.5 * range + margin;
    }
    if (!chart.equal_axes)
      return;
    const double metre = std::min (field_width / box.sizes ().x (), field_height / box.sizes ().y ());
    const Eigen::Vector2d half = 0.5 * Eigen::Vector2d (field_width, field_height) / metre, middle = box.center ();
    box = Eigen::AlignedBox2d (middle - half, middle + half);
  }

  double x (double value) const { return (left + field_width * (value - box.min ().x ()) / box.sizes ().x ()); }

  double y (double value) const { return (top + field_height * (box.max ().y () - value) / box.sizes ().y ()); }

  double field_width, field_height;
  Eigen::AlignedBox2d box;
};

void
drawTicks (HtmlWriter& svg, const Axes& axes, const LineChart& chart)
{
  const double y_end = top + axes.field_height, x_end = left + axes.field_width;
  const std::vector<double> xs = ticksBetween (axes.box.min ().x (), axes.box.max ().x (), 6);
  const std::vector<double> ys = ticksBetween (axes.box.min ().y (), axes.box.max ().y (), 5);
  const auto step = [] (const std::vector<double>& ticks) { return (ticks.size () > 1 ? ticks[1] - ticks[0] : 1.0); };
  for (const double tick : xs)
  {
    const std::string x = number (axes.x (tick));
    svg.element ("line", "", {{"class", "grid"}, {"x1", x}, {"x2", x}, {"y1", number (top)}, {"y2", number (y_end)}});
    svg.element ("text", tickText (tick, step (xs)), {{"x", x}, {"y", number (y_end + 15)}, {"text-anchor", "middle"}});
  }
  for (const double tick : ys)
  {
    const std::string y = number (axes.y (tick));
    svg.element ("line", "", {{"class", "grid"}, {"x1", number (left)}, {"x2", number (x_end)}, {"y1", y}, {"y2", y}});
    svg.element ("text", tickText (tick, step (ys)),
                 {{"x", number (left - 6)}, {"y", number (axes.y (tick) + 4)}, {"text-anchor", "end"}});
  }
  svg.element ("text", chart.x_label,
               {{"x", number (left + 0.5 * axes.field_width)},
                {"y", number (chart.height_px - 6.0)},
                {"text-anchor", "middle"}});
  svg.element ("text", chart.y_label,
               {{"transform", "translate(12 " + number (top + 0.5 * axes.field_height) + ") rotate(-90)"},
                {"text-anchor", "middle"}});
}

/** \brief At most so many of the points, the last one among them. Interruptions are kept. */
std::vector<Eigen::Vector2d>
thinned (const std::vector<Eigen::Vector2d>& points)
{
  const std::size_t step = points.size () / most_points + 1;
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t n = 0; n < points.size (); ++n)
    if (n % step == 0 || n + 1 == points.size () || !points[n].allFinite ())
      kept.push_back (points[n]);
  return (kept);
}

void
drawSeries (HtmlWriter& svg, const Axes& axes, const ChartSeries& series)
{
  std::string path;
  bool is_down = false;
  const Eigen::Vector2d* first = nullptr;
  const Eigen::Vector2d* last = nullptr;
  const std::vector<Eigen::Vector2d> points = thinned (series.points);
  for (const Eigen::Vector2d& point : points)
  {
    const bool is_point = point.allFinite ();
    if (is_point)
    {
      path += (is_down ? 'L' : 'M') + number (axes.x (point.x ())) + ' ' + number (axes.y (point.y ()));
      first = first != nullptr ? first : &point;
      last = &point;
    }
    is_down = is_point;
  }
  if (first == nullptr)
    return;
  svg.element ("path", "", {{"class", "line " + series.style + (series.is_dashed ? " dashed" : "")}, {"d", path}});
  if (!series.has_ends)
    return;
  const auto mark = [&] (const Eigen::Vector2d& at, const char* kind) {
    svg.element ("circle", "",
                 {{"class", kind + (" " + series.style)},
                  {"cx", number (axes.x (at.x ()))},
                  {"cy", number (axes.y (at.y ()))},
                  {"r", "3.5"}});
  };
  mark (*first, "ring");
  mark (*last, "dot");
}

} // namespace

std::vector<double>
ticksBetween (double least, double most, int count)
{
  const double raw = (most - least) / std::max (1, count);
  if (!(raw > 0.0) || !std::isfinite (raw))
    return {least};
  const double power = std::pow (10.0, std::floor (std::log10 (raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= raw * (1.0 - 1e-9))
      step = factor * power;
  std::vector<double> ticks;
  const double begin = std::ceil (least / step - 1e-9);
  for (double n = begin; n * step <= most + 1e-9 * step; ++n)
    ticks.push_back (n * step);
  return (ticks);
}

std::string
drawLineChart (const LineChart& chart)
{
  const Axes axes (chart);
  HtmlWriter svg;
  svg.open ("svg", {{"class", "chart"},
                    {"viewBox", "0 0 " + number (width, "%.0f") + ' ' + std::to_string (chart.height_px)},
                    {"role", "img"},
                    {"aria-label", chart.title}});
  drawTicks (svg, axes, chart);
  for (const ChartSeries& series : chart.series)
    drawSeries (svg, axes, series);
  svg.close ("svg");
  return (svg.html ());
}

std::string
drawBar (const std::vector<BarPart>& parts, const std::string& title, int width_px)
{
  HtmlWriter svg;
  const std::string height = std::to_string (bar_height_px);
  svg.open ("svg", {{"class", "bar"},
                    {"viewBox", "0 0 " + std::to_string (width_px) + ' ' + height},
                    {"preserveAspectRatio", "none"},
                    {"role", "img"},
                    {"aria-label", title}});
  double at = 0.0;
  for (const BarPart& part : parts)
  {
    const double size = std::clamp (part.share, 0.0, 1.0) * width_px;
    if (size > 0.0)
      svg.element ("rect", "",
                   {{"class", part.style},
                    {"x", number (at, "%.2f")},
                    {"y", "0"},
                    {"width", number (size, "%.2f")},
                    {"height", height}});
    at += size;
  }
  svg.close ("svg");
  return (svg.html ());
}
