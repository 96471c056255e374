// Elements and charts of a report.
"use strict";

const Page = (function () {
  const width = 420;                                    // of a chart, at which letters have their size
  const left = 46, right = 12, top = 10, bottom = 38;   // beside the field of the lines
  const mostPoints = 400;                               // of a line; more are thinned evenly
  const leastWidth = 1e-3;                              // metres, seconds or frames
  const barHeight = 10;

  function fill(element, attributes, children) {
    Object.entries(attributes || {}).forEach(function ([name, value]) { element.setAttribute(name, value); });
    element.append(...children.filter(function (child) { return child !== null && child !== undefined; }));
    return element;
  }

  // An element with attributes; children are elements or texts, which are never markup.
  function make(name, attributes, ...children) {
    return fill(document.createElement(name), attributes, children);
  }

  function makeSvg(name, attributes, ...children) {
    return fill(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
  }

  function place(value) {
    const text = value.toFixed(1);
    return text === "-0.0" ? "0.0" : text;
  }

  // Round numbers from least to most, about count of them.
  function ticksBetween(least, most, count) {
    const raw = (most - least) / Math.max(1, count);
    if (!(raw > 0) || !isFinite(raw))
      return [least];
    const power = Math.pow(10, Math.floor(Math.log10(raw)));
    let step = 10 * power;
    [5, 2, 1].forEach(function (factor) {
      if (factor * power >= raw * (1 - 1e-9))
        step = factor * power;
    });
    const ticks = [];
    for (let n = Math.ceil(least / step - 1e-9); n * step <= most + 1e-9 * step; ++n)
      ticks.push(n * step);
    return ticks;
  }

  function tickText(value, step) {
    const decimals = Math.min(Math.max(Math.ceil(-Math.log10(step) - 1e-9), 0), 6);
    return (Math.abs(value) < 1e-9 * step ? 0 : value).toFixed(decimals);
  }

  // Where numbers are in the picture. A point is [x, y], or null where a line is interrupted.
  function axesOf(chart) {
    const field = [width - left - right, chart.height - top - bottom];
    const least = [0, 1].map(function (axis) {
      const values = chart.series.flatMap(function (series) {
        return series.points.filter(Boolean).map(function (point) { return point[axis]; });
      });
      return values.reduce(function (box, value) { return [Math.min(box[0], value), Math.max(box[1], value)]; },
                           values.length ? [Infinity, -Infinity] : [0, 0]);
    });
    const box = least.map(function (range, axis) {
      const size = Math.max(range[1] - range[0], axis === 0 ? leastWidth : chart.leastHeight || 1e-3);
      const middle = 0.5 * (range[0] + range[1]);
      const margin = axis === 0 && !chart.equalAxes ? 0 : 0.06 * size;
      return [middle - 0.5 * size - margin, middle + 0.5 * size + margin];
    });
    if (chart.equalAxes) { // a metre is as long on both
      const metre = Math.min(field[0] / (box[0][1] - box[0][0]), field[1] / (box[1][1] - box[1][0]));
      box.forEach(function (range, axis) {
        const middle = 0.5 * (range[0] + range[1]), half = 0.5 * field[axis] / metre;
        box[axis] = [middle - half, middle + half];
      });
    }
    return {
      box: box, right: left + field[0], bottom: top + field[1],
      x: function (value) { return left + field[0] * (value - box[0][0]) / (box[0][1] - box[0][0]); },
      y: function (value) { return top + field[1] * (box[1][1] - value) / (box[1][1] - box[1][0]); }
    };
  }

  function drawTicks(svg, axes, chart) {
    const label = function (attributes, words) { svg.append(makeSvg("text", attributes, words)); };
    const xs = ticksBetween(axes.box[0][0], axes.box[0][1], 6), ys = ticksBetween(axes.box[1][0], axes.box[1][1], 5);
    const stepOf = function (ticks) { return ticks.length > 1 ? ticks[1] - ticks[0] : 1; };
    xs.forEach(function (tick) {
      const x = place(axes.x(tick));
      svg.append(makeSvg("line", {"class": "grid", x1: x, x2: x, y1: place(top), y2: place(axes.bottom)}));
      label({x: x, y: place(axes.bottom + 15), "text-anchor": "middle"}, tickText(tick, stepOf(xs)));
    });
    ys.forEach(function (tick) {
      const y = place(axes.y(tick));
      svg.append(makeSvg("line", {"class": "grid", x1: place(left), x2: place(axes.right), y1: y, y2: y}));
      label({x: place(left - 6), y: place(axes.y(tick) + 4), "text-anchor": "end"}, tickText(tick, stepOf(ys)));
    });
    label({x: place(0.5 * (left + axes.right)), y: place(chart.height - 6), "text-anchor": "middle"}, chart.xLabel);
    label({transform: "translate(12 " + place(0.5 * (top + axes.bottom)) + ") rotate(-90)", "text-anchor": "middle"}, chart.yLabel);
  }

  function drawSeries(svg, axes, series) {
    const step = Math.floor(series.points.length / mostPoints) + 1;
    const points = series.points.filter(function (point, n) {
      return n % step === 0 || n + 1 === series.points.length || !point;
    });
    let path = "";
    points.forEach(function (point, n) {
      if (point)
        path += (n > 0 && points[n - 1] ? "L" : "M") + place(axes.x(point[0])) + " " + place(axes.y(point[1]));
    });
    if (!path)
      return;
    svg.append(makeSvg("path", {"class": "line " + series.style + (series.isDashed ? " dashed" : ""), d: path}));
    if (!series.hasEnds)
      return;
    const shown = points.filter(Boolean);
    [["ring", shown[0]], ["dot", shown[shown.length - 1]]].forEach(function ([kind, point]) {
      svg.append(makeSvg("circle", {"class": kind + " " + series.style, cx: place(axes.x(point[0])), cy: place(axes.y(point[1])), r: "3.5"}));
    });
  }

  // Lines over two axes, as an SVG element that scales with its width. chart: title, xLabel, yLabel, height,
  // equalAxes, leastHeight (of the vertical axis: what moves less looks still), series (style, points, isDashed,
  // hasEnds: a ring at the first and a dot at the last point).
  function lineChart(chart) {
    const axes = axesOf(chart);
    const svg = makeSvg("svg", {"class": "chart", viewBox: "0 0 " + width + " " + chart.height, role: "img", "aria-label": chart.title});
    drawTicks(svg, axes, chart);
    chart.series.forEach(function (series) { drawSeries(svg, axes, series); });
    return svg;
  }

  // Parts beside each other: style, share of the width.
  function bar(parts, title, barWidth) {
    const svg = makeSvg("svg", {"class": "bar", viewBox: "0 0 " + barWidth + " " + barHeight, preserveAspectRatio: "none", role: "img", "aria-label": title});
    let at = 0;
    parts.forEach(function (part) {
      const size = Math.min(Math.max(part.share, 0), 1) * barWidth;
      if (size > 0)
        svg.append(makeSvg("rect", {"class": part.style, x: at.toFixed(2), y: "0", width: size.toFixed(2), height: barHeight}));
      at += size;
    });
    return svg;
  }

  return {make: make, ticksBetween: ticksBetween, lineChart: lineChart, bar: bar, data: null};
})();
