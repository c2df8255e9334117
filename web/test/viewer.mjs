import { spawn } from 'node:child_process';

const children = [];

/** A command of ours that runs; `over` is its exit status (or signal), `text` what it has printed. */
export function started(...words) {
  const child = spawn(words[0], words.slice(1), { stdio: ['ignore', 'pipe', 'inherit'] });
  children.push(child);
  child.text = '';
  child.stdout.on('data', (part) => (child.text += part));
  child.over = new Promise((resolve) => child.on('close', (code, signal) => resolve(code ?? signal)));
  return child;
}

/** `mixloop view` with these words: { child, url, mode } once it listens. */
export async function viewing(mixloop, ...words) {
  const child = started(mixloop, 'view', ...words, '--json');
  while (!child.text.includes('}')) {
    if (child.exitCode !== null) throw new Error(`mixloop view ended: ${child.text}`);
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
  return { child, ...JSON.parse(child.text) };
}

/** As Ctrl-C does; its exit status. */
export function ended(view) {
  view.child.kill('SIGINT');
  return view.child.over;
}

/** Ends what is still running. */
export function endAll() {
  for (const child of children) if (child.exitCode === null && child.signalCode === null) child.kill('SIGTERM');
}
