// SPDX-License-Identifier: GPL-3.0-or-later
// Three ways to look: around a point, on foot, and from above as on a plan (north up).
import { MathUtils, MOUSE, OrthographicCamera, PerspectiveCamera, TOUCH, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { CameraMode, Pose } from '../data/address.ts';
import type { Vector } from '../data/voxel_id.ts';

export const EYE_HEIGHT = 1.7; // [m] on foot
const FIELD_OF_VIEW_DEG = 50;
const HALF_VIEW = Math.tan(MathUtils.degToRad(FIELD_OF_VIEW_DEG / 2));
const FLIGHT_MS = 700;
const ASIDE = 0.22; // [rad] from straight along a street, so that boxes show two sides
const WALK_SPEED = 6; // [m/s]
const MAX_PITCH = 1.45; // [rad]

export class CameraRig {
  mode: CameraMode = 'orbit';
  isStill = false; // prefers-reduced-motion: jumps instead of flights
  readonly target = new Vector3();
  private readonly perspective = new PerspectiveCamera(FIELD_OF_VIEW_DEG, 1, 0.1, 1000);
  private readonly parallel = new OrthographicCamera(-1, 1, 1, -1, 0.1, 1000);
  private readonly orbit: OrbitControls;
  private readonly plan: OrbitControls;
  private readonly heading = { yaw: 0, pitch: 0 }; // on foot [rad], yaw counter-clockwise from east
  private readonly pressed = new Set<string>();
  private flight: { from: Pose; to: Pose; start: number } | null = null;
  private extent = 100; // [m] of the map
  private lastTick = 0;
  private readonly onMove: () => void;

  constructor(element: HTMLElement, onMove: () => void) {
    this.onMove = onMove;
    this.perspective.up.set(0, 0, 1);
    this.parallel.up.set(0, 1, 0);
    this.orbit = new OrbitControls(this.perspective, element);
    this.plan = new OrbitControls(this.parallel, element);
    this.setUpControls();
    this.addLooking(element);
  }

  get camera(): PerspectiveCamera | OrthographicCamera {
    return this.mode === 'plan' ? this.parallel : this.perspective;
  }

  get isFlying(): boolean {
    return this.flight !== null;
  }

  /** Diagonal of the map [m], which bounds how far one sees and goes. */
  setExtent(metres: number): void {
    this.extent = Math.max(metres, 10);
    this.orbit.maxDistance = 4 * this.extent;
  }

  setAspect(aspect: number): void {
    this.perspective.aspect = aspect;
    this.parallel.left = -aspect;
    this.parallel.right = aspect;
  }

  pose(): Pose {
    if (this.mode === 'plan') {
      const { x, y, z } = this.plan.target;
      return { mode: 'plan', eye: [x, y, z + 1 / this.parallel.zoom / HALF_VIEW], target: [x, y, z] };
    }
    const eye = this.perspective.position.toArray();
    const target = this.mode === 'walk' ? this.perspective.position.clone().addScaledVector(this.walkDirection(), 5) : this.orbit.target;
    return { mode: this.mode, eye, target: target.toArray() };
  }

  set(pose: Pose): void {
    this.mode = pose.mode;
    const [eye, target] = [new Vector3(...pose.eye), new Vector3(...pose.target)];
    if (pose.mode === 'plan') {
      this.parallel.zoom = 1 / Math.max(eye.distanceTo(target) * HALF_VIEW, 0.5);
      this.parallel.position.copy(target).setZ(target.z + this.extent + 100);
      this.plan.target.copy(target);
    } else {
      this.perspective.position.copy(eye);
      this.orbit.target.copy(target);
      const direction = target.sub(eye).normalize();
      this.heading.yaw = Math.atan2(direction.y, direction.x);
      this.heading.pitch = Math.asin(MathUtils.clamp(direction.z, -1, 1));
    }
    this.enable();
    this.onMove();
  }

  /** Moves there, in one mode smoothly. */
  fly(pose: Pose): void {
    if (this.isStill || pose.mode !== this.mode || pose.mode === 'walk') {
      this.flight = null;
      this.set(pose);
      return;
    }
    this.flight = { from: this.pose(), to: pose, start: performance.now() };
    this.onMove();
  }

  /** The other mode at the same place; ground: where a walker would stand. */
  switchTo(mode: CameraMode, ground: Vector): void {
    if (mode === this.mode) return;
    const { mode: before, eye, target } = this.pose();
    const at = before === 'walk' ? new Vector3(eye[0], eye[1], eye[2] - EYE_HEIGHT) : new Vector3(...target);
    const distance = before === 'walk' ? 40 : Math.max(new Vector3(...eye).distanceTo(new Vector3(...target)), 5);
    const backwards = new Vector3(...eye).sub(new Vector3(...target)).setZ(0);
    if (before === 'plan' || backwards.lengthSq() < 1e-6) backwards.set(0, -1, 0);
    backwards.normalize();
    if (mode === 'plan') this.set({ mode, eye: [at.x, at.y, at.z + distance], target: at.toArray() });
    else if (mode === 'orbit') this.set({ mode, target: at.toArray(), eye: at.clone().addScaledVector(backwards, distance * 0.75).add(new Vector3(0, 0, distance * 0.6)).toArray() });
    else {
      const stand = new Vector3(ground[0], ground[1], ground[2] + EYE_HEIGHT);
      this.set({ mode, eye: stand.toArray(), target: stand.clone().addScaledVector(backwards, -5).toArray() });
    }
  }

  /** One step of flights, inertia and walking; true while there is more to come. */
  tick(now: number): boolean {
    const seconds = Math.min((now - this.lastTick) / 1000, 0.1);
    this.lastTick = now;
    const isMoving = this.flight ? this.stepFlight(now) : this.mode === 'walk' ? this.stepWalk(seconds) : this.controls().update(seconds);
    this.updateProjection();
    return isMoving;
  }

  /** Keys and buttons that stay down: 'forward', 'back', 'left', 'right'; on foot they walk, else they pan. */
  press(direction: string, isDown: boolean): void {
    if (isDown) this.pressed.add(direction);
    else this.pressed.delete(direction);
    this.onMove();
  }

  /** Ground beneath the walker. */
  setGround(height: number): void {
    if (this.mode === 'walk') this.perspective.position.z = height + EYE_HEIGHT;
  }

  /** Shares of the view to the right and up. */
  pan(right: number, up: number): void {
    const { eye, target, mode } = this.pose();
    const reach = new Vector3(...eye).distanceTo(new Vector3(...target)) * HALF_VIEW * 2;
    const forward = mode === 'plan' ? new Vector3(0, 1, 0) : new Vector3(target[0] - eye[0], target[1] - eye[1], 0).normalize();
    const move = forward.clone().multiplyScalar(up * reach).add(new Vector3(forward.y, -forward.x, 0).multiplyScalar(right * reach));
    const shift = (from: Vector): Vector => [from[0] + move.x, from[1] + move.y, from[2]];
    this.set({ mode, eye: shift(eye), target: shift(target) });
  }

  /** Around the target, or the walker's head [rad]. */
  turn(yaw: number, pitch: number): void {
    if (this.mode === 'walk') {
      this.heading.yaw += yaw;
      this.heading.pitch = MathUtils.clamp(this.heading.pitch + pitch, -MAX_PITCH, MAX_PITCH);
      this.onMove();
      return;
    }
    if (this.mode === 'plan') return;
    const offset = this.perspective.position.clone().sub(this.orbit.target);
    const radius = offset.length();
    const angle = Math.atan2(offset.y, offset.x) + yaw;
    const height = MathUtils.clamp(Math.asin(offset.z / radius) + pitch, 0.02, 1.55);
    const level = radius * Math.cos(height);
    const eye = this.orbit.target.clone().add(new Vector3(level * Math.cos(angle), level * Math.sin(angle), radius * Math.sin(height)));
    this.set({ mode: 'orbit', eye: eye.toArray(), target: this.orbit.target.toArray() });
  }

  zoom(factor: number): void {
    const { mode, eye, target } = this.pose();
    if (mode === 'walk') return;
    const at = new Vector3(...target);
    this.set({ mode, target, eye: new Vector3(...eye).sub(at).multiplyScalar(factor).add(at).toArray() });
  }

  /** Counter-clockwise from east of what is up on the screen [rad]. */
  bearing(): number {
    if (this.mode === 'plan') return Math.PI / 2;
    const { eye, target } = this.pose();
    return Math.atan2(target[1] - eye[1], target[0] - eye[0]);
  }

  /** A place seen from a comfortable distance [m], looking along the axis of a street where one is given [rad], whichever way is nearer. */
  poseAt(point: Vector, distance: number, axis: number | null = null): Pose {
    const mode = this.mode === 'plan' ? 'plan' : 'orbit';
    if (mode === 'plan') return { mode, target: point, eye: [point[0], point[1], point[2] + distance * 1.6] };
    const bearing = this.bearing();
    const angle = axis === null ? bearing : axis + (Math.cos(bearing - axis) < 0 ? Math.PI : 0) + ASIDE;
    const height = axis === null ? 0.62 : 0.75; // steeper between houses
    const level = distance * Math.sqrt(1 - height * height);
    return { mode, target: point, eye: [point[0] - level * Math.cos(angle), point[1] - level * Math.sin(angle), point[2] + distance * height] };
  }

  private controls(): OrbitControls {
    return this.mode === 'plan' ? this.plan : this.orbit;
  }

  private setUpControls(): void {
    for (const controls of [this.orbit, this.plan]) {
      controls.zoomToCursor = true;
      controls.zoomSpeed = 1.4;
      controls.enabled = false;
      controls.addEventListener('change', () => this.onMove());
      controls.addEventListener('start', () => { this.flight = null; });
    }
    this.orbit.maxPolarAngle = 1.56;
    this.orbit.minDistance = 0.6;
    this.orbit.screenSpacePanning = false;
    this.plan.enableRotate = false;
    this.plan.mouseButtons = { LEFT: MOUSE.PAN, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.plan.touches = { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_PAN };
  }

  private enable(): void {
    this.orbit.enabled = this.mode === 'orbit';
    this.plan.enabled = this.mode === 'plan';
    for (const controls of [this.orbit, this.plan]) {
      controls.enableDamping = !this.isStill;
      controls.dampingFactor = 0.12;
    }
    if (this.mode === 'walk') this.lookAhead();
    else this.controls().update();
    this.updateProjection();
  }

  private updateProjection(): void {
    const eye = this.perspective.position;
    const distance = this.mode === 'walk' ? EYE_HEIGHT : eye.distanceTo(this.orbit.target);
    this.perspective.near = MathUtils.clamp(distance * 0.02, 0.05, 20);
    this.perspective.far = 3 * this.extent + 2 * distance + 200;
    this.parallel.far = 2 * this.extent + 300;
    for (const camera of [this.perspective, this.parallel]) {
      camera.updateProjectionMatrix();
      camera.updateMatrixWorld();
    }
  }

  private stepFlight(now: number): boolean {
    const { from, to, start } = this.flight!;
    const share = Math.min((now - start) / FLIGHT_MS, 1);
    const eased = share * share * (3 - 2 * share);
    const between = (a: Vector, b: Vector) => new Vector3(...a).lerp(new Vector3(...b), eased).toArray();
    this.set({ mode: to.mode, eye: between(from.eye, to.eye), target: between(from.target, to.target) });
    if (share === 1) this.flight = null;
    return share < 1;
  }

  private stepWalk(seconds: number): boolean {
    const along = Number(this.pressed.has('forward')) - Number(this.pressed.has('back'));
    const aside = Number(this.pressed.has('right')) - Number(this.pressed.has('left'));
    const { yaw } = this.heading;
    const step = new Vector3(Math.cos(yaw), Math.sin(yaw), 0).multiplyScalar(along).add(new Vector3(Math.sin(yaw), -Math.cos(yaw), 0).multiplyScalar(aside));
    if (step.lengthSq() > 0) this.perspective.position.addScaledVector(step.normalize(), WALK_SPEED * seconds);
    this.lookAhead();
    return step.lengthSq() > 0;
  }

  private walkDirection(): Vector3 {
    const { yaw, pitch } = this.heading;
    return new Vector3(Math.cos(yaw) * Math.cos(pitch), Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch));
  }

  private lookAhead(): void {
    this.perspective.lookAt(this.perspective.position.clone().add(this.walkDirection()));
    this.perspective.updateMatrixWorld();
  }

  /** On foot, dragging turns the head. */
  private addLooking(element: HTMLElement): void {
    let last: { x: number; y: number; id: number } | null = null;
    element.addEventListener('pointerdown', (event) => {
      if (this.mode === 'walk') last = { x: event.clientX, y: event.clientY, id: event.pointerId };
    });
    element.addEventListener('pointermove', (event) => {
      if (!last || this.mode !== 'walk' || event.pointerId !== last.id) return;
      this.turn((event.clientX - last.x) * 0.004, (event.clientY - last.y) * 0.004);
      last = { x: event.clientX, y: event.clientY, id: event.pointerId };
    });
    for (const type of ['pointerup', 'pointercancel'] as const) element.addEventListener(type, () => { last = null; });
    element.addEventListener('wheel', (event) => {
      if (this.mode !== 'walk') return;
      const distance = MathUtils.clamp(-event.deltaY * 0.01, -2, 2);
      this.perspective.position.add(new Vector3(Math.cos(this.heading.yaw), Math.sin(this.heading.yaw), 0).multiplyScalar(distance));
      this.onMove();
    }, { passive: true });
  }
}
