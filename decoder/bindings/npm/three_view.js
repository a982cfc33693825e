// How a camera of three.js sees an object, in the terms of gim_choose_level.
import { Matrix4, Vector2, Vector3 } from "three";

const eye = new Vector3(), inverse = new Matrix4(), size = new Vector2(), scales = new Vector3();

// viewport: a renderer, or the height of its picture in pixels.
export function viewportHeight(viewport) {
  return typeof viewport === "number" ? viewport : viewport.getDrawingBufferSize(size).y;
}

// box: in the object's coordinates. Returns {distance, verticalFov, viewportHeight}; lengths in the object's units.
export function viewOf(object, box, camera, viewport) {
  const height = viewportHeight(viewport);
  if (camera.isOrthographicCamera) {
    // What spans the picture at a right angle does so from half its height away.
    const seen = (camera.top - camera.bottom) / camera.zoom;
    return { distance: seen / 2 / largestScale(object), verticalFov: Math.PI / 2, viewportHeight: height };
  }
  eye.setFromMatrixPosition(camera.matrixWorld).applyMatrix4(inverse.copy(object.matrixWorld).invert());
  const largest = largestScale(object);
  // Scales that differ: the nearest that the box can be, the largest that an error can be.
  const distance = (box.distanceToPoint(eye) * Math.min(scales.x, scales.y, scales.z)) / largest;
  return { distance, verticalFov: (camera.getEffectiveFOV() * Math.PI) / 180, viewportHeight: height };
}
function largestScale(object) {
  scales.setFromMatrixScale(object.matrixWorld);
  return Math.max(scales.x, scales.y, scales.z);
}
