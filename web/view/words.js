import { h, shown } from '../shared/dom.js';

/** state_t's flags. */
const kRealTime = 1;
const kSafeState = 2;
const kHold = 4;
const kStale = 8;

/** What a live pose says of the plant: [state, words]. */
export function condition({ flags }) {
  if (flags & kSafeState) return ['warned', 'safe state: the plant ignores commands until a reset'];
  const words = ['live', flags & kRealTime ? 'in real time' : 'in lockstep'];
  if (flags & kHold) words.push('holding the end of the path');
  if (flags & kStale) words.push('a sensor did not deliver');
  return [flags & kStale ? 'warned' : 'live', words.join(', ')];
}

const place = (xyz) => (xyz[0] === null ? '–' : `${xyz.map((x) => x.toFixed(4)).join(', ')} m`);

/** The table's rows for a pose. */
export function numbers(pose, { mechanism, torque_limit: limits = [] }) {
  const torque = (value, { linear }, limit) => {
    if (value === null) return '–';
    const unit = linear ? 'N' : 'N m';
    return `${value.toFixed(4)} ${unit}${limit === undefined ? '' : ` of ± ${limit}`}`;
  };
  const rows = [
    ['Time', `${pose.t.toFixed(3)} s`],
    ['Tick', String(pose.k)],
    ['Position error', pose.error[0] === null ? '–' : `${shown(pose.error[0] * 1e3, 5)} mm`],
    ['E actual', place(pose.E)],
    ['E desired', place(pose.desired)],
    ...mechanism.motors.map((motor, i) => [`τ of ${motor.name}`, torque(pose.tau[i], motor, limits[i])]),
  ];
  return rows.map(([name, value]) => h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, value)));
}
