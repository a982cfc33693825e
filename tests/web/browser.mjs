// Pages with three.js in Debian's Chromium. WebGL is drawn by SwiftShader.
import { spawnSync } from "node:child_process";
import { copyFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { here, launch, packageFolder } from "./setup.mjs";

export const launchWithWebGl = () => launch("--use-angle=swiftshader", "--enable-unsafe-swiftshader");

// Puts a page into a folder: the script pages/NAME.js, or NAME.js of an absolute path, with three and the package in it.
// options: more of esbuild's.
export function makePage(name, folder, ...options) {
  const entries = ["decoder", "source", "three", "refine"].map((entry) => `--alias:gim/${entry}=${join(packageFolder, `${entry}.mjs`)}`);
  const how = ["--bundle", "--format=esm", "--target=es2022", "--log-level=warning", `--outfile=${join(folder, "page.js")}`];
  const env = { ...process.env, NODE_PATH: join(here, "node_modules") };
  const done = spawnSync("esbuild", [resolve(here, "pages", `${name}.js`), ...how, ...entries, ...options], { env, encoding: "utf8" });
  if (done.status !== 0) throw new Error(`esbuild: ${done.stderr ?? done.error}`);
  copyFileSync(join(here, "pages/blank.html"), join(folder, "index.html"));
}
