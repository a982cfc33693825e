// Runs in the page: draws a geometry as gim render does (tools/render.cpp), by three.js.
import * as THREE from "three";
import { GIMLoader, GIMMesh } from "gim/three";

const eyeDistance = 4.5, filled = 0.92;

// The model's axes as the camera sees them; y is up.
function axesOf(azimuth, elevation) {
  const radians = Math.PI / 180;
  return new THREE.Matrix4().makeRotationX(elevation * radians).multiply(new THREE.Matrix4().makeRotationY(azimuth * radians));
}

// Puts the mesh where gim render has it, and makes the camera's projection that of gim render.
function place(mesh, camera, side, azimuth, elevation) {
  const { position } = mesh.geometry.attributes, { index } = mesh.geometry;
  const box = new THREE.Box3().setFromBufferAttribute(position), centre = box.getCenter(new THREE.Vector3());
  const radius = 0.5 * box.getSize(new THREE.Vector3()).length();
  const turn = axesOf(azimuth, elevation);
  mesh.matrixAutoUpdate = false;
  mesh.matrix.copy(turn).multiply(new THREE.Matrix4().makeScale(1 / radius, 1 / radius, 1 / radius))
    .multiply(new THREE.Matrix4().makeTranslation(-centre.x, -centre.y, -centre.z));
  mesh.matrixWorldNeedsUpdate = true;
  const low = new THREE.Vector2(Infinity, Infinity), high = low.clone().negate(), seen = new THREE.Vector3();
  for (let i = 0; i < index.count; ++i) {
    seen.fromBufferAttribute(position, index.getX(i)).applyMatrix4(mesh.matrix);
    const p = new THREE.Vector2(seen.x, seen.y).divideScalar(eyeDistance - seen.z);
    low.min(p);
    high.max(p);
  }
  const size = high.clone().sub(low), middle = high.clone().add(low).multiplyScalar(0.5);
  const scale = (2 * filled) / Math.max(size.x, size.y), near = 1, far = 10;
  const shift = 1 / (3 * side); // gim render looks at the corners of samples, a GPU at their centres
  camera.position.set(0, 0, eyeDistance);
  camera.projectionMatrix.set(
    scale, 0, scale * middle.x - shift, 0, 0, scale, scale * middle.y + shift, 0,
    0, 0, -(far + near) / (far - near), (-2 * far * near) / (far - near), 0, 0, -1, 0);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
}

const fragment = `
  varying vec3 seenNormal, seenPlace;
  uniform bool isFlat;
  vec3 linear(vec3 colour) { return pow(colour, vec3(2.2)); }
  void main() {
    vec3 facet = normalize(cross(dFdx(seenPlace), dFdy(seenPlace)));
    vec3 n = isFlat ? facet : normalize(seenNormal);
    if (n.z < 0.0) n = -n;
    vec3 key = normalize(vec3(-0.45, 0.65, 0.62)), fill = normalize(vec3(0.75, 0.05, 0.55));
    float wrapped = max(0.0, (dot(n, key) + 0.15) / 1.15), sky = 0.5 + 0.5 * n.y;
    float diffuse = 0.95 * wrapped + 0.22 * max(0.0, dot(n, fill)) + 0.10 + 0.14 * sky;
    float gloss = 0.10 * pow(max(0.0, dot(n, normalize(key + vec3(0.0, 0.0, 1.0)))), 24.0);
    vec3 albedo = linear(gl_FrontFacing ? vec3(0.80, 0.76, 0.70) : vec3(0.80, 0.35, 0.28));
    gl_FragColor = vec4(pow(albedo * diffuse + gloss, vec3(1.0 / 2.2)), 1.0);
  }`;
const vertex = `
  varying vec3 seenNormal, seenPlace;
  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    seenPlace = place.xyz;
    seenNormal = normalMatrix * normal;
    gl_Position = projectionMatrix * place;
  }`;

// Returns side*side*3 bytes, row by row, as averages of 3 x 3 samples in linear light, in base64; and how many pixels show
// the surface.
function averaged(gl, side) {
  const wide = 3 * side, top = [0.97, 0.975, 0.98], bottom = [0.86, 0.875, 0.9];
  const background = (row, k) => (top[k] + (row / wide) * (bottom[k] - top[k])) ** 2.2;
  const samples = new Uint8Array(4 * wide * wide);
  gl.readPixels(0, 0, wide, wide, gl.RGBA, gl.UNSIGNED_BYTE, samples);
  const light = Float32Array.from({ length: 256 }, (_, byte) => (byte / 255) ** 2.2);
  let text = "", painted = 0;
  for (let row = 0; row < side; ++row) {
    for (let column = 0; column < side; ++column) {
      for (let k = 0; k < 3; ++k) {
        let sum = 0;
        for (let i = 0; i < 9; ++i) {
          const y = wide - 1 - (3 * row + Math.floor(i / 3)), x = 3 * column + (i % 3);
          const at = 4 * (y * wide + x);
          sum += samples[at + 3] ? light[samples[at + k]] : background(3 * row + Math.floor(i / 3), k);
          painted += samples[at + 3] && k === 0 ? 1 / 9 : 0;
        }
        text += String.fromCharCode(Math.round(255 * (sum / 9) ** (1 / 2.2)));
      }
    }
  }
  return { pixels: btoa(text), painted };
}

// how: "loader" or "mesh".
window.drawView = async ({ url, level, side, azimuth, elevation, isFlat, how }) => {
  const renderer = new THREE.WebGLRenderer({ alpha: true, antialias: false, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setSize(3 * side, 3 * side);
  renderer.setClearColor(0xffffff, 0);
  document.body.append(renderer.domElement);
  const material = new THREE.ShaderMaterial({
    vertexShader: vertex, fragmentShader: fragment, side: THREE.DoubleSide, uniforms: { isFlat: { value: isFlat } },
  });
  let mesh;
  if (how === "loader") {
    mesh = new THREE.Mesh(await new GIMLoader().setTextures(false).setLevel(level).loadAsync(url), material);
  } else {
    mesh = new GIMMesh(url, material, { level, textures: false });
    await new Promise((resolve, reject) => {
      mesh.addEventListener("finished", resolve);
      mesh.addEventListener("error", ({ error }) => reject(error));
    });
  }
  const camera = new THREE.PerspectiveCamera(), scene = new THREE.Scene();
  scene.add(mesh);
  place(mesh, camera, side, azimuth, elevation);
  renderer.render(scene, camera);
  const { pixels, painted } = averaged(renderer.getContext(), side);
  renderer.dispose();
  renderer.domElement.remove();
  return { pixels, painted, triangles: mesh.geometry.index.count / 3 };
};
window.isReady = true;
