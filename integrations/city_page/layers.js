// What is shown of the tiles: kinds of buildings and materials of the ground, and their levels by colour.
import { Color } from 'three';

const levelColours = [new Color(0xd9694a), new Color(0xe2b84d), new Color(0x5f9ea8), new Color(0x7a86c2), new Color(0x9a6fb0)];

/** The level of a tile, by its address: cells/LEVEL/X_Z.glb. */
const levelOf = (tile) => Number(/cells\/(\d+)\//.exec(tile.content?.uri ?? '')?.[1] ?? 0);

export class Layers {
  constructor(tiles) {
    this.tiles = tiles;
    this.kinds = new Map();  // by name of objects: whether they are shown
    this.materials = new Map();  // of the ground
    this.byLevel = false;
  }

  /** A row of the panel. */
  checkbox(name, count, on, changed) {
    const label = document.createElement('label');
    const box = Object.assign(document.createElement('input'), { type: 'checkbox', checked: on });
    box.addEventListener('change', () => changed(box.checked));
    label.append(box, Object.assign(document.createElement('span'), { textContent: name }));
    if (count !== null) label.append(Object.assign(document.createElement('small'), { textContent: count.toLocaleString('en') }));
    return label;
  }

  /** Each mesh of a tile with what it belongs to. */
  *meshes(scene) {
    const ground = (object) => object.name === 'ground' || (object.parent !== null && object.parent.name === 'ground');
    const all = [];
    scene.traverse((object) => object.isMesh && all.push(object));
    for (const mesh of all) yield { mesh, kind: mesh.isInstancedMesh ? mesh.userData.kind : null, isGround: !mesh.isInstancedMesh && ground(mesh) };
  }

  take(scene, tile) {
    scene.userData.level = levelOf(tile);
    scene.traverse((object) => {
      if (!object.isInstancedMesh) return;
      let named = object;
      while (named.userData.start === undefined && named.parent) named = named.parent;
      object.userData.kind = named.userData.start ?? named.name;
      object.userData.values = named.userData;
    });
    for (const { mesh, kind, isGround } of this.meshes(scene)) {
      if (kind) this.add('kinds', this.kinds, kind);
      if (isGround) this.add('materials', this.materials, mesh.material.name);
    }
    this.apply(scene);
  }

  add(list, known, name) {
    if (known.has(name)) return;
    known.set(name, true);
    const label = this.checkbox(name, null, true, (on) => {
      known.set(name, on);
      this.tiles.forEachLoadedModel((scene) => this.apply(scene));
    });
    label.dataset.name = name;
    const panel = document.getElementById(list);
    panel.insertBefore(label, [...panel.children].find((other) => other.dataset.name > name) ?? null);
  }

  apply(scene) {
    for (const { mesh, kind, isGround } of this.meshes(scene)) {
      mesh.visible = kind ? this.kinds.get(kind) !== false : !isGround || this.materials.get(mesh.material.name) !== false;
      mesh.userData.own ??= mesh.material;
      if (this.byLevel && mesh.material === mesh.userData.own) {
        mesh.material = mesh.userData.own.clone();
        mesh.material.vertexColors = false;
        mesh.material.color.copy(levelColours[scene.userData.level % levelColours.length]);
      } else if (!this.byLevel && mesh.material !== mesh.userData.own) {
        mesh.material.dispose();
        mesh.material = mesh.userData.own;
      }
    }
  }

  colourLevels(on) {
    this.byLevel = on;
    this.tiles.forEachLoadedModel((scene) => this.apply(scene));
  }

  /** Instances of objects, each counted once however many materials it has, and triangles. */
  countOf(scene) {
    const sum = { instances: 0, triangles: 0 }, seen = new Set();
    for (const { mesh } of this.meshes(scene)) {
      const triangles = mesh.geometry.index.count / 3;
      sum.triangles += mesh.isInstancedMesh ? triangles * mesh.count : triangles;
      if (!mesh.isInstancedMesh || seen.has(mesh.userData.values)) continue;
      seen.add(mesh.userData.values);
      sum.instances += mesh.count;
    }
    return sum;
  }
}
