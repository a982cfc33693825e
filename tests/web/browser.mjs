// Debian's Chromium without a window, and pages for it. WebGL is drawn by SwiftShader.
import { spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { existsSync, readFileSync, statSync } from "node:fs";
import { extname, join, normalize } from "node:path";
import { gzipSync } from "node:zlib";
import { chromium } from "playwright-core";
import { packageFolder, root } from "./package_under_test.mjs";

const executablePath = process.env.GIM_CHROMIUM ?? "/usr/bin/chromium";
export const withoutBrowser = existsSync(executablePath) ? false : `no browser at ${executablePath}`;

export function launch() {
  const asRoot = process.getuid?.() === 0 ? ["--no-sandbox"] : [];
  const args = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", ...asRoot];
  return chromium.launch({ executablePath, headless: true, args });
}

// Makes one script of a page's sources, with three and the package in it.
export function bundle(source, output, more = []) {
  const options = ["--bundle", "--format=esm", "--target=es2022", "--log-level=warning", `--outfile=${output}`];
  const entries = ["decoder", "source", "three"].map((name) => `--alias:gim/${name}=${join(packageFolder, `${name}.mjs`)}`);
  const env = { ...process.env, NODE_PATH: join(root, "tests/web/node_modules") };
  const done = spawnSync("esbuild", [source, ...options, ...entries, ...more], { env, encoding: "utf8" });
  if (done.status !== 0) throw new Error(`esbuild: ${done.stderr ?? done.error}`);
}

const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json" };

// Serves folders by the first part of a path; "" for the rest. With ranges. compresses: scripts are sent as gzip.
export async function serve(roots, { compresses = false } = {}) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname)).slice(1);
    const first = path.split("/")[0];
    let file = first in roots && first !== "" ? join(roots[first], path.slice(first.length + 1)) : join(roots[""], path);
    if (existsSync(file) && statSync(file).isDirectory()) file = join(file, "index.html");
    if (!existsSync(file)) return response.writeHead(404).end();
    const bytes = readFileSync(file), headers = { "content-type": types[extname(file)] ?? "application/octet-stream" };
    if (compresses && extname(file) === ".js")
      return response.writeHead(200, { ...headers, "content-encoding": "gzip" }).end(gzipSync(bytes));
    const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
    if (!range) return response.writeHead(200, headers).end(bytes);
    const part = bytes.subarray(Number(range[1]), Number(range[2]) + 1);
    headers["content-range"] = `bytes ${range[1]}-${Number(range[1]) + part.length - 1}/${bytes.length}`;
    response.writeHead(206, { ...headers, "content-length": part.length }).end(part);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}`, stop: () => (server.closeAllConnections?.(), server.close()) };
}
