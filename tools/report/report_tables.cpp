// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the pcl_cosection authors
#include "report_tables.h"

#include "scene_directions.h"
#include "svg_chart.h"
#include "text_table.h"

#include <pcl/cosection/evaluation/mesh_comparison.h>

#include <array>
#include <cmath>

using namespace pcl::cosection;

const char* const dash = "\xE2\x80\x93";

namespace
{

constexpr double millimetres = 1000.0;
constexpr std::size_t kinds = 4; ///< of provenance
constexpr std::array<const char*, kinds> kind_keys = {"observed", "inferred", "hull", "intersection"};
constexpr std::array<const char*, kinds> kind_names = {"observed", "inferred", "free space", "other bodies"};
const char* const times = " \xC3\x97 ";

std::string
sizeText (const RunObject& object, const ReportContent& content)
{
  if (object.completed.empty ())
    return (dash);
  const Eigen::Vector3d size = millimetres *
                               standingSize (object.completed, directionsOf (object, content.run, upOf (content)).up);
  return (toText (size.x ()) + times + toText (size.y ()) + times + toText (size.z ()));
}

std::string
solverText (const Json& solver)
{
  const std::optional<double> iterations = numberIn (solver, "iterations");
  if (!iterations)
    return (dash);
  const bool converged = flagIn (solver, "converged").value_or (true);
  return (counted (static_cast<std::size_t> (std::max (0.0, *iterations)), "iteration") +
          (converged ? "" : ", not converged"));
}

std::string
percentOf (double share)
{
  return (std::to_string (std::lround (100.0 * share)) + " %");
}

/** \brief The bar of an object's provenance and its numbers. */
std::string
provenanceMarkup (const RunObject& object)
{
  const std::vector<double> shares = provenanceShares (object);
  if (shares.empty ())
    return (dash);
  HtmlWriter html;
  std::vector<BarPart> parts;
  std::string title, numbers;
  for (std::size_t n = 0; n < kinds; ++n)
  {
    parts.push_back ({"p" + std::to_string (n), shares[n]});
    title += (n == 0 ? "" : ", ") + percentOf (shares[n]) + ' ' + kind_names[n];
    numbers += (n == 0 ? "" : " \xC2\xB7 ") + std::to_string (std::lround (100.0 * shares[n]));
  }
  html.markup (drawBar (parts, title)).element ("span", numbers + " %", {{"class", "shares"}});
  return (html.html ());
}

void
writeFailed (HtmlTable& table, const ReportContent& content)
{
  const Json& failed = member (content.run.summary, "failed");
  if (!failed.is_array ())
    return;
  for (const Json& entry : failed)
    table.row (
        {{"object " + toShortText (numberIn (entry, "id").value_or (0.0))}, {"failed: " + textIn (entry, "error")}});
}

/** \brief A parameter in words. */
std::string
valueText (const Json& value)
{
  if (value.is_null ())
    return (dash);
  if (value.is_string ())
    return (value.get<std::string> ().empty () ? dash : value.get<std::string> ());
  if (value.is_boolean ())
    return (value.get<bool> () ? "yes" : "no");
  if (value.empty ())
    return (dash);
  return (value.dump (-1, ' ', false, Json::error_handler_t::replace));
}

} // namespace

HtmlTable::HtmlTable (HtmlWriter& html, const std::string& caption, std::vector<std::string> header,
                      const std::string& style)
    : html_ (html)
    , header_ (std::move (header))
{
  html_.open ("div", {{"class", "wide"}, {"tabindex", "0"}, {"role", "region"}, {"aria-label", caption}})
      .open ("table", {{"class", style}});
  html_.element ("caption", caption).open ("thead").open ("tr");
  for (const std::string& name : header_)
    html_.element ("th", name, {{"scope", "col"}});
  html_.close ("tr").close ("thead").open ("tbody");
}

void
HtmlTable::row (const std::vector<TableCell>& cells)
{
  html_.open ("tr");
  for (std::size_t n = 0; n < cells.size (); ++n)
  {
    HtmlWriter::Attributes attributes;
    if (n == 0)
      attributes.emplace_back ("scope", "row");
    else
      attributes.emplace_back ("data-label", header_.at (n));
    if (n + 1 == cells.size () && cells.size () < header_.size ())
      attributes.emplace_back ("colspan", std::to_string (header_.size () - n));
    const std::string name = n == 0 ? "th" : "td";
    html_.open (name, attributes).markup (cells[n].before).text (cells[n].text).markup (cells[n].after).close (name);
  }
  html_.close ("tr");
}

void
HtmlTable::end ()
{
  html_.close ("tbody").close ("table").close ("div");
}

ObjectFacts
factsOf (const RunObject& object)
{
  ObjectFacts facts = {dash, dash, dash, dash, dash, std::nullopt};
  std::optional<double> volume_m3 = numberIn (object.summary, "volume_m3");
  facts.is_closed = flagIn (object.summary, "closed");
  if (!object.completed.empty () && !facts.is_closed)
  {
    const MeshSummary mesh = summarizeMesh (object.completed);
    facts.is_closed = mesh.topology.closed_manifold;
    volume_m3 = mesh.volume_m3;
  }
  if (volume_m3)
    facts.volume_ml = inMillilitres (*volume_m3);
  if (facts.is_closed)
    facts.closed = *facts.is_closed ? "yes" : "no";
  if (const std::optional<double> penetration_m = numberIn (object.summary, "penetration_m"))
    facts.penetration_mm = inMillimetres (*penetration_m);
  if (const std::optional<double> frames = numberIn (object.summary, "frames_tracked"))
    facts.frames = toShortText (*frames);
  else if (!object.poses.empty ())
    facts.frames = std::to_string (object.poses.size ());
  facts.solver = solverText (member (object.summary, "solver"));
  return (facts);
}

std::vector<double>
provenanceShares (const RunObject& object)
{
  std::vector<double> shares;
  const Json& given = member (object.summary, "provenance");
  for (const char* key : kind_keys)
    if (const std::optional<double> share = numberIn (given, key))
      shares.push_back (*share);
  if (shares.size () == kinds)
    return (shares);
  if (object.completed.provenance.empty ())
    return {};
  shares.assign (kinds, 0.0);
  for (const std::uint8_t kind : object.completed.provenance)
    if (kind < kinds)
      shares[kind] += 1.0 / static_cast<double> (object.completed.provenance.size ());
  return (shares);
}

void
writeObjectTable (HtmlWriter& html, const ReportContent& content)
{
  HtmlTable table (
      html, "Objects",
      {"Object", "Size (mm)", "Volume (ml)", "Closed", "Provenance", "Inside others (mm)", "Frames tracked", "Solver"});
  for (const RunObject& object : content.run.objects)
  {
    if (object.summary.is_null () && object.completed.empty () && object.seen.empty ())
      continue; // a trajectory alone
    const ObjectFacts facts = factsOf (object);
    const std::string name = nameOf (object, content), number = std::to_string (object.id);
    table.row ({{name, name == "object " + number ? "" : "<small>object " + number + "</small>",
                 "<i class=\"key " + styleOf (object.id) + "\"></i>"},
                {sizeText (object, content)},
                {facts.volume_ml},
                {facts.closed},
                {"", provenanceMarkup (object)},
                {facts.penetration_mm},
                {facts.frames},
                {facts.solver}});
  }
  writeFailed (table, content);
  table.end ();
  html.open ("p", {{"class", "note"}}).text ("Provenance, in this order: ");
  for (std::size_t n = 0; n < kinds; ++n)
    html.markup ("<i class=\"key p" + std::to_string (n) + "\"></i>")
        .text (kind_names[n] + std::string (n + 1 < kinds ? ", " : ". "));
  html.text (
      "Size: length, width and height of the box around the completed mesh as it stands. Inside others: how deep the "
      "object remains inside another body.");
  html.close ("p");
}

void
writeParameters (HtmlWriter& html, const ReportContent& content)
{
  const Json& parameters = member (content.run.summary, "parameters");
  if (!parameters.is_object () || parameters.empty ())
  {
    html.element ("p", "The run left no parameters.");
    return;
  }
  html.open ("details").element ("summary", counted (parameters.size (), "parameter"));
  HtmlTable table (html, "Parameters", {"Parameter", "Value"}, "plain");
  for (const auto& [key, value] : parameters.items ())
    table.row ({{key}, {valueText (value)}});
  table.end ();
  html.close ("details");
}

void
writeCollapsedList (HtmlWriter& html, const std::string& title, const std::vector<std::string>& lines)
{
  if (lines.empty ())
    return;
  html.open ("details").element ("summary", title).open ("ul");
  for (const std::string& line : lines)
    html.element ("li", line);
  html.close ("ul").close ("details");
}
