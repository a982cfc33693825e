// Who reads an input. A reader has read(sink, signal), bytesLoaded and requests; http_reader.js tells what read() does.
import { BlobReader } from "./blob_reader.js";
import { HttpReader } from "./http_reader.js";

// A part of a file that is read by ranges (source_glb.js).
export class PartReader {
  constructor(file, begin, size) {
    this.file = file;
    this.begin = begin;
    this.size = size;
    this.bytesLoaded = 0;
    this.requests = 0;
  }
  async read(sink, signal) {
    const from = sink.position(), to = Math.min(sink.end, this.size);
    if (from < to) {
      ++this.requests;
      const write = (bytes) => {
        this.bytesLoaded += bytes.length;
        sink.write(bytes);
      };
      await this.file.fetch(this.begin + from, this.begin + to, write, signal);
    }
    return sink.position() >= this.size;
  }
}

// Null: the input is the bytes themselves.
export function readerOf(input, options) {
  if (input instanceof PartReader) return input;
  if (typeof input === "string" || input instanceof URL) return new HttpReader(String(input), options);
  if (typeof Blob === "function" && input instanceof Blob) return new BlobReader(input);
  return null;
}

export function bytesOf(input) {
  return ArrayBuffer.isView(input) ? new Uint8Array(input.buffer, input.byteOffset, input.byteLength) : new Uint8Array(input);
}
