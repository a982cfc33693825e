// The viewer: opens files, shows a level of them, and keeps surface, image and settings in step.
import { Box3, Vector3 } from "three";
import { GimDecoder } from "gim/decoder";
import { GimSource } from "gim/source";
import { coloursOf, drawRamp, highEnd } from "./colours.js";
import { ImageView } from "./image_view.js";
import { Measure } from "./measure.js";
import { isOriginal, readOriginal } from "./original.js";
import { decodeShape, imagesOf, levelOf, planeColours } from "./shape.js";
import { SurfaceView } from "./surface_view.js";

const at = (id) => document.getElementById(id);
const count = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });
const length = (value) => (value === 0 ? "0" : value.toPrecision(3));

const measure = new Measure();
const surface = new SurfaceView(at("surface"), { onView: chooseLevel, onPoint: markVertex });
const image = new ImageView(at("image"), at("cross"), markSample);
const file = { source: null, images: null, name: "" }; // the file that is open
let shape = null; // its level that is shown
let original = null; // {name, diagonal}
let isBusy = false; // a level is on its way
let opening = null; // AbortController

// ---- files ------------------------------------------------------------------------------------------------------------

async function openGim(input, name) {
  opening?.abort();
  const { signal } = (opening = new AbortController());
  say("");
  try {
    const source = await GimSource.open(input, { signal, onProgress: showBytes });
    await source.level(source.levelCount - 1, { signal });
    file.source?.close();
    Object.assign(file, { source, name, images: imagesOf(source.bytes, source.info) });
    shape = null;
    begin();
    await showLevel(Math.min(source.levelCount - 1, Number(new URLSearchParams(location.search).get("level") ?? 0)));
  } catch (error) {
    if (!signal.aborted) say(`${name}: ${error.message}`);
  }
}
// Sets the controls for the file that was opened.
function begin() {
  const { source, images } = file;
  at("hint").hidden = true;
  Object.assign(at("level"), { max: source.levelCount - 1, disabled: source.levelCount < 2 });
  at("fact-file").textContent = `${file.name}, ${source.info.layout}, ${source.info.coding}`;
  at("image-row").hidden = images.length < 2;
  at("which").replaceChildren(...images.map((_, i) => new Option(`${i + 1} of ${images.length}`, i)));
  const hasColours = source.chunks.some((chunk) => chunk.name === "COLR");
  at("colour").querySelector("[value=plane]").disabled = !hasColours;
  if (at("colour").selectedOptions[0].disabled) at("colour").value = "plain";
  image.mark(null);
  surface.setMark(null);
}
async function openOriginal(name, bytes) {
  say("");
  try {
    const mesh = await readOriginal(name, bytes), low = new Vector3(), high = new Vector3();
    new Box3().setFromArray(mesh.positions).getSize(high);
    original = { name, diagonal: high.sub(low).length() };
    await measure.ask("original", relativeTo(mesh));
    at("fact-original").textContent = `${name}, ${count.format(mesh.triangles.length / 3)} triangles`;
    at("colour").querySelector("[value=error]").disabled = false;
    at("colour").value = "error";
    shape?.forget();
    await repaint();
  } catch (error) {
    say(`${name}: ${error.message}`);
  }
}
// The original in the coordinates of decoded positions.
function relativeTo(mesh) {
  const info = file.source?.info;
  if (!info?.isRelative) return mesh;
  return { ...mesh, positions: mesh.positions.map((value, i) => value - info.origin[i % 3]) };
}
async function openFiles(files) {
  const list = [...files];
  const known = list.filter((one) => /\.gim$/i.test(one.name) || isOriginal(one.name));
  for (const one of list) if (!known.includes(one)) say(`${one.name}: not a .gim, .obj, .ply or .glb file`);
  for (const one of known.filter(({ name }) => /\.gim$/i.test(name))) await openGim(one, one.name);
  for (const one of known.filter(({ name }) => isOriginal(name))) await openOriginal(one.name, await one.arrayBuffer());
}
const lastPart = (address) => decodeURIComponent(new URL(address, location.href).pathname.split("/").pop());
async function openAddresses() {
  const query = new URLSearchParams(location.search), url = query.get("url"), other = query.get("original");
  if (url) {
    at("url").value = url;
    await openGim(new URL(url, location.href), lastPart(url));
  }
  if (!other) return;
  const response = await fetch(other).catch((error) => say(`${other}: ${error.message}`));
  if (response?.ok) await openOriginal(lastPart(other), await response.arrayBuffer());
  else if (response) say(`${other}: status ${response.status}`);
}

// ---- levels -----------------------------------------------------------------------------------------------------------

async function showLevel(level) {
  at("level").value = file.source.levelCount - 1 - level; // finer to the right
  at("level-value").textContent = `${level} of 0 – ${file.source.levelCount - 1}`;
  at("level").setAttribute("aria-valuetext", `level ${level}`);
  file.wanted = level;
  if (isBusy) return;
  isBusy = true;
  try {
    while (shape?.source !== file.source || shape.level !== file.wanted) await load(file.wanted);
  } catch (error) {
    say(`${file.name}: ${error.message}`);
  } finally {
    isBusy = false;
  }
}
async function load(level) {
  const { source, images } = file, isFirst = shape?.source !== source;
  const end = Math.min(...images.map((one) => levelOf(one, level)));
  const bytes = await source.level(end);
  await GimDecoder.ready;
  const next = decodeShape(bytes, source.info, images, level);
  if (file.source !== source) return;
  shape = Object.assign(next, { source, forget: () => (next.distances = next.folded = undefined) });
  surface.show(shape, isFirst);
  showFacts();
  await repaint();
}
function chooseLevel() {
  if (!at("auto").checked || !shape) return;
  const { low, high } = shape.box, view = surface.view(new Box3(new Vector3(...low), new Vector3(...high)));
  const level = GimDecoder.chooseLevel(file.source.bytes, { ...view, pixelError: 1, shown: file.wanted });
  if (level !== file.wanted) showLevel(level);
}

// ---- colours and folds ------------------------------------------------------------------------------------------------

async function repaint() {
  if (!shape) return;
  const now = shape, kind = at("colour").value;
  if (kind === "plane" && !now.plane) now.plane = planeColours(await file.source.plane("colors"), now);
  if (kind === "error" && original && !now.distances) now.distances = await measure.ask("distances", meshOf(now));
  if (kind === "error" && now.distances) now.high = now.high ?? highEnd(now.distances);
  if (now !== shape) return;
  surface.paint(kind === "plain" ? null : coloursOf(kind, now));
  showImage();
  showLegend(kind);
  await showFolds();
}
const meshOf = ({ positions, triangles }) => ({ positions, triangles });
function showImage() {
  const kind = at("colour").value, part = shape.parts[Number(at("which").value) || 0];
  image.show(part, coloursOf(kind === "plain" ? "position" : kind, shape), shape.positions);
}
function showLegend(kind) {
  const isShown = kind === "error" && shape.distances;
  at("legend").hidden = !isShown;
  if (!isShown) return;
  drawRamp(at("ramp"));
  const { high, distances } = shape;
  at("ramp-low").textContent = "0";
  at("ramp-high").textContent = `≥ ${length(high)}`;
  const worst = distances.reduce((most, value) => (value > most ? value : most), 0);
  at("ramp-text").textContent =
    `Distance to the original, object units. Largest: ${length(worst)}, ${((100 * worst) / original.diagonal).toPrecision(2)} % of the diagonal.`;
}
async function showFolds() {
  const now = shape;
  if (!at("folds").checked) {
    surface.paintFolds(null);
    at("fact-folds").textContent = "not looked for";
    return;
  }
  at("fact-folds").textContent = "…";
  now.folded = now.folded ?? (await measure.ask("folds", meshOf(now)));
  if (now !== shape) return;
  surface.paintFolds(now.folded);
  const folded = now.folded.reduce((sum, value) => sum + value, 0);
  at("fact-folds").textContent = `${count.format(folded)} triangles`;
}

// ---- the marked sample ------------------------------------------------------------------------------------------------

// The pointer is at a vertex of the surface; null: at none.
function markVertex(vertex) {
  if (vertex === null) return;
  const index = shape.parts.findIndex(({ first, width, height }) => vertex >= first && vertex < first + width * height);
  if (String(index) !== at("which").value && shape.parts.length > 1) {
    at("which").value = index;
    showImage();
  }
  const { first, width } = shape.parts[index];
  mark(Math.floor((vertex - first) / width), (vertex - first) % width);
}
function markSample(row, column) {
  if (shape) mark(row, column);
}
function mark(row, column) {
  const part = shape.parts[Number(at("which").value) || 0], vertex = part.first + row * part.width + column;
  const place = Array.from(shape.positions.subarray(3 * vertex, 3 * vertex + 3));
  const isThere = !Number.isNaN(place[0]);
  image.mark([row, column]);
  surface.setMark(isThere ? place : null);
  const lines = [`row ${row}, column ${column} of ${part.height} × ${part.width}`];
  lines.push(isThere ? place.map((value) => value.toPrecision(6)).join("  ") : "no surface here");
  if (shape.distances && isThere) lines.push(`distance ${length(shape.distances[vertex])}`);
  at("sample").textContent = lines.join("\n");
}

// ---- what the page says -----------------------------------------------------------------------------------------------

function say(message) {
  at("message").textContent = message;
}
function showBytes({ loaded, total }) {
  at("fact-bytes").textContent = total ? `${count.format(loaded)} of ${count.format(total)} bytes` : `${count.format(loaded)} bytes`;
}
function showFacts() {
  const { info, bytes } = shape.source, error = info.levelMaxError[shape.level], rms = info.levelRmsError[shape.level];
  showBytes({ loaded: bytes.length, total: info.fileSize });
  at("fact-time").textContent = `${shape.milliseconds.toFixed(1)} ms`;
  at("fact-triangles").textContent = count.format(shape.triangles.length / 3);
  at("fact-rms").textContent = rms > 0 ? length(rms) : "not told";
  at("fact-error").textContent = error > 0 ? length(error) : "not told";
}

// ---- controls ---------------------------------------------------------------------------------------------------------

function setLevelByHand(level) {
  if (!file.source) return;
  at("auto").checked = false;
  showLevel(Math.min(Math.max(level, 0), file.source.levelCount - 1));
}
function toggle(id) {
  at(id).checked = !at(id).checked;
  at(id).dispatchEvent(new Event("change"));
}
function nextColours() {
  const select = at("colour"), { options } = select;
  do select.selectedIndex = (select.selectedIndex + 1) % options.length;
  while (select.selectedOptions[0].disabled);
  repaint();
}
at("level").addEventListener("input", ({ target }) => setLevelByHand(file.source.levelCount - 1 - Number(target.value)));
at("auto").addEventListener("change", chooseLevel);
at("wire").addEventListener("change", ({ target }) => surface.setWire(target.checked));
at("folds").addEventListener("change", () => shape && showFolds());
at("colour").addEventListener("change", repaint);
at("which").addEventListener("change", () => (image.mark(null), showImage()));
at("reset").addEventListener("click", () => surface.fit());
at("file").addEventListener("change", ({ target }) => openFiles(target.files).then(() => (target.value = "")));
at("address").addEventListener("submit", (event) => {
  event.preventDefault();
  const url = at("url").value.trim();
  if (!url) return;
  history.replaceState(null, "", `?url=${encodeURIComponent(url)}`);
  openGim(new URL(url, location.href), lastPart(url));
});
at("help-button").addEventListener("click", () => at("help").showModal());
at("help-close").addEventListener("click", () => at("help").close());

const keys = {
  ".": () => setLevelByHand(file.wanted - 1), ",": () => setLevelByHand(file.wanted + 1),
  a: () => toggle("auto"), w: () => toggle("wire"), f: () => toggle("folds"), c: nextColours,
  r: () => surface.fit(), o: () => at("file").click(), "?": () => at("help").showModal(),
};
document.addEventListener("keydown", (event) => {
  const isTyping = event.target.matches("input[type=text], select");
  if (isTyping || event.ctrlKey || event.metaKey || event.altKey || at("help").open) return;
  const act = keys[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  act();
});

let inside = 0;
document.addEventListener("dragenter", () => document.body.classList.toggle("dropping", ++inside > 0));
document.addEventListener("dragleave", () => document.body.classList.toggle("dropping", --inside > 0));
document.addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", (event) => {
  event.preventDefault();
  inside = 0;
  document.body.classList.remove("dropping");
  openFiles(event.dataTransfer.files);
});
openAddresses();
