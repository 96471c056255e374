// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene_stability.h"

#ifdef PCL_COSECTION_HAS_MUJOCO

#include "mujoco_simulation.h"

#include "pcl_cosection/common/byte_text.h"
#include "pcl_cosection/common/files.h"
#include "pcl_cosection/segmentation/network/child_process.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

namespace fs = std::filesystem;
using namespace pcl::cosection;

namespace {

using Message = nlohmann::json; // sent as CBOR, which has numbers that are not finite

constexpr std::uintmax_t most_file_bytes = std::uintmax_t (1) << 28;
constexpr std::uint64_t most_message_bytes = 1 << 26;

bool
sendMessage (const Channel& channel, const Message& message)
{
  const std::vector<std::uint8_t> bytes = Message::to_cbor (message);
  const std::uint64_t size = bytes.size ();
  return (channel.send (&size, sizeof (size)) && channel.send (bytes.data (), bytes.size ()));
}

Message
toMessage (const SceneStability& result)
{
  Message message = {{"extent", result.extent_m},
                     {"time_step", result.time_step_s},
                     {"duration", result.duration_s},
                     {"warnings", result.warnings},
                     {"bodies", Message::array ()}};
  if (result.deepest_contact)
    message["contact"] = {result.deepest_contact->depth_m, result.deepest_contact->first,
                          result.deepest_contact->second};
  for (const BodyDrift& body : result.bodies)
    message["bodies"].push_back (
        {body.name, body.drift_m, body.turn_rad, body.largest_drift_m, body.largest_turn_rad, body.flew_away});
  return (message);
}

/** \brief What the process does in which MuJoCo runs. */
void
serveScene (const Channel& to_parent, const std::string& path, double duration_s)
{
  limitMemory ();
  to_parent.endIfClosed (true); // loading may take long, and sends nothing
  const auto send = [&] (const Message& message) {
    to_parent.endIfClosed (false);
    return (sendMessage (to_parent, message));
  };
  try
  {
    const SceneStability result = simulateInThisProcess (
        path, duration_s,
        [&] (const std::string& error) {
          send ({{"error", error}});
        },
        [&] (double share) {
          return (send ({{"progress", share}}));
        });
    send ({{"result", toMessage (result)}});
  }
  catch (const std::exception& error)
  {
    const bool is_memory = dynamic_cast<const std::bad_alloc*> (&error) != nullptr;
    send ({{"error", is_memory ? "out of memory" : error.what ()}});
  }
}

/** \brief Wait for a message. \return nothing if the other process is gone, or sends what is no message */
std::optional<Message>
receiveMessage (const Channel& channel)
{
  std::uint64_t size = 0;
  if (!channel.receive (&size, sizeof (size)) || size > most_message_bytes)
    return (std::nullopt);
  std::vector<std::uint8_t> bytes (size);
  if (!channel.receive (bytes.data (), bytes.size ()))
    return (std::nullopt);
  Message message = Message::from_cbor (bytes, true, false);
  return (message.is_object () ? std::optional<Message> (std::move (message)) : std::nullopt);
}

SceneStability
fromMessage (const Message& message)
{
  SceneStability result;
  result.extent_m = message.at ("extent").get<double> ();
  result.time_step_s = message.at ("time_step").get<double> ();
  result.duration_s = message.at ("duration").get<double> ();
  result.warnings = message.at ("warnings").get<std::vector<std::string>> ();
  if (const auto contact = message.find ("contact"); contact != message.end ())
    result.deepest_contact = {contact->at (0).get<double> (), contact->at (1).get<std::string> (),
                              contact->at (2).get<std::string> ()};
  for (const Message& entry : message.at ("bodies"))
  {
    BodyDrift body;
    body.name = entry.at (0).get<std::string> ();
    body.drift_m = entry.at (1).get<double> ();
    body.turn_rad = entry.at (2).get<double> ();
    body.largest_drift_m = entry.at (3).get<double> ();
    body.largest_turn_rad = entry.at (4).get<double> ();
    body.flew_away = entry.at (5).get<bool> ();
    result.bodies.push_back (body);
  }
  return (result);
}

/** \brief The errors of opening and reading a file are the system's; MuJoCo names fewer. */
std::string
readSceneFile (const std::string& path)
{
  std::error_code unknown;
  const std::uintmax_t size = fs::file_size (path, unknown);
  if (!unknown && fs::is_regular_file (path, unknown) && size > most_file_bytes)
    throw IoError (path + ": has more than " + byteText (most_file_bytes));
  return (readBytes (path));
}

/** \brief The names and the quoted values of what looks like an attribute in XML. */
std::vector<std::pair<std::string, std::string>>
attributesOf (const std::string& xml)
{
  const char* const space = " \t\r\n";
  std::vector<std::pair<std::string, std::string>> attributes;
  for (std::size_t at = xml.find ('='); at != std::string::npos; at = xml.find ('=', at + 1))
  {
    const std::size_t quote = xml.find_first_not_of (space, at + 1);
    const std::size_t last = at == 0 ? std::string::npos : xml.find_last_not_of (space, at - 1);
    if (quote == std::string::npos || last == std::string::npos || (xml[quote] != '"' && xml[quote] != '\''))
      continue;
    const std::size_t before = xml.find_last_of (" \t\r\n<\"'", last);
    const std::size_t end = xml.find (xml[quote], quote + 1);
    if (before != std::string::npos && end != std::string::npos)
      attributes.emplace_back (xml.substr (before + 1, last - before), xml.substr (quote + 1, end - quote - 1));
  }
  return (attributes);
}

template <typename T>
bool
contains (const std::vector<T>& all, const T& one)
{
  return (std::find (all.begin (), all.end (), one) != all.end ());
}

/** \brief MuJoCo waits for what a pipe has, and reads from a device for ever: \a path and what it names are regular
 * files. What is not found is left to MuJoCo, which names it. */
void
requireSceneFiles (const std::string& path)
{
  std::vector<fs::path> folders = {fs::path (path).parent_path ()};
  std::vector<std::string> scenes = {path};
  for (std::size_t n = 0; n < scenes.size (); ++n)
  {
    const auto attributes = attributesOf (readSceneFile (scenes[n]));
    for (const auto& [key, value] : attributes)
      if ((key == "meshdir" || key == "texturedir") && !contains (folders, folders.front () / value))
        folders.push_back (folders.front () / value);
    for (const auto& [key, name] : attributes)
    {
      if (key.rfind ("file", 0) != 0) // file, fileup, fileright ... of includes, meshes, height fields and textures
        continue;
      for (const fs::path& folder : folders)
        for (const fs::path& found : {folder / name, folder / fs::path (name).filename ()}) // with strippath
        {
          std::error_code unknown;
          if (!fs::exists (found, unknown) || fs::is_directory (found, unknown))
            continue;
          if (!fs::is_regular_file (found, unknown))
            throw IoError (path + ": names '" + found.string () + "', which is not a regular file");
          if (found.extension () == ".xml" && !contains (scenes, found.string ()))
            scenes.push_back (found.string ());
        }
    }
  }
}

} // namespace

bool
canSimulate ()
{
  return (true);
}

SceneStability
simulateScene (const std::string& path, double duration_s, const ProgressCallback& progress)
{
  requireSceneFiles (path);
  ChildProcess process ([&] (Channel& to_parent) { serveScene (to_parent, path, duration_s); });
  try
  {
    while (const std::optional<Message> message = receiveMessage (process.channel ()))
    {
      if (message->contains ("error"))
        throw IoError (path + ": " + message->at ("error").get<std::string> ());
      if (message->contains ("result"))
        return (fromMessage (message->at ("result")));
      if (progress && !progress ("simulation", message->at ("progress").get<double> ()))
        throw Cancelled ("the simulation was cancelled");
    }
  }
  catch (const Message::exception&)
  {
    throw IoError (path + ": MuJoCo crashes");
  }
  throw IoError (path + ": " + causeOfEnd (process.waitForEnd (), "MuJoCo"));
}

#else

bool
canSimulate ()
{
  return (false);
}

SceneStability
simulateScene (const std::string& /*path*/, double /*duration_s*/, const pcl::cosection::ProgressCallback& /*progress*/)
{
  throw pcl::cosection::Error ("this build has no MuJoCo: install libmujoco-dev and build again");
}

#endif
