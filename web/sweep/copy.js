import { h } from '../shared/dom.js';

async function copied(text) {
  if (navigator.clipboard)
    try {
      await navigator.clipboard.writeText(text);
      return true;
    } catch {
      // a page of a file may not everywhere
    }
  const area = h('textarea', { readonly: '', class: 'sr-only' }, text);
  document.body.append(area);
  area.select();
  const done = document.execCommand('copy');
  area.remove();
  return done;
}

/** A button that copies a text, and says so. */
export function copyButton(text, label) {
  const button = h('button', { type: 'button', class: 'copy', 'data-text': text, title: text }, label);
  button.addEventListener('click', async (event) => {
    event.stopPropagation();
    const done = await copied(text);
    button.focus();
    button.textContent = done ? 'Copied' : 'Not allowed here: select it';
    document.getElementById('said').textContent = button.textContent;
    setTimeout(() => (button.textContent = label), 1500);
  });
  return button;
}
