import { shown } from '../shared/dom.js';

/** What a motor's curves may not pass: of which of a run's limits, and whether they hold both ways. */
const kOfMotors = {
  tau: [['torque', 'the plant’s limit'], ['commanded_torque', 'the controller’s limit']],
  psid: [['velocity', 'the controller’s limit'], ['planned_velocity', 'the plan’s limit']],
};

/** The limits of the runs' motors in SI, [{ value, name, colour }]: of 'tau', 'psid' or 'psi'. */
export function motorLimits(runs, quantity, names) {
  const colour = (run, i) => (runs.length > 1 ? run.index : i);
  const all = runs.flatMap((run) => {
    const limits = run.inputs?.limits ?? {};
    return names.flatMap(({ name, i }) => {
      if (quantity === 'psi')
        return (limits.position?.[i] ?? []).map((value, end) => ({ value, name: `${name}, ${end ? 'most' : 'least'}`, colour: colour(run, i) }));
      return kOfMotors[quantity].flatMap(([key, whose]) =>
        limits[key]?.[i] === undefined ? [] : [1, -1].map((sign) => ({ value: sign * limits[key][i], name: `${name}, ${whose}`, colour: colour(run, i) })));
    });
  });
  return all.filter((limit, k) => all.findIndex((other) => other.value === limit.value && other.name === limit.name) === k);
}

/** How far off the path a run may be before it has diverged, in mm. */
export function errorLimits(runs) {
  const values = [...new Set(runs.map((run) => run.inputs?.limits?.position_error).filter((value) => value !== undefined))];
  return values.map((value) => ({ value: 1e3 * value, name: 'past it a run has diverged', colour: 1 }));
}

/** In words: those that hold both ways once. */
export function limitsNote(limits) {
  const both = (limit) => limits.some((other) => other.name === limit.name && other.value === -limit.value);
  const words = limits.filter((limit) => limit.value >= 0 || !both(limit)).map((limit) => `${limit.name}: ${both(limit) ? '±' : ''}${shown(limit.value)}`);
  return words.length ? `Limits (dashed, where they are near): ${words.join('; ')}.` : '';
}

/** A range of y that shows the limits which are near to the curves. */
export function withLimits([least, most], limits) {
  const reach = 2 * Math.max(Math.abs(least), Math.abs(most));
  const near = limits.map(({ value }) => value).filter((value) => Math.abs(value) <= reach);
  return [Math.min(least, ...near.map((value) => 1.05 * value)), Math.max(most, ...near.map((value) => 1.05 * value))];
}
