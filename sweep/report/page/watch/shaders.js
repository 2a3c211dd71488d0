// Programs of the graphics processor.
//
// A sphere is a square towards the eye on which each ray is cut with the sphere, so that outline, shading and depth are
// exact in perspective. Lengths are in units of the film's extent.

const sphereVertex = `#version 300 es
precision highp float;
in vec2 corner;
in vec4 place, next;        // whole numbers; w: is it there
in float size, mobile;      // diameter over the largest; 1 or 0
in float shade, nextShade;  // 0: undefined, 1 ... 255
uniform vec3 low, scale, period;
uniform float between, radius, least, showFrozen;
uniform mat4 view, projection;
uniform vec4 cut;
uniform vec2 colours;  // where they begin in the range of the film, and how steep they are
uniform int chosen;
out vec3 centre, point, colour;
out float reach;
uniform sampler2D palette;
uniform vec3 frozenColour;
void main() {
  vec3 step = next.xyz - place.xyz;
  vec3 way = step * scale;
  for (int a = 0; a < 3; ++a) if (period[a] > 0.0) way[a] -= period[a] * round(way[a] / period[a]);
  vec3 world = low + place.xyz * scale + (next.w > 0.5 ? between * way : vec3(0.0));
  bool gone = place.w < 0.5 || (mobile < 0.5 && showFrozen < 0.5) || dot(cut.xyz, world) > cut.w;
  centre = (view * vec4(world, 1.0)).xyz;
  float distance = length(centre);
  reach = max(radius * size, least * distance);
  if (gone || distance <= reach) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  float grown = 1.02 * reach * distance / sqrt(distance * distance - reach * reach);
  vec3 ahead = centre / distance;
  vec3 right = normalize(cross(ahead, abs(ahead.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
  vec3 up = cross(right, ahead);
  point = centre + grown * (corner.x * right + corner.y * up);
  float level = nextShade > 0.5 && shade > 0.5 ? mix(shade, nextShade, between) : shade;
  float along = clamp(((level - 1.0) / 254.0 - colours.x) * colours.y, 0.0, 1.0);
  colour = level > 0.5 ? texture(palette, vec2(along * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb : frozenColour;
  if (gl_InstanceID == chosen) colour = vec3(1.0, 0.25, 0.55);
  gl_Position = projection * vec4(point, 1.0);
}`;

const sphereFragment = `#version 300 es
precision highp float;
in vec3 centre, point, colour;
in float reach;
uniform mat4 projection;
out vec4 pixel;
void main() {
  vec3 ray = normalize(point);
  float along = dot(ray, centre);
  vec3 off = centre - along * ray;
  float rim = length(off) / reach;
  float cover = clamp((1.0 - rim) / max(fwidth(rim), 1e-4) + 0.5, 0.0, 1.0);
  if (cover <= 0.0) discard;
  float depth = sqrt(max(0.0, 1.0 - rim * rim));
  vec3 hit = (along - reach * depth) * ray;
  vec3 normal = (hit - centre) / reach;
  vec4 clip = projection * vec4(hit, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
  vec3 light = normalize(vec3(-0.45, 0.7, 0.75));
  float facing = max(0.0, dot(normal, -ray));
  float bright = 0.42 + 0.62 * max(0.0, 0.25 + 0.75 * dot(normal, light)) - 0.22 * (1.0 - facing);
  float shine = pow(max(0.0, dot(reflect(ray, normal), light)), 24.0) * 0.16;
  pixel = vec4(colour * bright + shine, cover);
}`;

const wallVertex = `#version 300 es
precision highp float;
in vec3 corner, normal;
uniform mat4 view, projection;
uniform float top;
uniform vec4 cut;
out vec3 seen, turned;
out float faded, beyond;
void main() {
  faded = corner.z - top;
  beyond = dot(cut.xyz, corner) - cut.w;
  seen = (view * vec4(corner, 1.0)).xyz;
  turned = mat3(view) * normal;
  gl_Position = projection * vec4(seen, 1.0);
}`;

const wallFragment = `#version 300 es
precision highp float;
in vec3 seen, turned;
in float beyond;  // the cut
in float faded;   // above what is looked at, where a wall goes on
uniform vec4 tint;
uniform float lit, smooth_;
out vec4 pixel;
void main() {
  if (lit < 0.5) {
    pixel = vec4(tint.rgb, tint.a * (1.0 - smoothstep(0.0, 0.12, faded)));
    return;
  }
  if (beyond > 0.0) discard;
  vec3 normal = smooth_ > 0.5 ? normalize(turned) : normalize(cross(dFdx(seen), dFdy(seen)));
  float facing = abs(dot(normal, normalize(seen)));
  float side = abs(dot(normal, normalize(vec3(-0.45, 0.7, 0.75))));
  pixel = vec4(tint.rgb * (0.55 + 0.45 * side), mix(min(1.0, tint.a * 1.9), tint.a, facing));
  pixel.a *= 1.0 - smoothstep(0.0, 0.12, faded);
}`;

const sliceVertex = `#version 300 es
precision highp float;
in vec3 corner;
in vec2 cell;
uniform mat4 view, projection;
out vec2 at;
void main() {
  at = cell;
  gl_Position = projection * view * vec4(corner, 1.0);
}`;

const sliceFragment = `#version 300 es
precision highp float;
in vec2 at;
uniform sampler2D now, after, palette;
uniform float between, opacity;
out vec4 pixel;
void main() {
  float level = 255.0 * mix(texture(now, at).r, texture(after, at).r, between);
  if (level < 0.5) discard;
  pixel = vec4(texture(palette, vec2((level - 1.0) / 254.0 * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb, opacity);
}`;

// A line between two places is a strip towards the eye, as wide as its force.
const forceVertex = `#version 300 es
precision highp float;
in vec2 corner;   // along from 0 to 1, across from -1 to 1
in vec3 from, to;
in float width, attracts;
uniform mat4 view, projection;
uniform vec4 cut;
out float across, sign_;
void main() {
  across = corner.y;
  sign_ = attracts;
  if (dot(cut.xyz, from) > cut.w || dot(cut.xyz, to) > cut.w) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  vec3 a = (view * vec4(from, 1.0)).xyz, b = (view * vec4(to, 1.0)).xyz;
  vec3 side = cross(b - a, a);
  float length_ = length(side);
  vec3 place = mix(a, b, corner.x) + (length_ > 0.0 ? width * corner.y / length_ : 0.0) * side;
  gl_Position = projection * vec4(place, 1.0);
}`;

const forceFragment = `#version 300 es
precision highp float;
in float across, sign_;
out vec4 pixel;
void main() {
  float round_ = sqrt(max(0.0, 1.0 - across * across));
  vec3 colour = sign_ > 0.5 ? vec3(0.1, 0.45, 0.85) : vec3(0.84, 0.37, 0.0);
  pixel = vec4(colour * (0.55 + 0.45 * round_), 1.0);
}`;

function compiled(gl, kind, text) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
    throw new Error("WebGL does not compile a shader: " + gl.getShaderInfoLog(shader));
  return shader;
}

// {program, in: attribute locations, at: uniform locations}
function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  gl.attachShader(made, compiled(gl, gl.VERTEX_SHADER, vertex));
  gl.attachShader(made, compiled(gl, gl.FRAGMENT_SHADER, fragment));
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost())
    throw new Error("WebGL does not compile a shader: " + gl.getProgramInfoLog(made));
  const inputs = {}, uniforms = {};
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_ATTRIBUTES); ++i) {
    const { name } = gl.getActiveAttrib(made, i);
    inputs[name] = gl.getAttribLocation(made, name);
  }
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); ++i) {
    const { name } = gl.getActiveUniform(made, i);
    uniforms[name] = gl.getUniformLocation(made, name);
  }
  return { program: made, in: inputs, at: uniforms };
}

const programs = (gl) => ({
  spheres: program(gl, sphereVertex, sphereFragment),
  walls: program(gl, wallVertex, wallFragment),
  slices: program(gl, sliceVertex, sliceFragment),
  forces: program(gl, forceVertex, forceFragment),
});
