// A browser that looks at the page: says what it showed.
// node browser.mjs FOLDER-OF-PACKAGES CHROMIUM URL STEPS, where STEPS is JSON:
//   {"token": …, "plain": whether without an imitated graphics card, "steps": [["wait", expression], ["ask", name, expression], ["click", selector], ["sleep", ms],
//                          ["seek", seconds], ["picture", file]]}
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const [folder, executablePath, url, text] = process.argv.slice(2);
const require = createRequire(join(resolve(folder), "node_modules", "none.js"));
const { chromium } = require("playwright-core");
const { steps, token, plain } = JSON.parse(text);
const browser = await chromium.launch({
  executablePath,
  args: ["--headless", "--no-sandbox", "--disable-dev-shm-usage",
    ...(plain ? ["--disable-gpu"] : ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]),
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run"],
});
const page = await browser.newPage({ viewport: { width: 1440, height: 1000 } });
const told = {}, problems = [], foreign = [], questions = [];
page.on("pageerror", error => problems.push(String(error)));
page.on("console", message => { if (message.type() === "error") problems.push(message.text()); });
page.on("request", request => { if (!request.url().startsWith(url)) foreign.push(request.url()); });
page.on("dialog", dialog => { questions.push(dialog.message()); dialog.accept(); });
// The page lets nobody evaluate text within it, so it is asked from outside.
const until = async expression => {
  for (const end = Date.now() + 60_000; !await page.evaluate(expression);) {
    if (Date.now() > end) throw new Error(`not within a minute: ${expression}`);
    await page.waitForTimeout(50);
  }
};
try {
  await page.goto(url);
  for (const [what, ...how] of steps) {
    if (what === "wait") await until(how[0]);
    else if (what === "ask") told[how[0]] = await page.evaluate(how[1]);
    else if (what === "click") {
      if (token) await page.fill("#token", token, { force: true });
      await page.click(how[0]);
    }
    else if (what === "sleep") await page.waitForTimeout(how[0]);
    else if (what === "picture") await page.screenshot({ path: how[0] });
    else if (what === "seek") await page.evaluate(at => {
      const seek = document.getElementById("seek");
      seek.value = at;
      seek.dispatchEvent(new Event("input"));
      seek.dispatchEvent(new Event("change"));
    }, how[0]);
    else throw new Error(`no such step: ${what}`);
  }
} catch (error) { problems.push(String(error)); }
await browser.close();
console.log(JSON.stringify({ told, problems, foreign, questions }));
