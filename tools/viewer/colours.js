// Colours of samples: three bytes each, sRGB.

const stops = [[48, 18, 130], [32, 120, 200], [40, 180, 130], [230, 210, 60], [200, 30, 30]];
// share: 0 .. 1.
export function ramp(share) {
  const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1), i = Math.min(Math.floor(place), stops.length - 2), t = place - i;
  return stops[i].map((value, k) => Math.round(value + t * (stops[i + 1][k] - value)));
}

export function drawRamp(canvas) {
  const context = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; ++x) {
    context.fillStyle = `rgb(${ramp(x / (canvas.width - 1))})`;
    context.fillRect(x, 0, 1, canvas.height);
  }
}

// A value that few are above.
export function highEnd(values) {
  const sorted = values.filter((value) => !Number.isNaN(value)).sort();
  return sorted[Math.floor(0.99 * (sorted.length - 1))] || sorted.at(-1) || 1;
}

const byte = (value) => Math.round(255 * Math.min(Math.max(value, 0), 1));
const makers = {
  position: ({ positions, box }) => (v, k) => byte((positions[3 * v + k] - box.low[k]) / (box.high[k] - box.low[k] || 1)),
  normal: ({ normals }) => (v, k) => byte(0.5 + 0.5 * normals[3 * v + k]),
  plane: ({ plane }) => (v, k) => byte(plane[3 * v + k]),
  error: ({ distances, high }) => (v, k) => ramp(distances[v] / high)[k],
};
// kind: a key of makers. shape: what it reads.
export function coloursOf(kind, shape) {
  const colour = makers[kind](shape), colours = new Uint8Array(shape.positions.length);
  for (let v = 0; v < shape.positions.length / 3; ++v) for (let k = 0; k < 3; ++k) colours[3 * v + k] = colour(v, k);
  return colours;
}
