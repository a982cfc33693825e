// Whether two pictures of the same view are the same but for how edges are sampled. Three bytes a pixel, row by row.

// Each pixel is compared with the nearest colour among the 3 x 3 pixels around its place in the other picture, both ways.
// Returns the largest difference and how many pixels differ by more than `close`.
export function comparePictures(a, b, side, close) {
  const found = { worst: 0, off: 0 };
  const away = (from, to, x, y) => {
    let least = 255;
    for (let v = Math.max(y - 1, 0); v <= Math.min(y + 1, side - 1); ++v) {
      for (let u = Math.max(x - 1, 0); u <= Math.min(x + 1, side - 1); ++u) {
        let most = 0;
        for (let k = 0; k < 3; ++k) most = Math.max(most, Math.abs(from[3 * (y * side + x) + k] - to[3 * (v * side + u) + k]));
        least = Math.min(least, most);
      }
    }
    return least;
  };
  for (let y = 0; y < side; ++y) {
    for (let x = 0; x < side; ++x) {
      const difference = Math.max(away(a, b, x, y), away(b, a, x, y));
      found.worst = Math.max(found.worst, difference);
      if (difference > close) ++found.off;
    }
  }
  return found;
}
