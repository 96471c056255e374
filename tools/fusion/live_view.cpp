// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "live_view.h"

#include "method_json.h"
#include "output_files.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/io/mesh_io.h>
#include <pcl/cosection/io/trajectory.h>

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

const char* const viewer = "pcl_cosection_viewer";
constexpr std::size_t background_parts = 16;
constexpr std::chrono::milliseconds snapshot_every (200), look_every (20);
constexpr std::chrono::seconds patience (60); ///< until the window is there
constexpr int columns = 64;                   ///< of the background's mesh
constexpr double deepest_jump = 0.06;         ///< between neighbours on one surface, of their depth
constexpr TriangleMesh::Colour no_colour = {200, 200, 200};
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max ();

void
addNormals (TriangleMesh& mesh)
{
  mesh.normals.assign (mesh.vertices.size (), Eigen::Vector3f::Zero ());
  for (const TriangleMesh::Triangle& t : mesh.triangles)
  {
    const Eigen::Vector3f normal = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                       .cross (mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (const std::uint32_t vertex : t)
      mesh.normals[vertex] += normal;
  }
  for (Eigen::Vector3f& normal : mesh.normals)
    normal = normal.norm () > 0.0f ? Eigen::Vector3f (normal.normalized ()) : Eigen::Vector3f::UnitZ ();
}

/** \brief A mesh in the world of the background's pixels in a frame, at a stride. */
TriangleMesh
backgroundOf (const FrameReport& report, const PinholeCamera& camera)
{
  TriangleMesh mesh;
  if (!report.instances)
    return (mesh);
  const Image<float>& depth = report.frame.depth;
  const int step = std::max (1, depth.width / columns);
  const int width = depth.width / step, height = depth.height / step;
  std::vector<std::uint32_t> vertex_of (static_cast<std::size_t> (width) * height, none);
  std::vector<float> z_of;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
    {
      const float z = depth.at (u * step, v * step);
      if (!std::isfinite (z) || (!report.instances->pixels.empty () && report.instances->at (u * step, v * step) != 0))
        continue;
      vertex_of[static_cast<std::size_t> (v) * width + u] = static_cast<std::uint32_t> (mesh.vertices.size ());
      mesh.vertices.push_back ((report.T_world_camera * camera.unproject (u * step, v * step, z)).cast<float> ());
      mesh.colours.push_back (report.frame.colour.pixels.empty () ? no_colour
                                                                  : report.frame.colour.at (u * step, v * step));
      z_of.push_back (z);
    }
  const auto add = [&] (std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a == none || b == none || c == none)
      return;
    const auto [least, most] = std::minmax ({z_of[a], z_of[b], z_of[c]});
    if (most - least < deepest_jump * most)
      mesh.triangles.push_back ({a, b, c});
  };
  for (int v = 0; v + 1 < height; ++v)
    for (int u = 0; u + 1 < width; ++u)
    {
      const std::size_t n = static_cast<std::size_t> (v) * width + u;
      // Counter-clockwise for the camera, whose y points down.
      add (vertex_of[n], vertex_of[n + width], vertex_of[n + 1]);
      add (vertex_of[n + 1], vertex_of[n + width], vertex_of[n + width + 1]);
    }
  addNormals (mesh);
  return (mesh);
}

/** \brief Write what has changed, in the layout of a run; each file is whole. */
void
writeLiveScene (const LiveScene& scene, const std::string& folder)
{
  const fs::path mesh = fs::path (folder) / "mesh", trajectory = fs::path (folder) / "trajectory";
  const auto write = [&mesh] (const TriangleMesh& surface, const std::string& name) {
    if (!surface.empty ())
      saveMesh (surface, (mesh / name).string ());
  };
  for (const auto& [id, surface] : scene.seen)
    write (surface, "object_" + std::to_string (id) + "_tsdf.ply");
  for (const auto& [id, surface] : scene.completed)
    write (surface, "object_" + std::to_string (id) + ".ply");
  if (scene.changed_background)
  {
    TriangleMesh all;
    for (const TriangleMesh& part : scene.background)
      if (all.vertices.empty ())
        all = part;
      else
        appendMesh (all, part);
    write (all, "background.ply");
  }
  for (const auto& [id, poses] : scene.objects)
    saveTrajectory (poses, (trajectory / ("object_" + std::to_string (id) + ".txt")).string ());
  if (!scene.camera.empty ()) // last: its time shows that there is something new
    saveTrajectory (scene.camera, (trajectory / "camera.txt").string ());
}

std::string
makeTemporaryFolder ()
{
  std::error_code failure;
  std::string folder = (fs::temp_directory_path (failure) / "pcl_cosection_live_XXXXXX").string ();
  if (failure || mkdtemp (folder.data ()) == nullptr)
    throw IoError ("--live: no temporary folder can be made: " +
                   (failure ? failure.message () : std::string (std::strerror (errno))));
  return (folder);
}

/** \brief From here on, this thread runs only while a processor has nothing else to do: the run comes first. */
void
giveWay ()
{
  const sched_param none = {};
  sched_setscheduler (0, SCHED_IDLE, &none);
}

/** \brief The viewer beside this program, else the one that is found by its name. */
std::string
viewerPath ()
{
  std::error_code failure;
  const fs::path beside = fs::read_symlink ("/proc/self/exe", failure).parent_path () / viewer;
  return (!failure && access (beside.c_str (), X_OK) == 0 ? beside.string () : viewer);
}

/** \brief What a process said last, without its name. */
std::string
lastLine (const std::string& path)
{
  std::ifstream file (path);
  std::string line, last;
  while (std::getline (file, line))
    if (!line.empty ())
      last = line;
  const std::string before = "error: ";
  const std::size_t place = last.find (before);
  return (place == std::string::npos ? last : last.substr (place + before.size ()));
}

} // namespace

LiveView::LiveView (const std::string& dataset, const PinholeCamera& camera, const std::string& output)
    : camera_ (camera)
    , folder_ (makeTemporaryFolder ())
{
  try
  {
    fs::create_directory (fs::path (folder_) / "mesh");
    fs::create_directory (fs::path (folder_) / "trajectory");
    const nlohmann::ordered_json summary = {{"camera", cameraJson (camera)}, {"parameters", {{"dataset", dataset}}}};
    saveJson (summary, (fs::path (folder_) / "summary.json").string ());
    start (output);
    waitUntilReady ();
    thread_ = std::thread ([this] { writeSnapshots (); });
  }
  catch (...)
  {
    giveUp ();
    throw;
  }
}

LiveView::~LiveView ()
{
  {
    const std::lock_guard<std::mutex> lock (mutex_);
    stop_ = true;
  }
  changed_.notify_all ();
  thread_.join ();
  close (input_); // now the viewer turns to the result
  std::error_code ignored;
  fs::remove_all (folder_, ignored);
}

void
LiveView::giveUp ()
{
  if (process_ > 0)
  {
    kill (process_, SIGKILL);
    waitpid (process_, nullptr, 0);
  }
  if (input_ >= 0)
    close (input_);
  std::error_code ignored;
  fs::remove_all (folder_, ignored);
}

void
LiveView::start (const std::string& output)
{
  std::array<int, 2> ends;
  if (pipe2 (ends.data (), O_CLOEXEC) != 0)
    throw IoError (std::string ("--live: the viewer cannot be started: ") + std::strerror (errno));
  input_ = ends[1];
  const std::string path = viewerPath (), log = (fs::path (folder_) / "viewer.log").string ();
  std::array<const char*, 6> words = {path.c_str (), "--follow", folder_.c_str (), "--", output.c_str (), nullptr};
  process_ = fork ();
  if (process_ == 0) // from here on only what a signal handler may call
  {
    const int to = open (log.c_str (), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (to < 0 || dup2 (ends[0], STDIN_FILENO) < 0 || dup2 (to, STDOUT_FILENO) < 0 || dup2 (to, STDERR_FILENO) < 0)
      _exit (126);
    giveWay ();
    execvp (words[0], const_cast<char* const*> (words.data ()));
    _exit (127);
  }
  const int error = errno;
  close (ends[0]);
  if (process_ < 0)
    throw IoError (std::string ("--live: the viewer cannot be started: ") + std::strerror (error));
}

bool
LiveView::hasEnded ()
{
  if (process_ < 0)
    return (true);
  if (waitpid (process_, nullptr, WNOHANG) != process_)
    return (false);
  process_ = -1;
  return (true);
}

void
LiveView::waitUntilReady ()
{
  const fs::path ready = fs::path (folder_) / "ready";
  const auto start = std::chrono::steady_clock::now ();
  std::error_code ignored;
  while (!fs::exists (ready, ignored))
  {
    if (hasEnded ())
    {
      const std::string why = lastLine ((fs::path (folder_) / "viewer.log").string ());
      throw IoError ("--live: " +
                     (why.empty () ? std::string ("there is no program ") + viewer : why.substr (0, why.find (';'))));
    }
    if (std::chrono::steady_clock::now () - start > patience)
      throw IoError ("--live: the window does not open");
    std::this_thread::sleep_for (look_every);
  }
}

void
LiveView::show (const FrameReport& report)
{
  if (is_over_)
    return;
  // Volumes change with the next frame, so that their surfaces are made here.
  std::map<int, TriangleMesh> seen;
  TriangleMesh background;
  if (report.keyframe)
  {
    for (const auto& [id, pose] : report.T_world_object)
      seen[id] = report.seen (id);
    background = backgroundOf (report, camera_);
  }
  const std::lock_guard<std::mutex> lock (mutex_);
  scene_.camera.push_back ({report.frame.stamp, report.T_world_camera});
  for (const auto& [id, pose] : report.T_world_object)
    scene_.objects[id].push_back ({report.frame.stamp, pose});
  for (auto& [id, mesh] : seen)
    scene_.seen[id] = std::move (mesh);
  if (!background.empty ())
  {
    scene_.background.push_back (std::move (background));
    if (scene_.background.size () > background_parts)
      scene_.background.pop_front ();
    scene_.changed_background = true;
  }
  is_new_ = true;
  changed_.notify_all ();
}

void
LiveView::show (const KeyframeReport& report)
{
  if (is_over_)
    return;
  const std::lock_guard<std::mutex> lock (mutex_);
  for (const ObjectResult& object : report.scene.objects)
    if (object.error.empty ())
      scene_.completed[object.id] = object.mesh;
  is_new_ = true;
  changed_.notify_all ();
}

LiveScene
LiveView::takeChanges ()
{
  LiveScene changes;
  changes.camera = scene_.camera;
  changes.objects = scene_.objects;
  std::swap (changes.seen, scene_.seen);
  std::swap (changes.completed, scene_.completed);
  if (scene_.changed_background)
    changes.background = scene_.background;
  std::swap (changes.changed_background, scene_.changed_background);
  is_new_ = false;
  return (changes);
}

void
LiveView::writeSnapshots ()
{
  giveWay ();
  std::unique_lock<std::mutex> lock (mutex_);
  while (true)
  {
    changed_.wait (lock, [this] { return (is_new_ || stop_); });
    if (stop_)
      return;
    const LiveScene scene = takeChanges ();
    lock.unlock ();
    try
    {
      writeLiveScene (scene, folder_);
    }
    catch (const Error&)
    {
      is_over_ = true; // the disk is full: the run goes on
    }
    if (hasEnded ())
      is_over_ = true; // the window was closed
    lock.lock ();
    if (is_over_)
      return;
    changed_.wait_for (lock, snapshot_every, [this] { return (stop_); });
  }
}
