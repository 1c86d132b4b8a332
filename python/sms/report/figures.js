// Draws the page's curves with Plotly from the JSON in #plot-data. Colours come from style.css.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("plot-data").textContent);
  function floats(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Float32Array(bytes.buffer);
  }

  // A row of buttons of which one is pressed; calls `choose` with its number.
  function buttons(place, labels, choose) {
    const all = labels.map(({ label, note }, number) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = label;
      if (note) {
        const role = document.createElement("span");
        role.className = "role";
        role.textContent = note;
        button.append(" ", role);
      }
      button.addEventListener("click", () => press(number));
      place.append(button);
      return button;
    });
    function press(number) {
      all.forEach((button, i) => button.setAttribute("aria-pressed", String(i === number)));
      choose(number);
    }
    if (all.length) press(0);
  }

  // Records and signals, each a row of buttons; with one signal the records alone. Calls `choose` with the item's number.
  function choices(place, items, choose) {
    const distinct = (key) => [...new Set(items.map((item) => item[key]))];
    const labels = distinct("label"), signals = distinct("of");
    let label = labels[0], signal = signals[0];
    function chosen() {
      const exact = items.findIndex((item) => item.label === label && item.of === signal);
      choose(exact >= 0 ? exact : items.findIndex((item) => item.label === label));
    }
    const rows = signals.length > 1 ? [labels, signals] : [labels];
    rows.forEach((names, row) => {
      const line = document.createElement("div");
      line.className = "buttons";
      place.append(line);
      let ready = false;
      buttons(line, names.map((name) => ({ label: name,
        note: row === 0 ? items.find((item) => item.label === name).role : "" })), (number) => {
        if (row === 0) label = names[number]; else signal = names[number];
        if (ready) chosen();
      });
      ready = true;
    });
    if (items.length) chosen();
  }

  // ---- over time ------------------------------------------------------------------------------
  const models = data.extended ? ["baseline", "extended"] : ["baseline"];
  const names = { measured: "Measured", baseline: "Baseline", extended: "Extended" };
  const widths = { measured: 2.2, baseline: 1.3, extended: 1.3 };
  let record = 0, view = 0;

  function drawLines() {
    const r = data.records[record];
    const curve = Object.fromEntries(Object.keys(names).map((kind) => [kind, floats(r[kind])]));
    const x = floats(r.views[view].x);
    const unit = r.unit ? ` ${r.unit}` : "";
    // Over another signal than time only compared rows are drawn: the rest would hide them.
    const measured = view === 0 ? curve.measured
      : curve.measured.map((y, i) => (Number.isNaN(curve.baseline[i]) ? NaN : y));
    const traces = [["measured", measured], ...models.map((kind) => [kind, curve[kind]])]
      .map(([kind, y]) => ({ x, y, name: names[kind], mode: "lines", yaxis: "y", showlegend: false,
        line: { color: colour(kind), width: widths[kind] },
        hovertemplate: `${names[kind]} %{y:.2f}${unit}<extra></extra>` }));
    for (const kind of models) {
      const error = curve.measured.map((y, i) => y - curve[kind][i]);
      traces.push({ x, y: error, mode: "lines", yaxis: "y2", showlegend: false,
        line: { color: colour(kind), width: 1.3 },
        hovertemplate: `error of ${kind} %{y:.2f}${unit}<extra></extra>` });
    }
    const shapes = r.floor === null ? [] : [{ type: "rect", xref: "paper", x0: 0, x1: 1, yref: "y2",
      y0: -r.floor, y1: r.floor, line: { width: 0 }, fillcolor: colour("floor"), opacity: 0.3, layer: "below" }];
    Plotly.react("lines", traces, look(document.getElementById("lines"), { shapes, hovermode: view === 0 ? "x unified" : "closest",
      xaxis: axis(r.views[view].title, { anchor: "y2", zeroline: false }),
      yaxis: axis(r.signal, { domain: [0.46, 1], zeroline: false }),
      yaxis2: axis(`error [${r.unit}]`, { domain: [0, 0.4] }) }), config);
  }

  // ---- residual against every input -----------------------------------------------------------
  const symbols = { "": "circle", extending: "triangle-up", retracting: "triangle-down" };
  let group = 0, drawn = false;

  function drawResiduals() {
    const g = data.groups[group];
    const place = document.getElementById("residuals");
    for (const old of place.children) Plotly.purge(old);
    place.replaceChildren();
    for (const panel of g.panels) {
      const div = document.createElement("div");
      div.className = "panel";
      div.setAttribute("role", "img");
      div.setAttribute("aria-label", `Error of baseline and extended model over ${panel.title}`);
      place.append(div);
      const x = floats(panel.x);
      const dots = [], means = [];
      for (const kind of models) {
        const p = panel[kind];
        dots.push({ x, y: floats(g.dots[kind]), mode: "markers", showlegend: false, hoverinfo: "skip",
          marker: { size: 3, opacity: 0.18, color: colour(kind) } });
        for (const mean of p.means) {
          means.push({ x: floats(mean.x), y: floats(mean.y), mode: panel.few ? "markers" : "lines+markers",
            showlegend: false, line: { color: colour(kind), width: 1.6 },
            marker: { size: 8, color: colour(kind), symbol: symbols[mean.side],
              line: { color: colour("surface"), width: 1 } },
            hovertemplate: `mean error of ${kind} ${mean.side} %{y:.2f}<extra></extra>` });
        }
      }
      const ticks = panel.few ? { tickvals: panel.ticks, ticktext: panel.names } : {};
      Plotly.newPlot(div, [...dots, ...means], look(div, {
        margin: { l: 48, r: 8, t: 6, b: 40 },
        xaxis: axis(panel.title, { zeroline: false, ...ticks }),
        yaxis: axis(g.error, { range: [-g.limit, g.limit] }) }),
        { ...config, displayModeBar: false });
    }
  }

  if (data.records.length) {
    const views = document.getElementById("views");
    choices(document.getElementById("records"), data.records, (number) => {
      record = number;
      view = Math.min(view, data.records[record].views.length - 1);
      if (drawn) drawLines();
    });
    if (data.records.every((r) => r.views.length > 1)) {
      buttons(views, data.records[0].views.map((v) => ({ label: `over ${v.title.split(" [")[0]}` })),
        (number) => { view = Math.min(number, data.records[record].views.length - 1); if (drawn) drawLines(); });
    }
    choices(document.getElementById("groups"), data.groups,
      (number) => { group = number; if (drawn) drawResiduals(); });
    drawn = true;
    keepDrawn(() => { drawLines(); drawResiduals(); });
  }
})();
