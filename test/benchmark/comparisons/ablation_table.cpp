// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "ablation_table.h"

#include <cstdio>

namespace {

std::string
cell (double accuracy_m, double completeness_m, double f_score)
{
  char text[64];
  std::snprintf (text, sizeof text, "%.1f / %.1f / %.2f", 1e3 * accuracy_m, 1e3 * completeness_m, f_score);
  return text;
}

} // namespace

std::string
markdown (const std::vector<AblationScene>& scenes)
{
  std::string text;
  for (const AblationScene& scene : scenes)
  {
    text += "### " + scene.name + "\n\n| accuracy / completeness (mm) / F@1cm |";
    for (const std::string& object : scene.objects)
      text += " " + object + " |";
    text += " mean | closed | time |\n|---|";
    for (std::size_t n = 0; n < scene.objects.size () + 3; ++n)
      text += "---|";
    for (const AblationRow& row : scene.rows)
    {
      text += "\n| " + row.method + " |";
      double accuracy = 0.0, completeness = 0.0, f_score = 0.0;
      std::size_t meshes = 0, closed = 0;
      for (const AblationResult& result : row.results)
      {
        if (!result.comparison)
        {
          text += " - |";
          continue;
        }
        text += " " +
                cell (result.comparison->accuracy.mean, result.comparison->completeness.mean,
                      result.comparison->f_score) +
                " |";
        accuracy += result.comparison->accuracy.mean;
        completeness += result.comparison->completeness.mean;
        f_score += result.comparison->f_score;
        ++meshes;
        closed += result.closed;
      }
      const double n = static_cast<double> (meshes);
      char end[64];
      std::snprintf (end, sizeof end, " | %zu of %zu | %.1f s |", closed, row.results.size (), row.seconds);
      text += " " + (meshes == row.results.size () ? cell (accuracy / n, completeness / n, f_score / n) : "-") + end;
    }
    text += "\n\n";
  }
  return text;
}

std::string
csv (const std::vector<AblationScene>& scenes)
{
  std::string text = "scene,method,object,accuracy_m,completeness_m,f_score,closed\n";
  for (const AblationScene& scene : scenes)
    for (const AblationRow& row : scene.rows)
      for (std::size_t n = 0; n < row.results.size (); ++n)
      {
        const AblationResult& result = row.results[n];
        text += scene.name + ",\"" + row.method + "\"," + scene.objects[n] + ",";
        if (!result.comparison)
        {
          text += ",,,\n";
          continue;
        }
        char values[96];
        std::snprintf (values, sizeof values, "%.6f,%.6f,%.4f,%d\n", result.comparison->accuracy.mean,
                       result.comparison->completeness.mean, result.comparison->f_score, result.closed ? 1 : 0);
        text += values;
      }
  return text;
}
