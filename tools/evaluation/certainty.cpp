// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "certainty.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

using namespace pcl::cosection;

namespace {

constexpr std::size_t calibration_classes = 8; // of the calibration curve

/** \brief Names of provenances as the summaries of runs have them. */
std::vector<std::pair<std::string, Provenance>>
provenanceNames ()
{
  return {{"observed", Provenance::Observed},
          {"inferred", Provenance::Inferred},
          {"hull", Provenance::Hull},
          {"intersection", Provenance::Intersection}};
}

} // namespace

void
printCertainty (const std::vector<VertexError>& errors, const std::vector<double>& in_outer, Terminal& terminal)
{
  if (!errors.empty ())
  {
    TextTable table ({"expected errors", "vertices", "sigma", "error", "95 %", "<= sigma", "<= 2 sigma", "(mm)"});
    const auto add = [&] (const std::string& name, const ErrorCoverage& coverage) {
      if (coverage.vertices > 0)
        table.add ({name, std::to_string (coverage.vertices), inMillimetres (coverage.mean_sigma_m),
                    inMillimetres (coverage.mean_error_m), inMillimetres (coverage.p95_error_m),
                    toText (coverage.within_sigma), toText (coverage.within_two_sigma)});
    };
    for (const auto& [name, provenance] : provenanceNames ())
      add (name, errorCoverage (errors, provenance));
    add ("all", errorCoverage (errors));
    std::size_t number = 0;
    for (const ErrorCoverage& coverage : calibrationCurve (errors, calibration_classes))
      add ("class " + std::to_string (++number), coverage);
    terminal.result ("");
    table.print (terminal);
    terminal.result ("rank correlation of error and sigma: " + toText (rankCorrelation (errors)));
  }
  if (!in_outer.empty ())
  {
    const double mean = std::accumulate (in_outer.begin (), in_outer.end (), 0.0) /
                        static_cast<double> (in_outer.size ());
    terminal.result (inPercent (mean) + " of the truth is inside the outer bound on average, of the worst object " +
                     inPercent (*std::min_element (in_outer.begin (), in_outer.end ())));
  }
}

Json
coverageJson (const ErrorCoverage& coverage)
{
  return {{"vertices", coverage.vertices},
          {"within_sigma", coverage.within_sigma},
          {"within_two_sigma", coverage.within_two_sigma},
          {"mean_sigma_m", coverage.mean_sigma_m},
          {"mean_error_m", coverage.mean_error_m},
          {"p95_error_m", coverage.p95_error_m}};
}

Json
certaintyJson (const std::vector<VertexError>& errors)
{
  Json json = coverageJson (errorCoverage (errors));
  json["rank_correlation"] = rankCorrelation (errors);
  for (const auto& [name, provenance] : provenanceNames ())
    json["provenance"][name] = coverageJson (errorCoverage (errors, provenance));
  json["curve"] = Json::array ();
  for (const ErrorCoverage& coverage : calibrationCurve (errors, calibration_classes))
    json["curve"].push_back (coverageJson (coverage));
  return (json);
}
