// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
#include "report_page.h"

#include "embedded_page.h"
#include "embedding.h"
#include "report_data.h"

#include <pcl/cosection/version.h>

using namespace pcl::cosection;

namespace {

/** \brief SHA-256 in the letters of a Content-Security-Policy. */
std::string
policySource (const EmbeddedFile& file)
{
  std::string bytes;
  for (std::size_t n = 0; n + 1 < file.sha256.size (); n += 2)
    bytes += static_cast<char> (std::stoi (std::string (file.sha256.substr (n, 2)), nullptr, 16));
  return (" 'sha256-" + toBase64 (bytes.data (), bytes.size ()) + '\'');
}

} // namespace

std::string
reportPage (const ReportContent& content, const ProgressCallback& progress)
{
  const EmbeddedFile scripts[] = {three_library, orbit_controls, report_drawing, report_script, report_scene_view};
  std::string script_sources, script_elements;
  for (const EmbeddedFile& script : scripts)
  {
    script_sources += policySource (script);
    script_elements += "<script>" + std::string (script.text) + "</script>\n";
  }
  // Nothing is loaded, and nothing runs but the scripts of the report.
  const std::string policy = "default-src 'none'; img-src data:; style-src" + policySource (report_style) +
                             "; script-src" + script_sources + "; base-uri 'none'; form-action 'none'";
  return ("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta "
          "http-equiv=\"Content-Security-Policy\" content=\"" +
          policy +
          "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" "
          "content=\"light dark\">\n<meta name=\"generator\" content=\"pcl_cosection_report " PCL_COSECTION_VERSION
          "\">\n<title>pcl_cosection report</title>\n<style>" +
          std::string (report_style.text) +
          "</style></head>\n<body><noscript>This report needs a browser with scripts.</noscript>\n<script "
          "type=\"application/json\" id=\"report-data\">" +
          asScriptText (reportData (content, progress)) + "</script>\n" + script_elements + "</body></html>\n");
}
