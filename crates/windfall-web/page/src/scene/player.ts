/** A scene in 3D: transparent walls, fruit as shaded balls coloured by their largest peak
 *  force. */

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
  SphereGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { ContactView, SceneView } from "../api/types";
import { pick } from "../plots/scale";
import { PEAK, PLACE, TURN, WORDS, type Frame } from "./frames";

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
/** Fruit beyond which balls have fewer faces. */
const MANY = 2500;
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
    this.#renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.#colours = view.colours.map((own) => new Color(own));
    const { low, high } = view.about.bounds;
    this.#middle = new Vector3(...low).add(new Vector3(...high)).multiplyScalar(0.5);
    this.#points = outline(view);
    this.#size = Math.max(new Vector3(...low).distanceTo(new Vector3(...high)), 1e-3);

    this.#scene.add(new HemisphereLight(0xffffff, 0xc8ccd4, 2.5));
    const sun = new DirectionalLight(0xffffff, 1.0);
    sun.position.set(-0.4, -0.8, 1.2);
    this.#scene.add(sun);

    const capacity = Math.max(1, ...view.counts);
    const ball = marked(capacity > MANY ? 14 : 28);
    this.#fruit = new InstancedMesh(ball, new MeshLambertMaterial({ vertexColors: true }), capacity);
    this.#fruit.frustumCulled = false;
    this.#fruit.setColorAt(0, this.#colours[0]!);
    this.#fruit.count = 0;
    this.#scene.add(this.#fruit);

    this.#own = new Mesh(marked(40), new MeshLambertMaterial({ vertexColors: true }));
    this.#chosen = new Mesh(new SphereGeometry(1, 40, 24), new MeshBasicMaterial({ side: BackSide }));
    this.#spots = new InstancedMesh(new SphereGeometry(1, 12, 8), new MeshBasicMaterial(), SPOTS);
    this.#spots.frustumCulled = false;
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
    group.add(mesh, new LineSegments(new EdgesGeometry(geometry, BEND), edge));
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

  /** Fits the whole scene into view from a side. */
  look(azimuth: number, elevation: number): void {
    this.#from = [azimuth, elevation];
    this.#turned = false;
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
      for (const point of this.#points) {
        SPOT.subVectors(point, target);
        const far = Math.max(Math.abs(SPOT.dot(right)) / wide, Math.abs(SPOT.dot(up)) / high);
        away = Math.max(away, far + SPOT.dot(from));
      }
      const ends = [right, up].map((axis) => {
        const seen = this.#points.map((point) => {
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
    this.#frame = before;
    this.#time = time;
    for (const [place, group] of this.#walls.entries()) {
      pose(before.walls, next?.walls ?? null, 7 * place, part, group.matrix);
      group.matrixWorldNeedsUpdate = true;
    }
    this.#balls(before, next, part);
    this.draw();
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
      this.#fruit.setColorAt(k, this.#colour(before.numbers[at + PEAK]!));
      if (fruit === this.#selected) {
        found = true;
        this.#own.position.copy(SPOT);
        this.#own.quaternion.copy(ROTATION);
        this.#own.scale.setScalar(radius * 1.001);
        this.#own.material.color.copy(this.#colour(before.numbers[at + PEAK]!));
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

  #colour(force: number): Color {
    return pick(this.#colours, force / this.view.most);
  }

  /** Marks a fruit, and where it was struck; `through` makes the others transparent. */
  select(fruit: number | null, contacts: ContactView[], through: boolean): void {
    this.#selected = fruit;
    this.#contacts = [...contacts].sort((a, b) => b.peak_force - a.peak_force);
    const material = this.#fruit.material as MeshLambertMaterial;
    const clear = through && fruit !== null;
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
      this.#due = false;
      this.#renderer.render(this.#scene, this.#camera);
      this.drawn();
    });
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

/** Corners of the walls, or of the whole where there are none. */
function outline(view: SceneView): Vector3[] {
  const points: Vector3[] = [];
  for (const own of view.vertices) {
    for (let at = 0; at < own.length; at += 3) points.push(new Vector3().fromArray(own, at));
  }
  const { low, high } = view.about.bounds;
  if (points.length === 0) {
    for (let corner = 0; corner < 8; corner++) {
      const [x, y, z] = [0, 1, 2].map((k) => (corner & (1 << k) ? high[k]! : low[k]!));
      points.push(new Vector3(x, y, z));
    }
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
