// Reads an original: a mesh in a format that three.js knows, as one list of triangles.
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { OBJLoader } from "three/examples/jsm/loaders/OBJLoader.js";
import { PLYLoader } from "three/examples/jsm/loaders/PLYLoader.js";

export const isOriginal = (name) => /\.(obj|ply|glb)$/i.test(name);

async function objectOf(name, bytes) {
  if (/\.obj$/i.test(name)) return new OBJLoader().parse(new TextDecoder().decode(bytes));
  return (await new GLTFLoader().parseAsync(bytes, "")).scene;
}

// bytes: an ArrayBuffer. Returns {positions, triangles}, in the coordinates of the scene.
export async function readOriginal(name, bytes) {
  const parts = [];
  if (/\.ply$/i.test(name)) {
    parts.push(new PLYLoader().parse(bytes));
  } else {
    const object = await objectOf(name, bytes);
    object.updateMatrixWorld(true);
    object.traverse((child) => child.isMesh && parts.push(child.geometry.clone().applyMatrix4(child.matrixWorld)));
  }
  const found = join(parts);
  if (found.triangles.length === 0) throw new Error(`${name} has no triangles`);
  return found;
}

function join(geometries) {
  const vertices = geometries.reduce((sum, { attributes }) => sum + attributes.position.count, 0);
  const corners = geometries.reduce((sum, { index, attributes }) => sum + (index ?? attributes.position).count, 0);
  const positions = new Float32Array(3 * vertices), triangles = new Uint32Array(corners - (corners % 3));
  let at = 0, next = 0;
  for (const { index, attributes } of geometries) {
    const { position } = attributes;
    for (let v = 0; v < position.count; ++v) positions.set([position.getX(v), position.getY(v), position.getZ(v)], 3 * (at + v));
    const count = (index ?? position).count;
    for (let i = 0; i < count; ++i) triangles[next++] = at + (index ? index.getX(i) : i);
    at += position.count;
  }
  return { positions, triangles };
}
