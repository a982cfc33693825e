// The examples of the package's README for gim/refine, as they stand there, in a page that draws.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launchWithWebGl, makePage } from "./browser.mjs";
import { noBrowser, open, packageFolder, serve, vector } from "./setup.mjs";

const skip = noBrowser;
const harness = `
const renderer = new THREE.WebGLRenderer();
renderer.setSize(400, 400);
document.body.append(renderer.domElement);
const scene = new THREE.Scene().add(mesh, new THREE.HemisphereLight(0xffffff, 0x30303a, 3));
geometry.computeBoundingSphere();
const { center, radius } = geometry.boundingSphere;
const camera = new THREE.PerspectiveCamera(45, 1, 0.01 * radius, 1000 * radius);
window.drawFrom = (radii) => {
  camera.position.copy(center).add({ x: 0, y: 0, z: radii * radius });
  camera.lookAt(center);
  camera.updateMatrixWorld();
  refine(camera, 400);
  renderer.render(scene, camera);
  const drawn = geometry.index.array.slice(0, geometry.drawRange.count);
  const eye = camera.position.toArray(), wanted = Array.from({ length: clusters.clusterCount }, (_, c) => isDrawn(c, eye, 480));
  const isSame = refined.triangles.every((v, i) => v === drawn[i]) && drawn.length === 3 * refined.triangleCount;
  return { triangles: renderer.info.render.triangles, isSame, clusters: wanted.filter(Boolean).length, all: clusters.clusterCount };
};
window.isReady = true;
`;
let folder, served, browser;
before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "gim-refine-"));
  const section = readFileSync(join(packageFolder, "README.md"), "utf8").split("## Refining")[1].split("\n## ")[0];
  const examples = [...section.matchAll(/```js\n(.*?)```/gs)].map((found) => found[1]);
  assert.equal(examples.length, 2);
  writeFileSync(join(folder, "example.js"), examples.join("\n") + harness);
  writeFileSync(join(folder, "bunny.gim"), vector("sphere-33-lossy.gim"));
  makePage(join(folder, "example"), folder);
  served = await serve({ "": folder });
  browser = await launchWithWebGl();
});
after(async () => {
  await browser?.close();
  served?.close();
  if (folder) rmSync(folder, { recursive: true, force: true });
});

test("the examples draw a mesh that is finer from near", { skip, timeout: 120000 }, async (context) => {
  const { page, errors } = await open(browser, served.address);
  await page.waitForFunction(() => window.isReady);
  const far = await page.evaluate(() => window.drawFrom(400)), near = await page.evaluate(() => window.drawFrom(1.5));
  context.diagnostic(JSON.stringify({ far, near }));
  assert.ok(far.isSame && near.isSame);
  assert.ok(far.triangles > 0 && near.triangles > 2 * far.triangles);
  assert.ok(far.clusters > 0 && near.clusters > far.clusters && near.clusters < near.all);
  assert.deepEqual(errors, []);
});
