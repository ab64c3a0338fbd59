// Tests the page in a real browser: it loads, the ball moves by mouse and keys, the restitution is that of the native program,
// and there are no errors on the console. Usage: node check.mjs PAGE PROGRAM, with playwright-core installed.
import { chromium } from "playwright-core";
import { execFileSync } from "node:child_process";
import { statSync } from "node:fs";
import { resolve } from "node:path";

const [page_file, program, picture] = process.argv.slice(2);
const must = (holds, what) => { if (!holds) throw new Error(what); console.log(`ok: ${what}`); };
must(statSync(page_file).size < 1.5e6, "the page is smaller than 1.5 MB");

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});
try {
  const context = await browser.newContext({ viewport: { width: 1000, height: 1150 } });
  const page = await context.newPage();
  const said = [], asked = [];
  page.on("console", message => { if (["error", "warning"].includes(message.type())) said.push(message.text()); });
  page.on("pageerror", fault => said.push(String(fault)));
  page.on("request", request => { if (!/^(file|data|blob):/.test(request.url())) asked.push(request.url()); });
  await page.goto(`file://${resolve(page_file)}`);
  await page.waitForSelector("html[data-ready=yes]", { timeout: 60_000 });
  must(await page.evaluate(() => drawing.result.sub_impact_count) > 1, "several contacts are shown");

  // The animation runs.
  const clock = () => page.textContent("#clock");
  const before = await clock();
  await page.waitForTimeout(400);
  must(before !== await clock(), "the animation moves");

  // Compares with the same scene solved by the native program.
  const agree = async name => {
    const [scene, here] = await page.evaluate(() => [JSON.stringify(scene()), drawing.result]);
    const native = JSON.parse(execFileSync(program, ["simulate", "-", "--json"], { input: scene, encoding: "utf8" }));
    const difference = Math.abs(here.restitution - native.restitution);
    must(here.sub_impact_count === native.sub_impact_count && difference <= 1e-12,
      `${name}: restitution ${here.restitution}, native within ${difference.toExponential(1)}`);
  };
  await agree("at the start");

  const settled = () => page.waitForFunction(() => drawing && Math.abs(drawing.result.scene.location_m - scene().location_m) < 1e-9);
  await page.focus("#ball");
  const value = async () => Number(await page.getAttribute("#ball", "aria-valuenow"));
  const at = await value();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("PageUp");
  must(Math.abs(await value() - at - 0.11) < 1e-9, "arrow keys move the ball");
  await settled();
  await agree("moved by keys");

  const box = await page.locator("#ball circle").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 150, box.y + box.height / 2, { steps: 5 });
  await page.mouse.up();
  must(await value() > at + 0.2, "the mouse drags the ball");
  await settled();
  await agree("dragged");

  await page.selectOption("#beam_of", "aluminium");
  await page.fill("#speed", "2");
  await page.waitForFunction(() => drawing && drawing.result.scene.striker.speed_m_s === 2);
  await agree("faster, on aluminium");

  // With keys alone: the focus reaches every control once and is visible.
  const controls = await page.evaluate(() => [...document.querySelectorAll("[role=slider], button, input, select")].map(e => e.id));
  await page.focus(`#${controls[0]}`);
  const passed = [controls[0]];
  while (passed.length < controls.length) {
    await page.keyboard.press("Tab");
    passed.push(await page.evaluate(() => document.activeElement.id));
    const seen = await page.evaluate(() => document.activeElement.matches(":focus-visible"));
    if (!seen) throw new Error(`the focus on ${passed.at(-1)} is not shown`);
  }
  must(passed.join() === controls.join(), `the tab key reaches all ${controls.length} controls in the order of the page`);
  await page.focus("#play");
  const label = await page.textContent("#play");
  await page.keyboard.press("Space");
  must(await page.textContent("#play") !== label, "the space bar plays and pauses");
  await page.focus("#time");
  await page.keyboard.press("Home");
  await page.keyboard.press("PageUp");
  must(/time .*force/.test(await page.getAttribute("#time", "aria-valuetext")), "the time slider announces time and force");
  await page.focus("#radius");
  const radius = await page.inputValue("#radius");
  await page.keyboard.press("ArrowLeft");
  must(Number(await page.inputValue("#radius")) < Number(radius), "arrow keys change the ball");
  await page.waitForFunction(() => drawing && drawing.result.scene.striker.radius_m === state.radius / 1000);
  await agree("a smaller ball");

  // The accessibility tree for screen readers.
  const tree = await page.locator("body").ariaSnapshot();
  for (const wanted of [/main/, /heading "Play with an impact" \[level=1\]/, /slider "Location of impact"/, /group "Beam and ball"/,
    /button "(Play|Pause)"/, /form "Ball and beam"/, /status/, /row "Restitution/, /img "Contact force over time: \d+ contacts/]) {
    if (!wanted.test(tree)) throw new Error(`a screen reader does not find ${wanted} in\n${tree}`);
  }
  console.log("ok: a screen reader finds headings, controls, results and the picture");
  const nameless = await page.evaluate(() => [...document.querySelectorAll("input, select, button, [role=slider]")]
    .filter(e => !(e.labels?.length || e.textContent.trim() || e.getAttribute("aria-label"))).map(e => e.id));
  must(nameless.length === 0, "every control has a name");
  must(await page.getAttribute("#results", "aria-live") === "polite", "results are announced");
  await page.click("#hear");
  await page.click("#copy");
  await page.waitForFunction(() => document.getElementById("copy").textContent === "Copied");
  console.log("ok: the scene is copied");
  if (picture) await page.screenshot({ path: picture, fullPage: true });
  must(asked.length === 0, `no address is requested ${asked}`);
  must(said.length === 0, `nothing on the console ${said}`);
} finally {
  await browser.close();
}
