let here = 0;
const palette = ["--one", "--bad", "--mark", "--soft", "--film", "--ink"];
const shade = k => k < 0 ? colour("--line") : colour(palette[k % palette.length]);

function trace(line) {
  const both = { x: line.x, y: line.y, name: plain(line.name), showlegend: !!line.name, customdata: line.of, hoverinfo: "none" };
  const marks = { size: line.style === "dots" ? 4 : 9, color: shade(line.colour), symbol: line.style === "open" ? "circle-open" : "circle" };
  if (line.style === "dots") return { ...both, mode: "markers", marker: marks };
  if (line.style === "marks" || line.style === "open")
    return { ...both, mode: "markers+text", text: (line.texts || []).map(plain), textposition: "top center", cliponaxis: false, marker: marks };
  if (line.style === "joined") return { ...both, mode: "lines+markers", connectgaps: false, marker: marks, line: { color: shade(line.colour), width: 1.5 } };
  if (line.style === "stems") return { ...both, type: "bar", marker: { color: shade(line.colour) } };
  return { ...both, mode: "lines", connectgaps: false, line: { color: shade(line.colour), width: 2, dash: line.style === "dash" ? "dash" : "solid" } };
}

function layout(picture, at) {
  const axis = (title, side) => ({ title: { text: plain(title), standoff: 8 }, gridcolor: colour("--line"), zerolinecolor: colour("--line"),
    linecolor: colour("--line"), automargin: side });
  const up = Object.assign(axis(picture.up, "left"), picture.log ? { type: "log", exponentformat: "power" } : {});
  const cut = { type: "line", xref: "x", yref: "paper", x0: at, x1: at, y0: 0, y1: 1, line: { color: colour("--ink"), width: 1.2, dash: "dot" } };
  return { margin: { l: 60, r: 14, t: 24, b: 46 }, paper_bgcolor: colour("--paper"), plot_bgcolor: colour("--paper"), hovermode: "closest",
    font: { color: colour("--ink"), size: 12 }, legend: { orientation: "h", y: 1.12 }, dragmode: false, bargap: 0.6, xaxis: axis(picture.across, "bottom"),
    yaxis: up, shapes: at === null ? [] : [cut] };
}

function draw(boxes, pictures, at) {
  pictures.forEach((picture, k) => Plotly.react(boxes[k], picture.lines.map(trace), layout(picture, at), config));
}

function made(parent, count) {
  while (parent.children.length < count) parent.append(document.createElement("div"));
  [...parent.children].forEach((box, k) => { box.hidden = k >= count; });
  return [...parent.children];
}

function list(parent, lines) {
  parent.replaceChildren(...lines.map(text => { const item = document.createElement("li"); item.textContent = text; return item; }));
}

function go(k) {
  if (!data.places.length) return;
  here = Math.max(0, Math.min(data.places.length - 1, k));
  const place = data.places[here];
  find("place").value = here;
  list(find("said"), place.said);
  draw(made(find("places"), place.pictures.length), place.pictures, null);
  boxes.forEach(box => Plotly.relayout(box, { "shapes[0].x0": place.at, "shapes[0].x1": place.at }));
}

function all() {
  draw(boxes, data.overviews, data.places.length ? data.places[here].at : null);
  go(here);
}

const boxes = made(find("overviews"), data.overviews.length);
boxes.forEach(box => box.classList.add("wide"));
list(find("told"), data.said);
find("place").max = data.places.length - 1;
find("moved").hidden = data.places.length < 2;
find("place").addEventListener("input", e => go(+e.target.value));
document.addEventListener("keydown", e => {
  if (e.target.type === "range") return;
  const step = { ArrowRight: 1, ArrowLeft: -1, Home: -data.places.length, End: data.places.length }[e.key];
  if (step) { go(here + step); e.preventDefault(); }
});
all();
boxes.forEach(box => ["plotly_hover", "plotly_click"].forEach(event => box.on(event, found => {
  const k = found.points[0].customdata;
  if (Number.isInteger(k) && k !== here) go(k);
})));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", all);
