// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "random_table.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace {

using nlohmann::json;

const std::vector<std::string> kinds = {"ball", "bottle", "bowl",    "box",    "can",   "capsule",
                                        "cone", "cup",    "hexagon", "lbrick", "torus", "wedge"};
constexpr int things = 6;

/** \brief Random numbers that do not depend on the standard library, which std::uniform_real_distribution does not
 * promise. */
class Dice
{
public:
  explicit Dice (unsigned seed) : engine_ (seed) {}

  double between (double low, double high)
  {
    return low + (high - low) * (static_cast<double> (engine_ ()) / 4294967296.0);
  }

  template <typename T> void shuffle (std::vector<T>& values)
  {
    for (std::size_t n = values.size (); n > 1; --n)
      std::swap (values[n - 1], values[engine_ () % n]);
  }

private:
  std::mt19937 engine_;
};

json
extrusion (const json& outline, double height)
{
  return {{"type", "extrusion"}, {"outline", outline}, {"height", height}};
}

json
revolution (const json& profile)
{
  return {{"type", "revolution"}, {"profile", profile}};
}

/** \brief Of a wall of even thickness, from the bottom to the rim. */
json
vessel (double bottom, double rim, double height, double wall)
{
  return revolution ({{0, 0}, {bottom, 0}, {rim, height}, {rim - wall, height}, {bottom - wall, wall}, {0, wall}});
}

json
shapeOf (const std::string& kind, Dice& dice)
{
  const auto between = [&] (double low, double high) { return dice.between (low, high); };
  if (kind == "ball")
  {
    const double r = between (0.035, 0.07);
    return {{"type", "sphere"}, {"radius", r}, {"position", {0, 0, r}}};
  }
  if (kind == "bottle")
  {
    const double r = between (0.03, 0.045), h = between (0.16, 0.22);
    return revolution ({{0, 0}, {r, 0}, {r, 0.55 * h}, {0.4 * r, 0.75 * h}, {0.4 * r, h}, {0, h}});
  }
  if (kind == "bowl")
  {
    const double r = between (0.06, 0.09), h = between (0.04, 0.07);
    return vessel (0.5 * r, r, h, between (0.004, 0.008));
  }
  if (kind == "cup")
  {
    const double r = between (0.03, 0.05), h = between (0.07, 0.12);
    return vessel (0.85 * r, r, h, between (0.003, 0.006));
  }
  if (kind == "box")
  {
    const double x = between (0.05, 0.18), y = between (0.05, 0.18), z = between (0.04, 0.2);
    return {{"type", "box"}, {"size", {x, y, z}}, {"rounding", 0.002}, {"position", {0, 0, 0.5 * z}}};
  }
  if (kind == "can")
  {
    const double r = between (0.025, 0.06);
    return {{"type", "cylinder"}, {"radius", r}, {"height", between (0.06, 0.2)}};
  }
  if (kind == "capsule")
  {
    const double r = between (0.02, 0.04), l = between (0.06, 0.12);
    return {{"type", "capsule"}, {"radius", r}, {"length", l}, {"position", {-0.5 * l, 0, r}}, {"rpy_deg", {0, 90, 0}}};
  }
  if (kind == "cone")
  {
    const double r = between (0.04, 0.07), top = between (0.015, r - 0.01);
    return {{"type", "cone"}, {"bottom_radius", r}, {"top_radius", top}, {"height", between (0.06, 0.16)}};
  }
  if (kind == "hexagon")
  {
    const double r = between (0.04, 0.08);
    json outline;
    for (int n = 0; n < 6; ++n)
      outline.push_back ({r * std::cos (n * M_PI / 3.0), r * std::sin (n * M_PI / 3.0)});
    return extrusion (outline, between (0.04, 0.14));
  }
  if (kind == "lbrick")
  {
    const double l = between (0.1, 0.18), w = between (0.04, 0.07);
    return extrusion ({{0, 0}, {l, 0}, {l, w}, {w, w}, {w, l}, {0, l}}, between (0.06, 0.14));
  }
  if (kind == "torus")
  {
    const double r = between (0.04, 0.07), tube = between (0.012, 0.022);
    return {{"type", "torus"}, {"radius", r}, {"tube_radius", tube}, {"position", {0, 0, tube}}};
  }
  const double a = between (0.08, 0.16), b = between (0.05, 0.12);
  return extrusion ({{0, 0}, {a, 0}, {0, b}}, between (0.05, 0.15));
}

} // namespace

std::string
randomTable (unsigned seed, int views)
{
  Dice dice (seed);
  std::vector<int> order;
  for (int v = 0; v < views; ++v)
    order.push_back (v);
  dice.shuffle (order);
  const double first = dice.between (0.0, 2.0 * M_PI);
  json keys = json::array ();
  for (int v = 0; v < views; ++v)
  {
    const double angle = first + 2.0 * M_PI * order[static_cast<std::size_t> (v)] / views + dice.between (-0.3, 0.3);
    const double distance = dice.between (0.75, 0.95), height = dice.between (0.4, 0.75);
    keys.push_back ({{"time", v},
                     {"position", {distance * std::cos (angle), distance * std::sin (angle), height}},
                     {"look_at", {0.0, 0.0, 0.05}}});
  }
  std::vector<std::string> names = kinds;
  dice.shuffle (names);
  json objects = json::array ();
  for (int n = 0; n < things; ++n)
  {
    const std::string& name = names[static_cast<std::size_t> (n)];
    const json shape = shapeOf (name, dice);
    const double x = 0.27 * (n % 3 - 1) + dice.between (-0.03, 0.03);
    const double y = 0.3 * (n / 3 - 0.5) + dice.between (-0.03, 0.03);
    const json key = {{"position", {x, y, 0.0005}}, {"rpy_deg", {0.0, 0.0, dice.between (0.0, 360.0)}}};
    objects.push_back ({{"name", name}, {"id", n + 1}, {"shape", shape}, {"keys", json::array ({key})}});
  }
  const json table = {{"type", "box"}, {"size", {1.5, 1.2, 0.04}}, {"position", {0, 0, -0.02}}};
  const json floor = {{"type", "plane"}, {"extent", 12}, {"position", {0, 0, -0.72}}};
  return json ({{"frames", views},
                {"rate", 1},
                {"seed", seed},
                {"camera", {{"width", 640}, {"height", 480}, {"keys", keys}}},
                {"views", {{"every", 1}}},
                {"background", {{"parts", json::array ({table, floor})}}},
                {"objects", objects}})
      .dump ();
}
