import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { chromium } from 'playwright-core';

const flags = [
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
/** WebGL without a graphics card. */
export const webgl = ['--disable-gpu', '--enable-unsafe-swiftshader'];

/** That such a WebGL is slow, says Chromium. */
const isOfTheDriver = (text) => text.includes('GL Driver Message (OpenGL, Performance');

/** Opens a tab of a browser of its own, calls `look(browser, tab)`, and holds that no script failed or complained. */
export async function opened(executablePath, look, more = ['--disable-gpu']) {
  const profile = mkdtempSync(path.join(tmpdir(), 'mixloop-browser-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath,
    args: [...flags, ...more],
    viewport: { width: 1280, height: 900 },
    timeout: 120_000,
  });
  try {
    const tab = context.pages()[0] ?? (await context.newPage());
    tab.setDefaultTimeout(120_000); // a busy machine without a graphics card draws slowly
    const complaints = [];
    tab.on('console', (message) => {
      if (['error', 'warning'].includes(message.type()) && !isOfTheDriver(message.text())) complaints.push(message.text());
    });
    tab.on('pageerror', (error) => complaints.push(String(error.stack)));
    await look(context, tab, complaints);
    assert.deepEqual(complaints, [], 'the console is silent');
  } finally {
    await context.close();
    rmSync(profile, { recursive: true, force: true });
  }
}
