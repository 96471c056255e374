// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "mujoco_simulation.h"

#include <pcl/cosection/common/error.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <mujoco/mujoco.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

using namespace pcl::cosection;

namespace {

constexpr double most_steps = 1e7;          // some minutes, of the smallest scene
constexpr double far_away = 10.0;           // in extents of the scene
constexpr std::size_t progress_steps = 100; // how often progress is reported

std::string
inOneLine (const std::string& text)
{
  std::istringstream words (text);
  std::string line;
  for (std::string word; words >> word;)
    line += (line.empty () ? "" : " ") + word;
  return (line);
}

/** \brief What MuJoCo's handlers, which have no other argument, know. */
struct MujocoReports
{
  std::function<void (const std::string& error)> on_error;
  std::vector<std::string> warnings;
};

MujocoReports&
mujocoReports ()
{
  static MujocoReports reports;
  return (reports);
}

/** \brief MuJoCo must not go on after an error. */
void
endWithError (const char* text)
{
  mujocoReports ().on_error (inOneLine (text));
  _exit (1);
}

void
noteWarning (const char* text)
{
  mujocoReports ().warnings.push_back (inOneLine (text));
}

struct MujocoDeleter
{
  void operator() (mjModel* model) const { mj_deleteModel (model); }
  void operator() (mjData* data) const { mj_deleteData (data); }
};

using Model = std::unique_ptr<mjModel, MujocoDeleter>;
using State = std::unique_ptr<mjData, MujocoDeleter>;

Model
loadModel (const std::string& path)
{
  char text[1000] = "";
  Model model (mj_loadXML (path.c_str (), nullptr, text, sizeof (text)));
  if (!model)
    throw IoError (inOneLine (text));
  if (text[0] != '\0')
    noteWarning (text);
  return (model);
}

std::string
nameOfBody (const mjModel& model, int body)
{
  const char* name = mj_id2name (&model, mjOBJ_BODY, body);
  return (name && *name ? name : "body " + std::to_string (body));
}

/** \brief The name of the body that a geom belongs to. */
std::string
nameOfOwner (const mjModel& model, int geom)
{
  const int body = model.geom_bodyid[geom];
  const char* name = mj_id2name (&model, mjOBJ_GEOM, geom);
  return (body == 0 && name && *name ? name : nameOfBody (model, body)); // 0: the world
}

std::optional<BodyContact>
deepestContact (const mjModel& model, const mjData& data)
{
  std::optional<BodyContact> deepest;
  for (int n = 0; n < data.ncon; ++n)
  {
    const mjContact& contact = data.contact[n];
    if (-contact.dist > (deepest ? deepest->depth_m : 0.0))
      deepest = {-contact.dist, nameOfOwner (model, contact.geom1), nameOfOwner (model, contact.geom2)};
  }
  return (deepest);
}

double
extentOf (const mjModel& model, const mjData& data)
{
  Eigen::AlignedBox3d box;
  for (int geom = 0; geom < model.ngeom; ++geom)
    if (model.geom_type[geom] != mjGEOM_PLANE)
    {
      const Eigen::Vector3d centre = Eigen::Map<const Eigen::Matrix<mjtNum, 3, 1>> (data.geom_xpos + 3 * geom);
      const Eigen::Vector3d radius = Eigen::Vector3d::Constant (model.geom_rbound[geom]);
      box.extend (Eigen::AlignedBox3d (centre - radius, centre + radius));
    }
  return (box.isEmpty () ? 0.0 : box.diagonal ().norm ());
}

/** \brief A body, and how far it moves. */
class TrackedBody
{
public:
  TrackedBody (const mjModel& model, const mjData& data, int body)
      : body_ (body)
      , centre_ (centre (data))
      , orientation_ (orientation (data))
  {
    drift_.name = nameOfBody (model, body);
  }

  void look (const mjData& data, double far_m)
  {
    drift_.drift_m = (centre (data) - centre_).norm ();
    drift_.turn_rad = orientation_.angularDistance (orientation (data));
    drift_.largest_drift_m = std::max (drift_.largest_drift_m, drift_.drift_m);
    drift_.largest_turn_rad = std::max (drift_.largest_turn_rad, drift_.turn_rad);
    drift_.flew_away = drift_.flew_away || !(drift_.drift_m <= far_m) || !std::isfinite (drift_.turn_rad);
  }

  const BodyDrift& drift () const { return (drift_); }

private:
  /** \brief Of the mass of the body and of those that are fixed to it. */
  Eigen::Vector3d centre (const mjData& data) const
  {
    return (Eigen::Map<const Eigen::Matrix<mjtNum, 3, 1>> (data.subtree_com + 3 * body_).cast<double> ());
  }

  Eigen::Quaterniond orientation (const mjData& data) const
  {
    const mjtNum* q = data.xquat + 4 * body_;
    return (Eigen::Quaterniond (q[0], q[1], q[2], q[3]).normalized ());
  }

  const int body_;
  const Eigen::Vector3d centre_;
  const Eigen::Quaterniond orientation_;
  BodyDrift drift_;
};

/** \brief A warning means that the state was set back to the beginning, or that contacts were left out: what follows is
 * worth nothing. */
void
requireNoWarning (const mjData& data, double time_s, const std::optional<BodyContact>& deepest)
{
  for (int n = 0; n < mjNWARNING; ++n)
  {
    if (data.warning[n].number == 0)
      continue;
    std::ostringstream text;
    text << "the simulation fails after " << time_s << " s: " << mju_warningText (n, data.warning[n].lastinfo);
    if (deepest)
      text << (text.str ().back () == '.' ? " " : ". ") << "At its start, the deepest contact is "
           << 1000.0 * deepest->depth_m << " mm, between " << deepest->first << " and " << deepest->second;
    throw IoError (inOneLine (text.str ()));
  }
}

std::vector<TrackedBody>
freeBodies (const mjModel& model, const mjData& data)
{
  std::vector<TrackedBody> bodies;
  for (int joint = 0; joint < model.njnt; ++joint)
    if (model.jnt_type[joint] == mjJNT_FREE)
      bodies.emplace_back (model, data, model.jnt_bodyid[joint]);
  if (bodies.empty ())
    throw IoError ("has no body with a free joint");
  return (bodies);
}

std::size_t
countSteps (const mjModel& model, double duration_s)
{
  constexpr double tolerance = 1e-6; // so that 5 s of 0.002 s are 2500 steps
  std::ostringstream time_step;
  time_step << model.opt.timestep << " s";
  if (!(model.opt.timestep > 0.0))
    throw IoError ("has a time step of " + time_step.str () + ", which is not greater than 0");
  const double steps = std::max (1.0, std::ceil (duration_s / model.opt.timestep - tolerance));
  if (!(steps <= most_steps))
    throw IoError ("has a time step of " + time_step.str () + ": too many steps");
  return (static_cast<std::size_t> (steps));
}

SceneStability
simulate (const Model& model, double duration_s, const std::function<bool (double share)>& progress)
{
  const State data (mj_makeData (model.get ()));
  mj_forward (model.get (), data.get ());
  SceneStability result;
  result.extent_m = extentOf (*model, *data);
  result.time_step_s = model->opt.timestep;
  result.deepest_contact = deepestContact (*model, *data);
  requireNoWarning (*data, 0.0, result.deepest_contact);
  std::vector<TrackedBody> bodies = freeBodies (*model, *data);
  const std::size_t steps = countSteps (*model, duration_s);
  const double far_m = far_away * result.extent_m;
  for (std::size_t n = 0; n <= steps; ++n)
  {
    if (n > 0)
      mj_step (model.get (), data.get ());
    if (n == steps) // mj_step leaves the places of bodies as they were before it
      mj_forward (model.get (), data.get ());
    requireNoWarning (*data, static_cast<double> (n) * result.time_step_s, result.deepest_contact);
    for (TrackedBody& body : bodies)
      body.look (*data, far_m);
    if (n % (steps / progress_steps + 1) == 0 &&
        !progress (static_cast<double> (n) / static_cast<double> (std::max<std::size_t> (steps, 1))))
      throw Cancelled ("the simulation was cancelled");
  }
  result.duration_s = static_cast<double> (steps) * result.time_step_s;
  for (const TrackedBody& body : bodies)
    result.bodies.push_back (body.drift ());
  result.warnings = mujocoReports ().warnings;
  return (result);
}

} // namespace

SceneStability
simulateInThisProcess (const std::string& path, double duration_s,
                       const std::function<void (const std::string& error)>& on_error,
                       const std::function<bool (double share)>& progress)
{
  mujocoReports ().on_error = on_error;
  mju_user_error = endWithError;
  mju_user_warning = noteWarning;
  return (simulate (loadModel (path), duration_s, progress));
}
