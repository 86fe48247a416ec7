// SPDX-License-Identifier: Apache-2.0
// How faces are drawn: flat, lit from the eye and from above, front and back in two colours. Around a focus the surface becomes a
// screen of dots, so that what lies behind it is seen whatever the order of drawing.
import { Color, DoubleSide, ShaderMaterial, Vector3 } from 'three';
import { themeColor } from './theme';

const VERTEX = `
varying vec3 vPosition;
#ifdef FOCUSED
varying vec3 vWorld;
#endif
#ifdef COLOURED
attribute vec3 faceColor;
varying vec3 vColor;
#endif
#ifdef SMOOTH
varying vec3 vNormal;
#endif
void main() {
#ifdef SMOOTH
  vNormal = normalMatrix * normal;
#endif
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  vPosition = eye.xyz;
#ifdef FOCUSED
  vWorld = (modelMatrix * vec4(position, 1.0)).xyz;
#endif
#ifdef COLOURED
  vColor = 1.055 * pow(faceColor, vec3(1.0 / 2.4)) - 0.055;
#endif
  gl_Position = projectionMatrix * eye;
}`;

const FRAGMENT = `
uniform vec3 front;
uniform vec3 back;
varying vec3 vPosition;
#ifdef FOCUSED
uniform vec3 focus;
uniform float focusRadius;
uniform float ghost;
varying vec3 vWorld;
#endif
#ifdef COLOURED
varying vec3 vColor;
#endif
#ifdef SMOOTH
varying vec3 vNormal;
#endif
void main() {
#ifdef FOCUSED
  float kept = max(1.0 - ghost, smoothstep(0.8, 1.0, distance(vWorld, focus) / focusRadius));
  vec2 cell = mod(floor(gl_FragCoord.xy), 4.0);
  float threshold = mod(cell.x * 5.0 + cell.y * 7.0 + mod(cell.x * cell.y, 2.0) * 3.0, 16.0) / 16.0;
  if (kept < 0.999 && threshold >= kept) discard;
#endif
#ifdef SMOOTH
  vec3 normal = vNormal;
#else
  vec3 normal = cross(dFdx(vPosition), dFdy(vPosition));
#endif
  float perLength = inversesqrt(dot(normal, normal));
  float facing = abs(dot(normal, vPosition)) * perLength * inversesqrt(dot(vPosition, vPosition));
  float light = 0.33 + 0.58 * facing + 0.13 * normal.y * perLength;
#ifdef COLOURED
  vec3 base = gl_FrontFacing ? vColor : mix(vColor, back, 0.7);
#else
  vec3 base = gl_FrontFacing ? front : back;
#endif
  float curve = 0.0724 - 0.101 * light + 1.0283 * sqrt(light);
  gl_FragColor = vec4((base + 0.055) * curve - 0.055, 1.0);
}`;

export class SurfaceMaterial extends ShaderMaterial {
  /** `smooth`: by the geometry's normals, in place of the faces'. */
  constructor(coloured = false, smooth = false) {
    super({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      defines: { ...(coloured ? { COLOURED: '' } : {}), ...(smooth ? { SMOOTH: '' } : {}) },
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      uniforms: {
        front: { value: new Color() },
        back: { value: new Color() },
        focus: { value: new Vector3() },
        focusRadius: { value: 0 },
        ghost: { value: 0 },
      },
    });
    this.applyTheme(true);
  }
  /** Without winding both sides look alike. */
  applyTheme(showsWinding: boolean): void {
    this.setSides(themeColor('face-front'), themeColor(showsWinding ? 'face-back' : 'face-front'));
  }
  /** Both sides in a colour that the theme's own is mixed with. */
  tint(color: Color): void {
    const mixed = themeColor('face-front').lerp(color, 0.7);
    this.setSides(mixed, mixed);
  }
  private setSides(front: Color, back: Color): void {
    this.uniforms['front']!.value = front.clone().convertLinearToSRGB();
    this.uniforms['back']!.value = back.clone().convertLinearToSRGB();
  }
  get isGhost(): boolean {
    return 'FOCUSED' in this.defines!;
  }
  /** The surface within the radius of the point is drawn by this share less. */
  setFocus(point: Vector3 | undefined, radius = 0, ghost = 0.75): void {
    const isFocused = point !== undefined && radius > 0;
    if (isFocused) {
      (this.uniforms['focus']!.value as Vector3).copy(point);
      this.uniforms['focusRadius']!.value = radius;
      this.uniforms['ghost']!.value = ghost;
    }
    if (isFocused === this.isGhost) return;
    if (isFocused) this.defines!['FOCUSED'] = '';
    else delete this.defines!['FOCUSED'];
    this.needsUpdate = true; // a shader that discards nothing is much cheaper: hidden faces are left out before it
  }
}
