// SPDX-License-Identifier: Apache-2.0
import { Scene } from 'three';
document.title = `ok ${new Scene().type}`;
