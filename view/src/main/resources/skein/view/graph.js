// The control graph as it runs: its parts and what leads where come from the interpreter, the numbers from its meters.

const wide = 112, high = 26, columnGap = 84, rowGap = 18, margin = 14;

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
    this.key = undefined;
    this.before = undefined;
  }

  /** @param graph stages {name, column, row, entered, passed, unanswered, ageMs} and edges {from, to}; counts since the start
   *  @param at seconds */
  draw(graph, at) {
    this.section.hidden = graph.stages.length === 0;
    if (this.section.hidden) return;
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
    const spots = new Map(stages.map(({ name, column, row }) => [name, { x: margin + column * (wide + columnGap), y: margin + row * (high + rowGap) }]));
    const right = Math.max(...[...spots.values()].map(spot => spot.x)) + wide + margin;
    const bottom = Math.max(...[...spots.values()].map(spot => spot.y)) + high + margin + 26;
    const root = svg("svg", { viewBox: `0 0 ${right} ${bottom}`, width: right, height: bottom, "font-family": "sans-serif", "font-size": 11 });
    this.labels = new Map();
    this.boxes = new Map();
    edges.forEach((edge, number) => {
      const from = spots.get(edge.from), to = spots.get(edge.to), back = to.x <= from.x;
      const [x0, y0, x1, y1] = [from.x + wide, from.y + high / 2, to.x, to.y + high / 2];
      const path = back
        ? `M${from.x + wide / 2},${from.y + high} V${bottom - 12} H${to.x + wide / 2} V${to.y + high + 5}`
        : `M${x0},${y0} C${x0 + 30},${y0} ${x1 - 34},${y1} ${x1 - 5},${y1}`;
      root.append(svg("path", { d: path, fill: "none", stroke: back ? "#b8860b" : "#98a2b3", "stroke-width": 1.3 }));
      root.append(back
        ? svg("path", { d: `M${to.x + wide / 2},${to.y + high} l-4,7 h8 z`, fill: "#b8860b" })
        : svg("path", { d: `M${x1},${y1} l-7,-4 v8 z`, fill: "#98a2b3" }));
      const label = svg("text", back
        ? { x: (from.x + to.x + wide) / 2, y: bottom - 16, "text-anchor": "middle", fill: "#667085", "font-size": 10 }
        : { x: x1 - 9, y: y1 - 5, "text-anchor": "end", fill: "#667085", "font-size": 10 }, "");
      this.labels.set(number, label);
      root.append(label);
    });
    for (const { name } of stages) {
      const { x, y } = spots.get(name);
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
    const leaving = (name, seen) => rate(name, "passed") ?? (seen.has(name) ? 0 : edges
      .filter(edge => edge.to === name).reduce((sum, edge) => sum + along(edge, new Set(seen).add(name)), 0));
    const along = (edge, seen) => {
      const key = `${edge.from}→${edge.to}`;
      if (!rates.has(key)) rates.set(key, rate(edge.to, "entered") ?? leaving(edge.from, seen));
      return rates.get(key);
    };
    const age = (name, seen) => now.get(name).ageMs ?? (seen.has(name) ? undefined : Math.max(...edges
      .filter(edge => edge.to === name).map(edge => age(edge.from, new Set(seen).add(name)) ?? -1)));
    edges.forEach((edge, number) => {
      const old = age(edge.from, new Set());
      this.labels.get(number).textContent = `${along(edge, new Set()).toFixed(0)}/s${old >= 0 ? ` ${old.toFixed(0)} ms` : ""}`;
    });
    for (const [name, waits] of this.boxes) {
      const { unanswered } = now.get(name);
      waits.textContent = unanswered === undefined ? "" : `${unanswered} unanswered`;
    }
  }
}
