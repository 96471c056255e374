// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include <pcl/cosection/segmentation/instance_detector.h>

#include "pcl_cosection/common/files.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <optional>

namespace pcl::cosection {
namespace {

constexpr std::size_t longest_name = 200;
constexpr std::size_t most_names = 100000;

/** \brief The number that fills \a word. */
std::optional<std::size_t>
wholeNumber (const std::string& word)
{
  std::size_t number = 0;
  const auto [end, error] = std::from_chars (word.data (), word.data () + word.size (), number);
  if (error != std::errc () || end != word.data () + word.size ())
    return (std::nullopt);
  return (number);
}

bool
isAmong (const DetectedInstance& instance, const std::vector<std::string>& classes)
{
  return (std::any_of (classes.begin (), classes.end (), [&] (const std::string& word) {
    return (word == instance.class_name || word == std::to_string (instance.class_id));
  }));
}

void
requireKnown (const std::string& word, const std::vector<std::string>& names)
{
  if (word.empty ())
    throw InvalidArgument ("a class must have a name");
  const std::optional<std::size_t> number = wholeNumber (word);
  if (std::find (names.begin (), names.end (), word) != names.end () ||
      (number && (names.empty () || *number < names.size ())))
    return;
  throw InvalidArgument (names.empty ()
                             ? "class \"" + word + "\" is given by its name, but the class names are not given"
                             : "there is no class \"" + word + "\" among the " + std::to_string (names.size ()) +
                                   " class names");
}

void
drawInstance (const DetectedInstance& instance, std::uint32_t value, Image<std::uint32_t>& image)
{
  const int right = std::min (image.width, instance.left + instance.mask.width);
  const int bottom = std::min (image.height, instance.top + instance.mask.height);
  for (int v = std::max (0, instance.top); v < bottom; ++v)
    for (int u = std::max (0, instance.left); u < right; ++u)
      if (instance.mask.at (u - instance.left, v - instance.top) != 0 && image.at (u, v) == 0)
        image.at (u, v) = value;
}

} // namespace

std::vector<std::string>
loadClassNames (const std::string& path)
{
  const std::string text = readBytes (path);
  std::vector<std::string> names;
  for (std::size_t at = 0; at < text.size ();)
  {
    const std::size_t end = std::min (text.find ('\n', at), text.size ());
    std::string name = text.substr (at, end - at);
    name.erase (0, name.find_first_not_of (" \t\r"));
    name.erase (name.find_last_not_of (" \t\r") + 1);
    if (name.size () > longest_name || names.size () == most_names ||
        std::any_of (name.begin (), name.end (), [] (unsigned char c) { return (c < 0x20 || c == 0x7f); }))
      throw IoError (path + ": is not a list of class names, one in each line");
    names.push_back (std::move (name));
    at = end + 1;
  }
  while (!names.empty () && names.back ().empty ())
    names.pop_back ();
  if (names.empty ())
    throw IoError (path + ": holds no class name");
  return (names);
}

void
ClassRoles::validate (const std::vector<std::string>& class_names) const
{
  std::vector<std::string> seen;
  for (const std::vector<std::string>* role : {&objects, &statics, &ignored})
  {
    for (const std::string& word : *role)
    {
      requireKnown (word, class_names);
      if (std::find (seen.begin (), seen.end (), word) != seen.end ())
        throw InvalidArgument ("class \"" + word + "\" cannot be several of object, static and ignored");
    }
    seen.insert (seen.end (), role->begin (), role->end ());
  }
}

InstanceLabels
labelInstances (const std::vector<DetectedInstance>& instances, int width, int height, const ClassRoles& roles,
                const Image<std::uint8_t>& readings)
{
  const auto isWhole = [] (const auto& image) {
    return image.width >= 0 && image.height >= 0 &&
           image.pixels.size () == static_cast<std::size_t> (image.width) * image.height;
  };
  if (width < 0 || height < 0)
    throw InvalidArgument ("the size of an image must not be negative");
  if (!readings.pixels.empty () && (readings.width != width || readings.height != height || !isWhole (readings)))
    throw InvalidArgument ("readings must be of the image's size");
  if (!std::all_of (instances.begin (), instances.end (),
                    [&] (const DetectedInstance& instance) { return isWhole (instance.mask); }))
    throw InvalidArgument ("the mask of an instance must have as many pixels as its size says");
  std::vector<std::size_t> order (instances.size ());
  std::iota (order.begin (), order.end (), 0u);
  std::stable_sort (order.begin (), order.end (),
                    [&] (std::size_t a, std::size_t b) { return (instances[a].score > instances[b].score); });

  const auto ignored = static_cast<std::uint32_t> (instances.size () + 1);
  const std::uint32_t no_reading = ignored + 1;
  Image<std::uint32_t> owners (width, height, 0); // 0: unassigned; 1 + instance; ignored; no_reading
  for (std::size_t i = 0; i < readings.pixels.size (); ++i)
    if (readings.pixels[i] == 0)
      owners.pixels[i] = no_reading;
  for (const std::size_t n : order)
  {
    if (isAmong (instances[n], roles.ignored))
      drawInstance (instances[n], ignored, owners);
    else if (!isAmong (instances[n], roles.statics) &&
             (roles.objects.empty () || isAmong (instances[n], roles.objects)))
      drawInstance (instances[n], static_cast<std::uint32_t> (n + 1), owners);
  }

  std::vector<std::size_t> pixels (no_reading + 1, 0);
  for (const std::uint32_t owner : owners.pixels)
    ++pixels[owner];
  std::stable_sort (order.begin (), order.end (),
                    [&] (std::size_t a, std::size_t b) { return (pixels[a + 1] > pixels[b + 1]); });

  InstanceLabels result;
  std::vector<std::uint16_t> label_of (no_reading + 1, 0);
  label_of[ignored] = ignored_label;
  for (const std::size_t n : order)
    if (pixels[n + 1] > 0 && result.instances.size () + 1 < ignored_label)
    {
      result.instances.push_back (n);
      label_of[n + 1] = static_cast<std::uint16_t> (result.instances.size ());
    }
  result.labels = Image<std::uint16_t> (width, height, 0);
  std::transform (owners.pixels.begin (), owners.pixels.end (), result.labels.pixels.begin (),
                  [&] (std::uint32_t owner) { return (label_of[owner]); });
  return (result);
}

} // namespace pcl::cosection
