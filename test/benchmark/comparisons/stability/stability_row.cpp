// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "stability_row.h"

#include "scene_stability.h"

#include "pcl_cosection/common/quantile.h"
#include "pcl_cosection/physics/formats/scene_writers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

constexpr double seconds = 5.0;
constexpr double max_drift_m = 0.003;
constexpr double degrees_per_rad = 180.0 / M_PI;
constexpr double max_turn_rad = 2.0 / degrees_per_rad;

std::string
numberOf (double value, int digits)
{
  char text[64];
  std::snprintf (text, sizeof (text), "%.*f", digits, value);
  return text;
}

/** \brief "median / largest", in millimetres. */
std::string
rangeOf (std::vector<double> values_m)
{
  if (values_m.empty ())
    return "–";
  const double largest = *std::max_element (values_m.begin (), values_m.end ());
  return numberOf (1000.0 * median (values_m), 2) + " / " + numberOf (1000.0 * largest, 1);
}

} // namespace

bool
StabilityRow::simulate (const std::string& file, const std::string& who)
{
  try
  {
    const SceneStability before = simulateScene (file, 0.0); // also of a simulation that fails later
    contacts_m_.push_back (before.deepest_contact ? before.deepest_contact->depth_m : 0.0);
    const SceneStability after = simulateScene (file, seconds);
    for (const BodyDrift& body : after.bodies)
    {
      drifts_m_.push_back (body.drift_m);
      flown_ += body.flew_away ? 1 : 0;
      if (body.stayed (max_drift_m, max_turn_rad))
        ++stayed_;
      else
        std::fprintf (stderr, "%s: %s is at the end %.1f mm away and turned by %.1f degrees\n", who.c_str (),
                      body.name.c_str (), 1000.0 * body.drift_m, degrees_per_rad * body.turn_rad);
    }
    return true;
  }
  catch (const IoError& error)
  {
    std::fprintf (stderr, "%s: %s\n", who.c_str (), error.what ());
    return false;
  }
}

void
StabilityRow::add (const std::string& name, std::size_t objects, const PhysicalScene& scene, const std::string& folder)
{
  const std::string who = name + ", " + method_;
  const auto free = static_cast<std::size_t> (std::count_if (
      scene.bodies.begin (), scene.bodies.end (), [] (const PhysicalBody& body) { return !body.isStatic (); }));
  ++scenes_;
  bodies_ += free;
  missing_ += objects - free;
  if (free < objects)
    std::fprintf (stderr, "%s: %zu objects are missing\n", who.c_str (), objects - free);
  if (free == 0)
    return;
  fs::create_directories (folder);
  writeMjcf (scene, folder);
  if (!simulate ((fs::path (folder) / "scene.xml").string (), who))
    ++failed_scenes_;
  fs::remove_all (folder);
}

std::string
StabilityRow::head ()
{
  return "| bodies from | scenes | bodies | missing | stayed within 3 mm and 2° | flew away | failed simulations | "
         "drift "
         "(mm), median / largest | deepest initial contact (mm), median / largest "
         "|\n|---|---|---|---|---|---|---|---|---|\n";
}

std::string
StabilityRow::text () const
{
  const double share = 100.0 * static_cast<double> (stayed_) /
                       static_cast<double> (std::max<std::size_t> (bodies_ + missing_, 1));
  std::string text = "| " + method_;
  for (const std::string& cell :
       {std::to_string (scenes_), std::to_string (bodies_), std::to_string (missing_), numberOf (share, 0) + " %",
        std::to_string (flown_), std::to_string (failed_scenes_), rangeOf (drifts_m_), rangeOf (contacts_m_)})
    text += " | " + cell;
  return text + " |\n";
}
