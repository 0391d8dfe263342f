// Plots of the last half minute, as the flight grows.
/* global uPlot */

const kinds = [
  { series: "age", title: "Age of a vehicle's own data at its decisions, ms" },
  { series: "roundTrip", title: "Round trips, ms" },
  { series: "error", title: "Error of predictions, mm" },
  { series: "distance", title: "Smallest distance between two vehicles, m", single: true },
];

export class Plots {
  constructor(place) {
    this.place = place;
    this.plots = [];
    this.names = undefined;
  }

  draw(flight) {
    const lines = flight.lines();
    const shown = kinds.filter(kind => flight.series[kind.series].buckets.length);
    this.place.hidden = !shown.length;
    const key = JSON.stringify([shown.map(kind => kind.series), lines.map(line => line.name), this.place.clientWidth]);
    if (key !== this.names) {
      this.names = key;
      this.build(shown, lines);
    }
    for (const { plot, kind, count } of this.plots) {
      plot.setData(flight.series[kind.series].columns(count), false);
      plot.setScale("x", { min: Math.max(0, flight.now - 30), max: Math.max(5, flight.now) });
    }
  }

  build(shown, lines) {
    for (const { plot } of this.plots) plot.destroy();
    const height = Math.floor((this.place.clientHeight - 20) / Math.max(shown.length, 1)) - 34;
    this.plots = shown.map(kind => {
      const own = kind.single ? [{ name: "nearest", colour: "#344054" }] : lines;
      const plot = new uPlot({
        title: kind.title, width: this.place.clientWidth - 20, height, legend: { show: false }, cursor: { show: false }, pxAlign: 0,
        scales: { x: { time: false, auto: false }, y: { range: (plot, low, high) => [0, Math.max(high ?? 1, 0.1) * 1.1] } },
        axes: [
          { stroke: "#667085", grid: { stroke: "#eef1f5" }, size: 26, font: "10px sans-serif", values: (plot, all) => all.map(value => `${value} s`) },
          { stroke: "#667085", grid: { stroke: "#eef1f5" }, size: 42, space: Math.max(16, height / 8), font: "10px sans-serif" },
        ],
        series: [{}, ...own.map(line => ({ label: line.name, stroke: line.colour, width: 1.5, spanGaps: true, points: { show: false } }))],
      }, [[], ...own.map(() => [])], this.place);
      return { plot, kind, count: own.length };
    });
  }
}
