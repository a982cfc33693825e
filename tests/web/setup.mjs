// Where things are, and what all tests need. GIM_PACKAGE: the folder that tools/npm.sh fills; GIM_DAMAGED: that of
// write_damaged; GIM_REFINED: that of write_refined; GIM_TGZ: the packed file; GIM_CHROMIUM: the browser.
import { createServer } from "node:http";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { chromium } from "playwright-core";

export const here = fileURLToPath(new URL(".", import.meta.url));
const build = join(here, "../../build");
export const packageFolder = process.env.GIM_PACKAGE ?? join(build, "npm/package");
export const damagedFolder = process.env.GIM_DAMAGED ?? join(build, "web/damaged");
export const refinedFolder = process.env.GIM_REFINED ?? join(build, "web/refined");
export const vectorsFolder = join(here, "../../spec/vectors");
export const tgz = process.env.GIM_TGZ ?? join(build, "npm", readdirSync(join(build, "npm")).find((n) => n.endsWith(".tgz")));
const executablePath = process.env.GIM_CHROMIUM || "/usr/bin/chromium";
export const noBrowser = existsSync(executablePath) ? false : `no browser at ${executablePath}`;

// What checkAll of decode_all.mjs wants to know of spec/vectors.
export function vectorNames() {
  const list = (folder) => readdirSync(join(vectorsFolder, folder)).sort();
  const valid = list("valid");
  const withoutExtension = (files) => files.filter((f) => f.endsWith(".gim")).map((f) => f.slice(0, -4));
  return {
    valid: withoutExtension(valid).map((name) => ({
      name,
      extensions: ["f32", "tri", "vtx", "pln", "lbl"].filter((e) => valid.includes(`${name}.${e}`)),
    })),
    invalid: withoutExtension(list("invalid")),
  };
}

export const vector = (name) => readFileSync(join(vectorsFolder, "valid", name));
export const importEntry = (name) => import(join(packageFolder, `${name}.mjs`));

const types = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".mjs": "text/javascript", ".json": "application/json" };

// Sends a file, or the range of it that is asked for.
function send(request, response, bytes, headers) {
  const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
  if (!range) return response.writeHead(200, headers).end(bytes);
  const part = bytes.subarray(Number(range[1]), Number(range[2]) + 1);
  const place = `bytes ${range[1]}-${Number(range[1]) + part.length - 1}/${bytes.length}`;
  response.writeHead(206, { ...headers, "content-range": place, "content-length": part.length }).end(part);
}

// Serves folders on this machine. roots: by the first part of a path; "" for the rest. policy: of all answers. compresses:
// scripts are sent as gzip.
export async function serve(roots, policy, compresses = false) {
  const server = createServer(async (request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname)).slice(1) || "index.html";
    const first = path.split("/")[0];
    const file = first in roots ? join(roots[first], path.slice(first.length + 1)) : join(roots[""], path);
    try {
      const bytes = await readFile(file);
      const headers = { "content-type": types[extname(file)] ?? "application/octet-stream" };
      if (policy) headers["content-security-policy"] = policy;
      if (!compresses || extname(file) !== ".js") return send(request, response, bytes, headers);
      response.writeHead(200, { ...headers, "content-encoding": "gzip" }).end(gzipSync(bytes));
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => (server.close(), server.closeAllConnections()) };
}

// options: more of the browser's.
export function launch(...options) {
  const asRoot = process.getuid?.() === 0 ? ["--no-sandbox"] : [];
  return chromium.launch({ executablePath, headless: true, args: [...asRoot, ...options] });
}

// Opens a page and collects the errors that nobody handles.
export async function open(browser, address) {
  const page = await browser.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  await page.goto(address);
  return { page, errors };
}
