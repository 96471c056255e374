// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// fit_expected_error VIEWS SCENES [SCENES ...]: fits the constants of expectedError () to scenes with truth, as
// pcl_cosection_simulate --meshes writes them, from the first VIEWS views of each. Things whose place in the alphabet
// is even have no part in it, and show what the constants are worth for others; then the halves change places, and in
// the end all things count.

#include "pcl_cosection/completion/background/background.h"
#include "pcl_cosection/completion/energy_terms.h"
#include "pcl_cosection/completion/finish_objects.h"
#include "pcl_cosection/completion/joint_solve.h"
#include "pcl_cosection/completion/observe.h"
#include "pcl_cosection/completion/place_bodies.h"
#include "pcl_cosection/completion/surroundings.h"
#include "pcl_cosection/energy/body_mesh.h"
#include "pcl_cosection/volume/mesh_distance/mesh_surface.h"
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/pcd_view.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace pcl::cosection;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t least_points = 100; // as for pcl_cosection
constexpr double wanted_share = 0.95;
constexpr double least_share = 0.01, largest_share = 1.0, step = 1.02; // of the search

struct Vertex
{
  ErrorSources sources;
  double error_m;
};

using VerticesByThing = std::map<std::string, std::vector<Vertex>>;

Scene
readScene (const fs::path& folder, int views)
{
  Scene scene;
  std::map<int, std::vector<OrientedPoint>> points;
  for (int v = 0; v < views; ++v)
  {
    const fs::path file = folder / ("view" + std::to_string (v) + ".pcd");
    LabelledView view = readPcdView (file.string ());
    if (view.view)
      scene.views.push_back ({std::move (*view.view), ViewUse::Full});
    for (auto& [label, object] : view.objects)
      std::move (object.points.begin (), object.points.end (), std::back_inserter (points[static_cast<int> (label)]));
  }
  for (auto& [label, of_label] : points)
    if (label == 0)
      scene.background = std::move (of_label);
    else if (of_label.size () >= least_points)
      scene.objects.push_back ({label, std::move (of_label), {}});
  return scene;
}

/** \brief The stages of completeScene (), and what the errors of each mesh depend on beside the errors themselves. */
void
measure (const Scene& scene, const fs::path& folder, const std::map<int, std::string>& names, VerticesByThing& vertices)
{
  SceneState state;
  CompletionLog log (scene.objects.size (), {});
  const CompletionMode mode = CompletionMode::Once;
  const std::vector<Observation> observations = observeObjects (scene, mode, state, log);
  const std::vector<SupportPlanes> support = findObjectPlanes (scene, observations, log);
  const std::vector<SceneObject> objects = placeObjects (scene, observations, support, mode, state, log);
  BackgroundBodies bodies = placeBackground (scene, objects, mode, bytesInUse (scene, state, observations), state, log);
  gatherEvidence (scene, mode, objects, bodies, log);
  const Background background = solveBackground (scene, objects, mode, UpdateOutput::Fields, bodies, log);
  std::vector<BodyEnergy> energies = objectEnergies (scene, mode, objects, log);
  solveJointly (scene, objects, background.fields (), {}, energies, log);
  forEachObject (objects, log, [&] (std::size_t o) {
    const int label = objects[o].input->id;
    const TriangleMesh mesh = closedMesh (energies[o], objects[o].body->solution);
    const std::vector<ErrorSources> sources = errorSourcesOf (objects[o], energies[o], mesh);
    const SurfaceDistance truth (loadMesh ((folder / ("truth_" + std::to_string (label) + ".ply")).string ()));
    const std::vector<double> errors = vertexDistances (mesh, truth);
    std::vector<Vertex>& of_thing = vertices[names.at (label)];
    for (std::size_t v = 0; v < sources.size (); ++v)
      of_thing.push_back ({sources[v], errors[v]});
  });
}

std::map<int, std::string>
readNames (const fs::path& folder)
{
  std::map<int, std::string> names;
  std::ifstream file (folder / "names.txt");
  std::string name;
  for (int label; file >> label >> name;)
    names[label] = name;
  return names;
}

/** \brief The share of the size for which the pinball loss of the 95 % quantile, two sigma, is least (R. Koenker, G.
 * Bassett, "Regression quantiles", Econometrica 1978). */
double
bestShare (const std::vector<Vertex>& vertices, bool has_target)
{
  double best = least_share, least_loss = std::numeric_limits<double>::infinity ();
  for (double share = least_share; share < largest_share; share *= step)
  {
    double loss = 0.0;
    for (const Vertex& vertex : vertices)
      if (vertex.sources.has_target == has_target)
      {
        const double above_m = vertex.error_m - 2.0 * expectedError (vertex.sources, {share, share});
        loss += above_m > 0.0 ? wanted_share * above_m : (wanted_share - 1.0) * above_m;
      }
    if (loss < least_loss)
    {
      least_loss = loss;
      best = share;
    }
  }
  return best;
}

std::vector<Vertex>
verticesOf (const VerticesByThing& things, const std::set<std::string>& names)
{
  std::vector<Vertex> vertices;
  for (const std::string& name : names)
    vertices.insert (vertices.end (), things.at (name).begin (), things.at (name).end ());
  return vertices;
}

void
printCoverage (const char* what, const std::vector<Vertex>& vertices, const SizeShares& shares)
{
  double within_one = 0.0, within_two = 0.0, sigma_m = 0.0;
  for (const Vertex& vertex : vertices)
  {
    const double expected_m = expectedError (vertex.sources, shares);
    within_one += vertex.error_m <= expected_m;
    within_two += vertex.error_m <= 2.0 * expected_m;
    sigma_m += expected_m;
  }
  const auto count = static_cast<double> (vertices.size ());
  std::printf ("  %-8s %8zu vertices, within one sigma %.3f, within two %.3f, mean sigma %.2f mm\n", what,
               vertices.size (), within_one / count, within_two / count, 1000.0 * sigma_m / count);
}

} // namespace

int
main (int argc, char** argv)
{
  try
  {
    if (argc < 3)
    {
      std::fprintf (stderr, "usage: fit_expected_error VIEWS SCENES [SCENES ...]\n");
      return EXIT_FAILURE;
    }
    VerticesByThing things;
    for (int a = 2; a < argc; ++a)
      for (const auto& folder : std::set<fs::path> (fs::directory_iterator (argv[a]), fs::directory_iterator ()))
        measure (readScene (folder, std::atoi (argv[1])), folder, readNames (folder), things);
    std::set<std::string> halves[2], all;
    for (const auto& [name, vertices] : things)
    {
      halves[all.size () % 2].insert (name);
      all.insert (name);
    }
    const std::set<std::string> fitted[3] = {halves[0], halves[1], all}, others[3] = {halves[1], halves[0], {}};
    for (int n = 0; n < 3; ++n)
    {
      const std::vector<Vertex> vertices = verticesOf (things, fitted[n]);
      const SizeShares shares = {bestShare (vertices, true), bestShare (vertices, false)};
      std::printf ("fitted to %zu things: %.3f with a target, %.3f without\n", fitted[n].size (), shares.with_target,
                   shares.without);
      printCoverage ("fitted", vertices, shares);
      if (!others[n].empty ())
        printCoverage ("others", verticesOf (things, others[n]), shares);
    }
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf (stderr, "fit_expected_error: %s\n", error.what ());
    return EXIT_FAILURE;
  }
}
