// SPDX-License-Identifier: Apache-2.0
// How faces are drawn: flat, lit from the eye and from above, front and back in two colours. Around a focus the surface becomes a
// screen of dots, so that what lies behind it is seen whatever the order of drawing.
import { Color, DoubleSide, ShaderMaterial, Vector3 } from 'three';
import { themeColor } from './theme';

const VERTEX = `
attribute vec3 faceColor;
varying vec3 vPosition;
varying vec3 vWorld;
varying vec3 vColor;
void main() {
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  vPosition = eye.xyz;
  vWorld = (modelMatrix * vec4(position, 1.0)).xyz;
#ifdef COLOURED
  vColor = faceColor;
#else
  vColor = vec3(1.0);
#endif
  gl_Position = projectionMatrix * eye;
}`;

const FRAGMENT = `
uniform vec3 front;
uniform vec3 back;
uniform vec3 focus;
uniform float focusRadius;
uniform float ghost;
varying vec3 vPosition;
varying vec3 vWorld;
varying vec3 vColor;
void main() {
  float away = focusRadius > 0.0 ? distance(vWorld, focus) / focusRadius : 9.0;
  float kept = max(1.0 - ghost, smoothstep(0.8, 1.0, away));
  vec2 cell = mod(floor(gl_FragCoord.xy), 4.0);
  float threshold = mod(cell.x * 5.0 + cell.y * 7.0 + mod(cell.x * cell.y, 2.0) * 3.0, 16.0) / 16.0;
  if (kept < 0.999 && threshold >= kept) discard;
  vec3 normal = normalize(cross(dFdx(vPosition), dFdy(vPosition)));
  vec3 toEye = normalize(-vPosition);
  float facing = abs(dot(normal, toEye));
  float above = 0.5 + 0.5 * normal.y;
  float light = 0.2 + 0.58 * facing + 0.26 * above;
#ifdef COLOURED
  vec3 base = gl_FrontFacing ? vColor : mix(vColor, back, 0.7);
#else
  vec3 base = gl_FrontFacing ? front : back;
#endif
  gl_FragColor = vec4(base * light, 1.0);
  #include <colorspace_fragment>
}`;

export class SurfaceMaterial extends ShaderMaterial {
  constructor(coloured = false) {
    super({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: DoubleSide,
      defines: coloured ? { COLOURED: '' } : {},
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
    this.uniforms['front']!.value = themeColor('face-front');
    this.uniforms['back']!.value = themeColor(showsWinding ? 'face-back' : 'face-front');
  }
  /** Both sides in a colour that the theme's own is mixed with. */
  tint(color: Color): void {
    const mixed = themeColor('face-front').lerp(color, 0.7);
    this.uniforms['front']!.value = mixed;
    this.uniforms['back']!.value = mixed;
  }
  get isGhost(): boolean {
    return (this.uniforms['ghost']!.value as number) > 0;
  }
  /** The surface within the radius of the point is drawn by this share less. 0: whole. */
  setFocus(point: Vector3 | undefined, radius = 0, ghost = 0.75): void {
    if (point !== undefined) (this.uniforms['focus']!.value as Vector3).copy(point);
    this.uniforms['focusRadius']!.value = point === undefined ? 0 : radius;
    this.uniforms['ghost']!.value = point === undefined ? 0 : ghost;
  }
}
