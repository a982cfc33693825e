// The surface in three.js: camera, mesh, folds, mark. Draws only when something changed.
import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, PerspectiveCamera, Raycaster, Scene, Sphere, SphereGeometry, Vector2, Vector3, WebGLRenderer,
  LineSegments, WireframeGeometry, LineBasicMaterial,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { viewOf } from "../../decoder/bindings/npm/three_view.js";

const plain = new Color(0.8, 0.76, 0.7);

export class SurfaceView {
  // onView(): the camera moved. onPoint(triangle's vertex or null): the pointer is there.
  constructor(canvas, { onView, onPoint }) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(40, 1, 0.01, 100);
    this.onView = onView;
    this.makeControls();
    this.material = new MeshStandardMaterial({ color: plain, roughness: 0.75, side: DoubleSide });
    this.mesh = new Mesh(new BufferGeometry(), this.material);
    this.folds = new Mesh(new BufferGeometry(), new MeshBasicMaterial({
      color: 0xe0101c, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -4,
    }));
    this.mark = new Mesh(new SphereGeometry(1, 16, 8), new MeshBasicMaterial({ color: 0xd01070 }));
    this.mark.visible = false;
    this.wire = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0x1a2438, transparent: true, opacity: 0.55 }));
    this.wire.visible = false;
    this.mesh.visible = false;
    this.addLights();
    this.scene.add(this.mesh, this.folds, this.mark, this.wire, this.camera);
    new ResizeObserver(() => (this.resize(), onView())).observe(canvas.parentElement);
    this.watchPointer(onPoint);
    this.watchKeys(onView);
  }
  addLights() {
    const key = new DirectionalLight(0xffffff, 2.1), fill = new DirectionalLight(0xffffff, 0.5);
    key.position.set(-0.45, 0.65, 0.62);
    fill.position.set(0.75, 0.05, 0.55);
    this.camera.add(key, fill, key.target, fill.target); // lights move with the eye
    key.target.position.set(0, 0, -1e-3);
    this.scene.add(new AmbientLight(0xffffff, 0.4));
  }

  // Shows a shape. fits: also moves the camera.
  show(shape, fits) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(shape.positions.map((value) => (Number.isNaN(value) ? 0 : value)), 3));
    geometry.setAttribute("normal", new BufferAttribute(shape.normals, 3));
    geometry.setIndex(new BufferAttribute(shape.triangles, 1));
    const low = new Vector3(...shape.box.low), high = new Vector3(...shape.box.high);
    geometry.boundingSphere = new Sphere(low.clone().add(high).multiplyScalar(0.5), Math.max(0.5 * low.distanceTo(high), 1e-20));
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
    this.mesh.visible = true;
    this.mark.scale.setScalar(0.012 * geometry.boundingSphere.radius);
    this.paintFolds(null);
    this.updateWire();
    if (fits) this.fit(low, high);
    this.draw();
  }
  // colours: three bytes a vertex, sRGB. Null: plain.
  paint(colours) {
    const { geometry } = this.mesh;
    if (colours) {
      const linear = new Float32Array(colours.length), table = Float32Array.from({ length: 256 }, (_, i) => new Color().setRGB(i / 255, 0, 0, "srgb").r);
      for (let i = 0; i < colours.length; ++i) linear[i] = table[colours[i]];
      geometry.setAttribute("color", new BufferAttribute(linear, 3));
    } else {
      geometry.deleteAttribute("color");
    }
    this.material.vertexColors = Boolean(colours);
    this.material.color.copy(colours ? new Color(1, 1, 1) : plain);
    this.material.needsUpdate = true;
    this.draw();
  }
  // folded: 1 for each triangle to paint red. Null: none.
  paintFolds(folded) {
    const index = [], { geometry } = this.mesh;
    folded?.forEach((isFolded, t) => isFolded && index.push(...geometry.index.array.subarray(3 * t, 3 * t + 3)));
    this.folds.geometry.dispose();
    this.folds.geometry = new BufferGeometry();
    if (index.length > 0) this.folds.geometry.setAttribute("position", geometry.attributes.position);
    this.folds.geometry.setIndex(index);
    this.folds.visible = index.length > 0;
    this.folds.frustumCulled = false;
    this.draw();
  }
  setWire(isOn) {
    this.wire.visible = isOn;
    this.updateWire();
    this.draw();
  }
  updateWire() {
    this.wire.geometry.dispose();
    this.wire.geometry = this.wire.visible && this.mesh.visible ? new WireframeGeometry(this.mesh.geometry) : new BufferGeometry();
    this.material.polygonOffset = this.wire.visible;
    this.material.polygonOffsetFactor = this.material.polygonOffsetUnits = 1;
    this.material.needsUpdate = true;
    this.wire.frustumCulled = false;
  }
  // position: of the marked sample; null: none.
  setMark(position) {
    this.mark.visible = position !== null;
    if (position) this.mark.position.fromArray(position);
    this.draw();
  }

  // They read the camera's up axis when they are made.
  makeControls() {
    this.controls?.dispose();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => (this.draw(), this.onView()));
  }

  // ---- camera -------------------------------------------------------------------------------------------------------

  fit(low, high) {
    if (low) this.bounds = [low, high];
    if (!this.bounds) return;
    const [from, to] = this.bounds, extent = to.clone().sub(from);
    const isFlat = extent.z < 0.4 * Math.min(extent.x, extent.y); // terrain
    const centre = from.clone().add(to).multiplyScalar(0.5), radius = Math.max(0.5 * extent.length(), 1e-20);
    const angle = (this.camera.fov * Math.PI) / 360, narrow = Math.min(1, this.camera.aspect);
    const distance = radius / Math.sin(Math.atan(Math.tan(angle) * narrow));
    this.camera.up.set(0, isFlat ? 0 : 1, isFlat ? 1 : 0);
    const way = isFlat ? new Vector3(-0.4, -0.8, 0.6) : new Vector3(-0.54, 0.34, 0.77);
    this.camera.position.copy(centre).addScaledVector(way.normalize(), distance);
    this.camera.near = radius / 100;
    this.camera.far = 40 * radius;
    this.camera.updateProjectionMatrix();
    this.makeControls();
    this.controls.minDistance = radius / 20;
    this.controls.maxDistance = 20 * radius;
    this.controls.target.copy(centre);
    this.controls.update();
  }
  // In the terms of GimDecoder.chooseLevel.
  view(box) {
    this.camera.updateMatrixWorld();
    return viewOf(this.mesh, box, this.camera, this.renderer);
  }
  // Turns the camera about its target by angles in radians, and moves it nearer or farther.
  move(aside, down, nearer) {
    const { target } = this.controls, offset = this.camera.position.clone().sub(target);
    const axis = this.camera.up;
    const side = new Vector3().crossVectors(axis, offset).normalize();
    const tilt = offset.angleTo(axis);
    const turned = Math.min(Math.max(tilt + down, 0.02), Math.PI - 0.02) - tilt;
    offset.applyAxisAngle(side, turned).applyAxisAngle(axis, aside).multiplyScalar(nearer);
    this.camera.position.copy(target).add(offset);
    this.controls.update();
  }
  watchKeys(onView) {
    const steps = {
      ArrowLeft: [-0.15, 0, 1], ArrowRight: [0.15, 0, 1], ArrowUp: [0, -0.12, 1], ArrowDown: [0, 0.12, 1],
      "+": [0, 0, 0.85], "=": [0, 0, 0.85], "-": [0, 0, 1 / 0.85],
    };
    this.canvas.addEventListener("keydown", (event) => {
      const step = steps[event.key];
      if (!step || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      this.move(...step);
      onView();
    });
  }
  watchPointer(onPoint) {
    const ray = new Raycaster(), place = new Vector2();
    let next = null;
    const look = () => {
      const event = next;
      next = null;
      const frame = this.canvas.getBoundingClientRect();
      place.set(((event.clientX - frame.left) / frame.width) * 2 - 1, 1 - ((event.clientY - frame.top) / frame.height) * 2);
      ray.setFromCamera(place, this.camera);
      const hit = this.mesh.visible ? ray.intersectObject(this.mesh)[0] : undefined;
      onPoint(hit ? this.nearestCorner(hit) : null);
    };
    this.canvas.addEventListener("pointermove", (event) => {
      if (event.buttons !== 0) return;
      if (!next) requestAnimationFrame(look);
      next = event;
    });
    this.canvas.addEventListener("click", (event) => {
      if (!next) requestAnimationFrame(look);
      next = event;
    });
  }
  nearestCorner({ face, point }) {
    const { position } = this.mesh.geometry.attributes, corner = new Vector3();
    const away = (v) => corner.fromBufferAttribute(position, v).distanceToSquared(point);
    return [face.a, face.b, face.c].reduce((best, v) => (away(v) < away(best) ? v : best));
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
  draw() {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.renderer.render(this.scene, this.camera);
    });
  }
}
