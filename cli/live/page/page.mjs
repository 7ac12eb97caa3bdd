// SPDX-License-Identifier: MIT OR Apache-2.0
// The page: connects the source to the model, the model to what is drawn, and controls to commands.

import { Board } from './board.mjs';
import { fill, Knobs, readLink, SPANS, SPEEDS, writeLink } from './controls.mjs';
import { fixed, readColours } from './draw.mjs';
import { Loupe } from './loupe.mjs';
import { Model } from './model.mjs';
import { Bars, drawEvents, element, PadTable, Speech, write } from './panels.mjs';
import { Leader, leadByPointer, listenToKeys } from './pointer.mjs';
import { Link, PROTOCOL, STATES } from './protocol.mjs';
import { Sheet } from './sheet.mjs';
import { SlotPlot } from './slot.mjs';
import { Strips } from './strips.mjs';

const $ = (id) => document.getElementById(id);
/** Numbers change at most this often, so that they can be read; strips so often, since they cost most. */
const [TEXT_MS, STRIPS_MS] = [100, 30];
const NOTICE_MS = 6000;
/** Without frames for this long, the values shown are called old. */
const STALE_MS = 1500;

readColours();
const model = new Model();
const sheet = new Sheet($('sheet'), model);
const loupe = new Loupe($('loupe'), model);
const strips = new Strips($('strips'), model, draw);
const slotPlot = new SlotPlot($('slot'), $('slot-channels'), $('slot-facts'), model);
const bars = new Bars($('bars'), model);
const table = new PadTable($('pads'), model, choose);
const knobs = new Knobs($('knobs'), model, send, (set) => open({ ...opened, set: { ...opened.set, ...set } }));
const leader = new Leader(model, send);
const board = new Board({ group: $('board'), arm: $('arm'), disable: $('disable'), line: $('line-now') }, model, send);
let speech = new Speech($('speech'), model);
/** What is open, and what the page's address asks for, as links say it. */
let [opened, asked] = [{ set: {} }, readLink(location.search)];
let [paused, recording, drawing] = [false, false, false];
let [text_ms, strips_ms, frames_ms, textTimer, noticeTimer] = [0, 0, performance.now(), 0, 0];
const link = new Link(`${location.origin.replace('http', 'ws')}/ws${location.search}`, accept, connected);

/** Sends a command; a refusal is shown. */
function send(command) {
  return link.send(command).catch((error) => notice(error.message));
}

function notice(text = '') {
  write($('notice'), text);
  $('notice').hidden = !text;
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(notice, NOTICE_MS);
}

function connected(yes) {
  model.lost = !yes;
  showRecording(false);
  checkAge();
  draw();
}

const MESSAGES = {
  hello: acceptHello,
  frames(message) {
    model.acceptFrames(message);
    frames_ms = performance.now();
    if (model.stale) checkAge();
  },
  status(message) {
    model.status = message;
    paused = message.asked_speed === 0 || message.stepped;
    if (message.opening) notice(`Setting up ${message.opening} …`);
    checkAge();
  },
  event(message) {
    model.acceptEvent(message);
    drawEvents($('events'), model, pickEvent);
  },
  slot: (message) => slotPlot.show(message),
  recorded: download,
  note: (message) => notice(message.text),
  error: (message) => notice(message.message),
};

function accept(message) {
  MESSAGES[message.type]?.(message);
  draw();
}

function acceptHello(hello) {
  if (hello.protocol !== PROTOCOL) notice(`The source speaks protocol ${hello.protocol}, this page ${PROTOCOL}: load the page again`);
  model.acceptHello(hello);
  if (!isOwn(hello)) opened = { scene: hello.scene, case: hello.case_index || null, set: hello.set };
  else if (!opened.preset) opened.case = hello.case_index || null;
  $('game').hidden = !hello.arena;
  document.body.className = `${hello.truth ? '' : 'no-truth'} ${hello.hand ? '' : 'no-hand'} ${hello.source} ${hello.arena ? 'plays' : ''}`;
  document.title = `${hello.scene} – hapticore live`;
  const scenes = new Set([hello.scene, ...hello.scenes]);
  fill($('scene'), [...scenes].sort().map((name) => [name, name]), hello.scene);
  fill($('case'), hello.cases.map((name, index) => [index, name]), hello.case_index);
  $('case').parentElement.hidden = hello.cases.length < 2;
  const other = hello.speed && !SPEEDS.some(([speed]) => speed === hello.speed) ? [[hello.speed, fixed(hello.speed, 2)]] : [];
  fill($('speed'), [...SPEEDS, ...other], hello.speed || 1);
  write($('facts'), `${hello.fidelity} core · profile ${hello.profile} · slots of ${hello.slot_us} µs`);
  showTexts(hello);
  board.build();
  knobs.build();
  bars.build();
  table.build();
  strips.build();
  drawEvents($('events'), model, pickEvent);
  speech = new Speech($('speech'), model);
  choose(model.pad);
  checkAge();
  openAsked(hello);
}

/** Whether this page has opened what is open; else another client has, or the command line. */
function isOwn({ presets, scene, set }) {
  const preset = presets.find(({ name }) => name === opened.preset);
  const text = (of) => JSON.stringify(Object.entries(of).map(([key, value]) => [key, String(value)]).sort());
  return opened.scene === scene && text({ ...preset?.set, ...opened.set }) === text(set);
}

/** Presets, hint and warnings. */
function showTexts({ presets, title, summary, scene, walls, arena, warnings }) {
  if (board.is) return void write($('hint'), `${title}. Values are measured; nothing here knows the truth.`);
  const current = presets.find(({ name }) => name === opened.preset);
  const what = arena ? 'into the puck: its impact and the walls of the arena brake the pad'
    : walls.length ? 'into the hatched wall: the deeper it goes, the harder the sheet brakes it' : 'and see what the core measures';
  $('hint').title = summary;
  write($('hint'), current?.hint ?? `${title || scene}. Drag a pad ${what}.`);
  $('presets').replaceChildren(...presets.map((preset) => {
    const button = element('button', '', preset.label);
    button.ariaPressed = preset === current;
    button.onclick = () => open({ preset: preset.name, set: {} });
    return button;
  }));
  $('warnings').hidden = !warnings.length;
  write($('warnings').firstElementChild, `Before you use these results (${warnings.length})`);
  $('warnings').lastElementChild.replaceChildren(...warnings.map((text) => element('li', '', text)));
}

/** Opens what the page's address asks for, once. */
function openAsked({ presets, scene }) {
  const wanted = { ...asked, scene: asked.scene ?? scene };
  asked = { set: {} };
  const names = presets.map(({ name }) => name);
  if (wanted.preset && !names.includes(wanted.preset)) notice(`preset: expected one of ${names.join(', ')}; got ${wanted.preset}`);
  else if (wanted.preset || wanted.case || wanted.scene !== scene || Object.keys(wanted.set).length) open(wanted);
}

/** Opens a scene, or a preset of one; `set` holds what is set besides. */
async function open(wanted) {
  const [before, preset] = [opened, model.hello.presets.find(({ name }) => name === wanted.preset)];
  const scene = preset?.scene ?? wanted.scene;
  opened = { ...wanted, scene };
  notice(`Setting up ${scene} …`);
  try {
    const set = { ...preset?.set, ...wanted.set };
    await link.send({ ...preset, type: 'open', scene, case: wanted.case ?? preset?.case, set });
    notice();
    history.replaceState(null, '', writeLink(location.search, opened));
  } catch (error) {
    opened = before;
    $('scene').value = model.hello.scene;
    $('case').value = model.hello.case_index;
    knobs.build();
    notice(error.message);
  }
}

function choose(number) {
  model.pad = number;
  for (const id of ['strips-pad', 'knobs-pad', 'loupe-pad']) write($(id), model.title(number));
  knobs.choose();
  text_ms = 0;
  draw();
}

function freeze(time_s) {
  model.freeze(time_s);
  draw();
}

const serve = () => send({ type: 'serve' });
const follow = () => model.follow();
const toggleFreeze = () => (model.frozen ? (follow(), draw()) : freeze());
const pickEvent = ({ pad, time_s }) => (choose(pad), freeze(time_s));

/** Says plainly whether what the page shows is of now. */
function checkAge() {
  model.stale = !model.lost && !paused && model.latest !== null && performance.now() - frames_ms > STALE_MS;
  const old = model.latest ? ' The values below are old.' : '';
  const text = model.lost ? `No connection to hapticore.${old} Trying again every second …`
    : model.status.stopped ? `The source has stopped: ${model.status.stopped}.${old}` : model.stale ? `No new values.${old}` : '';
  $('banner').hidden = !text;
  write($('banner'), text);
  document.body.classList.toggle('lost', Boolean(text));
}

setInterval(() => {
  const before = model.stale;
  checkAge();
  if (before !== model.stale) draw();
  if (model.hello) speech.hear(performance.now());
}, 300);

/** Draws, once, with the next picture of the screen. */
function draw() {
  if (drawing || !model.hello) return;
  drawing = true;
  requestAnimationFrame(paint);
}

function paint(now_ms) {
  drawing = false;
  board.live(now_ms);
  sheet.draw();
  loupe.draw();
  bars.draw();
  if (now_ms - strips_ms >= STRIPS_MS) paintStrips(now_ms);
  // For tests: what is drawn, and where.
  Object.assign($('sheet').dataset, { slot: model.shown?.slot ?? '', scale: sheet.scale });
  if (model.shown?.game) Object.assign($('sheet').dataset, { puck: model.shown.game.puck_mm, speed: model.shown.game.puck_mm_s });
  clearTimeout(textTimer);
  if (now_ms - text_ms >= TEXT_MS) paintText(now_ms);
  else textTimer = setTimeout(() => paintText(performance.now()), TEXT_MS);
}

function paintStrips(now_ms) {
  strips_ms = now_ms;
  strips.draw();
}

function paintText(now_ms) {
  text_ms = now_ms;
  paintStrips(now_ms);
  for (const part of [table, knobs, board]) part.draw();
  for (const part of [strips, bars]) part.drawValues();
  const { shown, status, frozen } = model;
  const slow = !paused && !model.lost && status.speed < 0.95 * status.asked_speed;
  const reached = status.speed == null ? '' : `${fixed(status.speed, 2)} × real time${slow ? ': machine too busy' : ''}`;
  write($('speed-now'), model.lost ? 'Not connected' : paused ? 'Paused' : reached);
  $('speed-now').className = slow ? 'bad' : '';
  write($('slot-now'), shown ? `${fixed(shown.time_s, 2)} s, slot ${shown.slot}` : '');
  write($('score'), shown?.game ? shown.game.score.join(' : ') : '');
  write($('answer-now'), link.answer_ms == null ? '' : `answers in ${fixed(link.answer_ms, 0)} ms`);
  write($('pause'), paused ? 'Run' : 'Pause');
  write($('freeze'), frozen ? 'Follow' : 'Freeze');
  $('freeze').ariaPressed = frozen;
  document.body.classList.toggle('frozen', frozen);
}

async function pace(speed) {
  await send({ type: 'pace', speed });
  [paused, frames_ms, text_ms] = [speed === 0, performance.now(), 0];
  draw();
}

async function oneSlot() {
  follow();
  if (!paused) await pace(0);
  await send({ type: 'step', slots: 1 });
  await send({ type: 'slot' });
}

function showRecording(on) {
  recording = on;
  write($('record'), on ? 'Stop and save' : 'Record');
  $('record').classList.toggle('on', on);
}

async function toggleRecord() {
  try {
    await link.send({ type: 'record', to: recording ? 'scene' : 'start' });
    showRecording(!recording);
  } catch (error) {
    notice(error.message);
  }
}

function download({ name, text, note }) {
  const anchor = element('a');
  anchor.href = URL.createObjectURL(new Blob([text], { type: 'text/plain' }));
  anchor.download = name;
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 1000);
  notice(`Saved ${name}; hapticore simulate ${name} runs it. ${note}`);
}

function copy(text) {
  const done = () => notice(`Copied: ${text}`);
  if (navigator.clipboard) navigator.clipboard.writeText(text).then(done, () => notice(`Copy this: ${text}`));
  else notice(`Copy this: ${text}`);
}

for (const [word, words] of Object.entries(STATES)) $('states').append(element('dt', '', word), element('dd', '', words));
fill($('span'), SPANS, strips.span_s);
leadByPointer(sheet, leader, (pad) => (follow(), choose(pad)));
leadByPointer(loupe, leader, follow);
listenToKeys({ model, choose, freeze: toggleFreeze, slot: oneSlot, serve, step: (by) => (follow(), leader.step(model.pad, by)) });
const clicks = {
  serve,
  pause: () => pace(paused ? Number($('speed').value) : 0), 'one-slot': oneSlot, 'take-slot': () => send({ type: 'slot' }),
  freeze: toggleFreeze, record: toggleRecord, 'copy-command': () => copy(model.hello?.command ?? ''),
  'copy-link': () => copy(location.origin + location.pathname + writeLink('', opened)),
};
for (const [id, run] of Object.entries(clicks)) $(id).onclick = run;
const changes = {
  scene: (scene) => open({ scene, set: {} }), case: (of) => open({ ...opened, case: of }), speed: (speed) => pace(Number(speed)),
  span: (span) => (Object.assign(strips, { span_s: Number(span) }), draw()),
};
for (const [id, run] of Object.entries(changes)) $(id).onchange = (event) => run(event.target.value);
addEventListener('resize', draw);
window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  readColours();
  if (model.hello) strips.build();
  slotPlot.build();
  draw();
});
