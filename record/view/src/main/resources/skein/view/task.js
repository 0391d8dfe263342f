// Work that is no flight: how far it is, its curves and its map, as they grow.
/* global uPlot */

const names = ["progress", "curve", "landscape"];
const shades = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

export class Task {
  constructor(section) {
    this.section = section;
    this.clear();
  }

  clear() {
    this.parts = new Map();
    this.section.replaceChildren();
    document.body.classList.remove("task");
  }

  /** Takes a message of one of its topics; says whether it was. */
  row(name, row) {
    if (!names.includes(name)) return false;
    document.body.classList.add("task");
    const key = `${name} ${row.title}`;
    if (!this.parts.has(key)) {
      const place = document.createElement("div");
      place.className = name;
      this.section.append(place);
      this.parts.set(key, { place });
    }
    this[name](this.parts.get(key), row);
    return true;
  }

  progress({ place }, { title, done, expected, unit, line }) {
    const share = Math.min(1, done / Math.max(1, expected));
    const bar = Object.assign(document.createElement("progress"), { max: 1, value: share });
    const words = `${(100 * share).toFixed(1)} %, ${done.toLocaleString("en")} of about ${expected.toLocaleString("en")} ${unit}`;
    place.replaceChildren(heading(title), bar, paragraph(words), paragraph(line));
  }

  curve(part, { title, x, y, points }) {
    const columns = [points.map(point => point[0]), points.map(point => point[1])];
    if (part.plot) { part.plot.setData(columns); return; }
    part.place.replaceChildren(heading(title));
    const axis = label => ({ label, stroke: "#667085", grid: { stroke: "#eef1f5" }, font: "10px sans-serif", labelFont: "11px sans-serif" });
    part.plot = new uPlot({
      width: part.place.clientWidth - 20, height: 300, legend: { show: false }, cursor: { show: false },
      scales: { x: { time: false } }, axes: [axis(x), { ...axis(y), size: 64 }],
      series: [{}, { stroke: "#1f6fb2", width: 2, paths: uPlot.paths.stepped({ align: 1 }), points: { show: false } }],
    }, columns, part.place);
  }

  landscape({ place }, { title, x, y, rows }) {
    const known = rows.flat().filter(value => value !== null);
    const [least, most] = [Math.min(...known), Math.max(...known)];
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [x.values.length, y.values.length];
    const pen = canvas.getContext("2d");
    rows.forEach((row, up) => row.forEach((value, across) => {
      if (value === null) return;
      pen.fillStyle = shade((value - least) / (most - least || 1));
      pen.fillRect(across, y.values.length - 1 - up, 1, 1);
    }));
    const range = values => `${brief(values[0])} … ${brief(values.at(-1))}`;
    const legend = known.length ? `dark ${brief(least)}, light ${brief(most)}; ` : "";
    place.replaceChildren(heading(title), canvas, paragraph(
      `${legend}across: ${x.name}, ${range(x.values)}; upwards: ${y.name}, ${range(y.values)}; ${known.length} of ${x.values.length * y.values.length} cells`));
  }
}

const heading = text => Object.assign(document.createElement("h2"), { textContent: text });
const paragraph = text => Object.assign(document.createElement("p"), { textContent: text });
const brief = value => Number(value.toPrecision(4)).toString();

function shade(share) {
  const place = Math.max(0, Math.min(1, share)) * (shades.length - 1), at = Math.min(shades.length - 2, Math.floor(place));
  return `rgb(${shades[at].map((one, part) => Math.round(one + (shades[at + 1][part] - one) * (place - at))).join(",")})`;
}
