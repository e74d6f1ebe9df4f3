// SPDX-License-Identifier: GPL-3.0-or-later
// Voxels without vertices: each vertex finds its voxel in a texture by its number. A cube costs the seven corners that the eye can see, or one
// point where it is only a few pixels wide. (Instances would be shorter to write, but some drivers draw them one by one.)

/** Words of a voxel: x y z faces | red green blue label | change age; the last pair only where the map has them. */
const READ_VOXEL = /* glsl */ `
precision highp float;
precision highp int;
precision highp usampler2D;

uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform usampler2D voxels;
uniform sampler2D table;
uniform vec4 eyeInTile;     // [voxels] position and 1, or direction towards the eye and 0
uniform uint tileNumber;
uniform int colourMode;     // -1: own colour, else a row of the table
uniform vec3 heightRange;   // lowest, 1 / extent [m], and the tile's lowest
uniform float voxelSize;    // [m]

flat out vec3 colour;
flat out uint name;

const uint kVanished = 2u;

vec3 srgb(vec3 linear) {
  return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, vec3(lessThan(linear, vec3(0.0031308))));
}

uvec4 wordsOf(int voxel) {
  return texelFetch(voxels, ivec2(voxel & 2047, voxel >> 11), 0);
}

vec3 centreOf(uvec4 words) {
  return vec3(words.x & 255u, (words.x >> 8) & 255u, (words.x >> 16) & 255u);
}

// In every picture but that of the changes a voxel that is gone is not there.
bool isHidden(uvec4 words) {
  return (words.z & 255u) == kVanished && colourMode != 2;
}

vec3 colourOf(uvec4 words, vec3 centre) {
  vec3 own = srgb(vec3(words.y & 255u, (words.y >> 8) & 255u, (words.y >> 16) & 255u) / 255.0);
  if (colourMode < 0) return own;
  if (colourMode == 0) {
    float height = (heightRange.z + (centre.z + 0.5) * voxelSize - heightRange.x) * heightRange.y;
    return texelFetch(table, ivec2(clamp(height, 0.0, 1.0) * 255.0, 0), 0).rgb;
  }
  uint value = colourMode == 1 ? words.y >> 24 : colourMode == 2 ? words.z & 255u : (words.z >> 8) & 255u;
  if (colourMode == 2 && value == 0u) return mix(vec3(0.80), vec3(dot(own, vec3(0.3, 0.59, 0.11))), 0.45);
  return texelFetch(table, ivec2(int(value), colourMode), 0).rgb;
}
`;

// Light from the south-west above, by face: -x +x -y +y -z +z.
const FACE_LIGHT = /* glsl */ `
const vec3 kLow = vec3(0.80, 0.88, 0.55);
const vec3 kHigh = vec3(0.74, 0.70, 1.0);
`;

export const CUBE_VERTEX = READ_VOXEL + /* glsl */ `
out vec3 inCube;            // -1..1

// Corners by number, 1: on the side towards the eye. The eighth is hidden by the others.
const vec3 kCorners[8] = vec3[8](vec3(1, 1, 1), vec3(-1, 1, 1), vec3(1, -1, 1), vec3(1, 1, -1),
                                 vec3(-1, -1, 1), vec3(-1, 1, -1), vec3(1, -1, -1), vec3(1, 1, 1));

void main() {
  int voxel = gl_VertexID >> 3;
  uvec4 words = wordsOf(voxel);
  vec3 centre = centreOf(words);
  vec3 towards = eyeInTile.xyz - centre * eyeInTile.w;
  vec3 side = vec3(towards.x < 0.0 ? -1.0 : 1.0, towards.y < 0.0 ? -1.0 : 1.0, towards.z < 0.0 ? -1.0 : 1.0);
  inCube = kCorners[gl_VertexID & 7] * side;
  colour = colourOf(words, centre);
  name = (tileNumber << 20) | uint(voxel);
  gl_Position = isHidden(words) ? vec4(2, 2, 2, 1) : projectionMatrix * modelViewMatrix * vec4(centre + 0.5 * inCube, 1.0);
}
`;

export const CUBE_FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
uniform bool isPicking;
uniform float edgeStrength;
flat in vec3 colour;
flat in uint name;
in vec3 inCube;
out vec4 result;
${FACE_LIGHT}
void main() {
  if (isPicking) {
    result = vec4(name & 255u, (name >> 8) & 255u, (name >> 16) & 255u, name >> 24) / 255.0;
    return;
  }
  vec3 size = abs(inCube);
  vec3 light = mix(kLow, kHigh, step(0.0, inCube));
  bool isZ = size.z + 1e-4 >= max(size.x, size.y);  // on an edge: the top
  bool isX = !isZ && size.x >= size.y;
  bool isY = !isZ && !isX;
  float shade = isX ? light.x : isY ? light.y : light.z;
  vec2 inFace = isX ? size.yz : isY ? size.xz : size.xy;
  vec2 pixel = fwidth(inFace);
  vec2 line = 1.0 - smoothstep(vec2(0.0), pixel * 1.5, 1.0 - inFace);
  float visible = clamp((0.12 - max(pixel.x, pixel.y)) * 16.0, 0.0, 1.0);  // faces of 16 pixels and more
  result = vec4(colour * shade * (1.0 - edgeStrength * visible * max(line.x, line.y)), 1.0);
}
`;

export const POINT_VERTEX = READ_VOXEL + /* glsl */ `
uniform float pixelsPerUnit;  // of a length of 1 m at a distance of 1 m, or anywhere in a parallel view
${FACE_LIGHT}
void main() {
  uvec4 words = wordsOf(gl_VertexID);
  vec3 centre = centreOf(words);
  vec3 towards = normalize(eyeInTile.xyz - centre * eyeInTile.w);
  uint faces = words.x >> 24;
  vec3 isHigh = step(0.0, towards);
  vec3 open = vec3((faces >> (isHigh.x > 0.5 ? 1u : 0u)) & 1u, (faces >> (isHigh.y > 0.5 ? 3u : 2u)) & 1u, (faces >> (isHigh.z > 0.5 ? 5u : 4u)) & 1u);
  vec3 weight = abs(towards) * open + 1e-3;
  float shade = dot(weight, mix(kLow, kHigh, isHigh)) / (weight.x + weight.y + weight.z);
  colour = colourOf(words, centre) * shade;
  name = (tileNumber << 20) | uint(gl_VertexID);
  gl_Position = isHidden(words) ? vec4(2, 2, 2, 1) : projectionMatrix * modelViewMatrix * vec4(centre, 1.0);
  // A cube's picture is wider than its face; squares that just touch would let the background through.
  gl_PointSize = max(1.0, 1.35 * voxelSize * pixelsPerUnit / gl_Position.w) + 0.3;
}
`;

export const POINT_FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
uniform bool isPicking;
flat in vec3 colour;
flat in uint name;
out vec4 result;
void main() {
  result = isPicking ? vec4(name & 255u, (name >> 8) & 255u, (name >> 16) & 255u, name >> 24) / 255.0 : vec4(colour, 1.0);
}
`;
