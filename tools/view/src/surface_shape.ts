// SPDX-License-Identifier: Apache-2.0
// A surface without a mesh (fdcg/surface.h) as triangles to draw: centred in its frame, its axis along z.
import { BoxGeometry, BufferGeometry, CapsuleGeometry, CylinderGeometry, PlaneGeometry, SphereGeometry, TorusGeometry } from 'three';
import type { SurfaceSizes } from './session_data';

const ROUND = 64; // sides of what is round

/** `reach`: how far a plane, which has no end, is drawn. */
export function surfaceShape(surface: SurfaceSizes, reach: number): BufferGeometry {
  const { radius, length, half } = surface;
  switch (surface.kind) {
    case 'plane':
      return new PlaneGeometry(2 * reach, 2 * reach);
    case 'sphere':
      return new SphereGeometry(radius, ROUND, ROUND / 2);
    case 'cylinder':
      return alongZ(new CylinderGeometry(radius, radius, length, ROUND));
    case 'capsule':
      return alongZ(new CapsuleGeometry(radius, length, ROUND / 4, ROUND));
    case 'cone':
      return alongZ(new CylinderGeometry(surface.top_radius, radius, length, ROUND));
    case 'box':
      return new BoxGeometry(2 * half[0], 2 * half[1], 2 * half[2]);
    case 'torus':
      return new TorusGeometry(radius, surface.tube_radius, ROUND / 2, ROUND);
    case 'ellipsoid':
      return new SphereGeometry(1, ROUND, ROUND / 2).scale(...half);
  }
}

function alongZ(geometry: BufferGeometry): BufferGeometry {
  return geometry.rotateX(Math.PI / 2);
}
