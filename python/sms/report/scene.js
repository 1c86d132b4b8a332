// The platform moving in 3-D: legs coloured by pressure, drawn by Plotly from #plot-data's "scene".
"use strict";
(() => {
  const scene = JSON.parse(document.getElementById("plot-data").textContent).scene;
  const place = document.getElementById("scene");
  if (!scene || !place) return;
  const scale = [[0, "#0072b2"], [0.5, "#e6e0c8"], [1, "#d55e00"]];
  const up = (points) => ({ x: points.map((p) => p[0]), y: points.map((p) => p[1]), z: points.map((p) => -p[2]) });
  const along = (a, b, share) => a.map((v, k) => v + share * (b[k] - v));
  const base = scene.base;

  // One frame's traces, in a fixed order: three cylinders, three rods, Panhard rods, frame, payload.
  function traces(frame) {
    const joints = frame.joints;
    const legs = [0, 1, 2].map((i) => {
      const length = Math.hypot(...joints[i].map((v, k) => v - base[i][k]));
      const body = along(base[i], joints[i], scene.cylinder[i] / length);
      return { body: up([base[i], body]), rod: up([body, joints[i]]) };
    });
    const panhard = [3, 4, 5].flatMap((i) => [base[i], joints[i], [null, null, null]])
      .map((p) => (p[0] === null ? { x: null, y: null, z: null } : { x: p[0], y: p[1], z: -p[2] }));
    return [
      ...legs.map((leg, i) => Object.assign({ line: { width: 16, color: [frame.pressure[i], frame.pressure[i]],
        colorscale: scale, cmin: scene.low, cmax: scene.high, showscale: i === 0,
        colorbar: { title: { text: "lower chamber<br>bar absolute" }, len: 0.6, thickness: 12, x: 1 } } }, leg.body)),
      ...legs.map((leg) => Object.assign({ line: { width: 5, color: colour("floor") } }, leg.rod)),
      { x: panhard.map((p) => p.x), y: panhard.map((p) => p.y), z: panhard.map((p) => p.z),
        line: { width: 3, color: colour("quiet") } },
      up(joints.slice(0, 3)),
      up(frame.payload)
    ];
  }

  const kinds = [0, 1, 2, 3, 4, 5, 6].map(() => ({ type: "scatter3d", mode: "lines", hoverinfo: "skip" }));
  const mesh = (faces, name, opacity) => ({ type: "mesh3d", i: faces.map((f) => f[0]), j: faces.map((f) => f[1]),
    k: faces.map((f) => f[2]), color: colour(name), opacity, flatshading: true, hoverinfo: "skip" });
  const box = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7],
    [2, 7, 6], [3, 0, 4], [3, 4, 7]];
  kinds.push(mesh([[0, 1, 2]], "measured", 0.85), mesh(box, "extended", 0.35));
  const ground = Object.assign({ type: "mesh3d", i: [0, 0], j: [1, 2], k: [2, 3], color: colour("grid"), opacity: 0.6,
    hoverinfo: "skip" }, up([[-1.8, -1.8, 0], [1.8, -1.8, 0], [1.8, 1.8, 0], [-1.8, 1.8, 0]]));
  const data = traces(scene.frames[0]).map((trace, i) => Object.assign({ showlegend: false }, kinds[i], trace));
  data.push(ground, Object.assign({ type: "scatter3d", mode: "text", text: ["1", "2", "3"], hoverinfo: "skip",
    showlegend: false, textfont: { color: colour("ink"), size: 14 } },
    up([0, 1, 2].map((i) => [1.08 * base[i][0], 1.08 * base[i][1], base[i][2]]))));

  const side = (title, range) => ({ title: { text: title }, range, color: colour("quiet"), gridcolor: colour("line"),
    backgroundcolor: "rgba(0,0,0,0)" });
  const still = { mode: "immediate", transition: { duration: 0 }, frame: { duration: 0, redraw: true } };
  const running = { mode: "immediate", fromcurrent: true, transition: { duration: 0 },
    frame: { duration: 1000 * scene.period, redraw: true } };
  const layout = { height: 560, margin: { l: 0, r: 0, t: 0, b: 0 }, paper_bgcolor: "rgba(0,0,0,0)",
    font: { family: getComputedStyle(document.body).fontFamily, size: 12, color: colour("ink") },
    scene: { aspectmode: "data", xaxis: side("x forward, m", [-1.8, 1.8]), yaxis: side("y starboard, m", [-1.8, 1.8]),
      zaxis: side("up, m", [0, 2.4]), camera: { eye: { x: 1.15, y: 1.05, z: 0.45 }, center: { x: 0, y: 0, z: -0.14 } } },
    updatemenus: [{ type: "buttons", direction: "left", x: 0, y: 0, xanchor: "left", yanchor: "bottom",
      pad: { l: 8, b: 8 }, showactive: false, bgcolor: colour("surface"), bordercolor: colour("line"),
      buttons: [{ label: "Play", method: "animate", args: [null, running] },
        { label: "Pause", method: "animate", args: [[null], still] }] }],
    sliders: [{ x: 0.14, len: 0.84, y: 0, yanchor: "bottom", pad: { b: 4 }, currentvalue: { prefix: "time ", suffix: " s",
      xanchor: "right" }, ticklen: 0, minorticklen: 0, font: { color: "rgba(0,0,0,0)", size: 1 },
      steps: scene.frames.map((frame) => ({ label: frame.time.toFixed(1), method: "animate",
        args: [[frame.time.toFixed(2)], still] })) }] };
  layout.sliders[0].currentvalue.font = { color: colour("ink"), size: 13 };
  Plotly.newPlot(place, data, layout, { responsive: true, displaylogo: false, displayModeBar: false }).then(() =>
    Plotly.addFrames(place, scene.frames.map((frame) => ({ name: frame.time.toFixed(2), data: traces(frame),
      traces: kinds.map((_, i) => i) }))));
})();
