// Bundles each page into one file: node build.js [OUTPUT_FOLDER]. Run where node_modules is.
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { build } from 'vite';
import { viteSingleFile } from 'vite-plugin-singlefile';
import { notices } from './notices.js';

const here = path.dirname(fileURLToPath(import.meta.url));
const out = path.resolve(process.argv[2] ?? path.join(here, 'dist'));

for (const page of ['report', 'sweep', 'view']) {
  await build({
    configFile: false,
    root: path.join(here, page),
    logLevel: 'warn',
    plugins: [notices(), viteSingleFile({ removeViteModuleLoader: true })],
    build: {
      outDir: path.join(out, page),
      emptyOutDir: true,
      target: 'es2022',
      modulePreload: false,
    },
  });
}
