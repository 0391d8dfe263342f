// Plots of the last half minute, as the flight grows.
/* global uPlot */

const kinds = [
  { series: "age", title: "Age of a vehicle's own data at its decisions, ms" },
  { series: "commandAge", title: "Age of a vehicle's own data at its commands, ms" },
  { series: "every", title: "Time since its last command, ms" },
  { series: "unanswered", title: "Calls unanswered when it was commanded" },
  { series: "roundTrip", title: "Round trips, ms" },
  { series: "error", title: "Error of predictions, mm" },
  { series: "distance", title: "Smallest distance between two vehicles, m", single: true },
  { series: "altitude", title: "Altitude, m", many: "Altitude of the lowest vehicle, m" },
];
const leastHeight = 84, wholeHeight = 500, titleHeight = 34;

export class Plots {
  constructor(place) {
    this.place = place;
    this.plots = [];
    this.names = undefined;
  }

  draw(flight) {
    const lines = flight.lines();
    const shown = [...kinds, ...flight.own].filter(kind => flight.series[kind.series].buckets.length);
    this.place.hidden = !shown.length;
    this.altitudes = flight.limits.flatMap(limit => limit.altitudeM ?? []);
    const key = JSON.stringify([shown, this.altitudes, lines.map(line => line.name), this.place.clientWidth]);
    if (key !== this.names) {
      this.names = key;
      this.build(shown, lines);
    }
    for (const { plot, kind, count, bounds } of this.plots) {
      const columns = flight.series[kind.series].columns(count);
      plot.setData([...columns, ...bounds.map(bound => columns[0].map(() => bound))], false);
      plot.setScale("x", { min: Math.max(0, flight.now - 30), max: Math.max(5, flight.now) });
    }
  }

  build(shown, lines) {
    for (const { plot } of this.plots) plot.destroy();
    const height = Math.max(leastHeight, Math.floor(wholeHeight / Math.max(shown.length, 1)) - titleHeight);
    this.plots = shown.map(kind => {
      const own = kind.single ? [{ name: kind.title, colour: "#344054" }] : lines;
      const bounds = kind.series === "altitude" ? this.altitudes : kind.bound ? [kind.bound.value] : [];
      // A bound far away is not shown: it would make all else flat.
      const ends = (low, high) => {
        const [least, most] = [Math.min(low ?? 0, 0), Math.max(high ?? 1, 0.1)];
        const near = bounds.filter(bound => bound <= 2 * most && bound >= 2 * least);
        return [Math.min(least, ...near) * 1.1, Math.max(most, ...near) * 1.1];
      };
      const title = kind.many && lines.length === 1 && lines[0].name === "worst" ? kind.many : kind.title;
      const plot = new uPlot({
        title: kind.bound ? `${title} (dashed: ${kind.bound.name})` : title, width: this.place.clientWidth - 20, height, legend: { show: false }, cursor: { show: false }, pxAlign: 0,
        scales: { x: { time: false, auto: false }, y: { range: (plot, low, high) => ends(low, high) } },
        axes: [
          { stroke: "#667085", grid: { stroke: "#eef1f5" }, size: 26, font: "10px sans-serif", values: (plot, all) => all.map(value => `${value} s`) },
          { stroke: "#667085", grid: { stroke: "#eef1f5" }, size: 42, space: Math.max(16, height / 8), font: "10px sans-serif" },
        ],
        series: [{}, ...own.map(line => ({ label: line.name, stroke: line.colour, width: 1.5, spanGaps: true, points: { show: false } })),
          ...bounds.map(() => ({ label: "limit", stroke: "#c00", width: 1, dash: [5, 4], auto: false, points: { show: false } }))],
      }, [[], ...own.map(() => []), ...bounds.map(() => [])], this.place);
      return { plot, kind, count: own.length, bounds };
    });
  }
}
