// Reads a Blob or a File in parts.
import { GimSourceError } from "./source_error.js";

export class BlobReader {
  constructor(blob) {
    this.blob = blob;
    this.bytesLoaded = 0;
    this.requests = 0;
  }

  // As that of HttpReader.
  async read(sink, signal) {
    ++this.requests;
    const part = this.blob.slice(sink.position(), sink.end);
    const bytes = await part.arrayBuffer().catch((cause) => {
      throw new GimSourceError("NETWORK", `the file cannot be read: ${cause.message}`, { cause });
    });
    if (signal.aborted) return false;
    this.bytesLoaded += bytes.byteLength;
    sink.write(new Uint8Array(bytes));
    return sink.position() >= this.blob.size;
  }
}
