// Runs in the page: many meshes with automatic levels and one budget, seen by a camera that flies past them.
import * as THREE from "three";
import { GIMBudget, GIMMesh } from "gim/three";

const next = () => new Promise(requestAnimationFrame);

function place(meshes) {
  const side = Math.ceil(Math.sqrt(meshes.length));
  meshes.forEach((mesh, i) => mesh.position.set(3 * (i % side) - 1.5 * side, 0, -3 * Math.floor(i / side)));
}

// Returns what happened: {errors, most: of bytes, frames, milliseconds, levels: how often each was shown, shown: meshes}.
window.drawMany = async ({ urls, maxBytes, frames, pixelError }) => {
  const renderer = new THREE.WebGLRenderer();
  renderer.setSize(800, 600);
  document.body.append(renderer.domElement);
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(50, 800 / 600, 0.1, 200);
  const light = new THREE.DirectionalLight(0xffffff, 3);
  light.position.set(-1, 2, 2);
  scene.add(light, new THREE.AmbientLight(0xffffff, 0.5));
  scene.background = new THREE.Color(0xeef0f4);
  const budget = new GIMBudget(maxBytes), material = new THREE.MeshStandardMaterial({ color: 0xc8b090 });
  const found = { errors: [], most: 0, levels: {}, frames };
  const meshes = urls.map((url) => {
    const mesh = new GIMMesh(url, material, { budget, pixelError });
    mesh.addEventListener("error", ({ error }) => found.errors.push(String(error)));
    mesh.addEventListener("levelchange", ({ level }) => (found.levels[level] = (found.levels[level] ?? 0) + 1));
    return mesh;
  });
  place(meshes);
  scene.add(...meshes);
  while (meshes.some((mesh) => !mesh.images && !mesh.error)) await next();
  const begin = performance.now();
  for (let frame = 0; frame < frames; ++frame) {
    const t = frame / (frames - 1);
    camera.position.set(6 * Math.sin(3 * t), 3 - t, 8 - 30 * t);
    camera.lookAt(0, 0, camera.position.z - 10);
    budget.update(camera, renderer);
    renderer.render(scene, camera);
    found.most = Math.max(found.most, budget.byteCount);
    await next();
  }
  found.milliseconds = performance.now() - begin;
  camera.position.set(0, 6, 9);
  camera.lookAt(0, 0, -12);
  for (let i = 0; i < 10; ++i) {
    budget.update(camera, renderer);
    await next();
  }
  renderer.render(scene, camera);
  found.shown = meshes.filter((mesh) => mesh.level >= 0).length;
  found.geometries = renderer.info.memory.geometries;
  found.triangles = renderer.info.render.triangles;
  window.disposeMany = () => {
    meshes.forEach((mesh) => mesh.dispose());
    return { geometries: renderer.info.memory.geometries, bytes: budget.byteCount };
  };
  return found;
};
window.isReady = true;
