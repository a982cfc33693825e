// The viewer's page in a browser, served by gim view.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { request } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launchWithWebGl } from "./browser.mjs";
import { ball, encoded, program, root, withoutProgram } from "./meshes.mjs";
import { noBrowser } from "./setup.mjs";

const page_ = join(root, "build/viewer");
const skip = withoutProgram || noBrowser || (existsSync(page_) ? false : "no page; tools/viewer/build.sh makes it");
const text = (page, id) => page.evaluate((name) => document.getElementById(name).textContent, id);
const number = async (page, id) => Number((await text(page, id)).replace(/[^0-9.]/g, ""));

let folder, file, original, viewer, address, browser, errors;
before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "gim-viewer-"));
  file = await encoded("ball", () => ball(32, 64, 1), "--size", "129");
  original = join(folder, "a ball & its original.obj");
  writeFileSync(original, ball(32, 64, 1));
  viewer = spawn(program, ["view", file, "--original", original]);
  address = (await new Promise((resolve) => viewer.stdout.once("data", resolve))).toString().trim();
  browser = await launchWithWebGl();
});
after(async () => {
  await browser?.close();
  viewer?.kill();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

async function open(query = new URL(address).search, size = { width: 1200, height: 700 }) {
  const page = await browser.newPage({ viewport: size });
  errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(new URL(address).origin + "/" + query);
  return page;
}
const loaded = (page) => page.waitForFunction(() => document.getElementById("fact-triangles").textContent !== "–");

test("gim view serves ranges, and only to this machine", { skip }, async () => {
  const url = new URL(address), name = url.origin + "/" + url.searchParams.get("url");
  const part = await fetch(name, { headers: { range: "bytes=2-11" } });
  assert.equal(part.status, 206);
  assert.deepEqual(Buffer.from(await part.arrayBuffer()), readFileSync(file).subarray(2, 12));
  assert.equal((await fetch(`${url.origin}/file/..%2f..%2fetc%2fpasswd`)).status, 404);
  const status = await new Promise((resolve) =>
    request(name, { headers: { host: "elsewhere.example" } }, (response) => resolve(response.resume().statusCode)).end());
  assert.equal(status, 403, "a name of elsewhere");
});

test("gim view says what is wrong", { skip }, () => {
  const run = (...options) => spawnSync(program, ["view", ...options], { encoding: "utf8", timeout: 10000 });
  const noPage = run(file, "--page", folder);
  assert.equal(noPage.status, 1);
  assert.match(noPage.stderr, /tools\/viewer\/build\.sh/);
  assert.match(run(original).stderr, /not a .gim file/);
  assert.equal(run(join(folder, "none.gim")).status, 1);
  const taken = run(file, "--port", new URL(address).port);
  assert.equal(taken.status, 1);
  assert.match(taken.stderr, /port/);
});

test("a file, its original, and the distances between them", { skip, timeout: 60000 }, async () => {
  const page = await open();
  await page.waitForSelector("#legend:not([hidden])");
  assert.match(await text(page, "ramp-text"), /object units/);
  assert.equal(await number(page, "fact-triangles"), 32768);
  // The largest distance at samples is below what the encoder measured everywhere, and not nothing.
  const worst = Number(/Largest: ([0-9.e-]+)/.exec(await text(page, "ramp-text"))[1]);
  const told = Number(await text(page, "fact-error"));
  assert.ok(worst > 0 && worst <= 1.001 * told, `${worst} of ${told}`);
  await page.check("#folds");
  await page.waitForFunction(() => /triangles/.test(document.getElementById("fact-folds").textContent));
  assert.deepEqual(errors, []);
  await page.close();
});

test("the slider and the keys change the level", { skip, timeout: 60000 }, async () => {
  const page = await open();
  await loaded(page);
  const triangles = async (wanted) =>
    page.waitForFunction((n) => document.getElementById("fact-triangles").textContent === n, wanted, { timeout: 10000 });
  await triangles("32,768");
  await page.focus("#level");
  await page.keyboard.press("ArrowLeft");
  await triangles("8,192");
  await page.keyboard.press("Home");
  await triangles("512");
  await page.keyboard.press(".");
  await triangles("2,048");
  await page.keyboard.press("a");
  assert.ok(await page.isChecked("#auto"));
  await page.focus("#surface");
  for (let i = 0; i < 40; ++i) await page.keyboard.press("-");
  await page.waitForFunction(() => Number(document.getElementById("fact-triangles").textContent.replace(",", "")) < 8192);
  await page.keyboard.press("?");
  assert.ok(await page.isVisible("#help"));
  await page.keyboard.press("Escape");
  assert.deepEqual(errors, []);
  await page.close();
});

test("each control is reached by Tab", { skip, timeout: 60000 }, async () => {
  const page = await open();
  await loaded(page);
  await page.waitForSelector("#legend:not([hidden])");
  const reached = new Set();
  for (let i = 0; i < 24; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement.id));
  }
  for (const id of ["file", "url", "help-button", "surface", "image", "level", "auto", "wire", "folds", "colour", "reset"])
    assert.ok(reached.has(id), `${id} is not reached`);
  await page.close();
});

test("surface and image mark the same sample", { skip, timeout: 60000 }, async () => {
  const page = await open();
  await loaded(page);
  const surface = await page.locator("#surface").boundingBox();
  await page.mouse.move(surface.x + surface.width / 2, surface.y + surface.height / 2);
  await page.waitForFunction(() => /^row/.test(document.getElementById("sample").textContent));
  const fromSurface = await text(page, "sample");
  const [, row, column] = /row (\d+), column (\d+)/.exec(fromSurface).map(Number);
  const image = await page.locator("#image").boundingBox();
  await page.mouse.move(image.x + 3, image.y + 3);
  await page.waitForFunction(() => /^row 1?[0-9], column/.test(document.getElementById("sample").textContent));
  await page.mouse.move(image.x + ((column + 0.5) / 129) * image.width, image.y + ((row + 0.5) / 129) * image.height);
  await page.waitForFunction((wanted) => document.getElementById("sample").textContent.startsWith(wanted), `row ${row}, column ${column}`);
  assert.equal((await text(page, "sample")).split("\n")[1], fromSurface.split("\n")[1], "the same place in space");
  await page.focus("#image");
  await page.keyboard.press("ArrowRight");
  assert.match(await text(page, "sample"), new RegExp(`column ${Math.min(column + 1, 128)}`));
  await page.close();
});

test("bad files are said, and the page goes on", { skip, timeout: 60000 }, async () => {
  const page = await open("?url=file/none.gim");
  await page.waitForFunction(() => /404/.test(document.getElementById("message").textContent));
  await page.setInputFiles("#file", { name: "x.gim", mimeType: "", buffer: Buffer.from("no gim") });
  await page.waitForFunction(() => /x\.gim: /.test(document.getElementById("message").textContent));
  await page.setInputFiles("#file", { name: "x.txt", mimeType: "", buffer: Buffer.from("no gim") });
  await page.waitForFunction(() => /x\.txt: not/.test(document.getElementById("message").textContent));
  await page.setInputFiles("#file", file);
  await loaded(page);
  assert.equal(await text(page, "message"), "");
  await page.close();
});

test("a narrow page has no sideways scrolling", { skip, timeout: 60000 }, async () => {
  const page = await open(undefined, { width: 360, height: 740 });
  await loaded(page);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 360));
  await page.close();
});
