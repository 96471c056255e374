// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "report_page.h"

#include "embedded_page.h"
#include "html_writer.h"
#include "object_pictures.h"
#include "report_accuracy.h"
#include "report_header.h"
#include "report_plots.h"
#include "report_tables.h"
#include "scene_data.h"
#include "scene_panels.h"
#include "text_table.h"

#include <pcl/cosection/common/error.h>
#include <pcl/cosection/version.h>

using namespace pcl::cosection;

namespace
{

/** \brief A part of the page, from its making to its end (). */
class Section
{
public:
  Section (HtmlWriter& html, const std::string& id, const std::string& title) : html_ (html)
  {
    html_.open ("section", {{"id", id}}).element ("h2", title);
  }
  Section (const Section&) = delete;
  Section& operator= (const Section&) = delete;

  void end () { html_.close ("section"); }

private:
  HtmlWriter& html_;
};

void
tell (const ProgressCallback& progress, const std::string& stage, double fraction)
{
  if (progress && !progress (stage, fraction))
    throw Cancelled ("the report was cancelled");
}

void
writePicture (HtmlWriter& html, const CaptionedPicture& picture)
{
  html.open ("figure")
      .single ("img", {{"src", picture.uri},
                       {"alt", picture.alternative},
                       {"width", std::to_string (picture.width)},
                       {"height", std::to_string (picture.height)}})
      .element ("figcaption", picture.caption)
      .close ("figure");
}

/** \brief What the colours of provenance and of errors mean. */
void
writePictureKeys (HtmlWriter& html, const ReportContent& content)
{
  html.open ("ul", {{"class", "legend"}});
  const char* const names[] = {"observed", "inferred by smoothness", "bounded by free space",
                               "bounded by another body"};
  for (int n = 0; n < 4; ++n)
    html.open ("li").markup ("<i class=\"key p" + std::to_string (n) + "\"></i>").text (names[n]).close ("li");
  if (content.truth)
    html.open ("li")
        .markup ("<i class=\"scale\"></i>")
        .text ("error, 0 to " + toShortText (1000.0 * content.scene.error_max_m) + " mm and more")
        .close ("li");
  html.close ("ul");
}

void
writePictures (HtmlWriter& html, const ReportContent& content, const ProgressCallback& progress)
{
  const std::vector<RunObject>& objects = content.run.objects;
  const Eigen::Vector3d up = upOf (content);
  Section section (html, "pictures", "Before and after");
  html.element ("p",
                "Left what was seen, the zero level of the truncated distances averaged over all frames; then what was "
                "completed. Above from the side of the camera, below from behind.");
  writePictureKeys (html, content);
  html.open ("div", {{"class", "panels scene"}});
  for (const CaptionedPicture& picture : drawScenePanels (content))
    writePicture (html, picture);
  html.close ("div");
  for (std::size_t n = 0; n < objects.size (); ++n)
  {
    tell (progress, "drawing objects", 0.1 + 0.4 * static_cast<double> (n) / static_cast<double> (objects.size ()));
    const RunObject& object = objects[n];
    if (object.completed.empty () && object.seen.empty ())
      continue;
    const auto errors = content.scene.errors.find (object.id);
    const std::string name = nameOf (object, content);
    html.open ("article")
        .open ("h3")
        .markup ("<i class=\"key " + styleOf (object.id) + "\"></i>")
        .text (name)
        .close ("h3")
        .open ("div", {{"class", "panels"}});
    for (const CaptionedPicture& picture :
         drawObject (object, directionsOf (object, content.run, up),
                     errors == content.scene.errors.end () ? std::vector<double> () : errors->second.completed,
                     content.scene.error_max_m, name))
      writePicture (html, picture);
    html.close ("div").close ("article");
  }
  section.end ();
}

/** \brief The view that page/report.js brings to life; until then, and where that cannot be, a sentence. */
void
writeInteractiveView (HtmlWriter& html, const ReportContent& content)
{
  Section section (html, "scene", "The scene to turn");
  html.open ("div", {{"id", "view"}, {"class", "view"}})
      .element (
          "p",
          "The interactive view needs a browser with scripts and WebGL. All else in this report can be read without.",
          {{"id", "no-view"}, {"class", "no-view"}})
      .close ("div");
  html.element (
      "p",
      "Drag to turn, drag with the right button or two fingers to move, pinch to come nearer; the wheel does so once "
      "the view has been clicked.",
      {{"class", "note screen-only"}});
  html.open ("script", {{"type", "application/json"}, {"id", "scene-data"}})
      .markup (asScriptText (sceneData (content)))
      .close ("script");
  section.end ();
}

void
writeWarnings (HtmlWriter& html, const ReportContent& content)
{
  std::vector<std::string> warnings = content.warnings;
  const std::vector<std::string> of_run = textsIn (content.run.summary, "warnings");
  warnings.insert (warnings.end (), of_run.begin (), of_run.end ());
  const std::vector<std::string> events = textsIn (content.run.summary, "events");
  Section section (html, "warnings", "Warnings and events");
  if (warnings.empty ())
    html.element ("p", "No warnings.");
  else
  {
    html.open ("ul", {{"class", "warnings"}});
    for (const std::string& warning : warnings)
      html.element ("li", warning);
    html.close ("ul");
  }
  writeCollapsedList (html, counted (events.size (), "event") + " of tracking", events);
  section.end ();
}

/** \brief SHA-256 in the letters of a Content-Security-Policy. */
std::string
policySource (const EmbeddedFile& file)
{
  std::string bytes;
  for (std::size_t n = 0; n + 1 < file.sha256.size (); n += 2)
    bytes += static_cast<char> (std::stoi (std::string (file.sha256.substr (n, 2)), nullptr, 16));
  return (" 'sha256-" + toBase64 (bytes.data (), bytes.size ()) + '\'');
}

/** \brief Nothing is loaded, nothing runs but the scripts of the report. */
std::string
contentPolicy ()
{
  return ("default-src 'none'; img-src data:; style-src" + policySource (report_style) + "; script-src" +
          policySource (three_library) + policySource (orbit_controls) + policySource (report_script) +
          "; base-uri 'none'; form-action 'none'");
}

void
writeHead (HtmlWriter& html, const std::string& title)
{
  html.open ("head")
      .single ("meta", {{"charset", "utf-8"}})
      .single ("meta", {{"http-equiv", "Content-Security-Policy"}, {"content", contentPolicy ()}});
  html.single ("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}})
      .single ("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.single ("meta", {{"name", "generator"}, {"content", "pcl_cosection_report " PCL_COSECTION_VERSION}});
  html.element ("title", title).open ("style").markup (report_style.text).close ("style").close ("head");
}

void
writeFooter (HtmlWriter& html)
{
  html.open ("footer").element ("p", "Written by pcl_cosection_report " PCL_COSECTION_VERSION
                                     ". This file loads nothing from anywhere.");
  if (!three_library.text.empty ())
    html.open ("details")
        .element ("summary", "Licence of three.js, which draws the scene")
        .open ("pre")
        .text (std::string (three_notice.text))
        .close ("pre")
        .close ("details");
  html.close ("footer");
  for (const EmbeddedFile& script : {three_library, orbit_controls, report_script})
    html.open ("script").markup (script.text).close ("script");
}

} // namespace

std::string
reportPage (const ReportContent& content, const ProgressCallback& progress)
{
  HtmlWriter html;
  html.markup ("<!DOCTYPE html>\n").open ("html", {{"lang", "en"}});
  writeHead (html, titleOf (content) + " \xE2\x80\x93 pcl_cosection report");
  html.open ("body");
  writeHeader (html, content);
  html.open ("main");
  const bool has_meshes = !content.run.background.empty () || !content.run.objects.empty ();
  tell (progress, "drawing objects", 0.0);
  if (!content.run.objects.empty ())
    writePictures (html, content, progress);
  tell (progress, "embedding meshes", 0.5);
  if (has_meshes && !three_library.text.empty ())
    writeInteractiveView (html, content);
  tell (progress, "writing tables", 0.95);
  const auto section = [&] (const char* id, const char* title, auto&& write) {
    HtmlWriter part;
    if (write (part))
    {
      Section whole (html, id, title);
      html.markup (part.html ());
      whole.end ();
    }
  };
  if (!content.run.objects.empty ())
    section ("objects", "Objects", [&] (HtmlWriter& part) { return (writeObjectTable (part, content), true); });
  if (content.truth)
    section ("accuracy", "Accuracy", [&] (HtmlWriter& part) { return (writeAccuracy (part, content), true); });
  section ("comparison", "Comparison", [&] (HtmlWriter& part) { return (writeComparison (part, content)); });
  section ("trajectories", "Trajectories", [&] (HtmlWriter& part) { return (writeTrajectories (part, content)); });
  section ("times", "Times", [&] (HtmlWriter& part) { return (writeTimings (part, content)); });
  writeWarnings (html, content);
  section ("parameters", "What was run", [&] (HtmlWriter& part) { return (writeParameters (part, content), true); });
  html.close ("main");
  writeFooter (html);
  html.close ("body").close ("html");
  return (html.html ());
}
