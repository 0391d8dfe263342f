// What is known of one flight: from rows, in their order. Times are seconds since it began; before that, since its first row.

const trailS = 20, trailEveryS = 0.1, bucketS = 0.1, windowS = 30, mostEvents = 200, mostLines = 6;

const colours = ["#d1495b", "#1f6fb2", "#2a9d5c", "#b8860b", "#7b4fa3", "#0f8b8d", "#c1666b", "#4d648d"];

export class Flight {
  constructor() {
    this.heading = undefined;
    this.startNs = undefined;
    this.hasBegun = false;
    this.now = 0;
    this.vehicles = new Map();
    this.events = [];
    this.eventCount = 0;
    this.ending = undefined;
    this.paused = false;
    this.series = { age: new Series(), commandAge: new Series(), every: new Series(), unanswered: new Series(), error: new Series(), distance: new Series(), roundTrip: new Series(), altitude: new Series(Math.min) };
    // What the scenario draws, and what it forbids.
    this.own = [];
    this.limits = [];
    this.obstacles = [];
    this.clouds = new Map();
  }

  seconds(ns) {
    this.startNs ??= ns;
    return Number(ns - this.startNs) / 1e9;
  }

  /** It began at this time, which may be told late. */
  begin(ns) {
    const by = this.startNs === undefined ? 0 : Number(this.startNs - ns) / 1e9;
    this.startNs = ns;
    this.hasBegun = true;
    if (by === 0) return;
    this.now += by;
    for (const series of Object.values(this.series)) for (const bucket of series.buckets) bucket.time += by;
    for (const event of this.events) event.at += by;
    for (const vehicle of this.vehicles.values()) {
      for (const point of vehicle.trail) point[0] += by;
      for (const key of ["at", "decided"]) if (vehicle[key] !== undefined) vehicle[key] += by;
    }
  }

  /** Takes a row of one of the recording's tables. */
  row(table, row, logNs) {
    const at = this.seconds(logNs);
    const vehicle = row.vehicle === undefined ? undefined : this.vehicle(row.vehicle);
    switch (table) {
      case "flight": this.heading = row; break;
      case "vehicle": Object.assign(this.vehicle(row.name), { role: row.role }); break;
      // Vehicles come before parameters.
      case "parameter": if (row.name.startsWith("kind.")) this.vehicle(row.name.slice(5)).kind = row.value; break;
      case "reading": {
        if (vehicle.at !== undefined && at < vehicle.at) break;
        vehicle.at = at;
        vehicle.north = row.positionNorthM; vehicle.east = row.positionEastM; vehicle.down = row.positionDownM;
        vehicle.velocityNorth = row.velocityNorthMps; vehicle.velocityEast = row.velocityEastMps;
        // The last point moves until the next is due.
        if (vehicle.trail.length > 1 && at - vehicle.trail.at(-2)[0] < trailEveryS) vehicle.trail.pop();
        vehicle.trail.push([at, vehicle.north, vehicle.east]);
        while (vehicle.trail.length && vehicle.trail[0][0] < at - trailS) vehicle.trail.shift();
        this.series.altitude.put(at, this.line(vehicle), -vehicle.down);
        // What a simulator shows of itself made no trip.
        if (row.receivedAtNs > row.sentAtNs) this.series.roundTrip.put(at, this.line(vehicle), (row.receivedAtNs - row.sentAtNs) / 1e6);
        this.measure(at);
        break;
      }
      case "decision":
        vehicle.decided = at;
        vehicle.heading = row.headingRad;
        vehicle.predicted = row.actsAtNs === undefined ? undefined
          : { north: row.ownPredictedPositionNorthM, east: row.ownPredictedPositionEastM };
        vehicle.ageMs = row.ownTrueAgeMs ?? row.ownAgeMs;
        this.series.age.put(at, this.line(vehicle), vehicle.ageMs);
        break;
      case "command":
        vehicle.command = { north: row.velocityNorthMps, east: row.velocityEastMps };
        break;
      case "plan":
        vehicle.plan = row.courseNorthM && { north: row.courseNorthM, east: row.courseEastM, stepS: row.courseStepMs / 1000, at };
        break;
      case "prediction":
        // The circle is round the vehicle's own prediction.
        if (row.decider === row.vehicle) vehicle.errorM = row.errorM;
        this.series.error.put(at, this.line(vehicle), row.errorM === undefined ? undefined : row.errorM * 1000);
        break;
      case "event":
        this.eventCount++;
        this.events.unshift({ at, kind: row.kind, vehicle: row.vehicle ?? "", detail: row.detail });
        this.events.length = Math.min(this.events.length, mostEvents);
        if (row.kind === "Paused" || row.kind === "Continued") this.paused = row.kind === "Paused";
        break;
      // It stands still from here on, whatever comes.
      case "ending": this.ending = row; this.now = at; break;
      case "clock": this.begin(BigInt(row.startedAtNs)); break;
      // Of a program that is seen from outside: the worst of each vehicle's commands, and what is wrong.
      case "observed":
        this.hasBegun = true;
        this.findings = row.findings;
        for (const { vehicle: name, ageMs, everyMs, unanswered } of row.vehicles) {
          const commanded = this.vehicle(name);
          commanded.ageMs = ageMs;
          const line = this.line(commanded);
          this.series.commandAge.put(at, line, ageMs);
          this.series.every.put(at, line, everyMs);
          this.series.unanswered.put(at, line, unanswered);
        }
        break;
      case "scenario":
        row.series.forEach(({ title, bound, points }, index) => {
          this.own[index] = { series: `own${index}`, title, bound, single: true };
          const series = this.series[`own${index}`] ??= new Series();
          // The last point is of now; all count seconds.
          for (const [time, value] of points) series.put(at - (points.at(-1)[0] - time), 0, value);
        });
        this.limits = row.limits;
        this.failed = row.failed;
        break;
    }
  }

  /** Takes what stands in the world: a foxglove.SceneUpdate. */
  scene({ entities }) { this.obstacles = entities.flatMap(({ cubes, cylinders }) => [...cubes.map(footprint), ...cylinders.map(disc)]); }

  /** The smallest distance between any two. */
  measure(at) {
    const placed = [...this.vehicles.values()].filter(vehicle => vehicle.north !== undefined);
    let nearest = Infinity;
    for (let i = 0; i < placed.length; i++)
      for (let j = i + 1; j < placed.length; j++)
        nearest = Math.min(nearest, Math.hypot(placed[i].north - placed[j].north, placed[i].east - placed[j].east, placed[i].down - placed[j].down));
    if (nearest < Infinity) {
      this.nearestM = nearest;
      this.series.distance.put(at, 0, nearest);
    }
  }

  /** A jump to an earlier time forgets what came later. */
  rewind(at) {
    for (const vehicle of this.vehicles.values()) {
      vehicle.trail = vehicle.trail.filter(point => point[0] <= at);
      vehicle.at = vehicle.plan = undefined;
    }
    for (const series of Object.values(this.series)) series.cut(at);
    this.events = this.events.filter(event => event.at <= at);
    this.eventCount = this.events.length;
    this.paused = this.events.find(event => event.kind === "Paused" || event.kind === "Continued")?.kind === "Paused";
    this.ending = undefined;
    this.clouds.clear();
  }

  vehicle(name) {
    if (!this.vehicles.has(name)) {
      const index = this.vehicles.size;
      this.vehicles.set(name, { name, index, colour: colours[index % colours.length], trail: [] });
    }
    return this.vehicles.get(name);
  }

  /** Few vehicles have a line each, many share one, of the worst. */
  line(vehicle) { return this.vehicles.size > mostLines ? 0 : vehicle.index; }

  lines() {
    const all = [...this.vehicles.values()];
    return all.length > mostLines ? [{ name: "worst", colour: colours[0] }] : all;
  }
}

const paint = ({ r, g, b }) => `${Math.round(r * 255)},${Math.round(g * 255)},${Math.round(b * 255)}`;

function disc({ pose: { position }, size, color }) {
  return { north: position.x, east: position.y, reach: size.x / 2, rgb: paint(color) };
}

/** A box from above: the hull of its corners. */
function footprint({ pose: { position, orientation: { x, y, z, w } }, size, color }) {
  const corners = [];
  for (const f of [-size.x / 2, size.x / 2]) for (const r of [-size.y / 2, size.y / 2]) for (const d of [-size.z / 2, size.z / 2]) corners.push([
    position.x + (1 - 2 * (y * y + z * z)) * f + 2 * (x * y - w * z) * r + 2 * (x * z + w * y) * d,
    position.y + 2 * (x * y + w * z) * f + (1 - 2 * (x * x + z * z)) * r + 2 * (y * z - w * x) * d,
  ]);
  corners.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = points => {
    const hull = [];
    for (const [n, e] of points) {
      while (hull.length > 1) {
        const [[n0, e0], [n1, e1]] = hull.slice(-2);
        if ((n1 - n0) * (e - e0) - (e1 - e0) * (n - n0) > 1e-9) break;
        hull.pop();
      }
      hull.push([n, e]);
    }
    return hull.slice(0, -1);
  };
  return {
    north: position.x, east: position.y, reach: Math.hypot(size.x, size.y, size.z) / 2,
    corners: [...half(corners), ...half(corners.reverse())], rgb: paint(color),
  };
}

/** The largest value of each line in each tenth of a second, or the least, for some time back. */
class Series {
  constructor(pick = Math.max) { this.buckets = []; this.pick = pick; }

  put(at, line, value) {
    if (value === undefined) return;
    const time = Math.floor(at / bucketS) * bucketS;
    let last = this.buckets.length - 1;
    while (last >= 0 && this.buckets[last].time > time + 1e-6) last--;
    if (last < 0 || this.buckets[last].time < time - 1e-6) this.buckets.splice(++last, 0, { time, values: [] });
    const values = this.buckets[last].values;
    values[line] = this.pick(values[line] ?? value, value);
    while (this.buckets[0].time < at - windowS) this.buckets.shift();
  }

  cut(at) { this.buckets = this.buckets.filter(bucket => bucket.time <= at); }

  /** As uPlot wants it: times, then the values of each line. */
  columns(lines) {
    const columns = [this.buckets.map(bucket => bucket.time)];
    for (let line = 0; line < lines; line++) columns.push(this.buckets.map(bucket => bucket.values[line] ?? null));
    return columns;
  }
}
