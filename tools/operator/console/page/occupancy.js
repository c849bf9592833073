// Free and occupied cells from the scans that have been shown, each from its pose in the map: what lines do not show. They
// begin anew when the robot is in another map or its pose jumps; what loops have moved since is drawn over by what is seen next.

const CELL_M = 0.05;
const TILE = 64; // cells a side
const HIT = 5;
const PASS = -1;
const MOST = 40;
const SURE = 6; // evidence of an occupied cell
const LARGEST_STEP_M = 0.5;
const MOST_TILES = 4096; // 13 m^2 each of what has been seen

export class Occupancy {
  constructor() {
    this.forget();
  }

  forget() {
    this.tiles = new Map(); // "x,y" -> {x, y, cells, canvas, due}
    this.frame = null;
    this.map = undefined;
    this.scan = undefined;
  }

  // scan: its number, since it may be shown more than once; points: ends of the beams in the map, [x, y, ...]; from: the sensor;
  // map: its number; frame: [x, y, turn] of the smooth pose's in it, which stays while the robot drives and moves when its map pose does.
  add(scan, points, from, map, frame) {
    if (scan === this.scan) return;
    if (map !== this.map || this.#moved(from, frame) > LARGEST_STEP_M) this.forget();
    [this.scan, this.map, this.frame] = [scan, map, frame];
    for (let k = 0; k < points.length; k += 2) this.#beam(from[0], from[1], points[k], points[k + 1]);
  }

  // How far from there it would be, had the map not moved since the scan before.
  #moved([x, y], [left, bottom, turn]) {
    const [beforeLeft, beforeBottom, before] = this.frame ?? [left, bottom, turn];
    const [c, s] = [Math.cos(before - turn), Math.sin(before - turn)];
    return Math.hypot(beforeLeft + c * (x - left) - s * (y - bottom) - x, beforeBottom + s * (x - left) + c * (y - bottom) - y);
  }

  // Cell by cell along the longer axis, up to the cell before the last.
  #beam(x0, y0, x1, y1) {
    const steps = Math.max(1, Math.ceil(Math.max(Math.abs(x1 - x0), Math.abs(y1 - y0)) / CELL_M));
    for (let k = 0; k < steps - 1; k++) this.#change(x0 + ((x1 - x0) * k) / steps, y0 + ((y1 - y0) * k) / steps, PASS);
    this.#change(x1, y1, HIT);
  }

  #change(x, y, by) {
    const [column, row] = [Math.floor(x / CELL_M), Math.floor(y / CELL_M)];
    const [tx, ty] = [Math.floor(column / TILE), Math.floor(row / TILE)];
    const tile = this.#tile(tx, ty);
    if (!tile) return;
    const cell = (row - ty * TILE) * TILE + column - tx * TILE;
    tile.cells[cell] = Math.max(-MOST, Math.min(MOST, tile.cells[cell] + by)) || Math.sign(by);
    tile.due = true;
  }

  #tile(x, y) {
    if (this.last?.x === x && this.last.y === y && this.tiles.has(this.last.key)) return this.last;
    const key = `${x},${y}`;
    let tile = this.tiles.get(key);
    if (!tile && this.tiles.size < MOST_TILES) {
      tile = { key, x, y, cells: new Int8Array(TILE * TILE), canvas: new OffscreenCanvas(TILE, TILE), due: true };
      this.tiles.set(key, tile);
    }
    return (this.last = tile);
  }

  // colours: of free and occupied cells, [r, g, b].
  draw(context, view, free, occupied) {
    context.imageSmoothingEnabled = false;
    for (const tile of this.tiles.values()) {
      if (tile.due || tile.colours !== `${free} ${occupied}`) this.#render(tile, free, occupied);
      const [left, bottom] = view.toScreen(tile.x * TILE * CELL_M, tile.y * TILE * CELL_M);
      const size = TILE * CELL_M * view.scale;
      context.drawImage(tile.canvas, left, bottom - size, size, size);
    }
  }

  #render(tile, free, occupied) {
    tile.due = false;
    tile.colours = `${free} ${occupied}`;
    const image = new ImageData(TILE, TILE);
    for (let k = 0; k < tile.cells.length; k++) {
      const evidence = tile.cells[k];
      if (evidence === 0) continue;
      const pixel = 4 * ((TILE - 1 - Math.floor(k / TILE)) * TILE + (k % TILE)); // rows from the top
      const colour = evidence >= SURE ? occupied : free;
      image.data.set([...colour, evidence < 0 ? 70 : evidence >= SURE ? 200 : 0], pixel);
    }
    tile.canvas.getContext("2d").putImageData(image, 0, 0);
  }
}
