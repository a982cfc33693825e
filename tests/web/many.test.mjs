// A page with 100 different files, levels chosen by the camera, and a budget of memory.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { cpus, tmpdir } from "node:os";
import { join } from "node:path";
import { launchWithWebGl, makePage } from "./browser.mjs";
import { scaledFile } from "./made_files.mjs";
import { ball, encoded, withoutProgram } from "./meshes.mjs";
import { noBrowser, serve } from "./setup.mjs";

const skip = noBrowser || withoutProgram;
const shapes = 25, scales = [1, 0.9, 0.8, 0.7], count = shapes * scales.length;
let folder, served, browser;

// Encodes shapes in as many processes as there are cores. Each becomes files of several sizes.
async function encodeAll() {
  const files = [];
  let i = 0;
  const work = async () => {
    for (let seed; (seed = i++) < shapes; )
      files[seed] = await encoded(`many-${seed}`, () => ball(12, 20, seed), "--size", "33", "--node-side", "9", "--threads", "1");
  };
  await Promise.all(Array.from({ length: cpus().length }, work));
  return files;
}

before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "gim-many-"));
  const files = await encodeAll();
  files.flatMap((file) => scales.map((scale) => scaledFile(readFileSync(file), scale)))
    .forEach((bytes, i) => writeFileSync(join(folder, `${i}.gim`), bytes));
  makePage("many", folder);
  served = await serve({ "": folder });
  browser = await launchWithWebGl();
});
after(async () => {
  await browser?.close();
  served?.close();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

async function draw(options) {
  const page = await browser.newPage({ viewport: { width: 800, height: 600 } });
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(served.address);
  await page.waitForFunction(() => window.isReady);
  const urls = Array.from({ length: count }, (_, i) => `/${i}.gim`);
  const found = await page.evaluate((how) => window.drawMany(how), { urls, frames: 120, pixelError: 1, ...options });
  if (process.env.GIM_WEB_FRAMES) writeFileSync(join(process.env.GIM_WEB_FRAMES, `many-${options.maxBytes}.png`), await page.screenshot());
  return { page, found: { ...found, errors: [...found.errors, ...errors] } };
}

test("100 meshes with room for all", { skip, timeout: 200000 }, async (context) => {
  const { page, found } = await draw({ maxBytes: 64 << 20, pixelError: 4 });
  context.diagnostic(`${((1000 * found.frames) / found.milliseconds).toFixed(1)} frames/s, ${JSON.stringify(found)}`);
  assert.deepEqual(found.errors, []);
  assert.equal(found.shown, count);
  assert.ok(Object.keys(found.levels).length >= 3, "several levels were shown");
  assert.equal(found.geometries <= count + 1, true, "no level stays that is not shown");
  const left = await page.evaluate(() => window.disposeMany());
  assert.deepEqual(left, { geometries: 0, bytes: 0 });
  await page.close();
});

test("100 meshes with room for few", { skip, timeout: 200000 }, async (context) => {
  const maxBytes = 1 << 20;
  const { page, found } = await draw({ maxBytes, pixelError: 0.1 });
  context.diagnostic(`${((1000 * found.frames) / found.milliseconds).toFixed(1)} frames/s, ${JSON.stringify(found)}`);
  assert.deepEqual(found.errors, []);
  assert.ok(found.most <= maxBytes, `${found.most} bytes of ${maxBytes}`);
  assert.ok(found.most > maxBytes / 2, "the budget is used");
  await page.close();
});
