/** A scene in 3D: transparent walls, fruit as balls that are shaded and cast shadows, in the
 *  colours of a value. */

import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  EdgesGeometry,
  Group,
  HemisphereLight,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Scene,
  ShadowMaterial,
  SphereGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { ContactView, SceneView } from "../api/types";
import { pick } from "../plots/scale";
import { PLACE, TURN, WORDS, type Frame } from "./frames";
import type { Shade } from "./shades";

/** Colours that the theme gives. */
export interface Look {
  wall: string;
  edge: string;
  chosen: string;
}

/** Initial view of a scene: azimuth from x towards y, elevation; rad. As in
 *  crates/scene-run/src/frames/figure.rs. */
const FROM: [number, number] = [(-62 * Math.PI) / 180, (24 * Math.PI) / 180];
const FIELD = 28;
/** Edges are drawn where faces meet at more than this; degrees. */
const BEND = 25;
/** Fruit beyond which balls have fewer faces and cast no shadows. */
const MANY = 2500;
/** Points of a side of the map of shadows. */
const SHADOWS = 2048;
/** Most spots that are marked on a fruit. */
const SPOTS = 300;

export class Player {
  /** Called after each drawing. */
  drawn: () => void = () => undefined;
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(FIELD, 1, 0.01, 100);
  readonly #controls: OrbitControls;
  readonly #fruit: InstancedMesh;
  readonly #walls: Group[] = [];
  readonly #faces: MeshLambertMaterial[] = [];
  readonly #edges: LineBasicMaterial[] = [];
  readonly #chosen: Mesh<SphereGeometry, MeshBasicMaterial>;
  readonly #own: Mesh<SphereGeometry, MeshLambertMaterial>;
  readonly #spots: InstancedMesh;
  readonly #colours: Color[];
  readonly #middle: Vector3;
  readonly #size: number;
  #frame: Frame | null = null;
  #selected: number | null = null;
  #contacts: ContactView[] = [];
  #time = 0;
  #due = false;
  #shade: Shade | null = null;
  /** The view, until the user turns it. */
  #from = FROM;
  #turned = false;
  /** What must be seen. */
  readonly #points: Vector3[];

  /** Fails where the browser shows no 3D graphics. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    readonly view: SceneView,
  ) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.enlarge(null);
    this.#colours = view.colours.map((own) => new Color(own));
    const { low, high } = view.about.bounds;
    this.#middle = new Vector3(...low).add(new Vector3(...high)).multiplyScalar(0.5);
    this.#points = outline(view);
    this.#size = Math.max(new Vector3(...low).distanceTo(new Vector3(...high)), 1e-3);

    const capacity = view.counts.reduce((a, b) => Math.max(a, b), 1);
    this.#scene.add(new HemisphereLight(0xffffff, 0xb4bac6, 2.0));
    this.#sun(capacity <= MANY);
    const ball = marked(capacity > MANY ? 14 : 28);
    this.#fruit = new InstancedMesh(ball, new MeshLambertMaterial({ vertexColors: true }), capacity);
    this.#fruit.frustumCulled = false;
    this.#fruit.castShadow = true;
    this.#fruit.receiveShadow = true;
    this.#fruit.setColorAt(0, this.#colours[0]!);
    this.#fruit.count = 0;
    this.#scene.add(this.#fruit);

    this.#own = new Mesh(marked(40), new MeshLambertMaterial({ vertexColors: true }));
    this.#chosen = new Mesh(new SphereGeometry(1, 40, 24), new MeshBasicMaterial({ side: BackSide }));
    this.#spots = new InstancedMesh(new SphereGeometry(1, 12, 8), new MeshBasicMaterial(), SPOTS);
    this.#spots.frustumCulled = false;
    this.#own.castShadow = true;
    for (const own of [this.#own, this.#chosen, this.#spots]) {
      own.visible = false;
      this.#scene.add(own);
    }
    view.about.walls.forEach((wall, place) => {
      this.#walls.push(this.#wall(view.vertices[place]!, view.faces[place]!, wall.corners, wall.endless));
    });

    this.#camera.up.set(0, 0, 1);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.maxPolarAngle = 0.98 * Math.PI;
    this.#controls.addEventListener("change", () => this.draw());
    this.#controls.addEventListener("start", () => (this.#turned = true));
    this.look(...FROM);
  }

  /** The light that gives depth. */
  #sun(shadows: boolean): void {
    const sun = new DirectionalLight(0xffffff, 1.5);
    sun.position.set(-0.3, -0.6, 1.4).setLength(2 * this.#size).add(this.#middle);
    sun.target.position.copy(this.#middle);
    this.#scene.add(sun, sun.target);
    this.#renderer.shadowMap.enabled = shadows;
    this.#renderer.shadowMap.autoUpdate = false;
    sun.castShadow = shadows;
    sun.shadow.mapSize.set(SHADOWS, SHADOWS);
    const half = 0.6 * this.#size;
    Object.assign(sun.shadow.camera, { left: -half, right: half, top: half, bottom: -half });
    Object.assign(sun.shadow.camera, { near: 0.5 * this.#size, far: 4 * this.#size });
    sun.shadow.normalBias = 2e-3 * this.#size;
    sun.shadow.intensity = 0.6;
  }

  #wall(vertices: number[], faces: number[], corners: number, endless: boolean): Group {
    const triangles: number[] = [];
    for (let at = 0; at < faces.length; at += corners) {
      for (let k = 1; k + 1 < corners; k++) triangles.push(faces[at]!, faces[at + k]!, faces[at + k + 1]!);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(vertices), 3));
    geometry.setIndex(triangles);
    geometry.computeVertexNormals();
    const face = new MeshLambertMaterial({
      transparent: true,
      opacity: endless ? 0.1 : 0.16,
      side: DoubleSide,
      depthWrite: false,
    });
    const edge = new LineBasicMaterial({ transparent: true, opacity: 0.8 });
    this.#faces.push(face);
    this.#edges.push(edge);
    const group = new Group();
    const mesh = new Mesh(geometry, face);
    // Behind one another as they come: fruit are drawn before.
    mesh.renderOrder = 1;
    // A wall one sees through shows no shadow itself.
    const shadow = new Mesh(geometry, new ShadowMaterial({ opacity: 0.3, side: DoubleSide, depthWrite: false }));
    shadow.receiveShadow = true;
    shadow.renderOrder = 2;
    group.add(mesh, shadow, new LineSegments(new EdgesGeometry(geometry, BEND), edge));
    group.matrixAutoUpdate = false;
    this.#scene.add(group);
    return group;
  }

  /** Colours of a theme. */
  dress(look: Look): void {
    for (const own of this.#faces) own.color.set(look.wall);
    for (const own of this.#edges) own.color.set(look.edge);
    this.#chosen.material.color.set(look.chosen);
    this.#spots.material = new MeshBasicMaterial({ color: look.chosen });
    this.draw();
  }

  resize(width: number, height: number): void {
    if (width < 1 || height < 1) return;
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    if (this.#turned) this.draw();
    else this.look(...this.#from);
  }

  /** Fits the whole scene and the fruit in it into view from a side. */
  look(azimuth: number, elevation: number): void {
    this.#from = [azimuth, elevation];
    this.#turned = false;
    const points = [...this.#points, ...this.#ends()];
    const [sin, cos] = [Math.sin(elevation), Math.max(Math.cos(elevation), 1e-3)];
    const from = new Vector3(Math.cos(azimuth) * cos, Math.sin(azimuth) * cos, sin).normalize();
    const right = new Vector3(-Math.sin(azimuth), Math.cos(azimuth), 0);
    const up = new Vector3().crossVectors(from, right);
    const high = Math.tan((FIELD * Math.PI) / 360);
    const wide = high * this.#camera.aspect;
    const target = this.#middle.clone();
    let away = this.#size;
    // As far away as needed, then centred.
    for (let round = 0; round < 10; round++) {
      away = 0;
      for (const point of points) {
        SPOT.subVectors(point, target);
        const far = Math.max(Math.abs(SPOT.dot(right)) / wide, Math.abs(SPOT.dot(up)) / high);
        away = Math.max(away, far + SPOT.dot(from));
      }
      const ends = [right, up].map((axis) => {
        const seen = points.map((point) => {
          SPOT.subVectors(point, target);
          return SPOT.dot(axis) / (away - SPOT.dot(from));
        });
        return (seen.reduce((a, b) => Math.max(a, b)) + seen.reduce((a, b) => Math.min(a, b))) / 2;
      });
      target.addScaledVector(right, ends[0]! * away).addScaledVector(up, ends[1]! * away);
    }
    away *= 1.06;
    this.#controls.target.copy(target);
    this.#camera.position.copy(target).addScaledVector(from, away);
    this.#camera.near = 0.01 * away;
    this.#camera.far = away + 20 * this.#size;
    this.#camera.updateProjectionMatrix();
    this.#controls.minDistance = 0.02 * away;
    this.#controls.maxDistance = 10 * away;
    this.#controls.update();
    this.draw();
  }

  /** Where fruit end to all sides, without those that fell far from the scene. */
  #ends(): Vector3[] {
    const frame = this.#frame;
    const found: Vector3[] = [];
    for (let k = 0; frame && k < frame.count; k++) {
      const centre = new Vector3().fromArray(frame.numbers, k * WORDS + PLACE);
      if (centre.distanceTo(this.#middle) > 2 * this.#size) continue;
      const radius = this.view.radii[frame.words[k * WORDS]! - 1] ?? 0;
      for (const side of [-radius, radius]) {
        for (const axis of [0, 1, 2]) found.push(centre.clone().setComponent(axis, centre.getComponent(axis) + side));
      }
    }
    return found;
  }

  /** Directions of the axes on the canvas (down is positive), and towards the viewer. */
  axes(): { name: string; x: number; y: number; towards: number }[] {
    const turn = this.#camera.quaternion.clone().invert();
    return ["x", "y", "z"].map((name, axis) => {
      SPOT.set(0, 0, 0).setComponent(axis, 1).applyQuaternion(turn);
      return { name, x: SPOT.x, y: -SPOT.y, towards: SPOT.z };
    });
  }

  /** A round length (m) and how wide it is seen in the middle of the view (px), at most `most`. */
  bar(most: number): { length: number; width: number } {
    const away = this.#camera.position.distanceTo(this.#controls.target);
    const pixel = (2 * Math.tan((FIELD * Math.PI) / 360) * away) / this.size()[1];
    const power = 10 ** Math.floor(Math.log10(most * pixel));
    const length = power * ([5, 2].find((step) => step * power <= most * pixel) ?? 1);
    return { length, width: length / pixel };
  }

  /** Width and height of the canvas as it is seen; px. */
  size(): [number, number] {
    return [Math.max(this.canvas.clientWidth, 1), Math.max(this.canvas.clientHeight, 1)];
  }

  /** Colours fruit by a value. */
  colourBy(shade: Shade): void {
    this.#shade = shade;
    if (this.#frame) this.show(this.#frame, null, this.#time);
  }

  /** Where the camera is and what it looks at; `null` as the scene begins. m */
  pose(): number[] | null {
    if (!this.#turned && this.#from.every((angle, k) => angle === FROM[k])) return null;
    return [...this.#camera.position.toArray(), ...this.#controls.target.toArray()];
  }

  /** Takes a view that `pose` told. */
  take(pose: number[]): void {
    this.#turned = true;
    this.#camera.position.fromArray(pose);
    this.#controls.target.fromArray(pose, 3);
    this.#controls.update();
    this.draw();
  }

  /** Turns the view by angles (rad) and zooms by a factor. */
  turn(azimuth: number, elevation: number, nearer = 1): void {
    this.#turned = true;
    const from = this.#camera.position.clone().sub(this.#controls.target);
    const away = from.length();
    const up = Math.min(Math.max(Math.asin(from.z / away) + elevation, -1.5), 1.5);
    const around = Math.atan2(from.y, from.x) + azimuth;
    from.set(Math.cos(around) * Math.cos(up), Math.sin(around) * Math.cos(up), Math.sin(up));
    this.#camera.position.copy(this.#controls.target).addScaledVector(from, away / nearer);
    this.#controls.update();
    this.draw();
  }

  /** Shows a time between two frames, interpolating linearly. */
  show(before: Frame, after: Frame | null, time: number): void {
    const span = after ? after.time - before.time : 0;
    const part = after && span > 0 ? Math.min(Math.max((time - before.time) / span, 0), 1) : 0;
    const next = part > 0 ? after : null;
    const first = this.#frame === null;
    this.#frame = before;
    this.#time = time;
    for (const [place, group] of this.#walls.entries()) {
      pose(before.walls, next?.walls ?? null, 7 * place, part, group.matrix);
      group.matrixWorldNeedsUpdate = true;
    }
    this.#balls(before, next, part);
    this.#renderer.shadowMap.needsUpdate = true;
    if (first && !this.#turned) this.look(...this.#from);
    else this.draw();
  }

  #balls(before: Frame, next: Frame | null, part: number): void {
    let there = 0;
    let found = false;
    for (let k = 0; k < before.count; k++) {
      const at = k * WORDS;
      const fruit = before.words[at]!;
      // Both frames are in the order of numbers.
      while (next && there < next.count && next.words[there * WORDS]! < fruit) there++;
      const same = next && there < next.count && next.words[there * WORDS] === fruit;
      const periods = this.view.about.periods;
      between(before.numbers, at, same ? next.numbers : null, there * WORDS, part, periods);
      const radius = this.view.radii[fruit - 1] ?? 0;
      MATRIX.compose(SPOT, ROTATION, SIZE.setScalar(radius));
      this.#fruit.setMatrixAt(k, MATRIX);
      const colour = this.#colour(fruit, before.numbers, at);
      this.#fruit.setColorAt(k, colour);
      if (fruit === this.#selected) {
        found = true;
        this.#own.position.copy(SPOT);
        this.#own.quaternion.copy(ROTATION);
        this.#own.scale.setScalar(radius * 1.001);
        this.#own.material.color.copy(colour);
        this.#chosen.position.copy(SPOT);
        this.#chosen.scale.setScalar(radius * 1.16);
      }
    }
    this.#fruit.count = before.count;
    this.#fruit.instanceMatrix.needsUpdate = true;
    if (this.#fruit.instanceColor) this.#fruit.instanceColor.needsUpdate = true;
    this.#own.visible = found;
    this.#chosen.visible = found;
    this.#mark(found);
  }

  /** Spots of the contacts of the chosen fruit so far. */
  #mark(found: boolean): void {
    const radius = this.#own.scale.x;
    let count = 0;
    for (const contact of this.#contacts) {
      if (!found || count === SPOTS) break;
      if (contact.time > this.#time) continue;
      SPOT.set(...contact.spot).applyQuaternion(this.#own.quaternion).multiplyScalar(radius).add(this.#own.position);
      const size = radius * (0.05 + 0.13 * Math.sqrt(Math.min(contact.peak_force / this.view.most, 1)));
      this.#spots.setMatrixAt(count++, MATRIX.compose(SPOT, ROTATION.identity(), SIZE.setScalar(size)));
    }
    this.#spots.count = count;
    this.#spots.visible = count > 0;
    this.#spots.instanceMatrix.needsUpdate = true;
  }

  #colour(fruit: number, numbers: Float32Array, at: number): Color {
    const part = this.#shade ? this.#shade.of(fruit, numbers, at) / this.#shade.most : 0;
    return pick(this.#colours, part);
  }

  /** Marks a fruit, and where it was struck; `through` makes the others transparent. */
  select(fruit: number | null, contacts: ContactView[], through: boolean): void {
    this.#selected = fruit;
    this.#contacts = [...contacts].sort((a, b) => b.peak_force - a.peak_force);
    const material = this.#fruit.material as MeshLambertMaterial;
    const clear = through && fruit !== null;
    this.#fruit.castShadow = !clear;
    if (material.transparent !== clear) {
      material.transparent = clear;
      material.opacity = clear ? 0.16 : 1;
      material.depthWrite = !clear;
      material.needsUpdate = true;
    }
    if (this.#frame) this.show(this.#frame, null, this.#time);
  }

  /** The fruit at a place of the canvas (px from its corner). */
  pick(x: number, y: number): number | null {
    const frame = this.#frame;
    if (!frame) return null;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    RAY.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.#camera);
    const { origin, direction } = RAY.ray;
    let nearest = Infinity;
    let found: number | null = null;
    for (let k = 0; k < frame.count; k++) {
      this.#fruit.getMatrixAt(k, MATRIX);
      SPOT.setFromMatrixPosition(MATRIX).sub(origin);
      const fruit = frame.words[k * WORDS]!;
      const radius = this.view.radii[fruit - 1] ?? 0;
      const along = SPOT.dot(direction);
      const beside = SPOT.lengthSq() - along * along;
      const to = along - Math.sqrt(Math.max(radius * radius - beside, 0));
      if (beside <= radius * radius && to > 0 && to < nearest) {
        nearest = to;
        found = fruit;
      }
    }
    return found;
  }

  /** Where a fruit is seen on the canvas; px. `null` where it is not in the scene. */
  placeOf(fruit: number): [number, number] | null {
    const frame = this.#frame;
    for (let k = 0; frame && k < frame.count; k++) {
      if (frame.words[k * WORDS] !== fruit) continue;
      this.#fruit.getMatrixAt(k, MATRIX);
      SPOT.setFromMatrixPosition(MATRIX).project(this.#camera);
      const { clientWidth: width, clientHeight: height } = this.canvas;
      return [((SPOT.x + 1) / 2) * width, ((1 - SPOT.y) / 2) * height];
    }
    return null;
  }

  /** Draws in the next animation frame. */
  draw(): void {
    if (this.#due) return;
    this.#due = true;
    requestAnimationFrame(() => {
      if (!this.#due) return;
      this.render();
    });
  }

  /** Draws at once. */
  render(): void {
    this.#due = false;
    this.#renderer.render(this.#scene, this.#camera);
    this.drawn();
  }

  /** Pixels of the canvas in one of the page; as many as the screen has where it is `null`. */
  enlarge(scale: number | null): void {
    this.#renderer.setPixelRatio(scale ?? Math.min(window.devicePixelRatio, 2));
    if (scale === null) this.draw();
  }

  dispose(): void {
    this.#due = false;
    this.#controls.dispose();
    this.#renderer.dispose();
  }
}

const MATRIX = new Matrix4();
const SPOT = new Vector3();
const SIZE = new Vector3();
const ROTATION = new Quaternion();
const OTHER = new Quaternion();
const RAY = new Raycaster();

/** Corners of the walls, and of the box in which fruit come, too. */
function outline(view: SceneView): Vector3[] {
  const points: Vector3[] = [];
  for (const own of view.vertices) {
    for (let at = 0; at < own.length; at += 3) points.push(new Vector3().fromArray(own, at));
  }
  const { low, high } = view.about.bounds;
  for (let corner = 0; corner < 8; corner++) {
    const [x, y, z] = [0, 1, 2].map((k) => (corner & (1 << k) ? high[k]! : low[k]!));
    points.push(new Vector3(x, y, z));
  }
  return points;
}

/** Place and orientation between two records of a fruit, into SPOT and ROTATION. Over an end of a
 *  scene that repeats a fruit goes on, not back through the scene. */
function between(
  from: Float32Array,
  a: number,
  to: Float32Array | null,
  b: number,
  part: number,
  periods: number[],
): void {
  SPOT.fromArray(from, a + PLACE);
  turnOf(from, a + TURN, ROTATION);
  if (!to) return;
  SIZE.fromArray(to, b + PLACE);
  for (const [axis, period] of periods.entries()) {
    const way = SIZE.getComponent(axis) - SPOT.getComponent(axis);
    if (period > 0) SIZE.setComponent(axis, SIZE.getComponent(axis) - period * Math.round(way / period));
  }
  SPOT.lerp(SIZE, part);
  ROTATION.slerp(turnOf(to, b + TURN, OTHER), part);
}

function turnOf(numbers: Float32Array, at: number, into: Quaternion): Quaternion {
  return into.set(numbers[at + 1]!, numbers[at + 2]!, numbers[at + 3]!, numbers[at]!);
}

/** Where a wall is between two frames. */
function pose(from: Float32Array, to: Float32Array | null, at: number, part: number, into: Matrix4): void {
  turnOf(from, at, ROTATION);
  SPOT.fromArray(from, at + 4);
  if (to) {
    ROTATION.slerp(turnOf(to, at, OTHER), part);
    SPOT.lerp(SIZE.fromArray(to, at + 4), part);
  }
  into.compose(SPOT, ROTATION, SIZE.setScalar(1));
}

/** A ball with dark poles, so that its rolling shows. */
function marked(around: number): SphereGeometry {
  const ball = new SphereGeometry(1, around, Math.round(0.6 * around));
  const places = ball.getAttribute("position");
  const shades = new Float32Array(3 * places.count);
  for (let k = 0; k < places.count; k++) shades.fill(Math.abs(places.getY(k)) > 0.96 ? 0.35 : 1, 3 * k, 3 * k + 3);
  ball.setAttribute("color", new BufferAttribute(shades, 3));
  return ball;
}
