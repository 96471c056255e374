// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "label_field.h"

#include "cloud_columns.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/common/image.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace pcl::cosection {
namespace {

constexpr std::size_t most_labels = 256; // that are looked for in fields of other names

/** \brief How many different whole numbers a field holds, at most most_labels + 1; 0 if there are other numbers. NaN is
 * none. */
std::size_t
wholeNumbers (const std::string& path, const CloudHeader& header, const PCLPointCloud2& cloud, const CloudField& field)
{
  if (field.isPadding () || field.count != 1)
    return 0;
  const CloudColumn column (path, cloud, field);
  std::set<double> values;
  for (std::size_t i = 0; i < header.points; ++i)
    if (const double value = column.number (i); std::isnan (value))
      continue;
    else if (value != std::trunc (value))
      return 0;
    else if (values.size () <= most_labels)
      values.insert (value);
  return values.size ();
}

/** \brief The field with the labels: the one that is wanted, or label, or one of the names that other programs give it;
 * nullptr if there is none. \throws IoError if the wanted one is missing */
const CloudField*
labelField (const std::string& path, const CloudHeader& header, const PCLPointCloud2& cloud, const std::string& wanted)
{
  const CloudField* named = header.find (wanted.empty () ? "label" : wanted);
  if (named)
    return named;
  if (!wanted.empty ())
  {
    std::string names;
    for (const CloudField& field : header.fields)
      names += " " + printable (field.name);
    throw IoError (path + ": has no field " + printable (wanted) + "; its fields are" + names);
  }
  const CloudField* alike = header.findAlike ({"label", "labels", "class", "classification"});
  return alike && wholeNumbers (path, header, cloud, *alike) > 0 ? alike : nullptr;
}

/** \brief Names of fields that hold a few whole numbers, as labels do, with a space before each. */
std::string
fieldsLikeLabels (const std::string& path, const CloudHeader& header, const PCLPointCloud2& cloud)
{
  const std::set<std::string> others = {"x",         "y",    "z",     "normal_x",  "normal_y", "normal_z",
                                        "curvature", "rgb",  "rgba",  "intensity", "ring",     "red",
                                        "green",     "blue", "alpha", "r",         "g",        "b"};
  std::string names;
  for (const CloudField& field : header.fields)
    if (others.count (field.name) == 0)
      if (const std::size_t count = wholeNumbers (path, header, cloud, field); count > 1 && count <= most_labels)
        names += " " + printable (field.name);
  return names;
}

/** \brief The whole number of each point; negative if it is NaN. */
std::vector<std::int64_t>
numbersOf (const std::string& path, const PCLPointCloud2& cloud, const CloudField& field, std::size_t points)
{
  if (field.count != 1)
    throw IoError (path + ": field " + printable (field.name) + " must be one integer (COUNT 1)");
  const CloudColumn column (path, cloud, field);
  std::vector<std::int64_t> numbers (points);
  for (std::size_t i = 0; i < points; ++i)
  {
    if (field.type != 'F')
    {
      numbers[i] = column.integer (i);
      continue;
    }
    const double label = column.real (i); // as some programs write all fields
    if (std::isfinite (label) && label != std::trunc (label))
    {
      std::ostringstream message;
      message << path << ": point " << i << " has label " << label << ", which is not an integer";
      throw IoError (message.str ());
    }
    constexpr double large = 1e15;
    numbers[i] = std::isnan (label) ? -1 : static_cast<std::int64_t> (std::clamp (label, -large, large));
  }
  return numbers;
}

bool
contains (const std::vector<std::uint32_t>& labels, std::int64_t label)
{
  return std::any_of (labels.begin (), labels.end (), [label] (std::uint32_t l) { return l == label; });
}

} // namespace

void
readLabels (const std::string& path, const CloudHeader& header, const PCLPointCloud2& points,
            const PcdViewOptions& options, SensorCloud& cloud)
{
  if (!options.labels.empty ())
  {
    if (options.labels.size () != cloud.labels.size ())
      throw InvalidArgument (path + ": there must be one label per point");
    cloud.labels = options.labels;
    cloud.has_labels = true;
    return;
  }
  const CloudField* field = labelField (path, header, points, options.label_field);
  if (field == nullptr)
  {
    if (const std::string names = fieldsLikeLabels (path, header, points); !names.empty ())
      cloud.warnings.push_back (path + ": has no field label; if labels are in" + names + ", give --label-field NAME");
    if (!options.background_labels.empty () || !options.ignored_labels.empty ())
      cloud.warnings.push_back (path + ": has no field label, so no label is background or ignored");
    return;
  }
  cloud.has_labels = true;
  if (options.label_field.empty () && field->name != "label")
    cloud.warnings.push_back (path + ": has no field label; " + printable (field->name) + " is taken for it");
  const auto namesakes = std::count_if (header.fields.begin (), header.fields.end (),
                                        [&] (const CloudField& other) { return other.name == field->name; });
  if (namesakes > 1)
    cloud.warnings.push_back (path + ": has " + std::to_string (namesakes) + " fields " + printable (field->name) +
                              "; the first is used");
  const std::vector<std::uint32_t> background = options.background_labels.empty () ? std::vector<std::uint32_t>{0}
                                                                                   : options.background_labels;
  const bool zero_is_object = !contains (background, 0);
  bool has_background = false;
  bool has_object_zero = false;
  bool has_none = false;
  const std::vector<std::int64_t> numbers = numbersOf (path, points, *field, cloud.labels.size ());
  for (std::size_t i = 0; i < cloud.labels.size (); ++i)
  {
    const std::int64_t label = numbers[i];
    if (label > std::numeric_limits<std::int32_t>::max () && !contains (background, label) &&
        !contains (options.ignored_labels, label))
      throw IoError (path + ": label " + std::to_string (label) + " is too large, the largest is 2147483647");
    if (contains (background, label))
    {
      cloud.labels[i] = 0;
      has_background = true;
    }
    else if (label >= 0 && label != ignored_label && !contains (options.ignored_labels, label))
    {
      cloud.labels[i] = label == 0 && zero_is_object ? background[0] : static_cast<std::uint32_t> (label);
      has_object_zero = has_object_zero || (label == 0 && zero_is_object);
    }
    else if (cloud.positions[i].allFinite ())
    {
      cloud.positions[i].setConstant (nan_value);
      ++cloud.ignored;
      has_none = has_none || label < 0;
    }
  }
  if (has_none && options.background_labels.empty () && options.ignored_labels.empty () &&
      std::count (numbers.begin (), numbers.end (), 0) > 0)
    cloud.warnings.push_back (path +
                              ": label 0 is the background, and points of a negative label or NaN are ignored; if "
                              "labels count the objects from 0 and those mark no object, as clusters do, add 1 to all");
  if (has_object_zero)
    cloud.warnings.push_back (path + ": label 0 is no background; it is object " + std::to_string (background[0]));
  if (!options.background_labels.empty () && !has_background)
    cloud.warnings.push_back (path + ": no point has the label of the background");
}

} // namespace pcl::cosection
