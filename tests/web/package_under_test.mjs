// The package as it is packed, and files to decode. bash tools/npm.sh builds it.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

export const root = fileURLToPath(new URL("../..", import.meta.url));
export const packageFolder = process.env.GIM_PACKAGE ?? join(root, "build/npm/package");
export const program = process.env.GIM_PROGRAM ?? join(root, "build/release/tools/gim");
export const models = process.env.GIM_MODELS_DIR ?? join(root, "../shared/models");

export const importEntry = (name) => import(join(packageFolder, `${name}.mjs`));
export const vector = (name) => new Uint8Array(readFileSync(join(root, "spec/vectors/valid", `${name}.gim`)));

// A folder that is gone when the test ends.
export function temporaryFolder(context) {
  const folder = mkdtempSync(join(tmpdir(), "gim-web-"));
  context.after(() => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

// Writes a torus of rings x sides quads with ripples, as OBJ. seed: of their phases.
export function torus(rings, sides, seed = 0) {
  const lines = [];
  for (let i = 0; i < rings; ++i) {
    for (let j = 0; j < sides; ++j) {
      const a = (2 * Math.PI * i) / rings, b = (2 * Math.PI * j) / sides;
      const r = 0.35 + 0.05 * Math.sin((3 + (seed % 5)) * a + seed) + 0.03 * Math.cos((4 + (seed % 7)) * b + 2 * seed);
      lines.push(`v ${(1 + r * Math.cos(b)) * Math.cos(a)} ${r * Math.sin(b)} ${-(1 + r * Math.cos(b)) * Math.sin(a)}`);
    }
  }
  const at = (i, j) => (i % rings) * sides + (j % sides) + 1;
  for (let i = 0; i < rings; ++i)
    for (let j = 0; j < sides; ++j)
      lines.push(`f ${at(i, j)} ${at(i + 1, j)} ${at(i + 1, j + 1)} ${at(i, j + 1)}`);
  return lines.join("\n") + "\n";
}

// Runs the gim program.
export const gim = (...options) => execFileSync(program, options, { encoding: "utf8" });
export const withoutProgram = existsSync(program) ? false : `no program at ${program}`;
