"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const find = id => document.getElementById(id);
const titled = q => q.unit ? `${q.name} (${q.unit})` : q.name;
const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
// Plotly reads tags, entities and, between dollars, formulae in what it writes; names and units are text.
const config = { displayModeBar: false, responsive: true, typesetMath: false };
const plain = text => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
