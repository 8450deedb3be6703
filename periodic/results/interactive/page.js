const bytes = Uint8Array.from(atob(data.orbits), c => c.charCodeAt(0));
const orbits = new Float32Array(bytes.buffer);
const count = data.points.length, many = data.signals.length, samples = data.samples;
const floats = text => new Float32Array(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
if (data.drawing) data.drawing.shapes.filter(s => s.kind === "line").forEach(s => { s.bent = floats(s.values); });
let here = 0, moving = false, turn = 0, last = 0;

function signal(point, k) { const at = (point * many + k) * samples; return orbits.subarray(at, at + samples); }
function closed(values) { return [...values, values[0]]; }

function frame(x, y, more) {
  // Each axis moves its own margin alone: with one that its last number moves too the other may never settle.
  const axis = (title, side) => ({ title: { text: plain(title), standoff: 8 }, gridcolor: colour("--line"),
    zerolinecolor: colour("--line"), linecolor: colour("--line"), automargin: side });
  return Object.assign({ margin: { l: 60, r: 14, t: 34, b: 46 }, paper_bgcolor: colour("--paper"),
    plot_bgcolor: colour("--paper"), font: { color: colour("--ink"), size: 12 }, showlegend: false,
    hovermode: "closest", xaxis: axis(x, "bottom"), yaxis: axis(y, "left") }, more);
}

function stretches() {
  if (data.border) return [{ stable: true, from: 0, to: count - 1 }];
  const found = [];
  for (let k = 0; k + 1 < count; k++) {
    const stable = data.points[k].stable && data.points[k + 1].stable || (data.points[k].stable && !!data.points[k + 1].label)
      || (data.points[k + 1].stable && !!data.points[k].label);
    const open = found[found.length - 1];
    if (open && open.stable === stable) open.to = k + 1; else found.push({ stable, from: k, to: k + 1 });
  }
  return found;
}

function heights() {
  const k = find("output").selectedIndex;
  return data.points.map(p => p.heights[k]);
}

// What stands at a special point; one with a note, as of what is proven, has a tick.
function written(p) { return `${p.label}${p.note ? " ✓" : ""}`.trim(); }

// Which texts are written: those that are not too near to another one. Axes are longer than what is drawn on them.
function apart(places, x, y) {
  const span = values => 1.25 * (Math.max(...values) - Math.min(...values)) || 1;
  const box = find("branch").getBoundingClientRect(), across = (box.width - 80) / span(x), up = (box.height - 90) / span(y);
  const kept = [];
  return places.map(([a, b]) => {
    const free = kept.every(([c, d]) => Math.abs(a - c) * across > 22 || Math.abs(b - d) * up > 15);
    if (free) kept.push([a, b]);
    return free;
  });
}

function drawBranch() {
  const x = data.points.map(p => p.at), y = heights(), q = data.heights[find("output").selectedIndex];
  const curve = data.curves ? data.curves[find("output").selectedIndex] : [x, y], parts = data.curves ? data.parts : 1;
  const traces = stretches().map(s => ({ x: curve[0].slice(parts * s.from, parts * s.to + 1),
    y: curve[1].slice(parts * s.from, parts * s.to + 1), mode: "lines", hoverinfo: "skip",
    line: { color: colour("--one"), width: 2.4, shape: data.curves ? "linear" : "spline", smoothing: 0.7, dash: s.stable ? "solid" : "dash" } }));
  traces.push({ x, y, mode: "markers", marker: { size: 14, color: "rgba(0,0,0,0)" },
    hovertemplate: "%{x:.6g}, %{y:.5g}<extra></extra>" });
  const special = data.points.map((p, k) => k).filter(k => written(data.points[k]))
    .filter(k => !data.points[k].label.startsWith("peak of ") || data.points[k].label === "peak of " + q.name);
  traces.push({ x: special.map(k => x[k]), y: special.map(k => y[k]), mode: "markers+text",
    text: special.map(k => plain(written(data.points[k]))), textposition: "top center", cliponaxis: false,
    textfont: { color: colour("--mark") }, hoverinfo: "skip", marker: { size: special.map(k => data.points[k].note ? 11 : 8),
      symbol: special.map(k => data.points[k].note ? "diamond" : "circle"), color: colour("--mark") } });
  traces.push({ x: [x[here]], y: [y[here]], mode: "markers", hoverinfo: "skip",
    marker: { size: 15, color: "rgba(0,0,0,0)", line: { color: colour("--ink"), width: 2.5 } } });
  const named = apart(special.map(k => [x[k], y[k]]), x, y);
  traces[traces.length - 2].text = special.map((k, i) => named[i] ? plain(written(data.points[k])) : "");
  const height = titled({ name: q.said, unit: q.unit });
  Plotly.react("branch", traces, frame(titled(data.parameter), height, { dragmode: false }), config);
}

function spectrum(values) {
  const found = [];
  for (let n = 1; n <= 20; n++) {
    let a = 0, b = 0;
    for (let k = 0; k < samples; k++) { const t = 2 * Math.PI * n * k / samples; a += values[k] * Math.cos(t); b += values[k] * Math.sin(t); }
    found.push(2 * Math.hypot(a, b) / samples);
  }
  return found;
}

function drawOrbit() {
  const p = data.points[here], pair = data.pairs[find("pair").selectedIndex] || [0, 0];
  const unit = p.period < 1e-3 ? ["µs", 1e6] : p.period < 1 ? ["ms", 1e3] : ["s", 1];
  const t = Array.from({ length: samples + 1 }, (_, k) => k / samples * p.period * unit[1]);
  const u = signal(here, pair[0]), v = signal(here, pair[1]), first = data.signals[pair[0]], second = data.signals[pair[1]];
  const line = { color: colour("--one"), width: 2 }, dot = { size: 11, color: colour("--bad") };
  Plotly.react("time", [{ x: t, y: closed(u), mode: "lines", line }, { x: [t[turn]], y: [u[turn]], mode: "markers", marker: dot }],
    frame(`time (${unit[0]}), one period`, titled(first)), config);
  Plotly.react("phase", [{ x: closed(u), y: closed(v), mode: "lines", line }, { x: [u[turn]], y: [v[turn]], mode: "markers", marker: dot }],
    frame(titled(first), titled(second)), config);
  const spectral = frame("harmonic of the period", `amplitude of ${titled(first)}`);
  spectral.yaxis.type = "log"; spectral.yaxis.exponentformat = "power";
  Plotly.react("spectrum", [{ x: spectrum(u).map((_, k) => k + 1), y: spectrum(u), type: "bar", marker: { color: colour("--one") } }], spectral, config);
  const round = Array.from({ length: 181 }, (_, k) => k * Math.PI / 90);
  const m = p.multipliers.filter(z => z[0] !== null && z[1] !== null);
  const unstable = m.map(z => Math.hypot(z[0], z[1]) > 1);
  const name = p.equilibrium ? "eigenvalues (1/s)" : "Floquet multipliers";
  const circle = p.equilibrium ? [] : [{ x: round.map(Math.cos), y: round.map(Math.sin), mode: "lines", hoverinfo: "skip", line: { color: colour("--soft"), width: 1.2 } }];
  const layout = frame(`real part, ${name}`, "imaginary part");
  if (!p.equilibrium) layout.yaxis.scaleanchor = "x";
  Plotly.react("circle", [...circle, { x: m.map(z => z[0]), y: m.map(z => z[1]), mode: "markers",
    marker: { size: 10, color: unstable.map(b => b ? colour("--bad") : colour("--one")) } }], layout, config);
}

function tell() {
  const p = data.points[here], k = find("output").selectedIndex, q = data.heights[k];
  const size = `${q.said} ${p.heights[k]}`;
  const largest = p.multipliers.length ? Math.max(...p.multipliers.map(z => Math.hypot(z[0] ?? 0, z[1] ?? 0))) : null;
  find("said").replaceChildren();
  const said = [`${data.parameter.name} ${Number(p.at.toPrecision(9))} ${data.parameter.unit}`.trim(), `${size} ${q.unit}`.trim(),
    p.stable ? "stable" : "unstable"];
  if (!p.equilibrium && largest !== null) said.push(`largest multiplier ${largest.toPrecision(5)}`);
  if (p.label) { const mark = document.createElement("b"); mark.textContent = `${p.label}  `; find("said").append(mark); }
  if (p.note) said.push(`✓ ${p.note}`);
  find("said").append(said.join(" · "));
}

function go(k) {
  here = Math.max(0, Math.min(count - 1, k));
  find("place").value = here;
  const traces = find("branch").data.length;
  Plotly.restyle("branch", { x: [[data.points[here].at]], y: [[heights()[here]]] }, [traces - 1]);
  drawOrbit(); drawSystem(); tell();
}

function length(place) {
  const d = data.drawing, valued = ([name, factor]) => factor * (Object.hasOwn(d.signals, name)
    ? signal(here, d.signals[name][0])[turn] * d.signals[name][1] : d.numbers[name][here]);
  return place.fixed + d.magnified * place.moved.map(valued).reduce((a, b) => a + b, 0);
}

function element(kind, attributes, text = "") {
  const made = document.createElementNS(find("drawing").querySelector("svg").namespaceURI, kind);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.textContent = text;
  return made;
}

function shape(s, theta) {
  const size = length(s.size), angle = s.start + s.turn * theta, look = s.look;
  const x = length(s.x) + s.arm * Math.cos(angle), y = -length(s.y) - s.arm * Math.sin(angle);
  if (s.kind === "ring") return [element("circle", { class: "fixed", cx: x, cy: y, r: size + 0.06, "stroke-width": 0.12 })];
  if (s.kind === "block") {
    const block = element("rect", { class: look, x: x - size, y: y - 0.7 * size, width: 2 * size, height: 1.4 * size, rx: 0.03 });
    return look === "body" ? [block, element("text", { x, y: y + 0.06, "text-anchor": "middle" }, s.of[0])] : [block];
  }
  if (s.kind === "wall") return [element("rect", { class: "wall", x: size > 0 ? x : x - 0.14, y: y - 0.5, width: 0.14, height: 1 })];
  if (s.kind === "line") {
    const many = s.nodes.length, step = Math.floor(turn / samples * 32), at = (here * many) * 32 + step;
    const places = s.nodes.map((_, k) => [x - 1 + 2 * k / (many - 1), y - data.drawing.magnified * s.bent[at + 32 * k]]);
    const beam = element("path", { d: `M${places.map(p => p.join(" ")).join("L")}`, class: "beam" });
    return [beam, ...places.map(([cx, cy]) => element("circle", { class: "body", r: 0.03, cx, cy }))];
  }
  if (!s.waves) {
    const disc = element("circle", { class: look, cx: x, cy: y, r: size });
    if (!s.turn || s.arm) return [disc];
    return [disc, element("path", { d: `M${x} ${y}l${size * Math.cos(angle)} ${-size * Math.sin(angle)}`, stroke: "currentColor" })];
  }
  const many = Math.min(10 * s.waves + 60, 1600), depth = length(s.depth);
  const rim = Array.from({ length: many }, (_, k) => {
    const at = 2 * Math.PI * k / many, r = size + depth * Math.sin(s.waves * (Math.PI / 2 - at) + theta);
    return `${(x + r * Math.cos(at)).toFixed(4)} ${(y - r * Math.sin(at)).toFixed(4)}`;
  });
  return [element("path", { class: look, d: `M${rim.join("L")}Z` })];
}

function drawSystem() {
  const d = data.drawing;
  if (!d) return;
  const theta = 2 * Math.PI * data.points[here].periods * turn / samples, order = ["film", "fixed", "body", "mark"];
  const shown = [...d.shapes].sort((a, b) => order.indexOf(a.look) - order.indexOf(b.look));
  const wide = s => s.kind === "line" ? 1.3 : Math.min(Math.abs(s.size.fixed), 1) + 0.6;  // of large discs the place where they touch
  const left = Math.min(...d.shapes.map(s => s.x.fixed - wide(s))), right = Math.max(...d.shapes.map(s => s.x.fixed + wide(s)));
  const top = Math.max(...d.shapes.map(s => Math.abs(s.size.fixed) < 1 && s.kind !== "ring" ? 0.9 : 1.45));
  const bar = element("path", { class: "bar", d: `M${left + 0.1} ${top - 0.06}h${d.bar.length}` });
  const long = element("text", { x: left + 0.1, y: top - 0.13 }, d.bar.text);
  const box = find("drawing").querySelector("svg");
  box.setAttribute("viewBox", `${left} ${-top} ${right - left} ${2 * top}`);
  box.replaceChildren(...shown.flatMap(s => shape(s, theta)), bar, long);
}

function all() { drawBranch(); drawOrbit(); drawSystem(); tell(); }

function tick(now) {
  if (!moving) return;
  if (now - last > 40) {
    last = now; turn = (turn + 1) % samples;
    const p = data.points[here], pair = data.pairs[find("pair").selectedIndex] || [0, 0];
    const unit = p.period < 1e-3 ? 1e6 : p.period < 1 ? 1e3 : 1, u = signal(here, pair[0]), v = signal(here, pair[1]);
    Plotly.restyle("time", { x: [[turn / samples * p.period * unit]], y: [[u[turn]]] }, [1]);
    Plotly.restyle("phase", { x: [[u[turn]]], y: [[v[turn]]] }, [1]);
    drawSystem();
  }
  requestAnimationFrame(tick);
}

find("stop").textContent = `${count} points; ${data.stop}`;
find("place").max = count - 1;
find("drawing").hidden = !data.drawing;
document.querySelector("main").classList.toggle("drawn", !!data.drawing);
data.heights.forEach(q => find("output").add(new Option(titled({ name: q.said, unit: q.unit }))));
data.pairs.forEach(([a, b]) => find("pair").add(new Option(`${data.signals[a].name}, ${data.signals[b].name}`)));
find("output").addEventListener("change", all);
find("pair").addEventListener("change", drawOrbit);
find("place").addEventListener("input", e => go(+e.target.value));
find("play").addEventListener("click", () => { moving = !moving; find("play").textContent = moving ? "Hold" : "Move"; find("play").setAttribute("aria-pressed", moving); requestAnimationFrame(tick); });
document.addEventListener("keydown", e => {
  if (e.target.tagName === "SELECT" || e.target.type === "range") return;
  const step = { ArrowRight: 1, ArrowLeft: -1, PageUp: 10, PageDown: -10, Home: -count, End: count }[e.key];
  if (step) { go(here + step); e.preventDefault(); }
});
all();
function nearest(event, reach) {
  const { xaxis, yaxis } = find("branch")._fullLayout, box = find("branch").getBoundingClientRect(), y = heights();
  const px = event.clientX - box.left - xaxis._offset, py = event.clientY - box.top - yaxis._offset;
  const away = data.points.map((p, k) => y[k] === null ? Infinity : Math.hypot(xaxis.d2p(p.at) - px, yaxis.d2p(y[k]) - py));
  const k = away.indexOf(Math.min(...away));
  if (away[k] <= reach && k !== here) go(k);
}
// A pen and a finger, or a pressed button, lead from anywhere; a mouse that passes leads near the curve.
find("branch").addEventListener("pointerdown", e => nearest(e, Infinity));
find("branch").addEventListener("pointermove", e => nearest(e, e.pointerType === "mouse" && !e.buttons ? 30 : Infinity));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", all);
