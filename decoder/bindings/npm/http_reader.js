// Reads a file by HTTP in ranges. What servers answer instead of a range is taken where it can be:
//   200         the file from its start. It is read to its end, and nothing is asked again
//   416         some servers refuse a range that ends behind the file: asked again with the length that they tell
//   encoded     a range of a compressed body says nothing about ranges of the file: the whole file is fetched
//   changed     the file is read again from its start, once
//   cut off     the rest is asked for, once; so it is after a failure of the network or a status that passes
import { GimSourceError } from "./source_error.js";

const passing = new Set([429, 500, 502, 503, 504]);

// A failure that may be gone at the next try.
class PassingError extends GimSourceError {}

// Returns {begin, end, size} of "bytes 0-99/1234"; size is undefined for "*". Null: the header is not there.
function contentRange(response) {
  const found = /^bytes (?:(\d+)-(\d+)|\*)\/(?:(\d+)|\*)$/.exec(response.headers.get("content-range") ?? "");
  if (!found) return null;
  const number = (text, more) => (text === undefined ? undefined : Number(text) + more);
  return { begin: number(found[1], 0), end: number(found[2], 1), size: number(found[3], 0) };
}

// What tells one version of a file from another. Weak tags do not: equal ones may name different bytes.
function versionOf(response) {
  const tag = response.headers.get("etag");
  return { tag: tag && !tag.startsWith("W/") ? tag : null, modified: response.headers.get("last-modified") };
}
function differ(a, b) {
  if (a.tag && b.tag) return a.tag !== b.tag;
  return Boolean(a.modified && b.modified) && a.modified !== b.modified;
}

function isEncoded(response) {
  const coding = response.headers.get("content-encoding");
  return Boolean(coding) && coding !== "identity";
}

function sleep(milliseconds, signal) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, milliseconds);
    signal.addEventListener("abort", () => (clearTimeout(timer), reject(signal.reason)), { once: true });
  });
}

export class HttpReader {
  constructor(url, options) {
    this.url = url;
    this.fetch = options.fetch ?? ((...request) => fetch(...request));
    this.headers = options.headers ?? {};
    this.credentials = options.credentials;
    this.maxBytes = options.maxBytes ?? 2 ** 28;
    this.retryDelay = options.retryDelay ?? 300;
    this.bytesLoaded = 0;
    this.requests = 0;
    this.hasRanges = true;
    this.hasReloaded = false;
    this.version = null; // of the bytes that came so far
    this.size = undefined; // of the file, as the server says
  }

  // Appends the file's bytes from sink.position() to sink.end, or more, to the sink. Returns whether the file ends there.
  async read(sink, signal) {
    try {
      return await this.attempt(sink, signal);
    } catch (error) {
      if (signal.aborted || !(error instanceof PassingError)) throw error;
      await sleep(this.retryDelay, signal);
      return this.attempt(sink, signal);
    }
  }

  async attempt(sink, signal) {
    for (;;) {
      const begin = sink.position();
      const end = Math.min(sink.end, this.size ?? Infinity, begin + this.maxBytes - this.bytesLoaded);
      if (this.size !== undefined && begin >= this.size) return true;
      if (end <= begin) throw this.overBudget();
      const isEnd = await this.ask(sink, begin, end, signal);
      if (isEnd !== undefined) return isEnd;
    }
  }

  // Returns whether the file's end was reached. Undefined: ask again, for something else.
  async ask(sink, begin, end, signal) {
    const wanted = this.hasRanges ? { range: `bytes=${begin}-${end - 1}` } : {};
    const response = await this.send(wanted, signal);
    const range = contentRange(response);
    if (response.status === 416 && this.hasRanges) return this.refused(sink, response, range);
    if (response.status === 206 && this.hasRanges) {
      if (isEncoded(response) || (range && range.begin !== begin)) return this.giveUpRanges(response);
      if (this.hasChanged(response, range?.size)) return this.reload(sink, response);
      this.remember(response, range?.size);
      return this.take(sink, response, 0, (range?.end ?? end) - begin);
    }
    if (response.status === 200) return this.takeAll(sink, response, begin);
    this.drop(response);
    const Kind = passing.has(response.status) ? PassingError : GimSourceError;
    throw new Kind("HTTP", `${this.url}: status ${response.status}`, { httpStatus: response.status });
  }

  async send(wanted, signal) {
    ++this.requests;
    const request = { headers: { ...this.headers, ...wanted }, signal, cache: this.hasReloaded ? "reload" : "default" };
    if (this.credentials) request.credentials = this.credentials;
    try {
      return await this.fetch(this.url, request);
    } catch (cause) {
      if (signal.aborted) throw cause;
      throw new PassingError("NETWORK", `${this.url}: ${cause.cause?.message ?? cause.message}`, { cause });
    }
  }

  refused(sink, response, range) {
    this.drop(response);
    if (this.hasChanged(response, range?.size)) return this.reload(sink, response);
    if (this.size !== undefined || range?.size === undefined) return this.giveUpRanges(response);
    this.size = range.size;
    return undefined;
  }
  giveUpRanges(response) {
    this.drop(response);
    this.hasRanges = false;
    this.size = undefined;
    return undefined;
  }
  // The whole file came: the part before `begin` is here already, unless it is that of an older version.
  async takeAll(sink, response, begin) {
    this.hasRanges = false;
    const length = isEncoded(response) ? undefined : response.headers.get("content-length");
    if (begin > 0 && this.hasChanged(response)) {
      this.noteReload(sink);
      begin = 0;
    }
    this.remember(response);
    await this.take(sink, response, begin, length ? Number(length) - begin : Infinity);
    this.size = sink.position();
    return true;
  }

  hasChanged(response, size) {
    if (!this.version) return false;
    return differ(this.version, versionOf(response)) || (size !== undefined && this.size !== undefined && size !== this.size);
  }
  remember(response, size) {
    this.version = versionOf(response);
    this.size = size ?? this.size;
  }
  reload(sink, response) {
    this.drop(response);
    this.noteReload(sink);
    return undefined;
  }
  noteReload(sink) {
    if (this.hasReloaded) throw new GimSourceError("CHANGED", `${this.url}: the file changed again while it was read`);
    this.hasReloaded = true;
    this.version = null;
    this.size = undefined;
    sink.restart();
  }

  // Appends `count` bytes of the body behind the first `skipped`. Returns whether the file ends there.
  async take(sink, response, skipped, count) {
    let left = count;
    try {
      for await (let bytes of this.parts(response)) {
        this.bytesLoaded += bytes.length;
        const cut = Math.min(skipped, bytes.length);
        skipped -= cut;
        bytes = bytes.subarray(cut, Math.min(bytes.length, cut + left));
        left -= bytes.length;
        if (bytes.length > 0) sink.write(bytes);
        if (left <= 0) break;
        if (this.bytesLoaded >= this.maxBytes) throw this.overBudget();
      }
    } catch (cause) {
      if (cause instanceof GimSourceError || cause.name === "AbortError" || cause.status !== undefined) throw cause;
      throw new PassingError("TRUNCATED", `${this.url}: the answer broke off: ${cause.message}`, { cause });
    }
    if (left > 0 && left < Infinity) throw new PassingError("TRUNCATED", `${this.url}: the answer is ${left} bytes short`);
    return this.size !== undefined && sink.position() >= this.size;
  }
  async *parts(response) {
    if (!response.body) {
      yield new Uint8Array(await response.arrayBuffer());
      return;
    }
    const reader = response.body.getReader();
    try {
      for (;;) {
        const { done, value } = await reader.read();
        if (done) return;
        yield value;
      }
    } finally {
      reader.cancel().catch(() => {}); // does nothing at the end of the body
    }
  }
  drop(response) {
    response.body?.cancel().catch(() => {});
  }
  overBudget() {
    return new GimSourceError("BUDGET", `${this.url}: more than ${this.maxBytes} bytes would be loaded`);
  }
}
