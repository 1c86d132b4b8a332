// Draws the workspace page with Plotly from the JSON in #plot-data. Colours come from style.css.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("plot-data").textContent);
  // From low to high: orange, grey at the middle, blue; both ends safe for colour-blind readers.
  function heightColour(share) {
    const stops = [[213, 94, 0], [128, 128, 128], [0, 114, 178]];
    const at = 2 * share, i = Math.min(Math.floor(at), 1);
    const mix = stops[i].map((c, k) => Math.round(c + (at - i) * (stops[i + 1][k] - c)));
    return `rgb(${mix.join(",")})`;
  }

  const boxLook = [{ name: "bad", dash: "solid" }, { name: "good", dash: "dash" }];

  function drawRegion() {
    const count = data.outlines.length;
    const lines = data.outlines.map((outline, i) => ({ x: outline.roll, y: outline.pitch, mode: "lines",
      name: `${outline.height} mm`,
      line: { color: heightColour(i / Math.max(count - 1, 1)), width: outline.best ? 3 : 1.8 },
      hovertemplate: `height ${outline.height} mm<br>roll %{x:.2f}°, pitch %{y:.2f}°<extra></extra>` }));
    const areas = data.outlines.filter((outline) => outline.best).map((outline) => ({ x: outline.roll,
      y: outline.pitch, mode: "none", fill: "toself", fillcolor: colour("tint"), showlegend: false, hoverinfo: "skip" }));
    const boxes = data.boxes.map((box, i) => ({
      x: [-1, 1, 1, -1, -1].map((s) => s * box.roll), y: [-1, -1, 1, 1, -1].map((s) => s * box.pitch),
      mode: "lines", name: box.name, legendgroup: "boxes",
      line: { color: colour(boxLook[i % 2].name), width: 3, dash: boxLook[i % 2].dash },
      hovertemplate: `${box.name}<extra></extra>` }));
    const narrow = innerWidth < 760;
    const all = [...lines, ...boxes].flatMap((trace) => [...trace.x, ...trace.y]).map(Math.abs);
    const end = Math.max(...all) + 0.7;
    const angles = (more) => Object.assign({ dtick: narrow ? 4 : 2, range: [-end, end], constrain: "domain" }, more);
    Plotly.react("region", [...areas, ...lines, ...boxes], look(document.getElementById("region"), {
      xaxis: axis("roll [°]", angles({})), yaxis: axis("pitch [°]", angles({ scaleanchor: "x" })),
      legend: narrow ? { orientation: "h", y: -0.25, yanchor: "top" } : { x: 1.02, y: 1, title: { text: "height" }, traceorder: "normal" },
    }), config);
  }

  function drawByHeight(place, title, names, more, suffix) {
    const colours = ["baseline", "extended", "good", "warn"].map(colour);
    const traces = names.map((name, i) => ({ x: data.height, y: data.by_height[name], mode: "lines", name,
      line: { color: colours[i], width: 2, dash: i > 1 ? "dot" : "solid" },
      hovertemplate: `${name} %{y:.2f}${suffix}<extra></extra>` }));
    Plotly.react(place, traces, look(document.getElementById(place), { hovermode: "x unified", xaxis: axis("height [mm]"),
      yaxis: axis(title, more) }), config);
  }

  function drawStroke() {
    const traces = data.boxes.map((box, i) => ({ x: box.height, y: box.margin, mode: "lines", name: box.name,
      line: { color: colour(boxLook[i % 2].name), width: 2, dash: boxLook[i % 2].dash },
      hovertemplate: "%{y:.1f} mm<extra>" + box.name + "</extra>" }));
    Plotly.react("stroke", traces, look(document.getElementById("stroke"), { xaxis: axis("height [mm]"),
      yaxis: axis("stroke left [mm]", { range: [-60, 20], zerolinecolor: colour("ink"), zerolinewidth: 1.5 }),
      legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0, font: { size: 11 } } }), config);
  }

  function draw() {
    drawRegion();
    drawStroke();
    drawByHeight("alone", "angle [°]", ["roll −", "roll +", "pitch −", "pitch +"],
      { rangemode: "tozero" }, "°");
    drawByHeight("joints", "angle [°]", ["actuator, base", "rod, base", "actuator, platform", "rod, platform"],
      { rangemode: "tozero" }, "°");
    drawByHeight("condition", "condition number", ["Panhard rods", "all six links"], { range: [1, 2] }, "");
    drawByHeight("force", "share [%]", ["holding", "accelerating"], { range: [0, 100] }, " %");
  }

  keepDrawn(draw);
})();
