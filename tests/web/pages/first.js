// Runs in the page: from the call that loads a file to the frame that shows its first triangle.
import * as THREE from "three";
import { GIMMesh } from "gim/three";

const next = () => new Promise(requestAnimationFrame);

const renderer = new THREE.WebGLRenderer();
renderer.setSize(400, 400);
document.body.append(renderer.domElement);
const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(45, 1, 0.001, 100);
scene.add(new THREE.HemisphereLight());
const material = new THREE.MeshLambertMaterial();

// The page has drawn with this material before, as one that shows other things has.
async function warm() {
  const box = new THREE.Mesh(new THREE.BoxGeometry(), material);
  camera.position.set(0, 0, 5);
  scene.add(box);
  renderer.render(scene, camera);
  scene.remove(box);
  await next();
}

// Returns milliseconds until the frame after the one that has a triangle, and until the level that the camera needs.
window.measureFirst = async (url, isWarm) => {
  if (isWarm) await warm();
  const begin = performance.now(), found = {};
  const mesh = new GIMMesh(url, material);
  mesh.addEventListener("finished", () => (found.isFinished = true));
  mesh.addEventListener("error", ({ error }) => (found.error = String(error)));
  scene.add(mesh);
  while (!found.finest && !found.error) {
    await next();
    const { boundingSphere } = mesh.geometry;
    if (boundingSphere?.radius > 0) {
      camera.position.copy(boundingSphere.center);
      camera.position.z += 3 * boundingSphere.radius;
    }
    renderer.render(scene, camera);
    if (renderer.info.render.triangles === 0) continue;
    if (found.first === undefined) {
      found.triangles = renderer.info.render.triangles;
      await next();
      found.first = performance.now() - begin;
      found.sinceNavigation = performance.now();
    }
    if (found.isFinished && mesh.level === 0) found.finest = performance.now() - begin;
  }
  found.requests = mesh.source?.requests;
  found.bytes = mesh.source?.bytesLoaded;
  scene.remove(mesh);
  mesh.dispose();
  return found;
};
if (new URLSearchParams(location.search).has("cold")) window.measureFirst("/x.gim", false).then((found) => (window.cold = found));
window.isReady = true;
