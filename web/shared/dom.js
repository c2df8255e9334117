/**
 * An element: h('p', { class: 'x' }, 'text', child, ...). Text is never read as HTML.
 * @returns {HTMLElement}
 */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes))
    if (value !== undefined && value !== null && value !== false) element.setAttribute(name, value);
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return element;
}

/** A number for people: six digits that count, no more. */
export function shown(value, digits = 6) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return String(value);
  return String(Number(value.toPrecision(digits)));
}

/** How many: with a comma at the thousands. */
export function counted(number) {
  return number.toLocaleString('en');
}
