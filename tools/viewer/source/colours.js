/** Colours of what is drawn, in both themes. */
export const THEMES = {
  light: {
    sky: 0xdfe6ec, floor: 0xe9ecef, haze: 0xf3f5f7, body: 0xb9bec4, pin: 0x20262d, contact: 0xffb000,
    wire: 0x1c2126, exposure: 1.0, ambient: 1.0,
  },
  dark: {
    sky: 0x232a31, floor: 0x3b454f, haze: 0x14181c, body: 0x8a929b, pin: 0xf4f6f8, contact: 0xffc233,
    wire: 0x0c0f12, exposure: 0.95, ambient: 0.62,
  },
};

/** Front and back of the cloth of each result. */
export const FABRICS = [
  { front: 0x9c4a38, back: 0xd9c8ab },
  { front: 0x3a628c, back: 0xd3cbb8 },
];

/** Names of colours for lists of any length: neighbours in the list are far apart. */
export function hueOf(index) {
  return (0.04 + index * 0.618033988749895) % 1;
}
