// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "help_text.h"

#include <pcl/cosection/version.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace
{

constexpr std::size_t text_width = 80;
constexpr std::size_t name_width = 30; ///< of the column of option names

const char* const synopsis = "pcl_cosection [OPTIONS] INPUT.pcd [INPUT.pcd ...] OUTPUT";

const char* const purpose = "Completes the hidden surfaces of objects in point clouds: closed meshes that keep clear of "
                            "seen free space and of each other.";

const char* const input_text =
    "INPUT is a view: points in the sensor frame; VIEWPOINT of the header is the pose of the sensor. An integer field "
    "\"label\" says which object a point belongs to, 0 is the background; without it, everything is object 1. Organised "
    "clouds, and others that were seen from their viewpoint, also tell which space is free.";

const char* const output_text =
    "OUTPUT ending in .ply, .stl or .obj is one file with the meshes of all objects, without the background; anything "
    "else is a folder for background.ply and object_LABEL.ply. Meshes are in metres, in the world frame, or in the frame "
    "of an object that has a trajectory.";

const char* const configuration_text =
    "A configuration file has a line NAME = VALUE for each option, without the dashes:";
const char* const configuration_lines[] = {"voxel-size = 0.004", "plane = [0, 0, 1, 0.72]"};

const char* const status_text = "Exit status: 0 all went well, 1 something failed, 2 wrong usage, 130 interrupted.";

/** \brief \a text in lines, all but the first after \a indent spaces. */
std::string
wrapped (const std::string& text, std::size_t indent)
{
  std::istringstream words (text);
  std::string result, word;
  std::size_t column = indent;
  while (words >> word)
  {
    if (column > indent && column + 1 + word.size () > text_width)
    {
      result += "\n" + std::string (indent, ' ');
      column = indent;
    }
    else if (column > indent)
    {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size ();
  }
  return (result + "\n");
}

std::string
nameOf (const CLI::Option& option)
{
  std::string name;
  for (const std::string& letter : option.get_snames ())
    name += "-" + letter + ", ";
  for (const std::string& word : option.get_lnames ())
    name += "--" + word;
  return (option.get_option_text ().empty () ? name : name + " " + option.get_option_text ());
}

std::vector<const CLI::Option*>
optionsOf (const CLI::App& app, const std::string& group)
{
  return (app.get_options ([&group] (const CLI::Option* option) {
    return (option->get_group () == group && !option->get_lnames ().empty ());
  }));
}

std::vector<std::string>
groupsOf (const CLI::App& app)
{
  std::vector<std::string> groups;
  for (const std::string& group : app.get_groups ())
    if (!group.empty () && !optionsOf (app, group).empty ())
      groups.push_back (group);
  return (groups);
}

std::string
lowerCase (std::string text)
{
  std::transform (text.begin (), text.end (), text.begin (),
                  [] (unsigned char c) { return (static_cast<char> (std::tolower (c))); });
  return (text);
}

std::string
groupText (const CLI::App& app, const std::string& group)
{
  std::string text = group + ":\n";
  for (const CLI::Option* option : optionsOf (app, group))
  {
    std::string line = "  " + nameOf (*option);
    line += line.size () + 2 > name_width ? "\n" + std::string (name_width, ' ')
                                          : std::string (name_width - line.size (), ' ');
    text += line + wrapped (option->get_description (), name_width);
  }
  return (text);
}

std::string
exampleText ()
{
  std::string text = "Examples:\n";
  for (const UsageExample& example : usageExamples ())
    text += "  " + example.command + "\n      " + wrapped (example.meaning, 6);
  return (text);
}

/** \brief For man: no line may begin with a dot or an apostrophe, and dashes are to be dashes. */
std::string
escaped (const std::string& text)
{
  std::string result;
  for (const char c : text)
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  return (result.empty () || (result[0] != '.' && result[0] != '\'') ? result : "\\&" + result);
}

} // namespace

const std::vector<UsageExample>&
usageExamples ()
{
  static const std::vector<UsageExample> examples = {
      {"pcl_cosection table.pcd meshes",
       "every labelled object of one organised view, and the table, into the folder meshes"},
      {"pcl_cosection front.pcd left.pcd cup.ply",
       "one object seen in two views (VIEWPOINT in each header), as one closed mesh"},
      {"pcl_cosection --plane 0,0,1,0 --voxel-size 0.003 cropped.pcd cup.stl",
       "what stands on a known plane, z = 0 in the world, with voxels of 3 mm"},
      {"pcl_cosection --obstacle shelf.off --max-faces 2000 cropped.pcd cup.obj",
       "what stands in a shelf whose model is known, in a mesh of 2000 triangles"},
      {"pcl_cosection --scale 0.001 --save-bounds scan_mm.pcd part.ply",
       "a scan in millimetres; also part_inner.ply and part_outer.ply"},
      {"pcl_cosection --preset paper --constraints hull --json s.json table.pcd out",
       "the parameters of the publication, without the intersection constraint"},
  };
  return (examples);
}

std::vector<std::string>
helpTopics (const CLI::App& app)
{
  std::vector<std::string> topics;
  for (const std::string& group : groupsOf (app))
    topics.push_back (lowerCase (group));
  topics.push_back ("examples");
  return (topics);
}

std::string
helpText (const CLI::App& app, const std::string& topic)
{
  if (topic == "examples")
    return (exampleText ());
  for (const std::string& group : groupsOf (app))
    if (lowerCase (group) == topic)
      return (groupText (app, group));
  std::string topics;
  for (const std::string& name : helpTopics (app))
    topics += (topics.empty () ? "" : ", ") + name;
  std::string text = wrapped (purpose, 0) + "\nUsage: " + synopsis + "\n\n" + wrapped (input_text, 2) +
                     wrapped (output_text, 2) + "\n" + wrapped ("For a part of this: --help TOPIC, one of " + topics + ".", 0);
  for (const std::string& group : groupsOf (app))
    text += "\n" + groupText (app, group);
  text += "\n" + exampleText () + "\n" + wrapped (configuration_text, 0);
  for (const char* line : configuration_lines)
    text += "  " + std::string (line) + "\n";
  return (text + "\n" + wrapped (status_text, 0));
}

std::string
manPage (const CLI::App& app)
{
  std::string text = ".TH PCL_COSECTION 1 \"\" \"pcl_cosection " PCL_COSECTION_VERSION "\" \"User Commands\"\n"
                     ".SH NAME\npcl_cosection \\- complete the hidden surfaces of objects in point clouds\n"
                     ".SH SYNOPSIS\n.B " +
                     escaped (synopsis) + "\n.SH DESCRIPTION\n" + escaped (purpose) + "\n.PP\n" + escaped (input_text) +
                     "\n.PP\n" + escaped (output_text) + "\n.SH OPTIONS\n";
  for (const std::string& group : groupsOf (app))
  {
    text += ".SS " + group + "\n";
    for (const CLI::Option* option : optionsOf (app, group))
      text += ".TP\n.B " + escaped (nameOf (*option)) + "\n" + escaped (option->get_description ()) + "\n";
  }
  text += ".SH EXAMPLES\n";
  for (const UsageExample& example : usageExamples ())
    text += ".TP\n.B " + escaped (example.command) + "\n" + escaped (example.meaning) + "\n";
  text += ".SH FILES\n" + escaped (configuration_text) + "\n.PP\n.nf\n";
  for (const char* line : configuration_lines)
    text += escaped (line) + "\n";
  return (text + ".fi\n.SH EXIT STATUS\n" + escaped (status_text) + "\n");
}
