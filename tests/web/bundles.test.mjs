// The packed package, installed into an empty folder as a user would, then bundled by esbuild, Vite and webpack and run in
// Chromium; required and imported by Node; checked by TypeScript.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { execFileSync } from "node:child_process";
import { cpSync, mkdtempSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { here, launch, noBrowser, open, serve, tgz, vectorsFolder } from "./setup.mjs";

const app = mkdtempSync(join(tmpdir(), "gim-web-"));
const installed = join(app, "node_modules/gim");
const timeout = 120000;
const run = (command, ...args) => execFileSync(command, args, { cwd: app, encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
let browser, served;

// What is bundled: a mesh by a worker and by this thread.
const main = `
import { GimDecoder, GimError } from "gim/decoder";
(async () => {
  await GimDecoder.ready;
  const file = await (await fetch("sphere.gim")).arrayBuffer();
  const here = GimDecoder.decodeMesh(file);
  GimDecoder.useWorkers(1);
  const there = await GimDecoder.decodeAsync("mesh", file);
  GimDecoder.useWorkers(0);
  const same = there.positions.every((x, i) => x === here.positions[i]);
  let name = "";
  try { GimDecoder.info(new Uint8Array(2)); } catch (error) { name = error instanceof GimError ? error.statusName : String(error); }
  globalThis.found = { same, triangles: here.triangles.length / 3, name };
})();
`;
const wanted = { same: true, triangles: 2 * 32 * 32, name: "NOT_GIM" };

before(async () => {
  writeFileSync(join(app, "package.json"), JSON.stringify({ name: "app", private: true, type: "module" }));
  run("npm", "install", "--no-audit", "--no-fund", "--silent", tgz);
  writeFileSync(join(app, "main.js"), main);
  cpSync(join(vectorsFolder, "valid/sphere-33-lossy.gim"), join(app, "sphere.gim"));
  if (noBrowser) return;
  served = await serve({ "": app });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  served?.close();
  rmSync(app, { recursive: true, force: true });
});

// Runs FOLDER/out.js in a page.
async function runs(folder) {
  writeFileSync(join(app, folder, "index.html"), '<!doctype html><script src="out.js"></script>');
  cpSync(join(app, "sphere.gim"), join(app, folder, "sphere.gim"));
  const { page, errors } = await open(browser, `${served.address}/${folder}/index.html`);
  await page.waitForFunction(() => globalThis.found);
  assert.deepEqual(await page.evaluate(() => globalThis.found), wanted);
  assert.deepEqual(errors, []);
}

test("the package has what is needed and no more", () => {
  const files = readdirSync(installed).sort();
  const entries = ["decoder", "refine", "source", "three"].flatMap((entry) => [`${entry}.cjs`, `${entry}.d.ts`, `${entry}.mjs`]);
  assert.ok(["LICENSE", "README.md", "package.json", ...entries].every((f) => files.includes(f)));
  for (const file of files) assert.match(file, /^(LICENSE|README\.md|package\.json|[a-z_]+\.(mjs|cjs|d\.ts))$/);
  assert.ok(files.every((file) => statSync(join(installed, file)).isFile()));
});

test("esbuild", { skip: noBrowser, timeout }, async () => {
  const { build } = await import("esbuild");
  await build({ entryPoints: [join(app, "main.js")], bundle: true, minify: true, outfile: join(app, "esbuild/out.js"), logLevel: "error" });
  await runs("esbuild");
});

test("Vite", { skip: noBrowser, timeout }, async () => {
  const { build } = await import("vite");
  const lib = { entry: join(app, "main.js"), formats: ["iife"], name: "app", fileName: () => "out.js" };
  await build({ root: app, logLevel: "error", build: { outDir: "vite", lib } });
  await runs("vite");
});

test("webpack", { skip: noBrowser, timeout }, async () => {
  const { default: webpack } = await import("webpack");
  const output = { path: join(app, "webpack"), filename: "out.js" };
  const stats = await new Promise((resolve, reject) =>
    webpack({ mode: "production", context: app, entry: "./main.js", output, performance: { hints: false } }, (error, made) =>
      error ? reject(error) : resolve(made),
    ),
  );
  assert.deepEqual(stats.toJson().errors, []);
  await runs("webpack");
});

const nodeScript = (load) => `
const file = require("fs").readFileSync("sphere.gim");
(${load}).then(async ({ GimDecoder }) => {
  await GimDecoder.ready;
  process.stdout.write(String(GimDecoder.decodeMesh(file).triangles.length / 3));
});`;

test("gim/refine in Node shares the decoder's errors", () => {
  const body = `const wrong = ({ GimRefine }, { GimError }) => GimRefine.ready.then(() => {
    try { GimRefine.open(new Uint8Array(3)); } catch (error) { process.stdout.write(String(error instanceof GimError && error.statusName)); }
  });\n`;
  writeFileSync(join(app, "refine.cjs"), `${body}wrong(require("gim/refine"), require("gim/decoder"));`);
  writeFileSync(join(app, "refine.mjs"), `${body}wrong(await import("gim/refine"), await import("gim/decoder"));`);
  for (const script of ["refine.cjs", "refine.mjs"]) assert.equal(run("node", script), "NOT_GIM");
});

test("require() and import in Node", () => {
  writeFileSync(join(app, "require.cjs"), nodeScript('Promise.resolve(require("gim/decoder"))'));
  writeFileSync(join(app, "import.cjs"), nodeScript('import("gim/decoder")'));
  for (const script of ["require.cjs", "import.cjs"]) assert.equal(run("node", script), String(wanted.triangles));
});

test("TypeScript knows the types", () => {
  const source = (body) => `import { GimDecoder, GimError, type GimMesh } from "gim/decoder";\n${body}\n`;
  writeFileSync(join(app, "fine.ts"), source(`
    export async function load(bytes: ArrayBuffer, signal: AbortSignal): Promise<number> {
      await GimDecoder.ready;
      const mesh: GimMesh = await GimDecoder.decodeAsync("hardMesh", bytes, { level: 1, signal });
      const { values } = GimDecoder.decodePlane(new Uint8Array(bytes), { plane: "normals" });
      try { return mesh.positions.length + values.length; } catch (e) { return e instanceof GimError ? e.status : 0; }
    }`));
  writeFileSync(join(app, "refine.ts"), `import { GimRefine, type GimClusters } from "gim/refine";
    export function coarse(bytes: ArrayBuffer, positions: Float32Array): GimClusters {
      const domain = GimRefine.open(bytes, { positions });
      const mesh = domain.refined({ mostTriangles: 1000 });
      const isDone: boolean = mesh.refine({ eye: [0, 0, 1], verticalFov: 1, viewportHeight: 600, pixelError: 2, need: (v) => v });
      if (isDone) mesh[Symbol.dispose]();
      return domain.clusters({ side: 4 });
    }\n`);
  writeFileSync(join(app, "wrong.ts"), source(`GimDecoder.decodePlane(new ArrayBuffer(0), { plane: "smells" });`));
  const check = (file) => {
    const options = ["--noEmit", "--strict", "--target", "es2020", "--lib", "es2020,dom", "--module", "nodenext", "--moduleResolution", "nodenext"];
    return execFileSync("node", [join(here, "node_modules/typescript/bin/tsc"), ...options, file], { cwd: app, encoding: "utf8" });
  };
  check("fine.ts");
  check("refine.ts");
  assert.throws(() => check("wrong.ts"), (error) => /smells/.test(error.stdout));
});
