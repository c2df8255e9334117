import uPlot from 'uplot';
import { shown } from '../shared/dom.js';
import { paintLegend } from '../shared/legend.js';
import { cssColour, dashes, onThemeChange, palettes, theme } from '../shared/theme.js';

const kWindow = 10; // s of a live run that the plots show

/** The plots of error and torque: live the last seconds, of a log all of it with a mark where one is. */
export class LivePlots {
  constructor(errorBox, torqueBox, motors, isLog) {
    this.isLog = isLog;
    this.data = { t: [], error: [], tau: motors.map(() => []) };
    const plot = (box, label, names) => this.plot(box, label, names);
    const unit = motors.every((motor) => motor.linear) ? 'Force (N)' : motors.some((motor) => motor.linear) ? 'Torque (N m), force (N)' : 'Torque (N m)';
    this.errors = plot(errorBox, 'Error (mm)', ['error']);
    this.torques = plot(torqueBox, unit, motors.map((motor) => motor.name));
    this.paintLegends();
    onThemeChange(() => {
      this.paintLegends();
      for (const one of [this.errors, this.torques]) one.redraw(false);
    });
  }

  plot(box, label, names) {
    const axis = (text, size) => ({
      label: text,
      size,
      labelSize: 20,
      labelGap: 2,
      font: '12px system-ui, "DejaVu Sans", sans-serif',
      labelFont: '12px system-ui, "DejaVu Sans", sans-serif',
      stroke: () => cssColour('--quiet'),
      grid: { stroke: () => cssColour('--grid'), width: 1 },
      ticks: { stroke: () => cssColour('--line'), width: 1 },
      values: (_, splits) => splits.map((value) => shown(value, 4)),
    });
    const made = new uPlot(
      {
        width: box.clientWidth || 400,
        height: 180,
        scales: { x: { time: false } },
        axes: [axis('Time (s)', 30), axis(label, 64)],
        legend: { live: false },
        cursor: { sync: { key: 'view' }, drag: { x: false, y: false } },
        series: [
          { label: 'Time' },
          ...names.map((name, i) => ({
            label: name,
            stroke: () => palettes[theme()][i % 8],
            dash: dashes[i % 4],
            width: 1.5,
            pxAlign: 0,
            points: { show: false },
          })),
        ],
        hooks: { draw: [(u) => this.mark(u)] },
      },
      [[], ...names.map(() => [])],
      box,
    );
    new ResizeObserver(() => box.clientWidth && made.setSize({ width: box.clientWidth, height: 180 })).observe(box);
    return made;
  }

  paintLegends() {
    for (const one of [this.errors, this.torques])
      paintLegend(one, one.series.slice(1).map((_, i) => ({ colour: i, dash: i % 4 })));
  }

  /** Where the log's pose is. */
  mark(u) {
    if (!this.isLog || this.now === undefined) return;
    const x = u.valToPos(this.now, 'x', true);
    u.ctx.save();
    u.ctx.fillStyle = cssColour('--ink');
    u.ctx.fillRect(x - 1, u.bbox.top, 2, u.bbox.height);
    u.ctx.restore();
  }

  clear() {
    this.data = { t: [], error: [], tau: this.data.tau.map(() => []) };
  }

  /** Takes what a pose brought. */
  add(traces, t) {
    const { data } = this;
    data.t.push(...traces.t);
    data.error.push(...traces.error.map((e) => (e === null ? null : e * 1e3)));
    traces.tau.forEach((values, i) => data.tau[i].push(...values));
    if (this.isLog) return;
    const old = data.t.findIndex((x) => x > t - kWindow);
    if (old > 200) for (const list of [data.t, data.error, ...data.tau]) list.splice(0, old);
  }

  /** Shows what there is, about time t. */
  draw(t) {
    const { data } = this;
    const end = (this.now = t);
    const range = this.isLog ? null : { min: Math.max(0, end - kWindow), max: Math.max(kWindow / 10, end) };
    const show = (plot, lists) => {
      if (this.isLog && plot.data[0].length === data.t.length) return plot.redraw(false, false);
      plot.setData([data.t, ...lists].map((list) => list.slice()), this.isLog); // what it draws stays as it is while paused
      if (range) plot.batch(() => plot.setScale('x', range));
    };
    show(this.errors, [data.error]);
    show(this.torques, data.tau);
  }
}
