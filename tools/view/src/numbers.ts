// SPDX-License-Identifier: Apache-2.0
// Numbers as the native programs print them, digit for digit.

function scientific(digits: string, exponent: number): string {
  const tail = digits.length > 1 ? `.${digits.slice(1)}` : '';
  const size = Math.abs(exponent);
  return `${digits[0]}${tail}e${exponent < 0 ? '-' : '+'}${size < 10 ? '0' : ''}${size}`;
}

function fixed(digits: string, exponent: number): string {
  if (exponent < 0) return `0.${'0'.repeat(-exponent - 1)}${digits}`;
  if (digits.length <= exponent + 1) return digits + '0'.repeat(exponent + 1 - digits.length);
  return `${digits.slice(0, exponent + 1)}.${digits.slice(exponent + 1)}`;
}

function split(text: string): { digits: string; exponent: number } {
  const [mantissa = '0', exponent = '0'] = text.split('e');
  return { digits: mantissa.replace('.', ''), exponent: Number(exponent) };
}

function special(x: number): string | undefined {
  if (Number.isNaN(x)) return 'nan';
  if (!Number.isFinite(x)) return x < 0 ? '-inf' : 'inf';
  if (x === 0) return Object.is(x, -0) ? '-0' : '0';
  return undefined;
}

/** The shortest digits that read back as x: C++'s std::to_chars. */
export function shortest(x: number): string {
  const known = special(x);
  if (known !== undefined) return known;
  const { digits, exponent } = split(Math.abs(x).toExponential());
  const plain = fixed(digits, exponent);
  const short = scientific(digits, exponent);
  return (x < 0 ? '-' : '') + (plain.length <= short.length ? plain : short);
}

/** 17 significant digits: C's %.17g. Where two are equally near, JavaScript takes the larger, C the even one. */
export function precise(x: number): string {
  const known = special(x);
  if (known !== undefined) return known;
  const size = Math.abs(x);
  let { digits, exponent } = split(size.toExponential(16));
  const longer = split(size.toExponential(40));
  const isTie = /^50*$/.test(longer.digits.slice(17));
  if (isTie && Number(longer.digits[16]) % 2 === 0) ({ digits, exponent } = { digits: longer.digits.slice(0, 17), exponent: longer.exponent });
  digits = digits.replace(/0+$/, '') || '0';
  return (x < 0 ? '-' : '') + (exponent < -4 || exponent >= 17 ? scientific(digits, exponent) : fixed(digits, exponent));
}

/** 1234567 as 1,234,567. */
export function grouped(x: number): string {
  return String(x).replace(/\B(?=(\d{3})+(?!\d))/g, ',');
}

/** For people: three significant digits. */
export function short(x: number): string {
  if (x === 0 || !Number.isFinite(x)) return String(x);
  const size = Math.abs(x);
  return size >= 1e5 || size < 1e-3 ? x.toExponential(2).replace('e+', 'e') : String(Number(x.toPrecision(3)));
}
