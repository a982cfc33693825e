// Memory that many meshes share. Each frame it says which level each mesh may show: nearest first.
// Part of the memory that a plan may take. The rest is for geometries that are about to be replaced.
const planned = 0.8;

export class GIMBudget {
  constructor(maxBytes = 256 << 20) {
    this.maxBytes = maxBytes;
    this.meshes = new Set();
  }
  add(mesh) {
    this.meshes.add(mesh);
  }
  remove(mesh) {
    this.meshes.delete(mesh);
  }
  // Bytes that the meshes hold.
  get byteCount() {
    let sum = 0;
    for (const mesh of this.meshes) sum += mesh.byteCount;
    return sum;
  }

  // Chooses levels for all meshes. viewport: a renderer, or the height of its picture in pixels.
  update(camera, viewport) {
    const plans = [];
    for (const mesh of this.meshes) {
      if (!mesh.images || mesh.error) continue;
      mesh.guard(() => {
        const ideal = mesh.choose(camera, viewport);
        plans.push({ mesh, ideal, distance: mesh.view?.distance ?? 0, level: -1 });
      });
    }
    plans.sort((a, b) => a.distance - b.distance);
    this.share(plans);
    // Those that give memory back go first.
    plans.sort((a, b) => Number(this.grows(a)) - Number(this.grows(b)));
    for (const { mesh, level } of plans) mesh.want(level);
  }
  grows({ mesh, level }) {
    return level >= 0 && (mesh.level < 0 || level < mesh.level);
  }

  // First each mesh gets its coarsest level, nearest first, then what it needs, as far as there is room.
  share(plans) {
    let left = planned * this.maxBytes;
    for (const { mesh } of plans) left -= mesh.byteCount - mesh.geometryBytes - mesh.reserved; // files and textures
    for (const plan of plans) {
      const coarsest = plan.mesh.source.levelCount - 1;
      const size = this.sizeAt(plan.mesh, coarsest);
      if (size > left) continue;
      left -= plan.size = size;
      plan.level = coarsest;
    }
    for (const plan of plans) {
      if (plan.level < 0) continue;
      for (let level = plan.ideal; level < plan.level; ++level) {
        const more = this.sizeAt(plan.mesh, level) - plan.size;
        if (more > left) continue;
        left -= more;
        plan.level = level;
        break;
      }
    }
  }
  // Bytes of a level: its geometry, and what of the file is to come for it.
  sizeAt(mesh, level) {
    return mesh.sizeOf(level) + Math.max(mesh.endOf(level) - mesh.source.bytes.length, 0);
  }

  // Whether a mesh may take so many bytes now. One that becomes coarser lets go of what it shows, if it must.
  hasRoom(mesh, size, level) {
    if (this.byteCount + size <= this.maxBytes) return true;
    if (mesh.level < 0 || level <= mesh.level) return false;
    mesh.letGo();
    return this.byteCount + size <= this.maxBytes;
  }
}
