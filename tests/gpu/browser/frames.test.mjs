// Frames of WebGPU against the software rendering. GIM_GPU_CASES: the folder that write_buffers wrote. GIM_CHROMIUM: the
// browser. Skips where there is no browser.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { compare } from "./compare.mjs";
import { serve } from "./serve.mjs";

const cases = process.env.GIM_GPU_CASES;
const executablePath = process.env.GIM_CHROMIUM ?? "/usr/bin/chromium";
const here = import.meta.dirname ?? new URL(".", import.meta.url).pathname;
const close = 6; // of 255, as in tests/gpu/gpu_scene.h
const skip = existsSync(executablePath) ? false : `no browser at ${executablePath}`;

const swiftShader = [
  "--enable-unsafe-webgpu",
  "--enable-unsafe-swiftshader",
  "--use-webgpu-adapter=swiftshader",
  "--enable-features=Vulkan",
  "--use-vulkan=swiftshader",
];
const asRoot = process.getuid?.() === 0 ? ["--no-sandbox"] : [];

let served, browser, page;
before(async () => {
  if (skip) return;
  assert.ok(cases, "GIM_GPU_CASES is not set");
  served = await serve({ "": here, shaders: join(here, "../../../decoder/shaders"), cases });
  browser = await chromium.launch({ executablePath, headless: true, args: [...swiftShader, ...asRoot] });
  page = await browser.newPage();
  page.on("console", (message) => console.log(`page: ${message.text()}`));
  await page.goto(`${served.address}/page.html`);
  await page.waitForFunction(() => window.drawCase);
});
after(async () => {
  await browser?.close();
  served?.server.close();
});

// Draws a case and compares it with the reference.
async function drawAndCompare(name, forgets) {
  const folder = join(cases, name);
  const read = (file) => readFileSync(join(folder, file));
  const shape = JSON.parse(read("case.json"));
  const drawn = await page.evaluate(([which, how]) => window.drawCase(which, how), [name, forgets]);
  const frame = Buffer.from(drawn.pixels, "base64");
  keepFrame(frame, shape.side, forgets ? `${name}-leaky` : name);
  return { ...drawn, shape, found: compare(frame, read("samples"), read("contested"), shape.side, shape.finer) };
}

// Writes NAME.ppm into the folder GIM_GPU_FRAMES, if that variable is set, for people to look at.
function keepFrame(frame, side, name) {
  if (!process.env.GIM_GPU_FRAMES) return;
  const rgb = frame.filter((_, i) => i % 4 !== 3);
  writeFileSync(join(process.env.GIM_GPU_FRAMES, `browser-${name}.ppm`), Buffer.concat([Buffer.from(`P6 ${side} ${side} 255\n`), rgb]));
}

const names = skip || !cases ? [] : readdirSync(cases).sort();

test("there are cases", { skip }, () => assert.ok(names.length > 0));

for (const name of names) {
  test(`WebGPU draws ${name}`, { timeout: 120000 }, async (t) => {
    const { adapter, command, shape, found } = await drawAndCompare(name, false);
    const [vertexCount, instanceCount, , , needed] = command;
    assert.deepEqual([vertexCount, instanceCount, needed], [3 * shape.triangles, 1, shape.triangles]);
    t.diagnostic(`${adapter}: ${JSON.stringify(found)}`);
    assert.ok(found.worst <= close, `a pixel is off by ${found.worst}`);
    assert.equal(found.background, 0, "background shows through");
    assert.equal(found.backs, 0, "backs show through");
  });
}

// The tests above would notice gaps.
test("borders that forget their neighbours leak", { skip, timeout: 120000 }, async (t) => {
  const coarse = names.filter((name) => name.includes("-4-levels-"));
  let leaky = 0;
  for (const name of coarse) {
    const { found } = await drawAndCompare(name, true);
    if (found.background + found.backs > 0) ++leaky;
  }
  t.diagnostic(`${leaky} of ${coarse.length} frames leak`);
  assert.ok(2 * leaky > coarse.length);
});
