// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "spec_node.h"

#include <pcl/cosection/common/error.h>

#include <algorithm>
#include <cmath>

namespace pcl::cosection {

void
SpecNode::refuse (const std::string& why) const
{
  const bool is_root = !path_.empty () && path_.back () == ' ';
  throw InvalidArgument (path_ + (is_root ? "" : " ") + why);
}

void
SpecNode::requireObject () const
{
  if (!value_.is_object ())
    refuse ("must be an object { ... }");
}

bool
SpecNode::has (const std::string& field)
{
  known_.insert (field);
  return value_.contains (field);
}

SpecNode
SpecNode::field (const std::string& field)
{
  if (!has (field))
    refuse ("lacks the field \"" + field + "\"");
  const char last = path_.empty () ? ' ' : path_.back ();
  return {value_.at (field), path_ + (last == ' ' ? "" : ".") + field};
}

std::vector<SpecNode>
SpecNode::elements (std::size_t least) const
{
  if (!value_.is_array ())
    refuse ("must be a list [ ... ]");
  if (value_.size () < least)
    refuse ("must have at least " + std::to_string (least) + (least == 1 ? " element" : " elements"));
  std::vector<SpecNode> nodes;
  for (std::size_t n = 0; n < value_.size (); ++n)
    nodes.emplace_back (value_[n], path_ + "[" + std::to_string (n) + "]");
  return nodes;
}

double
SpecNode::number () const
{
  if (!value_.is_number () || !std::isfinite (value_.get<double> ()))
    refuse ("must be a number");
  return value_.get<double> ();
}

double
SpecNode::number (const std::string& name, double otherwise)
{
  return has (name) ? field (name).number () : otherwise;
}

int
SpecNode::whole (int least, int most) const
{
  const double value = number ();
  if (value != std::floor (value) || value < least || value > most)
    refuse ("must be a whole number from " + std::to_string (least) + " to " + std::to_string (most));
  return static_cast<int> (value);
}

int
SpecNode::whole (const std::string& name, int otherwise, int least, int most)
{
  return has (name) ? field (name).whole (least, most) : otherwise;
}

bool
SpecNode::flag (const std::string& name, bool otherwise)
{
  if (!has (name))
    return otherwise;
  const SpecNode node = field (name);
  if (!node.value_.is_boolean ())
    node.refuse ("must be true or false");
  return node.isTrue ();
}

std::string
SpecNode::text () const
{
  if (!value_.is_string ())
    refuse ("must be a text");
  return value_.get<std::string> ();
}

std::string
SpecNode::word (std::initializer_list<const char*> words) const
{
  const std::string given = text ();
  std::string all;
  for (const char* known : words)
  {
    if (given == known)
      return given;
    all += (all.empty () ? "" : ", ") + std::string (known);
  }
  refuse ("is \"" + given + "\"; it must be one of " + all);
}

void
SpecNode::finish () const
{
  for (const auto& [name, value] : value_.items ())
    if (known_.count (name) == 0)
    {
      std::string all;
      for (const std::string& known : known_)
        all += (all.empty () ? "" : ", ") + known;
      refuse ("has the unknown field \"" + name + "\"; its fields are " + all);
    }
}

} // namespace pcl::cosection
