// Opens a recording or a flight under way in Foxglove Studio with our layout, in a browser without a window, and keeps a
// picture:
//
//   npm install --ignore-scripts --prefix bench/foxglove
//   node bench/foxglove/look.mjs FILE.mcap PICTURE.png [SECONDS]                      played for so long before
//   node bench/foxglove/look.mjs ws://HOST:PORT/flights/ID PICTURE.png [SECONDS]      watched for so long before
//
// A flight has to allow it: ./skein fly --view --view-origin http://127.0.0.1:8766.
// Studio's components are those of its last release under a free licence. It has an older panel for images, which takes
// the place of the layout's.
import { createReadStream, readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { basename, dirname, extname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const [source, picture, seconds = "20"] = process.argv.slice(2);
if (!picture) throw new Error("expected a file or an address, and the picture's name");
const here = dirname(fileURLToPath(import.meta.url));
const isLive = source.startsWith("ws");

const layout = JSON.parse(readFileSync(join(here, "../../docs/guides/foxglove-layout.json"), "utf8").replaceAll('"Image!', '"ImageViewPanel!'));
for (const panel of Object.values(layout.configById)) if (panel.imageMode) panel.cameraTopic = panel.imageMode.imageTopic;

const kinds = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".css": "text/css", ".svg": "image/svg+xml" };
const server = createServer((request, response) => {
  const path = new URL(request.url, "http://here").pathname;
  if (path === "/layout.json") return response.end(JSON.stringify(layout));
  const file = path === `/${basename(source)}` ? resolve(source) : join(here, path === "/" ? "studio.html" : path);
  let size;
  try { size = statSync(file).size; } catch { return response.writeHead(404).end(); }
  const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? "");
  const start = range ? Number(range[1]) : 0, end = Math.min(range?.[2] ? Number(range[2]) : size - 1, size - 1);
  response.writeHead(range ? 206 : 200, {
    "accept-ranges": "bytes", "content-length": end - start + 1, "content-type": kinds[extname(file)] ?? "application/octet-stream",
    ...(range && { "content-range": `bytes ${start}-${end}/${size}` }),
  });
  createReadStream(file, { start, end }).pipe(response);
}).listen(8766, "127.0.0.1");
await new Promise(ready => server.once("listening", ready));

const origin = `http://127.0.0.1:${server.address().port}`;
const wanted = new URLSearchParams({
  layoutId: "skein", ds: isLive ? "foxglove-websocket" : "remote-file", "ds.url": isLive ? source : `${origin}/${basename(source)}`,
});
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
});
const page = await browser.newPage({ viewport: { width: 1600, height: 1000 } });
page.on("pageerror", error => console.log(`error: ${error}`));
page.on("console", message => { if (message.type() === "error") console.log(`error: ${message.text()}`); });
await page.goto(`${origin}/?${wanted}`);
if (!isLive) {
  await page.waitForLoadState("networkidle");
  await page.getByTitle("Play").first().click({ timeout: 60_000 });
}
await page.waitForTimeout(1000 * Number(seconds));
await page.screenshot({ path: picture });
console.log(await page.evaluate(() => document.body.innerText));
await browser.close();
server.close();
