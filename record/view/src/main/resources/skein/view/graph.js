// The control graph as it runs: its parts and what leads where come from the interpreter, the numbers from its meters.

const letter = 6.4, high = 26, columnGap = 82, rowGap = 18, margin = 14;

const svg = (name, attributes, text) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
};

export class Graph {
  constructor(section) {
    this.section = section;
    this.place = section.querySelector("div");
    this.title = section.querySelector("h2");
    this.key = undefined;
    this.before = undefined;
  }

  /** @param graph stages {name, column, row, entered, passed, unanswered, ageMs} and edges {from, to}; counts since the start.
   *    Where each vehicle has a controller, the name of the one whose graph it is
   *  @param at seconds */
  draw(graph, at) {
    this.section.hidden = graph.stages.length === 0;
    if (this.section.hidden) return;
    this.title.textContent = graph.controller
      ? `The control graph of ${graph.controller}'s controller as it runs; each vehicle has one` : "The control graph as it runs";
    const key = JSON.stringify([graph.stages.map(stage => stage.name), graph.edges]);
    if (key !== this.key) {
      this.key = key;
      this.before = undefined;
      this.build(graph);
    }
    if (this.before && at > this.before.at) this.tell(graph, at - this.before.at);
    if (!this.before || at - this.before.at >= 0.9) this.before = { at, stages: new Map(graph.stages.map(stage => [stage.name, stage])) };
  }

  build({ stages, edges }) {
    const spots = place(stages);
    const right = Math.max(...[...spots.values()].map(spot => spot.x + spot.wide)) + margin;
    const bottom = Math.max(...[...spots.values()].map(spot => spot.y)) + high + margin + 26;
    const root = svg("svg", { viewBox: `0 0 ${right} ${bottom}`, width: right, height: bottom, "font-family": "sans-serif", "font-size": 11 });
    // Where several come together, each has its label where it begins.
    const meets = edge => edges.filter(other => other.to === edge.to && spots.get(other.from).x < spots.get(other.to).x).length > 1;
    this.labels = new Map();
    this.boxes = new Map();
    edges.forEach((edge, number) => {
      const from = spots.get(edge.from), to = spots.get(edge.to), back = to.x <= from.x;
      const [x0, y0, x1, y1] = [from.x + from.wide, from.y + high / 2, to.x, to.y + high / 2];
      const path = back
        ? `M${from.x + from.wide / 2},${from.y + high} V${bottom - 12} H${to.x + to.wide / 2} V${to.y + high + 5}`
        : `M${x0},${y0} C${x0 + 30},${y0} ${x1 - 34},${y1} ${x1 - 5},${y1}`;
      root.append(svg("path", { d: path, fill: "none", stroke: back ? "#b8860b" : "#98a2b3", "stroke-width": 1.3 }));
      root.append(back
        ? svg("path", { d: `M${to.x + to.wide / 2},${to.y + high} l-4,7 h8 z`, fill: "#b8860b" })
        : svg("path", { d: `M${x1},${y1} l-7,-4 v8 z`, fill: "#98a2b3" }));
      const place = back
        ? { x: (from.x + to.x + to.wide) / 2, y: bottom - 16, "text-anchor": "middle" }
        : meets(edge) ? { x: x0 + 4, y: y0 - 5 } : { x: x1 - 9, y: y1 - 5, "text-anchor": "end" };
      const edged = { fill: "#667085", "font-size": 10, stroke: "#fff", "stroke-width": 3, "paint-order": "stroke" };
      this.labels.set(number, svg("text", { ...place, ...edged }, ""));
    });
    // Above all lines, some of which curve through their places.
    root.append(...this.labels.values());
    for (const { name } of stages) {
      const { x, y, wide } = spots.get(name);
      const box = svg("rect", { x, y, width: wide, height: high, rx: 5, fill: "#fff", stroke: "#475467", "stroke-width": 1.2 });
      const words = svg("text", { x: x + wide / 2, y: y + high / 2 + 4, "text-anchor": "middle", fill: "#1d2430" }, name);
      const waits = svg("text", { x: x + wide - 4, y: y + high + 10, "text-anchor": "end", fill: "#b54708", "font-size": 9 }, "");
      this.boxes.set(name, waits);
      root.append(box, words, waits);
    }
    this.place.replaceChildren(root);
  }

  tell({ stages, edges }, seconds) {
    const now = new Map(stages.map(stage => [stage.name, stage]));
    const rate = (name, count) => {
      const [was, is] = [this.before.stages.get(name)?.[count], now.get(name)[count]];
      return is ? (is - (was ?? 0)) / seconds : undefined;
    };
    const rates = new Map();
    // What a part without a meter passes on is what comes to it.
    const leaving = (name, seen) => {
      const coming = edges.filter(edge => edge.to === name);
      return rate(name, "passed") ?? (seen.has(name) ? 0 : !coming.length ? undefined
        : coming.reduce((sum, edge) => sum + (along(edge, new Set(seen).add(name)) ?? 0), 0));
    };
    const along = (edge, seen) => {
      const key = `${edge.from}→${edge.to}`;
      if (!rates.has(key)) rates.set(key, rate(edge.to, "entered") ?? leaving(edge.from, seen));
      return rates.get(key);
    };
    const age = (name, seen) => now.get(name).ageMs ?? (seen.has(name) ? undefined : Math.max(...edges
      .filter(edge => edge.to === name).map(edge => age(edge.from, new Set(seen).add(name)) ?? -1)));
    edges.forEach((edge, number) => {
      const old = age(edge.from, new Set());
      const passing = along(edge, new Set());
      this.labels.get(number).textContent = passing === undefined ? "" : `${passing.toFixed(0)}/s${old >= 0 ? ` ${old.toFixed(0)} ms` : ""}`;
    });
    for (const [name, waits] of this.boxes) {
      const { unanswered } = now.get(name);
      waits.textContent = unanswered === undefined ? "" : `${unanswered} unanswered`;
    }
  }
}

/** Each column as wide as its longest name. */
function place(stages) {
  const widths = [];
  for (const { name, column } of stages) widths[column] = Math.max(widths[column] ?? 0, name.length * letter + 18);
  const lefts = widths.map((_, column) => margin + widths.slice(0, column).reduce((sum, width) => sum + width + columnGap, 0));
  return new Map(stages.map(({ name, column, row }) =>
    [name, { x: lefts[column], y: margin + row * (high + rowGap), wide: widths[column] }]));
}
