// Runs in the page: draws a GLB whose meshes are .gim files, loaded at once or by ranges.
import * as THREE from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { GIMGLTFExtension, loadGIMScene } from "gim/three";

const next = () => new Promise(requestAnimationFrame);
const side = 400;
const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
renderer.setSize(side, side);
document.body.append(renderer.domElement);
const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 100);
camera.position.set(0, 1.5, 9);
camera.lookAt(0, -0.3, 0);

function stage(gltf) {
  const scene = new THREE.Scene().add(gltf.scene, new THREE.HemisphereLight(0xffffff, 0x30303a, 2));
  const light = new THREE.DirectionalLight(0xffffff, 2);
  light.position.set(-2, 3, 4);
  scene.background = new THREE.Color(0xeef0f4);
  return scene.add(light);
}
// Returns the picture's bytes in base64, row by row.
function draw(scene) {
  renderer.render(scene, camera);
  const gl = renderer.getContext(), pixels = new Uint8Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let text = "";
  for (let i = 0; i < pixels.length; i += 4) text += String.fromCharCode(pixels[i], pixels[i + 1], pixels[i + 2]);
  return { pixels: btoa(text), triangles: renderer.info.render.triangles };
}

window.drawWhole = async ({ url, level }) => {
  const loader = new GLTFLoader().register((parser) => new GIMGLTFExtension(parser, { level }));
  return draw(stage(await loader.loadAsync(url)));
};

let refining = null;
// Draws what is there when the promise of the load is kept.
window.beginScene = async ({ url, ...options }) => {
  const gltf = await loadGIMScene(url, new GLTFLoader(), options), errors = [];
  for (const mesh of gltf.gim.meshes) mesh.addEventListener("error", ({ error }) => errors.push(String(error)));
  refining = { gltf, scene: stage(gltf), errors };
  const { bytesLoaded, requests } = gltf.gim.source, levels = gltf.gim.meshes.map(({ level }) => level);
  return { ...draw(refining.scene), levels, bytesLoaded, requests };
};
// Draws until all meshes show the levels that they need, with their textures.
window.finishScene = async () => {
  const { gltf, scene, errors } = refining, { meshes } = gltf.gim;
  await gltf.gim.materials;
  while (errors.length === 0 && (draw(scene), meshes.some((mesh) => !mesh.isDone()))) await next();
  const found = { ...draw(scene), levels: meshes.map(({ level }) => level), errors, bytesLoaded: gltf.gim.source.bytesLoaded };
  gltf.gim.dispose();
  renderer.renderLists.dispose();
  return found;
};
window.isReady = true;
