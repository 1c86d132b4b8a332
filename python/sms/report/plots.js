// Draws every figure of #plot-data; plots.py says what a figure holds.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("plot-data").textContent);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const touch = matchMedia("(pointer: coarse)").matches;
  const config = { responsive: true, displaylogo: false, displayModeBar: touch ? false : "hover",
    modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]],
    toImageButtonOptions: { format: "png", scale: 2 } };
  const cycle = ["measured", "extended", "baseline", "good", "warn", "floor"];

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

  function axis(title, log) {
    const shown = { title: { text: title, standoff: 8 }, gridcolor: colour("grid"), linecolor: colour("line"),
      zerolinecolor: colour("line"), tickcolor: colour("line"), automargin: true };
    return log ? Object.assign(shown, { type: "log", exponentformat: "none", dtick: "D2" }) : shown;
  }

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
    const y = axis(figure.y, figure.log_y);
    const x = axis(figure.x, figure.log_x);
    if (figure.range_x) x.range = figure.range_x;
    if (figure.range_y) y.range = figure.range_y;
    Plotly.react(place, figure.series.map(trace), { paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: colour("ink") },
      margin: { l: 60, r: 12, t: named > 1 && figure.legend ? 34 : 12, b: 44 }, height: figure.height || 300,
      dragmode: touch ? false : "zoom",
      modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("quiet"), activecolor: colour("ink") },
      hovermode: "closest",
      hoverlabel: { bgcolor: colour("surface"), bordercolor: colour("line"), font: { color: colour("ink") } },
      showlegend: named > 1 && figure.legend, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
      xaxis: x, yaxis: y, shapes: (figure.marks || []).map(line) }, config);
  }

  const drawAll = () => data.figures.forEach(draw);
  drawAll();
  dark.addEventListener("change", drawAll);
})();
