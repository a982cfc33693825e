// GimSource against servers that do what nginx does not, and from memory.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { createServer } from "node:http";
import { gzipSync } from "node:zlib";
import { importEntry, vector } from "./setup.mjs";
import { longFile } from "./made_files.mjs";

const { GimDecoder } = await importEntry("decoder");
const { GimSource } = await importEntry("source");
await GimDecoder.ready;

const file = Uint8Array.from(vector("bounds-two-images.gim")), long = longFile(file, 60000).bytes;
const quick = { retryDelay: 1 };
const servers = [];
after(() => servers.forEach((server) => (server.closeAllConnections?.(), server.close())));

// answer(request, response, range, count): range is [begin, end) or null; count: how many requests came before.
async function serve(answer) {
  let count = 0;
  const server = createServer((request, response) => {
    const found = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
    answer(request, response, found && [Number(found[1]), Number(found[2]) + 1], count++);
  });
  servers.push(server);
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return `http://127.0.0.1:${server.address().port}/x.gim`;
}
function sendRange(response, bytes, [begin, end], headers = {}) {
  const part = bytes.subarray(begin, end);
  const range = `bytes ${begin}-${begin + part.length - 1}/${bytes.length}`;
  response.writeHead(206, { "content-range": range, "content-length": part.length, ...headers });
  response.end(part);
}
const sameAs = (bytes, wanted) => assert.deepEqual(Buffer.from(bytes), Buffer.from(wanted));

test("416 for a range beyond the end: asked again with the length", async () => {
  const url = await serve((_, response, range) => {
    if (range[1] <= file.length) return sendRange(response, file, range);
    response.writeHead(416, { "content-range": `bytes */${file.length}` }).end();
  });
  const source = await GimSource.open(url);
  sameAs(await source.level(0), file);
  assert.equal(source.requests, 2);
});

test("416 without a length: the whole file", async () => {
  const url = await serve((_, response, range) => (range ? response.writeHead(416).end() : response.end(file)));
  sameAs(await (await GimSource.open(url)).level(0), file);
});

test("an encoded range: the whole file", async () => {
  const url = await serve((_, response, range) => {
    if (!range) return response.end(long);
    const part = gzipSync(long).subarray(...range);
    const headers = { "content-encoding": "gzip", "content-range": `bytes ${range[0]}-${range[1] - 1}/*` };
    response.writeHead(206, headers).end(part);
  });
  sameAs(await (await GimSource.open(url)).whole(), long);
});

test("a range from elsewhere: the whole file", async () => {
  const url = await serve((_, response, range) => {
    if (!range) return response.end(long);
    sendRange(response, long, [range[0] + 1, range[1] + 1]);
  });
  sameAs(await (await GimSource.open(url)).whole(), long);
});

test("a range without Content-Range, as a page of another origin sees it", async () => {
  const url = await serve((_, response, range) => {
    const part = long.subarray(...range);
    response.writeHead(206, { "content-length": part.length }).end(part);
  });
  sameAs(await (await GimSource.open(url)).whole(), long);
});

test("an answer that breaks off: the rest is asked for", async () => {
  const asked = [];
  const url = await serve((_, response, range, count) => {
    asked.push(range[0]);
    if (count !== 1) return sendRange(response, long, range);
    response.writeHead(206, { "content-range": `bytes ${range[0]}-${range[1] - 1}/${long.length}`, "content-length": range[1] - range[0] });
    response.write(long.subarray(range[0], range[0] + 20000), () => setTimeout(() => response.destroy(), 50));
  });
  const source = await GimSource.open(url, quick);
  sameAs(await source.whole(), long);
  assert.ok(asked.length === 3 && asked[2] > asked[1], `asked from ${asked}`);
});

test("an answer that breaks off twice is an error, and what came stays", async () => {
  const url = await serve((_, response, range, count) => {
    if (count === 0) return sendRange(response, long, range);
    response.writeHead(206, { "content-range": `bytes ${range[0]}-${range[1] - 1}/${long.length}`, "content-length": range[1] - range[0] });
    response.write(long.subarray(range[0], range[0] + 100), () => setTimeout(() => response.destroy(), 50));
  });
  const source = await GimSource.open(url, quick);
  await assert.rejects(source.whole(), { name: "GimSourceError", code: "TRUNCATED" });
  sameAs(await source.level(0), long.subarray(0, source.bytes.length));
});

test("weak tags say nothing, strong ones do", async () => {
  const strings = (kind) => serve((_, response, range, count) => sendRange(response, long, range, { etag: `${kind}"${count}"` }));
  const weak = await GimSource.open(await strings("W/"), { firstBytes: 256 });
  sameAs(await weak.whole(), long);
  assert.equal(weak.generation, 0);
  const strong = await GimSource.open(await strings(""), { firstBytes: 256 });
  sameAs(await strong.whole(), long);
  assert.equal(strong.generation, 1);
});

test("a changed file in a 200 is taken as it comes", async () => {
  const url = await serve((_, response, range, count) => {
    if (count === 0) return sendRange(response, long, range, { etag: '"a"' });
    response.writeHead(200, { etag: '"b"' }).end(file);
  });
  const source = await GimSource.open(url, { firstBytes: 256 });
  sameAs(await source.whole(), file);
  assert.equal(source.requests, 2);
  assert.equal(source.generation, 1);
});

test("200 to a later request: the part that is here is not taken twice", async () => {
  const url = await serve((_, response, range, count) => (count === 0 ? sendRange(response, long, range) : response.end(long)));
  const source = await GimSource.open(url, { firstBytes: 256 });
  sameAs(await source.whole(), long);
});

test("a status that passes is tried again, once", async () => {
  const once = await serve((_, response, range, count) =>
    count === 0 ? response.writeHead(503).end() : sendRange(response, file, range));
  sameAs(await (await GimSource.open(once, quick)).level(0), file);
  const always = await serve((_, response) => response.writeHead(503).end());
  await assert.rejects(GimSource.open(always, quick), { code: "HTTP", httpStatus: 503 });
});

test("no server", async () => {
  const server = createServer().listen(0, "127.0.0.1");
  await new Promise((resolve) => server.on("listening", resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  await assert.rejects(GimSource.open(`http://127.0.0.1:${port}/x.gim`, quick), { code: "NETWORK" });
});

test("a signal ends the opening, and a wait", async () => {
  let closed = 0;
  const url = await serve((_, response, range, count) => {
    response.on("close", () => ++closed);
    if (count === 0) sendRange(response, long, range);
  });
  const source = await GimSource.open(url);
  const one = new AbortController(), other = new AbortController();
  const waits = [source.whole({ signal: one.signal }), source.whole({ signal: other.signal })];
  waits.forEach((wait) => wait.catch(() => {}));
  setTimeout(() => one.abort(), 20);
  await assert.rejects(waits[0], { name: "AbortError" });
  assert.equal(closed, 1, "the request goes on for the other");
  other.abort(new Error("enough"));
  await assert.rejects(waits[1], { message: "enough" });
  while (closed < 2) await new Promise((resolve) => setTimeout(resolve, 10));
  await assert.rejects(GimSource.open(url, { signal: AbortSignal.abort() }), { name: "AbortError" });
});

test("close() ends a wait", async () => {
  const url = await serve((_, response, range, count) => count === 0 && sendRange(response, long, range));
  const source = await GimSource.open(url);
  const wait = source.whole();
  setTimeout(() => source.close(), 20);
  await assert.rejects(wait, { code: "CLOSED" });
  await assert.rejects(source.level(0), { code: "CLOSED" });
});

test("no more than maxBytes are loaded", async () => {
  const ranges = await serve((_, response, range) => sendRange(response, long, range));
  const source = await GimSource.open(ranges, { maxBytes: 30000 });
  await source.level(0);
  await assert.rejects(source.whole(), { code: "BUDGET" });
  assert.ok(source.bytesLoaded <= 30000);
  const endless = await serve((_, response) => {
    const block = Buffer.alloc(65536);
    const send = () => response.destroyed || response.write(block, () => setImmediate(send));
    response.write(long), send();
  });
  const stream = await GimSource.open(endless, { maxBytes: 200000 });
  await stream.whole();
  assert.ok(stream.bytesLoaded < 400000);
});

test("bytes and blobs", async () => {
  for (const input of [file, file.slice().buffer, new DataView(file.slice().buffer), new Blob([file])]) {
    const source = await GimSource.open(input, { firstBytes: 128 });
    sameAs(await source.level(0), file);
  }
  const cut = await GimSource.open(file.subarray(0, file.length - 1));
  await assert.rejects(cut.level(0), { code: "TRUNCATED" });
  const cutBlob = await GimSource.open(new Blob([file.subarray(0, file.length - 1)]));
  await assert.rejects(cutBlob.level(0), { code: "TRUNCATED" });
  await assert.rejects(cut.level(9), RangeError);
  await assert.rejects(cut.plane("colors"), RangeError);
});
