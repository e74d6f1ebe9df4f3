// SPDX-License-Identifier: GPL-3.0-or-later
// Parking spaces as boxes: red, green or grey by their state, with a badge above that says the same without colour, and a ring where it is new.
import {
  BufferAttribute, BufferGeometry, CanvasTexture, Color, DoubleSide, Group, LinearFilter, Mesh, MeshBasicMaterial, Ray, ShapeUtils,
  Sprite, SpriteMaterial, Vector2, Vector3, type Camera,
} from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { centreOf, isNew, stateAt, type Space, type State } from '../data/spaces.ts';
import { css, STATE_COLOURS } from './colours.ts';

const NEW_COLOUR = '#ffc533';
const FILL = 0.3;
const FAINT_FILL = 0.1;
const BADGE_PIXELS = 30;
const BADGE_REACH = 140; // [m] from the eye; farther ones would hide each other

const stateColour = (state: State) => new Color(...(STATE_COLOURS[state].map((c) => c / 255) as [number, number, number]));

/** Corners of the floor and the lid. */
function cornersOf(space: Space): { low: Vector3[]; high: Vector3[] } {
  const low = space.polygon.map(([x, y, z]) => new Vector3(x, y, z + 0.06));
  return { low, high: low.map((corner) => corner.clone().setZ(corner.z + space.height)) };
}

function trianglesOf(space: Space): number[] {
  const { low, high } = cornersOf(space);
  const positions: number[] = [];
  const add = (...corners: Vector3[]) => corners.forEach((corner) => positions.push(...corner.toArray()));
  low.forEach((a, i) => {
    const j = (i + 1) % low.length;
    add(a, low[j], high[j], a, high[j], high[i]);
  });
  const lid = ShapeUtils.triangulateShape(high.map(({ x, y }) => new Vector2(x, y)), []);
  for (const [i, j, k] of lid) add(high[i], high[j], high[k], low[i], low[k], low[j]);
  return positions;
}

function edgesOf(space: Space): number[] {
  const { low, high } = cornersOf(space);
  return low.flatMap((a, i) => {
    const j = (i + 1) % low.length;
    return [a, low[j], high[i], high[j], a, high[i]].flatMap((corner) => corner.toArray());
  });
}

/** Symbol of a state on a disc: a bar (taken), a ring (free), a question mark. */
function drawBadge(state: State, isNewState: boolean): CanvasTexture {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 96;
  const pen = canvas.getContext('2d')!;
  const disc = (radius: number, colour: string) => {
    pen.fillStyle = colour;
    pen.beginPath();
    pen.arc(48, 48, radius, 0, 2 * Math.PI);
    pen.fill();
  };
  if (isNewState) disc(47, NEW_COLOUR);
  disc(isNewState ? 38 : 34, '#ffffff');
  disc(isNewState ? 33 : 30, css(STATE_COLOURS[state]));
  pen.fillStyle = pen.strokeStyle = '#ffffff';
  pen.lineWidth = 6;
  if (state === 'occupied') pen.fillRect(32, 43, 32, 10);
  else if (state === 'vacant') {
    pen.beginPath();
    pen.arc(48, 48, 13, 0, 2 * Math.PI);
    pen.stroke();
  } else {
    pen.font = 'bold 40px sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.fillText('?', 48, 51);
  }
  const texture = new CanvasTexture(canvas);
  texture.minFilter = LinearFilter;
  return texture;
}

const badges = new Map<string, CanvasTexture>();
function badgeOf(state: State, isNewState: boolean): CanvasTexture {
  const key = `${state}${isNewState}`;
  if (!badges.has(key)) badges.set(key, drawBadge(state, isNewState));
  return badges.get(key)!;
}

/** The spaces as one epoch shows them. */
export class SpaceBoxes extends Group {
  readonly badges = new Group(); // drawn over the shaded picture
  readonly marks = new Group(); // outlines, drawn there too
  private readonly fills: MeshBasicMaterial[] = [];
  private readonly spaces: readonly Space[];

  constructor(spaces: readonly Space[], epoch: string, epochs: readonly string[], selected: string | null) {
    super();
    this.spaces = spaces;
    for (const state of ['unknown', 'vacant', 'occupied'] as const) {
      const inState = spaces.filter((space) => stateAt(space, epoch) === state);
      this.addFill(inState, state);
      this.addEdges(inState.filter((space) => !isNew(space, epoch, epochs)), stateColour(state), 2);
    }
    this.addEdges(spaces.filter((space) => isNew(space, epoch, epochs)), NEW_COLOUR, 3.5);
    const chosen = spaces.find((space) => space.id === selected);
    if (chosen) this.marks.add(outline(edgesOf(chosen), '#ffffff', 5), outline(edgesOf(chosen), '#1463ff', 2.5));
    for (const space of spaces) this.addBadge(space, stateAt(space, epoch), isNew(space, epoch, epochs));
  }

  /** Where one looks through many boxes, or colours say something else, the boxes hold back. */
  setFaint(isFaint: boolean): void {
    for (const fill of this.fills) fill.opacity = isFaint ? FAINT_FILL : FILL;
  }

  /** Badges keep their size on the screen; pixel: of the picture's height. */
  placeBadges(camera: Camera, height: number): void {
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld);
    const isParallel = 'isOrthographicCamera' in camera;
    const scale = (2 * BADGE_PIXELS) / height / camera.projectionMatrix.elements[5];
    for (const badge of this.badges.children) {
      const distance = eye.distanceTo(badge.position);
      badge.visible = isParallel || distance < BADGE_REACH;
      badge.scale.setScalar(isParallel ? scale : scale * distance);
    }
  }

  /** The nearest space on a ray, and how far it is. */
  hit(ray: Ray): { space: Space; distance: number } | null {
    let nearest: { space: Space; distance: number } | null = null;
    for (const space of this.spaces) {
      const positions = trianglesOf(space);
      for (let i = 0; i < positions.length; i += 9) {
        const [a, b, c] = [0, 3, 6].map((k) => new Vector3().fromArray(positions, i + k));
        const distance = ray.intersectTriangle(a, b, c, false, new Vector3())?.distanceTo(ray.origin);
        if (distance !== undefined && (!nearest || distance < nearest.distance)) nearest = { space, distance };
      }
    }
    return nearest;
  }

  dispose(): void {
    for (const group of [this, this.marks, this.badges] as Group[]) {
      group.traverse((part) => {
        const { geometry, material } = part as Mesh;
        if (!(part as Sprite).isSprite) geometry?.dispose();
        (material as MeshBasicMaterial | undefined)?.dispose();
      });
    }
  }

  private addFill(spaces: readonly Space[], state: State): void {
    if (spaces.length === 0) return;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(spaces.flatMap(trianglesOf)), 3));
    const fill = new MeshBasicMaterial({ color: stateColour(state), transparent: true, opacity: FILL, depthWrite: false, side: DoubleSide, toneMapped: false });
    this.fills.push(fill);
    this.add(new Mesh(geometry, fill));
  }

  private addEdges(spaces: readonly Space[], colour: Color | string, width: number): void {
    if (spaces.length > 0) this.add(outline(spaces.flatMap(edgesOf), colour, width, true));
  }

  private addBadge(space: Space, state: State, isNewState: boolean): void {
    const badge = new Sprite(new SpriteMaterial({ map: badgeOf(state, isNewState), depthTest: false, depthWrite: false, transparent: true, toneMapped: false }));
    badge.position.set(...centreOf(space));
    badge.position.z += space.height + 0.5;
    this.badges.add(badge);
  }
}

/** Lines between pairs of points, `width` pixels wide; hidden by what is before them only where isInScene. */
export function outline(positions: number[], colour: Color | string, width: number, isInScene = false): LineSegments2 {
  const material = new LineMaterial({ color: new Color(colour).getHex(), linewidth: width, depthTest: isInScene, depthWrite: false, transparent: true, toneMapped: false });
  const lines = new LineSegments2(new LineSegmentsGeometry().setPositions(positions), material);
  lines.frustumCulled = false;
  return lines;
}
