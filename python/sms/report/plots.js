// Draws every figure of #plot-data; plots.py says what a figure holds.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("plot-data").textContent);
  const cycle = ["measured", "extended", "baseline", "good", "warn", "floor"];

  const scaled = (title, log) => axis(title, log ? { type: "log", exponentformat: "none", dtick: "D2" } : {});

  function trace(series, index) {
    const mode = series.mode || "lines";
    return { x: series.x, y: series.y, name: series.name, mode, type: "scatter",
      line: { color: colour(series.colour || cycle[index % cycle.length]), width: 1.6, dash: series.dash || "solid" },
      showlegend: Boolean(series.name),
      marker: { color: colour(series.colour || cycle[index % cycle.length]), size: series.size || 7,
        symbol: series.symbol || "circle" } };
  }

  function line(mark) {
    const across = mark.y !== undefined;
    return { type: "line", xref: across ? "paper" : "x", yref: across ? "y" : "paper",
      x0: across ? 0 : mark.x, x1: across ? 1 : mark.x, y0: across ? mark.y : 0, y1: across ? mark.y : 1,
      line: { color: colour(mark.colour || "bad"), width: 1, dash: "dot" } };
  }

  function draw(figure) {
    const place = document.getElementById(figure.id);
    const named = figure.series.filter((series) => series.name).length;
    const y = scaled(figure.y, figure.log_y);
    const x = scaled(figure.x, figure.log_x);
    if (figure.range_x) x.range = figure.range_x;
    if (figure.range_y) y.range = figure.range_y;
    const legend = named > 1 && figure.legend;
    Plotly.react(place, figure.series.map(trace), look(place, { margin: { l: 60, r: 12, t: legend ? 34 : 12, b: 44 },
      height: figure.height || 300, showlegend: legend, xaxis: x, yaxis: y, shapes: (figure.marks || []).map(line) }),
      config);
  }

  keepDrawn(() => data.figures.forEach(draw));
})();
