// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

/** \brief The folder that a file is in; "." for a name without one. */
std::filesystem::path folderOf (const std::filesystem::path& path);

/** \brief Whether a name is more than an ending, such as ".ply", and has it. */
bool endsWith (const std::string& name, const std::string& ending);

/** \brief Whether both names stand for the same file, even if it does not exist yet, or links lead to it. */
bool isSameFile (const std::string& first, const std::string& second);

/** \brief Whether \a path is \a folder or lies in it, be it through links. */
bool isWithin (const std::string& path, const std::string& folder);

/** \brief \throws UsageError if one of \a outputs is one of \a inputs, or two of them are the same; empty names are
 * none. */
void refuseToOverwrite (const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/** \brief Make a folder, with those above it, unless there is one. \throws pcl::cosection::IoError */
void makeFolder (const std::filesystem::path& folder);

/** \brief Prove by doing it that a file can be made in a folder. \param[in] path what the message names \throws
 * pcl::cosection::IoError */
void requireWritableFolder (const std::string& path, const std::string& folder);

/** \brief Find out, before the work, whether a file can be written. \throws pcl::cosection::IoError */
void requireWritable (const std::string& path);

/** \brief Write text, through a temporary name. \throws pcl::cosection::IoError */
void saveText (const std::string& text, const std::string& path);

/** \brief Write JSON, through a temporary name. \throws pcl::cosection::IoError */
void saveJson (const nlohmann::ordered_json& json, const std::string& path);

/** \brief A row of a CSV file: fields with commas, quotes or line breaks are quoted (RFC 4180). */
std::string csvRow (const std::vector<std::string>& fields);
