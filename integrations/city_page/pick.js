// What a ray meets: the building, its row in the tile's table of places, and a copy of it that shows which one it is.
import { Group, Mesh, MeshBasicMaterial } from 'three';

export class Picker {
  constructor(scene, tiles) {
    this.tiles = tiles;
    this.mark = new Group();
    this.material = new MeshBasicMaterial({ color: 0xff7a2e, transparent: true, opacity: .55, depthTest: true, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 });
    scene.add(this.mark);
  }

  clear() {
    this.mark.clear();
  }

  /** The object of the first instance on the ray: {object, path, rule, file, line, values}; null for the ground. */
  pick(ray) {
    this.clear();
    const hits = ray.intersectObject(this.tiles.group, true).filter((hit) => hit.object.visible);
    if (hits.length === 0 || !hits[0].object.isInstancedMesh) return null;
    const { object: mesh, instanceId } = hits[0];
    let scene = mesh;
    while (!scene.userData.structuralMetadata && scene.parent) scene = scene.parent;
    const metadata = scene.userData.structuralMetadata, feature = mesh.geometry.getAttribute('_FEATURE_ID_0') ?? mesh.geometry.getAttribute('_feature_id_0');
    if (!metadata || !feature) return null;
    const row = metadata.getPropertyTableData(0, feature.getX(instanceId));
    this.show(mesh, instanceId);
    const { start, ...values } = Object.fromEntries(Object.entries(mesh.userData.values).filter(([name]) => name === 'start' || name === 'seed' || name.startsWith('param ')));
    return { object: start ?? mesh.name, path: row.path, rule: row.rule, file: row.file, line: Number(row.line), values };
  }

  /** Draws the instance once more, all its materials. */
  show(mesh, instance) {
    const siblings = mesh.parent.children.filter((other) => other.isInstancedMesh && other.userData.values === mesh.userData.values);
    for (const part of siblings) {
      const copy = new Mesh(part.geometry, this.material);
      copy.matrixAutoUpdate = false;
      part.getMatrixAt(instance, copy.matrix);
      part.updateWorldMatrix(true, false);
      copy.matrix.premultiply(part.matrixWorld);
      copy.raycast = () => {};
      this.mark.add(copy);
    }
  }
}
