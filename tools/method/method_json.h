// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <pcl/cosection/surface/co_section.h>

#include <string>
#include <vector>

nlohmann::ordered_json solverJson (const pcl::cosection::SolverSummary& solver);

/** \brief A completed object in a summary for programs. \param[in] origin of the frame of its mesh */
nlohmann::ordered_json objectJson (const pcl::cosection::ObjectResult& object,
                                   const Eigen::Vector3d& origin = Eigen::Vector3d::Zero ());

/** \brief "width", "height", "fx", "fy", "cx", "cy". */
nlohmann::ordered_json cameraJson (const pcl::cosection::PinholeCamera& camera);

/** \brief A transformation as four rows. \param[in] origin of the frame to which it leads */
nlohmann::ordered_json transformJson (const Eigen::Affine3d& T,
                                      const Eigen::Vector3d& origin = Eigen::Vector3d::Zero ());

/** \brief Planes n.x + d = 0 as lists of four numbers. \param[in] origin of their frame */
nlohmann::ordered_json planesJson (const std::vector<Eigen::Vector4d>& planes,
                                   const Eigen::Vector3d& origin = Eigen::Vector3d::Zero ());

/** \brief Add the parameters of the method. */
void addMethod (const pcl::cosection::CoSectionOptions& method, nlohmann::ordered_json& parameters);

/** \brief Why objects could not be completed, a line for each reason: "object 3: ..." or "objects 1, 2: ...". */
std::vector<std::string> failureTexts (const std::vector<pcl::cosection::ObjectResult>& objects);

/** \brief Save the summary of a run that failed as a whole, without objects and with the field error. Does nothing if
 * it cannot be written. */
void saveFailure (const std::string& error, const nlohmann::ordered_json& parameters,
                  const std::vector<std::string>& warnings, const std::vector<std::string>& files);
