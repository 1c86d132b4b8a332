// Starts a page: unpacks Plotly where the page carries it, then draws; what all figures share. Colours: style.css.
"use strict";
const dark = matchMedia("(prefers-color-scheme: dark)");
const touch = matchMedia("(pointer: coarse)").matches;
const config = { responsive: true, displaylogo: false, displayModeBar: touch ? false : "hover",
  modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]], toImageButtonOptions: { format: "png", scale: 2 } };

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const onPaper = () => document.documentElement.hasAttribute("data-paper");

function axis(title, more) {
  return Object.assign({ title: { text: title, standoff: 8 }, gridcolor: colour("grid"), linecolor: colour("line"),
    zerolinecolor: colour("line"), tickcolor: colour("line"), automargin: true }, more);
}

// The layout that all figures share. On paper a figure has the size of its place at once; on a screen it follows it.
function look(place, more) {
  const paper = onPaper() ? { width: place.clientWidth, height: place.clientHeight } : {};
  return Object.assign({ paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    font: { family: getComputedStyle(document.body).fontFamily, size: onPaper() ? 10 : 13, color: colour("ink") },
    margin: { l: 56, r: 12, t: 12, b: 44 }, dragmode: touch ? false : "zoom", hovermode: "closest",
    modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("quiet"), activecolor: colour("ink") },
    hoverlabel: { bgcolor: colour("surface"), bordercolor: colour("line"), font: { color: colour("ink") } },
    legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 } }, more, paper);
}

// Draws now, and again when the colours change or the page goes to paper and comes back.
function keepDrawn(draw) {
  draw();
  dark.addEventListener("change", draw);
  addEventListener("beforeprint", () => { document.documentElement.setAttribute("data-paper", ""); draw(); });
  addEventListener("afterprint", () => { document.documentElement.removeAttribute("data-paper"); draw(); });
}

// The page's policy names the hash of what is unpacked: the browser runs this text and no other.
async function unpack() {
  const packed = document.getElementById("plotly");
  if (packed) {
    const bytes = Uint8Array.from(atob(packed.textContent), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    const script = document.createElement("script");
    script.textContent = await new Response(stream).text();
    document.head.append(script);
    packed.remove();
  }
  if (!window.Plotly) throw new Error("Plotly is not there");
}

function complain(problem) {
  const said = document.createElement("p");
  said.className = "decide";
  said.textContent = document.getElementById("plotly")
    ? "The figures of this page need a browser of 2023 or later (DecompressionStream)."
    : `The figures of this page could not be drawn (${problem.message}); is the file plotly-*.min.js beside it?`;
  document.querySelector("main").prepend(said);
}
