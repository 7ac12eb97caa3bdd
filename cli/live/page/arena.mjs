// SPDX-License-Identifier: MIT OR Apache-2.0
// Air hockey: table, goals, puck and score, on the sheet and in the loupe.

import { colours, disc, label, line, ring } from './draw.mjs';

/** A rectangle's corners, closed. */
const corners = ([w, h]) => [[-w, h], [w, h], [w, -h], [-w, -h], [-w, h]];

/** The table: its border, the centre line, and both goals. */
export function drawArena(g, view) {
  const { arena } = view.model.hello;
  if (!arena) return;
  const [w, h] = arena.half_mm;
  const [left, top] = view.at([-w, h]);
  const [right, bottom] = view.at([w, -h]);
  Object.assign(g, { fillStyle: colours.page, globalAlpha: 0.6 });
  g.fillRect(left, top, right - left, bottom - top);
  g.globalAlpha = 1;
  line(g, [view.at([0, h]), view.at([0, -h])], colours.rule, 1.5, [6, 5]);
  line(g, corners(arena.half_mm).map((mm) => view.at(mm)), colours.ink, 2);
  for (const x of [-w, w]) line(g, [view.at([x, arena.goal_half_mm]), view.at([x, -arena.goal_half_mm])], colours.goal, 6);
}

/** The puck, with its mass as a dot. */
export function drawPuck(g, view) {
  const { hello, shown } = view.model;
  if (!hello.arena || !shown?.game) return;
  const at = view.at(shown.game.puck_mm);
  const radius = Math.max(4, hello.arena.puck_radius_mm * view.scale);
  disc(g, at, radius, colours.puck, 0.85);
  ring(g, at, radius, colours.ink, 1.5);
  disc(g, at, 2.5, colours.page);
}

/** Goals of either player, at the upper end of the centre line. */
export function drawScore(g, view) {
  const { hello, shown } = view.model;
  if (!hello.arena || !shown?.game) return;
  const [x, y] = view.at([0, hello.arena.half_mm[1]]);
  label(g, shown.game.score.join(' : '), x, y + 18, colours.ink, 'center', '600 ');
}

/** The walls of the chosen pad: hatched where its centre may not be, with their surfaces as lines. */
export function drawReach(g, view, reach) {
  const { hello, pad } = view.model;
  if (!hello.arena) return;
  hello.arena.reach_mm[pad].forEach(([from, to], axis) => {
    view.wall(g, { axis, mm: from, below: true }, view.origin, reach, 10);
    view.wall(g, { axis, mm: to, below: false }, view.origin, reach, 10);
  });
}
