// SPDX-License-Identifier: GPL-3.0-or-later
// The second pass: outlines where depth leaps (Boucheny 2009, eye-dome lighting), shade in corners, and the sky behind.
import {
  DepthTexture, FloatType, GLSL3, Mesh, NearestFilter, OrthographicCamera, PlaneGeometry, RawShaderMaterial, Scene, Vector2,
  Vector3, WebGLRenderTarget, type PerspectiveCamera, type WebGLRenderer,
} from 'three';

const VERTEX = /* glsl */ `
in vec3 position;
out vec2 at;
void main() { at = position.xy * 0.5 + 0.5; gl_Position = vec4(position.xy, 0.0, 1.0); }
`;

const FRAGMENT = /* glsl */ `
precision highp float;
precision highp sampler2D;
uniform sampler2D picture;
uniform sampler2D depths;
uniform vec2 size;           // [pixels]
uniform vec2 range;          // near and far [m]
uniform bool isParallel;
uniform float pixelsPerUnit;
uniform vec3 skyLow;
uniform vec3 skyHigh;
uniform float outline;
uniform float viewHeight;    // [m] of a parallel view
in vec2 at;
out vec4 result;

float distanceAt(vec2 where) {
  float depth = texture(depths, where).r;
  return isParallel ? mix(range.x, range.y, depth) : range.x * range.y / (range.y - depth * (range.y - range.x));
}

// How much nearer the other is, so that the same edge looks the same far and near.
float leap(float here, float other) {
  return isParallel ? (here - other) / viewHeight : log2(here / other);
}

const vec2 kRing[6] = vec2[6](vec2(1.0, 0.0), vec2(0.5, 0.866), vec2(-0.5, 0.866), vec2(0.92, 0.38), vec2(0.13, 0.99), vec2(-0.79, 0.61));

void main() {
  vec4 colour = texture(picture, at);
  vec3 sky = mix(skyLow, skyHigh, smoothstep(0.0, 1.0, at.y));
  if (texture(depths, at).r >= 1.0) { result = vec4(mix(sky, colour.rgb, colour.a), 1.0); return; }

  float here = distanceAt(at);
  vec2 pixel = 1.0 / size;
  float sum = 0.0;
  sum += max(0.0, leap(here, distanceAt(at + vec2(pixel.x, 0.0))));
  sum += max(0.0, leap(here, distanceAt(at - vec2(pixel.x, 0.0))));
  sum += max(0.0, leap(here, distanceAt(at + vec2(0.0, pixel.y))));
  sum += max(0.0, leap(here, distanceAt(at - vec2(0.0, pixel.y))));
  float edge = exp(-outline * min(sum, 0.12));

  // Opposite neighbours that are nearer on average: a corner. A slope alone is none, nor is what stands far before it.
  float shade = 0.0;
  // Each pixel asks in other directions (Jimenez 2014, interleaved gradient noise), or the neighbours would leave ghosts of their outlines.
  float turn = 1.047 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  mat2 turned = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
  for (int i = 0; i < 6; ++i) {
    float radius = i < 3 ? 0.35 : 1.1;  // [m]
    vec2 offset = turned * kRing[i] * clamp(radius * pixelsPerUnit / (isParallel ? 1.0 : here), 2.0, 90.0) * pixel;
    vec2 nearer = here - vec2(distanceAt(at + offset), distanceAt(at - offset));
    float isBeside = 1.0 - smoothstep(0.8 * radius, 1.3 * radius, max(nearer.x, nearer.y));
    shade += isBeside * clamp(0.5 * (nearer.x + nearer.y) / radius, 0.0, 1.0);
  }
  float ambient = 1.0 - 0.75 * min(shade / 2.4, 0.75);

  float haze = isParallel ? 0.0 : 0.35 * (1.0 - exp(-here / 400.0));
  result = vec4(mix(colour.rgb * edge * ambient, sky, haze), 1.0);
}
`;

export class Shading {
  readonly target: WebGLRenderTarget;
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly uniforms = {
    picture: { value: null as unknown },
    depths: { value: null as unknown },
    size: { value: new Vector2() },
    range: { value: new Vector2() },
    isParallel: { value: false },
    pixelsPerUnit: { value: 1 },
    skyLow: { value: new Vector3() },
    skyHigh: { value: new Vector3() },
    outline: { value: 9 },
    viewHeight: { value: 1 },
  };

  constructor() {
    this.target = new WebGLRenderTarget(1, 1, { depthTexture: new DepthTexture(1, 1, FloatType), minFilter: NearestFilter, magFilter: NearestFilter });
    this.uniforms.picture.value = this.target.texture;
    this.uniforms.depths.value = this.target.depthTexture;
    const material = new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: this.uniforms, depthTest: false, depthWrite: false });
    const quad = new Mesh(new PlaneGeometry(2, 2), material);
    quad.frustumCulled = false;
    this.scene.add(quad);
  }

  /** Has the shader compiled before it is needed. */
  compile(renderer: WebGLRenderer): void {
    renderer.compile(this.scene, this.camera);
  }

  setSize(width: number, height: number): void {
    if (this.target.width !== width || this.target.height !== height) this.target.setSize(width, height);
    this.uniforms.size.value.set(width, height);
  }

  setSky(low: Vector3, high: Vector3): void {
    this.uniforms.skyLow.value.copy(low);
    this.uniforms.skyHigh.value.copy(high);
  }

  /** Shades the target into the canvas. */
  draw(renderer: WebGLRenderer, camera: PerspectiveCamera | OrthographicCamera, pixelsPerUnit: number): void {
    const isParallel = 'isOrthographicCamera' in camera;
    this.uniforms.range.value.set(camera.near, camera.far);
    this.uniforms.isParallel.value = isParallel;
    this.uniforms.pixelsPerUnit.value = pixelsPerUnit;
    this.uniforms.viewHeight.value = isParallel ? ((camera as OrthographicCamera).top - (camera as OrthographicCamera).bottom) / camera.zoom : 1;
    renderer.setRenderTarget(null);
    renderer.render(this.scene, this.camera);
  }
}
