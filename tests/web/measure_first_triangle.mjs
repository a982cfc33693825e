// node measure_first_triangle.mjs FILE.gim [times]: milliseconds from new GIMMesh() to the frame that shows a triangle, in
// Chromium throttled to 2 Mbit/s and 40 ms, drawn by SwiftShader; and from navigation, with the page's scripts on the way.
import { copyFileSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launchWithWebGl, makePage } from "./browser.mjs";
import { serve } from "./setup.mjs";

const [file, times = "15"] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "gim-first-"));
copyFileSync(file, join(folder, "x.gim"));
makePage("first", folder, "--minify");
const served = await serve({ "": folder }, undefined, true), browser = await launchWithWebGl();

async function open(query) {
  const context = await browser.newContext(), page = await context.newPage();
  const session = await context.newCDPSession(page);
  await session.send("Network.enable");
  const rate = 2e6 / 8;
  await session.send("Network.emulateNetworkConditions", { offline: false, latency: 40, downloadThroughput: rate, uploadThroughput: rate });
  await page.goto(served.address + query);
  await page.waitForFunction(() => window.isReady);
  return { page, context };
}
const middle = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
const describe = (list) => `${middle(list).toFixed(0)} ms (${Math.min(...list).toFixed(0)} to ${Math.max(...list).toFixed(0)})`;

const warm = [], finest = [], cold = [];
let last;
for (let i = 0; i < Number(times); ++i) {
  const { page, context } = await open("/");
  last = await page.evaluate(() => window.measureFirst("/x.gim", true));
  if (last.error) throw new Error(last.error);
  warm.push(last.first), finest.push(last.finest);
  await context.close();
  const other = await open("/?cold");
  await other.page.waitForFunction(() => window.cold);
  cold.push((await other.page.evaluate(() => window.cold)).sinceNavigation);
  await other.context.close();
}
console.log(`first triangle after ${describe(warm)}, finest level after ${describe(finest)}, from navigation ${describe(cold)}`);
console.log(`${last.triangles} triangles first; ${last.requests} request, ${last.bytes} bytes until the finest level`);
await browser.close();
served.close();
rmSync(folder, { recursive: true });
