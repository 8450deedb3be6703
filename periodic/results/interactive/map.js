const [across, up] = data.axes;
let at = [0, 0];

function shown() { return data.numbers[find("number").selectedIndex]; }
function value() { return up ? shown().values[at[1]][at[0]] : shown().values[at[0]]; }

function draw() {
  const q = shown(), axis = title => ({ title: { text: plain(title), standoff: 8 }, gridcolor: colour("--line"), zeroline: false, automargin: true });
  const field = up ? { type: "heatmap", x: across.values, y: up.values, z: q.values, colorscale: "Viridis", hoverinfo: "none",
    colorbar: { title: { text: plain(titled(q)), side: "right" } } } : { x: across.values, y: q.values, mode: "lines+markers", line: { color: colour("--one") }, hoverinfo: "none" };
  const here = { x: [across.values[at[0]]], y: [up ? up.values[at[1]] : value()], mode: "markers", hoverinfo: "skip",
    marker: { size: 15, color: "rgba(0,0,0,0)", line: { color: up ? "#fff" : colour("--ink"), width: 2.5 } } };
  Plotly.react("branch", [field, here], { margin: { l: 60, r: 14, t: 20, b: 46 }, paper_bgcolor: colour("--paper"), showlegend: false,
    plot_bgcolor: colour("--paper"), font: { color: colour("--ink"), size: 12 }, dragmode: false, xaxis: axis(titled(across)),
    yaxis: axis(up ? titled(up) : titled(q)) }, config);
}

function go(i, j) {
  at = [Math.max(0, Math.min(across.values.length - 1, i)), up ? Math.max(0, Math.min(up.values.length - 1, j)) : 0];
  Plotly.restyle("branch", { x: [[across.values[at[0]]]], y: [[up ? up.values[at[1]] : value()]] }, [1]);
  tell();
}

function tell() {
  const said = data.axes.map((a, k) => `${a.name} ${a.values[at[k]]} ${a.unit}`.trim()), v = value();
  find("said").textContent = [...said, v === null ? `${shown().name}: none` : `${shown().name} ${v} ${shown().unit}`.trim()].join(" · ");
}

function nearest(values, there) { const away = values.map(v => Math.abs(v - there)); return away.indexOf(Math.min(...away)); }

function pointed(event) {
  const { xaxis, yaxis } = find("branch")._fullLayout, box = find("branch").getBoundingClientRect();
  const x = xaxis.p2d(event.clientX - box.left - xaxis._offset), y = yaxis.p2d(event.clientY - box.top - yaxis._offset);
  go(nearest(across.values, x), up ? nearest(up.values, y) : 0);
}

data.numbers.forEach(q => find("number").add(new Option(titled(q))));
find("number").addEventListener("change", () => { draw(); tell(); });
find("branch").addEventListener("pointerdown", pointed);
find("branch").addEventListener("pointermove", pointed);
document.addEventListener("keydown", e => {
  if (e.target.tagName === "SELECT") return;
  const step = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
  if (step) { go(at[0] + step[0], at[1] + step[1]); e.preventDefault(); }
});
draw(); tell();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
