// What went wrong, as the decoder says it (gim/decoder.h, gim_status).
const names = ["OK", "NOT_GIM", "UNSUPPORTED_VERSION", "MALFORMED", "LIMIT_EXCEEDED", "BAD_ARGUMENT",
  "SCRATCH_TOO_SMALL", "CHECKSUM", "NO_SUCH_LEVEL", "NO_SUCH_PLANE"];

export class GimError extends Error {
  constructor(status, message) {
    super(message);
    this.name = "GimError";
    this.status = status;
    this.statusName = status < 0 ? "NEED_MORE_INPUT" : names[status];
  }
}

export function fail(status, text) {
  throw new GimError(status, text);
}
