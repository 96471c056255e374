// Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause

// The report in a browser: it draws, complains of nothing, asks nobody for anything, and lets nobody else's script run.

#ifdef PCL_COSECTION_CHROMIUM

#include "browser.h"
#include "report_scene.h"

#include "pcl_cosection/io/image_io.h"

#include <nlohmann/json.hpp>

#include <regex>

using namespace pcl::cosection;
using namespace pcl::cosection::test;

namespace {

class ReportBrowser : public ReportScene
{
protected:
  /** \brief Open a page. \return the document after its scripts have run */
  std::string open (const std::string& name, const Words& more = {"--dump-dom"})
  {
    const BrowsedPage page = browse (file (""), name, more);
    console_ = page.console;
    return (page.document);
  }

  /** \brief What the page asked for, as the browser has noted it; its own requests are not those of a page. */
  Words requests () const
  {
    Words urls;
    const nlohmann::json log = json ("net.json");
    for (const nlohmann::json& event : log["events"])
      if (event.contains ("params") && event["params"].contains ("initiator") &&
          event["params"]["initiator"] != "not an origin")
        urls.push_back (event["params"].value ("url", "?"));
    return (urls);
  }

  /** \brief How many pixels the interactive view has drawn; -1: it has not. */
  static long drawnPixels (const std::string& document)
  {
    std::smatch match;
    return (std::regex_search (document, match, std::regex ("data-pixels=\"([0-9]+)\"")) ? std::stol (match[1]) : -1);
  }

  /** \brief Distinct strong colours in the middle of a picture of the page: of the objects by their numbers. */
  Picture screenshot (const std::string& name)
  {
    open (name, {"--window-size=1000,900", "--screenshot=" + file ("page.png")});
    return (loadColourImage (file ("page.png")));
  }

  std::string console_;
};

/** \brief How many pixels are nearly of a colour. */
std::size_t
pixelsOf (const Picture& picture, bool (*is_it) (const std::array<std::uint8_t, 3>&))
{
  return (static_cast<std::size_t> (std::count_if (picture.pixels.begin (), picture.pixels.end (), is_it)));
}

} // namespace

TEST_F (ReportBrowser, ThePageIsWholeAndDraws)
{
  page ({"--truth", "sim", "out"});
  const std::string document = open ("report.html");
  EXPECT_EQ (console_, "");
  EXPECT_GT (drawnPixels (document), 5000);
  EXPECT_NE (document.find ("<canvas"), std::string::npos);
  EXPECT_EQ (withoutScripts (document).find ("needs a browser with scripts and"), std::string::npos); // it made room
  for (const char* section :
       {"pictures", "scene", "objects", "accuracy", "comparison", "trajectories", "times", "warnings", "parameters"})
    EXPECT_NE (document.find ("<section id=\"" + std::string (section) + "\">"), std::string::npos) << section;
  EXPECT_NE (cell (document, "accuracy", "ball", "Accuracy (mm)"), "none");
  EXPECT_NE (document.find ("<option value=\"error\">"), std::string::npos);
}

TEST_F (ReportBrowser, NothingIsAskedOfAnybody)
{
  page ({"out"});
  open ("report.html");
  EXPECT_EQ (requests (), Words ());
  // Such a request is noted, and so would be one of the report.
  writeFile (file ("other.html"), "<!DOCTYPE html><img src=\"http://elsewhere.test/x.png\">");
  open ("other.html");
  ASSERT_FALSE (requests ().empty ());
  EXPECT_EQ (requests ()[0], "http://elsewhere.test/x.png");
  // Nor does the page allow any: not even to what somebody writes into it.
  std::string html = readFile (file ("report.html"));
  html.insert (html.find ("<noscript>"),
               "<img src=\"http://elsewhere.test/x.png\"><script>document.title = 'changed'</script>"
               "<link rel=\"stylesheet\" href=\"http://elsewhere.test/x.css\"><p onclick=\"1\" style=\"color: red\">");
  writeFile (file ("changed.html"), html);
  const std::string document = open ("changed.html");
  EXPECT_EQ (requests (), Words ());
  EXPECT_EQ (document.find ("<title>changed</title>"), std::string::npos);
  EXPECT_NE (console_.find ("Content Security Policy"), std::string::npos);
  EXPECT_GT (drawnPixels (document), 5000); // what is its own runs
}

TEST_F (ReportBrowser, ColoursAreThoseAskedFor)
{
  std::string html = page ({"out"});
  // The view alone, where a picture of the page shows it.
  const std::string rule = ".panels.scene {";
  const std::size_t policy = html.find ("<meta http-equiv=\"Content-Security-Policy\"");
  html.erase (policy, html.find ('>', policy) - policy + 1);
  html.insert (html.find (rule), "#pictures { display: none }\n");
  writeFile (file ("view.html"), html);
  const auto isRed = [] (const std::array<std::uint8_t, 3>& c) {
    return (c[0] > 90 && c[0] > 2 * c[1] && c[0] > 2 * c[2]);
  };
  const auto isOrange = [] (const std::array<std::uint8_t, 3>& c) {
    return (c[0] > 110 && c[1] > c[2] * 3 / 2 && c[0] > c[1] * 5 / 4 && c[2] < 120);
  };
  const std::size_t real_red = pixelsOf (screenshot ("view.html#colour=colours"), isRed);
  EXPECT_GT (real_red, 500u); // the ball
  const Picture provenance = screenshot ("view.html#colour=provenance");
  EXPECT_LT (pixelsOf (provenance, isRed), real_red / 2);
  EXPECT_GT (pixelsOf (provenance, isOrange), 50u);
}

/** \brief A script, in a copy that allows it, does what a reader does, and notes what becomes of it. */
TEST_F (ReportBrowser, ControlsWork)
{
  std::string html = page ({"--truth", "sim", "out"});
  const std::size_t policy = html.find ("<meta http-equiv=\"Content-Security-Policy\"");
  html.erase (policy, html.find ('>', policy) - policy + 1);
  html.insert (
      html.find ("<title>"),
      "<script>window.requestAnimationFrame = (draw) => setTimeout (draw, 0);</script>"); // no display, no frames
  html.insert (html.find ("</body>"), R"(<script>(async function () {
    const notes = {}, view = document.getElementById ("view"), canvas = view.querySelector ("canvas");
    const wait = (ms) => new Promise ((done) => setTimeout (done, ms));
    const find = (selector, words) =>
      Array.from (view.querySelectorAll (selector)).find ((e) => e.textContent.includes (words));
    const change = async (element, event) => { element.dispatchEvent (new Event (event)); await wait (100); };
    function picture () {
      const copy = document.createElement ("canvas");
      copy.width = canvas.width; copy.height = canvas.height;
      const context = copy.getContext ("2d");
      context.drawImage (canvas, 0, 0);
      return context.getImageData (0, 0, copy.width, copy.height).data;
    }
    const covered = () => picture ().filter ((value, n) => n % 4 === 3 && value > 0).length;
    const sum = () => picture ().reduce ((total, value, n) => (total * 31 + value) % 1000003, 0);
    const slider = view.querySelector ("input[type=range]"), clock = view.querySelector ("output");
    await wait (300);
    notes.middle = clock.textContent;
    slider.value = 0; await change (slider, "input");
    notes.first = clock.textContent;
    const first = sum ();
    slider.value = 11; await change (slider, "input");
    notes.last = clock.textContent;
    notes.moved = sum () !== first;
    const all = covered (), box = find ("label", "background").querySelector ("input");
    box.checked = false; await change (box, "change");
    notes.hidden = covered () < all / 2 && covered () > 0;
    box.checked = true; await change (box, "change");
    notes.shown = covered () === all;
    const colour = find ("label", "Colour").querySelector ("select");
    const show = find ("label", "Show").querySelector ("select");
    let before = sum ();
    notes.colours = [];
    for (const option of colour.options) {
      colour.value = option.value; await change (colour, "change");
      const entries = view.querySelectorAll (".legend li").length;
      notes.colours.push (option.value + " " + entries + (sum () !== before ? " new" : ""));
      before = sum ();
    }
    show.value = "seen"; await change (show, "change");
    notes.seen = sum () !== before;
    before = sum ();
    const through = find ("label", "through").querySelector ("input");
    through.checked = true; await change (through, "change");
    notes.through = sum () !== before;
    find ("button", "Reset").click (); await wait (100);
    notes.reset = sum () === before && !through.checked;
    const at = (x, y) => ({clientX: x, clientY: y, button: 0, bubbles: true, cancelable: true});
    canvas.dispatchEvent (new MouseEvent ("mousedown", at (300, 300)));
    document.dispatchEvent (new MouseEvent ("mousemove", at (380, 320)));
    document.dispatchEvent (new MouseEvent ("mouseup", at (380, 320)));
    await wait (100);
    notes.turned = sum () !== before;
    before = sum ();
    canvas.dispatchEvent (new WheelEvent ("wheel", {deltaY: -300, cancelable: true})); await wait (100);
    notes.nearer = sum () !== before;
    canvas.blur (); await wait (50);
    before = sum ();
    canvas.dispatchEvent (new WheelEvent ("wheel", {deltaY: -300, cancelable: true})); await wait (100);
    notes.page_scrolls = sum () === before;
    const from = slider.value;
    find ("button", "Play").click (); await wait (400);
    notes.plays = slider.value !== from && find ("button", "Pause") !== undefined;
    find ("button", "Pause").click ();
    document.title = JSON.stringify (notes);
  }) ().catch ((error) => { document.title = String (error); });</script>)");
  writeFile (file ("script.html"), html);
  const std::string document = open ("script.html", {"--virtual-time-budget=60000", "--dump-dom"});
  EXPECT_EQ (console_, "");
  std::smatch title;
  ASSERT_TRUE (std::regex_search (document, title, std::regex ("<title>(\\{.*\\})</title>")))
      << document.substr (document.find ("<title>"), 300);
  const nlohmann::json notes = nlohmann::json::parse (title[1].str ());
  EXPECT_EQ (notes["middle"], "frame 6");
  EXPECT_EQ (notes["first"], "frame 0");
  EXPECT_EQ (notes["last"], "frame 11");
  EXPECT_EQ (notes["colours"],
             nlohmann::json ({"colours 0", "provenance 4 new", "confidence 1 new", "instance 0 new", "error 1 new"}));
  for (const char* name :
       {"moved", "hidden", "shown", "seen", "through", "reset", "turned", "nearer", "page_scrolls", "plays"})
    EXPECT_EQ (notes[name], true) << name;
}

TEST_F (ReportBrowser, WithoutWebGlThereIsASentence)
{
  page ({"out"});
  const std::string document = open ("report.html", {"--disable-3d-apis", "--disable-gpu", "--dump-dom"});
  EXPECT_LT (drawnPixels (document), 1);
  EXPECT_NE (withoutScripts (document).find ("needs a browser with scripts and WebGL"), std::string::npos);
  EXPECT_NE (cell (document, "objects", "object 1", "Volume (ml)"), "none");
}

TEST_F (ReportBrowser, HostileTextsDoNothing)
{
  nlohmann::json summary = json ("out/summary.json");
  summary["warnings"] = {"<script>document.title = 'changed'</script>",
                         "<img src=x onerror=\"document.title='changed'\">"};
  summary["parameters"]["dataset"] = "</title><script>document.title = 'changed'</script>";
  writeFile (file ("out/summary.json"), summary.dump ());
  page ({"out"});
  const std::string document = open ("report.html");
  EXPECT_EQ (console_, "");
  EXPECT_EQ (document.find ("<title>changed</title>"), std::string::npos);
  EXPECT_GT (drawnPixels (document), 5000);
}

TEST_F (ReportBrowser, IncompleteRunsDrawToo)
{
  for (const auto& entry : {"out/summary.json", "out/trajectory/camera.txt", "out/trajectory/object_1.txt",
                            "out/mesh/background.ply", "out/mesh/object_2.ply"})
    std::filesystem::remove (file (entry));
  page ({"out"});
  const std::string document = open ("report.html");
  EXPECT_EQ (console_, "");
  EXPECT_GT (drawnPixels (document), 500);
}

#endif // PCL_COSECTION_CHROMIUM
