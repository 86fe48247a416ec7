// SPDX-License-Identifier: Apache-2.0
// The picture of what stands still: while only marks move over it, it is copied and not drawn again.
import { Camera, FramebufferTexture, Mesh, PlaneGeometry, RGBFormat, ShaderMaterial, Vector2, type WebGLRenderer } from 'three';

const VERTEX = 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }';
const FRAGMENT = 'uniform sampler2D kept; void main() { gl_FragColor = texelFetch(kept, ivec2(gl_FragCoord.xy), 0); }';

export class Still {
  private texture: FramebufferTexture | undefined;
  private readonly material = new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, depthTest: false, depthWrite: false, uniforms: { kept: { value: null } } });
  private readonly quad = new Mesh(new PlaneGeometry(2, 2), this.material);
  private readonly camera = new Camera();

  constructor() {
    this.quad.frustumCulled = false;
  }

  get isKept(): boolean {
    return this.texture !== undefined;
  }
  /** Keeps what has just been drawn. */
  keep(renderer: WebGLRenderer): void {
    this.drop();
    const { x: width, y: height } = renderer.getDrawingBufferSize(new Vector2());
    this.texture = new FramebufferTexture(width, height);
    this.texture.format = RGBFormat; // the canvas has no alpha
    this.texture.internalFormat = 'RGB8';
    this.material.uniforms['kept']!.value = this.texture;
    renderer.copyFramebufferToTexture(this.texture);
  }
  draw(renderer: WebGLRenderer): void {
    renderer.render(this.quad, this.camera);
  }
  drop(): void {
    this.texture?.dispose();
    this.texture = undefined;
  }
}
