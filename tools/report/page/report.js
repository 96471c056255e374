// Writes a report into its page, from the data that is embedded there; reportData () of report_data.cpp says what they are.
"use strict";

(function () {
  const data = Page.data = JSON.parse(document.getElementById("report-data").textContent);
  const make = Page.make;
  const dash = "\u2013", times = " \u00d7 ", dot = " \u00b7 ";
  const provenanceNames = ["observed", "inferred", "free space", "other bodies"];
  const longProvenanceNames = ["observed", "inferred by smoothness", "bounded by free space", "bounded by another body"];

  // --- Numbers in words: null is not known -----------------------------------------------------------------------------
  const isNumber = function (value) { return typeof value === "number" && isFinite(value); };

  function orDash(value, write) {
    return isNumber(value) ? write(value) : dash;
  }

  // Three significant digits.
  function digits(value) {
    const magnitude = Math.abs(value) > 0 ? Math.floor(Math.log10(Math.abs(value))) : 0;
    const decimals = Math.min(Math.max(2 - magnitude, 0), 3);
    return Math.abs(value) < 1e9 ? value.toFixed(decimals) : String(Number(value.toPrecision(Math.max(decimals, 1))));
  }
  const millimetres = function (metres) { return orDash(metres, function (m) { return digits(1000 * m); }); };
  const millilitres = function (cubicMetres) { return orDash(cubicMetres, function (m3) { return digits(1e6 * m3); }); };
  const degrees = function (radians) { return orDash(radians, function (rad) { return digits(rad * 180 / Math.PI); }); };
  const percent = function (share) { return (100 * share).toFixed(1) + " %"; };
  const counted = function (count, what) { return count + " " + what + (count === 1 ? "" : "s"); };

  // --- Elements ----------------------------------------------------------------------------------------------------------
  const key = function (style) { return make("i", {"class": "key " + style}); };
  const note = function (...words) { return make("p", {"class": "note"}, ...words); };
  const smallPrint = function (words) { return words ? make("small", {}, words) : null; };

  function styleOf(id) {
    return "s" + ((id - 1) % 10 + 1); // ten colours, which repeat
  }

  function legend(entries) {
    return make("ul", {"class": "legend"}, ...entries.map(function ([mark, words]) { return make("li", {}, mark, words); }));
  }

  function section(id, title, ...children) {
    return make("section", {id: id}, make("h2", {}, title), ...children);
  }

  // A cell is a text or a list of elements and texts. Each row begins with a header; a short row's last cell is wide.
  // On narrow screens rows become blocks, in which each cell has the name of its column before it.
  function table(caption, header, rows, style) {
    const body = rows.map(function (cells) {
      return make("tr", {}, ...cells.map(function (content, n) {
        const attributes = n === 0 ? {scope: "row"} : {"data-label": header[n]};
        if (n + 1 === cells.length && cells.length < header.length)
          attributes.colspan = header.length - n;
        return make(n === 0 ? "th" : "td", attributes, ...[content].flat());
      }));
    });
    const head = make("tr", {}, ...header.map(function (name) { return make("th", {scope: "col"}, name); }));
    return make("div", {"class": "wide", tabindex: "0", role: "region", "aria-label": caption},
                make("table", {"class": style || "cards"},
                     make("caption", {}, caption), make("thead", {}, head), make("tbody", {}, ...body)));
  }

  function collapsed(title, lines) {
    if (!lines.length)
      return null;
    return make("details", {}, make("summary", {}, title),
                make("ul", {}, ...lines.map(function (line) { return make("li", {}, line); })));
  }

  // --- What the page begins with -----------------------------------------------------------------------------------------
  // "3 completed objects and the background from 100 frames in 34.2 s."
  function sentence() {
    const completed = data.objects.filter(function (object) { return object.completed; }).length;
    let text = counted(completed, "completed object") + (data.has_background ? " and the background" : "");
    if (completed === 0)
      text = data.has_background ? "The background" : "Nothing was completed";
    if (isNumber(data.frames))
      text += " from " + counted(Math.max(0, Math.floor(data.frames)), "frame");
    if (isNumber(data.timings_s.total))
      text += " in " + digits(data.timings_s.total) + " s";
    return text + ".";
  }

  function banners() {
    const list = [];
    const failed = function (strong, words) {
      list.push(make("p", {"class": "banner failed", role: "alert"}, make("strong", {}, strong), words));
    };
    if (data.failure)
      failed("The run failed: ", data.failure);
    else if (!data.has_summary)
      failed("The run is incomplete: ", "it has no summary; below is what it left.");
    if (data.failed.length)
      list.push(make("p", {"class": "banner failed"}, counted(data.failed.length, "object") + " failed; see the table of objects."));
    if (data.warnings.length)
      list.push(make("p", {"class": "banner"}, make("a", {href: "#warnings"}, counted(data.warnings.length, "warning"))));
    return list;
  }

  function facts() {
    const list = make("dl", {"class": "facts"});
    const add = function (value, unit, name) {
      list.append(make("div", {}, make("dt", {}, name), make("dd", {}, value, smallPrint(unit))));
    };
    const mean = function (values) { return values.reduce(function (sum, value) { return sum + value / values.length; }, 0); };
    const completed = data.objects.filter(function (object) { return object.completed; });
    const depths = completed.map(function (object) { return object.penetration_m; }).filter(isNumber);
    if (completed.length)
      add(completed.filter(function (object) { return object.closed; }).length + " of " + completed.length, "", "closed");
    if (data.accuracy && data.accuracy.objects.length) {
      const scores = data.accuracy.objects.map(function (object) { return object.score; });
      add(millimetres(mean(scores.map(function (score) { return score.accuracy_m; }))), "mm", "mean accuracy");
      add(millimetres(mean(scores.map(function (score) { return score.completeness_m; }))), "mm", "mean completeness");
    }
    if (data.accuracy)
      add(millimetres(data.accuracy.camera.ate_m), "mm", "camera ATE");
    if (depths.length)
      add(millimetres(Math.max(...depths)), "mm", "deepest overlap");
    if (isNumber(data.frames_per_second))
      add(digits(data.frames_per_second), "/s", "frames");
    return list;
  }

  function header() {
    const about = [data.method, data.date].filter(Boolean).map(function (words) { return words + dot; });
    const truth = data.truth_folder ? [dot + "truth ", make("code", {}, data.truth_folder)] : [];
    return make("header", {}, make("p", {"class": "kicker"}, "pcl_cosection report"), make("h1", {}, data.title),
                make("p", {"class": "lead"}, sentence()), note(...about, "run ", make("code", {}, data.path), ...truth),
                ...banners(), facts());
  }

  // --- Pictures ------------------------------------------------------------------------------------------------------------
  function figure(picture) {
    return make("figure", {}, make("img", {src: picture.uri, alt: picture.alternative, width: picture.width, height: picture.height}),
                make("figcaption", {}, picture.caption));
  }

  function pictures() {
    const keys = longProvenanceNames.map(function (name, n) { return [key("p" + n), name]; });
    if (isNumber(data.error_max_m))
      keys.push([make("i", {"class": "scale"}), "error, 0 to " + Number((1000 * data.error_max_m).toPrecision(14)) + " mm and more"]);
    const sides = "Above from the side of the camera, below from behind.";
    const part = section("pictures", data.has_seen ? "Before and after" : "Completed", make("p", {}, data.has_seen ?
      "Left what was seen, the zero level of the truncated distances averaged over all frames; then what was completed. " +
      sides : sides), legend(keys),
      make("div", {"class": "panels scene"}, ...data.scene_pictures.map(figure)));
    data.objects.forEach(function (object) {
      if (object.pictures.length)
        part.append(make("article", {}, make("h3", {}, key(styleOf(object.id)), object.name),
                         make("div", {"class": "panels"}, ...object.pictures.map(figure))));
    });
    return part;
  }

  // The view that scene_view.js brings to life; until then, and where that cannot be, a sentence.
  function interactiveView() {
    return section("scene", "The scene to turn",
      make("div", {id: "view", "class": "view"}, make("p", {id: "no-view", "class": "no-view"},
        "The interactive view needs a browser with scripts and WebGL. All else in this report can be read without WebGL.")),
      make("p", {"class": "note screen-only"},
        "Drag to turn, drag with the right button or two fingers to move, pinch to come nearer; the wheel does so once the " +
        "view has been clicked."));
  }

  // --- Tables --------------------------------------------------------------------------------------------------------------
  function provenance(shares) {
    if (!shares.length)
      return dash;
    const whole = shares.map(function (share) { return Math.round(100 * share); });
    const title = whole.map(function (share, n) { return share + " % " + provenanceNames[n]; }).join(", ");
    const parts = shares.map(function (share, n) { return {style: "p" + n, share: share}; });
    return [Page.bar(parts, title, 120), make("span", {"class": "shares"}, whole.join(dot) + " %")];
  }

  function solver(object) {
    return orDash(object.iterations, function (count) {
      return counted(Math.max(0, Math.floor(count)), "iteration") + (object.converged ? "" : ", not converged");
    });
  }

  function objects() {
    const rows = data.objects.filter(function (object) { return object.is_known; }).map(function (object) {
      const number = "object " + object.id;
      return [[key(styleOf(object.id)), object.name, object.name === number ? null : smallPrint(number)],
              object.size_m ? object.size_m.map(millimetres).join(times) : dash, millilitres(object.volume_m3),
              object.closed === null ? dash : object.closed ? "yes" : "no", provenance(object.provenance),
              millimetres(object.penetration_m), orDash(object.frames, String), solver(object)];
    });
    data.failed.forEach(function (object) { rows.push(["object " + object.id, "failed: " + object.error]); });
    const keys = provenanceNames.flatMap(function (name, n) { return [key("p" + n), name + (n < 3 ? ", " : ". ")]; });
    return section("objects", "Objects",
      table("Objects", ["Object", "Size (mm)", "Volume (ml)", "Closed", "Provenance", "Inside others (mm)", "Frames tracked", "Solver"], rows),
      note("Provenance, in this order: ", ...keys, "Size: length, width and height of the box around the completed mesh as " +
           "it stands. Inside others: how deep the object remains inside another body."));
  }

  function accuracy() {
    const camera = data.accuracy.camera;
    const score = function (s) { return [millimetres(s.accuracy_m), millimetres(s.completeness_m), digits(s.f_score)]; };
    const rows = data.accuracy.objects.map(function (object) {
      const error = object.trajectory;
      return [object.name, ...score(object.score),
              orDash(object.volume_error, function (share) { return (share >= 0 ? "+" : "") + percent(share); }),
              millimetres(object.penetration_m), millimetres(error.ate_m), millimetres(error.rpe_m), degrees(error.rpe_rad),
              object.tracked + " / " + object.visible];
    });
    if (data.accuracy.background)
      rows.push(["background", ...score(data.accuracy.background), dash, dash, dash, dash, dash, dash]);
    return section("accuracy", "Accuracy",
      make("p", {}, "Camera: ATE " + millimetres(camera.ate_m) + " mm, RPE " + millimetres(camera.rpe_m) + " mm and " +
           degrees(camera.rpe_rad) + "\u00b0, " + camera.matched + " of " + counted(camera.poses, "pose") + "."),
      table("Accuracy", ["Object", "Accuracy (mm)", "Completeness (mm)", "F at 10 mm", "Volume", "Inside others (mm)", "ATE (mm)",
                         "RPE (mm)", "RPE (\u00b0)", "Tracked / visible"], rows),
      note("Accuracy: mean distance from the completed mesh to the true one; completeness: from the true one to it; F: F-score " +
           "at 10 mm. ATE and RPE: root mean squares of the absolute and the relative error of the trajectory, of objects in the " +
           "camera's frame. Volume: the error of it."),
      ...data.accuracy.unmatched.map(function (id) { return note("Object " + id + " matches none of the true objects."); }),
      ...data.accuracy.missed.map(function (name) { return note("The true object " + name + " was not found."); }));
  }

  // --- Comparison: methods in rows, objects in columns ---------------------------------------------------------------------
  const scoreParts = [["accuracy_m", millimetres, Math.min], ["completeness_m", millimetres, Math.min], ["f_score", digits, Math.max]];

  // The mean over all objects, in one more column, where all are known.
  function withMean(scores) {
    if (scores.length < 2)
      return scores;
    const mean = {};
    scoreParts.forEach(function ([part]) {
      mean[part] = scores.reduce(function (sum, score) { return sum + (score ? score[part] : NaN) / scores.length; }, 0);
    });
    return scores.concat([scores.every(Boolean) ? mean : null]);
  }

  function methodCell(method) {
    return [method.name, smallPrint(method.remark)];
  }

  function compareScores(comparison) {
    const methods = comparison.methods.map(function (method) { return {cell: methodCell(method), scores: withMean(method.scores)}; });
    const header = ["Accuracy / completeness (mm) / F", ...comparison.columns];
    if (comparison.columns.length > 1)
      header.push("Mean");
    const rows = methods.map(function (method) {
      return [method.cell, ...method.scores.map(function (score, column) {
        if (!score)
          return dash;
        return scoreParts.flatMap(function ([part, write, better], n) {
          const known = methods.map(function (other) { return other.scores[column]; }).filter(Boolean);
          const best = write(better(...known.map(function (other) { return other[part]; })));
          const text = write(score[part]);
          return [n > 0 ? " / " : null, text === best ? make("b", {}, text) : text];
        });
      })];
    });
    return [table("Comparison with what was seen" + (comparison.methods.length > 2 ? " and with other runs" : ""), header, rows, "scroll"),
            note("The best of each number is bold. What was seen alone is accurate and not complete: it has no hidden sides.")];
  }

  // Without truth: what each run says of itself.
  function compareSummaries(comparison) {
    const rows = comparison.methods.map(function (method) {
      return [methodCell(method), ...method.summaries.map(function (object) {
        return millilitres(object.volume_m3) + " / " + millimetres(object.penetration_m);
      })];
    });
    return [table("Comparison with other runs", ["Volume (ml) / inside others (mm)", ...comparison.columns], rows, "scroll")];
  }

  function comparison() {
    return section("comparison", "Comparison", ...(data.accuracy ? compareScores : compareSummaries)(data.comparison));
  }

  // --- Trajectories of the camera and of the objects' middles --------------------------------------------------------------
  const mostOpen = 6;      // charts over time; more are folded away
  const gapPeriods = 1.5;  // a longer time between poses interrupts the line
  const leastHeight = 0.02; // metres, of a chart over time: noise is not motion

  // Points of a line, interrupted where poses are missing. poses: [stamp, x, y, z].
  function lineOf(poses, pointOf) {
    return poses.flatMap(function (pose, n) {
      const isGap = n > 0 && pose[0] - poses[n - 1][0] > gapPeriods * data.trajectories.period;
      return isGap ? [null, pointOf(pose)] : [pointOf(pose)];
    });
  }

  // The truth only as long as the run, and times from the first pose of all; frames keep their numbers.
  function prepared(paths) {
    const first = Math.min(...paths.map(function (path) { return path.poses[0][0]; }));
    const last = Math.max(...paths.map(function (path) { return path.poses[path.poses.length - 1][0]; }));
    const isFrame = paths.every(function (path) {
      return path.poses.every(function (pose) { return Number.isInteger(pose[0]) && pose[0] < 1e7; });
    });
    const begin = isFrame ? 0 : first;
    const since = function (pose) { return [pose[0] - begin, pose[1], pose[2], pose[3]]; };
    return {isFrame: isFrame, paths: paths.map(function (path) {
      const truth = path.truth.filter(function (pose) { return pose[0] >= first && pose[0] <= last; });
      return {name: path.name, style: path.id ? styleOf(path.id) : "s0", poses: path.poses.map(since), truth: truth.map(since)};
    })};
  }

  function overTime(path, time) {
    const start = path.poses[0], series = [];
    ["ax", "ay", "az"].forEach(function (style, axis) {
      const pointOf = function (pose) { return [pose[0], pose[axis + 1] - start[axis + 1]]; };
      if (path.truth.length)
        series.push({style: "truth", points: lineOf(path.truth, pointOf), isDashed: true});
      series.push({style: style, points: lineOf(path.poses, pointOf)});
    });
    return {title: path.name + ": moved since the beginning", xLabel: time, yLabel: "moved (m)", series: series, height: 220, leastHeight: leastHeight};
  }

  function fromAbove(paths) {
    const pointOf = function (pose) { return [pose[1], pose[2]]; };
    const series = paths.flatMap(function (path) {
      const run = {style: path.style, points: lineOf(path.poses, pointOf), hasEnds: true};
      return data.accuracy ? [run, {style: "truth", points: lineOf(path.truth, pointOf), isDashed: true}] : [run];
    });
    return {title: "From above", xLabel: "x (m)", yLabel: "y (m)", series: series, equalAxes: true, height: 480};
  }

  function trajectories() {
    const ready = prepared(data.trajectories.paths), paths = ready.paths;
    const time = ready.isFrame ? "frame" : "time (s)";
    const chart = function (content) { return make("figure", {}, make("figcaption", {}, content.title), Page.lineChart(content)); };
    const charts = paths.map(function (path) { return chart(overTime(path, time)); });
    const keys = paths.map(function (path) { return [key(path.style), path.name]; });
    if (data.accuracy)
      keys.push([key("truth"), "truth"]);
    const more = charts.slice(mostOpen);
    return section("trajectories", "Trajectories", legend(keys),
      legend([[null, "Over time:"], [key("ax"), "x"], [key("ay"), "y"], [key("az"), "z (up)"]]),
      make("div", {"class": "charts"}, chart(fromAbove(paths)), ...charts.slice(0, mostOpen)),
      more.length === 0 ? null : make("details", {}, make("summary", {}, "Charts of " + counted(more.length, "more object")),
                                      make("div", {"class": "charts"}, ...more)),
      note("Rings are beginnings, dots are ends; where nothing was tracked the line is interrupted. For objects, the middle of " +
           "the mesh is shown."));
  }

  // --- Times ---------------------------------------------------------------------------------------------------------------
  // Names of stages in summary.json and for readers. A part belongs to the stage before it that is not a part; what is
  // beside happens at the same time as others.
  const stages = [
    ["read", "waiting for images", "stage"], ["segmentation", "masks, segmentation, association", "stage"],
    ["raycast", "projecting models", "stage"], ["tracking", "tracking", "stage"], ["integration", "integrating depth", "stage"],
    ["keyframes", "keyframes: points and free space", "stage"], ["updates", "completing at keyframes, beside the rest", "beside"],
    ["final_solve", "completing", "stage"], ["data_term", "data term", "part"], ["constraints", "constraints", "part"],
    ["solve", "solving", "part"], ["mesh", "meshes", "part"], ["write", "writing", "stage"]];

  function timings() {
    const seconds = data.timings_s, total = seconds.total;
    const row = function (name, time, style) {
      return [name, digits(time), [Page.bar([{style: style, share: time / total}], percent(time / total), 300)]];
    };
    const known = stages.filter(function ([stage]) { return isNumber(seconds[stage]) && seconds[stage] >= 1e-6; });
    const rows = known.map(function ([stage, name, kind]) {
      return row((kind === "part" ? "\u00a0\u00a0\u00a0" : "") + name, seconds[stage], kind);
    });
    Object.keys(seconds).forEach(function (name) {
      if (name !== "total" && isNumber(seconds[name]) && !stages.some(function ([stage]) { return stage === name; }))
        rows.push(row(name, seconds[name], "stage"));
    });
    const rest = known.reduce(function (left, [stage, , kind]) { return kind === "stage" ? left - seconds[stage] : left; }, total);
    if (rest > 0.005 * total)
      rows.push(row("the rest", rest, "rest"));
    rows.push(["all", digits(total), ""]);
    return section("times", "Times", table("Times per stage", ["Stage", "Seconds", "Share of all"], rows, "plain bars"),
      isNumber(data.frames_per_second)
        ? note(digits(data.frames_per_second) + " frames per second until the last completion, with reading.") : null);
  }

  // --- The rest ------------------------------------------------------------------------------------------------------------
  function warnings() {
    return section("warnings", "Warnings and events",
      data.warnings.length ? make("ul", {"class": "warnings"}, ...data.warnings.map(function (text) { return make("li", {}, text); }))
                           : make("p", {}, "No warnings."),
      collapsed(counted(data.events.length, "event") + " of tracking", data.events));
  }

  function parameters() {
    const content = data.parameters.length === 0 ? make("p", {}, "The run left no parameters.")
      : make("details", {}, make("summary", {}, counted(data.parameters.length, "parameter")),
             table("Parameters", ["Parameter", "Value"], data.parameters, "plain"));
    return section("parameters", "What was run", content);
  }

  function footer() {
    const licence = !data.licence ? null
      : make("details", {}, make("summary", {}, "Licence of three.js, which draws the scene"), make("pre", {}, data.licence));
    return make("footer", {}, make("p", {}, "Written by pcl_cosection_report " + data.version + ". This file loads nothing from anywhere."), licence);
  }

  document.title = data.title + " \u2013 pcl_cosection report";
  document.body.prepend(header(), make("main", {},
    data.objects.length ? pictures() : null,
    data.scene ? interactiveView() : null,
    data.objects.length ? objects() : null,
    data.accuracy ? accuracy() : null,
    data.comparison ? comparison() : null,
    data.trajectories.paths.length ? trajectories() : null,
    isNumber(data.timings_s.total) && data.timings_s.total > 0 ? timings() : null,
    warnings(), parameters()), footer());
  window.addEventListener("beforeprint", function () { // on paper, everything is open
    document.querySelectorAll("main details").forEach(function (details) { details.open = true; });
  });
})();
