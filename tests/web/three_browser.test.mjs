// What GIMLoader and GIMMesh draw in a browser, against gim render.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { inflateSync } from "node:zlib";
import { launchWithWebGl, makePage } from "./browser.mjs";
import { comparePictures } from "./compare_pictures.mjs";
import { ball, encoded, gim, models, withoutProgram } from "./meshes.mjs";
import { noBrowser, serve } from "./setup.mjs";

const skip = noBrowser || withoutProgram;
const side = 200;
let folder, served, browser, page;
before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "gim-three-"));
  copyFileSync(await encoded("ball", () => ball(32, 64, 1), "--size", "129"), join(folder, "ball.gim"));
  if (existsSync(join(models, "bunny.ply")))
    gim("encode", join(models, "bunny.ply"), join(folder, "bunny.gim"), "--layout", "gim", "--size", "129", "--quiet");
  makePage("view", folder);
  served = await serve({ "": folder });
  browser = await launchWithWebGl();
  page = await browser.newPage();
  page.on("console", (message) => console.log(`page: ${message.text()}`));
  await page.goto(served.address);
  await page.waitForFunction(() => window.isReady);
});
after(async () => {
  await browser?.close();
  served?.close();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

// The bytes of a PNG as gim writes it: eight bits, red green blue.
function readPng(path) {
  const png = readFileSync(path), parts = [];
  let width = 0;
  for (let at = 8; at < png.length; ) {
    const size = png.readUInt32BE(at), type = png.toString("latin1", at + 4, at + 8);
    if (type === "IHDR") {
      width = png.readUInt32BE(at + 8);
      assert.deepEqual([...png.subarray(at + 16, at + 18)], [8, 2]);
    }
    if (type === "IDAT") parts.push(png.subarray(at + 8, at + 8 + size));
    at += size + 12;
  }
  const raw = inflateSync(Buffer.concat(parts)), stride = 3 * width, rgb = Buffer.alloc(stride * Math.floor(raw.length / (stride + 1)));
  const paeth = (a, b, c) => {
    const p = a + b - c, [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
  };
  for (let y = 0; y * stride < rgb.length; ++y) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const a = x >= 3 ? rgb[y * stride + x - 3] : 0, b = y > 0 ? rgb[(y - 1) * stride + x] : 0;
      const c = x >= 3 && y > 0 ? rgb[(y - 1) * stride + x - 3] : 0;
      const add = [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
      rgb[y * stride + x] = raw[y * (stride + 1) + 1 + x] + add;
    }
  }
  return rgb;
}

function keep(name, bytes) {
  if (process.env.GIM_WEB_FRAMES) writeFileSync(join(process.env.GIM_WEB_FRAMES, name), Buffer.concat([Buffer.from(`P6 ${side} ${side} 255\n`), bytes]));
}

const views = [
  { model: "ball", level: 0, azimuth: 35, elevation: 20, isFlat: true, how: "loader" },
  { model: "ball", level: 1, azimuth: -70, elevation: 50, isFlat: true, how: "mesh" },
  { model: "ball", level: 0, azimuth: 35, elevation: 20, isFlat: false, how: "mesh" },
  { model: "bunny", level: 0, azimuth: 35, elevation: 20, isFlat: true, how: "mesh" },
  { model: "bunny", level: 2, azimuth: 200, elevation: 10, isFlat: true, how: "loader" },
  { model: "bunny", level: 1, azimuth: 35, elevation: 20, isFlat: false, how: "loader" },
];
for (const view of views) {
  const name = `${view.how} draws ${view.model} at level ${view.level}, ${view.isFlat ? "flat" : "smooth"}`;
  test(name, { skip, timeout: 120000 }, async (context) => {
    const file = join(folder, `${view.model}.gim`);
    if (!existsSync(file)) return context.skip(`no model ${view.model}`);
    const drawn = await page.evaluate((how) => window.drawView(how), { ...view, url: `/${view.model}.gim`, side });
    const frame = Buffer.from(drawn.pixels, "base64");
    gim("render", file, join(folder, "view.png"), "--up", "y", "--level", String(view.level), "--size", String(side),
      "--azimuth", String(view.azimuth), "--elevation", String(view.elevation), ...(view.isFlat ? ["--flat"] : []));
    const reference = readPng(join(folder, "view.png"));
    keep(`${name}.ppm`.replaceAll(" ", "-"), frame), keep(`${name} reference.ppm`.replaceAll(" ", "-"), reference);
    const found = comparePictures(frame, reference, side, 12);
    context.diagnostic(`${drawn.triangles} triangles: ${JSON.stringify(found)}`);
      assert.ok(drawn.painted > 0.2 * side * side, "there is a model in the picture");
    // gim render makes normals from triangles, the decoder from the samples around.
    assert.ok(found.off <= (view.isFlat ? 0.001 : 0.003) * drawn.painted, `${found.off} pixels are off`);
  });
}
