// Prints what three's loaders make of .glb and .usda files: a line a file with the tree of its named nodes and their
// triangles, the triangles of each material (of .usda: by colour, for three drops the names) and the size of the whole.
// Exit code 3 where three isn't installed (npm install --prefix build three).
import fs from 'fs';
import path from 'path';
import {pathToFileURL} from 'url';

const folder = ['node_modules', 'build/node_modules'].map(f => path.resolve(f, 'three')).find(f => fs.existsSync(f));
if (!folder) process.exit(3);
const load = file => import(pathToFileURL(path.join(folder, file)));
globalThis.self ??= globalThis;
const {Box3, Vector3} = await load('build/three.module.js');
const {GLTFLoader} = await load('examples/jsm/loaders/GLTFLoader.js');
const {USDLoader} = await load('examples/jsm/loaders/USDLoader.js');

const trianglesOf = mesh => (mesh.geometry.index ?? mesh.geometry.attributes.position).count / 3;

/// A mesh of many primitives is a group of meshes, and a USD prim holds a mesh called Surface: both count as one node.
function outline(node) {
  const own = node.children.filter(c => c.isMesh && (c.name === 'Surface' || c.userData.part));
  const triangles = [node, ...own].filter(m => m.isMesh).reduce((n, m) => n + trianglesOf(m), 0);
  const below = node.children.filter(c => !own.includes(c) && c.name !== 'Materials').map(c => outline(c));
  return node.name + (triangles ? ` ${triangles}` : '') + (below.length ? ` (${below.join(', ')})` : '');
}

function materialsOf(root, nameOf) {
  const found = {};
  root.traverse(mesh => {
    if (!mesh.isMesh) return;
    const groups = mesh.geometry.groups.length ? mesh.geometry.groups : [{count: 3 * trianglesOf(mesh), materialIndex: 0}];
    for (const g of groups) {
      const material = Array.isArray(mesh.material) ? mesh.material[g.materialIndex] : mesh.material;
      found[nameOf(material)] = (found[nameOf(material)] ?? 0) + g.count / 3;
    }
  });
  return JSON.stringify(found);
}

for (const file of process.argv.slice(2)) {
  const bytes = fs.readFileSync(file), buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  const isGltf = file.endsWith('.glb');
  let root;
  if (isGltf) {
    const gltf = await new Promise((done, failed) => new GLTFLoader().parse(buffer, '', done, failed));
    root = gltf.scene.children[0];
    for (const [object, of] of gltf.parser.associations)
      if (of.primitives !== undefined && of.nodes === undefined) object.userData.part = true;
  } else {
    root = new USDLoader().parse(buffer);
    while (root.children.length === 1 && root.name !== path.parse(file).name) root = root.children[0];
  }
  const size = new Box3().setFromObject(root).getSize(new Vector3());
  const nameOf = isGltf ? m => m.name : m => m.color.toArray().map(c => c.toFixed(2)).join(' ');
  console.log(path.basename(file), outline(root), materialsOf(root, nameOf), 'size',
              size.toArray().map(v => Number(v.toFixed(3))).join(' '));
}
