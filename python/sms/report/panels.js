// Draws every figure of #plot-data: panels above each other over one axis, a choice of views. Colours: style.css.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("plot-data").textContent);
  const faint = { measured: 0.5 };

  function line(trace, number) {
    const suffix = number ? String(number + 1) : "";
    const out = { x: trace.x, y: trace.y, name: trace.name, mode: trace.mode, xaxis: "x", yaxis: `y${suffix}`,
      showlegend: Boolean(trace.name) && !trace.quiet, opacity: trace.mode === "markers" ? faint[trace.colour] || 1 : 1,
      line: { color: colour(trace.colour), width: 2, dash: trace.dash || "solid" },
      marker: { color: colour(trace.colour), size: trace.size || 5, symbol: trace.symbol || "circle" } };
    if (trace.error) {
      out.error_y = { type: "data", symmetric: !trace.error_below, array: trace.error, arrayminus: trace.error_below,
        color: colour(trace.colour), thickness: 1.2, width: 3 };
    }
    return out;
  }

  function map(panel) {
    return [{ type: "heatmap", x: panel.names, y: panel.names, z: panel.values, zmin: -1, zmax: 1, xgap: 2, ygap: 2,
      colorscale: [[0, "#d55e00"], [0.5, dark.matches && !onPaper() ? "#2a3036" : "#f4f4f2"], [1, "#0072b2"]],
      text: panel.values.map((row) => row.map((v) => v === null ? "at bound" : v.toFixed(2).replace("-0.00", "0.00"))),
      texttemplate: "%{text}", hovertemplate: "%{y} with %{x}: %{z:.3f}<extra></extra>", colorbar: { thickness: 10 } }];
  }

  function space(trace) {
    const { x, y, name, mode, showlegend, opacity, line: stroke, marker } = line(trace, 0);
    return { type: "scatter3d", x, y, z: trace.z, name, mode, showlegend, opacity,
      line: { color: stroke.color, width: 4 },
      marker: { color: marker.color, size: trace.size || 3, symbol: marker.symbol } };
  }

  // Whether every name of the legend stands for dots, which are too small there as they are drawn.
  function dots(view) {
    const named = (view.panels || []).flatMap((panel) => panel.traces.filter((trace) => trace.name));
    return named.every((trace) => trace.mode === "markers");
  }

  function layout(place, view) {
    const out = look(place, { margin: { l: 64, r: 12, t: 12, b: 44 },
      legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0, itemsizing: dots(view) ? "constant" : "trace" } });
    if (view.titles) {
      const side = (title) => ({ title: { text: title }, color: colour("quiet"), gridcolor: colour("line"),
        backgroundcolor: "rgba(0,0,0,0)" });
      const [xaxis, yaxis, zaxis] = view.titles.map(side);
      return Object.assign(out, { margin: { l: 0, r: 0, t: 0, b: 0 },
        scene: { xaxis, yaxis, zaxis, aspectmode: "cube", camera: { eye: { x: 1.6, y: -1.6, z: 0.9 } } } });
    }
    if (view.names) {
      return Object.assign(out, { margin: { l: 64, r: 12, t: 36, b: 44 }, xaxis: axis("", { tickangle: -30 }), yaxis: axis("", { autorange: "reversed" }) });
    }
    const count = view.panels.length;
    out.xaxis = axis(view.x_title, Object.assign({ anchor: count > 1 ? `y${count}` : "y" }, view.x_log ? { type: "log" } : {},
      view.x_names ? { tickvals: view.x_names.map((_, i) => i + 1), ticktext: view.x_names } : {}));
    const heights = view.panels.map((panel) => panel.share || 1);
    const sum = heights.reduce((a, b) => a + b, 0), gap = count > 1 ? 0.05 : 0;
    let top = 1;
    view.panels.forEach((panel, i) => {
      const bottom = Math.max(top - heights[i] / sum * (1 - gap * (count - 1)), 0);
      const more = { domain: [bottom, top], rangemode: panel.from_zero ? "tozero" : "normal" };
      if (panel.log) Object.assign(more, { type: "log", exponentformat: "none", dtick: "D2" });
      if (panel.range) more.range = panel.range;
      out[`yaxis${i ? i + 1 : ""}`] = axis(panel.title, more);
      top = bottom - gap;
    });
    return out;
  }

  function draw(id, number) {
    const view = data[id][number];
    const traces = view.names ? map(view) : view.titles ? view.traces.map(space)
      : view.panels.flatMap((panel, i) => panel.traces.map((t) => line(t, i)));
    Plotly.react(`${id}-plot`, traces, layout(document.getElementById(`${id}-plot`), view), config);
  }

  function choose(id) {
    const place = document.getElementById(`${id}-choice`);
    if (!place) return () => 0;
    const select = document.createElement("select");
    select.setAttribute("aria-label", "What is shown");
    data[id].forEach((view, i) => select.add(new Option(view.label, i)));
    place.append(select);
    select.addEventListener("change", () => draw(id, Number(select.value)));
    return () => Number(select.value);
  }

  const shown = Object.keys(data).map((id) => [id, choose(id)]);
  keepDrawn(() => shown.forEach(([id, number]) => draw(id, number())));
})();
