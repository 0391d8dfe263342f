import { connect } from "/connection.js";
import { Flight } from "/flight.js";
import { FlightMap } from "/map.js";
import { Graph } from "/graph.js";
import { Plots } from "/plots.js";
import { Cameras, pointsOf } from "/cameras.js";

// Where a graphics card is imitated by software, canvases are drawn several times faster without it.
const gl = document.createElement("canvas").getContext("webgl");
const card = gl?.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER) ?? "none";
if (/none|swiftshader|llvmpipe|software/i.test(card)) {
  const context = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) { return context.call(this, kind, { willReadFrequently: true, ...options }); };
}
gl?.getExtension("WEBGL_lose_context")?.loseContext();

const find = id => document.getElementById(id);
const tables = ["flight", "vehicle", "parameter", "reading", "decision", "command", "prediction", "plan", "event", "ending", "clock", "scenario", "graph", "observed"];
const map = new FlightMap(document.querySelector("#map canvas"));
const plots = new Plots(find("plots"));
const graph = new Graph(find("graph"));
const cameras = new Cameras(find("cameras"));
const isWanted = topic => topic.startsWith("/skein/") ? tables.includes(topic.slice(7)) : topic === "/scene" || /\/(image|cloud)$/.test(topic);

let flight, connection, changed = false, recorded, playing, warnings;

/** What the server lists, the shown one's name, and the name of one that was added since then. */
let flights = [], shown, added;

/** What a test asks the page. */
window.skein = { get flight() { return flight; }, get recorded() { return recorded; }, get playing() { return playing; }, get isConnected() { return connection.isOpen(); }, get cameras() { return [...cameras.cameras.values()]; }, frames: 0 };

function show(id) {
  shown = id;
  added = undefined;
  find("flights").value = id;
  const address = `/flights/${encodeURIComponent(id)}`;
  connection?.close();
  cameras.clear();
  find("graph").hidden = true;
  find("control").hidden = !flights.find(one => one.id === id).controls.length;
  find("control").onsubmit = async event => {
    event.preventDefault();
    const [path, question] = {
      pause: [`${address}/pause`, `Pause ${id}? All its vehicles hover, and nothing is decided until it continues.`],
      continue: [`${address}/continue`, `Let ${id} go on? Its vehicles move.`],
      hover: ["/hover", "Pause all flights? All vehicles hover."],
      abort: [`${address}/abort`, `End ${id} now? All its vehicles hover.`],
    }[event.submitter.id];
    if (!confirm(question)) return;
    const answer = await fetch(path, { method: "POST", headers: { "X-Skein-Token": find("token").value } });
    find("answer").textContent = await answer.text();
  };
  flight = new Flight();
  recorded = playing = undefined;
  warnings = new Map();
  connection = connect(address, isWanted, {
    info(info) {
      flight = new Flight();
      const ns = time => BigInt(time.sec) * 1000000000n + BigInt(time.nsec);
      recorded = info.dataStartTime && { start: ns(info.dataStartTime), end: ns(info.dataEndTime) };
      if (recorded) flight.startNs = recorded.start;
      find("playback").hidden = !recorded;
      state("", false);
    },
    row(topic, row, logNs) {
      if (topic === "/scene") flight.scene(row);
      else if (topic === "/skein/graph") graph.draw(row, flight.seconds(logNs));
      else flight.row(topic.slice(7), row, logNs);
      if (topic === "/skein/clock") told = -1;
      changed = true;
    },
    sight(topic, bytes, logNs) {
      if (topic.endsWith("/cloud")) flight.clouds.set(topic, { points: pointsOf(bytes), colour: flight.vehicle(topic.split("/")[2]).colour });
      else cameras.take(topic, bytes, logNs);
      changed = true;
    },
    time(ns) {
      if (flight.ending) return;
      flight.now = flight.startNs === undefined ? 0 : flight.seconds(ns);
      changed = true;
    },
    playback(now) {
      const at = flight.seconds(now.now);
      if (now.seeked && at < flight.now) flight.rewind(at);
      flight.now = at;
      playing = now;
      find("play").textContent = now.status === "playing" ? "Pause" : "Play";
      changed = true;
    },
    warning(key, text) { warnings.set(key, text); find("lost").textContent = [...warnings.values()].join("; "); },
    // When its flights have ended, a server goes; what the page shows stays.
    closed() {
      if (flight.ending && !recorded) connection.close();
      else state("not connected", true);
    },
  });
}

function state(text, bad) {
  find("state").textContent = text;
  find("state").classList.toggle("bad", bad);
}

let seeking = false;

function draw(at) {
  requestAnimationFrame(draw);
  if (!flight) return;
  if (changed) {
    changed = false;
    stale = true;
    window.skein.frames++;
    map.draw(flight);
  }
  // What came last is drawn, too, when nothing follows.
  if (!stale || at - drawn < 200) return;
  stale = false;
  drawn = at;
  plots.draw(flight);
  words();
}
let stale = false;
let drawn = 0, told = -1;

function words() {
  const { heading } = flight;
  if (heading) find("what").textContent =
    heading.loop === "none" ? `${heading.scenario}, simulator at ${heading.simulator}`
      : `${heading.scenario}, loop ${heading.loop}, link ${heading.link}, ${heading.simulator} simulator, seed ${heading.seed}`;
  find("time").textContent = flight.hasBegun || recorded ? `${flight.now.toFixed(1)} s` : "not begun";
  if (flight.ending) state(`${flight.ending.how}${flight.ending.reason ? `: ${flight.ending.reason}` : ""}`, flight.ending.how === "Failed");
  else if (find("state").textContent !== "not connected") state(flight.paused ? "paused: vehicles hover, nothing is decided" : "", flight.paused);
  find("pause").hidden = flight.paused;
  find("continue").hidden = !flight.paused;
  find("hover").hidden = flights.filter(one => one.controls.includes("pause")).length < 2;
  find("control").classList.toggle("over", Boolean(flight.ending));
  if (recorded && !seeking) {
    find("seek").max = Number(recorded.end - recorded.start) / 1e9;
    find("seek").value = flight.now;
  }
  const vehicles = [...flight.vehicles.values()];
  find("legend").replaceChildren(...(vehicles.length > 8 ? [] : vehicles).map(vehicle => {
    const item = document.createElement("li"), dot = document.createElement("i");
    dot.style.background = vehicle.colour;
    const age = vehicle.ageMs === undefined ? "" : `, ${vehicle.ageMs.toFixed(0)} ms old at its last ${flight.findings ? "command" : "decision"}`;
    const up = vehicle.down === undefined ? "" : `, ${(-vehicle.down).toFixed(1)} m up`;
    item.append(dot, `${vehicle.name}${up}${age}`);
    return item;
  }));
  const signs = [
    [vehicles.some(one => one.predicted), "ring: where its command acts"], [vehicles.some(one => one.command), "arrow: commanded velocity"],
    [vehicles.some(one => one.plan), "dotted: its plan"],
    [flight.clouds.size, "points: what lidars see"],
  ];
  find("signs").textContent = signs.filter(([is]) => is).map(([, words]) => words).join("; ");
  // A program seen from outside has no places.
  find("map").classList.toggle("bare", Boolean(flight.findings));
  find("findings").replaceChildren(...(flight.findings ?? []).map(finding => Object.assign(document.createElement("li"), { textContent: finding })));
  find("limits").hidden = !flight.limits.length && !flight.failed;
  document.querySelector("#limits ul").replaceChildren(...flight.limits.map(limit => {
    const words = limit.stretches
      ? `${limit.text}: broken ${limit.stretches === 1 ? "once" : `${limit.stretches} times`}, worst ${limit.worst} at ${limit.worstAtS.toFixed(1)} s by ${limit.vehicles.join(" and ")}`
      : `${limit.text}: kept so far`;
    return Object.assign(document.createElement("li"), { textContent: words, className: limit.stretches ? "bad" : "" });
  }), ...(flight.failed ? [Object.assign(document.createElement("li"), { textContent: `not shown: ${flight.failed}`, className: "bad" })] : []));
  if (told === flight.eventCount) return;
  told = flight.eventCount;
  find("eventCount").textContent = `(${flight.eventCount})`;
  document.querySelector("#events ol").replaceChildren(...flight.events.map(event => {
    const item = document.createElement("li");
    for (const text of [`${event.at.toFixed(2)} s`, event.kind, event.vehicle, event.detail])
      item.append(Object.assign(document.createElement("span"), { textContent: text }));
    return item;
  }));
}

const speed = () => Number(find("speed").value);
const stands = () => playing?.status !== "playing";
find("play").onclick = () => connection.play(stands(), speed());
find("speed").onchange = () => connection.play(!stands(), speed());
find("seek").oninput = () => {
  seeking = true;
  connection.play(!stands(), speed(), recorded.start + BigInt(Math.round(Number(find("seek").value) * 1e9)));
};
find("seek").onchange = () => { seeking = false; };

/** Lists the flights. One that was added while the shown one flew or later is shown when that has ended. */
async function list() {
  const before = flights.map(one => one.id);
  flights = await (await fetch("/flights")).json();
  const ids = flights.map(one => one.id);
  if (String(ids) !== String(before)) {
    find("flights").replaceChildren(...ids.map(id => Object.assign(document.createElement("option"), { textContent: id })));
    find("flights").value = shown;
  }
  find("flights").hidden = ids.length < 2;
  if (flight?.hasBegun) added = ids.findLast(id => !before.includes(id)) ?? added;
  if (shown === undefined && ids.length) show(ids[0]);
  else if (added && flight.ending) show(added);
  else if (!ids.length) state("no flight yet", true);
}

let seconds = 0, ended;

function listAgain() {
  seconds++;
  // A connection that is silent for more than five seconds makes room for others; a server whose flights have ended goes.
  const isDue = shown === undefined || (flight.ending ? flight.ending === ended && connection.isOpen() : seconds % 6 === 0);
  ended = flight?.ending;
  if (isDue && !recorded) list().catch(() => { /* The connection says that the server is away. */ });
}

find("flights").onchange = () => show(find("flights").value);
listAgain();
setInterval(listAgain, 1000);
requestAnimationFrame(draw);
