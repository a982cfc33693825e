// A scene that refines as bytes arrive, in Chromium, from nginx: the final picture is that of the loader that reads all at once.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launchWithWebGl, makePage } from "./browser.mjs";
import { sceneGlb } from "./glb_scene.mjs";
import { encodedGlb, withoutProgram } from "./meshes.mjs";
import { startNginx, withoutNginx } from "./nginx.mjs";
import { noBrowser, open } from "./setup.mjs";

const skip = noBrowser || withoutProgram || withoutNginx, timeout = 120000;
let folder, nginx, browser, file, pictureAt;
before(async () => {
  if (skip) return;
  file = readFileSync(await encodedGlb("textured-scene", () => sceneGlb(true), "--size", "65", "--lossless", "--bits", "16"));
  const size = file.readUInt32LE(12), json = JSON.parse(file.subarray(20, 20 + size).toString());
  pictureAt = 28 + size + json.bufferViews[json.images[0].bufferView].byteOffset;
  folder = mkdtempSync(join(tmpdir(), "gim-scene-"));
  mkdirSync(join(folder, "files"));
  writeFileSync(join(folder, "files/scene.glb"), file);
  makePage("scene", join(folder, "files"));
  nginx = await startNginx(folder);
  browser = await launchWithWebGl();
});
after(async () => {
  await browser?.close();
  await nginx?.stop();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

async function openPage() {
  const opened = await open(browser, `${nginx.address}/index.html`);
  await opened.page.waitForFunction(() => window.isReady);
  return opened;
}
function keep(name, { pixels }) {
  if (!process.env.GIM_WEB_FRAMES) return;
  const rows = Buffer.from(pixels, "base64"), lines = Array.from({ length: 400 }, (_, y) => rows.subarray(1200 * (399 - y), 1200 * (400 - y)));
  writeFileSync(join(process.env.GIM_WEB_FRAMES, name), Buffer.concat([Buffer.from("P6 400 400 255\n"), ...lines]));
}
// How many pixels differ.
function difference(a, b) {
  const [one, other] = [a, b].map(({ pixels }) => Buffer.from(pixels, "base64"));
  let count = 0;
  for (let i = 0; i < one.length; i += 3) if (one.compare(other, i, i + 3, i, i + 3) !== 0) ++count;
  return count;
}

test("coarse levels are drawn before the pictures are here; the final picture is that of the whole file", { skip, timeout }, async (context) => {
  const { page, errors } = await openPage();
  const url = "/ranges/scene.glb", whole = await page.evaluate((how) => window.drawWhole(how), { url, level: 0 });
  const coarse = await page.evaluate((how) => window.drawWhole(how), { url, level: 2 });
  let release;
  const released = new Promise((resolve) => (release = resolve)), asked = [];
  await page.route("**/ranges/scene.glb", async (route) => {
    const range = /^bytes=(\d+)-/.exec(route.request().headers().range ?? "");
    asked.push(route.request().headers().range);
    if (range && Number(range[1]) >= pictureAt) await released;
    await route.continue();
  });
  const options = { url, pixelError: 0.05, firstBytes: 4096 };
  const begun = await page.evaluate((how) => window.beginScene(how), options);
  assert.deepEqual(begun.levels, [2, 2, 2]);
  assert.equal(begun.triangles, coarse.triangles);
  assert.ok(begun.bytesLoaded < file.length / 3, `${begun.bytesLoaded} of ${file.length} bytes`);
  release();
  const finished = await page.evaluate(() => window.finishScene());
  context.diagnostic(`${begun.bytesLoaded} bytes in ${begun.requests} requests, then ${finished.bytesLoaded} of ${file.length}; ${asked.join(", ")}`);
  keep("scene-whole.ppm", whole), keep("scene-coarse.ppm", begun), keep("scene-refined.ppm", finished);
  assert.deepEqual(finished.errors, []);
  assert.deepEqual(finished.levels, [0, 0, 0]);
  assert.equal(finished.triangles, whole.triangles);
  assert.equal(difference(finished, whole), 0);
  assert.ok(difference(begun, whole) > 1000, "the first picture is another one");
  assert.deepEqual(errors, []);
});

test("a server without ranges gives the same picture", { skip, timeout }, async () => {
  const { page, errors } = await openPage();
  const url = "/no-ranges/scene.glb", whole = await page.evaluate((how) => window.drawWhole(how), { url, level: 1 });
  await page.evaluate((how) => window.beginScene(how), { url, level: 1 });
  const finished = await page.evaluate(() => window.finishScene());
  assert.deepEqual(finished.errors, []);
  assert.equal(difference(finished, whole), 0);
  assert.deepEqual(errors, []);
});
