// SPDX-License-Identifier: MIT OR Apache-2.0
// Controls: options, knobs, and how the page's state becomes a link.

import { fixed } from './draw.mjs';
import { element, write } from './panels.mjs';

export const SPEEDS = [[0.01, '1/100'], [0.1, '1/10'], [0.25, '1/4'], [1, '1'], [2, '2'], [4, '4']];
export const SPANS = [[10, '10 s'], [3, '3 s'], [1, '1 s'], [0.3, '0.3 s'], [0.1, '0.1 s']];
/** Range of a wall's knob about the place where the scene has it, mm. */
const WALL_MM = 30;

/** Fills a `select` with pairs `[value, text]`. */
export function fill(select, pairs, value) {
  select.replaceChildren(...pairs.map(([of, text]) => new Option(text, of)));
  select.value = String(value);
}

const NAMES = ['preset', 'scene', 'case'];

/** What a link opens: a preset or a scene, its case, and settings `set=key=value`. */
export function readLink(search) {
  const parameters = new URLSearchParams(search);
  const pairs = parameters.getAll('set').map((pair) => pair.split(/=(.*)/s)).filter((pair) => pair.length > 1);
  const named = Object.fromEntries(NAMES.map((name) => [name, parameters.get(name)]));
  return { ...named, set: Object.fromEntries(pairs) };
}

/** The inverse of {@link readLink}. Other parameters, such as a token, stay. */
export function writeLink(search, wanted) {
  const parameters = new URLSearchParams(search);
  for (const name of [...NAMES, 'set']) parameters.delete(name);
  const named = { ...wanted, scene: wanted.preset ? null : wanted.scene };
  for (const name of NAMES) if (named[name] != null) parameters.set(name, named[name]);
  for (const [key, value] of Object.entries(wanted.set)) parameters.append('set', `${key}=${value}`);
  return `?${parameters}`.replaceAll('%3D', '=');
}

/** Sliders of a source's inputs. One of a pad or a wall acts at once; a setting of the scene sets the scene up again. */
export class Knobs {
  constructor(box, model, send, open) {
    Object.assign(this, { box, model, send, open, values: new Map(), pending: new Map() });
  }

  build() {
    const { inputs, settings, walls } = this.model.hello;
    this.values.clear();
    const ofPad = inputs.map((input) => {
      const key = input.name.replace('pad.', '');
      return this.knob({ ...input, key, ofPad: true, message: (value, pad) => ({ type: 'set', pad, [key]: value }) });
    });
    const ofWalls = walls.map(({ axis, mm }, wall) => this.knob({
      wall,
      key: `${axis}_mm`, label: `Wall at ${axis}`, unit: 'mm', value: mm,
      least: Math.round(mm) - WALL_MM, most: Math.round(mm) + WALL_MM,
      message: (value) => ({ type: 'wall', [`${axis}_mm`]: value }) }));
    const ofScene = settings.map((setting) => this.knob({ ...setting, again: true }));
    this.knobs = [...ofPad, ...ofWalls];
    const details = element('details');
    details.open = this.box.querySelector('details')?.open ?? false;
    details.hidden = !ofScene.length;
    const summary = element('summary', '', `${ofScene.length} settings of the scene; a change starts it again`);
    details.append(summary, ...ofScene.map(({ row }) => row));
    this.box.replaceChildren(...this.knobs.map(({ row }) => row), this.buttons(), details);
  }

  knob(input) {
    const [row, slider, value] = [element('label', 'knob'), element('input'), element('output')];
    const decimals = input.unit === 'bits' ? 0 : Math.max(0, Math.ceil(-Math.log10((input.most - input.least) / 100)));
    Object.assign(slider, { type: 'range', min: input.least, max: input.most, step: 10 ** -decimals });
    if (input.says) row.title = input.says;
    row.append(element('span', '', input.label), slider, value);
    const show = () => write(value, `${fixed(Number(slider.value), decimals)} ${input.unit}`);
    const set = (number) => {
      slider.value = number ?? input.least;
      if (number == null) write(value, 'default');
      else show();
    };
    slider.oninput = () => {
      show();
      if (!input.again) this.change(input, Number(slider.value));
    };
    if (input.again) slider.onchange = () => this.open({ [input.key]: Number(slider.value) });
    set(input.value);
    return { row, input, set };
  }

  buttons() {
    const row = element('p', 'buttons');
    const back = element('button', '', 'Let go');
    back.title = 'The scene’s script leads this pad again';
    back.onclick = () => {
      for (const { input } of this.knobs) if (input.ofPad) this.values.delete(this.name(input));
      this.send({ type: 'release', pad: this.model.pad }).then(() => this.choose());
    };
    this.off = element('button', '', 'Walls off');
    this.off.onclick = () => this.send({ type: 'wall', ...(this.wallsOff ? this.surfaces() : { off: true }) });
    row.append(...(this.model.hello.walls.length ? [this.off] : []), back);
    return row;
  }

  get wallsOff() {
    return this.model.latest?.walls.every((mm) => mm == null) ?? false;
  }

  surfaces() {
    return Object.fromEntries(this.model.hello.walls.map(({ axis, mm }) => [`${axis}_mm`, this.values.get(`${axis}_mm`) ?? mm]));
  }

  name(input) {
    return input.ofPad ? `${this.model.pad} ${input.key}` : input.key;
  }

  /** Sends the newest value of a knob, once per picture at most. */
  change(input, value) {
    this.values.set(this.name(input), value);
    if (!this.pending.size) requestAnimationFrame(() => this.flush());
    this.pending.set(this.name(input), input.message(value, this.model.pad));
  }

  flush() {
    for (const message of this.pending.values()) this.send(message);
    this.pending.clear();
  }

  /** Shows the values of the chosen pad: those set here, else the load that its last frame had. */
  choose() {
    const load = this.model.latest?.pads[this.model.pad]?.load_g;
    for (const { input, set } of this.knobs) {
      set(this.values.get(this.name(input)) ?? (input.key === 'load_g' ? load : null) ?? input.value);
    }
  }

  /** A wall that nobody has moved here goes where the scene says. */
  draw() {
    for (const { input, set } of this.knobs) {
      if (input.wall !== undefined && !this.values.has(input.key)) set(this.model.latest?.walls[input.wall] ?? input.value);
    }
    write(this.off, this.wallsOff ? 'Walls on' : 'Walls off');
  }
}
