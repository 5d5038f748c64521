// The plan of the town as lines over the ground, a layer each: roads, blocks, lots.
import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments } from 'three';

const colours = { water: 0x2f6f9f, park: 0x3f7a3f, highway: 0xb0501c, street: 0x7a4a2a, crossing: 0x8a5a3a, bridge: 0x6a3fa0, block: 0x22262b, lot: 0xa02850 };

/** The layers of a town's plan (GeoJSON), which `sgm bake` writes beside the tileset of a town; null where it can't be read. */
export async function loadPlan(name) {
  const answer = await fetch(name).catch(() => null);
  if (!answer?.ok) return null;
  const lines = new Map();
  for (const { properties, geometry } of (await answer.json()).features) {
    if (!lines.has(properties.layer)) lines.set(properties.layer, { count: 0, points: [] });
    const layer = lines.get(properties.layer);
    layer.count += 1;
    for (const polygon of geometry.coordinates)
      for (const ring of polygon)
        for (let i = 0; i + 1 < ring.length; i += 1) {
          const [a, b] = [ring[i], ring[i + 1]];
          layer.points.push(a[0], 0, -a[1], b[0], 0, -b[1]);  // y of a plan is north
        }
  }
  const group = new Group(), layers = new Map();
  for (const [name, { count, points }] of lines) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
    const line = new LineSegments(geometry, new LineBasicMaterial({ color: colours[name] ?? 0x404040, depthTest: false, transparent: true }));
    line.renderOrder = 1;
    line.userData.count = count;
    line.raycast = () => {};
    layers.set(name, line);
    group.add(line);
  }
  return { group, layers };
}
