// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/simulation/simulated_scene.h>

#include <Eigen/Geometry>

#include <nlohmann/json.hpp>

#include <initializer_list>
#include <set>
#include <string>
#include <vector>

namespace pcl::cosection {

/** \brief A value of a description and where it is, for messages. Every field that is asked for is known from then on;
 * others are refused by finish (). All functions throw InvalidArgument, with the path of the field. */
class SpecNode
{
public:
  SpecNode (const nlohmann::ordered_json& value, std::string path) : value_ (value), path_ (std::move (path)) {}

  [[noreturn]] void refuse (const std::string& why) const;

  /** \brief Must be called on an object, before its fields are asked for. */
  void requireObject () const;

  bool has (const std::string& field);

  /** \brief A field that must be there. */
  SpecNode field (const std::string& field);

  std::vector<SpecNode> elements (std::size_t least = 0) const;

  double number () const;

  double number (const std::string& field, double otherwise);

  int whole (int least, int most) const;

  int whole (const std::string& field, int otherwise, int least, int most);

  bool flag (const std::string& field, bool otherwise);

  std::string text () const;

  /** \brief One of \a words. */
  std::string word (std::initializer_list<const char*> words) const;

  template <int N> Eigen::Matrix<double, N, 1> vector () const
  {
    const std::vector<SpecNode> numbers = elements ();
    if (numbers.size () != N)
      refuse ("must be " + std::to_string (N) + " numbers");
    Eigen::Matrix<double, N, 1> result;
    for (int n = 0; n < N; ++n)
      result[n] = numbers[n].number ();
    return result;
  }

  bool isFalse () const { return value_.is_boolean () && !value_.get<bool> (); }

  bool isTrue () const { return value_.is_boolean () && value_.get<bool> (); }

  /** \brief Refuse fields that were not read. */
  void finish () const;

  const std::string& path () const { return path_; }

private:
  const nlohmann::ordered_json& value_;
  std::string path_;
  std::set<std::string> known_;
};

} // namespace pcl::cosection
