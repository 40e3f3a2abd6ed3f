// Shaders of the robot view. Light comes from above, behind and left; shadows on floor and wall are the capsules'
// closest approach to the ray of light, softened with distance.

const LIGHT = 'const vec3 LIGHT = normalize(vec3(-.55, .42, 1.));';

export const TUBE_VERTEX = `#version 300 es
in vec3 normal; in float end;
in vec3 a; in vec3 b; in vec2 radius; in vec3 colour;
uniform mat4 view;
out vec3 vPoint; out vec3 vNormal; out vec3 vColour; out float vEnd;
void main() {
  vec3 z = normalize(b - a);
  vec3 x = normalize(cross(abs(z.z) < .9 ? vec3(0, 0, 1) : vec3(1, 0, 0), z));
  vec3 n = mat3(x, cross(z, x), z) * normal;
  vPoint = mix(a, b, end) + mix(radius.x, radius.y, end) * n;
  vNormal = n; vColour = colour; vEnd = end;
  gl_Position = view * vec4(vPoint, 1);
}`;

export const TUBE_FRAGMENT = `#version 300 es
precision highp float;
${LIGHT}
uniform vec3 eye; uniform float dim; uniform float spray;
in vec3 vPoint; in vec3 vNormal; in vec3 vColour; in float vEnd;
out vec4 shade;
void main() {
  if (spray > 0.) { shade = vec4(vColour, mix(.95, .35, vEnd)); return; }
  vec3 n = normalize(vNormal), toEye = normalize(eye - vPoint);
  float diffuse = max(0., dot(n, LIGHT));
  float sky = mix(.34, .62, .5 + .5 * n.z);
  float rim = pow(1. - max(0., dot(n, toEye)), 4.) * .16;
  float gloss = pow(max(0., dot(n, normalize(LIGHT + toEye))), 48.) * .35;
  shade = vec4((vColour * (sky + .58 * diffuse) + rim + gloss) * dim, 1);
}`;

export const PLANE_VERTEX = `#version 300 es
in vec3 point; in vec2 uv;
uniform mat4 view;
out vec3 vPoint; out vec2 vUv;
void main() { vPoint = point; vUv = uv; gl_Position = view * vec4(point, 1); }`;

// surface: 0 the floor, 1 the room behind, 2 the wall with its picture.
export const planeFragment = (count) => `#version 300 es
precision highp float;
${LIGHT}
uniform int surface; uniform sampler2D picture;
uniform vec3 floorColour, nearRoom, farRoom;
uniform vec4 tubeA[${count}]; uniform vec4 tubeB[${count}];
in vec3 vPoint; in vec2 vUv;
out vec4 shade;
float lit(vec3 p) {
  float light = 1.;
  for (int i = 0; i < ${count}; i++) {
    vec3 ba = tubeB[i].xyz - tubeA[i].xyz, oa = p - tubeA[i].xyz;
    vec3 v = ba - LIGHT * dot(ba, LIGHT), w = oa - LIGHT * dot(oa, LIGHT);
    float s = clamp(dot(w, v) / max(dot(v, v), 1e-6), 0., 1.);
    float t = s * dot(ba, LIGHT) - dot(oa, LIGHT);
    float gap = length(w - s * v) - mix(tubeA[i].w, tubeB[i].w, s);
    float soft = .012 + .16 * max(t, 0.);
    if (t > 0.) light = min(light, smoothstep(-soft, soft, gap));
  }
  return light;
}
float nearby(vec3 p) {
  float open = 1.;
  for (int i = 0; i < ${count}; i++) {
    vec3 ba = tubeB[i].xyz - tubeA[i].xyz, oa = p - tubeA[i].xyz;
    float s = clamp(dot(oa, ba) / max(dot(ba, ba), 1e-6), 0., 1.);
    float gap = length(oa - s * ba) - mix(tubeA[i].w, tubeB[i].w, s);
    open *= 1. - .30 * exp(-max(0., gap) * 11.);
  }
  return open;
}
void main() {
  if (surface == 1) {
    shade = vec4(mix(nearRoom, farRoom, clamp((vPoint.z + .46) / 1.6, 0., 1.)), 1);
  } else if (surface == 2) {
    shade = vec4(texture(picture, vUv).rgb * (.80 + .20 * lit(vPoint)), 1);
  } else {
    float away = length(vPoint.xy - vec2(.3, 0)), far = clamp(away / 3.4, 0., 1.);
    float light = away < 1.9 ? nearby(vPoint) * (.80 + .20 * lit(vPoint)) : 1.;
    shade = vec4(mix(floorColour * light, nearRoom, far * far), 1);
  }
}`;
