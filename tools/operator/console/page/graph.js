// The mapper's pose graph: keyframes with their heading, what ties neighbours, and loops. A keyframe has the colour of
// the map that it is in: another one than the robot's is drawn as its walls are.

const DOT_PX = 3;
const DOT_LEAST_PX = 2; // where the map is drawn small
const HEADING_PX = 8;
const HEADING_FROM_SCALE = 30; // pixels a metre; below, headings would hide the dots
const APART_DASH = [6, 4];
// Told by shape as well as by strength: what moved the map is solid, what joined two maps is long dashes.
const LOOPS = {
  recognised: { width: 1, alpha: 0.6, dash: [] },
  closed: { width: 2.25, alpha: 1, dash: [] },
  joins: { width: 2.5, alpha: 1, dash: [12, 5] },
};

export function drawGraph(context, view, scene, colour) {
  const { keyframes, loops } = scene.graph;
  const places = keyframes.map(({ at }) => view.toScreen(at[0], at[1]));
  const colourOf = (keyframe, here) => colour(scene.isApart(keyframe) ? "apart" : here);
  context.save();
  for (const apart of [true, false]) {
    context.strokeStyle = colour(apart ? "apart" : "keyframe");
    context.lineWidth = 1.25;
    context.setLineDash(apart ? APART_DASH : []);
    context.beginPath();
    keyframes.forEach((keyframe, k) => {
      if (keyframe.tied && scene.isApart(keyframe) === apart) line(context, places[k - 1], places[k]);
    });
    context.stroke();
  }
  for (const [kind, { width, alpha, dash }] of Object.entries(LOOPS)) {
    context.lineWidth = width;
    context.globalAlpha = alpha;
    context.setLineDash(dash);
    for (const loop of loops.filter((each) => each.kind === kind)) {
      context.strokeStyle = colourOf(keyframes[loop.to], "loop");
      context.beginPath();
      line(context, places[loop.from], places[loop.to]);
      context.stroke();
    }
  }
  context.globalAlpha = 1;
  context.setLineDash([]);
  const isLarge = view.scale >= HEADING_FROM_SCALE;
  keyframes.forEach((keyframe, k) => {
    context.fillStyle = context.strokeStyle = colourOf(keyframe, "keyframe");
    dot(context, places[k], isLarge ? DOT_PX : DOT_LEAST_PX);
    if (isLarge) heading(context, places[k], keyframe.at[2]);
  });
  context.restore();
}

function line(context, from, to) {
  context.moveTo(...from);
  context.lineTo(...to);
}

function dot(context, [px, py], radius) {
  context.beginPath();
  context.arc(px, py, radius, 0, 2 * Math.PI);
  context.fill();
}

function heading(context, [px, py], theta) {
  context.lineWidth = 1.5;
  context.beginPath();
  line(context, [px, py], [px + HEADING_PX * Math.cos(theta), py - HEADING_PX * Math.sin(theta)]);
  context.stroke();
}
