// GimSource against nginx on loopback.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { mkdirSync, mkdtempSync, rmSync, utimesSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { startNginx, withoutNginx } from "./nginx.mjs";
import { importEntry, vector } from "./setup.mjs";
import { longFile } from "./made_files.mjs";

const { GimDecoder } = await importEntry("decoder");
const { GimSource, GimSourceError } = await importEntry("source");
await GimDecoder.ready;

const small = Uint8Array.from(vector("bounds.gim")), long = longFile(vector("bounds-two-images.gim"), 60000);
let folder, nginx;
const put = (name, bytes, time) => {
  const path = join(folder, "files", name);
  writeFileSync(path, bytes);
  if (time) utimesSync(path, time, time);
};
before(async () => {
  if (withoutNginx) return;
  folder = mkdtempSync(join(tmpdir(), "gim-nginx-"));
  mkdirSync(join(folder, "files"));
  nginx = await startNginx(folder);
});
after(async () => {
  await nginx?.stop();
  if (folder) rmSync(folder, { recursive: true, force: true });
});
const test_ = (name, run) => test(name, { skip: withoutNginx }, run);
const at = (place, name) => `${nginx.address}/${place}/${name}`;

function sameAs(bytes, file) {
  assert.deepEqual(Buffer.from(bytes), Buffer.from(file.subarray(0, bytes.length)));
}

test_("a small file takes one request, to its finest level", async () => {
  put("small.gim", small);
  const source = await GimSource.open(at("ranges", "small.gim"));
  for (let level = source.levelCount - 1; level >= 0; --level) sameAs(await source.level(level), small);
  assert.equal(source.requests, 1);
  assert.equal(source.bytesLoaded, small.length);
  GimDecoder.decodeMesh(source.bytes, { level: 0 });
});

test_("levels of a long file are ranges, and close ones are one", async () => {
  put("long.gim", long.bytes);
  const seen = [];
  const source = await GimSource.open(at("ranges", "long.gim"), { firstBytes: 64, onProgress: (p) => seen.push(p) });
  // The index is longer than the first request, so there is a second one.
  assert.equal(source.requests, 2);
  const before = source.requests;
  await Promise.all([source.level(3), source.level(2)]);
  assert.equal(source.requests, before + 1);
  assert.ok(source.has(2));
  const coarse = source.bytesLoaded;
  assert.ok(coarse < long.bytes.length - 50000, "what lies behind the levels stays where it is");
  sameAs(await source.whole(), long.bytes);
  assert.equal(source.bytesLoaded, long.bytes.length);
  assert.equal(seen.at(-1).loaded, long.bytes.length);
  assert.equal(seen.at(-1).total, long.bytes.length);
});

test_("a server without ranges sends the file once", async () => {
  put("long.gim", long.bytes);
  const source = await GimSource.open(at("no-ranges", "long.gim"));
  sameAs(await source.whole(), long.bytes);
  assert.equal(source.requests, 1);
  assert.equal(source.bytesLoaded, long.bytes.length);
});

test_("gzip on the way gives the same bytes", async () => {
  put("long.gim", long.bytes);
  const headers = { "accept-encoding": "gzip", range: "bytes=0-99" };
  const answer = await fetch(at("gzip", "long.gim"), { headers });
  assert.equal(answer.headers.get("content-encoding"), "gzip");
  await answer.arrayBuffer();
  const source = await GimSource.open(at("gzip", "long.gim"), { headers: { "accept-encoding": "gzip" } });
  sameAs(await source.whole(), long.bytes);
});

test_("a changed file is read again from its start", async () => {
  put("changed.gim", long.bytes, 1000);
  const source = await GimSource.open(at("ranges", "changed.gim"), { firstBytes: 256 });
  const other = longFile(small, 70000);
  put("changed.gim", other.bytes, 2000);
  sameAs(await source.whole(), other.bytes);
  assert.equal(source.generation, 1);
  assert.equal(source.info.imageCount, 1);
});

test_("a file that changes again and again is an error", async () => {
  put("restless.gim", long.bytes, 1000);
  const source = await GimSource.open(at("ranges", "restless.gim"), { firstBytes: 100 });
  put("restless.gim", long.bytes, 2000);
  await source.level(3);
  put("restless.gim", long.bytes, 3000);
  await assert.rejects(source.whole(), (error) => error instanceof GimSourceError && error.code === "CHANGED");
});

test_("a file that is shorter than its index says", async () => {
  put("cut.gim", small.subarray(0, small.length - 9));
  const source = await GimSource.open(at("ranges", "cut.gim"));
  await assert.rejects(source.level(0), { name: "GimSourceError", code: "TRUNCATED" });
  await source.level(source.levelCount - 1);
});

test_("no file, an empty file, another file", async () => {
  await assert.rejects(GimSource.open(at("ranges", "none.gim")), { code: "HTTP", httpStatus: 404 });
  put("empty.gim", new Uint8Array(0));
  await assert.rejects(GimSource.open(at("ranges", "empty.gim")), { name: "GimError", statusName: "NEED_MORE_INPUT" });
  put("text.gim", new TextEncoder().encode("<!doctype html>"));
  await assert.rejects(GimSource.open(at("ranges", "text.gim")), { name: "GimError", statusName: "NOT_GIM" });
});
