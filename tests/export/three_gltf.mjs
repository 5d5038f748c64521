// Prints what three's glTF loader makes of files, one JSON object a file: triangles, materials, bounding box, volume.
// Exit code 3 where three isn't installed (npm install --prefix build three).
import fs from 'fs';
import {createRequire} from 'module';
import {pathToFileURL} from 'url';

const require = createRequire(import.meta.url);
let folder;
for (const place of [process.cwd(), process.cwd() + '/build'])
  if (fs.existsSync(place + '/node_modules/three/package.json')) folder = place + '/node_modules/three';
if (!folder) process.exit(3);
const load = (path) => import(pathToFileURL(folder + '/' + path).href);
const THREE = await load('build/three.module.js');
const {GLTFLoader} = await load('examples/jsm/loaders/GLTFLoader.js');
const {MeshoptDecoder} = await load('examples/jsm/libs/meshopt_decoder.module.js');
globalThis.self = globalThis;

// three's DRACOLoader wants a browser's workers: its decoder alone does here.
const copied = fs.mkdtempSync('/tmp/three-draco-') + '/draco_decoder.cjs';
fs.copyFileSync(folder + '/examples/jsm/libs/draco/gltf/draco_decoder.js', copied);
const draco = await new Promise((done) => require(copied)({onModuleLoaded: done}));
fs.rmSync(copied);
const dracoLoader = {
  preload() {},
  decodeDracoFile(bytes, callback, ids) {
    const decoder = new draco.Decoder(), mesh = new draco.Mesh();
    const status = decoder.DecodeArrayToMesh(new Int8Array(bytes), bytes.byteLength, mesh);
    if (!status.ok()) throw new Error(status.error_msg());
    const geometry = new THREE.BufferGeometry();
    for (const [name, id] of Object.entries(ids)) {
      const attribute = decoder.GetAttributeByUniqueId(mesh, id), values = new draco.DracoFloat32Array();
      decoder.GetAttributeFloatForAllPoints(mesh, attribute, values);
      const array = Float32Array.from({length: values.size()}, (_, i) => values.GetValue(i));
      geometry.setAttribute(name, new THREE.BufferAttribute(array, attribute.num_components()));
    }
    const corners = new draco.DracoInt32Array(), indices = [];
    for (let f = 0; f < mesh.num_faces(); ++f) {
      decoder.GetFaceFromMesh(mesh, f, corners);
      indices.push(corners.GetValue(0), corners.GetValue(1), corners.GetValue(2));
    }
    geometry.setIndex(indices);
    callback(geometry);
  },
};

for (const file of process.argv.slice(2)) {
  const bytes = fs.readFileSync(file);
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).setDRACOLoader(dracoLoader);
  const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength), '');
  gltf.scene.updateMatrixWorld(true);
  const box = new THREE.Box3(), names = new Set(), corner = [0, 1, 2].map(() => new THREE.Vector3());
  let triangles = 0, volume = 0;
  gltf.scene.traverse((object) => {
    if (!object.isMesh) return;
    const {index, attributes} = object.geometry;
    names.add(object.material.name);
    triangles += index.count / 3;
    for (let i = 0; i < index.count; i += 3) {
      for (let k = 0; k < 3; ++k)
        box.expandByPoint(corner[k].fromBufferAttribute(attributes.position, index.getX(i + k)).applyMatrix4(object.matrixWorld));
      volume += corner[0].dot(corner[1].cross(corner[2])) / 6;
    }
  });
  console.log(JSON.stringify({triangles, volume, materials: [...names].sort(), box: [...box.min.toArray(), ...box.max.toArray()]}));
}
