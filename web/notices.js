// The licences of the packages that went into a page, as a comment at its head.
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';

function licenceOf(folder) {
  const file = readdirSync(folder).find((name) => /^licen[cs]e/i.test(name));
  if (!file) throw new Error(`${folder} has no licence file; expected one, to go into the page`);
  const { name, version } = JSON.parse(readFileSync(path.join(folder, 'package.json'), 'utf8'));
  return `${name} ${version}\n\n${readFileSync(path.join(folder, file), 'utf8').trim()}\n`;
}

export function notices() {
  const folders = new Set();
  return {
    name: 'notices',
    buildEnd() {
      for (const id of this.getModuleIds()) {
        const inside = /^(\/.*\/node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(id);
        if (inside) folders.add(inside[1]);
      }
    },
    transformIndexHtml: {
      order: 'post',
      handler(html) {
        const texts = [...folders].sort().map(licenceOf).join('\n');
        return html.replace(/^<!doctype html>/i, (head) => `${head}\n<!-- This page contains:\n\n${texts}-->`);
      },
    },
  };
}
