// Meshes and the program that encodes them. GIM_PROGRAM: the program; without it that of a build that is there.
import { execFile, execFileSync } from "node:child_process";
import { existsSync, mkdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { promisify } from "node:util";
import { here } from "./setup.mjs";

export const root = join(here, "../..");
export const models = process.env.GIM_MODELS_DIR ?? join(root, "../shared/models");
const programs = ["release", "ci"].map((preset) => join(root, "build", preset, "tools/gim"));
export const program = process.env.GIM_PROGRAM ?? programs.find((path) => existsSync(path)) ?? programs[0];

// Returns a ball with waves, as OBJ. seed: of the waves.
export function ball(rings, sides, seed = 0) {
  const lines = ["v 0 1 0", "v 0 -1 0"];
  const radius = (a, b) => 1 + 0.12 * Math.sin((2 + (seed % 3)) * a + seed) * Math.sin(b) ** 2 + 0.08 * Math.cos((3 + (seed % 4)) * b + 0.7 * seed);
  lines[0] = `v 0 ${radius(0, 0)} 0`; lines[1] = `v 0 ${-radius(0, Math.PI)} 0`;
  for (let i = 1; i < rings; ++i) {
    for (let j = 0; j < sides; ++j) {
      const a = (2 * Math.PI * j) / sides, b = (Math.PI * i) / rings, r = radius(a, b);
      lines.push(`v ${r * Math.sin(b) * Math.cos(a)} ${r * Math.cos(b)} ${-r * Math.sin(b) * Math.sin(a)}`);
    }
  }
  const at = (i, j) => 3 + (i - 1) * sides + (j % sides);
  for (let j = 0; j < sides; ++j) {
    lines.push(`f 1 ${at(1, j)} ${at(1, j + 1)}`, `f 2 ${at(rings - 1, j + 1)} ${at(rings - 1, j)}`);
    for (let i = 1; i < rings - 1; ++i) lines.push(`f ${at(i, j)} ${at(i + 1, j)} ${at(i + 1, j + 1)} ${at(i, j + 1)}`);
  }
  return lines.join("\n") + "\n";
}

// Runs the gim program.
export const gim = (...options) => execFileSync(program, options, { encoding: "utf8" });
// Returns the path of `name` in build/web/meshes, and encodes what make() returns if it is not there. It takes seconds.
async function encodedFile(name, inputName, make, options) {
  const folder = join(root, "build/web/meshes"), file = join(folder, name), input = join(folder, inputName);
  if (existsSync(file) && statSync(file).mtimeMs > statSync(program).mtimeMs) return file;
  mkdirSync(folder, { recursive: true });
  writeFileSync(input, make());
  await promisify(execFile)(program, ["encode", input, file, "--layout", "gim", "--quiet", ...options]);
  rmSync(input);
  return file;
}
export const encoded = (name, makeMesh, ...options) => encodedFile(`${name}.gim`, `${name}.obj`, makeMesh, options);
// The same for a scene: NAME.glb.
export const encodedGlb = (name, makeGlb, ...options) => encodedFile(`${name}.glb`, `${name}-plain.glb`, makeGlb, options);
export const withoutProgram = existsSync(program) ? false : `no program at ${program}`;
