// SPDX-License-Identifier: Apache-2.0
import { start } from './app';

start().catch((error: unknown) => {
  const place = document.getElementById('app')!;
  const text = document.createElement('p');
  text.className = 'failure';
  text.setAttribute('role', 'alert');
  text.textContent = `The page cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
  place.replaceChildren(text);
  place.removeAttribute('aria-busy');
});
