import { counted, h, shown } from '../shared/dom.js';

/** Of a share that may come out below 0 by chance; to a hundredth of a percent. */
const percent = (share, digits = 3) => {
  if (share > 0 && share < 5e-5) return '< 0.01 %';
  return `${shown(Math.round(1e4 * Math.max(share, 0)) / 1e2, digits)} %`;
};

/** With what it may be off by. */
const doubted = ({ share, doubt }) => `${percent(share)}${doubt ? ` ± ${percent(doubt, 2)}` : ''}`;

const missing = {
  too_few: (runs) => `Too few to tell: it was measured in ${counted(runs)} runs. 64 draws at least are needed, and several hundred are better (--runs).`,
  partly_run: () => 'Not told yet: of a grid only a corner was run, in which entries don’t vary freely of one another. All runs tell.',
};

/** One sentence on a metric: what moves it most, and how sure that is. */
function verdict(metric, rows, variables) {
  const [first, second] = rows;
  if (!first) return `What ${metric} depends on isn’t told: it was measured where nothing varies.`;
  const name = variables[first.entry].name;
  if (first.share <= first.doubt) return `No entry moves ${metric} by itself more than its doubt.`;
  if (second && first.share - second.share < Math.hypot(first.doubt, second.doubt))
    return `${name} and ${variables[second.entry].name} move ${metric} most; which of them more is within the doubt.`;
  return `${name} moves ${metric} most: ${doubted(first)} of its variance.`;
}

/** Where a few runs far out make the variance, the ranks tell of all the others. */
function amongRanks(rows, variables) {
  const byRanks = rows.map((row) => ({ ...row, share: row.share_of_ranks ?? 0, doubt: row.doubt_of_ranks ?? 0 })).sort((a, b) => b.share - a.share);
  const [first, second] = byRanks;
  if (!first || first.entry === rows[0].entry || first.share - (second?.share ?? 0) < first.doubt) return null;
  return `Among the ranks, where a few runs far out count no more than the others, it is ${variables[first.entry].name}: ${doubted(first)}.`;
}

/** What of the variance no entry has by itself. */
function rest(rows) {
  const sum = rows.reduce((all, { share }) => all + share, 0);
  const doubt = Math.hypot(...rows.map((row) => row.doubt));
  const left = Math.max(1 - sum, 0);
  return `All of them by themselves: ${doubted({ share: sum, doubt })}. ${
    left > Math.max(doubt, 0.02) ? `The other ${percent(left)} is what entries do together (interaction), which a map shows.` : 'What entries do together adds next to nothing.'
  }`;
}

function direction({ rank_correlation: rank }, runs, variable, drawn) {
  if (variable.kind === 'words') return 'no order';
  if (rank === null) return '–';
  if (drawn && Math.abs(rank) < 2 / Math.sqrt(Math.max(runs - 1, 1))) return `${shown(rank, 2)} (no more than chance)`;
  return `${shown(rank, 3)} ${rank > 0 ? '↗ rises with it' : '↘ falls with it'}`;
}

/** Which entry moves a metric that is chosen: a bar an entry, the longest first. */
export function influence(data) {
  const { influences, variables, done } = data;
  if (influences.length === 0) return h('p', {}, 'Nothing that was measured differs between the runs.');
  const select = h('select', { id: 'influence-metric' }, influences.map(({ metric }) => h('option', { value: metric }, variables[metric].name)));
  const body = h('div', { id: 'influence-shown' });
  const show = () => {
    const one = influences.find(({ metric }) => metric === Number(select.value));
    const metric = variables[one.metric];
    const rows = one.entries.filter(({ share }) => share !== null).sort((a, b) => b.share - a.share);
    if (one.missing) return body.replaceChildren(h('p', { class: 'notes' }, missing[one.missing](one.runs)));
    const partly = one.runs < 0.99 * done ? h('p', { class: 'notes' }, `It was measured in ${percent(one.runs / done)} of the runs. Those in which it wasn’t are not chosen by chance, so that shares may be off by more than their doubt.`) : null;
    return body.replaceChildren(
      h('p', {}, h('strong', {}, verdict(metric.name, rows, variables)), ' ', amongRanks(rows, variables) ?? ''),
      ...[partly].filter(Boolean),
      h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `What moves ${metric.name}` },
        h('table', { class: 'influence' },
          h('thead', {}, h('tr', {}, ['Entry', 'Share of the variance', '', 'Of the ranks’', 'Rank correlation'].map((text) => h('th', { scope: 'col' }, text)))),
          h('tbody', {}, rows.map((row) => h('tr', {},
            h('th', { scope: 'row' }, variables[row.entry].name),
            h('td', { class: 'bar' }, bar(row)),
            h('td', { class: 'number' }, doubted(row)),
            h('td', { class: 'number' }, row.share_of_ranks === null ? '–' : doubted({ share: row.share_of_ranks, doubt: row.doubt_of_ranks })),
            h('td', {}, direction(row, one.runs, variables[row.entry], Boolean(data.spread)))))))),
      h('p', {}, rows.length ? rest(rows) : ''),
    );
  };
  select.addEventListener('change', show);
  select.value = data.strongest.metric;
  show();
  return h('div', {},
    h('div', { class: 'controls' }, h('label', { for: 'influence-metric' }, 'Of ', select)),
    body,
    h('details', {}, h('summary', {}, 'What the numbers mean'), meaning(data)));
}

function bar({ share, doubt }) {
  const at = (x) => `${100 * Math.min(Math.max(x, 0), 1)}%`;
  return h('div', { class: 'track', 'aria-hidden': 'true' },
    h('div', { class: 'fill', style: `width: ${at(share)}` }),
    doubt ? h('div', { class: 'whisker', style: `left: ${at(share - doubt)}; right: calc(100% - ${at(share + doubt)})` }) : null);
}

function meaning(data) {
  const classes = [...new Set(data.influences.flatMap(({ entries }) => entries.map((entry) => entry.classes)))].sort((a, b) => a - b);
  return h('div', { class: 'prose' },
    h('p', {}, 'The share is the first-order Sobol’ index: how much of the variance over these runs would go if the entry alone were known. It is estimated from the runs as they are, by the correlation ratio over classes of the entry’s values ' +
      `(Plischke, 2010; Plischke, Borgonovo & Smith, 2013), here ${classes.join(' and ')} of them. What the metric varies within a class is missed: of a straight line 1/M² of its share with M classes, of what swings to and fro within a class more.`),
    h('p', {}, data.spread
      ? '± is half of a 95 % interval, by leaving out one of 20 groups of draws after the other (the jackknife; Busing, Meijer & van der Leeden, 1999), which also takes off what few runs add.'
      : 'All combinations of a grid were run, so that the shares have no doubt of chance: they are of these values, each as likely as the others.'),
    h('p', {}, 'Of the ranks’ variance: the same where each run’s metric is replaced by its rank, so that a few runs far out count no more than the others. The rank correlation is Spearman’s, to a thousandth of the ranks: its sign says whether the metric rises or falls with the entry; near 0 with a large share it does both.'));
}
