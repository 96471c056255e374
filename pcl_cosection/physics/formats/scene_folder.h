// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/cosection/common/triangle_mesh.h>
#include <pcl/cosection/volume/signed_distance_field.h>

#include <string>
#include <utility>
#include <vector>

namespace pcl::cosection {

/** \brief Writes files into a folder, and removes them again unless all were written. */
class SceneFolder
{
public:
  /** \brief \a folder must exist. */
  explicit SceneFolder (std::string folder) : folder_ (std::move (folder)) {}
  SceneFolder (const SceneFolder&) = delete;
  SceneFolder& operator= (const SceneFolder&) = delete;
  ~SceneFolder ();

  /** \brief Write a file; its folder within this one is made if needed. \throws IoError */
  void write (const std::string& name, const std::string& bytes);

  /** \brief Write a mesh, by the extension of its name. \throws IoError */
  void write (const std::string& name, const TriangleMesh& mesh);

  /** \brief Write a signed distance, as VTK image data. \throws IoError */
  void write (const std::string& name, const SignedDistanceField& field);

  /** \brief Whether a file is there, from now or before. */
  bool has (const std::string& name) const;

  /** \brief Keep the files. \return their paths, in the order in which they were written */
  std::vector<std::string> finish ();

private:
  /** \brief The path of a file to be written. */
  std::string pathOf (const std::string& name);

  std::string folder_;
  std::vector<std::string> paths_;
  std::vector<std::string> made_folders_;
};

} // namespace pcl::cosection
