// The comparison of tests/gpu/compare_frames.cpp, for a frame as bytes.

const isColour = (bytes, at, colour) => bytes[at] === colour[0] && bytes[at + 1] === colour[1] && bytes[at + 2] === colour[2];
const background = [255, 0, 255];
const backFace = [0, 0, 255];

// samples: the reference, `finer` times as many in each direction. contested: 1 for samples where any surface will do.
// Returns the largest difference to what is within one pixel, and pixels that show background or backs where none is.
export function compare(frame, samples, contested, side, finer) {
  const wide = side * finer;
  const between = (x, y, u, v) => {
    const a = 4 * (y * side + x);
    const b = 4 * (v * wide + u);
    if (contested[v * wide + u] && !isColour(frame, a, background)) return 0;
    let most = 0;
    for (let k = 0; k < 3; ++k) most = Math.max(most, Math.abs(frame[a + k] - samples[b + k]));
    return most;
  };
  const centre = (place) => finer * place + (finer - 1) / 2;
  const around = (x, y, reach, size, visit) => {
    for (let v = Math.max(y - reach, 0); v <= Math.min(y + reach, size - 1); ++v)
      for (let u = Math.max(x - reach, 0); u <= Math.min(x + reach, size - 1); ++u) visit(u, v);
  };
  const found = { worst: 0, background: 0, backs: 0 };
  for (let y = 1; y + 1 < side; ++y) {
    for (let x = 1; x + 1 < side; ++x) {
      if (between(x, y, centre(x), centre(y)) <= 1) continue;
      let toReference = 255;
      let toFrame = 255;
      let hasBackground = false;
      let hasBack = false;
      around(centre(x), centre(y), finer, wide, (u, v) => {
        toReference = Math.min(toReference, between(x, y, u, v));
        const b = 4 * (v * wide + u);
        hasBackground ||= isColour(samples, b, background);
        hasBack ||= isColour(samples, b, backFace) || contested[v * wide + u] !== 0;
      });
      around(x, y, 1, side, (u, v) => (toFrame = Math.min(toFrame, between(u, v, centre(x), centre(y)))));
      found.worst = Math.max(found.worst, toReference, toFrame);
      const a = 4 * (y * side + x);
      if (isColour(frame, a, background) && !hasBackground) ++found.background;
      if (isColour(frame, a, backFace) && !hasBack) ++found.backs;
    }
  }
  return found;
}
