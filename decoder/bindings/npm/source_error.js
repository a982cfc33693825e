// Why a file could not be fetched. code: NETWORK, HTTP, CHANGED, TRUNCATED, BUDGET or CLOSED.
export class GimSourceError extends Error {
  constructor(code, message, options) {
    super(message, options);
    this.name = "GimSourceError";
    this.code = code;
    this.httpStatus = options?.httpStatus;
  }
}
