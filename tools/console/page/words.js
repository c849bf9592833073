// Numbers and codes in an operator's words.

export const metres = (v) => (v === null ? "–" : `${v.toFixed(3)} m`);
export const degrees = (rad, digits = 1) => (rad === null ? "–" : `${((rad * 180) / Math.PI).toFixed(digits)}°`);
export const millimetres = (m) => (Number.isFinite(m) ? `${(m * 1000).toFixed(1)} mm` : "–");

export function duration(us) {
  if (us === null || us === undefined) return "–";
  if (us < 995) return `${us.toFixed(0)} µs`;
  if (us < 995e3) return `${(us / 1e3).toPrecision(3)} ms`;
  return `${(us / 1e6).toFixed(1)} s`;
}

export const heading = (rad) => {
  const turn = 2 * Math.PI;
  return degrees(((((rad + Math.PI) % turn) + turn) % turn) - Math.PI);
};

// What a beam without a range says: the scanner's own code, or (from 128) what the driver made of it.
const CODES = {
  0: "nothing in reach", 6: "nothing in reach", 7: "beside a disturbed beam", 18: "dazzled by something shiny",
  19: "no beam there", 129: "nothing in reach", 130: "unusable", 131: "masked", 133: "too near",
};
const codeInWords = (code) => CODES[code] ?? (code < 6 ? "too weak" : "disturbed");

// [[code, count], ...] as "12 nothing in reach, 3 too weak".
export function codesInWords(codes) {
  const counts = new Map();
  for (const [code, count] of codes) {
    const words = codeInWords(code);
    counts.set(words, (counts.get(words) ?? 0) + count);
  }
  return [...counts].map(([words, count]) => `${count} ${words}`).join(", ") || "none";
}

export const STATES = {
  good: ["good", ""],
  weak: ["weak", "position uncertain"],
  lost: ["lost", "position unknown"],
};
