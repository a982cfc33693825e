// One level of a file, decoded with every sample as a vertex, so that a vertex is a place in the image.
import { GimDecoder } from "gim/decoder";

export const levelOf = (image, level) => Math.min(level, image.coarsest);

export function imagesOf(bytes, info) {
  return Array.from({ length: info.imageCount }, (_, image) => {
    const coarsest = GimDecoder.levelInfo(bytes, { image }).coarsestLevel;
    const ends = Array.from({ length: coarsest + 1 }, (_, level) => GimDecoder.levelInfo(bytes, { image, level }).prefixSize);
    return { image, coarsest, ends };
  });
}

// Returns {positions, normals, triangles, parts, box, milliseconds}; parts: {image, width, height, first} of each image.
export function decodeShape(bytes, info, images, level) {
  const begin = performance.now();
  const grids = images.map((image) => GimDecoder.decodeGrid(bytes, { image: image.image, level: levelOf(image, level), texcoords: false }));
  const milliseconds = performance.now() - begin;
  const count = (name) => grids.reduce((sum, grid) => sum + grid[name].length, 0);
  const shape = {
    positions: new Float32Array(count("positions")), normals: new Float32Array(count("positions")),
    triangles: new Uint32Array(count("triangles")), parts: [], milliseconds, level,
  };
  let first = 0, corner = 0;
  grids.forEach((grid, i) => {
    shape.positions.set(grid.positions, 3 * first);
    shape.normals.set(grid.normals, 3 * first);
    shape.triangles.set(grid.triangles.map((v) => v + first), corner);
    shape.parts.push({ image: images[i].image, level: levelOf(images[i], level), width: grid.width, height: grid.height, first });
    first += grid.positions.length / 3;
    corner += grid.triangles.length;
  });
  shape.box = boxOf(shape.positions);
  return shape;
}

function boxOf(positions) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    const value = positions[i], k = i % 3;
    if (value < low[k]) low[k] = value;
    if (value > high[k]) high[k] = value;
  }
  return { low, high };
}

// Colours of the file at the samples of a shape, nearest texel.
export function planeColours(bytes, shape) {
  const colours = new Float32Array(shape.positions.length);
  for (const { image, width, height, first } of shape.parts) {
    const plane = GimDecoder.decodePlane(bytes, { plane: "colors", image });
    for (let row = 0; row < height; ++row) {
      for (let column = 0; column < width; ++column) {
        const x = Math.round((column / (width - 1)) * (plane.width - 1)), y = Math.round((row / (height - 1)) * (plane.height - 1));
        colours.set(plane.values.subarray(3 * (y * plane.width + x), 3 * (y * plane.width + x) + 3), 3 * (first + row * width + column));
      }
    }
  }
  return colours;
}
