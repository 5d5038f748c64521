// The page of a baked city: its tiles by three.js and 3d-tiles-renderer, the rule of a building under a click, layers.
import { AmbientLight, Box3, Clock, Color, DirectionalLight, Fog, HemisphereLight, MathUtils, Matrix4, PerspectiveCamera, Raycaster, Scene, Sphere, Vector2, Vector3, WebGLRenderer } from 'three';
import { MapControls } from 'three/addons/controls/MapControls.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { TilesRenderer } from '3d-tiles-renderer';
import { GLTFExtensionsPlugin } from '3d-tiles-renderer/plugins';
import { Layers } from './layers.js';
import { Picker } from './pick.js';
import { loadPlan } from './plan.js';

const element = (id) => document.getElementById(id);

/** Error in pixels by the slider's place: a tile is refined where it is off by more. */
const errorOf = (place) => 64 / 2 ** Number(place);

class CityPage {
  constructor() {
    this.renderer = new WebGLRenderer({ canvas: element('view'), antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.scene.background = new Color(0xcfd9e3);
    this.scene.fog = new Fog(0xcfd9e3, 1e4, 4e4);
    this.scene.add(new HemisphereLight(0xf2f6ff, 0x8a8474, 1.9), new AmbientLight(0xffffff, .25));
    const sun = new DirectionalLight(0xfff1dc, 2.4);
    sun.position.set(.5, 1, .35);
    this.scene.add(sun);
    this.camera = new PerspectiveCamera(50, 1, 1, 1e5);
    this.controls = new MapControls(this.camera, this.renderer.domElement);
    this.controls.maxPolarAngle = MathUtils.degToRad(88);
    this.controls.zoomToCursor = true;
    this.tiles = new TilesRenderer(new URL('tileset.json', location.href).href);
    this.tiles.registerPlugin(new GLTFExtensionsPlugin({ metadata: true, meshoptDecoder: MeshoptDecoder }));
    // Below the root of a server the renderer joins addresses by two slashes, which not every server takes.
    this.tiles.registerPlugin({ preprocessURL: (address) => address.toString().replace(/([^:])\/\/+/g, '$1/') });
    this.tiles.setCamera(this.camera);
    this.scene.add(this.tiles.group);
    this.layers = new Layers(this.tiles);
    this.picker = new Picker(this.scene, this.tiles);
    this.drawn = 0;
    this.failed = [];
  }

  async start() {
    // A city on the globe is shown where it stands by itself: east, up and south as in the model.
    const tileset = await (await fetch('tileset.json')).json();
    const place = new Matrix4();
    if (tileset.root.transform) place.fromArray(tileset.root.transform).invert();
    this.home = new Matrix4().makeRotationX(-Math.PI / 2).multiply(place);
    this.home.decompose(this.tiles.group.position, this.tiles.group.quaternion, this.tiles.group.scale);
    this.tiles.group.updateMatrixWorld(true);
    this.frame(tileset.root.boundingVolume.box);
    this.manifest = await fetch('manifest.json').then((answer) => (answer.ok ? answer.json() : null)).catch(() => null);
    this.showFacts();
    this.tiles.addEventListener('load-model', ({ scene, tile }) => this.layers.take(scene, tile));
    this.tiles.addEventListener('load-error', ({ url, error }) => this.fail(url, error));
    this.listen();
    if (this.manifest?.plan) loadPlan(this.manifest.plan).then((plan) => plan && this.showPlan(plan));
    element('told').textContent = '';
    this.clock = new Clock();
    this.renderer.setAnimationLoop(() => this.draw());
  }

  /** Turns the camera so that the root's box, z up about the model's origin, is in the picture. */
  frame(box) {
    const half = new Vector3(Math.abs(box[3]), Math.abs(box[11]), Math.abs(box[7]));
    const middle = new Vector3(box[0], box[2], -box[1]);
    this.bounds = new Box3(middle.clone().sub(half), middle.clone().add(half));
    this.fit();
  }

  fit() {
    const sphere = this.bounds.getBoundingSphere(new Sphere());
    const distance = .95 * sphere.radius / Math.sin(MathUtils.degToRad(this.camera.fov / 2));
    this.controls.target.copy(sphere.center);
    this.camera.position.copy(sphere.center).add(new Vector3(.45, .55, .7).normalize().multiplyScalar(distance));
    this.camera.near = Math.max(.5, sphere.radius / 5000);
    this.camera.far = 20 * sphere.radius + 1000;
    this.scene.fog.near = 3 * sphere.radius;
    this.scene.fog.far = 12 * sphere.radius;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  /** Looks from one place of the model to another, both in metres. */
  look(from, to) {
    this.camera.position.set(...from);
    this.controls.target.set(...to);
    this.controls.update();
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    if (this.width !== width || this.height !== height) {
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      [this.width, this.height] = [width, height];
    }
    this.controls.update(this.clock.getDelta());
    this.camera.updateMatrixWorld();
    this.tiles.errorTarget = this.error ?? errorOf(element('detail').value);
    this.tiles.setResolutionFromRenderer(this.camera, this.renderer);
    this.tiles.update();
    this.renderer.render(this.scene, this.camera);
    this.drawn += 1;
  }

  /** Whether all that this view needs is there. */
  get complete() {
    const s = this.tiles.stats;
    return this.drawn > 2 && this.tiles.root !== null && s.downloading + s.parsing + s.queued === 0 && this.tiles.visibleTiles.size > 0;
  }

  /** Instances and triangles of the tiles that are shown. */
  count() {
    const sum = { tiles: 0, instances: 0, triangles: 0 };
    for (const tile of this.tiles.visibleTiles) {
      const scene = tile.engineData?.scene;
      if (!scene) continue;
      sum.tiles += 1;
      const own = this.layers.countOf(scene);
      sum.instances += own.instances;
      sum.triangles += own.triangles;
    }
    return sum;
  }

  showFacts() {
    const facts = element('facts');
    const row = (name, value) => {
      facts.append(Object.assign(document.createElement('dt'), { textContent: name }), Object.assign(document.createElement('dd'), { textContent: value }));
    };
    const m = this.manifest;
    if (!m) return;
    if (m.name) {
      document.title = m.name;
      document.querySelector('h1').textContent = m.name;
    }
    row('buildings', m.places.toLocaleString('en'));
    row('different ones', m.objects.toLocaleString('en'));
    row('triangles', m.triangles.toLocaleString('en'));
    row('megabytes', (m.bytes / 1e6).toFixed(1));
  }

  showPlan(plan) {
    plan.group.position.y = this.bounds.max.y > 0 ? .5 : 0;
    this.scene.add(plan.group);
    element('plan').hidden = false;
    for (const [name, line] of plan.layers) {
      line.visible = false;
      element('layers').append(this.layers.checkbox(name, line.userData.count, false, (on) => { line.visible = on; }));
    }
  }

  fail(url, error) {
    this.failed.push(`${url}: ${error?.message ?? error}`);
    element('told').textContent = `A tile could not be read: ${this.failed[0]}`;
  }

  /** Tells what stands at a place of the canvas, 0 … 1 from the upper left corner. */
  pick(x, y) {
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(2 * x - 1, 1 - 2 * y), this.camera);
    const found = this.picker.pick(ray);
    const footer = element('picked');
    footer.replaceChildren();
    if (found) {
      footer.append(Object.assign(document.createElement('b'), { textContent: found.object }));
      const values = Object.entries(found.values).map(([name, value]) => `${name.replace(/^param /, '')} ${value}`);
      footer.append(`rule ${found.rule || 'start'}, ${found.file} line ${found.line} · ${found.path}${values.length ? ` · ${values.join(', ')}` : ''}`);
    }
    return found;
  }

  listen() {
    const canvas = this.renderer.domElement;
    let pressed = null;
    canvas.addEventListener('pointerdown', (e) => { pressed = [e.clientX, e.clientY]; });
    canvas.addEventListener('pointerup', (e) => {
      const moved = pressed && Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) > 4;
      pressed = null;
      if (!moved && e.button === 0) this.pick(e.clientX / canvas.clientWidth, e.clientY / canvas.clientHeight);
    });
    element('fit').addEventListener('click', () => this.fit());
    element('levels').addEventListener('change', (e) => this.layers.colourLevels(e.target.checked));
    addEventListener('keydown', (e) => {
      if (e.key === 'f' || e.key === 'F') this.fit();
      if (e.key === 'Escape') this.picker.clear(), element('picked').replaceChildren();
    });
  }
}

try {
  const page = new CityPage();
  window.sgmCity = page;
  page.start().catch((error) => { element('told').textContent = `The tileset could not be read: ${error.message}. The folder wants a server, as sgm serve.`; });
} catch (error) {
  element('told').textContent = `This browser can't draw the city: ${error.message}`;
}
